//! Profiles of a patch for plotting: along its middle strip, and across the strips.

use super::fields::PatchFields;
use super::integrals::wear_left_behind;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use crate::contact::profiles::{ContactNode, PROFILE_POINTS, Profiles, STRIP_POINTS, StripProfiles, depths};
use crate::friction::coulomb;
use crate::numerics::interpolation::between;

/// The fields at the cells of the window, strip by strip.
pub fn contact_nodes(operators: &PatchOperators, fields: &PatchFields) -> Vec<ContactNode> {
    let (grid, scale) = (&operators.grid, operators.scales.pressure);
    let cells = (0..grid.strips).flat_map(|strip| (0..grid.cells).map(move |cell| (strip, cell)));
    cells
        .map(|(strip, cell)| {
            let (place, index) = (grid.place(strip, cell), strip * grid.cells + cell);
            let shear = [fields.shear[0][place], fields.shear[1][place]];
            let bound = fields.friction[place] * fields.pressure[place];
            ContactNode {
                position: grid.x(cell),
                lateral_position: grid.y(strip),
                pressure: fields.pressure[place] * scale,
                shear: shear[0] * scale,
                lateral_shear: shear[1] * scale,
                slip: fields.slip[0][place],
                lateral_slip: fields.slip[1][place],
                utilisation: if bound > 0.0 {
                    coulomb::magnitude(shear) / bound
                } else {
                    0.0
                },
                friction_coefficient: fields.friction[place],
                temperature: fields.heat.surface[index],
                wear_depth: fields.wear.depth[index],
            }
        })
        .collect()
}

/// Samples the fields, linear between the centres of the cells; along the rail the mean of two strips, which may be the same.
pub fn profiles(problem: &PatchProblem, fields: &PatchFields, ambient: f64, middle: [usize; 2]) -> Profiles {
    let operators = problem.operators;
    let grid = &operators.grid;
    let along = |value: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        let values: Vec<f64> = (0..grid.cells)
            .map(|cell| 0.5 * (value(middle[0], cell) + value(middle[1], cell)))
            .collect();
        crate::contact::profiles::sample(&values, PROFILE_POINTS)
    };
    let across = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let values: Vec<f64> = (0..grid.strips).map(value).collect();
        crate::contact::profiles::sample(&values, STRIP_POINTS)
    };
    let largest = |strip: usize, value: &dyn Fn(usize) -> f64| -> f64 {
        (0..grid.cells)
            .map(|cell| value(grid.place(strip, cell)))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let surface = |strip: usize, cell: usize| ambient + fields.heat.surface[strip * grid.cells + cell];
    let scale = operators.scales.pressure;
    let strips = StripProfiles {
        position: across(&|strip| grid.y(strip)),
        pressure: across(&|strip| largest(strip, &|place| scale * fields.pressure[place])),
        temperature: across(&|strip| {
            (0..grid.cells)
                .map(|cell| surface(strip, cell))
                .fold(f64::NEG_INFINITY, f64::max)
        }),
        wear_depth: across(&|strip| wear_left_behind(problem, fields, strip)),
        friction_power: across(&|strip| {
            let power = |place: usize| {
                coulomb::vector_power(
                    [fields.shear[0][place], fields.shear[1][place]],
                    [fields.slip[0][place], fields.slip[1][place]],
                )
            };
            grid.length * scale * grid.row(strip).map(power).sum::<f64>()
        }),
    };
    let rises = fields.heat.surface.iter().enumerate();
    let hottest = rises.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index);
    let amplitudes = fields
        .heat
        .amplitudes(&operators.strips, hottest / grid.cells, hottest % grid.cells);
    let depth = depths(operators.depth[operators.depth.len() - 1]);
    Profiles {
        x: along(&|_, cell| grid.x(cell)),
        pressure: along(&|strip, cell| scale * fields.pressure[grid.place(strip, cell)]),
        shear: along(&|strip, cell| scale * fields.shear[0][grid.place(strip, cell)]),
        slip: along(&|strip, cell| fields.slip[0][grid.place(strip, cell)]),
        temperature: along(&surface),
        wear_depth: along(&|strip, cell| fields.wear.depth[strip * grid.cells + cell]),
        strips,
        depth_temperature: depth
            .iter()
            .map(|&z| ambient + below(operators, amplitudes.clone(), z))
            .collect(),
        depth,
    }
}

/// Temperature rise of a column at a depth `m`, `K`.
fn below(operators: &PatchOperators, amplitudes: impl Iterator<Item = f64> + Clone, depth: f64) -> f64 {
    let (upper, weight) = between(&operators.depth, depth);
    let value = |row| operators.basis.value(amplitudes.clone(), row);
    value(upper) * (1.0 - weight) + value(upper + 1) * weight
}
