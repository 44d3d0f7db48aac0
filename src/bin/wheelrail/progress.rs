//! Progress of a run: a bar on a terminal, and lines where standard error goes elsewhere, into a log for example.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// The progress of a run, on standard error.
pub struct Progress {
    bar: ProgressBar,
    lines: Lines,
    begun: Instant,
}

/// Lines that are written where there is no terminal.
struct Lines {
    steps: u64,
    /// Tenths of the steps that were done at the last one.
    tenths: u64,
    /// Time at which the last line was written.
    written: Duration,
}

/// Least time between two lines; a run that is over before writes none.
const PAUSE: Duration = Duration::from_secs(1);

impl Progress {
    /// Progress of a run of so many steps.
    pub fn new(steps: u64) -> Progress {
        // The template is a constant: without it the bar would only look plainer.
        let style = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Progress {
            bar: ProgressBar::new(steps).with_style(style),
            lines: Lines {
                steps,
                tenths: 0,
                written: Duration::ZERO,
            },
            begun: Instant::now(),
        }
    }

    /// Counts a step; to be called after each.
    pub fn step(&mut self) {
        self.bar.inc(1);
        if self.bar.is_hidden()
            && let Some(line) = self.lines.after(self.bar.position(), || self.begun.elapsed())
        {
            eprintln!("{line}");
        }
    }

    /// Ends the display: the bar goes, and stays where the run was interrupted.
    pub fn end(self, interrupted: bool) {
        if interrupted {
            self.bar.abandon();
        } else {
            self.bar.finish_and_clear();
        }
    }
}

impl Lines {
    /// The line after so many steps, where there is one: one for each tenth of them, and none within the pause after the last
    /// one. The time is asked for only where it matters.
    fn after(&mut self, done: u64, elapsed: impl FnOnce() -> Duration) -> Option<String> {
        let tenths = 10 * done / self.steps.max(1);
        if tenths == self.tenths || tenths >= 10 {
            return None;
        }
        self.tenths = tenths;
        let elapsed = elapsed();
        if elapsed < self.written + PAUSE {
            return None;
        }
        self.written = elapsed;
        let left = elapsed.as_secs_f64() * (self.steps - done) as f64 / done as f64;
        let (steps, percent) = (self.steps, 10 * tenths);
        Some(format!("{percent} %: {done} of {steps} steps, {left:.0} s left"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(steps: u64, seconds_per_step: f64) -> Vec<String> {
        let (tenths, written) = (0, Duration::ZERO);
        let mut lines = Lines { steps, tenths, written };
        let elapsed = |done: u64| Duration::from_secs_f64(seconds_per_step * done as f64);
        (1..=steps)
            .filter_map(|done| lines.after(done, || elapsed(done)))
            .collect()
    }

    #[test]
    fn a_long_run_writes_a_line_for_each_tenth() {
        let long = lines(2000, 0.01);
        assert_eq!(long.len(), 9);
        assert_eq!(long[0], "10 %: 200 of 2000 steps, 18 s left");
        assert_eq!(long[8], "90 %: 1800 of 2000 steps, 2 s left");
        // Fewer steps than tenths.
        assert_eq!(lines(2, 10.0), ["50 %: 1 of 2 steps, 10 s left"]);
    }

    #[test]
    fn a_short_run_writes_few_lines_or_none() {
        assert_eq!(lines(2000, 0.0004), [""; 0]);
        // Four seconds, a second between lines: every third tenth.
        let percents: Vec<_> = lines(1000, 0.004).iter().map(|line| line[..4].to_owned()).collect();
        assert_eq!(percents, ["30 %", "60 %", "90 %"]);
    }
}
