//! Braking and re-acceleration at steps of 1 ms under random load, creepages and friction: every step completes, all outputs
//! stay finite and within physical bounds, and the memory stays flat. A line is driven by FMI 2.0 and a patch by FMI 3.0, and every
//! fiftieth step is repeated by the other one from a serialised state: it gives the same bits. A minute of a line and a third of that of a coarse patch by
//! default, an hour and a third with `WHEELRAIL_SOAK_MINUTES=60 cargo test --release --test fmi -- --nocapture soak`.

use super::importer::{Api, Client, ContactModel, Fmi2, Fmi3, Handle, Line, OK, Patch, Profiles, Standard};
use super::own_process::in_own_process;
use std::env::var;
use std::fs::read_to_string;
use std::ptr::null_mut;
use std::time::{Duration, Instant};
use wheelrail::parameters::Parameters;
use wheelrail::signals::OUTPUTS;
use wheelrail::torture::random::Random;
use wheelrail::wheel_rail::PROFILE_POINTS;

/// Communication step, [s].
const STEP: f64 = 1e-3;
/// Steps between two checks of the profiles.
const PROFILE_STEPS: u64 = 1000;
/// Steps between two that are repeated from a saved state.
const REPEATED_STEPS: u64 = 50;
/// Memory that may come and go with the allocator, [KiB].
const SLACK: u64 = 256;

/// A signal that moves from one value to the next, in a jump or along a ramp.
#[derive(Clone, Copy)]
struct Ramp {
    value: f64,
    target: f64,
    rate: f64,
}

impl Ramp {
    fn at(value: f64) -> Ramp {
        Ramp {
            value,
            target: value,
            rate: 0.0,
        }
    }

    fn advance(&mut self) -> f64 {
        let left = self.target - self.value;
        let step = self.rate * STEP;
        self.value = if left.abs() <= step {
            self.target
        } else {
            self.value + step.copysign(left)
        };
        self.value
    }

    fn to(&mut self, target: f64, duration: f64) {
        self.rate = (target - self.value).abs() / duration;
        self.target = target;
    }
}

/// The driver, the track and the weather.
struct Scenario {
    random: Random,
    speed: Ramp,
    creepage: Ramp,
    load: Ramp,
    friction_scale: Ramp,
    ambient: Ramp,
    /// Lateral and spin creepage, the latter in 1/m: of a patch.
    sideways: Option<[Ramp; 2]>,
    /// Steps left until the next choice of the speed.
    manoeuvre: u64,
    /// Steps left with the wheel off the rail, and the load afterwards.
    lifted: Option<(u64, f64)>,
}

/// What a step is given.
#[derive(Debug, Clone, Copy)]
struct Given {
    vehicle_speed: f64,
    wheel_speed: f64,
    normal_load: f64,
    friction_scale: f64,
    ambient_temperature: f64,
    lateral_speed: f64,
    spin_rate: f64,
}

impl Scenario {
    fn new(seed: u64, contact: ContactModel) -> Scenario {
        Scenario {
            random: Random::new(seed, 0),
            speed: Ramp::at(20.0),
            creepage: Ramp::at(0.0),
            load: Ramp::at(60e3),
            friction_scale: Ramp::at(1.0),
            ambient: Ramp::at(293.15),
            sideways: (contact == Patch).then_some([Ramp::at(0.0); 2]),
            manoeuvre: 0,
            lifted: None,
        }
    }

    /// The next choice of the speed: brake to standstill, wait, accelerate, cruise, or turn round.
    fn choose_speed(&mut self) {
        let random = &mut self.random;
        let now = self.speed.value;
        let target = match random.count(0, 4) {
            0 | 1 if now != 0.0 => 0.0,
            0 => now,
            1 => random.between(-10.0, 40.0),
            2 => random.between(0.0, 1.0),
            _ => random.between(1.0, 40.0),
        };
        let acceleration = random.between(0.3, 3.0);
        let duration = ((target - now).abs() / acceleration).max(0.5);
        self.speed.to(target, duration);
        self.manoeuvre = ((duration + random.between(0.2, 3.0)) / STEP) as u64;
    }

