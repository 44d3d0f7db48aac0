//! The command line `wheelrail`.

mod binary;
mod describe;
mod fields;
mod pack;
mod preset;
mod simulate;
mod standard;
mod table;
mod torture;
mod verify;

use clap::{Parser, Subcommand};
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
    /// The scenario is a table with a header: a column `time` `s`, ascending, and a column for each input that changes,
    /// in SI units. Between its rows the inputs are interpolated linearly; other inputs keep their start values. Lines
    /// that begin with # are comments.
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
    let result: Result<(), Box<dyn std::error::Error>> = match Arguments::parse().command {
        Command::Pack(command) => command.run().map_err(Into::into),
        Command::Describe(command) => command.run().map_err(Into::into),
        Command::Simulate(command) => command.run().map_err(Into::into),
        Command::Presets(command) => command.run().map_err(Into::into),
        Command::Verify(command) => command.run().map_err(Into::into),
        Command::Torture(command) => command.run().map_err(Into::into),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("wheelrail: {error}");
            ExitCode::FAILURE
        }
    }
}
