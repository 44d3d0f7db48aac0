//! What is read off the fields of a patch for the outputs.

use super::fields::PatchFields;
use super::problem::Problem;
use super::rail::PatchRail;
use crate::contact::outputs::Readings;
use crate::contact::resultants::{Node, Resultants};
use crate::contact::rim::ContactHeat;
use crate::friction::coulomb;

/// Of the given fields under the problem's conditions.
pub fn readings(problem: &Problem, fields: &PatchFields) -> Readings {
    let rail = problem.rail;
    let extent = extent(rail, &fields.pressure);
    let heat = problem.heat_march();
    Readings {
        resultants: Resultants::of(nodes(problem, fields)),
        node_area: rail.grid.cell_area(),
        pressure_scale: rail.scales.pressure,
        penetration: fields.penetration * rail.scales.displacement,
        contact_length: extent.length,
        contact_breadth: extent.breadth,
        contact_area: extent.area,
        peak_rise: fields.heat.surface.iter().fold(f64::NEG_INFINITY, |m: f64, t| t.max(m)),
        wear_depth: (0..rail.grid.strips)
            .map(|strip| wear_left_behind(problem, fields, strip))
            .fold(0.0, f64::max),
        leaving_rise: rail.incoming.equivalent_rise(&rail.basis, heat.leaving(&fields.heat)),
        leaving_wear_depth: problem.wear_march().leaving(&fields.wear),
        wheel_heat: ContactHeat::new(problem.parameters, rail.unit_force(), problem.heated_nodes(fields)),
        wheel_temperature: fields.wheel_temperature,
    }
}

fn nodes<'f>(problem: &'f Problem, fields: &'f PatchFields) -> impl Iterator<Item = Node> + 'f {
    let grid = &problem.rail.grid;
    let regularisation = problem.parameters.slip_regularisation;
    (0..grid.strips).flat_map(move |strip| {
        (0..grid.cells).map(move |cell| {
            let place = grid.place(strip, cell);
            let pressure = fields.pressure[place];
            let shear = [fields.shear[0][place], fields.shear[1][place]];
            let bound = fields.friction[place] * pressure;
            // Coulomb's bound is reached to round-off.
            let share = if bound > 0.0 {
                coulomb::magnitude(shear) / bound
            } else {
                1.0
            };
            Node {
                position: grid.x(cell),
                lateral: grid.y(strip),
                pressure,
                shear: shear[0],
                lateral_shear: shear[1],
                slip: fields.slip[0][place],
                lateral_slip: fields.slip[1][place],
                friction: fields.friction[place],
                heat_flux: fields.heat.flux[strip * grid.cells + cell],
                sticks: pressure > 0.0 && coulomb::sticks(share * (1.0 + 1e-9), regularisation),
            }
        })
    })
}

/// Wear depth of a strip at the end of the window where material leaves it; at rest the deepest, `m`.
pub fn wear_left_behind(problem: &Problem, fields: &PatchFields, strip: usize) -> f64 {
    let cells = problem.rail.grid.cells;
    let depth = &fields.wear.depth[strip * cells..(strip + 1) * cells];
    let speed = problem.conditions.motion.rolling_speed;
    if speed > 0.0 {
        depth[0]
    } else if speed < 0.0 {
        depth[cells - 1]
    } else {
        depth.iter().fold(0.0, |m, &w| w.max(m))
    }
}

/// The size of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Extent {
    /// Largest length along a strip, `m`.
    pub length: f64,
    /// Largest breadth across the strips, `m`.
    pub breadth: f64,
    /// Area, `m²`.
    pub area: f64,
}

/// How far before the centre of a cell the contact ends when that cell joins it, in cells.
const JOINS: f64 = 0.156;

/// How far the contact reaches beyond the place where its last cell has joined, in cells, 0 to 1: r + 0.77 r³ of the ratio r of that
/// cell's pressure to the next one's. Towards an end the pressure falls like the root of the distance, and what uniform
/// cells make of that depends on nothing but where the end lies between them; the polynomial and [`JOINS`] are fitted to Hertz's
/// ellipses, whose ends it gives to 0.03 of a cell.
fn reach(edge: f64, inside: f64) -> f64 {
    if edge >= inside {
        return 1.0;
    }
    let ratio = edge / inside;
    (ratio + 0.77 * ratio * ratio * ratio).min(1.0)
}

/// Length, breadth and area of the cells under pressure.
pub fn extent(rail: &PatchRail, pressure: &[f64]) -> Extent {
    let grid = &rail.grid;
    let mut extent = Extent::default();
    for strip in 0..grid.strips {
        extent.length = extent.length.max(length(rail, pressure, strip));
    }
    for cell in 0..grid.cells {
        let breadth = grid.breadth * distance(grid.strips, |strip| pressure[grid.place(strip, cell)]);
        extent.breadth = extent.breadth.max(breadth);
    }
    extent.area = area(rail, pressure);
    extent
}

