use super::apart::{self, Apart, ByPressure, ByShear, Influence, Resultants};
use super::approach_response::RESPONSE_ERROR;
use super::bodies::{RAIL, WHEEL};
use super::geometry::{Pose, WindowGeometry};
use super::operators::SurfaceOperators;
use super::placement::place;
use super::pressure::hold;
use super::problem::SurfaceProblem;
use super::search::Search;
use super::solvers::SurfaceSolvers;
use super::windows::{EVERYWHERE, Place};
use super::worn_bodies::WornBodies;
use crate::body::grid::Grid;
use crate::contact::engine::Engine;
use crate::contact::fields::Fields;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::patch::undeformed::Undeformed;
use crate::contact::problem::{Coupling, Problem, StepConditions, Task};
use crate::contact::surface::fields::SurfaceFields;
use crate::contact::{ContactState, ContactWorkspace};
use crate::geometry::profile::Profile;
use crate::geometry::profile::files::Format;
use crate::geometry::profile::tests::steep_flange;
use crate::geometry::rail::PlacedRail;
use crate::geometry::unrolled::{PlacedWheel, RailPoint, WheelsetPosition};
use crate::geometry::wheelset::{Dimensions, Wheelset};
use crate::parameters::{ContactModel, Control, Parameters, ProfileContents, ProfileWear, Side, SlipSource};
use crate::settings::Settings;
use crate::signals::{INPUTS, Inputs, Outputs};
use crate::torture::random::Random;
use crate::wheel_rail::{Model, State, Workspace};
use nalgebra::Vector3;
use std::ops::Range;

pub fn parameters(control: Control) -> Parameters {
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        side: Side::Right,
        rail_profile: "UIC60".to_owned(),
        control,
        patch_nodes: 18,
        patch_strips: 11,
        depth_nodes: 13,
        ..Parameters::default()
    }
}

/// A wheelset that is displaced to the right, yawed and rolled over a rail that moves as well.
pub fn displaced(lateral: f64) -> Inputs {
    Inputs {
        wheel_speed: 20.1 / 0.46,
        vehicle_speed: 20.0,
        lateral_displacement: -lateral,
        vertical_displacement: -0.15e-3,
        roll_angle: -2e-4,
        yaw_angle: 1e-3,
        lateral_speed: 0.02,
        roll_rate: 0.01,
        yaw_rate: -0.02,
        rail_roll_angle: 1e-3,
        rail_lateral_speed: -0.01,
        ..Inputs::default()
    }
}

pub fn run(parameters: &Parameters, inputs: &Inputs, steps: usize) -> State {
    let model = Model::new(parameters.clone()).unwrap();
    let mut workspace = model.workspace();
    let mut state = model.initial_state(&mut workspace, inputs).unwrap();
    for _ in 0..steps {
        model
            .step(&mut workspace, &mut state, inputs, &Inputs::ZERO, 1e-3)
            .unwrap();
    }
    state
}

pub fn fields(state: &State) -> &SurfaceFields {
    let ContactState::Surface(own) = &state.contact else {
        panic!("another contact model");
    };
    &own.fields
}

/// Default settings, and operators and solvers with the built-in profiles.
fn built(parameters: &Parameters) -> (Settings, SurfaceOperators, SurfaceSolvers) {
    let settings = Settings::default();
    let operators = SurfaceOperators::build(parameters, &ProfileContents::default()).unwrap();
    let solvers = operators.solvers(&settings);
    (settings, operators, solvers)
}

/// Gap and rigid slip that the cells of a window see.
fn seen(operators: &SurfaceOperators, bodies: (&PlacedRail, &PlacedWheel), place: &Place, pose: &Pose) -> Undeformed {
    let mut undeformed = Undeformed::none(&operators.of(place).grid);
    WindowGeometry::new(operators).set(operators, bodies, place, &pose.motion, EVERYWHERE, &mut undeformed);
    undeformed
}

/// Gap and rigid slip of every cell change with each input as their differences do.
#[test]
fn the_change_of_the_geometry_is_its_difference() {
    let parameters = parameters(Control::Height);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    for lateral in [1e-3, 5e-3] {
        let inputs = displaced(lateral);
        let state = run(&parameters, &inputs, 0);
        for (_, place) in fields(&state).used() {
            let grid = &operators.of(&place).grid;
            let undeformed = |inputs: &Inputs| {
                let pose = Pose::new(&operators, inputs, parameters.wheel_radius);
                let wheel = PlacedWheel::new(&operators.bodies.wheel, &pose.position);
                seen(&operators, (&operators.bodies.rail, &wheel), &place, &pose)
            };
            let here = undeformed(&inputs);
            for signal in INPUTS {
                let step = 1e-4 * signal.nominal;
                let [ahead, behind] = [step, -step].map(|step| {
                    let mut moved = inputs;
                    (signal.set)(&mut moved, (signal.get)(&inputs) + step);
                    undeformed(&moved)
                });
                let mut change = Inputs::ZERO;
                (signal.set)(&mut change, 1.0);
                let pose = Pose::new(&operators, &inputs, parameters.wheel_radius);
                let change = pose.change(&operators, &inputs, &change);
                let wheel = PlacedWheel::new(&operators.bodies.wheel, &pose.position);
                let mut tangent = Undeformed::none(grid);
                let mut own = WindowGeometry::new(&operators);
                own.set(
                    &operators,
                    (&operators.bodies.rail, &wheel),
                    &place,
                    &pose.motion,
                    EVERYWHERE,
                    &mut tangent,
                );
                own.set_change(&operators, &place, &wheel, (&pose, &change), &mut tangent);
                let rows: [fn(&Undeformed) -> &Vec<f64>; 3] = [|u| &u.gap, |u| &u.rigid_slip[0], |u| &u.rigid_slip[1]];
                for (number, row) in rows.into_iter().enumerate() {
                    let size = row(&tangent)
                        .iter()
                        .fold(1e-3, |size: f64, value| size.max(value.abs()));
                    let ends = row(&ahead).iter().zip(row(&behind)).zip(row(&tangent));
                    for (((ahead, behind), tangent), gap) in ends.zip(&here.gap) {
                        // Far from the wheel a steep rail bends what is interpolated.
                        if *gap > 1.0 {
                            continue;
                        }
                        let difference = (ahead - behind) / (2.0 * step);
                        // The third derivative over the step's square, round-off over the step, and that the gap is interpolated between two nodes, its
                        // change between all.
                        assert!(
                            (difference - tangent).abs() < 1e-4 * size,
                            "{} {number}: {difference:e} {tangent:e}",
                            signal.name
                        );
                    }
                }
            }
        }
    }
}

