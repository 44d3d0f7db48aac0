//! The linearised step of a contact of profiles: each window as that of a patch, and the height of the wheel that keeps the load.
//!
//! A change of the wheelset's pose opens the gap of the cells and changes their rigid slip. At an unchanged height of the wheel each window
//! follows by itself, but for the displacement by the others; the change of the approach is then the one by which, with the response
//! of all windows to a unit of it, the vertical force changes as the load does.

use super::apart::{ByPressure, ByShear};
use super::fields::SurfaceFields;
use super::geometry::{Pose, WindowGeometry};
use super::operators::SurfaceOperators;
use super::problem::{SurfaceProblem, vertical_forces};
use super::search::Search;
use super::solvers::SurfaceSolvers;
use super::windows::{BREADTHS, LENGTHS, WINDOWS};
use super::worn_bodies::WornBodies;
use crate::contact::engine::{Along, Direction, Linearised};
use crate::contact::fields::Fields;
use crate::contact::interface::Interface;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::linearisation::Solution;
use crate::contact::patch::march_tangent;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::patch::tangent::PatchTangent;
use crate::error::{Error, Result};
use crate::geometry::unrolled::PlacedWheel;
use crate::heat::strips::StripHeatScratch;
use crate::mechanics::normal::normal_problem::Constraint;
use crate::numerics::dense::{add_multiple, largest};
use crate::settings::Settings;

/// Limit of the iterations on what the windows do to each other.
const ROUNDS: usize = 30;

/// Solvers and buffers of the linearised mechanics, heat and wear.
pub struct SurfaceTangent {
    windows: Vec<WindowTangent>,
    apart: ByPressure,
    apart_shear: ByShear,
    /// Change of the tractions with the approach, per displacement scale.
    unit: SurfaceFields,
    /// Change of the vertical force in it, `N`; 0 where the height is given.
    stiffness: f64,
    /// Bodies as they are at the beginning of the step.
    worn: WornBodies,
    /// Search of contacts at the position of the wheelset.
    search: Search,
    /// Change of the approach along the direction where the height is given, `m`.
    approach: f64,
    /// Interface vector without a change.
    nothing: Interface,
}

/// Solvers of a window.
struct WindowTangent {
    patch: PatchTangent,
    /// Heat marches by the length of the window; the one in use is in `patch`.
    marches: Vec<StripHeatScratch>,
    length: Option<usize>,
    geometry: WindowGeometry,
    /// Change of the gap along the direction, without what the others do, on the grid, scaled.
    gap: Vec<f64>,
    interface: Interface,
}

impl WindowTangent {
    fn prepare(&mut self, length: usize) {
        if self.length == Some(length) {
            return;
        }
        if let Some(before) = self.length {
            std::mem::swap(&mut self.patch.heat, &mut self.marches[before]);
        }
        std::mem::swap(&mut self.patch.heat, &mut self.marches[length]);
        self.length = Some(length);
    }
}

impl SurfaceTangent {
    /// Solvers for the given operators.
    pub fn new(operators: &SurfaceOperators, settings: &Settings) -> SurfaceTangent {
        let shape = |length: usize| &operators.shapes[length * BREADTHS];
        let grid = operators.sizes.largest;
        let interface = Interface::new(grid.strips * grid.cells, 1);
        let window = |_| WindowTangent {
            patch: PatchTangent::new(shape(0), settings),
            marches: (0..LENGTHS)
                .map(|length| StripHeatScratch::new(&shape(length).basis, &shape(length).strips))
                .collect(),
            length: None,
            geometry: WindowGeometry::new(operators),
            gap: vec![0.0; grid.len()],
            interface: interface.clone(),
        };
        SurfaceTangent {
            windows: (0..WINDOWS).map(window).collect(),
            apart: ByPressure::new(operators),
            apart_shear: ByShear::new(operators),
            unit: SurfaceFields::new(operators),
            stiffness: 0.0,
            worn: WornBodies::new(operators),
            search: Search::new(&operators.bodies),
            approach: 0.0,
            nothing: Interface::of_windows(WINDOWS, grid.strips * grid.cells),
        }
    }

