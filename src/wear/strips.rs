//! The wear depth of the strips of a patch: the march of [`super::WearMarch`] in all strips at once.
//!
//! Depths are kept in blocks of [`LANES`] strips side by side. [`StripWearMarch::advance`] is the rail ahead and the window, as often
//! as the wear rate changes; [`StripWearMarch::finalise`] is the rail behind, which does not act back. What strips have in
//! common with the rail ahead and behind is in [`crate::transport::strips`].

use super::{WearChange, WearMarch, WearSteps};
use crate::numerics::dense::LANES;
use crate::transport::strips::{Side, Strips};
use crate::transport::{CellEnds, CellStep};
use serde::{Deserialize, Serialize};

/// Wear depth of the strips and of the rail ahead and behind, `m`, or a change of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StripWear {
    /// Depths of the strips, blocks × columns × [`LANES`]: the strips, after them the rail beside the contact.
    pub window: Vec<f64>,
    /// Depths of the rail on either side of the window; at the column next to the window the mean.
    pub outer: [Vec<f64>; 2],
    /// Depths at the cells, strip by strip.
    pub depth: Vec<f64>,
    /// Depths that the step has overwritten: those in the strips' inflow column, blocks × [`LANES`], where rail
    /// entered, and the mean at the outflow column. The derivatives of the step need them.
    pub replaced: Vec<f64>,
    /// B of the last step with a contact, `m`.
    pub breadth: f64,
}

impl StripWear {
    /// Unworn rail.
    pub fn new(strips: &Strips) -> StripWear {
        let lanes = strips.blocks() * LANES;
        let outer = |side| vec![0.0; strips.outer_positions(side).len()];
        StripWear {
            window: vec![0.0; strips.columns() * lanes],
            outer: [outer(Side::Left), outer(Side::Right)],
            depth: vec![0.0; strips.strips * strips.cells],
            replaced: vec![0.0; lanes + 2],
            breadth: strips.breadth * strips.strips as f64,
        }
    }

    /// Depth of a strip at one of its columns, `m`; the strip after the last is the rail beside the contact.
    #[cfg(feature = "verification")]
    pub fn at(&self, strips: &Strips, strip: usize, column: usize) -> f64 {
        self.window[(strip / LANES * strips.columns() + column) * LANES + strip % LANES]
    }

    /// The vectors, in the order of their declaration.
    pub fn vectors(&self) -> [&Vec<f64>; 5] {
        let [left, right] = &self.outer;
        [&self.window, left, right, &self.depth, &self.replaced]
    }

    /// The vectors to change, in the same order.
    pub fn vectors_mut(&mut self) -> [&mut Vec<f64>; 5] {
        let [left, right] = &mut self.outer;
        [&mut self.window, left, right, &mut self.depth, &mut self.replaced]
    }
}

/// The steps between the columns on either side.
#[derive(Debug, Clone)]
pub struct StripWearSteps {
    outer: [WearSteps; 2],
}

impl StripWearSteps {
    /// Steps for the cells of the given strips.
    pub fn new(strips: &Strips) -> StripWearSteps {
        StripWearSteps {
            outer: [Side::Left, Side::Right].map(|side| WearSteps::new(strips.outer_positions(side))),
        }
    }
}

/// One step of the strips.
pub struct StripWearMarch<'a> {
    /// The strips.
    pub strips: &'a Strips,
    /// Speed V, `m/s`; 0 counts as forward.
    pub speed: f64,
    /// Step Δt, `s`; infinite for the steady depth.
    pub duration: f64,
}

/// A value of each strip of a block.
type Lanes = [f64; LANES];