/// The gap of the cells is interpolated between the places along each strip at which the wheel is looked at, to 1e-9 of the approach: what is left are the
/// jumps of the profile's curvature, which a yawed wheel passes by.
#[test]
fn the_gap_is_that_of_the_wheel_over_each_cell() {
    let parameters = parameters(Control::Height);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let (mut cells, mut largest) = (0, 0f64);
    for lateral in [1e-3, 5e-3] {
        let inputs = displaced(lateral);
        let state = run(&parameters, &inputs, 0);
        let pose = Pose::new(&operators, &inputs, parameters.wheel_radius);
        let wheel = PlacedWheel::new(&operators.bodies.wheel, &pose.position);
        // The wheel's lowest place is at one of the places along the strips, or between two.
        let moved = |(_, place): (usize, Place)| {
            [0, 1, 2, 3, 4].map(|cells| Place {
                cell: place.cell + cells,
                ..place
            })
        };
        for place in fields(&state).used().flat_map(moved) {
            let window = operators.of(&place);
            let (grid, scale) = (&window.grid, window.scales.displacement);
            let rail = &operators.bodies.rail;
            let undeformed = seen(&operators, (rail, &wheel), &place, &pose);
            for strip in 0..grid.strips {
                let point = rail.at(place.arc(grid, strip));
                for (cell, at) in grid.row(strip).enumerate() {
                    let gap = undeformed.gap[at];
                    if gap.abs() < 1.0 {
                        let along = place.middle_along(grid) + grid.x(cell);
                        let distance = wheel.distance(along, &point, 0.0).distance;
                        largest = largest.max((gap - distance / scale).abs());
                        cells += 1;
                    }
                }
            }
        }
    }
    assert!(cells > 100);
    assert!(largest < 1e-9, "{largest:e}");
}

/// The wheelset as a whole is turned back by the roll of the rail: roll and yaw by which its axle points the same way make the same wheel over the rail.
#[test]
fn a_rail_that_rolls_sees_the_wheelset_turned_back() {
    let parameters = parameters(Control::Load);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let bodies = &operators.bodies;
    let (roll, yaw, rail_roll) = (0.01_f64, 0.04_f64, 0.03_f64);
    // Direction of the axle in the track, then in the rail's axes.
    let axle = [-yaw.sin() * roll.cos(), yaw.cos() * roll.cos(), roll.sin()];
    let turned = [
        rail_roll.cos() * axle[1] + rail_roll.sin() * axle[2],
        rail_roll.cos() * axle[2] - rail_roll.sin() * axle[1],
    ];
    let position = WheelsetPosition {
        lateral: 1e-3,
        height: parameters.wheel_radius + 0.02,
        ..WheelsetPosition::default()
    };
    // The same place by the height along the track's vertical.
    let rolled = WheelsetPosition {
        lateral: position.lateral - position.height * rail_roll.tan(),
        height: position.height / rail_roll.cos(),
        roll,
        yaw,
        rail_roll,
    };
    let same = WheelsetPosition {
        roll: turned[1].asin(),
        yaw: (-axle[0]).atan2(turned[0]),
        ..position
    };
    let motion = crate::geometry::unrolled::WheelsetMotion {
        velocity: [20.0, 0.1, -0.05],
        spin: 44.0,
        ..Default::default()
    };
    let [rolled, same] = [rolled, same].map(|position| PlacedWheel::new(&bodies.wheel, &position));
    let middle = 0.5 * (bodies.rail.range()[0] + bodies.rail.range()[1]);
    for (along, across) in [(0.0, 0.0), (3e-3, 5e-3), (-4e-3, -8e-3)] {
        let point = bodies.rail.at(middle + across);
        let [a, b] = [&rolled, &same].map(|wheel| (wheel, wheel.distance(along, &point, 0.0)));
        assert!((a.1.distance - b.1.distance).abs() < 1e-12);
        let [a, b] = [a, b].map(|(wheel, at)| wheel.velocity(&at, &motion));
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-10), "{a:?} {b:?}");
    }
}

/// Forces and moments are the same, to the round-off of places over the stiffness of the contact.
fn agree(one: &Outputs, other: &Outputs) {
    assert!(one.force_y.abs() > 100.0);
    for (name, one, other) in [
        ("force_x", one.force_x, other.force_x),
        ("force_y", one.force_y, other.force_y),
        ("force_z", one.force_z, other.force_z),
        ("moment_x", one.moment_x, other.moment_x),
        ("moment_y", one.moment_y, other.moment_y),
        ("moment_z", one.moment_z, other.moment_z),
    ] {
        assert!((one - other).abs() < 1e-9 * 50e3, "{name}: {one} {other}");
    }
}