    fn choose_creepage(&mut self) {
        let random = &mut self.random;
        let target = match random.count(0, 7) {
            // Locked wheel, slide, partial slip, free rolling.
            0 => -1.0,
            1 => random.between(-0.5, -0.02),
            2 => random.between(0.02, 0.3),
            3 => 0.0,
            _ => random.between(-0.006, 0.006),
        };
        let duration = random.between(STEP, 0.3);
        self.creepage.to(target, duration);
    }

    fn advance(&mut self) -> Given {
        if self.manoeuvre == 0 {
            self.choose_speed();
        }
        self.manoeuvre -= 1;
        if self.random.chance(1e-3) {
            self.choose_creepage();
        }
        if self.random.chance(2e-3) {
            let (target, duration) = (self.random.between(0.15, 1.3), self.random.between(STEP, 0.1));
            self.friction_scale.to(target, duration);
        }
        if self.random.chance(1e-4) {
            let (target, duration) = (self.random.between(250.0, 320.0), self.random.between(1.0, 20.0));
            self.ambient.to(target, duration);
        }
        self.lifted = match self.lifted {
            Some((0, load)) => {
                self.load.to(load, STEP);
                None
            }
            Some((steps, load)) => Some((steps - 1, load)),
            None if self.random.chance(2e-4) => {
                let load = self.load.value;
                let duration = self.random.between(STEP, 0.05);
                self.load.to(0.0, duration);
                Some((((duration + self.random.between(0.0, 0.2)) / STEP) as u64, load))
            }
            None => {
                if self.random.chance(5e-3) {
                    let (target, duration) = (self.random.between(15e3, 98e3), self.random.between(STEP, 0.1));
                    self.load.to(target, duration);
                }
                None
            }
        };
        let vehicle_speed = self.speed.advance();
        let [lateral, spin] = self.move_sideways();
        // A wheel that stands may slip sideways, and turn on the spot.
        let speed = vehicle_speed.abs().max(1.0);
        Given {
            vehicle_speed,
            wheel_speed: vehicle_speed * (1.0 + self.creepage.advance()) / Parameters::default().wheel_radius,
            normal_load: self.load.advance(),
            friction_scale: self.friction_scale.advance(),
            ambient_temperature: self.ambient.advance(),
            lateral_speed: lateral * speed,
            spin_rate: spin * speed,
        }
    }

    /// Lateral and spin creepage.
    fn move_sideways(&mut self) -> [f64; 2] {
        let Some(ramps) = &mut self.sideways else {
            return [0.0; 2];
        };
        for (ramp, largest) in ramps.iter_mut().zip([0.01, 1.0]) {
            if self.random.chance(5e-3) {
                // Mostly small, and none at times.
                let share = self.random.between(-1.0, 1.0).powi(3);
                let target = if self.random.chance(0.2) { 0.0 } else { largest * share };
                ramp.to(target, self.random.between(STEP, 0.3));
            }
        }
        ramps.each_mut().map(Ramp::advance)
    }
}

/// Resident memory now and at its peak, [KiB].
fn memory() -> (u64, u64) {
    let status = read_to_string("/proc/self/status").expect("status");
    let line = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name)).expect("a line");
        line.split_whitespace()
            .nth(1)
            .expect("a number")
            .parse()
            .expect("a number")
    };
    (line("VmRSS:"), line("VmHWM:"))
}

/// How often the run was where.
#[derive(Debug, Default)]
struct Tally {
    standing: u64,
    creeping: u64,
    sliding: u64,
    lifted: u64,
    failed: u64,
    repeated: u64,
    slowest: Duration,
}

