//! Friction that falls with slip, and that remembers, along the path of the rail's particles through the contact.
//!
//! The coefficient is a law of temperature times a law of slip, μ(θ) f(s), s the magnitude of the slip velocity, with
//!
//! f(s) = A + (1 − A) exp(−B s)
//!
//! (Polach, Wear 258 (2005) 992). With a memory it reaches that only on a way of slip (Vollebregt and Schuttelaars, Wear 286 (2012) 43):
//! along the path of a particle
//!
//! dμ/dt = −max(s, s₀) (μ − μ(θ) f(s))/d_c.
//!
//! Without it a point that slides faster carries less, and so slides faster still: where the coefficient falls steeply with slip or with the
//! temperature that slip makes, the same inputs have several solutions.
//!
//! A particle comes to a node (O) through the cell upstream of it. Where it was at the beginning of its way through that cell follows from
//! the Courant number C = |V| Δt/Δ: with C ≥ 1 at the node upstream (U), between the beginning and the end of the step, else between the
//! two nodes at the beginning of the step. A value a that it brings from there is T a,
//!
//! C ≥ 1: T a = (1 − 1/C) a_U + a_Uⁿ/C,  C < 1: T a = C a_Uⁿ + (1 − C) a_Oⁿ,
//!
//! and on its way of t = min(Δ/|V|, Δt) the law is solved exactly, for any d_c:
//!
//! μ_O = M f(ŝ) + (T μ − M f(ŝ)) exp(−max(ŝ, s₀) t/d_c).
//!
//! M = μ(θ) is that of the node. The node's slip is that of the cell upstream of it, and ŝ its mean with the slip at the beginning of the way,
//! ŝ = β s_O + (1 − β) T s: β is 1 where d_c is longer than twice the elastic displacement of a cell at its bound, and on a coarser mesh the
//! ratio of the two. With more of its own slip the shear of a cell would fall faster than its elasticity follows, and the discrete problem
//! would have the several solutions that the memory is there to prevent.
//!
//! A layer between wheel and rail that flows lowers the bound on the shear from μ p to its own strength, [`super::layer`]. The coefficient of a
//! node is then that bound over the pressure, beside the μ of the surfaces that the particle takes along.

use super::largest_coefficient;
use super::layer::{LayerLaw, Yielding};
use super::memory::ParticlePath;
pub use super::node::{Link, NodeFriction, Passed, PassedTogether, PathNode};
use super::passage::Passage;
pub use super::passage::PathStep;
use crate::parameters::Parameters;

/// Slip factor f(s) of the coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipLaw {
    share: f64,
    decay: f64,
}

impl SlipLaw {
    /// Slip factor of the parameters.
    pub fn new(parameters: &Parameters) -> SlipLaw {
        SlipLaw {
            share: parameters.friction_slip_share,
            decay: parameters.friction_slip_decay,
        }
    }

    /// f at a slip velocity of this magnitude, `m/s`, and df/ds, `s/m`.
    pub fn factor(&self, speed: f64) -> (f64, f64) {
        let falling = (1.0 - self.share) * (-self.decay * speed).exp();
        (self.share + falling, -self.decay * falling)
    }

    fn is_constant(&self) -> bool {
        self.share == 1.0 || self.decay == 0.0
    }
}

/// The law of all nodes in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathLaw {
    slip: SlipLaw,
    /// Least slip velocity s₀ of the relaxation, `m/s`.
    least_speed: f64,
    /// Weight β of the node's own slip velocity in the effective one.
    own_slip_weight: f64,
    passage: Passage,
    /// Change of `passage` with |V|.
    passage_tangent: Passage,
    /// Fraction that is left, where nothing slips, of the μ that a particle brings.
    idle_relaxation: f64,
    /// Whether particles come from high indices.
    forward: bool,
    layer: Option<LayerLaw>,
}

impl PathLaw {
    /// Law of the parameters; none where friction depends on the temperature only.
    pub fn new(parameters: &Parameters, step: &PathStep) -> Option<PathLaw> {
        let slip = SlipLaw::new(parameters);
        let distance = parameters.friction_memory_distance;
        let layer = LayerLaw::new(parameters, step);
        if slip.is_constant() && distance == 0.0 && layer.is_none() {
            return None;
        }
        let passage = Passage::new(step.duration, step.spacing, step.speed.abs(), distance);
        let displacement = 2.0 * largest_coefficient(parameters) * step.displacement;
        Some(PathLaw {
            slip,
            least_speed: parameters.friction_memory_speed,
            own_slip_weight: if passage.residence.is_infinite() || distance >= displacement {
                1.0
            } else {
                distance / displacement
            },
            passage,
            passage_tangent: passage.tangent(step.duration, step.spacing, step.speed.abs()),
            idle_relaxation: if passage.residence.is_finite() {
                (-passage.residence * parameters.friction_memory_speed).exp()
            } else {
                0.0
            },
            forward: step.speed >= 0.0,
            layer,
        })
    }

