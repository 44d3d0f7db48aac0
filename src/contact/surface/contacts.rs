//! Places of the contacts: those of a pressure that is known, and those that begin beside them.
//!
//! The undeformed bodies overlap in more places than they touch: the surface sinks about a contact. So windows are placed for the contacts of
//! the step before, and for places at which the bodies overlap by more than what the pressure of that step lets the surface sink.

use super::apart::ByPressure;
use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::search::Search;
use super::windows::{Place, Region, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::patch::extent::beyond_centre;
use crate::numerics::dense::largest;

/// Contacts that are looked at.
pub const CONTACTS: usize = 3 * WINDOWS;
/// Extent of the region that a window is placed for, over that of the contact in it: the contact may grow in a step.
const GROWTH: f64 = 1.08;
/// Turn of the rail over a contact, rad, from which on it lies in a gauge corner: 5 mm of one of 13 mm.
const CORNER_TURN: f64 = 0.4;
/// The extent across of a contact of which a narrow part counts: its ends go slowly, and with fine strips a window has little room for it.
const NARROW_GROWTH: f64 = 1.02;
/// Extent about such a region, over that of the region, in which no other contact is looked for: the window there finds it by itself, and so near a
/// contact the sinking of the surface is not known well.
pub const BESIDE: f64 = 1.8;
/// Approach that windows are placed for, over the expected one.
pub const AHEAD: f64 = 1.03;
/// Breadth of a contact over (∫f ds)²/∫f² ds of its force per breadth f: of an ellipse.
const ELLIPSE: f64 = 1.2;
/// Least depth, over the approach, by which the bodies overlap more than the surface sinks where a contact begins: the sinking is known to a few per cent of
/// the approach.
const LEAST_DEPTH: f64 = 0.02;

/// Region for a window.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted {
    /// The region.
    pub region: Region,
    /// Ends in arc length of the contact itself, and the breadth of its window's strips, `m`; none of an overlap.
    pub reach: Option<Reach>,
    /// Extents along and across of what its window has room for, over those of the region.
    pub room: [f64; 2],
}

/// Ends of a contact across the rail.
#[derive(Debug, Clone, Copy)]
pub struct Reach {
    /// Ends in arc length of the strips that carry, `m`.
    pub across: [f64; 2],
    /// Breadth of a strip, `m`.
    pub strip: f64,
}

impl Wanted {
    /// An overlap of the bodies.
    pub fn overlap(region: Region) -> Wanted {
        Wanted {
            region,
            reach: None,
            room: [1.0; 2],
        }
    }

    /// Takes in the next one, farther to the field side.
    pub fn join(&mut self, next: &Wanted) {
        self.region = self.region.union(&next.region);
        self.room = std::array::from_fn(|way| self.room[way].max(next.room[way]));
        self.reach = next.reach.or(self.reach);
    }

    /// Whether this contact and the next one are one: no more than a strip lies between them. Where they have two windows, the broader strip counts, as what lies
    /// between may be no more than the seam of the windows.
    pub fn goes_on_in(&self, next: &Wanted) -> bool {
        match (self.reach, next.reach) {
            (Some(own), Some(next)) => next.across[0] - own.across[1] < own.strip.max(next.strip) + ROUND_OFF,
            _ => false,
        }
    }
}

/// Round-off of arc lengths, `m`.
const ROUND_OFF: f64 = 1e-9;

/// Gap at the expected approach from which on a contact of the step before has ended, `m`: the wheelset has jumped. Heat and wear change the gap by less.
const LIFTED: f64 = 5e-4;

/// Contacts to expect of fields.
#[derive(Debug, Clone, Copy)]
pub struct Expected {
    /// Extent of the contacts over that in the fields.
    pub growth: f64,
    /// Extent about a contact, over that of its region, in which no other one is looked for.
    pub beside: f64,
    /// Load over that in the fields.
    pub load_ratio: f64,
    /// Approach, `m`.
    pub approach: f64,
}

impl Expected {
    /// The contacts that there are at an approach, `m`.
    pub fn unchanged(approach: f64) -> Expected {
        Expected {
            growth: 1.0,
            beside: BESIDE,
            load_ratio: 1.0,
            approach: approach * AHEAD,
        }
    }
}

