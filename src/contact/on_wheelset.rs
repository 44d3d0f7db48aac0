//! Forces on a wheelset, and the contacts that make them, one by one.

use crate::damage::PointDamage;
use crate::geometry::profile::WheelMeasures;

/// Largest number of contacts.
pub const CONTACTS: usize = 4;

/// Force and moment on the wheelset, and the contacts one by one, in the axes of the track.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OnWheelset {
    /// Force on the wheelset, `N`.
    pub force: [f64; 3],
    /// Moment on the wheelset about its middle, `N m`.
    pub moment: [f64; 3],
    /// Moment about the axle, `N m`.
    pub torque: f64,
    /// Number of contacts.
    pub count: usize,
    /// Area per time that the profiles of wheel and rail lose, `m²/s`.
    pub worn_area_rates: [f64; 2],
    /// Measures of the wheel's profile at the beginning of the step; 0 of one without a flange.
    pub measures: WheelMeasures,
    /// The contacts, from the gauge side to the field side.
    pub contacts: [OneContact; CONTACTS],
}

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OneContact {
    /// Arc length of the rail's profile at the resultant of the pressure, `m`.
    pub arc: f64,
    /// Place of the resultant of the pressure ahead of the axle, `m`.
    pub along: f64,
    /// Lateral positions of the resultant of the pressure in the frames of the rail's and of the wheel's profile, `m`.
    pub positions: [f64; 2],
    /// Creepages along and across in the plane of the contact, and of spin, `1/m`, at the resultant of the pressure.
    pub creepages: [f64; 3],
    /// Inclination of the rail's surface there, rad; positive where it rises to the field side.
    pub inclination: f64,
    /// Normal force, `N`.
    pub normal_force: f64,
    /// Friction on the wheel along the rail, and across it in the plane of the contact to the field side, `N`.
    pub friction: [f64; 2],
    /// Moment of the friction on the wheel about the normal through the resultant of the pressure, `N m`.
    pub spin_moment: f64,
    /// Length along the rail and breadth across it, `m`.
    pub size: [f64; 2],
    /// Area, `m²`.
    pub area: f64,
    /// Peak pressure, `Pa`.
    pub peak_pressure: f64,
    /// Peak temperature rise, `K`.
    pub peak_rise: f64,
    /// Friction power, `W`.
    pub friction_power: f64,
    /// Power of creep forces and spin moment over |V|, `N`.
    pub wear_number: f64,
    /// Damage to the points of the rail.
    pub damage: PointDamage,
}
