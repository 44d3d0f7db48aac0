//! The law on a window with two contacts: against itself node by node, in its limits. Its derivatives are in [`super::duals`].

use super::super::memory::Brought;
use super::*;

pub const NODES: usize = 11;
/// Two contacts, the second entered by what has left the first.
pub const TOUCHES: [bool; NODES] = [false, true, true, true, false, false, true, true, true, true, false];
pub const SPACING: f64 = 2e-4;
/// Scale of pressures, `Pa`.
pub const PRESSURE: f64 = 1e9;

pub fn parameters(distance: f64) -> Parameters {
    Parameters {
        friction_slip_share: 0.4,
        friction_slip_decay: 0.7,
        friction_memory_distance: distance,
        ..Parameters::default()
    }
}

pub fn step(duration: f64, speed: f64) -> PathStep {
    PathStep {
        duration,
        spacing: SPACING,
        speed,
        displacement: 2e-6,
        pressure: PRESSURE,
    }
}

fn values(of: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..NODES).map(of).collect()
}

/// A memory without regularity.
pub fn before() -> Brought {
    Brought {
        friction: values(|i| 0.3 + 0.05 * (1.7 * i as f64).sin()),
        speed: values(|i| {
            if TOUCHES[i] {
                0.02 + 0.01 * (2.3 * i as f64).cos()
            } else {
                0.0
            }
        }),
        static_friction: values(|i| 0.35 + 0.04 * (0.9 * i as f64).cos()),
        flow: values(|i| {
            if TOUCHES[i] {
                1e-6 + 5e-7 * (1.3 * i as f64).sin()
            } else {
                0.0
            }
        }),
    }
}

/// Parameters with a layer that yields at some 60 % of the surfaces' bound.
pub fn with_layer(parameters: Parameters) -> Parameters {
    Parameters {
        layer_yield_stress: 0.08 * PRESSURE,
        layer_hardening: 2e4 * PRESSURE,
        ..parameters
    }
}

pub fn pressure() -> Vec<f64> {
    values(|i| {
        if TOUCHES[i] {
            0.4 + 0.2 * (1.9 * i as f64).sin()
        } else {
            0.0
        }
    })
}

/// Solution at these μ(θ), slip velocities and pressures, from the law of the nodes in contact and then the others:
/// their coefficients, and the history that they leave.
pub fn solve(law: &PathLaw, static_friction: &[f64], speed: &[f64], pressure: &[f64]) -> (Vec<f64>, Brought) {
    let brought = before();
    let path = brought.path(0..NODES);
    let mut coefficient = vec![0.0; NODES];
    let mut now = Brought {
        friction: vec![0.0; NODES],
        speed: speed.to_vec(),
        static_friction: static_friction.to_vec(),
        flow: vec![0.0; NODES],
    };
    let mut last = Passed::default();
    law.prepare(
        &path,
        static_friction,
        |node| TOUCHES[node],
        |node, own| {
            let found = law.friction(&own, &last, speed[node], pressure[node]);
            coefficient[node] = found.coefficient;
            last = found.passed(speed[node]);
            (now.friction[node], now.flow[node]) = (last.friction, last.flow);
        },
    );
    law.finalise(&path, static_friction, |node| TOUCHES[node], &mut now.friction);
    (coefficient, now)
}

pub fn speeds() -> Vec<f64> {
    // Some above s₀ and some below.
    values(|i| match i % 4 {
        _ if !TOUCHES[i] => 0.0,
        0 => 3e-4,
        k => 0.03 * k as f64,
    })
}

pub fn static_friction() -> Vec<f64> {
    values(|i| 0.4 - 0.01 * i as f64)
}

/// The share of μ(θ) is the derivative by it.
#[test]
fn the_share_is_that_of_the_temperature() {
    for distance in [0.0, 1e-7, 3e-6] {
        let law = PathLaw::new(&parameters(distance), &step(1e-4, 10.0)).unwrap();
        let brought = before();
        let of = |more: f64| {
            let static_friction = values(|i| static_friction()[i] + if i == 8 { more } else { 0.0 });
            let mut found = NodeFriction::default();
            law.prepare(
                &brought.path(0..NODES),
                &static_friction,
                |node| TOUCHES[node],
                |node, own| {
                    if node == 8 {
                        found = law.friction(
                            &own,
                            &Passed {
                                friction: 0.31,
                                speed: 0.02,
                                flow: 0.0,
                            },
                            0.05,
                            1.0,
                        );
                    }
                },
            );
            found
        };
        let difference = (of(1e-3).coefficient - of(-1e-3).coefficient) / 2e-3;
        assert!((of(0.0).share - difference).abs() < 1e-12);
    }
}

