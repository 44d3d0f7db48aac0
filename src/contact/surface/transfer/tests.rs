use super::super::tests::{displaced, fields, parameters, problem, run};
use super::*;
use crate::contact::fields::Fields;
use crate::contact::surface::problem::SurfaceProblem;
use crate::contact::surface::windows;
use crate::parameters::{Control, Parameters, ProfileContents};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::wheel_rail::Model;

/// Fills a window as a step does.
fn fill(problem: &SurfaceProblem, before: &SurfaceFields, place: &Place, into: &mut PatchFields, window: usize) {
    let operators = problem.operators;
    let friction = |place: &Place, strip: usize, rise: f64| problem.of(place).friction_at(strip).coefficient(rise).0;
    let rail = Rail {
        operators,
        rise: problem.incoming_rise(),
        depth: problem.conditions.inputs.incoming_wear_depth,
        friction: &friction,
    };
    let mut transfer = Transfer::new(operators);
    transfer.begin(&rail, before);
    transfer.fill(&rail, before, place, into, window);
}

/// Heat and worn depth that a window brings along are those of the window before where it covers them, whatever the size of the cells.
#[test]
fn a_window_that_moves_keeps_heat_and_worn_volume() {
    let parameters = parameters(Control::Load);
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let state = run(&parameters, &displaced(3e-3), 5);
    let before = fields(&state);
    let (window, place) = before.used().next().unwrap();
    let sums = |fields: &SurfaceFields| {
        let place = fields.places[window].unwrap();
        let area = operators.of(&place).grid.cell_area();
        let own = &fields.windows[window];
        [&own.heat.content, &own.wear.depth].map(|values| area * values.iter().sum::<f64>())
    };
    let settings = Settings::default();
    let problem = problem(&operators, (&parameters, &settings), displaced(3e-3));
    // A strip farther, and with strips twice as broad that cover those before.
    let shifted = windows::Place {
        strip: place.strip + 1,
        ..place
    };
    let strips = operators.of(&place).grid.strips as i32;
    let coarse = windows::Place {
        breadth: place.breadth - 1,
        strip: (place.strip - strips / 2).div_euclid(2),
        ..place
    };
    for target in [shifted, coarse] {
        let mut after = SurfaceFields::new(&operators);
        after.guess_from(before);
        after.places = [None; windows::WINDOWS];
        after.places[window] = Some(target);
        fill(&problem, before, &target, &mut after.windows[window], window);
        let (old, new) = (sums(before), sums(&after));
        assert!(old.iter().all(|sum| *sum > 0.0));
        // The strip that is left out is cold and unworn.
        for (old, new) in old.into_iter().zip(new) {
            assert!((new / old - 1.0).abs() < 1e-12, "{old:e} {new:e}");
        }
    }
}

/// Two windows lie over each other: a strip is as in the one that carries there, and not the mean with the other one, which has the rail there as if nothing touched it.
#[test]
fn a_strip_is_that_of_the_window_that_carries_there() {
    let parameters = parameters(Control::Load);
    let settings = Settings::default();
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let mut before = fields(&run(&parameters, &displaced(3e-3), 5)).clone();
    let (window, place) = before.used().next().unwrap();
    let beside = (window + 1) % WINDOWS;
    before.places[beside] = Some(Place {
        strip: place.strip + 2,
        ..place
    });
    before.windows[beside] = before.windows[window].untouched();
    let problem = problem(&operators, (&parameters, &settings), displaced(3e-3));
    let mut after = SurfaceFields::new(&operators);
    fill(&problem, &before, &place, &mut after.windows[window], window);
    let grid = &operators.of(&place).grid;
    let [now, then] = [&after, &before].map(|fields| &fields.windows[window]);
    let mut carrying = 0;
    for strip in 0..grid.strips {
        if then.pressure[grid.row(strip)].iter().all(|&pressure| pressure == 0.0) {
            continue;
        }
        carrying += 1;
        let cells = strip * grid.cells..(strip + 1) * grid.cells;
        let of: [fn(&PatchFields) -> &Vec<f64>; 2] = [|fields| &fields.wear.depth, |fields| &fields.heat.surface];
        for of in of {
            let largest = dense::largest(of(then));
            for (now, then) in of(now)[cells.clone()].iter().zip(&of(then)[cells.clone()]) {
                assert!((now - then).abs() < 1e-12 * largest, "{now:e} {then:e}");
            }
        }
    }
    assert!(carrying > 4);
}

/// Rail that no window has been over is displaced by the shear in the windows as the rail beside it is: between its cells and those of the window before there is no step.
#[test]
fn rail_that_nothing_has_touched_is_displaced_by_the_shear_beside_it() {
    let parameters = Parameters {
        thermal_expansion: 0.0,
        ..parameters(Control::Load)
    };
    let settings = Settings::default();
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let state = run(&parameters, &displaced(3e-3), 5);
    let before = fields(&state);
    let (window, place) = before.used().next().unwrap();
    let grid = &operators.of(&place).grid;
    let problem = problem(&operators, (&parameters, &settings), displaced(3e-3));
    let covered = grid.strips / 2;
    let mut after = SurfaceFields::new(&operators);
    let target = Place {
        strip: place.strip + (grid.strips - covered) as i32,
        ..place
    };
    fill(&problem, before, &target, &mut after.windows[window], window);
    for component in 0..2 {
        let own = &after.windows[window].displacement[component];
        let [last, beside, next] = [covered - 1, covered, covered + 1].map(|strip| &own[grid.row(strip)]);
        let size = dense::largest(last);
        assert!(size > 0.0);
        for ((last, beside), next) in last.iter().zip(beside).zip(next) {
            // It changes from the last strip that was covered to the first that was not as little as from there to the next, but for the error of the blocks.
            println!("{component} {last:e} {beside:e} {next:e}");
            let step = (beside - last).abs();
            assert!(
                step < 2.0 * (next - beside).abs() + 0.02 * size,
                "{component}: {last:e} {beside:e} {next:e}"
            );
        }
    }
}

