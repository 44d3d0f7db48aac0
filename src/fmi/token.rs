//! The token of a model description, its GUID in FMI 2.0: a hash of it, so that a library and a description of different builds
//! refuse each other.

/// The value of the first attribute of this name, which the text must have.
pub const fn attribute<'a>(name: &str, xml: &'a str) -> &'a str {
    let (name, bytes) = (name.as_bytes(), xml.as_bytes());
    let mut start = 0;
    loop {
        let mut matched = 0;
        while matched < name.len() && bytes[start + matched] == name[matched] {
            matched += 1;
        }
        let quoted = bytes[start + matched] == b'=' && bytes[start + matched + 1] == b'"';
        if matched == name.len() && quoted && bytes[start - 1] == b' ' {
            start += matched + 2;
            break;
        }
        start += 1;
    }
    let mut end = start;
    while bytes[end] != b'"' {
        end += 1;
    }
    xml.split_at(end).0.split_at(start).1
}

/// The hash of a model description that has no token yet: FNV-1a, 128 bits (Fowler, Noll and Vo).
#[cfg(feature = "cli")]
pub fn hashed(text: &str) -> String {
    let hash = text
        .bytes()
        .fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, |hash, byte| {
            (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
        });
    let digits = format!("{hash:032x}");
    format!(
        "{{{}-{}-{}-{}-{}}}",
        &digits[..8],
        &digits[8..12],
        &digits[12..16],
        &digits[16..20],
        &digits[20..]
    )
}