/// Limits of the memory: without one, or with one that is much shorter than the way of slip in a cell, the law of
/// temperature and slip; with one that is much longer, the μ that has entered.
#[test]
fn the_limits_of_the_memory_are_the_steady_law_and_none_of_it() {
    let speeds = values(|i| if TOUCHES[i] { 0.5 } else { 0.0 });
    let static_friction = vec![0.4; NODES];
    let steady = 0.4 * SlipLaw::new(&parameters(0.0)).factor(0.5).0;
    for (distance, expected) in [(0.0, steady), (1e-9, steady), (1e-2, 0.4)] {
        let law = PathLaw::new(&parameters(distance), &step(f64::INFINITY, 10.0)).unwrap();
        let (friction, _) = solve(&law, &static_friction, &speeds, &pressure());
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

/// Standstill: nothing comes from elsewhere, and every node relaxes exponentially in time, in one step as in a hundred.
#[test]
fn at_standstill_each_node_relaxes_in_time() {
    let (distance, slides) = (3e-6, 0.01);
    let steady = 0.4 * SlipLaw::new(&parameters(0.0)).factor(slides).0;
    let total = 4e-4;
    // Nothing that a node before could have makes a difference.
    let strange = Passed {
        friction: 9.0,
        speed: 9.0,
        flow: 9.0,
    };
    for steps in [1, 100] {
        let law = PathLaw::new(&parameters(distance), &step(total / f64::from(steps), 0.0)).unwrap();
        let mut brought = Brought {
            friction: vec![0.4; NODES],
            speed: vec![slides; NODES],
            static_friction: vec![0.4; NODES],
            flow: vec![0.0; NODES],
        };
        for _ in 0..steps {
            let mut friction = vec![0.0; NODES];
            let path = brought.path(0..NODES);
            law.prepare(
                &path,
                &[0.4; NODES],
                |node| TOUCHES[node],
                |node, own| {
                    friction[node] = law.friction(&own, &strange, slides, 1.0).coefficient;
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

/// A layer alone: particles that come through a contact at a uniform pressure flow from the yield stress on, the stress rising with the way of
/// slip behind them, until it reaches the surfaces' bound, and the surfaces slip from there on.
#[test]
fn a_layer_hardens_along_the_path_up_to_the_bound_of_the_surfaces() {
    let parameters = with_layer(Parameters::default());
    let (speed, slides, coefficient, pressure) = (10.0, 0.05, 0.3, 0.4);
    for (duration, sign) in [(f64::INFINITY, 1.0), (f64::INFINITY, -1.0)] {
        let law = PathLaw::new(&parameters, &step(duration, sign * speed)).unwrap();
        assert!(law.remembers());
        let static_friction = [coefficient; NODES];
        let (found, now) = solve(&law, &static_friction, &[slides; NODES], &[pressure; NODES]);
        let mut flow = 0.0;
        for node in law.order(NODES) {
            if !TOUCHES[node] {
                flow = 0.0;
                assert_eq!(now.flow[node], 0.0);
                continue;
            }
            flow += slides * SPACING / speed;
            let bound = (0.08 + 2e4 * flow).min(coefficient * pressure);
            let way = (bound - 0.08) / 2e4;
            assert!((found[node] * pressure - bound).abs() < 1e-14, "{node}");
            assert!((now.flow[node] - way).abs() < 1e-18, "{node}");
            assert_eq!(now.friction[node], coefficient);
        }
    }
}

/// Standstill: the way of flow is all that has been slipped since the contact closed, in any number of steps.
#[test]
fn at_standstill_a_layer_flows_in_time() {
    let parameters = with_layer(Parameters::default());
    let (total, slides) = (1e-4, 0.01);
    for steps in [1, 50] {
        let law = PathLaw::new(&parameters, &step(total / f64::from(steps), 0.0)).unwrap();
        let mut brought = Brought {
            friction: vec![0.4; NODES],
            speed: vec![0.0; NODES],
            static_friction: vec![0.4; NODES],
            flow: vec![0.0; NODES],
        };
        for _ in 0..steps {
            let mut flow = vec![0.0; NODES];
            law.prepare(
                &brought.path(0..NODES),
                &[0.4; NODES],
                |node| TOUCHES[node],
                |node, own| flow[node] = law.friction(&own, &Passed::default(), slides, 0.5).flow(),
            );
            brought.flow = flow;
        }
        for node in (0..NODES).filter(|&node| TOUCHES[node]) {
            assert!((brought.flow[node] / (slides * total) - 1.0).abs() < 1e-12);
        }
    }
}
