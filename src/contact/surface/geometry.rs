//! Position and motion of the wheelset over the rail, and what the cells of a window see of them.

use super::operators::SurfaceOperators;
use super::windows::Place;
use crate::contact::patch::undeformed::Undeformed;
use crate::geometry::unrolled::{Distance, PlacedWheel, RailPoint, WheelsetMotion, WheelsetPosition};
use crate::parameters::Parameters;
use crate::signals::Inputs;

/// Distance that is added where another window has the surface, `m`: far more than any approach.
const ELSEWHERE: f64 = 1e-2;

/// Position of the wheelset but for the height of its middle, and its motion, both relative to the rail; of one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position relative to the rail; the height is that of the inputs.
    pub position: WheelsetPosition,
    /// Motion relative to the rail.
    pub motion: WheelsetMotion,
    /// Roll of the rail, by which the forces are turned back.
    pub rail_roll: f64,
}

impl Pose {
    /// Pose that the inputs define, or its change with that of the inputs.
    pub fn new(operators: &SurfaceOperators, inputs: &Inputs, radius: f64) -> Pose {
        let side = operators.side;
        let top = operators.rail.top();
        // About the rail's top, the axle's middle is turned back by the roll of the rail.
        let rail_roll = side * inputs.rail_roll_angle;
        let (sine, cosine) = rail_roll.sin_cos();
        let lateral = side * (inputs.lateral_displacement - inputs.rail_lateral_displacement) - top;
        let height = radius + inputs.vertical_displacement - inputs.rail_vertical_displacement;
        Pose {
            position: WheelsetPosition {
                lateral: top + cosine * lateral + sine * height,
                height: cosine * height - sine * lateral,
                roll: side * inputs.roll_angle - rail_roll,
                yaw: side * inputs.yaw_angle,
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
            rail_roll,
        }
    }

    /// Change of the pose of the given inputs with a change of them.
    pub fn change(
        &self,
        operators: &SurfaceOperators,
        inputs: &Inputs,
        change: &Inputs,
        parameters: &Parameters,
    ) -> Pose {
        let side = operators.side;
        let top = operators.rail.top();
        let (sine, cosine) = self.rail_roll.sin_cos();
        let rail_roll = side * change.rail_roll_angle;
        let lateral = side * (inputs.lateral_displacement - inputs.rail_lateral_displacement) - top;
        let height = parameters.wheel_radius + inputs.vertical_displacement - inputs.rail_vertical_displacement;
        let across = side * (inputs.lateral_speed - inputs.rail_lateral_speed);
        let up = inputs.vertical_speed - inputs.rail_vertical_speed;
        let turned = |[y, z]: [f64; 2], [dy, dz]: [f64; 2]| {
            [
                cosine * dy + sine * dz + (cosine * z - sine * y) * rail_roll,
                cosine * dz - sine * dy - (cosine * y + sine * z) * rail_roll,
            ]
        };
        let place = turned(
            [lateral, height],
            [
                side * (change.lateral_displacement - change.rail_lateral_displacement),
                change.vertical_displacement - change.rail_vertical_displacement,
            ],
        );
        let velocity = turned(
            [across, up],
            [
                side * (change.lateral_speed - change.rail_lateral_speed),
                change.vertical_speed - change.rail_vertical_speed,
            ],
        );
        Pose {
            position: WheelsetPosition {
                lateral: place[0],
                height: place[1],
                roll: side * change.roll_angle - rail_roll,
                yaw: side * change.yaw_angle,
            },
            motion: WheelsetMotion {
                velocity: [change.vehicle_speed, velocity[0], velocity[1]],
                roll_rate: side * change.roll_rate,
                yaw_rate: side * change.yaw_rate,
                spin: change.wheel_speed,
            },
            rail_roll,
        }
    }

    /// The same with the axle's middle at another height.
    pub fn at_height(&self, height: f64) -> WheelsetPosition {
        WheelsetPosition {
            height,
            ..self.position
        }
    }
}

/// What the cells of a window see of wheel and rail.
pub struct WindowGeometry {
    /// Surface of the rail in the middle of the strips.
    pub points: Vec<RailPoint>,
    /// Wheel over the cells, on the grid.
    pub distances: Vec<Distance>,
    /// Change of the distance with the height of the axle's middle, on the grid.
    pub rise: Vec<f64>,
}

impl WindowGeometry {
    /// Buffers for a window.
    pub fn new(operators: &SurfaceOperators) -> WindowGeometry {
        let grid = operators.sizes.largest;
        WindowGeometry {
            points: vec![RailPoint::default(); grid.strips],
            distances: vec![Distance::default(); grid.len()],
            rise: vec![0.0; grid.len()],
        }
    }

