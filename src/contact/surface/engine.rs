//! The contact of profiles as an [`Engine`]: the patch's parts of a step in each window.

use super::fields::SurfaceFields;
use super::mechanics;
use super::operators::SurfaceOperators;
use super::placement;
use super::plots;
use super::pressure;
use super::problem::SurfaceProblem;
use super::profile_wear;
use super::solvers::SurfaceSolvers;
use super::tangent::{self, SurfaceTangent};
use super::totals;
use super::windows::{EVERYWHERE, WINDOWS};
use crate::contact::engine::{Along, Direction, Engine, Linearised};
use crate::contact::fields::EngineState;
use crate::contact::integrals::Integrals;
use crate::contact::interface::Interface;
use crate::contact::memory;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::patch::{self, begin, heat_and_wear};
use crate::contact::profiles::{ContactNode, Profiles};
use crate::contact::rim::HeatedNode;
use crate::contact::work::Iterations;
use crate::error::Result;
use crate::geometry::unrolled::PlacedWheel;
use crate::mechanics::normal_tangential::TractionChange;
use crate::numerics::dense::add_multiple;
use crate::parameters::Parameters;
use crate::settings::{SensitivitySettings, Settings, SplitSettings};

/// Ratio of two changes of the interface vector below which iterations are plain: with contacts of different size the mechanics' errors are a large
/// part of the last changes.
const PLAIN_BELOW: f64 = 0.03;
/// Factor on a patch's tolerance of the tractions in the first sweep: the vertical force of the friction, which the pressure of the next one carries, is a
/// guess as well.
const FIRST_SLACK: f64 = 100.0;
/// Least change of the interface, in tolerances, that the next sweep is taken to make. The mechanics are solved to a part of it. Solved to a part of the last change, which
/// is larger, they left errors of their own that took two more sweeps.
const LEAST_SEEN_CHANGE: f64 = 20.0;

/// Fields before the step at the places of its windows.
fn at_places<'a>(moved: bool, carried: &'a SurfaceFields, before: &'a SurfaceFields) -> &'a SurfaceFields {
    if moved { carried } else { before }
}

/// Begins a step in the windows, which stand at their places.
fn begin_windows(
    problem: &SurfaceProblem,
    before: Option<&SurfaceFields>,
    now: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
) -> Result<()> {
    let SurfaceSolvers {
        windows,
        before: carried,
        moved,
        responded,
        followed,
        compared,
        ..
    } = solvers;
    let before = before.map(|before| at_places(*moved, carried, before));
    (*responded, *followed) = (false, false);
    // The windows of an initial state have been placed for its own pressure.
    *compared = before.is_none();
    // The work of a window that is used no longer is not of this step.
    for own in windows.iter_mut() {
        own.patch.start_step();
    }
    for (window, place) in now.used() {
        let (patch, own) = (problem.of(&place), &mut now.windows[window]);
        own.relaxation_length = begin::relaxation_length_of(&patch, &problem.operators.pair, &own.pressure);
        let before = before.map(|before| &before.windows[window]);
        // A window that is alone keeps these zeros; several windows are displaced by each other before their friction is solved.
        windows[window]
            .patch
            .beside
            .iter_mut()
            .for_each(|component| component.fill(0.0));
        begin::begin(&patch, before, own, &mut windows[window].patch)?;
    }
    Ok(())
}

impl Engine for SurfaceOperators {
    type Fields = SurfaceFields;
    type Solvers = SurfaceSolvers;
    type Tangent = SurfaceTangent;

    fn fields(&self) -> SurfaceFields {
        SurfaceFields::new(self)
    }

    fn solvers(&self, settings: &Settings) -> SurfaceSolvers {
        SurfaceSolvers::new(self, settings)
    }

    fn tangent(&self, settings: &Settings) -> SurfaceTangent {
        SurfaceTangent::new(self, settings)
    }

    fn interface(&self) -> Interface {
        let grid = &self.sizes.largest;
        Interface::of_windows(WINDOWS, grid.strips * grid.cells)
    }

