use super::*;

fn wheelset(rail: &str, wheel: &str, dimensions: &Dimensions) -> Wheelset {
    let (rail, wheel) = (Profile::built_in(rail).unwrap(), Profile::built_in(wheel).unwrap());
    Wheelset::new([&rail; 2], [&wheel; 2], dimensions).unwrap()
}

/// A cone of 1:20 has the conicity 1/20 at every amplitude, and Δr = 2 y/20 up to the roll.
#[test]
fn a_cone_has_its_conicity() {
    let upright = Dimensions {
        rail_inclination: 0.0,
        ..Dimensions::default()
    };
    for (name, conicity) in [("cone20", 0.05), ("cone40", 0.025)] {
        let sweep = Sweep::new(&wheelset("60E1", name, &upright), [-8e-3, 8e-3], 1e-4, 0.0).unwrap();
        for amplitude in [1e-3, 3e-3, 7e-3] {
            let found = sweep.conicity(amplitude).unwrap();
            println!("{name} {amplitude} {found:?}");
            assert!((found.conicity / conicity - 1.0).abs() < 0.03);
        }
        println!("{:?}", sweep.jumps);
    }
}

#[test]
fn s1002() {
    let start = std::time::Instant::now();
    let sweep = Sweep::new(
        &wheelset("60E1", "S1002", &Dimensions::default()),
        [-8e-3, 8e-3],
        1e-4,
        0.0,
    )
    .unwrap();
    println!("{:?}", start.elapsed());
    println!("{:#?}", sweep.jumps);
    for k in 1..8 {
        println!("{k} {:?}", sweep.conicity(1e-3 * k as f64));
    }
    for k in (0..161).step_by(10) {
        println!("{:?}", sweep.poses[k]);
    }
}
