//! Probes of what only FMI 3.0 has: answers of a step, arrays, lengths, types of integers, configuration mode, derivatives with
//! counts of their own, functions of other interface types. probes.rs runs them.

use super::importer::{Answer, Arguments, Client, DISCARD, ERROR, Fmi3, OK, RIGHT};
use super::probes::{Given, advance, discard, probes, refuse, running};
use std::ffi::c_int;
use std::ptr::{null, null_mut};
use wheelrail::wheel_rail::PROFILE_POINTS;

/// A step of which one answer has no place.
fn step_without(client: &Client, missing: usize) -> c_int {
    let mut answer = Answer::NONE;
    let or_null = |place: usize, pointer: *mut u8| if place == missing { null_mut() } else { pointer };
    let time = if missing == 3 {
        null_mut()
    } else {
        &raw mut answer.last_successful_time
    };
    // SAFETY: null or valid places.
    let status = unsafe {
        (client.api.fmi3.fmi3DoStep)(
            client.component,
            0.0,
            0.01,
            1,
            or_null(0, &mut answer.event_handling_needed),
            or_null(1, &mut answer.terminate_simulation),
            or_null(2, &mut answer.early_return),
            time,
        )
    };
    // Nothing was written beside.
    assert!(answer.last_successful_time.is_nan());
    status
}

/// fmi3GetFloat64 of one variable with room for so many values.
fn read(client: &Client, name: &str, values: &mut [f64]) -> c_int {
    client.get_references(&[client.api.reference(name)], values)
}

/// fmi3EnterConfigurationMode, in *Instantiated*.
fn configuring(api: &Given) -> Client<'_> {
    let client = Client::coarse(api, api.contact);
    client.expect(OK, enter(&client));
    client
}

fn enter(client: &Client) -> c_int {
    // SAFETY: a live instance.
    unsafe { (client.api.fmi3.fmi3EnterConfigurationMode)(client.component) }
}

fn exit(client: &Client) -> c_int {
    // SAFETY: a live instance.
    unsafe { (client.api.fmi3.fmi3ExitConfigurationMode)(client.component) }
}

fn set_length(client: &Client, value: u64) -> c_int {
    let strips = client.api.reference("patch_strips");
    // SAFETY: one element.
    unsafe { (client.api.fmi3.fmi3SetUInt64)(client.component, &strips, 1, &value, 1) }
}

/// Jᵀ of one output by one input, with the given counts of seeds and sensitivities; there is room for two.
fn adjoint(client: &Client, output: &str, input: &str, seed: f64, counts: [usize; 2]) -> c_int {
    let (api, seeds, mut room) = (client.api, [seed; 2], [0.0; 2]);
    let (unknown, known) = (api.reference(output), api.reference(input));
    let (c, [n, m]) = (client.component, counts);
    // SAFETY: two elements, or more than memory holds.
    unsafe { (api.fmi3.fmi3GetAdjointDerivative)(c, &unknown, 1, &known, 1, seeds.as_ptr(), n, room.as_mut_ptr(), m) }
}

