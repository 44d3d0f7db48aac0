//! The output sensitivities are the derivatives of a step, at random: of a line and of a patch, for each law of friction. A few cases a law, the
//! same in every run; `DERIVATIVE_CASES` says how many or which ones, and `make derivatives` draws two thousand.

use crate::derivatives::{Mismatch, Tally, compare, does_not_rest};
use crate::setups::{Falling, Layer, line, patch, rolling, rolling_straight, settle};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::ops::Range;
use wheelrail::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource, TABLE_POINTS, Wheel, WheelHeating};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::Model;

/// Cases of a law, unless `DERIVATIVE_CASES` says which.
const CASES: usize = 6;

/// Share of all derivatives that are compared at least: the rest is at corners.
const LEAST_COMPARED: f64 = 0.7;

/// Share of them that may be at corners which the state does not name.
const LARGEST_UNNAMED: f64 = 0.02;

/// Share of the cases of unlike bodies on friction that falls and remembers whose step may be staggered; of few cases one may.
const LARGEST_STAGGERED: f64 = 0.02;

/// A step to differentiate.
#[derive(Debug, Clone)]
struct Case {
    parameters: Parameters,
    inputs: Inputs,
    step: f64,
}

/// Law of friction of the cases.
#[derive(Debug, Clone, Copy)]
enum Law {
    /// A law of temperature.
    Static(FrictionLaw),
    /// Any of them, falling with slip, mostly with a memory.
    Falling,
    /// A layer that yields.
    Layer,
}

/// Laws of μ(θ) but the table.
fn of_temperature() -> impl Strategy<Value = FrictionLaw> {
    prop_oneof![
        Just(FrictionLaw::Constant),
        Just(FrictionLaw::PiecewiseLinear),
        Just(FrictionLaw::FlowStress)
    ]
}

/// Parameters with a law.
fn with_law(law: Law, parameters: Parameters) -> BoxedStrategy<Parameters> {
    match law {
        Law::Static(FrictionLaw::Table) => (
            2..=TABLE_POINTS,
            prop::collection::vec((20.0..200.0, 0.1..0.6), TABLE_POINTS),
        )
            .prop_map(move |(points, drawn)| {
                let mut parameters = Parameters {
                    friction_law: FrictionLaw::Table,
                    friction_table_points: points,
                    ..parameters.clone()
                };
                let mut temperature = 250.0;
                for (point, (width, coefficient)) in drawn.into_iter().enumerate() {
                    temperature += width;
                    parameters.friction_table_temperature[point] = temperature;
                    // A coefficient that rises much faster gives a contact several temperatures.
                    let before = if point == 0 {
                        coefficient
                    } else {
                        parameters.friction_table_coefficient[point - 1]
                    };
                    let room = 0.002 * width;
                    parameters.friction_table_coefficient[point] =
                        f64::clamp(coefficient, before - room, before + room);
                }
                parameters
            })
            .boxed(),
        Law::Static(friction_law) => Just(Parameters {
            friction_law,
            ..parameters
        })
        .boxed(),
        Law::Falling => (
            of_temperature(),
            prop_oneof![
                (0.3..0.9_f64, 0.1..2.0_f64, Just(0.0)),
                (0.3..0.9_f64, 0.1..5.0_f64, 0.3e-6..1e-5),
                (Just(1.0), Just(0.0), 0.1e-6..1e-5),
            ],
        )
            .prop_map(move |(friction_law, (share, decay, distance))| {
                let falling = Falling { share, decay, distance };
                falling.on(Parameters {
                    friction_law,
                    ..parameters.clone()
                })
            })
            .boxed(),
        Law::Layer => (
            of_temperature(),
            5e7..4e8_f64,
            prop_oneof![Just(0.0), (11.0..13.5_f64).prop_map(|log| 10.0_f64.powf(log))],
            prop_oneof![Just(0.0), (-14.0..-12.0_f64).prop_map(|log| 10.0_f64.powf(log))],
            any::<bool>(),
        )
            .prop_map(move |(friction_law, strength, hardening, compliance, falls)| {
                let layer = Layer {
                    strength,
                    hardening,
                    compliance,
                    falls,
                };
                layer.on(Parameters {
                    friction_law,
                    ..parameters.clone()
                })
            })
            .boxed(),
    }
}

