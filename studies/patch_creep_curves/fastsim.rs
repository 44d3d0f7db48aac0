//! FASTSIM, for comparison: J.J. Kalker, A fast algorithm for the simplified theory of rolling contact, Vehicle System Dynamics
//! 11 (1982) 1–13, in wheelrail's axes and signs.
//!
//! The displacement difference u = L τ is local, with flexibilities L₁ for ξ, L₂ for η and L₃ for φ that give Kalker's linear
//! forces. Where nothing slips, V ∂u/∂x is the rigid slip, so that along a strip
//! ∂τ_x/∂x = ξ/L₁ + φ y/L₃ and ∂τ_y/∂x = −η/L₂ − φ x/L₃, from τ = 0 at the leading edge backward;
//! where that exceeds the bound μ p, the traction keeps its direction and has the bound's size.

use std::f64::consts::PI;

/// The ellipse under a wheel, and what is in it; SI units.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Semi-axis a along the rail.
    pub along: f64,
    /// Semi-axis b across it.
    pub across: f64,
    /// Load N.
    pub load: f64,
    /// Friction coefficient μ.
    pub friction: f64,
    /// Shear modulus G of both bodies.
    pub shear_modulus: f64,
    /// Kalker's C₁₁, C₂₂ and C₂₃.
    pub coefficients: [f64; 3],
}

/// Creepages: ξ and η without a unit, φ in 1/m.
#[derive(Debug, Clone, Copy, Default)]
pub struct Creepages {
    /// ξ, positive where the wheel drives.
    pub longitudinal: f64,
    /// η, positive where the wheel moves to the left.
    pub lateral: f64,
    /// φ, positive anticlockwise from above.
    pub spin: f64,
}

/// Forces on the wheel.
#[derive(Debug, Clone, Copy, Default)]
pub struct Forces {
    /// F_x in N.
    pub longitudinal: f64,
    /// F_y in N.
    pub lateral: f64,
    /// M_z in N·m.
    pub spin_moment: f64,
    /// Friction power over V, in N. Without spin it is F_x ξ − F_y η; with it, three flexibilities do not fit together.
    pub dissipation: f64,
}

/// The traction bound over the ellipse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// p = 2N/(πab) (1 − x²/a² − y²/b²), which goes with u = L τ: the usual one.
    Parabolic,
    /// Hertz's p = 3N/(2πab) √(1 − x²/a² − y²/b²).
    Elliptic,
}

/// What a strip is divided into.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    /// Elements along each strip, which begin and end at its edges.
    pub along: usize,
    /// Strips of equal breadth across the ellipse.
    pub across: usize,
}

impl Contact {
    /// L₁, L₂ and L₃ in m/Pa.
    pub fn flexibilities(&self) -> [f64; 3] {
        let [longitudinal, lateral, spin] = self.coefficients.map(|coefficient| coefficient * self.shear_modulus);
        [
            8.0 * self.along / (3.0 * longitudinal),
            8.0 * self.along / (3.0 * lateral),
            PI * self.along * (self.along / self.across).sqrt() / (4.0 * spin),
        ]
    }

    /// μN in N.
    pub fn friction_bound(&self) -> f64 {
        self.friction * self.load
    }

    /// c = √(ab) in m.
    pub fn mean_semi_axis(&self) -> f64 {
        (self.along * self.across).sqrt()
    }

    /// μ p in Pa.
    fn traction_bound(&self, bound: Bound, x: f64, y: f64) -> f64 {
        let inside = (1.0 - (x / self.along).powi(2) - (y / self.across).powi(2)).max(0.0);
        let mean = self.friction_bound() / (PI * self.along * self.across);
        match bound {
            Bound::Parabolic => 2.0 * mean * inside,
            Bound::Elliptic => 1.5 * mean * inside.sqrt(),
        }
    }
}

/// The forces in steady rolling.
pub fn forces(contact: &Contact, creepages: &Creepages, bound: Bound, grid: Grid) -> Forces {
    let breadth = 2.0 * contact.across / grid.across as f64;
    let mut sum = Forces::default();
    for strip in 0..grid.across {
        let y = (strip as f64 + 0.5) * breadth - contact.across;
        add_strip(&mut sum, contact, creepages, bound, grid.along, y, breadth);
    }
    sum
}

