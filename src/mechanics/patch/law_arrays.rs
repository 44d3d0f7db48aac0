//! The law of all cells in contact, each quantity an array of its own, so that the cells of a vector register go through the law at a time.

use super::law::{Cell, CellLawRow, Matrix, Scheme, SpeedChange, Vector};
use crate::numerics::dense;
use crate::numerics::number::Register;
use crate::numerics::real::{BLOCK, Real};
use pulp::{Simd, WithSimd};

/// Components along x and y, cells.
pub type Components = [Vec<f64>; 2];
/// Derivatives of each component by each component, cells.
pub type Derivatives = [Components; 2];

/// Values of so many cells, filled up to whole registers.
fn values(cells: usize) -> Vec<f64> {
    vec![0.0; cells.next_multiple_of(BLOCK)]
}

fn components(cells: usize) -> Components {
    std::array::from_fn(|_| values(cells))
}

fn derivatives(cells: usize) -> Derivatives {
    std::array::from_fn(|_| components(cells))
}

/// Data of the law: see [`Cell`] and [`Scheme`].
#[derive(Debug, Clone)]
pub struct CellArrays {
    /// τ.
    pub shear: Components,
    /// S, with what the leading edge adds.
    pub ahead: Components,
    /// B.
    pub behind: Components,
    /// c.
    pub off_middle: Components,
    /// μp.
    pub bound: Vec<f64>,
    /// r, at the leading edge that of its cells.
    pub scale: Vec<f64>,
}

/// Law of the cells, linearised: see [`CellLawRow`].
#[derive(Debug, Clone)]
pub struct LawArrays {
    /// The residual.
    pub residual: Components,
    /// Derivatives by the shear, by component of the residual and component of the shear.
    pub by_shear: Derivatives,
    /// Derivatives by S.
    pub by_ahead: Derivatives,
    /// Derivatives by B.
    pub by_behind: Derivatives,
    /// Derivatives by the bound.
    pub by_bound: Components,
    /// Derivatives by w.
    pub by_noise: Components,
}

/// Magnitude of the slip, where the bound depends on it.
#[derive(Debug, Clone)]
pub struct SpeedArrays {
    /// |s|, `m/s`.
    pub speed: Vec<f64>,
    /// Derivative of the bound by it.
    pub bound_by_speed: Vec<f64>,
    /// Derivatives of |s| by S.
    pub by_ahead: Components,
    /// Derivatives of |s| by B.
    pub by_behind: Components,
    /// Derivatives of |s| by w.
    pub by_noise: Vec<f64>,
}

/// Registers of an array.
#[derive(Clone, Copy)]
struct Source<'a, S: Simd> {
    simd: S,
    registers: &'a [S::f64s],
}

impl<'a, S: Simd> Source<'a, S> {
    #[inline(always)]
    fn new(simd: S, values: &'a [f64], count: usize) -> Source<'a, S> {
        Source {
            simd,
            registers: &f64::vectors::<S>(values)[..count],
        }
    }

    #[inline(always)]
    fn of_components(simd: S, values: &'a Components, count: usize) -> [Source<'a, S>; 2] {
        let [x, y] = values;
        [Source::new(simd, x, count), Source::new(simd, y, count)]
    }

    #[inline(always)]
    fn at(&self, k: usize) -> Register<S> {
        Register::new(self.simd, self.registers[k])
    }
}

/// A vector of the cells of a register.
#[inline(always)]
fn vector<S: Simd>([x, y]: &[Source<S>; 2], k: usize) -> Vector<Register<S>> {
    [x.at(k), y.at(k)]
}

/// Registers of an array, to be written.
type Target<'a, S> = &'a mut [<f64 as Real>::Vector<S>];

#[inline(always)]
fn target<S: Simd>(values: &mut [f64], count: usize) -> Target<'_, S> {
    &mut f64::vectors_mut::<S>(values)[..count]
}

/// Registers of components, to be written.
struct Targets<'a, S: Simd>([Target<'a, S>; 2]);

impl<'a, S: Simd> Targets<'a, S> {
    #[inline(always)]
    fn new([x, y]: &'a mut Components, count: usize) -> Targets<'a, S> {
        Targets([target::<S>(x, count), target::<S>(y, count)])
    }

    #[inline(always)]
    fn put(&mut self, k: usize, vector: Vector<Register<S>>) {
        (self.0[0][k], self.0[1][k]) = (vector[0].values, vector[1].values);
    }
}

/// Registers of derivatives, to be written.
struct MatrixTargets<'a, S: Simd>([Targets<'a, S>; 2]);

