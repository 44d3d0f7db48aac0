//! Parts of the equations of a step that all contacts have: the law of friction along a path, load or penetration, ∂u/∂t, wear.

use super::engine::Engine;
use super::problem::Problem;
use crate::friction::path::{PathLaw, PathStep};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::transient::Transient;
use crate::parameters::Control;
use crate::wear::law::PointwiseLaw;

impl<E: Engine> Problem<'_, E> {
    /// Law by which friction depends on slip and on what a particle has met before; none where it does not.
    pub fn path_law(&self) -> Option<PathLaw> {
        let operators = self.operators;
        PathLaw::new(
            self.parameters,
            &PathStep {
                duration: self.conditions.duration,
                spacing: operators.spacing(),
                speed: self.conditions.motion.rolling_speed,
                displacement: operators.diagonal_displacement(self.parameters),
                pressure: operators.pressure_scale(),
            },
        )
    }

    /// Load or penetration, scaled. A negligible load counts as none.
    pub fn constraint(&self) -> Constraint {
        match self.parameters.control {
            Control::Load => {
                let load = self.conditions.inputs.normal_load;
                let load = self.settings.mechanics.carried_load(load, self.parameters.largest_load);
                Constraint::Total(load / self.unit_force())
            }
            Control::Penetration => {
                Constraint::Penetration(self.parameters.prescribed_penetration / self.operators.displacement_scale())
            }
            // Of profiles it is 0: the height is in their gap.
            Control::Height => Constraint::Penetration(
                self.conditions.inputs.contact_penetration / self.operators.displacement_scale(),
            ),
        }
    }

    /// Whether there is no load to carry.
    pub fn is_unloaded(&self) -> bool {
        self.constraint() == Constraint::Total(0.0)
    }

    /// Force of a scaled traction of 1 on a node, `N`.
    pub fn unit_force(&self) -> f64 {
        self.operators.unit_force(self.parameters)
    }

    /// Load that the pressure of the fields carries, `N`.
    pub fn load(&self, fields: &E::Fields) -> f64 {
        E::carried_load(self, fields)
    }

    /// Law of wear that depends on more than the coefficient of [`Problem::wear_per_slip`]; none where it is Archard's with that.
    pub fn pointwise_wear(&self) -> Option<PointwiseLaw<'_>> {
        PointwiseLaw::new(self.parameters, self.conditions.motion.rolling_speed)
    }

    /// Wear depth per time at a slip of 1 m/s under a scaled pressure of 1, by Archard's law.
    pub fn wear_per_slip(&self) -> f64 {
        self.parameters.wear_coefficient * self.operators.pressure_scale()
    }

    /// ∂u/∂t over the step, for a displacement that is forgotten over `relaxation_length` `m` of rolling.
    pub fn transient(&self, relaxation_length: f64) -> Transient {
        Transient::new(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.operators.spacing(),
            relaxation_length,
            self.operators.displacement_scale(),
        )
    }

    /// Change of [`Problem::transient`] per |V|.
    pub fn transient_per_speed(&self, relaxation_length: f64) -> Transient {
        self.transient(relaxation_length).tangent(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.operators.spacing(),
            relaxation_length,
        )
    }
}
