//! Windows of a contact of profiles: their sizes, their places on the rail's surface.
//!
//! All windows have as many cells along and strips across as a patch; what differs is the size of the cells. Lengths and breadths come
//! in powers of two of the largest, so that what is computed once serves any window, and a cell of one window is a whole number
//! of cells of another.

use crate::body::grid::Grid;
use crate::contact::on_wheelset::CONTACTS;
use serde::{Deserialize, Serialize};

/// Largest number of windows: contacts that are resolved.
pub const WINDOWS: usize = CONTACTS;
/// Number of lengths that a window may have.
pub const LENGTHS: usize = 5;
/// Number of breadths that a window may have.
pub const BREADTHS: usize = 6;

/// Arc lengths of a window that has the whole surface to itself, `m`.
pub const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Cells along the window, and strips across it, that stay free on either side of a region that a window is placed for.
const MARGIN: [f64; 2] = [1.5, 1.0];
/// Strips across the window that stay free on either side of a region in a window that stays, and in one for a contact whose ends are known.
const LEAST_MARGIN: f64 = 0.5;
/// Free cells on either side of a region along a window that stays, over all cells along it; one cell is enough. On few cells it is less than one: with a whole one, a contact that
/// just fits went to and fro between windows of two lengths.
const MARGIN_ALONG: f64 = 1.0 / 32.0;
/// Least share of a window's length that the region in it takes up, before the window becomes shorter.
const LEAST_SHARE: f64 = 0.36;
/// Share of a window's strips that the narrowest contact in it has at least when a window is placed, and when it stays.
const FEWEST_STRIPS: [f64; 2] = [0.4, 0.32];
/// Largest share of a window's strips that the narrowest contact has in a window that stays.
const MOST_STRIPS: f64 = 0.85;

/// Breadth that counts for the strips, over that of a contact curved all over as the sharpest part of it is: a peak of the pressure there gets 1/2.5 of the
/// strips that a contact does, with which it is found to some per cent.
const SHARP: f64 = 2.5;

/// Size and place of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    /// Number of its length: it is halved so many times.
    pub length: usize,
    /// Number of its breadth.
    pub breadth: usize,
    /// First cell along the rail, counted in cells of its length from below the axle.
    pub cell: i32,
    /// First strip, counted in strips of its breadth from the beginning of the rail's profile.
    pub strip: i32,
}

/// Region of the rail's surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Region {
    /// Ends along the rail, `m` ahead of the axle.
    pub along: [f64; 2],
    /// Ends in arc length of the rail's profile, `m`.
    pub across: [f64; 2],
    /// Breadth of the narrowest contact in it, `m`.
    pub narrowest: f64,
    /// Breadth of a contact under the same approach whose bodies are curved against each other all over as these are at their sharpest place, `m`.
    pub sharpest: f64,
    /// Whether it is that of a contact whose ends are known to a part of a strip.
    pub is_measured: bool,
}

/// Sizes of all windows.
#[derive(Debug, Clone, Copy)]
pub struct Sizes {
    /// The largest window.
    pub largest: Grid,
}

impl Place {
    /// Number of the shape.
    pub fn shape(&self) -> usize {
        self.length * BREADTHS + self.breadth
    }

    /// Distance of the window's middle ahead of the axle, `m`.
    pub fn middle_along(&self, grid: &Grid) -> f64 {
        (f64::from(self.cell) + 0.5 * grid.cells as f64) * grid.length
    }

    /// Arc length of the rail's profile at the middle of a strip, `m`.
    pub fn arc(&self, grid: &Grid, strip: usize) -> f64 {
        (f64::from(self.strip) + strip as f64 + 0.5) * grid.breadth
    }

    /// Region that the window covers.
    pub fn region(&self, grid: &Grid) -> Region {
        let (cell, strip) = (f64::from(self.cell), f64::from(self.strip));
        Region {
            along: [cell, cell + grid.cells as f64].map(|count| count * grid.length),
            across: [strip, strip + grid.strips as f64].map(|count| count * grid.breadth),
            narrowest: grid.strips as f64 * grid.breadth,
            sharpest: f64::INFINITY,
            is_measured: false,
        }
    }
}

