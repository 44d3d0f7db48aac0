//! One instance: what it holds, its way through the states, its variables.

use super::failure::Failure;
use super::fence;
use super::logging::{Category, Logger, Message};
use super::modes::{Function, Mode};
use super::saving::SavedStates;
use super::state::{Experiment, fixed_part};
use super::types::{CO_SIMULATION, CallbackFunctions, Integer, Real, ValueReference};
use super::variables::{self, IntegerVariable, PROFILES, RealVariable};
use super::{GUID, resource};
use crate::error;
use crate::parameters::{INTEGER_PARAMETERS, Parameters, REAL_PARAMETERS};
use crate::signals::{INPUTS, Inputs, OUTPUTS};
use crate::wheel_rail::{Model, Profiles, State, Workspace};
use std::ffi::CStr;
use std::mem::MaybeUninit;

/// What follows from the parameters, and the scratch that goes with it.
pub(super) struct Built {
    pub(super) model: Model,
    pub(super) workspace: Workspace,
}

/// An instance of the component.
pub struct Instance {
    pub(super) mode: Mode,
    pub(super) experiment: Option<Experiment>,
    pub(super) parameters: Parameters,
    pub(super) inputs: Inputs,
    /// Rates of change of the inputs in the next step.
    pub(super) rates: Inputs,
    /// The communication point in s.
    pub(super) time: Real,
    /// Kept as long as the fixed parameters are the same, over fmi2Reset too.
    pub(super) built: Option<Built>,
    /// Rail and contact at the communication point. In *initializationMode* computed when it is asked for.
    pub(super) state: Option<State>,
    /// Computed from `state` when it is asked for.
    pub(super) profiles: Option<Profiles>,
    pub(super) saved: SavedStates,
    logger: Logger,
    messages: Vec<Message>,
}

/// The arguments of fmi2Instantiate that matter, copied from C.
pub struct Instantiation<'a> {
    /// Name of the instance.
    pub name: Option<&'a CStr>,
    /// Model exchange or co-simulation.
    pub fmu_type: i32,
    /// GUID of the importer's model description.
    pub guid: Option<&'a CStr>,
    /// URI of the resources.
    pub resource_location: Option<&'a CStr>,
    /// The importer's functions.
    pub callbacks: CallbackFunctions,
    /// Whether all log categories are on.
    pub logging_on: bool,
}

/// Why there is no instance.
#[derive(Debug, thiserror::Error)]
enum Refusal {
    #[error("instanceName is null or blank")]
    Name,
    #[error("fmuType = {0}: this is a unit for co-simulation (1)")]
    Type(i32),
    #[error("fmuGUID is a null pointer; the library's is {GUID}")]
    NoGuid,
    #[error("fmuGUID = {0}: the library's is {GUID}; description and library are not of one build")]
    Guid(String),
}

impl Instance {
    /// fmi2Instantiate; `None` after a logged refusal.
    pub fn new(arguments: &Instantiation<'_>) -> Option<Instance> {
        let logger = Logger::new(
            &arguments.callbacks,
            arguments.name.unwrap_or_default(),
            arguments.logging_on,
        );
        if let Err(refusal) = arguments.check() {
            if let Some(message) = logger.refusal(|| format!("fmi2Instantiate: {refusal}")) {
                logger.send(&message);
            }
            return None;
        }
        if let Some(message) = logger.information(Category::Events, || arguments.greeting()) {
            logger.send(&message);
        }
        Some(Instance {
            mode: Mode::Instantiated,
            experiment: None,
            parameters: Parameters::default(),
            inputs: Inputs::default(),
            rates: Inputs::ZERO,
            time: 0.0,
            built: None,
            state: None,
            profiles: None,
            saved: SavedStates::default(),
            logger,
            messages: Vec::new(),
        })
    }

    /// One call: state check, panic fence, status. The messages come back: the logger may call into this instance.
    pub(super) fn call(
        &mut self,
        function: Function,
        body: impl FnOnce(&mut Instance) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let result = fence::fenced(|| {
            if !function.is_allowed(self.mode) {
                return Err(Failure::NotAllowed {
                    mode: self.mode,
                    allowed: function.allowed_modes(),
                });
            }
            body(self)
        });
        if let Err(failure) = &result {
            self.messages.extend(self.logger.failure(function.name(), failure));
            if failure.status() == super::types::Status::ERROR {
                self.mode = Mode::Error;
            }
            if matches!(failure, Failure::Panic { .. }) {
                self.built = None;
                self.profiles = None;
            }
        }
        result
    }

    /// The messages of a call and the logger to send them to.
    pub(super) fn take_messages(&mut self) -> (Vec<Message>, Logger) {
        (std::mem::take(&mut self.messages), self.logger.clone())
    }

    /// Tells the importer something, where the category is on.
    pub(super) fn inform(&mut self, category: Category, text: impl FnOnce(&Instance) -> String) {
        let message = self.logger.information(category, || text(self));
        self.messages.extend(message);
    }

