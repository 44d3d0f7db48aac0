//! Inputs over time, linear between the rows of a table, and the communication steps through it.

use super::error::{Error, Result};
use crate::signals::{INPUTS, Inputs};

/// Part of a communication step by which a schedule may overshoot its last one: rounding of the rows' times.
const ROUNDING: f64 = 1e-6;

/// The inputs at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time, `s`.
    pub time: f64,
    /// The inputs then.
    pub inputs: Inputs,
}

/// A table of at least two rows with ascending times.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    points: Vec<Point>,
}

/// A communication step: the inputs change linearly from one point to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Point at which the step begins.
    pub from: Point,
    /// Point at which the step ends.
    pub to: Point,
}

/// The communication steps from a schedule's start to its end, [`Schedule::steps`].
#[derive(Debug, Clone)]
pub struct Steps<'a> {
    schedule: &'a Schedule,
    length: f64,
    count: usize,
    /// Steps that were handed out.
    done: usize,
    from: Point,
}

impl Schedule {
    /// The rows of the table. Whether the inputs are allowed is not looked at here: that depends on the model.
    ///
    /// # Errors
    /// [`Error::TimeNotAscending`], [`Error::TooFewRows`].
    pub fn new(points: Vec<Point>) -> Result<Schedule> {
        let mut before = f64::NEG_INFINITY;
        for (row, &Point { time, .. }) in points.iter().enumerate() {
            if !(time > before && time.is_finite()) {
                return Err(Error::TimeNotAscending { row, time, before });
            }
            before = time;
        }
        match points.len() {
            rows @ (0 | 1) => Err(Error::TooFewRows { rows }),
            _ => Ok(Schedule { points }),
        }
    }

    /// The rows.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The first row.
    pub fn start(&self) -> Point {
        self.points[0]
    }

    /// The last row.
    pub fn end(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    /// The inputs at a time, linear between the rows; before the first and after the last, those of that row.
    pub fn at(&self, time: f64) -> Inputs {
        let upper = self
            .points
            .partition_point(|row| row.time < time)
            .clamp(1, self.points.len() - 1);
        let (before, after) = (&self.points[upper - 1], &self.points[upper]);
        let weight = ((time - before.time) / (after.time - before.time)).clamp(0.0, 1.0);
        let mut inputs = before.inputs;
        for signal in INPUTS {
            let (low, high) = ((signal.get)(&before.inputs), (signal.get)(&after.inputs));
            let between = low * (1.0 - weight) + high * weight;
            // Round-off takes no value that is at its limit over it.
            (signal.set)(&mut inputs, between.max(low.min(high)).min(low.max(high)));
        }
        inputs
    }

    /// Communication steps of `length` `s` from the start to the end. The last one is shorter where `length` does not
    /// divide the duration, and none is left over for rounding.
    ///
    /// # Errors
    /// [`Error::StepLength`].
    pub fn steps(&self, length: f64) -> Result<Steps<'_>> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::StepLength { step: length });
        }
        let (start, end) = (self.start().time, self.end().time);
        Ok(Steps {
            schedule: self,
            length,
            count: ((end - start) / length - ROUNDING).ceil().max(1.0) as usize,
            done: 0,
            from: Point {
                time: start,
                inputs: self.at(start),
            },
        })
    }
}

impl Iterator for Steps<'_> {
    type Item = Step;

    fn next(&mut self) -> Option<Step> {
        if self.done == self.count {
            return None;
        }
        self.done += 1;
        // Each time from the start: a sum of steps would drift.
        let time = if self.done == self.count {
            self.schedule.end().time
        } else {
            self.schedule.start().time + self.done as f64 * self.length
        };
        let from = self.from;
        self.from = Point {
            time,
            inputs: self.schedule.at(time),
        };
        Some(Step { from, to: self.from })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count - self.done, Some(self.count - self.done))
    }
}

impl ExactSizeIterator for Steps<'_> {}

impl Step {
    /// Length of the step, `s`.
    pub fn duration(&self) -> f64 {
        self.to.time - self.from.time
    }

