//! Sums over the fields of a contact of profiles: integrals over all windows, forces on the wheelset, the contacts one by one.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::problem::SurfaceProblem;
use super::profile_wear;
use super::solvers::SurfaceSolvers;
use super::windows::WINDOWS;
use crate::body::grid::Grid;
use crate::contact::engine::Engine;
use crate::contact::integrals::{Integrals, NodeSums};
use crate::contact::on_wheelset::{OnWheelset, OneContact};
use crate::contact::outputs::{creepage_speed, damping};
use crate::contact::patch;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::rim::ContactHeat;
use crate::damage::PointDamage;
use crate::geometry::unrolled::{PlacedWheel, RailPoint};

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
        leaving_rise: f64::NEG_INFINITY,
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
        all.leaving_rise = all.leaving_rise.max(own.leaving_rise);
        all.leaving_wear_depth = all.leaving_wear_depth.max(own.leaving_wear_depth);
        all.damage = all.damage.with(&own.damage);
    }
    if fields.used().next().is_none() {
        // Rail that nothing touches leaves as it has come in.
        all.peak_rise = problem.incoming_rise();
        all.leaving_rise = all.peak_rise;
        all.wear_depth = problem.conditions.inputs.incoming_wear_depth;
        all.leaving_wear_depth = all.wear_depth;
    }
    all
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
    let (pose, height) = (problem.pose(), problem.height(fields));
    let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(height));
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
        let patch = problem.of(&place);
        let own = &fields.windows[window];
        let Some(integrals) = of_windows[window].filter(|integrals| integrals.sums.nodes > 0.0) else {
            continue;
        };
        let (grid, unit) = (&patch.operators.grid, PatchOperators::unit_force(patch.operators));
        let middle = place.middle_along(grid);
        let mut contact = OneContact::default();
        let (mut moment_x, mut moment_s, mut friction_moment) = (0.0, 0.0, 0.0);
        let carries = |strip: &usize| own.pressure[grid.row(*strip)].iter().any(|&pressure| pressure > 0.0);
        for strip in (0..grid.strips).filter(carries) {
            let arc = place.arc(grid, strip);
            let point = bodies.rail.at(arc);
            let tangent = point.tangent();
            let row = grid.row(strip);
            let [mut normal, mut ahead, mut x_moment, mut along, mut across, mut twist] = [0.0; 6];
            for (cell, at) in row.enumerate() {
                let x = middle + grid.x(cell);
                let (pressure, shear) = (
                    unit * own.pressure[at],
                    [unit * own.shear[0][at], unit * own.shear[1][at]],
                );
                normal += pressure;
                ahead += x * pressure;
                along -= shear[0];
                across -= shear[1];
                x_moment += pressure * x;
                twist -= x * shear[1];
            }
            contact.normal_force += normal;
            contact.friction[0] += along;
            contact.friction[1] += across;
            moment_x += x_moment;
            moment_s += arc * normal;
            friction_moment += twist - arc * along;
            let lateral = point.place[0] - pose.position.lateral;
            let vertical = point.place[1] - height;
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
            // Friction acts on the wheel's undeformed surface, at a distance h along the normal n from the rail's: its moment
            // is larger by h n × τ. Across, n × t = (−1, 0, 0).
            let moved = friction_times_distance(&wheel, (&point, middle), own, grid, strip);
            let [along, across] = moved.map(|sum| unit * sum);
            all.moment[0] -= across;
            all.moment[1] += point.normal[1] * along;
            all.moment[2] -= point.normal[0] * along;
        }
        let (x, arc) = (moment_x / contact.normal_force, moment_s / contact.normal_force);
        let point = bodies.rail.at(arc);
        let at = wheel.distance(x, &point, 0.0);
        contact.arc = arc;
        contact.along = x;
        contact.positions = [point.place[0] - bodies.rail.top(), wheel.profile_position(&at)];
        contact.inclination = (-point.normal[0]).atan2(point.normal[1]) + pose.position.rail_roll;
        let [ahead, y, z] = wheel.velocity(&at, &pose.motion);
        let approach_speed = wheel.approach_speed(&at, &point, &pose.motion);
        let added = contact.normal_force * (damping(problem.parameters, approach_speed) - 1.0);
        if added != 0.0 {
            contact.normal_force += added;
            let force = [added * point.normal[0], added * point.normal[1]];
            let arm = [point.place[0] - pose.position.lateral, point.place[1] - height];
            all.force[1] += force[0];
            all.force[2] += force[1];
            all.moment[0] += arm[0] * force[1] - arm[1] * force[0];
            all.moment[1] -= x * force[1];
            all.moment[2] += x * force[0];
        }
        let tangent = point.tangent();
        let speed = creepage_speed(pose.motion.velocity[0]);
        let [across, spin] = [y * tangent[0] + z * tangent[1], wheel.spin(&point, &pose.motion)];
        contact.creepages = [-ahead / speed, across / speed, spin / speed];
        contact.spin_moment = friction_moment - x * contact.friction[1] + arc * contact.friction[0];
        let power = -contact.friction[0] * ahead - contact.friction[1] * across - contact.spin_moment * spin;
        contact.wear_number = power / speed.abs();
        contact.size = [integrals.contact_length, integrals.contact_breadth];
        contact.area = integrals.contact_area;
        contact.peak_pressure = integrals.sums.peak_pressure * patch.operators.scales.pressure;
        contact.peak_rise = integrals.peak_rise;
        contact.damage = integrals.damage;
        contact.friction_power = unit * integrals.sums.friction_power;
        all.contacts[all.count] = contact;
        all.count += 1;
    }
    let count = all.count;
    all.contacts[..count].sort_by(|a, b| a.arc.total_cmp(&b.arc));
    all.torque = wheel.about_axle(all.moment);
    // Back from the rail's axes to those of the track, and from the mirror image.
    let (sine, cosine) = pose.position.rail_roll.sin_cos();
    for vector in [&mut all.force, &mut all.moment] {
        let [_, y, z] = *vector;
        (vector[1], vector[2]) = (cosine * y - sine * z, sine * y + cosine * z);
    }
    all.force[1] *= operators.side;
    all.moment[0] *= operators.side;
    all.moment[2] *= operators.side;
    for contact in &mut all.contacts {
        contact.friction[1] *= operators.side;
        contact.spin_moment *= operators.side;
        contact.creepages[1] *= operators.side;
        contact.creepages[2] *= operators.side;
    }
    all
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
