//! Shared libraries as `wheelrail pack` takes them: what platform each is of, and the functions of FMI that it exports.

use crate::standard::Standard;
use object::read::NameOrOrdinal;
use object::read::macho::{FatArch, MachOFatFile32};
use object::{Architecture, BinaryFormat, File, FileKind, Object, ObjectKind};
use std::collections::BTreeSet;

/// A platform that a version of FMI has a name for.
#[derive(Debug, PartialEq)]
pub struct Platform {
    /// The folder's name under binaries/.
    pub name: &'static str,
    format: BinaryFormat,
    /// A library for several processors has at least one of them.
    processors: &'static [Architecture],
}

const fn platform(name: &'static str, format: BinaryFormat, processors: &'static [Architecture]) -> Platform {
    Platform {
        name,
        format,
        processors,
    }
}

const DARWIN: &[Architecture] = &[Architecture::X86_64, Architecture::Aarch64];

/// Platforms of FMI 2.0.
const FMI2: &[Platform] = &[
    platform("darwin64", BinaryFormat::MachO, DARWIN),
    platform("linux32", BinaryFormat::Elf, &[Architecture::I386]),
    platform("linux64", BinaryFormat::Elf, &[Architecture::X86_64]),
    platform("win32", BinaryFormat::Pe, &[Architecture::I386]),
    platform("win64", BinaryFormat::Pe, &[Architecture::X86_64]),
];

/// Platforms of FMI 3.0 that there are compilers for.
const FMI3: &[Platform] = &[
    platform("aarch64-darwin", BinaryFormat::MachO, &[Architecture::Aarch64]),
    platform("aarch64-linux", BinaryFormat::Elf, &[Architecture::Aarch64]),
    platform("aarch64-windows", BinaryFormat::Pe, &[Architecture::Aarch64]),
    platform("x86-linux", BinaryFormat::Elf, &[Architecture::I386]),
    platform("x86-windows", BinaryFormat::Pe, &[Architecture::I386]),
    platform("x86_64-darwin", BinaryFormat::MachO, &[Architecture::X86_64]),
    platform("x86_64-linux", BinaryFormat::Elf, &[Architecture::X86_64]),
    platform("x86_64-windows", BinaryFormat::Pe, &[Architecture::X86_64]),
];

impl Platform {
    /// The platform of a name.
    pub fn named(standard: Standard, name: &str) -> Result<&'static Platform, String> {
        let (version, platforms) = match standard {
            Standard::Fmi2 => ("2.0", FMI2),
            Standard::Fmi3 => ("3.0", FMI3),
        };
        platforms.iter().find(|platform| platform.name == name).ok_or_else(|| {
            let names: Vec<_> = platforms.iter().map(|platform| platform.name).collect();
            format!("FMI {version} has no platform {name}: it has {}", names.join(", "))
        })
    }

    /// Extension of a shared library's name on the platform.
    pub fn extension(&self) -> &'static str {
        match self.format {
            BinaryFormat::MachO => "dylib",
            BinaryFormat::Pe => "dll",
            _ => "so",
        }
    }
}

/// Format, processors and symbols that a shared library declares.
pub struct Binary {
    format: BinaryFormat,
    processors: Vec<Architecture>,
    /// The names that begin with `fmi`, of each processor.
    functions: Vec<BTreeSet<String>>,
}

impl Binary {
    /// Reads a library of any platform; the error says what is wrong.
    pub fn read(content: &[u8]) -> object::Result<Binary> {
        let fat = FileKind::parse(content)? == FileKind::MachOFat32;
        let files: Vec<File> = if fat {
            let slices = MachOFatFile32::parse(content)?;
            let files = slices.arches().iter().map(|slice| File::parse(slice.data(content)?));
            files.collect::<Result<_, _>>()?
        } else {
            vec![File::parse(content)?]
        };
        let functions = files.iter().map(functions).collect::<object::Result<_>>()?;
        Ok(Binary {
            format: files.first().map_or(BinaryFormat::Elf, |file| file.format()),
            processors: files.iter().map(|file| file.architecture()).collect(),
            functions,
        })
    }

    /// Whether it is a library of a platform.
    pub fn is_of(&self, platform: &Platform) -> bool {
        self.format == platform.format && self.processors.iter().any(|p| platform.processors.contains(p))
    }

    /// Description of the binary as it is, for a message.
    pub fn description(&self) -> String {
        let processors: Vec<_> = self.processors.iter().map(|p| format!("{p:?}")).collect();
        format!("{:?} for {}", self.format, processors.join(" and "))
    }

    /// The functions that it exports for each of its processors.
    pub fn functions(&self) -> BTreeSet<String> {
        let mut functions = self.functions.iter();
        let first = functions.next().cloned().unwrap_or_default();
        functions.fold(first, |common, other| &common & other)
    }
}

/// The exported functions of FMI; none of what is no shared library.
fn functions(file: &File) -> object::Result<BTreeSet<String>> {
    let mut names = BTreeSet::new();
    if file.kind() == ObjectKind::Dynamic {
        for export in file.exports()? {
            if let NameOrOrdinal::Name(name) = export?.name() {
                // The C compilers of darwin put an underscore before a name.
                let name = name.strip_prefix(b"_").unwrap_or(name);
                if name.starts_with(b"fmi") {
                    names.insert(String::from_utf8_lossy(name).into_owned());
                }
            }
        }
    }
    Ok(names)
}
