//! MiniProf's `.ban` and `.whl`: lines `key=value`, an empty line, then rows by `ColumnDef`, X and Y first unless that says otherwise; the old
//! ones with `MINIPROF` in the first three lines, a heading up to an empty line, and rows; `.mpt` with sections in brackets, of which those
//! named `Profile…Points` have the rows. A line with a `"` is dropped,
//! and what stands behind the numbers of a row is not read. Lengths are in `mm`; the directions are not said.

use super::{Raw, Weighted};
use crate::error::ProfileError;

/// Millimetres.
const UNIT: f64 = 1e-3;

/// Whether the file is an `.mpt`, whose sections may hold several profiles.
pub fn has_sections(text: &str) -> bool {
    text.trim_start().starts_with('[')
}

pub fn read(text: &str, name: &str, part: Option<usize>) -> Result<Raw, ProfileError> {
    let refused = |line: usize, reason: String| ProfileError::Content {
        name: name.to_owned(),
        format: "MiniProf",
        line,
        reason,
    };
    let rows = if has_sections(text) {
        section(text, part).map_err(|reason| refused(0, reason))?
    } else {
        let is_old = text.lines().take(3).any(|line| line.starts_with("MINIPROF"));
        // A heading of old files has numbers, too.
        let lines = (1..).zip(text.lines());
        lines
            .skip_while(|(_, line)| is_old && !line.trim().is_empty())
            .collect()
    };
    let mut columns = [0, 1];
    let mut points = Vec::new();
    for (line, content) in rows {
        let content = content.split(['%', '!']).next().unwrap_or_default().trim();
        if content.is_empty() || content.contains('"') || content.starts_with('#') {
            continue;
        }
        if let Some((key, value)) = content.split_once('=') {
            if key.trim().eq_ignore_ascii_case("ColumnDef") {
                let names: Vec<_> = value.split(',').map(|name| name.trim().to_ascii_uppercase()).collect();
                let place = |wanted: &str| names.iter().position(|name| name == wanted);
                let (Some(x), Some(y)) = (place("X"), place("Y")) else {
                    return Err(refused(line, format!("ColumnDef={value}: it has no X or no Y")));
                };
                columns = [x, y];
            }
            continue;
        }
        // People write remarks behind the numbers.
        let row: Vec<f64> = content.split_whitespace().map_while(|part| part.parse().ok()).collect();
        if row.len() > columns[0].max(columns[1]) {
            points.push(Weighted {
                place: columns.map(|column| row[column]),
                weight: 1.0,
            });
        } else if !points.is_empty() || !row.is_empty() {
            return Err(refused(line, format!("{content:?} is no row of points")));
        }
    }
    if points.is_empty() {
        return Err(refused(0, "it has no rows of points".to_owned()));
    }
    Ok(Raw {
        points,
        unit: Some(UNIT),
        ..Raw::default()
    })
}

/// Lines of the section that has the points of a profile, with their numbers: the one of a number, or the only one.
fn section(text: &str, part: Option<usize>) -> Result<Vec<(usize, &str)>, String> {
    let mut sections: Vec<(&str, Vec<(usize, &str)>)> = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let trimmed = content.trim();
        if let Some(title) = trimmed.strip_prefix('[').and_then(|title| title.strip_suffix(']')) {
            sections.push((title, Vec::new()));
        } else if let Some((_, lines)) = sections.last_mut() {
            lines.push((line, content));
        }
    }
    sections.retain(|(title, _)| title.starts_with("Profile") && title.ends_with("Points"));
    let count = sections.len();
    match part {
        None if count == 1 => Ok(sections.remove(0).1),
        None => Err(format!("it has {count} profiles; part has to say which one")),
        Some(number) => {
            let wanted = format!("Profile{number}Points");
            let found = sections.into_iter().find(|(title, _)| *title == wanted);
            found
                .map(|(_, lines)| lines)
                .ok_or_else(|| format!("part = {number}: it has {count} profiles and no section {wanted}"))
        }
    }
}
