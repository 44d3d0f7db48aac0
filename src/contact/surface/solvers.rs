//! Solvers and buffers of a step of a contact of profiles, made once, so that a step allocates nothing.

use super::apart::{ByPressure, ByShear};
use super::contacts::{CONTACTS, Wanted};
use super::fields::SurfaceFields;
use super::geometry::WindowGeometry;
use super::operators::SurfaceOperators;
use super::seams::{CUTS, CutOff};
use super::search::Search;
use super::transfer::Transfer;
use super::windows::{EVERYWHERE, LENGTHS, WINDOWS};
use super::worn_bodies::{WornBodies, WornOff};
use crate::contact::interface::Interface;
use crate::contact::patch::solvers::PatchSolvers;
use crate::heat::strips::StripHeatScratch;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::normal::response::PressureResponse;
use crate::settings::Settings;
use crate::wear::strips::StripWearSteps;

/// Solvers and buffers of a step.
pub struct SurfaceSolvers {
    /// Solvers of the windows.
    pub windows: Vec<WindowSolvers>,
    /// Bodies as they are at the beginning of the step.
    pub worn: WornBodies,
    /// Wheel and rail as the step leaves them, with which the next one begins.
    pub worn_after: WornBodies,
    /// Wear of the profiles by the step, once its fields are final; none before, and in a linearisation, which looks at other fields.
    pub worn_off: Option<WornOff>,
    /// Search of contacts.
    pub search: Search,
    /// Transfer of the fields between places.
    pub transfer: Transfer,
    /// Fields before the step at the places of this one; used where these have changed.
    pub before: SurfaceFields,
    /// Whether places have changed with this step.
    pub moved: bool,
    /// Influence of the windows' pressures on one another.
    pub apart: ByPressure,
    /// Influence of the windows' responses on one another.
    pub apart_response: ByPressure,
    /// Influence of the windows' shear on one another.
    pub apart_shear: ByShear,
    /// Whether the responses of the windows' pressures to the approach have been found in this step.
    pub responded: bool,
    /// Whether friction has been solved for in this step: shear and coefficient are of one temperature then, that of the iteration before.
    pub followed: bool,
    /// Regions to place windows for.
    pub wanted: Vec<Wanted>,
    /// Regions of the contacts in the pressure that a try of this step has found, for which the next try places its windows. None in a first try, and after windows have
    /// pushed each other's contacts away: windows are placed for the pressure of the step before then.
    pub found: Vec<Wanted>,
    /// Whether this try has compared its windows with the pressure found in them.
    pub compared: bool,
    /// Number of times in this step that windows that held their contacts have been placed anew.
    pub replaced: usize,
    /// Arc lengths between which each window has the surface to itself, `m`; infinite where there is no other one.
    pub own: [[f64; 2]; WINDOWS],
    /// Approach for which the geometry is that of the windows, `m`.
    pub reference: f64,
    /// Approach at which a contact has outgrown its window in this step, `m`.
    pub outgrown: f64,
    /// Room for contacts, as in the conditions, in the first try with the seams there are now. Contacts that have pushed each other away since get the room of the conditions over this one.
    pub room_before: f64,
    /// Contacts that have been cut off at the seams between windows in this step.
    pub cut_off: Vec<CutOff>,
    /// Whether contacts of different windows have pushed each other away by turns in this step.
    pub is_unsettled: bool,
    /// Whether there are more contacts than windows.
    pub crowded: bool,
}

/// Solvers and buffers of one window.
pub struct WindowSolvers {
    /// Solvers of a patch.
    pub patch: PatchSolvers,
    /// Buffers that depend on the length of the window, by its number; the one in use is in `patch`.
    marches: Vec<March>,
    length: Option<usize>,
    /// View that the cells have of wheel and rail.
    pub geometry: WindowGeometry,
    /// Part of the interface vector of all windows that the tractions are solved for.
    pub interface: Interface,
    /// Part of one that is read off fields, or off a change of them.
    pub image: Interface,
    /// Cells under pressure before a sweep.
    pub contact_before: Contact,
    /// Pressure before a sweep, on the grid, scaled.
    pub pressure_before: Vec<f64>,
    /// Vertical force of the friction on the wheel over that of the pressure.
    pub friction_share: f64,
    /// Response of the pressure to the approach, scaled.
    pub response: PressureResponse,
    /// Opening of the gap at the reference approach, on the grid, scaled.
    pub gap: Vec<f64>,
}

/// Buffers of the marches through a window of one length.
struct March {
    heat: StripHeatScratch,
    wear: StripWearSteps,
}

impl SurfaceSolvers {
    /// Solvers for the given operators.
    pub fn new(operators: &SurfaceOperators, settings: &Settings) -> SurfaceSolvers {
        SurfaceSolvers {
            windows: (0..WINDOWS).map(|_| WindowSolvers::new(operators, settings)).collect(),
            worn: WornBodies::new(operators),
            worn_after: WornBodies::new(operators),
            worn_off: None,
            search: Search::new(&operators.bodies),
            transfer: Transfer::new(operators),
            before: SurfaceFields::new(operators),
            moved: false,
            apart: ByPressure::new(operators),
            apart_response: ByPressure::new(operators),
            apart_shear: ByShear::new(operators),
            responded: false,
            followed: false,
            wanted: Vec::with_capacity(CONTACTS),
            found: Vec::with_capacity(CONTACTS),
            compared: false,
            replaced: 0,
            own: [EVERYWHERE; WINDOWS],
            reference: 0.0,
            outgrown: 0.0,
            room_before: 1.0,
            cut_off: Vec::with_capacity(CUTS),
            is_unsettled: false,
            crowded: false,
        }
    }
}

impl WindowSolvers {
    fn new(operators: &SurfaceOperators, settings: &Settings) -> WindowSolvers {
        let shape = |length: usize| &operators.shapes[length * super::windows::BREADTHS];
        let first = shape(0);
        WindowSolvers {
            patch: PatchSolvers::new(first, settings),
            marches: (0..LENGTHS)
                .map(|length| March {
                    heat: StripHeatScratch::new(&shape(length).basis, &shape(length).strips),
                    wear: StripWearSteps::new(&shape(length).strips),
                })
                .collect(),
            length: None,
            geometry: WindowGeometry::new(operators),
            interface: Interface::new(first.grid.strips * first.grid.cells, 1),
            image: Interface::new(first.grid.strips * first.grid.cells, 1),
            contact_before: Contact::new(&first.grid),
            pressure_before: vec![0.0; first.grid.len()],
            friction_share: 0.0,
            response: PressureResponse::new(&first.grid),
            gap: vec![0.0; first.grid.len()],
        }
    }

    /// Prepares the solvers for a window of the given length, whose cells may be others than in the step before.
    pub fn prepare(&mut self, length: usize) {
        self.patch.weights = None;
        if self.length == Some(length) {
            return;
        }
        if let Some(before) = self.length {
            self.exchange(before);
        }
        self.exchange(length);
        self.length = Some(length);
    }

    fn exchange(&mut self, length: usize) {
        std::mem::swap(&mut self.patch.heat, &mut self.marches[length].heat);
        std::mem::swap(&mut self.patch.wear_steps, &mut self.marches[length].wear);
    }
}
