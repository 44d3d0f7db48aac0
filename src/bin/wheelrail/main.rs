//! The command line `wheelrail`.

mod binary;
mod describe;
mod fields;
mod files;
mod geometry;
mod geometry_picture;
mod names;
mod pack;
mod preset;
mod profile;
mod progress;
mod scenario;
mod simulate;
mod standard;
mod table;
mod torture;
mod verify;
mod wear;

use clap::{Parser, Subcommand};
use std::error::Error;
use std::io;
use std::process::ExitCode;

/// Thermoelastic wheel-rail rolling contact: pack the FMU, describe its variables, simulate natively, verify.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build the archive WheelRailContact.fmu.
    Pack(pack::Pack),
    /// List inputs, outputs, parameters and locals.
    Describe(describe::Describe),
    /// Simulate a scenario natively, without FMI, and write inputs and outputs as CSV.
    ///
    /// The scenario is a table with a header: a column `time`, ascending, and a column for each input that changes. A
    /// heading may have a unit, `time [ms]`, `normal_load [kN]`, `creepage [%]`; without one it is that of `wheelrail
    /// describe`. Between its rows the inputs are interpolated linearly; other inputs keep their start values. A column
    /// that the chosen slip_source or control does not use is refused, unless it is everywhere at the input's start value. Lines that
    /// begin with # are comments.
    ///
    /// Fields are written for one instant, the last one: place, pressure, shear on the rail, slip of the rail relative to
    /// the wheel, the share of Coulomb's bound, absolute temperature and wear depth.
    Simulate(simulate::Simulate),
    /// Tell where a wheelset's wheels touch the rails over its lateral displacement, without forces.
    ///
    /// Both wheels touch: roll and height follow. The table has, for each displacement, the places of the contacts on rail and wheel
    /// (positive to the field side, from the rail's highest point and the wheel's running circle) and ahead of the axle, their
    /// inclination, the rolling radii and their difference, left less right, and the equivalent conicity of that amplitude by EN 15302's
    /// integration, empty where there is none. The conicity at 3 mm and the jumps of the contacts are said beside.
    Geometry(Box<geometry::Geometry>),
    /// List the built-in profiles, or look at or convert one, built in or from a file.
    ///
    /// The table has y to the field side, z upward, arc length, inclination and curvature. A rail's origin is its highest point, a wheel's
    /// its running circle. What a file does not say of its unit and directions is found by its shape, or has to be given.
    Profile(profile::Options),
    /// List the named sets of parameters, or print one.
    Presets(preset::Presets),
    /// Compare the model with closed forms, identities and published figures.
    Verify(verify::Verify),
    /// Drive wheels with random parameters at random: what fails, and which steps are slow.
    Torture(torture::Options),
}

fn main() -> ExitCode {
    let result: Result<(), Box<dyn Error>> = match Arguments::parse().command {
        Command::Pack(command) => command.run().map_err(Into::into),
        Command::Describe(command) => command.run().map_err(Into::into),
        Command::Simulate(command) => command.run().map_err(Into::into),
        Command::Geometry(command) => command.run().map_err(Into::into),
        Command::Profile(command) => command.run().map_err(Into::into),
        Command::Presets(command) => command.run().map_err(Into::into),
        Command::Verify(command) => command.run().map_err(Into::into),
        Command::Torture(command) => command.run().map_err(Into::into),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Who reads has seen enough, as in `wheelrail describe | head`.
        Err(error) if is_broken_pipe(&*error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("wheelrail: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Whether an error comes from output that nobody reads any more.
fn is_broken_pipe(error: &(dyn Error + 'static)) -> bool {
    let mut causes = std::iter::successors(Some(error), |error| (*error).source());
    causes.any(|error| {
        let error = error.downcast_ref::<io::Error>();
        error.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    })
}
