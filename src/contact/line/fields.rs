//! The fields of the contact, all that a step changes, and their trend from step to step.

use crate::contact::line::operators::LineOperators;
use crate::friction::memory::Memory;
use crate::numerics::dense;
use serde::{Deserialize, Serialize};

/// The fields of the contact at one instant; n contact nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    /// Modal amplitudes of the temperature rise, columns × modes, column by column.
    pub temperature: Vec<f64>,
    /// Temperature rise at the surface of the columns, `K`.
    pub surface_temperature: Vec<f64>,
    /// Displacement of the contact nodes caused by the temperature, scaled, along x₁ then along x₂, 2n.
    pub thermal_displacement: Vec<f64>,
    /// Wear depth at the columns, `m`.
    pub wear: Vec<f64>,
    /// What stood in the inflow column before the step: its modal amplitudes, then its wear depth, modes + 1. The derivatives of
    /// the step need it.
    pub replaced_inflow: Vec<f64>,
    /// Pressure, scaled, n.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail, scaled, n.
    pub shear: Vec<f64>,
    /// Slip velocity, `m/s`, 0 outside the contact, n.
    pub slip: Vec<f64>,
    /// Share −τ/(μ p) of Coulomb's bound that the shear takes, n.
    pub saturation: Vec<f64>,
    /// Friction coefficient; where a layer flows, its bound over the pressure, n.
    pub friction: Vec<f64>,
    /// Heat flux into the rail, `W/m²`, n.
    pub heat_flux: Vec<f64>,
    /// Displacement of the contact nodes along x₁, scaled, n.
    pub displacement: Vec<f64>,
    /// Its change over the last step, n.
    pub displacement_change: Vec<f64>,
    /// What friction remembers, n.
    pub memory: Memory,
    /// The way of rolling on which the last step took the displacement to be forgotten, `m`.
    pub relaxation_length: f64,
    /// Penetration δ, scaled; 0 when lifted.
    pub penetration: f64,
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
}

impl Fields {
    /// A cold, unworn rail without contact; the wheel's temperature is 0 K.
    pub fn new(operators: &LineOperators) -> Fields {
        let (n, columns) = (operators.mesh.contact_nodes, operators.mesh.columns());
        Fields {
            temperature: vec![0.0; columns * operators.heat.basis.len()],
            surface_temperature: vec![0.0; columns],
            thermal_displacement: vec![0.0; 2 * n],
            wear: vec![0.0; columns],
            replaced_inflow: vec![0.0; operators.heat.basis.len() + 1],
            pressure: vec![0.0; n],
            shear: vec![0.0; n],
            slip: vec![0.0; n],
            saturation: vec![0.0; n],
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

    /// The vectors, in the order of their declaration.
    pub fn vectors(&self) -> [&Vec<f64>; 13] {
        [
            &self.temperature,
            &self.surface_temperature,
            &self.thermal_displacement,
            &self.wear,
            &self.replaced_inflow,
            &self.pressure,
            &self.shear,
            &self.slip,
            &self.saturation,
            &self.friction,
            &self.heat_flux,
            &self.displacement,
            &self.displacement_change,
        ]
    }

    /// Whether the outputs are linear functions of a vector or its largest value, in the order of [`Fields::vectors`]: so of
    /// temperatures, wear and heat flux, not of tractions, slip and friction. None where no output depends on it.
    pub const OUTPUTS_ARE_LINEAR: [Option<bool>; 13] = [
        Some(true),
        Some(true),
        Some(true),
        Some(true),
        None,
        Some(false),
        Some(false),
        Some(false),
        Some(false),
        Some(false),
        Some(true),
        None,
        None,
    ];

    fn vectors_mut(&mut self) -> [&mut Vec<f64>; 13] {
        [
            &mut self.temperature,
            &mut self.surface_temperature,
            &mut self.thermal_displacement,
            &mut self.wear,
            &mut self.replaced_inflow,
            &mut self.pressure,
            &mut self.shear,
            &mut self.slip,
            &mut self.saturation,
            &mut self.friction,
            &mut self.heat_flux,
            &mut self.displacement,
            &mut self.displacement_change,
        ]
    }

    /// Overwrites these fields with others of the same sizes, without allocating.
    pub fn copy_from(&mut self, other: &Fields) {
        self.temperature.copy_from_slice(&other.temperature);
        self.copy_surface_from(other);
    }

    /// As [`Fields::copy_from`], but for the temperature below the surface, most of all values.
    pub fn copy_surface_from(&mut self, other: &Fields) {
        for (own, other) in self.vectors_mut().into_iter().zip(other.vectors()).skip(1) {
            own.copy_from_slice(other);
        }
        self.memory.copy_from(&other.memory);
        self.relaxation_length = other.relaxation_length;
        self.penetration = other.penetration;
        self.wheel_temperature = other.wheel_temperature;
    }

    /// Adds a multiple of other fields of the same sizes.
    pub fn add_multiple(&mut self, factor: f64, other: &Fields) {
        for (own, other) in self.vectors_mut().into_iter().zip(other.vectors()) {
            dense::add_multiple(other, factor, own);
        }
        self.penetration += factor * other.penetration;
        self.wheel_temperature += factor * other.wheel_temperature;
    }

    /// Modal amplitudes of one column.
    pub fn column(&self, operators: &LineOperators, column: usize) -> &[f64] {
        let m = operators.heat.basis.len();
        &self.temperature[column * m..(column + 1) * m]
    }
}

/// Rates of change of what a step starts its iteration from, per second: the first guess is extrapolated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trend {
    /// Of the shear, n.
    pub shear: Vec<f64>,
    /// Of the surface temperature, columns.
    pub surface_temperature: Vec<f64>,
    /// Of the thermal displacement, 2n.
    pub thermal_displacement: Vec<f64>,
    /// Of the wear depth, columns.
    pub wear: Vec<f64>,
}

impl Trend {
    /// No change.
    pub fn new(operators: &LineOperators) -> Trend {
        let fields = Fields::new(operators);
        Trend {
            shear: fields.shear,
            surface_temperature: fields.surface_temperature,
            thermal_displacement: fields.thermal_displacement,
            wear: fields.wear,
        }
    }

    /// The vectors, in the order of their declaration.
    pub fn vectors(&self) -> [&Vec<f64>; 4] {
        [
            &self.shear,
            &self.surface_temperature,
            &self.thermal_displacement,
            &self.wear,
        ]
    }

    /// The trend between two fields `duration` `s` apart.
    pub fn update(&mut self, before: &Fields, after: &Fields, duration: f64) {
        let update = |trend: &mut [f64], before: &[f64], after: &[f64]| {
            for ((trend, before), after) in trend.iter_mut().zip(before).zip(after) {
                *trend = (after - before) / duration;
            }
        };
        update(&mut self.shear, &before.shear, &after.shear);
        update(
            &mut self.surface_temperature,
            &before.surface_temperature,
            &after.surface_temperature,
        );
        update(
            &mut self.thermal_displacement,
            &before.thermal_displacement,
            &after.thermal_displacement,
        );
        update(&mut self.wear, &before.wear, &after.wear);
    }

    /// Moves the first guess on by `duration` `s`.
    pub fn extrapolate(&self, fields: &mut Fields, duration: f64) {
        dense::add_multiple(&self.shear, duration, &mut fields.shear);
        dense::add_multiple(&self.surface_temperature, duration, &mut fields.surface_temperature);
        dense::add_multiple(&self.thermal_displacement, duration, &mut fields.thermal_displacement);
        dense::add_multiple(&self.wear, duration, &mut fields.wear);
    }
}
