//! Operators of a contact of profiles: wheel and rail in their shapes, and those of a patch for each size of a window.

use super::bodies::{Bodies, WHEEL, measures};
use super::interpolation::Interpolation;
use super::windows::{BREADTHS, LENGTHS, Place, Sizes};
use crate::body::grid::Grid;
use crate::body::half_space::HalfSpaces;
use crate::contact::patch::operators::PatchOperators;
use crate::error::{Error, ProfileError, Result};
use crate::geometry::profile::files::ReadOptions;
use crate::geometry::profile::{Body, DepthGrid, Profile, WornHeight};
use crate::geometry::rail::PlacedRail;
use crate::geometry::unrolled::Wheel;
use crate::parameters::{Parameters, ProfileContents, ProfileSource, ProfileWear};

/// Distance of the points of the rail's profile at which contacts are sought, `m`: less than the breadth of the smallest that carries
/// an appreciable load.
const SCAN_STEP: f64 = 0.5e-3;
/// Sine of the inclination to the field side, 60°, beyond which no contact is sought: no tread is as hollow. There the normals miss the wheel, and the search
/// spent a third of its time on them.
const STEEPEST_TO_THE_FIELD: f64 = 0.866;
/// Length of the longest window over that of a patch's: contacts on the flange are several times as long as broad.
const LONGEST: f64 = 4.8;
/// Breadth of the broadest window over that of a patch's: contacts in the gauge corner are several times as broad as long.
const BROADEST: f64 = 4.0;

/// Strips of a window for two of a patch: a contact in a gauge corner may be broad, and the load in it concentrated.
const STRIPS: usize = 3;

/// Wheel, rail, and the operators of a window for each of its sizes.
pub struct SurfaceOperators {
    /// Rail and wheel as they were new.
    pub bodies: Bodies,
    /// Profiles of wheel and rail as they were read, the rail's upright.
    pub profiles: [Profile; 2],
    /// Cells in which the depths of wear of both profiles are collected.
    pub grids: [DepthGrid; 2],
    /// Whether wheel and rail wear.
    wears: [bool; 2],
    /// Height of the wheel where it wears.
    pub worn_height: WornHeight,
    /// Radius of the new wheel in the middle of its cells, `m`.
    pub wheel_radii: Vec<f64>,
    /// 1 on the left side of the track, −1 on the right, whose mirror image is solved.
    pub side: f64,
    /// Sizes of the windows.
    pub sizes: Sizes,
    /// Interpolation along the strips of a window.
    pub along: Interpolation,
    /// Operators by the number of the shape.
    pub shapes: Vec<PatchOperators>,
    /// The bodies as half-spaces.
    pub pair: HalfSpaces,
    /// Position of the flange's tip on the wheel's profile towards the tread, from the running circle to the field side, `m`.
    pub flange_tip: f64,
    /// Distance of the running circle from the back of the wheel's flange, `m`.
    pub flange_back_position: f64,
    /// Strips of the rail by the number of their breadth.
    gauge_faces: Vec<GaugeFace>,
}

/// Strips of one breadth over the rail's profile, and how far they belong to its gauge face.
struct GaugeFace {
    /// Number of the first strip.
    first: i32,
    /// Shares of the strips, 0 to 1.
    shares: Vec<f64>,
}

impl GaugeFace {
    /// Shares of the strips of a breadth, and of as many as a window has before the first and after the last one.
    fn new(parameters: &Parameters, rail: &PlacedRail, breadth: f64, strips: usize) -> GaugeFace {
        let [first, last] = rail.range().map(|arc| (arc / breadth).floor() as i32);
        let around = strips as i32 + 1;
        let share = |strip: i32| {
            let [across, up] = rail.at((f64::from(strip) + 0.5) * breadth).normal;
            let inclination = (-across).atan2(up);
            let t = ((inclination - parameters.gauge_face_angle) / parameters.gauge_face_blend).clamp(0.0, 1.0);
            // As smooth as derivatives by the place ask for.
            t * t * (3.0 - 2.0 * t)
        };
        GaugeFace {
            first: first - around,
            shares: (first - around..=last + around).map(share).collect(),
        }
    }
}

