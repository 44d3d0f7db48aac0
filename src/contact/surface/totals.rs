//! Sums over the fields of a contact of profiles: integrals over all windows, forces on the wheelset, the contacts one by one.

use super::bodies::Bodies;
use super::fields::SurfaceFields;
use super::geometry::Pose;
use super::operators::SurfaceOperators;
use super::problem::SurfaceProblem;
use super::profile_wear;
use super::solvers::SurfaceSolvers;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::engine::Engine;
use crate::contact::integrals::{Integrals, NodeSums};
use crate::contact::on_wheelset::{OnWheelset, OneContact};
use crate::contact::outputs::{creepage_speed, damping};
use crate::contact::patch;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::patch::problem::PatchProblem;
use crate::contact::rim::ContactHeat;
use crate::damage::PointDamage;
use crate::geometry::unrolled::{Distance, PlacedWheel, RailPoint};

/// Integrals of the given fields under the problem's conditions.
pub fn integrals(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &SurfaceSolvers) -> Integrals {
    let operators = problem.operators;
    let area = operators.sizes.largest.cell_area();
    let mut of_windows = [None; WINDOWS];
    for (window, place) in fields.used() {
        of_windows[window] = Some(patch::integrals::integrals(
            &problem.of(&place),
            &fields.windows[window],
        ));
    }
    let mut all = Integrals {
        sums: NodeSums::default(),
        node_area: area,
        pressure_scale: operators.shapes[0].scales.pressure,
        penetration: if fields.load > 0.0 { fields.approach[0] } else { 0.0 },
        contact_length: 0.0,
        contact_breadth: 0.0,
        contact_area: 0.0,
        peak_rise: f64::NEG_INFINITY,
        wear_depth: 0.0,
        leaving_rise: 0.0,
        leaving_wear_depth: 0.0,
        wheel_heat: ContactHeat::new(
            problem.parameters,
            problem.unit_force(),
            SurfaceOperators::heated_nodes(problem, fields, fields),
        ),
        wheel_temperature: fields.wheel_temperature,
        damage: PointDamage::default(),
        on_wheelset: on_wheelset(problem, fields, solvers, &of_windows),
    };
    for (own, place) in of_windows.iter().zip(&fields.places) {
        let (Some(own), Some(place)) = (own, place) else {
            continue;
        };
        let middle = place.middle_along(&operators.of(place).grid);
        let sums = NodeSums {
            moment: own.sums.moment + middle * own.sums.pressure,
            ..own.sums
        };
        all.sums = all.sums.with(&sums.scaled(own.node_area / area));
        all.contact_length = all.contact_length.max(own.contact_length);
        all.contact_breadth += own.contact_breadth;
        all.contact_area += own.contact_area;
        all.peak_rise = all.peak_rise.max(own.peak_rise);
        all.wear_depth = all.wear_depth.max(own.wear_depth);
        all.damage = all.damage.with(&own.damage);
    }
    (all.leaving_rise, all.leaving_wear_depth) = leaving(&of_windows, all.contact_breadth);
    if fields.used().next().is_none() {
        // Rail that nothing touches leaves as it has come in.
        all.peak_rise = problem.incoming_rise();
        all.leaving_rise = all.peak_rise;
        all.wear_depth = problem.conditions.inputs.incoming_wear_depth;
        all.leaving_wear_depth = all.wear_depth;
    }
    all
}

/// Temperature rise and depth of wear with which the rail leaves: the means over the `breadth` of all contacts, so that they stand for the heat and the wear of all windows.
/// Where nothing touches any more there is no breadth: then the largest of the windows.
fn leaving(of_windows: &[Option<Integrals>; WINDOWS], breadth: f64) -> (f64, f64) {
    let windows = || of_windows.iter().flatten();
    let over_windows = |of: fn(&Integrals) -> f64| {
        if breadth > 0.0 {
            windows().map(|own| own.contact_breadth / breadth * of(own)).sum()
        } else {
            windows().map(of).fold(f64::NEG_INFINITY, f64::max)
        }
    };
    (
        over_windows(|own| own.leaving_rise),
        over_windows(|own| own.leaving_wear_depth),
    )
}

