//! Response of pressure, penetration, displacement and gap to the shear while the active set stays.
//!
//! On the active nodes the separation is zero, so that pressure and penetration are affine functions of the shear. With
//! Π = C_AA⁻¹ where the penetration is given, and Π = C_AA⁻¹ − C_AA⁻¹1 1ᵀC_AA⁻¹ / (1ᵀC_AA⁻¹1) where the load is,
//!
//! ∂p/∂τ = Π C_nt,  ∂u₁/∂τ = C_tt − C_tn ∂p/∂τ,  ∂w/∂τ = C_nn ∂p/∂τ − C_nt − ∂δ/∂τ.

use super::normal::active_set::ActiveSet;
use super::traction_problem::{TractionProblem, node_ahead};
use crate::numerics::dense;
use std::ops::Range;

/// Response on the m nodes under pressure, of n contact nodes.
#[derive(Debug, Clone)]
pub struct Response {
    /// Kind of problem that it was computed for; another kind has another response.
    kind: ResponseKind,
    nodes: Vec<usize>,
    /// Range of the nodes under pressure, those between them, and one more on either side.
    span: Range<usize>,
    /// ∂p/∂τ, m × m.
    pressure: Vec<f64>,
    /// ∂δ/∂τ, m.
    penetration: Vec<f64>,
    /// ∂u₁/∂τ, span × m.
    displacement: Vec<f64>,
    /// ∂w/∂τ of the node ahead of the leading one, m.
    gap: Vec<f64>,
    /// Displacement along x₁ under the shear on one node and the pressure that follows, n.
    moved: Vec<f64>,
    /// Upward displacement of the nodes under pressure by the shear on one node, m.
    upward: Vec<f64>,
    /// Normal compliance of the node ahead of the leading one, m.
    ahead: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct ResponseKind {
    forward: bool,
    load_given: bool,
    /// Whether the pressure follows the shear, or stays as in the paper's alternation.
    follows: bool,
}

impl Response {
    /// Room for `nodes` contact nodes.
    pub fn new(nodes: usize) -> Response {
        Response {
            kind: ResponseKind {
                forward: true,
                load_given: true,
                follows: true,
            },
            nodes: Vec::with_capacity(nodes),
            span: 0..0,
            pressure: vec![0.0; nodes * nodes],
            penetration: vec![0.0; nodes],
            displacement: vec![0.0; nodes * nodes],
            gap: vec![0.0; nodes],
            moved: vec![0.0; nodes],
            upward: vec![0.0; nodes],
            ahead: vec![0.0; nodes],
        }
    }

    /// Forgets the response: it belonged to another compliance.
    pub fn forget(&mut self) {
        self.nodes.clear();
    }

    /// ∂p/∂τ on the nodes under pressure, m × m.
    pub fn pressure(&self) -> &[f64] {
        &self.pressure
    }

    /// ∂δ/∂τ, m.
    pub fn penetration(&self) -> &[f64] {
        &self.penetration
    }

    /// ∂w/∂τ of the node ahead of the leading one, m.
    pub fn gap(&self) -> &[f64] {
        &self.gap[..self.nodes.len()]
    }

    /// Range of the nodes under pressure, those between them, and one more on either side: none of the window's ends is under
    /// pressure.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// ∂u₁/∂τ, span × m.
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// Node ahead of the leading one.
    pub fn node_ahead_of_the_contact(&self) -> Option<usize> {
        let leading = if self.kind.forward {
            self.nodes.last()
        } else {
            self.nodes.first()
        };
        leading.map(|&node| node_ahead(node, self.kind.forward))
    }

    /// Makes this the response on `nodes`, ascending, the active ones of `active_set`'s last solve where the pressure is
    /// to follow. Returns whether it changed.
    pub fn update(
        &mut self,
        problem: &TractionProblem,
        nodes: &[usize],
        active_set: &ActiveSet,
        follows: bool,
    ) -> bool {
        let kind = ResponseKind {
            forward: problem.is_forward(),
            load_given: problem.load_is_given(),
            follows,
        };
        if self.nodes == nodes && self.kind == kind {
            return false;
        }
        self.nodes.clear();
        self.nodes.extend_from_slice(nodes);
        self.kind = kind;
        self.span = match (nodes.first(), nodes.last()) {
            (Some(&first), Some(&last)) => first - 1..last + 2,
            _ => 0..0,
        };
        self.compute(problem, active_set);
        true
    }

    fn compute(&mut self, problem: &TractionProblem, active_set: &ActiveSet) {
        let compliance = problem.compliance;
        let node_ahead = self.node_ahead_of_the_contact();
        let nodes = &self.nodes;
        let (m, height) = (nodes.len(), self.span.len());
        let (inverse, unit) = active_set.inverse();
        let unit_sum: f64 = unit.iter().sum();
        if let Some(ahead) = node_ahead {
            for (own, &node) in self.ahead.iter_mut().zip(nodes) {
                *own = problem.normal_compliance[(ahead, node)];
            }
        }
        for (column, &loaded) in nodes.iter().enumerate() {
            let pressure = &mut self.pressure[column * m..(column + 1) * m];
            pressure.fill(0.0);
            self.penetration[column] = 0.0;
            self.gap[column] = 0.0;
            if self.kind.follows {
                for (upward, &node) in self.upward.iter_mut().zip(nodes) {
                    *upward = compliance.normal_tangential[(node, loaded)];
                }
                dense::multiply(inverse, m, &self.upward, pressure);
                if self.kind.load_given {
                    let total = pressure.iter().sum::<f64>() / unit_sum;
                    dense::add_multiple(unit, -total, pressure);
                    self.penetration[column] = -total;
                }
                if let Some(ahead) = node_ahead {
                    self.gap[column] = dense::dot(&self.ahead[..m], pressure)
                        - compliance.normal_tangential[(ahead, loaded)]
                        - self.penetration[column];
                }
            }
            // Column by column, and only those of nodes under pressure: a product with the whole matrix would read all n.
            let span = self.span.clone();
            let moved = &mut self.moved[..height];
            moved.copy_from_slice(&compliance.tangential_tangential.column(loaded).as_slice()[span.clone()]);
            for (&node, &p) in nodes.iter().zip(pressure.iter()) {
                if p != 0.0 {
                    let column = &compliance.tangential_normal.column(node);
                    dense::vectorised(
                        #[inline(always)]
                        |arithmetic| arithmetic.add_multiple(&column.as_slice()[span.clone()], -p, moved),
                    );
                }
            }
            self.displacement[column * height..(column + 1) * height].copy_from_slice(moved);
        }
    }
}
