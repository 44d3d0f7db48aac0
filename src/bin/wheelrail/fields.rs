//! The fields at the nodes of a line contact or the cells of a patch, as a table.

use crate::table::{Error, Table, heading};
use std::path::Path;
use wheelrail::Simulation;
use wheelrail::wheel_rail::ContactNode;

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

/// An empty table.
pub fn create(path: &Path) -> Result<Table, Error> {
    Table::create(path, COLUMNS.iter().map(|(name, unit, _)| heading(name, unit)))
}

/// One row for each node, as the simulation stands.
pub fn write(table: &mut Table, simulation: &Simulation) -> Result<(), Error> {
    let ambient = simulation.state.inputs.ambient_temperature;
    for node in simulation.contact_nodes() {
        table.write(COLUMNS.iter().map(|(_, _, value)| value(&node, ambient)))?;
    }
    table.finish()
}
