//! The operator split of section 4 of the paper: mechanics for given temperature and wear, wear and heat for given
//! tractions, repeated until the temperature rests.

use crate::compliance::{self, Compliance, RollingCompliance, Scales};
use crate::dense;
use crate::error::{Error, Result};
use crate::heat::{DepthBasis, FrictionState, HeatMarch, SurfaceExchange};
use crate::mesh::Mesh;
use crate::normal::{ActiveSet, Constraint, NormalProblem, Pschenichnyj};
use crate::parameters::{Control, NormalSolver, Parameters};
use crate::signals::{Inputs, Motion};
use crate::tangential::{Tangential, TangentialProblem};
use crate::thermal_map::ThermalMap;
use crate::transport::Upwind;
use crate::wear;
use serde::{Deserialize, Serialize};

/// Sweeps between normal and tangential problem in one mechanics step.
const SWEEPS: usize = 200;
/// Change of the tractions at which the sweeps rest, relative to the peak pressure.
const SWEEP_TOLERANCE: f64 = 1e-11;
/// Iterations of the operator split.
const SPLITS: usize = 200;
/// Change of the surface temperature, relative to the largest (at least 1 K), at which the split rests (η).
const SPLIT_TOLERANCE: f64 = 1e-10;

/// The rail and the wheel's profile, built at initialisation.
pub struct Rail {
    /// Triangulation.
    pub mesh: Mesh,
    /// Units of the contact problem.
    pub scales: Scales,
    /// Compliance of the contact nodes.
    pub compliance: RollingCompliance,
    /// Eigenbasis of the depth operator.
    pub basis: DepthBasis,
    /// Thermal displacement of the contact nodes.
    pub thermal_map: ThermalMap,
    /// Profile of the wheel √(r₀² − x²) − r₀ at the contact nodes, scaled. The u₁ in (9) is dropped: it moves the contact
    /// by its own size, some µm, against a half-length of some mm.
    pub profile: Vec<f64>,
}

impl Rail {
    /// Mesh, compliance, thermal maps.
    ///
    /// # Errors
    /// [`Error::StiffnessNotPositiveDefinite`], [`Error::DepthBasis`].
    pub fn new(parameters: &Parameters) -> Result<Rail> {
        let mesh = Mesh::new(parameters);
        let scales = Scales::new(parameters);
        let (compliance, thermal) = compliance::build(&mesh, parameters, &scales)?;
        let basis = DepthBasis::new(&mesh.depth)?;
        let thermal_map = ThermalMap::new(&mesh, &basis, &thermal);
        let r0 = parameters.wheel_radius;
        let profile = (0..mesh.contact_nodes)
            .map(|i| {
                let x = mesh.contact_position(i);
                // √(r₀² − x²) − r₀ without the cancellation.
                -x * x / (r0 + (r0 * r0 - x * x).sqrt()) / scales.displacement
            })
            .collect();
        Ok(Rail {
            mesh,
            scales,
            compliance,
            basis,
            thermal_map,
            profile,
        })
    }

    /// Scaled pressure sum Σp of a normal load [N].
    pub fn scaled_load(&self, parameters: &Parameters, load: f64) -> f64 {
        load / (parameters.contact_width * self.mesh.contact_spacing() * self.scales.pressure)
    }
}

/// What one implicit step holds fixed.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// The inputs at the end of the step.
    pub inputs: Inputs,
    /// The motion they make.
    pub motion: Motion,
    /// Length of the step, [s].
    pub duration: f64,
}

/// The fields of the contact at one instant; n contact nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    /// Modal amplitudes of the temperature rise, columns × modes, column by column.
    pub temperature: Vec<f64>,
    /// Wear depth at the columns, [m].
    pub wear: Vec<f64>,
    /// Pressure, scaled, n.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail, scaled, n.
    pub shear: Vec<f64>,
    /// Slip velocity, [m/s], 0 outside the contact, n.
    pub slip: Vec<f64>,
    /// Friction coefficient at the contact nodes, n.
    pub friction: Vec<f64>,
    /// Heat flux into the rail, [W/m²], n.
    pub heat_flux: Vec<f64>,
    /// Penetration δ, scaled; 0 when lifted.
    pub penetration: f64,
}

impl Fields {
    /// A cold, unworn rail without contact.
    pub fn new(rail: &Rail) -> Fields {
        let n = rail.mesh.contact_nodes;
        Fields {
            temperature: vec![0.0; rail.mesh.columns() * rail.basis.len()],
            wear: vec![0.0; rail.mesh.columns()],
            pressure: vec![0.0; n],
            shear: vec![0.0; n],
            slip: vec![0.0; n],
            friction: vec![0.0; n],
            heat_flux: vec![0.0; n],
            penetration: 0.0,
        }
    }

