//! Tables of y and z: the first two numbers of each row, separated by commas, semicolons, tabs or blanks, below an optional line of headings.
//! Comments begin with `#`, `!` or `%`. Headings may have a unit, `y [mm],z [mm]`, the same for both.

use super::{LengthUnit, Raw, Weighted, numbers};
use crate::error::ProfileError;

pub fn read(text: &str, name: &str) -> Result<Raw, ProfileError> {
    let refused = |line: usize, reason: String| ProfileError::Content {
        name: name.to_owned(),
        format: "columns",
        line,
        reason,
    };
    let (mut points, mut unit, mut headed) = (Vec::new(), None, false);
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.trim_start_matches('\u{feff}').split(['#', '!', '%']).next();
        let content = content.unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        match numbers(content) {
            Some(row) if row.len() >= 2 => points.push(Weighted {
                place: [row[0], row[1]],
                weight: 1.0,
            }),
            None if points.is_empty() && !headed => {
                headed = true;
                unit = heading_unit(content).map_err(|reason| refused(line, reason))?;
            }
            _ => return Err(refused(line, format!("{content:?} is no row of two numbers"))),
        }
    }
    if points.is_empty() {
        return Err(refused(0, "it has no rows of two numbers".to_owned()));
    }
    Ok(Raw {
        points,
        unit: unit.map(LengthUnit::metres),
        ..Raw::default()
    })
}

/// Unit of the first two headings, where they have one.
fn heading_unit(content: &str) -> Result<Option<LengthUnit>, String> {
    let mut units = content
        .split('[')
        .skip(1)
        .take(2)
        .map(|rest| rest.split(']').next().unwrap_or_default().trim());
    let (Some(first), second) = (units.next(), units.next()) else {
        return Ok(None);
    };
    if second.is_some_and(|second| second != first) {
        return Err(format!("{content:?}: the columns have different units"));
    }
    let unit = LengthUnit::named(first);
    unit.map(Some)
        .ok_or_else(|| format!("[{first}]: allowed is m, mm or in"))
}