fn simulate(standard: Standard, contact: ContactModel, steps: u64) {
    let [api, other] = [standard, standard.other()].map(Api::load);
    let running = |api| {
        let client = match contact {
            Line => Client::new(api),
            Patch | Profiles => Client::coarse(api, contact),
        };
        client.expect(OK, client.set_integers(&[("slip_source", 2)]));
        client.start();
        client
    };
    let (client, other) = (running(&api), running(&other));
    let inputs = [
        "vehicle_speed",
        "wheel_speed",
        "normal_load",
        "friction_scale",
        "ambient_temperature",
        "incoming_temperature",
        "lateral_speed",
        "spin_rate",
    ]
    .map(|name| api.reference(name));
    let outputs = api.standard.outputs();
    let column = |name: &str| OUTPUTS.iter().position(|row| row.name == name).expect("an output");
    let totals = ["worn_volume", "friction_energy", "distance", "wheel_wear_depth"].map(column);
    let not_negative = [
        "peak_pressure",
        "peak_shear",
        "contact_length",
        "friction_power",
        "wear_rate",
        "wear_depth",
        "contact_breadth",
        "contact_area",
    ]
    .map(column);
    let [traction, lateral, temperature, stick] =
        ["traction_force", "lateral_force", "peak_temperature", "stick_fraction"].map(column);
    let profiles = ["profile.pressure", "profile.wear_depth", "profile.temperature"];
    let profiles: Vec<u32> = profiles
        .iter()
        .flat_map(|name| api.array(name, PROFILE_POINTS))
        .collect();
    let mut locals = vec![0.0; 3 * PROFILE_POINTS];

    let mut scenario = Scenario::new(20_240_607, contact);
    let mut values = vec![0.0; OUTPUTS.len()];
    let mut last = values.clone();
    let mut tally = Tally::default();
    let mut handle: Handle = null_mut();
    let mut after_warm_up = 0;
    let (mut time, start) = (0.0, Instant::now());
    for step in 0..steps {
        let given = scenario.advance();
        let set = [
            given.vehicle_speed,
            given.wheel_speed,
            given.normal_load,
            given.friction_scale,
            given.ambient_temperature,
            // The rail comes in at ambient.
            given.ambient_temperature,
            given.lateral_speed,
            given.spin_rate,
        ];
        // SAFETY: as many values as references, and a variable.
        unsafe {
            client.expect(
                OK,
                api.set_real(client.component, inputs.as_ptr(), inputs.len(), set.as_ptr()),
            );
            client.expect(OK, api.get_state(client.component, &mut handle));
        }
        let (begin, before) = (Instant::now(), time);
        let status = client.step(time, STEP);
        tally.slowest = tally.slowest.max(begin.elapsed());
        if status != OK {
            tally.failed += 1;
            println!(
                "step {step}, status {status}: {given:?}, creepage {}: {}",
                scenario.creepage.value,
                client.last_message()
            );
            report(&client, handle, step);
            // As a master would: back, and on with a wheel that rolls.
            client.expect(OK, client.restore(handle));
            client.expect(
                OK,
                client.set(&[("wheel_speed", given.vehicle_speed / Parameters::default().wheel_radius)]),
            );
            let status = client.step(time, STEP);
            if status != OK {
                client.expect(OK, client.restore(handle));
            }
        }
        time += STEP;
        if status != OK {
            // The time of the last communication point that stands.
            time = client.last_successful_time();
        }
        client.expect(OK, client.get_references(&outputs, &mut values));
        for (row, value) in OUTPUTS.iter().zip(&values) {
            assert!(value.is_finite(), "step {step}: {} = {value} at {given:?}", row.name);
        }
        if status == OK {
            check(
                step,
                &given,
                values[traction].hypot(values[lateral]),
                values[temperature],
            );
        }
        for row in totals {
            let (now, before) = (values[row], last[row]);
            assert!(
                now >= before,
                "step {step}: {} fell from {before} to {now}",
                OUTPUTS[row].name
            );
        }
        for row in not_negative {
            assert!(
                values[row] >= 0.0,
                "step {step}: {} = {}",
                OUTPUTS[row].name,
                values[row]
            );
        }
        last.copy_from_slice(&values);
        if step % REPEATED_STEPS == 0 && status == OK {
            tally.repeated += 1;
            repeat(&client, &other, handle, before);
        }
        tally.standing += u64::from(given.vehicle_speed == 0.0);
        tally.creeping += u64::from(given.vehicle_speed != 0.0 && given.vehicle_speed.abs() < 1.0);
        tally.lifted += u64::from(given.normal_load == 0.0);
        tally.sliding += u64::from(given.normal_load > 0.0 && values[stick] == 0.0);

        if step % PROFILE_STEPS == 0 {
            client.expect(OK, client.get_references(&profiles, &mut locals));
            let (not_negative, temperatures) = locals.split_at(2 * PROFILE_POINTS);
            assert!(not_negative.iter().all(|value| *value >= 0.0), "step {step}: {given:?}");
            let coldest = temperatures.iter().fold(f64::INFINITY, |m, value| value.min(m));
            // Round-off of the absolute temperature.
            assert!(
                coldest >= given.ambient_temperature - 1e-9,
                "step {step}: {coldest} K at {given:?}"
            );
        }
        if step == steps / 10 {
            after_warm_up = memory().0;
        }
    }
    let (resident, peak) = memory();
    let wall = start.elapsed().as_secs_f64();
    println!(
        "{standard:?}, {contact:?}: {steps} steps in {wall:.0} s, {:.3} ms each; {tally:?}",
        1e3 * wall / steps as f64
    );
    println!("memory: {after_warm_up} KiB after a tenth, {resident} KiB at the end, {peak} KiB at most");
    assert!(resident <= after_warm_up + SLACK, "memory has grown");
    assert!(
        tally.standing > 0 && tally.creeping > 0 && tally.sliding > 0 && tally.lifted > 0,
        "{tally:?}"
    );
    assert_eq!(tally.failed, 0, "steps failed");
}

