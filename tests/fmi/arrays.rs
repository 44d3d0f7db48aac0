//! FMI 3.0: arrays as one variable each, their lengths as structural parameters, and the types of integers.

use super::importer::{Api, Client, Fmi2, Fmi3, Line, OK, Patch, sideways, with_each_contact_model};
use wheelrail::fmi::variables::{FIELDS, PROFILES};
use wheelrail::parameters::Parameters;
use wheelrail::signals::CONTACTS;
use wheelrail::wheel_rail::Model;

/// An array of so many elements.
fn array(client: &Client, name: &str, elements: usize) -> Vec<f64> {
    let mut values = vec![f64::NAN; elements];
    client.expect(OK, client.get_references(&[client.api.reference(name)], &mut values));
    values
}

/// Lengths are set in configuration mode.
fn configure(client: &Client, [strips, cells]: [u64; 2]) {
    let api = &client.api.fmi3;
    let references = ["patch_strips", "patch_nodes"].map(|name| client.api.reference(name));
    // SAFETY: a live instance, two elements each.
    unsafe {
        client.expect(OK, (api.fmi3EnterConfigurationMode)(client.component));
        let values = [strips, cells];
        client.expect(
            OK,
            (api.fmi3SetUInt64)(client.component, references.as_ptr(), 2, values.as_ptr(), 2),
        );
        client.expect(OK, (api.fmi3ExitConfigurationMode)(client.component));
    }
}

/// In *Step Mode* after some steps, with fields of the given lengths.
fn patch(api: &Api, lengths: [u64; 2]) -> Client<'_> {
    let client = Client::coarse(api, Patch);
    configure(&client, lengths);
    client.expect(OK, client.begin(0.0, None));
    client.expect(OK, client.set(&[("creepage", 0.004)]));
    client.expect(OK, client.set(sideways(Patch)));
    client.expect(OK, client.exit());
    for step in 0..3 {
        client.expect(OK, client.step(1e-3 * f64::from(step), 1e-3));
    }
    client
}

#[test]
fn the_elements_of_profiles_are_the_variables_of_fmi2() {
    let [two, three] = [Fmi2, Fmi3].map(Api::load);
    with_each_contact_model(&two, |two, contact| {
        let clients = [two, &three].map(|api| {
            let client = Client::running(api, contact, &[("creepage", 0.004)]);
            client.expect(OK, client.step(0.0, 0.01));
            client
        });
        for column in &PROFILES {
            let [one, other] = clients.each_ref().map(|client| {
                let mut values = vec![f64::NAN; column.points];
                let references = client.api.array(column.name, column.points);
                client.expect(OK, client.get_references(&references, &mut values));
                values
            });
            assert_eq!(one, other, "{}", column.name);
        }
    });
}

/// Strips first, then cells along a strip: the last index runs fastest. Other lengths, other shapes.
#[test]
fn fields_of_a_patch_are_those_of_the_model() {
    let api = &Api::load(Fmi3);
    for [strips, cells] in [[7, 14], [5, 12], [9, 10]] {
        let client = patch(api, [strips, cells]);
        let [strips, cells] = [strips, cells].map(|length| length as usize);
        let x = array(&client, "patch.x", cells);
        let y = array(&client, "patch.y", strips);
        assert!(x.is_sorted() && y.is_sorted(), "{x:?} {y:?}");
        let field = |name: &str| array(&client, name, strips * cells);
        let pressure = field("patch.pressure");
        // The load, by the areas of the cells, which are all alike along and across.
        let area = (x[1] - x[0]) * (y[1] - y[0]);
        let load: f64 = pressure.iter().sum::<f64>() * area;
        assert!((load / client.get("normal_load") - 1.0).abs() < 1e-6, "{load}");
        let largest = pressure.iter().copied().fold(0.0, f64::max);
        assert_eq!(largest, client.get("peak_pressure"));
        let at = pressure.iter().position(|value| *value == largest).unwrap();
        // Under the middle of the contact, by either index.
        assert!(x[at % cells].abs() < 0.2 * (x[cells - 1] - x[0]), "{at}");
        assert!(y[at / cells].abs() < 0.2 * (y[strips - 1] - y[0]), "{at}");
        // Tractions where there is pressure, slip that they oppose, a rail that is no colder than its surroundings.
        let [shear_x, slip_x] = ["patch.shear_x", "patch.slip_x"].map(field);
        for (k, pressure) in pressure.iter().enumerate() {
            assert!(*pressure >= 0.0 && (*pressure > 0.0 || shear_x[k] == 0.0));
            assert!(slip_x[k].is_finite());
        }
        assert!(field("patch.temperature").iter().all(|value| *value >= 293.15 - 1e-9));
        let force: f64 = shear_x.iter().sum::<f64>() * area;
        assert!((force / client.get("traction_force")).abs() - 1.0 < 1e-6, "{force}");
    }
}

