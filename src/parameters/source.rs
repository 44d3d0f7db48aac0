//! Source of a profile: what its text names.

use crate::error::{Error, Result, TextProblem};
use crate::geometry::profile::built_in;
use std::path::PathBuf;

/// Source of a profile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ProfileSource {
    /// Profile that is built in, by its name.
    BuiltIn(&'static str),
    /// File that holds it.
    File(PathBuf),
}

impl ProfileSource {
    /// Source that the text of the parameter `name` names: a profile that is built in, capital letters apart, or else a file by its
    /// path or URI.
    ///
    /// # Errors
    /// [`Error::Text`].
    pub fn of(name: &'static str, text: &str) -> Result<ProfileSource> {
        let known = built_in::NAMES.iter().find(|known| known.eq_ignore_ascii_case(text));
        match known {
            Some(known) => Ok(ProfileSource::BuiltIn(known)),
            None => path_of(text)
                .map(ProfileSource::File)
                .map_err(|problem| Error::Text { name, problem }),
        }
    }
}

/// Path that a text is, or that a URI `file:///path`, `file://localhost/path` or `file:/path` stands for.
///
/// # Errors
/// [`TextProblem::OtherUri`] or [`TextProblem::Escape`].
pub fn path_of(text: &str) -> std::result::Result<PathBuf, TextProblem> {
    let Some((scheme, rest)) = text.split_once(':') else {
        return Ok(PathBuf::from(text));
    };
    if !scheme.eq_ignore_ascii_case("file") {
        // A colon may stand in the name of a file, and behind the letter of a drive.
        let is_scheme = scheme.len() > 1 && scheme.bytes().all(|byte| byte.is_ascii_alphanumeric());
        return match is_scheme && rest.starts_with("//") {
            true => Err(TextProblem::OtherUri),
            false => Ok(PathBuf::from(text)),
        };
    }
    let path = match rest.strip_prefix("//") {
        Some(rest) => {
            let (host, _) = rest.split_once('/').ok_or(TextProblem::OtherUri)?;
            if !host.is_empty() && host != "localhost" {
                return Err(TextProblem::OtherUri);
            }
            &rest[host.len()..]
        }
        None => rest,
    };
    let path = unescaped(path).ok_or(TextProblem::Escape)?;
    // The drive of /C:/path.
    let drive = cfg!(windows) && path.as_bytes().get(2) == Some(&b':');
    Ok(PathBuf::from(if drive { &path[1..] } else { &path }))
}

/// A text with the bytes that %20 and the like stand for; `None` where they are no text without a zero byte.
fn unescaped(text: &str) -> Option<String> {
    let mut parts = text.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        let digits = part.get(..2).filter(|digits| !digits.starts_with('+'))?;
        bytes.push(u8::from_str_radix(digits, 16).ok()?);
        bytes.extend(&part.as_bytes()[2..]);
    }
    String::from_utf8(bytes).ok().filter(|text| !text.contains('\0'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_name_profiles_that_are_built_in_and_files() {
        let of = |text| ProfileSource::of("rail_profile", text);
        let file = |path: &str| Ok(ProfileSource::File(PathBuf::from(path)));
        assert_eq!(of("60E1"), Ok(ProfileSource::BuiltIn("60E1")));
        assert_eq!(of("s1002"), Ok(ProfileSource::BuiltIn("S1002")));
        for (text, path) in [
            ("60E1.prr", "60E1.prr"),
            ("worn/60E1", "worn/60E1"),
            ("/a b/rail.csv", "/a b/rail.csv"),
            ("a:b", "a:b"),
            ("file:///a%20b/r%C3%A4il.prr", "/a b/räil.prr"),
            ("file:/rail.prr", "/rail.prr"),
            ("FILE://localhost/rail.prr", "/rail.prr"),
            ("c:\\rail.prr", "c:\\rail.prr"),
            ("50%.prr", "50%.prr"),
        ] {
            assert_eq!(of(text), file(path));
        }
        for (text, problem) in [
            ("https://example.org/rail.prr", TextProblem::OtherUri),
            ("file://server/rail.prr", TextProblem::OtherUri),
            ("file://rail.prr", TextProblem::OtherUri),
            ("file:///50%", TextProblem::Escape),
            ("file:///%+1", TextProblem::Escape),
            ("file:///%zz", TextProblem::Escape),
            ("file:///a%00b", TextProblem::Escape),
            ("file:///%ff", TextProblem::Escape),
        ] {
            let name = "rail_profile";
            assert_eq!(of(text), Err(Error::Text { name, problem }), "{text}");
        }
        let refused = of("https://example.org").unwrap_err().to_string();
        assert!(
            refused.starts_with("rail_profile is a URI, and not") && refused.contains("file:///path"),
            "{refused}"
        );
    }
}
