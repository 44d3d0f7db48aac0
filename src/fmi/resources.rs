//! The resources of the archive: a profile may be a file among them.

use crate::parameters::{ContactModel, Parameters, ProfileSource, TEXT_PARAMETERS};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The folder of the resources, where the importer has said where it is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Resources {
    folder: Option<PathBuf>,
}

impl Resources {
    /// Resources in a folder.
    pub fn new(folder: Option<PathBuf>) -> Resources {
        Resources { folder }
    }

    /// The folder, where the importer has said where it is.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The parameters as the model takes them: the name of a profile that is a file among the resources becomes its path. Profiles
    /// that are built in go before them, and only where there are profiles is any file looked for.
    pub fn located<'a>(&self, parameters: &'a Parameters) -> Cow<'a, Parameters> {
        let mut located = Cow::Borrowed(parameters);
        let (Some(folder), ContactModel::Profiles) = (&self.folder, parameters.contact_model) else {
            return located;
        };
        for row in TEXT_PARAMETERS {
            if let Some(path) = found(folder, row.name, (row.get)(parameters)) {
                (row.set)(located.to_mut(), path);
            }
        }
        located
    }
}

/// The path of the file among the resources that a text names.
fn found(folder: &Path, name: &'static str, text: &str) -> Option<String> {
    match ProfileSource::of(name, text) {
        Ok(ProfileSource::File(path)) if path.is_relative() => {
            let path = folder.join(path);
            let text = path.is_file().then(|| path.to_str().map(str::to_owned))?;
            text.filter(|text| crate::parameters::check_text(name, text).is_ok())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_name_among_the_resources_becomes_its_path() {
        let folder = std::env::temp_dir().join(format!("wheelrail_resources_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for name in ["räil 1.prr", "60E1"] {
            fs::write(folder.join(name), "a profile").unwrap();
        }
        let resources = Resources::new(Some(folder.clone()));
        let parameters = |rail: &str, contact_model| Parameters {
            rail_profile: rail.to_owned(),
            contact_model,
            ..Parameters::default()
        };
        let own = parameters("räil 1.prr", ContactModel::Profiles);
        let path = folder.join("räil 1.prr");
        let located = resources.located(&own);
        assert_eq!(located.rail_profile, path.to_str().unwrap());
        assert_eq!(located.wheel_profile, "S1002");
        assert_eq!(*Resources::default().located(&own), own);
        // One that is built in, one that is not there, an absolute path, and where there are no profiles.
        let elsewhere = path.to_str().unwrap();
        for (rail, contact_model) in [
            ("60E1", ContactModel::Profiles),
            ("rail 2.prr", ContactModel::Profiles),
            (elsewhere, ContactModel::Profiles),
            ("räil 1.prr", ContactModel::Patch),
        ] {
            let own = parameters(rail, contact_model);
            assert!(matches!(resources.located(&own), Cow::Borrowed(_)), "{rail}");
        }
        fs::remove_dir_all(folder).unwrap();
    }
}
