//! `wheelrail simulate`: a scenario from CSV through the model, without FMI.

use crate::files::{self, Files};
use crate::progress::Progress;
use crate::table::{self, Table, heading};
use crate::{fields, names, preset, scenario, wear};
use clap::Args;
use std::path::PathBuf;
use std::sync::Arc;
use wheelrail::parameters::{ProfileSource, ProfileWear};
use wheelrail::profile_files::{check_ending, ending_of, written_endings};
use wheelrail::signals::{InputSignal, OutputSignal};
use wheelrail::simulation::{self, Point, Schedule};
use wheelrail::wheel_rail::Convergence;
use wheelrail::{
    Body, ContactModel, Error as ModelError, INPUTS, Model, OUTPUTS, Outputs, Parameters, ProfileError, Simulation,
};

/// Depth that a step may wear off a profile without a word, `m`.
const LARGEST_PROFILE_CHANGE: f64 = 1e-6;
/// Steps of a run at most: at a microsecond each these are a quarter of an hour, and no step is as short.
const MOST_STEPS: usize = 1_000_000_000;

/// Options of `simulate`.
#[derive(Args)]
pub struct Simulate {
    /// The scenario: time and inputs, linear between the rows.
    #[arg(value_name = "SCENARIO.csv")]
    scenario: PathBuf,
    /// CSV file for time, inputs and outputs: all that the contact model may have
    #[arg(short, long, value_name = "OUT.csv")]
    output: PathBuf,
    /// CSV file for the fields at the end: a row for each node of a line contact, or cell of a patch or of the windows of profiles
    #[arg(long, value_name = "FIELDS.csv")]
    fields: Option<PathBuf>,
    /// CSV file for the wear of both profiles at the end: places and depths, where contact_model is profiles
    #[arg(long, value_name = "DEPTHS.csv")]
    profile_wear: Option<PathBuf>,
    /// File for the wheel's profile as worn at the end, where contact_model is profiles: SIMPACK's (.prw), MiniProf's (.whl, .mpt), VAMPIRE's
    /// (.whe), or a table of y and z (.csv)
    #[arg(long, value_name = "WHEEL.prw")]
    worn_wheel: Option<PathBuf>,
    /// File for the rail's profile as worn at the end, upright, where contact_model is profiles: SIMPACK's (.prr), MiniProf's (.ban, .mpt),
    /// VAMPIRE's (.rai), or a table of y and z (.csv)
    #[arg(long, value_name = "RAIL.prr")]
    worn_rail: Option<PathBuf>,
    /// Communication step, `s`.
    #[arg(long, value_name = "SECONDS", default_value_t = 1e-3, allow_hyphen_values = true)]
    step: f64,
    /// Named parameters: one of `wheelrail presets`, or a file of that kind. Repeatable; a later one wins over an earlier one,
    /// and --set over all.
    #[arg(long, value_name = "NAME|FILE.toml")]
    preset: Vec<String>,
    /// A parameter in SI units, as thermal_expansion=0, or a choice by its name; `wheelrail describe` lists them. Repeatable;
    /// wins over every --preset, wherever it stands.
    #[arg(long = "set", value_name = "NAME=VALUE")]
    set: Vec<String>,
}

