//! How sun and shadow look: colours, light, haze, relief and lines, as one value.
//!
//! Drawings read [`LOOK`], and the shader that draws the window's picture gets it as a uniform. A test compares whole
//! pictures of the two.

use glam::DVec3;

/// The look of all drawings and pictures. Colours of three floats are linear factors or display values, 0 to 1; colours
/// of three bytes are sRGB.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// The building's material, like matt card: its reflectance in display values.
    pub building: DVec3,
    /// The ground that it stands on.
    pub ground: DVec3,
    /// The factor for the earth that an elevation cuts, relative to the ground.
    pub cut_earth: f64,
    /// The tint of the sky's light.
    pub sky_light: DVec3,
    /// The tint of the sun's light.
    pub sun_light: DVec3,
    /// The share of the sky that a wall sees.
    pub sky: f64,
    /// The increase of that share for a face that faces up, and its decrease for one that faces down.
    pub sky_slope: f64,
    /// The value of level ground in the sun, nearly the paper's white.
    pub exposure: f64,
    /// The sine of the sun's altitude below which the exposure no longer makes up for the weak light.
    pub least_height: f64,
    /// The least light on a face in the sun, so that a face at a grazing angle still differs from shade: the drawing
    /// shows where the sun shines, not how warm it is there.
    pub least_sun: f64,
    /// Values above this are compressed instead of cut off.
    pub pressed_above: f64,
    /// The range into which they are compressed.
    pub pressed_room: f64,
    /// The sky at the horizon, which is also the haze.
    pub horizon: DVec3,
    /// The sky overhead.
    pub zenith: DVec3,
    /// How fast the sky's colour changes from the horizon upwards.
    pub sky_rise: f64,
    /// The greatest share of that change.
    pub sky_most: f64,
    /// The distance at which haze begins, in distances of the subject.
    pub haze_begins: f64,
    /// The further distance over which haze hides all but 1/e, in distances of the subject.
    pub haze_length: f64,
    /// The factor for night: everything is dimmer and bluer.
    pub night: DVec3,
    /// The colour of surfaces that are not judged, beside surfaces in the colours of hours.
    pub not_judged: [u8; 3],
    /// The colour of the ground around surfaces in the colours of hours. It is not judged either, and has no entry in
    /// the legend.
    pub hours_ground: [u8; 3],
    /// The mean light on a wall that is not judged, where a plan's hours are drawn in a camera's picture.
    pub hours_card: f64,
    /// How that light changes per unit of the normal towards the east, the north and up.
    pub hours_card_slope: DVec3,
    /// The factor for a plan's hours in a camera's picture, on a wall.
    pub hours_wall: f64,
    /// The increase of that factor on a face that faces up.
    pub hours_wall_slope: f64,
    /// The tolerance in height between a seen point and the counted surface, metres, besides the effect of its slope.
    pub hours_height_m: f64,
    /// The least upward component of a unit normal for a face to show a plan's hours.
    pub hours_least_up: f64,

    /// The plan's ground in the sun.
    pub plan_ground_sun: [u8; 3],
    /// The plan's ground in the shade.
    pub plan_ground_shade: [u8; 3],
    /// Roofs in the sun.
    pub plan_roof_sun: [u8; 3],
    /// Roofs in the shade.
    pub plan_roof_shade: [u8; 3],
    /// Roofs that are not judged, where only the ground is.
    pub plan_roof_unjudged: [u8; 3],
    /// The ground of plans that are lines alone.
    pub lines_ground: [u8; 3],
    /// Text and lines on paper.
    pub ink: [u8; 3],
    /// The factor in the shade for components with colours of their own.
    pub plan_tint_shade: f64,
    /// How strongly slopes differ from level roofs.
    pub relief: f64,
    /// The same where colours show values: weak enough not to be mistaken for a different band.
    pub relief_of_hours: f64,
    /// The darkest factor of a slope.
    pub relief_darkest: f64,
    /// The lightest factor of a slope.
    pub relief_lightest: f64,
    /// The upward component of a unit normal above which a face is level and has no relief.
    pub relief_level: f64,

    /// The colour of the lines: nearly black, so that it is visible on a scale's dark end.
    pub line: [u8; 3],
    /// The strength of lines, 0 to 1, for outlines in the plan, against the ground.
    pub outline: f32,
    /// The strength at jumps of height or depth, and against the sky.
    pub step: f32,
    /// The strength where buildings meet the ground, in a camera's picture.
    pub foot: f32,
    /// The strength where two faces meet at an angle.
    pub crease: f32,
    /// The cosine of the angle below which two faces are one surface in a camera's picture.
    pub crease_cos: f64,
    /// The same cosine in the plan.
    pub plan_crease_cos: f64,
    /// In the plan, the least gap in height that is a step, metres: below it a step is rounding, a kerb or a joint.
    pub plan_step_least_m: f64,
    /// The greatest such gap, however large the cells are, metres.
    pub plan_step_most_m: f64,
    /// The upward component of a unit normal up to which a face is a wall, whose height is not extrapolated in a plan.
    pub plan_wall_up: f64,
    /// The relative gap in depth that is a step.
    pub step_share: f64,
    /// The gap that is a step in a side's picture, in pixels.
    pub side_step_pixels: f64,
    /// The factor for lines where colours distinguish components.
    pub tinted_lines: f32,

    /// The colour of shadow volumes.
    pub volume: [u8; 3],
    /// The colour of silhouettes.
    pub silhouette: [u8; 3],
    /// The opacity of one layer of volumes.
    pub layer: f64,
    /// The greatest opacity of all layers together, so that shadows stay visible below them.
    pub most_layers: f64,

    /// What keeps a rule. The four colours of verdicts differ in lightness, too.
    pub passing: [u8; 3],
    /// What is too close to a limit to say.
    pub too_close: [u8; 3],
    /// What breaks a rule.
    pub failing: [u8; 3],
    /// What a rule only reports.
    pub only_reported: [u8; 3],
}

