//! The drawing of a change: sun lost in blues, sun gained in oranges, what is new or gone in grays.

use super::scale::{NO_SHADOW, Rgb, band_secs, mix};
use super::{FigureContext, cells, check_surface, page, panel, plan, text, words};
use crate::choice::Receivers;
use crate::export::{ExportError, check_size};
use crate::mesh::Mesh;
use crate::profile::comparison::{Alteration, Change, Comparison};
use crate::view::Surface;

/// More shadow, from a little to the most; darker than the same amount of less shadow, so that prints without colour
/// can be read.
const LOST: [Rgb; 3] = [[208, 224, 240], [84, 125, 176], [10, 30, 88]];
/// Less shadow, lighter than the same amount of more shadow.
const GAINED: [Rgb; 3] = [[253, 232, 188], [243, 174, 82], [204, 98, 14]];
/// The colours of what is new and of what is gone.
const BUILT: Rgb = [112, 110, 106];
const CLEARED: Rgb = [201, 199, 194];

/// The greatest number of bands for gain and for loss; more are hard to tell apart.
const MOST_BANDS: u32 = 7;

/// The bands of a change: none, then (0, band], (band, 2 band], … for gain and for loss alike, up to the larger of the
/// two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChangeBands {
    /// Width of a band, seconds.
    pub band_secs: u32,
    /// The number of bands for gain, and for loss.
    pub count: u32,
}

impl ChangeBands {
    /// Bands as wide as the study's step if that gives few enough, otherwise of a round duration.
    pub fn of(comparison: &Comparison, step_secs: u32) -> ChangeBands {
        let most = (0..comparison.cells()).filter_map(|cell| comparison.change(cell)).map(i64::unsigned_abs).max();
        // no change is longer than the daylight, which fits
        let most_secs = u32::try_from(most.unwrap_or(0).div_ceil(255)).unwrap_or(u32::MAX);
        let band_secs = band_secs(step_secs, most_secs, MOST_BANDS);
        ChangeBands { band_secs, count: most_secs.div_ceil(band_secs) }
    }

    /// The colour of a change in shadow, in units of 1/255 s.
    pub fn colour(&self, change: i64) -> Rgb {
        if change == 0 {
            return NO_SHADOW;
        }
        // a change of exactly one band belongs to that band, not to the next
        let band = (change.unsigned_abs() - 1) / (255 * u64::from(self.band_secs));
        self.of_band(if change > 0 { LOST } else { GAINED }, band as u32)
    }

    fn of_band(&self, [light, middle, dark]: [Rgb; 3], band: u32) -> Rgb {
        let share = match self.count {
            0 | 1 => 0.5,
            count => f64::from(band.min(count - 1)) / f64::from(count - 1),
        };
        if share < 0.5 { mix(light, middle, 2.0 * share) } else { mix(middle, dark, 2.0 * share - 1.0) }
    }

    fn legend(&self) -> Vec<(Rgb, String)> {
        let with_secs = !self.band_secs.is_multiple_of(60);
        let label = |band: u32, what: &str| {
            let [from, to] = [band, band + 1].map(|at| at.saturating_mul(self.band_secs));
            if self.band_secs >= words::MANY_HOURS_SECS {
                let [from, to] = [from, to].map(|secs| (f64::from(secs) / 3600.0).round());
                return format!("{what} {from} – {to} h");
            }
            let [from, to] = [from, to].map(|secs| words::hours(secs, with_secs));
            format!("{what} {from} – {to}")
        };
        let gained = (0..self.count).rev().map(|band| (self.of_band(GAINED, band), label(band, "gained")));
        let lost = (0..self.count).map(|band| (self.of_band(LOST, band), label(band, "lost")));
        gained.chain([(NO_SHADOW, "no change".to_owned())]).chain(lost).collect()
    }
}

/// The colours of a change.
pub struct ChangeColours {
    /// The colour of each cell.
    pub of_cells: Vec<Rgb>,
    /// The heading of the legend.
    pub legend_head: String,
    /// Each colour with its meaning; the most sun gained comes first.
    pub legend: Vec<(Rgb, String)>,
    /// For each cell, whether and how it is drawn as altered.
    altered: Vec<Alteration>,
}

