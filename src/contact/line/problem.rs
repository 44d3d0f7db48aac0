//! One implicit step of the line contact as a problem: its data, and the parts of its equations that the split and its
//! derivative share.

use super::coupling::Coupling;
use super::fields::Fields;
use super::operators::LineOperators;
use crate::contact::rim::HeatedNode;
use crate::contact::task::Conditions;
use crate::friction::FrictionState;
use crate::friction::coulomb::Sliding;
use crate::friction::path::{PathLaw, PathStep};
use crate::heat::march::HeatMarch;
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::problem::{MechanicsProblem, Tractions};
use crate::mechanics::softening::Softening;
use crate::mechanics::transient::Transient;
use crate::parameters::{Control, Parameters, WheelHeating};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::transport::Upwind;
use crate::wear::WearMarch;

/// One problem: the rail, its parameters, the limits of the methods, the conditions of the step.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// The rail.
    pub operators: &'a LineOperators,
    /// The parameters.
    pub parameters: &'a Parameters,
    /// Limits and tolerances.
    pub settings: &'a Settings,
    /// What the step holds fixed.
    pub conditions: Conditions,
}

/// The data of the mechanics at n contact nodes, scaled.
pub struct MechanicsData {
    /// Profile of the wheel, less wear, plus the upward displacement that heat and inertia cause, n.
    profile: Vec<f64>,
    /// Displacement along x₁ that heat and inertia cause, n.
    displacement: Vec<f64>,
    /// Displacement along x₁ at the end of the step before, n.
    displacement_before: Vec<f64>,
    /// μ without slip, n.
    friction: Vec<f64>,
}

impl MechanicsData {
    /// With n contact nodes.
    pub fn new(nodes: usize) -> MechanicsData {
        MechanicsData {
            profile: vec![0.0; nodes],
            displacement: vec![0.0; nodes],
            displacement_before: vec![0.0; nodes],
            friction: vec![0.0; nodes],
        }
    }

    /// μ without slip, n.
    pub fn friction(&self) -> &[f64] {
        &self.friction
    }

    /// Takes the displacement at the end of the step before from the fields then.
    pub fn start_from(&mut self, before: &Fields) {
        self.displacement_before.copy_from_slice(&before.displacement);
    }

    /// Takes it from the fields at the end of the step.
    pub fn start_from_end(&mut self, after: &Fields) {
        let nodes = after.displacement.iter().zip(&after.displacement_change);
        for (before, (now, change)) in self.displacement_before.iter_mut().zip(nodes) {
            *before = now - change;
        }
    }
}

