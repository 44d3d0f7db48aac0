//! Contents of the files that hold profiles.

use super::{ContactModel, Parameters, ProfileSource};
use crate::error::{Error, ProfileError, Result};
use crate::geometry::profile::files::text_of;
use crate::geometry::profile::{Body, built_in};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// Contents of the files that [`Parameters::wheel_profile`] and [`Parameters::rail_profile`] name; none of a profile that is built in, and
/// none of a contact without profiles. A saved state carries them, as the files may have changed or be gone where it is restored.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProfileContents {
    /// Text of the wheel's file.
    pub wheel: Option<Arc<str>>,
    /// Text of the rail's file.
    pub rail: Option<Arc<str>>,
}

impl ProfileContents {
    /// Reads the files that the parameters name.
    ///
    /// # Errors
    /// [`Error::Text`], or [`Error::NamedProfile`] where a file cannot be read.
    pub fn read(parameters: &Parameters) -> Result<ProfileContents> {
        ProfileContents::read_after(None, parameters)
    }

    /// Reads the files that the parameters name as [`ProfileContents::read`] does, after those in a folder of resources, if there is one, have become paths: the
    /// error of a file that is not there names that folder too.
    ///
    /// # Errors
    /// As [`ProfileContents::read`].
    pub(crate) fn read_after(resources: Option<&Path>, parameters: &Parameters) -> Result<ProfileContents> {
        if parameters.contact_model != ContactModel::Profiles {
            return Ok(ProfileContents::default());
        }
        Ok(ProfileContents {
            wheel: read("wheel_profile", &parameters.wheel_profile, Body::Wheel, resources)?,
            rail: read("rail_profile", &parameters.rail_profile, Body::Rail, resources)?,
        })
    }
}

/// Text of the file that the parameter `name` names by `text`; none of a profile that is built in.
fn read(name: &'static str, text: &str, body: Body, resources: Option<&Path>) -> Result<Option<Arc<str>>> {
    let ProfileSource::File(path) = ProfileSource::of(name, text)? else {
        return Ok(None);
    };
    let content = text_of(&path).map_err(|reason| Error::NamedProfile {
        name,
        text: text.to_owned(),
        reason: Box::new(match path.try_exists() {
            Ok(false) => not_found(&path, body, resources),
            _ => reason,
        }),
    })?;
    Ok(Some(content.into()))
}

/// Error of a file that is not there: the folders it was looked for in, and the profiles that need no file.
fn not_found(path: &Path, body: Body, resources: Option<&Path>) -> ProfileError {
    let mut places = Vec::new();
    if path.is_relative() {
        let folder = resources.filter(|folder| folder.is_dir());
        places.extend(folder.map(|folder| format!("among the archive's resources, {}", folder.display())));
        places.push(match std::env::current_dir() {
            Ok(folder) => format!("in the working directory, {}", folder.display()),
            Err(_) => "in the working directory".to_owned(),
        });
    }
    let places = places.join(", or ");
    ProfileError::NotFound {
        path: path.display().to_string(),
        places: if places.is_empty() {
            places
        } else {
            format!(" {places}")
        },
        body: body.name(),
        known: built_in::names_of(body).join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One sentence says where the file was looked for, and what there is without one.
    #[test]
    fn a_file_that_is_not_there_is_told_with_the_places_it_was_looked_for_in() {
        let here = std::env::current_dir().unwrap();
        let here = format!("in the working directory, {}", here.display());
        let folder = std::env::temp_dir();
        let among = format!("among the archive's resources, {}, or ", folder.display());
        let missing = folder.join("wheelrail no folder");
        let rails = "built-in rails are 60E1, 60E2, 54E1, 49E1, UIC60";
        let wheels = "built-in wheels are S1002, cone20, cone40, UIC519A, UIC519B, UIC519H, UIC519I";
        let absolute = missing.join("nope.prr");
        let absolute = absolute.to_str().unwrap();
        for (name, text, resources, places, known) in [
            ("rail_profile", "nope.prr", None, format!(" {here}"), rails),
            (
                "wheel_profile",
                "nope.prw",
                Some(&folder),
                format!(" {among}{here}"),
                wheels,
            ),
            ("rail_profile", "nope.prr", Some(&missing), format!(" {here}"), rails),
            ("rail_profile", absolute, Some(&folder), String::new(), rails),
        ] {
            let mut parameters = Parameters {
                contact_model: ContactModel::Profiles,
                ..Parameters::default()
            };
            parameters.set_by_name(name, text).unwrap();
            let refused = ProfileContents::read_after(resources.map(|folder| &**folder), &parameters);
            let expected = format!("{name} = {text:?}: there is no file {text}{places}; {known}");
            assert_eq!(refused.unwrap_err().to_string(), expected);
        }
    }
}