/// A rail that is rolled about its top is one that is inclined by as much more, where that puts the same places of the profile: it makes the same forces and moments.
#[test]
fn a_rolled_rail_is_one_that_is_inclined_more() {
    let roll = 0.01_f64;
    for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
        let upright = Parameters {
            side,
            ..parameters(Control::Load)
        };
        let inclined = Parameters {
            rail_inclination: (upright.rail_inclination.atan() + roll).tan(),
            ..upright.clone()
        };
        let [rolls, leans] = [&upright, &inclined].map(|parameters| {
            let operators = SurfaceOperators::build(parameters, &ProfileContents::default()).unwrap();
            operators.bodies.rail.clone()
        });
        // One place of the profile in the track, of the rolled rail and of the inclined one.
        let arc = rolls.range()[0] + 0.03;
        let ([y, z], [there_y, there_z]) = (rolls.at(arc).place, leans.at(arc).place);
        let y = y - rolls.top();
        let turned = [
            rolls.top() + roll.cos() * y - roll.sin() * z,
            roll.sin() * y + roll.cos() * z,
        ];
        for lateral in [1e-3, 4.5e-3, 6.4e-3] {
            let rolled = Inputs {
                normal_load: 50e3,
                wheel_speed: 20.1 / 0.46,
                vehicle_speed: 20.0,
                lateral_displacement: sign * lateral,
                yaw_angle: 2e-3,
                lateral_speed: 0.02,
                roll_rate: 0.02,
                vertical_speed: 0.01,
                rail_roll_angle: sign * roll,
                ..Inputs::default()
            };
            let leaning = Inputs {
                rail_roll_angle: 0.0,
                rail_lateral_displacement: sign * (turned[0] - there_y),
                rail_vertical_displacement: turned[1] - there_z,
                ..rolled
            };
            // Under the load, and at the height that carries about as much.
            let [one, other] = [(&upright, &rolled), (&inclined, &leaning)]
                .map(|(parameters, inputs)| run(parameters, inputs, 2).outputs);
            agree(&one, &other);
            let given = |parameters: &Parameters| Parameters {
                control: Control::Height,
                ..parameters.clone()
            };
            let (upright, inclined) = (given(&upright), given(&inclined));
            let model = Model::new(upright.clone()).unwrap();
            let mut workspace = model.workspace();
            let at = |inputs: &Inputs, vertical_displacement: f64| Inputs {
                vertical_displacement,
                ..*inputs
            };
            let (mut low, mut high) = (-10e-3, 10e-3);
            for _ in 0..25 {
                let middle = 0.5 * (low + high);
                let state = model.initial_state(&mut workspace, &at(&rolled, middle));
                let carries = state.map_or(true, |state| state.outputs.force_z > rolled.normal_load);
                *(if carries { &mut low } else { &mut high }) = middle;
            }
            let [one, other] = [(&upright, &rolled), (&inclined, &leaning)]
                .map(|(parameters, inputs)| run(parameters, &at(inputs, high), 2).outputs);
            assert!((one.force_z / rolled.normal_load - 1.0).abs() < 0.1);
            agree(&one, &other);
        }
    }
}

/// A distance is guessed from slope and curvature of the one beside it: what is missing is of third order.
#[test]
fn a_distance_is_guessed_from_the_one_beside_it() {
    let parameters = parameters(Control::Height);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let (mut points, mut largest, mut least) = (0, 0.0_f64, f64::INFINITY);
    for lateral in [1e-3, 5e-3] {
        let inputs = displaced(lateral);
        let state = run(&parameters, &inputs, 0);
        let pose = Pose::new(&operators, &inputs, parameters.wheel_radius);
        let wheel = PlacedWheel::new(&operators.bodies.wheel, &pose.position);
        for (_, place) in fields(&state).used() {
            let grid = &operators.of(&place).grid;
            let middle = place.middle_along(grid);
            let point = operators.bodies.rail.at(place.arc(grid, grid.strips / 2));
            for along in [middle - 3e-3, middle, middle + 3e-3] {
                let here = wheel.distance(along, &point, 0.0);
                for way in [-1e-3, 1e-3] {
                    let beside = wheel.distance(along + way, &point, 0.0).distance;
                    largest = largest.max((here.farther_along(way) - beside).abs());
                    least = least.min((beside - here.distance).abs());
                    points += 1;
                }
            }
        }
    }
    assert!(points > 0, "{points}");
    // A millimetre squared over twice the wheel's radius is 1e-6 m; cubed, over the square of the wheel's radius, 5e-9 m.
    assert!(least > 1e-7, "{points} {least:e} {largest:e}");
    assert!(largest < 5e-9, "{points} {least:e} {largest:e}");
}

/// A wheel that is worn, cell by cell, between two positions on its profile, `m`.
fn worn_wheel(operators: &SurfaceOperators, between: Range<f64>, mut depth_of: impl FnMut(usize) -> f64) -> WornBodies {
    let mut worn = WornBodies::new(operators);
    let mut depths = [WHEEL, RAIL].map(|body| vec![0.0; operators.wear_cells(body)]);
    let grid = operators.grids[WHEEL];
    for (cell, depth) in depths[WHEEL].iter_mut().enumerate() {
        let position = operators.profiles[WHEEL].at(grid.middle(cell)).place[0];
        if between.contains(&position) {
            *depth = depth_of(cell);
        }
    }
    worn.set(operators, &depths).unwrap();
    worn
}

/// The wheel with worn grooves, along lines that cross them and from guesses on either side: a point on its surface is found where the line goes into it.
#[test]
fn the_wheel_is_found_between_the_walls_of_its_grooves() {
    let parameters = Parameters {
        wheel_profile_wear: ProfileWear::On,
        ..parameters(Control::Load)
    };
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let worn = worn_wheel(&operators, 2e-3..12e-3, |cell| if cell % 4 < 2 { 2e-3 } else { 0.0 });
    let bodies = worn.of(&operators);
    let wheel = PlacedWheel::new(
        &bodies.wheel,
        &WheelsetPosition {
            height: parameters.wheel_radius,
            ..WheelsetPosition::default()
        },
    );
    for step in 0..400 {
        let position = 3e-3 + 8e-3 * f64::from(step) / 400.0;
        for angle in [-0.6, -0.3, 0.0, 0.3, 0.6_f64] {
            let point = RailPoint {
                place: [bodies.wheel.offset + position, -1e-3],
                normal: [angle.sin(), angle.cos()],
            };
            for guess in [-1e-3, 0.0, 1e-3, 2e-3, 3e-3, 4e-3] {
                let at = wheel.distance(1e-3, &point, guess);
                let [x, y, z] = at.arm;
                let [height, slope, _] = bodies.wheel.profile.value_slope_curvature(y - bodies.wheel.offset);
                let outside = x.hypot(z) - bodies.wheel.radius + height;
                assert!(outside.abs() < 1e-8, "{point:?}, {guess}: {outside:e}");
                let inward = slope * point.normal[0] + z / x.hypot(z) * point.normal[1];
                assert!(inward < 0.0, "{point:?}, {guess}: out of the wheel");
            }
        }
    }
}

