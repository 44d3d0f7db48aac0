//! Profiles for plotting, sampled at fixed numbers of points whatever the mesh is. Every engine fills them in.

/// Points along the contact window.
pub const PROFILE_POINTS: usize = 61;
/// Points below the hottest contact point.
pub const DEPTH_POINTS: usize = 41;
/// Points across the window of a patch.
pub const STRIP_POINTS: usize = 21;
/// Depth of the lowest point below the surface, `m`.
const LARGEST_DEPTH: f64 = 10e-3;

/// Profiles along the contact window, [`PROFILE_POINTS`] points each, the temperature in depth, and, of a patch, profiles
/// across the window, [`STRIP_POINTS`] points each. Along the rail those of a patch are of its middle strip; of profiles all are of the window
/// that carries most, and of its strip that does.
#[derive(Debug, Clone, PartialEq)]
pub struct Profiles {
    /// Position, `m`.
    pub x: Vec<f64>,
    /// Pressure, `Pa`.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail, `Pa`.
    pub shear: Vec<f64>,
    /// Slip velocity, `m/s`, 0 outside the contact.
    pub slip: Vec<f64>,
    /// Absolute surface temperature, `K`.
    pub temperature: Vec<f64>,
    /// Wear depth, `m`.
    pub wear_depth: Vec<f64>,
    /// Depth below the hottest contact point, [`DEPTH_POINTS`] points, `m`.
    pub depth: Vec<f64>,
    /// Absolute temperature at that depth, `K`.
    pub depth_temperature: Vec<f64>,
    /// Profiles across the window.
    pub strips: StripProfiles,
}

/// Profiles across the window of a patch, [`STRIP_POINTS`] points each.
#[derive(Debug, Clone, PartialEq)]
pub struct StripProfiles {
    /// Position to the left, `m`.
    pub position: Vec<f64>,
    /// Largest pressure along the strip, `Pa`.
    pub pressure: Vec<f64>,
    /// Largest absolute surface temperature along the strip, `K`.
    pub temperature: Vec<f64>,
    /// Wear depth behind the contact, `m`.
    pub wear_depth: Vec<f64>,
    /// Friction power per width, `W/m`.
    pub friction_power: Vec<f64>,
}

impl StripProfiles {
    /// Profiles of a contact without strips: a line contact, or a rail that nothing has touched.
    pub fn none(ambient: f64) -> StripProfiles {
        StripProfiles {
            position: vec![0.0; STRIP_POINTS],
            pressure: vec![0.0; STRIP_POINTS],
            temperature: vec![ambient; STRIP_POINTS],
            wear_depth: vec![0.0; STRIP_POINTS],
            friction_power: vec![0.0; STRIP_POINTS],
        }
    }
}

impl Profiles {
    /// Profiles of a rail that nothing has touched, all points in one place.
    pub fn untouched(ambient: f64) -> Profiles {
        let along = || vec![0.0; PROFILE_POINTS];
        Profiles {
            x: along(),
            pressure: along(),
            shear: along(),
            slip: along(),
            temperature: vec![ambient; PROFILE_POINTS],
            wear_depth: along(),
            depth: vec![0.0; DEPTH_POINTS],
            depth_temperature: vec![ambient; DEPTH_POINTS],
            strips: StripProfiles::none(ambient),
        }
    }
}

/// Place of a profile in which the depth of its wear is collected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WornPlace {
    /// Lateral position on the new profile, in its own frame, `m`.
    pub position: f64,
    /// Arc length of the new profile, `m`.
    pub arc_length: f64,
    /// Depth along the normal, `m`.
    pub depth: f64,
    /// Place of the worn surface in the track, to the left of its middle and above the height of the rail's top, `m`; of the wheel below its axle.
    pub in_track: [f64; 2],
}

/// Wear of both profiles, from the gauge or flange side to the field side; of profiles that stay new with a depth of 0.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileDepths {
    /// The wheel's.
    pub wheel: Vec<WornPlace>,
    /// The rail's, on the profile as it was read, which is upright.
    pub rail: Vec<WornPlace>,
}