/// Motion of a line or a patch under load.
fn motions(contact_model: ContactModel) -> impl Strategy<Value = Inputs> {
    let rolls = (
        prop_oneof![
            1 => 0.01..0.1_f64,
            5 => 2.0..40.0,
        ],
        prop_oneof![-0.003..-0.0003, 0.0003..0.003, 0.005..0.2, -0.2..-0.005],
        -0.002..0.002,
        -0.8..0.8,
        any::<bool>(),
    );
    let conditions = (20e3..95e3, 0.3..1.2, 280.0..330.0);
    (rolls, conditions).prop_map(move |(rolls, (normal_load, friction_scale, incoming_temperature))| {
        let (speed, creepage, lateral, spin, reverse) = rolls;
        let speed = if reverse { -speed } else { speed };
        let inputs = match contact_model {
            ContactModel::Line => rolling_straight(speed, creepage),
            ContactModel::Patch | ContactModel::Profiles => {
                rolling(speed, [creepage.clamp(-0.05, 0.05), lateral, spin])
            }
        };
        Inputs {
            normal_load,
            friction_scale,
            incoming_temperature,
            ..inputs
        }
    })
}

fn cases(contact_model: ContactModel, law: Law) -> impl Strategy<Value = Case> {
    let contact = (
        prop_oneof![Just(SlipSource::Creepage), Just(SlipSource::VehicleSpeed)],
        prop_oneof![Just(Wheel::Rigid), Just(Wheel::Elastic)],
        // The rail's, or softer, so that pressure and shear are coupled.
        prop_oneof![Just(8.2e10), Just(4e10)],
        prop_oneof![Just(WheelHeating::Off), Just(WheelHeating::On)],
        prop_oneof![3 => Just(0.0), 1 => Just(1e-3)],
    );
    let parameters = contact.prop_flat_map(
        move |(source, wheel, wheel_shear_modulus, wheel_heating, slip_regularisation)| {
            let contact = match contact_model {
                ContactModel::Line => line(source, wheel),
                ContactModel::Patch | ContactModel::Profiles => patch(source, wheel),
            };
            let contact = Parameters {
                wheel_shear_modulus,
                wheel_heating,
                slip_regularisation,
                ..contact
            };
            with_law(law, contact)
        },
    );
    // In a long step what comes in reaches the contact and the other end.
    let steps = prop_oneof![Just(1e-3), Just(0.05)];
    (parameters, motions(contact_model), steps).prop_map(|(parameters, inputs, step)| Case {
        parameters,
        inputs,
        step,
    })
}

/// Compares the derivatives of a case where it rests at the settings of the comparison; at those that everybody has it has to. Not of a line on a
/// layer, nor of unlike bodies, whose shear moves their pressure, on friction that falls and remembers, whose step may be staggered: docs/limits.md says
/// where. The latter are counted.
fn compare_where_it_rests(case: &Case, mismatches: &mut Vec<Mismatch>) -> Tally {
    let Case {
        parameters,
        inputs,
        step,
    } = case;
    match compare(parameters.clone(), inputs, *step, mismatches) {
        Ok(tally) => tally,
        Err(error) if does_not_rest(&error) => {
            let on_a_layer = parameters.layer_compliance > 0.0 || parameters.layer_yield_stress > 0.0;
            let mut staggered = false;
            if parameters.contact_model == ContactModel::Patch || !on_a_layer {
                let model = Model::new(parameters.clone()).unwrap();
                let settled = settle(&model, &mut model.workspace(), inputs, *step);
                let settled = settled.unwrap_or_else(|error| panic!("{error}, at {case:?}"));
                staggered = settled.convergence.staggered;
                let unlike =
                    parameters.wheel == Wheel::Rigid || parameters.wheel_shear_modulus != parameters.shear_modulus;
                let may_be = unlike && parameters.friction_memory_distance > 0.0;
                assert!(may_be || !staggered, "{error}, at {case:?}");
            }
            Tally {
                refused: 1,
                staggered: usize::from(staggered),
                ..Tally::default()
            }
        }
        Err(error) => panic!("{error}, at {case:?}"),
    }
}

