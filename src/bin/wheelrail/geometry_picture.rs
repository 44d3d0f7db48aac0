//! Picture of the contact geometry: rails and wheels where they touch, above the difference of the rolling radii, the equivalent conicity and
//! the places of the contacts.

use crate::geometry::{Error, SIDES};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::ops::Range;
use std::path::Path;
use wheelrail::contact_geometry::{Pose, Wheelset};

/// Size of the picture, pixels.
const SIZE: (u32, u32) = (1080, 720);
/// Heights that the upper row shows about the rails' tops, `mm`.
const HEIGHTS: Range<f64> = -55.0..30.0;
/// Range of y in the upper row over that of the heights, so that both have one scale: that of the panels' pixels.
const ASPECT: f64 = 464.0 / 277.0;
/// Margin about the values of an axis, over their range.
const MARGIN: f64 = 0.05;
/// Least margin, `mm` or 1: values may all be the same.
const LEAST_MARGIN: f64 = 1e-3;
/// Change of a contact's place from one displacement to the next that is a jump, `mm`: a line over it would be drawn where no contact is.
const JUMP: f64 = 1.0;

const CONICITY: &str = "equivalent conicity [1]";
/// Colours that people with other colour vision tell apart too (Okabe and Ito).
const BLUE_LINE: RGBColor = RGBColor(0, 114, 178);
const COLOURS: [RGBColor; 4] = [
    RGBColor(213, 94, 0),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(86, 180, 233),
];

/// Lines of a panel, each with its colour and its name in the legend.
type Lines = Vec<(Vec<(f64, f64)>, RGBColor, &'static str)>;

/// Poses of a sweep and their equivalent conicities.
type Swept<'a> = (&'a [Pose], &'a [Option<f64>]);

/// Refuses the name of a file that would say another kind of picture.
///
/// # Errors
/// [`Error::PictureName`].
pub fn check_name(path: &Path) -> Result<(), Error> {
    let is_svg = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    is_svg
        .then_some(())
        .ok_or_else(|| Error::PictureName { path: path.to_owned() })
}

/// Writes the picture of a sweep as SVG, with the profiles at one pose.
///
/// # Errors
/// A file that cannot be written.
pub fn write(path: &Path, wheelset: &Wheelset, at: &Pose, swept: Swept) -> Result<(), Error> {
    let mut text = String::new();
    draw(&mut text, wheelset, at, swept)
        .and_then(|()| Ok(std::fs::write(path, text)?))
        .map_err(|error| Error::Picture {
            path: path.to_owned(),
            reason: error.to_string(),
        })
}

fn draw(
    text: &mut String,
    wheelset: &Wheelset,
    at: &Pose,
    (poses, conicities): Swept,
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (upper, lower) = root.split_vertically(SIZE.1 / 2);
    for (side, area) in upper.split_evenly((1, 2)).iter().enumerate() {
        let bodies = [("rail", BLACK), ("wheel", BLUE_LINE)];
        let outlines = wheelset.outlines(at, side);
        // y to the left, as it is seen in the direction of travel.
        let lines = bodies.into_iter().zip(outlines).map(|((name, colour), points)| {
            let points = points.into_iter().map(|[y, z]| (1e3 * y, 1e3 * z));
            (points.filter(|(_, z)| HEIGHTS.contains(z)).collect(), colour, name)
        });
        let title = format!("{}, {:.2} mm to the left", SIDES[side], 1e3 * at.lateral);
        let lines: Lines = lines.collect();
        let Range { start, end } = range(&lines, |point| point.0);
        let (middle, half) = (0.5 * (start + end), 0.5 * ASPECT * (HEIGHTS.end - HEIGHTS.start));
        let y = middle + half..middle - half;
        panel(area, [&title, "y [mm]", "z [mm]"], y, HEIGHTS, &lines)?;
    }
    let lateral = |pose: &Pose| 1e3 * pose.lateral;
    let radii = poses
        .iter()
        .map(|pose| (lateral(pose), 1e3 * pose.radius_difference()))
        .collect();
    let amplitudes = poses.iter().zip(conicities).filter(|(pose, _)| pose.lateral > 0.0);
    let conicities = amplitudes
        .filter_map(|(pose, conicity)| Some((lateral(pose), (*conicity)?)))
        .collect();
    let names = ["left wheel", "left rail", "right wheel", "right rail"];
    let mut places: Lines = Vec::new();
    for (number, (name, colour)) in names.into_iter().zip(COLOURS).enumerate() {
        let place = |pose: &Pose| {
            let touch = &pose.touches[number / 2];
            1e3 * if number % 2 == 0 { touch.on_wheel } else { touch.on_rail }
        };
        let mut name = name;
        for run in poses.chunk_by(|a, b| (place(a) - place(b)).abs() <= JUMP) {
            let points = run.iter().map(|pose| (lateral(pose), place(pose)));
            places.push((points.collect(), colour, name));
            name = "";
        }
    }
    let areas = lower.split_evenly((1, 3));
    let lower: [([&str; 3], Lines); 3] = [
        (
            ["", "lateral displacement [mm]", "difference of rolling radii [mm]"],
            vec![(radii, BLACK, "")],
        ),
        (["", "amplitude [mm]", CONICITY], vec![(conicities, BLUE_LINE, "")]),
        (["", "lateral displacement [mm]", "contact [mm]"], places),
    ];
    for (area, (labels, lines)) in areas.iter().zip(&lower) {
        let across = range(lines, |point| point.0);
        let mut up = range(lines, |point| point.1);
        if labels[2] == CONICITY {
            up.start = 0.0;
        }
        panel(area, *labels, across, up, lines)?;
    }
    root.present()?;
    Ok(())
}

/// Range of the values of lines with a margin; 0 to 1 where there are none.
fn range(lines: &Lines, value: impl Fn(&(f64, f64)) -> f64) -> Range<f64> {
    let values = lines.iter().flat_map(|line| line.0.iter().map(&value));
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    if low > high {
        return 0.0..1.0;
    }
    let margin = (MARGIN * (high - low)).max(LEAST_MARGIN);
    low - margin..high + margin
}

/// Draws the axes of a panel with a title and labels, and its lines.
fn panel<'a>(
    area: &DrawingArea<SVGBackend<'a>, Shift>,
    [title, along, up]: [&str; 3],
    x: Range<f64>,
    y: Range<f64>,
    lines: &Lines,
) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>> {
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(title, ("sans-serif", 16))
        .x_label_area_size(36)
        .y_label_area_size(52)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc(along)
        .y_desc(up)
        .x_labels(7)
        .y_labels(7)
        .draw()?;
    let mut is_named = false;
    for (points, colour, name) in lines {
        let drawn = chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
        if !name.is_empty() {
            is_named = true;
            let colour = *colour;
            drawn
                .label(*name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        }
    }
    if is_named {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerMiddle)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
    }
    Ok(())
}
