//! The serialised form of a saved state.
//!
//! | bytes | content (little endian) |
//! |---|---|
//! | 8 | magic `WHLRAIL` and a zero byte |
//! | 4 | version of this form |
//! | 8 | hash of the version, of the names of all quantities and of the fixed parameters: state and instance must agree in them |
//! | 8 | length of the payload |
//! | … | payload: [`Snapshot`] as postcard |
//! | 4 | CRC-32 of everything before |
//!
//! Meshes and tables are not part of it: they follow from the parameters, and profiles in files from the contents of these, which are part of it.

use super::snapshot::Snapshot;
use crate::parameters::{INTEGER_PARAMETERS, Parameters, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::{INPUTS, OUTPUTS};

const MAGIC: [u8; 8] = *b"WHLRAIL\0";
const VERSION: u32 = 13;
const HEADER: usize = 8 + 4 + 8 + 8;
const CHECKSUM: usize = 4;

/// Reason why bytes are not a serialised state.
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
    /// Another version's, or made with other fixed parameters.
    #[error("it was made by another version, or with other fixed parameters than this instance's")]
    Parameters,
    /// Damaged.
    #[error("its checksum is wrong")]
    Checksum,
    /// Well-formed, but not the content of a state.
    #[error("its content is not that of a state")]
    Content,
}

/// Hash of what a reader must agree in. It is the same for every version of FMI, so that they read each other's states.
fn agreement_hash(parameters: &Parameters) -> u64 {
    let version = std::iter::once(env!("CARGO_PKG_VERSION"));
    let inputs = INPUTS.iter().map(|signal| signal.name);
    let outputs = OUTPUTS.iter().map(|signal| signal.name);
    let reals = REAL_PARAMETERS.iter().map(|row| row.name);
    let integers = INTEGER_PARAMETERS.iter().map(|row| row.name);
    let texts = TEXT_PARAMETERS.iter().map(|row| row.name);
    let names = version.chain(inputs).chain(outputs);
    let names = names.chain(reals).chain(integers).chain(texts);
    let fixed = postcard::to_allocvec(&parameters.fixed_part()).unwrap_or_default();
    fnv(names.flat_map(|name| name.bytes().chain([0])).chain(fixed))
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The serialised form of a snapshot.
///
/// # Errors
/// [`Corruption::Content`], which no snapshot of an instance leads to.
pub fn serialize(snapshot: &Snapshot) -> Result<Vec<u8>, Corruption> {
    let payload = postcard::to_allocvec(snapshot).map_err(|_| Corruption::Content)?;
    let mut bytes = Vec::with_capacity(HEADER + payload.len() + CHECKSUM);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(agreement_hash(&snapshot.parameters).to_le_bytes());
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
    if u64::from_le_bytes(*hash) != agreement_hash(parameters) {
        return Err(Corruption::Parameters);
    }
    let (snapshot, rest) = postcard::take_from_bytes::<Snapshot>(payload).map_err(|_| Corruption::Content)?;
    if !rest.is_empty() || snapshot.parameters.fixed_part() != parameters.fixed_part() {
        return Err(Corruption::Content);
    }
    Ok(snapshot)
}
