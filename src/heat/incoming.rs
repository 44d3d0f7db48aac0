//! The rail between one wheel and the next: a temperature and a wear depth that carry the heat and the wear.
//!
//! A unit's rail ends at the edges of its strip, |x₁| = L. What leaves at the trailing edge is handed to the next wheel,
//! where it enters at the leading edge. With the wheels a distance D ≥ 2L apart the delay from leaving to entering is
//! (D − 2L)/V; for a shorter distance the strip has to be shortened (`strip_half_length` ≤ D/2).
//!
//! Temperature. One number stands for the profile over the depth: the heat per area of the leaving column spread over the
//! skin depth d,
//!
//! leaving_temperature = T_a + (1/d) ∫ θ dz,
//!
//! and what enters under the incoming temperature is the profile with that heat,
//!
//! θ(z) = (incoming_temperature − T_a) g(z),  g = exp(−π z²/(4 d²)),  ∫ g dz = d.
//!
//! The heat is the same on both sides, whatever d: units that are chained conserve it to round-off of the marches (at one
//! ambient temperature; steps aligned with the delay). g is the profile of heat that was put in at the surface
//! at one instant a time t before, θ ∝ exp(−z²/(4κt)), if d = √(π κ t): then the number is the surface temperature itself.
//! The wake of a contact is such a profile once t is long against the passage (1 ms). So choose d = √(π κ (D − L)/V), the
//! age of the wake where it enters the next unit: 5 mm, the default, is 0.55 s. A d that is too large makes the
//! rail under the next wheel too cold at the surface and too warm below, and the other way round.
//!
//! The incoming temperature is absolute: where the ambient temperature is changed and the rail comes in at ambient, both
//! inputs are to be set. It is that of a skin, not of a rail that is warm all through.
//!
//! Wear. The depth at the trailing edge enters as it left; the march conserves the volume, to round-off
//! while speed and step stay, and else to second order in the length of the columns.

use crate::heat::basis::DepthBasis;
use crate::numerics::gauss::GAUSS;
use std::f64::consts::FRAC_PI_4;

/// The entering temperature profile in the eigenbasis of the depth operator.
#[derive(Debug, Clone)]
pub struct Incoming {
    /// Modal amplitudes of g, m.
    amplitudes: Vec<f64>,
    /// Value of g at the surface, 1 but for the mesh.
    surface: f64,
    /// Skin depth d, `m`.
    skin_depth: f64,
}

impl Incoming {
    /// The profile of skin depth d `m` on the given depths `m`: of the temperatures on them the one that is closest to g in the mean of the squares,
    /// with ∫ g = d made exact. One that had the values of g at the depths would have too much heat where they are far apart, in the depth, and lose at the
    /// surface what it has too much.
    pub fn new(depth: &[f64], basis: &DepthBasis, skin_depth: f64) -> Incoming {
        let profile = |z: f64| (-FRAC_PI_4 * (z / skin_depth).powi(2)).exp();
        // φᵀ M g with the integral of the product in place of M g: the modes are orthonormal in the mass matrix.
        let mut amplitudes = vec![0.0; basis.len()];
        for (row, ends) in depth.windows(2).enumerate() {
            let length = ends[1] - ends[0];
            for [place, weight] in GAUSS {
                let part = weight * length * profile(ends[0] + place * length);
                for (mode, amplitude) in amplitudes.iter_mut().enumerate() {
                    let [upper, lower] = [row, row + 1].map(|row| basis.modes[(row, mode)]);
                    *amplitude += part * ((1.0 - place) * upper + place * lower);
                }
            }
        }
        let exact = skin_depth / basis.content(amplitudes.iter().copied());
        for amplitude in &mut amplitudes {
            *amplitude *= exact;
        }
        Incoming {
            surface: basis.surface_value(amplitudes.iter().copied()),
            amplitudes,
            skin_depth,
        }
    }

    /// Writes the column that enters at `rise` `K` over the ambient: its m modal amplitudes and its surface temperature.
    pub fn enter(&self, rise: f64, amplitudes: &mut [f64], surface: &mut f64) {
        for (amplitude, unit) in amplitudes.iter_mut().zip(&self.amplitudes) {
            *amplitude = rise * unit;
        }
        *surface = rise * self.surface;
    }

    /// Temperature rise over the skin depth that holds the heat of a column given by its modal amplitudes, `K`.
    pub fn equivalent_rise(&self, basis: &DepthBasis, amplitudes: &[f64]) -> f64 {
        basis.content(amplitudes.iter().copied()) / self.skin_depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::mesh::Mesh;
    use crate::parameters::Parameters;

    fn column(skin_depth: f64) -> (Mesh, DepthBasis, Incoming) {
        let mesh = Mesh::new(&Parameters::default());
        let basis = DepthBasis::new(&mesh.depth).unwrap();
        let incoming = Incoming::new(&mesh.depth, &basis, skin_depth);
        (mesh, basis, incoming)
    }

    #[test]
    fn what_enters_holds_the_heat_of_the_skin_and_has_its_profile() {
        for skin_depth in [1e-3, 5e-3, 2e-2] {
            let (mesh, basis, incoming) = column(skin_depth);
            let (mut amplitudes, mut surface) = (vec![0.0; basis.len()], 0.0);
            incoming.enter(20.0, &mut amplitudes, &mut surface);
            assert!((basis.content(amplitudes.iter().copied()) / (20.0 * skin_depth) - 1.0).abs() < 1e-13);
            assert!((incoming.equivalent_rise(&basis, &amplitudes) / 20.0 - 1.0).abs() < 1e-13);
            // The rows at the surface are micrometres apart, those below grow by a third from one to the next.
            assert!((surface / 20.0 - 1.0).abs() < 2e-5, "{surface}");
            let rows = mesh.depth.iter().enumerate();
            let errors = rows.map(|(row, z)| {
                let exact = 20.0 * (-FRAC_PI_4 * (z / skin_depth).powi(2)).exp();
                (basis.value(amplitudes.iter().copied(), row) - exact).abs()
            });
            assert!(errors.fold(0.0, f64::max) < 0.01 * 20.0);
        }
    }
}
