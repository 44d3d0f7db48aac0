//! Macros that turn the declarations of inputs and outputs into fields, start values and rows; macros, because a row reads and writes its field. The
//! names that they use are those of the module above.

macro_rules! optional {
    () => {
        None
    };
    ($value:expr) => {
        Some($value)
    };
}

/// The range that the parameters leave to an input: the whole range where nothing narrows it.
macro_rules! limits {
    ($minimum:expr, $maximum:expr) => {
        |_| ($minimum, $maximum)
    };
    ($minimum:expr, $maximum:expr, $narrowed:expr) => {
        $narrowed
    };
}

/// The choice that an input's column `by` names.
macro_rules! used_by {
    () => {
        None
    };
    (creepage) => {
        Some(UsedBy::SlipSource(SlipSource::Creepage))
    };
    (vehicle_speed) => {
        Some(UsedBy::SlipSource(SlipSource::VehicleSpeed))
    };
    (load) => {
        Some(UsedBy::Control(Control::Load))
    };
    (height) => {
        Some(UsedBy::Control(Control::Height))
    };
    (geometry) => {
        Some(UsedBy::PatchGeometry(PatchGeometry::Inputs))
    };
}

/// Writes what the column `by` says at the end of an input's description.
macro_rules! used_where {
    () => {
        ""
    };
    (load) => {
        ", used where control is load"
    };
    (height) => {
        ", used where control is height"
    };
    (geometry) => {
        ", used where patch_geometry is inputs"
    };
    ($source:ident) => {
        concat!(", used where slip_source is ", stringify!($source))
    };
}

/// The contact models that a column `only` names.
macro_rules! models {
    () => {
        ContactModel::ALL
    };
    ([patch]) => {
        &[ContactModel::Patch]
    };
    ([profiles]) => {
        &[ContactModel::Profiles]
    };
    ([patch, profiles]) => {
        &[ContactModel::Patch, ContactModel::Profiles]
    };
}

/// Words for the contact models of a column `only` in a refusal.
macro_rules! takers {
    () => {
        ""
    };
    ([patch]) => {
        "2 (patch) takes"
    };
    ([profiles]) => {
        "3 (profiles) takes"
    };
    ([patch, profiles]) => {
        "2 (patch) and 3 (profiles) take"
    };
}

/// Writes what the column `only` says at the end of a description.
macro_rules! zero_unless {
    () => {
        ""
    };
    ([patch]) => {
        "; 0 unless contact_model is patch"
    };
    ([profiles]) => {
        "; 0 unless contact_model is profiles"
    };
    ([patch, profiles]) => {
        "; 0 unless contact_model is patch or profiles"
    };
}

macro_rules! is_profiles {
    () => {
        false
    };
    ([profiles]) => {
        true
    };
    ([patch, profiles]) => {
        false
    };
}

macro_rules! narrowed_by {
    () => {
        ""
    };
    ($because:expr) => {
        $because
    };
}