    /// Sets the geometry to that of a wheel in its position, and with it gap and rigid slip of the undeformed bodies. The surface
    /// outside of the given arc lengths is another window's.
    pub fn set(
        &mut self,
        operators: &SurfaceOperators,
        place: &Place,
        wheel: &PlacedWheel,
        motion: &WheelsetMotion,
        own: [f64; 2],
        undeformed: &mut Undeformed,
    ) {
        let window = operators.of(place);
        let (grid, scale) = (&window.grid, window.scales.displacement);
        let middle = place.middle_along(grid);
        let up = WheelsetPosition {
            height: 1.0,
            ..WheelsetPosition::default()
        };
        let mut first_guess = 0.0;
        for strip in 0..grid.strips {
            let arc = place.arc(grid, strip);
            let elsewhere = if own[0] <= arc && arc < own[1] { 0.0 } else { ELSEWHERE };
            let point = operators.rail.at(arc);
            self.points[strip] = point;
            let mut guess = first_guess;
            for (cell, at) in grid.row(strip).enumerate() {
                let distance = wheel.distance(middle + grid.x(cell), &point, guess);
                guess = distance.distance;
                if cell == 0 {
                    first_guess = guess;
                }
                self.distances[at] = distance;
                self.rise[at] = wheel.distance_change(&distance, &up);
                undeformed.gap[at] = (distance.distance + elsewhere) / scale;
            }
        }
        self.set_slip(operators, place, wheel, motion, undeformed);
    }

    /// Sets the rigid slip half way between the cells.
    fn set_slip(
        &self,
        operators: &SurfaceOperators,
        place: &Place,
        wheel: &PlacedWheel,
        motion: &WheelsetMotion,
        undeformed: &mut Undeformed,
    ) {
        let grid = &operators.of(place).grid;
        let forward = motion.velocity[0] >= 0.0;
        for strip in 0..grid.strips {
            let tangent = self.points[strip].tangent();
            let slip = |at: usize| {
                let [x, y, z] = wheel.velocity(&self.distances[at], motion);
                [-x, -(y * tangent[0] + z * tangent[1])]
            };
            let row = grid.row(strip);
            let mut before = slip(row.start);
            for at in row.start + 1..row.end {
                let here = slip(at);
                let to = if forward { at - 1 } else { at };
                for component in 0..2 {
                    undeformed.rigid_slip[component][to] = 0.5 * (before[component] + here[component]);
                }
                before = here;
            }
        }
    }

    /// Takes what another one has found.
    pub fn copy_from(&mut self, other: &WindowGeometry) {
        self.points.copy_from_slice(&other.points);
        self.distances.copy_from_slice(&other.distances);
        self.rise.copy_from_slice(&other.rise);
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
        let forward = pose.motion.velocity[0] >= 0.0;
        let both = (&change.position, &change.motion);
        for (strip, point) in self.points.iter().enumerate() {
            let tangent = point.tangent();
            let slip = |at: usize| {
                let [x, y, z] = wheel.velocity_change(&self.distances[at], point, &pose.motion, both);
                [-x, -(y * tangent[0] + z * tangent[1])]
            };
            let row = grid.row(strip);
            let mut before = slip(row.start);
            for at in row.clone() {
                undeformed.gap[at] = wheel.distance_change(&self.distances[at], &change.position) / scale;
            }
            for at in row.start + 1..row.end {
                let here = slip(at);
                let to = if forward { at - 1 } else { at };
                for component in 0..2 {
                    undeformed.rigid_slip[component][to] = 0.5 * (before[component] + here[component]);
                }
                before = here;
            }
        }
    }
}