    fn split_settings(settings: &Settings) -> SplitSettings {
        SplitSettings {
            // The load is found to this by the height of the wheel.
            mechanics_alone_tolerance: settings.patch_split().mechanics_alone_tolerance.max(1e-9),
            plain_below: PLAIN_BELOW,
            first_mechanics_tolerance: FIRST_SLACK * settings.patch.first_mechanics_tolerance,
            least_seen_change: LEAST_SEEN_CHANGE,
            ..settings.patch_split()
        }
    }

    fn sensitivity_settings(settings: &Settings) -> SensitivitySettings {
        settings.patch_sensitivity()
    }

    fn window_length(&self) -> f64 {
        self.shapes[0].window_length()
    }

    fn spacing(&self) -> f64 {
        self.shapes[0].spacing()
    }

    fn displacement_scale(&self) -> f64 {
        self.shapes[0].displacement_scale()
    }

    fn pressure_scale(&self) -> f64 {
        self.shapes[0].pressure_scale()
    }

    /// Force on a cell of the largest window: nodes of other windows count by their area.
    fn unit_force(&self, parameters: &Parameters) -> f64 {
        Engine::unit_force(&self.shapes[0], parameters)
    }

    fn diagonal_displacement(&self, parameters: &Parameters) -> f64 {
        self.shapes[0].diagonal_displacement(parameters)
    }

    fn relaxation_length(problem: &SurfaceProblem, _fields: &SurfaceFields) -> f64 {
        problem.operators.shapes[0].relaxation_length
    }

    fn touches(fields: &SurfaceFields) -> bool {
        fields
            .used()
            .any(|(window, _)| fields.windows[window].pressure.iter().any(|&pressure| pressure > 0.0))
    }

    fn carried_load(problem: &SurfaceProblem, fields: &SurfaceFields) -> f64 {
        if problem.is_height_given() {
            fields.load
        } else {
            problem.vertical_load()
        }
    }

    fn wheel_temperature(fields: &SurfaceFields) -> f64 {
        fields.wheel_temperature
    }

    fn set_wheel_temperature(fields: &mut SurfaceFields, temperature: f64) {
        fields.wheel_temperature = temperature;
        for window in &mut fields.windows {
            window.wheel_temperature = temperature;
        }
    }

    fn begin(
        problem: &SurfaceProblem,
        before: Option<&SurfaceFields>,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) -> Result<()> {
        if solvers.worn_after.has(&now.worn.depth) {
            std::mem::swap(&mut solvers.worn, &mut solvers.worn_after);
        } else {
            solvers.worn.set(problem.operators, &now.worn.depth)?;
        }
        now.worn.begin();
        solvers.worn_off = None;
        placement::place(problem, before, None, now, solvers)?;
        begin_windows(problem, before, now, solvers)?;
        if before.is_none()
            && solvers.found.is_empty()
            && let Some(approach) = pressure::approach_of_pressure(problem, now, solvers)
            // A negligible load may be carried at the height of the first touch already, which is known to a few nanometres: the first windows are as good.
            && approach > 0.0
        {
            placement::place(problem, before, Some(approach), now, solvers)?;
            begin_windows(problem, before, now, solvers)?;
        }
        Ok(())
    }

    fn extrapolate(
        state: &EngineState<SurfaceFields>,
        ahead: f64,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) {
        if !solvers.moved {
            state.extrapolate(ahead, now);
        }
    }

    fn limit_guess(before: &SurfaceFields, now: &mut SurfaceFields) {
        if now.places == before.places {
            for (window, _) in now.used() {
                PatchOperators::limit_guess(&before.windows[window], &mut now.windows[window]);
            }
        }
    }

    fn read(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &mut SurfaceSolvers, interface: &mut Interface) {
        interface.clear_windows(fields.wheel_temperature);
        for (window, place) in fields.used() {
            let own = &mut solvers.windows[window];
            heat_and_wear::read(
                &problem.of(&place),
                &fields.windows[window],
                &mut own.patch,
                &mut own.image,
            );
            own.image.put_window(interface, window);
        }
    }