    /// Linearises at the fields that were solved for the interface vector, and finds the response to a unit of the approach.
    ///
    /// # Errors
    /// [`Error::SingularContactMatrix`], a linear system that cannot be solved.
    pub fn linearise(
        &mut self,
        problem: &SurfaceProblem,
        interface: &Interface,
        fields: &SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) -> Result<()> {
        self.worn.set(problem.operators, &fields.worn.before)?;
        for (window, place) in fields.used() {
            let (own, from) = (&mut self.windows[window], &mut solvers.windows[window]);
            own.prepare(place.length);
            own.geometry.copy_from(&from.geometry);
            from.interface.take_window(interface, window);
            if touches(&fields.windows[window]) {
                let solution = Solution {
                    interface: &from.interface,
                    fields: &fields.windows[window],
                    solvers: &from.patch,
                };
                own.patch.linearise(&problem.of(&place), solution)?;
            }
        }
        self.stiffness = 0.0;
        let bodies = self.worn.of(problem.operators);
        self.search.touch(bodies, &problem.pose().position, fields.touch);
        if problem.is_height_given() {
            return Ok(());
        }
        self.unit.clear();
        self.unit.copy_places(fields);
        let (pose, operators) = (problem.pose(), problem.operators);
        let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(problem.height(fields)));
        let lowered = Pose::lowered(operators.shapes[0].scales.displacement);
        for (window, place) in fields.used() {
            let own = &mut self.windows[window];
            let undeformed = &mut own.patch.undeformed;
            own.geometry
                .set_change(operators, &place, &wheel, (&pose, &lowered), undeformed);
            own.gap.copy_from_slice(&undeformed.gap);
        }
        let tolerance =
            <SurfaceOperators as crate::contact::engine::Engine>::sensitivity_settings(problem.settings).tolerance;
        let mut parts = Parts {
            problem,
            fields,
            solvers,
            windows: &mut self.windows,
            apart: &mut self.apart,
            apart_shear: &mut self.apart_shear,
            tolerance,
        };
        let along = Along {
            direction: &Direction::NONE,
            interface: &self.nothing,
        };
        parts.at_height(&along, &mut self.unit)?;
        self.stiffness = vertical_force(problem.operators, pose.vertical(), &self.worn, &self.unit);
        Ok(())
    }

    /// Sets the change of gap and rigid slip along a direction, and begins the marches of the heat.
    pub fn begin(
        &mut self,
        problem: &SurfaceProblem,
        fields: &SurfaceFields,
        direction: &Direction,
        change: &mut SurfaceFields,
    ) {
        change.clear();
        change.copy_places(fields);
        let operators = problem.operators;
        let pose = problem.pose();
        let mut moved = pose.change(operators, &problem.conditions.inputs, &direction.inputs);
        let height = moved.position.height;
        moved.position.height = 0.0;
        let touching = pose.at_height(fields.touch);
        let bodies = self.worn.of(operators);
        let touch = self.search.touch_change(bodies, &touching, &moved.position);
        // What the inputs say of the height counts where it is given. Under a load the wheel first follows the rail, at an unchanged approach.
        moved.position.height = if problem.is_height_given() { height } else { touch };
        self.approach = touch - moved.position.height;
        change.touch = touch;
        let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(problem.height(fields)));
        for (window, place) in fields.used() {
            let own = &mut self.windows[window];
            own.prepare(place.length);
            let undeformed = &mut own.patch.undeformed;
            own.geometry
                .set_change(operators, &place, &wheel, (&pose, &moved), undeformed);
            own.gap.copy_from_slice(&undeformed.gap);
            let (fields, change) = (&fields.windows[window], &mut change.windows[window]);
            march_tangent::begin(&problem.of(&place), fields, direction, change, &mut own.patch);
        }
    }
}

