//! Integrals of the fields over a contact. The sums of two parts of a contact add up to those of the whole.

use super::on_wheelset::OnWheelset;
use super::rim::ContactHeat;
use crate::damage::PointDamage;
use crate::friction::coulomb;

/// State of one surface node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Node {
    /// Position ahead of the axle, `m`.
    pub position: f64,
    /// Position to the left of the axle's middle, `m`; 0 of a line contact, as all across the rail.
    pub lateral: f64,
    /// Pressure, scaled.
    pub pressure: f64,
    /// Shear traction on the rail along it, scaled.
    pub shear: f64,
    /// Shear traction on the rail across it, to the left, scaled.
    pub lateral_shear: f64,
    /// Slip velocity along the rail, `m/s`.
    pub slip: f64,
    /// Slip velocity across the rail, to the left, `m/s`.
    pub lateral_slip: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Heat flux into the rail, `W/m²`.
    pub heat_flux: f64,
    /// Depth worn per time, `m/s`; 0 where wear is Archard's, in proportion to [`NodeSums::sliding`].
    pub wear_rate: f64,
    /// Whether it sticks.
    pub sticks: bool,
}

/// Integrals over a contact, its extent, and what else the outputs are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integrals {
    /// NodeSums over the nodes.
    pub sums: NodeSums,
    /// Area that a node stands for, `m²`.
    pub node_area: f64,
    /// Unit of the scaled tractions, `Pa`.
    pub pressure_scale: f64,
    /// Penetration δ, `m`; 0 when lifted.
    pub penetration: f64,
    /// Length of the contact, `m`.
    pub contact_length: f64,
    /// Breadth of the contact across the rail, `m`; 0 of a line contact.
    pub contact_breadth: f64,
    /// Area of the contact, `m²`; 0 of a line contact.
    pub contact_area: f64,
    /// Largest temperature rise of the rail's surface, `K`.
    pub peak_rise: f64,
    /// Wear depth behind the contact, `m`.
    pub wear_depth: f64,
    /// Temperature rise of the rail's skin where it leaves, `K`.
    pub leaving_rise: f64,
    /// Wear depth of the rail where it leaves, `m`.
    pub leaving_wear_depth: f64,
    /// Heat that the contact gives to the wheel.
    pub wheel_heat: ContactHeat,
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
    /// Damage to the points of the rail.
    pub damage: PointDamage,
    /// Forces on the wheelset and contacts one by one, of a contact of profiles.
    pub on_wheelset: OnWheelset,
}

/// NodeSums and largest values over the nodes. Tractions are scaled; every node stands for the same area.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeSums {
    /// Σ p.
    pub pressure: f64,
    /// Σ p x, `m`.
    pub moment: f64,
    /// Σ τ_x.
    pub shear: f64,
    /// Σ τ_y.
    pub lateral_shear: f64,
    /// Σ (x τ_y − y τ_x), `m`.
    pub spin_moment: f64,
    /// Σ p μ.
    pub friction: f64,
    /// Σ |τ·s|, `m/s`.
    pub friction_power: f64,
    /// Σ p |s|, `m/s`.
    pub sliding: f64,
    /// Σ q, `W/m²`.
    pub heat_flux: f64,
    /// Σ of the depth worn per time, `m/s`; 0 where wear is Archard's, in proportion to Σ p |s|.
    pub wear_rate: f64,
    /// Number of nodes in contact, each counted by its area.
    pub nodes: f64,
    /// Number of those that stick, counted alike.
    pub sticking: f64,
    /// Largest p.
    pub peak_pressure: f64,
    /// Largest |τ|.
    pub peak_shear: f64,
}

impl NodeSums {
    /// NodeSums over the given nodes.
    pub fn of(nodes: impl Iterator<Item = Node>) -> NodeSums {
        let mut sum = NodeSums::default();
        // Of nodes by strips, `for_each` makes two nested loops.
        nodes.for_each(|node| {
            sum.heat_flux += node.heat_flux;
            if node.pressure <= 0.0 {
                return;
            }
            sum.pressure += node.pressure;
            sum.moment += node.pressure * node.position;
            sum.shear += node.shear;
            sum.friction += node.pressure * node.friction;
            let (shear, slip) = ([node.shear, node.lateral_shear], [node.slip, node.lateral_slip]);
            sum.lateral_shear += node.lateral_shear;
            sum.spin_moment += node.position * node.lateral_shear - node.lateral * node.shear;
            sum.friction_power += coulomb::vector_power(shear, slip);
            sum.sliding += node.pressure * coulomb::magnitude(slip);
            sum.wear_rate += node.wear_rate;
            sum.peak_pressure = sum.peak_pressure.max(node.pressure);
            sum.peak_shear = sum.peak_shear.max(coulomb::magnitude(shear));
            sum.nodes += 1.0;
            if node.sticks {
                sum.sticking += 1.0;
            }
        });
        sum
    }

    /// Sums with all areas scaled.
    pub fn scaled(&self, factor: f64) -> NodeSums {
        NodeSums {
            pressure: factor * self.pressure,
            moment: factor * self.moment,
            shear: factor * self.shear,
            lateral_shear: factor * self.lateral_shear,
            spin_moment: factor * self.spin_moment,
            friction: factor * self.friction,
            friction_power: factor * self.friction_power,
            sliding: factor * self.sliding,
            heat_flux: factor * self.heat_flux,
            wear_rate: factor * self.wear_rate,
            nodes: factor * self.nodes,
            sticking: factor * self.sticking,
            ..*self
        }
    }

    /// Sums of both.
    pub fn with(&self, other: &NodeSums) -> NodeSums {
        NodeSums {
            pressure: self.pressure + other.pressure,
            moment: self.moment + other.moment,
            shear: self.shear + other.shear,
            lateral_shear: self.lateral_shear + other.lateral_shear,
            spin_moment: self.spin_moment + other.spin_moment,
            friction: self.friction + other.friction,
            friction_power: self.friction_power + other.friction_power,
            sliding: self.sliding + other.sliding,
            heat_flux: self.heat_flux + other.heat_flux,
            wear_rate: self.wear_rate + other.wear_rate,
            nodes: self.nodes + other.nodes,
            sticking: self.sticking + other.sticking,
            peak_pressure: self.peak_pressure.max(other.peak_pressure),
            peak_shear: self.peak_shear.max(other.peak_shear),
        }
    }

    /// A sum over the pressure's, 0 without contact: Σ p x becomes the resultant's position.
    pub fn per_pressure(&self, sum: f64) -> f64 {
        if self.pressure > 0.0 { sum / self.pressure } else { 0.0 }
    }
}