impl Region {
    /// Smallest region that holds both.
    pub fn union(&self, other: &Region) -> Region {
        let hull = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Region {
            along: hull(self.along, other.along),
            across: hull(self.across, other.across),
            narrowest: self.narrowest.min(other.narrowest),
            sharpest: self.sharpest.min(other.sharpest),
            is_measured: self.is_measured && other.is_measured,
        }
    }

    /// The region with its extents, and those of the contact in it, grown about its middle.
    pub fn grown(&self, factor: f64) -> Region {
        let grown = |[from, to]: [f64; 2]| {
            let more = 0.5 * (factor - 1.0) * (to - from);
            [from - more, to + more]
        };
        Region {
            along: grown(self.along),
            across: grown(self.across),
            narrowest: factor * self.narrowest,
            sharpest: self.sharpest,
            is_measured: self.is_measured,
        }
    }

    /// The region grown about its middle by a factor along and one across, with the contact in it as broad as the region has become broader.
    pub fn with_room(&self, [along, across]: [f64; 2]) -> Region {
        Region {
            along: self.grown(along).along,
            ..self.grown(across)
        }
    }

    /// Whether somewhere in it the bodies are curved so sharply that strips for the breadth of its contacts are too broad there.
    pub fn is_sharp(&self) -> bool {
        self.resolved() < self.narrowest
    }

    /// Breadth that the strips of its window are to resolve, `m`.
    fn resolved(&self) -> f64 {
        self.narrowest.min(SHARP * self.sharpest)
    }

    /// Whether it has a part at an arc length.
    pub fn holds(&self, [along, across]: [f64; 2]) -> bool {
        (self.along[0]..=self.along[1]).contains(&along) && self.holds_across(across)
    }

    /// Whether an arc length lies in it.
    pub fn holds_across(&self, arc: f64) -> bool {
        self.across[0] <= arc && arc <= self.across[1]
    }

    /// Whether the two have a point in common.
    pub fn meets(&self, other: &Region) -> bool {
        let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
        overlap(self.along, other.along) && overlap(self.across, other.across)
    }
}

impl Sizes {
    /// Grid of a window of the given length and breadth.
    pub fn grid(&self, length: usize, breadth: usize) -> Grid {
        Grid {
            length: self.largest.length / f64::from(1_u32 << length),
            breadth: self.largest.breadth / f64::from(1_u32 << breadth),
            ..self.largest
        }
    }

    /// Window for a region: `kept` where that holds it and is not far too large, else one about the region's middle: the shortest that
    /// holds it, with as broad strips as resolve the narrowest contact, or broader ones where it would not hold the region.
    pub fn place(&self, region: &Region, kept: Option<Place>) -> Place {
        if let Some(kept) = kept
            && self.suits(region, &kept)
        {
            return kept;
        }
        let Grid { cells, strips, .. } = self.largest;
        let length = finest_holding(region.along, cells, MARGIN[0], self.largest.length, LENGTHS);
        let breadth = self.breadth_of(region, self.finest_for(region, kept));
        let grid = self.grid(length, breadth);
        let first = |extent: [f64; 2], size: f64, count: usize| {
            (0.5 * (extent[0] + extent[1]) / size - 0.5 * count as f64).round() as i32
        };
        Place {
            length,
            breadth,
            cell: first(region.along, grid.length, cells),
            strip: first(region.across, grid.breadth, strips),
        }
    }

    /// Number of the least breadth that holds a region: with a margin, and without one where the window has had it, so that a contact which just
    /// fits does not go to and fro. Ends that are known to a part of a strip are the same ones on other strips, and need no margin either.
    fn finest_for(&self, region: &Region, kept: Option<Place>) -> usize {
        let Grid { strips, breadth, .. } = self.largest;
        let finest = |margin: f64| finest_holding(region.across, strips, margin, breadth, BREADTHS);
        let [with_margin, without] = [MARGIN[1], LEAST_MARGIN].map(finest);
        match kept {
            _ if region.is_measured => without,
            Some(kept) => kept.breadth.min(without).max(with_margin),
            None => with_margin,
        }
    }

