//! What tests must know of a standard: its value references, its token, the names of its functions.

use std::collections::HashMap;
use std::ffi::CString;
use std::sync::LazyLock;
use wheelrail::fmi::variables::{Kind, Shape};
use wheelrail::fmi2::variables::{Variable, variables};
use wheelrail::fmi3::references::{self, Type};
use wheelrail::signals::OUTPUTS;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Standard {
    Fmi2,
    Fmi3,
}

pub use Standard::{Fmi2, Fmi3};

/// What a variable is in a standard.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    pub reference: u32,
    /// In FMI 3.0 by its own types; in FMI 2.0 `Int32` stands for Integer.
    pub kind: Type,
    /// How many values an array has that has always as many; 1 where it is none.
    pub elements: usize,
}

impl Standard {
    pub const ALL: [Standard; 2] = [Fmi2, Fmi3];

    pub fn other(self) -> Standard {
        match self {
            Fmi2 => Fmi3,
            Fmi3 => Fmi2,
        }
    }

    /// The exported name of a function, which the standards name alike but for the number.
    pub fn function(self, name: &str) -> String {
        match (self, name) {
            (Fmi2, name) => format!("fmi2{name}"),
            (Fmi3, "SetReal") => "fmi3SetFloat64".to_owned(),
            (Fmi3, name) => format!("fmi3{name}"),
        }
    }

    /// The GUID, or the instantiation token, of the library.
    pub fn token(self) -> CString {
        let token = match self {
            Fmi2 => wheelrail::fmi2::GUID,
            Fmi3 => wheelrail::fmi3::INSTANTIATION_TOKEN,
        };
        CString::new(token).expect("no zero")
    }

    /// The table by names, made once: with its names it takes as long as many a call.
    pub fn table(self) -> &'static HashMap<String, Entry> {
        static TABLES: LazyLock<[HashMap<String, Entry>; 2]> = LazyLock::new(|| [of_fmi2(), of_fmi3()]);
        &TABLES[self as usize]
    }

    /// All value references.
    pub fn references(self) -> Vec<u32> {
        let mut references: Vec<_> = self.table().values().map(|entry| entry.reference).collect();
        references.sort_unstable();
        references
    }

    /// The value references of all outputs, in FMI 3.0 one for all contacts: their values follow each other as the rows of
    /// [`OUTPUTS`] do.
    pub fn outputs(self) -> Vec<u32> {
        let rows = OUTPUTS.iter().map(|row| self.find(row.name).0.reference);
        let mut references: Vec<u32> = rows.collect();
        references.dedup();
        references
    }

    /// The type of a variable.
    pub fn type_of(self, reference: u32) -> Option<Type> {
        static TYPES: LazyLock<[HashMap<u32, Type>; 2]> = LazyLock::new(|| {
            Standard::ALL.map(|standard| {
                let rows = standard.table().values();
                rows.map(|entry| (entry.reference, entry.kind)).collect()
            })
        });
        TYPES[self as usize].get(&reference).copied()
    }

    /// What the variable of a name is, and the element of an array where the name has an index and the standard has arrays.
    #[track_caller]
    pub fn find(self, name: &str) -> (Entry, Option<usize>) {
        if let Some(entry) = self.table().get(name) {
            return (*entry, None);
        }
        let indexed = name.strip_suffix(']').and_then(|name| name.split_once('['));
        let found = indexed.and_then(|(array, index)| Some((self.table().get(array)?, index.parse::<usize>().ok()?)));
        let (entry, index) = found.unwrap_or_else(|| panic!("no variable {name}"));
        (*entry, Some(index - 1))
    }
}

fn of_fmi2() -> HashMap<String, Entry> {
    let rows = variables().into_iter().map(|row| {
        let kind = match row.kind {
            wheelrail::fmi2::variables::Kind::Real { .. } => Type::Float64,
            wheelrail::fmi2::variables::Kind::Integer { .. } => Type::Int32,
            wheelrail::fmi2::variables::Kind::Text { .. } => Type::String,
        };
        let entry = Entry {
            reference: row.reference,
            kind,
            elements: 1,
        };
        (row.name, entry)
    });
    rows.collect()
}

fn of_fmi3() -> HashMap<String, Entry> {
    let rows = references::table().map(|(reference, row)| {
        let (kind, elements) = match row.kind {
            Kind::Real(kind) => match kind.shape {
                Shape::Array(elements) => (Type::Float64, elements),
                _ => (Type::Float64, 1),
            },
            Kind::Integer { kind, .. } => (Type::of(kind), 1),
            Kind::Text { .. } => (Type::String, 1),
        };
        let entry = Entry {
            reference,
            kind,
            elements,
        };
        (row.name.to_owned(), entry)
    });
    rows.collect()
}

/// A row of the table with arrays as their elements, which tests of either standard go through.
#[track_caller]
pub fn find(name: &str) -> &'static Variable {
    static TABLE: LazyLock<Vec<Variable>> = LazyLock::new(variables);
    let row = TABLE.iter().find(|row| row.name == name);
    row.unwrap_or_else(|| panic!("no variable {name}"))
}