probes! {
    // Instantiation
    "scheduled execution makes none" of Fmi3: |api| { assert!(!api.instantiates(&Arguments { kind: 2, ..RIGHT })) }
    "event mode makes none" of Fmi3: |api| { assert!(!api.instantiates(&Arguments { event_mode: true, ..RIGHT })) }
    "variables of an intermediate update make none" of Fmi3: |api| {
        for intermediate_variables in [1, usize::MAX] {
            assert!(!api.instantiates(&Arguments { intermediate_variables, ..RIGHT }));
        }
    }
    "an importer that can return early has an instance" of Fmi3: |api| {
        assert!(api.instantiates(&Arguments { early_return: true, ..RIGHT }));
    }

    // fmi3DoStep
    "a step without a place for eventHandlingNeeded is refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, step_without(&client, 0));
    }
    "a step without a place for terminateSimulation is refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, step_without(&client, 1));
    }
    "a step without a place for earlyReturn is refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, step_without(&client, 2));
    }
    "a step without a place for lastSuccessfulTime is refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, step_without(&client, 3));
    }
    "a step with a place for the time that is no place of a double is refused" of Fmi3: |api| {
        let client = running(api);
        let mut places = [0_u8; 24];
        let odd = places.as_mut_ptr().wrapping_add(places.as_ptr().align_offset(8) + 1).cast();
        let step = api.fmi3.fmi3DoStep;
        refuse(&client, step(client.component, 0.0, 0.01, 1, &mut 0, &mut 0, &mut 0, odd));
    }
    "a step answers that nothing is to be done and how far it came" of Fmi3: |api| {
        let client = running(api);
        advance(&client, 0.0);
        let expected = Answer {
            event_handling_needed: 0,
            terminate_simulation: 0,
            early_return: 0,
            last_successful_time: 0.01,
        };
        assert_eq!(client.answer.get(), expected);
        assert_eq!(client.get("time"), 0.01);
    }

    // Counts of values, arrays
    "more values than variables are not read" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, read(&client, "normal_load", &mut [0.0; 2]));
    }
    "no values of a variable are not read" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, read(&client, "normal_load", &mut []));
    }
    "fewer values than variables are not set" of Fmi3: |api| {
        let client = running(api);
        let both = ["normal_load", "creepage"].map(|name| api.reference(name));
        refuse(&client, client.set_references(&both, &[5e4]));
    }
    "values without variables are not set" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, client.set_references(&[], &[5e4]));
    }
    "more values than memory holds are not read of a variable" of Fmi3: |api| {
        let client = running(api);
        let (load, mut value) = (api.reference("normal_load"), 0.0);
        refuse(&client, (api.fmi3.fmi3GetFloat64)(client.component, &load, 1, &mut value, usize::MAX));
    }
    "an array is not read in part" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, read(&client, "profile.pressure", &mut [0.0; PROFILE_POINTS - 1]));
    }
    "an array is not read with an element more" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, read(&client, "profile.pressure", &mut [0.0; PROFILE_POINTS + 1]));
    }
    "a field has as many values as cells" of Fmi3: |api| {
        let client = running(api);
        let cells = (client.get_integer("patch_strips") * client.get_integer("patch_nodes")) as usize;
        let mut values = vec![f64::NAN; cells];
        client.expect(OK, read(&client, "patch.pressure", &mut values));
        assert!(values.iter().all(|value| value.is_finite()));
        refuse(&client, read(&client, "patch.pressure", &mut vec![0.0; cells + 1]));
    }
    "a parameter's array is not set in part" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, client.set_references(&[api.reference("friction_table.coefficient")], &[0.3; 9]));
    }
    "of an array with an element that cannot be nothing is set" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        let before = client.get("friction_table.coefficient[1]");
        let status = client.set(&[("friction_table.coefficient[1]", 0.2), ("friction_table.coefficient[7]", f64::NAN)]);
        client.expect(DISCARD, status);
        assert!(client.last_message().contains("friction_table.coefficient[7]"));
        assert_eq!(client.get("friction_table.coefficient[1]"), before);
    }
    "an integer has one value" of Fmi3: |api| {
        let client = running(api);
        let (nodes, mut values) = (api.reference("contact_nodes"), [0; 2]);
        refuse(&client, (api.fmi3.fmi3GetInt32)(client.component, &nodes, 1, values.as_mut_ptr(), 2));
    }
    "integers without values are not set" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, (api.fmi3.fmi3SetInt32)(client.component, &api.reference("contact_nodes"), 1, null(), 0));
    }
    "time is not set" of Fmi3: |api| { let client = running(api); refuse(&client, client.set(&[("time", 1.0)])); }
    "outputs are not read before the initialisation" of Fmi3: |api| {
        let client = Client::coarse(api, api.contact);
        assert_eq!(client.get("normal_load"), 6e4);
        refuse(&client, read(&client, "traction_force", &mut [0.0]));
    }

    // Types
    "a choice is not read as an Int32" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3GetInt32)(client.component, &api.reference("control"), 1, &mut 0, 1));
    }
    "a count is not read as an enumeration" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3GetInt64)(client.component, &api.reference("contact_nodes"), 1, &mut 0, 1));
    }
    "a length is not read as an Int32" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3GetInt32)(client.component, &api.reference("patch_strips"), 1, &mut 0, 1));
    }
    "a Boolean is not set as an enumeration" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, (api.fmi3.fmi3SetInt64)(client.component, &api.reference("wheel_heating"), 1, &1, 1));
    }
    "a real number is not read as a Float32" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3GetFloat32)(client.component, &api.reference("normal_load"), 1, &mut 0.0, 1));
    }
    "there is nothing of the types that no variable has" of Fmi3: |api| {
        let reference = api.reference("contact_nodes");
        let f = &api.fmi3;
        let calls: [fn(&Given, &Client, *const u32) -> c_int; 7] = [
            |api, client, vr| (api.fmi3.fmi3GetInt8)(client.component, vr, 1, &mut 0, 1),
            |api, client, vr| (api.fmi3.fmi3SetUInt8)(client.component, vr, 1, &0, 1),
            |api, client, vr| (api.fmi3.fmi3GetInt16)(client.component, vr, 1, &mut 0, 1),
            |api, client, vr| (api.fmi3.fmi3SetUInt16)(client.component, vr, 1, &0, 1),
            |api, client, vr| (api.fmi3.fmi3GetUInt32)(client.component, vr, 1, &mut 0, 1),
            |api, client, vr| (api.fmi3.fmi3GetBinary)(client.component, vr, 1, &mut 0, &mut null(), 1),
            |api, client, vr| (api.fmi3.fmi3SetBinary)(client.component, vr, 1, &0, &null(), 1),
        ];
        let _ = f;
        for call in calls {
            let client = Client::initializing(api, api.contact);
            refuse(&client, call(api, &client, &reference));
        }
    }
    "a choice that has no name is discarded" of Fmi3: |api| {
        let control = api.reference("control");
        for value in [0, -1, 99, i64::MAX, i64::MIN, 1 << 32 | 1] {
            let client = Client::initializing(api, api.contact);
            client.expect(DISCARD, (api.fmi3.fmi3SetInt64)(client.component, &control, 1, &value, 1));
            assert!(client.last_message().contains("allowed is"));
            client.expect(OK, client.exit());
            advance(&client, 0.0);
        }
    }
    "a Boolean that is no bool of C is true" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        let heating = api.reference("wheel_heating");
        for (given, expected) in [(0, 0), (1, 1), (77, 1), (0xff, 1)] {
            let mut value = 9;
            client.expect(OK, (api.fmi3.fmi3SetBoolean)(client.component, &heating, 1, &given, 1));
            client.expect(OK, (api.fmi3.fmi3GetBoolean)(client.component, &heating, 1, &mut value, 1));
            assert_eq!(value, expected);
        }
    }

    // Configuration mode and lengths
    "a length is not set in initialization mode" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, set_length(&client, 9));
    }
    "a length is not set in step mode" of Fmi3: |api| { let client = running(api); refuse(&client, set_length(&client, 9)); }
    "a length beyond its range is discarded" of Fmi3: |api| {
        let client = configuring(api);
        for value in [0, 2, 102, 1 << 31, 1 << 63, u64::MAX] {
            client.expect(DISCARD, set_length(&client, value));
            assert!(client.last_message().contains("patch_strips = "));
        }
        client.expect(OK, exit(&client));
        client.start();
        advance(&client, 0.0);
    }
    "configuration mode is not entered twice" of Fmi3: |api| { let client = configuring(api); refuse(&client, enter(&client)); }
    "configuration mode is not left before it is entered" of Fmi3: |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, exit(&client));
    }
    "configuration mode is not entered during the initialisation" of Fmi3: |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, enter(&client));
    }
    "configuration mode is not entered between steps" of Fmi3: |api| { let client = running(api); refuse(&client, enter(&client)); }
    "the initialisation does not begin in configuration mode" of Fmi3: |api| {
        let client = configuring(api);
        refuse(&client, client.enter());
    }
    "no input is set in configuration mode" of Fmi3: |api| {
        let client = configuring(api);
        refuse(&client, client.set(&[("normal_load", 5e4)]));
    }
    "nothing is read in configuration mode" of Fmi3: |api| {
        let client = configuring(api);
        refuse(&client, read(&client, "normal_load", &mut [0.0]));
    }
    "a state of configuration mode leads back there" of Fmi3: |api| {
        let client = configuring(api);
        let handle = client.save();
        client.expect(OK, exit(&client));
        client.start();
        client.expect(OK, client.restore(handle));
        client.expect(OK, set_length(&client, 9));
        client.expect(OK, exit(&client));
        client.start();
        advance(&client, 0.0);
    }

    // Derivatives
    "a direction with an element more is refused" of Fmi3: |api| {
        let client = running(api);
        let (output, input) = (api.reference("traction_force"), api.reference("creepage"));
        let (seeds, derivative) = ([1.0; 2], api.fmi3.fmi3GetDirectionalDerivative);
        refuse(&client, derivative(client.component, &output, 1, &input, 1, seeds.as_ptr(), 2, &mut 0.0, 1));
    }
    "a derivative without a place is refused" of Fmi3: |api| {
        let client = running(api);
        let (output, input) = (api.reference("traction_force"), api.reference("creepage"));
        let derivative = api.fmi3.fmi3GetDirectionalDerivative;
        refuse(&client, derivative(client.component, &output, 1, &input, 1, &1.0, 1, null_mut(), 0));
    }
    "weights with an element more are refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, adjoint(&client, "traction_force", "creepage", 1.0, [2, 1]));
    }
    "more sensitivities than inputs are refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, adjoint(&client, "traction_force", "creepage", 1.0, [1, 2]));
    }
    "more weights than memory holds are refused" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, adjoint(&client, "traction_force", "creepage", 1.0, [usize::MAX, 1]));
    }
    "a weight that is not finite is refused" of Fmi3: |api| {
        for weight in [f64::NAN, f64::INFINITY] {
            let client = running(api);
            refuse(&client, adjoint(&client, "traction_force", "creepage", weight, [1, 1]));
        }
    }
    "there is no adjoint derivative of an input" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, adjoint(&client, "creepage", "creepage", 1.0, [1, 1]));
    }
    "there is no adjoint derivative with respect to a profile" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, adjoint(&client, "traction_force", "profile.pressure", 1.0, [1, 1]));
    }
    "an adjoint derivative of nothing is 0" of Fmi3: |api| {
        let client = running(api);
        let (creepage, mut value) = (api.reference("creepage"), f64::NAN);
        let adjoint = api.fmi3.fmi3GetAdjointDerivative;
        client.expect(OK, adjoint(client.component, null(), 0, &creepage, 1, null(), 0, &mut value, 1));
        assert_eq!(value, 0.0);
    }
    "output derivatives with a place more are refused" of Fmi3: |api| {
        let client = running(api);
        let (force, mut values) = (api.reference("traction_force"), [0.0; 2]);
        let rates = api.fmi3.fmi3GetOutputDerivatives;
        refuse(&client, rates(client.component, &force, 1, &1, values.as_mut_ptr(), 2));
    }

    // What the unit does not have
    "event mode is not entered" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3EnterEventMode)(client.component));
    }
    "discrete states are not updated, and no place is looked at" of Fmi3: |api| {
        let client = running(api);
        let none = null_mut();
        refuse(&client, (api.fmi3.fmi3UpdateDiscreteStates)(client.component, none, none, none, none, none, null_mut()));
    }
    "there are no clocks, and no pointer is looked at" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3GetClock)(client.component, null(), 1, null_mut()));
        let interval = api.fmi3.fmi3GetIntervalDecimal;
        refuse(&client, interval(client.component, null(), usize::MAX, null_mut(), null_mut()));
    }
    "there are no continuous states, and no pointer is looked at" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3SetContinuousStates)(client.component, null(), 3));
        refuse(&client, (api.fmi3.fmi3GetNumberOfContinuousStates)(client.component, null_mut()));
    }
    "there are no dependencies of elements" of Fmi3: |api| {
        let client = running(api);
        let force = api.reference("traction_force");
        refuse(&client, (api.fmi3.fmi3GetNumberOfVariableDependencies)(client.component, force, null_mut()));
    }
    "there is no partition to activate" of Fmi3: |api| {
        let client = running(api);
        refuse(&client, (api.fmi3.fmi3ActivateModelPartition)(client.component, 0, f64::NAN));
    }
    "a step that cannot be completed from its start is discarded and changes nothing" of Fmi3: |api| {
        let client = running(api);
        let before = client.outputs();
        // A rate of FMI 2.0, in a state that both read, takes the load out of its range.
        let other = super::importer::Api::load(super::importer::Fmi2);
        let two = Client::running(&other, api.contact, &[("creepage", 0.004)]);
        two.expect(OK, two.set_rates(&[("normal_load", 1, 1e300)]));
        let (bytes, mut handle) = (two.serialize(two.save()), null_mut());
        client.expect(OK, client.deserialize(&bytes, &mut handle));
        client.expect(OK, client.restore(handle));
        client.expect(DISCARD, client.step(0.0, 0.01));
        assert_eq!(client.outputs(), before);
        client.expect(ERROR, client.step(0.01, 0.01));
    }
    "a length beyond its range is discarded without configuration mode too" of Fmi3: |api| {
        let client = Client::coarse(api, api.contact);
        client.expect(DISCARD, set_length(&client, 1));
        client.start();
        discard(&client, client.set(&[("normal_load", f64::NAN)]));
    }
}