/// Coulomb's bound, and no rail colder than its surroundings.
fn check(step: u64, given: &Given, friction: f64, temperature: f64) {
    let bound = Parameters::default().friction_cold * given.friction_scale * given.normal_load;
    // The friction law holds to the tolerance of the mechanics.
    assert!(
        friction <= bound * (1.0 + 1e-6),
        "step {step}: {friction} N > {bound} N at {given:?}"
    );
    assert!(
        temperature >= given.ambient_temperature,
        "step {step}: {temperature} K at {given:?}"
    );
}

/// Repeats a step from the state before it, in the same instance and, serialised, in another one: the same bits. The
/// other one was left wherever the repetition before had ended.
fn repeat(client: &Client, other: &Client, handle: Handle, time: f64) {
    let expected = client.outputs();
    client.expect(OK, client.restore(handle));
    client.expect(OK, client.step(time, STEP));
    assert_eq!(client.outputs(), expected, "repeated at {time} s");
    let mut copy = null_mut();
    other.expect(OK, other.deserialize(&client.serialize(handle), &mut copy));
    other.expect(OK, other.restore(copy));
    other.expect(OK, other.step(time, STEP));
    assert_eq!(other.outputs(), expected, "in another instance at {time} s");
    // SAFETY: a state of this instance.
    other.expect(OK, unsafe { other.api.free_state(other.component, &mut copy) });
}

/// Where WHEELRAIL_SOAK_FAILURES names a folder, the state before a step that failed goes there, serialised.
fn report(client: &Client, handle: Handle, step: u64) {
    if let Some(folder) = std::env::var_os("WHEELRAIL_SOAK_FAILURES") {
        let path = std::path::Path::new(&folder).join(format!("{step}.state"));
        std::fs::write(path, client.serialize(handle)).expect("the state is written");
    }
}

/// So many steps for each minute that the environment asks for; one by default.
fn simulate_minutes(standard: Standard, contact: ContactModel, steps: u64) {
    let minutes = var("WHEELRAIL_SOAK_MINUTES").map_or(1, |text| text.parse().expect("whole minutes"));
    simulate(standard, contact, steps * minutes);
}

#[test]
fn braking_and_accelerating_goes_on_and_on() {
    in_own_process("soak::braking_and_accelerating_goes_on_and_on", || {
        simulate_minutes(Fmi2, Line, 60_000);
    });
}

#[test]
fn braking_and_accelerating_goes_on_and_on_with_a_patch() {
    in_own_process("soak::braking_and_accelerating_goes_on_and_on_with_a_patch", || {
        simulate_minutes(Fmi3, Patch, 20_000);
    });
}
