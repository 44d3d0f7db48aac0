//! Fields of a contact of profiles: they add up to the outputs, and stand where the outputs say.

use std::f64::consts::PI;
use std::path::Path;
use wheelrail::parameters::{ContactModel, Parameters, ProfileWear, Side, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::{Model, ProfileDepths, SurfaceWindow, WornPlace};
use wheelrail::{Body, Error, Profile, Simulation};

fn parameters(side: Side) -> Parameters {
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        side,
        patch_nodes: 20,
        patch_strips: 13,
        ..Parameters::default()
    }
}

/// Rolling with yaw where tread and flange's root carry, on a rail that has moved and rolled.
fn inputs(side: Side) -> Inputs {
    let sign = if side == Side::Left { 1.0 } else { -1.0 };
    Inputs {
        normal_load: 60e3,
        vehicle_speed: 20.0,
        wheel_speed: 43.6,
        lateral_displacement: sign * 5.1e-3,
        yaw_angle: sign * 2e-3,
        rail_lateral_displacement: sign * 2e-4,
        rail_vertical_displacement: 3e-4,
        rail_roll_angle: sign * 1e-3,
        ..Inputs::default()
    }
}

/// A wheel that has rolled some steps.
fn rolled(parameters: Parameters) -> Simulation {
    let inputs = inputs(parameters.side);
    let mut run = Simulation::new(&parameters, &inputs).unwrap();
    run.hold(&inputs, 1e-3, 3).unwrap();
    run
}

/// Sum over the cells of a window of their areas times a value.
fn integral(window: &SurfaceWindow, value: impl Fn(&SurfaceWindow, usize) -> f64) -> f64 {
    let area = window.cell_length * window.strip_breadth;
    (0..window.nodes.len()).map(|node| area * value(window, node)).sum()
}

/// Each carrying window is a contact: pressure and shear add up to its forces, its cells lie within its extents.
#[test]
fn fields_add_up_to_the_contacts() {
    for side in [Side::Left, Side::Right] {
        let run = rolled(parameters(side));
        let (outputs, windows) = (run.outputs(), run.surface_windows().unwrap());
        let count = outputs.contacts as usize;
        assert_eq!(count, 2, "{side:?}");
        for (number, window) in windows.iter().enumerate() {
            let contact = &outputs.contact[number];
            let near = |value: f64, expected: f64, scale: f64, what: &str| {
                assert!(
                    (value - expected).abs() <= 1e-9 * scale,
                    "{side:?} {number} {what}: {value} {expected}"
                );
            };
            let force = contact.normal_force;
            near(window.normal_force(), force, force, "normal force");
            if number >= count {
                continue;
            }
            near(
                -integral(window, |w, n| w.nodes[n].shear),
                contact.longitudinal_force,
                force,
                "along",
            );
            near(
                -integral(window, |w, n| w.nodes[n].lateral_shear),
                contact.lateral_force,
                force,
                "across",
            );
            let power = |w: &SurfaceWindow, n: usize| {
                let node = &w.nodes[n];
                -(node.shear * node.slip + node.lateral_shear * node.lateral_slip)
            };
            // Where the surfaces stick, what is left of a slip counts as none.
            let work = integral(window, power);
            let error = work / contact.friction_power - 1.0;
            assert!(error.abs() < 1e-6, "{side:?} {number}: {work} W");
            let largest = window.nodes.iter().map(|node| node.pressure).fold(0.0, f64::max);
            near(largest, contact.peak_pressure, largest, "peak pressure");
            assert!(
                window
                    .nodes
                    .iter()
                    .all(|node| (node.pressure > 0.0) == (node.friction_coefficient > 0.0))
            );
            stands_where_the_contact_is(window, contact.position, [contact.length, contact.breadth]);
        }
        // Of the area in contact, as much sticks as the output says.
        let area = |counts: fn(f64) -> bool| -> f64 {
            let counted = |w: &SurfaceWindow, n: usize| {
                let node = &w.nodes[n];
                f64::from(node.pressure > 0.0 && counts(node.utilisation))
            };
            windows.iter().map(|window| integral(window, counted)).sum()
        };
        let sticks = area(|utilisation| utilisation < 0.9999) / area(|_| true);
        assert!(
            (outputs.stick_fraction - sticks).abs() < 1e-9,
            "{} {sticks}",
            outputs.stick_fraction
        );
        // All windows together.
        let vertical = |w: &SurfaceWindow, n: usize| {
            let sign = if side == Side::Left { 1.0 } else { -1.0 };
            let angle = w.strips[n / w.x.len()].inclination;
            w.nodes[n].pressure * angle.cos() - sign * w.nodes[n].lateral_shear * angle.sin()
        };
        let force: f64 = windows.iter().map(|window| integral(window, vertical)).sum();
        assert!(
            (force / outputs.force_z - 1.0).abs() < 1e-9,
            "{side:?}: {force} {}",
            outputs.force_z
        );
    }
}

