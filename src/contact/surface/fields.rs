//! The fields of a contact of profiles: those of a patch in each window, and where the windows are.

use super::operators::SurfaceOperators;
use super::windows::{Place, SHAPES, WINDOWS};
use crate::contact::fields::{FieldRow, Fields, Number, number, row};
use crate::contact::patch::fields::PatchFields;
use crate::friction::memory::Memory;
use serde::{Deserialize, Serialize};

/// Fields of all windows at one instant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceFields {
    /// Fields of the windows.
    pub windows: [PatchFields; WINDOWS],
    /// Places of the windows; `None` of one that is not used.
    pub places: [Option<Place>; WINDOWS],
    /// Approach: by how much the wheel is lower than where the undeformed bodies touch first, `m`.
    pub approach: Vec<f64>,
    /// Height of the axle's middle over the rail's top at which the undeformed bodies touch first, `m`.
    pub touch: f64,
    /// Vertical stiffness, change of the load with the approach, `N/m`; 0 where it is not known.
    pub stiffness: f64,
    /// Vertical load that is carried, `N`.
    pub load: f64,
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
}

impl SurfaceFields {
    /// Fields of a cold, unworn rail without contact; the wheel's temperature is 0 K.
    pub fn new(operators: &SurfaceOperators) -> SurfaceFields {
        SurfaceFields {
            windows: std::array::from_fn(|_| PatchFields::new(&operators.shapes[0])),
            places: [None; WINDOWS],
            approach: vec![0.0],
            touch: 0.0,
            stiffness: 0.0,
            load: 0.0,
            wheel_temperature: 0.0,
        }
    }

    /// Windows that are used, each with its number and its place.
    pub fn used(&self) -> impl Iterator<Item = (usize, Place)> + use<> {
        let places = self.places;
        places
            .into_iter()
            .enumerate()
            .filter_map(|(window, place)| place.map(|place| (window, place)))
    }
}

/// Rows of the fields of the windows.
macro_rules! rows_of_windows {
    ($($window:literal)+) => {
        &[
            row!(Nonlinear, Extrapolated, approach),
            $(
                row!(Nonlinear, Extrapolated, windows[$window].shear[0]),
                row!(Nonlinear, Extrapolated, windows[$window].shear[1]),
                row!(Nonlinear, Extrapolated, windows[$window].pressure),
                row!(Linear, Extrapolated, windows[$window].heat.surface),
                row!(Independent, Extrapolated, windows[$window].heat.content),
                row!(Linear, Extrapolated, windows[$window].wear.depth),
                row!(Nonlinear, Before, windows[$window].slip[0]),
                row!(Nonlinear, Before, windows[$window].slip[1]),
                row!(Nonlinear, Before, windows[$window].friction),
                row!(Independent, Before, windows[$window].displacement[0]),
                row!(Independent, Before, windows[$window].displacement[1]),
                row!(Independent, Before, windows[$window].displacement_change[0]),
                row!(Independent, Before, windows[$window].displacement_change[1]),
                row!(Linear, Computed, windows[$window].heat.flux),
                row!(Linear, Computed, windows[$window].heat.outer[0]),
                row!(Linear, Computed, windows[$window].heat.outer[1]),
                row!(Linear, Computed, windows[$window].wear.outer[0]),
                row!(Linear, Computed, windows[$window].wear.outer[1]),
                row!(Independent, Computed, windows[$window].heat.window),
                row!(Independent, Computed, windows[$window].heat.replaced),
                row!(Independent, Computed, windows[$window].wear.window),
                row!(Independent, Computed, windows[$window].wear.replaced),
            )+
        ]
    };
}

/// Numbers of the fields of the windows.
macro_rules! numbers_of_windows {
    ($($window:literal)+) => {
        &[
            number!(false, true, touch),
            number!(false, true, stiffness),
            number!(false, true, load),
            number!(false, true, wheel_temperature),
            $(
                number!(true, true, windows[$window].relaxation_length),
                number!(false, true, windows[$window].penetration),
                number!(false, true, windows[$window].wheel_temperature),
                number!(true, false, windows[$window].heat.breadth),
                number!(true, false, windows[$window].wear.breadth),
            )+
        ]
    };
}

impl Fields for SurfaceFields {
    const ROWS: &'static [FieldRow<SurfaceFields>] = rows_of_windows!(0 1 2 3);
    const NUMBERS: &'static [Number<SurfaceFields>] = numbers_of_windows!(0 1 2 3);

    fn memories(&self) -> impl Iterator<Item = &Memory> {
        self.windows.iter().map(|window| &window.memory)
    }

    fn memories_mut(&mut self) -> impl Iterator<Item = &mut Memory> {
        self.windows.iter_mut().map(|window| &mut window.memory)
    }

    fn has_moved(&self, before: &SurfaceFields) -> bool {
        self.places != before.places
    }

    fn copy_places(&mut self, other: &SurfaceFields) {
        self.places = other.places;
    }

    fn has_valid_places(&self) -> bool {
        self.used().all(|(_, place)| place.shape() < SHAPES)
    }
}
