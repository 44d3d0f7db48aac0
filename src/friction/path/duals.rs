//! The derivatives of the law along the path against dual numbers: the equations of the headings of [`super`] and of
//! [`crate::friction::layer`] are marched through the window once more, node by node, each as it stands there.

use super::super::duals::{larger, lesser};
use super::super::memory::Brought;
use super::tests::*;
use super::*;
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

/// Path of a rail, and what is done to it on the way, in dual numbers.
struct March {
    /// |V|, `m/s`.
    speed: Dual64,
    forward: bool,
    duration: f64,
    /// M = μ(θ) of each node.
    static_friction: Vec<Dual64>,
    /// s of each node, `m/s`, 0 outside the contact.
    slip: Vec<Dual64>,
    /// p of each node, scaled.
    pressure: Vec<Dual64>,
}

impl March {
    /// T a, with a at the end of the step upstream and at its beginning upstream and here; and t, `s`.
    fn brought(&self, upstream: Dual64, before: [f64; 2]) -> (Dual64, Dual64) {
        let crossing = self.speed.recip() * SPACING;
        if self.duration.is_infinite() {
            return (upstream, crossing);
        }
        let cells = self.speed * self.duration / SPACING;
        if cells.re >= 1.0 {
            ((-cells.recip() + 1.0) * upstream + cells.recip() * before[0], crossing)
        } else {
            (
                cells * before[0] + (-cells + 1.0) * before[1],
                Dual64::from(self.duration),
            )
        }
    }

    /// The bound on the shear over the pressure at each node in contact, 0 elsewhere.
    fn coefficients(&self, parameters: &Parameters, before: &Brought) -> Vec<Dual64> {
        let none = Dual64::from(0.0);
        let (distance, least) = (parameters.friction_memory_distance, parameters.friction_memory_speed);
        let share = parameters.friction_slip_share;
        // Twice the elastic displacement of a cell at its bound.
        let longest = 2.0 * largest_coefficient(parameters) * step(self.duration, 1.0).displacement;
        let own = (distance / longest).min(1.0);
        let (strength, hardening) = (
            parameters.layer_yield_stress / PRESSURE,
            parameters.layer_hardening / PRESSURE,
        );
        let mut order: Vec<usize> = (0..NODES).collect();
        if self.forward {
            order.reverse();
        }
        let mut found = vec![none; NODES];
        // μ of the surfaces, s and u_pl of the node upstream.
        let (mut friction, mut slip, mut flow) = (self.static_friction[order[0]], none, none);
        for pair in order.windows(2) {
            let [upstream, node] = [pair[0], pair[1]];
            let start = |values: &[f64]| [values[upstream], values[node]];
            let (arrived, time) = self.brought(friction, start(&before.friction));
            if !TOUCHES[node] {
                let steady = self.static_friction[node];
                friction = steady + (arrived - steady) * (-time * least / distance).exp();
                (slip, flow) = (none, none);
                continue;
            }
            let effective = self.slip[node] * own + self.brought(slip, start(&before.speed)).0 * (1.0 - own);
            let falling = (-effective * parameters.friction_slip_decay).exp() * (1.0 - share) + share;
            let steady = self.static_friction[node] * falling;
            let way = larger(effective, Dual64::from(least)) * time;
            friction = steady + (arrived - steady) * (-way / distance).exp();
            slip = self.slip[node];
            found[node] = friction;
            if strength > 0.0 {
                let pressure = self.pressure[node];
                let came = self.brought(flow, start(&before.flow)).0;
                // No further than up to where the layer is as strong as the surfaces.
                let room = larger((friction * pressure - strength) / hardening - came, none);
                flow = came + lesser(slip * time, room);
                found[node] = lesser(friction * pressure, flow * hardening + strength) / pressure;
            }
        }
        found
    }
}

proptest! {
    /// Changes of |V|, slip, μ(θ) and pressure of all nodes at once, over parts of a cell and over many, along and against x₁, at any d_c,
    /// with a layer that flows and without.
    #[test]
    fn the_tangent_is_the_derivative_of_the_equations(
        cells in prop_oneof![0.05..0.9_f64, 1.1..20.0_f64, Just(f64::INFINITY)],
        log_distance in -7.5..-4.5,
        forward in any::<bool>(),
        speed_change in -1.0..1.0_f64,
        change in prop::collection::vec(-0.1..0.1_f64, NODES),
        slips in prop::collection::vec(-1e-3..1e-3_f64, NODES),
        pressures in prop::collection::vec(-0.1..0.1_f64, NODES),
        layer in any::<bool>(),
        part in 0.0..1.0_f64,
    ) {
        let parameters = parameters(10.0_f64.powf(log_distance));
        let parameters = if layer { with_layer(parameters) } else { parameters };
        let speed = 10.0;
        let duration = cells * SPACING / speed;
        let brought = before();
        let dual = |values: &[f64], change: &[f64]| -> Vec<Dual64> {
            (0..NODES).map(|i| Dual64::new(values[i], if TOUCHES[i] { change[i] } else { 0.0 })).collect()
        };
        let march = March {
            speed: Dual64::new(speed, speed_change),
            forward,
            duration,
            static_friction: (0..NODES).map(|i| Dual64::new(static_friction()[i], change[i])).collect(),
            slip: dual(&speeds(), &slips),
            pressure: dual(&pressure(), &pressures),
        };
        let expected = march.coefficients(&parameters, &brought);

        let law = PathLaw::new(&parameters, &step(duration, if forward { speed } else { -speed })).unwrap();
        let (coefficient, now) = solve(&law, &static_friction(), &speeds(), &pressure());
        let mut tangent = vec![0.0; NODES];
        law.tangent(
            (&brought.path(0..NODES), &now.path(0..NODES)),
            (&pressure(), |node| part * pressures[node]),
            (speed_change, &change),
            &mut tangent,
        );
        // The part of the slip and the rest of the pressure's, in the order of the particles.
        let (mut last, mut last_change) = (Passed::default(), Passed::default());
        let (path, mut by_slip) = (brought.path(0..NODES), vec![0.0; NODES]);
        law.prepare(&path, &static_friction(), |node| TOUCHES[node], |node, own| {
            let found = law.friction(&own, &last, now.speed[node], pressure()[node]);
            let pressed = (1.0 - part) * pressures[node];
            let (linked, passed) = found.change(&last_change, slips[node], pressed);
            by_slip[node] = linked + found.by_speed() * slips[node] + found.by_pressure() * pressed;
            (last, last_change) = (found.passed(now.speed[node]), passed);
        });
        for node in (0..NODES).filter(|&node| TOUCHES[node]) {
            let (value, exact) = (coefficient[node], tangent[node] + by_slip[node]);
            prop_assert!((value - expected[node].re).abs() < 1e-13, "{node}: {value} {}", expected[node]);
            // Round-off of what is taken together along the path.
            prop_assert!((exact - expected[node].eps).abs() < 1e-12 * (1.0 + exact.abs()), "{node}: {exact} {}", expected[node]);
        }
    }
}