impl<'a, S: Simd> MatrixTargets<'a, S> {
    #[inline(always)]
    fn new([x, y]: &'a mut Derivatives, count: usize) -> MatrixTargets<'a, S> {
        MatrixTargets([Targets::new(x, count), Targets::new(y, count)])
    }

    #[inline(always)]
    fn put(&mut self, k: usize, matrix: Matrix<Register<S>>) {
        self.0[0].put(k, matrix[0]);
        self.0[1].put(k, matrix[1]);
    }
}

/// Registers of the law, to be written.
struct LawTargets<'a, S: Simd> {
    residual: Targets<'a, S>,
    by_shear: MatrixTargets<'a, S>,
    by_ahead: MatrixTargets<'a, S>,
    by_behind: MatrixTargets<'a, S>,
    by_bound: Targets<'a, S>,
    by_noise: Targets<'a, S>,
}

impl<'a, S: Simd> LawTargets<'a, S> {
    #[inline(always)]
    fn new(law: &'a mut LawArrays, count: usize) -> LawTargets<'a, S> {
        LawTargets {
            residual: Targets::new(&mut law.residual, count),
            by_shear: MatrixTargets::new(&mut law.by_shear, count),
            by_ahead: MatrixTargets::new(&mut law.by_ahead, count),
            by_behind: MatrixTargets::new(&mut law.by_behind, count),
            by_bound: Targets::new(&mut law.by_bound, count),
            by_noise: Targets::new(&mut law.by_noise, count),
        }
    }

    #[inline(always)]
    fn put(&mut self, k: usize, row: &CellLawRow<Register<S>>) {
        self.residual.put(k, row.residual);
        self.by_shear.put(k, row.by_shear);
        self.by_ahead.put(k, row.by_ahead);
        self.by_behind.put(k, row.by_behind);
        self.by_bound.put(k, row.by_bound);
        self.by_noise.put(k, row.by_noise);
    }
}

/// Registers of the data.
struct CellSources<'a, S: Simd> {
    /// Number of registers that hold the cells.
    count: usize,
    noise: Register<S>,
    shear: [Source<'a, S>; 2],
    ahead: [Source<'a, S>; 2],
    behind: [Source<'a, S>; 2],
    off_middle: [Source<'a, S>; 2],
    bound: Source<'a, S>,
    scale: Source<'a, S>,
}

impl<'a, S: Simd> CellSources<'a, S> {
    #[inline(always)]
    fn new(simd: S, of: &Cells<'a>) -> CellSources<'a, S> {
        let Cells {
            arrays: cells,
            noise,
            count,
        } = *of;
        let count = count.div_ceil(S::F64_LANES);
        CellSources {
            count,
            noise: Register::new(simd, simd.splat_f64s(noise)),
            shear: Source::of_components(simd, &cells.shear, count),
            ahead: Source::of_components(simd, &cells.ahead, count),
            behind: Source::of_components(simd, &cells.behind, count),
            off_middle: Source::of_components(simd, &cells.off_middle, count),
            bound: Source::new(simd, &cells.bound, count),
            scale: Source::new(simd, &cells.scale, count),
        }
    }

    /// The cells of a register and their scheme.
    #[inline(always)]
    fn at(&self, k: usize) -> (Scheme<Register<S>>, Cell<Register<S>>) {
        let scheme = Scheme {
            scale: self.scale.at(k),
            noise: self.noise,
            regularisation: 0.0,
        };
        let cell = Cell {
            shear: vector(&self.shear, k),
            ahead: vector(&self.ahead, k),
            behind: vector(&self.behind, k),
            off_middle: vector(&self.off_middle, k),
            bound: self.bound.at(k),
        };
        (scheme, cell)
    }
}

/// Cells whose law is computed: the first `count` of the arrays, with the slip w that they have in common.
#[derive(Clone, Copy)]
struct Cells<'a> {
    arrays: &'a CellArrays,
    noise: f64,
    count: usize,
}

/// [`CellArrays::speeds`] with the vectors of the machine.
struct Speeds<'a> {
    of: Cells<'a>,
    speed: &'a mut [f64],
}

impl WithSimd for Speeds<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let cells = CellSources::new(simd, &self.of);
        for (k, speed) in target::<S>(self.speed, cells.count).iter_mut().enumerate() {
            let (scheme, cell) = cells.at(k);
            *speed = scheme.slip(&cell).speed().values;
        }
    }
}

/// [`LawArrays::take`] of Coulomb's law with the vectors of the machine.
struct CoulombRows<'a> {
    of: Cells<'a>,
    speeds: Option<&'a mut SpeedArrays>,
    law: &'a mut LawArrays,
}

