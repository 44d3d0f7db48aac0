//! History of friction that the rail carries along: the state of [`super::path`].

use super::PointLaw;
use crate::parameters::Parameters;
use serde::{Deserialize, Serialize};
#[cfg(feature = "verification")]
use std::cmp::Ordering;

/// History that the particles bring along, values at nodes, or a change of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Brought {
    /// Coefficient μ of the surfaces.
    pub friction: Vec<f64>,
    /// Slip velocity s, the magnitude of the law's slip velocity, `m/s`, 0 outside the contact.
    pub speed: Vec<f64>,
    /// Static coefficient μ(θ), that at this temperature and no slip.
    pub static_friction: Vec<f64>,
    /// Way u_pl that the layer has flowed, `m`, 0 outside the contact.
    pub flow: Vec<f64>,
}

impl Brought {
    fn new(nodes: usize) -> Brought {
        Brought {
            friction: vec![0.0; nodes],
            speed: vec![0.0; nodes],
            static_friction: vec![0.0; nodes],
            flow: vec![0.0; nodes],
        }
    }

    fn copy_from(&mut self, other: &Brought) {
        self.friction.copy_from_slice(&other.friction);
        self.speed.copy_from_slice(&other.speed);
        self.static_friction.copy_from_slice(&other.static_friction);
        self.flow.copy_from_slice(&other.flow);
    }
}

/// History of friction at the nodes of a window.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Memory {
    /// Whether the step before has remembered.
    pub remembers: bool,
    /// History at the end of the step.
    pub now: Brought,
    /// History at the beginning of the step, which the derivatives of the step need.
    pub before: Brought,
    /// Derivative of μ of the surfaces by μ(θ) at the node's temperature.
    pub share: Vec<f64>,
    /// Bound of a layer that may flow, over the pressure; 0 without one.
    pub layer_bound: Vec<f64>,
}

impl Memory {
    /// Memory of so many nodes that nothing has happened to yet.
    pub fn new(nodes: usize) -> Memory {
        Memory {
            remembers: false,
            now: Brought::new(nodes),
            before: Brought::new(nodes),
            share: vec![1.0; nodes],
            layer_bound: vec![0.0; nodes],
        }
    }

    /// Whether anything is remembered: μ, or the way of a layer that hardens.
    pub fn is_kept(parameters: &Parameters) -> bool {
        parameters.friction_memory_distance > 0.0
            || (parameters.layer_yield_stress > 0.0 && parameters.layer_hardening > 0.0)
    }

    /// Side of the corners of a layer's law that the nodes are on: whether its strength is less or more than what the surfaces carry, or, to
    /// round-off, as much, which it hardens up to; none without a layer.
    #[cfg(feature = "verification")]
    pub fn layer_sides(&self) -> Vec<Option<Ordering>> {
        let nodes = self.layer_bound.iter().zip(&self.now.friction);
        nodes
            .map(|(&bound, &surfaces)| {
                let equal = (bound - surfaces).abs() <= 1e-9 * surfaces;
                let side = if equal {
                    Ordering::Equal
                } else {
                    bound.total_cmp(&surfaces)
                };
                (bound > 0.0).then_some(side)
            })
            .collect()
    }

    /// The vectors.
    pub fn vectors(&self) -> [&Vec<f64>; 10] {
        let (now, before) = (&self.now, &self.before);
        [
            &now.friction,
            &now.speed,
            &now.static_friction,
            &now.flow,
            &before.friction,
            &before.speed,
            &before.static_friction,
            &before.flow,
            &self.share,
            &self.layer_bound,
        ]
    }

    /// The vectors to change, in the same order.
    pub fn vectors_mut(&mut self) -> [&mut Vec<f64>; 10] {
        let (now, before) = (&mut self.now, &mut self.before);
        [
            &mut now.friction,
            &mut now.speed,
            &mut now.static_friction,
            &mut now.flow,
            &mut before.friction,
            &mut before.speed,
            &mut before.static_friction,
            &mut before.flow,
            &mut self.share,
            &mut self.layer_bound,
        ]
    }

    /// Overwrites it with another of the same size, without allocating.
    pub fn copy_from(&mut self, other: &Memory) {
        self.remembers = other.remembers;
        self.now.copy_from(&other.now);
        self.before.copy_from(&other.before);
        self.share.copy_from_slice(&other.share);
        self.layer_bound.copy_from_slice(&other.layer_bound);
    }

    /// Law of μ of a node in contact as a function of its temperature.
    pub fn point_law(&self, node: usize) -> PointLaw {
        let share = self.share[node];
        PointLaw {
            base: self.now.friction[node] - share * self.now.static_friction[node],
            share,
            layer_bound: self.layer_bound[node],
        }
    }

    /// Derivative of the coefficient of a node in contact by μ(θ).
    pub fn share_at(&self, node: usize) -> f64 {
        self.point_law(node).share_at(self.now.static_friction[node])
    }

    /// Sets μ(θ) of a node in contact to that at its final temperature. Returns the coefficient.
    pub fn at_final_temperature(&mut self, node: usize, static_friction: f64) -> f64 {
        let law = self.point_law(node);
        let surfaces = PointLaw {
            layer_bound: 0.0,
            ..law
        }
        .of((static_friction, 0.0))
        .0;
        (self.now.friction[node], self.now.static_friction[node]) = (surfaces, static_friction);
        law.of((static_friction, 0.0)).0
    }

    /// Makes it that of rail that nothing has happened to yet, without allocating.
    pub fn forget(&mut self) {
        self.remembers = false;
        self.vectors_mut().into_iter().for_each(|values| values.fill(0.0));
        self.share.fill(1.0);
    }

    /// Begins a step from the memory at its beginning. Rail that has remembered nothing yet has rested, at μ(θ) of the nodes then.
    pub fn start_from(&mut self, last: &Memory, static_friction: impl Fn(usize) -> f64) {
        if last.remembers {
            self.before.copy_from(&last.now);
            return;
        }
        self.before.speed.fill(0.0);
        self.before.flow.fill(0.0);
        for node in 0..self.before.static_friction.len() {
            self.before.static_friction[node] = static_friction(node);
        }
        self.before.friction.copy_from_slice(&self.before.static_friction);
    }

    /// Begins without a step before.
    pub fn start_steady(&mut self) {
        for values in [
            &mut self.before.friction,
            &mut self.before.speed,
            &mut self.before.static_friction,
            &mut self.before.flow,
        ] {
            values.fill(0.0);
        }
    }
}

/// History of the particles on one path: the nodes of a window, or of one of its strips.
#[derive(Debug, Clone, Copy)]
pub struct ParticlePath<'a> {
    /// Coefficient μ of the surfaces.
    pub friction: &'a [f64],
    /// Slip velocity s, `m/s`.
    pub speed: &'a [f64],
    /// Static μ(θ).
    pub static_friction: &'a [f64],
    /// Way of flow u_pl, `m`.
    pub flow: &'a [f64],
}

impl Brought {
    /// Path over some of the nodes.
    pub fn path(&self, nodes: std::ops::Range<usize>) -> ParticlePath<'_> {
        ParticlePath {
            friction: &self.friction[nodes.clone()],
            speed: &self.speed[nodes.clone()],
            static_friction: &self.static_friction[nodes.clone()],
            flow: &self.flow[nodes],
        }
    }
}
