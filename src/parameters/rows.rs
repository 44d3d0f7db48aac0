//! Macros that turn a declaration in `table` into a field, its start value and a row; macros, because a row reads and writes its field.
//!
//! Each kind of parameter has three arms: `start`, the field's start value; `unit`, for the field's documentation; `row`.
//! `parameters!` puts them together. The names that they use are those of `table`.

/// A number: unit, unit in which a person would read it, start value, range.
macro_rules! real {
    (start { $unit:literal $(shown in $display:literal)?, $start:expr, $minimum:expr, $maximum:expr $(, $tunable:ident)? }) => {
        $start
    };
    (unit { $unit:literal $($rest:tt)* }) => { concat!("\n\nUnit: `", $unit, "`") };
    (row $field:ident, $description:expr,
     { $unit:literal $(shown in $display:literal)?, $start:expr, $minimum:expr, $maximum:expr $(, $tunable:ident)? }) => {
        ParameterRow::Real(RealParameter {
            name: stringify!($field),
            is_array: false,
            elements: &[stringify!($field)],
            unit: $unit,
            display_unit: optional!($($display)?),
            start: &[$start],
            minimum: $minimum,
            maximum: $maximum,
            tunable: is_there!($($tunable)?),
            description: $description,
            get: |parameters| std::slice::from_ref(&parameters.$field),
            get_mut: |parameters| std::slice::from_mut(&mut parameters.$field),
        })
    };
}

/// An array: name and numbers of its elements, unit, unit in which a person would read it, start values, range.
macro_rules! reals {
    (start { $name:literal [$($element:literal)+], $unit:literal $(shown in $display:literal)?, $start:expr, $($rest:tt)* }) => {
        $start
    };
    (unit { $name:literal [$($element:literal)+], $unit:literal $($rest:tt)* }) => {
        concat!("\n\nUnit: `", $unit, "`")
    };
    (row $field:ident, $description:expr,
     { $name:literal [$($element:literal)+], $unit:literal $(shown in $display:literal)?, $start:expr, $minimum:expr, $maximum:expr }) => {
        ParameterRow::Real(RealParameter {
            name: $name,
            is_array: true,
            elements: &[$(concat!($name, "[", $element, "]")),+],
            unit: $unit,
            display_unit: optional!($($display)?),
            start: &$start,
            minimum: $minimum,
            maximum: $maximum,
            tunable: false,
            description: $description,
            get: |parameters| &parameters.$field,
            get_mut: |parameters| &mut parameters.$field,
        })
    };
}

/// A number of things: start value, range.
macro_rules! count {
    (start { $start:expr, $minimum:expr, $maximum:expr }) => {
        $start
    };
    (unit { $($columns:tt)* }) => {
        ""
    };
    (row $field:ident, $description:expr, { $start:expr, $minimum:expr, $maximum:expr }) => {
        ParameterRow::Integer(IntegerParameter {
            name: stringify!($field),
            start: $start,
            minimum: $minimum,
            maximum: $maximum,
            kind: IntegerKind::Count,
            description: $description,
            get: |parameters| parameters.$field as i32,
            // `check` has refused negative counts.
            set: |parameters, value| parameters.$field = value.unsigned_abs() as usize,
        })
    };
}

/// A choice, numbered from 1: type, start value.
macro_rules! choice {
    (start { $type:ident::$start:ident }) => {
        $type::$start
    };
    (unit { $($columns:tt)* }) => {
        ""
    };
    (row $field:ident, $description:expr, { $type:ident::$start:ident }) => {
        ParameterRow::Integer(IntegerParameter {
            name: stringify!($field),
            start: $type::$start as i32 + 1,
            minimum: 1,
            maximum: $type::ALL.len() as i32,
            kind: IntegerKind::Choice($type::NAMES),
            description: $description,
            get: |parameters| parameters.$field as i32 + 1,
            set: |parameters, value| {
                if let Some(choice) = $type::ALL.get((value - 1) as usize) {
                    parameters.$field = *choice;
                }
            },
        })
    };
}

/// A text: start value.
macro_rules! text {
    (start { $start:literal }) => {
        $start.to_owned()
    };
    (unit { $($columns:tt)* }) => {
        ""
    };
    (row $field:ident, $description:expr, { $start:literal }) => {
        ParameterRow::Text(TextParameter {
            name: stringify!($field),
            start: $start,
            description: $description,
            get: |parameters| &parameters.$field,
            set: |parameters, text| parameters.$field = text,
        })
    };
}

/// A number of things that is also the length of arrays: start value, range.
macro_rules! length {
    (row $($rest:tt)*) => {
        of_kind!(IntegerKind::Length, count!(row $($rest)*))
    };
    ($($rest:tt)*) => {
        count!($($rest)*)
    };
}

/// A choice between off (1) and on (2): type, start value.
macro_rules! switch {
    (row $($rest:tt)*) => {
        of_kind!(IntegerKind::Switch, choice!(row $($rest)*))
    };
    ($($rest:tt)*) => {
        choice!($($rest)*)
    };
}

/// A row of integers with another kind.
macro_rules! of_kind {
    ($kind:expr, $row:expr) => {
        match $row {
            ParameterRow::Integer(row) => ParameterRow::Integer(IntegerParameter { kind: $kind, ..row }),
            other => other,
        }
    };
}

macro_rules! optional {
    () => {
        None
    };
    ($value:literal) => {
        Some($value)
    };
}

macro_rules! is_there {
    () => {
        false
    };
    (tunable) => {
        true
    };
}

macro_rules! parameters {
    ($($(#[doc = $description:literal])+ $field:ident $($symbol:literal)?: $type:ty = $kind:ident $columns:tt)+) => {
        /// All parameters. Start values are those of section 5 of the paper where it gives a number; the wheel is elastic, where
        /// the paper's is rigid.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub struct Parameters {
            $(
                #[doc = concat!($($description),+)]
                $(#[doc = concat!("\n\nSymbol: ", $symbol)])?
                #[doc = $kind!(unit $columns)]
                pub $field: $type,
            )+
            /// Couple normal and tangential displacement (Dundurs). A rigid wheel on an elastic rail is coupled, a wheel of
            /// the rail's material is not; the switch exists for the comparison of the former with Carter's theory, which
            /// has identical bodies. Not an FMI parameter.
            pub normal_tangential_coupling: bool,
        }

        impl Default for Parameters {
            fn default() -> Self {
                Parameters {
                    $($field: $kind!(start $columns),)+
                    normal_tangential_coupling: true,
                }
            }
        }

        const ROWS: &[ParameterRow] = &[
            $($kind!(row $field, concat!($($description),+).trim_ascii(), $columns),)+
        ];
    };
}
