//! Reading and setting the variables of an instance.

use super::component::Component;
use super::failures::Failure;
use super::modes::Mode;
use super::variables::{
    FIELDS, Integer, IntegerVariable, Lengths, PROFILE_WEAR, PROFILES, Real, RealVariable, SURFACE, Text,
};
use crate::error::{Error, LONGEST_TEXT, TextProblem};
use crate::parameters::{ContactModel, INTEGER_PARAMETERS, REAL_PARAMETERS, TEXT_PARAMETERS, TextParameter};
use crate::signals::{INPUTS, InputSignal, OUTPUTS};
use crate::wheel_rail::ContactNode;
use std::borrow::Cow;
use std::ffi::{CStr, CString};

impl Component {
    /// The value of a real variable. In *initializationMode* the contact is solved where an output asks for it.
    ///
    /// # Errors
    /// [`Failure::NothingComputed`], or [`Failure::Model`] where there is no solution.
    pub fn real(&mut self, variable: Real) -> Result<f64, Failure> {
        Ok(match variable.variable {
            RealVariable::Input(row) => (INPUTS[row].get)(&self.inputs),
            RealVariable::Parameter(row) => (REAL_PARAMETERS[row].get)(&self.parameters)[variable.element],
            RealVariable::Output(row) => (OUTPUTS[row].get)(&self.solution()?.outputs),
            RealVariable::Contacts(row) => {
                let element = OUTPUTS.get(row + variable.element).ok_or(Failure::NothingComputed)?;
                (element.get)(&self.solution()?.outputs)
            }
            RealVariable::Profile(row) => {
                let values = (PROFILES[row].values)(self.profiles()?);
                *values.get(variable.element).ok_or(Failure::NothingComputed)?
            }
            RealVariable::Field(row) => self.field(row, variable.element)?,
            RealVariable::Surface(row) => {
                let (window, place) = self.lengths().surface_cell(row, variable.element);
                let ambient = self.inputs.ambient_temperature;
                SURFACE[row].at(self.windows()?.get(window), place, ambient)
            }
            RealVariable::ProfileWear(row) => {
                let column = &PROFILE_WEAR[row];
                let place = (column.places)(self.profile_wear()?).get(variable.element);
                place.map_or(0.0, column.value)
            }
            RealVariable::Residual => {
                let (built, state) = self.solved()?;
                built.model.convergence(state).residual
            }
            RealVariable::Time => self.time,
        })
    }

    /// An element of a field of a patch. Of a line contact, which has no cells, it is 0, or the ambient temperature.
    fn field(&mut self, row: usize, element: usize) -> Result<f64, Failure> {
        const NOWHERE: ContactNode = ContactNode::UNTOUCHED;
        let ambient = self.inputs.ambient_temperature;
        let cell = self.lengths().cell(row, element);
        let is_patch = self.parameters.contact_model == ContactModel::Patch;
        let node = if is_patch { self.nodes()?.get(cell) } else { None };
        Ok((FIELDS[row].value)(node.unwrap_or(&NOWHERE), ambient))
    }

    /// Returns the lengths of the arrays.
    pub fn lengths(&self) -> Lengths {
        Lengths::of(&self.parameters)
    }

    /// The value of an integer variable.
    ///
    /// # Errors
    /// As [`Component::real`].
    pub fn integer(&mut self, variable: Integer) -> Result<i32, Failure> {
        Ok(match variable.variable {
            IntegerVariable::Parameter(row) => (INTEGER_PARAMETERS[row].get)(&self.parameters),
            IntegerVariable::Iterations => {
                let (built, state) = self.solved()?;
                i32::try_from(built.model.convergence(state).iterations).unwrap_or(i32::MAX)
            }
        })
    }

    /// The value of a text variable. It stays where it is until the variable is read with another value, or the instance is freed.
    pub fn text(&mut self, variable: Text) -> &CStr {
        let text = (TEXT_PARAMETERS[variable.row].get)(&self.parameters);
        let shown = &mut self.texts[variable.row];
        if shown.to_bytes() != text.as_bytes() {
            // Texts with a zero byte are refused where they are set.
            *shown = CString::new(text).unwrap_or_default();
        }
        shown
    }

