//! Wear compliance: the wear of a step inside the normal problem.
//!
//! Wear within a step opens the gap in proportion to the pressure: W is a part that does not depend on the pressure of this
//! step, and the sum of ∂W/∂p p over the nodes. Where ∂W/∂p is not small against the compliance (a wheel that spins on the
//! spot, a soft rail), a split that takes the wear from the iteration before diverges. There the normal problem takes
//! ∂W/∂p, the wear compliance, into its compliance, as if the rail were softer, and the split iterates only on the rest of the wear.

use crate::settings::WearComplianceSettings;
use crate::transport::CellStep;
use nalgebra::DMatrix;

/// Normal compliance with the wear compliance of the step, n contact nodes, scaled.
#[derive(Debug, Clone)]
pub struct WearCompliance {
    settings: WearComplianceSettings,
    /// Diagonal of ∂W/∂p, by a node's own pressure, n; all zero where wear is explicit.
    diagonal: Vec<f64>,
    /// March from node to node.
    step: CellStep,
    /// Whether material moves towards −x₁.
    forward: bool,
    compliance: DMatrix<f64>,
    smallest_compliance: f64,
    /// Whether the next update renews the wear compliance, however small its change.
    stale: bool,
}

impl WearCompliance {
    /// No wear compliance on top of the given normal compliance, n × n.
    pub fn new(compliance: &DMatrix<f64>, settings: WearComplianceSettings) -> WearCompliance {
        let n = compliance.nrows();
        // The least compliant pressure alternates from node to node.
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut alternating = 0.0;
        for i in 0..n {
            for j in 0..n {
                alternating += sign(i) * sign(j) * compliance[(i, j)];
            }
        }
        WearCompliance {
            settings,
            diagonal: vec![0.0; n],
            step: CellStep::NONE,
            forward: true,
            compliance: compliance.clone(),
            smallest_compliance: alternating / n as f64,
            stale: true,
        }
    }

    /// Normal compliance with the wear compliance of the step.
    pub fn compliance(&self) -> &DMatrix<f64> {
        &self.compliance
    }

    /// Makes the next [`WearCompliance::update`] compute everything anew: a step follows from its state alone, not from what an
    /// earlier step has left here.
    pub fn start_step(&mut self) {
        self.stale = true;
    }

    /// Adapts to slip velocities `m/s` and step: `per_slip` is the wear rate per pressure and slip, `step` the march of the
    /// wear from node to node. Returns whether the compliance changed.
    pub fn update(&mut self, stiff: &DMatrix<f64>, slip: &[f64], per_slip: f64, step: CellStep, forward: bool) -> bool {
        let fastest = slip.iter().fold(0.0, |m: f64, s| s.abs().max(m));
        let was_soft = self.is_soft();
        if per_slip * (step.upstream + step.diagonal) * fastest <= self.settings.explicit * self.smallest_compliance {
            if was_soft {
                self.diagonal.fill(0.0);
                self.compliance.copy_from(stiff);
            }
            return was_soft;
        }
        let factor = per_slip * step.diagonal;
        let largest = factor * fastest;
        let change = self
            .diagonal
            .iter()
            .zip(slip)
            .fold(0.0, |m: f64, (diagonal, s)| (diagonal - factor * s.abs()).abs().max(m));
        let stale = std::mem::take(&mut self.stale);
        if !stale && change <= self.settings.renewal * largest && step == self.step && forward == self.forward {
            return false;
        }
        for (diagonal, slip) in self.diagonal.iter_mut().zip(slip) {
            *diagonal = factor * slip.abs();
        }
        self.step = step;
        self.forward = forward;
        self.compliance.copy_from(stiff);
        for node in 0..slip.len() {
            // To the next node goes what stays of the node's own wear and what the march takes from a source upstream.
            let (mut depth, mut next) = (self.diagonal[node], self.passed_on() * self.diagonal[node]);
            let mut row = Some(node);
            while let Some(worn) = row.filter(|_| depth > 0.0) {
                self.compliance[(worn, node)] += depth;
                depth = self.step.courant_weight * depth + std::mem::take(&mut next);
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
        let passed_on = self.passed_on();
        let (mut carried, mut upstream) = (0.0, 0.0);
        for k in 0..n {
            let node = if self.forward { n - 1 - k } else { k };
            let worn = self.diagonal[node] * pressure[node];
            carried = self.step.courant_weight * carried + passed_on * upstream + worn;
            upstream = worn;
            wear[node] -= carried;
        }
    }

    /// Whether the compliance has the wear of the step in it.
    pub fn is_soft(&self) -> bool {
        self.diagonal.iter().any(|diagonal| *diagonal > 0.0)
    }

    /// Wear of the next node downstream over that of a node's own, both by the node's pressure alone.
    fn passed_on(&self) -> f64 {
        self.step.upstream / self.step.diagonal
    }

    fn downstream(&self, node: usize) -> Option<usize> {
        if self.forward {
            node.checked_sub(1)
        } else {
            Some(node + 1).filter(|&next| next < self.diagonal.len())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::transport::Upwind;
    use crate::wear::{WearMarch, WearSteps};

    /// Compares wear compliance and proportional part with the march of the wear under any pressure.
    #[test]
    fn the_proportional_part_is_that_of_the_march() {
        let n = 6;
        let x: Vec<f64> = (0..n + 2).map(|i| 0.2 * i as f64).collect();
        let stiff = DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 } else { 0.1 });
        let slip = [0.3, -0.2, 0.5, 0.1, 0.0, -0.4];
        let pressure = [0.0, 1.0, 3.0, 2.0, 0.5, 0.0];
        for (speed, duration) in [(2.0, 0.01), (2.0, 10.0), (-0.5, 1.0), (0.0, 3.0)] {
            let march = WearMarch {
                transport: Upwind::new(&x, speed),
                duration,
                first_contact: 1,
            };
            let rate: Vec<f64> = slip
                .iter()
                .zip(&pressure)
                .map(|(s, p): (&f64, _)| 70.0 * s.abs() * p)
                .collect();
            let mut worn = vec![0.0; n + 2];
            march.advance(&rate, &vec![0.0; n + 2], &mut worn, &mut WearSteps::new(&x));
            let mut wear_compliance = WearCompliance::new(&stiff, Settings::default().wear_compliance);
            let step = CellStep::new(1.0 / duration, 0.2, speed.abs());
            assert!(wear_compliance.update(&stiff, &slip, 70.0, step, speed >= 0.0));
            let mut rest = worn[1..=n].to_vec();
            wear_compliance.subtract_proportional(&pressure, &mut rest);
            for i in 0..n {
                let softened: f64 = (0..n)
                    .map(|j| (wear_compliance.compliance()[(i, j)] - stiff[(i, j)]) * pressure[j])
                    .sum();
                assert!(
                    (softened - worn[i + 1]).abs() < 1e-12,
                    "{speed} {i}: {softened} {}",
                    worn[i + 1]
                );
                assert!(rest[i].abs() < 1e-12);
            }
        }
    }
}
