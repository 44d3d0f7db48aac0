//! The line as an [`Engine`].

use super::fields::LineFields;
use super::heat_and_wear;
use super::integrals;
use super::mechanics::{self, LineProblem};
use super::operators::LineOperators;
use super::profiles;
use super::solvers::LineSolvers;
use super::tangent::{self, LineTangent};
use crate::contact::engine::{Along, Direction, Engine, Linearised, MaterialPath, OneWindow};
use crate::contact::fields::Fields;
use crate::contact::integrals::Integrals;
use crate::contact::interface::Interface;
use crate::contact::memory;
use crate::contact::problem::Problem;
use crate::contact::profiles::{ContactNode, Profiles};
use crate::contact::rim::HeatedNode;
use crate::error::Result;
use crate::friction::memory::Memory;
use crate::mechanics::normal_tangential::TractionChange;
use crate::parameters::Parameters;
use crate::settings::{SensitivitySettings, Settings, SplitSettings};
use std::iter;

impl Engine for LineOperators {
    type Fields = LineFields;
    type Solvers = LineSolvers;
    type Tangent = LineTangent;

    fn fields(&self) -> LineFields {
        LineFields::new(self)
    }

    fn solvers(&self, settings: &Settings) -> LineSolvers {
        LineSolvers::new(self, settings)
    }

    fn tangent(&self, _settings: &Settings) -> LineTangent {
        LineTangent::new(self)
    }

    fn interface(&self) -> Interface {
        Interface::new(self.mesh.contact_nodes, 2)
    }

    fn split_settings(settings: &Settings) -> SplitSettings {
        settings.split
    }

    fn sensitivity_settings(settings: &Settings) -> SensitivitySettings {
        settings.sensitivity
    }

    fn window_length(&self) -> f64 {
        2.0 * self.mesh.window_half_width()
    }

    fn spacing(&self) -> f64 {
        self.mesh.contact_spacing()
    }

    fn displacement_scale(&self) -> f64 {
        self.scales.displacement
    }

    fn pressure_scale(&self) -> f64 {
        self.scales.pressure
    }

    fn unit_force(&self, parameters: &Parameters) -> f64 {
        self.node_area(parameters) * self.scales.pressure
    }

    fn diagonal_displacement(&self, parameters: &Parameters) -> f64 {
        self.near_field.direct * self.scales.displacement + parameters.layer_compliance * self.scales.pressure
    }

    fn relaxation_length(problem: &LineProblem, fields: &LineFields) -> f64 {
        let (load, relaxation) = (problem.load(fields), &problem.operators.relaxation);
        if load > 0.0 {
            let half_length = problem.parameters.hertz_half_length(load);
            relaxation.length(half_length.min(relaxation.half_length))
        } else {
            relaxation.length(relaxation.half_length)
        }
    }

    fn touches(fields: &LineFields) -> bool {
        Self::pressure(fields).iter().any(|&pressure| pressure > 0.0)
    }

    fn carried_load(problem: &Problem<Self>, fields: &LineFields) -> f64 {
        problem.unit_force() * Self::pressure(fields).iter().sum::<f64>()
    }

    fn wheel_temperature(fields: &LineFields) -> f64 {
        fields.wheel_temperature
    }

    fn set_wheel_temperature(fields: &mut LineFields, temperature: f64) {
        fields.wheel_temperature = temperature;
    }

    fn begin(
        problem: &LineProblem,
        before: Option<&LineFields>,
        now: &mut LineFields,
        solvers: &mut LineSolvers,
    ) -> Result<()> {
        match before {
            Some(before) => {
                memory::begin(problem, before, now);
                now.relaxation_length = Self::relaxation_length(problem, before);
                solvers.data.displacement_before.copy_from_slice(&before.displacement);
                heat_and_wear::keep_inflow(problem, before, now);
            }
            None => solvers.data.displacement_before.fill(0.0),
        }
        solvers.mechanics.start_step();
        solvers.wear_compliance.start_step();
        heat_and_wear::update_wear_compliance(problem, now, solvers);
        Ok(())
    }

    fn read(problem: &LineProblem, fields: &LineFields, solvers: &mut LineSolvers, interface: &mut Interface) {
        heat_and_wear::read(problem, fields, solvers, interface);
    }

    fn solve_mechanics(
        problem: &LineProblem,
        interface: &Interface,
        now: &mut LineFields,
        solvers: &mut LineSolvers,
        tolerance: f64,
    ) -> Result<TractionChange> {
        mechanics::solve(problem, interface, now, solvers, tolerance)
    }

    fn mechanics_work(solvers: &LineSolvers) -> u64 {
        solvers.mechanics.work()
    }

    /// Products with the compliance, and some thirty operations a mode, exponentials among them.
    fn sweep_work(&self) -> u64 {
        let nodes = self.mesh.contact_nodes;
        (6 * nodes * nodes + 30 * self.mesh.columns() * self.heat.basis.len()) as u64
    }

    fn set_surface_temperature(&self, interface: &Interface, now: &mut LineFields) {
        let window = &mut now.surface_temperature[self.mesh.window()];
        for (temperature, rise) in window.iter_mut().zip(interface.temperatures()) {
            *temperature = rise;
        }
    }

    fn march_wear(problem: &LineProblem, before: &LineFields, now: &mut LineFields, solvers: &mut LineSolvers) {
        heat_and_wear::march_wear(problem, before, now, solvers);
    }

