//! Newton's method on the interface vector, x − G(x) = 0, for steps whose fixed-point iteration does not contract.
//!
//! Friction and contact make G piecewise smooth: its derivative is that of the nodes that touch, stick and slip at x (a semismooth
//! Newton method). Each step solves (1 − G′) d = G(x) − x by GMRES ([`super::linear`]) and is shortened until |x − G(x)| falls.

use super::convergence::ConvergenceTest;
use super::engine::{Engine, Linearised};
use super::interface::Interface;
use super::linear::LinearSystem;
use super::problem::Problem;
use super::rail_and_rim;
use super::work::Work;
use crate::error::Result;
use crate::mechanics::normal_tangential::TractionChange;
use crate::settings::Settings;

/// Solvers and buffers of Newton's method, and of the derivatives of a step.
pub struct Newton<E: Engine> {
    pub(super) tangent: E::Tangent,
    pub(super) system: LinearSystem<E>,
    /// Newton's step.
    pub(super) step: Interface,
    /// Fields that have moved along a change.
    pub(super) moved: E::Fields,
    /// Iterate that the line search starts from.
    origin: Interface,
    /// Iterate with the least change so far, and that change: where Newton's method begins, and what a step ends with that gets no
    /// further.
    closest: Closest,
    /// Iterations of the fixed point since its change was halved last, and that change.
    idle: usize,
    halved: f64,
}

/// Iterate with the least change of a step.
struct Closest {
    iterate: Interface,
    change: f64,
}

impl Closest {
    /// Keeps an iterate if its change is the least so far.
    fn keep(&mut self, iterate: &Interface, change: f64) {
        if change < self.change {
            self.change = change;
            self.iterate.copy_from(iterate);
        }
    }
}

impl<E: Engine> Newton<E> {
    /// Solvers for a contact.
    pub fn new(operators: &E, settings: &Settings) -> Newton<E> {
        let interface = operators.interface();
        Newton {
            tangent: operators.tangent(settings),
            system: LinearSystem::new(operators, settings),
            step: interface.clone(),
            moved: operators.fields(),
            closest: Closest {
                iterate: interface.clone(),
                change: f64::INFINITY,
            },
            origin: interface,
            idle: 0,
            halved: f64::INFINITY,
        }
    }

    /// Whether the closest iterate so far changes by no more than a tolerance.
    pub fn is_close(&self, tolerance: f64) -> bool {
        self.closest.change <= tolerance
    }

    /// Sets the iterate to the closest one so far.
    pub fn take_closest(&self, iterate: &mut Interface) {
        iterate.copy_from(&self.closest.iterate);
    }

    /// Forgets the step before.
    pub fn restart(&mut self) {
        (self.halved, self.idle) = (f64::INFINITY, 0);
        self.forget_closest();
    }

    /// Forgets the closest iterate so far.
    pub fn forget_closest(&mut self) {
        self.closest.change = f64::INFINITY;
    }

    /// Keeps an iterate of the fixed-point iteration if its change is the least so far. Returns for how many iterations the change has
    /// not been halved.
    pub fn keep(&mut self, iterate: &Interface, change: f64) -> usize {
        self.closest.keep(iterate, change);
        self.idle += 1;
        if change < 0.5 * self.halved {
            (self.halved, self.idle) = (change, 0);
        }
        self.idle
    }
}

/// Buffers that a sweep of Newton's method works on.
pub struct Sweeps<'a, E: Engine> {
    /// Fields at the beginning of the step.
    pub before: &'a E::Fields,
    /// Fields that it changes.
    pub now: &'a mut E::Fields,
    /// Solvers of the step.
    pub solvers: &'a mut E::Solvers,
    /// Iterate.
    pub iterate: &'a mut Interface,
    /// Image of the iterate.
    pub image: &'a mut Interface,
}

impl<E: Engine> Sweeps<'_, E> {
    /// One sweep, whose work is counted. The inner error is that of a solver.
    fn counted_sweep(&mut self, problem: &Problem<E>, work: &mut Work) -> Result<Result<f64>> {
        let before = E::mechanics_work(self.solvers);
        let residual = self.sweep(problem);
        work.add(problem.operators.sweep_work() + E::mechanics_work(self.solvers).saturating_sub(before))?;
        Ok(residual)
    }

    /// One sweep x ↦ G(x), with converged mechanics and the wheel at the temperature of the iterate: a function of x
    /// and of the fields before, whatever was swept last. Returns |x − G(x)|.
    fn sweep(&mut self, problem: &Problem<E>) -> Result<f64> {
        let settings = &problem.settings.interface;
        let tolerance = E::split_settings(problem.settings).last_mechanics_tolerance;
        for _ in 0..settings.mechanics_sweeps {
            let TractionChange {
                shear_change,
                set_changed,
                ..
            } = E::solve_mechanics(problem, self.iterate, self.now, self.solvers, tolerance)?;
            if !set_changed && shear_change <= settings.mechanics_tolerance.max(10.0 * tolerance) {
                break;
            }
        }
        E::march_wear(problem, self.before, self.now, self.solvers);
        let rise = problem.wheel_rise(self.iterate.wheel_temperature());
        problem.operators.set_surface_temperature(self.iterate, self.now);
        E::march_heat(problem, self.before, rise, self.now, self.solvers)?;
        rail_and_rim::warm_wheel(problem, self.before, self.now);
        E::map_displacement(problem, self.now, self.solvers);
        E::read(problem, self.now, self.solvers, self.image);
        Ok(distance(self.iterate, self.image))
    }
}

