//! Wear of the profiles: what a step removes from the wheel is spread over the turn, what it removes from the rail over the length of rail that the wheel
//! passes over and over,
//!
//! ∂W_w/∂t = ∫ Ẇ_w dx / (2π r(s)),  ∂W_r/∂t = ∫ Ẇ_r dx / L,
//!
//! times `wear_acceleration`. A strip of a window wears a stretch of either profile: of the rail's that below it, of the wheel's the one that is over it,
//! where it slides. Within a strip the volume is spread with the slope that those beside it give it. Each cell of a profile is given its part of the
//! volume, so that nothing is lost.

use super::bodies::{Bodies, RAIL, WHEEL};
use super::fields::SurfaceFields;
use super::problem::SurfaceProblem;
use super::windows::Place;
use super::worn_bodies::WornOff;
use crate::body::grid::Grid;
use crate::contact::patch::fields::PatchFields;
use crate::friction::coulomb;
use crate::geometry::unrolled::PlacedWheel;
use crate::numerics::dense;
use crate::parameters::WheelWearLaw;
use std::f64::consts::PI;

/// Least breadth of the stretch that a strip wears off the wheel, over the strip's own: where the two bend apart.
const LEAST_BREADTH: f64 = 0.1;

/// Volumes that a strip wears off both bodies per time, and the arc length of the wheel's profile that is over it.
#[derive(Debug, Clone, Copy, Default)]
struct Strip {
    /// Volumes per time, `m³/s`.
    rates: [f64; 2],
    /// Arc length of the wheel's profile, `m`.
    over: f64,
}

impl Strip {
    fn wears(&self) -> bool {
        self.rates[WHEEL] > 0.0
    }
}

/// Finds the area that each cell of the profiles loses per time, `m²/s`: the number of the body, that of the cell, the area.
fn areas(problem: &SurfaceProblem, bodies: &Bodies, fields: &SurfaceFields, mut give: impl FnMut(usize, usize, f64)) {
    let (operators, parameters) = (problem.operators, problem.parameters);
    if [WHEEL, RAIL].iter().all(|&body| operators.wear_cells(body) == 0) {
        return;
    }
    let wheel = PlacedWheel::new(&bodies.wheel, &problem.pose().at_height(problem.height(fields)));
    let acceleration = parameters.wear_acceleration;
    for (window, place) in fields.used() {
        let grid = &operators.of(&place).grid;
        let strip = |strip: usize| {
            if strip < grid.strips {
                worn_strip(problem, bodies, &wheel, &fields.windows[window], &place, strip)
            } else {
                Strip::default()
            }
        };
        let [mut before, mut here] = [Strip::default(), strip(0)];
        for number in 0..grid.strips {
            let after = strip(number + 1);
            let own = place.arc(grid, number);
            let half = 0.5 * grid.breadth;
            for body in [WHEEL, RAIL] {
                let rate = here.rates[body];
                if operators.wear_cells(body) == 0 || rate <= 0.0 {
                    continue;
                }
                let stretch = match body {
                    WHEEL => over(&before, &here, &after, half),
                    _ => [own - half, own + half],
                };
                let tilt = (0.25 * (after.rates[body] - before.rates[body]) / rate).clamp(-1.0, 1.0);
                operators.grids[body].spread(stretch, acceleration * rate, tilt, |cell, volume| {
                    let length = match body {
                        WHEEL => 2.0 * PI * operators.wheel_radii[cell],
                        _ => parameters.rail_wear_length,
                    };
                    give(body, cell, volume / length);
                });
            }
            (before, here) = (here, after);
        }
    }
}

/// Stretch of the wheel's profile that a strip wears: half way to those beside it.
fn over(before: &Strip, here: &Strip, after: &Strip, half: f64) -> [f64; 2] {
    let towards = |other: &Strip, way: f64| {
        if other.wears() {
            0.5 * (other.over - here.over)
        } else {
            way
        }
    };
    let stretch = [here.over + towards(before, -half), here.over + towards(after, half)];
    if stretch[1] - stretch[0] < 2.0 * LEAST_BREADTH * half {
        return [here.over - half, here.over + half];
    }
    stretch
}

