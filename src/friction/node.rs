//! The friction law at one node of a path, and what a particle takes from there to the next one: see [`super::path`].

use super::layer::Yielding;
use std::ops::{Add, Mul};

/// The law at a node for given temperature, all that the slip in the step does not change.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathNode {
    /// Static μ(θ) M at the node.
    pub(super) steady: f64,
    /// Advected μ, T μ without the part of the node upstream.
    pub(super) advected: f64,
    /// Courant weight of the μ of the node upstream.
    pub(super) courant_weight: f64,
    /// Advected slip velocity, T s without the part of the node upstream, `m/s`.
    pub(super) speed: f64,
    /// Courant weight of the slip velocity of the node upstream.
    pub(super) speed_weight: f64,
    /// Advected way of flow, T u_pl without the part of the node upstream, `m`.
    pub(super) flow: f64,
    /// Courant weight of the u_pl of the node upstream.
    pub(super) flow_weight: f64,
}

/// Values that a particle takes from a node in contact to the next one, or a change of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Passed<T = f64> {
    /// Coefficient μ of the surfaces.
    pub friction: T,
    /// Magnitude of the slip velocity, `m/s`.
    pub speed: T,
    /// Way of flow u_pl, `m`.
    pub flow: T,
}

/// Derivatives by which a change at a node follows from that at the node before, in either precision.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Link<T> {
    /// Derivatives of μ of the surfaces by that of the node before, by the slip velocity there and by the node's own.
    by_before: T,
    by_speed_before: T,
    by_speed: T,
    /// Derivatives of the coefficient by μ of the surfaces and by u_pl.
    by_friction: T,
    by_flow: T,
    /// Derivatives of u_pl by that of the node before, by the node's own slip velocity and by μ.
    flow_by_before: T,
    flow_by_speed: T,
    flow_by_friction: T,
}

impl<T: Copy + Add<Output = T> + Mul<Output = T>> Link<T> {
    /// Changes of the coefficient with those of what comes from the node before, and of what it passes on with that of its own slip velocity besides.
    #[inline(always)]
    pub fn change(&self, before: &Passed<T>, speed: T) -> (T, Passed<T>) {
        let friction = self.by_before * before.friction + self.by_speed_before * before.speed;
        let flow = self.flow_by_before * before.flow;
        let linked = self.by_friction * friction + self.by_flow * flow;
        let friction = friction + self.by_speed * speed;
        let passed = Passed {
            friction,
            speed,
            flow: flow + self.flow_by_speed * speed + self.flow_by_friction * friction,
        };
        (linked, passed)
    }
}

impl Link<f64> {
    /// Rounded to single precision.
    pub fn single(&self) -> Link<f32> {
        Link {
            by_before: self.by_before as f32,
            by_speed_before: self.by_speed_before as f32,
            by_speed: self.by_speed as f32,
            by_friction: self.by_friction as f32,
            by_flow: self.by_flow as f32,
            flow_by_before: self.flow_by_before as f32,
            flow_by_speed: self.flow_by_speed as f32,
            flow_by_friction: self.flow_by_friction as f32,
        }
    }
}

/// Friction at a node: the coefficient and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeFriction {
    /// The bound on the shear over the pressure: μ of the surfaces where no layer flows.
    pub coefficient: f64,
    /// Coefficient μ of the surfaces.
    pub surfaces: f64,
    /// Derivative of the coefficient by μ(θ) at the node's temperature.
    pub share: f64,
    /// Derivative of the coefficient by the μ of the node upstream.
    pub(super) by_before: f64,
    /// Derivative of the coefficient by the magnitude of the slip velocity at the node upstream, `s/m`.
    pub(super) by_speed_before: f64,
    /// Derivative of the coefficient by the magnitude of the node's own slip velocity, `s/m`.
    pub(super) by_speed: f64,
    /// The layer.
    pub(super) layer: Yielding,
    /// Derivative of u_pl by that of the node upstream.
    pub(super) flow_by_before: f64,
}

impl Default for NodeFriction {
    fn default() -> NodeFriction {
        NodeFriction {
            coefficient: 0.0,
            share: 0.0,
            surfaces: 0.0,
            by_before: 0.0,
            by_speed_before: 0.0,
            by_speed: 0.0,
            layer: Yielding::none(0.0),
            flow_by_before: 0.0,
        }
    }
}

impl NodeFriction {
    /// Way of flow u_pl, `m`.
    pub fn flow(&self) -> f64 {
        self.layer.flow
    }

    /// The layer's bound over the pressure; 0 without a layer.
    pub fn layer_bound(&self) -> f64 {
        self.layer.layer_bound
    }

    /// Derivative of the coefficient by the node's own slip velocity, `s/m`.
    pub fn by_speed(&self) -> f64 {
        self.layer.by_friction * self.by_speed + self.layer.by_flow * self.layer.flow_by_speed
    }

    /// Derivative of the coefficient by the node's own pressure.
    pub fn by_pressure(&self) -> f64 {
        self.layer.by_pressure
    }

    /// Returns the values that a particle takes from this node to the next one.
    pub fn passed(&self, speed: f64) -> Passed {
        Passed {
            friction: self.surfaces,
            speed,
            flow: self.layer.flow,
        }
    }

    /// Derivatives by which a change here follows from that at the node before.
    pub fn link(&self) -> Link<f64> {
        let layer = &self.layer;
        Link {
            by_before: self.by_before,
            by_speed_before: self.by_speed_before,
            by_speed: self.by_speed,
            by_friction: layer.by_friction,
            by_flow: layer.by_flow,
            flow_by_before: self.flow_by_before,
            flow_by_speed: layer.flow_by_speed,
            flow_by_friction: layer.flow_by_friction,
        }
    }

    /// [`Link::change`], and of what it passes on with that of its own pressure besides.
    pub fn change(&self, before: &Passed, speed: f64, pressure: f64) -> (f64, Passed) {
        let (linked, passed) = self.link().change(before, speed);
        let flow = passed.flow + self.layer.flow_by_pressure * pressure;
        (linked, Passed { flow, ..passed })
    }

    /// [`NodeFriction::change`] of several changes side by side: of what is passed on, and in place of the slip velocities the linked changes
    /// of the coefficient. Each waits for that of the node before: side by side they wait together. `flows` says whether a layer may.
    pub fn changes<const N: usize>(
        &self,
        flows: bool,
        passed: &mut PassedTogether<N>,
        speed: &mut [f64; N],
        pressure: &[f64; N],
    ) {
        for k in 0..N {
            let before = Passed {
                friction: passed.friction[k],
                speed: passed.speed[k],
                flow: passed.flow[k],
            };
            passed.speed[k] = speed[k];
            if flows {
                let (linked, now) = self.change(&before, speed[k], pressure[k]);
                (speed[k], passed.friction[k], passed.flow[k]) = (linked, now.friction, now.flow);
            } else {
                let linked = self.by_before * before.friction + self.by_speed_before * before.speed;
                passed.friction[k] = linked + self.by_speed * speed[k];
                speed[k] = linked;
            }
        }
    }
}

/// [`Passed`] of several changes side by side.
#[derive(Debug, Clone, Copy)]
pub struct PassedTogether<const N: usize> {
    pub(super) friction: [f64; N],
    pub(super) speed: [f64; N],
    pub(super) flow: [f64; N],
}

impl<const N: usize> Default for PassedTogether<N> {
    fn default() -> Self {
        let nothing = [0.0; N];
        PassedTogether {
            friction: nothing,
            speed: nothing,
            flow: nothing,
        }
    }
}
