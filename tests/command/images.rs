//! Shared libraries of other platforms in as few bytes as make them readable: headers, the exported functions, a text.

use object::read::NameOrOrdinal;
use object::{File, Object};

/// The functions that the library beside the tests exports.
pub fn functions() -> Vec<String> {
    let library = std::fs::read(super::library_path()).unwrap();
    let file = File::parse(&*library).unwrap();
    let exports = file.exports().unwrap().map(|export| match export.unwrap().name() {
        // The C compilers of darwin put an underscore before a name.
        NameOrOrdinal::Name(name) => String::from_utf8_lossy(name.strip_prefix(b"_").unwrap_or(name)).into_owned(),
        NameOrOrdinal::Ordinal(number) => number.to_string(),
    });
    exports.filter(|name| name.starts_with("fmi")).collect()
}

/// A piece of a file under construction.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn u16(&mut self, values: &[u16]) {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
    }

    fn u32(&mut self, values: &[u32]) {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
    }

    fn zeros(&mut self, count: usize) {
        self.0.extend(vec![0; count]);
    }
}

/// A table of names, each ended by a zero, and where each begins.
fn strings(names: &[String], prefix: &str) -> (Vec<u8>, Vec<u32>) {
    let (mut table, mut places) = (vec![0], Vec::new());
    for name in names {
        places.push(table.len() as u32);
        table.extend(format!("{prefix}{name}\0").into_bytes());
    }
    (table, places)
}

/// A library of Windows on x86-64 with one section, the table of exports.
pub fn windows(functions: &[String], text: &str) -> Vec<u8> {
    const SECTION: u32 = 0x1000;
    const START: u32 = 0x200;
    let count = functions.len() as u32;
    let (names, places) = strings(functions, "");
    // The directory, then addresses of functions, of names, ordinals, and the names.
    let addresses = SECTION + 40;
    let name_pointers = addresses + 4 * count;
    let ordinals = name_pointers + 4 * count;
    let texts = ordinals + 2 * count;
    let mut section = Bytes::default();
    section.u32(&[0, 0, 0, texts, 1, count, count, addresses, name_pointers, ordinals]);
    functions.iter().for_each(|_| section.u32(&[SECTION + 0x8000]));
    places.iter().for_each(|place| section.u32(&[texts + place]));
    (0..count as u16).for_each(|ordinal| section.u16(&[ordinal]));
    section.0.extend(names);
    section.0.extend(text.bytes());
    let size = section.0.len() as u32;

    let mut file = Bytes(b"MZ".to_vec());
    file.zeros(58);
    file.u32(&[64]);
    // COFF: x86-64, one section, a DLL.
    file.0.extend(b"PE\0\0");
    file.u16(&[0x8664, 1]);
    file.u32(&[0, 0, 0]);
    file.u16(&[240, 0x2022]);
    // The optional header: 64 bits, no code; 16 directories, of which the first is that of the exports.
    file.u16(&[0x20b]);
    file.zeros(22);
    file.u32(&[0x8000_0000, 1, SECTION, START]);
    file.zeros(16);
    file.u32(&[SECTION + 0x9000, START]);
    file.zeros(44);
    file.u32(&[16, SECTION, size]);
    file.zeros(15 * 8);
    file.0.extend(b".edata\0\0");
    file.u32(&[0x9000, SECTION, size, START, 0, 0, 0, 0x4000_0040]);
    file.zeros(START as usize - file.0.len());
    file.0.extend(section.0);
    file.0
}

/// A library of darwin for both processors, each with nothing but a table of symbols.
pub fn darwin(functions: &[String], text: &str) -> Vec<u8> {
    let (names, places) = strings(functions, "_");
    let slice = |processor: u32| {
        let (header, symbols) = (32 + 72 + 80 + 24, 16 * places.len() as u32);
        let mut file = Bytes::default();
        // 64 bits, a dynamic library, two commands.
        file.u32(&[0xfeed_facf, processor, 3, 6, 2, 72 + 80 + 24, 0, 0]);
        // LC_SEGMENT_64 with one section, of no size.
        file.u32(&[0x19, 72 + 80]);
        file.zeros(56);
        file.u32(&[1, 0]);
        file.zeros(80);
        // LC_SYMTAB.
        file.u32(&[2, 24, header, places.len() as u32, header + symbols, names.len() as u32]);
        for place in &places {
            // Defined in the first section, external.
            file.u32(&[*place]);
            file.0.extend([0x0f, 1, 0, 0]);
            file.u32(&[0, 0]);
        }
        file.0.extend(&names);
        file.0.extend(text.bytes());
        file.0
    };
    // Big-endian: the processor, where its slice begins, its size and alignment.
    let slices = [(0x0100_0007_u32, 0x1000_u32), (0x0100_000c, 0x9000)];
    let mut file = Bytes(0xcafe_babe_u32.to_be_bytes().to_vec());
    file.0.extend(2_u32.to_be_bytes());
    for (processor, start) in slices {
        let size = slice(processor).len() as u32;
        for value in [processor, 3, start, size, 12] {
            file.0.extend(value.to_be_bytes());
        }
    }
    for (processor, start) in slices {
        file.zeros(start as usize - file.0.len());
        file.0.extend(slice(processor));
    }
    file.0
}
