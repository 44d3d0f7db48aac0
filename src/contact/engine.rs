//! Interface between a contact model and the step: the model's operators, built once, are an [`Engine`]. The line, the patch and the
//! surface of profiles are three; a further one is another implementation, and the step ([`super::step`]) and its derivatives
//! ([`super::sensitivity`]) stay as they are.

use super::fields::{EngineState, Fields};
use super::integrals::Integrals;
use super::interface::Interface;
use super::problem::Problem;
use super::profiles::{ContactNode, Profiles};
use super::rim::HeatedNode;
use super::work::Iterations;
use crate::error::Result;
use crate::friction::memory::Memory;
use crate::mechanics::normal_tangential::TractionChange;
use crate::parameters::Parameters;
use crate::settings::{SensitivitySettings, Settings, SplitSettings};
use crate::signals::{Inputs, Motion};
use std::ops::Range;

/// Direction in the space of the inputs, along which derivatives are taken.
#[derive(Debug, Clone, Copy)]
pub struct Direction {
    /// Change of the inputs.
    pub inputs: Inputs,
    /// Change of the motion that they make.
    pub motion: Motion,
    /// Change of |V|, `m/s`.
    pub speed: f64,
}

impl Direction {
    /// No change: what then changes follows the interface vector alone.
    pub const NONE: Direction = Direction {
        inputs: Inputs::ZERO,
        motion: Motion::ZERO,
        speed: 0.0,
    };
}

/// Path of rail material through the window: its nodes, and the same nodes in the fields of the tractions.
#[derive(Debug, Clone)]
pub struct MaterialPath {
    /// Nodes, by their number.
    pub nodes: Range<usize>,
    /// Places of the nodes in the fields of the tractions.
    pub places: Range<usize>,
}

