//! Leading-edge correction: the edge of the contact falls between two nodes, and the slip of the leading nodes is corrected for it.
//!
//! **The strain of the leading node.** The difference to the node ahead contains the jump of u₁ out of the contact, as the
//! difference of the gaps does: where pressure and shear leave the edge in a fixed ratio, both with the root of the distance,
//! both jumps are in that ratio, too. The jump of the gap is known: the separation w of the node ahead. So w τ/p of the
//! leading node is taken off its strain. A layer between wheel and rail is sheared from the edge on, not from the node ahead: it
//! adds cτ over the distance d to the edge to the strain, in place of that to the node ahead. Where the pressure leaves the edge with the
//! root of the distance, the separation goes with its power 3/2, γ = w E*/(2 Δx p) = ⅔ (1 − q)^{3/2}/√q with q = d/Δx, and
//! 1/q − 1 is 3 γ within a sixth for q between ¼ and ¾. Beyond γ = 1, where the leading node has just joined and carries next to nothing, it is
//! held: with a layer that is far softer than a cell, w τ/p of a pressure that falls to 0 in the midst of an iteration would outweigh all other
//! slip, and Newton's method would not converge.
//!
//! **The slip that is smaller than a cell.** Unlike bodies (Dundurs) have τ/p that grows towards the leading edge with the
//! logarithm of the distance from it, until the edge slips, on less than a cell. The strain between the nodes contains that slip,
//! although they stick. Beside an edge at which a zone of length d slips, the shear is that of full stick less k K d/(2√x),
//! with k = β E*/(2π), and d falls exponentially with the distance of τ/p from μ. So the rows of the first two nodes are given
//! back the slip in their strains, which is against the shear,
//!
//! S β p̂ |V|/Δx exp((ρ̂ − μ)/k),  S = 0.21 + 0.57 ω(1 − ω),
//!
//! with p̂ and ρ̂ the pressure and τ/p of the next nodes, shared by ω = γ/(1 + γ), γ = w E*/(2 Δx p): 0 where the node
//! ahead just touches, 1 where the leading node has just joined, so that nothing jumps when a node joins. The two numbers
//! of S are fitted to solutions on refined nodes. The verification's creep curves show what both corrections leave.

use crate::body::compliance::Scales;
use crate::body::half_plane::HalfPlanes;

/// Separation, pressures and shears below this multiple of the unit pressure are not divided by.
const LEAST_PRESSURE: f64 = 1e-12;
/// Ratio (1/q − 1)/γ of the heading, by which a layer adds to the strain.
pub const LAYER_STRAIN: f64 = 3.0;
/// Largest γ that a layer's strain is taken for.
const LARGEST_GAMMA: f64 = 1.0;
/// Hidden slip S at ω = 0 and 1, and its rise towards ω = ½ over ω(1 − ω).
const HIDDEN_SLIP: [f64; 2] = [0.21, 0.57];

/// Compliance of the half-planes within one cell, scaled: displacement per traction on the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearField {
    /// Σ (1 − ν)/γ over both bodies times Δx, that is 2Δx/E*.
    pub direct: f64,
    /// β Δx: (1 − 2ν)/(2γ) of the rail less that of the wheel, times Δx.
    pub coupling: f64,
    /// Strain that a layer adds at the leading node, over the correction w τ/p of the strain without a layer: 0 without one.
    pub layer: f64,
}

/// Leading edge of one contact.
#[derive(Debug, Clone, Copy)]
pub struct LeadingEdge {
    /// Compliance of the half-planes within one cell.
    pub near_field: NearField,
    /// Whether the three leading nodes are neighbours, and at least one more follows them: else only the strain is corrected.
    pub resolved: bool,
    /// Whether the leading side is that of +x₁.
    pub forward: bool,
    /// |V| times the displacement scale over the node spacing, `m/s`.
    pub strain_speed: f64,
}

/// Values at the three leading nodes, the first of them first, and ahead of them.
#[derive(Debug, Clone, Copy, Default)]
pub struct EdgeValues {
    /// Pressure.
    pub pressure: [f64; 3],
    /// Shear.
    pub shear: [f64; 3],
    /// μ at the first.
    pub friction: f64,
    /// Separation of the node ahead.
    pub gap: f64,
}

/// Correction of the slip of one node at the leading edge, and its partial derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeCorrection {
    /// Slip that is added, `m/s`.
    pub slip: f64,
    /// Derivatives by the pressures.
    pub by_pressure: [f64; 3],
    /// Derivatives by the shears.
    pub by_shear: [f64; 3],
    /// Derivative by μ.
    pub by_friction: f64,
    /// Derivative by the separation ahead.
    pub by_gap: f64,
}

