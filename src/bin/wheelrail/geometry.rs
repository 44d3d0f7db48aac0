//! `wheelrail geometry`: where a wheelset's wheels touch the rails, over its lateral displacement, without forces.

use crate::files::{self, Files};
use crate::geometry_picture;
use crate::profile;
use crate::table::{self, Table, heading};
use clap::{ArgGroup, Args};
use std::path::{Path, PathBuf};
use wheelrail::contact_geometry::{Conicity, Dimensions, Jump, Pose, Sweep, Touch, Wheelset};
use wheelrail::{Body, Profile, ProfileError};

/// Options of `geometry`.
#[derive(Args)]
#[command(group = ArgGroup::new("drawn").args(["outlines", "picture"]).multiple(true))]
pub struct Geometry {
    /// Profile of the rails: a name of `wheelrail profile`, or a file.
    #[arg(long, value_name = "NAME|FILE", default_value = "60E1")]
    rail: String,
    /// Profile of the wheels: a name of `wheelrail profile`, or a file.
    #[arg(long, value_name = "NAME|FILE", default_value = "S1002")]
    wheel: String,
    /// Profile of the right rail, where it is another one.
    #[arg(long, value_name = "NAME|FILE")]
    rail_right: Option<String>,
    /// Profile of the right wheel, where it is another one.
    #[arg(long, value_name = "NAME|FILE")]
    wheel_right: Option<String>,
    /// Wavelength of the smoothing of profiles from files, `m`: waves of this length are halved.
    #[arg(long, value_name = "METRES", default_value_t = 0.0, allow_hyphen_values = true)]
    smoothing: f64,
    /// First lateral displacement of the wheelset, `m`, to the left: the table begins there.
    #[arg(long, value_name = "METRES", default_value_t = -8e-3, allow_hyphen_values = true)]
    from: f64,
    /// Last lateral displacement, `m`: the table ends there, or at the last step before it.
    #[arg(long, value_name = "METRES", default_value_t = 8e-3, allow_hyphen_values = true)]
    to: f64,
    /// Step of the lateral displacement from the first one on, `m`.
    #[arg(long, value_name = "METRES", default_value_t = 1e-4, allow_hyphen_values = true)]
    step: f64,
    /// Yaw of the wheelset, rad, anticlockwise from above.
    #[arg(long, value_name = "RADIANS", default_value_t = 0.0, allow_hyphen_values = true)]
    yaw: f64,
    /// Distance of the rails' running faces, `m`.
    #[arg(long, value_name = "METRES", default_value_t = Dimensions::default().gauge, allow_hyphen_values = true)]
    gauge: f64,
    /// Depth below the rails' tops at which the gauge is measured, `m`.
    #[arg(long, value_name = "METRES", default_value_t = Dimensions::default().gauge_depth, allow_hyphen_values = true)]
    gauge_depth: f64,
    /// Inclination of the rails as a slope: 0 for profiles that are inclined already.
    #[arg(long, value_name = "SLOPE", default_value_t = 0.025, allow_hyphen_values = true)]
    rail_inclination: f64,
    /// Distance between the backs of the flanges, `m`.
    #[arg(long, value_name = "METRES", default_value_t = Dimensions::default().flange_back_distance, allow_hyphen_values = true)]
    flange_back_distance: f64,
    /// Distance of the running circles from the backs of their flanges, `m`: says where the wheels stand in the track. The option of this
    /// name of `wheelrail profile` is another one, which moves the points of a file.
    #[arg(long, value_name = "METRES", default_value_t = Dimensions::default().flange_back_position, allow_hyphen_values = true)]
    flange_back_position: f64,
    /// Radius of the running circles, `m`.
    #[arg(long, value_name = "METRES", default_value_t = Dimensions::default().wheel_radii[0], allow_hyphen_values = true)]
    wheel_radius: f64,
    /// Radius of the right wheel, where it is another one, `m`.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    wheel_radius_right: Option<f64>,
    /// Keep the axle level, each wheel touching by itself: the reference results of EN 15302 are without roll.
    #[arg(long)]
    level: bool,
    /// CSV file for the table; without it the table goes to the standard output.
    #[arg(short, long, value_name = "OUT.csv")]
    output: Option<PathBuf>,
    /// CSV file for the jumps of the contacts.
    #[arg(long, value_name = "JUMPS.csv")]
    jumps: Option<PathBuf>,
    /// CSV file for the outlines of rails and wheels where they touch, for pictures.
    #[arg(long, value_name = "OUTLINES.csv")]
    outlines: Option<PathBuf>,
    /// SVG file for a picture: rails and wheels where they touch, difference of the rolling radii, equivalent conicity and places of the contacts.
    #[arg(long, value_name = "PICTURE.svg")]
    picture: Option<PathBuf>,
    /// Lateral displacement at which rails and wheels are drawn, `m`.
    #[arg(
        long,
        value_name = "METRES",
        default_value_t = 0.0,
        allow_hyphen_values = true,
        requires = "drawn"
    )]
    outlines_at: f64,
}

