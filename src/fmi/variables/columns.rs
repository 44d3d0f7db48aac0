//! Columns that are looked at: profiles, the fields of a patch, those of profiles, and their wear.

use crate::wheel_rail::{
    ContactNode, DEPTH_POINTS, PROFILE_POINTS, ProfileDepths, Profiles, STRIP_POINTS, SurfaceStrip, SurfaceWindow,
    WornPlace,
};

/// One plotted profile.
pub struct ProfileColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the values.
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Number of points.
    pub points: usize,
    /// Reads the points.
    pub values: fn(&Profiles) -> &[f64],
}

/// The profiles.
#[rustfmt::skip]
pub const PROFILES: [ProfileColumn; 13] = [
    ProfileColumn { name: "profile.x", unit: "m", display_unit: Some("mm"), nominal: 1e-2, points: PROFILE_POINTS,
        description: "Position along the rail ahead of the axle (of profiles in the strip that carries most)", values: |p| &p.x },
    ProfileColumn { name: "profile.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, points: PROFILE_POINTS,
        description: "Contact pressure", values: |p| &p.pressure },
    ProfileColumn { name: "profile.shear", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, points: PROFILE_POINTS,
        description: "Shear traction on the rail", values: |p| &p.shear },
    ProfileColumn { name: "profile.slip", unit: "m/s", display_unit: None, nominal: 1e-1, points: PROFILE_POINTS,
        description: "Slip velocity of the rail relative to the wheel", values: |p| &p.slip },
    ProfileColumn { name: "profile.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: PROFILE_POINTS,
        description: "Absolute temperature of the rail surface", values: |p| &p.temperature },
    ProfileColumn { name: "profile.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, points: PROFILE_POINTS,
        description: "Depth of wear of the rail surface", values: |p| &p.wear_depth },
    ProfileColumn { name: "depth.z", unit: "m", display_unit: Some("mm"), nominal: 1e-3, points: DEPTH_POINTS,
        description: "Depth below the hottest contact point", values: |p| &p.depth },
    ProfileColumn { name: "depth.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: DEPTH_POINTS,
        description: "Absolute temperature below the hottest contact point", values: |p| &p.depth_temperature },
    ProfileColumn { name: "strip.position", unit: "m", display_unit: Some("mm"), nominal: 1e-2, points: STRIP_POINTS,
        description: "Position across the rail to the left (of profiles from the track's middle, in the window that carries most)", values: |p| &p.strips.position },
    ProfileColumn { name: "strip.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, points: STRIP_POINTS,
        description: "Largest contact pressure along the strip", values: |p| &p.strips.pressure },
    ProfileColumn { name: "strip.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: STRIP_POINTS,
        description: "Largest absolute temperature of the rail surface along the strip", values: |p| &p.strips.temperature },
    ProfileColumn { name: "strip.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, points: STRIP_POINTS,
        description: "Depth of wear of the strip behind the contact", values: |p| &p.strips.wear_depth },
    ProfileColumn { name: "strip.friction_power", unit: "W/m", display_unit: Some("kW/m"), nominal: 1e6, points: STRIP_POINTS,
        description: "Power dissipated by friction in the strip per width", values: |p| &p.strips.friction_power },
];

/// A field over the cells of a patch, or the places of the cells. Only where arrays have the lengths that parameters give
/// them: FMI 2.0 would need a variable for each cell.
pub struct FieldColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the values.
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Whether it has an element for each strip, and for each cell along a strip.
    pub over: [bool; 2],
    /// Reads the value of a cell; the ambient temperature is in `K`.
    pub value: fn(&ContactNode, f64) -> f64,
}

/// The fields of a patch.
#[rustfmt::skip]
pub const FIELDS: [FieldColumn; 9] = [
    FieldColumn { name: "patch.x", unit: "m", display_unit: Some("mm"), nominal: 1e-2, over: [false, true],
        description: "Position of the cells of a strip along the rail, ahead of the axle", value: |node, _| node.position },
    FieldColumn { name: "patch.y", unit: "m", display_unit: Some("mm"), nominal: 1e-2, over: [true, false],
        description: "Position of the strips across the rail, to the left", value: |node, _| node.lateral_position },
    FieldColumn { name: "patch.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, over: [true, true],
        description: "Contact pressure in the cells of the patch", value: |node, _| node.pressure },
    FieldColumn { name: "patch.shear_x", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, over: [true, true],
        description: "Shear traction on the rail in the cells of the patch, along the rail", value: |node, _| node.shear },
    FieldColumn { name: "patch.shear_y", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, over: [true, true],
        description: "Shear traction on the rail in the cells of the patch, to the left", value: |node, _| node.lateral_shear },
    FieldColumn { name: "patch.slip_x", unit: "m/s", display_unit: None, nominal: 1e-1, over: [true, true],
        description: "Slip velocity of the rail relative to the wheel in the cells of the patch, along the rail", value: |node, _| node.slip },
    FieldColumn { name: "patch.slip_y", unit: "m/s", display_unit: None, nominal: 1e-1, over: [true, true],
        description: "Slip velocity of the rail relative to the wheel in the cells of the patch, to the left", value: |node, _| node.lateral_slip },
    FieldColumn { name: "patch.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, over: [true, true],
        description: "Absolute temperature of the rail surface in the cells of the patch", value: |node, ambient| ambient + node.temperature },
    FieldColumn { name: "patch.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, over: [true, true],
        description: "Depth of wear of the rail surface in the cells of the patch", value: |node, _| node.wear_depth },
];

