//! fmi2GetDirectionalDerivative of every output with respect to every input against differences of a step that is rolled
//! back with fmi2SetFMUstate, over random operating points in stick, partial slip and sliding.

use super::importer::{Api, Client, Handle, OK, reference};
use wheelrail::parameters::Parameters;
use wheelrail::signals::{INPUTS, OUTPUTS};
use wheelrail::torture::random::Random;

const STEP: f64 = 1e-3;
const POINTS: usize = 30;
/// Relative step of a difference.
const CHANGE: f64 = 4e-4;
/// Relative change of all inputs in the step that is differentiated. Without it the operator split would rest after two
/// iterations, and the difference quotient miss the derivative by the square of the contraction, up to 1e-3 whatever its step.
const MOVE: f64 = 0.02;
/// The same for load and temperatures: what comes in changes the tractions little, least those of like bodies, whose split
/// contracts fastest.
const LARGE_MOVE: f64 = -0.1;

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
        let mut values = vec![f64::NAN; self.references.len()];
        client.expect(OK, client.get_references(&self.references, &mut values));
        let pressure = values.split_off(OUTPUTS.len());
        (values, pressure.iter().map(|p| *p > 0.0).collect())
    }

    /// Derivatives of all outputs with respect to one input by differences with Richardson's extrapolation; `None` for
    /// those between whose ends a node joins or leaves the contact, or the friction law has a corner.
    fn differences(&self, input: usize, change: f64) -> Vec<Option<f64>> {
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
                let allowed = 3e-5 * further.abs() + 4e-9 * OUTPUTS[row].nominal.max(here.0[row].abs());
                let smooth = one_set
                    && (further - 2.0 * (forward + backward)).abs() <= allowed
                    && (further_curvature - 4.0 * curvature).abs() <= allowed;
                smooth.then_some((8.0 * (forward + backward) - further) / (12.0 * change))
            })
            .collect()
    }

    /// The column of the interface.
    fn derivatives(&self, input: usize) -> Vec<f64> {
        let (client, unknowns) = (self.client, &self.references[..OUTPUTS.len()]);
        let (known, mut values) = (reference(INPUTS[input].name), vec![f64::NAN; OUTPUTS.len()]);
        // SAFETY: as many elements as references.
        let status = unsafe {
            (client.api.directional_derivative)(
                client.component,
                unknowns.as_ptr(),
                unknowns.len(),
                &known,
                1,
                &1.0,
                values.as_mut_ptr(),
            )
        };
        client.expect(OK, status);
        values
    }
}

#[test]
fn directional_derivatives_are_the_differences_of_a_rolled_back_step() {
    let api = Api::load();
    let mut random = Random::new(3, 0);
    let (mut compared, mut large, mut corners, mut regimes, mut worst) = (0, 0, 0, [0; 3], 0.0_f64);
    for point in 0..POINTS {
        let vehicle = point % 2 == 1;
        let client = Client::new(&api);
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
            0 => random.between(-0.0022, -0.001),
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
        // In the order of the inputs, any other at its start value.
        let start: [_; INPUTS.len()] = std::array::from_fn(|row| {
            let signal = &INPUTS[row];
            let value = chosen.iter().find(|(name, _)| *name == signal.name);
            (signal.name, value.map_or(signal.default, |(_, value)| *value))
        });
        let moved = start.map(|(name, value)| match name {
            "normal_load" | "ambient_temperature" | "incoming_temperature" => (name, value * (1.0 + LARGE_MOVE)),
            _ => (name, value * (1.0 + MOVE)),
        });
        client.expect(OK, client.set(&moved));
        client.expect(OK, client.setup(0.0, None));
        client.expect(OK, client.enter());
        client.expect(OK, client.exit());
        let mut time = 0.0;
        for _ in 0..20 {
            client.expect(OK, client.step(time, STEP));
            time += STEP;
        }
        let outputs = OUTPUTS.iter().map(|row| reference(row.name));
        let pressure = (1..=61).map(|node| reference(&format!("profile.pressure[{node}]")));
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
            // No difference can be taken of what a line contact refuses.
            if signal.patch_only {
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
            let differences = point.differences(input, CHANGE * nominal);
            for (row, difference) in differences.into_iter().enumerate() {
                let Some(difference) = difference else {
                    corners += 1;
                    continue;
                };
                compared += 1;
                let exact = column[row];
                // 1e-4 of the derivative; below, the split's tolerance of 1e-9 by the weights (1.5) and the relative step of
                // a difference.
                let scale = OUTPUTS[row].nominal.max(here[row].abs()) / nominal;
                let error = (exact - difference).abs();
                assert!(
                    error <= 1e-4 * exact.abs() + 1.5 * 1e-9 / CHANGE * scale,
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
}