    /// Overwrites these fields with others of the same sizes, without allocating.
    pub fn copy_from(&mut self, other: &Fields) {
        self.temperature.copy_from_slice(&other.temperature);
        self.wear.copy_from_slice(&other.wear);
        self.pressure.copy_from_slice(&other.pressure);
        self.shear.copy_from_slice(&other.shear);
        self.slip.copy_from_slice(&other.slip);
        self.friction.copy_from_slice(&other.friction);
        self.heat_flux.copy_from_slice(&other.heat_flux);
        self.penetration = other.penetration;
    }

    /// Modal amplitudes of one column.
    pub fn column(&self, rail: &Rail, column: usize) -> &[f64] {
        let m = rail.basis.len();
        &self.temperature[column * m..(column + 1) * m]
    }

    /// Temperature rise at the surface of a column, [K].
    pub fn surface_temperature(&self, rail: &Rail, column: usize) -> f64 {
        rail.basis.surface_value(self.column(rail, column))
    }
}

/// How a split came to rest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Convergence {
    /// Iterations of the operator split, summed over the sub-steps of a step.
    pub iterations: usize,
    /// Last relative change of the surface temperature.
    pub residual: f64,
}

/// Buffers of a split.
pub struct Scratch {
    moving: Compliance,
    moving_rho_v2: f64,
    active_set: ActiveSet,
    pschenichnyj: Pschenichnyj,
    tangential: Tangential,
    thermal_displacement: Vec<f64>,
    profile: Vec<f64>,
    free_displacement: Vec<f64>,
    bound: Vec<f64>,
    last_pressure: Vec<f64>,
    last_shear: Vec<f64>,
    exchange: Vec<SurfaceExchange>,
    wear_rate: Vec<f64>,
    mode: Vec<f64>,
    surface: Vec<f64>,
}

impl Scratch {
    /// Buffers for the given rail.
    pub fn new(rail: &Rail) -> Scratch {
        let n = rail.mesh.contact_nodes;
        Scratch {
            moving: rail.compliance.at_rest.clone(),
            moving_rho_v2: 0.0,
            active_set: ActiveSet::new(n),
            pschenichnyj: Pschenichnyj::new(n),
            tangential: Tangential::new(n),
            thermal_displacement: vec![0.0; 2 * n],
            profile: vec![0.0; n],
            free_displacement: vec![0.0; n],
            bound: vec![0.0; n],
            last_pressure: vec![0.0; n],
            last_shear: vec![0.0; n],
            exchange: vec![SurfaceExchange::default(); n],
            wear_rate: vec![0.0; n],
            mode: vec![0.0; rail.basis.len()],
            surface: vec![0.0; n],
        }
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
        self.set_speed(scratch);
        let mut residual = f64::INFINITY;
        for iterations in 1..=SPLITS {
            // Step 2: tractions for given temperature and wear.
            self.mechanics(fields, scratch)?;
            // Step 3: wear and temperature for given tractions.
            self.march_wear(before, fields, scratch);
            self.march_heat(before, fields, scratch)?;
            // Step 4: rest?
            residual = self.temperature_change(fields, scratch);
            if residual <= SPLIT_TOLERANCE {
                self.check_window(fields)?;
                return Ok(Convergence { iterations, residual });
            }
        }
        Err(Error::SplitNotConverged {
            iterations: SPLITS,
            residual,
            tolerance: SPLIT_TOLERANCE,
        })
    }

    /// The mechanics alone, for given temperature and wear.
    ///
    /// # Errors
    /// As [`Contact::operator_split`].
    pub fn solve_mechanics(&self, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        self.set_speed(scratch);
        for node in 0..self.rail.mesh.contact_nodes {
            scratch.surface[node] = fields.surface_temperature(self.rail, self.rail.mesh.contact_column(node));
        }
        self.mechanics(fields, scratch)?;
        self.check_window(fields)
    }

    /// C(V).
    fn set_speed(&self, scratch: &mut Scratch) {
        let rho_v2 = self.parameters.density * self.conditions.motion.rolling_speed.powi(2);
        if rho_v2 != scratch.moving_rho_v2 {
            self.rail.compliance.at_speed(rho_v2, &mut scratch.moving);
            scratch.moving_rho_v2 = rho_v2;
        }
    }