/// Whether anything in a window is under pressure.
fn touches(fields: &PatchFields) -> bool {
    fields.pressure.iter().any(|&pressure| pressure > 0.0)
}

/// Force of all windows along the track's vertical, given in the rail's axes, or its change, `N`.
fn vertical_force(operators: &SurfaceOperators, vertical: [f64; 2], worn: &WornBodies, fields: &SurfaceFields) -> f64 {
    let rail = &worn.of(operators).rail;
    let forces = fields.used().map(|(window, place)| {
        let point = |strip: usize| rail.at(place.arc(&operators.of(&place).grid, strip));
        vertical_forces(operators, vertical, point, &place, &fields.windows[window])
    });
    forces.map(|[normal, friction]| normal + friction).sum()
}

/// Takes each window's own problem as that of a patch, by its number and with a buffer for its part of a change of the interface vector.
fn each_window(
    at: &mut Linearised<SurfaceOperators>,
    change: &mut SurfaceFields,
    mut run: impl FnMut(&mut Linearised<PatchOperators>, usize, &mut Interface, &mut PatchFields),
) {
    for (window, place) in at.fields.used() {
        let own = &mut at.tangent.windows[window];
        let from = &mut at.solvers.windows[window];
        let mut patch = Linearised {
            problem: &at.problem.of(&place),
            interface: &from.interface,
            touches: touches(&at.fields.windows[window]),
            fields: &mut at.fields.windows[window],
            solvers: &mut from.patch,
            tangent: &mut own.patch,
            tolerance: at.tolerance,
        };
        run(&mut patch, window, &mut own.interface, &mut change.windows[window]);
    }
}

/// Change of wear and heat along a direction and a change of the interface vector.
///
/// # Errors
/// A linear system that cannot be solved.
pub fn march(at: &mut Linearised<SurfaceOperators>, along: &Along, change: &mut SurfaceFields) -> Result<()> {
    let mut result = Ok(());
    each_window(at, change, |at, window, interface, change| {
        interface.take_window(along.interface, window);
        let along = Along {
            direction: along.direction,
            interface,
        };
        march_tangent::wear(at, along.direction, change);
        if result.is_ok() {
            result = march_tangent::heat(at, &along, change);
        }
    });
    result
}

/// Change of the heat under the surface and of the rail behind the windows.
pub fn finalise(at: &mut Linearised<SurfaceOperators>, direction: &Direction, change: &mut SurfaceFields) {
    each_window(at, change, |at, _, _, change| {
        march_tangent::finalise(at, direction, change);
    });
}

/// Change of the tractions along a direction, with the height of the wheel that keeps the load.
///
/// # Errors
/// A linear system that cannot be solved.
pub fn tractions(at: &mut Linearised<SurfaceOperators>, along: &Along, change: &mut SurfaceFields) -> Result<()> {
    let problem = at.problem;
    let SurfaceTangent {
        windows,
        apart,
        apart_shear,
        unit,
        stiffness,
        approach,
        worn,
        ..
    } = &mut *at.tangent;
    let scale = problem.operators.shapes[0].scales.displacement;
    // The first guess is the change at an unchanged height: what the height has added is taken off again.
    if !problem.is_height_given() {
        add(unit, -change.approach[0] / scale, change);
        change.approach[0] = 0.0;
    }
    let mut parts = Parts {
        problem,
        fields: at.fields,
        solvers: at.solvers,
        windows,
        apart,
        apart_shear,
        tolerance: at.tolerance,
    };
    parts.at_height(along, change)?;
    let (pose, operators) = (problem.pose(), problem.operators);
    let turned = pose.vertical_change(operators.side * along.direction.inputs.rail_roll_angle);
    let force =
        vertical_force(operators, pose.vertical(), worn, change) + vertical_force(operators, turned, worn, at.fields);
    if problem.is_height_given() {
        change.load = force;
        change.approach[0] = *approach;
        return Ok(());
    }
    // A contact whose load does not grow as the wheel is lowered has no height for a load.
    if stiffness.is_nan() || *stiffness <= 0.0 {
        return Err(Error::SingularContactMatrix {
            matrix: "height of the wheel",
            unknowns: 1,
        });
    }
    change.load = along.direction.inputs.normal_load;
    let units = (change.load - force) / *stiffness;
    add(unit, units, change);
    change.approach[0] = units * scale;
    Ok(())
}

