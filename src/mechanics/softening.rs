//! The wear of a step inside the normal problem.
//!
//! Wear within a step opens the gap in proportion to the pressure: W is a part that does not depend on the pressure of this
//! step, and the sum of ∂W/∂p p over the nodes. Where ∂W/∂p is not small against the compliance (a wheel that spins on the
//! spot, a soft rail), a split that takes the wear from the iteration before diverges. There the normal problem takes
//! ∂W/∂p into its compliance, as if the rail were softer, and the split iterates only on the rest of the wear.

use crate::settings::SofteningSettings;
use nalgebra::DMatrix;

/// The normal compliance with the wear of the step, n contact nodes, scaled.
#[derive(Debug, Clone)]
pub struct Softening {
    settings: SofteningSettings,
    /// ∂W/∂p of a node's own pressure, n; all zero where wear is explicit.
    own: Vec<f64>,
    /// Share of a node's wear that the march hands to the next node downstream.
    handed_on: f64,
    /// Whether material moves towards −x₁.
    forward: bool,
    compliance: DMatrix<f64>,
    smallest_compliance: f64,
    /// Whether the next update renews the softening, however small its change.
    stale: bool,
}

impl Softening {
    /// No softening of the given normal compliance, n × n.
    pub fn new(compliance: &DMatrix<f64>, settings: SofteningSettings) -> Softening {
        let n = compliance.nrows();
        // The least compliant pressure alternates from node to node.
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut alternating = 0.0;
        for i in 0..n {
            for j in 0..n {
                alternating += sign(i) * sign(j) * compliance[(i, j)];
            }
        }
        Softening {
            settings,
            own: vec![0.0; n],
            handed_on: 0.0,
            forward: true,
            compliance: compliance.clone(),
            smallest_compliance: alternating / n as f64,
            stale: true,
        }
    }

    /// The normal compliance with the wear of the step.
    pub fn compliance(&self) -> &DMatrix<f64> {
        &self.compliance
    }

    /// Makes the next [`Softening::update`] compute the softening anew: a step follows from its state alone, not from what an
    /// earlier step has left here.
    pub fn start_step(&mut self) {
        self.stale = true;
    }

    /// Adapts to slip velocities `m/s` and step: `per_slip` is the wear rate per pressure and slip, `storage` 1/Δt and
    /// `advection` |V|/Δx. Returns whether the compliance changed.
    pub fn update(
        &mut self,
        stiff: &DMatrix<f64>,
        slip: &[f64],
        per_slip: f64,
        storage: f64,
        advection: f64,
        forward: bool,
    ) -> bool {
        let rate = storage + advection;
        let factor = if rate > 0.0 { per_slip / rate } else { 0.0 };
        let largest = factor * slip.iter().fold(0.0, |m: f64, s| s.abs().max(m));
        let was_soft = self.is_soft();
        if largest <= self.settings.explicit * self.smallest_compliance {
            if was_soft {
                self.own.fill(0.0);
                self.compliance.copy_from(stiff);
            }
            return was_soft;
        }
        let handed_on = advection / rate;
        let change = self
            .own
            .iter()
            .zip(slip)
            .fold(0.0, |m: f64, (own, s)| (own - factor * s.abs()).abs().max(m));
        let stale = std::mem::take(&mut self.stale);
        if !stale && change <= self.settings.renewal * largest && handed_on == self.handed_on && forward == self.forward
        {
            return false;
        }
        for (own, slip) in self.own.iter_mut().zip(slip) {
            *own = factor * slip.abs();
        }
        self.handed_on = handed_on;
        self.forward = forward;
        self.compliance.copy_from(stiff);
        for node in 0..slip.len() {
            let (mut depth, mut row) = (self.own[node], Some(node));
            while let Some(worn) = row.filter(|_| depth > 0.0) {
                self.compliance[(worn, node)] += depth;
                depth *= handed_on;
                row = self.downstream(worn);
            }
        }
        true
    }

    /// Takes the proportional part off the wear, in place.
    pub fn subtract_proportional(&self, pressure: &[f64], wear: &mut [f64]) {
        if !self.is_soft() {
            return;
        }
        let n = wear.len();
        let mut carried = 0.0;
        for k in 0..n {
            let node = if self.forward { n - 1 - k } else { k };
            carried = self.handed_on * carried + self.own[node] * pressure[node];
            wear[node] -= carried;
        }
    }

    fn is_soft(&self) -> bool {
        self.own.iter().any(|own| *own > 0.0)
    }

    fn downstream(&self, node: usize) -> Option<usize> {
        if self.forward {
            node.checked_sub(1)
        } else {
            Some(node + 1).filter(|&next| next < self.own.len())
        }
    }
}
