//! The braking manoeuvre of `examples/braking.csv`, by steps of 1 ms, and models of a given fineness: what all benchmarks
//! step through.

// Each benchmark uses a part of this.
#![allow(dead_code)]

use wheelrail::parameters::{Parameters, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::{Model, State, Workspace};

/// Communication step, `s`.
pub const STEP: f64 = 1e-3;
/// Where the measured stretch begins, `s`: full braking, the wheel about to slide.
const FROM: f64 = 4.0;

/// A contact window of `contact_nodes` nodes, all effects on, moved by a vehicle.
pub fn parameters(contact_nodes: usize) -> Parameters {
    Parameters {
        slip_source: SlipSource::VehicleSpeed,
        contact_nodes,
        ..Parameters::default()
    }
}

/// The inputs at the communication points, linear between the rows of the scenario.
pub fn manoeuvre() -> Vec<Inputs> {
    let rows: Vec<[f64; 4]> = include_str!("../../examples/braking.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let mut cells = line.split(',').map(|cell| cell.parse().expect("a number"));
            std::array::from_fn(|_| cells.next().expect("four columns"))
        })
        .collect();
    let end = rows[rows.len() - 1][0];
    let steps = (end / STEP).round() as usize;
    (0..=steps)
        .map(|step| {
            let time = step as f64 * STEP;
            let next = rows.partition_point(|row| row[0] < time).clamp(1, rows.len() - 1);
            let (a, b) = (rows[next - 1], rows[next]);
            let share = ((time - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0);
            let at = |cell: usize| a[cell] + share * (b[cell] - a[cell]);
            Inputs {
                wheel_speed: at(1),
                vehicle_speed: at(2),
                normal_load: at(3),
                ..Inputs::default()
            }
        })
        .collect()
}

/// A model under way through the manoeuvre.
pub struct Run {
    pub model: Model,
    pub workspace: Workspace,
    pub state: State,
    manoeuvre: Vec<Inputs>,
    next: usize,
}

impl Run {
    /// At the beginning of the measured stretch.
    pub fn new(contact_nodes: usize) -> Run {
        let model = Model::new(parameters(contact_nodes)).expect("a model");
        let mut workspace = model.workspace();
        let manoeuvre = manoeuvre();
        let next = (FROM / STEP) as usize;
        let state = model
            .initial_state(&mut workspace, &manoeuvre[next - 100])
            .expect("a state");
        let mut run = Run {
            model,
            workspace,
            state,
            manoeuvre,
            next: next - 100,
        };
        for _ in 0..100 {
            run.step();
        }
        run
    }

    /// One communication step; after the last one the manoeuvre begins again.
    pub fn step(&mut self) {
        self.next += 1;
        if self.next == self.manoeuvre.len() {
            self.next = 0;
        }
        self.model
            .step(
                &mut self.workspace,
                &mut self.state,
                &self.manoeuvre[self.next],
                &Inputs::ZERO,
                STEP,
            )
            .expect("a step");
    }

    /// Steps from here to the end of the manoeuvre.
    pub fn remaining(&self) -> usize {
        self.manoeuvre.len() - 1 - self.next
    }

    /// Nodes under pressure.
    pub fn nodes_in_contact(&self) -> usize {
        self.state.fields().pressure.iter().filter(|&&p| p > 0.0).count()
    }
}