/// A yawed wheel at the height at which it touched as new, worn since to grooves with steep walls: nothing of it is in the rail. Between the places at which the
/// cells look at it, the interpolation may see it deeper by what it may bulge, which is a hundredth of the grooves; without that limit it sees it five times as deep as
/// they are, and Newton's method alone, to and fro between the walls, by a tenth.
#[test]
fn steep_walls_of_a_worn_wheel_do_not_reach_into_the_rail() {
    const DEPTH: f64 = 5e-3;
    let parameters = Parameters {
        wheel_profile_wear: ProfileWear::On,
        ..parameters(Control::Load)
    };
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let worn = worn_wheel(&operators, 2e-3..12e-3, |cell| if cell % 4 < 2 { DEPTH } else { 0.0 });
    let bodies = worn.of(&operators);
    let mut walls = 0;
    let inputs = Inputs {
        yaw_angle: 0.02,
        normal_load: 60e3,
        ..displaced(1e-3)
    };
    let state = run(&parameters, &inputs, 0);
    let pose = Pose::new(&operators, &inputs, parameters.wheel_radius);
    let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(fields(&state).touch));
    for (_, place) in fields(&state).used() {
        let scale = operators.of(&place).scales.displacement;
        let undeformed = seen(&operators, (&bodies.rail, &wheel), &place, &pose);
        let depth = DEPTH / scale;
        walls += undeformed.gap.iter().filter(|&&gap| gap > 0.5 * depth).count();
        let deepest = undeformed.gap.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(deepest > -0.01 * depth, "{deepest}");
    }
    assert!(walls > 0);
}

/// Problem of a step under the given inputs.
pub fn problem<'a>(
    operators: &'a SurfaceOperators,
    (parameters, settings): (&'a Parameters, &'a Settings),
    inputs: Inputs,
) -> SurfaceProblem<'a> {
    let conditions = StepConditions {
        inputs,
        motion: inputs.motion(parameters),
        duration: 1e-3,
        coupling: Coupling::Implicit,
        room: 1.0,
    };
    let task = Task {
        parameters,
        settings,
        conditions,
    };
    Problem::new(operators, &task)
}

/// Force and moment on the wheelset are those of pressure and shear, cell by cell, at the wheel's undeformed surface.
#[test]
fn force_and_moment_are_those_of_the_cells() {
    let parameters = parameters(Control::Load);
    let settings = Settings::default();
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    for lateral in [1e-3, 5.4e-3, 7e-3] {
        let inputs = Inputs {
            rail_roll_angle: 0.0,
            ..displaced(lateral)
        };
        let state = run(&parameters, &inputs, 3);
        let (fields, problem) = (fields(&state), problem(&operators, (&parameters, &settings), inputs));
        let position = problem.pose().at_height(problem.height(fields));
        let wheel = PlacedWheel::new(&operators.bodies.wheel, &position);
        let [mut force, mut moment, mut from_rail] = [Vector3::zeros(); 3];
        for (window, place) in fields.used() {
            let patch = operators.of(&place);
            let (grid, unit) = (&patch.grid, PatchOperators::unit_force(patch));
            let own = &fields.windows[window];
            let cells = (0..grid.strips).flat_map(|strip| grid.row(strip).enumerate().map(move |cell| (strip, cell)));
            for (strip, (cell, node)) in cells.filter(|(_, (_, node))| own.pressure[*node] > 0.0) {
                let point = operators.bodies.rail.at(place.arc(grid, strip));
                let across_the_rail = |[y, z]: [f64; 2]| Vector3::new(0.0, y, z);
                let (normal, tangent) = (across_the_rail(point.normal), across_the_rail(point.tangent()));
                let at = wheel.distance(place.middle_along(grid) + grid.x(cell), &point, 0.0);
                let friction = -unit * (own.shear[0][node] * Vector3::x() + own.shear[1][node] * tangent);
                let all = friction + unit * own.pressure[node] * normal;
                force += all;
                moment += Vector3::from(at.arm).cross(&all);
                from_rail += (at.distance * normal).cross(&friction);
            }
        }
        // The right side is computed as the left one's mirror image.
        let outputs = &state.outputs;
        let mirrored = Vector3::new(outputs.force_x, -outputs.force_y, outputs.force_z);
        assert!((mirrored - force).norm() < 1e-12 * force.norm(), "{mirrored} {force}");
        let mirrored = Vector3::new(-outputs.moment_x, outputs.moment_y, -outputs.moment_z);
        // The model has the distance to the second order along the rail.
        let error = (mirrored - moment).norm();
        assert!(
            error < 1e-4 * from_rail.norm(),
            "{lateral}: {error} of {}",
            from_rail.norm()
        );
    }
}