impl ChangeColours {
    /// The colours of a comparison. `mesh` is the mesh after the change; `step_secs` is the step of the study.
    pub fn of(
        comparison: &Comparison,
        [before, after]: [&Surface; 2],
        mesh: &Mesh,
        receivers: Receivers,
        step_secs: u32,
    ) -> ChangeColours {
        let ground_only = receivers == Receivers::Ground;
        let bands = ChangeBands::of(comparison, step_secs);
        // if only the ground is judged, buildings are drawn as what stands there
        let altered: Vec<Alteration> = match ground_only {
            true => Alteration::between(before, after),
            false => (0..comparison.cells()).map(|cell| comparison.altered(cell)).collect(),
        };
        let roof = |cell: usize| after.face[cell] < Surface::GROUND && !mesh.is_terrain(after.face[cell]);
        let colour = |(cell, altered): (usize, &Alteration)| match (altered, comparison.change(cell)) {
            (Alteration::Built, _) => BUILT,
            (Alteration::Cleared, None) => CLEARED,
            _ if ground_only && roof(cell) => plan::ROOF_UNJUDGED,
            (_, change) => bands.colour(change.unwrap_or(0)),
        };
        let of_cells: Vec<Rgb> = altered.iter().enumerate().map(colour).collect();
        let mut legend_head = match comparison.after().day_secs {
            0 => "No sun in this window".to_owned(),
            day => format!("Hours of sun out of {}", words::long_duration(day)),
        };
        let total = |change| comparison.most(change).is_some();
        if !total(Change::SunLost) && !total(Change::SunGained) {
            legend_head = "Nothing changes".to_owned();
        }
        let mut legend = bands.legend();
        let grays = [(BUILT, "new or higher"), (CLEARED, "gone or lower")];
        let seen = grays.into_iter().filter(|(colour, _)| of_cells.contains(colour));
        legend.extend(seen.map(|(colour, what)| (colour, what.to_owned())));
        if ground_only {
            legend.push((plan::ROOF_UNJUDGED, super::UNJUDGED.to_owned()));
        }
        ChangeColours { of_cells, legend_head, legend, altered }
    }
}

/// `compare.png`: hours of sun lost and gained on the plan. The two scenes are those before and after; the sheet takes
/// its labels from the latter.
///
/// # Errors
/// [`ExportError::Size`] if a surface or the comparison does not fill the grid; [`ExportError::Encode`] from the
/// encoder.
pub fn difference(
    scenes: &[FigureContext; 2],
    names: &[String; 2],
    comparison: &Comparison,
) -> Result<Vec<u8>, ExportError> {
    let grid = comparison.grid();
    check_size("comparison", comparison.cells(), grid.width, grid.height)?;
    for scene in scenes {
        check_surface(scene.surface, (grid.width, grid.height))?;
    }
    let [before, after] = scenes;
    let surfaces = [before.surface, after.surface];
    let ChangeColours { of_cells, legend_head, legend, altered } =
        ChangeColours::of(comparison, surfaces, after.mesh, after.receivers, after.track.step_secs);

    let mut panel = panel(after, "Sun lost and gained");
    let [name_before, name_after] = text::told_apart(names, super::panel::holds);
    panel.facts.insert(0, ("Before", name_before));
    panel.facts.insert(1, ("After", name_after));
    panel.facts.push(("Cells", cells(grid.width, grid.height, grid.cell)));
    let night_secs = comparison.after().night_secs;
    if night_secs > 0 {
        let night = words::long_duration(night_secs);
        panel.facts.push(("Night", format!("{night} of the window, not counted")));
    }
    (panel.legend_head, panel.legend) = (legend_head, legend);
    let draw = |fit| plan::difference(scenes, &of_cells, &altered, grid.cell, fit);
    page::page(&panel, (grid.width, grid.height), Some(grid.cell), draw, page::png)
}
