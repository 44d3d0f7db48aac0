//! Limits and tolerances of the numerical methods, each with its reason. None of them is physics: those are
//! [`crate::parameters`].
//!
//! Every iteration has a limit. A limit of 0 makes its method fail at once, which is how the tests see what a failed
//! step leaves behind.

mod interface;
#[cfg(test)]
pub(crate) mod limits;
mod patch;
mod step;

pub use interface::InterfaceSettings;
pub use patch::PatchSettings;
pub use step::StepSettings;

/// Settings of all solvers. A [`crate::wheel_rail::Model`] has one set, the default unless told otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Settings {
    /// Division of a step.
    pub step: StepSettings,
    /// The operator split of one sub-step.
    pub split: SplitSettings,
    /// Normal and tangential problem in turn.
    pub mechanics: MechanicsSettings,
    /// The normal problem.
    pub normal: NormalSettings,
    /// The tangential problem.
    pub tangential: TangentialSettings,
    /// The wear of a step inside the normal problem.
    pub wear_compliance: WearComplianceSettings,
    /// The surface condition of the heat march, and the rim.
    pub heat: HeatSettings,
    /// Derivatives of the outputs.
    pub sensitivity: SensitivitySettings,
    /// The mechanics of the patch.
    pub patch: PatchSettings,
    /// The interface vector of hard steps, and the linear systems of its changes.
    pub interface: InterfaceSettings,
}

/// Convergence of the operator split.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplitSettings {
    /// Limit of the iterations. Most steps take two, those of a wheel slide three to five.
    pub iterations: usize,
    /// Error at which the split has converged (η of section 4): of the surface temperature relative to its largest value, of wear and
    /// thermal displacement relative to the displacement scale. 1e-9 is far below what a mesh resolves, and above
    /// round-off.
    pub tolerance: f64,
    /// Error of the shear at which it has converged, relative to the peak pressure.
    pub shear_tolerance: f64,
    /// Iterations of the fixed point after which Newton's method takes over: a step that contracts is done by then.
    pub fixed_point_iterations: usize,
    /// Iterations in which the change has not been halved after which it takes over, too.
    pub idle_iterations: usize,
    /// Change of the closest iterate at which a step ends then, before Newton's method is tried: a patch's costs as much as many sweeps.
    pub accepted_change: f64,
    /// Change at which it is ended where neither the fixed point nor Newton's method gets further: below what the mesh resolves. Slip that
    /// heats so much that friction has hardly one solution leaves it.
    pub stalled_tolerance: f64,
    /// Tolerance of the mechanics in the first iteration, whose temperature is only a guess.
    pub first_mechanics_tolerance: f64,
    /// Largest tolerance of the mechanics in those that follow: any of them may be the last.
    pub largest_mechanics_tolerance: f64,
    /// Tolerance of the mechanics relative to the last change of the split: their error must not hide its contraction.
    pub mechanics_tolerance: f64,
    /// Least change, in tolerances of the split, that the next iteration is taken to make where its mechanics are solved to a part of the change that is
    /// foretold. Infinite where they are solved to a part of the last change.
    pub least_seen_change: f64,
    /// The smallest tolerance that is asked of the mechanics: round-off of the compliance's products.
    pub last_mechanics_tolerance: f64,
    /// Tolerance of the mechanics where they are solved alone, for the initial state.
    pub mechanics_alone_tolerance: f64,
    /// Change of the thermal displacement that is not handed to the mechanics, relative to `tolerance`.
    pub negligible: f64,
    /// Iterations after which Anderson's method takes part. Two plain ones settle most steps.
    pub accelerate_after: usize,
    /// Ratio of the last two changes below which Anderson's method does not take part: where plain iterations contract, differences that hold the
    /// error of the mechanics lead away.
    pub plain_below: f64,
    /// Least temperature to which the change of the temperature is related, `K`.
    pub least_temperature: f64,
    /// The error of an iteration is estimated as its change times the ratio of the last two changes. The estimate is used
    /// only where that ratio is below this one.
    pub trusted_contraction: f64,
    /// Factor on the tolerance of the mechanics after an iteration that did not contract as much.
    pub sharpening: f64,
    /// Factor on the tolerances where a node has come under pressure or left it in the last iteration.
    pub set_margin: f64,
    /// Smallest ratio of two changes that is believed as a contraction: the first change contains what one iteration
    /// settles for good.
    pub least_contraction: f64,
}

