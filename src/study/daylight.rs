//! The daylight in a study's window.

use crate::sun::SunTrack;

/// The seconds of the window with the sun above the horizon, and those with it below.
pub(crate) fn day_and_night(track: &SunTrack) -> (u32, u32) {
    // both fit: a window is at most ten years, 3.2e8 s
    let secs = |night: bool| {
        let instants = track.instants.iter().filter(|instant| instant.night == night);
        instants.map(|instant| instant.weight_secs).sum()
    };
    (secs(false), secs(true))
}