/// Solves x = G(x) from the closest iterate so far, within a share of the work. The caller sweeps the iterate that it ends with once more: where it
/// gets no further than the fixed point, that is the closest one. Returns the number of sweeps and whether that iterate is the solution, or as good
/// as one.
///
/// # Errors
/// A budget of work that is spent.
pub fn solve<E: Engine>(
    problem: &Problem<E>,
    newton: &mut Newton<E>,
    mut sweeps: Sweeps<E>,
    test: &mut ConvergenceTest,
    work: &mut Work,
) -> Result<(usize, bool)> {
    let mut share = work.share(problem.settings.interface.work);
    let end = solve_within(problem, newton, &mut sweeps, test, &mut share);
    work.add(share.spent())?;
    Ok(end.unwrap_or_else(|_| {
        newton.take_closest(sweeps.iterate);
        (0, false)
    }))
}

/// Solves x = G(x) within the given work.
///
/// # Errors
/// A solver that fails where it begins, or a budget of work that is spent.
fn solve_within<E: Engine>(
    problem: &Problem<E>,
    newton: &mut Newton<E>,
    sweeps: &mut Sweeps<E>,
    test: &mut ConvergenceTest,
    work: &mut Work,
) -> Result<(usize, bool)> {
    let settings = problem.settings.interface;
    let split = E::split_settings(problem.settings);
    let Newton {
        tangent,
        system,
        step,
        origin,
        closest,
        ..
    } = newton;
    sweeps.iterate.copy_from(&closest.iterate);
    let mut residual = sweeps.counted_sweep(problem, work)??;
    let (mut count, mut jumps) = (1, 0);
    for _ in 0..settings.newton_steps {
        let change = sweeps.iterate.change_to(sweeps.image, split.least_temperature);
        test.amend(change);
        closest.keep(sweeps.iterate, change);
        if change <= settings.newton_margin * split.tolerance {
            return Ok((count, true));
        }
        origin.copy_from(sweeps.iterate);
        let values = sweeps.iterate.values().iter().zip(sweeps.image.values());
        for (step, (iterate, image)) in step.values_mut().iter_mut().zip(values) {
            *step = image - iterate;
        }
        E::finalise_displacement(problem, sweeps.iterate, sweeps.now, sweeps.solvers);
        let tolerance = settings.krylov_tolerance;
        let mut at = Linearised::new(problem, sweeps.iterate, sweeps.now, sweeps.solvers, tangent, tolerance)?;
        // One correction: Newton's method takes a step that is not quite exact.
        let left = system.solve(&mut at, step.values_mut(), settings.newton_krylov_tolerance, 1)?;
        // Next to a singular matrix single precision overflows.
        if !left.is_finite() {
            break;
        }
        work.add(system.products() * problem.operators.sweep_work())?;
        let mut damping = 1.0;
        let mut falls = false;
        for _ in 0..=settings.halvings {
            set_iterate(sweeps.iterate, origin, step, damping);
            count += 1;
            // Where a solver fails, the step is too long.
            let trial = sweeps.counted_sweep(problem, work)?.unwrap_or(f64::INFINITY);
            if trial < (1.0 - settings.descent * damping) * residual {
                residual = trial;
                falls = true;
                break;
            }
            damping *= 0.5;
        }
        if count > settings.newton_sweeps {
            break;
        }
        if !falls {
            // A node that has several temperatures has left the one that it had: the solution, if there is one, is on the other side of
            // the jump.
            if jumps == settings.jumps {
                break;
            }
            jumps += 1;
            set_iterate(sweeps.iterate, origin, step, 1.0);
            count += 1;
            residual = sweeps.counted_sweep(problem, work)??;
        }
    }
    // It gets no further: the closest iterate may be as good as the mesh all the same.
    sweeps.iterate.copy_from(&closest.iterate);
    Ok((count, closest.change <= split.stalled_tolerance))
}

/// Sets the iterate to where the line search starts, moved by `damping` times a step.
fn set_iterate(iterate: &mut Interface, origin: &Interface, step: &Interface, damping: f64) {
    let values = origin.values().iter().zip(step.values());
    for (iterate, (origin, step)) in iterate.values_mut().iter_mut().zip(values) {
        *iterate = origin + damping * step;
    }
}

/// |x − G(x)|.
fn distance(iterate: &Interface, image: &Interface) -> f64 {
    let values = iterate.values().iter().zip(image.values());
    values.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}
