//! The patch as an [`Engine`].

use super::begin;
use super::extent;
use super::fields::PatchFields;
use super::heat_and_wear;
use super::integrals;
use super::linearisation::Solution;
use super::march_tangent;
use super::mechanics;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use super::profiles;
use super::solvers::PatchSolvers;
use super::tangent::PatchTangent;
use crate::body::half_space::HalfSpaces;
use crate::contact::engine::{Along, Direction, Engine, Linearised, MaterialPath, OneWindow};
use crate::contact::fields::Fields;
use crate::contact::integrals::Integrals;
use crate::contact::interface::Interface;
use crate::contact::memory;
use crate::contact::problem::Problem;
use crate::contact::profiles::{ContactNode, Profiles};
use crate::contact::rim::HeatedNode;
use crate::contact::work::Iterations;
use crate::error::Result;
use crate::friction::memory::Memory;
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::normal_tangential::TractionChange;
use crate::parameters::{Control, Parameters, PatchGeometry};
use crate::settings::{SensitivitySettings, Settings, SplitSettings};

impl Engine for PatchOperators {
    type Fields = PatchFields;
    type Solvers = PatchSolvers;
    type Tangent = PatchTangent;

    fn fields(&self) -> PatchFields {
        PatchFields::new(self)
    }

    fn solvers(&self, settings: &Settings) -> PatchSolvers {
        PatchSolvers::new(self, settings)
    }

    fn tangent(&self, settings: &Settings) -> PatchTangent {
        PatchTangent::new(self, settings)
    }

    fn interface(&self) -> Interface {
        Interface::new(self.grid.strips * self.grid.cells, 1)
    }

    fn split_settings(settings: &Settings) -> SplitSettings {
        settings.patch_split()
    }

    fn sensitivity_settings(settings: &Settings) -> SensitivitySettings {
        settings.patch_sensitivity()
    }

    fn window_length(&self) -> f64 {
        2.0 * self.grid.half_length()
    }

    fn spacing(&self) -> f64 {
        self.grid.length
    }

    fn displacement_scale(&self) -> f64 {
        self.scales.displacement
    }

    fn pressure_scale(&self) -> f64 {
        self.scales.pressure
    }

    fn unit_force(&self, _parameters: &Parameters) -> f64 {
        self.grid.cell_area() * self.scales.pressure
    }

    fn diagonal_displacement(&self, _parameters: &Parameters) -> f64 {
        self.scales.displacement * self.strip_kernels[0][self.grid.stride()]
    }

    /// Scales the relaxation length at the largest load by the ratio of the contact's lengths; of a contact of given geometry it is that of its extent.
    fn relaxation_length(problem: &PatchProblem, fields: &PatchFields) -> f64 {
        if problem.parameters.patch_geometry == PatchGeometry::Inputs {
            let pair = HalfSpaces::of_pair(problem.parameters);
            return begin::relaxation_length_of(problem, &pair, &fields.pressure);
        }
        let load = problem.load(fields);
        let ratio = (load / problem.parameters.largest_load).cbrt().min(1.0);
        problem.operators.relaxation_length * if load > 0.0 { ratio } else { 1.0 }
    }

    fn touches(fields: &PatchFields) -> bool {
        Self::pressure(fields).iter().any(|&pressure| pressure > 0.0)
    }

    fn carried_load(problem: &Problem<Self>, fields: &PatchFields) -> f64 {
        problem.unit_force() * Self::pressure(fields).iter().sum::<f64>()
    }

    fn wheel_temperature(fields: &PatchFields) -> f64 {
        fields.wheel_temperature
    }

    fn set_wheel_temperature(fields: &mut PatchFields, temperature: f64) {
        fields.wheel_temperature = temperature;
    }

    fn begin(
        problem: &PatchProblem,
        before: Option<&PatchFields>,
        now: &mut PatchFields,
        solvers: &mut PatchSolvers,
    ) -> Result<()> {
        if let Some(before) = before {
            now.relaxation_length = Self::relaxation_length(problem, before);
        }
        solvers
            .undeformed
            .set(problem, &problem.conditions.inputs, &problem.conditions.motion);
        begin::begin(problem, before, now, solvers)
    }