    /// Number of the breadth for a region: the broadest that resolves the narrowest contact, but none finer than the given one.
    fn breadth_of(&self, region: &Region, finest: usize) -> usize {
        let Grid { strips, breadth, .. } = self.largest;
        let resolved = region.resolved() / (FEWEST_STRIPS[0] * strips as f64);
        (0..finest)
            .find(|&level| shrunk(breadth, level) <= resolved)
            .unwrap_or(finest)
    }

    /// Number of the breadth for a region of a new window.
    fn breadth_for(&self, region: &Region) -> usize {
        self.breadth_of(region, self.finest_for(region, None))
    }

    /// Breadth of a strip of the window for a region, `m`.
    pub fn strip_for(&self, region: &Region) -> f64 {
        shrunk(self.largest.breadth, self.breadth_for(region))
    }

    /// Whether a window holds a region with a margin and is not far too large for it.
    fn suits(&self, region: &Region, place: &Place) -> bool {
        let grid = self.grid(place.length, place.breadth);
        let window = place.region(&grid);
        let holds = |outer: [f64; 2], inner: [f64; 2], margin: f64| {
            inner[0] >= outer[0] + margin && inner[1] <= outer[1] - margin
        };
        let margin_along = (MARGIN_ALONG * grid.cells as f64).min(1.0);
        let length = (region.along[1] - region.along[0]) / (window.along[1] - window.along[0]);
        let strips = region.resolved() / (window.across[1] - window.across[0]);
        holds(window.along, region.along, margin_along * grid.length)
            && holds(window.across, region.across, LEAST_MARGIN * grid.breadth)
            && (place.length + 1 == LENGTHS || length > LEAST_SHARE)
            && self.resolves(region, place)
            && (place.breadth == 0 || strips < MOST_STRIPS)
    }

    /// Whether the strips of a window resolve the narrowest contact of a region, or are the finest that hold it.
    pub fn resolves(&self, region: &Region, place: &Place) -> bool {
        let grid = self.grid(place.length, place.breadth);
        let strips = region.resolved() / (grid.strips as f64 * grid.breadth);
        strips > FEWEST_STRIPS[1] || self.breadth_for(region) <= place.breadth
    }
}

/// Size of a cell or strip after so many halvings.
fn shrunk(size: f64, level: usize) -> f64 {
    size / f64::from(1_u32 << level)
}

/// Number of the finest of the sizes with which so many cells, less a margin on either side, hold an extent.
fn finest_holding(extent: [f64; 2], count: usize, margin: f64, largest: f64, levels: usize) -> usize {
    let needed = (extent[1] - extent[0]) / (count as f64 - 2.0 * margin);
    (0..levels)
        .rev()
        .find(|&level| needed <= shrunk(largest, level))
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes() -> Sizes {
        Sizes {
            largest: Grid::new(34, 32, 17e-3, 12.8e-3),
        }
    }

    fn region(across: [f64; 2]) -> Region {
        Region {
            along: [-4e-3, 4e-3],
            across,
            narrowest: 5e-3,
            sharpest: f64::INFINITY,
            is_measured: false,
        }
    }

    /// A region that needs all strips of its window but one keeps their breadth when it moves; a new window for it has broader ones.
    #[test]
    fn a_contact_that_just_fits_keeps_its_strips() {
        let sizes = sizes();
        let before = sizes.place(&region([20e-3, 31.8e-3]), None);
        let moved = region([22e-3, 34.3e-3]);
        let kept = sizes.place(&moved, Some(before));
        assert_eq!((before.breadth, kept.breadth), (1, 1));
        assert!(kept.strip > before.strip);
        assert!(kept.region(&sizes.grid(kept.length, kept.breadth)).meets(&moved));
        assert_eq!(sizes.place(&moved, None).breadth, 0);
        let measured = Region {
            is_measured: true,
            ..moved
        };
        assert_eq!(sizes.place(&measured, None).breadth, 1);
    }
}