/// Samples the values of evenly spaced nodes at evenly spaced points, both from the first node to the last, linear between the nodes.
pub fn sample(values: &[f64], points: usize) -> Vec<f64> {
    let n = values.len();
    (0..points)
        .map(|i| {
            let position = i as f64 * (n - 1) as f64 / (points - 1) as f64;
            let left = (position as usize).min(n - 2);
            let weight = position - left as f64;
            values[left] * (1.0 - weight) + values[left + 1] * weight
        })
        .collect()
}

/// Depths of [`Profiles::depth`] in a body of the given height, `m`. Their spacing grows with the square of the index: most
/// lie in the heated skin.
pub fn depths(height: f64) -> Vec<f64> {
    (0..DEPTH_POINTS)
        .map(|i| LARGEST_DEPTH.min(0.5 * height) * (i as f64 / (DEPTH_POINTS - 1) as f64).powi(3))
        .collect()
}

/// Fields at one surface node of the contact window, of a patch at the centre of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactNode {
    /// x₁, `m`.
    pub position: f64,
    /// y, to the left, `m`; 0 of a line contact.
    pub lateral_position: f64,
    /// Pressure, `Pa`.
    pub pressure: f64,
    /// Shear traction on the rail along it, `Pa`.
    pub shear: f64,
    /// Shear traction on the rail to the left, `Pa`; 0 of a line contact.
    pub lateral_shear: f64,
    /// Slip velocity along the rail, `m/s`; 0 outside the contact.
    pub slip: f64,
    /// Slip velocity to the left, `m/s`; 0 of a line contact.
    pub lateral_slip: f64,
    /// Traction utilisation −τ/(μ p), with the sign of the slip; of a patch its magnitude |τ|/(μ p).
    pub utilisation: f64,
    /// Friction coefficient; where a layer flows, its bound over the pressure.
    pub friction_coefficient: f64,
    /// Temperature rise over the ambient, `K`.
    pub temperature: f64,
    /// Wear depth, `m`.
    pub wear_depth: f64,
}

impl ContactNode {
    /// Node at a place that nothing has touched.
    pub const UNTOUCHED: ContactNode = ContactNode {
        position: 0.0,
        lateral_position: 0.0,
        pressure: 0.0,
        shear: 0.0,
        lateral_shear: 0.0,
        slip: 0.0,
        lateral_slip: 0.0,
        utilisation: 0.0,
        friction_coefficient: 0.0,
        temperature: 0.0,
        wear_depth: 0.0,
    };
}

/// Window of a contact of profiles on the unrolled surface of the rail, with its cells.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceWindow {
    /// Length of a cell along the rail, `m`.
    pub cell_length: f64,
    /// Breadth of a strip along the arc of the rail's profile, `m`.
    pub strip_breadth: f64,
    /// Positions of the cells of a strip ahead of the axle, `m`.
    pub x: Vec<f64>,
    /// Strips, from the gauge side to the field side.
    pub strips: Vec<SurfaceStrip>,
    /// Fields at the cells, strip by strip. Lateral parts are along the arc of the profile, positive to the left.
    pub nodes: Vec<ContactNode>,
}

/// Place of a strip of a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceStrip {
    /// Arc length of the rail's new profile from its gauge side, `m`.
    pub arc_length: f64,
    /// Place in the track, to the left of its middle and above the height of the rail's top, `m`.
    pub in_track: [f64; 2],
    /// Inclination of the rail's surface to the plane of the track, rad; positive where it rises to the field side.
    pub inclination: f64,
}

impl SurfaceWindow {
    /// Force of the pressure, `N`.
    pub fn normal_force(&self) -> f64 {
        self.cell_length * self.strip_breadth * self.nodes.iter().map(|node| node.pressure).sum::<f64>()
    }
}
