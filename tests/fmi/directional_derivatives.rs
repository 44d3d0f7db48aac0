//! The directional derivative of every output with respect to every input against differences of a step that is rolled
//! back with a saved state, over random operating points in stick, partial slip and sliding of both contact models.

use super::importer::{Client, ContactModel, Handle, Line, OK, Patch, Profiles, with_each};
use wheelrail::parameters::Parameters;
use wheelrail::signals::{INPUTS, OUTPUTS};
use wheelrail::torture::random::Random;
use wheelrail::wheel_rail::PROFILE_POINTS;

const STEP: f64 = 1e-3;
/// Relative change of all inputs in the step that is differentiated. Without it the operator split would rest after two
/// iterations, and the difference quotient miss the derivative by the square of the contraction, up to 1e-3 whatever its step.
const MOVE: f64 = 0.02;
/// The same for load and temperatures: what comes in changes the tractions little, least those of like bodies, whose split
/// contracts fastest.
const LARGE_MOVE: f64 = -0.1;

/// What differences are taken with, and what can be asked of them.
struct Accuracy {
    points: usize,
    /// Relative step of a difference.
    change: f64,
    /// What the solvers leave of an output, relative to its weight.
    left: f64,
    /// Differences over one and two steps that differ by more than this share of themselves, or by that of the output, have a
    /// corner between them.
    corner: [f64; 2],
    /// Error of a derivative, relative to itself.
    relative: f64,
}

/// The operator split rests at 1e-9 by the weights of the outputs (1.5).
const OF_A_LINE: Accuracy = Accuracy {
    points: 30,
    change: 4e-4,
    left: 1.5 * 1e-9,
    corner: [3e-5, 4e-9],
    relative: 1e-4,
};

/// The mechanics of a patch leave 1e-5 of the pressure, and up to some times that of the outputs that follow from it (2.5e-5 was
/// found). With tighter tolerances than an importer can choose, the model's own tests find 1e-4 of the derivative.
const OF_A_PATCH: Accuracy = Accuracy {
    points: 20,
    change: 3e-3,
    left: 4e-5,
    corner: [1e-3, 4e-5],
    relative: 5e-3,
};

fn accuracy(contact: ContactModel) -> &'static Accuracy {
    match contact {
        Line => &OF_A_LINE,
        Patch | Profiles => &OF_A_PATCH,
    }
}

/// Where a difference starts: a saved state, its time and the inputs that were in force.
struct Point<'a> {
    client: &'a Client<'a>,
    before: Handle,
    time: f64,
    inputs: [(&'static str, f64); INPUTS.len()],
    references: Vec<u32>,
}

impl Point<'_> {
    /// Rolls back and steps with one input changed: the outputs, and which nodes are under pressure.
    fn step(&self, input: usize, change: f64) -> (Vec<f64>, Vec<bool>) {
        let client = self.client;
        client.expect(OK, client.restore(self.before));
        let mut inputs = self.inputs;
        inputs[input].1 += change;
        client.expect(OK, client.set(&inputs));
        client.expect(OK, client.step(self.time, STEP));
        let mut values = vec![f64::NAN; OUTPUTS.len() + PROFILE_POINTS];
        client.expect(OK, client.get_references(&self.references, &mut values));
        let pressure = values.split_off(OUTPUTS.len());
        (values, pressure.iter().map(|p| *p > 0.0).collect())
    }

    /// Derivatives of all outputs with respect to one input by differences with Richardson's extrapolation; `None` for
    /// those between whose ends a node joins or leaves the contact, or the friction law has a corner.
    fn differences(&self, input: usize, change: f64) -> Vec<Option<f64>> {
        let [relative, absolute] = accuracy(self.client.contact).corner;
        let at = |steps: f64| self.step(input, steps * change);
        let (here, ahead, behind) = (at(0.0), at(1.0), at(-1.0));
        let (further_ahead, further_behind) = (at(2.0), at(-2.0));
        let one_set = [&ahead, &behind, &further_ahead, &further_behind]
            .iter()
            .all(|point| point.1 == here.1);
        (0..OUTPUTS.len())
            .map(|row| {
                let forward = ahead.0[row] - here.0[row];
                let backward = here.0[row] - behind.0[row];
                let further = further_ahead.0[row] - further_behind.0[row];
                // A corner shows in the first or second differences over one and two steps, wherever it lies between.
                let curvature = forward - backward;
                let further_curvature = further_ahead.0[row] - 2.0 * here.0[row] + further_behind.0[row];
                let allowed = relative * further.abs() + absolute * OUTPUTS[row].nominal.max(here.0[row].abs());
                let smooth = one_set
                    && (further - 2.0 * (forward + backward)).abs() <= allowed
                    && (further_curvature - 4.0 * curvature).abs() <= allowed;
                smooth.then_some((8.0 * (forward + backward) - further) / (12.0 * change))
            })
            .collect()
    }

    /// The column of the interface.
    fn derivatives(&self, input: usize) -> Vec<f64> {
        let (client, unknowns) = (self.client, self.client.api.standard.outputs());
        let (known, mut values) = (client.api.reference(INPUTS[input].name), vec![f64::NAN; OUTPUTS.len()]);
        client.expect(OK, client.directional(&unknowns, &[known], &[1.0], &mut values));
        values
    }
}