/// Contact model: its operators, computed once.
pub trait Engine: Sized + 'static {
    /// Fields, all that a step changes.
    type Fields: Fields;
    /// Solvers and buffers of a step. What a step leaves in them changes no result of another one.
    type Solvers;
    /// Solvers and buffers of the linearised mechanics, heat and wear.
    type Tangent;

    /// Fields of a cold, unworn rail without contact; the wheel's temperature is 0 K.
    fn fields(&self) -> Self::Fields;

    /// Solvers of a step.
    fn solvers(&self, settings: &Settings) -> Self::Solvers;

    /// Solvers of a linearised step.
    fn tangent(&self, settings: &Settings) -> Self::Tangent;

    /// Interface vector, all zero.
    fn interface(&self) -> Interface;

    /// Tolerances of the iteration on the interface vector.
    fn split_settings(settings: &Settings) -> SplitSettings;

    /// Tolerances of the derivatives.
    fn sensitivity_settings(settings: &Settings) -> SensitivitySettings;

    /// Length along the rail of the window in which the contact is sought, `m`.
    fn window_length(&self) -> f64;

    /// Distance of neighbouring nodes along the rail, `m`.
    fn spacing(&self) -> f64;

    /// Unit of displacements, `m`.
    fn displacement_scale(&self) -> f64;

    /// Unit of tractions, `Pa`.
    fn pressure_scale(&self) -> f64;

    /// Force of a scaled traction of 1 on a node, `N`.
    fn unit_force(&self, parameters: &Parameters) -> f64;

    /// Diagonal of the tangential compliance: displacement of a node by a scaled shear of 1 on itself, `m`.
    fn diagonal_displacement(&self, parameters: &Parameters) -> f64;

    /// Distance of rolling on which a contact under the load of the given fields forgets its displacement, `m`.
    fn relaxation_length(problem: &Problem<Self>, fields: &Self::Fields) -> f64;

    /// Whether anything is under pressure.
    fn touches(fields: &Self::Fields) -> bool;

    /// Load that the tractions of the fields carry, `N`.
    fn carried_load(problem: &Problem<Self>, fields: &Self::Fields) -> f64;

    /// Temperature of the wheel, absolute, `K`.
    fn wheel_temperature(fields: &Self::Fields) -> f64;

    /// Sets the temperature of the wheel, absolute, `K`.
    fn set_wheel_temperature(fields: &mut Self::Fields, temperature: f64);

    // -- one step -----------------------------------------------------------------------------------------------------

    /// Begins a step from the fields before it; without any the mechanics stand alone, and no time passes. `now` holds the first
    /// guess of the tractions.
    ///
    /// # Errors
    /// Heat that cannot be carried along.
    fn begin(
        problem: &Problem<Self>,
        before: Option<&Self::Fields>,
        now: &mut Self::Fields,
        solvers: &mut Self::Solvers,
    ) -> Result<()>;

    /// Moves the first guess of a step on by `ahead` `s`.
    fn extrapolate(
        state: &EngineState<Self::Fields>,
        ahead: f64,
        now: &mut Self::Fields,
        _solvers: &mut Self::Solvers,
    ) {
        state.extrapolate(ahead, now);
    }

    /// Keeps an extrapolated first guess within what is possible.
    fn limit_guess(_before: &Self::Fields, _now: &mut Self::Fields) {}

    /// Writes the interface vector of the fields, or of a change of them.
    fn read(problem: &Problem<Self>, fields: &Self::Fields, solvers: &mut Self::Solvers, interface: &mut Interface);

    /// Solves the mechanics (31) once, pressure and then friction, for what the interface vector holds.
    ///
    /// # Errors
    /// The first solver that does not converge.
    fn solve_mechanics(
        problem: &Problem<Self>,
        interface: &Interface,
        now: &mut Self::Fields,
        solvers: &mut Self::Solvers,
        tolerance: f64,
    ) -> Result<TractionChange>;

    /// Work of the mechanics since the step began, in multiplications and additions.
    fn mechanics_work(solvers: &Self::Solvers) -> u64;

    /// Iterations of the mechanics since the solvers were made; a line has none of the kinds that are counted.
    fn iterations(_solvers: &Self::Solvers) -> Iterations {
        Iterations::default()
    }

    /// Work of a sweep besides, about.
    fn sweep_work(&self) -> u64;

    /// Sets the surface temperature of the fields to that of the interface vector. The heat march takes it as a first guess: where
    /// friction rises so fast with temperature that a node has several, it is the one that this one leads to.
    fn set_surface_temperature(&self, interface: &Interface, now: &mut Self::Fields);

    /// Marches the wear (24) for the tractions.
    fn march_wear(problem: &Problem<Self>, before: &Self::Fields, now: &mut Self::Fields, solvers: &mut Self::Solvers);

    /// Marches the heat (19), (23) for the tractions with the wheel at θ_w.
    ///
    /// # Errors
    /// [`crate::error::Error::SurfaceHeatNotConverged`].
    fn march_heat(
        problem: &Problem<Self>,
        before: &Self::Fields,
        wheel_rise: f64,
        now: &mut Self::Fields,
        solvers: &mut Self::Solvers,
    ) -> Result<()>;

    /// Adapts the wear compliance, by which wear is a part of the normal problem, to the slip of the fields.
    fn update_wear_compliance(problem: &Problem<Self>, now: &Self::Fields, solvers: &mut Self::Solvers);

    /// Bound of the change of the thermal displacement that has been left out of the fields so far, scaled.
    fn pending_displacement(_problem: &Problem<Self>, _now: &Self::Fields, _solvers: &Self::Solvers) -> f64 {
        0.0
    }

    /// Computes what [`Engine::pending_displacement`] bounds, into the fields.
    fn map_displacement(_problem: &Problem<Self>, _now: &mut Self::Fields, _solvers: &mut Self::Solvers) {}

    /// Ends a step with the history of friction that the rail takes along into the next one.
    fn end_memory(problem: &Problem<Self>, now: &mut Self::Fields);

    /// Sets friction coefficient and shear of the fields to those at their temperature; the traction utilisation stays. The friction power
    /// of the fields is then, to round-off, the friction power that heats rail and wheel.
    fn finalise_friction(problem: &Problem<Self>, now: &mut Self::Fields, solvers: &Self::Solvers);

    /// Sets the displacement of the surface at the end of the step, and its change, from the tractions and the interface vector that
    /// they were solved for.
    fn finalise_displacement(
        problem: &Problem<Self>,
        interface: &Interface,
        now: &mut Self::Fields,
        solvers: &mut Self::Solvers,
    );

    /// Computes, from the converged fields, what no other equation of the step depends on: heat under the surface, rail behind the
    /// window.
    ///
    /// # Errors
    /// [`crate::error::Error::SurfaceHeatNotConverged`].
    fn finalise(
        problem: &Problem<Self>,
        before: &Self::Fields,
        now: &mut Self::Fields,
        solvers: &mut Self::Solvers,
    ) -> Result<()>;

    /// Whether the contact would reach beyond its window, had it not been held within it.
    fn is_cut_off(problem: &Problem<Self>, now: &Self::Fields, solvers: &Self::Solvers) -> bool;

    /// Nodes as the rim sees them: those in contact of `fields`, with the values of `values`, which are the same fields or a change
    /// of them.
    fn heated_nodes<'f>(
        problem: &'f Problem<Self>,
        fields: &'f Self::Fields,
        values: &'f Self::Fields,
    ) -> impl Iterator<Item = HeatedNode> + 'f;

    // -- its derivative -----------------------------------------------------------------------------------------------

    /// Prepares the solvers for the linearisation of a step that has ended with the given fields.
    fn begin_linearisation(problem: &Problem<Self>, fields: &Self::Fields, solvers: &mut Self::Solvers);

    /// Factorises the mechanics at the fields that were solved for the interface vector; they are under pressure.
    ///
    /// # Errors
    /// Mechanics that do not converge, or a singular matrix.
    fn linearise(
        problem: &Problem<Self>,
        interface: &Interface,
        fields: &mut Self::Fields,
        solvers: &mut Self::Solvers,
        tangent: &mut Self::Tangent,
    ) -> Result<()>;

    /// Begins a direction: sets the change of the fields to what it is without a change of the tractions.
    fn begin_direction(
        problem: &Problem<Self>,
        fields: &Self::Fields,
        direction: &Direction,
        change: &mut Self::Fields,
        tangent: &mut Self::Tangent,
    );

    /// Change of the tractions along a direction and a change of the interface vector.
    ///
    /// # Errors
    /// A linear system that cannot be solved.
    fn mechanics_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut Self::Fields) -> Result<()>;

    /// Change of wear and heat for changed tractions, and a changed temperature of the wheel in the interface vector.
    ///
    /// # Errors
    /// A linear system that cannot be solved.
    fn march_tangent(at: &mut Linearised<Self>, along: &Along, change: &mut Self::Fields) -> Result<()>;

    /// Change of what [`Engine::finalise`] computes.
    fn finalise_tangent(at: &mut Linearised<Self>, direction: &Direction, change: &mut Self::Fields);

    // -- what is read off ---------------------------------------------------------------------------------------------

    /// Integrals over the contact, and what else the outputs are made of. The solvers are those of the step, or of its linearisation.
    fn integrals(problem: &Problem<Self>, fields: &Self::Fields, solvers: &Self::Solvers) -> Integrals;

    /// Largest depth that the step has worn off a profile, `m`; 0 where none wears.
    fn profile_change(_solvers: &Self::Solvers) -> f64 {
        0.0
    }

    /// Whether there are more contacts than windows.
    fn is_crowded(_solvers: &Self::Solvers) -> bool {
        false
    }

    /// Profiles for plotting.
    fn profiles(problem: &Problem<Self>, fields: &Self::Fields) -> Profiles;

    /// Fields at the nodes of the contact window.
    fn contact_nodes(problem: &Problem<Self>, fields: &Self::Fields) -> Vec<ContactNode>;
}

