//! Kinematics of the slip (16): the slip velocity that follows from the motion of the wheel and from displacements of the surface,
//! and its derivatives.
//!
//! The displacement u is that of the rail less that of the wheel, scaled. The slip of the law is taken between a node, or a cell, and
//! the one ahead of it, on the leading side: s = w + |V|/Δx (u − u ahead) + ∂u/∂t, where w is the rigid slip and the displacement
//! scale is in |V|/Δx and in ∂u/∂t. The rate of change is centred between the two by θ of [`Transient`],
//! ∂u/∂t = r (1 − θ) (u − u before) + r θ (u − u before) ahead, so that strain and rate together have the weights of [`SlipWeights`].

use super::traction_problem::{TractionProblem, TractionProblemTangent, node_ahead};
use super::transient::Transient;
use crate::signals::Motion;

/// Weights with which displacements enter the slip of the law, `m/s` per scaled displacement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SlipWeights {
    /// Weight |V|/Δx − θ r of the displacement u less that ahead.
    pub strain: f64,
    /// Weight r of u less u before the step.
    pub change: f64,
    /// Weight θ r of u before the step less that ahead then.
    pub strain_before: f64,
    /// Speed |V| times the displacement scale over the node spacing.
    pub strain_speed: f64,
}

impl SlipWeights {
    /// Weights for a rate of change of the displacement and a strain speed, `m/s`.
    pub fn new(transient: Transient, strain_speed: f64) -> SlipWeights {
        let centred = transient.centring * transient.rate;
        SlipWeights {
            strain: strain_speed - centred,
            change: transient.rate,
            strain_before: centred,
            strain_speed,
        }
    }

    /// Change of the weights with a change of |V| by `speed` `m/s`, under which the strain speed changes by `strain_speed` `m/s` and
    /// the rate of change by `per_speed` per `m/s`.
    pub fn tangent(transient: Transient, per_speed: Transient, speed: f64, strain_speed: f64) -> SlipWeights {
        let centred = speed * (per_speed.centring * transient.rate + transient.centring * per_speed.rate);
        SlipWeights {
            strain: strain_speed - centred,
            change: speed * per_speed.rate,
            strain_before: centred,
            strain_speed,
        }
    }

    /// Slip by the displacement u here and ahead, and u at both before the step, without the rigid slip, `m/s`.
    pub fn displaced(&self, [here, ahead]: [f64; 2], [before, before_ahead]: [f64; 2]) -> f64 {
        self.strain * (here - ahead) + self.strain_before * (before - before_ahead) + self.change * (here - before)
    }

    /// Slip by a rigid slip, `m/s`, and the displacement u here and ahead, and at both before the step.
    pub fn slip(&self, rigid: f64, [here, ahead]: [f64; 2], [before, before_ahead]: [f64; 2]) -> f64 {
        rigid
            + self.strain * (here - ahead)
            + self.strain_before * (before - before_ahead)
            + self.change * (here - before)
    }
}

/// Rigid slip of the rail relative to the wheel at a point under a motion, or its change under that of a motion, `m/s`:
/// w_x = V(ξ + φ y), w_y = −V(η + φ x).
pub fn rigid_slip(motion: &Motion, x: f64, y: f64) -> [f64; 2] {
    [
        motion.rigid_slip + motion.spin_rate * y,
        -(motion.lateral_speed + motion.spin_rate * x),
    ]
}

impl TractionProblem<'_> {
    /// Weights with which displacements enter the slip of the law.
    pub fn slip_weights(&self) -> SlipWeights {
        SlipWeights::new(self.transient, self.strain_speed.abs())
    }

    /// Slip velocity of the law at a node, without the leading-edge correction, `m/s`.
    pub fn law_slip(&self, displacement: &[f64], node: usize) -> f64 {
        let ahead = node_ahead(node, self.is_forward());
        let before = self.displacement_before;
        self.slip_weights().slip(
            self.rigid_slip,
            [displacement[node], displacement[ahead]],
            [before[node], before[ahead]],
        )
    }

    /// Change of [`TractionProblem::law_slip`] at a displacement, with the data and with `moved`, the change of the displacement.
    pub fn law_slip_tangent(
        &self,
        change: &TractionProblemTangent,
        displacement: &[f64],
        moved: &[f64],
        node: usize,
    ) -> f64 {
        let ahead = node_ahead(node, self.is_forward());
        let strain = |u: &[f64]| u[node] - u[ahead];
        let weights = self.slip_weights();
        let since = |i: usize| displacement[i] - self.displacement_before[i];
        let (now, change_of) = (self.transient, change.transient);
        let centred = change_of.centring * now.rate + now.centring * change_of.rate;
        change.rigid_slip
            + change.strain_speed * strain(displacement)
            + weights.strain * strain(moved)
            + weights.change * moved[node]
            + change_of.rate * since(node)
            - centred * (since(node) - since(ahead))
    }

    /// Slip velocity that heats, wears and takes power: the mean of those in the middle of the two cells beside a node, `m/s`.
    /// With it the work of the tractions on the body vanishes in the sum over the nodes, as it does on an elastic body, but for
    /// the edges. With the slip of the law, taken on one side, it would not.
    pub fn mean_slip(&self, displacement: &[f64], node: usize) -> f64 {
        self.rigid_slip
            + 0.5 * self.strain_speed * (displacement[node - 1] - displacement[node + 1])
            + self.transient.rate * (displacement[node] - self.displacement_before[node])
    }

    /// Change of [`TractionProblem::mean_slip`] at a displacement, with the data and with `moved`, the change of the displacement.
    pub fn mean_slip_tangent(
        &self,
        change: &TractionProblemTangent,
        displacement: &[f64],
        moved: &[f64],
        node: usize,
    ) -> f64 {
        let sign = if self.is_forward() { 1.0 } else { -1.0 };
        let strain = |u: &[f64]| 0.5 * (u[node - 1] - u[node + 1]);
        change.rigid_slip
            + sign * change.strain_speed * strain(displacement)
            + self.strain_speed * strain(moved)
            + change.transient.rate * (displacement[node] - self.displacement_before[node])
            + self.transient.rate * moved[node]
    }
}
