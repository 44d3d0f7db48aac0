//! Notation of a standard's table, functions × states.

/// Declares `Function`, the functions of a standard that work on an instance and are bound to states, from a table with a
/// column for each of its `STATES`; `column` gives that of a mode, `NEVER` the words for a function that no state allows.
macro_rules! functions {
    ($($function:ident $name:literal [$($allowed:tt)*])*) => {
        /// The functions that work on an instance and are bound to states.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Function {
            $(
                #[doc = $name]
                $function,
            )*
        }

        const TABLE: &[(&str, [bool; STATES.len()])] =
            &[$(($name, [$($crate::fmi::states::is_allowed(stringify!($allowed))),*]),)*];

        impl $crate::fmi::call::Function for Function {
            fn name(self) -> &'static str {
                TABLE[self as usize].0
            }

            fn is_allowed(self, mode: Mode) -> bool {
                TABLE[self as usize].1[column(mode)]
            }

            fn name_of(mode: Mode) -> &'static str {
                STATES[column(mode)]
            }

            fn allowed_modes(self) -> String {
                let allowed = STATES.iter().zip(TABLE[self as usize].1);
                let names: Vec<_> = allowed.filter(|(_, allowed)| *allowed).map(|(name, _)| *name).collect();
                if names.is_empty() { NEVER.to_owned() } else { names.join(", ") }
            }
        }
    };
}

/// Whether a cell of a table says so: `x`, or `-` for not allowed.
pub const fn is_allowed(cell: &str) -> bool {
    matches!(cell.as_bytes(), b"x")
}

pub(crate) use functions;
