//! Plots of a contact of profiles: the cells of its windows and both profiles in their places in the track, and profiles along, across and below
//! the window that carries most.

use super::bodies::{RAIL, WHEEL};
use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::problem::SurfaceProblem;
use super::windows::Place;
use super::worn_bodies::WornBodies;
use crate::contact::patch;
use crate::contact::profiles::{
    ContactNode, ProfileDepths, Profiles, STRIP_POINTS, SurfaceStrip, SurfaceWindow, WornPlace, sample,
};
use crate::geometry::unrolled::PlacedWheel;

/// Place of the rail in the track, by which points over the rail in its own place are turned, mirrored and moved.
struct InTrack {
    side: f64,
    top: f64,
    sine: f64,
    cosine: f64,
    displacement: [f64; 2],
}

impl InTrack {
    fn new(problem: &SurfaceProblem) -> InTrack {
        let inputs = &problem.conditions.inputs;
        let (sine, cosine) = problem.pose().position.rail_roll.sin_cos();
        InTrack {
            side: problem.operators.side,
            top: problem.operators.bodies.rail.top(),
            sine,
            cosine,
            displacement: [inputs.rail_lateral_displacement, inputs.rail_vertical_displacement],
        }
    }

    /// Point to the left of the track's middle and above the height of the rail's top, from one of the rail's axes.
    fn point(&self, [y, z]: [f64; 2]) -> [f64; 2] {
        let outwards = self.top + self.cosine * (y - self.top) - self.sine * z;
        let up = self.sine * (y - self.top) + self.cosine * z;
        [self.side * outwards + self.displacement[0], up + self.displacement[1]]
    }
}

/// Bodies at depths of wear. Those that fold a surface have been refused by the step.
fn worn(operators: &SurfaceOperators, depths: &[Vec<f64>; 2]) -> WornBodies {
    let mut worn = WornBodies::new(operators);
    let _ = worn.set(operators, depths);
    worn
}

impl SurfaceOperators {
    /// Windows with their cells, on the rail as the step saw it: first those that carry, in the order of the contacts, then the others.
    pub fn windows(problem: &SurfaceProblem, fields: &SurfaceFields) -> Vec<SurfaceWindow> {
        windows(problem, fields)
    }

    /// Places of both profiles with the depth of the spline in the middle of their cells.
    pub fn depths(problem: &SurfaceProblem, fields: &SurfaceFields) -> ProfileDepths {
        depths(problem, fields)
    }
}

fn windows(problem: &SurfaceProblem, fields: &SurfaceFields) -> Vec<SurfaceWindow> {
    let operators = problem.operators;
    let (worn, track) = (worn(operators, &fields.worn.before), InTrack::new(problem));
    let rail = &worn.of(operators).rail;
    let mut found: Vec<(f64, SurfaceWindow)> = fields
        .used()
        .map(|(window, place)| {
            let patch = operators.of(&place);
            let (grid, middle) = (&patch.grid, place.middle_along(&patch.grid));
            let strips = (0..grid.strips).map(|strip| {
                let arc_length = place.arc(grid, strip);
                let point = rail.at(arc_length);
                SurfaceStrip {
                    arc_length,
                    in_track: track.point(point.place),
                    inclination: (-point.normal[0]).atan2(point.normal[1]) + problem.pose().position.rail_roll,
                }
            });
            let strips: Vec<SurfaceStrip> = strips.collect();
            let mut nodes = patch::profiles::contact_nodes(patch, &fields.windows[window]);
            for (number, node) in nodes.iter_mut().enumerate() {
                node.position += middle;
                node.lateral_position = strips[number / grid.cells].in_track[0];
                node.lateral_shear *= operators.side;
                node.lateral_slip *= operators.side;
            }
            let window = SurfaceWindow {
                cell_length: grid.length,
                strip_breadth: grid.breadth,
                x: (0..grid.cells).map(|cell| middle + grid.x(cell)).collect(),
                strips,
                nodes,
            };
            (resultant(&window), window)
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, window)| window).collect()
}