/// The contact is as long as its longest strip under pressure, and as broad as its broadest column of cells. Either ends where the pressure of its last cells
/// says: when a cell joins, 0.156 of a cell before its centre, from there to as far before that of the next one. The contact's resultant lies among the cells.
fn stands_where_the_contact_is(window: &SurfaceWindow, position: f64, extents: [f64; 2]) {
    let cells = window.x.len();
    let place = |node: usize| [window.nodes[node].position, window.strips[node / cells].arc_length];
    let carrying: Vec<usize> = (0..window.nodes.len())
        .filter(|node| window.nodes[*node].pressure > 0.0)
        .collect();
    let span = |way: usize, nodes: &mut dyn Iterator<Item = usize>| {
        nodes.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], node| {
            [low.min(place(node)[way]), high.max(place(node)[way])]
        })
    };
    let lines = [window.nodes.len() / cells, cells];
    let sizes = [window.cell_length, window.strip_breadth];
    for way in 0..2 {
        let on_line = |line: usize| move |node: &usize| [node / cells, node % cells][way] == line;
        let longest = (0..lines[way]).fold(0.0, |longest: f64, line| {
            let [low, high] = span(way, &mut carrying.iter().copied().filter(on_line(line)));
            longest.max(high - low)
        });
        let beyond = (extents[way] - longest) / sizes[way];
        assert!(
            (-0.312..=1.688).contains(&beyond),
            "{way}: {longest} {extents:?} {sizes:?}"
        );
    }
    let [low, high] = span(0, &mut carrying.iter().copied());
    assert!(low <= position && position <= high, "{low} {position} {high}");
}

/// Inclinations are those of the rail as it lies in the track, its roll included: the strips' that of the line through their neighbours, the contact's that
/// of the pressure's middle.
#[test]
fn inclinations_are_slopes_in_the_track() {
    for side in [Side::Left, Side::Right] {
        let sign = if side == Side::Left { 1.0 } else { -1.0 };
        // Wheel and rail meet on one arc of the rail's profile, whose chords are as steep as the arc is in their middle.
        let inputs = Inputs {
            rail_roll_angle: sign * 0.03,
            roll_angle: sign * 0.03,
            ..inputs(side)
        };
        let mut run = Simulation::new(&parameters(side), &inputs).unwrap();
        run.hold(&inputs, 1e-3, 3).unwrap();
        let (outputs, windows) = (run.outputs(), run.surface_windows().unwrap());
        let mut carrying = 0;
        for (contact, window) in outputs.contact.iter().zip(&windows) {
            if contact.normal_force == 0.0 {
                continue;
            }
            carrying += 1;
            for around in window.strips.windows(3) {
                let [one, other] = [around[0].in_track, around[2].in_track];
                let slope = ((other[1] - one[1]) / (sign * (other[0] - one[0]))).atan();
                let off = around[1].inclination - slope;
                assert!(off.abs() < 1e-9, "{side:?}: {slope} and {}", around[1].inclination);
            }
            let of_pressure = |w: &SurfaceWindow, n: usize| w.nodes[n].pressure * w.strips[n / w.x.len()].inclination;
            let mean = integral(window, of_pressure) / contact.normal_force;
            let off = contact.inclination - mean;
            assert!(off.abs() < 1e-9, "{side:?}: {mean} and {}", contact.inclination);
        }
        assert!(carrying > 0);
    }
}

