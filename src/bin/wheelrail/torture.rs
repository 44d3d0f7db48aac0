//! `wheelrail torture`: wheels driven at random, what fails and what is slow.

use clap::{Args, ValueEnum};
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use wheelrail::torture::{Engines, LARGEST_TEMPERATURE, Run, RunFailure, Slow, StepTime, Torture, explain};

/// Options of `torture`.
#[derive(Args)]
pub struct Options {
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of runs, each a drive of one wheel.
    #[arg(long, default_value_t = 400)]
    runs: u64,
    /// Steps of a run.
    #[arg(long, default_value_t = 150)]
    steps: usize,
    /// Threads; a time of a step is a time by the clock, so that more threads than idle cores make it longer.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: u64,
    /// Take this run alone, and print its parameters and steps.
    #[arg(long, conflicts_with_all = ["runs", "threads"])]
    run: Option<u64>,
    /// Half-width of the contact window in units of the usual one, at equal spacing of the nodes.
    #[arg(long, default_value_t = 1.0, value_parser = window)]
    window: f64,
    /// The contact models that are driven.
    #[arg(long, value_enum, default_value_t = ContactModels::Both)]
    model: ContactModels,
    /// Number of the slowest steps to explain.
    #[arg(long, default_value_t = 10)]
    slowest: usize,
    /// Explain the slowest of the steps that were solved: none that was taken staggered.
    #[arg(long)]
    solved: bool,
}

/// The contact models of the runs.
#[derive(Clone, Copy, ValueEnum)]
enum ContactModels {
    /// The line contact
    Line,
    /// The patch
    Patch,
    /// Profiles: perturbed, worn, wearing
    Profiles,
    /// Built-in profiles that stay new
    NewProfiles,
    /// Line and patch in turn
    Both,
}

/// Number of candidates timed again for each of the slowest steps that are listed: what interrupted a step made it slow
/// once.
const CANDIDATES: usize = 3;

fn window(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(factor) if (1.0..=3.0).contains(&factor) => Ok(factor),
        _ => Err("from 1 to 3".to_owned()),
    }
}

/// Reason why the torture did not pass.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Runs that did not come to their end.
    #[error("{failed} of {runs} runs fail")]
    Failed {
        /// Runs that fail.
        failed: usize,
        /// All runs.
        runs: u64,
    },
    /// Standard output.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

/// Summary of the runs once they are over.
#[derive(Default)]
struct Summary {
    times: Vec<f64>,
    /// The slowest, longest first.
    slowest: Vec<StepTime>,
    /// Failures by their kind, with run and step.
    failures: BTreeMap<String, Vec<(u64, usize, RunFailure)>>,
    /// Steps that were taken staggered, and those of them that have a residual of 1 or more.
    staggered: usize,
    far_off: usize,
    /// Rails that were too hot.
    replaced: usize,
    /// Outermost contact in units of the half-length at `largest_load`.
    outermost: f64,
}

impl Options {
    /// Takes the runs and prints what came of them.
    pub fn run(&self) -> Result<(), Error> {
        let torture = Torture {
            seed: self.seed,
            steps: self.steps,
            window: self.window,
            engines: match self.model {
                ContactModels::Line => Engines::Line,
                ContactModels::Patch => Engines::Patch,
                ContactModels::Profiles => Engines::Profiles,
                ContactModels::NewProfiles => Engines::NewProfiles,
                ContactModels::Both => Engines::Both,
            },
        };
        let mut out = io::stdout().lock();
        if let Some(number) = self.run {
            return replay(&mut out, &torture, number);
        }
        let summary = self.take(&torture);
        let failed = summary.print(&mut out, &torture, self.runs)?;
        let explained = summary
            .slowest
            .iter()
            .filter_map(|taken| explain(&torture, *taken).ok());
        let mut slow: Vec<Slow> = explained.collect();
        slow.sort_by(|a, b| b.again.total_cmp(&a.again));
        for slow in slow.iter().take(self.slowest) {
            print_slow(&mut out, slow)?;
        }
        if failed > 0 {
            return Err(Error::Failed {
                failed,
                runs: self.runs,
            });
        }
        Ok(())
    }