/// Finds the contacts of the fields, grown as is expected of them, and the overlaps outside of them at the expected approach. They are listed from
/// the gauge side to the field side, without allocating.
pub fn find(
    operators: &SurfaceOperators,
    fields: &SurfaceFields,
    expected: Expected,
    search: &Search,
    apart: &mut ByPressure,
    found: &mut Vec<Wanted>,
) {
    let Expected {
        beside,
        load_ratio,
        approach,
        ..
    } = expected;
    found.clear();
    carrying(operators, fields, expected, search, found);
    found.retain(|own| search.is_near(own.region.across, approach + LIFTED));
    let carrying = found.len();
    let about: [Region; CONTACTS] = std::array::from_fn(|number| {
        found
            .get(number)
            .map_or(Region::default(), |own| own.region.grown(beside))
    });
    let least = LEAST_DEPTH * approach;
    // Asked for in few steps: most find no overlap outside of the contacts.
    let mut resultants_are_set = false;
    let mut last = f64::NAN;
    for overlap in search.deepest(approach) {
        let [along, across] = overlap.place;
        if about[..carrying].iter().any(|region| region.holds_across(across)) {
            last = f64::NAN;
            continue;
        }
        if !resultants_are_set {
            apart.set_resultants(operators, fields);
            resultants_are_set = true;
        }
        if overlap.depth - load_ratio * apart.sinking(operators, [along, across]) <= least {
            last = f64::NAN;
            continue;
        }
        let region = overlap.region(0.5 * overlap.spacing);
        // Places beside each other are one contact.
        let goes_on = (last - across).abs() < 1.5 * overlap.spacing;
        last = across;
        if let Some(wanted) = found[carrying..].last_mut()
            && goes_on
        {
            wanted.region = wanted.region.union(&region);
            wanted.region.narrowest = wanted.region.across[1] - wanted.region.across[0];
        } else if found.len() < CONTACTS {
            found.push(Wanted::overlap(region));
        }
    }
    found.sort_unstable_by(|a, b| a.region.across[0].total_cmp(&b.region.across[0]));
}

/// Finds the contacts of the fields: neighbouring strips that carry.
fn carrying(
    operators: &SurfaceOperators,
    fields: &SurfaceFields,
    expected: Expected,
    search: &Search,
    found: &mut Vec<Wanted>,
) {
    for (window, place) in fields.used() {
        let grid = &operators.of(&place).grid;
        let middle = place.middle_along(grid);
        let mut run: Option<Run> = None;
        // One more strip, that carries nothing, ends the last run.
        for strip in 0..=grid.strips {
            let row = (strip < grid.strips).then(|| &fields.windows[window].pressure[grid.row(strip)]);
            let first = row.and_then(|row| row.iter().position(|&pressure| pressure > 0.0));
            let (Some(row), Some(first)) = (row, first) else {
                if let Some(run) = run.take()
                    && found.len() < CONTACTS
                {
                    let breadth = run.across[1] - run.across[0];
                    let narrowest = (ELLIPSE * grid.breadth * run.force * run.force / run.squares).min(breadth);
                    let region = Region {
                        along: run.along,
                        across: run.across,
                        narrowest,
                        sharpest: search.sharpest(run.across, expected.approach),
                        is_measured: false,
                    };
                    let ends = || ends(&fields.windows[window].pressure, grid, &place, run.strips);
                    found.push(Wanted {
                        region: grown(operators, &region, ends, expected.growth),
                        reach: Some(Reach {
                            across: run.across,
                            strip: grid.breadth,
                        }),
                        room: [1.0; 2],
                    });
                }
                continue;
            };
            let last = row.iter().rposition(|&pressure| pressure > 0.0).unwrap_or(first);
            let force: f64 = row.iter().sum();
            let arc = place.arc(grid, strip);
            let along = [grid.x(first) - 0.5 * grid.length, grid.x(last) + 0.5 * grid.length].map(|x| middle + x);
            let run = run.get_or_insert(Run {
                along,
                across: [arc - 0.5 * grid.breadth; 2],
                strips: [strip; 2],
                force: 0.0,
                squares: 0.0,
            });
            run.along = [run.along[0].min(along[0]), run.along[1].max(along[1])];
            run.across[1] = arc + 0.5 * grid.breadth;
            run.strips[1] = strip;
            run.force += force;
            run.squares += force * force;
        }
    }
}

