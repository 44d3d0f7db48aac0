//! Creep curves of an elliptic contact: FASTSIM, CONTACT's points, limits under refinement, and wheelrail's patch, with times.
//!
//!     cargo run --release --example patch_creep_curves > results/patch_creep_curves.csv
//!     .venv/bin/python examples/patch_creep_curves.py
//!
//! Forces are on the wheel, over μN; the moment is over μN √(ab), and spin is times √(ab).

mod fastsim;

use fastsim::{Bound, Contact, Creepages, Forces, Grid};
use std::time::Instant;
use wheelrail::verification::contact_points::{
    self, ELLIPSES, FRICTION, LATERAL, LOAD, LONGITUDINAL, MOMENT, SHEAR_MODULUS,
};
use wheelrail::verification::kalker::CreepCoefficients;
use wheelrail::verification::patch_limits::LIMITS;

/// Points of a curve beside the one at 0.
const POINTS: u32 = 40;
/// Largest creepage of a curve; of spin, times √(ab).
const LARGEST: f64 = 6e-3;
/// Strips and elements of FASTSIM.
const GRID: Grid = Grid { along: 20, across: 20 };

/// Which creepage a curve runs over.
#[derive(Clone, Copy)]
enum Driven {
    Longitudinal,
    Lateral,
    Spin,
}

impl Driven {
    fn name(self) -> &'static str {
        match self {
            Driven::Longitudinal => "longitudinal",
            Driven::Lateral => "lateral",
            Driven::Spin => "spin",
        }
    }

    /// The creepages of a point.
    fn creepages(self, contact: &Contact, value: f64) -> Creepages {
        let none = Creepages::default();
        match self {
            Driven::Longitudinal => Creepages {
                longitudinal: value,
                ..none
            },
            Driven::Lateral => Creepages { lateral: value, ..none },
            Driven::Spin => Creepages {
                spin: value / contact.mean_semi_axis(),
                ..none
            },
        }
    }
}

/// Forces by wheelrail's patch; none as long as there is no such engine.
fn wheelrail(_contact: &Contact, _creepages: &Creepages) -> Option<Forces> {
    None
}

/// Forces by FASTSIM as it is used.
fn simplified(contact: &Contact, creepages: &Creepages) -> Option<Forces> {
    Some(fastsim::forces(contact, creepages, Bound::Parabolic, GRID))
}

/// Forces by FASTSIM under Hertz's pressure.
fn simplified_elliptic(contact: &Contact, creepages: &Creepages) -> Option<Forces> {
    Some(fastsim::forces(contact, creepages, Bound::Elliptic, GRID))
}

/// CONTACT's ellipses with Kalker's coefficients of their material.
fn contacts() -> impl Iterator<Item = Contact> {
    ELLIPSES.iter().filter_map(|ellipse| {
        let of = CreepCoefficients::of(ellipse.along / ellipse.across, contact_points::poisson_ratio())?;
        Some(Contact {
            along: ellipse.along,
            across: ellipse.across,
            load: LOAD,
            friction: FRICTION,
            shear_modulus: SHEAR_MODULUS,
            coefficients: [of.longitudinal, of.lateral, of.lateral_spin],
        })
    })
}

/// One line of the table. A quantity that is not known is left out.
fn line(contact: &Contact, driven: Driven, value: f64, by: &str, shares: [Option<f64>; 4], seconds: Option<f64>) {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
    println!(
        "{:.1},{},{value},{by},{},{},{},{},{}",
        contact.along / contact.across,
        driven.name(),
        number(shares[0]),
        number(shares[1]),
        number(shares[2]),
        number(shares[3]),
        number(seconds.map(|seconds| 1e6 * seconds)),
    );
}

/// A curve of one engine, where it has one.
fn curve(contact: &Contact, driven: Driven, by: &str, engine: fn(&Contact, &Creepages) -> Option<Forces>) {
    let unit = contact.friction_bound();
    for point in 0..=POINTS {
        let value = LARGEST * f64::from(point) / f64::from(POINTS);
        let creepages = driven.creepages(contact, value);
        let start = Instant::now();
        let Some(forces) = engine(contact, &creepages) else {
            return;
        };
        let seconds = start.elapsed().as_secs_f64();
        let shares = [
            forces.longitudinal / unit,
            forces.lateral / unit,
            forces.spin_moment / (unit * contact.mean_semi_axis()),
            1e3 * forces.dissipation / unit,
        ];
        line(contact, driven, value, by, shares.map(Some), Some(seconds));
    }
}

/// CONTACT's limits on the circle, with wheelrail's signs; its moments are those at n = 80.
fn points_of_contact(circle: &Contact) {
    for point in LONGITUDINAL {
        let shares = [Some(point.limit()), Some(0.0), Some(0.0), None];
        line(circle, Driven::Longitudinal, point.creepage, "contact", shares, None);
    }
    for (point, [_, moment]) in LATERAL.iter().zip(MOMENT) {
        let shares = [Some(0.0), Some(-point.limit()), Some(moment), None];
        line(circle, Driven::Lateral, point.creepage, "contact", shares, None);
    }
}

/// The limits at one creepage alone.
fn limits(ellipse: usize, contact: &Contact) {
    for limit in LIMITS.iter().filter(|limit| limit.ellipse == ellipse) {
        let [fx, fy, mz] = limit.forces.map(Some);
        let shares = [fx, fy, mz, None];
        match limit.creepages {
            [xi, 0.0, 0.0] => line(contact, Driven::Longitudinal, xi, "limit", shares, None),
            [0.0, eta, 0.0] => line(contact, Driven::Lateral, eta, "limit", shares, None),
            [0.0, 0.0, spin] => line(contact, Driven::Spin, spin, "limit", shares, None),
            // Combined creepages are on none of the curves.
            _ => {}
        }
    }
}

fn main() {
    println!(
        "a/b [1],driven,creepage [1],by,Fx/(mu N) [1],Fy/(mu N) [1],Mz/(mu N c) [1],1e3 power/(mu N V) [1],time [us]"
    );
    for (number, contact) in contacts().enumerate() {
        for driven in [Driven::Longitudinal, Driven::Lateral, Driven::Spin] {
            curve(&contact, driven, "fastsim", simplified);
            curve(&contact, driven, "fastsim_elliptic", simplified_elliptic);
            curve(&contact, driven, "wheelrail", wheelrail);
        }
        limits(number, &contact);
        if contact.along == contact.across {
            points_of_contact(&contact);
        }
    }
}
