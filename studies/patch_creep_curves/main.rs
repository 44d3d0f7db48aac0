//! Creep curves of an elliptic contact: FASTSIM, CONTACT's points, limits under refinement, and wheelrail's patch, with times.
//!
//!     cargo run --release --example patch_creep_curves > results/patch_creep_curves.csv
//!     .venv/bin/python studies patch_creep_curves
//!
//! Forces are on the wheel, over μN; the moment is over μN √(ab), and spin is times √(ab). `wheelrail` solves each point from
//! nothing, `wheelrail_step` takes a step there from the point before, with the heat. The points `limits` are those of
//! [`LIMITS`] by their number, combined creepages among them; `varying` has what CONTACT and its FASTSIM take for a call.

mod fastsim;
mod patch;

use fastsim::{Bound, Contact, Creepages, Forces, Grid};
use patch::Wheel;
use std::time::Instant;
use wheelrail::verification::contact_points::{
    self, ELLIPSES, Ellipse, FASTSIM_RUN_TIMES, FRICTION, LATERAL, LOAD, LONGITUDINAL, MOMENT, RUN_TIMES, SHEAR_MODULUS,
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

/// Forces by FASTSIM as it is used.
fn simplified(contact: &Contact, creepages: &Creepages) -> Option<Forces> {
    Some(fastsim::forces(contact, creepages, Bound::Parabolic, GRID))
}

/// Forces by FASTSIM under Hertz's pressure.
fn simplified_elliptic(contact: &Contact, creepages: &Creepages) -> Option<Forces> {
    Some(fastsim::forces(contact, creepages, Bound::Elliptic, GRID))
}

/// An ellipse of CONTACT with Kalker's coefficients of its material.
fn contact(ellipse: &Ellipse) -> Option<Contact> {
    let of = CreepCoefficients::of(ellipse.along / ellipse.across, contact_points::poisson_ratio())?;
    Some(Contact {
        along: ellipse.along,
        across: ellipse.across,
        load: LOAD,
        friction: FRICTION,
        shear_modulus: SHEAR_MODULUS,
        coefficients: [of.longitudinal, of.lateral, of.lateral_spin],
    })
}

/// One of the engines that are compared: forces on the wheel, where it has any.
type Engine<'a> = (&'a str, &'a mut dyn FnMut(&Contact, &Creepages) -> Option<Forces>);

/// One line of the table. A quantity that is not known is left out.
fn line(contact: &Contact, driven: &str, value: f64, by: &str, shares: [Option<f64>; 4], seconds: Option<f64>) {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
    println!(
        "{:.1},{},{value},{by},{},{},{},{},{}",
        contact.along / contact.across,
        driven,
        number(shares[0]),
        number(shares[1]),
        number(shares[2]),
        number(shares[3]),
        number(seconds.map(|seconds| 1e6 * seconds)),
    );
}

/// One point by one engine, where it has one.
fn point(contact: &Contact, (driven, value): (&str, f64), creepages: &Creepages, (by, engine): &mut Engine) {
    let unit = contact.friction_bound();
    let start = Instant::now();
    let Some(forces) = engine(contact, creepages) else {
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

/// A curve of one engine.
fn curve(contact: &Contact, driven: Driven, engine: &mut Engine) {
    for number in 0..=POINTS {
        let value = LARGEST * f64::from(number) / f64::from(POINTS);
        point(
            contact,
            (driven.name(), value),
            &driven.creepages(contact, value),
            engine,
        );
    }
}

/// CONTACT's limits on the circle, with wheelrail's signs; its moments are those at n = 80.
fn points_of_contact(circle: &Contact) {
    for point in LONGITUDINAL {
        let shares = [Some(point.limit()), Some(0.0), Some(0.0), None];
        line(
            circle,
            Driven::Longitudinal.name(),
            point.creepage,
            "contact",
            shares,
            None,
        );
    }
    for (point, [_, moment]) in LATERAL.iter().zip(MOMENT) {
        let shares = [Some(0.0), Some(-point.limit()), Some(moment), None];
        line(circle, Driven::Lateral.name(), point.creepage, "contact", shares, None);
    }
}

/// The times that CONTACT and its FASTSIM take for a call where the creepages vary, on the grid nearest to the patch's own.
fn times_of_contact(circle: &Contact) {
    let (_, least, largest) = RUN_TIMES[0];
    let (_, fastsim) = FASTSIM_RUN_TIMES[0];
    for (by, seconds) in [("contact", 0.5 * (least + largest)), ("contact_fastsim", fastsim)] {
        line(circle, "varying", 0.0, by, [None; 4], Some(seconds));
    }
}

/// The limits, on the curves where one creepage is alone, and by their number beside what the engines make of them.
fn limits(ellipse: usize, contact: &Contact, engines: &mut [Engine]) {
    for (number, limit) in LIMITS.iter().enumerate().filter(|(_, limit)| limit.ellipse == ellipse) {
        let [fx, fy, mz] = limit.forces.map(Some);
        let shares = [fx, fy, mz, None];
        let on_curve = match limit.creepages {
            [xi, 0.0, 0.0] => Some((Driven::Longitudinal, xi)),
            [0.0, eta, 0.0] => Some((Driven::Lateral, eta)),
            [0.0, 0.0, spin] => Some((Driven::Spin, spin)),
            // Combined creepages are on none of the curves.
            _ => None,
        };
        if let Some((driven, value)) = on_curve {
            line(contact, driven.name(), value, "limit", shares, None);
        }
        let [longitudinal, lateral, spin] = limit.creepages;
        let creepages = Creepages {
            longitudinal,
            lateral,
            spin: spin / contact.mean_semi_axis(),
        };
        let place = ("limits", number as f64);
        line(contact, place.0, place.1, "limit", shares, None);
        for engine in &mut *engines {
            point(contact, place, &creepages, engine);
        }
    }
}

fn main() -> Result<(), wheelrail::Error> {
    println!(
        "a/b [1],driven,creepage [1],by,Fx/(mu N) [1],Fy/(mu N) [1],Mz/(mu N c) [1],1e3 power/(mu N V) [1],time [us]"
    );
    for (number, ellipse) in ELLIPSES.iter().enumerate() {
        let Some(contact) = contact(ellipse) else {
            continue;
        };
        let (mut alone, mut stepped) = (Wheel::new(ellipse)?, Wheel::new(ellipse)?);
        let mut at_rest = |_: &Contact, creepages: &Creepages| alone.steady(creepages);
        let mut step = |_: &Contact, creepages: &Creepages| stepped.step(creepages);
        let (mut parabolic, mut elliptic) = (simplified, simplified_elliptic);
        let mut engines: [Engine; 4] = [
            ("fastsim", &mut parabolic),
            ("fastsim_elliptic", &mut elliptic),
            ("wheelrail", &mut at_rest),
            ("wheelrail_step", &mut step),
        ];
        for driven in [Driven::Longitudinal, Driven::Lateral, Driven::Spin] {
            for engine in &mut engines {
                curve(&contact, driven, engine);
            }
        }
        limits(number, &contact, &mut engines[..3]);
        if contact.along == contact.across {
            points_of_contact(&contact);
            times_of_contact(&contact);
        }
    }
    Ok(())
}
