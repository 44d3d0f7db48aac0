//! The tangential problem of the iteration: friction on the nodes under pressure, gathered from the tractions and scattered to them.

use super::Mechanics;
use crate::error::Result;
use crate::mechanics::leading_edge::LeadingEdge;
use crate::mechanics::response::Response;
use crate::mechanics::tangential::{LeadingRows, Tangential, TangentialProblem};
use crate::mechanics::traction_problem::{TractionProblem, Tractions, node_ahead};
use crate::numerics::dense;

impl Mechanics {
    /// Updates ∂s/∂τ to the response of the displacement, with the weights of [`TractionProblem::slip_weights`].
    fn update_slip_response(&mut self, problem: &TractionProblem) {
        let weights = problem.slip_weights();
        if self.slip_weights == Some(weights) {
            return;
        }
        self.slip_weights = Some(weights);
        let (span, m) = (self.response.span(), self.nodes.len());
        let forward = problem.is_forward();
        let columns = self.response.displacement().chunks_exact(span.len().max(1));
        for (slips, displacement) in self.slip_response.chunks_exact_mut(m.max(1)).zip(columns).take(m) {
            for (slip, &node) in slips.iter_mut().zip(&self.nodes) {
                let here = displacement[node - span.start];
                let ahead = displacement[node_ahead(node, forward) - span.start];
                *slip = weights.strain * (here - ahead) + weights.change * here;
            }
        }
    }

    /// Leading edge of the nodes under pressure.
    pub(in crate::mechanics) fn leading_rows(&self, problem: &TractionProblem) -> LeadingRows<'_> {
        leading_rows(problem, &self.response, &self.nodes, self.gap)
    }

    /// Runs a method on the friction problem of the nodes under pressure.
    fn with_friction<R>(
        &mut self,
        problem: &TractionProblem,
        tolerance: f64,
        run: impl FnOnce(&mut Tangential, &TangentialProblem) -> R,
    ) -> R {
        let (local, m) = (&self.local, self.nodes.len());
        let tangential = TangentialProblem {
            pressure: &local.pressure[..m],
            slip: &local.slip[..m],
            pressure_response: self.response.pressure(),
            slip_response: &self.slip_response,
            friction: &local.friction[..m],
            path: problem.path.as_ref().map(|(law, _)| (*law, &local.path[..m])),
            leading: leading_rows(problem, &self.response, &self.nodes, self.gap),
            regularisation: problem.regularisation,
            accepts_regularised: problem.accepts_regularised,
            tolerance,
        };
        run(&mut self.tangential, &tangential)
    }

    /// Factorises the friction law at the point of the last solve. False where its matrix is singular.
    pub(in crate::mechanics) fn factorise_friction(&mut self, problem: &TractionProblem, tolerance: f64) -> bool {
        self.with_friction(problem, tolerance, |tangential, friction| {
            tangential.linearise(friction)
        })
    }

    /// Solves friction for given pressure and its response; pressure and penetration follow. Returns the largest change of the shear.
    pub(super) fn solve_friction(
        &mut self,
        problem: &TractionProblem,
        tractions: &mut Tractions,
        tolerance: f64,
    ) -> Result<f64> {
        let clamped = clamp_shear(problem, tractions);
        tractions.friction.copy_from_slice(problem.friction);
        if self.nodes.is_empty() {
            clear_slip(problem, tractions);
            return Ok(clamped);
        }
        self.gather(problem, tractions);
        self.prepare_path(problem);
        let m = self.nodes.len();
        let (mut shear, utilisation) = (
            std::mem::take(&mut self.local.shear),
            std::mem::take(&mut self.local.utilisation),
        );
        let solved = self.with_friction(problem, tolerance, |tangential, friction| {
            tangential.solve(friction, &utilisation[..m], &mut shear[..m])
        });
        (self.local.shear, self.local.utilisation) = (shear, utilisation);
        let change = solved?;
        self.scatter(problem, tractions);
        Ok(change.max(clamped))
    }

    /// Copies the tractions from which friction is solved to the nodes under pressure, with the slip at the start.
    fn gather(&mut self, problem: &TractionProblem, tractions: &Tractions) {
        self.displacement.copy_from_slice(problem.displacement);
        problem
            .compliance
            .add_along(1.0, tractions.pressure, tractions.shear, &mut self.displacement);
        self.update_slip_response(problem);
        for (row, &node) in self.nodes.iter().enumerate() {
            self.local.pressure[row] = tractions.pressure[node];
            self.local.shear[row] = tractions.shear[node];
            self.local.friction[row] = problem.friction[node];
            self.local.utilisation[row] = tractions.utilisation[node];
            self.local.slip[row] = problem.law_slip(&self.displacement, node);
        }
    }

    /// Sets the tractions to the solution, with displacement, slip and penetration that follow the change of the shear.
    fn scatter(&mut self, problem: &TractionProblem, tractions: &mut Tractions) {
        let m = self.nodes.len();
        let point = self.tangential.point(m);
        let span = self.response.span();
        dense::multiply_columns(
            self.response.displacement(),
            span.len(),
            point.change,
            &mut self.displacement[span],
        );
        *tractions.penetration += dense::dot(&self.response.penetration()[..m], point.change);
        tractions.shear.fill(0.0);
        clear_slip(problem, tractions);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.shear[node] = self.local.shear[row];
            tractions.slip[node] = problem.mean_slip(&self.displacement, node);
            tractions.utilisation[node] = point.utilisation[row];
            tractions.pressure[node] = point.pressure[row];
        }
        if problem.path.is_some() {
            for (row, &node) in self.nodes.iter().enumerate() {
                tractions.friction[node] = point.friction[row];
                tractions.surfaces[node] = point.of_slip[row].surfaces;
                tractions.flow[node] = point.of_slip[row].flow();
                tractions.speed[node] = point.slip[row].abs();
                tractions.share[node] = point.of_slip[row].share;
                tractions.layer_bound[node] = point.of_slip[row].layer_bound();
            }
        }
    }

    /// Sets the friction law of the nodes under pressure for the history that their particles bring along.
    fn prepare_path(&mut self, problem: &TractionProblem) {
        let Some((law, path)) = &problem.path else {
            return;
        };
        let nodes = &self.nodes;
        let (forward, m) = (law.is_forward(), nodes.len());
        let laws = &mut self.local.path;
        let mut given = 0;
        let touches = |node: usize| nodes.binary_search(&node).is_ok();
        law.prepare(path, problem.friction, touches, |_, node| {
            laws[if forward { m - 1 - given } else { given }] = node;
            given += 1;
        });
    }
}

