//! Response of the slip to the shear: the displacement by shear of a cell and of the cell ahead of it, with the weights that speed and
//! step give them.

use super::operators::PatchOperators;
use super::problem::PatchProblem;
use crate::body::influence::ShiftedKernels;
use crate::mechanics::kinematics::SlipWeights;
use crate::mechanics::patch::friction::SlipResponse;

/// Response that is not adapted to any weights yet.
pub fn none(operators: &PatchOperators) -> SlipResponse {
    SlipResponse {
        double: operators.displacement.clone(),
        single: operators.displacement.single(),
        strip_kernels: [
            vec![0.0; operators.strip_kernels[0].len()],
            vec![0.0; operators.strip_kernels[1].len()],
        ],
        origin: operators.grid.stride(),
        forward: true,
    }
}

/// Adapts the response of the slip to the weights, for a contact on so many strips.
pub fn adapt(problem: &PatchProblem, weights: &SlipWeights, strips: usize, response: &mut SlipResponse) {
    let (operators, forward) = (problem.operators, problem.is_forward());
    response.forward = forward;
    // The kernel of the cell ahead is that of the cell itself, shifted by one lag.
    let ahead = if forward { 1 } else { -1 };
    let (here, next) = (weights.strain + weights.change, -weights.strain);
    let (transform, displacement) = operators.transform_for(strips);
    displacement.combine(
        transform,
        ShiftedKernels {
            here,
            ahead: next,
            shift: ahead,
        },
        &mut response.double,
        &mut response.single,
    );
    for (table, kernel) in response.strip_kernels.iter_mut().zip(&operators.strip_kernels) {
        for (lag, value) in table.iter_mut().enumerate() {
            let shifted = lag.saturating_add_signed(ahead).min(kernel.len() - 1);
            *value = (here * kernel[lag] + next * kernel[shifted]) as f32;
        }
    }
}
