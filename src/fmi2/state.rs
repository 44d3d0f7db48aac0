//! What a saved state holds, and its serialised form.
//!
//! | bytes | content (little endian) |
//! |---|---|
//! | 8 | magic `WHLRAIL` and a zero byte |
//! | 4 | version of this form |
//! | 8 | hash of the description and of the fixed parameters: state and instance must agree in both |
//! | 8 | length of the payload |
//! | … | payload: [`Snapshot`] as postcard |
//! | 4 | CRC-32 of everything before |
//!
//! Meshes and tables are not part of it: they follow from the parameters.

use super::modes::Mode;
use crate::parameters::{Parameters, REAL_PARAMETERS};
use crate::signals::Inputs;
use crate::wheel_rail::State;
use serde::{Deserialize, Serialize};

const MAGIC: [u8; 8] = *b"WHLRAIL\0";
const VERSION: u32 = 2;
const HEADER: usize = 8 + 4 + 8 + 8;
const CHECKSUM: usize = 4;

/// Times given by fmi2SetupExperiment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    /// Start time in s.
    pub start: f64,
    /// Stop time, where one is defined in s.
    pub stop: Option<f64>,
}

/// Everything of an instance that changes: fmi2GetFMUstate is a copy of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// State of the state machine.
    pub mode: Mode,
    /// Times of the experiment, once they are set.
    pub experiment: Option<Experiment>,
    /// All parameters.
    pub parameters: Parameters,
    /// The inputs at the communication point.
    pub inputs: Inputs,
    /// Their rates of change in the next step.
    pub rates: Inputs,
    /// The communication point in s.
    pub time: f64,
    /// Rail and contact, once computed.
    pub state: Option<State>,
}

/// Why bytes are not a serialised state.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Corruption {
    /// Fewer bytes than the shortest state has, or not as many as it says.
    #[error("it has {given} bytes, not {expected}")]
    Length {
        /// Bytes given.
        given: usize,
        /// Bytes expected.
        expected: u64,
    },
    /// Another component's.
    #[error("it does not begin with the mark of a wheelrail state")]
    Foreign,
    /// Another version's.
    #[error("its version is {given}, not {expected}", expected = VERSION)]
    Version {
        /// Version found.
        given: u32,
    },
    /// Another build's, or made with other fixed parameters.
    #[error("it was made by another build, or with other fixed parameters than this instance's")]
    Parameters,
    /// Damaged.
    #[error("its checksum is wrong")]
    Checksum,
    /// Well-formed, but not the content of a state.
    #[error("its content is not that of a state")]
    Content,
}

/// Hash of the description and of the fixed parameters.
pub fn parameter_hash(parameters: &Parameters) -> u64 {
    let fixed = fixed_part(parameters);
    let bytes = postcard::to_allocvec(&fixed).unwrap_or_default();
    fnv(super::GUID.bytes().chain(bytes))
}

/// The parameters with every tunable one at its start value: what a model is built for.
pub fn fixed_part(parameters: &Parameters) -> Parameters {
    let mut fixed = parameters.clone();
    for row in REAL_PARAMETERS.iter().filter(|row| row.tunable) {
        (row.set)(&mut fixed, row.default);
    }
    fixed
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The serialised form.
pub fn serialize(snapshot: &Snapshot) -> Result<Vec<u8>, Corruption> {
    let payload = postcard::to_allocvec(snapshot).map_err(|_| Corruption::Content)?;
    let mut bytes = Vec::with_capacity(HEADER + payload.len() + CHECKSUM);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(parameter_hash(&snapshot.parameters).to_le_bytes());
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(payload);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    Ok(bytes)
}

/// Reads the serialised form, for an instance with the given parameters.
///
/// # Errors
/// [`Corruption`] for anything that [`serialize`] did not make under the same fixed parameters.
pub fn deserialize(bytes: &[u8], parameters: &Parameters) -> Result<Snapshot, Corruption> {
    let shortest = HEADER + CHECKSUM;
    let too_short = Corruption::Length {
        given: bytes.len(),
        expected: shortest as u64,
    };
    let (magic, rest) = bytes.split_first_chunk().ok_or(too_short.clone())?;
    if *magic != MAGIC {
        return Err(Corruption::Foreign);
    }
    let (version, rest) = rest.split_first_chunk().ok_or(too_short.clone())?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(Corruption::Version { given: version });
    }
    let (hash, rest) = rest.split_first_chunk().ok_or(too_short.clone())?;
    let (length, rest) = rest.split_first_chunk().ok_or(too_short.clone())?;
    let length = u64::from_le_bytes(*length);
    let (payload, checksum) = rest.split_last_chunk().ok_or(too_short)?;
    if payload.len() as u64 != length {
        let expected = length.saturating_add(shortest as u64);
        return Err(Corruption::Length {
            given: bytes.len(),
            expected,
        });
    }
    if u32::from_le_bytes(*checksum) != crc32fast::hash(&bytes[..bytes.len() - CHECKSUM]) {
        return Err(Corruption::Checksum);
    }
    if u64::from_le_bytes(*hash) != parameter_hash(parameters) {
        return Err(Corruption::Parameters);
    }
    let (snapshot, rest) = postcard::take_from_bytes::<Snapshot>(payload).map_err(|_| Corruption::Content)?;
    if !rest.is_empty() || fixed_part(&snapshot.parameters) != fixed_part(parameters) {
        return Err(Corruption::Content);
    }
    Ok(snapshot)
}