/// Force and moment on the wheelset and the contacts, of which the integrals are given.
fn on_wheelset(
    problem: &SurfaceProblem,
    fields: &SurfaceFields,
    solvers: &SurfaceSolvers,
    of_windows: &[Option<Integrals>; WINDOWS],
) -> OnWheelset {
    let operators = problem.operators;
    let bodies = solvers.worn.of(operators);
    let pose = problem.pose();
    let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(problem.height(fields)));
    let mut all = OnWheelset {
        // A step that wears the profiles has computed them.
        worn_area_rates: match solvers.worn_off {
            Some(worn) => worn.area_rates,
            None => profile_wear::area_rates(problem, bodies, fields),
        },
        measures: bodies.measures,
        ..OnWheelset::default()
    };
    for (window, place) in fields.used() {
        let own = &fields.windows[window];
        let Some(integrals) = of_windows[window].filter(|integrals| integrals.sums.nodes > 0.0) else {
            continue;
        };
        let placed = PlacedContact {
            bodies,
            wheel: &wheel,
            pose: &pose,
            place: &place,
            patch: &problem.of(&place),
            fields: own,
        };
        let mut contact = placed.add_tractions(&mut all);
        let point = bodies.rail.at(contact.arc);
        let at = wheel.distance(contact.along, &point, 0.0);
        placed.describe(&integrals, (&point, &at), &mut contact);
        placed.add_damping((&point, &at), &mut contact, &mut all);
        all.contacts[all.count] = contact;
        all.count += 1;
    }
    let count = all.count;
    all.contacts[..count].sort_by(|a, b| a.arc.total_cmp(&b.arc));
    all.torque = wheel.about_axle(all.moment);
    to_track(operators.side, pose.position.rail_roll, &mut all);
    all
}

/// Turns forces and moments from the rail's axes to those of the track, and back from the mirror image that a right wheel is solved in.
fn to_track(side: f64, rail_roll: f64, all: &mut OnWheelset) {
    let (sine, cosine) = rail_roll.sin_cos();
    for vector in [&mut all.force, &mut all.moment] {
        let [_, y, z] = *vector;
        (vector[1], vector[2]) = (cosine * y - sine * z, sine * y + cosine * z);
    }
    all.force[1] *= side;
    all.moment[0] *= side;
    all.moment[2] *= side;
    for contact in &mut all.contacts {
        contact.friction[1] *= side;
        contact.spin_moment *= side;
        contact.creepages[1] *= side;
        contact.creepages[2] *= side;
    }
}

/// A contact in its window, between wheel and rail in their places.
#[derive(Clone, Copy)]
struct PlacedContact<'a> {
    bodies: &'a Bodies,
    wheel: &'a PlacedWheel<'a>,
    pose: &'a Pose,
    place: &'a Place,
    patch: &'a PatchProblem<'a>,
    fields: &'a PatchFields,
}