impl WithSimd for CoulombRows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let cells = CellSources::new(simd, &self.of);
        let count = cells.count;
        let mut law = LawTargets::new(self.law, count);
        let Some(speeds) = self.speeds else {
            for k in 0..count {
                let (scheme, cell) = cells.at(k);
                let slip = scheme.slip(&cell);
                law.put(k, &scheme.coulomb_row(&cell, &slip));
            }
            return;
        };
        let bound_by_speed = Source::new(simd, &speeds.bound_by_speed, count);
        let mut by_ahead = Targets::new(&mut speeds.by_ahead, count);
        let mut by_behind = Targets::new(&mut speeds.by_behind, count);
        let by_noise = target::<S>(&mut speeds.by_noise, count);
        for (k, by_noise) in by_noise.iter_mut().enumerate() {
            let (scheme, cell) = cells.at(k);
            let slip = scheme.slip(&cell);
            let mut row = scheme.coulomb_row(&cell, &slip);
            let change = slip.speed_change();
            row.add_bound_by_speed(bound_by_speed.at(k), &change);
            law.put(k, &row);
            by_ahead.put(k, change.by_ahead);
            by_behind.put(k, change.by_behind);
            *by_noise = change.by_noise.values;
        }
    }
}

impl CellArrays {
    /// Data of up to so many cells.
    pub fn new(cells: usize) -> CellArrays {
        CellArrays {
            shear: components(cells),
            ahead: components(cells),
            behind: components(cells),
            off_middle: components(cells),
            bound: values(cells),
            scale: values(cells),
        }
    }

    /// Selects the first `count` cells, with the w of a scheme.
    fn with(&self, scheme: &Scheme, count: usize) -> Cells<'_> {
        Cells {
            arrays: self,
            noise: scheme.noise,
            count,
        }
    }

    /// Data of a cell, and its scheme.
    fn cell(&self, scheme: &Scheme, index: usize) -> (Scheme, Cell) {
        let at = |values: &Components| [values[0][index], values[1][index]];
        let cell = Cell {
            shear: at(&self.shear),
            ahead: at(&self.ahead),
            behind: at(&self.behind),
            off_middle: at(&self.off_middle),
            bound: self.bound[index],
        };
        let scale = self.scale[index];
        (Scheme { scale, ..*scheme }, cell)
    }

    /// Finds the magnitude of the slip of so many cells.
    pub fn speeds(&self, scheme: &Scheme, count: usize, speeds: &mut SpeedArrays) {
        dense::with_vectors(Speeds {
            of: self.with(scheme, count),
            speed: &mut speeds.speed,
        });
    }
}

impl LawArrays {
    /// Law of up to so many cells.
    pub fn new(cells: usize) -> LawArrays {
        LawArrays {
            residual: components(cells),
            by_shear: derivatives(cells),
            by_ahead: derivatives(cells),
            by_behind: derivatives(cells),
            by_bound: components(cells),
            by_noise: components(cells),
        }
    }

    /// Takes the law of so many cells with these data; of their scales, not of the scheme's. Where `speeds` are given, the bound follows the slip's
    /// magnitude by `bound_by_speed`, and its derivatives are left there. What stands beyond the cells has no meaning.
    pub fn take(&mut self, cells: &CellArrays, scheme: &Scheme, count: usize, mut speeds: Option<&mut SpeedArrays>) {
        if scheme.regularisation == 0.0 {
            dense::with_vectors(CoulombRows {
                of: cells.with(scheme, count),
                speeds,
                law: self,
            });
            return;
        }
        for index in 0..count {
            let (scheme, cell) = cells.cell(scheme, index);
            let slip = scheme.slip(&cell);
            let mut row = scheme.row(&cell, &slip);
            if let Some(speeds) = &mut speeds {
                let change = slip.speed_change();
                row.add_bound_by_speed(speeds.bound_by_speed[index], &change);
                speeds.set(index, &change);
            }
            self.set(index, &row);
        }
    }

    /// Sets the law of a cell.
    pub fn set(&mut self, index: usize, row: &CellLawRow) {
        for i in 0..2 {
            self.residual[i][index] = row.residual[i];
            self.by_bound[i][index] = row.by_bound[i];
            self.by_noise[i][index] = row.by_noise[i];
            for j in 0..2 {
                self.by_shear[i][j][index] = row.by_shear[i][j];
                self.by_ahead[i][j][index] = row.by_ahead[i][j];
                self.by_behind[i][j][index] = row.by_behind[i][j];
            }
        }
    }