/// Rail that no window has been over is as warm and as worn as it came in, and its friction that of rested rail.
#[test]
fn rail_that_nothing_has_touched_is_as_it_came_in() {
    let parameters = Parameters {
        friction_memory_distance: 1e-5,
        friction_slip_share: 0.6,
        friction_slip_decay: 1.0,
        ..parameters(Control::Load)
    };
    let inputs = Inputs {
        incoming_temperature: 353.15,
        incoming_wear_depth: 1e-6,
        ..displaced(3e-3)
    };
    let settings = Settings::default();
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    // Long enough for the rail of the beginning, which is at ambient, to be far behind.
    let mut before = fields(&run(&parameters, &inputs, 3000)).clone();
    let (window, place) = before.used().next().unwrap();
    let problem = problem(&operators, (&parameters, &settings), inputs);
    let own = operators.of(&place);
    let grid = own.grid;
    let patch = problem.of(&place);
    // The first strip is warmer, so that nothing of it can be taken for the rail beside the contact.
    let amplitudes = &mut before.windows[window].heat.window;
    let columns = amplitudes
        .chunks_exact_mut(LANES)
        .take(own.basis.len() * own.strips.columns());
    columns.for_each(|lanes| lanes[0] *= 2.0);
    let half = grid.strips / 2;
    let target = Place {
        strip: place.strip + half as i32,
        ..place
    };
    let mut after = SurfaceFields::new(&operators);
    fill(&problem, &before, &target, &mut after.windows[window], window);
    let (now, then) = (&after.windows[window], &before.windows[window]);
    // The last strip of the window before has carried nothing.
    let last = grid.strips - 1;
    assert_eq!(dense::sum(&then.pressure[grid.row(last)]), 0.0);
    assert!(then.heat.surface[last * grid.cells] > 30.0);
    for strip in grid.strips - half..grid.strips {
        for cell in 0..grid.cells {
            let [at, beside] = [strip, last].map(|strip| strip * grid.cells + cell);
            assert!((now.heat.surface[at] / then.heat.surface[beside] - 1.0).abs() < 1e-12);
            assert!((now.wear.depth[at] / 1e-6 - 1.0).abs() < 1e-9);
            let rested = patch.friction_at(strip).coefficient(now.heat.surface[at]).0;
            let memory = &now.memory.now;
            assert_eq!([memory.friction[at], memory.static_friction[at]], [rested; 2]);
            assert_eq!([memory.speed[at], memory.flow[at]], [0.0; 2]);
            assert_eq!(now.memory.share[at], 1.0);
        }
    }
    // Where there has not been a window at all, the rail is as it enters.
    fill(
        &problem,
        &SurfaceFields::new(&operators),
        &place,
        &mut after.windows[window],
        window,
    );
    let now = &after.windows[window];
    for at in 0..grid.strips * grid.cells {
        assert!((now.heat.content[at] / (60.0 * parameters.skin_depth) - 1.0).abs() < 1e-12);
        assert_eq!(now.wear.depth[at], 1e-6);
    }
}

/// A wheel that rolls and moves sideways at 50 mm/s, under its heat and wear: each time that its window moves, heat and worn volume in it stay. The strips that it leaves have been
/// cold and unworn again since the contact was there.
#[test]
fn a_wheel_that_moves_sideways_keeps_heat_and_worn_volume() {
    let parameters = parameters(Control::Load);
    let settings = Settings::default();
    let operators = SurfaceOperators::build(&parameters, &ProfileContents::default()).unwrap();
    let model = Model::new(parameters.clone()).unwrap();
    let mut workspace = model.workspace();
    let inputs = |step: i32, normal_load: f64| Inputs {
        lateral_displacement: 2e-3 - 5e-5 * f64::from(step),
        lateral_speed: -0.05,
        normal_load,
        ..displaced(0.0)
    };
    let sums = |place: &Place, fields: &PatchFields| {
        let area = operators.of(place).grid.cell_area();
        [&fields.heat.content, &fields.wear.depth].map(|values| area * values.iter().sum::<f64>())
    };
    let mut moves = 0;
    for normal_load in [displaced(0.0).normal_load, 20e3] {
        let mut state = model.initial_state(&mut workspace, &inputs(0, normal_load)).unwrap();
        for step in 1..=120 {
            let before = fields(&state).clone();
            model
                .step(
                    &mut workspace,
                    &mut state,
                    &inputs(step, normal_load),
                    &Inputs::ZERO,
                    1e-3,
                )
                .unwrap();
            let places = fields(&state).places;
            if places == before.places {
                continue;
            }
            let (window, old) = before.used().next().unwrap();
            let new = places[window].unwrap();
            // A longer window covers more of the warm rail behind.
            if [new.length, new.cell as usize] != [old.length, old.cell as usize] {
                continue;
            }
            moves += 1;
            let problem = problem(&operators, (&parameters, &settings), inputs(step, normal_load));
            let mut after = SurfaceFields::new(&operators);
            fill(&problem, &before, &new, &mut after.windows[window], window);
            let sums = [(&old, &before), (&new, &after)].map(|(place, fields)| sums(place, &fields.windows[window]));
            for (old, new) in sums[0].into_iter().zip(sums[1]) {
                // The implicit march leaves a millionth of a column's heat in it when it has rolled on.
                assert!((new / old - 1.0).abs() < 1e-5, "step {step}: {old:e} {new:e}");
            }
        }
    }
    assert!(moves >= 3, "{moves}");
}
