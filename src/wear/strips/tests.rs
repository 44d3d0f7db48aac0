//! The strips against the march of one, the balance of the whole, and the tangent.

use super::*;
use crate::numerics::differences::assert_tangent;
use crate::transport::Upwind;
use proptest::prelude::*;

const CELLS: usize = 6;
const STRIPS: usize = 9;
/// Cells 2 to 7 and the columns next to them are evenly spaced.
const X: [f64; 12] = [-4.0, -1.5, -0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7, 1.5, 4.0];
const FIRST: usize = 3;
const BREADTH: f64 = 0.4;

fn strips() -> Strips {
    Strips::new(&X, FIRST..FIRST + CELLS, STRIPS, BREADTH)
}

fn march(strips: &Strips, speed: f64, duration: f64) -> StripWearMarch<'_> {
    StripWearMarch {
        strips,
        speed,
        duration,
    }
}

fn advance(march: &StripWearMarch, rate: &[f64], incoming: f64, breadth: f64, before: &StripWear) -> StripWear {
    let (mut after, mut steps) = (before.clone(), StripWearSteps::new(march.strips));
    march.advance(rate, incoming, before, &mut after, &mut steps);
    march.finalise(breadth, before, &mut after, &mut steps);
    after
}

/// B a_beside + Σ b (a_j − a_beside) at a column of all, `m²`.
fn section(march: &StripWearMarch, field: &StripWear, column: usize) -> f64 {
    let first = FIRST - 1;
    if column < first {
        field.breadth * field.outer[0][column]
    } else if column < first + CELLS + 2 {
        let strips = march.strips;
        field.breadth * strips.mean(field.breadth, |strip| field.window[march.place(strip, column - first)])
    } else {
        field.breadth * field.outer[1][column - first - CELLS - 1]
    }
}

proptest! {
    /// Each strip, and the rail beside them.
    #[test]
    fn each_strip_is_the_march_of_one(
        rate in prop::collection::vec(0.0..3.0, STRIPS * CELLS),
        speed in prop_oneof![Just(0.0), -5.0..5.0_f64],
        log_duration in -3.0..2.0,
        incoming in 0.0..1.0,
    ) {
        let (strips, duration) = (strips(), 10.0_f64.powf(log_duration));
        let march = march(&strips, speed, duration);
        let mut before = StripWear::new(&strips);
        let mut line = vec![vec![0.0; X.len()]; STRIPS + 1];
        for _ in 0..3 {
            let after = advance(&march, &rate, incoming, 1.0, &before);
            for (strip, line) in line.iter_mut().enumerate() {
                let single = WearMarch { transport: Upwind::new(&X, speed), duration, first_contact: FIRST };
                let mut next = vec![0.0; X.len()];
                next[single.transport.inflow()] = incoming;
                let own = rate.chunks_exact(CELLS).nth(strip).unwrap_or(&[]);
                single.advance(own, line, &mut next, &mut WearSteps::new(&X));
                for column in 0..strips.columns() {
                    let (found, expected) = (after.window[march.place(strip, column)], next[FIRST - 1 + column]);
                    prop_assert!((found - expected).abs() <= 1e-13 * (1.0 + expected), "{strip} {column}: {found} {expected}");
                }
                for (cell, expected) in next[FIRST..FIRST + CELLS].iter().enumerate().filter(|_| strip < STRIPS) {
                    prop_assert!((after.depth[strip * CELLS + cell] - expected).abs() <= 1e-13 * (1.0 + expected));
                }
                *line = next;
            }
            before = after;
        }
    }

    /// Worn volume, over a contact of one breadth: it lies on the rail or has left it, to and fro, with a worn rail
    /// coming in.
    #[test]
    fn worn_volume_is_the_depth_on_the_rail_and_what_left_it(
        rate in prop::collection::vec(0.0..3.0, STRIPS * CELLS),
        speeds in prop::array::uniform5(-5.0..5.0_f64),
        log_duration in -2.0..1.0,
        incoming in 0.0..1.0,
        strips_in_contact in 1_usize..STRIPS,
    ) {
        let (strips, duration) = (strips(), 10.0_f64.powf(log_duration));
        let breadth = BREADTH * strips_in_contact as f64;
        let mut before = StripWear::new(&strips);
        before.breadth = breadth;
        for (number, speed) in speeds.into_iter().enumerate() {
            let march = march(&strips, speed, duration);
            // Without a contact the breadth stays, and nothing wears.
            let lifted = number == 3;
            let rate = if lifted { vec![0.0; rate.len()] } else { rate.clone() };
            let after = advance(&march, &rate, incoming, if lifted { 0.0 } else { breadth }, &before);
            let (mut stored, mut worn) = (0.0, 0.0);
            let transport = Upwind::new(&X, speed);
            for column in transport.columns() {
                let step = CellStep::new(1.0 / duration, column.spacing, speed.abs());
                let mean = |at: &dyn Fn(usize) -> f64| column.spacing * step.mean(at(column.upstream), at(column.index));
                stored += mean(&|c| section(&march, &after, c) - section(&march, &before, c));
                worn += duration * mean(&|c| {
                    let cell = c.wrapping_sub(FIRST);
                    let strips = rate.chunks_exact(CELLS);
                    strips.map(|strip| BREADTH * strip.get(cell).unwrap_or(&0.0)).sum()
                });
            }
            let left = speed.abs() * duration * breadth * (march.leaving(&after) - incoming);
            let size = stored.abs().max(worn).max(left.abs()).max(breadth);
            prop_assert!((stored + left - worn).abs() <= 1e-12 * size, "{stored} {left} {worn}");
            before = after;
        }
    }

    #[test]
    fn the_tangent_is_the_derivative(
        rate in prop::collection::vec(0.0..3.0, STRIPS * CELLS),
        rate_change in prop::collection::vec(-1.0..1.0, STRIPS * CELLS),
        speed in 0.5..5.0_f64,
        log_duration in -2.5..2.0,
        directions in prop::array::uniform2(any::<bool>()),
        changes in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let strips = strips();
        let duration = 10.0_f64.powf(log_duration);
        let [first, sign] = directions.map(|forward| if forward { 1.0 } else { -1.0 });
        let [speed_change, incoming_change, breadth_change] = changes;
        let mut before = StripWear::new(&strips);
        for breadth in [1.0, 2.0] {
            before = advance(&march(&strips, first * speed, 0.3), &rate, 0.5, breadth, &before);
        }
        let at = |h: f64| {
            let march = march(&strips, sign * (speed + h * speed_change), duration);
            let rate: Vec<f64> = rate.iter().zip(&rate_change).map(|(r, d)| r + h * d).collect();
            advance(&march, &rate, 0.3 + h * incoming_change, 1.5 + h * breadth_change, &before)
        };
        let h = 1e-5;
        let (here, ahead, behind) = (at(0.0), at(h), at(-h));
        let march = march(&strips, sign * speed, duration);
        let mut tangent = StripWear::new(&strips);
        let change = WearChange { rate: &rate_change, speed: speed_change };
        march.advance_tangent(change, incoming_change, &here, &mut tangent);
        march.finalise_tangent(speed_change, breadth_change, &here, &mut tangent);
        let vectors = tangent.vectors().into_iter().zip(ahead.vectors()).zip(behind.vectors());
        for (number, ((exact, ahead), behind)) in vectors.enumerate().take(4) {
            // Truncation h², round-off 1e-16/h, of depths and their changes up to some 10.
            assert_tangent(number, exact, [ahead, behind], 2.0 * h, 1e-6);
        }
    }
}