impl PlacedContact<'_> {
    /// Adds what the tractions do to the wheelset, strip by strip as each has its own normal. Returns the contact's forces, the moment of
    /// its friction and the place of its resultant.
    fn add_tractions(&self, all: &mut OnWheelset) -> OneContact {
        let (own, grid) = (self.fields, &self.patch.operators.grid);
        let unit = PatchOperators::unit_force(self.patch.operators);
        let middle = self.place.middle_along(grid);
        let mut contact = OneContact::default();
        let (mut moment_x, mut moment_s, mut friction_moment) = (0.0, 0.0, 0.0);
        let carries = |strip: &usize| own.pressure[grid.row(*strip)].iter().any(|&pressure| pressure > 0.0);
        for strip in (0..grid.strips).filter(carries) {
            let arc = self.place.arc(grid, strip);
            let point = self.bodies.rail.at(arc);
            let [mut normal, mut ahead, mut along, mut across, mut twist] = [0.0; 5];
            for (cell, at) in grid.row(strip).enumerate() {
                let x = middle + grid.x(cell);
                let (pressure, shear) = (
                    unit * own.pressure[at],
                    [unit * own.shear[0][at], unit * own.shear[1][at]],
                );
                normal += pressure;
                ahead += x * pressure;
                along -= shear[0];
                across -= shear[1];
                twist -= x * shear[1];
            }
            contact.normal_force += normal;
            contact.friction[0] += along;
            contact.friction[1] += across;
            moment_x += ahead;
            moment_s += arc * normal;
            friction_moment += twist - arc * along;
            self.add_strip(&point, [normal, ahead, along, across, twist], all);
            // Friction acts on the wheel's undeformed surface, at a distance h along the normal n from the rail's: its moment
            // is larger by h n × τ. Across, n × t = (−1, 0, 0).
            let moved = friction_times_distance(self.wheel, (&point, middle), own, grid, strip);
            let [along, across] = moved.map(|sum| unit * sum);
            all.moment[0] -= across;
            all.moment[1] += point.normal[1] * along;
            all.moment[2] -= point.normal[0] * along;
        }
        contact.along = moment_x / contact.normal_force;
        contact.arc = moment_s / contact.normal_force;
        contact.spin_moment = friction_moment - contact.along * contact.friction[1] + contact.arc * contact.friction[0];
        contact
    }

    /// Adds force and moment of a strip at a point of the rail. Of the strip are given: the normal force and its moment by the distance ahead of the axle, the
    /// friction along the rail and across it in the strip's plane, and the moment of the last by that distance.
    fn add_strip(&self, point: &RailPoint, [normal, ahead, along, across, twist]: [f64; 5], all: &mut OnWheelset) {
        let tangent = point.tangent();
        let [lateral, vertical] = self.arm(point);
        let force = [
            along,
            normal * point.normal[0] + across * tangent[0],
            normal * point.normal[1] + across * tangent[1],
        ];
        for (sum, part) in all.force.iter_mut().zip(force) {
            *sum += part;
        }
        // Σ x f of the strip, whose lateral and vertical forces stand at different places along it.
        let lateral_moment = ahead * point.normal[0] + twist * tangent[0];
        let vertical_moment = ahead * point.normal[1] + twist * tangent[1];
        all.moment[0] += lateral * force[2] - vertical * force[1];
        all.moment[1] += vertical * along - vertical_moment;
        all.moment[2] += lateral_moment - lateral * along;
    }

    /// Lateral and vertical distance of a point of the rail from the wheelset's centre, `m`.
    fn arm(&self, point: &RailPoint) -> [f64; 2] {
        let [_, y, z] = self.wheel.centre;
        [point.place[0] - y, point.place[1] - z]
    }

    /// Says where a contact is and how it moves, at the resultant of its pressure, and what its integrals are.
    fn describe(&self, integrals: &Integrals, (point, at): (&RailPoint, &Distance), contact: &mut OneContact) {
        let motion = &self.pose.motion;
        contact.positions = [point.place[0] - self.bodies.rail.top(), self.wheel.profile_position(at)];
        contact.inclination = (-point.normal[0]).atan2(point.normal[1]) + self.pose.position.rail_roll;
        let [ahead, y, z] = self.wheel.velocity(at, motion);
        let tangent = point.tangent();
        let speed = creepage_speed(motion.velocity[0]);
        let [across, spin] = [y * tangent[0] + z * tangent[1], self.wheel.spin(point, motion)];
        contact.creepages = [-ahead / speed, across / speed, spin / speed];
        let power = -contact.friction[0] * ahead - contact.friction[1] * across - contact.spin_moment * spin;
        contact.wear_number = power / speed.abs();
        contact.size = [integrals.contact_length, integrals.contact_breadth];
        contact.area = integrals.contact_area;
        contact.peak_pressure = integrals.sums.peak_pressure * self.patch.operators.scales.pressure;
        contact.peak_rise = integrals.peak_rise;
        contact.damage = integrals.damage;
        contact.friction_power = PatchOperators::unit_force(self.patch.operators) * integrals.sums.friction_power;
    }

    /// Adds what damps the approach to the normal force, at the resultant of the pressure.
    fn add_damping(&self, (point, at): (&RailPoint, &Distance), contact: &mut OneContact, all: &mut OnWheelset) {
        let approach_speed = self.wheel.approach_speed(at, point, &self.pose.motion);
        let added = contact.normal_force * (damping(self.patch.parameters, approach_speed) - 1.0);
        if added == 0.0 {
            return;
        }
        contact.normal_force += added;
        let force = [added * point.normal[0], added * point.normal[1]];
        let arm = self.arm(point);
        all.force[1] += force[0];
        all.force[2] += force[1];
        all.moment[0] += arm[0] * force[1] - arm[1] * force[0];
        all.moment[1] -= contact.along * force[1];
        all.moment[2] += contact.along * force[0];
    }
}

/// Sums over the cells of a strip of friction on the wheel, along and across, times how far the wheel's surface lies from the rail's along the normal.
fn friction_times_distance(
    wheel: &PlacedWheel,
    (point, middle): (&RailPoint, f64),
    fields: &PatchFields,
    grid: &Grid,
    strip: usize,
) -> [f64; 2] {
    let at = wheel.distance(middle, point, 0.0);
    let mut sums = [0.0; 2];
    for (cell, node) in grid.row(strip).enumerate() {
        let distance = at.farther_along(grid.x(cell));
        for (sum, shear) in sums.iter_mut().zip(&fields.shear) {
            *sum -= shear[node] * distance;
        }
    }
    sums
}