    /// Rates of change of the inputs, per second.
    pub fn rates(&self) -> Inputs {
        let mut rates = Inputs::ZERO;
        for signal in INPUTS {
            let change = (signal.get)(&self.to.inputs) - (signal.get)(&self.from.inputs);
            (signal.set)(&mut rates, change / self.duration());
        }
        rates
    }

    /// Divides the step into `count` sub-steps of equal length (at least one), for more accuracy in time between the
    /// same communication points.
    pub fn parts(self, count: usize) -> impl Iterator<Item = Step> {
        let count = count.max(1);
        let rates = self.rates();
        let boundary = move |part: usize| match part {
            0 => self.from,
            _ if part == count => self.to,
            _ => {
                let passed = self.duration() * part as f64 / count as f64;
                Point {
                    time: self.from.time + passed,
                    inputs: self.from.inputs.advanced(&rates, passed),
                }
            }
        };
        (0..count).map(move |part| Step {
            from: boundary(part),
            to: boundary(part + 1),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(time: f64, creepage: f64) -> Point {
        let inputs = Inputs {
            creepage,
            ..Inputs::default()
        };
        Point { time, inputs }
    }

    fn schedule() -> Schedule {
        Schedule::new(vec![point(1.0, 0.0), point(1.1, 0.01), point(1.3, -0.01)]).unwrap()
    }

    #[test]
    fn inputs_are_linear_between_the_rows_and_held_outside() {
        for (time, creepage) in [(0.0, 0.0), (1.05, 0.005), (1.1, 0.01), (1.2, 0.0), (9.0, -0.01)] {
            assert!((schedule().at(time).creepage - creepage).abs() < 1e-15, "{time}");
        }
    }

    /// A load at its limit stays there, though 1 − w and w do not add up to 1.
    #[test]
    fn a_constant_input_is_constant() {
        let constant = Schedule::new(vec![point(0.02, 99.9), point(0.08, 99.9)]).unwrap();
        for part in 0..1000 {
            assert_eq!(constant.at(0.02 + 6e-5 * f64::from(part)).creepage, 99.9);
        }
    }

    #[test]
    fn steps_lead_from_start_to_end_without_a_gap() {
        let schedule = schedule();
        for (length, count) in [(0.1, 3), (0.3, 1), (0.2, 2), (1.0, 1), (1e-3, 300), (7e-3, 43)] {
            let steps: Vec<Step> = schedule.steps(length).unwrap().collect();
            assert_eq!(steps.len(), count, "{length}");
            assert_eq!((steps[0].from, steps[count - 1].to), (schedule.start(), schedule.end()));
            assert!(steps.windows(2).all(|pair| pair[0].to == pair[1].from));
            assert!(steps.iter().all(|step| step.duration() < length * (1.0 + 1e-9)));
        }
    }

    #[test]
    fn parts_of_a_step_are_the_step() {
        let step = schedule().steps(0.05).unwrap().next().unwrap();
        let parts: Vec<Step> = step.parts(4).collect();
        assert_eq!((parts.len(), parts[0].from, parts[3].to), (4, step.from, step.to));
        assert!(parts.windows(2).all(|pair| pair[0].to == pair[1].from));
        assert!((parts[1].to.inputs.creepage - 0.0025).abs() < 1e-15);
        assert_eq!(step.parts(1).collect::<Vec<_>>(), [step]);
        assert_eq!(step.parts(0).collect::<Vec<_>>(), [step]);
    }

    #[test]
    fn tables_and_steps_that_cannot_be_are_refused() {
        let refused = |times: &[f64]| Schedule::new(times.iter().map(|&time| point(time, 0.0)).collect()).unwrap_err();
        assert_eq!(refused(&[]), Error::TooFewRows { rows: 0 });
        assert_eq!(refused(&[0.0]), Error::TooFewRows { rows: 1 });
        for (times, row) in [
            (&[0.0, 1.0, 0.5][..], 2),
            (&[0.0, 0.0], 1),
            (&[0.0, f64::INFINITY], 1),
            (&[0.0, f64::NAN], 1),
        ] {
            assert!(matches!(refused(times), Error::TimeNotAscending { row: found, .. } if found == row));
        }
        for step in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
            assert!(matches!(schedule().steps(step).unwrap_err(), Error::StepLength { .. }));
        }
    }
}
