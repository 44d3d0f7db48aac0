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
        // Slip along and across the rail, and that of the spin at the contact's side.
        let slips = |motion: &Motion, inputs: &Inputs| {
            [
                motion.rigid_slip,
                // A wheelset that is yawed rolls askew. The yaw rate is none of a line or a patch.
                motion.lateral_speed - inputs.rail_lateral_speed - motion.rolling_speed * inputs.yaw_angle,
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
    use crate::parameters::{Parameters, SlipSource};

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
}