    /// All runs, on all threads.
    fn take(&self, torture: &Torture) -> Summary {
        let summary = Mutex::new(Summary::default());
        let next = AtomicU64::new(0);
        let work = || {
            loop {
                let model = next.fetch_add(1, Ordering::Relaxed);
                let runs = Torture::runs_of_model(model);
                if runs.start >= self.runs {
                    break;
                }
                let taken = torture.runs(runs.start..runs.end.min(self.runs));
                // A summary that a panicking thread has left is as good as it was.
                let mut summary = summary.lock().unwrap_or_else(PoisonError::into_inner);
                for run in &taken {
                    summary.add(run, CANDIDATES * self.slowest, self.solved);
                }
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..self.threads {
                scope.spawn(work);
            }
        });
        summary.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Summary {
    /// Adds a run, and keeps so many of the slowest steps, of those that were solved alone or of all.
    fn add(&mut self, run: &Run, slowest: usize, solved: bool) {
        self.times.extend(run.steps.iter().map(|step| step.time));
        self.slowest
            .extend(run.steps.iter().filter(|step| !(solved && step.staggered)));
        self.slowest.sort_by(|a, b| b.time.total_cmp(&a.time));
        self.slowest.truncate(slowest);
        self.staggered += run.steps.iter().filter(|step| step.staggered).count();
        self.far_off += run.steps.iter().filter(|step| step.residual >= 1.0).count();
        self.replaced += run.replaced;
        let reaches = run.reach.iter().map(|reach| reach.outermost);
        self.outermost = reaches.fold(self.outermost, f64::max);
        if let Some(failure) = &run.failure {
            let failures = self.failures.entry(failure.kind()).or_default();
            failures.push((run.number, run.length, failure.clone()));
        }
    }

    /// Prints all but the slowest steps. The number of failures in the range of the model.
    fn print(&self, out: &mut impl Write, torture: &Torture, runs: u64) -> io::Result<usize> {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        let steps = times.len();
        writeln!(out, "seed {}: {runs} runs, {steps} steps", torture.seed)?;
        let mut failed = 0;
        for (kind, failures) in &self.failures {
            failed += failures.len();
            writeln!(out, "{} times {kind}", failures.len())?;
            for (run, step, failure) in failures {
                writeln!(out, "  --run {run} step {step}: {failure}")?;
            }
        }
        writeln!(
            out,
            "{} steps taken staggered, as their coupled equations were not solved; {} with a residual of 1 or more",
            self.staggered, self.far_off
        )?;
        writeln!(
            out,
            "{} rails above {LARGEST_TEMPERATURE} K, or too thick for a penetration, replaced by cold ones",
            self.replaced
        )?;
        writeln!(out, "outermost contact: {:.3} a(largest_load)", self.outermost)?;
        if steps > 0 {
            let total: f64 = times.iter().sum();
            write!(out, "time of a step [µs]: mean {:.1}", 1e6 * total / steps as f64)?;
            for (name, share) in [
                ("median", 0.5),
                ("90 %", 0.9),
                ("99 %", 0.99),
                ("99.9 %", 0.999),
                ("largest", 1.0),
            ] {
                write!(
                    out,
                    ", {name} {:.1}",
                    1e6 * times[((steps - 1) as f64 * share) as usize]
                )?;
            }
            writeln!(out, "\nslowest steps; beside a method, time and iterations without it:")?;
        }
        Ok(failed)
    }
}

fn print_slow(out: &mut impl Write, slow: &Slow) -> io::Result<()> {
    writeln!(
        out,
        "  --run {} step {}: {:.0} µs ({:.0} µs in the run), {} iterations, {} of {} nodes under pressure; {:.3e} s, V {:.3e} m/s, slip {:.3e} m/s, {:.3e} N",
        slow.taken.run,
        slow.taken.step,
        1e6 * slow.again,
        1e6 * slow.taken.time,
        slow.taken.iterations,
        slow.pressed,
        slow.nodes,
        slow.duration,
        slow.rolling_speed,
        slow.rigid_slip,
        slow.load,
    )?;
    for (method, without) in &slow.without {
        match without {
            None => writeln!(out, "    {method}: fails")?,
            Some((_, iterations)) if *iterations == slow.taken.iterations => {}
            Some((time, iterations)) => writeln!(out, "    {method}: {:.0} µs, {iterations}", 1e6 * time)?,
        }
    }
    Ok(())
}

/// One run, step by step.
fn replay(out: &mut impl Write, torture: &Torture, number: u64) -> Result<(), Error> {
    writeln!(out, "{:#?}", torture.parameters(number))?;
    let Some(run) = torture.runs(number..number + 1).pop() else {
        return Ok(());
    };
    writeln!(
        out,
        "step       µs iterations  outermost/a(largest_load)  load/largest_load  largest K  staggered, residual"
    )?;
    for (step, reach) in run.steps.iter().zip(&run.reach) {
        let residual = if step.staggered {
            format!("{:21.2e}", step.residual)
        } else {
            String::new()
        };
        writeln!(
            out,
            "{:4} {:8.1} {:10} {:26.4} {:18.4} {:10.1}{residual}",
            step.step,
            1e6 * step.time,
            step.iterations,
            reach.outermost,
            reach.load,
            reach.temperature,
        )?;
    }
    if let Some(failure) = &run.failure {
        writeln!(out, "step {}: {failure}", run.length)?;
        return Err(Error::Failed { failed: 1, runs: 1 });
    }
    Ok(())
}
