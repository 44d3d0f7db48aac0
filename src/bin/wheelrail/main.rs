//! The command line `wheelrail`.

mod binary;
mod describe;
mod fields;
mod files;
mod names;
mod pack;
mod preset;
mod progress;
mod scenario;
mod simulate;
mod standard;
mod table;
mod torture;
mod verify;

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