/// A field over the cells of the windows of profiles, or the places of the cells. As the fields of a patch, only where arrays have the lengths that
/// parameters give them: a window has half as many strips again as a patch, and the arrays have room for twice as many.
pub struct SurfaceColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the values.
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Whether it has an element for each strip of a window, and for each cell along a strip.
    pub over: [bool; 2],
    /// Reads a value.
    pub value: SurfaceValue,
}

/// Way to read a value of a window.
#[derive(Clone, Copy)]
pub enum SurfaceValue {
    /// Value of the window.
    Window(fn(&SurfaceWindow) -> f64),
    /// Value of a place along the strips, from [`SurfaceWindow::x`].
    Along,
    /// Value of a strip.
    Strip(fn(&SurfaceStrip) -> f64),
    /// Value of a cell; the ambient temperature is in `K`.
    Cell(fn(&ContactNode, f64) -> f64),
}

impl SurfaceColumn {
    /// Value in a window, at a strip and a cell along it; 0 and the ambient temperature, `K`, where there is none.
    pub fn at(&self, window: Option<&SurfaceWindow>, [strip, cell]: [usize; 2], ambient: f64) -> f64 {
        let found = window.and_then(|window| match self.value {
            SurfaceValue::Window(value) => Some(value(window)),
            SurfaceValue::Along => window.x.get(cell).copied(),
            SurfaceValue::Strip(value) => window.strips.get(strip).map(value),
            SurfaceValue::Cell(value) => {
                let node = window.nodes.get(strip * window.x.len() + cell);
                node.map(|node| value(node, ambient))
            }
        });
        found.unwrap_or(match self.value {
            SurfaceValue::Cell(value) => value(&ContactNode::UNTOUCHED, ambient),
            _ => 0.0,
        })
    }
}

/// The fields of profiles.
#[rustfmt::skip]
pub const SURFACE: [SurfaceColumn; 15] = [
    SurfaceColumn { name: "surface.cell_length", unit: "m", display_unit: Some("mm"), nominal: 1e-3, over: [false, false],
        description: "Length of the cells of a window along the rail; 0 of a window that there is not, and unless contact_model is profiles",
        value: SurfaceValue::Window(|window| window.cell_length) },
    SurfaceColumn { name: "surface.strip_breadth", unit: "m", display_unit: Some("mm"), nominal: 1e-3, over: [false, false],
        description: "Breadth of the strips of a window along the arc of the rail's profile; 0 of a window that there is not",
        value: SurfaceValue::Window(|window| window.strip_breadth) },
    SurfaceColumn { name: "surface.x", unit: "m", display_unit: Some("mm"), nominal: 1e-2, over: [false, true],
        description: "Position of the cells of a strip along the rail, ahead of the axle", value: SurfaceValue::Along },
    SurfaceColumn { name: "surface.arc_length", unit: "m", display_unit: Some("mm"), nominal: 1e-2, over: [true, false],
        description: "Arc length of the rail's new profile at the strips, from its gauge side", value: SurfaceValue::Strip(|strip| strip.arc_length) },
    SurfaceColumn { name: "surface.y", unit: "m", display_unit: Some("mm"), nominal: 1.0, over: [true, false],
        description: "Position of the strips to the left of the track's middle", value: SurfaceValue::Strip(|strip| strip.in_track[0]) },
    SurfaceColumn { name: "surface.z", unit: "m", display_unit: Some("mm"), nominal: 1e-3, over: [true, false],
        description: "Height of the strips above that of the rails' tops", value: SurfaceValue::Strip(|strip| strip.in_track[1]) },
    SurfaceColumn { name: "surface.inclination", unit: "rad", display_unit: Some("deg"), nominal: 0.1, over: [true, false],
        description: "Inclination of the rail's surface at the strips, positive on the side of the gauge face", value: SurfaceValue::Strip(|strip| strip.inclination) },
    SurfaceColumn { name: "surface.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, over: [true, true],
        description: "Contact pressure in the cells of the windows, 0 beyond the last strip of a window", value: SurfaceValue::Cell(|node, _| node.pressure) },
    SurfaceColumn { name: "surface.shear_x", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, over: [true, true],
        description: "Shear traction on the rail in the cells of the windows, along the rail", value: SurfaceValue::Cell(|node, _| node.shear) },
    SurfaceColumn { name: "surface.shear_s", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, over: [true, true],
        description: "Shear traction on the rail in the cells of the windows, along the arc of its profile, positive to the left", value: SurfaceValue::Cell(|node, _| node.lateral_shear) },
    SurfaceColumn { name: "surface.slip_x", unit: "m/s", display_unit: None, nominal: 1e-1, over: [true, true],
        description: "Slip velocity of the rail relative to the wheel in the cells of the windows, along the rail", value: SurfaceValue::Cell(|node, _| node.slip) },
    SurfaceColumn { name: "surface.slip_s", unit: "m/s", display_unit: None, nominal: 1e-1, over: [true, true],
        description: "Slip velocity of the rail relative to the wheel in the cells of the windows, along the arc of the rail's profile, positive to the left", value: SurfaceValue::Cell(|node, _| node.lateral_slip) },
    SurfaceColumn { name: "surface.friction_coefficient", unit: "1", display_unit: None, nominal: 0.1, over: [true, true],
        description: "Friction coefficient in the cells of the windows, where they carry", value: SurfaceValue::Cell(|node, _| node.friction_coefficient) },
    SurfaceColumn { name: "surface.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, over: [true, true],
        description: "Absolute temperature of the rail surface in the cells of the windows", value: SurfaceValue::Cell(|node, ambient| ambient + node.temperature) },
    SurfaceColumn { name: "surface.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, over: [true, true],
        description: "Depth of wear of the rail surface in the cells of the windows", value: SurfaceValue::Cell(|node, _| node.wear_depth) },
];

