//! The law on a window with two contacts: against itself node by node, its derivatives against differences.

use super::super::memory::Brought;
use super::*;
use proptest::prelude::*;

const NODES: usize = 11;
/// Two contacts, the second entered by what has left the first.
const TOUCHES: [bool; NODES] = [false, true, true, true, false, false, true, true, true, true, false];
const SPACING: f64 = 2e-4;

fn parameters(distance: f64) -> Parameters {
    Parameters {
        friction_slip_share: 0.4,
        friction_slip_decay: 0.7,
        friction_memory_distance: distance,
        ..Parameters::default()
    }
}

fn step(duration: f64, speed: f64) -> PathStep {
    PathStep {
        duration,
        spacing: SPACING,
        speed,
        displacement: 2e-6,
    }
}

fn values(of: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..NODES).map(of).collect()
}

/// A memory without regularity.
fn before() -> Brought {
    Brought {
        friction: values(|i| 0.3 + 0.05 * (1.7 * i as f64).sin()),
        speed: values(|i| {
            if TOUCHES[i] {
                0.02 + 0.01 * (2.3 * i as f64).cos()
            } else {
                0.0
            }
        }),
        resting: values(|i| 0.35 + 0.04 * (0.9 * i as f64).cos()),
    }
}

/// μ of all nodes at these μ(θ) and slip velocities, from the law of the nodes in contact and then the others.
fn solve(law: &PathLaw, resting: &[f64], speed: &[f64]) -> Vec<f64> {
    let brought = before();
    let path = brought.path(0..NODES);
    let mut friction = vec![0.0; NODES];
    let mut last = (0.0, 0.0);
    law.prepare(
        &path,
        resting,
        |node| TOUCHES[node],
        |node, own| {
            let found = law.friction(&own, last, speed[node]).coefficient;
            friction[node] = found;
            last = (found, speed[node]);
        },
    );
    law.close(&path, resting, |node| TOUCHES[node], &mut friction);
    friction
}

fn speeds() -> Vec<f64> {
    // Some above s₀ and some below.
    values(|i| match i % 4 {
        _ if !TOUCHES[i] => 0.0,
        0 => 3e-4,
        k => 0.03 * k as f64,
    })
}

fn resting() -> Vec<f64> {
    values(|i| 0.4 - 0.01 * i as f64)
}

proptest! {
    /// With speed and μ(θ) of all nodes at once, over parts of a cell and over many, along and against x₁, at any d_c.
    #[test]
    fn the_tangent_is_the_derivative(
        cells in prop_oneof![0.05..0.9_f64, 1.1..20.0_f64, Just(f64::INFINITY)],
        log_distance in -7.5..-4.5,
        forward in any::<bool>(),
        speed_change in -1.0..1.0_f64,
        change in prop::collection::vec(-0.1..0.1_f64, NODES),
        slips in prop::collection::vec(-1e-3..1e-3_f64, NODES),
    ) {
        let parameters = parameters(10.0_f64.powf(log_distance));
        let sign = if forward { 1.0 } else { -1.0 };
        let speed = 10.0;
        let duration = cells * SPACING / speed;
        let at = |h: f64| {
            let law = PathLaw::new(&parameters, &step(duration, sign * (speed + h * speed_change))).unwrap();
            let resting = values(|i| resting()[i] + h * change[i]);
            let speeds = values(|i| if TOUCHES[i] { speeds()[i] + h * slips[i] } else { 0.0 });
            solve(&law, &resting, &speeds)
        };
        let h = 1e-5;
        let (here, ahead, behind) = (at(0.0), at(h), at(-h));
        let law = PathLaw::new(&parameters, &step(duration, sign * speed)).unwrap();
        let brought = before();
        let now = Brought { friction: here, speed: speeds(), resting: resting() };
        let mut tangent = vec![0.0; NODES];
        law.tangent(
            (&brought.path(0..NODES), &now.path(0..NODES)),
            |node| TOUCHES[node],
            (speed_change, &change),
            &mut tangent,
        );
        // The part of the slip, in the order of the particles.
        let mut last = (0.0, 0.0, 0.0, 0.0);
        let (path, mut by_slip) = (brought.path(0..NODES), vec![0.0; NODES]);
        law.prepare(&path, &resting(), |node| TOUCHES[node], |node, own| {
            let found = law.friction(&own, (last.0, last.1), now.speed[node]);
            by_slip[node] = found.by_before * last.2 + found.by_speed_before * last.3 + found.by_speed * slips[node];
            last = (found.coefficient, now.speed[node], by_slip[node], slips[node]);
        });
        for node in (0..NODES).filter(|&node| TOUCHES[node]) {
            let exact = tangent[node] + by_slip[node];
            let difference = (ahead[node] - behind[node]) / (2.0 * h);
            // Truncation: h² over the squares of the scales, of which d_c is the shortest.
            prop_assert!((exact - difference).abs() < 1e-5 * (1.0 + exact.abs()), "{node}: {exact} {difference}");
        }
    }
}