/// A wheel worn as roughly as its cells are wide touches the rail between the points at which contacts are sought, and under a small load no point overlaps: the place has a window all the same.
#[test]
fn rough_bodies_have_a_window_where_they_touch_first() {
    const LOAD: f64 = 100.0;
    let parameters = Parameters {
        wheel_profile_wear: ProfileWear::On,
        ..parameters(Control::Load)
    };
    let (settings, operators, mut solvers) = built(&parameters);
    let mut random = Random::new(1, 0);
    solvers.worn = worn_wheel(&operators, -30e-3..30e-3, |_| random.between(0.0, 3e-4));
    // The load was carried at next to no approach, and elsewhere.
    let mut before = SurfaceFields::new(&operators);
    (before.load, before.approach[0]) = (LOAD, 1e-6);
    for step in 0..40 {
        let inputs = Inputs {
            normal_load: LOAD,
            ..displaced(1e-4 * f64::from(step))
        };
        let problem = problem(&operators, (&parameters, &settings), inputs);
        let mut now = SurfaceFields::new(&operators);
        place(&problem, Some(&before), None, &mut now, &mut solvers).unwrap();
        let first = solvers.search.first_place().unwrap();
        let grid = |place: &Place| operators.sizes.grid(place.length, place.breadth);
        let holds = |place: &Place| place.region(&grid(place)).holds(first);
        assert!(now.used().any(|(_, place)| holds(&place)), "{step}: {first:?}");
    }
}

/// The height at which a wheel with a steep flange touches is the same one from centimetres below, where the wheel is closest at the end of the rail's points,
/// and from centimetres above, where lines along the rail's normals graze the wheel. A level wheelset has it where the silhouettes of wheel and rail have it:
/// the other wheel stands on its flat tread.
#[test]
fn the_height_of_a_steep_flange_is_found_from_far() {
    let rail = Profile::built_in("UIC60").unwrap();
    for degrees in [70.0, 76.0, 80.0] {
        let wheel = steep_flange(degrees);
        let parameters = Parameters {
            wheel_profile: "steep.prw".to_owned(),
            ..parameters(Control::Load)
        };
        let contents = ProfileContents {
            wheel: Some(wheel.text(Format::Simpack).into()),
            rail: None,
        };
        let operators = SurfaceOperators::build(&parameters, &contents).unwrap();
        let bodies = &operators.bodies;
        let mut search = Search::new(bodies);
        let wheelset = Wheelset::new([&rail; 2], [&wheel; 2], &Dimensions::default()).unwrap();
        let wheelset = wheelset.level();
        for (step, roll) in (0..60).flat_map(|step| [-0.01, 0.0, 0.006].map(|roll| (step, roll))) {
            let lateral = -2e-4 * f64::from(step);
            let inputs = Inputs {
                lateral_displacement: lateral,
                roll_angle: roll,
                ..Inputs::default()
            };
            let pose = Pose::new(&operators, &inputs, parameters.wheel_radius);
            let [first, rest @ ..] = [-0.02, -0.004, 0.0, 0.004, 0.02].map(|way| {
                let height = search.touch(bodies, &pose.position, parameters.wheel_radius + way);
                assert!(search.touches(), "{degrees} degrees, {lateral} m, {roll}, from {way} m");
                height
            });
            for height in rest {
                assert!(
                    (height - first).abs() < 1e-9,
                    "{degrees} degrees, {lateral} m, {roll}: {height}, {first}"
                );
            }
            if roll == 0.0 {
                let risen = 2.0 * wheelset.at(lateral, 0.0).unwrap().vertical;
                // The parabola through three points half a millimetre from each other is as good as that on a face of 80 degrees.
                let error = first - parameters.wheel_radius - risen;
                assert!(error.abs() < 1e-5, "{degrees} degrees, {lateral} m: {error}");
            }
        }
    }
}

/// No overlap of a wheel that is lower by an approach is much deeper than that: neither where a line along the rail's normal grazes the flange, nor beside a point
/// whose normal passes below it.
#[test]
fn no_overlap_is_deeper_than_the_approach() {
    const APPROACH: f64 = 1e-4;
    let parameters = Parameters {
        wheel_profile: "steep.prw".to_owned(),
        ..parameters(Control::Load)
    };
    let contents = ProfileContents {
        wheel: Some(steep_flange(70.0).text(Format::Simpack).into()),
        rail: None,
    };
    let operators = SurfaceOperators::build(&parameters, &contents).unwrap();
    let mut search = Search::new(&operators.bodies);
    for step in 40..240 {
        let inputs = Inputs {
            lateral_displacement: -1e-4 * f64::from(step),
            ..Inputs::default()
        };
        let pose = Pose::new(&operators, &inputs, parameters.wheel_radius);
        search.touch(&operators.bodies, &pose.position, parameters.wheel_radius);
        if search.touches() {
            let deepest = search.overlaps(APPROACH).iter().map(|overlap| overlap.depth);
            let deepest = deepest.fold(0.0, f64::max);
            assert!(deepest < 1.2 * APPROACH, "{step}: {deepest}");
        }
    }
}

/// A load that grows a ten thousandfold, from an approach that little of it has made: windows are placed for no more than that and the approach of ellipses.
#[test]
fn the_approach_of_a_small_load_does_not_grow_with_it() {
    let parameters = parameters(Control::Load);
    let (settings, operators, mut solvers) = built(&parameters);
    let inputs = displaced(1e-3);
    let mut before = SurfaceFields::new(&operators);
    before.copy_from(fields(&run(&parameters, &inputs, 0)));
    let usual = before.approach[0];
    (before.load, before.approach[0]) = (before.load * 1e-4, 1e-4);
    let problem = problem(&operators, (&parameters, &settings), inputs);
    let mut now = SurfaceFields::new(&operators);
    now.guess_from(&before);
    place(&problem, Some(&before), None, &mut now, &mut solvers).unwrap();
    // Ellipses in place of the contacts are near what they carry.
    assert!(
        solvers.reference > 1e-4 && solvers.reference < 1e-4 + 1.5 * usual,
        "{:e}",
        solvers.reference
    );
}