/// Arc length of the resultant of a window's pressure, `m`; infinite of one that carries nothing.
fn resultant(window: &SurfaceWindow) -> f64 {
    let rows = window.nodes.chunks_exact(window.x.len()).zip(&window.strips);
    let forces = rows.map(|(row, strip)| (row.iter().map(|node| node.pressure).sum::<f64>(), strip.arc_length));
    let (force, moment) = forces.fold((0.0, 0.0), |sums, (force, arc)| (sums.0 + force, sums.1 + arc * force));
    if force > 0.0 { moment / force } else { f64::INFINITY }
}

/// The fields at the cells of all windows, window by window.
pub fn contact_nodes(problem: &SurfaceProblem, fields: &SurfaceFields) -> Vec<ContactNode> {
    windows(problem, fields)
        .into_iter()
        .flat_map(|window| window.nodes)
        .collect()
}

/// Profiles of the window that carries most: along its strip that carries most, across its strips, and below its hottest cell; those of an
/// untouched rail where none carries.
pub fn profiles(problem: &SurfaceProblem, fields: &SurfaceFields) -> Profiles {
    let (operators, ambient) = (problem.operators, problem.conditions.inputs.ambient_temperature);
    let strip_force = |window: usize, place: &Place, strip: usize| -> f64 {
        let grid = &operators.of(place).grid;
        grid.cell_area() * fields.windows[window].pressure[grid.row(strip)].iter().sum::<f64>()
    };
    let window_force = |(window, place): &(usize, Place)| -> f64 {
        let strips = operators.of(place).grid.strips;
        (0..strips).map(|strip| strip_force(*window, place, strip)).sum()
    };
    let carrying = fields.used().filter(|window| window_force(window) > 0.0);
    let Some((window, place)) = carrying.max_by(|a, b| window_force(a).total_cmp(&window_force(b))) else {
        return Profiles::untouched(ambient);
    };
    let grid = &operators.of(&place).grid;
    let strips = 0..grid.strips;
    let force = |strip: &usize| strip_force(window, &place, *strip);
    let heaviest = strips.clone().max_by(|a, b| force(a).total_cmp(&force(b))).unwrap_or(0);
    let own = &fields.windows[window];
    let mut found = patch::profiles::profiles(&problem.of(&place), own, ambient, [heaviest; 2]);
    let middle = place.middle_along(grid);
    found.x.iter_mut().for_each(|x| *x += middle);
    let (worn, track) = (worn(operators, &fields.worn.before), InTrack::new(problem));
    let rail = &worn.of(operators).rail;
    let across: Vec<f64> = strips
        .map(|strip| track.point(rail.at(place.arc(grid, strip)).place)[0])
        .collect();
    found.strips.position = sample(&across, STRIP_POINTS);
    found
}

fn depths(problem: &SurfaceProblem, fields: &SurfaceFields) -> ProfileDepths {
    let operators = problem.operators;
    let track = InTrack::new(problem);
    let worn = worn(operators, &fields.worn.depth);
    let bodies = worn.of(operators);
    let wheel = PlacedWheel::new(&bodies.wheel, &problem.pose().at_height(problem.height(fields)));
    let [wheel, rail] = [WHEEL, RAIL].map(|body| {
        let (grid, depth) = (&operators.grids[body], &fields.worn.depth[body]);
        let place = |cell: usize| {
            let arc_length = grid.middle(cell);
            let depth = grid.at(depth, arc_length);
            let point = match body {
                WHEEL => wheel.below_axle(operators.profiles[WHEEL].worn_at(arc_length, depth).place),
                _ => bodies.rail.at(arc_length).place,
            };
            WornPlace {
                position: operators.profiles[body].at(arc_length).place[0],
                arc_length,
                depth: depth[0],
                in_track: track.point(point),
            }
        };
        (0..grid.cells).map(place).collect()
    });
    ProfileDepths { wheel, rail }
}