/// Reason why a simulation stopped.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file of results that cannot be written.
    #[error(transparent)]
    Table(#[from] table::Error),
    /// A file that does not serve as a scenario.
    #[error(transparent)]
    Scenario(#[from] Box<scenario::Error>),
    /// A file that is not to be written, or cannot be.
    #[error(transparent)]
    Files(#[from] files::Error),
    /// A communication step that cannot be.
    #[error("--step {step}: the communication step is a positive, finite number of seconds")]
    Step {
        /// Step that was given.
        step: f64,
    },
    /// More steps than can be meant.
    #[error(
        "--step {step:e}: from {start} s to {end} s these are {count:e} steps, more than {MOST_STEPS:e}; the default is 1e-3 s"
    )]
    TooManySteps {
        /// Step that was given.
        step: f64,
        /// Start of the scenario, `s`.
        start: f64,
        /// End of the scenario, `s`.
        end: f64,
        /// Steps that it would take.
        count: f64,
    },
    /// A `--set` without an equals sign.
    #[error("--set {text:?}: expected name=value")]
    NotAnAssignment {
        /// Text that was given.
        text: String,
    },
    /// A named set of parameters that does not serve.
    #[error("--preset: {0}")]
    Preset(#[from] preset::Error),
    /// A parameter that cannot be.
    #[error("{0}{hint}", hint = names::hint(.0))]
    Parameter(ModelError),
    /// Worn profiles that there are not, or that cannot be written.
    #[error("worn profiles: {0}")]
    NoProfiles(ModelError),
    /// Files that only profiles have something for.
    #[error("{option}: only contact_model = 3 (profiles) has profiles that wear")]
    NotProfiles {
        /// The option that names the file.
        option: &'static str,
    },
    /// A file of a worn profile whose name is that of the other body's files.
    #[error("{option}: {source}")]
    WornEnding {
        /// The option that names the file.
        option: &'static str,
        /// Reason.
        source: ProfileError,
    },
    /// A file of a worn profile whose name does not say what is to be written.
    #[error("{option} {}: the name of a file of a {body} ends in one of .{}", path.display(), endings.join(", ."))]
    UnknownEnding {
        /// The option that names the file.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// "rail" or "wheel".
        body: &'static str,
        /// Endings that are written, without the dot.
        endings: &'static [&'static str],
    },
    /// A file of a worn profile that does not wear.
    #[error("{option}: the {body} does not wear; with {parameter} = 2 (on) it does")]
    NoWear {
        /// The option that names the file.
        option: &'static str,
        /// "rail" or "wheel".
        body: &'static str,
        /// Parameter that makes the body wear.
        parameter: &'static str,
    },
    /// The model cannot start.
    #[error("at the start of the scenario: {0}")]
    Start(ModelError),
    /// The model cannot go on.
    #[error("{source}; {output} holds what was computed before")]
    Interrupted {
        /// The results.
        output: PathBuf,
        /// Step that failed, and the reason.
        source: Box<simulation::Error>,
    },
}

impl Simulate {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        let mut parameters = self.parameters()?;
        self.check_files(&parameters)?;
        let start_value = Parameters::default().largest_load;
        let follows = parameters.largest_load == start_value && !self.sets("largest_load");
        let schedule = scenario::read(&self.scenario, &mut parameters, follows).map_err(Box::new)?;
        if follows && parameters.largest_load > start_value {
            eprintln!(
                "largest_load = {} N follows the loads of the scenario",
                parameters.largest_load
            );
        }
        self.check_steps(&schedule)?;
        let steps = schedule.steps(self.step).map_err(|_| Error::Step { step: self.step })?;
        let of_wear = self.files_of_wear().into_iter().find(|(_, path)| path.is_some());
        if let Some((option, _)) = of_wear.filter(|_| parameters.contact_model != ContactModel::Profiles) {
            return Err(Error::NotProfiles { option });
        }
        self.check_worn(&parameters)?;
        let model = Arc::new(Model::new(parameters).map_err(Error::Parameter)?);
        let start = schedule.start();
        let mut simulation = Simulation::of(model, &start.inputs).map_err(Error::Start)?;
        for remark in simulation.model.parameters().without_effect() {
            eprintln!("{remark}");
        }
        // Only now that nothing can be refused any more, so that a refusal leaves no file behind.
        let contact_model = simulation.model.parameters().contact_model;
        let columns = Columns::of(contact_model);
        let mut table = Table::create(&self.output, columns.headings())?;
        let fields = self.fields.as_deref();
        let mut fields = fields.map(|path| fields::create(path, contact_model)).transpose()?;
        columns.write(&mut table, &start, simulation.outputs())?;

