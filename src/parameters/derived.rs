//! Quantities that follow from the parameters by a formula.

use super::choices::Wheel;
use super::table::Parameters;

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
        (4.0 * load * self.wheel_radius / (std::f64::consts::PI * self.contact_width * self.contact_modulus())).sqrt()
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
}
