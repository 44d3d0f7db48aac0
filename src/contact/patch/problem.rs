//! Parts of the equations of a patch: slip, leading edge, sliding, heat exchange.

use super::fields::PatchFields;
use super::operators::PatchOperators;
use crate::friction::coulomb::{self, Sliding};
use crate::heat::strips::StripHeatMarch;
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::mechanics::kinematics::SlipWeights;
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::patch::normal::PatchNormalProblem;
use crate::mechanics::transient::Transient;
use crate::wear::law::Rubbing;
use crate::wear::strips::StripWearMarch;
use std::ops::Range;

/// Problem of a step of the patch.
pub type PatchProblem<'a> = crate::contact::problem::Problem<'a, PatchOperators>;

impl<'a> PatchProblem<'a> {
    /// Weights with which displacements enter the slip ahead of a cell.
    pub fn slip_weights(&self, transient: Transient) -> SlipWeights {
        SlipWeights::new(transient, self.strain_speed(self.conditions.motion.rolling_speed.abs()))
    }

    /// Change of the weights with |V|, by `speed` `m/s`.
    pub fn slip_weights_tangent(&self, fields: &PatchFields, speed: f64) -> SlipWeights {
        SlipWeights::tangent(
            self.transient(fields.relaxation_length),
            self.transient_per_speed(fields.relaxation_length),
            speed,
            self.strain_speed(speed),
        )
    }

    /// Speed times the displacement scale over the length of a cell, `m/s`.
    fn strain_speed(&self, speed: f64) -> f64 {
        speed * self.operators.scales.displacement / self.operators.grid.length
    }

    /// Ratio of the separation `gap` ahead of a leading cell to the cell's pressure, to which the leading-edge correction of the slip
    /// is proportional.
    pub fn separation_ratio(&self, gap: f64, pressure: f64) -> f64 {
        (gap.max(0.0) / pressure).min(self.largest_separation_ratio())
    }

    /// Change of [`PatchProblem::separation_ratio`].
    pub fn separation_ratio_tangent(&self, gap: f64, pressure: f64, gap_change: f64, pressure_change: f64) -> f64 {
        let ratio = gap / pressure;
        if ratio > 0.0 && ratio < self.largest_separation_ratio() {
            (gap_change - ratio * pressure_change) / pressure
        } else {
            0.0
        }
    }

    fn largest_separation_ratio(&self) -> f64 {
        self.settings.patch.largest_separation_ratio * self.operators.normal_influence.diagonal
    }

    /// Cells of a strip that have a cell ahead of them: the slip is taken between the two.
    pub fn cells_with_next(&self) -> Range<usize> {
        let cells = self.operators.grid.cells;
        if self.is_forward() { 0..cells - 1 } else { 1..cells }
    }

