//! The fields of a line contact, all that a step changes.

use super::operators::LineOperators;
use crate::contact::fields::{FieldRow, Fields, Number, number, row};
use crate::friction::memory::Memory;
use serde::{Deserialize, Serialize};

/// Fields of the contact at one instant; n contact nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LineFields {
    /// Modal amplitudes of the temperature rise, columns × modes, column by column.
    pub temperature: Vec<f64>,
    /// Temperature rise at the surface of the columns, `K`.
    pub surface_temperature: Vec<f64>,
    /// Displacement of the contact nodes caused by the temperature, scaled, along x₁ then along x₂, 2n.
    pub thermal_displacement: Vec<f64>,
    /// Wear depth at the columns, `m`.
    pub wear: Vec<f64>,
    /// Content of the inflow column before the step, which the derivatives of the step need: its modal amplitudes, then its wear
    /// depth, modes + 1.
    pub replaced_inflow: Vec<f64>,
    /// Pressure, scaled, n.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail, scaled, n.
    pub shear: Vec<f64>,
    /// Slip velocity, `m/s`, 0 outside the contact, n.
    pub slip: Vec<f64>,
    /// Traction utilisation −τ/(μ p), with the sign of the slip, n.
    pub utilisation: Vec<f64>,
    /// Friction coefficient; where a layer flows, its bound over the pressure, n.
    pub friction: Vec<f64>,
    /// Heat flux into the rail, `W/m²`, n.
    pub heat_flux: Vec<f64>,
    /// Displacement of the contact nodes along x₁, scaled, n.
    pub displacement: Vec<f64>,
    /// Change of the displacement along x₁ over the last step, scaled, n.
    pub displacement_change: Vec<f64>,
    /// History of friction, n.
    pub memory: Memory,
    /// Relaxation length of the displacement in the last step, `m`: the distance of rolling on which a change of it decays.
    pub relaxation_length: f64,
    /// Penetration δ, scaled; 0 when lifted.
    pub penetration: f64,
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
}

impl LineFields {
    /// Fields of a cold, unworn rail without contact; the wheel's temperature is 0 K.
    pub fn new(operators: &LineOperators) -> LineFields {
        let (n, columns) = (operators.mesh.contact_nodes, operators.mesh.columns());
        LineFields {
            temperature: vec![0.0; columns * operators.heat.basis.len()],
            surface_temperature: vec![0.0; columns],
            thermal_displacement: vec![0.0; 2 * n],
            wear: vec![0.0; columns],
            replaced_inflow: vec![0.0; operators.heat.basis.len() + 1],
            pressure: vec![0.0; n],
            shear: vec![0.0; n],
            slip: vec![0.0; n],
            utilisation: vec![0.0; n],
            friction: vec![0.0; n],
            heat_flux: vec![0.0; n],
            displacement: vec![0.0; n],
            displacement_change: vec![0.0; n],
            memory: Memory::new(n),
            relaxation_length: operators.relaxation.length(operators.relaxation.half_length),
            penetration: 0.0,
            wheel_temperature: 0.0,
        }
    }

    /// Modal amplitudes of one column.
    pub fn column(&self, operators: &LineOperators, column: usize) -> &[f64] {
        let m = operators.heat.basis.len();
        &self.temperature[column * m..(column + 1) * m]
    }
}

impl Fields for LineFields {
    const ROWS: &'static [FieldRow<LineFields>] = &[
        row!(Linear, Computed, temperature),
        row!(Linear, Extrapolated, surface_temperature),
        row!(Linear, Extrapolated, thermal_displacement),
        row!(Linear, Extrapolated, wear),
        row!(Independent, Before, replaced_inflow),
        row!(Nonlinear, Before, pressure),
        row!(Nonlinear, Extrapolated, shear),
        row!(Nonlinear, Before, slip),
        row!(Nonlinear, Before, utilisation),
        row!(Nonlinear, Before, friction),
        row!(Linear, Before, heat_flux),
        row!(Independent, Before, displacement),
        row!(Independent, Before, displacement_change),
    ];
    const NUMBERS: &'static [Number<LineFields>] = &[
        number!(true, true, relaxation_length),
        number!(false, true, penetration),
        number!(false, true, wheel_temperature),
    ];

    fn memories(&self) -> impl Iterator<Item = &Memory> {
        std::iter::once(&self.memory)
    }

    fn memories_mut(&mut self) -> impl Iterator<Item = &mut Memory> {
        std::iter::once(&mut self.memory)
    }
}