impl SurfaceOperators {
    /// Makes the profiles, of the contents of their files where they are in such, and computes the operators of all windows.
    ///
    /// # Errors
    /// A profile that does not serve, [`crate::error::Error::DepthBasis`].
    pub fn build(parameters: &Parameters, contents: &ProfileContents) -> Result<SurfaceOperators> {
        let profiles = [
            profile(
                "wheel_profile",
                &parameters.wheel_profile,
                contents.wheel.as_deref(),
                Body::Wheel,
                parameters,
            )?,
            profile(
                "rail_profile",
                &parameters.rail_profile,
                contents.rail.as_deref(),
                Body::Rail,
                parameters,
            )?,
        ];
        let (rail, wheel) = placed(&profiles, parameters)?;
        let (half_length, half_breadth) = parameters.patch_window();
        let sizes = Sizes {
            largest: Grid::new(
                parameters.patch_nodes,
                (STRIPS * parameters.patch_strips).div_ceil(2),
                LONGEST * half_length,
                BROADEST * half_breadth,
            ),
        };
        let strips = sizes.largest.strips;
        let narrow = [strips / 3, strips / 2, 2 * strips / 3].map(|strips| strips.max(2));
        let [first, last] = rail.range();
        let points = ((last - first) / SCAN_STEP) as usize;
        let scan: Vec<_> = (0..=points)
            .map(|point| {
                let arc = last - point as f64 * SCAN_STEP;
                (arc, rail.at(arc))
            })
            .skip_while(|(_, point)| point.normal[0] > STEEPEST_TO_THE_FIELD)
            .collect();
        let cells = parameters.profile_wear_points;
        let worn_height = WornHeight::new(&profiles[WHEEL], cells).map_err(Error::Profile)?;
        let grids = [worn_height.grid(), DepthGrid::new(rail.range(), cells)];
        let radius = |cell: usize| {
            let [_, z] = profiles[WHEEL].at(grids[WHEEL].middle(cell)).place;
            wheel.radius - z
        };
        let gauge_faces = (0..BREADTHS)
            .map(|breadth| GaugeFace::new(parameters, &rail, sizes.grid(0, breadth).breadth, strips))
            .collect();
        let shapes = (0..LENGTHS).flat_map(|length| (0..BREADTHS).map(move |breadth| (length, breadth)));
        Ok(SurfaceOperators {
            wheel_radii: (0..grids[WHEEL].cells).map(radius).collect(),
            wears: [parameters.wheel_profile_wear, parameters.rail_profile_wear].map(|wear| wear == ProfileWear::On),
            flange_tip: wheel.profile.flange_tip(),
            flange_back_position: parameters.flange_back_position,
            bodies: Bodies {
                measures: measures(&wheel, parameters.flange_back_position),
                rail,
                wheel,
                scan,
            },
            grids,
            worn_height,
            profiles,
            side: parameters.side_sign(),
            shapes: shapes
                .map(|(length, breadth)| PatchOperators::on_grid(parameters, sizes.grid(length, breadth), &narrow))
                .collect::<Result<_>>()?,
            along: Interpolation::new(sizes.largest.cells),
            gauge_faces,
            sizes,
            pair: HalfSpaces::of_pair(parameters),
        })
    }

    /// Shares of a window's strips that belong to the rail's gauge face.
    pub fn gauge_face(&self, place: &Place) -> &[f64] {
        let GaugeFace { first, shares } = &self.gauge_faces[place.breadth];
        usize::try_from(place.strip - first)
            .ok()
            .and_then(|first| shares.get(first..first + self.sizes.largest.strips))
            .unwrap_or(&[])
    }

    /// Number of cells in which the depth of a body is collected; 0 of one that stays new.
    pub fn wear_cells(&self, body: usize) -> usize {
        if self.wears[body] { self.grids[body].cells } else { 0 }
    }

    /// Operators of a window.
    pub fn of(&self, place: &Place) -> &PatchOperators {
        &self.shapes[place.shape()]
    }
}

/// Rail and wheel in their shapes.
fn placed([wheel, rail]: &[Profile; 2], parameters: &Parameters) -> Result<(PlacedRail, Wheel)> {
    let inclined = rail
        .inclined(parameters.rail_inclination.atan())
        .map_err(Error::Profile)?;
    let rail = PlacedRail::new(inclined, parameters.gauge, parameters.gauge_depth).map_err(Error::Profile)?;
    let wheel = Wheel {
        profile: wheel.height_function().map_err(Error::Profile)?,
        radius: parameters.wheel_radius,
        offset: parameters.running_circle(),
    };
    Ok((rail, wheel))
}

/// Profile that the text of a parameter names: one that is built in, or one of a file with this content.
fn profile(
    parameter: &'static str,
    text: &str,
    content: Option<&str>,
    body: Body,
    parameters: &Parameters,
) -> Result<Profile> {
    let profile = match ProfileSource::of(parameter, text)? {
        ProfileSource::BuiltIn(name) => Profile::built_in(name),
        ProfileSource::File(path) => {
            let options = ReadOptions {
                body: Some(body),
                smoothing: parameters.profile_smoothing,
                ..ReadOptions::default()
            };
            content
                .ok_or_else(|| ProfileError::File {
                    path: path.display().to_string(),
                    reason: "its content is not known".to_owned(),
                })
                .and_then(|content| Profile::of_file(&path, content, &options))
        }
    };
    let named = |reason| Error::NamedProfile {
        name: parameter,
        text: text.to_owned(),
        reason: Box::new(reason),
    };
    let profile = profile.map_err(named)?;
    profile.require(body).map_err(named)?;
    Ok(profile)
}
