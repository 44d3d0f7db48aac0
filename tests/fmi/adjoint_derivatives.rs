//! FMI 3.0: derivatives of weighted sums of outputs, Jᵀ s, against the directional derivatives J e of all outputs with respect to
//! every input.

use super::importer::{Api, Client, ContactModel, Fmi2, Fmi3, OK, Profiles, sideways, with_each_contact_model};
use wheelrail::signals::{INPUTS, OUTPUTS};
use wheelrail::torture::random::Random;

fn inputs(api: &Api) -> Vec<u32> {
    INPUTS.iter().map(|row| api.reference(row.name)).collect()
}

/// J, a column for each input.
fn jacobian(client: &Client) -> Vec<Vec<f64>> {
    let (api, unknowns) = (client.api, client.api.standard.outputs());
    let column = |known: u32| {
        let mut values = vec![f64::NAN; OUTPUTS.len()];
        client.expect(OK, client.directional(&unknowns, &[known], &[1.0], &mut values));
        values
    };
    inputs(api).into_iter().map(column).collect()
}

/// Jᵀ s.
fn adjoint(client: &Client, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Vec<f64> {
    let mut values = vec![f64::NAN; knowns.len()];
    // SAFETY: as many elements as are counted.
    client.expect(OK, unsafe {
        (client.api.fmi3.fmi3GetAdjointDerivative)(
            client.component,
            unknowns.as_ptr(),
            unknowns.len(),
            knowns.as_ptr(),
            knowns.len(),
            seed.as_ptr(),
            seed.len(),
            values.as_mut_ptr(),
            values.len(),
        )
    });
    values
}

/// Slips, with their source, that a contact model takes: profiles roll by speeds alone.
fn taken_by(contact: ContactModel, slips: &[(i32, f64)]) -> impl Iterator<Item = (i32, f64)> {
    slips
        .iter()
        .copied()
        .filter(move |(source, _)| contact != Profiles || *source == 2)
}

/// Some steps with a moving load: the rail has warmed up.
fn driven(api: &Api, contact: ContactModel, slip_source: i32, creepage: f64) -> Client<'_> {
    let client = Client::initializing(api, contact);
    client.expect(
        OK,
        client.set_integers(&[("slip_source", slip_source), ("wheel_heating", 2)]),
    );
    client.expect(OK, client.set(sideways(contact)));
    let rolling = 10.0 * (1.0 + creepage) / 0.46;
    client.expect(
        OK,
        client.set(&[
            ("creepage", creepage),
            ("vehicle_speed", 10.0),
            ("wheel_speed", rolling),
        ]),
    );
    client.expect(OK, client.exit());
    for step in 0..5 {
        client.expect(OK, client.set(&[("normal_load", 6e4 + 1e3 * f64::from(step))]));
        client.expect(OK, client.step(1e-3 * f64::from(step), 1e-3));
    }
    client
}

#[test]
fn adjoint_derivatives_are_the_transposed_directional_ones() {
    let api = &Api::load(Fmi3);
    for &contact in ContactModel::ALL {
        println!("{contact:?}");
        let mut random = Random::new(14, 0);
        let (unknowns, knowns) = (api.standard.outputs(), inputs(api));
        let mut entries = 0;
        // Stick, partial slip, sliding; a braked and a driven wheel, by creepage and by speeds.
        for (slip_source, creepage) in taken_by(contact, &[(1, 1e-4), (1, 3e-3), (2, -0.05), (2, 1e-3)]) {
            let client = driven(api, contact, slip_source, creepage);
            let columns = jacobian(&client);
            // One output at a time: the row of J itself, to the bit.
            for (row, output) in OUTPUTS.iter().enumerate() {
                let (entry, element) = api.standard.find(output.name);
                let mut seed = vec![0.0; entry.elements];
                seed[element.unwrap_or(0)] = 1.0;
                let gradient = adjoint(&client, &[entry.reference], &knowns, &seed);
                for (column, derivative) in columns.iter().zip(&gradient) {
                    assert_eq!(
                        derivative.to_bits(),
                        (0.0 + column[row]).to_bits(),
                        "{}",
                        OUTPUTS[row].name
                    );
                    entries += 1;
                }
            }
            // All at once with weights that make them comparable, as sums in another order.
            let weights: Vec<f64> = OUTPUTS
                .iter()
                .map(|row| random.between(-1.0, 1.0) / row.nominal)
                .collect();
            let gradient = adjoint(&client, &unknowns, &knowns, &weights);
            for ((column, derivative), input) in columns.iter().zip(&gradient).zip(INPUTS) {
                let terms = column
                    .iter()
                    .zip(&weights)
                    .map(|(derivative, weight)| derivative * weight);
                let size: f64 = terms.clone().map(f64::abs).sum();
                let sum: f64 = terms.rev().sum();
                // Each of as many sums rounds once.
                let allowed = f64::EPSILON * OUTPUTS.len() as f64 * size;
                assert!(
                    (derivative - sum).abs() <= allowed,
                    "{}: {derivative} {sum}",
                    input.name
                );
            }
            // sᵀ (J d) = (Jᵀ s)ᵀ d for any direction.
            let direction: Vec<f64> = INPUTS
                .iter()
                .map(|row| row.nominal * random.between(-1.0, 1.0))
                .collect();
            let mut forward = vec![f64::NAN; OUTPUTS.len()];
            client.expect(OK, client.directional(&unknowns, &knowns, &direction, &mut forward));
            let products = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>();
            let (one, other) = (products(&forward, &weights), products(&gradient, &direction));
            let size: f64 = columns
                .iter()
                .zip(&direction)
                .flat_map(|(column, step)| column.iter().zip(&weights).map(move |(d, w)| (d * w * step).abs()))
                .sum();
            let difference = one.iter().sum::<f64>() - other.iter().sum::<f64>();
            let allowed = f64::EPSILON * (INPUTS.len() + OUTPUTS.len()) as f64 * size;
            assert!(difference.abs() <= allowed, "{difference} {allowed}");
        }
        println!("{entries} derivatives are the same bits transposed");
    }
}

/// An output or an input that is named again counts again.
#[test]
fn repeated_names_add_up() {
    with_each_contact_model(&Api::load(Fmi3), |api, contact| {
        let client = driven(api, contact, 1, 3e-3);
        let [force, creepage, load] = ["traction_force", "creepage", "normal_load"].map(|name| api.reference(name));
        let once = adjoint(&client, &[force], &[creepage, load], &[3.0]);
        let often = adjoint(&client, &[force; 3], &[creepage, load, creepage], &[1.0; 3]);
        assert_eq!(often[0], often[2]);
        for (once, often) in once.iter().zip(&often) {
            assert!((once - often).abs() <= 4.0 * f64::EPSILON * once.abs());
        }
    });
}

#[test]
fn directional_derivatives_of_both_standards_have_the_same_bits() {
    let [two, three] = [Fmi2, Fmi3].map(Api::load);
    for &contact in ContactModel::ALL {
        for (slip_source, creepage) in taken_by(contact, &[(1, 3e-3), (2, -0.05)]) {
            let bits = |api: &Api| {
                let columns = jacobian(&driven(api, contact, slip_source, creepage));
                columns.into_iter().flatten().map(f64::to_bits).collect::<Vec<_>>()
            };
            assert_eq!(bits(&two), bits(&three));
        }
    }
}
