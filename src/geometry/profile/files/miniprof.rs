//! MiniProf's `.ban` and `.whl`: lines `key=value`, an empty line, then rows by `ColumnDef`, X and Y first unless that says otherwise; the old
//! ones with `MINIPROF` in the first three lines, a heading up to an empty line, and rows; `.mpt` with sections in brackets, of which those
//! named `Profile…Points` have the rows, and those named `Profile…Info` what else is said of them. A line with a `"` is dropped,
//! and what stands behind the numbers of a row is not read. Where there are fewer rows than `XYPoints` says, those that were dropped
//! included, the file is cut off; rows that somebody has added by hand are read. Lengths are in `mm`; the directions are not said.

use super::{Raw, Weighted};
use crate::error::ProfileError;

/// Millimetres.
const UNIT: f64 = 1e-3;
/// Key of the number of rows.
const COUNT: &str = "XYPoints";

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
    let mut said = None;
    let rows = if has_sections(text) {
        let (info, rows) = section(text, part).map_err(|reason| refused(0, reason))?;
        for (line, content) in info {
            if let Some((key, value)) = content.split_once('=')
                && key.trim().eq_ignore_ascii_case(COUNT)
            {
                said = count(value).map_err(|reason| refused(line, reason))?;
            }
        }
        rows
    } else {
        let is_old = text.lines().take(3).any(|line| line.starts_with("MINIPROF"));
        // A heading of old files has numbers, too.
        let lines = (1..).zip(text.lines());
        lines
            .skip_while(|(_, line)| is_old && !line.trim().is_empty())
            .collect()
    };
    let mut columns = [0, 1];
    let (mut points, mut dropped) = (Vec::new(), 0);
    for (line, content) in rows {
        let content = content.split(['%', '!']).next().unwrap_or_default().trim();
        if content.contains('"') {
            dropped += usize::from(is_row(content));
            continue;
        }
        if content.is_empty() || content.starts_with('#') {
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
            } else if key.trim().eq_ignore_ascii_case(COUNT) {
                said = count(value).map_err(|reason| refused(line, reason))?;
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
    let found = points.len() + dropped;
    if let Some(said) = said.filter(|&said| said > found) {
        return Err(refused(
            0,
            format!("{COUNT}={said}, and it has {found} rows of points: the file is cut off"),
        ));
    }
    Ok(Raw {
        points,
        unit: Some(UNIT),
        ..Raw::default()
    })
}

/// Number of rows that a file says it has; none where it leaves that blank.
fn count(value: &str) -> Result<Option<usize>, String> {
    let value = value.trim();
    if value.is_empty() {
        return Ok(None);
    }
    let count = value.parse().map(Some);
    count.map_err(|_| format!("{COUNT}={value}: a number of rows is needed"))
}

/// Whether a line that is dropped is a row of points.
fn is_row(content: &str) -> bool {
    let numbers = content.replace('"', " ");
    let mut numbers = numbers.split_whitespace().map(str::parse::<f64>);
    numbers.next().is_some_and(|first| first.is_ok()) && numbers.next().is_some_and(|second| second.is_ok())
}

/// Lines with their numbers, counted from 1.
type Lines<'a> = Vec<(usize, &'a str)>;

/// Lines of the sections that describe a profile and that have its points: of the profile of a number, or of the only one.
fn section(text: &str, part: Option<usize>) -> Result<(Lines<'_>, Lines<'_>), String> {
    let mut sections: Vec<(&str, Lines)> = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let trimmed = content.trim();
        if let Some(title) = trimmed.strip_prefix('[').and_then(|title| title.strip_suffix(']')) {
            sections.push((title, Vec::new()));
        } else if let Some((_, lines)) = sections.last_mut() {
            lines.push((line, content));
        }
    }
    let named = |(title, _): &(&str, Lines)| Some(title.strip_prefix("Profile")?.strip_suffix("Points")?.to_owned());
    let profiles: Vec<String> = sections.iter().filter_map(named).collect();
    let count = profiles.len();
    let number = match (part, &profiles[..]) {
        (None, [only]) => only.clone(),
        (None, _) => return Err(format!("it has {count} profiles; part has to say which one")),
        (Some(number), _) => number.to_string(),
    };
    let mut lines = |wanted: &str| {
        let found = sections.iter().position(|(title, _)| *title == wanted);
        found.map(|section| sections.swap_remove(section).1)
    };
    let info = lines(&format!("Profile{number}Info")).unwrap_or_default();
    let wanted = format!("Profile{number}Points");
    let rows =
        lines(&wanted).ok_or_else(|| format!("part = {number}: it has {count} profiles and no section {wanted}"))?;
    Ok((info, rows))
}
