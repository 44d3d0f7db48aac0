//! The elastic wheel on the elastic rail: Hertz's contact with the combined modulus 1/E* = Σ (1 − ν²)/E; Carter's creep
//! curve for like materials, whose normal and tangential problems are not coupled, without any switch; and free
//! rolling at creepage 0 where the rigid wheel's is −0.0016 (6e6 N/m).

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use super::{carter, hertz};
use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;

const CARTER: &str = "Carter 1926; Johnson, Contact Mechanics, 8.3";
/// Each halves the spacing of the one before it.
const NODES: [usize; 3] = [31, 61, 121];
/// The mixed compliances of like bodies are some tenths, in scaled units, and cancel but for round-off; the creepage of free
/// rolling is of the size of what is left.
const ROUND_OFF: f64 = 1e-12;

/// A wheel of the rail's material.
fn like() -> Parameters {
    Parameters {
        wheel: Wheel::Elastic,
        ..Parameters::default()
    }
}

/// A wheel that is half as stiff and of another Poisson's ratio (0.2 in place of 0.29).
fn soft() -> Parameters {
    Parameters {
        wheel_lame_lambda: 2.7e10,
        wheel_shear_modulus: 4.05e10,
        ..like()
    }
}

/// Hertz, Carter, free rolling.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = hertz::contact("wheel of the rail's material", like(), &[10, 50, 100])?;
    rows.extend(hertz::contact("softer wheel", soft(), &[10, 50, 100])?);
    rows.extend(creep_curve()?);
    rows.push(Row::absolute(
        "creepage of free rolling, wheel of the rail's material",
        "1",
        0.0,
        free_rolling(like())?,
        ROUND_OFF,
        "symmetry of the pair",
    ));
    rows.push(Row::absolute(
        "creepage of free rolling, rigid wheel",
        "1",
        -0.0016,
        free_rolling(Parameters {
            wheel: Wheel::Rigid,
            ..Parameters::default()
        })?,
        2e-4,
        "independent prototype, 61 nodes over 12 mm",
    ));
    Ok(rows)
}

/// Carter's curve on the default mesh, and its error under refinement.
fn creep_curve() -> Result<Vec<Row>> {
    let load = Inputs::default().normal_load;
    let mut rows = Vec::new();
    let mut run = like_bodies(Parameters::default().contact_nodes)?;
    for (creepage, expected, computed) in curve(&mut run, load, &carter::CREEPAGES)? {
        rows.push(Row::absolute(
            format!("T/(mu N) at creepage {creepage}, wheel of the rail's material"),
            "1",
            expected,
            computed,
            carter::TRACTION_TOLERANCE,
            CARTER,
        ));
    }
    let errors = NODES.into_iter().map(mean_error).collect::<Result<Vec<f64>>>()?;
    for (pair, nodes) in errors.windows(2).zip(NODES.windows(2)) {
        rows.push(Row::at_most(
            format!("mean error of T/(mu N) at {} nodes over that at {}", nodes[1], nodes[0]),
            "1",
            // Not a quarter: the ends of contact and stick zone lie between the nodes.
            0.75,
            pair[1] / pair[0],
            "falls under refinement",
        ));
    }
    Ok(rows)
}

/// Mean of |T/(μN) − Carter| in partial slip over loads whose contacts end at different places between the nodes: the
/// error at one load goes up and down with that place.
fn mean_error(contact_nodes: usize) -> Result<f64> {
    const LOADS: [f64; 6] = [40e3, 45e3, 50e3, 55e3, 60e3, 65e3];
    let (mut sum, mut count) = (0.0, 0.0);
    let mut run = like_bodies(contact_nodes)?;
    for load in LOADS {
        for (_, expected, computed) in curve(&mut run, load, &[0.001, 0.002, 0.003])? {
            sum += (computed - expected).abs();
            count += 1.0;
        }
    }
    Ok(sum / count)
}

/// Simulation of like bodies without heat or wear in the gap.
fn like_bodies(contact_nodes: usize) -> Result<Simulation> {
    let parameters = Parameters {
        wheel: Wheel::Elastic,
        contact_nodes,
        ..mechanics_alone()
    };
    set_up::simulation(&parameters, &Inputs::default())
}

/// Creepage, Carter's T/(μN) and ours at the given creepages.
fn curve(run: &mut Simulation, normal_load: f64, creepages: &[f64]) -> Result<Vec<(f64, f64, f64)>> {
    let parameters = run.model.parameters().clone();
    let inputs = |creepage| Inputs {
        creepage,
        normal_load,
        ..Inputs::default()
    };
    let mut points = Vec::new();
    for &creepage in creepages {
        let computed = run.hold(&inputs(creepage), carter::PASSAGE, 1)?.traction_coefficient / parameters.friction_cold;
        let stick = carter::stick_share(&parameters, normal_load, creepage);
        points.push((creepage, 1.0 - stick * stick, computed));
    }
    Ok(points)
}

/// The creepage at which T = 0, constant μ, after the rail has been cleared of what other creepages left.
fn free_rolling(parameters: Parameters) -> Result<f64> {
    let parameters = Parameters {
        friction_law: FrictionLaw::Constant,
        ..parameters
    };
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    // Like bodies roll freely at the second guess.
    set_up::free_rolling([-0.001, 0.0], |creepage| {
        let inputs = Inputs {
            creepage,
            ..Inputs::default()
        };
        Ok(run.hold(&inputs, 1e-2, 60)?.traction_coefficient)
    })
}