/// Contact model whose nodes are all in one window.
pub trait OneWindow: Engine {
    /// Paths on which rail material crosses the window.
    fn paths(&self) -> impl Iterator<Item = MaterialPath> + '_;

    /// Pressure of the fields, scaled.
    fn pressure(fields: &Self::Fields) -> &[f64];

    /// Temperature rise of the rail's surface at the nodes, `K`.
    fn surface_rise<'f>(&self, fields: &'f Self::Fields) -> &'f [f64];

    /// History of friction.
    fn memory(fields: &Self::Fields) -> &Memory;

    /// History of friction, to be changed.
    fn memory_mut(fields: &mut Self::Fields) -> &mut Memory;
}

/// Linearised step: the point at which it is linearised, with solvers that are factorised there.
pub struct Linearised<'a, E: Engine> {
    /// Problem of the step.
    pub problem: &'a Problem<'a, E>,
    /// Interface vector that the tractions of the fields were solved for.
    pub interface: &'a Interface,
    /// Fields after the sweep.
    pub fields: &'a mut E::Fields,
    /// Solvers of the step.
    pub solvers: &'a mut E::Solvers,
    /// Solvers of the linearised step.
    pub tangent: &'a mut E::Tangent,
    /// Whether anything is under pressure.
    pub touches: bool,
    /// Relative tolerance of linear systems within a sweep.
    pub tolerance: f64,
}

impl<'a, E: Engine> Linearised<'a, E> {
    /// Linearises at the fields that were solved for the interface vector.
    ///
    /// # Errors
    /// Mechanics that do not converge, or a singular matrix.
    pub fn new(
        problem: &'a Problem<'a, E>,
        interface: &'a Interface,
        fields: &'a mut E::Fields,
        solvers: &'a mut E::Solvers,
        tangent: &'a mut E::Tangent,
        tolerance: f64,
    ) -> Result<Linearised<'a, E>> {
        let touches = E::touches(fields);
        if touches {
            E::linearise(problem, interface, fields, solvers, tangent)?;
        }
        Ok(Linearised {
            problem,
            interface,
            fields,
            solvers,
            tangent,
            touches,
            tolerance,
        })
    }
}

/// Change along which a tangent is taken.
#[derive(Clone, Copy)]
pub struct Along<'a> {
    /// Change of the inputs.
    pub direction: &'a Direction,
    /// Change of the interface vector.
    pub interface: &'a Interface,
}
