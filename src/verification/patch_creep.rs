//! The creep forces of the patch in steady rolling, full adhesion to full slip: F_x(ξ), F_y(η) and M_z(η) at CONTACT's points on the
//! circle, and ξ, η, φ alone and combined on three ellipses, against the limits of fine elements ([`super::contact_points`],
//! [`super::patch_limits`]).

use super::contact_points::{LATERAL, LONGITUDINAL, MOMENT};
use super::patch_cases::{self, Rolling};
use super::patch_limits::LIMITS;
use super::row::{Row, larger};
use crate::error::Result;
use crate::parameters::Parameters;

/// Forces over μN, moments over μN √(ab), at the default number of cells and at twice as many each way. The references are known
/// to some 0.002.
const TOLERANCES: [(usize, &str, f64); 2] = [(1, "default cells", 0.012), (2, "twice as many each way", 0.006)];
/// The circle among the ellipses.
const CIRCLE: usize = 1;

/// ξ, η, φ and CONTACT's shares, as far as it has them, with wheelrail's signs.
fn points() -> Vec<([f64; 3], [Option<f64>; 3])> {
    let mut points: Vec<_> = LONGITUDINAL
        .iter()
        .map(|point| ([point.creepage, 0.0, 0.0], [Some(point.limit()), None, None]))
        .collect();
    points.extend(
        LATERAL
            .iter()
            .zip(MOMENT)
            .map(|(point, [creepage, moment])| ([0.0, creepage, 0.0], [None, Some(-point.limit()), Some(moment)])),
    );
    points
}

/// Largest deviation of each force.
#[derive(Default)]
struct Deviations([f64; 3]);

impl Deviations {
    fn take(&mut self, computed: [f64; 3], expected: [Option<f64>; 3]) {
        for ((largest, computed), expected) in self.0.iter_mut().zip(computed).zip(expected) {
            *largest = larger(*largest, expected.map_or(0.0, |expected| (computed - expected).abs()));
        }
    }

    fn rows(self, points: &str, cells: &str, tolerance: f64, source: &'static str) -> Vec<Row> {
        let forces = ["F_x/(mu N)", "F_y/(mu N)", "M_z/(mu N sqrt(ab))"];
        let row = |(force, deviation)| {
            let quantity = format!("largest deviation of {force}, {points}, {cells}");
            Row::absolute(quantity, "1", 0.0, deviation, tolerance, source)
        };
        forces.into_iter().zip(self.0).map(row).collect()
    }
}

/// Largest deviations.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (refinement, cells, tolerance) in TOLERANCES {
        for ellipse in 0..3 {
            let rolling = Rolling::new(patch_cases::parameters(ellipse, refinement))?;
            let axis = patch_cases::mean_axis(rolling.parameters());
            if ellipse == CIRCLE {
                let mut deviations = Deviations::default();
                for (creepages, expected) in points() {
                    deviations.take(rolling.shares(creepages)?, expected);
                }
                rows.extend(deviations.rows(
                    "xi or eta alone on the circle",
                    cells,
                    tolerance,
                    "CONTACT, extrapolated",
                ));
            }
            let mut deviations = Deviations::default();
            for limit in LIMITS.iter().filter(|limit| limit.ellipse == ellipse) {
                let [longitudinal, lateral, spin] = limit.creepages;
                let shares = rolling.shares([longitudinal, lateral, spin / axis])?;
                deviations.take(shares, limit.forces.map(Some));
            }
            let name = format!("all creepages, {}", patch_cases::name(ellipse));
            rows.extend(deviations.rows(&name, cells, tolerance, "independent program, extrapolated"));
        }
    }
    Ok(rows)
}

/// Largest deviation of F_x/(μN) and F_y/(μN) from CONTACT's limits under ξ or η alone on the circle, with so many cells and strips.
///
/// # Errors
/// A solver that did not converge.
pub fn largest_deviation(patch_nodes: usize, patch_strips: usize) -> Result<f64> {
    let rolling = Rolling::new(Parameters {
        patch_nodes,
        patch_strips,
        ..patch_cases::parameters(CIRCLE, 1)
    })?;
    let mut deviations = Deviations::default();
    for (creepages, [along, across, _]) in points() {
        deviations.take(rolling.shares(creepages)?, [along, across, None]);
    }
    Ok(deviations.0.into_iter().fold(0.0, larger))
}

/// Largest deviation of F_x/(μN), F_y/(μN) and M_z/(μN √(ab)) from the limits, ξ, η and φ alone and combined on all ellipses, with so many
/// cells and strips.
///
/// # Errors
/// A solver that did not converge.
pub fn largest_deviations(patch_nodes: usize, patch_strips: usize) -> Result<[f64; 3]> {
    let mut deviations = Deviations::default();
    for ellipse in 0..3 {
        let rolling = Rolling::new(Parameters {
            patch_nodes,
            patch_strips,
            ..patch_cases::parameters(ellipse, 1)
        })?;
        let axis = patch_cases::mean_axis(rolling.parameters());
        for limit in LIMITS.iter().filter(|limit| limit.ellipse == ellipse) {
            let [longitudinal, lateral, spin] = limit.creepages;
            let shares = rolling.shares([longitudinal, lateral, spin / axis])?;
            deviations.take(shares, limit.forces.map(Some));
        }
        if ellipse == CIRCLE {
            for (creepages, expected) in points() {
                deviations.take(rolling.shares(creepages)?, expected);
            }
        }
    }
    Ok(deviations.0)
}

/// CONTACT's own, at n = 40.
pub fn largest_deviation_of_contact() -> f64 {
    let points = LONGITUDINAL.iter().chain(&LATERAL);
    points
        .map(|point| (point.coarse - point.limit()).abs())
        .fold(0.0, f64::max)
}

/// F_x over ξ, F_y over η and M_z over η on the circle, the creepages as in `points`: which force (0 to 2), creepage, share,
/// CONTACT's.
///
/// # Errors
/// A solver that did not converge.
pub fn curve() -> Result<Vec<Vec<f64>>> {
    let rolling = Rolling::new(patch_cases::parameters(CIRCLE, 1))?;
    let mut curve = Vec::new();
    for (creepages, expected) in points() {
        let shares = rolling.shares(creepages)?;
        let creepage = creepages[0] + creepages[1];
        for (force, expected) in expected.into_iter().enumerate() {
            if let Some(expected) = expected {
                curve.push(vec![force as f64, creepage, shares[force].abs(), expected.abs()]);
            }
        }
    }
    Ok(curve)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{INTEGER_PARAMETERS, PatchGrid};

    /// Descriptions of cells and strips name each grid with its error: rounded to the last digit that stands there.
    #[test]
    fn errors_of_the_grids_are_those_of_their_descriptions() {
        for grid in PatchGrid::ALL {
            let (nodes, strips) = (grid.nodes(), grid.strips());
            let error = largest_deviations(nodes, strips).unwrap().into_iter().fold(0.0, larger);
            println!("{}: {error}", grid.name());
            for (parameter, cells) in [
                ("patch_nodes", format!("{nodes} x {strips}")),
                ("patch_strips", strips.to_string()),
            ] {
                let row = INTEGER_PARAMETERS.iter().find(|row| row.name == parameter).unwrap();
                let before = format!("{} {cells} (error ", grid.name());
                let (_, rest) = row
                    .description
                    .split_once(&before)
                    .unwrap_or_else(|| panic!("{parameter} lacks {before}"));
                let (said, _) = rest.split_once(',').unwrap();
                let digits = said.len() - "0.".len();
                assert_eq!(format!("{error:.digits$}"), said, "{parameter}, {}", grid.name());
            }
        }
    }
}
