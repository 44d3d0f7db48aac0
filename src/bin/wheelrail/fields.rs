//! The fields at the nodes of a line contact, or the cells of a patch or of the windows of profiles, as a table.

use crate::table::{Error, Table, heading};
use std::path::Path;
use wheelrail::wheel_rail::{ContactNode, SurfaceStrip, SurfaceWindow};
use wheelrail::{ContactModel, Simulation};

/// A column: its name and unit, and its value at a node under an ambient temperature, `K`.
type Column = (&'static str, &'static str, fn(&ContactNode, f64) -> f64);

/// All columns. The shear is that on the rail, the slip that of the rail relative to the wheel.
const COLUMNS: [Column; 10] = [
    ("x", "m", |node, _| node.position),
    ("y", "m", |node, _| node.lateral_position),
    ("pressure", "Pa", |node, _| node.pressure),
    ("shear_x", "Pa", |node, _| node.shear),
    ("shear_y", "Pa", |node, _| node.lateral_shear),
    ("slip_x", "m/s", |node, _| node.slip),
    ("slip_y", "m/s", |node, _| node.lateral_slip),
    // That of a line contact has a sign, which the shear has too.
    ("saturation", "1", |node, _| node.utilisation.abs()),
    ("temperature", "K", |node, ambient| ambient + node.temperature),
    ("wear_depth", "m", |node, _| node.wear_depth),
];

/// A column that the cells of profiles have besides: its name and unit, and its value in a window at a strip.
type SurfaceColumn = (&'static str, &'static str, fn(&SurfaceWindow, &SurfaceStrip) -> f64);

/// Columns that stand before the others: the places of the cells on the unrolled surface and in the track, and their sizes.
const SURFACE_COLUMNS: [SurfaceColumn; 5] = [
    ("arc_length", "m", |_, strip| strip.arc_length),
    ("z", "m", |_, strip| strip.in_track[1]),
    ("inclination", "rad", |_, strip| strip.inclination),
    ("cell_length", "m", |window, _| window.cell_length),
    ("strip_breadth", "m", |window, _| window.strip_breadth),
];

/// Column that stands behind the others.
const FRICTION: (&str, &str) = ("friction_coefficient", "1");

/// An empty table.
pub fn create(path: &Path, contact_model: ContactModel) -> Result<Table, Error> {
    let is_surface = contact_model == ContactModel::Profiles;
    let common = COLUMNS.iter().map(|(name, unit, _)| match *name {
        // Along the arc of the rail's profile.
        "shear_y" if is_surface => heading("shear_s", unit),
        "slip_y" if is_surface => heading("slip_s", unit),
        name => heading(name, unit),
    });
    if !is_surface {
        return Table::create(path, common);
    }
    let own = SURFACE_COLUMNS.iter().map(|(name, unit, _)| heading(name, unit));
    let window = std::iter::once(heading("window", "1"));
    let friction = std::iter::once(heading(FRICTION.0, FRICTION.1));
    Table::create(path, window.chain(own).chain(common).chain(friction))
}

/// One row for each cell of each window, in the order of the contacts.
fn write_windows(table: &mut Table, windows: &[SurfaceWindow], ambient: f64) -> Result<(), Error> {
    for (number, window) in windows.iter().enumerate() {
        for (row, strip) in window.nodes.chunks(window.x.len()).zip(&window.strips) {
            for node in row {
                let own = SURFACE_COLUMNS.iter().map(|(_, _, value)| value(window, strip));
                let common = COLUMNS.iter().map(|(_, _, value)| value(node, ambient));
                let number = std::iter::once((number + 1) as f64);
                let friction = std::iter::once(node.friction_coefficient);
                table.write(number.chain(own).chain(common).chain(friction))?;
            }
        }
    }
    table.finish()
}

/// One row for each node, as the simulation stands.
pub fn write(table: &mut Table, simulation: &Simulation) -> Result<(), Error> {
    let ambient = simulation.state.inputs.ambient_temperature;
    if let Ok(windows) = simulation.surface_windows() {
        return write_windows(table, &windows, ambient);
    }
    for node in simulation.contact_nodes() {
        table.write(COLUMNS.iter().map(|(_, _, value)| value(&node, ambient)))?;
    }
    table.finish()
}