    /// fmi2SetDebugLogging.
    pub(super) fn set_debug_logging(&mut self, on: bool, categories: &[Category]) {
        self.logger.switch(on, categories);
    }

    /// fmi2SetupExperiment. The tolerance is not used: the accuracy follows from mesh and passage time.
    pub(super) fn setup_experiment(&mut self, start: Real, stop: Option<Real>) -> Result<(), Failure> {
        if !start.is_finite() {
            return Err(Failure::StartTime { value: start });
        }
        if let Some(value) = stop {
            // Not a number is not above the start either.
            if value.is_nan() || value < start {
                return Err(Failure::StopTime { value, start });
            }
        }
        self.experiment = Some(Experiment { start, stop });
        self.time = start;
        Ok(())
    }

    /// fmi2EnterInitializationMode.
    pub(super) fn enter_initialization(&mut self) -> Result<(), Failure> {
        if self.experiment.is_none() {
            return Err(Failure::NoExperiment);
        }
        self.mode = Mode::Initialization;
        Ok(())
    }

    /// fmi2ExitInitializationMode: the parameters must make a model, and the contact a solution.
    pub(super) fn exit_initialization(&mut self) -> Result<(), Failure> {
        self.solution()?;
        self.mode = Mode::StepComplete;
        self.inform(Category::Events, |instance| {
            format!("initialized at t = {} s", instance.time)
        });
        Ok(())
    }

    /// fmi2Terminate.
    pub(super) fn terminate(&mut self) -> Result<(), Failure> {
        #[cfg(feature = "panic-injection")]
        panic!("deliberate panic of the feature panic-injection");
        #[cfg(not(feature = "panic-injection"))]
        {
            self.mode = Mode::Terminated;
            self.inform(Category::Events, |instance| {
                format!("terminated at t = {} s", instance.time)
            });
            Ok(())
        }
    }

    /// fmi2Reset: everything as after fmi2Instantiate; saved states and the choice of log categories stay.
    pub(super) fn reset(&mut self) {
        self.mode = Mode::Instantiated;
        self.experiment = None;
        self.parameters = Parameters::default();
        self.inputs = Inputs::default();
        self.rates = Inputs::ZERO;
        self.time = 0.0;
        self.state = None;
        self.profiles = None;
        self.inform(Category::Events, |_| "reset to the start values".to_owned());
    }

    /// Makes `built` the model of the given parameters; nothing is built anew where only tunable ones differ.
    pub(super) fn prepare(&mut self, parameters: &Parameters) -> error::Result<&mut Built> {
        let reusable = self
            .built
            .take_if(|built| fixed_part(built.model.parameters()) == fixed_part(parameters));
        let built = match reusable {
            Some(mut built) => {
                built.model.retune(parameters)?;
                built
            }
            None => {
                let model = Model::new(parameters.clone())?;
                let workspace = model.workspace();
                Built { model, workspace }
            }
        };
        Ok(self.built.insert(built))
    }

    /// The state at the communication point. In *initializationMode* it follows from parameters and inputs.
    pub(super) fn solution(&mut self) -> Result<&State, Failure> {
        if self.state.is_none() {
            if self.mode != Mode::Initialization {
                return Err(Failure::NothingComputed);
            }
            let (parameters, inputs) = (self.parameters.clone(), self.inputs);
            inputs.check(&parameters).map_err(Failure::Model)?;
            let Built { model, workspace } = self.prepare(&parameters).map_err(Failure::Model)?;
            let state = model.initial_state(workspace, &inputs).map_err(Failure::Model)?;
            self.state = Some(state);
        }
        self.state.as_ref().ok_or(Failure::NothingComputed)
    }

    /// Model and state at the communication point.
    pub(super) fn solved(&mut self) -> Result<(&mut Built, &State), Failure> {
        self.solution()?;
        match (&mut self.built, &self.state) {
            (Some(built), Some(state)) => Ok((built, state)),
            _ => Err(Failure::NothingComputed),
        }
    }

    fn profiles(&mut self) -> Result<&Profiles, Failure> {
        if self.profiles.is_none() {
            let (built, state) = self.solved()?;
            let profiles = built.model.profiles(state);
            self.profiles = Some(profiles);
        }
        self.profiles.as_ref().ok_or(Failure::NothingComputed)
    }

    fn forget_solution(&mut self) {
        self.state = None;
        self.profiles = None;
    }

    /// fmi2GetReal.
    pub(super) fn get_real(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        for reference in references {
            real(*reference)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(self.real_value(real(*reference)?)?);
        }
        Ok(())
    }

