//! Numbers that stand for no height.

use crate::message::{Message, message};

/// What programs write for no height, and no ground is as low.
const USUAL: [f32; 4] = [-9999.0, -32768.0, -32767.0, -99999.0];
/// The same above the ground, where heights are in metres: no ground is as high.
const USUAL_HIGH: [f32; 3] = [9999.0, 32767.0, 99999.0];
/// No ground is as low or as high as this.
const FARTHEST_M: f64 = 1e6;

/// Makes NaN of the numbers that stand for no height: the one that the file says; where it says none, the usual ones that
/// are there, with a note. `unit_m` is how many metres of height a number is.
pub(super) fn remove(heights: &mut [f32], said: Option<f32>, unit_m: f64, notes: &mut Vec<Message>) {
    let high: &[f32] = if unit_m >= 1.0 { &USUAL_HIGH } else { &[] };
    let usual = USUAL.iter().chain(high).copied().filter(|none| heights.contains(none));
    let taken: Vec<f32> = if said.is_some() { Vec::new() } else { usual.collect() };
    let is_said = |height: f32| said == Some(height);
    let is_beyond = |height: f32| f64::from(height).abs() * unit_m.min(1.0) > FARTHEST_M;
    let mut found: Vec<String> = taken.iter().map(f32::to_string).collect();
    if heights.iter().any(|&height| is_beyond(height) && !is_said(height)) {
        found.push(format!("what is beyond ±{FARTHEST_M} m"));
    }
    if !found.is_empty() {
        let which = if said.is_some() {
            "has numbers that are no heights"
        } else {
            "does not say which number stands for no height"
        };
        notes.push(message![format!("{which}; taken for none: {}", found.join(", "))]);
    }
    for height in heights {
        if is_said(*height) || is_beyond(*height) || !height.is_finite() || taken.contains(height) {
            *height = f32::NAN;
        }
    }
}
