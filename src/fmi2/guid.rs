//! The GUID: a hash of the model description, so that a library and a description of different builds refuse each other.

/// The GUID of the checked-in model description: a library and a description of different builds refuse each other.
pub const GUID: &str = guid_of(include_str!("../../modelDescription/modelDescription.xml"));

/// The value of the first attribute `guid` of a model description, which must have one.
pub const fn guid_of(xml: &str) -> &str {
    const ATTRIBUTE: &[u8] = b"guid=\"";
    let bytes = xml.as_bytes();
    let mut start = 0;
    loop {
        let mut matched = 0;
        while matched < ATTRIBUTE.len() && bytes[start + matched] == ATTRIBUTE[matched] {
            matched += 1;
        }
        if matched == ATTRIBUTE.len() {
            break;
        }
        start += 1;
    }
    start += ATTRIBUTE.len();
    let mut end = start;
    while bytes[end] != b'"' {
        end += 1;
    }
    xml.split_at(end).0.split_at(start).1
}

/// The hash of a model description that has no GUID yet: FNV-1a, 128 bits (Fowler, Noll and Vo).
#[cfg(feature = "cli")]
pub(super) fn hashed(text: &str) -> String {
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
