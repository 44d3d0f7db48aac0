//! The command line `wheelrail`.

mod simulate;
mod verify;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Thermoelastic wheel–rail rolling contact with temperature-dependent friction, heat and wear.
#[derive(Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Simulate a scenario natively, without FMI, and write all outputs as CSV
    Simulate(simulate::Arguments),
    /// Compare the model with closed forms, identities and published figures
    Verify,
}

fn main() -> ExitCode {
    match Cli::parse().command {
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Verify => verify::run(),
    }
}
