//! Problems of a text.

use thiserror::Error;

/// Bytes that a text has at most: those of the longest path.
pub const LONGEST_TEXT: usize = 4096;

/// Problem of a text that is to be a parameter's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum TextProblem {
    /// Nothing but spaces, or nothing at all.
    #[error("is blank")]
    Blank,
    /// More bytes than allowed.
    #[error("is too long")]
    TooLong,
    /// A zero byte in the middle.
    #[error("has a zero byte behind {before} others")]
    ZeroByte {
        /// Number of bytes before it.
        before: usize,
    },
    /// Bytes that are not UTF-8.
    #[error("is not UTF-8 behind its first {valid} bytes")]
    NotUtf8 {
        /// Number of bytes that are.
        valid: usize,
    },
    /// A URI of something else than a file here.
    #[error("is a URI, and not that of a file on this machine")]
    OtherUri,
    /// A URI whose escapes are none, or stand for what no path has.
    #[error("is a URI with an escape that is none in a path")]
    Escape,
}

impl TextProblem {
    /// Texts that are allowed, in words.
    pub(crate) fn allowed(self) -> String {
        match self {
            TextProblem::OtherUri | TextProblem::Escape => {
                "the name of a profile that is built in, a path, or a URI file:///path with escapes as %20".to_owned()
            }
            _ => format!("UTF-8 of 1 to {LONGEST_TEXT} bytes, none of them zero"),
        }
    }
}
