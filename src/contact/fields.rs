//! The fields of a contact, declared once: a table with a row for each field says how it is reached and what is done with it, and
//! whatever goes through all fields goes through the table.

use crate::friction::memory::Memory;
use crate::numerics::dense::{self, largest};
use crate::settings::SensitivitySettings;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Dependence of the outputs on a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outputs {
    /// No output is made of it.
    Independent,
    /// The outputs are linear functions of it or its largest value: temperature, wear, heat flux.
    Linear,
    /// The outputs are other functions of it: tractions, slip, friction.
    Nonlinear,
    /// The depth of the austenite alone is made of it, where there is any: temperature below the surface.
    Deep,
}

impl Outputs {
    /// Whether outputs are made of the field, where there is austenite or none.
    fn matter(self, austenite: bool) -> bool {
        match self {
            Outputs::Independent => false,
            Outputs::Linear | Outputs::Nonlinear => true,
            Outputs::Deep => austenite,
        }
    }
}

/// First guess of a field at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guess {
    /// Value of the field at the beginning of the step.
    Before,
    /// Value of the field at the beginning of the step, moved on at the rate of the step before.
    Extrapolated,
    /// No guess: the step computes the field from its value at the beginning of the step.
    Computed,
}

/// Row of the table of fields.
pub struct FieldRow<F> {
    /// The field.
    pub get: fn(&F) -> &Vec<f64>,
    /// The field, to be changed.
    pub get_mut: fn(&mut F) -> &mut Vec<f64>,
    /// Dependence of the outputs on the field.
    pub outputs: Outputs,
    /// First guess of a step.
    pub guess: Guess,
}

/// Row of the table of numbers.
pub struct Number<F> {
    /// The number.
    pub get: fn(&F) -> f64,
    /// The number, to be changed.
    pub get_mut: fn(&mut F) -> &mut f64,
    /// Whether it must be positive.
    pub positive: bool,
    /// Whether a step begins from its value before.
    pub kept: bool,
}

/// Declares a row: dependence of the outputs, first guess, the field.
macro_rules! row {
    ($outputs:ident, $guess:ident, $($field:tt)+) => {
        $crate::contact::fields::FieldRow {
            get: |fields| &fields.$($field)+,
            get_mut: |fields| &mut fields.$($field)+,
            outputs: $crate::contact::fields::Outputs::$outputs,
            guess: $crate::contact::fields::Guess::$guess,
        }
    };
}
pub(super) use row;

/// Declares a number: whether it must be positive, whether a step begins from it, the number.
macro_rules! number {
    ($positive:literal, $kept:literal, $($field:tt)+) => {
        $crate::contact::fields::Number {
            get: |fields| fields.$($field)+,
            get_mut: |fields| &mut fields.$($field)+,
            positive: $positive,
            kept: $kept,
        }
    };
}
pub(super) use number;

