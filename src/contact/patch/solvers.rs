//! Solvers and buffers of a step of the patch, made once, so that a step allocates nothing.

use super::expansion;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use super::response;
use super::undeformed::Undeformed;
use crate::body::influence;
use crate::friction::path::PathNode;
use crate::heat::strips::StripHeatScratch;
use crate::heat::surface::SurfaceExchange;
use crate::mechanics::kinematics::SlipWeights;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::friction::{Friction, SlipResponse};
use crate::mechanics::patch::normal::Normal;
use crate::settings::Settings;
use crate::wear::strips::StripWearSteps;

/// Solvers and buffers of a step.
pub struct PatchSolvers {
    pub(in crate::contact) contact: Contact,
    pub(in crate::contact) contact_before: Contact,
    pub(in crate::contact) normal: Normal,
    pub(in crate::contact) friction: Friction,
    pub(in crate::contact) response: SlipResponse,
    /// StepConditions that the response is adapted to: the weights, whether V ≥ 0, the strips that its transform serves.
    pub(in crate::contact) weights: Option<(SlipWeights, bool, usize)>,
    /// Strips that the transform of the response serves.
    pub(in crate::contact) strips: usize,
    pub(in crate::contact) products: influence::ProductScratch<f64>,
    pub(in crate::contact) exchange: Vec<SurfaceExchange>,
    pub(in crate::contact) heat: StripHeatScratch,
    pub(in crate::contact) wear_rate: Vec<f64>,
    pub(in crate::contact) wear_steps: StripWearSteps,
    /// Gap and rigid slip of the undeformed bodies in this step.
    pub(in crate::contact) undeformed: Undeformed,
    /// Gap at no penetration with heat and wear, on the grid, scaled.
    pub(in crate::contact) gap: Vec<f64>,
    /// Wear depth of the step per pressure, on the grid, scaled.
    pub(in crate::contact) wear_compliance: Vec<f64>,
    /// Displacement by shear, on the grid, scaled: upward in the first component, or along x and y.
    pub(in crate::contact) shear_displacement: [Vec<f64>; 2],
    /// Displacement u by the shear of contacts beside this one, on the grid, scaled.
    pub(in crate::contact) beside: [Vec<f64>; 2],
    /// Displacement u that does not come from the shear of this contact, on the grid, scaled.
    pub(in crate::contact) given: [Vec<f64>; 2],
    /// Displacement u before the step, on the grid, scaled.
    pub(in crate::contact) before: [Vec<f64>; 2],
    /// Slip ahead of the cells without the response to shear, on the grid, `m/s`.
    pub(in crate::contact) free_slip: [Vec<f64>; 2],
    pub(in crate::contact) expansion: expansion::ExpansionBuffers,
    pub(in crate::contact) nothing: Vec<f64>,
    pub(in crate::contact) shear_before: [Vec<f64>; 2],
    /// Coulomb's bound μp of the cells under pressure, scaled.
    pub(in crate::contact) bound: Vec<f64>,
    /// Slip per shear that the leading edge adds to the cells under pressure, along x and y, `m/s`.
    pub(in crate::contact) edge: Vec<[f64; 2]>,
    /// Loads of the strips, scaled.
    pub(in crate::contact) loads: Vec<f64>,
    /// Rigid slip at the centroid of a strip's load over that in the strip's middle, of the cells under pressure, `m/s`.
    pub(in crate::contact) off_middle: Vec<[f64; 2]>,
    /// Friction law of the cells under pressure where friction depends on slip.
    pub(in crate::contact) path: PathScratch,
}

/// Friction of the cells under pressure, where it depends on slip.
pub struct PathScratch {
    /// Friction law of the cells under pressure.
    pub nodes: Vec<PathNode>,
    /// Pressure of the cells under pressure, scaled.
    pub pressure: Vec<f64>,
    /// Number of a cell among those under pressure, for all cells strip by strip.
    pub index: Vec<Option<usize>>,
}

impl PathScratch {
    /// Buffers for a number of cells.
    pub fn new(cells: usize) -> PathScratch {
        PathScratch {
            nodes: vec![PathNode::default(); cells],
            pressure: vec![0.0; cells],
            index: vec![None; cells],
        }
    }
}

impl PatchSolvers {
    /// Solvers for the given operators.
    pub fn new(operators: &PatchOperators, settings: &Settings) -> PatchSolvers {
        let (grid, transform) = (&operators.grid, &operators.transform);
        let on_grid = || vec![0.0; grid.len()];
        let vectors = || [on_grid(), on_grid()];
        let cells = grid.strips * grid.cells;
        PatchSolvers {
            contact: Contact::new(grid),
            contact_before: Contact::new(grid),
            normal: Normal::new(grid, transform, settings.patch),
            friction: Friction::new(grid, transform, settings.patch),
            response: response::none(operators),
            weights: None,
            strips: grid.strips,
            products: transform.scratch(),
            exchange: vec![SurfaceExchange::default(); cells],
            heat: StripHeatScratch::new(&operators.basis, &operators.strips),
            wear_rate: vec![0.0; cells],
            wear_steps: StripWearSteps::new(&operators.strips),
            undeformed: Undeformed::of_curvatures(operators),
            gap: on_grid(),
            wear_compliance: on_grid(),
            shear_displacement: vectors(),
            beside: vectors(),
            given: vectors(),
            before: vectors(),
            free_slip: vectors(),
            expansion: expansion::ExpansionBuffers::new(grid, transform),
            nothing: on_grid(),
            shear_before: vectors(),
            bound: on_grid(),
            edge: vec![[0.0; 2]; grid.len()],
            loads: vec![0.0; grid.strips],
            off_middle: vec![[0.0; 2]; grid.len()],
            path: PathScratch::new(cells),
        }
    }

    /// Adapts the response of the slip to speed and step, for a contact on so many strips.
    pub fn respond(&mut self, problem: &PatchProblem, weights: SlipWeights, strips: usize) {
        self.strips = problem.operators.transform_for(strips).0.strips();
        let conditions = (weights, problem.is_forward(), self.strips);
        if self.weights == Some(conditions) {
            return;
        }
        self.weights = Some(conditions);
        response::adapt(problem, &weights, strips, &mut self.response);
    }

    /// Forgets what was computed in another step, and its work: a step follows from its state alone.
    pub fn start_step(&mut self) {
        self.normal.start_step();
        self.friction.start_step();
    }
}