/// Adds what a strip at `y` carries. Tractions are those at the elements' middles: from the leading edge to the first of them it
/// is half an element. Both strains are linear in x, so that their value between two middles gives adhesion exactly.
fn add_strip(
    sum: &mut Forces,
    contact: &Contact,
    creepages: &Creepages,
    bound: Bound,
    elements: usize,
    y: f64,
    breadth: f64,
) {
    let [longitudinal, lateral, spin] = contact.flexibilities();
    let edge = contact.along * (1.0 - (y / contact.across).powi(2)).sqrt();
    let length = 2.0 * edge / elements as f64;
    let area = length * breadth;
    let gradient_x = creepages.longitudinal / longitudinal + creepages.spin * y / spin;
    let mut before = edge;
    let (mut along, mut across) = (0.0_f64, 0.0_f64);
    for element in 0..elements {
        let x = edge - (element as f64 + 0.5) * length;
        let step = before - x;
        let gradient_y = -creepages.lateral / lateral - creepages.spin * 0.5 * (x + before) / spin;
        let adhering = [along - step * gradient_x, across - step * gradient_y];
        let size = adhering[0].hypot(adhering[1]);
        let limit = contact.traction_bound(bound, x, y);
        let share = if size > limit { limit / size } else { 1.0 };
        // What the traction lacks of adhesion is slip, against the mean traction on the way.
        let [lacking_x, lacking_y] = adhering.map(|traction| (share - 1.0) * traction);
        let mean = [
            0.5 * (along + share * adhering[0]),
            0.5 * (across + share * adhering[1]),
        ];
        sum.dissipation -= breadth * (longitudinal * lacking_x * mean[0] + lateral * lacking_y * mean[1]);
        (along, across) = (share * adhering[0], share * adhering[1]);
        sum.longitudinal -= area * along;
        sum.lateral -= area * across;
        sum.spin_moment -= area * (x * across - y * along);
        before = x;
    }
    // From the last middle to the trailing edge the traction falls to nothing.
    let step = before + edge;
    let gradient_y = -creepages.lateral / lateral - creepages.spin * 0.5 * (before - edge) / spin;
    let lacking = [step * gradient_x - along, step * gradient_y - across];
    sum.dissipation -= 0.5 * breadth * (longitudinal * lacking[0] * along + lateral * lacking[1] * across);
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid {
        along: 160,
        across: 160,
    };

    fn contact(axis_ratio: f64) -> Contact {
        let of = wheelrail::verification::kalker::CreepCoefficients::of(axis_ratio, 0.25).unwrap();
        Contact {
            along: 6e-3 * axis_ratio.sqrt(),
            across: 6e-3 / axis_ratio.sqrt(),
            load: 80e3,
            friction: 0.3,
            shear_modulus: 8.2e10,
            coefficients: [of.longitudinal, of.lateral, of.lateral_spin],
        }
    }

    fn creepages(longitudinal: f64, lateral: f64, spin: f64) -> Creepages {
        Creepages {
            longitudinal,
            lateral,
            spin,
        }
    }

    /// Total force over μN without spin under the parabolic bound, in closed form, in the direction of the rigid slip over L.
    ///
    /// On a strip of half-length e the traction rises from the leading edge with the gradient σ = |(ξ/L₁, η/L₂)| up to the bound
    /// μp₀ (e² − x²)/a², which it meets D = σ a²/(μp₀) ahead of the trailing edge and then follows; strips with 2e < D slip as a
    /// whole. The sum over the strips, with k = D/(2a) and e = a cos ψ, is elementary.
    fn share_without_spin(contact: &Contact, creepages: &Creepages) -> f64 {
        let [longitudinal, lateral, _] = contact.flexibilities();
        let gradient = (creepages.longitudinal / longitudinal).hypot(creepages.lateral / lateral);
        let steepest = 2.0 * contact.traction_bound(Bound::Parabolic, 0.0, 0.0) / contact.along;
        let k = gradient / steepest;
        if k >= 1.0 {
            return 1.0;
        }
        // Strips within |ψ| < arccos k adhere at their leading edge.
        let end = k.acos();
        let sine = end.sin();
        let cosine_cubed = 2.0 * (sine - sine.powi(3) / 3.0);
        let cosine_squared = end + sine * k;
        let partly = 4.0 * k * cosine_cubed - 4.0 * k * k * cosine_squared + 8.0 / 3.0 * k.powi(3) * sine;
        let fourth = |angle: f64| 0.375 * angle + 0.25 * (2.0 * angle).sin() + (4.0 * angle).sin() / 32.0;
        let fully = 8.0 / 3.0 * (fourth(0.5 * PI) - fourth(end));
        (partly + fully) / (0.5 * PI)
    }

    fn assert_near(computed: f64, expected: f64, tolerance: f64) {
        assert!((computed - expected).abs() <= tolerance, "{computed} is not {expected}");
    }

    /// Small creepages give Kalker's forces, for that is what L₁, L₂ and L₃ are made for. The moments are the simplified theory's
    /// own, by integration of its adhesion: C₃₂ = (3π/32) √(a/b) C₂₂ and C₃₃ = 32/(15π) (b/a)^{3/2} C₂₃, 0.998 on the circle
    /// where Kalker's is 1.19. The smallest creepages slip at the trailing edge only, whose share goes with them.
    #[test]
    fn linear_limit() {
        for axis_ratio in [0.5, 1.0, 2.0] {
            let contact = contact(axis_ratio);
            let [c11, c22, c23] = contact.coefficients;
            let mean = contact.mean_semi_axis();
            let unit = contact.shear_modulus * mean * mean * 1e-9;
            let at = |creepages| forces(&contact, &creepages, Bound::Parabolic, GRID);
            let along = at(creepages(1e-9, 0.0, 0.0));
            assert_near(along.longitudinal / unit, c11, 1e-4 * c11);
            let across = at(creepages(0.0, 1e-9, 0.0));
            assert_near(across.lateral / unit, -c22, 1e-4 * c22);
            let c32 = 3.0 * PI / 32.0 * axis_ratio.sqrt() * c22;
            assert_near(across.spin_moment / (unit * mean), c32, 1e-3 * c32);
            let spin = at(creepages(0.0, 0.0, 1e-9 / mean));
            assert_near(spin.lateral / unit, -c23, 1e-3 * c23);
            let c33 = 32.0 / (15.0 * PI) * axis_ratio.powf(-1.5) * c23;
            assert_near(spin.spin_moment / (unit * mean), -c33, 1e-3 * c33);
        }
    }

    /// Without spin: the closed form, in the direction of (ξ/L₁, −η/L₂), and the balance of powers.
    #[test]
    fn closed_form_without_spin() {
        let contact = contact(2.0);
        for size in [2e-4, 1e-3, 3e-3, 1e-2] {
            let creepages = creepages(0.8 * size, 0.6 * size, 0.0);
            let computed = forces(&contact, &creepages, Bound::Parabolic, GRID);
            let share = share_without_spin(&contact, &creepages);
            let total = computed.longitudinal.hypot(computed.lateral) / contact.friction_bound();
            assert_near(total, share, 1e-4);
            let [l1, l2, _] = contact.flexibilities();
            let direction = -computed.longitudinal / computed.lateral;
            assert_near(direction, 0.8 / l1 / (0.6 / l2), 1e-9);
            let power = computed.longitudinal * creepages.longitudinal - computed.lateral * creepages.lateral;
            assert_near(computed.dissipation / power, 1.0, 1e-3);
        }
        assert_eq!(share_without_spin(&contact, &creepages(0.1, 0.0, 0.0)), 1.0);
    }

    /// Full slip carries μN under either bound, and spin alone without end turns the tractions about the middle.
    #[test]
    fn saturation() {
        let contact = contact(1.0);
        for bound in [Bound::Parabolic, Bound::Elliptic] {
            let slipping = forces(&contact, &creepages(0.5, 0.0, 0.0), bound, GRID);
            assert_near(slipping.longitudinal / contact.friction_bound(), 1.0, 1e-3);
            let turning = forces(&contact, &creepages(0.0, 0.0, 1e4), bound, GRID);
            // The mean distance from the middle over the bound.
            let arm = match bound {
                Bound::Parabolic => 8.0 / 15.0,
                Bound::Elliptic => 3.0 * PI / 16.0,
            };
            assert_near(
                turning.spin_moment / contact.friction_bound() / contact.along,
                -arm,
                2e-3,
            );
            assert_near(turning.lateral / contact.friction_bound(), 0.0, 2e-2);
        }
    }

    /// Mirrored in y, ξ of the other sign, and both: forces turn with them.
    #[test]
    fn mirrored() {
        let contact = contact(0.5);
        let at = |xi, eta, phi| forces(&contact, &creepages(xi, eta, phi), Bound::Parabolic, GRID);
        let one = at(1e-3, 5e-4, 0.2);
        let other = at(1e-3, -5e-4, -0.2);
        let unit = 1e-9 * contact.friction_bound();
        assert_near(other.longitudinal, one.longitudinal, unit);
        assert_near(other.lateral, -one.lateral, unit);
        assert_near(other.spin_moment, -one.spin_moment, unit);
        assert_near(other.dissipation, one.dissipation, unit);
    }

    /// With first order: in slip the traction's direction is that of the step's end. A quarter and, for the finest grid is not the
    /// limit, a little more.
    #[test]
    fn converges() {
        let contact = contact(1.0);
        let creepages = creepages(1e-3, 5e-4, 0.15);
        let at = |n| forces(&contact, &creepages, Bound::Parabolic, Grid { along: n, across: n }).longitudinal;
        let finest = at(1280);
        let errors = [20, 80, 320].map(|n| (at(n) - finest).abs() / contact.friction_bound());
        assert!(errors[0] < 2e-3, "{errors:?}");
        assert!(errors.windows(2).all(|pair| pair[1] < 0.35 * pair[0]), "{errors:?}");
    }
}