impl EdgeCorrection {
    /// Change of the correction with a change of the values at the edge.
    pub fn change(&self, edge: &EdgeValues) -> f64 {
        let mut change = self.by_friction * edge.friction + self.by_gap * edge.gap;
        for node in 0..3 {
            change += self.by_pressure[node] * edge.pressure[node] + self.by_shear[node] * edge.shear[node];
        }
        change
    }
}

/// Ratio w/p of the separation ahead to the pressure of the leading node, and its derivatives.
#[derive(Debug, Clone, Copy)]
struct SeparationRatio {
    ratio: f64,
    by_gap: f64,
    by_pressure: f64,
}

impl NearField {
    /// Compliance of half-planes within cells `spacing` `m` long.
    pub fn new(half_planes: &HalfPlanes, spacing: f64, scales: &Scales) -> NearField {
        let cell = scales.compliance(spacing);
        NearField {
            direct: half_planes.direct * cell,
            coupling: half_planes.coupling * cell,
            layer: 0.0,
        }
    }

    /// Near field with a layer of this compliance, scaled, between the bodies.
    pub fn with_layer(self, compliance: f64) -> NearField {
        NearField {
            layer: LAYER_STRAIN * compliance / self.direct,
            ..self
        }
    }
}

impl LeadingEdge {
    /// Corrections of the slip of the first and of the second node.
    pub fn corrections(&self, edge: &EdgeValues) -> [EdgeCorrection; 2] {
        let mut rows = [EdgeCorrection::default(); 2];
        if edge.pressure[0] <= LEAST_PRESSURE {
            return rows;
        }
        let open = edge.gap.max(0.0);
        let opens = if edge.gap > 0.0 { 1.0 } else { 0.0 };
        let ratio = open / edge.pressure[0];
        let ratio_by_gap = opens / edge.pressure[0];
        let ratio_by_pressure = -ratio / edge.pressure[0];
        let NearField { direct, layer, .. } = self.near_field;
        let held = LARGEST_GAMMA * direct;
        let slope = 1.0 + if ratio < held { layer } else { 0.0 };
        let (speed, strain) = (self.strain_speed, ratio + layer * ratio.min(held));
        rows[0].slip = speed * strain * edge.shear[0];
        rows[0].by_shear[0] = speed * strain;
        rows[0].by_gap = speed * slope * ratio_by_gap * edge.shear[0];
        rows[0].by_pressure[0] = speed * slope * ratio_by_pressure * edge.shear[0];
        let coupled = self.near_field.coupling != 0.0;
        if coupled && self.resolved && edge.pressure[1].min(edge.pressure[2]) > LEAST_PRESSURE {
            let separation = SeparationRatio {
                ratio,
                by_gap: ratio_by_gap,
                by_pressure: ratio_by_pressure,
            };
            self.add_hidden_slip(edge, separation, &mut rows);
        }
        rows
    }

    /// Adds the slip that is smaller than a cell.
    fn add_hidden_slip(&self, edge: &EdgeValues, separation: SeparationRatio, rows: &mut [EdgeCorrection; 2]) {
        let SeparationRatio {
            ratio,
            by_gap: ratio_by_gap,
            by_pressure: ratio_by_pressure,
        } = separation;
        let NearField { direct, coupling, .. } = self.near_field;
        // Sign of the shear at an edge that slips: + on a rail softer than the wheel that is travelled along +x₁. A harder rail
        // turns it, and so does travel along −x₁.
        let sign = if (coupling > 0.0) == self.forward { 1.0 } else { -1.0 };
        let slope = coupling.abs() / (std::f64::consts::PI * direct);
        let [_, p1, p2] = edge.pressure;
        let (r1, r2) = (edge.shear[1] / p1, edge.shear[2] / p2);

        let gamma = ratio / direct;
        let weight = gamma / (1.0 + gamma);
        let weight_by_ratio = 1.0 / (direct * (1.0 + gamma) * (1.0 + gamma));
        let hidden = HIDDEN_SLIP[0] + HIDDEN_SLIP[1] * weight * (1.0 - weight);
        let hidden_by_weight = HIDDEN_SLIP[1] * (1.0 - 2.0 * weight);
        let pressure = (1.0 - weight) * p1 + weight * p2;
        let exponent = (sign * ((1.0 - weight) * r1 + weight * r2) - edge.friction) / slope;
        let decay = exponent.min(0.0).exp();
        let falls = if exponent < 0.0 { decay / slope } else { 0.0 };

        let scale = sign * self.strain_speed * coupling.abs();
        let slip = scale * hidden * pressure * decay;
        let by_weight = scale
            * ((hidden_by_weight * pressure + hidden * (p2 - p1)) * decay
                + hidden * pressure * falls * sign * (r2 - r1));
        let by_exponent = scale * hidden * pressure * falls;
        let whole = EdgeCorrection {
            slip,
            by_pressure: [
                by_weight * weight_by_ratio * ratio_by_pressure,
                (1.0 - weight) * (scale * hidden * decay - by_exponent * sign * r1 / p1),
                weight * (scale * hidden * decay - by_exponent * sign * r2 / p2),
            ],
            by_shear: [
                0.0,
                by_exponent * sign * (1.0 - weight) / p1,
                by_exponent * sign * weight / p2,
            ],
            by_friction: -by_exponent,
            by_gap: by_weight * weight_by_ratio * ratio_by_gap,
        };
        for (row, factor, factor_by_weight) in [(0, 1.0 - weight, -1.0), (1, weight, 1.0)] {
            let added = &mut rows[row];
            let by_ratio = factor_by_weight * weight_by_ratio * slip;
            added.slip += factor * whole.slip;
            for node in 0..3 {
                added.by_pressure[node] += factor * whole.by_pressure[node];
                added.by_shear[node] += factor * whole.by_shear[node];
            }
            added.by_pressure[0] += by_ratio * ratio_by_pressure;
            added.by_friction += factor * whole.by_friction;
            added.by_gap += factor * whole.by_gap + by_ratio * ratio_by_gap;
        }
    }
}

