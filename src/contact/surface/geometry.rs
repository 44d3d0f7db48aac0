//! Position and motion of the wheelset over the rail, and what the cells of a window see of them.

use super::interpolation::{Interpolation, NODES, SPACING};
use super::operators::SurfaceOperators;
use super::windows::Place;
use crate::body::grid::Grid;
use crate::contact::patch::undeformed::Undeformed;
use crate::geometry::rail::PlacedRail;
use crate::geometry::unrolled::{Distance, PlacedWheel, RailPoint, WheelsetMotion, WheelsetPosition};
use crate::signals::Inputs;

/// Distance that is added where another window has the surface, and beyond the places where contacts are sought, `m`: far more than any approach.
pub const ELSEWHERE: f64 = 1e-2;
/// Largest curvature along the rail with which the wheel bulges towards it between two nodes, `1/m`: that of the smallest wheel is 3 or 4. A worn wheel may have grooves with steep
/// walls, of which slope and curvature at a node say nothing of what lies between.
const LARGEST_CURVATURE: f64 = 20.0;

/// Position of the wheelset but for the height of its middle, and its motion, both relative to the rail; of one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position relative to the rail; the height is that of the inputs.
    pub position: WheelsetPosition,
    /// Motion relative to the rail.
    pub motion: WheelsetMotion,
}

impl Pose {
    /// Pose that the inputs define, or its change with that of the inputs.
    pub fn new(operators: &SurfaceOperators, inputs: &Inputs, radius: f64) -> Pose {
        let side = operators.side;
        let top = operators.bodies.rail.top();
        // The rail is rolled about its top. The way from there to the axle's middle is made of one across the rolled rail and one along the vertical of the track: a wheel
        // that rises under its load changes the second alone.
        let rail_roll = side * inputs.rail_roll_angle;
        let (sine, cosine) = rail_roll.sin_cos();
        let lateral = side * (inputs.lateral_displacement - inputs.rail_lateral_displacement) - top;
        let height = radius + inputs.vertical_displacement - inputs.rail_vertical_displacement;
        Pose {
            position: WheelsetPosition {
                lateral: top + lateral / cosine,
                height: height - lateral * sine / cosine,
                roll: side * inputs.roll_angle,
                yaw: side * inputs.yaw_angle,
                rail_roll,
            },
            motion: WheelsetMotion {
                velocity: {
                    let across = side * (inputs.lateral_speed - inputs.rail_lateral_speed);
                    let up = inputs.vertical_speed - inputs.rail_vertical_speed;
                    [
                        inputs.vehicle_speed,
                        cosine * across + sine * up,
                        cosine * up - sine * across,
                    ]
                },
                roll_rate: side * inputs.roll_rate,
                yaw_rate: side * inputs.yaw_rate,
                spin: inputs.wheel_speed,
            },
        }
    }

    /// Direction of the track's vertical in the rail's axes, lateral and upward.
    pub fn vertical(&self) -> [f64; 2] {
        let (sine, cosine) = self.position.rail_roll.sin_cos();
        [sine, cosine]
    }

    /// Change of [`Pose::vertical`] with the roll of the rail.
    pub fn vertical_change(&self, rail_roll: f64) -> [f64; 2] {
        let [sine, cosine] = self.vertical();
        [cosine * rail_roll, -sine * rail_roll]
    }

    /// Change of the pose of the given inputs with a change of them.
    pub fn change(&self, operators: &SurfaceOperators, inputs: &Inputs, change: &Inputs) -> Pose {
        let side = operators.side;
        let top = operators.bodies.rail.top();
        let (sine, cosine) = self.position.rail_roll.sin_cos();
        let rail_roll = side * change.rail_roll_angle;
        let lateral = side * (inputs.lateral_displacement - inputs.rail_lateral_displacement) - top;
        let lateral_change = side * (change.lateral_displacement - change.rail_lateral_displacement);
        let height_change = change.vertical_displacement - change.rail_vertical_displacement;
        let across = side * (inputs.lateral_speed - inputs.rail_lateral_speed);
        let up = inputs.vertical_speed - inputs.rail_vertical_speed;
        let across_change = side * (change.lateral_speed - change.rail_lateral_speed);
        let up_change = change.vertical_speed - change.rail_vertical_speed;
        let velocity = [
            cosine * across_change + sine * up_change + (cosine * up - sine * across) * rail_roll,
            cosine * up_change - sine * across_change - (cosine * across + sine * up) * rail_roll,
        ];
        Pose {
            position: WheelsetPosition {
                lateral: (lateral_change + lateral * sine / cosine * rail_roll) / cosine,
                height: height_change - (lateral_change * sine + lateral / cosine * rail_roll) / cosine,
                roll: side * change.roll_angle,
                yaw: side * change.yaw_angle,
                rail_roll,
            },
            motion: WheelsetMotion {
                velocity: [change.vehicle_speed, velocity[0], velocity[1]],
                roll_rate: side * change.roll_rate,
                yaw_rate: side * change.yaw_rate,
                spin: change.wheel_speed,
            },
        }
    }

