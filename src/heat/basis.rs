//! The depth operator's eigenbasis, in which a column of the heat march is a set of independent scalars.

use crate::error::{Error, Result};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

/// Eigenbasis of the depth operator, m = rows − 1 modes.
#[derive(Debug, Clone)]
pub struct DepthBasis {
    /// Eigenvalues λ, ascending, `1/m²`.
    pub eigenvalues: Vec<f64>,
    /// Value of each mode at the surface, φ(0), `m^-½`.
    pub surface: Vec<f64>,
    /// Integral of each mode over the depth, ∫φ, `m^½`.
    pub integral: Vec<f64>,
    /// Modes at the rows, `(row, mode)`, rows × m, the last row (bottom) zero.
    pub modes: DMatrix<f64>,
    /// Values of the modes' stiffness rows at the bottom: heat flux through it per mode, `m^-3/2`.
    #[cfg(feature = "verification")]
    pub bottom_flux: Vec<f64>,
}

impl DepthBasis {
    /// Basis on the given depths `m`, ascending from 0.
    ///
    /// # Errors
    /// [`Error::DepthBasis`].
    pub fn new(depth: &[f64]) -> Result<DepthBasis> {
        let m = depth.len() - 1;
        let failed = Error::DepthBasis { unknowns: m };
        let mut mass = DMatrix::zeros(m + 1, m + 1);
        let mut stiffness = DMatrix::zeros(m + 1, m + 1);
        for cell in 0..m {
            let h = depth[cell + 1] - depth[cell];
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let same = i == j;
                mass[(cell + i, cell + j)] += if same { h / 3.0 } else { h / 6.0 };
                stiffness[(cell + i, cell + j)] += if same { 1.0 / h } else { -1.0 / h };
            }
        }
        let free = |matrix: &DMatrix<f64>| matrix.view((0, 0), (m, m)).into_owned();
        let cholesky = Cholesky::new(free(&mass)).ok_or(failed.clone())?;
        let l = cholesky.l();
        let half = l.solve_lower_triangular(&free(&stiffness)).ok_or(failed.clone())?;
        let symmetric = l.solve_lower_triangular(&half.transpose()).ok_or(failed.clone())?;
        let symmetric = (&symmetric + symmetric.transpose()) * 0.5;
        let eigen = SymmetricEigen::try_new(symmetric, f64::EPSILON, 10_000).ok_or(failed.clone())?;
        let vectors = l
            .transpose()
            .solve_upper_triangular(&eigen.eigenvectors)
            .ok_or(failed)?;

        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let modes = DMatrix::from_fn(
            m + 1,
            m,
            |row, mode| if row < m { vectors[(row, order[mode])] } else { 0.0 },
        );
        let weight: Vec<f64> = mass.column_sum().iter().copied().collect();
        let per_mode = |f: &dyn Fn(usize) -> f64| (0..m).map(f).collect::<Vec<f64>>();
        Ok(DepthBasis {
            // The Rayleigh quotient is a sum of squares: also the smallest of eigenvalues that span ten decades is
            // accurate and positive.
            eigenvalues: per_mode(&|mode| {
                (0..m)
                    .map(|c| (modes[(c + 1, mode)] - modes[(c, mode)]).powi(2) / (depth[c + 1] - depth[c]))
                    .sum()
            }),
            surface: per_mode(&|mode| modes[(0, mode)]),
            integral: per_mode(&|mode| (0..=m).map(|row| weight[row] * modes[(row, mode)]).sum()),
            #[cfg(feature = "verification")]
            bottom_flux: per_mode(&|mode| modes[(m - 1, mode)] / (depth[m] - depth[m - 1])),
            modes,
        })
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Surface value of a column given by its modal amplitudes.
    pub fn surface_value(&self, amplitudes: impl Iterator<Item = f64>) -> f64 {
        amplitudes.zip(&self.surface).map(|(a, s)| a * s).sum()
    }

    /// Value at a row of a column given by its modal amplitudes.
    pub fn value(&self, amplitudes: impl Iterator<Item = f64>, row: usize) -> f64 {
        amplitudes
            .zip(self.modes.row(row).iter())
            .map(|(amplitude, mode)| amplitude * mode)
            .sum()
    }

    /// Integral over the depth of a column given by its modal amplitudes.
    pub fn content(&self, amplitudes: impl Iterator<Item = f64>) -> f64 {
        amplitudes.zip(&self.integral).map(|(a, s)| a * s).sum()
    }
}
