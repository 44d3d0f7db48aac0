//! The terminals: groups of variables that are connected together, as `terminalsAndIcons.xml`.
//!
//! [`terminals_and_icons`] is checked in as `modelDescription/fmi3/terminalsAndIcons.xml`.

use super::schema::{Terminal, TerminalMemberVariable, Terminals, TerminalsAndIcons};
use crate::fmi::schema::document;
use quick_xml::se::SeError;

/// Name, rule by which the members of two terminals are matched, description, members: variable and name in the terminal.
type TerminalRow = (
    &'static str,
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

/// The rail before one wheel matches the rail behind another one: their members have the same names.
const TERMINALS: [TerminalRow; 4] = [
    (
        "wheel",
        "plug",
        "The wheel's rotation, and the torque of the contact forces on it",
        &[("wheel_speed", "angular_velocity"), ("friction_torque", "torque")],
    ),
    (
        "axle",
        "bus",
        "The motion of the wheel's axle along and across the rail, and the forces between rail and wheel",
        &[
            ("vehicle_speed", "velocity"),
            ("lateral_speed", "lateral_velocity"),
            ("spin_rate", "spin_rate"),
            ("normal_load", "normal_load"),
            ("traction_force", "longitudinal_force"),
            ("lateral_force", "lateral_force"),
            ("spin_moment", "spin_moment"),
        ],
    ),
    (
        "rail_before",
        "plug",
        "The rail that enters the contact, as the wheel ahead has left it",
        &[
            ("incoming_temperature", "temperature"),
            ("incoming_wear_depth", "wear_depth"),
        ],
    ),
    (
        "rail_behind",
        "plug",
        "The rail that leaves the contact, for the wheel that follows",
        &[
            ("leaving_temperature", "temperature"),
            ("leaving_wear_depth", "wear_depth"),
        ],
    ),
];

/// The complete text of `terminalsAndIcons.xml`.
///
/// # Errors
/// What the XML serializer reports.
pub fn terminals_and_icons() -> Result<String, SeError> {
    let terminals = TERMINALS
        .iter()
        .map(|(name, matching_rule, description, members)| Terminal {
            name,
            matching_rule,
            description,
            members: members
                .iter()
                .map(|(variable_name, member_name)| TerminalMemberVariable {
                    variable_name,
                    member_name,
                    variable_kind: "signal",
                })
                .collect(),
        });
    let terminals = Terminals {
        terminals: terminals.collect(),
    };
    let content = TerminalsAndIcons {
        fmi_version: "3.0",
        terminals,
    };
    document("fmiTerminalsAndIcons", &content)
}

#[cfg(test)]
mod tests {
    use super::TERMINALS;
    use crate::fmi::variables::{Causality, variables};
    use std::collections::HashSet;

    #[test]
    fn the_members_are_inputs_and_outputs_each_under_a_name_of_its_own() {
        let table = variables();
        for (name, _, _, members) in TERMINALS {
            let names: HashSet<_> = members.iter().map(|(_, member)| member).collect();
            assert_eq!(names.len(), members.len(), "{name}");
            for (variable, _) in members {
                let row = table.iter().find(|row| row.name == *variable).expect(variable);
                assert!(
                    matches!(row.causality, Causality::Input | Causality::Output),
                    "{variable}"
                );
            }
        }
    }
}
