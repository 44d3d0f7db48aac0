//! Limits for the tests of what a failed step leaves behind.

use super::Settings;

/// A solver by what its error says, and how its limit is set.
pub type Limit = (&'static str, fn(&mut Settings, usize));

/// Iteration on the interface vector.
const SPLIT: Limit = ("thermo-mechanical operator split", |settings, limit| {
    settings.split.iterations = limit;
});
/// Fixed point of the heat of rail and rim.
const RIM: Limit = ("temperature of the wheel", |settings, limit| {
    settings.heat.rim_iterations = limit;
});

/// Every solver of the line engine.
pub const LIMITS: [Limit; 7] = [
    ("normal contact solver (active set)", |settings, limit| {
        settings.normal.exchanges = limit;
        settings.normal.descents_per_node = 0;
    }),
    ("normal contact solver (Pschenichnyj)", |settings, limit| {
        settings.normal.linearisations = limit;
    }),
    ("tangential Newton solver", |settings, limit| {
        settings.tangential.newton_steps = limit;
    }),
    ("coupling of normal and tangential contact", |settings, limit| {
        settings.split.iterations = limit;
    }),
    SPLIT,
    ("surface heat condition", |settings, limit| {
        settings.heat.surface_newton_steps = limit;
    }),
    RIM,
];

/// Every solver of a step of the patch engine.
pub const PATCH_LIMITS: [Limit; 4] = [
    ("normal contact solver (active set of the patch)", |settings, limit| {
        settings.patch.normal_passes = limit;
    }),
    ("tangential Newton solver", |settings, limit| {
        settings.patch.newton_steps = limit;
        settings.patch.continuation = 0;
    }),
    SPLIT,
    RIM,
];
