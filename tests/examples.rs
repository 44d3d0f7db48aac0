//! The Rust programs of examples/: what they print is what the contact does. Those in Python are in python_tests/test_examples.py.

#[allow(dead_code)]
#[path = "../examples/braking_curve.rs"]
mod braking_curve_example;
#[allow(dead_code)]
#[path = "../examples/creep_curves.rs"]
mod creep_curves_example;
#[allow(dead_code)]
#[path = "../examples/save_and_resume.rs"]
mod save_and_resume_example;

/// Braked from 20 m/s, the wheel slides between 4 s and 6 s: there it is hot, and most of the wear is from there.
#[test]
fn braking_curve() {
    let table = braking_curve_example::braking().unwrap();
    assert_eq!(table.len(), 18);
    let at = |wanted: f64| {
        let row = table.iter().find(|(time, _)| (time - wanted).abs() < 1e-9);
        &row.unwrap_or_else(|| panic!("{wanted} s is not in the table")).1
    };
    for (time, outputs) in &table {
        let slides = (4.5..=5.5).contains(time);
        assert_eq!(outputs.slip_creepage < -0.1, slides, "{time} s");
        assert_eq!(outputs.peak_temperature > 423.15, slides, "{time} s");
        assert!(outputs.traction_force < 0.0, "{time} s");
    }
    // Above 150 °C friction is 0.25 in place of 0.45.
    assert!(at(5.0).friction_coefficient < 0.3 && at(3.0).friction_coefficient > 0.44);
    let worn = |time| at(time).worn_volume;
    assert!(worn(6.0) - worn(4.0) > 0.9 * worn(9.0));
}

/// Each curve rises to a largest value below the friction coefficient of the cold contact; beyond it, it falls, the deeper the faster the wheel
/// rolls.
#[test]
fn creep_curves() {
    let curves = creep_curves_example::curves().unwrap();
    assert_eq!(curves.len(), creep_curves_example::SPEEDS.len());
    let last = creep_curves_example::CREEPAGES.len() - 1;
    for curve in &curves {
        assert!(curve[0] > 0.1 && curve[0] < curve[1]);
        // Round-off of the sum over the nodes.
        assert!(curve.iter().all(|&traction| traction < 0.45 * (1.0 + 1e-12)));
    }
    for pair in curves.windows(2) {
        assert!(pair[1][last] < pair[0][last], "{pair:?}");
    }
    assert!(curves[3][last] < curves[3][2]);
}

/// Saved half-way as bytes and resumed: the same bits in everything that changes in time.
#[test]
fn save_and_resume() {
    let [whole, resumed] = save_and_resume_example::both_ways().unwrap();
    assert!((whole.time - 1.0).abs() < 1e-9);
    assert!(whole.outputs.friction_energy > 0.0);
    assert_eq!(whole, resumed);
}
