//! Judgement of what the inputs do in a step: by how much they jump, and how long the transient after it is.

use super::Model;
use crate::friction;
use crate::geometry::hertz::HertzEllipse;
use crate::numerics::dense;
use crate::parameters::{ContactModel, Control};
use crate::signals::{Inputs, Motion};

impl Model {
    /// Largest change between two sets of inputs, each relative to what changes the contact appreciably.
    pub(super) fn change(&self, from: &Inputs, to: &Inputs) -> f64 {
        let (before, after) = (from.motion(&self.parameters), to.motion(&self.parameters));
        let speed = before.rolling_speed.abs().max(after.rolling_speed.abs());
        // Creepage at which the whole contact slides, μ a / r₀.
        let load = from.normal_load.max(to.normal_load);
        let (half_length, half_breadth) = self.half_axes(load);
        let saturation = friction::largest_coefficient(&self.parameters) * half_length / to.radius(&self.parameters);
        // A wheelset turns about its middle, a running circle's distance beside the wheel and a radius above the rail. A line and a patch have neither yaw rate
        // nor roll rate.
        let to_the_left = self.parameters.side_sign() * self.parameters.running_circle();
        let above = self.parameters.wheel_radius;
        // Slip along and across the rail, and that of the spin at the contact's side.
        let slips = |motion: &Motion, inputs: &Inputs| {
            [
                motion.rigid_slip + to_the_left * inputs.yaw_rate,
                // A wheelset that is yawed rolls askew.
                motion.lateral_speed - inputs.rail_lateral_speed - motion.rolling_speed * inputs.yaw_angle
                    + above * inputs.roll_rate,
                half_breadth * (motion.spin_rate + inputs.yaw_rate),
            ]
        };
        let (slips_before, slips_after) = (slips(&before, from), slips(&after, to));
        let slip = dense::largest(&slips_before).max(dense::largest(&slips_after));
        let relative = |change: f64, scale: f64| dense::relative(change.abs(), scale);
        relative(after.rolling_speed - before.rolling_speed, speed)
            .max(relative(
                dense::largest_change(&slips_after, &slips_before),
                (saturation * speed).max(slip),
            ))
            .max(relative(to.normal_load - from.normal_load, load))
            .max(relative(
                to.friction_scale - from.friction_scale,
                from.friction_scale.max(to.friction_scale),
            ))
            .max(self.change_of_place(from, to))
    }

    /// Half-length and half-breadth of the contact under a load, `m`. An ellipse's grow with the cube root of the load.
    fn half_axes(&self, load: f64) -> (f64, f64) {
        let Some(largest) = &self.largest_ellipse else {
            return self.parameters.contact_half_axes(load);
        };
        let share = (load / self.parameters.largest_load).cbrt();
        (share * largest.along, share * largest.across)
    }

    /// Largest change of the wheelset's place over the rail, or of the given geometry of a patch, relative to what changes the contacts appreciably.
    fn change_of_place(&self, from: &Inputs, to: &Inputs) -> f64 {
        /// Way across the track over which the contacts become others, `m`.
        const LATERAL: f64 = 5e-3;
        let Some(HertzEllipse { approach, .. }) = self.largest_ellipse else {
            return 0.0;
        };
        if self.parameters.contact_model == ContactModel::Patch {
            let penetration = (to.contact_penetration - from.contact_penetration).abs() / approach;
            let relative = |from: f64, to: f64| dense::relative((to - from).abs(), from.max(to));
            return penetration
                .max(relative(from.longitudinal_curvature, to.longitudinal_curvature))
                .max(relative(from.transverse_curvature, to.transverse_curvature));
        }
        let lateral = |inputs: &Inputs| inputs.lateral_displacement - inputs.rail_lateral_displacement;
        let place = (lateral(to) - lateral(from)).abs() / LATERAL;
        if self.parameters.control != Control::Height {
            return place;
        }
        let height = |inputs: &Inputs| inputs.vertical_displacement - inputs.rail_vertical_displacement;
        place.max((height(to) - height(from)).abs() / approach)
    }

