//! How pressure, penetration and strain respond to the shear while the active set stays.
//!
//! On the active nodes the separation is zero, so that pressure and penetration are affine functions of the shear. With
//! Π = C_AA⁻¹ where the penetration is given, and Π = C_AA⁻¹ − C_AA⁻¹1 1ᵀC_AA⁻¹ / (1ᵀC_AA⁻¹1) where the load is,
//!
//! ∂p/∂τ = Π C_nt,  ∂u₁/∂τ = C_tt − C_tn ∂p/∂τ.

use super::normal::active_set::ActiveSet;
use super::problem::{MechanicsProblem, node_ahead};
use crate::body::compliance::Compliance;
use crate::numerics::dense;

/// The response on the m nodes under pressure, of n contact nodes.
#[derive(Debug, Clone)]
pub struct Response {
    /// What it was computed for; another kind of problem has another response.
    kind: Kind,
    nodes: Vec<usize>,
    /// ∂p/∂τ, m × m.
    pressure: Vec<f64>,
    /// ∂δ/∂τ, m.
    penetration: Vec<f64>,
    /// ∂(u₁ − u₁ of the node ahead)/∂τ, m × m.
    strain: Vec<f64>,
    /// Displacement along x₁ under the shear on one node and the pressure that follows, n.
    displacement: Vec<f64>,
    /// Upward displacement of the nodes under pressure by the shear on one node, m.
    lift: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Kind {
    forward: bool,
    load_given: bool,
    /// Whether the pressure follows the shear, or stays as in the paper's alternation.
    follows: bool,
}

impl Response {
    /// Room for `nodes` contact nodes.
    pub fn new(nodes: usize) -> Response {
        Response {
            kind: Kind {
                forward: true,
                load_given: true,
                follows: true,
            },
            nodes: Vec::with_capacity(nodes),
            pressure: vec![0.0; nodes * nodes],
            penetration: vec![0.0; nodes],
            strain: vec![0.0; nodes * nodes],
            displacement: vec![0.0; nodes],
            lift: vec![0.0; nodes],
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

    /// ∂(u₁ − u₁ of the node ahead)/∂τ, m × m.
    pub fn strain(&self) -> &[f64] {
        &self.strain
    }

    /// Makes this the response on `nodes`, ascending, the active ones of `active_set`'s last solve where the pressure is
    /// to follow. Returns whether it changed.
    pub fn update(
        &mut self,
        problem: &MechanicsProblem,
        nodes: &[usize],
        active_set: &ActiveSet,
        follows: bool,
    ) -> bool {
        let kind = Kind {
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
        self.compute(problem.compliance, active_set);
        true
    }

    fn compute(&mut self, compliance: &Compliance, active_set: &ActiveSet) {
        let nodes = &self.nodes;
        let m = nodes.len();
        let (inverse, unit) = active_set.inverse();
        let unit_sum: f64 = unit.iter().sum();
        for (column, &loaded) in nodes.iter().enumerate() {
            let range = column * m..(column + 1) * m;
            let (pressure, strain) = (&mut self.pressure[range.clone()], &mut self.strain[range]);
            pressure.fill(0.0);
            self.penetration[column] = 0.0;
            if self.kind.follows {
                for (lift, &node) in self.lift.iter_mut().zip(nodes) {
                    *lift = compliance.normal_tangential[(node, loaded)];
                }
                dense::multiply(inverse, m, &self.lift, pressure);
                if self.kind.load_given {
                    let total = pressure.iter().sum::<f64>() / unit_sum;
                    dense::add_multiple(unit, -total, pressure);
                    self.penetration[column] = -total;
                }
            }
            // Column by column, and only those of nodes under pressure: a product with the whole matrix would read all n.
            self.displacement
                .copy_from_slice(compliance.tangential_tangential.column(loaded).as_slice());
            for (&node, &p) in nodes.iter().zip(pressure.iter()) {
                if p != 0.0 {
                    let moved = compliance.tangential_normal.column(node);
                    dense::vectorised(
                        #[inline(always)]
                        |arithmetic| arithmetic.add_multiple(moved.as_slice(), -p, &mut self.displacement),
                    );
                }
            }
            for (strain, &node) in strain.iter_mut().zip(nodes) {
                *strain = self.displacement[node] - self.displacement[node_ahead(node, self.kind.forward)];
            }
        }
    }
}
