//! Influence functions of a patch: displacement of the centre of a cell by a traction on another one, a function of the lag between
//! the two, in cells along x and strips across.

use crate::body::cell_integrals::CellIntegrals;
use crate::body::grid::Grid;
use crate::body::half_space::{HalfSpaces, Kernel, X_OVER_R2, XX_OVER_R3, XY_OVER_R3, Y_OVER_R2, YY_OVER_R3};
use crate::body::influence::{Tables, Transform};

/// Influence functions of the pair of half-spaces with a layer between them, scaled: displacement per traction.
pub struct Kernels {
    /// Factor on the kernel 1/r.
    direct: f64,
    /// Factor on the kernels of Poisson's effect.
    lateral: f64,
    /// Compliance of the layer; 0 without one.
    layer: f64,
    xx: CellIntegrals,
    xy: CellIntegrals,
    yy: CellIntegrals,
    /// Coupling of normal and tangential displacement: its factor, and the integrals along x and y; none where the bodies are alike.
    coupling: Option<(f64, [CellIntegrals; 2])>,
}

impl Kernels {
    /// Influence functions on a grid at all lags of a transform; `unit` is the scaled displacement per traction and compliance of 1 `m/Pa`,
    /// `layer` the compliance of the layer, scaled.
    pub fn new(pair: &HalfSpaces, grid: &Grid, transform: &Transform, unit: f64, layer: f64) -> Kernels {
        let lags = transform.largest_lags();
        let integrals = |kernel: &Kernel| CellIntegrals::new(grid, lags, kernel);
        Kernels {
            direct: unit * pair.normal(),
            lateral: unit * pair.lateral,
            layer,
            xx: integrals(&XX_OVER_R3),
            xy: integrals(&XY_OVER_R3),
            yy: integrals(&YY_OVER_R3),
            coupling: (pair.coupling != 0.0)
                .then(|| (-unit * pair.coupling, [integrals(&X_OVER_R2), integrals(&Y_OVER_R2)])),
        }
    }

    /// Normal displacement by pressure.
    pub fn normal(&self, lag: (isize, isize)) -> f64 {
        self.direct * (self.xx.at(lag) + self.yy.at(lag))
    }

    /// Displacement u_x by τ_x.
    pub fn along(&self, lag: (isize, isize)) -> f64 {
        self.normal(lag) + self.lateral * self.xx.at(lag) + self.layer_at(lag)
    }

    /// Displacement u_y by τ_y.
    pub fn across(&self, lag: (isize, isize)) -> f64 {
        self.normal(lag) + self.lateral * self.yy.at(lag) + self.layer_at(lag)
    }

    /// Displacement u_x by τ_y, and u_y by τ_x.
    pub fn mixed(&self, lag: (isize, isize)) -> f64 {
        self.lateral * self.xy.at(lag)
    }

    /// Tables of the displacement u by pressure, which are those of the normal displacement by shear, too.
    pub fn coupling(&self, transform: &Transform) -> Option<Tables<f64>> {
        let (factor, [along, across]) = self.coupling.as_ref()?;
        Some(transform.tables(|lag| factor * along.at(lag), |lag| factor * across.at(lag), |_| 0.0))
    }

    /// Displacement over the layer, which a cell's own shear alone moves.
    fn layer_at(&self, lag: (isize, isize)) -> f64 {
        if lag == (0, 0) { self.layer } else { 0.0 }
    }
}