    /// Change of the pose of a wheel that is lowered by an approach, `m`.
    pub fn lowered(approach: f64) -> Pose {
        Pose {
            position: WheelsetPosition {
                height: -approach,
                ..WheelsetPosition::default()
            },
            motion: WheelsetMotion::default(),
        }
    }

    /// Position with the axle's middle at another height.
    pub fn at_height(&self, height: f64) -> WheelsetPosition {
        WheelsetPosition {
            height,
            ..self.position
        }
    }
}

/// View that the cells of a window have of wheel and rail.
pub struct WindowGeometry {
    /// Surface of the rail in the middle of the strips.
    points: Vec<RailPoint>,
    /// Wheel over the nodes of the strips.
    nodes: Vec<[Distance; NODES]>,
    /// Change of the distance with the height of the axle's middle, on the grid.
    pub rise: Vec<f64>,
    /// Rigid slip over the nodes of the strips, `m/s`.
    slips: Vec<NodeSlips>,
    /// Change of the rigid slip with the height of the axle's middle, `1/s`: where the rail is steep, the wheel's material over a point of the rail then is
    /// another one.
    slip_rises: Vec<NodeSlips>,
}

/// Rigid slip along and across over the nodes of a strip, or a change of it.
type NodeSlips = [[f64; NODES]; 2];

impl WindowGeometry {
    /// Buffers for a window.
    pub fn new(operators: &SurfaceOperators) -> WindowGeometry {
        let grid = operators.sizes.largest;
        WindowGeometry {
            points: vec![RailPoint::default(); grid.strips],
            nodes: vec![[Distance::default(); NODES]; grid.strips],
            rise: vec![0.0; grid.len()],
            slips: vec![[[0.0; NODES]; 2]; grid.strips],
            slip_rises: vec![[[0.0; NODES]; 2]; grid.strips],
        }
    }

    /// Sets the geometry to that of a wheel in its position, and with it gap and rigid slip of the undeformed bodies. The surface
    /// outside of the given arc lengths is another window's.
    pub fn set(
        &mut self,
        operators: &SurfaceOperators,
        (rail, wheel): (&PlacedRail, &PlacedWheel),
        place: &Place,
        motion: &WheelsetMotion,
        own: [f64; 2],
        undeformed: &mut Undeformed,
    ) {
        let window = operators.of(place);
        let (grid, scale) = (&window.grid, window.scales.displacement);
        let (middle, half) = (place.middle_along(grid), grid.half_length());
        let interpolation = &operators.along;
        let bulge = LARGEST_CURVATURE * (half * SPACING).powi(2) / 8.0;
        let up = WheelsetPosition {
            height: 1.0,
            ..WheelsetPosition::default()
        };
        let [first, last] = rail.range();
        let mut first_guess = 0.0;
        for strip in 0..grid.strips {
            let arc = place.arc(grid, strip);
            let on_head = (first..=last).contains(&arc);
            let elsewhere = if on_head && own[0] <= arc && arc < own[1] {
                0.0
            } else {
                ELSEWHERE
            };
            let point = rail.at(arc);
            let tangent = point.tangent();
            let mut last: Option<(f64, Distance)> = None;
            let found = interpolation.nodes.map(|node| {
                let along = middle + half * node;
                let guess = last.map_or(first_guess, |(before, at)| as_guess(at.farther_along(along - before)));
                let at = wheel.distance(along, &point, guess);
                last = Some((along, at));
                at
            });
            first_guess = as_guess(found[0].distance);
            let rises = found.map(|at| wheel.distance_change(&at, &up));
            // dh/dx = −g_x/(g·n).
            let jets = found.map(|at| [at.distance, -half * at.gradient[0], half * half * at.curvature_along]);
            let cells = interpolation.cells.iter().zip(&interpolation.spans);
            for (at, (near, span)) in grid.row(strip).zip(cells) {
                self.rise[at] = near.of(&rises);
                undeformed.gap[at] = (span.of(&jets, bulge) + elsewhere) / scale;
            }
            self.slips[strip] = slips_of(tangent, &found.map(|at| wheel.velocity(&at, motion)));
            let still = WheelsetMotion::default();
            let velocity_rises = found.map(|at| wheel.velocity_change(&at, &point, motion, (&up, &still)));
            self.slip_rises[strip] = slips_of(tangent, &velocity_rises);
            set_slip(grid, strip, motion, interpolation, &self.slips[strip], undeformed);
            self.points[strip] = point;
            self.nodes[strip] = found;
        }
    }

