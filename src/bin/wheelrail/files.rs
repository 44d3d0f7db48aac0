//! Files that the commands read and write.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Files of one command, each with the option that names it. They are checked before anything is computed or written.
#[derive(Default)]
pub struct Files {
    read: Vec<Named>,
    written: Vec<Named>,
}

/// A file, and the option or parameter that names it.
struct Named {
    option: &'static str,
    path: PathBuf,
}

/// Reason why a command cannot write one of its files.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that is read as well.
    #[error("{option} {path}: the command reads this file ({other}), which would be lost; write to another one")]
    IsRead {
        /// Option for what is written.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// Option for what is read.
        other: &'static str,
    },
    /// A file for two outputs.
    #[error("{option} {path}: {other} is written to this file as well; each needs a file of its own")]
    IsWritten {
        /// Option for the second output.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// Option for the first output.
        other: &'static str,
    },
    /// A file that cannot be written at all.
    #[error("{option} {path}: {source}")]
    Unwritable {
        /// Option for what is written.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
}

impl Files {
    /// Notes a file that the command reads, where there is one.
    pub fn reads(&mut self, option: &'static str, path: Option<&Path>) {
        self.read.extend(path.map(|path| Named::new(option, path)));
    }

    /// Notes a file that the command writes, where it is asked for.
    pub fn writes(&mut self, option: &'static str, path: Option<&Path>) {
        self.written.extend(path.map(|path| Named::new(option, path)));
    }

    /// Refuses an output that would overwrite an input or another output.
    pub fn check_apart(&self) -> Result<(), Error> {
        for (number, Named { option, path }) in self.written.iter().enumerate() {
            let (option, is_same) = (*option, |other: &&Named| are_one(path, &other.path));
            if let Some(other) = self.read.iter().find(is_same) {
                let (path, other) = (path.clone(), other.option);
                return Err(Error::IsRead { option, path, other });
            }
            if let Some(other) = self.written[..number].iter().find(is_same) {
                let (path, other) = (path.clone(), other.option);
                return Err(Error::IsWritten { option, path, other });
            }
        }
        Ok(())
    }

    /// Refuses what [`Files::check_apart`] refuses, and an output that cannot be written: a run may be long, and is not to end
    /// without its results. Every file is left as it was.
    pub fn check(&self) -> Result<(), Error> {
        self.check_apart()?;
        for Named { option, path } in &self.written {
            try_to_write(path).map_err(|source| Error::Unwritable {
                option,
                path: path.clone(),
                source,
            })?;
        }
        Ok(())
    }
}

impl Named {
    fn new(option: &'static str, path: &Path) -> Named {
        let path = path.to_owned();
        Named { option, path }
    }
}

/// A new file; where its folder is not there, the error says so.
pub fn create(path: &Path) -> io::Result<File> {
    open(path, OpenOptions::new().write(true).create(true).truncate(true))
}

fn open(path: &Path, options: &OpenOptions) -> io::Result<File> {
    options.open(path).map_err(|error| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
            let text = format!("the folder {} is not there", folder.display());
            io::Error::new(error.kind(), text)
        }
        _ => error,
    })
}

/// Opens a file for writing and leaves it as it was.
fn try_to_write(path: &Path) -> io::Result<()> {
    // Who waits at the other end of a pipe would take the trial for the end.
    if fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
        return Ok(());
    }
    // Only a file that the trial itself has made goes again; where that is not allowed, it stays, empty.
    if open(path, OpenOptions::new().write(true).create_new(true)).is_ok() {
        let _ = fs::remove_file(path);
        return Ok(());
    }
    let is_link_to_nothing = fs::symlink_metadata(path).is_ok() && fs::metadata(path).is_err();
    open(path, OpenOptions::new().append(true).create(is_link_to_nothing))?;
    if is_link_to_nothing {
        // The link stays.
        let _ = fs::canonicalize(path).and_then(fs::remove_file);
    }
    Ok(())
}

/// Whether two paths lead to one file, which need not be there yet. Devices and pipes keep nothing that could be lost: they
/// are no files here.
fn are_one(first: &Path, second: &Path) -> bool {
    if fs::metadata(first).is_ok_and(|found| !found.is_file()) {
        return false;
    }
    match (whole(first), whole(second)) {
        (Some(first), Some(second)) => first == second || are_hard_links(&first, &second),
        _ => first == second,
    }
}

/// Path without links from the root on, where its folder is there.
fn whole(path: &Path) -> Option<PathBuf> {
    fs::canonicalize(path).ok().or_else(|| {
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
    })
}

/// Whether two paths are names of one file in its file system.
#[cfg(unix)]
fn are_hard_links(first: &Path, second: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |path: &Path| fs::metadata(path).map(|found| (found.dev(), found.ino())).ok();
    number(first).is_some_and(|first| number(second) == Some(first))
}

/// Elsewhere the standard library does not tell.
#[cfg(not(unix))]
fn are_hard_links(_first: &Path, _second: &Path) -> bool {
    false
}