/// Fields of a contact, all that a step changes.
pub trait Fields: Clone + PartialEq + std::fmt::Debug + Serialize + DeserializeOwned + 'static {
    /// Table of the fields, but for the history of friction.
    const ROWS: &'static [FieldRow<Self>];
    /// Table of the numbers.
    const NUMBERS: &'static [Number<Self>];

    /// Histories of friction, one of each window.
    fn memories(&self) -> impl Iterator<Item = &Memory>;

    /// Histories of friction, to be changed.
    fn memories_mut(&mut self) -> impl Iterator<Item = &mut Memory>;

    /// Whether the fields stand at other places than those before a step: they have no rates of change then.
    fn has_moved(&self, _before: &Self) -> bool {
        false
    }

    /// Whether a row of the table counts: those of a window that is not used have no meaning.
    fn is_used(&self, _row: usize) -> bool {
        true
    }

    /// Takes the history of friction of others at the same places.
    fn copy_memories(&mut self, other: &Self) {
        for (memory, other) in self.memories_mut().zip(other.memories()) {
            memory.copy_from(other);
        }
    }

    /// Takes the places at which the fields of others stand.
    fn copy_places(&mut self, _other: &Self) {}

    /// Whether the places, of another source, are possible.
    fn has_valid_places(&self) -> bool {
        true
    }

    /// Overwrites these fields with others of the same sizes, without allocating.
    fn copy_from(&mut self, other: &Self) {
        self.copy_places(other);
        self.copy(other, |_| true);
        for number in Self::NUMBERS {
            *(number.get_mut)(self) = (number.get)(other);
        }
    }

    /// Takes the first guess of a step, but for the extrapolation, from the fields at its beginning.
    fn guess_from(&mut self, before: &Self) {
        self.copy_places(before);
        self.copy(before, |row| row.guess != Guess::Computed);
        for number in Self::NUMBERS.iter().filter(|number| number.kept) {
            *(number.get_mut)(self) = (number.get)(before);
        }
    }

    /// Copies the fields of some rows and the history of friction.
    fn copy(&mut self, other: &Self, included: impl Fn(&FieldRow<Self>) -> bool) {
        for (number, row) in Self::ROWS.iter().enumerate() {
            if included(row) && other.is_used(number) {
                (row.get_mut)(self).copy_from_slice((row.get)(other));
            }
        }
        self.copy_memories(other);
    }

    /// Sets everything to 0, but for the history of friction.
    fn clear(&mut self) {
        for row in Self::ROWS {
            (row.get_mut)(self).fill(0.0);
        }
        for number in Self::NUMBERS {
            *(number.get_mut)(self) = 0.0;
        }
    }

    /// Takes what the outputs are made of from `fields`, moved by `step` times a change of them; what the depth of the austenite is made of, where there is any.
    fn move_along(&mut self, fields: &Self, change: &Self, step: f64, austenite: bool) {
        self.copy_places(fields);
        for (number, row) in Self::ROWS.iter().enumerate() {
            if !row.outputs.matter(austenite) || !fields.is_used(number) {
                continue;
            }
            let values = (row.get)(fields).iter().zip((row.get)(change));
            for (moved, (value, change)) in (row.get_mut)(self).iter_mut().zip(values) {
                *moved = value + step * change;
            }
        }
        for number in Self::NUMBERS {
            *(number.get_mut)(self) = (number.get)(fields) + step * (number.get)(change);
        }
    }

    /// Step of a central difference of the outputs along a change: it moves no field by more than a small fraction of the field's
    /// largest value, which the settings give.
    fn output_step(&self, change: &Self, settings: &SensitivitySettings) -> f64 {
        let step = Self::ROWS
            .iter()
            .enumerate()
            .filter(|(number, _)| self.is_used(*number))
            .filter_map(|(_, row)| {
                let share = match row.outputs {
                    // Below the surface the temperature changes with that of the surface.
                    Outputs::Independent | Outputs::Deep => return None,
                    Outputs::Linear => settings.linear_output_step,
                    Outputs::Nonlinear => settings.output_step,
                };
                Some(share * largest((row.get)(self)) / largest((row.get)(change)))
            })
            .filter(|step| step.is_finite() && *step > 0.0)
            .fold(f64::INFINITY, f64::min);
        if step.is_finite() { step } else { settings.output_step }
    }

    /// Whether these fields, of another source, have the sizes of `expected` and finite content.
    fn is_valid(&self, expected: &Self) -> bool {
        let same = |own: &Vec<f64>, expected: &Vec<f64>| {
            own.len() == expected.len() && own.iter().all(|value| value.is_finite())
        };
        let mut rows = Self::ROWS.iter();
        let mut numbers = Self::NUMBERS.iter();
        let mut memories = self
            .memories()
            .zip(expected.memories())
            .flat_map(|(own, expected)| own.vectors().into_iter().zip(expected.vectors()));
        self.has_valid_places()
            && rows.all(|row| same((row.get)(self), (row.get)(expected)))
            && memories.all(|(own, expected)| same(own, expected))
            && numbers.all(|number| {
                let value = (number.get)(self);
                value.is_finite() && (!number.positive || value > 0.0)
            })
    }
}

/// State of a contact: its fields and the rates at which they changed over the last step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EngineState<F> {
    /// Temperature, wear, tractions.
    pub fields: F,
    /// Rates of change of the fields that are extrapolated, per second, in the order of their rows.
    pub rates: Vec<Vec<f64>>,
}

impl<F: Fields> EngineState<F> {
    /// State that does not change.
    pub fn at_rest(fields: F) -> EngineState<F> {
        let rates = extrapolated::<F>().map(|(_, row)| vec![0.0; (row.get)(&fields).len()]);
        EngineState {
            rates: rates.collect(),
            fields,
        }
    }

    /// Makes the fields at the end of a step of `duration` `s` the state; `after` receives those before.
    pub fn commit(&mut self, after: &mut F, duration: f64) {
        let moved = after.has_moved(&self.fields);
        for (rates, (number, row)) in self.rates.iter_mut().zip(extrapolated::<F>()) {
            if moved {
                rates.fill(0.0);
                continue;
            }
            // Those of a window that is not used are 0 since its end.
            if !after.is_used(number) {
                continue;
            }
            let values = (row.get)(&self.fields).iter().zip((row.get)(after));
            dense::vectorised(
                #[inline(always)]
                |_| {
                    for (rate, (before, after)) in rates.iter_mut().zip(values) {
                        *rate = (after - before) / duration;
                    }
                },
            );
        }
        std::mem::swap(&mut self.fields, after);
    }

    /// Moves the first guess of a step on by `ahead` `s`.
    pub fn extrapolate(&self, ahead: f64, guess: &mut F) {
        for (rates, (number, row)) in self.rates.iter().zip(extrapolated::<F>()) {
            if !self.fields.is_used(number) {
                continue;
            }
            let values = (row.get_mut)(guess);
            values.copy_from_slice((row.get)(&self.fields));
            dense::add_multiple(rates, ahead, values);
        }
    }

    /// Whether the state, of another source, has the sizes of `expected` and finite content.
    pub fn is_valid(&self, expected: &EngineState<F>) -> bool {
        let same = |own: &Vec<f64>, expected: &Vec<f64>| {
            own.len() == expected.len() && own.iter().all(|value| value.is_finite())
        };
        self.fields.is_valid(&expected.fields)
            && self.rates.len() == expected.rates.len()
            && self
                .rates
                .iter()
                .zip(&expected.rates)
                .all(|(own, expected)| same(own, expected))
    }
}

/// Rows that are extrapolated, with their numbers.
fn extrapolated<F: Fields>() -> impl Iterator<Item = (usize, &'static FieldRow<F>)> {
    F::ROWS
        .iter()
        .enumerate()
        .filter(|(_, row)| row.guess == Guess::Extrapolated)
}