/// The separation of an attempt that has failed, in windows that lay elsewhere, is not that of a pressure that is held.
#[test]
fn a_pressure_that_is_held_knows_no_separation() {
    let parameters = parameters(Control::Load);
    let (settings, operators, mut solvers) = built(&parameters);
    let inputs = displaced(1e-3);
    let problem = problem(&operators, (&parameters, &settings), inputs);
    let state = run(&parameters, &inputs, 0);
    let mut held = SurfaceFields::new(&operators);
    held.guess_from(fields(&state));
    place(&problem, Some(fields(&state)), None, &mut held, &mut solvers).unwrap();
    for own in &mut solvers.windows {
        own.patch.normal.separation.fill(1.0);
    }
    hold(&problem, &mut held, &mut solvers).unwrap();
    for (window, _) in held.used() {
        let own = &solvers.windows[window].patch;
        assert!(own.contact.cells() > 0);
        assert!(own.normal.separation.iter().all(|&separation| separation == 0.0));
    }
}

/// Pressure and shear are corrected for a friction that has changed by more than a thousandth of the load: on the tread, where friction carries next to nothing, to the second order;
/// in the gauge corner to the error of the pressure's response.
#[test]
fn a_window_alone_carries_what_friction_changes_of_the_load() {
    let parameters = parameters(Control::Load);
    let (settings, operators, mut solvers) = built(&parameters);
    for (lateral, first_order) in [(1e-3, 0.0), (8e-3, RESPONSE_ERROR)] {
        let before = displaced(lateral);
        let state = run(&parameters, &before, 0);
        let inputs = Inputs {
            lateral_speed: before.lateral_speed - 0.05,
            ..before
        };
        let problem = problem(&operators, (&parameters, &settings), inputs);
        let mut now = SurfaceFields::new(&operators);
        now.guess_from(fields(&state));
        SurfaceOperators::begin(&problem, Some(fields(&state)), &mut now, &mut solvers).unwrap();
        let mut interface = operators.interface();
        SurfaceOperators::read(&problem, &now, &mut solvers, &mut interface);
        SurfaceOperators::solve_mechanics(&problem, &interface, &mut now, &mut solvers, 1e-4).unwrap();
        assert_eq!(now.used().count(), 1);
        let (window, place) = now.used().next().unwrap();
        let load = problem.vertical_load();
        let missing = (now.load / load - 1.0).abs();
        let [normal, friction] = problem.vertical_forces(&now, &solvers, window, &place);
        let left = ((normal + friction) / load - 1.0).abs();
        assert!(
            missing > 1e-3 && left < first_order * missing + 0.5 * missing.powi(2),
            "{lateral}: {missing:e} {left:e}"
        );
    }
}

/// Displacement by a unit force beside it, along the surface or down: over (1 − ν)/(πG), by the way from it (Boussinesq, Cerruti).
trait PointForce<const N: usize> {
    /// Displacement by a force.
    fn displacement(poisson: f64, force: [f64; N], way: [f64; 2]) -> [f64; N];
}

impl PointForce<1> for ByPressure {
    fn displacement(_poisson: f64, [force]: [f64; 1], [x, y]: [f64; 2]) -> [f64; 1] {
        [force / x.hypot(y)]
    }
}

impl PointForce<2> for ByShear {
    fn displacement(poisson: f64, [along, across]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
        let distance = x.hypot(y);
        let radial = poisson * (along * x + across * y) / distance.powi(3);
        [along / distance + radial * x, across / distance + radial * y]
    }
}

/// Bound of the second derivatives of Cerruti's displacement over those of 1/r: those of xx/r³ and xy/r³ are up to twice as large.
fn roughness(operators: &SurfaceOperators, components: usize) -> f64 {
    let poisson = operators.pair.lateral / operators.pair.normal();
    if components == 2 { 1.0 + 2.0 * poisson } else { 1.0 }
}

/// The displacement of one window by the pressure, or the shear, of another is the sum over its cells as point forces, to the second order in the size of a
/// block over the distance: of a/r, the interpolation between places that are d from each other leaves d²/4r² or less, the block as much. Close contacts have
/// smaller blocks.
#[test]
fn windows_displace_each_other_as_their_cells_do() {
    let parameters = parameters(Control::Load);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let inputs = Inputs {
        normal_load: 20e3,
        vertical_displacement: 0.0,
        ..displaced(5e-3)
    };
    let state = run(&parameters, &inputs, 0);
    let own = fields(&state);
    let loaded = |window: &usize| own.windows[*window].pressure.iter().any(|&pressure| pressure > 0.0);
    assert_eq!(own.used().filter(|(window, _)| loaded(window)).count(), 2);
    for are_close in [false, true] {
        let own = SurfaceFields {
            are_close,
            ..own.clone()
        };
        displaces_as_its_cells_do::<1>(&operators, &own, |fields, at| [fields.pressure[at]]);
        displaces_as_its_cells_do::<2>(&operators, &own, |fields, at| {
            [fields.shear[0][at], fields.shear[1][at]]
        });
    }
}