/// The share of μ(θ) is the derivative by it.
#[test]
fn the_share_is_that_of_the_temperature() {
    for distance in [0.0, 1e-7, 3e-6] {
        let law = PathLaw::new(&parameters(distance), &step(1e-4, 10.0)).unwrap();
        let brought = before();
        let of = |more: f64| {
            let resting = values(|i| resting()[i] + if i == 8 { more } else { 0.0 });
            let mut found = NodeFriction::default();
            law.prepare(
                &brought.path(0..NODES),
                &resting,
                |node| TOUCHES[node],
                |node, own| {
                    if node == 8 {
                        found = law.friction(&own, (0.31, 0.02), 0.05);
                    }
                },
            );
            found
        };
        let difference = (of(1e-3).coefficient - of(-1e-3).coefficient) / 2e-3;
        assert!((of(0.0).share - difference).abs() < 1e-12);
    }
}

/// Without a memory, and with one that is much shorter than the way of slip in a cell, it is the law of temperature and slip; with one
/// that is much longer, what has entered.
#[test]
fn the_limits_of_the_memory_are_the_steady_law_and_none_of_it() {
    let speeds = values(|i| if TOUCHES[i] { 0.5 } else { 0.0 });
    let resting = vec![0.4; NODES];
    let steady = 0.4 * SlipLaw::new(&parameters(0.0)).factor(0.5).0;
    for (distance, expected) in [(0.0, steady), (1e-9, steady), (1e-2, 0.4)] {
        let law = PathLaw::new(&parameters(distance), &step(f64::INFINITY, 10.0)).unwrap();
        let friction = solve(&law, &resting, &speeds);
        // The first node of a coarse mesh has entered without slip.
        for node in [1, 2, 6, 7, 8] {
            assert!(
                (friction[node] - expected).abs() < 2e-2 * (0.4 - steady),
                "{distance}: {}",
                friction[node]
            );
        }
    }
    let constant = Parameters {
        friction_memory_distance: 0.0,
        friction_slip_share: 1.0,
        ..parameters(0.0)
    };
    assert!(PathLaw::new(&constant, &step(1e-3, 10.0)).is_none());
}

/// At standstill nothing comes from elsewhere: every node by itself, exponentially in time, in one step as in a hundred.
#[test]
fn at_standstill_each_node_relaxes_in_time() {
    let (distance, slides) = (3e-6, 0.01);
    let steady = 0.4 * SlipLaw::new(&parameters(0.0)).factor(slides).0;
    let total = 4e-4;
    for steps in [1, 100] {
        let law = PathLaw::new(&parameters(distance), &step(total / f64::from(steps), 0.0)).unwrap();
        let mut brought = Brought {
            friction: vec![0.4; NODES],
            speed: vec![slides; NODES],
            resting: vec![0.4; NODES],
        };
        for _ in 0..steps {
            let mut friction = vec![0.0; NODES];
            let path = brought.path(0..NODES);
            law.prepare(
                &path,
                &[0.4; NODES],
                |node| TOUCHES[node],
                |node, own| {
                    friction[node] = law.friction(&own, (9.0, 9.0), slides).coefficient;
                },
            );
            brought.friction = friction;
        }
        let exact = steady + (0.4 - steady) * (-slides * total / distance).exp();
        for node in (0..NODES).filter(|&node| TOUCHES[node]) {
            assert!((brought.friction[node] - exact).abs() < 1e-12);
        }
    }
}