macro_rules! inputs {
    ($(
        $(#[doc = $description:literal])+
        $field:ident $($symbol:literal)?: $unit:literal $(shown in $display:literal)?, $(by $source:ident,)? start $default:expr,
        range [$minimum:expr, $maximum:expr $(; $narrowed:expr, $because:expr)?], nominal $nominal:expr $(, only $models:tt)?;
    )+) => {
        /// The continuous inputs at one instant.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        pub struct Inputs {
            $(
                #[doc = concat!($($description,)+ used_where!($($source)?), zero_unless!($($models)?))]
                $(#[doc = concat!("\n\nSymbol: ", $symbol)])?
                #[doc = concat!("\n\nUnit: `", $unit, "`")]
                pub $field: f64,
            )+
        }

        impl Inputs {
            /// All zero: the rates of inputs that are held.
            pub const ZERO: Inputs = Inputs { $($field: 0.0,)+ };

            /// The inputs after `time` at the given rates of change.
            pub fn advanced(&self, rates: &Inputs, time: f64) -> Inputs {
                Inputs { $($field: self.$field + rates.$field * time,)+ }
            }
        }

        impl Default for Inputs {
            /// The start values.
            fn default() -> Self {
                Inputs { $($field: $default,)+ }
            }
        }

        /// The inputs in the order in which they are listed.
        pub const INPUTS: &[InputSignal] = &[$(
            InputSignal {
                name: stringify!($field),
                unit: $unit,
                display_unit: optional!($($display)?),
                default: $default,
                minimum: $minimum,
                maximum: $maximum,
                limits: limits!($minimum, $maximum $(, $narrowed)?),
                narrowed_by: narrowed_by!($($because)?),
                used_by: used_by!($($source)?),
                models: models!($($models)?),
                takers: takers!($($models)?),
                nominal: $nominal,
                description: concat!($($description,)+ used_where!($($source)?), zero_unless!($($models)?)).trim_ascii(),
                get: |inputs| inputs.$field,
                set: |inputs, value| inputs.$field = value,
            },
        )+];
    };
}

macro_rules! outputs {
    ($(
        $(#[doc = $description:literal])+
        $field:ident $($symbol:literal)?: $unit:literal $(shown in $display:literal)?, $kind:ident,
        $(at least $minimum:literal,)? $(at most $maximum:literal,)? nominal $nominal:expr $(, only $models:tt)?;
    )+) => {
        /// The outputs at one instant.
        #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
        pub struct Outputs {
            $(
                #[doc = concat!($($description,)+ zero_unless!($($models)?))]
                $(#[doc = concat!("\n\nSymbol: ", $symbol)])?
                #[doc = concat!("\n\nUnit: `", $unit, "`")]
                pub $field: f64,
            )+
            /// The contacts along the rail's profile, from its gauge side to its field side; 0 where there is none.
            pub contact: [ContactOutputs; CONTACTS],
        }

        impl Outputs {
            /// Rates of change since the outputs `duration` `s` before, per second. Written out, field by field: through the functions of
            /// [`OUTPUTS`], and with the inputs along a ramp through those of [`INPUTS`], they took a twentieth of a step on 8 × 8 cells.
            pub(crate) fn rates(&self, before: &Outputs, duration: f64) -> Outputs {
                Outputs {
                    $($field: (self.$field - before.$field) / duration,)+
                    contact: std::array::from_fn(|k| self.contact[k].rates(&before.contact[k], duration)),
                }
            }
        }

        /// The rows of numbers.
        const NUMBERS: &[OutputSignal] = &[$(
            OutputSignal {
                name: stringify!($field),
                array: None,
                profiles_only: is_profiles!($($models)?),
                unit: $unit,
                display_unit: optional!($($display)?),
                kind: OutputKind::$kind,
                minimum: optional!($($minimum)?),
                maximum: optional!($($maximum)?),
                nominal: $nominal,
                description: concat!($($description,)+ zero_unless!($($models)?)).trim_ascii(),
                get: |outputs| outputs.$field,
                set: |outputs, value| outputs.$field = value,
            },
        )+];
    };
}

/// The row of a contact's output.
macro_rules! contact_row {
    ($contact:literal $index:literal, $field:ident, $unit:literal, $display:expr, $minimum:expr, $nominal:expr, $description:expr) => {
        OutputSignal {
            name: concat!("contact.", stringify!($field), "[", $index, "]"),
            array: Some((concat!("contact.", stringify!($field)), $contact)),
            profiles_only: true,
            unit: $unit,
            display_unit: $display,
            kind: OutputKind::Instantaneous,
            minimum: $minimum,
            maximum: None,
            nominal: $nominal,
            description: $description,
            get: |outputs| outputs.contact[$contact].$field,
            set: |outputs, value| outputs.contact[$contact].$field = value,
        }
    };
}

macro_rules! contact_outputs {
    ($(
        $(#[doc = $description:literal])+
        $field:ident: $unit:literal $(shown in $display:literal)?, $(at least $minimum:literal,)? nominal $nominal:expr;
    )+) => {
        /// The outputs of a contact at one instant.
        #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
        pub struct ContactOutputs {
            $(
                #[doc = concat!($($description),+)]
                #[doc = concat!("\n\nUnit: `", $unit, "`")]
                pub $field: f64,
            )+
        }

        impl ContactOutputs {
            /// See [`Outputs::rates`].
            fn rates(&self, before: &ContactOutputs, duration: f64) -> ContactOutputs {
                ContactOutputs {
                    $($field: (self.$field - before.$field) / duration,)+
                }
            }
        }

        /// The rows of arrays, element by element.
        const ELEMENTS: &[[OutputSignal; CONTACTS]] = &[$([
            contact_row!(0 "1", $field, $unit, optional!($($display)?), optional!($($minimum)?), $nominal, concat!($($description,)+ "; 0 where there is no such contact; contacts count from the gauge side").trim_ascii()),
            contact_row!(1 "2", $field, $unit, optional!($($display)?), optional!($($minimum)?), $nominal, concat!($($description,)+ "; 0 where there is no such contact; contacts count from the gauge side").trim_ascii()),
            contact_row!(2 "3", $field, $unit, optional!($($display)?), optional!($($minimum)?), $nominal, concat!($($description,)+ "; 0 where there is no such contact; contacts count from the gauge side").trim_ascii()),
            contact_row!(3 "4", $field, $unit, optional!($($display)?), optional!($($minimum)?), $nominal, concat!($($description,)+ "; 0 where there is no such contact; contacts count from the gauge side").trim_ascii()),
        ],)+];
    };
}
