//! Limits of steady rolling on CONTACT's ellipses under refinement, by an independent program: spin alone and creepages combined, where
//! [`super::contact_points`] has no points.
//!
//! Piecewise constant tractions on n × n elements over the ellipse's box, the strain by the difference over one element, Coulomb's
//! law exactly, the pressure by the same influence functions: the discrete problem of CONTACT, whose 32 forces and 8 moments in
//! [`super::contact_points`] it gives to 1e-5. The limits are extrapolated from n = 40 and 80 as [`CreepForce::limit`]
//! does; the steps from n = 20 to 40 to 80 let expect them to be known to some 0.002.
//!
//! [`CreepForce::limit`]: super::contact_points::CreepForce::limit

/// Creepages and forces of one case, with wheelrail's signs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Index into [`super::contact_points::ELLIPSES`].
    pub ellipse: usize,
    /// ξ, η, and φ √(ab).
    pub creepages: [f64; 3],
    /// F_x and F_y over μN, and M_z over μN √(ab), on the wheel.
    pub forces: [f64; 3],
}

const fn limit(ellipse: usize, creepages: [f64; 3], forces: [f64; 3]) -> Limit {
    Limit {
        ellipse,
        creepages,
        forces,
    }
}

/// Limits at all creepages: ξ, η and φ alone, then combined.
pub const LIMITS: [Limit; 48] = [
    limit(0, [0.0005, 0.0, 0.0], [0.309, 0.0, 0.0]),
    limit(0, [0.001, 0.0, 0.0], [0.5538, 0.0, 0.0]),
    limit(0, [0.002, 0.0, 0.0], [0.8698, 0.0, 0.0]),
    limit(0, [0.0, 0.0005, 0.0], [0.0, -0.2518, 0.0662]),
    limit(0, [0.0, 0.001, 0.0], [0.0, -0.4611, 0.0996]),
    limit(0, [0.0, 0.002, 0.0], [0.0, -0.7646, 0.1008]),
    limit(0, [0.0, 0.0, 0.0005], [0.0, -0.0837, -0.153]),
    limit(0, [0.0, 0.0, 0.001], [0.0, -0.1619, -0.2639]),
    limit(0, [0.0, 0.0, 0.002], [0.0, -0.2956, -0.3998]),
    limit(0, [0.0, 0.0, 0.004], [0.0, -0.4454, -0.5107]),
    limit(0, [0.001, 0.0005, 0.0008], [0.5001, -0.3404, -0.1163]),
    limit(0, [0.001, -0.0005, 0.0008], [0.4996, 0.0981, -0.1969]),
    limit(0, [-0.001, 0.001, 0.0005], [-0.4983, -0.4889, -0.0327]),
    limit(0, [0.0005, 0.0005, 0.002], [0.1865, -0.4858, -0.3463]),
    limit(0, [0.002, 0.001, -0.001], [0.794, -0.2297, 0.1236]),
    limit(0, [0.0001, -0.0002, 0.001], [0.0509, -0.0657, -0.2854]),
    limit(1, [0.0005, 0.0, 0.0], [0.257, 0.0, 0.0]),
    limit(1, [0.001, 0.0, 0.0], [0.4695, 0.0, 0.0]),
    limit(1, [0.002, 0.0, 0.0], [0.7749, 0.0, 0.0]),
    limit(1, [0.0, 0.0005, 0.0], [0.0, -0.2261, 0.0769]),
    limit(1, [0.0, 0.001, 0.0], [0.0, -0.4173, 0.1181]),
    limit(1, [0.0, 0.002, 0.0], [0.0, -0.7064, 0.1267]),
    limit(1, [0.0, 0.0, 0.0005], [0.0, -0.0966, -0.0704]),
    limit(1, [0.0, 0.0, 0.001], [0.0, -0.191, -0.1292]),
    limit(1, [0.0, 0.0, 0.002], [0.0, -0.3674, -0.2223]),
    limit(1, [0.0, 0.0, 0.004], [0.0, -0.6051, -0.354]),
    limit(1, [0.001, 0.0005, 0.0008], [0.4442, -0.3456, -0.0303]),
    limit(1, [0.001, -0.0005, 0.0008], [0.4463, 0.0563, -0.1311]),
    limit(1, [-0.001, 0.001, 0.0005], [-0.4325, -0.4702, 0.0318]),
    limit(1, [0.0005, 0.0005, 0.002], [0.1922, -0.5503, -0.1657]),
    limit(1, [0.002, 0.001, -0.001], [0.7348, -0.1745, 0.1136]),
    limit(1, [0.0001, -0.0002, 0.001], [0.0469, -0.1011, -0.1591]),
    limit(2, [0.0005, 0.0, 0.0], [0.2192, 0.0, 0.0]),
    limit(2, [0.001, 0.0, 0.0], [0.4058, 0.0, 0.0]),
    limit(2, [0.002, 0.0, 0.0], [0.6912, 0.0, 0.0]),
    limit(2, [0.0, 0.0005, 0.0], [0.0, -0.2098, 0.0957]),
    limit(2, [0.0, 0.001, 0.0], [0.0, -0.3896, 0.1492]),
    limit(2, [0.0, 0.002, 0.0], [0.0, -0.6671, 0.1665]),
    limit(2, [0.0, 0.0, 0.0005], [0.0, -0.1194, -0.0339]),
    limit(2, [0.0, 0.0, 0.001], [0.0, -0.238, -0.0647]),
    limit(2, [0.0, 0.0, 0.002], [0.0, -0.4668, -0.1228]),
    limit(2, [0.0, 0.0, 0.004], [0.0, -0.7674, -0.2759]),
    limit(2, [0.001, 0.0005, 0.0008], [0.3905, -0.3706, 0.018]),
    limit(2, [0.001, -0.0005, 0.0008], [0.3946, 0.0071, -0.1151]),
    limit(2, [-0.001, 0.001, 0.0005], [-0.3771, -0.4713, 0.0789]),
    limit(2, [0.0005, 0.0005, 0.002], [0.183, -0.6396, -0.0609]),
    limit(2, [0.002, 0.001, -0.001], [0.6676, -0.114, 0.1297]),
    limit(2, [0.0001, -0.0002, 0.001], [0.0422, -0.1528, -0.1052]),
];

#[cfg(test)]
mod tests {
    use super::super::contact_points::{LATERAL, LONGITUDINAL};
    use super::*;

    /// Limits against those of CONTACT, where both have a value.
    #[test]
    fn limits_are_those_of_contact() {
        for (axis, curve) in [LONGITUDINAL, LATERAL].into_iter().enumerate() {
            let alone = |creepages: [f64; 3]| (0..3).all(|other| (creepages[other] == 0.0) == (other != axis));
            let mut compared = 0;
            for limit in LIMITS
                .iter()
                .filter(|limit| limit.ellipse == 1 && alone(limit.creepages))
            {
                let point = curve
                    .iter()
                    .find(|point| point.creepage == limit.creepages[axis])
                    .unwrap();
                assert!(
                    (limit.forces[axis].abs() - point.limit()).abs() < 1e-4,
                    "{limit:?} {point:?}"
                );
                compared += 1;
            }
            assert_eq!(compared, 3);
        }
    }

    /// Friction takes power in: F_x ξ − F_y η − M_z φ > 0.
    #[test]
    fn creep_power_is_positive() {
        for Limit { creepages, forces, .. } in LIMITS {
            let power = forces[0] * creepages[0] - forces[1] * creepages[1] - forces[2] * creepages[2];
            assert!(power > 0.0, "{creepages:?}");
        }
    }
}