    fn solve_mechanics(
        problem: &SurfaceProblem,
        interface: &Interface,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
        tolerance: f64,
    ) -> Result<TractionChange> {
        mechanics::solve(problem, interface, now, solvers, tolerance)
    }

    fn mechanics_work(solvers: &SurfaceSolvers) -> u64 {
        solvers
            .windows
            .iter()
            .map(|own| PatchOperators::mechanics_work(&own.patch))
            .sum()
    }

    fn iterations(solvers: &SurfaceSolvers) -> Iterations {
        let mut sum = Iterations::default();
        for own in &solvers.windows {
            let iterations = PatchOperators::iterations(&own.patch);
            sum.newton += iterations.newton;
            sum.krylov += iterations.krylov;
            sum.inversions += iterations.inversions;
            sum.gradients += iterations.gradients;
        }
        sum
    }

    fn sweep_work(&self) -> u64 {
        self.shapes[0].sweep_work()
    }

    fn set_surface_temperature(&self, interface: &Interface, now: &mut SurfaceFields) {
        let mut rises = interface.temperatures();
        for window in &mut now.windows {
            for (temperature, rise) in window.heat.surface.iter_mut().zip(&mut rises) {
                *temperature = rise;
            }
        }
    }

    fn march_wear(
        problem: &SurfaceProblem,
        before: &SurfaceFields,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) {
        let before = at_places(solvers.moved, &solvers.before, before);
        for (window, place) in now.used() {
            let own = &mut solvers.windows[window].patch;
            heat_and_wear::march_wear(
                &problem.of(&place),
                &before.windows[window],
                &mut now.windows[window],
                own,
            );
        }
    }

    fn march_heat(
        problem: &SurfaceProblem,
        _before: &SurfaceFields,
        wheel_rise: f64,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) -> Result<()> {
        for (window, place) in now.used() {
            let own = &mut solvers.windows[window].patch;
            heat_and_wear::march_heat(&problem.of(&place), wheel_rise, &mut now.windows[window], own)?;
        }
        Ok(())
    }

    fn update_wear_compliance(problem: &SurfaceProblem, now: &SurfaceFields, solvers: &mut SurfaceSolvers) {
        for (window, place) in now.used() {
            let own = &mut solvers.windows[window].patch;
            heat_and_wear::update_wear_compliance(&problem.of(&place), &now.windows[window], own);
        }
    }

    fn end_memory(problem: &SurfaceProblem, now: &mut SurfaceFields) {
        for (window, place) in now.used() {
            memory::end(&problem.of(&place), &mut now.windows[window]);
        }
    }

    fn finalise_friction(problem: &SurfaceProblem, now: &mut SurfaceFields, solvers: &SurfaceSolvers) {
        for (window, place) in now.used() {
            let contact = &solvers.windows[window].patch.contact;
            heat_and_wear::finalise_friction(&problem.of(&place), &mut now.windows[window], contact);
        }
    }

    fn finalise_displacement(
        problem: &SurfaceProblem,
        _interface: &Interface,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) {
        for (window, place) in now.used() {
            let own = &mut solvers.windows[window].patch;
            patch::mechanics::finalise_displacement(&problem.of(&place), &mut now.windows[window], own);
        }
    }

    fn finalise(
        problem: &SurfaceProblem,
        before: &SurfaceFields,
        now: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
    ) -> Result<()> {
        let before = at_places(solvers.moved, &solvers.before, before);
        for (window, place) in now.used() {
            let own = &mut solvers.windows[window].patch;
            PatchOperators::finalise(
                &problem.of(&place),
                &before.windows[window],
                &mut now.windows[window],
                own,
            )?;
        }
        solvers.worn_off = Some(profile_wear::wear(problem, solvers.worn.of(problem.operators), now));
        // A surface that folds is found by the step that folds it: the state before can still be stepped.
        solvers.worn_after.set(problem.operators, &now.worn.depth)
    }

