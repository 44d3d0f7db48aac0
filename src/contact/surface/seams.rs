//! Seams: where the part of the surface that one window has to itself ends, and that of the next window begins.
//!
//! A seam is placed half-way between two regions that windows are wanted for, before the contacts in them are known. A contact that reaches the seam would go on beyond it. It is
//! cut off there, and its pressure has a false peak. The step is then tried again, and the window of that contact gets the surface up to the other region. Where the contact reaches the end of that as
//! well, or both contacts have reached the seam, one window is made for both. Not at once: a window for both has
//! the cells of the larger region, and the forces of a wheel that moves sideways step by more where windows are joined.

use super::contacts::Wanted;
use super::windows::{Place, Region, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::patch::extent::is_loaded;

/// Number of contacts that are found to be cut off in a step, at most: at both ends of each window in five tries.
pub const CUTS: usize = 10 * WINDOWS;
/// Distance of two seams, over the mean breadth of the regions beside one, below which they are the same: between two tries the regions change a little with the approach.
const SAME: f64 = 0.1;

/// A contact that reaches a seam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOff {
    /// Arc length of the seam, `m`.
    pub seam: f64,
    /// Whether the contact lies on the gauge side of it.
    pub is_on_gauge_side: bool,
}

/// Contacts of a window that are cut off at the ends of what it has to itself: the last strip before one is under pressure.
pub fn cut_off(grid: &Grid, place: &Place, own: [f64; 2], pressure: &[f64]) -> [Option<CutOff>; 2] {
    [0, 1].map(|end| {
        let seam = own[end];
        let is_beside = |&strip: &usize| (place.arc(grid, strip) - seam).abs() <= grid.breadth;
        let is_cut_off = (0..grid.strips)
            .filter(is_beside)
            .any(|strip| is_loaded(grid, pressure, strip));
        is_cut_off.then_some(CutOff {
            seam,
            is_on_gauge_side: end == 1,
        })
    })
}

/// Arc length of the seam between two regions, from the gauge side to the field side, `m`.
pub fn between(first: &Region, next: &Region) -> f64 {
    0.5 * (first.across[1] + next.across[0])
}

/// Moves the seam between two regions to the end of one of them, where the contact of the other one has been cut off. Returns whether they may have windows of their own.
pub fn give_room(first: &mut Wanted, next: &mut Wanted, cut_off: &[CutOff]) -> bool {
    let seam = between(&first.region, &next.region);
    let (own, other) = (&mut first.region.across, &mut next.region.across);
    let near = SAME * 0.5 * (own[1] - own[0] + other[1] - other[0]);
    let is_cut_off = |is_on_gauge_side: bool, seam: f64| {
        let mut cuts = cut_off.iter().filter(|cut| cut.is_on_gauge_side == is_on_gauge_side);
        cuts.any(|cut| (cut.seam - seam).abs() <= near)
    };
    let (end, begin) = (own[1], other[0]);
    match [is_cut_off(true, seam), is_cut_off(false, seam)] {
        [false, false] => true,
        [true, false] if begin > end && !is_cut_off(true, begin) => {
            own[1] = begin;
            true
        }
        [false, true] if begin > end && !is_cut_off(false, end) => {
            other[0] = end;
            true
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::windows::EVERYWHERE;
    use super::*;

    /// A window with strips of 1 mm from 10 mm on, of which those from 14 to 20 mm, to round-off, belong to it.
    const OWN: [f64; 2] = [14e-3, 20e-3];

    fn cuts(loaded: std::ops::Range<usize>, own: [f64; 2]) -> [Option<CutOff>; 2] {
        let grid = Grid::new(8, 12, 4e-3, 6e-3);
        let place = Place {
            length: 0,
            breadth: 0,
            cell: -4,
            strip: 10,
        };
        let mut pressure = vec![0.0; grid.len()];
        for strip in loaded {
            pressure[grid.row(strip).start + 3] = 1.0;
        }
        cut_off(&grid, &place, own, &pressure)
    }

    #[test]
    fn a_contact_is_cut_off_where_the_last_strip_of_its_own_carries() {
        let cut = |seam: f64, is_on_gauge_side: bool| Some(CutOff { seam, is_on_gauge_side });
        assert_eq!(cuts(5..9, OWN), [None; 2]);
        assert_eq!(cuts(4..9, OWN), [cut(14e-3, false), None]);
        assert_eq!(cuts(5..10, OWN), [None, cut(20e-3, true)]);
        assert_eq!(cuts(0..12, EVERYWHERE), [None; 2]);
    }

    /// Regions of 2 mm with 4 mm between them: the seam goes to the end of the region whose contact has not reached it, and there is none where that was not enough or both have.
    #[test]
    fn a_contact_that_is_cut_off_gets_the_surface_up_to_the_next_region() {
        let region = |across: [f64; 2]| {
            Wanted::overlap(Region {
                across,
                ..Region::default()
            })
        };
        let cut = |seam: f64, is_on_gauge_side: bool| CutOff { seam, is_on_gauge_side };
        let given = |cuts: &[CutOff]| {
            let (mut first, mut next) = (region([10e-3, 12e-3]), region([16e-3, 18e-3]));
            let room = give_room(&mut first, &mut next, cuts);
            room.then_some([first.region.across, next.region.across])
        };
        let [first, next] = [[10e-3, 12e-3], [16e-3, 18e-3]];
        assert_eq!(given(&[]), Some([first, next]));
        assert_eq!(given(&[cut(13e-3, true)]), Some([first, next]), "another seam");
        assert_eq!(given(&[cut(14.1e-3, true)]), Some([[10e-3, 16e-3], next]));
        assert_eq!(given(&[cut(14.1e-3, false)]), Some([first, [12e-3, 18e-3]]));
        assert_eq!(given(&[cut(14e-3, true), cut(16e-3, true)]), None, "not enough");
        assert_eq!(given(&[cut(14e-3, true), cut(14e-3, false)]), None, "both");
    }
}