/// As the random cases are compared: a named one. Returns how many derivatives were compared, none where the step does not rest.
pub fn check_where_it_rests(parameters: Parameters, inputs: Inputs, step: f64) -> Option<usize> {
    let mut mismatches = Vec::new();
    let case = Case {
        parameters,
        inputs,
        step,
    };
    let tally = compare_where_it_rests(&case, &mut mismatches);
    assert!(mismatches.is_empty(), "{}", mismatches[0]);
    (tally.steps > 0).then_some(tally.compared)
}

/// Numbers of the cases that are compared: of as many as `DERIVATIVE_CASES` says, or of those from one to before another (`1289..1290`).
fn numbers() -> Range<usize> {
    let Ok(cases) = std::env::var("DERIVATIVE_CASES") else {
        return 0..CASES;
    };
    let (first, end) = cases.split_once("..").unwrap_or(("0", &cases));
    let number = |text: &str| text.parse().expect("DERIVATIVE_CASES");
    number(first)..number(end)
}

/// Draws cases, compares their derivatives, prints the counts, and fails with what does not agree.
fn draw(contact_model: ContactModel, law: Law) {
    let numbers = numbers();
    let count = numbers.len();
    let mut runner = TestRunner::new(ProptestConfig::default());
    let strategy = cases(contact_model, law);
    let (mut tally, mut failures) = (Tally::default(), Vec::new());
    for number in 0..numbers.end {
        let case = strategy.new_tree(&mut runner).expect("a case").current();
        if !numbers.contains(&number) {
            continue;
        }
        let mut mismatches = Vec::new();
        let of_case = compare_where_it_rests(&case, &mut mismatches);
        if of_case.finer > 0 {
            println!("case {number}: {} settled by finer differences", of_case.finer);
        }
        tally.add(of_case);
        if !mismatches.is_empty() {
            let words: Vec<String> = mismatches.iter().map(|mismatch| format!("  {mismatch}")).collect();
            failures.push(format!("case {number}: {case:?}\n{}", words.join("\n")));
        }
    }
    println!(
        "{contact_model:?} {law:?}: {} steps, {} do not rest ({} of them staggered), {} derivatives compared, {} of them finer, {} at corners, {} at others, {} steps fail",
        tally.steps,
        tally.refused,
        tally.staggered,
        tally.compared,
        tally.finer,
        tally.corners,
        tally.unnamed,
        failures.len()
    );
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    // Shares are those of all cases that are drawn, not of some picked out of them.
    if numbers.start > 0 {
        return;
    }
    let most = (LARGEST_STAGGERED * count as f64).max(1.0);
    assert!(tally.staggered as f64 <= most, "{tally:?}");
    let all = (tally.compared + tally.corners + tally.unnamed) as f64;
    assert!(tally.compared as f64 >= LEAST_COMPARED * all, "{tally:?}");
    assert!(tally.unnamed as f64 <= LARGEST_UNNAMED * all, "{tally:?}");
}

/// A test for each contact and law.
macro_rules! draws {
    ($($name:ident: $contact:ident, $law:expr;)+) => {
        $(
            #[test]
            fn $name() {
                draw(ContactModel::$contact, $law);
            }
        )+
    };
}

draws! {
    a_line_with_constant_friction: Line, Law::Static(FrictionLaw::Constant);
    a_line_with_piecewise_linear_friction: Line, Law::Static(FrictionLaw::PiecewiseLinear);
    a_line_with_flow_stress: Line, Law::Static(FrictionLaw::FlowStress);
    a_line_with_a_table: Line, Law::Static(FrictionLaw::Table);
    a_line_with_falling_friction: Line, Law::Falling;
    a_line_on_a_layer: Line, Law::Layer;
    a_patch_with_constant_friction: Patch, Law::Static(FrictionLaw::Constant);
    a_patch_with_piecewise_linear_friction: Patch, Law::Static(FrictionLaw::PiecewiseLinear);
    a_patch_with_flow_stress: Patch, Law::Static(FrictionLaw::FlowStress);
    a_patch_with_a_table: Patch, Law::Static(FrictionLaw::Table);
    a_patch_with_falling_friction: Patch, Law::Falling;
    a_patch_on_a_layer: Patch, Law::Layer;
}
