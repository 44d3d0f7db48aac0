//! VAMPIRE's `.rai` and `.whe`: `WHEELPROFILE` or `RAILPROFILE`, a title, the tread datum or the gauge point, the distance of the flange backs
//! or the gauge, then rows y z of the left and y z of the right one, from the track's middle outwards, in `mm`. z points upward on
//! rails, and downward on wheels.

use super::numbers::Rows;
use super::{Lateral, Raw, Weighted};
use crate::error::ProfileError;
use crate::geometry::profile::Body;

/// Distance of the running circle from the flange's back by the tread datum's name, `mm`: inches in the United States.
const DATUMS: [(&str, f64); 3] = [
    ("EUROPEAN", 70.0),
    ("US1", (2.0 + 27.0 / 32.0) * 25.4),
    ("US2", (3.0 + 1.0 / 16.0) * 25.4),
];

pub fn read(text: &str, name: &str, part: Option<usize>) -> Result<Raw, ProfileError> {
    let refused = |line: usize, reason: String| ProfileError::Content {
        name: name.to_owned(),
        format: "VAMPIRE",
        line,
        reason,
    };
    let mut lines = (1..).zip(text.lines()).map(|(line, content)| {
        let content = content.split(['"', '!', '%']).next().unwrap_or_default();
        (line, content.trim())
    });
    let lines = &mut lines;
    let heading = lines
        .find(|(_, content)| !content.is_empty())
        .map(|(_, content)| content);
    let body = match heading {
        Some("WHEELPROFILE") => Body::Wheel,
        Some("RAILPROFILE") => Body::Rail,
        _ => {
            return Err(refused(
                1,
                "it begins neither with WHEELPROFILE nor with RAILPROFILE".to_owned(),
            ));
        }
    };
    // The title.
    lines.next();
    let datum = match (body, lines.next()) {
        (Body::Wheel, Some((line, content))) => {
            let back = datum(content).ok_or_else(|| {
                refused(
                    line,
                    format!("{content:?}: TREADDATUM EUROPEAN, US1, US2 or CUSTOM and a number is needed"),
                )
            })?;
            let (line, content) = lines.next().unwrap_or((line, ""));
            let distance = last_number(content).filter(|_| content.starts_with("FLANGEBACK"));
            let distance =
                distance.ok_or_else(|| refused(line, format!("{content:?}: FLANGEBACK and a number is needed")))?;
            0.5 * distance + back
        }
        (Body::Rail, Some((line, content))) if content.starts_with("GAUGEPOINT") => match lines.next() {
            Some((_, content)) if content.starts_with("GAUGE") => 0.0,
            _ => return Err(refused(line + 1, "GAUGE and a number is needed".to_owned())),
        },
        (_, other) => {
            let (line, content) = other.unwrap_or((3, ""));
            return Err(refused(line, format!("{content:?}: GAUGEPOINT is needed")));
        }
    };
    let right = match part {
        None | Some(2) => true,
        Some(1) => false,
        Some(other) => return Err(refused(0, format!("part = {other}: allowed is 1 (left) or 2 (right)"))),
    };
    let (mut points, mut rows) = (Vec::new(), Rows::default());
    for (line, content) in lines.filter(|(_, content)| !content.is_empty()) {
        let row = rows.numbers(line, content).map_err(|reason| refused(line, reason))?;
        let row = row
            .filter(|row| row.len() >= 4)
            .ok_or_else(|| refused(line, format!("{content:?} is no row y z y z")))?;
        let [y, z] = if right { [row[2], row[3]] } else { [-row[0], row[1]] };
        points.push(Weighted {
            place: [y - datum, z],
            weight: 1.0,
        });
    }
    if points.is_empty() {
        return Err(refused(0, "it has no rows of points".to_owned()));
    }
    Ok(Raw {
        points,
        body: Some(body),
        unit: Some(1e-3),
        y_to: Some(Lateral::ToField),
        z_up: Some(body == Body::Rail),
    })
}

/// Distance of the running circle from the flange's back, `mm`.
fn datum(content: &str) -> Option<f64> {
    let rest = content.strip_prefix("TREADDATUM")?.trim();
    let known = DATUMS
        .iter()
        .find(|(name, _)| rest == *name)
        .map(|(_, distance)| *distance);
    known.or_else(|| last_number(rest).filter(|_| rest.starts_with("CUSTOM")))
}

fn last_number(content: &str) -> Option<f64> {
    content.split_whitespace().next_back()?.parse().ok()
}