/// Both profiles stand in the track as the contact has them: the rail's strips on the rail's profile, and wheel and rail as far apart as they are pressed
/// together where they touch.
#[test]
fn profiles_stand_in_the_track() {
    for side in [Side::Left, Side::Right] {
        let wearing = Parameters {
            wheel_profile_wear: ProfileWear::On,
            rail_profile_wear: ProfileWear::On,
            wear_acceleration: 1e3,
            // Without a lead of the contact, so that what is below the axle touches.
            ..parameters(side)
        };
        let mut run = rolled(wearing);
        let still = Inputs {
            yaw_angle: 0.0,
            ..inputs(side)
        };
        run.hold(&still, 1e-3, 2).unwrap();
        let ProfileDepths { wheel, rail } = run.profile_wear().unwrap();
        let windows = run.surface_windows().unwrap();
        let gap = |strip: &[f64; 2]| height_at(&wheel, strip[0]) - strip[1];
        for window in windows.iter().filter(|window| window.normal_force() > 0.0) {
            for strip in &window.strips {
                let [y, z] = strip.in_track;
                let off = height_at(&rail, y) - z;
                assert!(
                    off.abs() < 2e-6,
                    "{side:?}: the rail is {off} m off its strips at {y} m"
                );
            }
            let inclination = window.strips[window.strips.len() / 2].inclination;
            let deepest = window
                .strips
                .iter()
                .map(|strip| gap(&strip.in_track))
                .fold(f64::INFINITY, f64::min);
            let overlap = -deepest * inclination.cos();
            let approach = run.outputs().penetration;
            assert!(
                overlap > 0.0 && overlap < 1.2 * approach,
                "{side:?}: {overlap} {approach}"
            );
        }
    }
}

/// The roll of the rail turns it about its top, by the angle of the input on either side; its displacements move it.
#[test]
fn a_rail_that_has_moved_and_rolled_is_there() {
    for side in [Side::Left, Side::Right] {
        let moved = inputs(side);
        let still = Inputs {
            rail_lateral_displacement: 0.0,
            rail_vertical_displacement: 0.0,
            rail_roll_angle: 0.0,
            ..moved
        };
        let [before, after] = [still, moved].map(|inputs| {
            let run = Simulation::new(&parameters(side), &inputs).unwrap();
            run.profile_wear().unwrap().rail
        });
        let top = before
            .iter()
            .max_by(|a, b| a.in_track[1].total_cmp(&b.in_track[1]))
            .unwrap();
        for (from, to) in before.iter().zip(&after) {
            let ([y, z], roll) = (from.in_track, moved.rail_roll_angle);
            let expected = [
                y - roll * z + moved.rail_lateral_displacement,
                z + roll * (y - top.in_track[0]) + moved.rail_vertical_displacement,
            ];
            for (place, expected) in to.in_track.iter().zip(expected) {
                // The square of the roll, and a place beside the top.
                let off = place - expected;
                assert!(off.abs() < 2e-7, "{side:?} {from:?} {to:?}");
            }
        }
    }
}

/// Height of a profile in the track over a lateral position, linear between its places.
fn height_at(places: &[WornPlace], y: f64) -> f64 {
    let pair = places
        .windows(2)
        .find(|pair| (pair[0].in_track[0] - y) * (pair[1].in_track[0] - y) <= 0.0);
    let [from, to] = pair.map(|pair| [pair[0].in_track, pair[1].in_track]).unwrap();
    from[1] + (to[1] - from[1]) * (y - from[0]) / (to[0] - from[0])
}

/// The profiles along, across and below are those of the window that carries most.
#[test]
fn profiles_for_plotting_are_those_of_the_window_that_carries_most() {
    let run = rolled(parameters(Side::Left));
    let (outputs, plots) = (run.outputs(), run.profiles());
    let heaviest = (0..2).max_by(|&a, &b| {
        outputs.contact[a]
            .normal_force
            .total_cmp(&outputs.contact[b].normal_force)
    });
    let contact = &outputs.contact[heaviest.unwrap()];
    let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, value| largest.max(*value));
    // Sampled between the cells.
    assert!((largest(&plots.pressure) / contact.peak_pressure - 1.0).abs() < 0.1);
    assert!((largest(&plots.strips.pressure) / contact.peak_pressure - 1.0).abs() < 0.1);
    assert!((largest(&plots.temperature) - contact.peak_temperature).abs() < 5.0);
    assert_eq!(
        plots.depth_temperature[0],
        largest(&plots.strips.temperature).max(plots.depth_temperature[0])
    );
    let windows = run.surface_windows().unwrap();
    let strips = &windows[heaviest.unwrap()].strips;
    let ends = [strips[0].in_track[0], strips[strips.len() - 1].in_track[0]];
    assert_eq!([plots.strips.position[0], plots.strips.position[20]], ends);
    let friction: f64 = plots
        .strips
        .friction_power
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .sum();
    let breadth = strips[strips.len() - 1].arc_length - strips[0].arc_length;
    assert!((friction * breadth / 20.0 / contact.friction_power - 1.0).abs() < 0.1);
    // A lifted wheel has none of them.
    let lifted = Inputs {
        normal_load: 0.0,
        ..inputs(Side::Left)
    };
    let lifted = Simulation::new(&parameters(Side::Left), &lifted).unwrap();
    assert_eq!(largest(&lifted.profiles().pressure), 0.0);
    assert!(
        lifted
            .surface_windows()
            .unwrap()
            .iter()
            .all(|window| window.normal_force() == 0.0)
    );
}

