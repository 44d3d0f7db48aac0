//! Contents of the files that hold profiles.

use super::{ContactModel, Parameters, ProfileSource};
use crate::error::{Error, ProfileError, Result};
use crate::geometry::profile::files::text_of;
use serde::{Deserialize, Serialize};
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
        if parameters.contact_model != ContactModel::Profiles {
            return Ok(ProfileContents::default());
        }
        Ok(ProfileContents {
            wheel: read("wheel_profile", &parameters.wheel_profile)?,
            rail: read("rail_profile", &parameters.rail_profile)?,
        })
    }
}

/// Text of the file that the parameter `name` names by `text`; none of a profile that is built in.
fn read(name: &'static str, text: &str) -> Result<Option<Arc<str>>> {
    let ProfileSource::File(path) = ProfileSource::of(name, text)? else {
        return Ok(None);
    };
    let content = text_of(&path).map_err(|reason: ProfileError| Error::NamedProfile {
        name,
        text: text.to_owned(),
        reason: Box::new(reason),
    })?;
    Ok(Some(content.into()))
}
