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
macro_rules! slip_source {
    () => {
        None
    };
    (creepage) => {
        Some(SlipSource::Creepage)
    };
    (vehicle_speed) => {
        Some(SlipSource::VehicleSpeed)
    };
}

/// Writes what the columns `by` and `only` say at the end of an input's description.
macro_rules! used_where {
    () => {
        ""
    };
    (patch) => {
        "; 0 unless contact_model is patch"
    };
    ($source:ident) => {
        concat!(", used where slip_source is ", stringify!($source))
    };
}

macro_rules! is_there {
    () => {
        false
    };
    (patch) => {
        true
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
        range [$minimum:expr, $maximum:expr $(; $narrowed:expr, $because:expr)?], nominal $nominal:expr $(, $patch:ident only)?;
    )+) => {
        /// The continuous inputs at one instant.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        pub struct Inputs {
            $(
                #[doc = concat!($($description,)+ used_where!($($source)?), used_where!($($patch)?))]
                $(#[doc = concat!("\n\nSymbol: ", $symbol)])?
                #[doc = concat!("\n\nUnit: `", $unit, "`")]
                pub $field: f64,
            )+
        }

        impl Inputs {
            /// All zero: the rates of inputs that are held.
            pub const ZERO: Inputs = Inputs { $($field: 0.0,)+ };
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
                slip_source: slip_source!($($source)?),
                patch_only: is_there!($($patch)?),
                nominal: $nominal,
                description: concat!($($description,)+ used_where!($($source)?), used_where!($($patch)?)).trim_ascii(),
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
        $(at least $minimum:literal,)? $(at most $maximum:literal,)? nominal $nominal:expr;
    )+) => {
        /// The outputs at one instant.
        #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
        pub struct Outputs {
            $(
                #[doc = concat!($($description),+)]
                $(#[doc = concat!("\n\nSymbol: ", $symbol)])?
                #[doc = concat!("\n\nUnit: `", $unit, "`")]
                pub $field: f64,
            )+
        }

        /// The outputs in the order in which they are listed.
        pub const OUTPUTS: &[OutputSignal] = &[$(
            OutputSignal {
                name: stringify!($field),
                unit: $unit,
                display_unit: optional!($($display)?),
                kind: OutputKind::$kind,
                minimum: optional!($($minimum)?),
                maximum: optional!($($maximum)?),
                nominal: $nominal,
                description: concat!($($description),+).trim_ascii(),
                get: |outputs| outputs.$field,
                set: |outputs, value| outputs.$field = value,
            },
        )+];
    };
}