/// Volumes that a strip of a window wears off, and where.
fn worn_strip(
    problem: &SurfaceProblem,
    bodies: &Bodies,
    wheel: &PlacedWheel,
    fields: &PatchFields,
    place: &Place,
    strip: usize,
) -> Strip {
    let (patch, parameters) = (problem.of(place), problem.parameters);
    let grid = &patch.operators.grid;
    // Per area, with the moment about the window's middle along the rail.
    let sliding = sliding(grid, patch.operators.scales.pressure, fields, strip);
    let of_coefficient = |coefficient: f64| sliding.map(|sum| coefficient * sum);
    let rail = match patch.pointwise_wear() {
        Some(law) => over_cells(grid, strip, |at| {
            if fields.pressure[at] > 0.0 {
                law.rate(&patch.rubbing(fields, at))
            } else {
                0.0
            }
        }),
        None => of_coefficient(parameters.wear_coefficient),
    };
    let [own, moment] = match parameters.wheel_wear_law {
        WheelWearLaw::Coefficient => of_coefficient(parameters.wheel_wear_coefficient),
        WheelWearLaw::WearLaw => rail,
    };
    let mut rates = [0.0; 2];
    (rates[WHEEL], rates[RAIL]) = (own, rail[0]);
    if rates == [0.0; 2] {
        return Strip::default();
    }
    let mut over = 0.0;
    if problem.operators.wear_cells(WHEEL) > 0 && rates[WHEEL] > 0.0 {
        let along = place.middle_along(grid) + moment / rates[WHEEL];
        let at = wheel.distance(along, &bodies.rail.at(place.arc(grid, strip)), 0.0);
        let worn_height = &problem.operators.worn_height;
        over = worn_height.arc_of(&bodies.wheel.profile, wheel.profile_position(&at));
    }
    Strip {
        rates: rates.map(|rate| grid.cell_area() * rate),
        over,
    }
}

/// Pressure times speed of sliding over the cells of a strip, `Pa m/s`, and its moment, `Pa m²/s`.
fn sliding(grid: &Grid, scale: f64, fields: &PatchFields, strip: usize) -> [f64; 2] {
    let [x, y] = &fields.slip;
    dense::vectorised(
        #[inline(always)]
        |_| {
            over_cells(grid, strip, |at| {
                scale * fields.pressure[at] * coulomb::magnitude([x[at], y[at]])
            })
        },
    )
}

/// Sum over the cells of a strip, and that of the moments about the window's middle along the rail.
#[inline(always)]
fn over_cells(grid: &Grid, strip: usize, of_cell: impl Fn(usize) -> f64) -> [f64; 2] {
    let (mut sum, mut moment) = (0.0, 0.0);
    for (cell, at) in grid.row(strip).enumerate() {
        let value = of_cell(at);
        sum += value;
        moment += value * grid.x(cell);
    }
    [sum, moment]
}

/// Area that both profiles lose per time, `m²/s`.
pub fn area_rates(problem: &SurfaceProblem, bodies: &Bodies, fields: &SurfaceFields) -> [f64; 2] {
    let mut rates = [0.0; 2];
    areas(problem, bodies, fields, |body, _, area| rates[body] += area);
    rates
}

/// Wears the profiles of the fields at the end of a step.
pub fn wear(problem: &SurfaceProblem, bodies: &Bodies, fields: &mut SurfaceFields) -> WornOff {
    let (operators, duration) = (problem.operators, problem.conditions.duration);
    // The depths are taken out, so that what the fields wear can be added to them.
    let mut depth = std::mem::take(&mut fields.worn.depth);
    let mut worn = WornOff {
        area_rates: [0.0; 2],
        change: 0.0,
    };
    areas(problem, bodies, fields, |body, cell, area| {
        worn.area_rates[body] += area;
        depth[body][cell] += duration * area / operators.grids[body].spacing;
        // No part is negative: the last one that a cell gets makes the change the largest.
        worn.change = worn.change.max(depth[body][cell] - fields.worn.before[body][cell]);
    });
    fields.worn.depth = depth;
    worn
}
