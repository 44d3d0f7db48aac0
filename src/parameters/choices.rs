//! The choices among the parameters. In FMI 2.0 each is an Integer, numbered from 1 in the order of its values here; in FMI 3.0
//! an Enumeration of their names.

use serde::{Deserialize, Serialize};

/// Declares a choice with the list of its values.
macro_rules! choices {
    ($($(#[$about:meta])* $name:ident { $($(#[$meaning:meta])* $value:ident $value_name:literal,)+ })+) => {$(
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        pub enum $name {
            $($(#[$meaning])* $value,)+
        }

        impl $name {
            /// All values, in the order of their numbers.
            pub const ALL: &'static [$name] = &[$($name::$value),+];
            /// Names of the choices, in the same order.
            pub const NAMES: &'static [&'static str] = &[$($value_name),+];
        }
    )+};
}

choices! {
    /// Resolution of the contact.
    ContactModel {
        /// Line contact along the rail, uniform over `contact_width`: the paper's.
        Line "line",
        /// Patch along the rail and across it: lateral force and spin moment.
        Patch "patch",
        /// Profiles of wheel and rail: contacts wherever they touch, from the wheelset's position and motion.
        Profiles "profiles",
    }

    /// Quantity prescribed in the normal direction.
    Control {
        /// The normal load is given, the penetration follows (the component's normal use).
        Load "load",
        /// The penetration is given, the load follows (the paper's case).
        Penetration "penetration",
        /// The height of the wheelset over profiles is given, or at each instant the penetration of a patch; the load follows: how a
        /// multibody code couples.
        Height "height",
    }

    /// Pair of inputs that defines the motion.
    SlipSource {
        /// Wheel speed and creepage: V = ω r₀ / (1 + ξ).
        Creepage "creepage",
        /// Wheel speed and vehicle speed.
        VehicleSpeed "vehicle_speed",
    }

    /// Method for the normal contact problem (37).
    NormalSolver {
        /// Primal–dual active set (semismooth Newton).
        ActiveSet "active_set",
        /// The paper's Pschenichnyj linearisation method.
        Pschenichnyj "pschenichnyj",
    }

    /// Triangulation of the rail.
    MeshKind {
        /// `contact_nodes` evenly spaced nodes under the wheel, graded outside.
        Graded "graded",
        /// The paper's 12 × 8 cells: 192 triangles, 13 surface nodes.
        Paper "paper",
    }

    /// The friction law μ(θ).
    FrictionLaw {
        /// μ₀ at every temperature.
        Constant "constant",
        /// Linear between (θ₀, μ₀) and (θ_F, μ_F), constant outside: (12)–(13).
        PiecewiseLinear "piecewise_linear",
        /// Follows the flow stress of rail steel.
        FlowStress "flow_stress",
        /// Linear between the points of a table, constant outside.
        Table "table",
    }

    /// Material of the wheel.
    Wheel {
        /// Rigid: the paper's. On an elastic rail it pulls at creepage 0.
        Rigid "rigid",
        /// Elastic, the default: its compliance adds to the rail's (`body::pair`). Of the rail's material it rolls freely at
        /// creepage 0.
        Elastic "elastic",
    }

    /// Law of the rail's wear.
    WearLaw {
        /// k |s| p with one coefficient k, (11).
        Archard "archard",
        /// Archard's law with a coefficient that depends on slip speed and pressure: the map of KTH (Jendel, Wear 253 (2002) 89).
        ArchardMap "archard_map",
        /// The loss of mass over the work per area and distance rolled: that of the University of Sheffield (Braghin, Lewis, Dwyer-Joyce and Bruni,
        /// Wear 261 (2006) 1253).
        Energy "energy",
    }

    /// Law of the wheel's wear.
    WheelWearLaw {
        /// k_w |s| p with the wheel's own coefficient.
        Coefficient "coefficient",
        /// The law of the rail's wear, with the same parameters: the wheel loses at a point what the rail loses there.
        WearLaw "wear_law",
    }

    /// Whether a profile wears.
    ProfileWear {
        /// The body stays new.
        Off "off",
        /// The body's profile loses what the contact wears off it.
        On "on",
    }

    /// Geometry of a patch.
    PatchGeometry {
        /// The parameters': constant.
        Parameters "parameters",
        /// The inputs' at each instant, for a vehicle code that searches the contacts itself.
        Inputs "inputs",
    }

    /// Side of the track.
    Side {
        /// The left one in the direction of x.
        Left "left",
        /// The right one.
        Right "right",
    }

    /// Whether the contact warms the wheel.
    WheelHeating {
        /// The wheel stays at the ambient temperature: the paper's.
        Off "off",
        /// The contact warms the wheel's rim.
        On "on",
    }
}
