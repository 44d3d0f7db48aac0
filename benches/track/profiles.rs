//! Inputs of a left wheel S1002 on 60E1 on the rough track: the load and the creepages of the patch there, and as much variation of spin.

use wheelrail::Inputs;

/// A wheelset at a lateral displacement.
pub struct OnProfiles {
    /// Name in the tables.
    pub name: &'static str,
    /// Lateral displacement to the left, `m`.
    displacement: f64,
    /// Rolling radius at the contact that carries most, `m`.
    rolling_radius: f64,
    /// Distance of that contact from the middle of the wheelset, `m`.
    lever: f64,
}

/// Wheelsets in the middle of the track, which touch on the tread alone, and to the left, where the gauge corner carries the smaller part of the load, and slides.
/// Rolling radius and lever are those with which the creepages are the track's (`profiles_have_the_creepages_of_the_track` in the tests).
pub const PROFILES: [OnProfiles; 2] = [
    OnProfiles {
        name: "tread",
        displacement: 0.0,
        rolling_radius: 459.98e-3,
        lever: 750.6e-3,
    },
    OnProfiles {
        name: "two",
        displacement: 5e-3,
        rolling_radius: 461.24e-3,
        lever: 732.6e-3,
    },
];
/// Radius by which the track's speeds make its creepages, `m`.
pub const RADIUS: f64 = 0.46;
/// Part of the track's spin that the inclination of a contact makes by itself, `1/m`.
const INCLINED: f64 = 0.1;

impl OnProfiles {
    /// Inputs with the same creepages, mirrored: the inclination of a left wheel's contact spins it the other way. A wheelset that yaws drives its
    /// wheels along the rail; the speed of the wheel makes up for that, and for its rolling radius.
    pub fn inputs(&self, patch: &Inputs) -> Inputs {
        let yaw_rate = INCLINED * patch.vehicle_speed - patch.spin_rate;
        Inputs {
            wheel_speed: (RADIUS * patch.wheel_speed - self.lever * yaw_rate) / self.rolling_radius,
            lateral_speed: -patch.lateral_speed,
            spin_rate: 0.0,
            yaw_rate,
            lateral_displacement: self.displacement,
            ..*patch
        }
    }
}