    fn march_heat(
        problem: &LineProblem,
        before: &LineFields,
        wheel_rise: f64,
        now: &mut LineFields,
        solvers: &mut LineSolvers,
    ) -> Result<()> {
        heat_and_wear::march_heat(problem, before, wheel_rise, now, solvers)
    }

    fn update_wear_compliance(problem: &LineProblem, now: &LineFields, solvers: &mut LineSolvers) {
        heat_and_wear::update_wear_compliance(problem, now, solvers);
    }

    fn pending_displacement(problem: &LineProblem, now: &LineFields, solvers: &LineSolvers) -> f64 {
        heat_and_wear::pending_displacement(problem, now, solvers)
    }

    fn map_displacement(problem: &LineProblem, now: &mut LineFields, solvers: &mut LineSolvers) {
        heat_and_wear::map_displacement(problem, now, solvers);
    }

    fn end_memory(problem: &Problem<Self>, now: &mut LineFields) {
        memory::end(problem, now);
    }

    fn finalise_friction(problem: &LineProblem, now: &mut LineFields, _solvers: &LineSolvers) {
        let law = problem.friction();
        let first = problem.operators.mesh.first_contact;
        let of_slip = problem.path_law().is_some();
        for node in 0..now.pressure.len() {
            let static_friction = law.coefficient(now.surface_temperature[first + node]).0;
            let mut mu = static_friction;
            if of_slip && now.pressure[node] > 0.0 {
                mu = now.memory.at_final_temperature(node, static_friction);
            }
            now.friction[node] = mu;
            if now.pressure[node] > 0.0 {
                now.shear[node] = -mu * now.pressure[node] * now.utilisation[node];
            }
        }
    }

    fn finalise_displacement(
        problem: &LineProblem,
        interface: &Interface,
        now: &mut LineFields,
        solvers: &mut LineSolvers,
    ) {
        mechanics::finalise_displacement(problem, interface, now, &solvers.data);
    }

    fn finalise(_: &LineProblem, _: &LineFields, _: &mut LineFields, _: &mut LineSolvers) -> Result<()> {
        Ok(())
    }

    fn is_cut_off(_problem: &LineProblem, now: &LineFields, solvers: &LineSolvers) -> bool {
        solvers.mechanics.is_cut_off() && now.pressure.iter().any(|&p| p > 0.0)
    }

    fn heated_nodes<'f>(
        problem: &'f LineProblem,
        _fields: &'f LineFields,
        values: &'f LineFields,
    ) -> impl Iterator<Item = HeatedNode> + 'f {
        let surface = problem.operators.surface_rise(values);
        (0..values.pressure.len()).map(move |node| HeatedNode {
            pressure: values.pressure[node],
            shear: [values.shear[node], 0.0],
            slip: [values.slip[node], 0.0],
            rise: surface[node],
        })
    }

    fn begin_linearisation(problem: &LineProblem, fields: &LineFields, solvers: &mut LineSolvers) {
        let nodes = fields.displacement.iter().zip(&fields.displacement_change);
        for (before, (now, change)) in solvers.data.displacement_before.iter_mut().zip(nodes) {
            *before = now - change;
        }
        solvers.mechanics.start_step();
        solvers.wear_compliance.start_step();
        heat_and_wear::update_wear_compliance(problem, fields, solvers);
    }

    fn linearise(
        problem: &LineProblem,
        interface: &Interface,
        fields: &mut LineFields,
        solvers: &mut LineSolvers,
        _tangent: &mut LineTangent,
    ) -> Result<()> {
        mechanics::linearise(problem, interface, fields, solvers)
    }

    fn begin_direction(
        _problem: &LineProblem,
        _fields: &LineFields,
        _direction: &Direction,
        change: &mut LineFields,
        _tangent: &mut LineTangent,
    ) {
        change.clear();
    }

    fn mechanics_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut LineFields) -> Result<()> {
        tangent::mechanics(at, along, change);
        Ok(())
    }

    fn march_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut LineFields) -> Result<()> {
        tangent::wear(at, along, change);
        tangent::heat(at, along, change);
        Ok(())
    }

    fn finalise_tangent(_: &mut Linearised<Self>, _: &Direction, _: &mut LineFields) {}

    fn integrals(problem: &LineProblem, fields: &LineFields, _solvers: &Self::Solvers) -> Integrals {
        integrals::integrals(problem, fields)
    }

    fn profiles(problem: &LineProblem, fields: &LineFields) -> Profiles {
        let ambient = problem.conditions.inputs.ambient_temperature;
        profiles::profiles(problem.operators, fields, ambient)
    }

    fn contact_nodes(problem: &LineProblem, fields: &LineFields) -> Vec<ContactNode> {
        profiles::contact_nodes(problem.operators, fields)
    }
}

impl OneWindow for LineOperators {
    fn paths(&self) -> impl Iterator<Item = MaterialPath> + '_ {
        let nodes = 0..self.mesh.contact_nodes;
        iter::once(MaterialPath {
            nodes: nodes.clone(),
            places: nodes,
        })
    }

    fn pressure(fields: &LineFields) -> &[f64] {
        &fields.pressure
    }

    fn surface_rise<'f>(&self, fields: &'f LineFields) -> &'f [f64] {
        &fields.surface_temperature[self.mesh.window()]
    }

    fn memory(fields: &LineFields) -> &Memory {
        &fields.memory
    }

    fn memory_mut(fields: &mut LineFields) -> &mut Memory {
        &mut fields.memory
    }
}