    fn real_value(&mut self, variable: RealVariable) -> Result<Real, Failure> {
        Ok(match variable {
            RealVariable::Input(row) => (INPUTS[row].get)(&self.inputs),
            RealVariable::Parameter(row) => (REAL_PARAMETERS[row].get)(&self.parameters),
            RealVariable::Output(row) => (OUTPUTS[row].get)(&self.solution()?.outputs),
            RealVariable::Profile(column, point) => {
                let values = (PROFILES[column].values)(self.profiles()?);
                *values.get(point).ok_or(Failure::NothingComputed)?
            }
            RealVariable::Residual => {
                let (built, state) = self.solved()?;
                built.model.convergence(state).residual
            }
        })
    }

    /// fmi2GetInteger.
    pub(super) fn get_integer(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<Integer>],
    ) -> Result<(), Failure> {
        for reference in references {
            integer(*reference)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(match integer(*reference)? {
                IntegerVariable::Parameter(row) => (INTEGER_PARAMETERS[row].get)(&self.parameters),
                IntegerVariable::Iterations => {
                    let (built, state) = self.solved()?;
                    Integer::try_from(built.model.convergence(state).iterations).unwrap_or(Integer::MAX)
                }
            });
        }
        Ok(())
    }

    /// fmi2SetReal: all values or none. Parameters come first, they bound the inputs.
    pub(super) fn set_real(&mut self, references: &[ValueReference], values: &[Real]) -> Result<(), Failure> {
        let mut parameters = self.parameters.clone();
        let mut inputs = self.inputs;
        for (reference, value) in references.iter().zip(values) {
            match real(*reference)? {
                RealVariable::Parameter(row) => {
                    let row = &REAL_PARAMETERS[row];
                    if self.mode == Mode::StepComplete && !row.tunable {
                        return Err(self.not_settable(*reference));
                    }
                    row.check(*value).map_err(Failure::Value)?;
                    (row.set)(&mut parameters, *value);
                }
                RealVariable::Input(row) => (INPUTS[row].set)(&mut inputs, *value),
                _ => return Err(self.not_settable(*reference)),
            }
        }
        for (reference, value) in references.iter().zip(values) {
            if let RealVariable::Input(row) = real(*reference)? {
                INPUTS[row].check(*value, &parameters).map_err(Failure::Value)?;
            }
        }
        if inputs != self.inputs {
            inputs.check_motion(&parameters).map_err(Failure::Value)?;
        }
        if self.mode == Mode::StepComplete {
            if parameters != self.parameters {
                self.prepare(&parameters).map_err(Failure::Value)?;
            }
        } else {
            self.forget_solution();
        }
        self.parameters = parameters;
        self.inputs = inputs;
        Ok(())
    }

    /// fmi2SetInteger: all values or none.
    pub(super) fn set_integer(&mut self, references: &[ValueReference], values: &[Integer]) -> Result<(), Failure> {
        let mut parameters = self.parameters.clone();
        for (reference, value) in references.iter().zip(values) {
            match integer(*reference)? {
                IntegerVariable::Parameter(row) if self.mode != Mode::StepComplete => {
                    let row = &INTEGER_PARAMETERS[row];
                    row.check(*value).map_err(Failure::Value)?;
                    (row.set)(&mut parameters, *value);
                }
                _ => return Err(self.not_settable(*reference)),
            }
        }
        if !references.is_empty() {
            self.forget_solution();
        }
        self.parameters = parameters;
        Ok(())
    }

    fn not_settable(&self, reference: ValueReference) -> Failure {
        Failure::NotSettable {
            name: variables::name(reference),
            reference,
            mode: self.mode,
            settable: match self.mode {
                Mode::StepComplete => "inputs and tunable parameters can be",
                _ => "inputs and parameters can be",
            },
        }
    }
}

impl Instantiation<'_> {
    fn check(&self) -> Result<(), Refusal> {
        let name = self.name.unwrap_or_default().to_string_lossy();
        if name.trim().is_empty() {
            return Err(Refusal::Name);
        }
        if self.fmu_type != CO_SIMULATION {
            return Err(Refusal::Type(self.fmu_type));
        }
        let guid = self.guid.ok_or(Refusal::NoGuid)?;
        if guid.to_bytes() != GUID.as_bytes() {
            return Err(Refusal::Guid(guid.to_string_lossy().into_owned()));
        }
        Ok(())
    }

    /// The location of the resources is only reported: the component reads no file.
    fn greeting(&self) -> String {
        let location = self.resource_location.unwrap_or_default().to_string_lossy();
        match resource::path(&location) {
            Some(path) => format!("instantiated; resources at {}", path.display()),
            None => "instantiated".to_owned(),
        }
    }
}

/// Resolves a value reference of type Real.
pub(super) fn real(reference: ValueReference) -> Result<RealVariable, Failure> {
    variables::real(reference).ok_or(Failure::UnknownReference {
        reference,
        expected: "a Real variable",
    })
}

/// Resolves a value reference of type Integer.
fn integer(reference: ValueReference) -> Result<IntegerVariable, Failure> {
    variables::integer(reference).ok_or(Failure::UnknownReference {
        reference,
        expected: "an Integer variable",
    })
}
