//! The fields of a contact of profiles: those of a patch in each window, and where the windows are.

use super::operators::SurfaceOperators;
use super::windows::{BREADTHS, LENGTHS, Place, WINDOWS};
use super::worn_bodies::ProfileWear;
use crate::contact::fields::{FieldRow, Fields, Number, number, row};
use crate::contact::patch::fields::PatchFields;
use crate::friction::memory::Memory;
use serde::{Deserialize, Serialize, Serializer};

/// Fields of all windows at one instant.
#[derive(Debug, Clone, Deserialize)]
#[serde(try_from = "Saved")]
pub struct SurfaceFields {
    /// Fields of the windows; those of a window that is not used have no meaning.
    pub windows: [PatchFields; WINDOWS],
    /// Places of the windows; `None` of one that is not used.
    pub places: [Option<Place>; WINDOWS],
    /// Whether contacts in windows of their own are close to each other, as [`super::apart`] takes them: kept, as derivatives go by what the step went by.
    pub are_close: bool,
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
    /// Wear of both profiles.
    pub worn: ProfileWear,
}

impl SurfaceFields {
    /// Fields of a cold, unworn rail without contact; the wheel's temperature is 0 K.
    pub fn new(operators: &SurfaceOperators) -> SurfaceFields {
        SurfaceFields {
            windows: std::array::from_fn(|_| PatchFields::new(&operators.shapes[0])),
            places: [None; WINDOWS],
            are_close: false,
            approach: vec![0.0],
            touch: 0.0,
            stiffness: 0.0,
            load: 0.0,
            wheel_temperature: 0.0,
            worn: ProfileWear::new(operators),
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

impl PartialEq for SurfaceFields {
    fn eq(&self, other: &SurfaceFields) -> bool {
        self.places == other.places
            && self.are_close == other.are_close
            && self.approach == other.approach
            && self.worn == other.worn
            && [self.touch, self.stiffness, self.load, self.wheel_temperature]
                == [other.touch, other.stiffness, other.load, other.wheel_temperature]
            && self
                .used()
                .all(|(window, _)| self.windows[window] == other.windows[window])
    }
}

/// Fields as they are saved: with the windows that are used, or one without content for the sizes.
#[derive(Serialize, Deserialize)]
struct Saved {
    places: [Option<Place>; WINDOWS],
    are_close: bool,
    windows: Vec<PatchFields>,
    approach: Vec<f64>,
    touch: f64,
    stiffness: f64,
    load: f64,
    wheel_temperature: f64,
    worn: ProfileWear,
}

impl Serialize for SurfaceFields {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let used = self.used().map(|(window, _)| self.windows[window].clone());
        let mut windows: Vec<PatchFields> = used.collect();
        if windows.is_empty() {
            windows.push(self.windows[0].untouched());
        }
        let saved = Saved {
            places: self.places,
            are_close: self.are_close,
            windows,
            approach: self.approach.clone(),
            touch: self.touch,
            stiffness: self.stiffness,
            load: self.load,
            wheel_temperature: self.wheel_temperature,
            worn: self.worn.clone(),
        };
        saved.serialize(serializer)
    }
}

impl TryFrom<Saved> for SurfaceFields {
    type Error = &'static str;

    fn try_from(saved: Saved) -> Result<SurfaceFields, &'static str> {
        let used = saved.places.iter().flatten().count();
        let first = saved.windows.first().ok_or("a state without windows")?;
        if saved.windows.len() != used.max(1) {
            return Err("a state with another number of windows than of places");
        }
        let untouched = first.untouched();
        let mut windows = saved.windows.into_iter();
        Ok(SurfaceFields {
            windows: saved.places.map(|place| {
                let own = place.and_then(|_| windows.next());
                own.unwrap_or_else(|| untouched.clone())
            }),
            places: saved.places,
            are_close: saved.are_close,
            approach: saved.approach,
            touch: saved.touch,
            stiffness: saved.stiffness,
            load: saved.load,
            wheel_temperature: saved.wheel_temperature,
            worn: saved.worn,
        })
    }
}

/// Rows that belong to no window: the approach and the wear of the profiles.
const COMMON: usize = 5;

/// Rows of the fields of the windows.
macro_rules! rows_of_windows {
    ($($window:literal)+) => {
        &[
            row!(Nonlinear, Extrapolated, approach),
            row!(Independent, Before, worn.depth[0]),
            row!(Independent, Before, worn.depth[1]),
            row!(Independent, Computed, worn.before[0]),
            row!(Independent, Computed, worn.before[1]),
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
                row!(Deep, Computed, windows[$window].heat.window),
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

    fn is_used(&self, row: usize) -> bool {
        // Those of all windows, then as many of each one.
        let rows = (Self::ROWS.len() - COMMON) / WINDOWS;
        row < COMMON || self.places[(row - COMMON) / rows].is_some()
    }

    fn copy_memories(&mut self, other: &SurfaceFields) {
        for (window, _) in other.used() {
            self.windows[window].memory.copy_from(&other.windows[window].memory);
        }
    }

    fn has_moved(&self, before: &SurfaceFields) -> bool {
        self.places != before.places
    }

    fn copy_places(&mut self, other: &SurfaceFields) {
        self.places = other.places;
        self.are_close = other.are_close;
    }

    fn has_valid_places(&self) -> bool {
        self.used()
            .all(|(_, place)| place.length < LENGTHS && place.breadth < BREADTHS)
    }
}