    /// Surface of the rail in the middle of the strips.
    pub fn points(&self) -> &[RailPoint] {
        &self.points
    }

    /// Takes what another one has found.
    pub fn copy_from(&mut self, other: &WindowGeometry) {
        self.points.copy_from_slice(&other.points);
        self.nodes.copy_from_slice(&other.nodes);
        self.rise.copy_from_slice(&other.rise);
        self.slips.copy_from_slice(&other.slips);
        self.slip_rises.copy_from_slice(&other.slip_rises);
    }

    /// Sets the rigid slip to that of a wheel that stands higher by `rise` `m` than in the position of the geometry.
    pub fn raise_slip(
        &self,
        operators: &SurfaceOperators,
        place: &Place,
        motion: &WheelsetMotion,
        rise: f64,
        undeformed: &mut Undeformed,
    ) {
        let grid = &operators.of(place).grid;
        for (strip, (slips, rises)) in self.slips.iter().zip(&self.slip_rises).enumerate() {
            let raised = [0, 1].map(|component: usize| {
                std::array::from_fn(|node| slips[component][node] + rise * rises[component][node])
            });
            set_slip(grid, strip, motion, &operators.along, &raised, undeformed);
        }
    }

    /// Sets the change of gap and rigid slip with a change of the pose.
    pub fn set_change(
        &self,
        operators: &SurfaceOperators,
        place: &Place,
        wheel: &PlacedWheel,
        (pose, change): (&Pose, &Pose),
        undeformed: &mut Undeformed,
    ) {
        let window = operators.of(place);
        let (grid, scale) = (&window.grid, window.scales.displacement);
        let interpolation = &operators.along;
        let both = (&change.position, &change.motion);
        for (strip, (point, nodes)) in self.points.iter().zip(&self.nodes).enumerate() {
            let distances = nodes.map(|at| wheel.distance_change(&at, &change.position));
            for (at, near) in grid.row(strip).zip(&interpolation.cells) {
                undeformed.gap[at] = near.of(&distances) / scale;
            }
            let velocities = nodes.map(|at| wheel.velocity_change(&at, point, &pose.motion, both));
            let slips = slips_of(point.tangent(), &velocities);
            set_slip(grid, strip, &pose.motion, interpolation, &slips, undeformed);
        }
    }
}

/// Rigid slip over the nodes of a strip, or its change: that of the rail relative to the wheel's material, whose velocity is given.
fn slips_of(tangent: [f64; 2], velocities: &[[f64; 3]; NODES]) -> NodeSlips {
    [
        velocities.map(|[x, ..]| -x),
        velocities.map(|[_, y, z]| -(y * tangent[0] + z * tangent[1])),
    ]
}

/// A distance as the guess of the next one, unless it is large. Where a line along the normal misses the wheel, what is found lies anywhere, and from there the wheel over the
/// next strip would not be found either.
fn as_guess(distance: f64) -> f64 {
    if distance.abs() < ELSEWHERE { distance } else { 0.0 }
}

/// Sets the rigid slip of a strip, or its change, half way from each cell to the one ahead of it, from that over the nodes.
fn set_slip(
    grid: &Grid,
    strip: usize,
    motion: &WheelsetMotion,
    interpolation: &Interpolation,
    slips: &NodeSlips,
    undeformed: &mut Undeformed,
) {
    // The cell ahead is the next one for V ≥ 0, else the one before.
    let behind = usize::from(motion.velocity[0] < 0.0);
    for (cell, near) in interpolation.ends.iter().enumerate() {
        let at = grid.place(strip, cell + behind);
        for (component, slips) in slips.iter().enumerate() {
            undeformed.rigid_slip[component][at] = near.of(slips);
        }
    }
}
