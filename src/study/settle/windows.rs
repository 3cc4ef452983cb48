//! Windows: which side is outside, and how deep they lie in their wall.

use super::obstacles::Obstacles;
use crate::message::{Message, few, message, setting};
use crate::site::{FieldLocation, JudgedSite, JudgedWindow, SiteError};
use glam::DVec3;
use rayon::prelude::*;

/// The other side of a window counts as more open only if its openness is greater by more than this.
const CLEARLY: f64 = 1.5;
/// The distance in front of the glass from which a reveal is measured, metres; no reveal is deeper.
const DEEPEST_M: f64 = 1.0;
/// The distance beside the glass at which the wall is sought, metres: beyond the frame.
const BESIDE_M: [f64; 3] = [0.2, 0.35, 0.5];
/// A face that lies up to this far behind the glass still bounds it, metres.
const BEHIND_M: f64 = 0.05;

/// What was found about a window.
#[derive(Clone, Copy, Default)]
struct SettledWindow {
    /// Nothing shows which side is outside.
    is_doubtful: bool,
    /// The side given by the order of its corners is far less open than the other.
    seems_turned: bool,
    looks_into_wall: bool,
    /// The reveal, if it was measured.
    reveal_m: Option<f64>,
}

/// Settles all windows.
///
/// # Errors
/// One error that lists all windows that look into their own wall.
pub(super) fn settle(site: &mut JudgedSite, obstacles: &Obstacles) -> Result<(), SiteError> {
    let found: Vec<SettledWindow> = site.windows.par_iter_mut().map(|window| of_window(window, obstacles)).collect();
    let named = |which: fn(&SettledWindow) -> bool| {
        let of = site.windows.iter().zip(&found).filter(|(_, found)| which(found));
        let names: Vec<String> = of.map(|(window, _)| format!("\"{}\"", window.name)).collect();
        (names.len(), few(names))
    };
    let windows = |count: usize| if count == 1 { "1 window".to_owned() } else { format!("{count} windows") };
    let (count, names) = named(|found| found.looks_into_wall);
    if count > 0 {
        let (look, their) = if count == 1 { ("looks", "its") } else { ("look", "their") };
        let what = format!("{} {look} into {their} own wall: {names}", windows(count));
        let hint = "write corners as they are seen from outside, and cut the opening into the wall";
        let at = FieldLocation::Key { file: site.file.clone(), table: "[[window]]".to_owned(), key: String::new() };
        return Err(SiteError::Value { at, message: Box::new(message![what; hint]) });
    }
    let (doubtful, names_of_doubtful) = named(|found| found.is_doubtful);
    let (turned, names_of_turned) = named(|found| found.seems_turned);
    let mut notes = Vec::new();
    if doubtful > 0 {
        let what = format!("both sides of {} are equally open: {names_of_doubtful}", windows(doubtful));
        notes.push(message![what; "write `corners` as they are seen from outside where the wrong side is judged"]);
    }
    if turned > 0 {
        let what = format!("the other side of {} is far more open: {names_of_turned}", windows(turned));
        notes.push(message![what; "write `corners` as they are seen from outside"]);
    }
    notes.extend(note_reveals(&found));
    site.notes.extend(notes);
    Ok(())
}

/// A note that reveals were measured, with their range.
fn note_reveals(found: &[SettledWindow]) -> Option<Message> {
    let measured: Vec<f64> = found.iter().filter_map(|found| found.reveal_m).collect();
    let least = measured.iter().copied().fold(f64::INFINITY, f64::min);
    let most = measured.iter().copied().fold(0.0, f64::max);
    let reveals = match measured.len() {
        0 => return None,
        1 => "the reveal of 1 window is".to_owned(),
        count => format!("the reveals of {count} windows are"),
    };
    let deep = if most - least < 0.005 { format!("{most:.2} m") } else { format!("{least:.2} to {most:.2} m") };
    let what = format!("{reveals} measured at the walls beside: {deep}");
    Some(message![what; setting("[[window]]", "reveal", "`reveal` under [[window]]"), " sets it"])
}

/// Turns a pane to its more open side, measures its reveal, and finds whether it looks into its own wall.
fn of_window(window: &mut JudgedWindow, obstacles: &Obstacles) -> SettledWindow {
    let middle = |corners: &[DVec3; 4]| corners.iter().sum::<DVec3>() / 4.0;
    let mut found = SettledWindow::default();
    let (front, ahead) = (middle(&window.corners), window.outward);
    // a pane has two faces; of written corners, the back of the same plane
    let back = window.other_side.as_ref().map_or(front, middle);
    let mut open = [obstacles.openness(front, ahead), obstacles.openness(back, -ahead)];
    let mut sides = [(front, ahead), (back, -ahead)];
    match window.other_side.take() {
        Some(other) => {
            found.is_doubtful = open[0] == open[1];
            if open[1] > open[0] {
                (window.corners, window.outward) = (other, -ahead);
                open.reverse();
                sides.reverse();
            }
        }
        None => found.seems_turned = open[1] > CLEARLY * open[0],
    }
    let [walled, walled_behind] = sides.map(|(point, normal)| obstacles.is_walled_in(point, normal));
    found.looks_into_wall = walled && (walled_behind || open[1] > CLEARLY * open[0]);
    if !window.reveal_is_said && !found.looks_into_wall {
        window.reveal_m = reveal(window, obstacles);
        found.reveal_m = Some(window.reveal_m);
    }
    found
}

/// The distance of the wall beside a window in front of its glass: the middle one of those at which rays from outside
/// meet it to the left, to the right and above; 0 if they meet nothing.
fn reveal(window: &JudgedWindow, obstacles: &Obstacles) -> f64 {
    let [low_left, low_right, high_right, high_left] = window.corners;
    let right = (low_right - low_left).normalize_or_zero();
    let up = (high_left - low_left).normalize_or_zero();
    let edges = [
        ((low_left + high_left) / 2.0, -right),
        ((low_right + high_right) / 2.0, right),
        ((high_left + high_right) / 2.0, up),
    ];
    let depth = |(edge, away): (DVec3, DVec3), beside: f64| {
        let from = edge + away * beside + window.outward * DEEPEST_M;
        let met = obstacles.first(from, -window.outward)?;
        (met <= DEEPEST_M + BEHIND_M).then_some(DEEPEST_M - met)
    };
    let beside = |edge: (DVec3, DVec3)| BESIDE_M.into_iter().filter_map(move |beside| depth(edge, beside));
    let mut depths: Vec<f64> = edges.into_iter().flat_map(beside).collect();
    depths.sort_unstable_by(f64::total_cmp);
    depths.get(depths.len() / 2).copied().unwrap_or(0.0).max(0.0)
}