impl<'a> Problem<'a> {
    /// The same problem under other inputs.
    pub fn under(&self, inputs: Inputs) -> Problem<'a> {
        Problem {
            conditions: Conditions {
                inputs,
                motion: inputs.motion(self.parameters),
                ..self.conditions
            },
            ..*self
        }
    }

    /// The friction law at this ambient temperature and scale.
    pub fn friction(&self) -> FrictionState<'a> {
        FrictionState {
            parameters: self.parameters,
            ambient: self.conditions.inputs.ambient_temperature,
            scale: self.conditions.inputs.friction_scale,
        }
    }

    /// How friction depends on slip and on what was before; none where it does not.
    pub fn path_law(&self) -> Option<PathLaw> {
        let operators = self.operators;
        PathLaw::new(
            self.parameters,
            &PathStep {
                duration: self.conditions.duration,
                spacing: operators.mesh.contact_spacing(),
                speed: self.conditions.motion.rolling_speed,
                displacement: operators.near_field.direct * operators.scales.displacement
                    + self.parameters.layer_compliance * operators.scales.pressure,
                pressure: operators.scales.pressure,
            },
        )
    }

    /// Load or penetration, scaled.
    pub fn constraint(&self) -> Constraint {
        match self.parameters.control {
            Control::Load => {
                let load = self.conditions.inputs.normal_load;
                let load = self.settings.mechanics.felt(load, self.parameters.largest_load);
                Constraint::Total(self.operators.scaled_load(self.parameters, load))
            }
            Control::Penetration => {
                Constraint::Penetration(self.parameters.prescribed_penetration / self.operators.scales.displacement)
            }
        }
    }

    /// The order in which material crosses the columns.
    pub fn upwind(&self) -> Upwind<'a> {
        Upwind::new(&self.operators.mesh.x, self.conditions.motion.rolling_speed)
    }

    /// Strain of a scaled displacement over the node spacing.
    pub fn strain_scale(&self) -> f64 {
        self.operators.scales.displacement / self.operators.mesh.contact_spacing()
    }

    /// ρ V², `Pa`.
    pub fn rho_v2(&self) -> f64 {
        self.parameters.density * self.conditions.motion.rolling_speed.powi(2)
    }

    /// Temperature rise θ_w of the wheel in (23) at the rim's temperature, `K`.
    pub fn wheel_rise(&self, wheel_temperature: f64) -> f64 {
        match self.parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => wheel_temperature - self.conditions.inputs.ambient_temperature,
        }
    }

    /// ∂u₁/∂t over the step, with the relaxation length of the fields.
    pub fn transient(&self, fields: &Fields) -> Transient {
        Transient::new(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.operators.mesh.contact_spacing(),
            fields.relaxation_length,
            self.operators.scales.displacement,
        )
    }

    /// Its change with |V| by `speed` `m/s`.
    pub fn transient_tangent(&self, fields: &Fields, speed: f64) -> Transient {
        let per_speed = self.transient(fields).tangent(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.operators.mesh.contact_spacing(),
            fields.relaxation_length,
        );
        Transient {
            rate: speed * per_speed.rate,
            centring: speed * per_speed.centring,
        }
    }

    /// Relaxation length of a contact under the load that it had in the given fields, `m`; of the largest contact without load.
    pub fn relaxation_length(&self, fields: &Fields) -> f64 {
        let load = self.unit_force() * fields.pressure.iter().sum::<f64>();
        let relaxation = &self.operators.relaxation;
        if load > 0.0 {
            let half_length = self.parameters.hertz_half_length(load);
            relaxation.length(half_length.min(relaxation.half_length))
        } else {
            relaxation.length(relaxation.half_length)
        }
    }

    /// Force of a scaled traction of 1 on a node, `N`.
    pub fn unit_force(&self) -> f64 {
        self.operators.node_area(self.parameters) * self.operators.scales.pressure
    }

    /// The nodes as the rim sees them, or with changes of fields their changes.
    pub fn heated_nodes<'f>(&self, fields: &'f Fields) -> impl Iterator<Item = HeatedNode> + 'f {
        let surface = &fields.surface_temperature[self.operators.mesh.window()];
        (0..fields.pressure.len()).map(move |node| HeatedNode {
            pressure: fields.pressure[node],
            shear: [fields.shear[node], 0.0],
            slip: [fields.slip[node], 0.0],
            rise: surface[node],
        })
    }

    /// The heat march of the step.
    pub fn heat_march(&self) -> HeatMarch<'a> {
        HeatMarch {
            basis: &self.operators.heat.basis,
            transport: self.upwind(),
            first_contact: self.operators.mesh.first_contact,
            duration: self.conditions.duration,
            surface: SurfaceCondition {
                friction: self.friction(),
                settings: self.settings.heat,
            },
        }
    }

    /// The wear march of the step.
    pub fn wear_march(&self) -> WearMarch<'a> {
        WearMarch {
            transport: self.upwind(),
            duration: self.conditions.duration,
            first_contact: self.operators.mesh.first_contact,
        }
    }

    /// What heats and cools the surface at the contact nodes with the wheel at θ_w.
    pub fn exchange(&self, fields: &Fields, wheel_rise: f64, exchange: &mut [SurfaceExchange]) {
        let of_slip = self.path_law().is_some();
        for (node, exchange) in exchange.iter_mut().enumerate() {
            let pressure = fields.pressure[node] * self.operators.scales.pressure;
            let sliding = Sliding::new(fields.slip[node], fields.saturation[node]);
            *exchange = SurfaceExchange::new(self.parameters, pressure, sliding, wheel_rise);
            if of_slip && pressure > 0.0 {
                exchange.law = fields.memory.point_law(node);
            }
        }
    }

    /// Friction coefficient of the fields, profile and displacement for given temperature and wear. The convective
    /// inertia is that of the fields' tractions, those of the iteration before: it rests where the split does.
    pub fn update_mechanics_data(&self, coupling: &Coupling, fields: &mut Fields, data: &mut MechanicsData) {
        let friction = self.friction();
        for (mu, temperature) in data.friction.iter_mut().zip(coupling.temperature()) {
            *mu = friction.coefficient(temperature).0;
        }
        data.displacement.copy_from_slice(coupling.along());
        let gap = self
            .operators
            .profile
            .iter()
            .zip(coupling.wear())
            .zip(coupling.upward());
        for (profile, ((wheel, wear), lift)) in data.profile.iter_mut().zip(gap) {
            *profile = wheel - wear + lift;
        }
        self.add_inertia(
            self.rho_v2(),
            &fields.pressure,
            &fields.shear,
            &mut data.displacement,
            &mut data.profile,
        );
    }

    /// The displacement along x₁ of the fields at the end of the step, and its change, with the coupling's thermal displacement.
    pub fn close_displacement(&self, coupling: &Coupling, fields: &mut Fields, data: &MechanicsData) {
        let compliance = &self.operators.compliance;
        let (pressure, shear, displacement) = (&fields.pressure, &fields.shear, &mut fields.displacement);
        displacement.copy_from_slice(coupling.along());
        compliance
            .inertia
            .add_along(self.rho_v2(), pressure, shear, displacement);
        compliance.at_rest.add_along(1.0, pressure, shear, displacement);
        let nodes = fields.displacement.iter().zip(&data.displacement_before);
        for (change, (now, before)) in fields.displacement_change.iter_mut().zip(nodes) {
            *change = now - before;
        }
    }

    /// Adds the displacement along x₁ and upward that the convective inertia of the given tractions causes.
    pub fn add_inertia(&self, rho_v2: f64, pressure: &[f64], shear: &[f64], along: &mut [f64], upward: &mut [f64]) {
        let inertia = &self.operators.compliance.inertia;
        inertia.add_upward(rho_v2, pressure, shear, upward);
        inertia.add_along(rho_v2, pressure, shear, along);
    }

    /// The mechanics problem over the data of [`Problem::update_mechanics_data`], and the tractions that it is solved from.
    pub fn mechanics<'s>(
        &'s self,
        fields: &'s mut Fields,
        data: &'s MechanicsData,
        softening: &'s Softening,
    ) -> (MechanicsProblem<'s>, Tractions<'s>) {
        let motion = self.conditions.motion;
        let transient = self.transient(fields);
        let problem = MechanicsProblem {
            compliance: &self.operators.compliance.at_rest,
            normal_compliance: softening.compliance(),
            profile: &data.profile,
            displacement: &data.displacement,
            displacement_before: &data.displacement_before,
            friction: &data.friction,
            path: self
                .path_law()
                .map(|law| (law, fields.memory.before.path(0..data.friction.len()))),
            constraint: self.constraint(),
            normal_solver: self.parameters.normal_solver,
            rigid_slip: motion.rigid_slip,
            strain_speed: motion.rolling_speed * self.strain_scale(),
            transient,
            near_field: self.operators.near_field,
            regularisation: self.parameters.slip_regularisation,
        };
        let tractions = Tractions {
            pressure: &mut fields.pressure,
            shear: &mut fields.shear,
            slip: &mut fields.slip,
            saturation: &mut fields.saturation,
            friction: &mut fields.friction,
            surfaces: &mut fields.memory.now.friction,
            flow: &mut fields.memory.now.flow,
            speed: &mut fields.memory.now.speed,
            share: &mut fields.memory.share,
            cap: &mut fields.memory.cap,
            penetration: &mut fields.penetration,
        };
        (problem, tractions)
    }
}