#[test]
fn directional_derivatives_are_the_differences_of_a_rolled_back_step() {
    with_each(|api, contact| {
        let mut random = Random::new(3, 0);
        let (mut compared, mut large, mut corners, mut regimes, mut worst) = (0, 0, 0, [0; 3], 0.0_f64);
        let accuracy = accuracy(contact);
        for point in 0..accuracy.points {
            let vehicle = point % 2 == 1;
            let client = match contact {
                Line => Client::new(api),
                Patch | Profiles => Client::coarse(api, contact),
            };
            let law = 1 + (point / 2 % 3) as i32;
            // Rigid or of the rail's material.
            let wheel = 1 + (point / 6 % 2) as i32;
            client.expect(
                OK,
                client.set_integers(&[
                    ("slip_source", 1 + i32::from(vehicle)),
                    ("friction_law", law),
                    ("wheel", wheel),
                ]),
            );
            let creepage = match point % 3 {
                // Sticking, about free rolling, at which a rigid wheel creeps backward: ranges in which a line and a patch stick.
                0 => match contact {
                    Line => random.between(-0.0022, -0.001),
                    Patch | Profiles => random.between(-0.0016, -0.0004),
                },
                1 => random.between(-0.003, 0.003),
                _ => random.between(0.008, 0.2) * if point % 4 < 2 { 1.0 } else { -1.0 },
            };
            let direction = if point % 5 == 4 { -1.0 } else { 1.0 };
            let speed = direction * random.between(2.0, 40.0);
            let chosen = [
                (
                    "wheel_speed",
                    speed * (1.0 + creepage) / Parameters::default().wheel_radius,
                ),
                ("normal_load", random.between(20e3, 95e3)),
                ("creepage", creepage),
                ("vehicle_speed", speed),
                ("friction_scale", random.between(0.3, 1.2)),
                ("ambient_temperature", random.between(260.0, 310.0)),
                ("incoming_temperature", random.between(260.0, 350.0)),
                ("incoming_wear_depth", random.between(0.0, 1e-6)),
            ];
            let sideways = match contact {
                Line => Vec::new(),
                Patch | Profiles => {
                    let lateral = 0.3 * creepage.abs() * random.between(-1.0, 1.0);
                    let spin = random.between(-0.2, 0.2);
                    vec![
                        ("lateral_creepage", lateral),
                        ("spin_creepage", spin),
                        ("lateral_speed", lateral * speed),
                        ("spin_rate", spin * speed),
                    ]
                }
            };
            // In the order of the inputs, any other at its start value.
            let start: [_; INPUTS.len()] = std::array::from_fn(|row| {
                let signal = &INPUTS[row];
                let value = chosen.iter().chain(&sideways).find(|(name, _)| *name == signal.name);
                (signal.name, value.map_or(signal.default, |(_, value)| *value))
            });
            let moved = start.map(|(name, value)| match name {
                "normal_load" | "ambient_temperature" | "incoming_temperature" => (name, value * (1.0 + LARGE_MOVE)),
                _ => (name, value * (1.0 + MOVE)),
            });
            client.expect(OK, client.set(&moved));
            client.expect(OK, client.begin(0.0, None));
            client.expect(OK, client.exit());
            let mut time = 0.0;
            for _ in 0..20 {
                client.expect(OK, client.step(time, STEP));
                time += STEP;
            }
            let outputs = api.standard.outputs().into_iter();
            let pressure = api.array("profile.pressure", PROFILE_POINTS);
            let point = Point {
                client: &client,
                before: client.save(),
                time,
                inputs: start,
                references: outputs.chain(pressure).collect(),
            };
            let here = point.step(0, 0.0).0;
            let stick = client.get("stick_fraction");
            regimes[if stick == 0.0 { 2 } else { usize::from(stick < 0.8) }] += 1;
            let columns: Vec<_> = (0..INPUTS.len()).map(|input| point.derivatives(input)).collect();
            for (input, column) in columns.iter().enumerate() {
                let signal = &INPUTS[input];
                // No difference can be taken of what a contact model refuses.
                if !signal.is_taken_by(contact) {
                    assert!(
                        column.iter().all(|derivative| *derivative == 0.0),
                        "{}: {column:?}",
                        signal.name
                    );
                    continue;
                }
                let nominal = match signal.name {
                    "creepage" => 1e-3,
                    "wheel_speed" | "vehicle_speed" if vehicle => 1e-2,
                    _ => signal.nominal,
                };
                let differences = point.differences(input, accuracy.change * nominal);
                for (row, difference) in differences.into_iter().enumerate() {
                    let Some(difference) = difference else {
                        corners += 1;
                        continue;
                    };
                    compared += 1;
                    let exact = column[row];
                    let scale = OUTPUTS[row].nominal.max(here[row].abs()) / nominal;
                    let error = (exact - difference).abs();
                    assert!(
                        error <= accuracy.relative * exact.abs() + accuracy.left / accuracy.change * scale,
                        "d {} / d {} = {exact}, by differences {difference}, at {start:?}",
                        OUTPUTS[row].name,
                        signal.name
                    );
                    if exact.abs() > 0.1 * scale {
                        large += 1;
                        worst = worst.max(error / exact.abs());
                    }
                }
            }
        }
        println!(
            "{compared} derivatives compared, {corners} at corners left out; largest relative error {worst:.1e} over the {large} that are not small"
        );
        println!("points in stick (more than 0.8 of the contact), partial slip, sliding: {regimes:?}");
        assert!(regimes.iter().all(|count| *count >= 3), "{regimes:?}");
        assert!(compared > 2 * corners, "{compared} {corners}");
    });
}