/// A number of each place of a profile that wears. As the fields, only where arrays have the lengths that parameters give them.
pub struct WearColumn {
    /// Name.
    pub name: &'static str,
    /// Typical magnitude.
    pub nominal: f64,
    /// Unit in which a person would read the values.
    pub display_unit: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Reads the places of a profile.
    pub places: fn(&ProfileDepths) -> &[WornPlace],
    /// Reads the value of a place.
    pub value: fn(&WornPlace) -> f64,
}

/// The wear of the profiles, in `m`.
#[rustfmt::skip]
pub const PROFILE_WEAR: [WearColumn; 10] = [
    WearColumn { name: "wheel_profile.position", nominal: 1e-2, display_unit: "mm",
        description: "Lateral positions of the places on the new profile of the wheel, outwards from the running circle; 0 unless contact_model is profiles", places: |p| &p.wheel, value: |place| place.position },
    WearColumn { name: "wheel_profile.arc_length", nominal: 1e-2, display_unit: "mm",
        description: "Arc lengths of the places on the new profile of the wheel from its flange side; 0 unless contact_model is profiles", places: |p| &p.wheel, value: |place| place.arc_length },
    WearColumn { name: "wheel_profile.wear_depth", nominal: 1e-5, display_unit: "µm",
        description: "Depths along the normal that the wheel's profile has lost; 0 unless wheel_profile_wear is on", places: |p| &p.wheel, value: |place| place.depth },
    WearColumn { name: "rail_profile.position", nominal: 1e-2, display_unit: "mm",
        description: "Lateral positions of the places on the new upright profile of the rail, outwards from its highest point; 0 unless contact_model is profiles", places: |p| &p.rail, value: |place| place.position },
    WearColumn { name: "rail_profile.arc_length", nominal: 1e-2, display_unit: "mm",
        description: "Arc lengths of the places on the new profile of the rail from its gauge side; 0 unless contact_model is profiles", places: |p| &p.rail, value: |place| place.arc_length },
    WearColumn { name: "rail_profile.wear_depth", nominal: 1e-5, display_unit: "µm",
        description: "Depths along the normal that the rail's profile has lost; 0 unless rail_profile_wear is on", places: |p| &p.rail, value: |place| place.depth },
    WearColumn { name: "wheel_profile.y", nominal: 1.0, display_unit: "mm",
        description: "Places of the wheel's profile as it is, below its axle, to the left of the track's middle; 0 unless contact_model is profiles", places: |p| &p.wheel, value: |place| place.in_track[0] },
    WearColumn { name: "wheel_profile.z", nominal: 1e-2, display_unit: "mm",
        description: "Heights of the wheel's profile as it is, below its axle, above that of the rails' tops; 0 unless contact_model is profiles", places: |p| &p.wheel, value: |place| place.in_track[1] },
    WearColumn { name: "rail_profile.y", nominal: 1.0, display_unit: "mm",
        description: "Places of the rail's profile as it is, to the left of the track's middle; 0 unless contact_model is profiles", places: |p| &p.rail, value: |place| place.in_track[0] },
    WearColumn { name: "rail_profile.z", nominal: 1e-2, display_unit: "mm",
        description: "Heights of the rail's profile as it is, above that of the rails' tops; 0 unless contact_model is profiles", places: |p| &p.rail, value: |place| place.in_track[1] },
];