impl StripWearMarch<'_> {
    /// Advances the rail ahead and the strips from `before`, with rail entering at the depth `incoming` `m`, under the
    /// wear rate at the cells, strip by strip, `m/s`.
    pub fn advance(
        &self,
        rate: &[f64],
        incoming: f64,
        before: &StripWear,
        after: &mut StripWear,
        steps: &mut StripWearSteps,
    ) {
        let entering = self.enter(incoming, after, |march, side, outer| {
            march.advance(&[], &before.outer[side], outer, &mut steps.outer[side]);
        });
        let step = self.step();
        let storage = 1.0 / self.duration;
        let window = self.strips.window(self.speed);
        for block in 0..self.strips.blocks() {
            let own = self.block(block);
            let (before, after) = (&before.window[own.clone()], &mut after.window[own]);
            let (before, after) = (before.as_chunks::<LANES>().0, after.as_chunks_mut::<LANES>().0);
            let mut depth = [entering; LANES];
            after[window.inflow()] = depth;
            let mut source = before[window.inflow()].map(|depth| storage * depth);
            for column in window.columns() {
                let mut own_source = self.at(rate, block, column.index);
                for lane in 0..LANES {
                    own_source[lane] += storage * before[column.index][lane];
                    let fed = step.upstream * source[lane] + step.diagonal * own_source[lane];
                    depth[lane] = fed + step.courant_weight * depth[lane];
                }
                source = own_source;
                after[column.index] = depth;
            }
        }
        self.read_cells(after);
    }

    /// The rail behind, over a contact of breadth B `breadth` `m`. Without a contact, at 0, it is that of the last step with one.
    pub fn finalise(&self, breadth: f64, before: &StripWear, after: &mut StripWear, steps: &mut StripWearSteps) {
        let (ahead, behind) = self.strips.ends(self.speed);
        let inflow = self.strips.window(self.speed).inflow();
        let lanes = self.strips.blocks() * LANES;
        for strip in 0..lanes {
            after.replaced[strip] = before.window[self.place(strip, inflow)];
        }
        for (replaced, side) in after.replaced[lanes..].iter_mut().zip([ahead, behind]) {
            *replaced = before.outer[side as usize][self.strips.outer(side, self.speed).inflow()];
        }
        after.breadth = if breadth > 0.0 { breadth } else { before.breadth };
        let outflow = self.strips.window(self.speed).outflow();
        let leaving = self
            .strips
            .mean(after.breadth, |strip| after.window[self.place(strip, outflow)]);
        let march = self.outer_march(behind);
        let side = behind as usize;
        after.outer[side][march.transport.inflow()] = leaving;
        march.advance(&[], &before.outer[side], &mut after.outer[side], &mut steps.outer[side]);
    }

    /// Depth of the rail that leaves at the end of the strip, `m`.
    pub fn leaving(&self, field: &StripWear) -> f64 {
        let (_, behind) = self.strips.ends(self.speed);
        field.outer[behind as usize][self.strips.outer(behind, self.speed).outflow()]
    }

    /// Computes the change of [`StripWearMarch::advance`]'s part of the result `after` with `change` and with the change
    /// `incoming` `m` of the depth that enters.
    pub fn advance_tangent(&self, change: WearChange, incoming: f64, after: &StripWear, tangent: &mut StripWear) {
        let lanes = self.strips.blocks() * LANES;
        let outer_change = WearChange { rate: &[], ..change };
        let entering = self.enter(incoming, tangent, |march, side, outer| {
            march.advance_tangent(outer_change, after.replaced[lanes], &after.outer[side], outer);
        });
        let step = self.step();
        let storage = 1.0 / self.duration;
        let (spacing, speed) = (self.strips.spacing(), self.speed.abs());
        let window = self.strips.window(self.speed);
        for block in 0..self.strips.blocks() {
            let own = self.block(block);
            let after_block = after.window[own.clone()].as_chunks::<LANES>().0;
            let tangent = tangent.window[own].as_chunks_mut::<LANES>().0;
            let mut depth_change = [entering; LANES];
            tangent[window.inflow()] = depth_change;
            // The sources of the step follow from its result.
            let mut source: Lanes = std::array::from_fn(|lane| storage * after.replaced[block * LANES + lane]);
            let mut source_change = [0.0; LANES];
            for column in window.columns() {
                let own_change = self.at(change.rate, block, column.index);
                for lane in 0..LANES {
                    let values = CellEnds {
                        upstream: after_block[column.upstream][lane],
                        column: after_block[column.index][lane],
                    };
                    let sources = CellEnds {
                        upstream: source[lane],
                        column: step.source(values, source[lane]),
                    };
                    let by_speed = CellStep::speed_tangent(storage, spacing, speed, values, sources);
                    depth_change[lane] = step.courant_weight * depth_change[lane]
                        + step.upstream * source_change[lane]
                        + step.diagonal * own_change[lane]
                        + change.speed * by_speed;
                    source[lane] = sources.column;
                }
                source_change = own_change;
                tangent[column.index] = depth_change;
            }
        }
        self.read_cells(tangent);
    }

    /// The change of [`StripWearMarch::finalise`], with those of |V|, by `speed_change` `m/s`, and of B, by `breadth_change` `m`, 0
    /// without a contact.
    pub fn finalise_tangent(&self, speed_change: f64, breadth_change: f64, after: &StripWear, tangent: &mut StripWear) {
        let (_, behind) = self.strips.ends(self.speed);
        let outflow = self.strips.window(self.speed).outflow();
        let at = |field: &StripWear, strip: usize| field.window[self.place(strip, outflow)];
        let widening = -breadth_change * self.strips.breadth / (after.breadth * after.breadth);
        let leaving = self.strips.mean(after.breadth, |strip| at(tangent, strip))
            + widening * self.strips.excess(|strip| at(after, strip));
        let march = self.outer_march(behind);
        let side = behind as usize;
        let replaced = after.replaced[self.strips.blocks() * LANES + 1];
        tangent.outer[side][march.transport.inflow()] = leaving;
        march.advance_tangent(
            WearChange {
                rate: &[],
                speed: speed_change,
            },
            replaced,
            &after.outer[side],
            &mut tangent.outer[side],
        );
        tangent.breadth = breadth_change;
    }

    /// The rail ahead with the depth `incoming` entering there, and the depth that enters the window.
    fn enter(
        &self,
        incoming: f64,
        field: &mut StripWear,
        march_outer: impl FnOnce(WearMarch, usize, &mut [f64]),
    ) -> f64 {
        let (ahead, _) = self.strips.ends(self.speed);
        let march = self.outer_march(ahead);
        let (inflow, outflow) = (march.transport.inflow(), march.transport.outflow());
        let outer = &mut field.outer[ahead as usize];
        outer[inflow] = incoming;
        march_outer(march, ahead as usize, outer);
        outer[outflow]
    }

    /// The march on one side: nothing wears there.
    fn outer_march(&self, side: Side) -> WearMarch<'_> {
        WearMarch {
            transport: self.strips.outer(side, self.speed),
            duration: self.duration,
            first_contact: 0,
        }
    }

    fn step(&self) -> CellStep {
        CellStep::new(1.0 / self.duration, self.strips.spacing(), self.speed.abs())
    }

    /// Range of a block's depths.
    fn block(&self, block: usize) -> std::ops::Range<usize> {
        let size = self.strips.columns() * LANES;
        block * size..(block + 1) * size
    }

    /// Index of a strip's depth in a column.
    fn place(&self, strip: usize, column: usize) -> usize {
        (strip / LANES * self.strips.columns() + column) * LANES + strip % LANES
    }

    /// The wear rate of a block's strips in a column.
    fn at(&self, rate: &[f64], block: usize, column: usize) -> Lanes {
        let (cells, mut found) = (self.strips.cells, [0.0; LANES]);
        let cell = column.wrapping_sub(1);
        if cell < cells {
            let strips = rate[block * LANES * cells..].chunks_exact(cells);
            for (found, strip) in found.iter_mut().zip(strips) {
                *found = strip[cell];
            }
        }
        found
    }

    fn read_cells(&self, field: &mut StripWear) {
        for (strip, depths) in field.depth.chunks_exact_mut(self.strips.cells).enumerate() {
            for (cell, depth) in depths.iter_mut().enumerate() {
                *depth = field.window[self.place(strip, cell + 1)];
            }
        }
    }
}

#[cfg(test)]
mod tests;
