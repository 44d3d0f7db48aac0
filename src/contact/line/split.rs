//! The operator split of section 4 of the paper: mechanics for given temperature and wear, wear and heat for given
//! tractions, repeated until the temperature rests.

use crate::contact::line::fields::Fields;
use crate::contact::line::rail::Rail;
use crate::contact::rim::{self, ContactHeat};
use crate::error::{Error, Result};
use crate::friction::{FrictionState, coulomb};
use crate::heat::march::{HeatMarch, Heated, SurfaceExchange};
use crate::injection::{self, Solver};
use crate::mechanics::normal::Constraint;
use crate::mechanics::softening::Softening;
use crate::mechanics::{Mechanics, MechanicsProblem, ProblemTangent, Sweep, Tractions};
use crate::numerics::anderson::Anderson;
use crate::numerics::dense::{self, largest, largest_change};
use crate::parameters::{Control, Parameters, WheelHeating};
use crate::signals::{Inputs, Motion};
use crate::transport::Upwind;
use crate::wear;
use serde::{Deserialize, Serialize};

/// Iterations of the operator split.
const SPLITS: usize = 100;
/// Error of surface temperature and wear at which the split rests (η), relative to the largest temperature (at least 1 K)
/// and to the displacement scale.
const TOLERANCE: f64 = 1e-9;
/// Error of the shear at which the split rests, relative to the peak pressure.
const SHEAR_TOLERANCE: f64 = 1e-9;
/// Tolerance of the mechanics where they are solved alone, for the initial state.
const MECHANICS_ALONE_TOLERANCE: f64 = 1e-11;
/// Tolerance of the mechanics in the first iteration, in the last, and in those between relative to the last change.
const FIRST_MECHANICS_TOLERANCE: f64 = 1e-8;
const LAST_MECHANICS_TOLERANCE: f64 = 1e-12;
const MECHANICS_TOLERANCE: f64 = 1e-4;
/// Change of the thermal displacement that is left out between iterations, relative to [`TOLERANCE`].
const UNFELT: f64 = 0.1;
/// Iterations after which a split that has not come to rest is accelerated.
const ACCELERATE_FROM: usize = 2;
/// Temperature that counts as much as a displacement of one unit, `K`.
pub(crate) const TEMPERATURE_SCALE: f64 = 100.0;
/// The error of an iteration is its change times the contraction; an estimate above this is not trusted.
const TRUSTED_CONTRACTION: f64 = 0.3;
/// Nor one below this: the first change may be large in what the iteration settles at once.
const LEAST_CONTRACTION: f64 = 1e-3;

/// What one implicit step holds fixed.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// The inputs at the end of the step.
    pub inputs: Inputs,
    /// The motion they make.
    pub motion: Motion,
    /// Length of the step, `s`.
    pub duration: f64,
}

/// How a split came to rest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Convergence {
    /// Iterations of the operator split, summed over the sub-steps of a step.
    pub iterations: usize,
    /// Last relative change of the surface temperature.
    pub residual: f64,
}

/// Values that the split iterates on ([`Contact::gather`]) with n contact nodes.
pub(crate) fn gathered(n: usize) -> usize {
    4 * n + 1
}

/// Buffers of a split.
pub struct Scratch {
    pub(crate) softening: Softening,
    mechanics: Mechanics,
    profile: Vec<f64>,
    displacement: Vec<f64>,
    exchange: Vec<SurfaceExchange>,
    wear_rate: Vec<f64>,
    mode: Vec<f64>,
    pub(crate) moments: Vec<f64>,
    /// The heat flux of the last application of the thermal map.
    mapped_flux: Vec<f64>,
    /// What the mechanics see of heat and wear in this iteration, and what heat and wear give for the next one:
    /// [`Contact::gather`].
    iterate: Vec<f64>,
    image: Vec<f64>,
    anderson: Anderson,
}

impl Scratch {
    /// Buffers for the given rail.
    pub fn new(rail: &Rail) -> Scratch {
        let n = rail.mesh.contact_nodes;
        Scratch {
            mechanics: Mechanics::new(n),
            profile: vec![0.0; n],
            displacement: vec![0.0; n],
            exchange: vec![SurfaceExchange::default(); n],
            wear_rate: vec![0.0; n],
            mode: vec![0.0; HeatMarch::scratch_len(&rail.basis)],
            moments: vec![0.0; rail.thermal_map.scratch_len()],
            mapped_flux: vec![0.0; n],
            iterate: vec![0.0; gathered(n)],
            image: vec![0.0; gathered(n)],
            anderson: Anderson::new(gathered(n)),
            softening: Softening::new(&rail.compliance.at_rest.normal_normal),
        }
    }

