//! Recognises numbers that mean no height.

use crate::message::{Message, message};

/// Usual numbers for no height that are lower than any ground.
const USUAL: [f32; 4] = [-9999.0, -32768.0, -32767.0, -99999.0];
/// Usual numbers for no height that are higher than any ground in metres.
const USUAL_HIGH: [f32; 3] = [9999.0, 32767.0, 99999.0];
/// Lower or higher than any ground.
const FARTHEST_M: f64 = 1e6;

/// Replaces numbers that mean no height by NaN: the one that the file gives, otherwise the usual ones that occur, with
/// a note. `unit_m` is the length of the heights' unit.
pub(super) fn remove(heights: &mut [f32], said: Option<f32>, unit_m: f64, notes: &mut Vec<Message>) {
    let high: &[f32] = if unit_m >= 1.0 { &USUAL_HIGH } else { &[] };
    let usual = USUAL.iter().chain(high).copied().filter(|none| heights.contains(none));
    let taken: Vec<f32> = if said.is_some() { Vec::new() } else { usual.collect() };
    let is_said = |height: f32| said == Some(height);
    let is_beyond = |height: f32| f64::from(height).abs() * unit_m.min(1.0) > FARTHEST_M;
    let mut found: Vec<String> = taken.iter().map(f32::to_string).collect();
    if heights.iter().any(|&height| is_beyond(height) && !is_said(height)) {
        found.push(format!("numbers beyond ±{FARTHEST_M} m"));
    }
    if !found.is_empty() {
        let which = if said.is_some() {
            "has numbers that are not heights"
        } else {
            "does not say which number means no height"
        };
        notes.push(message![format!("{which}; taken as missing: {}", found.join(", "))]);
    }
    for height in heights {
        if is_said(*height) || is_beyond(*height) || !height.is_finite() || taken.contains(height) {
            *height = f32::NAN;
        }
    }
}