/// Reason why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A profile or a dimension that does not serve.
    #[error("{0}{hint}", hint = profile::hint(.0))]
    Profile(#[from] ProfileError),
    /// A profile that is neither built in nor a file.
    #[error(transparent)]
    Named(#[from] profile::Error),
    /// A file that is not to be written, or cannot be.
    #[error(transparent)]
    Files(#[from] files::Error),
    /// A table that cannot be written.
    #[error(transparent)]
    Table(#[from] table::Error),
    /// A picture of another kind than SVG.
    #[error("--picture {}: the picture is SVG; its name must end in .svg", path.display())]
    PictureName {
        /// File of the picture.
        path: PathBuf,
    },
    /// A picture that cannot be written.
    #[error("{}: the picture cannot be written: {reason}", path.display())]
    Picture {
        /// File of the picture.
        path: PathBuf,
        /// Reason for it.
        reason: String,
    },
}

/// Sides in the order of the library, as columns are called by them.
pub const SIDES: [&str; 2] = ["left", "right"];
/// Amplitude at which EN 15302 has the conicity, `m`.
const AMPLITUDE: f64 = 3e-3;

impl Geometry {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        self.check_files()?;
        let profiles = self.profiles()?;
        let wheelset = self.wheelset(&profiles)?;
        let sweep = Sweep::new(&wheelset, [self.from, self.to], self.step, self.yaw)?;
        let motion = sweep.motion();
        let conicity = |amplitude: f64| motion.as_ref().and_then(|motion| motion.conicity(amplitude));
        let amplitudes = sweep.poses.iter().map(|pose| pose.lateral.abs());
        let conicities: Vec<_> = amplitudes
            .map(|amplitude| conicity(amplitude).map(|found| found.conicity))
            .collect();
        let is_drawn = self.outlines.is_some() || self.picture.is_some();
        let drawn = is_drawn.then(|| wheelset.at(self.outlines_at, self.yaw)).transpose()?;
        // Only now that nothing can be refused any more, so that a refusal leaves no file behind.
        let mut out = Table::open(self.output.as_deref(), headings())?;
        for (pose, conicity) in sweep.poses.iter().zip(&conicities) {
            let touches = pose.touches.iter().flat_map(|touch| {
                let Touch {
                    on_rail,
                    on_wheel,
                    ahead,
                    inclination,
                    rolling_radius,
                } = *touch;
                [on_rail, on_wheel, ahead, inclination, rolling_radius]
            });
            let place = [pose.lateral, pose.yaw, pose.roll, pose.vertical];
            let row = place.into_iter().chain(touches).chain([pose.radius_difference()]);
            out.write_some(row.map(Some).chain([*conicity]))?;
        }
        out.finish()?;
        if let Some(path) = &self.jumps {
            jumps(path, &sweep.jumps)?;
        }
        if let Some(pose) = &drawn {
            if let Some(path) = &self.outlines {
                write_outlines(path, &wheelset, pose)?;
            }
            if let Some(path) = &self.picture {
                geometry_picture::write(path, &wheelset, pose, (&sweep.poses, &conicities))?;
            }
        }
        summary(conicity(AMPLITUDE), &sweep.jumps);
        remark(&profiles);
        Ok(())
    }

    /// Refuses files that would overwrite a profile or each other, or that cannot be written.
    fn check_files(&self) -> Result<(), Error> {
        let mut files = Files::default();
        for (option, name) in [
            ("--rail", Some(&self.rail)),
            ("--wheel", Some(&self.wheel)),
            ("--rail-right", self.rail_right.as_ref()),
            ("--wheel-right", self.wheel_right.as_ref()),
        ] {
            files.reads(option, name.and_then(|name| profile::file(name)));
        }
        files.writes("--output", self.output.as_deref());
        files.writes("--jumps", self.jumps.as_deref());
        files.writes("--outlines", self.outlines.as_deref());
        files.writes("--picture", self.picture.as_deref());
        if let Some(path) = &self.picture {
            geometry_picture::check_name(path)?;
        }
        Ok(files.check()?)
    }

    /// Profiles of the rails, then those of the wheels, each the left one first.
    fn profiles(&self) -> Result<[Profile; 4], Error> {
        let named = |name: &str, body: Body| profile::named(name, body, self.smoothing);
        let names = [&self.rail, &self.wheel].into_iter();
        let mut names = names.chain(&self.rail_right).chain(&self.wheel_right);
        if self.smoothing != 0.0 && names.all(|name| profile::is_built_in(name)) {
            return Err(Error::Profile(ProfileError::NotUsed {
                name: format!("{}, {}", self.rail, self.wheel),
                option: "smoothing",
                reason: "all profiles are built in",
            }));
        }
        let rail = named(&self.rail, Body::Rail)?;
        let wheel = named(&self.wheel, Body::Wheel)?;
        let other = |name: &Option<String>, body, same: &Profile| {
            name.as_deref()
                .map_or_else(|| Ok(same.clone()), |name| named(name, body))
        };
        let rail_right = other(&self.rail_right, Body::Rail, &rail)?;
        let wheel_right = other(&self.wheel_right, Body::Wheel, &wheel)?;
        Ok([rail, rail_right, wheel, wheel_right])
    }

    fn wheelset(&self, [rail, rail_right, wheel, wheel_right]: &[Profile; 4]) -> Result<Wheelset, Error> {
        let radius = self.wheel_radius;
        let dimensions = Dimensions {
            gauge: self.gauge,
            gauge_depth: self.gauge_depth,
            rail_inclination: profile::angle(self.rail_inclination)?,
            flange_back_distance: self.flange_back_distance,
            flange_back_position: self.flange_back_position,
            wheel_radii: [radius, self.wheel_radius_right.unwrap_or(radius)],
        };
        let wheelset = Wheelset::new([rail, rail_right], [wheel, wheel_right], &dimensions)?;
        Ok(if self.level { wheelset.level() } else { wheelset })
    }
}

/// Says the conicity and the jumps, beside the table.
fn summary(conicity: Option<Conicity>, jumps: &[Jump]) {
    match conicity {
        Some(found) => eprintln!("equivalent conicity at {} mm: {:.4}", 1e3 * AMPLITUDE, found.conicity),
        None => eprintln!(
            "no equivalent conicity at {} mm: the wheels do not steer back, or the displacements end before",
            1e3 * AMPLITUDE
        ),
    }
    for jump in jumps {
        let [from, to] = jump.on_wheel.map(|place| 1e3 * place);
        eprintln!(
            "the {} contact jumps at {:.3} mm from {from:.2} to {to:.2} mm on the wheel",
            SIDES[jump.side],
            1e3 * jump.lateral
        );
    }
}

/// Says of which profiles the contacts jump with the noise.
fn remark(profiles: &[Profile]) {
    let mut rough: Vec<_> = profiles.iter().filter(|profile| profile.is_rough()).collect();
    rough.dedup_by_key(|profile| profile.name());
    for profile in rough {
        eprintln!(
            "remark: {}: its {} (--smoothing); the contacts jump with it",
            profile.name(),
            ProfileError::NOISE
        );
    }
}

/// Headings of the table.
fn headings() -> impl Iterator<Item = String> {
    let place = [
        ("lateral_displacement", "m"),
        ("yaw_angle", "rad"),
        ("roll_angle", "rad"),
        ("vertical_displacement", "m"),
    ];
    let contact = [
        ("on_rail", "m"),
        ("on_wheel", "m"),
        ("ahead", "m"),
        ("inclination", "rad"),
        ("rolling_radius", "m"),
    ];
    let contacts = SIDES
        .iter()
        .flat_map(move |side| contact.map(|(name, unit)| heading(&format!("{side}_{name}"), unit)));
    let rest = [("rolling_radius_difference", "m"), ("equivalent_conicity", "1")];
    let named = |(name, unit)| heading(name, unit);
    place
        .into_iter()
        .map(named)
        .chain(contacts)
        .chain(rest.into_iter().map(named))
}

/// Writes the outlines of rails and wheels at a pose.
fn write_outlines(path: &Path, wheelset: &Wheelset, pose: &Pose) -> Result<(), Error> {
    let names = ["side", "body"].map(str::to_owned).into_iter();
    let columns = names.chain(["y", "z"].map(|name| heading(name, "m")));
    let mut table = Table::open(Some(path), columns)?;
    for (side, name) in SIDES.iter().enumerate() {
        for (body, points) in ["rail", "wheel"].iter().zip(wheelset.outlines(pose, side)) {
            for point in points {
                table.write_named(&[name, body], point.into_iter())?;
            }
        }
    }
    Ok(table.finish()?)
}

/// Table of the jumps.
fn jumps(path: &Path, jumps: &[Jump]) -> Result<(), Error> {
    let columns = ["lateral_displacement", "wheel_from", "wheel_to", "rail_from", "rail_to"];
    let columns = std::iter::once("side".to_owned()).chain(columns.map(|name| heading(name, "m")));
    let mut table = Table::open(Some(path), columns)?;
    for jump in jumps {
        let places = jump.on_wheel.into_iter().chain(jump.on_rail);
        table.write_named(&[SIDES[jump.side]], std::iter::once(jump.lateral).chain(places))?;
    }
    Ok(table.finish()?)
}
