//! Archard wear (11), (24) with storage: ∂W/∂t − V ∂W/∂x₁ = k |s| p, the march of the heat without conduction.

use crate::transport::Upwind;

/// One implicit time step: the wear depth `after` at all columns, `m`, from `before`, under the wear rate
/// k |s| p at the contact nodes `m/s`, the first of which is the column `first_contact`. The inflow column of `after`
/// holds what enters.
pub fn advance(
    transport: &Upwind,
    duration: f64,
    first_contact: usize,
    rate: &[f64],
    before: &[f64],
    after: &mut [f64],
) {
    let storage = 1.0 / duration;
    let mut upstream = after[transport.inflow()];
    for column in transport.columns() {
        let advection = transport.speed() / column.spacing;
        let contact = column.index.wrapping_sub(first_contact);
        let worn = rate.get(contact).copied().unwrap_or(0.0);
        // The depth upstream enters last: columns wait for each other there, and all the rest can be computed meanwhile.
        let inverse = 1.0 / (storage + advection);
        let own = (storage * before[column.index] + worn) * inverse;
        upstream = own + advection * inverse * upstream;
        after[column.index] = upstream;
    }
}

/// The change of [`advance`]'s result `after` with that of the wear rate, `rate_change`, and of the speed |V|,
/// `speed_change`. The inflow column of `tangent` holds the change of what enters.
pub fn advance_tangent(
    transport: &Upwind,
    duration: f64,
    first_contact: usize,
    (rate_change, speed_change): (&[f64], f64),
    after: &[f64],
    tangent: &mut [f64],
) {
    let storage = 1.0 / duration;
    for column in transport.columns() {
        let advection = transport.speed() / column.spacing;
        let contact = column.index.wrapping_sub(first_contact);
        let worn = rate_change.get(contact).copied().unwrap_or(0.0);
        let carried = speed_change / column.spacing * (after[column.upstream] - after[column.index]);
        tangent[column.index] = (advection * tangent[column.upstream] + carried + worn) / (storage + advection);
    }
}
