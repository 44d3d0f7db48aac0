//! Files that are written.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// A new file; where its folder is not there, the error says so.
pub fn create(path: &Path) -> io::Result<File> {
    File::create(path).map_err(|error| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
            let text = format!("the folder {} is not there", folder.display());
            io::Error::new(error.kind(), text)
        }
        _ => error,
    })
}

/// Whether two paths lead to one file, which need not be there yet.
pub fn are_one(first: &Path, second: &Path) -> bool {
    let whole = |path: &Path| -> Option<PathBuf> {
        fs::canonicalize(path).ok().or_else(|| {
            let folder = match path.parent() {
                Some(folder) if !folder.as_os_str().is_empty() => folder,
                _ => Path::new("."),
            };
            Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
        })
    };
    match (whole(first), whole(second)) {
        (Some(first), Some(second)) => first == second,
        _ => first == second,
    }
}