    /// Heat march of the step.
    pub fn heat_march(&self) -> StripHeatMarch<'a> {
        StripHeatMarch {
            basis: &self.operators.basis,
            incoming: &self.operators.incoming,
            strips: &self.operators.strips,
            speed: self.conditions.motion.rolling_speed,
            duration: self.conditions.duration,
            surface: SurfaceCondition {
                friction: self.friction(),
                settings: self.settings.heat,
            },
        }
    }

    /// Wear march of the step.
    pub fn wear_march(&self) -> StripWearMarch<'a> {
        StripWearMarch {
            strips: &self.operators.strips,
            speed: self.conditions.motion.rolling_speed,
            duration: self.conditions.duration,
        }
    }

    /// Sliding of a cell, by its place on the grid.
    pub fn sliding(&self, fields: &PatchFields, place: usize) -> Sliding {
        let (slip, _) = vectors(fields, place);
        Sliding::of_vectors(slip, utilisation(fields, place))
    }

    /// Change of [`PatchProblem::sliding`] with that of the fields.
    pub fn sliding_tangent(&self, fields: &PatchFields, tangent: &PatchFields, place: usize) -> Sliding {
        let ((slip, _), (slip_change, shear_change)) = (vectors(fields, place), vectors(tangent, place));
        let (mu, pressure) = (fields.friction[place], fields.pressure[place]);
        let (bound, utilisation) = (mu * pressure, utilisation(fields, place));
        let bound_change = tangent.friction[place] * pressure + mu * tangent.pressure[place];
        let utilisation_change = [0, 1].map(|component| {
            if bound > 0.0 {
                -(shear_change[component] + utilisation[component] * bound_change) / bound
            } else {
                0.0
            }
        });
        Sliding::vector_tangent(slip, utilisation, slip_change, utilisation_change)
    }

    /// State of a cell that wears, by its place on the grid.
    pub fn rubbing(&self, fields: &PatchFields, place: usize) -> Rubbing {
        let (scale, (slip, shear)) = (self.operators.scales.pressure, vectors(fields, place));
        Rubbing {
            pressure: scale * fields.pressure[place],
            speed: coulomb::magnitude(slip),
            power: scale * coulomb::vector_power(shear, slip),
        }
    }

    /// Change of [`PatchProblem::rubbing`] with that of the fields.
    pub fn rubbing_tangent(&self, fields: &PatchFields, tangent: &PatchFields, place: usize) -> Rubbing {
        let scale = self.operators.scales.pressure;
        let ((slip, shear), (slip_change, shear_change)) = (vectors(fields, place), vectors(tangent, place));
        Rubbing {
            pressure: scale * tangent.pressure[place],
            speed: coulomb::magnitude_tangent(slip, slip_change),
            power: scale * coulomb::vector_power_tangent(shear, slip, shear_change, slip_change),
        }
    }

    /// Computes what heats and cools the surface of the cells, strip by strip, with the wheel at θ_w.
    pub fn exchange(&self, fields: &PatchFields, wheel_rise: f64, exchange: &mut [SurfaceExchange]) {
        let grid = &self.operators.grid;
        let of_slip = self.path_law().is_some();
        let (wear, capacity) = (self.pointwise_wear(), self.parameters.volumetric_heat_capacity());
        for (strip, exchange) in exchange.chunks_exact_mut(grid.cells).enumerate() {
            let gauge_face = self.gauge_face_factor(strip);
            for (cell, (place, exchange)) in grid.row(strip).zip(exchange).enumerate() {
                let pressure = fields.pressure[place] * self.operators.scales.pressure;
                *exchange = SurfaceExchange::default();
                if pressure > 0.0 {
                    *exchange =
                        SurfaceExchange::new(self.parameters, pressure, self.sliding(fields, place), wheel_rise);
                    if of_slip {
                        exchange.law = fields.memory.point_law(strip * grid.cells + cell);
                    }
                    if let Some(wear) = wear {
                        exchange.debris = capacity * wear.rate(&self.rubbing(fields, place));
                    }
                    exchange.law.share *= gauge_face;
                }
            }
        }
    }

    /// Normal problem for a gap, or for a change of it, with a wear compliance, both on the grid; its tolerance is 0.
    pub fn normal_problem(
        &self,
        gap: &'a [f64],
        wear_compliance: &'a [f64],
        constraint: Constraint,
    ) -> PatchNormalProblem<'a> {
        PatchNormalProblem {
            grid: &self.operators.grid,
            transform: &self.operators.transform,
            normal_influence: &self.operators.normal_influence,
            narrow: &self.operators.narrow_normal,
            gap,
            wear_compliance,
            constraint,
            tolerance: 0.0,
        }
    }

    /// Breadth over which the rail that leaves is averaged, `m`: that of the strips in contact.
    pub fn breadth(&self, fields: &PatchFields) -> f64 {
        super::extent::extent(self.operators, &fields.pressure).breadth
    }
}

/// Slip and shear of a cell.
fn vectors(fields: &PatchFields, place: usize) -> ([f64; 2], [f64; 2]) {
    let at = |vectors: &[Vec<f64>; 2]| [vectors[0][place], vectors[1][place]];
    (at(&fields.slip), at(&fields.shear))
}

/// Traction utilisation −τ/(μp) of a cell, along the rail and across it: with the sign of the slip.
fn utilisation(fields: &PatchFields, place: usize) -> [f64; 2] {
    let bound = fields.friction[place] * fields.pressure[place];
    let (_, shear) = vectors(fields, place);
    shear.map(|shear| if bound > 0.0 { -shear / bound } else { 0.0 })
}
