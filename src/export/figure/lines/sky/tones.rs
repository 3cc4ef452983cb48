//! The colours of a sky.

use crate::export::figure::scale::Rgb;
use crate::sunlight::SkyCell;

/// The free sky, what lies behind the point's plane, and the ground above a point below it.
pub(super) const SKY: Rgb = [244, 248, 252];
pub(super) const BEHIND: Rgb = [214, 211, 204];
pub(super) const GROUND: Rgb = [170, 152, 128];

/// The sun where it is seen and where it is not, its ways, and the hours of the clock and the sundial.
pub(super) const SUN: Rgb = [240, 164, 0];
pub(super) const SHADED: Rgb = [84, 92, 112];
pub(super) const WAY: Rgb = [72, 77, 86];
pub(super) const CLOCK: Rgb = [168, 60, 24];
pub(super) const SUNDIAL: Rgb = [40, 104, 160];

/// The colour of what a direction meets; `None` for the free sky.
pub(super) fn tone(cell: SkyCell, colours: &[Rgb]) -> Option<Rgb> {
    match cell {
        SkyCell::Free => None,
        SkyCell::Behind => Some(BEHIND),
        SkyCell::Ground => Some(GROUND),
        SkyCell::Component(component) => Some(colours.get(component as usize).copied().unwrap_or(GROUND)),
    }
}