    /// Forgets what the step before has left: a step follows from the state alone.
    fn start_step(&mut self) {
        self.mechanics.start_step();
        self.softening.start_step();
        self.anderson.restart();
    }
}

/// One problem: the rail, its parameters and the conditions of the step.
pub struct Contact<'a> {
    /// The rail.
    pub rail: &'a Rail,
    /// The parameters (friction and interface are read here, the rest is in the rail).
    pub parameters: &'a Parameters,
    /// What the step holds fixed.
    pub conditions: Conditions,
}

impl Contact<'_> {
    /// Solves the step: `fields` holds the first guess and receives the solution; temperature and wear at its start
    /// are those of `before`.
    ///
    /// # Errors
    /// The first solver that did not converge, or [`Error::ContactLeavesWindow`]; `fields` is then unspecified.
    pub fn operator_split(&self, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) -> Result<Convergence> {
        scratch.start_step();
        self.soften(fields, scratch);
        self.gather(fields, &scratch.softening, &mut scratch.iterate);
        let mut residual = f64::INFINITY;
        for iterations in 1..=SPLITS {
            // Step 2: tractions for given temperature and wear.
            let tolerance = (MECHANICS_TOLERANCE * residual).clamp(LAST_MECHANICS_TOLERANCE, FIRST_MECHANICS_TOLERANCE);
            let sweep = self.sweep_mechanics(fields, scratch, tolerance)?;
            // Step 3: wear and temperature for given tractions.
            self.march_wear(before, fields, scratch);
            self.march_heat(before, fields, scratch)?;
            self.soften(fields, scratch);
            self.gather(fields, &scratch.softening, &mut scratch.image);
            // Step 4: rest? The next change would be smaller by the contraction. One iteration cannot tell: the mechanics have
            // not yet seen what it changed.
            let bulging = if iterations > 1 {
                self.bulging(fields, scratch)
            } else {
                f64::INFINITY
            };
            let last = residual;
            residual = self.change(&scratch.iterate, &scratch.image).max(bulging);
            let contraction = if residual < TRUSTED_CONTRACTION * last && last.is_finite() {
                (residual / last).max(LEAST_CONTRACTION)
            } else {
                1.0
            };
            let rests = residual * contraction <= TOLERANCE && sweep.shear_change * contraction <= SHEAR_TOLERANCE;
            if rests && !sweep.set_changed {
                injection::passes(Solver::Split)?;
                self.check_window(fields)?;
                self.close_friction(fields);
                self.warm_wheel(before, fields);
                return Ok(Convergence { iterations, residual });
            }
            if bulging > UNFELT * TOLERANCE {
                self.bulge(fields, scratch);
                residual = self.change(&scratch.iterate, &scratch.image);
            }
            if iterations >= ACCELERATE_FROM {
                scratch.anderson.next(&scratch.iterate, &mut scratch.image);
            }
            std::mem::swap(&mut scratch.iterate, &mut scratch.image);
        }
        Err(Error::SplitNotConverged {
            iterations: SPLITS,
            residual,
            tolerance: TOLERANCE,
        })
    }

    /// The mechanics alone, for given temperature and wear.
    ///
    /// # Errors
    /// As [`Contact::operator_split`].
    pub fn solve_mechanics(&self, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        scratch.start_step();
        self.soften(fields, scratch);
        self.gather(fields, &scratch.softening, &mut scratch.iterate);
        for _ in 0..SPLITS {
            let sweep = self.sweep_mechanics(fields, scratch, MECHANICS_ALONE_TOLERANCE)?;
            if sweep.shear_change <= MECHANICS_ALONE_TOLERANCE && !sweep.set_changed {
                return self.check_window(fields);
            }
        }
        Err(Error::SplitNotConverged {
            iterations: SPLITS,
            residual: f64::NAN,
            tolerance: MECHANICS_ALONE_TOLERANCE,
        })
    }

    pub(crate) fn friction_state(&self) -> FrictionState<'_> {
        FrictionState {
            parameters: self.parameters,
            ambient: self.conditions.inputs.ambient_temperature,
            scale: self.conditions.inputs.friction_scale,
        }
    }

    pub(crate) fn constraint(&self) -> Constraint {
        match self.parameters.control {
            Control::Load => Constraint::Total(
                self.rail
                    .scaled_load(self.parameters, self.conditions.inputs.normal_load),
            ),
            Control::Penetration => {
                Constraint::Penetration(self.parameters.prescribed_penetration / self.rail.scales.displacement)
            }
        }
    }

    /// (31): tractions for given temperature and wear. The convective inertia is that of the tractions before, and so at
    /// rest where the split is.
    fn sweep_mechanics(&self, fields: &mut Fields, scratch: &mut Scratch, tolerance: f64) -> Result<Sweep> {
        let constraint = self.constraint();
        if constraint == Constraint::Total(0.0) {
            fields.pressure.fill(0.0);
            fields.shear.fill(0.0);
            fields.slip.fill(0.0);
            fields.penetration = 0.0;
            return Ok(Sweep {
                shear_change: 0.0,
                set_changed: false,
            });
        }
        self.update_mechanics_data(fields, scratch);
        let (problem, mut tractions, mechanics) = self.mechanics_problem(fields, scratch);
        mechanics.sweep(&problem, &mut tractions, tolerance)
    }

    /// Friction coefficient, profile and displacement for given temperature, wear and inertia.
    fn update_mechanics_data(&self, fields: &mut Fields, scratch: &mut Scratch) {
        let n = self.rail.mesh.contact_nodes;
        let friction = self.friction_state();
        let (displacement, rest) = scratch.iterate.split_at(2 * n);
        let (temperature, wear) = rest.split_at(n);
        for (mu, temperature) in fields.friction.iter_mut().zip(temperature) {
            *mu = friction.coefficient(temperature * TEMPERATURE_SCALE).0;
        }
        scratch.displacement.copy_from_slice(&displacement[..n]);
        for (node, profile) in scratch.profile.iter_mut().enumerate() {
            *profile = self.rail.profile[node] - wear[node] + displacement[n + node];
        }
        let rho_v2 = self.parameters.density * self.conditions.motion.rolling_speed.powi(2);
        self.add_inertia(
            rho_v2,
            &fields.pressure,
            &fields.shear,
            &mut scratch.displacement,
            &mut scratch.profile,
        );
    }

    /// Adds the displacement along x₁ and upward that the convective inertia of the given tractions causes.
    pub(crate) fn add_inertia(
        &self,
        rho_v2: f64,
        pressure: &[f64],
        shear: &[f64],
        along: &mut [f64],
        upward: &mut [f64],
    ) {
        let inertia = &self.rail.compliance.inertia;
        dense::multiply_add(&inertia.normal_normal, pressure, -rho_v2, upward);
        dense::multiply_add(&inertia.normal_tangential, shear, rho_v2, upward);
        dense::multiply_add(&inertia.tangential_normal, pressure, -rho_v2, along);
        dense::multiply_add(&inertia.tangential_tangential, shear, rho_v2, along);
    }

    /// The mechanics problem over the data of [`Contact::update_mechanics_data`].
    fn mechanics_problem<'s>(
        &'s self,
        fields: &'s mut Fields,
        scratch: &'s mut Scratch,
    ) -> (MechanicsProblem<'s>, Tractions<'s>, &'s mut Mechanics) {
        let motion = self.conditions.motion;
        let problem = MechanicsProblem {
            compliance: &self.rail.compliance.at_rest,
            normal_compliance: scratch.softening.compliance(),
            profile: &scratch.profile,
            displacement: &scratch.displacement,
            friction: &fields.friction,
            constraint: self.constraint(),
            normal_solver: self.parameters.normal_solver,
            rigid_slip: motion.rigid_slip,
            strain_speed: motion.rolling_speed * self.strain_scale(),
            regularisation: self.parameters.slip_regularisation,
        };
        let tractions = Tractions {
            pressure: &mut fields.pressure,
            shear: &mut fields.shear,
            slip: &mut fields.slip,
            penetration: &mut fields.penetration,
        };
        (problem, tractions, &mut scratch.mechanics)
    }

    /// Strain of a scaled displacement over the node spacing.
    pub(crate) fn strain_scale(&self) -> f64 {
        self.rail.scales.displacement / self.rail.mesh.contact_spacing()
    }

    /// Factorises the mechanics at `fields`, which are at rest.
    pub(crate) fn linearise_mechanics(&self, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        scratch.start_step();
        self.soften(fields, scratch);
        self.gather(fields, &scratch.softening, &mut scratch.iterate);
        self.update_mechanics_data(fields, scratch);
        let (problem, mut tractions, mechanics) = self.mechanics_problem(fields, scratch);
        mechanics.linearise(&problem, &mut tractions)
    }

    /// Change of the tractions in `tangent` with the data of the problem at `fields` ([`Mechanics::tangent`]).
    pub(crate) fn mechanics_tangent(
        &self,
        fields: &mut Fields,
        scratch: &mut Scratch,
        change: &ProblemTangent,
        tangent: &mut Tractions,
    ) {
        let (problem, _, mechanics) = self.mechanics_problem(fields, scratch);
        mechanics.tangent(&problem, change, tangent);
    }

    pub(crate) fn upwind(&self) -> Upwind<'_> {
        Upwind::new(&self.rail.mesh.x, self.conditions.motion.rolling_speed)
    }

    /// (24).
    fn march_wear(&self, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) {
        for (rate, (pressure, slip)) in scratch
            .wear_rate
            .iter_mut()
            .zip(fields.pressure.iter().zip(&fields.slip))
        {
            *rate = self.parameters.wear_coefficient * slip.abs() * pressure * self.rail.scales.pressure;
        }
        let transport = self.upwind();
        fields.wear[transport.inflow()] = self.conditions.inputs.incoming_wear_depth;
        wear::advance(
            &transport,
            self.conditions.duration,
            self.rail.mesh.first_contact,
            &scratch.wear_rate,
            &before.wear,
            &mut fields.wear,
        );
    }

    /// Temperature rise θ_w of the wheel in (23) at the rim's temperature, `K`.
    pub(crate) fn wheel_rise(&self, wheel_temperature: f64) -> f64 {
        match self.parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => wheel_temperature - self.conditions.inputs.ambient_temperature,
        }
    }

    /// (19), (23) together with the rim's temperature: what the rail gives to the wheel and what the wheel takes is the same
    /// heat. With a cold wheel this is one march.
    fn march_heat(&self, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        let ambient = self.conditions.inputs.ambient_temperature;
        let guess = scratch.iterate[gathered(fields.pressure.len()) - 1] * TEMPERATURE_SCALE;
        let mut wheel = rim::FixedPoint::new(match self.parameters.wheel_heating {
            WheelHeating::Off => ambient,
            WheelHeating::On => guess,
        });
        loop {
            self.march_rail(before, fields, scratch, self.wheel_rise(wheel.temperature()))?;
            // The friction of this temperature, not of the last one's, heats the wheel: the balance closes at any tolerance.
            if self.parameters.wheel_heating == WheelHeating::On {
                self.close_friction(fields);
            }
            self.warm_wheel(before, fields);
            if wheel.rests(fields.wheel_temperature)? {
                injection::passes(Solver::WheelHeat)?;
                break;
            }
        }
        Ok(())
    }

    /// Bound of what the heat of this iteration changes in the thermal displacement: flux that changes from one iteration to
    /// the next moves the surface less than in proportion to all that the flux has heated so far. It spares the last
    /// iteration of a step the thermal map: the fields keep the displacement that the tractions have felt.
    fn bulging(&self, fields: &Fields, scratch: &Scratch) -> f64 {
        let flux = largest(&scratch.mapped_flux);
        let change = largest_change(&fields.heat_flux, &scratch.mapped_flux);
        if change == 0.0 {
            0.0
        } else if flux == 0.0 {
            f64::INFINITY
        } else {
            change / flux * largest(&fields.thermal_displacement)
        }
    }

    /// The thermal displacement of the temperature, for the fields and for the next iteration.
    fn bulge(&self, fields: &mut Fields, scratch: &mut Scratch) {
        self.rail.thermal_map.apply(
            &fields.temperature,
            &mut scratch.moments,
            &mut fields.thermal_displacement,
        );
        scratch.mapped_flux.copy_from_slice(&fields.heat_flux);
        scratch.image[..fields.thermal_displacement.len()].copy_from_slice(&fields.thermal_displacement);
    }

    /// (19), (23) with the wheel at θ_w.
    fn march_rail(&self, before: &Fields, fields: &mut Fields, scratch: &mut Scratch, wheel_rise: f64) -> Result<()> {
        let (inputs, m) = (&self.conditions.inputs, self.rail.basis.len());
        for (exchange, (pressure, slip)) in scratch
            .exchange
            .iter_mut()
            .zip(fields.pressure.iter().zip(&fields.slip))
        {
            *exchange = SurfaceExchange::new(self.parameters, pressure * self.rail.scales.pressure, *slip, wheel_rise);
        }
        let inflow = self.upwind().inflow();
        self.rail.incoming.enter(
            inputs.incoming_temperature - inputs.ambient_temperature,
            &mut fields.temperature[inflow * m..(inflow + 1) * m],
            &mut fields.surface_temperature[inflow],
        );
        HeatMarch {
            basis: &self.rail.basis,
            transport: self.upwind(),
            first_contact: self.rail.mesh.first_contact,
            duration: self.conditions.duration,
            friction: self.friction_state(),
        }
        .advance(
            &before.temperature,
            &scratch.exchange,
            &mut Heated {
                temperature: &mut fields.temperature,
                surface: &mut fields.surface_temperature,
                flux: &mut fields.heat_flux,
            },
            &mut scratch.mode,
        )
    }

    /// The rim's temperature under what the contact gives to it.
    fn warm_wheel(&self, before: &Fields, fields: &mut Fields) {
        fields.wheel_temperature = rim::temperature(
            self.parameters,
            before.wheel_temperature,
            self.conditions.inputs.ambient_temperature,
            self.conditions.duration,
            &ContactHeat::new(self.rail, self.parameters, fields),
        );
    }

    /// Adapts the normal compliance to the wear of the step.
    fn soften(&self, fields: &Fields, scratch: &mut Scratch) {
        let scales = self.rail.scales;
        let transport = self.upwind();
        let changed = scratch.softening.update(
            &self.rail.compliance.at_rest.normal_normal,
            &fields.slip,
            self.parameters.wear_coefficient * scales.pressure / scales.displacement,
            1.0 / self.conditions.duration,
            transport.speed() / self.rail.mesh.contact_spacing(),
            transport.is_forward(),
        );
        if changed {
            scratch.mechanics.forget_normal_compliance();
        }
    }

    /// What the mechanics see of heat and wear: thermal displacement (2n), temperature (n) in hundreds of kelvin, a change
    /// that matters to the friction law, and the part of the wear that is not in the normal compliance (n). Last what the
    /// heat sees of the wheel, its temperature in hundreds of kelvin.
    pub(crate) fn gather(&self, fields: &Fields, softening: &Softening, values: &mut [f64]) {
        let n = self.rail.mesh.contact_nodes;
        let window = self.rail.mesh.window();
        let (displacement, rest) = values.split_at_mut(2 * n);
        let (temperature, rest) = rest.split_at_mut(n);
        let (wear, wheel) = rest.split_at_mut(n);
        wheel[0] = fields.wheel_temperature / TEMPERATURE_SCALE;
        displacement.copy_from_slice(&fields.thermal_displacement);
        for (value, temperature) in temperature.iter_mut().zip(&fields.surface_temperature[window.clone()]) {
            *value = temperature / TEMPERATURE_SCALE;
        }
        for (value, depth) in wear.iter_mut().zip(&fields.wear[window]) {
            *value = depth / self.rail.scales.displacement;
        }
        softening.subtract_proportional(&fields.pressure, wear);
    }

    /// ‖Δθ‖ relative to the largest temperature (at least 1 K), the change of thermal displacement and wear relative to
    /// the displacement scale, and that of the wheel's temperature in hundreds of kelvin.
    fn change(&self, before: &[f64], after: &[f64]) -> f64 {
        let n = self.rail.mesh.contact_nodes;
        let temperature = 2 * n..3 * n;
        let largest = after[temperature.clone()]
            .iter()
            .fold(1.0 / TEMPERATURE_SCALE, |m, t| t.abs().max(m));
        (largest_change(&after[temperature.clone()], &before[temperature]) / largest)
            .max(largest_change(&after[..2 * n], &before[..2 * n]))
            .max(largest_change(&after[3 * n..], &before[3 * n..]))
    }

    /// Friction coefficient and shear of the final temperature: what is left of the split's tolerance goes into the
    /// equilibrium, and the friction power is the one that heated rail and wheel, to round-off.
    fn close_friction(&self, fields: &mut Fields) {
        let law = self.friction_state();
        let first = self.rail.mesh.first_contact;
        for node in 0..fields.pressure.len() {
            let mu = law.coefficient(fields.surface_temperature[first + node]).0;
            fields.friction[node] = mu;
            if fields.pressure[node] > 0.0 {
                let saturation = coulomb::saturation(fields.slip[node], self.parameters.slip_regularisation);
                fields.shear[node] = -mu * fields.pressure[node] * saturation;
            }
        }
    }

    /// A contact that reaches the end of the window is cut off by it.
    fn check_window(&self, fields: &Fields) -> Result<()> {
        let n = fields.pressure.len();
        if fields.pressure[0] > 0.0 || fields.pressure[n - 1] > 0.0 {
            return Err(Error::ContactLeavesWindow {
                half_width: self.rail.mesh.window_half_width(),
                largest_load: self.parameters.largest_load,
            });
        }
        Ok(())
    }
}