/// Ends in arc length of the contact on neighbouring strips, `m`: within the outermost of them, by the largest pressure there and on the next one.
fn ends(pressure: &[f64], grid: &Grid, place: &Place, [first, last]: [usize; 2]) -> [f64; 2] {
    let peak = |strip: usize| largest(&pressure[grid.row(strip)]);
    let beyond = |end: usize, next: usize| {
        let inside = if first == last { 0.0 } else { peak(next) };
        grid.breadth * beyond_centre(peak(end), inside)
    };
    [
        place.arc(grid, first) - beyond(first, first + 1),
        place.arc(grid, last) + beyond(last, last.wrapping_sub(1)),
    ]
}

/// Region for a contact, grown as is expected of it. In a gauge corner the load goes from one end of a broad contact to the other, and a narrow part carries
/// most of it: there a contact counts as no broader than the part over which the rail turns by [`CORNER_TURN`].
fn grown(operators: &SurfaceOperators, contact: &Region, ends: impl Fn() -> [f64; 2], growth: f64) -> Region {
    let [[y, z], [v, w]] = contact.across.map(|arc| operators.bodies.rail.at(arc).normal);
    let turn = (y * w - z * v).atan2(y * v + z * w).abs();
    let region = contact.grown(GROWTH * growth);
    let lies_in_corner = turn > CORNER_TURN;
    if !lies_in_corner && !contact.is_sharp() {
        return region;
    }
    let within = Region {
        across: ends(),
        ..*contact
    };
    let [from, to] = within.grown(NARROW_GROWTH * growth).across;
    let narrowest = if lies_in_corner {
        region.narrowest.min((to - from) * CORNER_TURN / turn)
    } else {
        region.narrowest
    };
    Region {
        across: [from, to],
        narrowest,
        is_measured: true,
        ..region
    }
}

/// Neighbouring strips that carry.
struct Run {
    along: [f64; 2],
    across: [f64; 2],
    /// First and last strip.
    strips: [usize; 2],
    /// Sum of the strips' forces, and of their squares, scaled.
    force: f64,
    squares: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A contact ends near the centre of a strip that next to nothing acts on, and at the edge of one that carries as much as the next one.
    #[test]
    fn a_contact_ends_within_its_outermost_strips() {
        let grid = Grid::new(3, 5, 1.5e-3, 2.5e-3);
        let place = Place {
            length: 0,
            breadth: 0,
            cell: 0,
            strip: 20,
        };
        let mut pressure = vec![0.0; grid.len()];
        for (strip, carried) in [(1, 1e-9), (2, 2.0), (3, 2.0)] {
            pressure[grid.place(strip, 1)] = carried;
        }
        let [from, to] = ends(&pressure, &grid, &place, [1, 3]);
        // The first cell of a contact is under pressure from 0.156 of a cell before its centre on.
        assert!(
            (from - 21.656e-3).abs() < 1e-9 && (to - 24e-3).abs() < 1e-9,
            "{from} {to}"
        );
        // A strip by itself says nothing of where in it the contact ends.
        let [from, to] = ends(&pressure, &grid, &place, [2, 2]);
        assert!((from - 22e-3).abs() < 1e-9 && (to - 23e-3).abs() < 1e-9, "{from} {to}");
    }

    /// Two contacts with a strip between them, to round-off, are one, and the broader strip counts; with more between them they are two. An overlap is no contact yet.
    #[test]
    fn contacts_with_a_strip_between_them_go_on_in_each_other() {
        let strip = 0.1e-3;
        let contact = |across: [f64; 2], strip: f64| Wanted {
            reach: Some(Reach { across, strip }),
            ..Wanted::overlap(Region::default())
        };
        let first = contact([37.0e-3, 38.2e-3], strip);
        for (breadth, between, goes_on) in [
            (strip, 0.0, true),
            (strip, 1.0, true),
            (strip, 1.1, false),
            (4.0 * strip, 4.0, true),
            (4.0 * strip, 4.1, false),
        ] {
            let begin = 38.2e-3 + between * strip;
            let next = contact([begin, begin + breadth], breadth);
            assert_eq!(first.goes_on_in(&next), goes_on, "{breadth}: {between}");
        }
        assert!(!first.goes_on_in(&Wanted::overlap(Region::default())));
    }
}
