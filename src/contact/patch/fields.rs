//! The fields of a patch, all that a step changes.

use super::operators::PatchOperators;
use crate::contact::fields::{FieldRow, Fields, Number, number, row};
use crate::friction::memory::Memory;
use crate::heat::strips::StripTemperature;
use crate::wear::strips::StripWear;
use serde::{Deserialize, Serialize};

/// Fields of the patch at one instant. Those of the cells stand on the grid ([`crate::body::grid`]).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PatchFields {
    /// Temperature of the rail.
    pub heat: StripTemperature,
    /// Wear depth of the rail.
    pub wear: StripWear,
    /// Pressure, scaled.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail along x and y, scaled.
    pub shear: [Vec<f64>; 2],
    /// Slip velocity, `m/s`, 0 outside the contact.
    pub slip: [Vec<f64>; 2],
    /// Friction coefficient, 0 outside the contact.
    pub friction: Vec<f64>,
    /// Displacement of the rail's surface less that of the wheel's along x and y, scaled.
    pub displacement: [Vec<f64>; 2],
    /// Change of the displacement over the last step, scaled.
    pub displacement_change: [Vec<f64>; 2],
    /// History of friction of the cells, strip by strip.
    pub memory: Memory,
    /// Relaxation length of the displacement in the last step, `m`: the distance of rolling on which a change of it decays.
    pub relaxation_length: f64,
    /// Penetration δ, scaled; 0 when lifted.
    pub penetration: f64,
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
}

impl PatchFields {
    /// Fields of a cold, unworn rail without contact; the wheel's temperature is 0 K.
    pub fn new(operators: &PatchOperators) -> PatchFields {
        let on_grid = || vec![0.0; operators.grid.len()];
        let vectors = || [on_grid(), on_grid()];
        PatchFields {
            heat: StripTemperature::new(&operators.strips, operators.basis.len()),
            wear: StripWear::new(&operators.strips),
            pressure: on_grid(),
            shear: vectors(),
            slip: vectors(),
            friction: on_grid(),
            displacement: vectors(),
            displacement_change: vectors(),
            memory: Memory::new(operators.grid.strips * operators.grid.cells),
            relaxation_length: operators.relaxation_length,
            penetration: 0.0,
            wheel_temperature: 0.0,
        }
    }

    /// Fields of the same sizes that nothing has happened to.
    pub fn untouched(&self) -> PatchFields {
        let mut fields = self.clone();
        for row in Self::ROWS {
            (row.get_mut)(&mut fields).fill(0.0);
        }
        fields.memory = Memory::new(self.memory.share.len());
        fields.penetration = 0.0;
        fields
    }
}

impl Fields for PatchFields {
    const ROWS: &'static [FieldRow<PatchFields>] = &[
        row!(Nonlinear, Extrapolated, shear[0]),
        row!(Nonlinear, Extrapolated, shear[1]),
        row!(Nonlinear, Extrapolated, pressure),
        row!(Linear, Extrapolated, heat.surface),
        row!(Independent, Extrapolated, heat.content),
        row!(Linear, Extrapolated, wear.depth),
        row!(Nonlinear, Before, slip[0]),
        row!(Nonlinear, Before, slip[1]),
        row!(Nonlinear, Before, friction),
        row!(Independent, Before, displacement[0]),
        row!(Independent, Before, displacement[1]),
        row!(Independent, Before, displacement_change[0]),
        row!(Independent, Before, displacement_change[1]),
        row!(Linear, Computed, heat.flux),
        row!(Linear, Computed, heat.outer[0]),
        row!(Linear, Computed, heat.outer[1]),
        row!(Linear, Computed, wear.outer[0]),
        row!(Linear, Computed, wear.outer[1]),
        row!(Deep, Computed, heat.window),
        row!(Independent, Computed, heat.replaced),
        row!(Independent, Computed, wear.window),
        row!(Independent, Computed, wear.replaced),
    ];
    const NUMBERS: &'static [Number<PatchFields>] = &[
        number!(true, true, relaxation_length),
        number!(false, true, penetration),
        number!(false, true, wheel_temperature),
        number!(true, false, heat.breadth),
        number!(true, false, wear.breadth),
    ];

    fn memories(&self) -> impl Iterator<Item = &Memory> {
        std::iter::once(&self.memory)
    }

    fn memories_mut(&mut self) -> impl Iterator<Item = &mut Memory> {
        std::iter::once(&mut self.memory)
    }
}