    /// Law of a cell.
    pub fn row(&self, index: usize) -> CellLawRow {
        let vector = |values: &Components| [values[0][index], values[1][index]];
        let matrix = |values: &Derivatives| [vector(&values[0]), vector(&values[1])];
        CellLawRow {
            residual: vector(&self.residual),
            by_shear: matrix(&self.by_shear),
            by_ahead: matrix(&self.by_ahead),
            by_behind: matrix(&self.by_behind),
            by_bound: vector(&self.by_bound),
            by_noise: vector(&self.by_noise),
        }
    }
}

impl SpeedArrays {
    /// Magnitudes of up to so many cells.
    pub fn new(cells: usize) -> SpeedArrays {
        SpeedArrays {
            speed: values(cells),
            bound_by_speed: values(cells),
            by_ahead: components(cells),
            by_behind: components(cells),
            by_noise: values(cells),
        }
    }

    fn set(&mut self, index: usize, change: &SpeedChange) {
        for i in 0..2 {
            self.by_ahead[i][index] = change.by_ahead[i];
            self.by_behind[i][index] = change.by_behind[i];
        }
        self.by_noise[index] = change.by_noise;
    }

    /// Derivatives of a cell's magnitude.
    pub fn change(&self, index: usize) -> SpeedChange {
        SpeedChange {
            by_ahead: [self.by_ahead[0][index], self.by_ahead[1][index]],
            by_behind: [self.by_behind[0][index], self.by_behind[1][index]],
            by_noise: self.by_noise[index],
        }
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Rows of the law and corrections of the leading edge as arrays.
    pub fn arrays(rows: &[CellLawRow], edge: &[Vector]) -> (LawArrays, Components) {
        let mut law = LawArrays::new(rows.len());
        for (index, row) in rows.iter().enumerate() {
            law.set(index, row);
        }
        (
            law,
            [0, 1].map(|component: usize| edge.iter().map(|edge| edge[component]).collect()),
        )
    }

    /// Cells that stick, that slide, that have no slip or no bound, some more than fill whole registers.
    fn cells() -> (CellArrays, usize) {
        const CELLS: usize = 27;
        let wave = |i: usize, k: usize| (1.3 * i as f64 + 2.1 * k as f64).sin();
        let mut cells = CellArrays::new(CELLS);
        for i in 0..CELLS {
            for j in 0..2 {
                cells.shear[j][i] = 0.3 * wave(i, j);
                cells.ahead[j][i] = if i % 5 == 0 { 0.0 } else { wave(i, 2 + j) };
                cells.behind[j][i] = wave(i, 4 + j);
                cells.off_middle[j][i] = 0.1 * wave(i, 6 + j);
            }
            cells.bound[i] = if i % 7 == 3 { 0.0 } else { 0.5 * (1.0 + wave(i, 8)) };
            cells.scale[i] = 0.7 + 0.2 * wave(i, 9);
        }
        // Neither slip nor bound.
        cells.bound[10] = 0.0;
        (cells, CELLS)
    }

    /// A register of cells has the law of each of them, to the last bit, with and without a bound that follows the slip.
    #[test]
    fn cells_of_a_register_obey_the_law_of_each() {
        let (cells, count) = cells();
        for noise in [0.01, 0.0, f64::INFINITY] {
            for regularisation in [0.0, 0.1] {
                let scheme = Scheme {
                    scale: f64::NAN,
                    noise,
                    regularisation,
                };
                for follows in [false, true] {
                    let (mut law, mut speeds) = (LawArrays::new(count), SpeedArrays::new(count));
                    for (index, by_speed) in speeds.bound_by_speed.iter_mut().enumerate() {
                        *by_speed = 0.1 * index as f64;
                    }
                    cells.speeds(&scheme, count, &mut speeds);
                    law.take(&cells, &scheme, count, follows.then_some(&mut speeds));
                    let mut stick = 0;
                    for index in 0..count {
                        let (own, cell) = cells.cell(&scheme, index);
                        let slip = own.slip(&cell);
                        assert_eq!(speeds.speed[index], slip.speed());
                        let mut row = own.row(&cell, &slip);
                        if follows {
                            row.add_bound_by_speed(speeds.bound_by_speed[index], &slip.speed_change());
                            let (found, exact) = (speeds.change(index), slip.speed_change());
                            assert_eq!(
                                (found.by_ahead, found.by_behind, found.by_noise),
                                (exact.by_ahead, exact.by_behind, exact.by_noise)
                            );
                        }
                        assert_eq!(law.row(index), row, "{index}");
                        stick += usize::from(row.by_bound == [0.0; 2]);
                    }
                    // Both branches of Coulomb's law are there.
                    assert!(regularisation > 0.0 || (3..count - 3).contains(&stick), "{stick}");
                }
            }
        }
    }
}