    /// Whether what a node does depends on the nodes before it.
    pub fn remembers(&self) -> bool {
        self.follows() || self.layer.is_some_and(|layer| layer.hardens())
    }

    /// Whether there is a layer that flows.
    pub fn yields(&self) -> bool {
        self.layer.is_some()
    }

    /// Whether μ follows on a way of slip.
    fn follows(&self) -> bool {
        self.passage.residence.is_finite()
    }

    /// Whether particles come from high indices.
    pub fn is_forward(&self) -> bool {
        self.forward
    }

    /// Relaxation exp(−max(s, s₀) t/d_c) of the difference from the steady μ, and its derivative by s.
    fn relaxation(&self, speed: f64) -> (f64, f64) {
        if !self.follows() {
            return (0.0, 0.0);
        }
        if speed <= self.least_speed {
            return (self.idle_relaxation, 0.0);
        }
        let relaxation = (-self.passage.residence * speed).exp();
        (relaxation, -self.passage.residence * relaxation)
    }

    /// Effective slip velocity ŝ, the mean of the node's own and the advected one.
    fn effective_slip(&self, node: &PathNode, speed_before: f64, speed: f64) -> f64 {
        self.own_slip_weight * speed + (1.0 - self.own_slip_weight) * (node.speed + node.speed_weight * speed_before)
    }

    /// Whether a layer may flow.
    pub fn flows(&self) -> bool {
        self.layer.is_some()
    }

    /// Friction at a node with this slip velocity `m/s` and pressure, after a node that passes on `before`.
    // Called, it copies its result: 3 % of a step.
    #[inline(always)]
    pub fn friction(&self, node: &PathNode, before: &Passed, speed: f64, pressure: f64) -> NodeFriction {
        let effective_slip = self.effective_slip(node, before.speed, speed);
        let (factor, factor_slope) = self.slip.factor(effective_slip);
        let (relaxation, relaxation_slope) = self.relaxation(effective_slip);
        let steady = node.steady * factor;
        let more = node.advected + node.courant_weight * before.friction - steady;
        let by_effective_slip = (1.0 - relaxation) * node.steady * factor_slope + relaxation_slope * more;
        let surfaces = steady + relaxation * more;
        let layer = match &self.layer {
            None => Yielding::none(surfaces),
            Some(layer) => layer.bound((surfaces, pressure), node.flow + node.flow_weight * before.flow, speed),
        };
        NodeFriction {
            coefficient: layer.coefficient,
            share: (1.0 - relaxation) * factor,
            surfaces,
            by_before: relaxation * node.courant_weight,
            by_speed_before: by_effective_slip * (1.0 - self.own_slip_weight) * node.speed_weight,
            by_speed: by_effective_slip * self.own_slip_weight,
            layer,
            flow_by_before: layer.flow_by_advected * node.flow_weight,
        }
    }

    /// The places 0 to n − 1 in the order in which particles come to them.
    pub fn order(&self, n: usize) -> impl Iterator<Item = usize> + use<> {
        let forward = self.forward;
        (0..n).map(move |k| if forward { n - 1 - k } else { k })
    }

    /// A node and the one upstream of it, with μ(θ) of all.
    fn node(&self, path: &ParticlePath, static_friction: &[f64], node: usize, upstream: usize) -> PathNode {
        let start = |values: &[f64]| self.passage.start(values[upstream], values[node]);
        let layer = self.layer.as_ref().map(|layer| &layer.passage);
        PathNode {
            steady: static_friction[node],
            advected: start(path.friction),
            courant_weight: self.passage.upstream,
            speed: start(path.speed),
            speed_weight: self.passage.upstream,
            flow: layer.map_or(0.0, |passage| passage.start(path.flow[upstream], path.flow[node])),
            flow_weight: layer.map_or(0.0, |passage| passage.upstream),
        }
    }

    /// Coefficient of a node outside the contact, where nothing slips, after one with the μ `before`.
    fn idle(&self, node: &PathNode, before: f64) -> f64 {
        node.steady + self.idle_relaxation * (node.advected + node.courant_weight * before - node.steady)
    }