        let count = steps.len();
        let mut progress = Progress::new(count as u64);
        let (mut interrupted, mut staggered, mut full, mut crowded, mut overloaded, mut worn_at_once) =
            (None, 0, 0, 0, 0, 0f64);
        for step in steps {
            if let Err(source) = simulation.follow(&step) {
                interrupted = Some(Box::new(source));
                break;
            }
            staggered += usize::from(simulation.state.convergence.staggered);
            full += usize::from(simulation.state.convergence.fills_window);
            crowded += usize::from(simulation.state.convergence.crowded);
            overloaded += usize::from(simulation.state.convergence.overloaded);
            worn_at_once = worn_at_once.max(simulation.state.convergence.profile_change);
            columns.write(&mut table, &step.to, simulation.outputs())?;
            progress.step();
        }
        table.finish()?;
        if let Some(fields) = &mut fields {
            fields::write(fields, &simulation)?;
        }
        self.write_wear(&simulation)?;
        progress.end(interrupted.is_some());
        if worn_at_once > LARGEST_PROFILE_CHANGE {
            eprintln!(
                "a step has worn a profile by {:.3} µm at once, more than {}; shorter steps or a smaller wear_acceleration follow the wear",
                1e6 * worn_at_once,
                1e6 * LARGEST_PROFILE_CHANGE
            );
        }
        if staggered > 0 {
            eprintln!(
                "{}: mechanics, heat and wear were not solved together, but one after the other; shorter steps may be solved",
                steps_in_words(staggered)
            );
        }
        if full > 0 {
            eprintln!(
                "{}: {}",
                steps_in_words(full),
                simulation.model.parameters().full_window_remark()
            );
        }
        if crowded > 0 {
            eprintln!("{}: {}", steps_in_words(crowded), Convergence::CROWDED);
        }
        if overloaded > 0 {
            eprintln!(
                "{}: {}",
                steps_in_words(overloaded),
                simulation.model.parameters().overload_remark()
            );
        }
        if let Some(source) = interrupted {
            let output = self.output.clone();
            return Err(Error::Interrupted { output, source });
        }
        let end = schedule.end().time;
        eprintln!("{} to {end} s: {}", steps_in_words(count), self.output.display());
        Ok(())
    }

    /// The files for the profiles' wear, with the options that name them.
    fn files_of_wear(&self) -> [(&'static str, &Option<PathBuf>); 3] {
        [
            ("--profile-wear", &self.profile_wear),
            ("--worn-wheel", &self.worn_wheel),
            ("--worn-rail", &self.worn_rail),
        ]
    }

    /// Writes what is asked for of the profiles' wear.
    fn write_wear(&self, simulation: &Simulation) -> Result<(), Error> {
        if let Some(path) = &self.profile_wear {
            wear::write(path, &simulation.profile_wear().map_err(Error::NoProfiles)?)?;
        }
        if self.worn_wheel.is_none() && self.worn_rail.is_none() {
            return Ok(());
        }
        let [wheel, rail] = simulation.worn_profiles().map_err(Error::NoProfiles)?;
        for (path, profile) in [(&self.worn_wheel, wheel), (&self.worn_rail, rail)] {
            if let Some(path) = path {
                profile
                    .write(path)
                    .map_err(|error| Error::NoProfiles(ModelError::Profile(error)))?;
            }
        }
        Ok(())
    }

    /// Refuses files of results that would overwrite what the run reads or each other, or that cannot be written.
    fn check_files(&self, parameters: &Parameters) -> Result<(), Error> {
        let mut files = Files::default();
        files.reads("the scenario", Some(&self.scenario));
        for name in &self.preset {
            files.reads("--preset", preset::file(name));
        }
        let profiles = [
            ("rail_profile", &parameters.rail_profile),
            ("wheel_profile", &parameters.wheel_profile),
        ];
        let is_read = parameters.contact_model == ContactModel::Profiles;
        for (name, text) in profiles.into_iter().filter(|_| is_read) {
            if let ProfileSource::File(path) = ProfileSource::of(name, text).map_err(Error::Parameter)? {
                files.reads(name, Some(&path));
            }
        }
        files.writes("--output", Some(&self.output));
        files.writes("--fields", self.fields.as_deref());
        for (option, path) in self.files_of_wear() {
            files.writes(option, path.as_deref());
        }
        Ok(files.check()?)
    }

    /// Refuses files of worn profiles whose names are those of the other body's files or of none that are written, and those of a body
    /// that does not wear.
    fn check_worn(&self, parameters: &Parameters) -> Result<(), Error> {
        let wheel = (Body::Wheel, "wheel_profile_wear", parameters.wheel_profile_wear);
        let rail = (Body::Rail, "rail_profile_wear", parameters.rail_profile_wear);
        for (option, path, (body, parameter, wear)) in [
            ("--worn-wheel", &self.worn_wheel, wheel),
            ("--worn-rail", &self.worn_rail, rail),
        ] {
            let Some(path) = path else { continue };
            check_ending(path, body).map_err(|source| Error::WornEnding { option, source })?;
            let endings = written_endings(body);
            if !endings.contains(&ending_of(path).as_str()) {
                return Err(Error::UnknownEnding {
                    option,
                    path: path.clone(),
                    body: body.name(),
                    endings,
                });
            }
            if wear == ProfileWear::Off {
                return Err(Error::NoWear {
                    option,
                    body: body.name(),
                    parameter,
                });
            }
        }
        Ok(())
    }

    /// Refuses a step that is short beyond any sense: the run would not end.
    fn check_steps(&self, schedule: &Schedule) -> Result<(), Error> {
        let (start, end) = (schedule.start().time, schedule.end().time);
        let (step, count) = (self.step, (end - start) / self.step);
        if step > 0.0 && count > MOST_STEPS as f64 {
            return Err(Error::TooManySteps {
                step,
                start,
                end,
                count: count.ceil(),
            });
        }
        Ok(())
    }

    /// Whether `--set` gives the parameter of this name.
    fn sets(&self, parameter: &str) -> bool {
        let names = self.set.iter().filter_map(|text| text.split_once('='));
        names.into_iter().any(|(name, _)| name.trim() == parameter)
    }

    fn parameters(&self) -> Result<Parameters, Error> {
        let mut parameters = Parameters::default();
        for name in &self.preset {
            let title = preset::set(&mut parameters, name)?;
            eprintln!("preset {name}: {title}");
        }
        for text in &self.set {
            let (name, value) = text
                .split_once('=')
                .ok_or_else(|| Error::NotAnAssignment { text: text.clone() })?;
            parameters.set_by_name(name.trim(), value).map_err(Error::Parameter)?;
        }
        parameters.validate().map_err(Error::Parameter)?;
        Ok(parameters)
    }
}