fn displaces_as_its_cells_do<const N: usize>(
    operators: &SurfaceOperators,
    own: &SurfaceFields,
    traction: fn(&PatchFields, usize) -> [f64; N],
) where
    Resultants<N>: Influence<N>,
    Apart<N>: PointForce<N>,
{
    let [strips, cells] = apart::grain(&operators.sizes.largest, own.are_close).map(|count| count as f64);
    let poisson = operators.pair.lateral / operators.pair.normal();
    let mut apart = Apart::<N>::new(operators);
    apart.set_resultants(operators, own);
    for (window, place) in own.used() {
        apart.displace(operators, window, &place);
        let patch = operators.of(&place);
        let unit = operators.pair.normal() * patch.scales.pressure / patch.scales.displacement;
        let at = |place: &Place, strip: usize, cell: usize| {
            let grid = &operators.of(place).grid;
            [place.middle_along(grid) + grid.x(cell), place.arc(grid, strip)]
        };
        let touching = (0..patch.grid.strips).flat_map(|strip| (0..patch.grid.cells).map(move |cell| (strip, cell)));
        for (strip, cell) in
            touching.filter(|(strip, cell)| own.windows[window].pressure[patch.grid.place(*strip, *cell)] > 0.0)
        {
            let [x, y] = at(&place, strip, cell);
            let (mut sum, mut magnitude, mut nearest) = ([0.0; N], 0.0, f64::INFINITY);
            for (other, from) in own.used().filter(|(other, _)| *other != window) {
                let grid = &operators.of(&from).grid;
                for (row, column) in (0..grid.strips).flat_map(|row| (0..grid.cells).map(move |column| (row, column))) {
                    let [u, v] = at(&from, row, column);
                    let force = traction(&own.windows[other], grid.place(row, column));
                    let force = force.map(|traction| traction * grid.cell_area());
                    if force == [0.0; N] {
                        continue;
                    }
                    let way = [x - u, y - v];
                    let displacement = Apart::<N>::displacement(poisson, force, way);
                    for (sum, displacement) in sum.iter_mut().zip(displacement) {
                        *sum += displacement;
                    }
                    let distance = way[0].hypot(way[1]);
                    magnitude += force.iter().map(|force| force * force).sum::<f64>().sqrt() / distance;
                    nearest = f64::min(nearest, distance);
                }
            }
            let block = f64::max(cells * patch.grid.length, strips * patch.grid.breadth);
            let allowed = (0.5 * (block / nearest).powi(2)).min(0.1) * roughness(operators, N) * unit * magnitude;
            for (component, sum) in sum.into_iter().enumerate() {
                let found = apart.displacement[window][component][patch.grid.place(strip, cell)];
                assert!(
                    (found - unit * sum).abs() < allowed,
                    "{component} of {N}, {} {strip} {cell}: {found} {} {allowed}",
                    own.are_close,
                    unit * sum
                );
            }
        }
    }
}

/// Blocks follow the number of cells, and contacts are close where they are nearer to each other than one of the larger blocks is long.
#[test]
fn contacts_nearer_than_a_block_are_close() {
    for (cells, strips, far, close) in [
        (34, 32, [4, 6], [2, 2]),
        (24, 23, [3, 4], [1, 1]),
        (8, 12, [2, 2], [1, 1]),
    ] {
        let grid = Grid::new(cells, strips, 17e-3, 12.8e-3);
        assert_eq!(
            [false, true].map(|are_close| apart::grain(&grid, are_close)),
            [far, close]
        );
        let [across, along] = [far[0] as f64 * grid.breadth, far[1] as f64 * grid.length];
        assert_eq!(apart::block_size(&grid), across.max(along));
    }
    // Under a larger load the contacts are larger, and nearer to each other.
    for (normal_load, are_close) in [(40e3, false), (100e3, true)] {
        let parameters = Parameters {
            patch_nodes: 34,
            patch_strips: 21,
            ..parameters(Control::Load)
        };
        let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
        let inputs = Inputs {
            normal_load,
            ..displaced(4.7e-3)
        };
        let state = run(&parameters, &inputs, 3);
        let own = fields(&state);
        let mut contacts: Vec<_> = own
            .used()
            .filter_map(|(window, place)| {
                let grid = &operators.of(&place).grid;
                let loaded = |strip: &usize| {
                    own.windows[window].pressure[grid.row(*strip)]
                        .iter()
                        .any(|&pressure| pressure > 0.0)
                };
                let [first, last] = [(0..grid.strips).find(loaded)?, (0..grid.strips).rev().find(loaded)?];
                Some(([place.arc(grid, first), place.arc(grid, last)], apart::block_size(grid)))
            })
            .collect();
        contacts.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
        let [([_, end], first), ([begin, _], second)] = contacts[..] else {
            panic!("{} contacts", contacts.len());
        };
        let share = (begin - end) / f64::max(first, second);
        assert_eq!(
            (share < 1.0, own.are_close),
            (are_close, are_close),
            "{normal_load}: {share}"
        );
    }
}