/// Normal and tangential problem in turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MechanicsSettings {
    /// Limit of the iterations over both problems. With the active-set method two or three do, with the paper's method some
    /// ten.
    pub iterations: usize,
    /// Overlap of wheel and rail, scaled, above which an end of the window counts as cut off.
    pub overlap: f64,
    /// Load over the largest one below which the wheel is lifted: the pressure that carries it would be of the size of round-off of
    /// the bodies' profiles.
    pub least_load: f64,
    /// Change of the shear, relative to the peak pressure, to which they are solved before they are linearised.
    pub linearisation_tolerance: f64,
}

/// The normal problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalSettings {
    /// Separations above minus this one count as closed: round-off of sums whose terms are of order 1.
    pub round_off: f64,
    /// Exchanges of all violated nodes at once. Two ends of a contact that wait for each other can cycle, so that from then
    /// on only the worst node is exchanged.
    pub set_exchanges: usize,
    /// Exchanges altogether before the method that descends takes over.
    pub exchanges: usize,
    /// Exchanges of the method that descends, per node.
    pub descents_per_node: usize,
    /// Limit of the iterations of the paper's linearisation method.
    pub linearisations: usize,
    /// Largest step of the linearisation at which it has converged, relative to the largest pressure.
    pub linearisation_tolerance: f64,
}

/// The tangential problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialSettings {
    /// Limit of the Newton steps at one regularisation ε, and of those of Coulomb's law.
    pub newton_steps: usize,
    /// Coulomb's law: exchanges of all nodes that break their condition, before the path is followed that exchanges one at a
    /// time.
    pub exchanges: usize,
    /// Limit of the exchanges on that path, per node. A node seldom changes sides more than twice.
    pub path_exchanges_per_node: usize,
    /// Shears beyond the bound by less than this share of the largest bound count as within.
    pub round_off: f64,
    /// Limit of the halvings of one step in the line search. A step that does not help at 2⁻¹² of its length points uphill.
    pub halvings: usize,
    /// A factorisation is kept while each step is shorter than this share of the one before.
    pub slow_contraction: f64,
    /// Ratio of two steps that is expected of a fresh factorisation until a second step has shown it. Where that was too
    /// hopeful, the next iteration starts from the residual that was left.
    pub fresh_contraction: f64,
    /// Ratio of two regularisations on the way from the largest slip to the law, where the methods above stall.
    pub continuation_ratio: f64,
    /// The last of them before the law itself, relative to the largest slip.
    pub least_regularisation: f64,
    /// Residual to which those before the law are solved, relative to the largest pressure.
    pub continuation_tolerance: f64,
    /// Work of a sub-step, in multiplications and additions, after which no longer way is begun.
    pub work: u64,
    /// Limit of the arcs along the path of solutions, where that way does not lead to the law.
    pub arcs: usize,
    /// Newton steps back to the path after one of them.
    pub arc_corrections: usize,
    /// Residual at which it is on the path, relative to the largest pressure: a rougher one passes by where the path turns back.
    pub arc_tolerance: f64,
    /// Length of the first, in decades of ε and largest pressures.
    pub first_arc: f64,
    /// The longest.
    pub largest_arc: f64,
    /// The shortest.
    pub least_arc: f64,
    /// Share of the residual by which a whole step has to lower it.
    pub least_decrease: f64,
    /// The smallest ratio of two steps that is believed: steps of the size of round-off say nothing.
    pub least_contraction: f64,
}

/// The wear of a step inside the normal problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WearComplianceSettings {
    /// Wear per pressure, relative to the smallest compliance, up to which the split converges fast with the wear of the
    /// iteration before.
    pub explicit: f64,
    /// Relative change of the wear compliance from which on it is computed anew.
    pub renewal: f64,
    /// First sweeps of a step, in which it follows the slip; then it stays. The interface vector holds the wear that it does not take, so that vectors beside different
    /// ones do not compare: under a wear law that jumps Anderson's method would diverge.
    pub sweeps: usize,
}

/// The surface condition of a column, and the wheel's rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatSettings {
    /// Limit of the Newton steps of one column's surface condition. Bisection alone would need 47: 2⁻⁴⁷ is the tolerance.
    pub surface_newton_steps: usize,
    /// Residual at which that condition holds, relative to the temperatures between which it is sought.
    pub surface_tolerance: f64,
    /// Limit of the iterations between rail and rim.
    pub rim_iterations: usize,
    /// Change of the rim's temperature at which they rest, relative to the absolute temperature: ten times the tolerance of
    /// the surface condition.
    pub rim_tolerance: f64,
    /// Iterations that reach this tolerance unless the conductance is extreme.
    pub rim_fast_iterations: usize,
    /// The tolerance after them, where the round-off of an extreme conductance is larger.
    pub rim_round_off: f64,
}