#[cfg(test)]
mod duals;
#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub const EDGE: LeadingEdge = LeadingEdge {
        near_field: NearField {
            direct: 0.04,
            coupling: 0.012,
            layer: 0.7,
        },
        resolved: true,
        forward: true,
        strain_speed: 20.0,
    };

    proptest! {
        /// Corrections do not jump where the node ahead comes under pressure: it is then the leading one, without pressure yet.
        #[test]
        fn a_node_that_joins_changes_nothing(pressure in prop::array::uniform3(0.1..0.5_f64), ratio in -0.3..0.28_f64) {
            let touching = EdgeValues { pressure, shear: pressure.map(|p| ratio * p), friction: 0.3, gap: 0.0 };
            // The next node has joined: the pressure is next to nothing, the gap ahead of it finite.
            let joined = EdgeValues {
                pressure: [1e-9, pressure[0], pressure[1]],
                shear: [ratio * 1e-9, ratio * pressure[0], ratio * pressure[1]],
                friction: 0.3,
                gap: 0.02,
            };
            let (before, after) = (EDGE.corrections(&touching), EDGE.corrections(&joined));
            // Rows of the same nodes: the first before is the second after.
            prop_assert!((before[0].slip - after[1].slip).abs() < 1e-4 * EDGE.strain_speed * EDGE.near_field.coupling);
            prop_assert!(before[1].slip.abs() < 1e-15);
        }
    }

    /// The formula of the heading with its numbers: where the node ahead just touches, and half-way to where it has joined; on an
    /// edge that sticks, and on one that slips.
    #[test]
    fn the_hidden_slip_is_that_of_the_formula() {
        let pressure = [0.1, 0.2, 0.3];
        // k = β E*/(2π).
        let k = 0.012 / (std::f64::consts::PI * 0.04);
        let unit = 20.0 * 0.012;
        for (ratio, decay) in [(0.2, (-0.1 / k).exp()), (0.31, 1.0)] {
            let edge = |gap: f64| EdgeValues {
                pressure,
                shear: [0.0, ratio * 0.2, ratio * 0.3],
                friction: 0.3,
                gap,
            };
            let [first, second] = EDGE.corrections(&edge(0.0));
            assert!((first.slip - unit * 0.21 * 0.2 * decay).abs() < 1e-15);
            assert_eq!(second.slip, 0.0);
            // w E*/(2 Δx p) = 1: ω = ½.
            for row in EDGE.corrections(&edge(0.004)) {
                assert!((row.slip - 0.5 * unit * (0.21 + 0.57 / 4.0) * 0.25 * decay).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn like_bodies_have_no_hidden_slip() {
        let mut front = EDGE;
        front.near_field.coupling = 0.0;
        let edge = EdgeValues {
            pressure: [0.1, 0.2, 0.3],
            shear: [0.03, 0.06, 0.09],
            friction: 0.3,
            gap: 0.01,
        };
        let [first, second] = front.corrections(&edge);
        // The layer's part is held at γ = 1.
        assert!((first.slip - 20.0 * (0.01 / 0.1 + 0.7 * 0.04) * 0.03).abs() < 1e-15);
        assert_eq!(second, EdgeCorrection::default());
    }
}