/// A loaded cell displaces another window as a point force does, down or along the surface, wherever it lies in its block: to the second order in its distance δ from the
/// block's middle and in the distances d of the places of the target, over the distance r.
#[test]
fn a_cell_displaces_another_window_as_a_point_force() {
    let parameters = parameters(Control::Load);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let inputs = Inputs {
        normal_load: 20e3,
        vertical_displacement: 0.0,
        ..displaced(5e-3)
    };
    let state = run(&parameters, &inputs, 0);
    let (window, place) = fields(&state).used().next().unwrap();
    let (other, from) = fields(&state).used().nth(1).unwrap();
    let (grid, source) = (&operators.of(&place).grid, &operators.of(&from).grid);
    let scales = &operators.of(&place).scales;
    let unit = operators.pair.normal() * scales.pressure / scales.displacement * source.cell_area();
    let poisson = operators.pair.lateral / operators.pair.normal();
    // The four corners of a block of 4 strips and 6 cells.
    let block = [8, 12];
    let mut compared = 0;
    for (strip, cell) in [(0, 0), (0, 5), (3, 0), (3, 5)] {
        let (strip, cell) = (block[0] + strip, block[1] + cell);
        let nothing = vec![0.0; source.len()];
        let mut force = nothing.clone();
        force[source.place(strip, cell)] = 1.0;
        let mut by_pressure = ByPressure::new(&operators);
        by_pressure.clear(&operators, false);
        by_pressure.take_traction(&operators, [&force], other, &from);
        by_pressure.displace(&operators, window, &place);
        let by_shear = [[&force, &nothing], [&nothing, &force]].map(|shear| {
            let mut by_shear = ByShear::new(&operators);
            by_shear.clear(&operators, false);
            by_shear.take_traction(&operators, shear.map(|component| &component[..]), other, &from);
            by_shear.displace(&operators, window, &place);
            by_shear
        });
        let at = |strip: usize, cell: usize| [from.middle_along(source) + source.x(cell), from.arc(source, strip)];
        let [u, v] = at(strip, cell);
        let (first, last) = (at(block[0], block[1]), at(block[0] + 3, block[1] + 5));
        let middle = [0.5 * (first[0] + last[0]), 0.5 * (first[1] + last[1])];
        let of_block = (2.5 * source.length).hypot(1.5 * source.breadth);
        let between = (6.0 * grid.length).hypot(4.0 * grid.breadth);
        for (row, column) in (0..grid.strips).flat_map(|row| (0..grid.cells).map(move |column| (row, column))) {
            let [x, y] = [place.middle_along(grid) + grid.x(column), place.arc(grid, row)];
            let distance = (x - u).hypot(y - v);
            // Nearer than the blocks and the places are large there is no order.
            if distance < 2.0 * (of_block + between) {
                continue;
            }
            compared += 1;
            // A series of powers of δ over the distance from the block's middle.
            let from_middle = (x - middle[0]).hypot(y - middle[1]);
            let of_series = (of_block / from_middle).powi(2) / (1.0 - of_block / from_middle) * distance / from_middle;
            // Of 1/r the second derivatives along and across are 2/r³ or less, r from the nearest point between the places.
            let [right, up] = [(column % 6) as f64 / 6.0, (row % 4) as f64 / 4.0];
            let [left, low] = [x - 6.0 * right * grid.length, y - 4.0 * up * grid.breadth];
            let near_x = u.clamp(left, left + 6.0 * grid.length);
            let near_y = v.clamp(low, low + 4.0 * grid.breadth);
            let nearest = (near_x - u).hypot(near_y - v);
            let along = right * (1.0 - right) * (6.0 * grid.length).powi(2);
            let across = up * (1.0 - up) * (4.0 * grid.breadth).powi(2);
            let of_places = (along + across) * distance / nearest.powi(3);
            let allowed = unit / distance * (of_series + of_places);
            let at = grid.place(row, column);
            let down = by_pressure.displacement[window][0][at];
            let found = [[down, 0.0]].into_iter().chain(
                by_shear
                    .each_ref()
                    .map(|by_shear| by_shear.displacement[window].each_ref().map(|component| component[at])),
            );
            let way = [x - u, y - v];
            let exact = [
                [1.0 / distance, 0.0],
                ByShear::displacement(poisson, [1.0, 0.0], way),
                ByShear::displacement(poisson, [0.0, 1.0], way),
            ];
            for (load, (found, exact)) in found.zip(exact).enumerate() {
                let allowed = allowed * roughness(&operators, if load == 0 { 1 } else { 2 });
                for (found, exact) in found.into_iter().zip(exact) {
                    assert!(
                        (found - unit * exact).abs() <= allowed,
                        "{load}, {strip} {cell} on {row} {column}: {found} {} {allowed}",
                        unit * exact
                    );
                }
            }
        }
    }
    assert!(compared > 0);
}

/// The volume of the cells is what the law wears off both bodies over the steps, whatever the windows do: over a wheelset that goes from the tread to the
/// flange.
#[test]
fn the_volume_of_the_cells_is_that_of_the_law() {
    let parameters = Parameters {
        wheel_profile_wear: ProfileWear::On,
        rail_profile_wear: ProfileWear::On,
        rail_wear_length: 7.0,
        wheel_wear_coefficient: 1e-12,
        wear_acceleration: 100.0,
        ..parameters(Control::Load)
    };
    let model = Model::new(parameters.clone()).unwrap();
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let mut workspace = model.workspace();
    let mut state = model.initial_state(&mut workspace, &displaced(3e-3)).unwrap();
    for step in 0..30 {
        let inputs = displaced(3e-3 + 1e-4 * f64::from(step));
        model
            .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, 1e-3)
            .unwrap();
    }
    let worn = &fields(&state).worn;
    let [wheel, rail] = &operators.grids;
    let turns = worn.depth[WHEEL].iter().zip(&operators.wheel_radii);
    let of_wheel = wheel.spacing
        * turns
            .map(|(depth, radius)| std::f64::consts::TAU * radius * depth)
            .sum::<f64>();
    let of_rail = 7.0 * rail.spacing * worn.depth[RAIL].iter().sum::<f64>();
    for (found, expected) in [
        (of_wheel, 100.0 * state.totals.wheel_worn_volume),
        (of_rail, 100.0 * state.totals.worn_volume),
    ] {
        assert!(
            expected > 0.0 && (found / expected - 1.0).abs() < 1e-10,
            "{found} {expected}"
        );
    }
}

/// The work of a step is that of its own windows: of a wheel that has left its second contact, not what was done in that one before.
#[test]
fn work_is_of_the_windows_of_the_step() {
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    let model = Model::new(parameters.clone()).unwrap();
    let work = |workspace: &mut Workspace, lateral: f64| {
        let inputs = Inputs {
            vehicle_speed: 20.0,
            wheel_speed: 20.1 / parameters.wheel_radius,
            normal_load: 80e3,
            lateral_displacement: lateral,
            ..Inputs::default()
        };
        let mut state = run(&parameters, &inputs, 0);
        model.step(workspace, &mut state, &inputs, &Inputs::ZERO, 1e-3).unwrap();
        let ContactWorkspace::Surface(own) = &workspace.contact else {
            panic!("another contact model");
        };
        (
            fields(&state).used().count(),
            SurfaceOperators::mechanics_work(&own.solvers),
        )
    };
    let mut workspace = model.workspace();
    let (windows, _) = work(&mut workspace, 5e-3);
    assert_eq!(windows, 2);
    let of_one = work(&mut workspace, 0.0);
    assert_eq!(of_one, work(&mut model.workspace(), 0.0));
    assert_eq!(of_one.0, 1);
}
