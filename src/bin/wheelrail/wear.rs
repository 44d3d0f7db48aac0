//! Wear of the profiles, as a table.

use crate::table::{Error, Table, heading};
use std::path::Path;
use wheelrail::wheel_rail::ProfileDepths;

/// Columns of either body; y and z are those in the track.
const COLUMNS: [&str; 5] = ["position", "arc_length", "depth", "y", "z"];

/// Writes a row for each place of the profiles; there are as many of either body.
pub fn write(path: &Path, depths: &ProfileDepths) -> Result<(), Error> {
    let names = ["wheel", "rail"]
        .into_iter()
        .flat_map(|body| COLUMNS.map(|column| format!("{body}_{column}")));
    let mut table = Table::create(path, names.map(|name| heading(&name, "m")))?;
    for (wheel, rail) in depths.wheel.iter().zip(&depths.rail) {
        let values = [wheel, rail].into_iter().flat_map(|place| {
            let [y, z] = place.in_track;
            [place.position, place.arc_length, place.depth, y, z]
        });
        table.write(values)?;
    }
    table.finish()
}
