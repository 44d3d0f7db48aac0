//! Length, breadth and area of the cells under pressure.

use super::operators::PatchOperators;
use crate::body::grid::Grid;

/// Size of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Extent {
    /// Largest length along a strip, `m`.
    pub length: f64,
    /// Largest breadth across the strips, `m`.
    pub breadth: f64,
    /// Area, `m²`.
    pub area: f64,
}

/// Distance between the centre of a cell and the end of the contact when that cell joins the contact, in cells.
const JOINS: f64 = 0.156;

/// Distance of the contact's end beyond the place where its last cell has joined, in cells, 0 to 1: r + 0.77 r³ of the ratio r of
/// that cell's pressure to the next one's. Towards an end the pressure falls like the root of the distance, and the ratio that
/// uniform cells make of that depends on nothing but the place of the end between them; the polynomial and [`JOINS`] are fitted to
/// Hertz's ellipses, whose ends it gives to 0.03 of a cell.
fn reach(edge: f64, inside: f64) -> f64 {
    if edge >= inside {
        return 1.0;
    }
    let ratio = edge / inside;
    (ratio + 0.77 * ratio * ratio * ratio).min(1.0)
}

/// Distance of the contact's end from the centre of its last cell, in cells, from the pressure of that cell and the next one inside; no more than to the cell's
/// edge, beyond which the pressure says nothing.
pub fn beyond_centre(edge: f64, inside: f64) -> f64 {
    (reach(edge, inside) - JOINS).min(0.5)
}

/// Length, breadth and area of the cells under pressure.
pub fn extent(operators: &PatchOperators, pressure: &[f64]) -> Extent {
    let grid = &operators.grid;
    let mut extent = Extent::default();
    for strip in 0..grid.strips {
        extent.length = extent.length.max(length(operators, pressure, strip));
    }
    for cell in 0..grid.cells {
        let breadth = grid.breadth * distance(grid.strips, |strip| pressure[grid.place(strip, cell)]);
        extent.breadth = extent.breadth.max(breadth);
    }
    extent.area = area(operators, pressure);
    extent
}

/// Length of the contact along a strip, `m`.
fn length(operators: &PatchOperators, pressure: &[f64], strip: usize) -> f64 {
    let row = &pressure[operators.grid.row(strip)];
    operators.grid.length * distance(operators.grid.cells, |cell| row[cell])
}

/// Area of the contact, `m²`. Towards a side the length of the strips falls like the root of the distance, which the midpoint rule
/// over strips would miss. So the outermost strip on either side is replaced by the area under the root that begins at the side
/// and has the length L of the next strip at that strip's centre, a distance d strips from the side: from that strip's edge
/// outwards ⅔ L (d − ½)^{3/2}/√d, less L/(48 √(d (d − ½))), by which the midpoint rule is too large from there inwards.
fn area(operators: &PatchOperators, pressure: &[f64]) -> f64 {
    let grid = &operators.grid;
    let largest = |strip: usize| {
        let row = &pressure[grid.row(strip)];
        (0..grid.cells).fold(0, |largest, cell| if row[cell] > row[largest] { cell } else { largest })
    };
    let at = |strip: usize, cell: usize| pressure[grid.place(strip, cell)];
    let inside = |&strip: &usize| at(strip, largest(strip)) > 0.0;
    let (Some(first), Some(last)) = ((0..grid.strips).find(inside), (0..grid.strips).rfind(inside)) else {
        return 0.0;
    };
    let lengths =
        |strips: std::ops::Range<usize>| -> f64 { strips.map(|strip| length(operators, pressure, strip)).sum() };
    if last < first + 2 {
        return grid.breadth * lengths(first..last + 1);
    }
    let side = |outermost: usize, next: usize| {
        let cell = largest(outermost);
        let d = 1.0 - JOINS + reach(at(outermost, cell), at(next, cell));
        let beyond = d - 0.5;
        let root = length(operators, pressure, next) / d.sqrt();
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

/// Whether a strip is under pressure anywhere.
pub fn is_loaded(grid: &Grid, pressure: &[f64], strip: usize) -> bool {
    pressure[grid.row(strip)].iter().any(|&pressure| pressure > 0.0)
}

/// Whether a contact would reach beyond its window, had it not been held within it: at the ends along the strips, and across them. The surfaces overlap there
/// by more than `overlap`, or the outermost strips are under pressure.
pub fn is_cut_off(grid: &Grid, pressure: &[f64], separation: &[f64], overlap: f64) -> [bool; 2] {
    let is_loaded = |strip: usize| is_loaded(grid, pressure, strip);
    if !(0..grid.strips).any(is_loaded) {
        return [false; 2];
    }
    let overlaps = |place: usize| separation[place] < -overlap;
    let at_an_end = |strip: usize| {
        let row = grid.row(strip);
        overlaps(row.start) || overlaps(row.end - 1)
    };
    [
        (0..grid.strips).any(at_an_end),
        is_loaded(0) || is_loaded(grid.strips - 1),
    ]
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
        let operators = PatchOperators::build(&Parameters {
            contact_model: ContactModel::Patch,
            ..Parameters::default()
        })
        .unwrap();
        let grid = &operators.grid;
        let mut pressure = vec![0.0; grid.len()];
        assert_eq!(extent(&operators, &pressure), Extent::default());
        let mut areas = Vec::new();
        for strip in 5..9 {
            for cell in 10..20 {
                pressure[grid.place(strip, cell)] = 1.0;
            }
            areas.push(extent(&operators, &pressure).area / (grid.cell_area() * (11.0 - 2.0 * JOINS)));
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