/// The program's look: like a photograph of a plain model, warm in the sun and cool in the shade. The plan has the same
/// tones.
pub const LOOK: Look = Look {
    building: DVec3::new(0.995, 0.975, 0.935),
    ground: DVec3::new(0.965, 0.945, 0.895),
    cut_earth: 0.90,
    sky_light: DVec3::new(0.90, 0.97, 1.12),
    sun_light: DVec3::new(1.10, 1.00, 0.84),
    sky: 0.50,
    sky_slope: 0.09,
    exposure: 0.98,
    least_height: 0.32,
    least_sun: 0.26,
    pressed_above: 0.9,
    pressed_room: 0.1,
    horizon: DVec3::new(0.945, 0.942, 0.925),
    zenith: DVec3::new(0.640, 0.745, 0.850),
    sky_rise: 1.6,
    sky_most: 0.85,
    haze_begins: 1.3,
    haze_length: 3.5,
    night: DVec3::new(0.62, 0.66, 0.76),
    not_judged: [200, 191, 182],
    hours_ground: [236, 234, 229],
    hours_card: 0.74,
    hours_card_slope: DVec3::new(0.05, -0.03, 0.18),
    hours_wall: 0.90,
    hours_wall_slope: 0.10,
    hours_height_m: 0.02,
    hours_least_up: 0.05,

    plan_ground_sun: [246, 240, 226],
    plan_ground_shade: [140, 152, 173],
    plan_roof_sun: [255, 255, 253],
    plan_roof_shade: [174, 183, 198],
    plan_roof_unjudged: [224, 222, 216],
    lines_ground: [253, 251, 246],
    ink: [35, 38, 44],
    plan_tint_shade: 0.78,
    relief: 0.26,
    relief_of_hours: 0.10,
    relief_darkest: 0.70,
    relief_lightest: 1.04,
    relief_level: 0.9999,

    line: [24, 27, 34],
    outline: 0.9,
    step: 0.75,
    foot: 0.6,
    crease: 0.45,
    crease_cos: 0.985,
    plan_crease_cos: 0.990,
    plan_step_least_m: 0.02,
    plan_step_most_m: 0.5,
    plan_wall_up: 0.1,
    step_share: 0.004,
    side_step_pixels: 2.0,
    tinted_lines: 0.55,

    volume: [250, 205, 40],
    silhouette: [10, 10, 12],
    layer: 0.27,
    most_layers: 0.62,

    passing: [58, 150, 140],
    too_close: [238, 184, 72],
    failing: [176, 44, 36],
    only_reported: [118, 130, 152],
};
