//! How a change affects the sun: from another state of the site (before) to the open one (after).

use crate::deliver::Sink;
use crate::deliver::comparison::write_comparison;
use crate::desktop::results::cells::{cell_at, raster};
use crate::export::comparison;
use crate::export::figure::ChangeColours;
use crate::message::Message;
use crate::picture::HoursRaster;
use crate::profile::Timings;
use crate::profile::comparison::Alteration;
use crate::site::{Models, Pair, WrittenSite};
use crate::study::{CompareOutcome, OnEvent, Stopwatch};
use glam::DVec3;
use std::sync::Arc;

/// A computed change.
pub(in crate::desktop) struct ChangeResult {
    /// The state before, as it was requested.
    pub(in crate::desktop) before: Arc<WrittenSite>,
    /// The models before.
    pub(in crate::desktop) models: Models,
    /// Both states, without their models.
    pub(in crate::desktop) pair: Pair,
    pub(in crate::desktop) outcome: CompareOutcome,
    pub(in crate::desktop) timings: Timings,
    /// The drawing's colours.
    pub(in crate::desktop) colours: ChangeColours,
}

impl ChangeResult {
    /// The cells' colours, in the form that the picture uses.
    pub(in crate::desktop) fn raster(&self) -> HoursRaster<'_> {
        raster(self.outcome.comparison.grid(), &self.colours.of_cells, &self.outcome.surfaces[1].height_m)
    }

    /// The hours of sun at a point, before and after.
    pub(in crate::desktop) fn said(&self, point: DVec3) -> Option<String> {
        let comparison = &self.outcome.comparison;
        let cell = cell_at(comparison.grid(), &self.outcome.surfaces[1], point)?;
        let [before, after] = [comparison.before(), comparison.after()].map(|profile| {
            let day = f64::from(profile.day_secs) / 3600.0;
            day - f64::from(profile.hours(cell))
        });
        Some(match comparison.altered(cell) {
            Alteration::No => {
                let gained = -f64::from(comparison.hours(cell)) + 0.0;
                format!("{before:.2} h of sun before, {after:.2} h after: {gained:+.2} h").replace('-', "−")
            }
            Alteration::Built => format!("new or higher: {after:.2} h of sun after"),
            Alteration::Cleared => format!("gone or lower: {after:.2} h of sun after"),
        })
    }

    /// The command's notes on the models before.
    pub(in crate::desktop) fn notes_before(&self) -> &[Message] {
        &self.pair.before.notes
    }

    /// The names of the states.
    pub(in crate::desktop) fn names(&self) -> &[String; 2] {
        &self.pair.names
    }

    /// The areas, as the command prints them.
    pub(in crate::desktop) fn rows(&self) -> Vec<[String; 3]> {
        comparison::rows(&self.outcome.comparison, &self.pair.after.track)
    }

    /// The extent of the comparison.
    pub(in crate::desktop) fn extent(&self) -> String {
        comparison::extent(&self.outcome.comparison)
    }

    /// Writes the drawing, the raster and the report.
    pub(in crate::desktop) fn write(&self, sink: Sink<'_>, on_event: &mut OnEvent<'_>) -> anyhow::Result<()> {
        let watch = Stopwatch::after(self.timings.clone());
        write_comparison(&self.pair, &self.outcome, watch, sink, on_event)?;
        Ok(())
    }
}
