//! Wear (11), (24) with storage: ∂W/∂t − V ∂W/∂x₁ = k |s| p, the march of the heat without conduction. The right side is Archard's with one coefficient,
//! or one of the laws in [`law`].

pub mod law;
// The patch engine uses it.
#[allow(dead_code)]
pub mod strips;

use crate::transport::{CellEnds, CellStep, Cells, Upwind};

/// The step from the wear depth `before` to that at its end, `m`, at all columns.
pub struct WearMarch<'a> {
    /// Columns from inflow to outflow.
    pub transport: Upwind<'a>,
    /// Step Δt, `s`; infinite for the steady depth.
    pub duration: f64,
    /// First column of the contact window; wear rates start there.
    pub first_contact: usize,
}

/// Change of the data of a march.
#[derive(Debug, Clone, Copy)]
pub struct WearChange<'a> {
    /// Change of the wear rate k |s| p at the contact nodes or cells, `m/s`.
    pub rate: &'a [f64],
    /// Change of |V|, `m/s`.
    pub speed: f64,
}

/// Steps through the cells, one for each length. They depend on nothing that was asked before.
#[derive(Debug, Clone)]
pub struct WearSteps {
    cells: Cells,
    steps: Vec<CellStep>,
    /// Speed and Δt for which the steps were computed.
    conditions: (f64, f64),
}

impl WearSteps {
    /// Steps for the cells between columns at `x` `m`.
    pub fn new(x: &[f64]) -> WearSteps {
        let cells = Cells::new(x);
        WearSteps {
            steps: vec![CellStep::NONE; cells.lengths.len()],
            conditions: (f64::NAN, f64::NAN),
            cells,
        }
    }

    /// Computes the steps, unless the last ones were for the same speed and Δt.
    fn adapt(&mut self, speed: f64, duration: f64) {
        if self.conditions == (speed, duration) {
            return;
        }
        self.conditions = (speed, duration);
        for (step, length) in self.steps.iter_mut().zip(&self.cells.lengths) {
            *step = CellStep::new(1.0 / duration, *length, speed);
        }
    }
}

