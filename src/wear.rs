//! Archard wear (11), (24) with storage: ∂W/∂t − V ∂W/∂x₁ = k |s| p, the march of the heat without conduction.

use crate::transport::Upwind;

/// One implicit time step: the wear depth `after` at all columns, `m`, from `before`, under the wear rate
/// k |s| p at the contact nodes `m/s`, the first of which is the column `first_contact`. The inflow column of `after`
/// holds what enters.
pub fn advance(
    transport: &Upwind,
    duration: f64,
    first_contact: usize,
    rate: &[f64],
    before: &[f64],
    after: &mut [f64],
) {
    let storage = 1.0 / duration;
    let mut upstream = after[transport.inflow()];
    for column in transport.columns() {
        let advection = transport.speed() / column.spacing;
        let contact = column.index.wrapping_sub(first_contact);
        let worn = rate.get(contact).copied().unwrap_or(0.0);
        // The depth upstream enters last: columns wait for each other there, and all the rest can be computed meanwhile.
        let inverse = 1.0 / (storage + advection);
        let own = (storage * before[column.index] + worn) * inverse;
        upstream = own + advection * inverse * upstream;
        after[column.index] = upstream;
    }
}

/// The change of [`advance`]'s result `after` with that of the wear rate, `rate_change`, and of the speed |V|,
/// `speed_change`. The inflow column of `tangent` holds the change of what enters.
pub fn advance_tangent(
    transport: &Upwind,
    duration: f64,
    first_contact: usize,
    (rate_change, speed_change): (&[f64], f64),
    after: &[f64],
    tangent: &mut [f64],
) {
    let storage = 1.0 / duration;
    for column in transport.columns() {
        let advection = transport.speed() / column.spacing;
        let contact = column.index.wrapping_sub(first_contact);
        let worn = rate_change.get(contact).copied().unwrap_or(0.0);
        let carried = speed_change / column.spacing * (after[column.upstream] - after[column.index]);
        tangent[column.index] = (advection * tangent[column.upstream] + carried + worn) / (storage + advection);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Columns that widen to both sides, as those of a mesh do.
    const X: [f64; 9] = [-4.0, -1.0, -0.4, -0.2, 0.0, 0.2, 0.4, 1.0, 4.0];
    const FIRST: usize = 2;

    proptest! {
        /// Σ Δx (W − W before)/Δt + |V| (W out − W in) = Σ Δx rate: upwind differences telescope.
        #[test]
        fn the_volume_is_conserved(
            before in prop::collection::vec(0.0..1.0, X.len()),
            rate in prop::collection::vec(0.0..3.0, 5),
            speed in -5.0..5.0_f64,
            log_duration in -3.0..2.0,
            incoming in 0.0..1.0,
        ) {
            let duration = 10.0_f64.powf(log_duration);
            let transport = Upwind::new(&X, speed);
            let mut after = vec![0.0; X.len()];
            after[transport.inflow()] = incoming;
            advance(&transport, duration, FIRST, &rate, &before, &mut after);
            let (mut stored, mut worn) = (0.0, 0.0);
            for column in transport.columns() {
                stored += column.spacing * (after[column.index] - before[column.index]) / duration;
                worn += column.spacing * rate.get(column.index.wrapping_sub(FIRST)).copied().unwrap_or(0.0);
            }
            let carried = speed.abs() * (after[transport.outflow()] - incoming);
            let size = stored.abs().max(worn).max(carried.abs()).max(1.0 / duration);
            prop_assert!((stored + carried - worn).abs() < 1e-12 * size);
            prop_assert!(after.iter().all(|depth| *depth >= 0.0));
        }

        #[test]
        fn the_tangent_is_the_derivative(
            before in prop::collection::vec(0.0..1.0, X.len()),
            rate in prop::collection::vec(0.0..3.0, 5),
            rate_change in prop::collection::vec(-1.0..1.0, 5),
            speed in 0.5..5.0_f64,
            forward in any::<bool>(),
            speed_change in -1.0..1.0_f64,
            incoming_change in -1.0..1.0_f64,
        ) {
            let sign = if forward { 1.0 } else { -1.0 };
            let at = |h: f64| {
                let transport = Upwind::new(&X, sign * (speed + h * speed_change));
                let rate: Vec<f64> = rate.iter().zip(&rate_change).map(|(r, d)| r + h * d).collect();
                let mut after = vec![0.0; X.len()];
                after[transport.inflow()] = 0.3 + h * incoming_change;
                advance(&transport, 0.1, FIRST, &rate, &before, &mut after);
                after
            };
            let h = 1e-5;
            let (here, ahead, behind) = (at(0.0), at(h), at(-h));
            let transport = Upwind::new(&X, sign * speed);
            let mut tangent = vec![0.0; X.len()];
            tangent[transport.inflow()] = incoming_change;
            advance_tangent(&transport, 0.1, FIRST, (&rate_change, speed_change), &here, &mut tangent);
            for column in 0..X.len() {
                let difference = (ahead[column] - behind[column]) / (2.0 * h);
                // Truncation h², round-off 1e-16/h.
                prop_assert!((tangent[column] - difference).abs() < 1e-8, "{column}: {} {difference}", tangent[column]);
            }
        }

    /// The march is a weighted mean: it creates no extremes and keeps what it is given.
        #[test]
    fn the_march_without_rate_keeps_within_its_bounds(
        before in prop::collection::vec(0.0..1.0, 30),
        speed in -20.0..20.0,
        duration in 1e-5..1.0,
    ) {
        let x: Vec<f64> = (0..30).map(|i| 1e-3 * f64::from(i)).collect();
        let mut after = vec![0.0; 30];
        advance(&Upwind::new(&x, speed), duration, 0, &[], &before, &mut after);
        let largest = before.iter().fold(0.0, |m: f64, w| w.max(m));
        prop_assert!(after.iter().all(|&w| (0.0..=largest).contains(&w)));
    }
    }
}