    /// Takes off the first guess the pressure of cells that were not under pressure before.
    fn limit_guess(before: &PatchFields, now: &mut PatchFields) {
        for (pressure, before) in now.pressure.iter_mut().zip(&before.pressure) {
            *pressure = if *before > 0.0 { pressure.max(0.0) } else { 0.0 };
        }
    }

    fn read(problem: &PatchProblem, fields: &PatchFields, solvers: &mut PatchSolvers, interface: &mut Interface) {
        heat_and_wear::read(problem, fields, solvers, interface);
    }

    fn solve_mechanics(
        problem: &PatchProblem,
        interface: &Interface,
        now: &mut PatchFields,
        solvers: &mut PatchSolvers,
        tolerance: f64,
    ) -> Result<TractionChange> {
        mechanics::solve(problem, interface, now, solvers, tolerance)
    }

    fn mechanics_work(solvers: &PatchSolvers) -> u64 {
        solvers.normal.work() + solvers.friction.work()
    }

    fn iterations(solvers: &PatchSolvers) -> Iterations {
        let [newton, krylov, inversions] = solvers.friction.iterations();
        Iterations {
            newton,
            krylov,
            inversions,
            gradients: solvers.normal.iterations(),
        }
    }

    /// Some ten operations a mode.
    fn sweep_work(&self) -> u64 {
        (10 * self.grid.strips * self.grid.cells * self.basis.len()) as u64
    }

    fn set_surface_temperature(&self, interface: &Interface, now: &mut PatchFields) {
        for (temperature, rise) in now.heat.surface.iter_mut().zip(interface.temperatures()) {
            *temperature = rise;
        }
    }

    fn march_wear(problem: &PatchProblem, before: &PatchFields, now: &mut PatchFields, solvers: &mut PatchSolvers) {
        heat_and_wear::march_wear(problem, before, now, solvers);
    }

    fn march_heat(
        problem: &PatchProblem,
        _before: &PatchFields,
        wheel_rise: f64,
        now: &mut PatchFields,
        solvers: &mut PatchSolvers,
    ) -> Result<()> {
        heat_and_wear::march_heat(problem, wheel_rise, now, solvers)
    }

    fn update_wear_compliance(problem: &PatchProblem, now: &PatchFields, solvers: &mut PatchSolvers) {
        heat_and_wear::update_wear_compliance(problem, now, solvers);
    }

    fn end_memory(problem: &Problem<Self>, now: &mut PatchFields) {
        memory::end(problem, now);
    }

    fn finalise_friction(problem: &PatchProblem, now: &mut PatchFields, solvers: &PatchSolvers) {
        heat_and_wear::finalise_friction(problem, now, &solvers.contact);
    }

    fn finalise_displacement(
        problem: &PatchProblem,
        _interface: &Interface,
        now: &mut PatchFields,
        solvers: &mut PatchSolvers,
    ) {
        mechanics::finalise_displacement(problem, now, solvers);
    }

    fn finalise(
        problem: &PatchProblem,
        before: &PatchFields,
        now: &mut PatchFields,
        solvers: &mut PatchSolvers,
    ) -> Result<()> {
        let breadth = problem.breadth(now);
        let (heat, wear) = (problem.heat_march(), problem.wear_march());
        heat.finalise(&before.heat, breadth, &mut now.heat, &mut solvers.heat)?;
        wear.finalise(breadth, &before.wear, &mut now.wear, &mut solvers.wear_steps);
        Ok(())
    }

    fn is_cut_off(problem: &PatchProblem, now: &PatchFields, solvers: &PatchSolvers) -> bool {
        let overlap = problem.settings.mechanics.overlap;
        let [along, across] = extent::is_cut_off(
            &problem.operators.grid,
            &now.pressure,
            &solvers.normal.separation,
            overlap,
        );
        along || across
    }