impl WearMarch<'_> {
    /// The depth `after` from that `before` under the wear rate k |s| p at the contact nodes, `m/s`. The inflow column of
    /// `after` holds what enters. `steps` are those between the columns.
    pub fn advance(&self, rate: &[f64], before: &[f64], after: &mut [f64], steps: &mut WearSteps) {
        steps.adapt(self.transport.speed(), self.duration);
        let storage = 1.0 / self.duration;
        let inflow = self.transport.inflow();
        let mut upstream = after[inflow];
        let mut upstream_source = storage * before[inflow];
        for column in self.transport.columns() {
            let step = steps.steps[steps.cells.length_of(&column)];
            let own_source = storage * before[column.index] + self.at(rate, column.index);
            // The depth upstream is added last: only this waits for the column upstream, all the rest can be computed meanwhile.
            let fed = step.upstream * upstream_source + step.diagonal * own_source;
            upstream = fed + step.courant_weight * upstream;
            upstream_source = own_source;
            after[column.index] = upstream;
        }
    }

    /// Computes the change of the result `after` with `change`.
    /// `replaced` is the depth that stood in the inflow column before. The inflow column of `tangent` holds the change of what
    /// enters.
    pub fn advance_tangent(&self, change: WearChange, replaced: f64, after: &[f64], tangent: &mut [f64]) {
        let (storage, speed) = (1.0 / self.duration, self.transport.speed());
        // The sources of the step follow from its result.
        let mut upstream_source = storage * replaced;
        let mut upstream_change = 0.0;
        for column in self.transport.columns() {
            let step = CellStep::new(storage, column.spacing, speed);
            let values = CellEnds {
                upstream: after[column.upstream],
                column: after[column.index],
            };
            let sources = CellEnds {
                upstream: upstream_source,
                column: step.source(values, upstream_source),
            };
            let own_change = self.at(change.rate, column.index);
            let by_speed = CellStep::speed_tangent(storage, column.spacing, speed, values, sources);
            tangent[column.index] = step.courant_weight * tangent[column.upstream]
                + step.upstream * upstream_change
                + step.diagonal * own_change
                + change.speed * by_speed;
            (upstream_source, upstream_change) = (sources.column, own_change);
        }
    }

    /// The wear rate in a column.
    fn at(&self, rate: &[f64], column: usize) -> f64 {
        rate.get(column.wrapping_sub(self.first_contact))
            .copied()
            .unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::differences::assert_tangent;
    use proptest::prelude::*;

    /// Columns that widen to both sides, as those of a mesh do.
    const X: [f64; 9] = [-4.0, -1.0, -0.4, -0.2, 0.0, 0.2, 0.4, 1.0, 4.0];
    const FIRST: usize = 2;

    fn march(speed: f64, duration: f64) -> WearMarch<'static> {
        WearMarch {
            transport: Upwind::new(&X, speed),
            duration,
            first_contact: FIRST,
        }
    }

    proptest! {
        /// Balance of each cell: its increase, what leaves and what enters add up to what is worn.
        #[test]
        fn the_volume_is_conserved(
            before in prop::collection::vec(0.0..1.0, X.len()),
            rate in prop::collection::vec(0.0..3.0, 5),
            speed in -5.0..5.0_f64,
            log_duration in -3.0..2.0,
            incoming in 0.0..1.0,
        ) {
            let duration = 10.0_f64.powf(log_duration);
            let march = march(speed, duration);
            let transport = march.transport;
            let mut after = vec![0.0; X.len()];
            after[transport.inflow()] = incoming;
            march.advance(&rate, &before, &mut after, &mut WearSteps::new(&X));
            let (mut stored, mut worn) = (0.0, 0.0);
            for column in transport.columns() {
                let step = CellStep::new(1.0 / duration, column.spacing, transport.speed());
                let mean = |at: &dyn Fn(usize) -> f64| step.mean(at(column.upstream), at(column.index));
                stored += column.spacing * mean(&|i| after[i] - before[i]) / duration;
                worn += column.spacing * mean(&|i| march.at(&rate, i));
            }
            let carried = speed.abs() * (after[transport.outflow()] - incoming);
            let size = stored.abs().max(worn).max(carried.abs()).max(1.0 / duration);
            prop_assert!((stored + carried - worn).abs() < 1e-12 * size);
            // Between cells of one length a node counts with that length, as in the outputs; at the ends the weights vary.
            let even = 0.2 * rate[1..4].iter().sum::<f64>();
            let wide = 0.6 * rate[0].max(rate[4]);
            prop_assert!(worn >= even - 1e-12 && worn <= even + 2.0 * wide);
            prop_assert!(after.iter().all(|depth| *depth >= 0.0));
        }

        #[test]
        fn the_tangent_is_the_derivative(
            before in prop::collection::vec(0.0..1.0, X.len()),
            rate in prop::collection::vec(0.0..3.0, 5),
            rate_change in prop::collection::vec(-1.0..1.0, 5),
            speed in 0.5..5.0_f64,
            log_duration in -2.5..2.0,
            forward in any::<bool>(),
            speed_change in -1.0..1.0_f64,
            incoming_change in -1.0..1.0_f64,
        ) {
            let sign = if forward { 1.0 } else { -1.0 };
            let duration = 10.0_f64.powf(log_duration);
            let at = |h: f64| {
                let march = march(sign * (speed + h * speed_change), duration);
                let rate: Vec<f64> = rate.iter().zip(&rate_change).map(|(r, d)| r + h * d).collect();
                let mut after = vec![0.0; X.len()];
                after[march.transport.inflow()] = 0.3 + h * incoming_change;
                march.advance(&rate, &before, &mut after, &mut WearSteps::new(&X));
                after
            };
            let (h, here) = (1e-5, at(0.0));
            let march = march(sign * speed, duration);
            let inflow = march.transport.inflow();
            let mut tangent = vec![0.0; X.len()];
            tangent[inflow] = incoming_change;
            let change = WearChange { rate: &rate_change, speed: speed_change };
            march.advance_tangent(change, before[inflow], &here, &mut tangent);
            // Truncation h², round-off 1e-16/h.
            assert_tangent("column", &tangent, [&at(h), &at(-h)], 2.0 * h, 1e-7);
        }

        /// The march is a weighted mean: it creates no extremes and keeps what it is given.
        #[test]
        fn the_march_without_rate_keeps_within_its_bounds(
            before in prop::collection::vec(0.0..1.0, 30),
            speed in -80.0..80.0,
            log_duration in -6.0..0.0,
        ) {
            let x: Vec<f64> = (0..30).map(|i| 1e-3 * f64::from(i)).collect();
            let mut after = vec![0.0; 30];
            let march = WearMarch {
                transport: Upwind::new(&x, speed),
                duration: 10.0_f64.powf(log_duration),
                first_contact: 0,
            };
            march.advance(&[], &before, &mut after, &mut WearSteps::new(&x));
            let largest = before.iter().fold(0.0, |m: f64, w| w.max(m));
            // Round-off of the weights.
            prop_assert!(after.iter().all(|&w| (0.0..=largest * (1.0 + 1e-14)).contains(&w)));
        }
    }

    /// One-sided derivative at V = 0, towards positive speeds: nothing arrives yet, and the sources upstream begin to
    /// count.
    #[test]
    fn the_tangent_at_standstill_is_one_sided_and_finite() {
        let (before, rate) = ([0.3, 0.1, 0.7, 0.2, 0.4, 0.0, 0.9, 0.5, 0.6], [1.0, 0.0, 2.0, 0.5, 0.1]);
        for duration in [1e-3, 0.1, 10.0] {
            let at = |speed: f64| {
                let mut after = vec![0.0; X.len()];
                after[X.len() - 1] = 0.3;
                march(speed, duration).advance(&rate, &before, &mut after, &mut WearSteps::new(&X));
                after
            };
            // Truncation h and round-off 1/h, on the scale on which a cell is crossed in a step.
            let h = 1e-5 / duration;
            let (here, ahead) = (at(0.0), at(h));
            let mut tangent = vec![0.0; X.len()];
            let change = WearChange {
                rate: &[0.0; 5],
                speed: 1.0,
            };
            march(0.0, duration).advance_tangent(change, before[X.len() - 1], &here, &mut tangent);
            let size = tangent.iter().fold(0.0, |m: f64, d| d.abs().max(m));
            for column in 0..X.len() {
                let difference = (ahead[column] - here[column]) / h;
                assert!(
                    (tangent[column] - difference).abs() < 1e-3 * size,
                    "{column}: {} {difference}",
                    tangent[column]
                );
            }
            assert!(size > 0.0);
        }
    }

    /// A front that enters and goes leaves no depth below 0 and none above what entered.
    #[test]
    fn fronts_stay_within_their_bounds() {
        for speed in [0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0, 80.0, -10.0] {
            for duration in [1e-6, 1e-5, 1e-4, 1e-3, 3e-2] {
                let march = march(speed, duration);
                let mut before = vec![0.0; X.len()];
                for step in 0..40 {
                    let mut after = vec![0.0; X.len()];
                    after[march.transport.inflow()] = if step % 20 < 10 { 1.0 } else { 0.0 };
                    march.advance(&[0.0; 5], &before, &mut after, &mut WearSteps::new(&X));
                    assert!(
                        after.iter().all(|&depth| (0.0..=1.0 + 1e-14).contains(&depth)),
                        "{after:?}"
                    );
                    before = after;
                }
            }
        }
    }
}
