//! Depth of the rail that is hotter than a given temperature.
//!
//! The march has the temperature at the rows of the mesh in depth. Between two rows it is taken as the parabola through them and the one below: between the
//! row that is still hotter and the first that is not, that has exactly one place at the given temperature.

use super::basis::DepthBasis;

/// Deepest place at which columns of the rail, given by their modal amplitudes, are hotter than `rise` `K` over the ambient, with rows at the given depths; 0 where no
/// surface is, `m`. A column that is not hotter at the deepest row that is in one before it costs the value of this row alone.
pub fn depth<A>(basis: &DepthBasis, depth: &[f64], rise: f64, columns: impl Iterator<Item = A>) -> f64
where
    A: Iterator<Item = f64> + Clone,
{
    let (mut row, mut deepest) = (0, 0.0_f64);
    for amplitudes in columns {
        let excess = |row: usize| basis.value(amplitudes.clone(), row) - rise;
        let mut upper = excess(row);
        while upper > 0.0 {
            let Some(&below) = depth.get(row + 1) else {
                // Hotter all through.
                return depth[row];
            };
            let lower = excess(row + 1);
            if lower > 0.0 {
                (row, upper) = (row + 1, lower);
                continue;
            }
            let above = depth[row];
            let lowest = depth.get(row + 2).map(|&z| (z - above, excess(row + 2)));
            deepest = deepest.max(above + crossing(upper, (below - above, lower), lowest));
            break;
        }
    }
    deepest
}

/// Place at which the parabola from `upper` > 0 through (`h`, `lower` ≤ 0) and the `lowest` point is 0, between 0 and `h`; the straight line where there is none.
fn crossing(upper: f64, (h, lower): (f64, f64), lowest: Option<(f64, f64)>) -> f64 {
    let slope = (lower - upper) / h;
    let bend = lowest.map_or(0.0, |(z, value)| ((value - lower) / (z - h) - slope) / z);
    // upper + steep z + bend z² = 0; the other root is outside.
    let steep = slope - bend * h;
    2.0 * upper / ((steep * steep - 4.0 * bend * upper).sqrt() - steep)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::mesh::Mesh;
    use crate::parameters::Parameters;

    /// Amplitudes of a column whose rows have given temperatures, which are 0 at the bottom.
    fn column(basis: &DepthBasis, depth: &[f64], temperature: impl Fn(f64) -> f64) -> Vec<f64> {
        let m = basis.len();
        let modes = basis.modes.rows(0, m).into_owned();
        let values = nalgebra::DVector::from_iterator(m, depth[..m].iter().map(|&z| temperature(z)));
        modes.lu().solve(&values).unwrap().iter().copied().collect()
    }

    fn rail() -> (Vec<f64>, DepthBasis) {
        let depth = Mesh::new(&Parameters::default()).depth;
        let basis = DepthBasis::new(&depth).unwrap();
        (depth, basis)
    }

    /// Straight lines between the rows would be 1.5 % off in a profile that decays, as under a heated surface. One that is flat at the surface bends twice within a
    /// few cells.
    #[test]
    fn the_depth_of_known_profiles_is_found() {
        let (depths, basis) = rail();
        for at in [2e-5, 3e-5, 1.2e-4, 2.5e-4, 4e-4] {
            let rate = (1.5_f64).ln();
            let decaying = |z: f64| 1500.0 * (-rate * z / at).exp();
            let flat = |z: f64| 1500.0 * (-rate * (z / at).powi(2)).exp();
            for (profile, tolerance) in [(&decaying as &dyn Fn(f64) -> f64, 0.0025), (&flat, 0.025)] {
                let column = column(&basis, &depths, profile);
                let error = depth(&basis, &depths, 1000.0, std::iter::once(column.into_iter())) / at - 1.0;
                assert!(error.abs() < tolerance, "{at}: {error}");
            }
        }
    }

    #[test]
    fn the_deepest_of_several_columns_counts_whatever_their_order() {
        let (depths, basis) = rail();
        let columns = [3e-5, 2e-4, 1e-9, 1.9e-4, 5e-5]
            .map(|reach: f64| column(&basis, &depths, |z| (1000.0 - 900.0 * z / reach).max(0.0)));
        let deepest = |order: &[usize]| {
            let columns = order.iter().map(|&number| columns[number].iter().copied());
            depth(&basis, &depths, 100.0, columns)
        };
        assert_eq!(deepest(&[0, 1, 2, 3, 4]), deepest(&[4, 3, 2, 1, 0]));
        assert_eq!(deepest(&[0, 1, 2, 3, 4]), deepest(&[1]));
        assert!(deepest(&[0, 2, 3, 4]) < deepest(&[1]));
        let cold = std::iter::repeat_n(0.0, basis.len());
        assert_eq!(depth(&basis, &depths, 100.0, std::iter::once(cold)), 0.0);
    }

    /// The last row is at the ambient, so that all of the rail is hotter than less than that.
    #[test]
    fn a_rail_that_is_hotter_all_through_ends_at_the_bottom() {
        let (depths, basis) = rail();
        let cold = std::iter::repeat_n(0.0, basis.len());
        assert_eq!(
            depth(&basis, &depths, -1.0, std::iter::once(cold)),
            depths[depths.len() - 1]
        );
    }
}