/// A number of steps, in words.
fn steps_in_words(count: usize) -> String {
    format!("{count} step{}", if count == 1 { "" } else { "s" })
}

/// Columns of the table of results beside the time: all inputs and outputs, but what profiles alone have only with profiles.
struct Columns {
    inputs: Vec<&'static InputSignal>,
    outputs: Vec<&'static OutputSignal>,
}

impl Columns {
    fn of(contact_model: ContactModel) -> Columns {
        let with_profiles = contact_model == ContactModel::Profiles;
        let inputs = INPUTS.iter();
        let outputs = OUTPUTS.iter();
        Columns {
            inputs: inputs
                .filter(|signal| with_profiles || !signal.is_of_profiles_alone())
                .collect(),
            outputs: outputs
                .filter(|signal| with_profiles || !signal.profiles_only)
                .collect(),
        }
    }

    fn headings(&self) -> impl Iterator<Item = String> {
        let inputs = self.inputs.iter().map(|signal| heading(signal.name, signal.unit));
        let outputs = self.outputs.iter().map(|signal| heading(signal.name, signal.unit));
        std::iter::once(heading("time", "s")).chain(inputs).chain(outputs)
    }

    /// Writes a row.
    fn write(&self, table: &mut Table, point: &Point, outputs: &Outputs) -> Result<(), Error> {
        let inputs = self.inputs.iter().map(|signal| (signal.get)(&point.inputs));
        let outputs = self.outputs.iter().map(|signal| (signal.get)(outputs));
        table.write(std::iter::once(point.time).chain(inputs).chain(outputs))?;
        Ok(())
    }
}