    fn friction_state(&self) -> FrictionState<'_> {
        FrictionState {
            parameters: self.parameters,
            ambient: self.conditions.inputs.ambient_temperature,
            scale: self.conditions.inputs.friction_scale,
        }
    }

    fn constraint(&self) -> Constraint {
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

    /// Normal problem for given shear ↔ friction for given pressure, repeated until both rest.
    fn mechanics(&self, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        let n = self.rail.mesh.contact_nodes;
        if self.constraint() == Constraint::Total(0.0) {
            fields.pressure.fill(0.0);
            fields.shear.fill(0.0);
            fields.slip.fill(0.0);
            fields.penetration = 0.0;
            return Ok(());
        }
        self.rail
            .thermal_map
            .apply(&fields.temperature, &mut scratch.thermal_displacement);
        let friction = self.friction_state();
        for node in 0..n {
            let column = self.rail.mesh.contact_column(node);
            fields.friction[node] = friction.coefficient(fields.surface_temperature(self.rail, column)).0;
        }
        let mut residual = f64::INFINITY;
        for _ in 0..SWEEPS {
            scratch.last_pressure.copy_from_slice(&fields.pressure);
            scratch.last_shear.copy_from_slice(&fields.shear);
            self.solve_normal(fields, scratch)?;
            self.solve_friction(fields, scratch)?;
            let largest = fields.pressure.iter().fold(f64::MIN_POSITIVE, |m, p| p.max(m));
            residual = largest_change(&fields.pressure, &scratch.last_pressure)
                .max(largest_change(&fields.shear, &scratch.last_shear))
                / largest;
            if residual <= SWEEP_TOLERANCE {
                return Ok(());
            }
        }
        Err(Error::MechanicsNotConverged {
            iterations: SWEEPS,
            residual,
            tolerance: SWEEP_TOLERANCE,
        })
    }

    /// (37): the gap is closed by thermal bulge and friction, opened by wear.
    fn solve_normal(&self, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        let n = self.rail.mesh.contact_nodes;
        for node in 0..n {
            let wear = fields.wear[self.rail.mesh.contact_column(node)] / self.rail.scales.displacement;
            scratch.profile[node] = self.rail.profile[node] - wear + scratch.thermal_displacement[n + node];
        }
        dense::multiply_add(
            &scratch.moving.normal_tangential,
            &fields.shear,
            1.0,
            &mut scratch.profile,
        );
        let problem = NormalProblem {
            compliance: &scratch.moving.normal_normal,
            profile: &scratch.profile,
            constraint: self.constraint(),
        };
        let solution = match self.parameters.normal_solver {
            NormalSolver::ActiveSet => scratch.active_set.solve(&problem, &mut fields.pressure)?,
            NormalSolver::Pschenichnyj => scratch.pschenichnyj.solve(&problem, &mut fields.pressure)?,
        };
        fields.penetration = solution.penetration;
        Ok(())
    }

    /// (30): pressure and heat move the surface along x₁, friction resists its slip.
    fn solve_friction(&self, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        let n = self.rail.mesh.contact_nodes;
        scratch
            .free_displacement
            .copy_from_slice(&scratch.thermal_displacement[..n]);
        dense::multiply_add(
            &scratch.moving.tangential_normal,
            &fields.pressure,
            -1.0,
            &mut scratch.free_displacement,
        );
        for node in 0..n {
            scratch.bound[node] = fields.friction[node] * fields.pressure[node];
        }
        // The ends of the window have no neighbour; a contact that rests there is an error.
        scratch.bound[0] = 0.0;
        scratch.bound[n - 1] = 0.0;
        let problem = TangentialProblem {
            compliance: &scratch.moving,
            free_displacement: &scratch.free_displacement,
            bound: &scratch.bound,
            rigid_slip: self.conditions.motion.rigid_slip,
            strain_speed: self.conditions.motion.rolling_speed * self.rail.scales.displacement
                / self.rail.mesh.contact_spacing(),
            regularisation: self.parameters.slip_regularisation,
        };
        scratch
            .tangential
            .solve(&problem, &mut fields.shear, &mut fields.slip)?;
        Ok(())
    }

    fn upwind(&self) -> Upwind<'_> {
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
        wear::advance(
            &self.upwind(),
            self.conditions.duration,
            self.rail.mesh.first_contact,
            &scratch.wear_rate,
            &before.wear,
            &mut fields.wear,
        );
    }

    /// (19), (23).
    fn march_heat(&self, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
        for (exchange, (pressure, slip)) in scratch
            .exchange
            .iter_mut()
            .zip(fields.pressure.iter().zip(&fields.slip))
        {
            *exchange = SurfaceExchange::new(self.parameters, pressure * self.rail.scales.pressure, *slip);
        }
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
            &mut fields.temperature,
            &mut fields.heat_flux,
            &mut scratch.mode,
        )
    }

    /// ‖Δθ‖ at the contact nodes since the last call, relative to the largest temperature (at least 1 K).
    fn temperature_change(&self, fields: &Fields, scratch: &mut Scratch) -> f64 {
        let (mut change, mut largest) = (0.0_f64, 1.0_f64);
        for (node, last) in scratch.surface.iter_mut().enumerate() {
            let surface = fields.surface_temperature(self.rail, self.rail.mesh.contact_column(node));
            change = change.max((surface - *last).abs());
            largest = largest.max(surface.abs());
            *last = surface;
        }
        change / largest
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

fn largest_change(now: &[f64], last: &[f64]) -> f64 {
    now.iter().zip(last).fold(0.0, |m, (a, b)| (a - b).abs().max(m))
}