    /// Time in which rail material crosses the contact window, `s`; infinite at rest.
    pub(super) fn passage_time(&self, inputs: &Inputs) -> f64 {
        self.operators.window_length() / inputs.motion(&self.parameters).rolling_speed.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{Parameters, Side, SlipSource};

    fn model(contact_model: ContactModel) -> Model {
        let parameters = Parameters {
            contact_model,
            slip_source: match contact_model {
                ContactModel::Profiles => SlipSource::VehicleSpeed,
                _ => Parameters::default().slip_source,
            },
            patch_nodes: 8,
            patch_strips: 5,
            ..Parameters::default()
        };
        Model::new(parameters).unwrap()
    }

    /// The half-axes are those that the parameters have for the load, and a penetration that grows by the approach of the largest load is a
    /// change of 1.
    #[test]
    fn the_scales_are_those_of_the_contact_under_the_load() {
        for contact_model in [ContactModel::Line, ContactModel::Patch, ContactModel::Profiles] {
            let model = model(contact_model);
            for load in [0.0, 1e3, 40e3, model.parameters.largest_load] {
                let (found, exact) = (model.half_axes(load), model.parameters.contact_half_axes(load));
                // Round-off.
                assert!(
                    (found.0 - exact.0).abs() <= 1e-14,
                    "{contact_model:?} {load}: {found:?} {exact:?}"
                );
                assert!(
                    (found.1 - exact.1).abs() <= 1e-14,
                    "{contact_model:?} {load}: {found:?} {exact:?}"
                );
            }
        }
        let model = model(ContactModel::Patch);
        let approach = model.parameters.hertz_ellipse(model.parameters.largest_load).approach;
        let from = Inputs::default();
        let to = Inputs {
            contact_penetration: from.contact_penetration + approach,
            ..from
        };
        assert!((model.change_of_place(&from, &to) - 1.0).abs() < 1e-12);
    }

    /// A yaw rate drives the wheels of a wheelset along the rail, one forward and one backward, and a roll rate both to the side. A wheel whose
    /// speeds make up for it slides no more than before, and the contact has no creepage.
    #[test]
    fn turning_of_a_wheelset_is_slip_of_its_wheels() {
        for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
            let model = Model::new(Parameters {
                side,
                ..model(ContactModel::Profiles).parameters
            })
            .unwrap();
            let radius = model.parameters.wheel_radius;
            let speed = 30.0;
            let rolling = Inputs {
                vehicle_speed: speed,
                wheel_speed: speed / radius,
                ..Inputs::default()
            };
            let yawing = Inputs {
                yaw_rate: 0.6,
                ..rolling
            };
            let rolling_over = Inputs {
                roll_rate: 0.6,
                ..rolling
            };
            let circle = model.parameters.running_circle();
            let followed = Inputs {
                wheel_speed: rolling.wheel_speed - sign * circle * yawing.yaw_rate / radius,
                ..yawing
            };
            let held = Inputs {
                lateral_speed: -radius * rolling_over.roll_rate,
                ..rolling_over
            };
            let jump = model.settings.step.jump;
            for (moved, made_up) in [(yawing, followed), (rolling_over, held)] {
                assert!(model.change(&rolling, &moved) > jump, "{side:?}");
                assert!(model.change(&rolling, &made_up) < jump, "{side:?}");
                let state = model.initial_state(&mut model.workspace(), &made_up).unwrap();
                let contact = state.outputs.contact[0];
                // The contact is up to 3 mm beside the running circle, and its radius as much as 0.1 % another one.
                let creepage = contact.longitudinal_creepage.hypot(contact.lateral_creepage);
                assert!(creepage < 1e-3, "{side:?}: {creepage}");
            }
        }
    }
}
