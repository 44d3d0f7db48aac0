//! The plastic flow of a layer between wheel and rail.
//!
//! The layer yields where the shear reaches τ_c = τ_c0 + k u_pl, u_pl being the way that it has flowed where a particle of the rail is: 0 where
//! the particle enters the contact, and forgotten where it leaves. So the bound on the shear is the smaller of the surfaces' and the
//! layer's, min(μ p, τ_c), and the motion beyond it is flow of the layer, du_pl/dt = |s|, where the layer's bound is the smaller
//! one, and slip of the surfaces where it is not (Meierhofer, A new wheel-rail creep force model based on elasto-plastic third body layers, thesis, Graz
//! 2015; so in CONTACT's user guide). As friction is in [`super::path`], it is marched along with the rail, implicitly: a particle that brings T u_pl has
//! on its way of the time t
//!
//! u_pl = T u_pl + |s| t, but no more than up to τ_c = μ p.

use super::passage::{Passage, PathStep};
use crate::parameters::Parameters;

/// The layer's law of all nodes in a step, its stresses scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerLaw {
    /// Strength τ_c0 without flow, scaled.
    strength: f64,
    /// Hardening k, `1/m`, scaled.
    hardening: f64,
    /// Weights T; its residence is the time t itself, `s`, in place of t/d_c.
    pub passage: Passage,
    /// Change of `passage` with |V|.
    pub passage_tangent: Passage,
}

/// Bound on the shear of a node, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yielding {
    /// The bound over the pressure.
    pub coefficient: f64,
    /// The layer's own bound over the pressure; 0 without one.
    pub layer_bound: f64,
    /// Derivative of the coefficient by μ of the surfaces: 1, or 0 where the layer flows only.
    pub by_friction: f64,
    /// Derivative of the coefficient by u_pl, `1/m`: 0 where the surfaces slip.
    pub by_flow: f64,
    /// Derivative of the coefficient by the pressure at an unchanged u_pl.
    pub by_pressure: f64,
    /// Way of flow u_pl, `m`.
    pub flow: f64,
    /// Derivative of u_pl by T u_pl.
    pub flow_by_advected: f64,
    /// Derivative of u_pl by the magnitude of the slip velocity, `s`.
    pub flow_by_speed: f64,
    /// Derivative of u_pl by t, `m/s`.
    pub flow_by_time: f64,
    /// Derivative of u_pl by μ, `m`.
    pub flow_by_friction: f64,
    /// Derivative of u_pl by the pressure, `m`.
    pub flow_by_pressure: f64,
}

impl Yielding {
    /// No layer that could.
    #[inline(always)]
    pub fn none(coefficient: f64) -> Yielding {
        Yielding {
            coefficient,
            layer_bound: 0.0,
            by_friction: 1.0,
            by_flow: 0.0,
            by_pressure: 0.0,
            flow: 0.0,
            flow_by_advected: 0.0,
            flow_by_speed: 0.0,
            flow_by_time: 0.0,
            flow_by_friction: 0.0,
            flow_by_pressure: 0.0,
        }
    }
}

impl LayerLaw {
    /// Law of the parameters; none where the layer never yields.
    pub fn new(parameters: &Parameters, step: &PathStep) -> Option<LayerLaw> {
        if parameters.layer_yield_stress == 0.0 {
            return None;
        }
        let (duration, spacing, speed) = (step.duration, step.spacing, step.speed.abs());
        // Where it does not harden it need not know how far it has flowed.
        let way = if parameters.layer_hardening > 0.0 { 1.0 } else { 0.0 };
        Some(LayerLaw {
            strength: parameters.layer_yield_stress / step.pressure,
            hardening: parameters.layer_hardening / step.pressure,
            passage: Passage::new(duration, spacing, speed, way),
            passage_tangent: Passage::new(duration, spacing, speed, way).tangent(duration, spacing, speed),
        })
    }

    /// Whether it knows how far it has flowed.
    pub fn hardens(&self) -> bool {
        self.passage.residence.is_finite()
    }

    /// Residence time t, `s`; 0 where the law does not ask for it.
    fn time(&self) -> f64 {
        if self.hardens() { self.passage.residence } else { 0.0 }
    }

    /// Bound at a node of this μ and pressure, and u_pl of a particle that brings `advected` `m` and moves with this slip velocity,
    /// `m/s`.
    pub fn bound(&self, (coefficient, pressure): (f64, f64), advected: f64, speed: f64) -> Yielding {
        let (bound, time) = (coefficient * pressure, self.time());
        let first = self.strength + self.hardening * advected;
        let last = first + self.hardening * time * speed;
        let none = Yielding {
            layer_bound: if pressure > 0.0 { last / pressure } else { 0.0 },
            ..Yielding::none(coefficient)
        };
        if bound <= first {
            // The surfaces slip.
            Yielding {
                flow: advected,
                flow_by_advected: 1.0,
                ..none
            }
        } else if bound <= last {
            // The layer flows until it is as strong as the surfaces, which then slip.
            Yielding {
                flow: (bound - self.strength) / self.hardening,
                flow_by_friction: pressure / self.hardening,
                flow_by_pressure: coefficient / self.hardening,
                ..none
            }
        } else {
            let coefficient = last / pressure;
            Yielding {
                coefficient,
                by_friction: 0.0,
                by_flow: self.hardening / pressure,
                by_pressure: -coefficient / pressure,
                flow: advected + time * speed,
                flow_by_advected: 1.0,
                flow_by_speed: time,
                flow_by_time: speed,
                ..none
            }
        }
    }
}
