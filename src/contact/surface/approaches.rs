//! Search for the approach at which a load is carried: by the secant method, and by the stiffness where it is known.

use super::fields::SurfaceFields;

/// Change of the excess of load over the error of the pressure that shows the stiffness.
pub const SHOWS_STIFFNESS: f64 = 5.0;
/// Least and largest relative change of the load with a relative one of the approach: Hertz's is 3/2, that of a contact which begins far
/// below the height of the first touch, on a worn rail, is many times as much.
const STIFFNESSES: [f64; 2] = [0.3, 100.0];
/// Part of an excess of load that is left where an approach was chosen too small, and the factor on the stiffness then.
const SLOW: f64 = 0.5;
const SOFTER: f64 = 0.4;
/// Longest step of the approach over the usual one.
const LONGEST_REACH: f64 = 16.0;
/// Approach that counts for a step of it, over that of the largest load.
pub const LEAST_SIZE: f64 = 0.05;

/// Secant method for the approach at which a load is carried.
pub struct Approaches {
    /// Load, `N`; none where the approach is given.
    pub load: Option<f64>,
    /// Approach, `m`.
    pub approach: f64,
    /// Approach before and its excess of load, relative.
    last: Option<[f64; 2]>,
    /// Change of the load with the approach, relative, `1/m`.
    stiffness: f64,
    /// Approaches known to be too small and too large, `m`.
    bracket: [f64; 2],
    /// Longest step over the usual one.
    reach: f64,
    /// Approach that counts for the size of a step at least, `m`: a rail that bulges carries at an approach of nothing, and below.
    size: f64,
}

impl Approaches {
    /// The given approach alone, `m`.
    pub fn given(approach: f64) -> Approaches {
        Approaches {
            load: None,
            approach,
            last: None,
            stiffness: 0.0,
            bracket: [f64::NEG_INFINITY, f64::INFINITY],
            reach: 1.0,
            size: 0.0,
        }
    }

    /// Search for the approach of a load, `N`, from a guess, `m`, with the stiffness found before, `N/m`, or none. `scale` is the approach under the largest
    /// load, `m`.
    pub fn of_load(load: f64, approach: f64, stiffness: f64, scale: f64) -> Approaches {
        let size = LEAST_SIZE * scale;
        Approaches {
            load: Some(load),
            size,
            // Hertz's load is as the approach to the power of 3/2.
            stiffness: if stiffness > 0.0 {
                clamped(stiffness / load, approach.abs().max(size))
            } else {
                1.5 / approach
            },
            ..Approaches::given(approach)
        }
    }

    /// Takes the excess of load at the approach, relative, with an error of it, and moves on. `stiffness` is the change of the load with the approach where
    /// it is known, `N/m`.
    pub fn next(&mut self, excess: f64, error: f64, stiffness: Option<f64>) {
        let Some(load) = self.load else {
            return;
        };
        // The force grows with the approach, but for the error of the pressure.
        if excess.abs() > SHOWS_STIFFNESS * error {
            self.bracket[usize::from(excess > 0.0)] = self.approach;
        }
        if let Some([before, excess_before]) = self.last {
            if (excess - excess_before).abs() > SHOWS_STIFFNESS * error {
                let slope = (excess - excess_before) / (self.approach - before);
                self.stiffness = clamped(slope, self.approach.abs().max(self.size));
            } else if excess * excess_before > SLOW * excess_before * excess_before {
                // The way was too small to show the stiffness, which is therefore less than it was taken for.
                self.stiffness *= SOFTER;
            }
        }
        // The last approach has left too much of the excess: the given stiffness belongs to cells that no longer carry the load alone.
        let slow = self.last.is_some_and(|[_, before]| excess.abs() > SLOW * before.abs());
        if let Some(stiffness) = stiffness.filter(|_| !slow) {
            self.stiffness = clamped(stiffness / load, self.approach.abs().max(self.size));
        }
        self.last = Some([self.approach, excess]);
        // Half way to no contact at most, and to twice the approach: where another contact begins to carry, the stiffness jumps. Where nothing carries
        // there is none.
        let next = if excess > -1.0 {
            self.approach - excess / self.stiffness
        } else {
            f64::INFINITY
        };
        let size = self.reach * self.approach.abs().max(self.size);
        let within = next.clamp(self.approach - 0.5 * size, self.approach + size);
        // What is farther away is reached in steps that grow.
        self.reach = if within == next {
            1.0
        } else {
            (2.0 * self.reach).min(LONGEST_REACH)
        };
        self.approach = within;
        let [low, high] = self.bracket;
        // Far below the usual approaches the contact may be stiffer than the limit. The next approach would then jump from one end of the bracket to the other and
        // hardly come closer: the middle of the bracket does.
        let circles = slow && excess.abs() > SHOWS_STIFFNESS * error;
        if low.is_finite() && high.is_finite() && (circles || !(low < self.approach && self.approach < high)) {
            self.approach = 0.5 * (low + high);
        }
    }

    /// Moves on by an excess of load, relative, that is foreseen before the first pressure is solved. `stiffness` is in `N/m`.
    pub fn foresee(&mut self, excess: f64, stiffness: f64) {
        if let Some(load) = self.load {
            self.stiffness = clamped(stiffness / load, self.approach.abs().max(self.size));
            self.approach -= excess / self.stiffness;
        }
    }

    /// Leaves the approach and the stiffness in the fields.
    pub fn end(&self, fields: &mut SurfaceFields) {
        fields.approach[0] = self.approach;
        if let (Some(load), Some(_)) = (self.load, self.last) {
            fields.stiffness = self.stiffness * load;
        }
    }
}

/// Stiffness within what is possible at an approach, relative, `1/m`.
fn clamped(stiffness: f64, approach: f64) -> f64 {
    let [least, most] = STIFFNESSES.map(|stiffness| stiffness / approach);
    stiffness.clamp(least, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hertz's load at an approach far below those that the stiffness is limited for: the search halves the bracket in place of going to and fro.
    #[test]
    fn a_load_far_below_the_largest_is_found() {
        let (load, scale) = (1.0, 1.0);
        let sought = 8e-3 * LEAST_SIZE * scale;
        let mut search = Approaches::of_load(load, 2.0 * sought, 0.0, scale);
        for _ in 0..30 {
            let excess = (search.approach.max(0.0) / sought).powf(1.5) - 1.0;
            let stiffness = 1.5 * load * (search.approach.max(0.0) / sought).sqrt() / sought;
            search.next(excess, 1e-9, Some(stiffness));
        }
        assert!((search.approach / sought - 1.0).abs() < 1e-4, "{}", search.approach);
    }
}