    fn heated_nodes<'f>(
        problem: &'f PatchProblem,
        fields: &'f PatchFields,
        values: &'f PatchFields,
    ) -> impl Iterator<Item = HeatedNode> + 'f {
        let grid = &problem.operators.grid;
        (0..grid.strips).flat_map(move |strip| {
            let cells = grid.row(strip).enumerate();
            let heated = cells.filter(|(_, place)| fields.pressure[*place] > 0.0);
            heated.map(move |(cell, place)| HeatedNode {
                pressure: values.pressure[place],
                shear: [values.shear[0][place], values.shear[1][place]],
                slip: [values.slip[0][place], values.slip[1][place]],
                rise: values.heat.surface[strip * grid.cells + cell],
            })
        })
    }

    fn begin_linearisation(problem: &PatchProblem, fields: &PatchFields, solvers: &mut PatchSolvers) {
        solvers
            .undeformed
            .set(problem, &problem.conditions.inputs, &problem.conditions.motion);
        begin::begin_linearisation(problem, fields, solvers);
    }

    fn linearise(
        problem: &PatchProblem,
        interface: &Interface,
        fields: &mut PatchFields,
        solvers: &mut PatchSolvers,
        tangent: &mut PatchTangent,
    ) -> Result<()> {
        let solution = Solution {
            interface,
            fields,
            solvers,
        };
        tangent.linearise(problem, solution)
    }

    fn begin_direction(
        problem: &PatchProblem,
        fields: &PatchFields,
        direction: &Direction,
        change: &mut PatchFields,
        tangent: &mut PatchTangent,
    ) {
        change.clear();
        tangent.undeformed.set(problem, &direction.inputs, &direction.motion);
        march_tangent::begin(problem, fields, direction, change, tangent);
    }

    fn mechanics_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut PatchFields) -> Result<()> {
        let solution = Solution {
            interface: at.interface,
            fields: &*at.fields,
            solvers: &*at.solvers,
        };
        let load = along.direction.inputs.normal_load / at.problem.unit_force();
        let constraint = match at.problem.constraint() {
            Constraint::Total(_) => Constraint::Total(load),
            Constraint::Penetration(_) if at.problem.parameters.control == Control::Height => Constraint::Penetration(
                along.direction.inputs.contact_penetration / at.problem.operators.scales.displacement,
            ),
            Constraint::Penetration(_) => Constraint::Penetration(0.0),
        };
        at.tangent
            .tractions(at.problem, solution, along, constraint, change, at.tolerance)
    }

    fn march_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut PatchFields) -> Result<()> {
        march_tangent::wear(at, along.direction, change);
        march_tangent::heat(at, along, change)
    }

    fn finalise_tangent(at: &mut Linearised<Self>, direction: &Direction, change: &mut PatchFields) {
        march_tangent::finalise(at, direction, change);
    }

    fn integrals(problem: &PatchProblem, fields: &PatchFields, _solvers: &Self::Solvers) -> Integrals {
        integrals::integrals(problem, fields)
    }

    fn profiles(problem: &PatchProblem, fields: &PatchFields) -> Profiles {
        let ambient = problem.conditions.inputs.ambient_temperature;
        // The mean of two strips where none lies in the middle.
        let strips = problem.operators.grid.strips;
        profiles::profiles(problem, fields, ambient, [(strips - 1) / 2, strips / 2])
    }

    fn contact_nodes(problem: &PatchProblem, fields: &PatchFields) -> Vec<ContactNode> {
        profiles::contact_nodes(problem.operators, fields)
    }
}

impl OneWindow for PatchOperators {
    fn paths(&self) -> impl Iterator<Item = MaterialPath> + '_ {
        let grid = &self.grid;
        (0..grid.strips).map(|strip| MaterialPath {
            nodes: strip * grid.cells..(strip + 1) * grid.cells,
            places: grid.row(strip),
        })
    }

    fn pressure(fields: &PatchFields) -> &[f64] {
        &fields.pressure
    }

    fn surface_rise<'f>(&self, fields: &'f PatchFields) -> &'f [f64] {
        &fields.heat.surface
    }

    fn memory(fields: &PatchFields) -> &Memory {
        &fields.memory
    }

    fn memory_mut(fields: &mut PatchFields) -> &mut Memory {
        &mut fields.memory
    }
}