/// Clamps the shear of the first guess to Coulomb's bound: a shear left over from a much larger pressure would make strains that
/// outweigh those of this one. Returns the largest change.
fn clamp_shear(problem: &TractionProblem, tractions: &mut Tractions) -> f64 {
    let mut clamped = 0.0_f64;
    for (node, shear) in tractions.shear.iter_mut().enumerate() {
        let friction = match problem.path {
            None => problem.friction[node],
            // Rail that cools remembers a smaller μ than its static one, rail that warms a larger one.
            Some(_) => problem.friction[node].max(tractions.friction[node]),
        };
        let bound = friction * tractions.pressure[node];
        let within = shear.clamp(-bound, bound);
        clamped = clamped.max((*shear - within).abs());
        *shear = within;
    }
    clamped
}

/// Sets slip and what follows from it to 0.
fn clear_slip(problem: &TractionProblem, tractions: &mut Tractions) {
    tractions.slip.fill(0.0);
    tractions.utilisation.fill(0.0);
    if problem.path.is_some() {
        tractions.speed.fill(0.0);
        tractions.flow.fill(0.0);
    }
}

/// Leading edge of the nodes under pressure, with the separation `gap` ahead of it.
fn leading_rows<'a>(problem: &TractionProblem, response: &'a Response, nodes: &[usize], gap: f64) -> LeadingRows<'a> {
    let m = nodes.len();
    let forward = problem.is_forward();
    // Rows from the leading node on; a contact of fewer than three nodes has only the first.
    let last = m.saturating_sub(1);
    let rows = [0, 1, 2].map(|k: usize| if forward { last - k.min(last) } else { k.min(last) });
    LeadingRows {
        edge: LeadingEdge {
            near_field: problem.near_field,
            resolved: m >= 4 && nodes[rows[0]].abs_diff(nodes[rows[2]]) == 2,
            forward,
            strain_speed: problem.strain_speed.abs(),
        },
        rows,
        gap,
        gap_response: response.gap(),
    }
}
