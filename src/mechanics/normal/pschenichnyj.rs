//! The paper's method for the normal problem.

use super::normal_problem::{Constraint, NormalProblem, NormalSolution};
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::settings::NormalSettings;

/// Pschenichnyj's linearisation method (section 4.1 of the paper; Pschenichnyj, Optimization 18, 1987).
///
/// Each step solves min ∇f·d + ½σ‖d‖² over the linearised constraints, here bounds and load, that is, projects
/// p − ∇f/σ, and moves along d as far as f falls. The penalty function of the paper is f itself, because every iterate
/// is feasible. σ is the curvature along the last step (Barzilai and Borwein), where the paper takes 1: with
/// σ = 1 in any units the method needs as many steps as the condition number of C, a few hundred times more.
#[derive(Debug, Clone)]
pub struct Pschenichnyj {
    settings: NormalSettings,
    gradient: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    sorted: Vec<f64>,
}

impl Pschenichnyj {
    /// Scratch for problems with `nodes` nodes.
    pub fn new(nodes: usize, settings: NormalSettings) -> Pschenichnyj {
        Pschenichnyj {
            settings,
            gradient: vec![0.0; nodes],
            direction: vec![0.0; nodes],
            image: vec![0.0; nodes],
            sorted: Vec::with_capacity(nodes),
        }
    }

    /// Solves from `pressure`, made feasible first.
    ///
    /// # Errors
    /// [`Error::NormalNotConverged`].
    pub fn solve(&mut self, problem: &NormalProblem, pressure: &mut [f64]) -> Result<NormalSolution> {
        let offset = match problem.constraint {
            Constraint::Penetration(penetration) => penetration,
            Constraint::Total(_) => 0.0,
        };
        self.project(problem, pressure);
        let mut curvature = (0..pressure.len()).map(|i| problem.compliance[(i, i)]).sum::<f64>();
        let mut residual = f64::INFINITY;
        for iterations in 1..=self.settings.linearisations {
            // ∇f = C p − b − δ (Step 2 of the paper's algorithm); anew each time, so that round-off does not pile up.
            for (g, b) in self.gradient.iter_mut().zip(problem.profile) {
                *g = -b - offset;
            }
            dense::multiply_add(problem.compliance, pressure, 1.0, &mut self.gradient);
            for ((d, p), g) in self.direction.iter_mut().zip(pressure.iter()).zip(&self.gradient) {
                *d = p - g / curvature;
            }
            let mut direction = std::mem::take(&mut self.direction);
            let multiplier = self.project(problem, &mut direction) * curvature;
            for (d, p) in direction.iter_mut().zip(pressure.iter()) {
                *d -= p;
            }
            self.direction = direction;

            let largest = pressure.iter().fold(f64::MIN_POSITIVE, |m, p| p.max(m));
            residual = self.direction.iter().fold(0.0, |m: f64, d| d.abs().max(m)) / largest;
            self.image.fill(0.0);
            dense::multiply_add(problem.compliance, &self.direction, 1.0, &mut self.image);
            // Along Σd = 0 the multiplier does not change the slope, but without it round-off of Σd would.
            for g in &mut self.gradient {
                *g -= multiplier;
            }
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let slope = dot(&self.gradient, &self.direction);
            let bend = dot(&self.image, &self.direction);
            if residual <= self.settings.linearisation_tolerance || slope >= 0.0 {
                // The projected point: its zeros are exact, where shortened steps leave a trace of pressure.
                for (p, d) in pressure.iter_mut().zip(&self.direction) {
                    *p = (*p + d).max(0.0);
                }
                let penetration = match problem.constraint {
                    Constraint::Penetration(penetration) => penetration,
                    Constraint::Total(_) => multiplier,
                };
                return Ok(NormalSolution {
                    penetration,
                    iterations,
                });
            }
            // Step 3: f is quadratic, the largest decrease along d is known.
            let step = (-slope / bend).min(1.0);
            for (p, d) in pressure.iter_mut().zip(&self.direction) {
                *p = (*p + step * d).max(0.0);
            }
            curvature = bend / dot(&self.direction, &self.direction);
        }
        Err(Error::NormalNotConverged {
            solver: "Pschenichnyj",
            iterations: self.settings.linearisations,
            residual,
            tolerance: self.settings.linearisation_tolerance,
        })
    }

    /// Projects onto p ≥ 0, 0 at the free ends, and onto Σp where that is given. Returns the shift λ of the projection
    /// max(v + λ, 0).
    fn project(&mut self, problem: &NormalProblem, values: &mut [f64]) -> f64 {
        let candidates = problem.candidates();
        values[..candidates.start].fill(0.0);
        values[candidates.end..].fill(0.0);
        let values = &mut values[candidates];
        let mut shift = 0.0;
        if let Constraint::Total(total) = problem.constraint {
            self.sorted.clear();
            self.sorted.extend_from_slice(values);
            self.sorted.sort_unstable_by(|a, b| b.total_cmp(a));
            let mut sum = 0.0;
            for (count, value) in self.sorted.iter().enumerate() {
                sum += value;
                let candidate = (total - sum) / (count + 1) as f64;
                if value + candidate > 0.0 {
                    shift = candidate;
                }
            }
        }
        for value in values {
            *value = (*value + shift).max(0.0);
        }
        shift
    }
}