/// Adds a multiple of a change of the tractions to another.
fn add(unit: &SurfaceFields, factor: f64, change: &mut SurfaceFields) {
    if factor == 0.0 {
        return;
    }
    for (window, _) in unit.used() {
        let (from, to) = (&unit.windows[window], &mut change.windows[window]);
        add_multiple(&from.pressure, factor, &mut to.pressure);
        add_multiple(&from.friction, factor, &mut to.friction);
        for component in 0..2 {
            add_multiple(&from.shear[component], factor, &mut to.shear[component]);
            add_multiple(&from.slip[component], factor, &mut to.slip[component]);
        }
    }
}

/// Parts that a change of the tractions of all windows is made of.
struct Parts<'a> {
    problem: &'a SurfaceProblem<'a>,
    fields: &'a SurfaceFields,
    solvers: &'a SurfaceSolvers,
    windows: &'a mut [WindowTangent],
    apart: &'a mut ByPressure,
    apart_shear: &'a mut ByShear,
    tolerance: f64,
}

impl Parts<'_> {
    /// Change of the tractions at an unchanged height of the wheel, with what the windows do to each other.
    fn at_height(&mut self, along: &Along, change: &mut SurfaceFields) -> Result<()> {
        let operators = self.problem.operators;
        self.apart.set_resultants(operators, change);
        self.apart_shear.set_resultants(operators, change);
        for round in 0..ROUNDS {
            let (mut left, mut size) = (0.0_f64, f64::MIN_POSITIVE);
            for (window, place) in self.fields.used() {
                left = left
                    .max(self.apart.displace(operators, window, &place))
                    .max(self.apart_shear.displace(operators, window, &place));
                self.follow(window, along, change)?;
                self.apart.take_for_others(operators, change, window, &place);
                self.apart_shear.take_for_others(operators, change, window, &place);
                size = size.max(largest(&self.windows[window].gap));
                for displaced in self.apart.displacement[window]
                    .iter()
                    .chain(&self.apart_shear.displacement[window])
                {
                    size = size.max(largest(displaced));
                }
            }
            // Of one contact nothing comes back.
            if left <= self.tolerance * size && (round > 0 || !self.apart.is_coupled()) {
                break;
            }
        }
        Ok(())
    }

    /// Change of the tractions of a window that the others displace as they were found to.
    fn follow(&mut self, window: usize, along: &Along, change: &mut SurfaceFields) -> Result<()> {
        let (own, from, fields) = (
            &mut self.windows[window],
            &self.solvers.windows[window],
            &self.fields.windows[window],
        );
        let Some(place) = self.fields.places[window].filter(|_| touches(fields)) else {
            return Ok(());
        };
        let gaps = own
            .patch
            .undeformed
            .gap
            .iter_mut()
            .zip(&own.gap)
            .zip(&self.apart.displacement[window][0]);
        for ((gap, own), displaced) in gaps {
            *gap = own + displaced;
        }
        let by_shear = &self.apart_shear.displacement[window];
        for (beside, by_shear) in own.patch.beside.iter_mut().zip(by_shear) {
            beside.copy_from_slice(by_shear);
        }
        own.interface.take_window(along.interface, window);
        let along = Along {
            direction: along.direction,
            interface: &own.interface,
        };
        let solution = Solution {
            interface: &from.interface,
            fields,
            solvers: &from.patch,
        };
        let (patch, tangent) = (self.problem.of(&place), &mut change.windows[window]);
        own.patch.tractions(
            &patch,
            solution,
            &along,
            Constraint::Penetration(0.0),
            tangent,
            self.tolerance,
        )
    }
}