/// Length of the contact along a strip, `m`.
fn length(rail: &PatchRail, pressure: &[f64], strip: usize) -> f64 {
    let row = &pressure[rail.grid.row(strip)];
    rail.grid.length * distance(rail.grid.cells, |cell| row[cell])
}

/// Area of the contact, `m²`. In strips the midpoint rule would miss what ends like a root at the sides: the outermost strip on either
/// side, whose own length is that of an edge, is replaced by the area under the root that begins at the side and has
/// the length L of the next strip at its centre, a distance d strips from the side. From that strip's edge on it is ⅔ L (d − ½)^{3/2}/√d, and
/// what the midpoint rule overstates from there inwards is L/(48 √(d (d − ½))).
fn area(rail: &PatchRail, pressure: &[f64]) -> f64 {
    let grid = &rail.grid;
    let largest = |strip: usize| {
        let row = &pressure[grid.row(strip)];
        (0..grid.cells).fold(0, |largest, cell| if row[cell] > row[largest] { cell } else { largest })
    };
    let at = |strip: usize, cell: usize| pressure[grid.place(strip, cell)];
    let inside = |&strip: &usize| at(strip, largest(strip)) > 0.0;
    let (Some(first), Some(last)) = ((0..grid.strips).find(inside), (0..grid.strips).rfind(inside)) else {
        return 0.0;
    };
    let lengths = |strips: std::ops::Range<usize>| -> f64 { strips.map(|strip| length(rail, pressure, strip)).sum() };
    if last < first + 2 {
        return grid.breadth * lengths(first..last + 1);
    }
    let side = |outermost: usize, next: usize| {
        let cell = largest(outermost);
        let d = 1.0 - JOINS + reach(at(outermost, cell), at(next, cell));
        let beyond = d - 0.5;
        let root = length(rail, pressure, next) / d.sqrt();
        root * (beyond * beyond.sqrt() / 1.5 - 1.0 / (48.0 * beyond.sqrt()))
    };
    grid.breadth * (side(first, first + 1) + lengths(first + 1..last) + side(last, last - 1))
}

/// Distance between the ends of what is under pressure, in cells. A cell by itself is as long as when the next one joins it.
fn distance(count: usize, pressure: impl Fn(usize) -> f64) -> f64 {
    let inside = |&i: &usize| pressure(i) > 0.0;
    let (Some(first), Some(last)) = ((0..count).find(inside), (0..count).rfind(inside)) else {
        return 0.0;
    };
    let reach = |end: usize, next: usize| {
        if first == last {
            1.0
        } else {
            reach(pressure(end), pressure(next))
        }
    };
    (last - first) as f64 + reach(first, first + 1) + reach(last, last.wrapping_sub(1)) - 2.0 * JOINS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{ContactModel, Parameters};

    /// Pressures as the cells have them when the contact grows by a cell: no jump.
    #[test]
    fn a_cell_that_joins_changes_no_length() {
        let line = [0.712, 1.0, 1.1, 1.0, 0.713];
        let grown = [0.712, 1.0, 1.1, 1.0, 0.713, 1e-12];
        let (before, after) = (distance(5, |i| line[i]), distance(6, |i| grown[i]));
        assert!((before - after).abs() < 0.02, "{before} {after}");
        assert!((distance(1, |_| 1.0) - distance(2, |i| [1.0, 1e-12][i])).abs() < 1e-9);
        assert_eq!(distance(3, |_| 0.0), 0.0);
    }

    /// One strip, then two, then the root: the area has no gap.
    #[test]
    fn the_area_of_few_strips() {
        let rail = PatchRail::new(&Parameters {
            contact_model: ContactModel::Patch,
            ..Parameters::default()
        })
        .unwrap();
        let grid = &rail.grid;
        let mut pressure = vec![0.0; grid.len()];
        assert_eq!(extent(&rail, &pressure), Extent::default());
        let mut areas = Vec::new();
        for strip in 5..9 {
            for cell in 10..20 {
                pressure[grid.place(strip, cell)] = 1.0;
            }
            areas.push(extent(&rail, &pressure).area / (grid.cell_area() * (11.0 - 2.0 * JOINS)));
        }
        assert!(
            (areas[0] - 1.0).abs() < 1e-12 && (areas[1] - 2.0).abs() < 1e-12,
            "{areas:?}"
        );
        assert!(
            areas.windows(2).all(|pair| (0.5..1.5).contains(&(pair[1] - pair[0]))),
            "{areas:?}"
        );
    }
}