    /// Sets real variables, all or none. Inputs are checked after all parameters are known: these narrow their ranges.
    ///
    /// # Errors
    /// What the entries hold; [`Failure::NotSettable`], or [`Failure::Value`] for a value out of its range.
    pub fn set_reals(
        &mut self,
        entries: impl Iterator<Item = Result<(Real, f64), Failure>> + Clone,
    ) -> Result<(), Failure> {
        // Inputs alone, which are set before each step, need no copy of the parameters.
        let mut parameters = Cow::Borrowed(&self.parameters);
        let mut inputs = self.inputs;
        for entry in entries.clone() {
            let (variable, value) = entry?;
            match variable.variable {
                RealVariable::Parameter(row) => {
                    let row = &REAL_PARAMETERS[row];
                    if self.mode == Mode::StepComplete && !row.tunable {
                        return Err(self.not_settable(variable.name(), variable.reference));
                    }
                    row.check(variable.element, value).map_err(Failure::Value)?;
                    (row.get_mut)(parameters.to_mut())[variable.element] = value;
                }
                RealVariable::Input(_) => {}
                _ => return Err(self.not_settable(variable.name(), variable.reference)),
            }
        }
        for entry in entries {
            let (variable, value) = entry?;
            if let RealVariable::Input(row) = variable.variable {
                let row = &INPUTS[row];
                // Until the start contact_model may still follow, a call of its own because it is an Integer; the
                // inputs are checked with it then.
                let check = match self.mode {
                    Mode::StepComplete => InputSignal::check,
                    _ => InputSignal::check_range,
                };
                let checked = |value: f64| check(row, value, &parameters).map(|()| value);
                let taken = checked(value).or_else(|error| match row.rounded_limit(value, &parameters) {
                    Some(limit) => checked(limit),
                    None => Err(error),
                });
                (row.set)(&mut inputs, taken.map_err(Failure::Value)?);
            }
        }
        if inputs != self.inputs {
            inputs.check_motion(&parameters).map_err(Failure::Value)?;
        }
        let changed = match parameters {
            Cow::Owned(parameters) => Some(parameters),
            Cow::Borrowed(_) => None,
        };
        if self.mode != Mode::StepComplete {
            self.forget_solution();
        } else if let Some(parameters) = changed.as_ref().filter(|changed| **changed != self.parameters) {
            self.prepare(parameters).map_err(Failure::Value)?;
        }
        if let Some(parameters) = changed {
            self.parameters = parameters;
        }
        self.inputs = inputs;
        Ok(())
    }

    /// Sets integer variables, all or none.
    ///
    /// # Errors
    /// As [`Component::set_reals`].
    pub fn set_integers(
        &mut self,
        entries: impl Iterator<Item = Result<(Integer, i32), Failure>>,
    ) -> Result<(), Failure> {
        let mut parameters = self.parameters.clone();
        let mut any = false;
        for entry in entries {
            let (variable, value) = entry?;
            match variable.variable {
                IntegerVariable::Parameter(row) if self.mode != Mode::StepComplete => {
                    let row = &INTEGER_PARAMETERS[row];
                    row.check(value).map_err(Failure::Value)?;
                    (row.set)(&mut parameters, value);
                    any = true;
                }
                _ => return Err(self.not_settable(variable.name().to_owned(), variable.reference)),
            }
        }
        if any {
            self.forget_profiles();
        }
        self.parameters = parameters;
        Ok(())
    }

    /// Sets text variables, all or none. A text is given by its bytes, or as `None` for a null pointer in the argument of the
    /// given name.
    ///
    /// # Errors
    /// What the entries hold; [`Failure::NullPointer`], [`Failure::NotSettable`], or [`Failure::Value`] for a text that cannot be.
    pub fn set_texts<'a>(
        &mut self,
        argument: &'static str,
        entries: impl Iterator<Item = Result<(Text, Option<&'a [u8]>), Failure>>,
    ) -> Result<(), Failure> {
        let mut parameters = Cow::Borrowed(&self.parameters);
        for entry in entries {
            let (variable, bytes) = entry?;
            if self.mode == Mode::StepComplete {
                return Err(self.not_settable(variable.name().to_owned(), variable.reference));
            }
            let row = &TEXT_PARAMETERS[variable.row];
            let bytes = bytes.ok_or(Failure::NullPointer { argument })?;
            let text = decoded(row, bytes).map_err(Failure::Value)?;
            (row.set)(parameters.to_mut(), text);
        }
        if let Cow::Owned(parameters) = parameters {
            self.parameters = parameters;
            self.forget_profiles();
        }
        Ok(())
    }

    fn not_settable(&self, name: String, reference: u32) -> Failure {
        let (when, settable) = match self.mode {
            Mode::StepComplete => ("after the initialization", "inputs and tunable parameters can be"),
            _ => ("at any time", "inputs and parameters can be"),
        };
        Failure::NotSettable {
            name,
            reference,
            when,
            settable,
        }
    }
}

/// The text that bytes are, checked.
fn decoded(row: &TextParameter, bytes: &[u8]) -> Result<String, Error> {
    let text = std::str::from_utf8(bytes).map_err(|error| Error::Text {
        name: row.name,
        problem: match bytes.len() > LONGEST_TEXT {
            true => TextProblem::TooLong,
            false => TextProblem::NotUtf8 {
                valid: error.valid_up_to(),
            },
        },
    })?;
    row.check(text)?;
    Ok(text.to_owned())
}
