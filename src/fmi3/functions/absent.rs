//! Functions of event mode, clocks, model exchange and scheduled execution, which this unit does not have: no state allows
//! them. Their arguments are not looked at.

use super::call::call;
use crate::fmi3::states::Function;
use crate::fmi3::types::{
    self, Boolean, Clock, DependencyKind, Float64, IntervalQualifier, Status, UInt64, ValueReference,
};

/// Functions that no state allows.
macro_rules! absent {
    ($($name:ident $function:ident ($($argument:ty),*);)*) => {$(
        /// Never allowed.
        ///
        /// # Safety
        /// `instance` must be null or a live instance.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: types::Instance $(, _: $argument)*) -> Status {
            // SAFETY: a live instance (the caller's promise).
            unsafe { call(instance, Function::$function, |_| Ok(())) }
        }
    )*};
}

type References = *const ValueReference;

absent! {
    fmi3EnterEventMode EnterEventMode ();
    fmi3EnterStepMode EnterStepMode ();
    fmi3GetClock GetClock (References, usize, *mut Clock);
    fmi3SetClock SetClock (References, usize, *const Clock);
    fmi3GetNumberOfVariableDependencies GetNumberOfVariableDependencies (ValueReference, *mut usize);
    fmi3GetVariableDependencies GetVariableDependencies
        (ValueReference, *mut usize, *mut ValueReference, *mut usize, *mut DependencyKind, usize);
    fmi3GetIntervalDecimal GetIntervalDecimal (References, usize, *mut Float64, *mut IntervalQualifier);
    fmi3GetIntervalFraction GetIntervalFraction (References, usize, *mut UInt64, *mut UInt64, *mut IntervalQualifier);
    fmi3GetShiftDecimal GetShiftDecimal (References, usize, *mut Float64);
    fmi3GetShiftFraction GetShiftFraction (References, usize, *mut UInt64, *mut UInt64);
    fmi3SetIntervalDecimal SetIntervalDecimal (References, usize, *const Float64);
    fmi3SetIntervalFraction SetIntervalFraction (References, usize, *const UInt64, *const UInt64);
    fmi3SetShiftDecimal SetShiftDecimal (References, usize, *const Float64);
    fmi3SetShiftFraction SetShiftFraction (References, usize, *const UInt64, *const UInt64);
    fmi3EvaluateDiscreteStates EvaluateDiscreteStates ();
    fmi3UpdateDiscreteStates UpdateDiscreteStates
        (*mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Float64);
    fmi3EnterContinuousTimeMode EnterContinuousTimeMode ();
    fmi3CompletedIntegratorStep CompletedIntegratorStep (Boolean, *mut Boolean, *mut Boolean);
    fmi3SetTime SetTime (Float64);
    fmi3SetContinuousStates SetContinuousStates (*const Float64, usize);
    fmi3GetContinuousStateDerivatives GetContinuousStateDerivatives (*mut Float64, usize);
    fmi3GetEventIndicators GetEventIndicators (*mut Float64, usize);
    fmi3GetContinuousStates GetContinuousStates (*mut Float64, usize);
    fmi3GetNominalsOfContinuousStates GetNominalsOfContinuousStates (*mut Float64, usize);
    fmi3GetNumberOfEventIndicators GetNumberOfEventIndicators (*mut usize);
    fmi3GetNumberOfContinuousStates GetNumberOfContinuousStates (*mut usize);
    fmi3ActivateModelPartition ActivateModelPartition (ValueReference, Float64);
}
