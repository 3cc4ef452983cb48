//! Finds where an area is narrower than what a rule counts.

use glam::DVec2;

/// The distance between the places along a border at which the width is measured, metres.
const SPACING_M: f64 = 0.25;

/// A corner with a wider angle than this does not make the parts beside it narrow, degrees.
const SHARP_DEG: f64 = 45.0;

/// Finds a place at which an area is narrower than this many metres, and its width there, measured across the area and
/// square to its border. A corner makes it narrow if it is sharper than 45°.
pub fn narrow_place(rings: &[Vec<DVec2>], least_m: f64) -> Option<(DVec2, f64)> {
    if least_m <= 0.0 {
        return None;
    }
    let sides: Vec<[DVec2; 2]> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|at| [ring[at], ring[(at + 1) % ring.len()]]))
        .filter(|[from, to]| from.distance(*to) > 1e-6)
        .collect();
    // a width that is measured to a millimetre is not narrow because of its rounding
    let least_m = least_m - 1e-3;
    let mut narrowest: Option<(DVec2, f64)> = None;
    for [from, to] in &sides {
        let along = (to - from).normalize();
        // the inside is on the left
        let inward = along.perp();
        let length = from.distance(*to);
        let steps = (length / SPACING_M).ceil().clamp(1.0, 1e4);
        for step in 0..steps as usize {
            let point = from + along * (length * (step as f64 + 0.5) / steps);
            for side in &sides {
                let Some(away) = across(point, inward, side) else { continue };
                let is_less = away < least_m && narrowest.is_none_or(|(_, least)| away < least);
                if is_less && !is_blunt_neighbour([from, to], side) {
                    narrowest = Some((point, away));
                }
            }
        }
    }
    narrowest
}

/// The distance from a point to a side in a direction.
fn across(point: DVec2, direction: DVec2, [from, to]: &[DVec2; 2]) -> Option<f64> {
    let side = to - from;
    let cross = direction.perp_dot(side);
    if cross.abs() < 1e-12 {
        return None;
    }
    let away = (from - point).perp_dot(side) / cross;
    let along = (from - point).perp_dot(direction) / cross;
    (away > 1e-9 && (0.0..=1.0).contains(&along)).then_some(away)
}

/// Whether two sides meet in a corner that is not sharp.
fn is_blunt_neighbour([from, to]: [&DVec2; 2], [other_from, other_to]: &[DVec2; 2]) -> bool {
    let angle_deg = if to == other_from {
        (from - to).angle_to(other_to - to).abs().to_degrees()
    } else if from == other_to {
        (to - from).angle_to(other_from - from).abs().to_degrees()
    } else {
        return false;
    };
    angle_deg >= SHARP_DEG
}
