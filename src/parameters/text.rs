//! Check of a text.

use crate::error::{Error, LONGEST_TEXT, Result, TextProblem};

/// Refuses a text that is empty, too long or has a zero byte in it, which would end it in C.
///
/// # Errors
/// [`Error::Text`].
pub fn check_text(name: &'static str, text: &str) -> Result<()> {
    let refused = |problem| Err(Error::Text { name, problem });
    if text.trim().is_empty() {
        return refused(TextProblem::Blank);
    }
    if text.len() > LONGEST_TEXT {
        return refused(TextProblem::TooLong);
    }
    match text.bytes().position(|byte| byte == 0) {
        Some(before) => refused(TextProblem::ZeroByte { before }),
        None => Ok(()),
    }
}