/// Derivatives of the outputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensitivitySettings {
    /// Change of the tangents, relative to the largest, at which the linear split has converged.
    pub tolerance: f64,
    /// Residual of the linear system, relative to its right-hand side, above which it counts as not solved: what round-off leaves may be
    /// more than `tolerance`.
    pub largest_residual: f64,
    /// Relative step of the central difference of the outputs along the tangent of the fields. The outputs are sums,
    /// products and ratios of the fields: truncation is 1e-14, round-off 1e-9.
    pub output_step: f64,
    /// Step of the differences for fields of which the outputs are linear functions or the largest value: temperature,
    /// displacement, wear and flux. It is larger, so that a change of the rail that hardly moves the tractions is not
    /// lost in round-off.
    pub linear_output_step: f64,
    /// Factor on the step for outputs that it loses in round-off, because the fields that they hang on move less than others.
    pub wider_output_step: f64,
    /// Least step, relative to the nominal value of the input. Like bodies at creepage 0 have fields that are nothing but
    /// round-off, and a share of those is lost in the outputs that the others make; no contact changes within this step.
    pub least_output_step: f64,
}

impl Default for SplitSettings {
    fn default() -> Self {
        SplitSettings {
            iterations: 100,
            tolerance: 1e-9,
            shear_tolerance: 1e-9,
            fixed_point_iterations: 40,
            idle_iterations: 20,
            accepted_change: 0.0,
            stalled_tolerance: 1e-5,
            first_mechanics_tolerance: 1e-8,
            largest_mechanics_tolerance: 1e-8,
            mechanics_tolerance: 1e-4,
            least_seen_change: f64::INFINITY,
            last_mechanics_tolerance: 1e-12,
            mechanics_alone_tolerance: 1e-11,
            negligible: 0.1,
            accelerate_after: 1,
            plain_below: 0.0,
            least_temperature: 1.0,
            trusted_contraction: 0.3,
            sharpening: 0.1,
            set_margin: 0.1,
            least_contraction: 1e-3,
        }
    }
}

impl Default for MechanicsSettings {
    fn default() -> Self {
        MechanicsSettings {
            iterations: 40,
            overlap: 1e-9,
            least_load: 1e-12,
            linearisation_tolerance: 1e-10,
        }
    }
}

impl MechanicsSettings {
    /// Load that the contact carries: none where it is negligible.
    pub fn carried_load(&self, load: f64, largest_load: f64) -> f64 {
        if load < self.least_load * largest_load {
            0.0
        } else {
            load
        }
    }
}

impl Default for NormalSettings {
    fn default() -> Self {
        NormalSettings {
            round_off: 1e-13,
            set_exchanges: 4,
            exchanges: 40,
            descents_per_node: 4,
            linearisations: 200_000,
            linearisation_tolerance: 1e-12,
        }
    }
}

impl Default for TangentialSettings {
    fn default() -> Self {
        TangentialSettings {
            newton_steps: 60,
            exchanges: 12,
            path_exchanges_per_node: 3,
            round_off: 1e-13,
            halvings: 12,
            slow_contraction: 0.1,
            fresh_contraction: 0.01,
            continuation_ratio: 0.1,
            least_regularisation: 1e-7,
            continuation_tolerance: 1e-4,
            work: 20_000_000,
            arcs: 120,
            arc_corrections: 8,
            arc_tolerance: 1e-8,
            first_arc: 0.3,
            largest_arc: 1.0,
            least_arc: 1e-5,
            least_decrease: 1e-4,
            least_contraction: 1e-3,
        }
    }
}

impl Default for WearComplianceSettings {
    fn default() -> Self {
        WearComplianceSettings {
            explicit: 0.05,
            renewal: 0.1,
            sweeps: 3,
        }
    }
}

impl Default for HeatSettings {
    fn default() -> Self {
        HeatSettings {
            surface_newton_steps: 60,
            surface_tolerance: 1e-14,
            rim_iterations: 50,
            rim_tolerance: 1e-13,
            rim_fast_iterations: 10,
            rim_round_off: 1e-12,
        }
    }
}

impl Default for SensitivitySettings {
    fn default() -> Self {
        SensitivitySettings {
            tolerance: 1e-9,
            largest_residual: 1e-6,
            output_step: 1e-7,
            linear_output_step: 1e-5,
            wider_output_step: 100.0,
            least_output_step: 1e-9,
        }
    }
}

impl Settings {
    /// Settings with which a step is solved or refused, whatever work it takes up to a hundred times the usual budget: none is taken
    /// staggered.
    pub fn strict() -> Settings {
        let mut settings = Settings::default();
        settings.step.staggered_substeps = 0;
        settings.step.work *= 100;
        settings
    }
}
