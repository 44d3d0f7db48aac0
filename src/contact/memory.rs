//! History of friction on the paths of the rail's particles: with what it begins a step, and with what it ends.

use super::engine::OneWindow;
use super::problem::Problem;
use crate::friction::memory::Memory;
use crate::friction::path::PathLaw;

/// Begins a step with the history that the rail brings along from the step before.
pub fn begin<E: OneWindow>(problem: &Problem<E>, before: &E::Fields, now: &mut E::Fields) {
    let remembers = Memory::is_kept(problem.parameters);
    let memory = E::memory_mut(now);
    memory.remembers = remembers;
    if remembers {
        let rise = problem.operators.surface_rise(before);
        // All paths are equally long.
        let nodes = problem.operators.paths().next().map_or(1, |path| path.nodes.len());
        memory.start_from(E::memory(before), |node| {
            problem.friction_at(node / nodes).coefficient(rise[node]).0
        });
    }
}

/// Ends a step with the history that the rail takes along into the next one.
pub fn end<E: OneWindow>(problem: &Problem<E>, now: &mut E::Fields) {
    let remembers = Memory::is_kept(problem.parameters);
    E::memory_mut(now).remembers = remembers;
    let (Some(path_law), true) = (problem.path_law(), remembers) else {
        return;
    };
    let operators = problem.operators;
    let mut memory = std::mem::take(E::memory_mut(now));
    let rises = operators.surface_rise(now);
    for (strip, path) in operators.paths().enumerate() {
        let law = problem.friction_at(strip);
        for node in path.nodes.clone() {
            memory.now.static_friction[node] = law.coefficient(rises[node]).0;
        }
        let pressure = &E::pressure(now)[path.places];
        let before = memory.before.path(path.nodes.clone());
        let after = &mut memory.now;
        let touches = |node: usize| pressure[node] > 0.0;
        path_law.finalise(
            &before,
            &after.static_friction[path.nodes.clone()],
            touches,
            &mut after.friction[path.nodes],
        );
    }
    *E::memory_mut(now) = memory;
}

/// Writes the change of μ at unchanged slip into `friction`, node by node: with that of |V| by `speed` `m/s`, with that of μ(θ) in
/// `static_friction` and with that of the pressure.
pub fn tangent<E: OneWindow>(
    problem: &Problem<E>,
    law: &PathLaw,
    fields: &E::Fields,
    speed: f64,
    static_friction: &[f64],
    pressure_change: Option<&[f64]>,
    friction: &mut [f64],
) {
    let memory = E::memory(fields);
    for path in problem.operators.paths() {
        let (nodes, places) = (path.nodes, path.places);
        let pressure = &E::pressure(fields)[places.clone()];
        let changes = pressure_change.map(|changes| &changes[places]);
        let (before, now) = (memory.before.path(nodes.clone()), memory.now.path(nodes.clone()));
        law.tangent(
            (&before, &now),
            (pressure, |node| changes.map_or(0.0, |changes| changes[node])),
            (speed, &static_friction[nodes.clone()]),
            &mut friction[nodes],
        );
    }
}
