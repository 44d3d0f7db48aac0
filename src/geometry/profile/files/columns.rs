//! Tables of y and z: the first two numbers of each row, separated by commas, semicolons, tabs or blanks, below an optional line of headings.
//! Comments begin with `#`, `!` or `%`. Headings may have a unit, `y [mm],z [mm]`, the same for both. A comma may stand for the decimal point ([`Rows`]).

use super::numbers::Rows;
use super::{LengthUnit, Raw, Weighted};
use crate::error::ProfileError;

pub fn read(text: &str, name: &str) -> Result<Raw, ProfileError> {
    let refused = |line: usize, reason: String| ProfileError::Content {
        name: name.to_owned(),
        format: "columns",
        line,
        reason,
    };
    let (mut points, mut unit, mut headings) = (Vec::new(), None, None);
    let mut rows = Rows::default();
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.split(['#', '!', '%']).next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        match rows.numbers(line, content).map_err(|reason| refused(line, reason))? {
            Some(row) if headings.is_some_and(|count| is_twice(content, row.len(), count)) => {
                return Err(refused(
                    line,
                    format!(
                        "{content:?} is {} numbers below {} headings: a comma is either the decimal point or between numbers",
                        row.len(),
                        row.len() / 2
                    ),
                ));
            }
            Some(row) if row.len() >= 2 => points.push(Weighted {
                place: [row[0], row[1]],
                weight: 1.0,
            }),
            None if points.is_empty() && headings.is_none() => {
                headings = Some(content.split(',').count());
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

/// Whether a row of whole numbers between commas has twice as many of them as there are headings between commas: decimal commas would make that, too.
fn is_twice(content: &str, numbers: usize, headings: usize) -> bool {
    let whole = |part: &str| part.trim().parse::<i64>().is_ok();
    headings > 1 && numbers == 2 * headings && content.split(',').count() == numbers && content.split(',').all(whole)
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
