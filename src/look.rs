//! How sun and shadow look: colours, light, haze, relief and lines, as one value.
//!
//! Drawings read [`LOOK`]; the picture's shader, which draws the same for a window, gets it as a uniform. A test
//! compares whole pictures of the two.

use glam::DVec3;

/// The look of all drawings and pictures. Colours of three numbers are linear factors or display values, 0 to 1; those of
/// three bytes are sRGB.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Matt card before a camera: reflectance in display values.
    pub building: DVec3,
    /// The ground that it stands on.
    pub ground: DVec3,
    /// Earth that a side cuts, against the ground.
    pub cut_earth: f64,
    /// The tint of the sky's light, and of the sun's.
    pub sky_light: DVec3,
    /// See [`Look::sky_light`].
    pub sun_light: DVec3,
    /// How much of the sky a wall sees.
    pub sky: f64,
    /// How much more of it what looks upwards sees, and how much less what looks downwards.
    pub sky_slope: f64,
    /// What level ground in the sun comes to: nearly the paper's white.
    pub exposure: f64,
    /// Below this sine of its altitude the sun's light is not made up for.
    pub least_height: f64,
    /// What the sun grazes is still told from shade: the drawing says where it shines, not how warm it is there.
    pub least_sun: f64,
    /// Values above this are pressed together instead of cut off, into so much room.
    pub pressed_above: f64,
    /// See [`Look::pressed_above`].
    pub pressed_room: f64,
    /// The sky at the horizon, which is also the haze.
    pub horizon: DVec3,
    /// The sky overhead.
    pub zenith: DVec3,
    /// How fast the sky changes from one to the other, and how far.
    pub sky_rise: f64,
    /// See [`Look::sky_rise`].
    pub sky_most: f64,
    /// So many times as far away as the subject haze begins.
    pub haze_begins: f64,
    /// So many times that distance further it hides all but a part in e.
    pub haze_length: f64,
    /// Without a sun all is dimmer and bluer.
    pub night: DVec3,
    /// What is not judged, among surfaces in the colours of hours.
    pub not_judged: [u8; 3],

    /// The plan's ground in the sun.
    pub plan_ground_sun: [u8; 3],
    /// The plan's ground in the shade.
    pub plan_ground_shade: [u8; 3],
    /// Roofs in the sun.
    pub plan_roof_sun: [u8; 3],
    /// Roofs in the shade.
    pub plan_roof_shade: [u8; 3],
    /// How strongly slopes are told from level roofs.
    pub relief: f64,
    /// The same where colours are a measure: too little to be taken for another band.
    pub relief_of_hours: f64,
    /// The darkest and the lightest that a slope becomes.
    pub relief_darkest: f64,
    /// See [`Look::relief_darkest`].
    pub relief_lightest: f64,

    /// The colour of the lines; nearly black, so that it also reads on a scale's dark end.
    pub line: [u8; 3],
    /// How strong lines are, 0 to 1: in the plan against the ground.
    pub outline: f32,
    /// Where heights or depths jump, and against the sky.
    pub step: f32,
    /// Before a camera where buildings meet the ground.
    pub foot: f32,
    /// Where two faces meet at an angle.
    pub crease: f32,
    /// Before a camera faces that meet at less than this are one surface: a cosine.
    pub crease_cos: f64,
    /// The same in the plan.
    pub plan_crease_cos: f64,
    /// A gap in depth of so much of the distance is a step.
    pub step_share: f64,
    /// The same in a side's picture, in pixels.
    pub side_step_pixels: f64,
    /// Where colours tell components from each other lines are so much weaker.
    pub tinted_lines: f32,

    /// Shadow volumes.
    pub volume: [u8; 3],
    /// Silhouettes.
    pub silhouette: [u8; 3],
    /// How much of what lies behind it one layer of volumes hides.
    pub layer: f64,
    /// How much all of them hide at most: shadows stay legible below.
    pub most_layers: f64,
}

/// A quiet model photograph, warm in the sun and cool in the shade; from above a plan in the same tones.
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

    plan_ground_sun: [246, 240, 226],
    plan_ground_shade: [140, 152, 173],
    plan_roof_sun: [255, 255, 253],
    plan_roof_shade: [174, 183, 198],
    relief: 0.26,
    relief_of_hours: 0.10,
    relief_darkest: 0.70,
    relief_lightest: 1.04,

    line: [24, 27, 34],
    outline: 0.9,
    step: 0.75,
    foot: 0.6,
    crease: 0.45,
    crease_cos: 0.985,
    plan_crease_cos: 0.990,
    step_share: 0.004,
    side_step_pixels: 2.0,
    tinted_lines: 0.55,

    volume: [250, 205, 40],
    silhouette: [10, 10, 12],
    layer: 0.27,
    most_layers: 0.62,
};