/// Windows first, then two halves of their strips, strips of a half, cells: the last index runs fastest. The windows that carry are the contacts.
#[test]
fn fields_of_profiles_are_those_of_the_contacts() {
    let api = &Api::load(Fmi3);
    for [strips, cells] in [[7, 14], [8, 12]] {
        let client = Client::new(api);
        configure(&client, [strips, cells]);
        client.expect(OK, client.set_integers(&[("contact_model", 3), ("slip_source", 2)]));
        client.expect(
            OK,
            client.set(&[
                ("vehicle_speed", 20.0),
                ("wheel_speed", 43.6),
                ("lateral_displacement", 5e-3),
            ]),
        );
        client.start();
        client.expect(OK, client.step(0.0, 1e-3));
        let (rows, cells) = (2 * strips as usize, cells as usize);
        let [length, breadth] =
            ["surface.cell_length", "surface.strip_breadth"].map(|name| array(&client, name, CONTACTS));
        let forces = array(&client, "contact.normal_force", CONTACTS);
        let inclinations = array(&client, "contact.inclination", CONTACTS);
        assert!(client.get("contacts") >= 2.0);
        let pressure = array(&client, "surface.pressure", CONTACTS * rows * cells);
        let x = array(&client, "surface.x", CONTACTS * cells);
        let inclination = array(&client, "surface.inclination", CONTACTS * rows);
        for window in 0..CONTACTS {
            let own = &pressure[window * rows * cells..(window + 1) * rows * cells];
            let force = length[window] * breadth[window] * own.iter().sum::<f64>();
            assert!(
                (force - forces[window]).abs() <= 1e-9 * forces[window],
                "{window}: {force}"
            );
            if forces[window] == 0.0 {
                continue;
            }
            let at = (0..own.len()).max_by(|&a, &b| own[a].total_cmp(&own[b])).unwrap();
            let off = inclination[window * rows + at / cells] - inclinations[window];
            assert!(off.abs() < 0.2, "{window}: {off}");
            assert!(x[window * cells + at % cells].abs() < 0.01);
            // Half as many strips again as a patch has; nothing beyond.
            let used = (3 * strips as usize).div_ceil(2);
            assert!(own[used * cells..].iter().all(|pressure| *pressure == 0.0));
        }
        let temperature = array(&client, "surface.temperature", CONTACTS * rows * cells);
        assert!(temperature.iter().all(|value| *value >= 293.15 - 1e-9));
    }
}

#[test]
fn fields_of_a_line_are_as_long_and_empty() {
    let api = &Api::load(Fmi3);
    let client = Client::coarse(api, Line);
    configure(&client, [5, 12]);
    client.start();
    for column in &FIELDS {
        let elements = [5, 12].into_iter().zip(column.over);
        let elements = elements
            .map(|(length, is_index)| if is_index { length } else { 1 })
            .product();
        let expected = if column.name == "patch.temperature" {
            293.15
        } else {
            0.0
        };
        assert_eq!(
            array(&client, column.name, elements),
            vec![expected; elements],
            "{}",
            column.name
        );
    }
}

/// The same lengths without configuration mode, for importers that do not know it.
#[test]
fn lengths_may_be_set_where_parameters_are() {
    let api = &Api::load(Fmi3);
    let configured = patch(api, [5, 12]);
    let client = Client::coarse(api, Patch);
    client.expect(OK, client.set_integers(&[("patch_strips", 5), ("patch_nodes", 12)]));
    client.expect(OK, client.set(&[("creepage", 0.004)]));
    client.expect(OK, client.set(sideways(Patch)));
    client.start();
    for step in 0..3 {
        client.expect(OK, client.step(1e-3 * f64::from(step), 1e-3));
    }
    assert_eq!(client.outputs(), configured.outputs());
}

#[test]
fn a_reset_brings_the_lengths_back() {
    let client = patch(&Api::load(Fmi3), [5, 12]).get_integer("patch_strips");
    assert_eq!(client, 5);
    let api = &Api::load(Fmi3);
    let client = patch(api, [5, 12]);
    client.expect(OK, client.reset());
    let Parameters {
        patch_strips,
        patch_nodes,
        ..
    } = Parameters::default();
    assert_eq!(client.get_integer("patch_strips"), patch_strips as i32);
    assert_eq!(client.get_integer("patch_nodes"), patch_nodes as i32);
}

/// Choices by number, a switch as Boolean, counts: what is set is read, and the model is that of these parameters.
#[test]
fn integers_of_every_type_are_set_and_read() {
    let api = &Api::load(Fmi3);
    let client = Client::new(api);
    let (f, c) = (&api.fmi3, client.component);
    let [control, heating, nodes, strips] =
        ["control", "wheel_heating", "contact_nodes", "patch_strips"].map(|name| api.reference(name));
    let (mut choice, mut switch, mut count, mut length) = (0, 0, 0, 0);
    // SAFETY: one element each.
    unsafe {
        client.expect(OK, (f.fmi3SetInt64)(c, &control, 1, &2, 1));
        client.expect(OK, (f.fmi3SetBoolean)(c, &heating, 1, &1, 1));
        client.expect(OK, (f.fmi3SetInt32)(c, &nodes, 1, &25, 1));
        client.expect(OK, (f.fmi3SetUInt64)(c, &strips, 1, &9, 1));
        client.expect(OK, (f.fmi3GetInt64)(c, &control, 1, &mut choice, 1));
        client.expect(OK, (f.fmi3GetBoolean)(c, &heating, 1, &mut switch, 1));
        client.expect(OK, (f.fmi3GetInt32)(c, &nodes, 1, &mut count, 1));
        client.expect(OK, (f.fmi3GetUInt64)(c, &strips, 1, &mut length, 1));
    }
    assert_eq!((choice, switch, count, length), (2, 1, 25, 9));
    client.start();
    let parameters = Parameters {
        control: wheelrail::parameters::Control::Penetration,
        wheel_heating: wheelrail::parameters::WheelHeating::On,
        contact_nodes: 25,
        ..Parameters::default()
    };
    let model = Model::new(parameters).unwrap();
    let state = model
        .initial_state(&mut model.workspace(), &wheelrail::Inputs::default())
        .unwrap();
    assert_eq!(client.get("traction_force"), state.outputs.traction_force);
    assert_eq!(client.get("peak_pressure"), state.outputs.peak_pressure);
}
