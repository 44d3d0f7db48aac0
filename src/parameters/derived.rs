//! Quantities that follow from the parameters by a formula.

use super::choices::{ContactModel, PatchGeometry, Side, Wheel};
use super::table::Parameters;
use crate::geometry::hertz::{self, HertzEllipse};

/// Curvature of the crown of common rails, of 300 mm radius, `1/m`.
const CROWN_CURVATURE: f64 = 1.0 / 0.3;
/// Radius of a wheel of 920 mm, `m`, in the row of those by which windows of profiles are measured, and the ratio of each to the one before.
const RADII: (f64, f64) = (0.46, 1.05);

/// Radius of the row that is nearest to a radius, `m`.
fn radius_of_row(radius: f64) -> f64 {
    let (first, ratio) = RADII;
    let number = ((radius / first).ln() / ratio.ln()).round();
    first * ratio.powi(number as i32)
}

/// Poisson's ratio ν = λ/(2(λ + γ)).
fn poisson_ratio(lambda: f64, shear: f64) -> f64 {
    lambda / (2.0 * (lambda + shear))
}

/// E/(1 − ν²) = 4γ(λ + γ)/(λ + 2γ), `Pa`.
fn plane_strain_modulus(lambda: f64, shear: f64) -> f64 {
    4.0 * shear * (lambda + shear) / (lambda + 2.0 * shear)
}

impl Parameters {
    /// Contact modulus E* of the pair, `Pa`: 1/E* = (1 − ν²)/E of the rail, and the same of an elastic wheel added
    /// (Johnson, Contact Mechanics, 4.20).
    pub fn contact_modulus(&self) -> f64 {
        let wheel = match self.wheel {
            Wheel::Rigid => 0.0,
            Wheel::Elastic => 1.0 / plane_strain_modulus(self.wheel_lame_lambda, self.wheel_shear_modulus),
        };
        1.0 / (1.0 / plane_strain_modulus(self.lame_lambda, self.shear_modulus) + wheel)
    }

    /// Hertz half-length a = √(4 N r₀ / (π b E*)) of a line contact, `m` (Johnson, Contact Mechanics, 4.43).
    pub fn hertz_half_length(&self, load: f64) -> f64 {
        hertz::line_half_length(load, self.contact_width, self.wheel_radius, self.contact_modulus())
    }

    /// Hertz peak pressure p₀ = 2 N / (π a b), `Pa` (Johnson, Contact Mechanics, 4.45).
    pub fn hertz_peak_pressure(&self, load: f64) -> f64 {
        2.0 * load / (std::f64::consts::PI * self.hertz_half_length(load) * self.contact_width)
    }

    /// Volumetric heat capacity ρ c_p, `J/(m³ K)`.
    pub fn volumetric_heat_capacity(&self) -> f64 {
        self.density * self.heat_capacity
    }

    /// Rayleigh wave speed c_R ≈ c_s (0.862 + 1.14 ν)/(1 + ν), `m/s` (Viktorov's approximation); the smaller one of rail and
    /// elastic wheel.
    pub fn rayleigh_speed(&self) -> f64 {
        let speed = |lambda: f64, shear: f64, density: f64| {
            let nu = poisson_ratio(lambda, shear);
            (shear / density).sqrt() * (0.862 + 1.14 * nu) / (1.0 + nu)
        };
        let rail = speed(self.lame_lambda, self.shear_modulus, self.density);
        match self.wheel {
            Wheel::Rigid => rail,
            Wheel::Elastic => {
                let wheel = speed(self.wheel_lame_lambda, self.wheel_shear_modulus, self.wheel_density);
                rail.min(wheel)
            }
        }
    }

    /// Largest rolling speed |V|, 5 % of the Rayleigh speed, `m/s`: the compliance is used to first order in V²,
    /// with an error of (V/c_R)⁴ ≤ 6e-6.
    pub fn largest_speed(&self) -> f64 {
        0.05 * self.rayleigh_speed()
    }

    /// Half-width of the contact window, `m`: the Hertz half-length at the largest load and a margin of a fifth for
    /// thermal bulge, friction coupling and wear.
    pub fn window_half_width(&self) -> f64 {
        1.2 * self.hertz_half_length(self.largest_load)
    }

    /// Curvatures A and B of the gap A x² + B y² along and across the rail, `1/m`: 1/(2 r₀), half the sum across. Profiles have
    /// other ones at every place; these measure their contacts, as a cone's on a rail's crown, with a radius out of a row: a wheel that has become smaller
    /// by wear has windows of the same cells.
    pub fn gap_curvatures(&self) -> (f64, f64) {
        let (radius, across) = match self.contact_model {
            ContactModel::Line | ContactModel::Patch => (
                self.wheel_radius,
                self.rail_transverse_curvature + self.wheel_transverse_curvature,
            ),
            ContactModel::Profiles => (radius_of_row(self.wheel_radius), CROWN_CURVATURE),
        };
        (0.5 / radius, 0.5 * across)
    }

    /// Side of the wheelset that the wheel is on: 1 on the left, −1 on the right.
    pub fn side_sign(&self) -> f64 {
        if self.side == Side::Right { -1.0 } else { 1.0 }
    }

    /// Remark on a contact that fills its window, with the parameters that the window is sized by.
    pub fn full_window_remark(&self) -> String {
        let sizes = match self.patch_geometry {
            PatchGeometry::Parameters => "largest_load",
            PatchGeometry::Inputs => {
                "largest_load, wheel_radius, rail_transverse_curvature and wheel_transverse_curvature"
            }
        };
        format!(
            "the contact fills its window and is held within it, as if the surfaces ended there; the window is sized by {sizes}"
        )
    }

    /// Remark on a contact that carries more than `largest_load`.
    pub fn overload_remark(&self) -> String {
        format!(
            "the contact carries more than largest_load = {} N, for which its cells and windows are made: it may be less exact",
            self.largest_load
        )
    }

    /// Distance of the running circle from the middle of the wheelset, `m`.
    pub fn running_circle(&self) -> f64 {
        0.5 * self.flange_back_distance + self.flange_back_position
    }

    /// Contact ellipse under a `load` `N`, of the transverse curvatures.
    pub fn hertz_ellipse(&self, load: f64) -> HertzEllipse {
        HertzEllipse::new(load, self.gap_curvatures(), self.contact_modulus())
    }

    /// Half-length along the rail and half-breadth across it of the contact of Hertz under a `load` `N`, `m`; a line contact has
    /// half of its width.
    pub fn contact_half_axes(&self, load: f64) -> (f64, f64) {
        match self.contact_model {
            ContactModel::Line => (self.hertz_half_length(load), 0.5 * self.contact_width),
            ContactModel::Patch | ContactModel::Profiles => {
                let ellipse = self.hertz_ellipse(load);
                (ellipse.along, ellipse.across)
            }
        }
    }

    /// Half-length along the rail and half-breadth across it of the window of a patch, or of a contact of profiles, `m`: the ellipse of the largest load
    /// and a margin of a fifth for thermal bulge, friction coupling and wear.
    pub fn patch_window(&self) -> (f64, f64) {
        let ellipse = self.hertz_ellipse(self.largest_load);
        (1.2 * ellipse.along, 1.2 * ellipse.across)
    }
}
