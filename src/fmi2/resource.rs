//! The location of the unzipped resources: a URI.

use std::path::PathBuf;

/// The path in a `file:` URI, percent-decoded; both `file:///path` and `file:/path` are in use. `None` for every other URI.
pub fn path(uri: &str) -> Option<PathBuf> {
    let (scheme, rest) = uri.split_once(':')?;
    if !scheme.eq_ignore_ascii_case("file") {
        return None;
    }
    let path = match rest.strip_prefix("//") {
        Some(with_host) => {
            let start = with_host.find('/')?;
            let (host, path) = with_host.split_at(start);
            (host.is_empty() || host.eq_ignore_ascii_case("localhost")).then_some(path)?
        }
        None => rest,
    };
    if !path.starts_with('/') {
        return None;
    }
    String::from_utf8(decode(path)?).ok().map(PathBuf::from)
}

fn decode(text: &str) -> Option<Vec<u8>> {
    let mut decoded = Vec::with_capacity(text.len());
    let mut bytes = text.bytes();
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let mut digit = || char::from(bytes.next()?).to_digit(16);
            decoded.push((digit()? * 16 + digit()?) as u8);
        } else {
            decoded.push(byte);
        }
    }
    Some(decoded)
}

#[cfg(test)]
mod tests {
    use super::path;
    use std::path::Path;

    #[test]
    fn both_forms_are_percent_decoded() {
        let expected = Path::new("/tmp/a b/ü");
        for uri in [
            "file:///tmp/a%20b/%C3%BC",
            "file:/tmp/a%20b/%C3%BC",
            "FILE://localhost/tmp/a%20b/%c3%bc",
        ] {
            assert_eq!(path(uri).as_deref(), Some(expected), "{uri}");
        }
    }

    #[test]
    fn anything_else_has_no_path() {
        for uri in [
            "",
            "file:",
            "file://",
            "file:relative",
            "http://x/y",
            "/tmp",
            "file:///a%2",
            "file:///a%zz",
            "file:///%ff",
        ] {
            assert_eq!(path(uri), None, "{uri}");
        }
    }
}
