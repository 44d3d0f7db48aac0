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
}