#[test]
fn other_contact_models_have_no_windows() {
    let model = Model::new(Parameters::default()).unwrap();
    let state = model.initial_state(&mut model.workspace(), &Inputs::default()).unwrap();
    assert!(matches!(model.surface_windows(&state), Err(Error::OtherContactModel)));
}

/// A wheel that is hollow to a circle of the given radius, over a rail of an arc of 300 mm and waves of the given height; in files of the given name.
fn arcs(name: &str, hollow: f64, waves: impl Fn(f64) -> f64) -> Parameters {
    const CROWN: f64 = 0.3;
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let write = |body, ending: &str, height: &dyn Fn(f64) -> f64| {
        let places = (-340..=340).map(|tenths| 1e-4 * f64::from(tenths));
        let points: Vec<[f64; 2]> = places.map(|y| [y, height(y)]).collect();
        let file = folder.join(format!("{name}.{ending}"));
        let profile = Profile::from_points(body, name, name, &points, 0.0).unwrap();
        profile.write(&file).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let arc = |radius: f64, y: f64| (radius * radius - y * y).sqrt() - radius;
    // The rail's top stands over the running circle.
    let depth: f64 = 1e-3;
    let to_face = (CROWN.powi(2) - (CROWN - depth).powi(2)).sqrt();
    Parameters {
        rail_profile: write(Body::Rail, "prr", &|y| arc(CROWN, y) + waves(y)),
        wheel_profile: write(Body::Wheel, "prw", &|y| arc(hollow, y)),
        rail_inclination: 0.0,
        gauge: 2.0 * (0.75 - to_face),
        gauge_depth: depth,
        ..parameters(Side::Left)
    }
}

/// A contact that is broader than the largest window is held within it, and keeps the length of its cells: a wheel hollow to a circle on a rail of a little smaller one.
#[test]
fn a_contact_broader_than_the_largest_window_keeps_its_cells() {
    let parameters = arcs("broad", 0.307, |_| 0.0);
    let run = |load: f64| {
        let inputs = Inputs {
            normal_load: load,
            vehicle_speed: 20.0,
            wheel_speed: 20.0 / 0.46,
            ..Inputs::default()
        };
        let mut run = Simulation::new(&parameters, &inputs).unwrap();
        run.hold(&inputs, 1e-3, 3).unwrap();
        let fills = run.state.convergence.fills_window;
        (fills, run.surface_windows().unwrap()[0].cell_length)
    };
    let [narrow, broad] = [30e3, 70e3].map(run);
    assert_eq!([narrow.0, broad.0], [false, true]);
    assert_eq!(narrow.1, broad.1);
}

/// Where a wheel touches in more places than there are windows, all of them carry, and the step says so.
#[test]
fn more_contacts_than_windows_all_carry() {
    // Crests 11 mm apart, of which five touch.
    let parameters = arcs("crests", 0.3001, |y| 5e-5 * (2.0 * PI * y / 11e-3).cos());
    let inputs = Inputs {
        normal_load: 75e3,
        vehicle_speed: 20.0,
        wheel_speed: 20.0 / 0.46,
        ..Inputs::default()
    };
    let mut run = Simulation::new(&parameters, &inputs).unwrap();
    run.hold(&inputs, 1e-3, 3).unwrap();
    assert!(run.state.convergence.crowded);
    assert_eq!(run.outputs().contacts, 4.0);
    // Neighbouring strips under pressure are a contact: there is one for each crest.
    let windows = run.surface_windows().unwrap();
    let carries = |window: &SurfaceWindow, strip: usize| {
        let cells = window.x.len();
        let row = &window.nodes[strip * cells..(strip + 1) * cells];
        row.iter().any(|node| node.pressure > 0.0)
    };
    let contacts: usize = windows
        .iter()
        .map(|window| {
            let begins = |strip: &usize| carries(window, *strip) && (*strip == 0 || !carries(window, strip - 1));
            (0..window.strips.len()).filter(begins).count()
        })
        .sum();
    assert_eq!(contacts, 5);
    // Where no more than four touch each has a window, and nothing is said.
    let inputs = Inputs {
        normal_load: 10e3,
        ..inputs
    };
    run.hold(&inputs, 1e-3, 3).unwrap();
    assert!(!run.state.convergence.crowded);
}
