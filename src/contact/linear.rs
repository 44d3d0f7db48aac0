//! The linearised step: (1 − G′) dx = b for changes of the interface vector, by GMRES in single precision with a residual in double
//! precision. Newton's method and the derivatives of a step solve the same system.

use super::engine::{Along, Direction, Engine, Linearised};
use super::interface::Interface;
use super::rail_and_rim;
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::numerics::gmres::Gmres;
use crate::settings::Settings;

/// Change of the fields in one sweep, and the linear systems that it makes.
pub struct LinearSystem<E: Engine> {
    /// Change of the fields in the last sweep.
    pub change: E::Fields,
    gmres: Gmres,
    /// Image of a change of the interface vector.
    image: Interface,
    /// Change that a product is taken with.
    along: Interface,
    residual: Vec<f64>,
    correction: Vec<f32>,
    products: u64,
}

impl<E: Engine> LinearSystem<E> {
    /// Buffers for a contact.
    pub fn new(operators: &E, settings: &Settings) -> LinearSystem<E> {
        let along = operators.interface();
        let size = along.values().len();
        LinearSystem {
            change: operators.fields(),
            gmres: Gmres::new(size, settings.interface.krylov_iterations),
            image: along.clone(),
            residual: vec![0.0; size],
            correction: vec![0.0; size],
            products: 0,
            along,
        }
    }

    /// Solves (1 − G′) dx = `values`, in place, by at most so many corrections in single precision, until the residual is below
    /// `tolerance` relative to the values. Returns what it is in the end.
    ///
    /// # Errors
    /// A linear system of the sweep that cannot be solved.
    pub fn solve(
        &mut self,
        at: &mut Linearised<E>,
        values: &mut [f64],
        tolerance: f64,
        refinements: usize,
    ) -> Result<f64> {
        let LinearSystem {
            change,
            gmres,
            image,
            along,
            residual,
            correction,
            products,
        } = self;
        *products = 0;
        let settings = at.problem.settings.interface;
        begin_direction(at, &Direction::NONE, change);
        let size = norm(values);
        residual.copy_from_slice(values);
        values.fill(0.0);
        let mut left = size;
        for _ in 0..refinements {
            if left <= tolerance * size || size == 0.0 {
                break;
            }
            for (correction, residual) in correction.iter_mut().zip(&*residual) {
                *correction = (residual / left) as f32;
            }
            let asked = (tolerance * size / left).max(settings.krylov_tolerance) as f32;
            let mut failed = None;
            gmres.solve(correction, asked, |values, product| {
                for (along, value) in along.values_mut().iter_mut().zip(values) {
                    *along = f64::from(*value);
                }
                *products += 1;
                if let Err(error) = sweep_tangent(at, &Direction::NONE, along, change, image) {
                    failed = Some(error);
                }
                for ((product, value), image) in product.iter_mut().zip(values).zip(image.values()) {
                    *product = (f64::from(*value) - image) as f32;
                }
            });
            if let Some(error) = failed {
                return Err(error);
            }
            gmres.solution(correction);
            for (along, correction) in along.values_mut().iter_mut().zip(&*correction) {
                *along = f64::from(*correction);
            }
            // All products are with vectors of the size of 1: to that size are the systems within a sweep solved.
            sweep_tangent(at, &Direction::NONE, along, change, image)?;
            let changes = along.values().iter().zip(image.values());
            for ((value, residual), (along, image)) in values.iter_mut().zip(&mut *residual).zip(changes) {
                *value += left * along;
                *residual -= left * (along - image);
            }
            let before = left;
            left = norm(residual);
            // What round-off leaves does not get less.
            if !left.is_finite() || left > settings.least_refinement * before {
                break;
            }
        }
        Ok(dense::relative(left, size))
    }

    /// Products with the linearised sweep in the last solution.
    pub fn products(&self) -> u64 {
        self.products
    }

    /// Computes the change of the fields along a direction, with the interface vector following.
    ///
    /// # Errors
    /// [`Error::SensitivityNotConverged`], or a linear system of the sweep that cannot be solved.
    pub fn fields_tangent(
        &mut self,
        at: &mut Linearised<E>,
        direction: &Direction,
        following: &mut Interface,
    ) -> Result<()> {
        let settings = E::sensitivity_settings(at.problem.settings);
        let refinements = at.problem.settings.interface.refinements;
        following.values_mut().fill(0.0);
        begin_direction(at, direction, &mut self.change);
        sweep_tangent(at, direction, following, &mut self.change, &mut self.image)?;
        following.copy_from(&self.image);
        let residual = self.solve(at, following.values_mut(), settings.tolerance, refinements)?;
        if residual > settings.largest_residual {
            return Err(Error::SensitivityNotConverged {
                iterations: at.problem.settings.interface.krylov_iterations,
                residual,
                tolerance: settings.largest_residual,
            });
        }
        begin_direction(at, direction, &mut self.change);
        sweep_tangent(at, direction, following, &mut self.change, &mut self.image)?;
        if at.problem.conditions.duration > 0.0 {
            E::finalise_tangent(at, direction, &mut self.change);
        }
        Ok(())
    }
}

/// Begins the sweeps along a direction.
fn begin_direction<E: Engine>(at: &mut Linearised<E>, direction: &Direction, change: &mut E::Fields) {
    E::begin_direction(at.problem, at.fields, direction, change, at.tangent);
}

/// Computes the image under the linearised sweep: of changes of the inputs and of the interface vector. After initialisation, where no
/// time has passed, heat and wear do not follow.
fn sweep_tangent<E: Engine>(
    at: &mut Linearised<E>,
    direction: &Direction,
    interface: &Interface,
    change: &mut E::Fields,
    image: &mut Interface,
) -> Result<()> {
    let along = Along { direction, interface };
    if at.touches {
        E::mechanics_tangent(at, &along, change)?;
    }
    if at.problem.conditions.duration > 0.0 {
        E::march_tangent(at, &along, change)?;
        rail_and_rim::wheel_tangent(at, direction, change);
    } else {
        E::set_wheel_temperature(change, direction.inputs.ambient_temperature);
    }
    // Reading is linear: a change is read as the fields are.
    E::read(at.problem, change, at.solvers, image);
    Ok(())
}

/// |x|.
fn norm(values: &[f64]) -> f64 {
    dense::dot(values, values).sqrt()
}