    fn is_cut_off(problem: &SurfaceProblem, now: &SurfaceFields, solvers: &SurfaceSolvers) -> bool {
        now.used().any(|(window, place)| {
            let own = &solvers.windows[window].patch;
            PatchOperators::is_cut_off(&problem.of(&place), &now.windows[window], own)
        })
    }

    fn heated_nodes<'f>(
        problem: &'f SurfaceProblem,
        fields: &'f SurfaceFields,
        values: &'f SurfaceFields,
    ) -> impl Iterator<Item = HeatedNode> + 'f {
        let operators = problem.operators;
        fields.used().flat_map(move |(window, place)| {
            let grid = &operators.of(&place).grid;
            // Tractions count by the area of their cells.
            let area = grid.cell_area() / operators.sizes.largest.cell_area();
            let (fields, values) = (&fields.windows[window], &values.windows[window]);
            (0..grid.strips).flat_map(move |strip| {
                let heated = grid
                    .row(strip)
                    .enumerate()
                    .filter(|(_, place)| fields.pressure[*place] > 0.0);
                heated.map(move |(cell, place)| HeatedNode {
                    pressure: area * values.pressure[place],
                    shear: [area * values.shear[0][place], area * values.shear[1][place]],
                    slip: [values.slip[0][place], values.slip[1][place]],
                    rise: values.heat.surface[strip * grid.cells + cell],
                })
            })
        })
    }

    fn begin_linearisation(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &mut SurfaceSolvers) {
        let (operators, pose) = (problem.operators, problem.pose());
        solvers.worn_off = None;
        // Depths that fold a surface have been refused by the step; `linearise` would refuse them again.
        let _ = solvers.worn.set(operators, &fields.worn.before);
        let bodies = solvers.worn.of(operators);
        let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(problem.height(fields)));
        let apart = &mut solvers.apart;
        apart.begin(operators, fields);
        for (window, place) in fields.used() {
            let own = &mut solvers.windows[window];
            own.prepare(place.length);
            let undeformed = &mut own.patch.undeformed;
            own.geometry.set(
                operators,
                (&bodies.rail, &wheel),
                &place,
                &pose.motion,
                EVERYWHERE,
                undeformed,
            );
            add_multiple(&apart.displacement[window][0], 1.0, &mut undeformed.gap);
            begin::begin_linearisation(&problem.of(&place), &fields.windows[window], &mut own.patch);
        }
    }

    fn linearise(
        problem: &SurfaceProblem,
        interface: &Interface,
        fields: &mut SurfaceFields,
        solvers: &mut SurfaceSolvers,
        tangent: &mut SurfaceTangent,
    ) -> Result<()> {
        tangent.linearise(problem, interface, fields, solvers)
    }

    fn begin_direction(
        problem: &SurfaceProblem,
        fields: &SurfaceFields,
        direction: &Direction,
        change: &mut SurfaceFields,
        tangent: &mut SurfaceTangent,
    ) {
        tangent.begin(problem, fields, direction, change);
    }

    fn mechanics_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut SurfaceFields) -> Result<()> {
        tangent::tractions(at, along, change)
    }

    fn march_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut SurfaceFields) -> Result<()> {
        tangent::march(at, along, change)
    }

    fn finalise_tangent(at: &mut Linearised<Self>, direction: &Direction, change: &mut SurfaceFields) {
        tangent::finalise(at, direction, change);
    }

    fn integrals(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &SurfaceSolvers) -> Integrals {
        totals::integrals(problem, fields, solvers)
    }

    fn profile_change(solvers: &SurfaceSolvers) -> f64 {
        solvers.worn_off.map_or(0.0, |worn| worn.change)
    }

    fn is_crowded(solvers: &SurfaceSolvers) -> bool {
        solvers.crowded
    }

    fn profiles(problem: &SurfaceProblem, fields: &SurfaceFields) -> Profiles {
        plots::profiles(problem, fields)
    }

    fn contact_nodes(problem: &SurfaceProblem, fields: &SurfaceFields) -> Vec<ContactNode> {
        plots::contact_nodes(problem, fields)
    }
}
