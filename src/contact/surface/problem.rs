//! Problem of a step of a contact of profiles: the problem of each window, the pose of the wheelset, and the vertical forces of the windows.

use super::fields::SurfaceFields;
use super::geometry::Pose;
use super::operators::SurfaceOperators;
use super::solvers::SurfaceSolvers;
use super::windows::Place;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::problem::PatchProblem;
use crate::contact::problem::Problem;
use crate::geometry::unrolled::RailPoint;
use crate::numerics::dense;
use crate::parameters::Control;

/// Problem of a step of a contact of profiles.
pub type SurfaceProblem<'a> = Problem<'a, SurfaceOperators>;

impl<'a> SurfaceProblem<'a> {
    /// Problem of one window.
    pub fn of(&self, place: &Place) -> PatchProblem<'a> {
        PatchProblem {
            operators: self.operators.of(place),
            parameters: self.parameters,
            settings: self.settings,
            conditions: self.conditions,
            gauge_face: self.operators.gauge_face(place),
        }
    }

    /// Whether the height of the wheel is given, and the load follows.
    pub fn is_height_given(&self) -> bool {
        self.parameters.control == Control::Height
    }

    /// Pose of the wheelset over the rail.
    pub fn pose(&self) -> Pose {
        Pose::new(self.operators, &self.conditions.inputs, self.parameters.wheel_radius)
    }

    /// Height of the axle's middle over the rail's top at the end of a step, `m`.
    pub fn height(&self, fields: &SurfaceFields) -> f64 {
        if self.is_height_given() {
            self.pose().position.height
        } else {
            fields.touch - fields.approach[0]
        }
    }

    /// Vertical load to carry, `N`. A negligible one counts as none.
    pub fn vertical_load(&self) -> f64 {
        let load = self.conditions.inputs.normal_load;
        self.settings.mechanics.carried_load(load, self.parameters.largest_load)
    }

    /// Forces of a window on the wheel along the track's vertical: of the pressure and of the friction, `N`.
    pub fn vertical_forces(
        &self,
        fields: &SurfaceFields,
        solvers: &SurfaceSolvers,
        window: usize,
        place: &Place,
    ) -> [f64; 2] {
        let points = solvers.windows[window].geometry.points();
        let vertical = self.pose().vertical();
        vertical_forces(
            self.operators,
            vertical,
            |strip| points[strip],
            place,
            &fields.windows[window],
        )
    }
}

/// Forces of a window on the wheel along the track's vertical, given in the rail's axes, or their changes: of the pressure and of the friction, `N`. `point` is the rail's
/// surface in the middle of a strip.
pub fn vertical_forces(
    operators: &SurfaceOperators,
    vertical: [f64; 2],
    point: impl Fn(usize) -> RailPoint,
    place: &Place,
    fields: &PatchFields,
) -> [f64; 2] {
    [
        sum_over_strips(operators, place, &fields.pressure, |strip| {
            component(point(strip).normal, vertical)
        }),
        -sum_over_strips(operators, place, &fields.shear[1], |strip| {
            component(point(strip).tangent(), vertical)
        }),
    ]
}

/// Component of a vector of the track's cross-section along a direction.
pub fn component(vector: [f64; 2], direction: [f64; 2]) -> f64 {
    vector[0] * direction[0] + vector[1] * direction[1]
}

/// Force of tractions on the grid along a direction, `N`, whose component along theirs is given for each strip that is loaded.
pub fn sum_over_strips(
    operators: &SurfaceOperators,
    place: &Place,
    tractions: &[f64],
    of_strip: impl Fn(usize) -> f64,
) -> f64 {
    let window = operators.of(place);
    let grid = &window.grid;
    let mut force = 0.0;
    for strip in 0..grid.strips {
        let sum = dense::sum(&tractions[grid.row(strip)]);
        if sum != 0.0 {
            force += of_strip(strip) * sum;
        }
    }
    window.unit_force() * force
}