    /// Gives the nodes in contact their law, in the order of the particles, with μ(θ) of all nodes. What lies between two of them is
    /// taken together: the node before is the one in contact that was given before.
    pub fn prepare(
        &self,
        path: &ParticlePath,
        static_friction: &[f64],
        in_contact: impl Fn(usize) -> bool,
        mut give: impl FnMut(usize, PathNode),
    ) {
        if !self.remembers() {
            for node in self.order(static_friction.len()).filter(|&node| in_contact(node)) {
                let steady = static_friction[node];
                give(
                    node,
                    PathNode {
                        steady,
                        ..PathNode::default()
                    },
                );
            }
            return;
        }
        // μ upstream is a constant and a share of that of the last node in contact.
        let mut order = self.order(static_friction.len());
        let Some(mut upstream) = order.next() else {
            return;
        };
        let (mut constant, mut share) = (static_friction[upstream], 0.0);
        let mut touched = in_contact(upstream);
        if touched {
            let entering = PathNode {
                steady: constant,
                advected: constant,
                ..PathNode::default()
            };
            give(upstream, entering);
            (constant, share) = (0.0, 1.0);
        }
        for node in order {
            let own = self.node(path, static_friction, node, upstream);
            let touches = in_contact(node);
            if touches {
                give(
                    node,
                    PathNode {
                        advected: own.advected + own.courant_weight * constant,
                        courant_weight: own.courant_weight * share,
                        speed_weight: if touched { own.speed_weight } else { 0.0 },
                        flow_weight: if touched { own.flow_weight } else { 0.0 },
                        ..own
                    },
                );
                (constant, share) = (0.0, 1.0);
            } else {
                constant = self.idle(&own, constant);
                share *= self.idle_relaxation * own.courant_weight;
            }
            (upstream, touched) = (node, touches);
        }
    }

    /// Computes μ of the nodes outside the contact at the end of the step; `friction` and `static_friction` hold all the others.
    pub fn finalise(
        &self,
        path: &ParticlePath,
        static_friction: &[f64],
        in_contact: impl Fn(usize) -> bool,
        friction: &mut [f64],
    ) {
        let mut order = self.order(static_friction.len());
        let Some(mut upstream) = order.next() else {
            return;
        };
        if !in_contact(upstream) {
            friction[upstream] = static_friction[upstream];
        }
        for node in order {
            if !in_contact(node) {
                let own = self.node(path, static_friction, node, upstream);
                friction[node] = self.idle(&own, friction[upstream]);
            }
            upstream = node;
        }
    }

    /// Change of the coefficient of all nodes at unchanged slip, with that of |V| by `speed` `m/s`, that of μ(θ), `static_friction`, and that of the
    /// pressure; `now` is the solution.
    pub fn tangent(
        &self,
        (path, now): (&ParticlePath, &ParticlePath),
        (pressure, pressure_change): (&[f64], impl Fn(usize) -> f64),
        (speed, static_friction): (f64, &[f64]),
        friction: &mut [f64],
    ) {
        let in_contact = |node: usize| pressure[node] > 0.0;
        let mut order = self.order(static_friction.len());
        let Some(mut upstream) = order.next() else {
            return;
        };
        let mut passed = Passed {
            friction: static_friction[upstream],
            ..Passed::default()
        };
        friction[upstream] = static_friction[upstream];
        if !self.remembers() {
            order = self.order(static_friction.len());
        }
        let (passage, change) = (&self.passage, &self.passage_tangent);
        for node in order {
            let own = self.node(path, now.static_friction, node, upstream);
            let moved = |change: &Passage, now: &[f64], before: &[f64]| {
                speed * (change.upstream * now[upstream] + change.start(before[upstream], before[node]))
            };
            let advected_change = passage.upstream * passed.friction + moved(change, now.friction, path.friction);
            let contact = in_contact(node);
            let effective_slip = if contact {
                self.effective_slip(&own, now.speed[upstream], now.speed[node])
            } else {
                0.0
            };
            let (factor, factor_slope) = self.slip.factor(effective_slip);
            let (relaxation, relaxation_slope) = self.relaxation(effective_slip);
            let more = own.advected + own.courant_weight * now.friction[upstream] - own.steady * factor;
            let slid = if contact {
                (1.0 - self.own_slip_weight) * moved(change, now.speed, path.speed)
            } else {
                0.0
            };
            let by_effective_slip = (1.0 - relaxation) * own.steady * factor_slope + relaxation_slope * more;
            let by_residence = -effective_slip.max(self.least_speed) * relaxation * more;
            let surfaces = (1.0 - relaxation) * factor * static_friction[node]
                + relaxation * advected_change
                + by_effective_slip * slid
                + by_residence * speed * change.residence;
            friction[node] = surfaces;
            let mut flow = 0.0;
            if let (Some(layer), true) = (&self.layer, contact) {
                let advected = own.flow + own.flow_weight * now.flow[upstream];
                let yielding = layer.bound((now.friction[node], pressure[node]), advected, now.speed[node]);
                let change = &layer.passage_tangent;
                flow = yielding.flow_by_advected
                    * (layer.passage.upstream * passed.flow + moved(change, now.flow, path.flow))
                    + yielding.flow_by_time * speed * change.residence
                    + yielding.flow_by_friction * surfaces
                    + yielding.flow_by_pressure * pressure_change(node);
                friction[node] = yielding.by_friction * surfaces
                    + yielding.by_flow * flow
                    + yielding.by_pressure * pressure_change(node);
            }
            passed = Passed {
                friction: surfaces,
                flow,
                ..passed
            };
            upstream = node;
        }
    }
}

#[cfg(test)]
mod duals;
#[cfg(test)]
mod tests;
