//! SIMPACK's `.prr` and `.prw`: blocks `header`, `spline` and `point`, each between `….begin` and `….end`, with options as `key = value` and
//! comments behind `!` or `%`.
//!
//! The options are applied to the points in this order: least distance along y, shift, rotation, bounds of y, limits of z, mirrors,
//! inversion of the order, unit. y points to the field side and z downward.

use super::numbers::Rows;
use super::{Lateral, Raw, Weighted};
use crate::error::ProfileError;
use crate::geometry::profile::Body;

/// Options of the spline block that change the points.
#[derive(Debug, Default)]
struct Options {
    distance: f64,
    shift: [f64; 2],
    rotate: f64,
    /// Angles in the file for each rad.
    angle: Option<f64>,
    bounds_y: [f64; 2],
    bounds_z: [f64; 2],
    mirror: [bool; 2],
    inversion: bool,
    /// Lengths in the file for each `m`.
    length: Option<f64>,
}

pub fn read(text: &str, name: &str) -> Result<Raw, ProfileError> {
    let refused = |line: usize, reason: String| ProfileError::Content {
        name: name.to_owned(),
        format: "SIMPACK",
        line,
        reason,
    };
    let (mut block, mut options, mut body) = (Vec::new(), Options::default(), None);
    let (mut points, mut rows) = (Vec::new(), Rows::default());
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.split(['!', '%']).next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        if let Some(begun) = content.strip_suffix(".begin") {
            block.push(begun.trim());
        } else if let Some(ended) = content.strip_suffix(".end") {
            if block.pop() != Some(ended.trim()) {
                return Err(refused(line, format!("{content:?} ends a block that was not begun")));
            }
        } else if block.last() == Some(&"point") {
            let row = rows.numbers(line, content).map_err(|reason| refused(line, reason))?;
            let row = row
                .filter(|row| row.len() >= 2)
                .ok_or_else(|| refused(line, format!("{content:?} is no point y z")))?;
            let weight = row.get(2).copied().filter(|&weight| weight > 0.0).unwrap_or(1.0);
            points.push(Weighted {
                place: [row[0], row[1]],
                weight,
            });
        } else if let Some((key, value)) = content.split_once('=') {
            match block.last() {
                Some(&"header") if key.trim() == "type" => {
                    body = Some(match value.trim() {
                        "0" => Body::Rail,
                        "1" => Body::Wheel,
                        other => {
                            return Err(refused(
                                line,
                                format!("type = {other}: allowed is 0 (rail) or 1 (wheel)"),
                            ));
                        }
                    });
                }
                Some(&"spline") => {
                    let set = options.set(key.trim(), value.trim());
                    set.map_err(|reason| refused(line, reason))?;
                }
                _ => {}
            }
        } else {
            return Err(refused(
                line,
                format!("{content:?} is neither an option nor in the block of points"),
            ));
        }
    }
    if let Some(open) = block.last() {
        let inside = match *open {
            "point" => "the block of points".to_owned(),
            other => format!("the block {other}"),
        };
        return Err(refused(
            0,
            format!("it ends within {inside}, before {open}.end: the file is cut off"),
        ));
    }
    if points.is_empty() {
        return Err(refused(
            0,
            "it has no points, between point.begin and point.end".to_owned(),
        ));
    }
    let unit = options.length.map(|length| 1.0 / length);
    Ok(Raw {
        points: options.applied(points),
        body,
        unit,
        y_to: Some(Lateral::ToField),
        z_up: Some(false),
    })
}

impl Options {
    /// Takes an option; those that do not change the points are passed over.
    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let place = match key {
            "point.dist.min" => &mut self.distance,
            "shift.y" => &mut self.shift[0],
            "shift.z" => &mut self.shift[1],
            "rotate" => &mut self.rotate,
            "units.ang.f" => self.angle.insert(0.0),
            "bound.y.min" => &mut self.bounds_y[0],
            "bound.y.max" => &mut self.bounds_y[1],
            "bound.z.min" => &mut self.bounds_z[0],
            "bound.z.max" => &mut self.bounds_z[1],
            "units.len.f" => self.length.insert(0.0),
            "mirror.y" | "mirror.z" | "inversion" => {
                let on = match value {
                    "0" => false,
                    "1" => true,
                    _ => return Err(format!("{key} = {value}: allowed is 0 or 1")),
                };
                match key {
                    "mirror.y" => self.mirror[0] = on,
                    "mirror.z" => self.mirror[1] = on,
                    _ => self.inversion = on,
                }
                return Ok(());
            }
            _ => return Ok(()),
        };
        let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
        *place = number.ok_or_else(|| format!("{key} = {value}: a finite number is needed"))?;
        if key.starts_with("units.") && *place <= 0.0 {
            return Err(format!("{key} = {value}: a positive number is needed"));
        }
        Ok(())
    }

    fn applied(&self, mut points: Vec<Weighted>) -> Vec<Weighted> {
        if self.distance > 0.0 {
            let mut last = f64::NAN;
            points.retain(|point| {
                let kept = last.is_nan() || (point.place[0] - last).abs() > self.distance;
                if kept {
                    last = point.place[0];
                }
                kept
            });
        }
        let (sine, cosine) = (self.rotate / self.angle.unwrap_or(1.0)).sin_cos();
        for Weighted { place, .. } in &mut points {
            let [y, z] = [place[0] + self.shift[0], place[1] + self.shift[1]];
            *place = [cosine * y - sine * z, sine * y + cosine * z];
        }
        let [first, last] = self.bounds_y;
        if first < last {
            points.retain(|point| (first..=last).contains(&point.place[0]));
        }
        let [low, high] = self.bounds_z;
        for Weighted { place, .. } in &mut points {
            if low < high {
                place[1] = place[1].clamp(low, high);
            }
            for (value, mirror) in place.iter_mut().zip(self.mirror) {
                if mirror {
                    *value = -*value;
                }
            }
        }
        if self.inversion {
            points.reverse();
        }
        points
    }
}
