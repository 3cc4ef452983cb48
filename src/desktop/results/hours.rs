//! The hours of shadow on ground and roofs, as shown on the scene.

use crate::deliver::Sink;
use crate::deliver::profile::{Hours, ProfileRequest, write_hours};
use crate::desktop::results::cells::{cell_at, raster};
use crate::export::figure::scale::{Bands, NO_SHADOW, Rgb};
use crate::picture::HoursRaster;
use crate::profile::{Profile, Shaded, hours as hours_of};
use crate::shadow::plan_surface;
use crate::site::Site;
use crate::study::{OnEvent, Outcome, Stopwatch};
use crate::view::Surface;
use glam::DVec3;
use std::sync::Arc;

/// The hours of shadow on ground and roofs.
pub(in crate::desktop) struct ShadowHours {
    /// The answer, with each instant's shadow if the study's outlines can be drawn.
    hours: Hours,
    /// Its sums.
    shaded: Arc<Shaded>,
    /// What the cells see.
    surface: Surface,
    bands: Bands,
    colours: Vec<Rgb>,
}

impl ShadowHours {
    pub(in crate::desktop) fn new(site: &Site, hours: Hours) -> ShadowHours {
        let shaded = hours.shaded().cloned().unwrap_or_default();
        let surface = plan_surface(&hours.surface_mesh, site.ground.level, &site.grid);
        let bands = Bands::new(site.track.step_secs, hours.profile.day_secs);
        let colours = shaded.iter().map(|shaded| bands.colour(shaded)).collect();
        ShadowHours { hours, shaded, surface, bands, colours }
    }

    pub(in crate::desktop) fn raster(&self) -> HoursRaster<'_> {
        raster(&self.hours.profile.grid, &self.colours, &self.surface.height_m)
    }

    /// The hours as the outcome of a study of the plan.
    pub(in crate::desktop) fn outcome(&self) -> Outcome {
        let Hours { profile: Profile { grid, day_secs, night_secs, .. }, .. } = self.hours;
        let Hours { drawn, surface_mesh, statistics, notes, timings, .. } = &self.hours;
        Outcome {
            profile: Profile { grid, shaded: Shaded::clone(&self.shaded), day_secs, night_secs },
            drawn: drawn.clone(),
            surface: None,
            surface_mesh: surface_mesh.clone(),
            statistics: *statistics,
            notes: notes.clone(),
            timings: timings.clone(),
        }
    }

    pub(in crate::desktop) fn said(&self, point: DVec3) -> Option<String> {
        let cell = cell_at(&self.hours.profile.grid, &self.surface, point)?;
        Some(format!("{:.2} h of shadow", hours_of(self.shaded.of(cell))))
    }

    pub(in crate::desktop) fn legend(&self) -> (String, Vec<(Rgb, String)>) {
        let bands = &self.bands;
        let hours = |secs: u32| {
            if bands.band_secs.is_multiple_of(60) {
                format!("{}:{:02}", secs / 3600, secs / 60 % 60)
            } else {
                format!("{}:{:02}:{:02}", secs / 3600, secs / 60 % 60, secs % 60)
            }
        };
        let entry = |band: usize| {
            let (from, to) = bands.bounds(band);
            (bands.colours[band], format!("{} – {}", hours(from), hours(to)))
        };
        let none = (NO_SHADOW, "none".to_owned());
        let entries = std::iter::once(none).chain((0..bands.colours.len()).map(entry)).collect();
        (format!("Hours of shadow out of {}", hours(bands.day_secs)), entries)
    }

    /// A request without files.
    pub(in crate::desktop) fn nothing(&self) -> ProfileRequest<'_> {
        ProfileRequest::of(Stopwatch::after(self.hours.timings.clone()))
    }

    /// A request for the drawing, the raster and the report, and for the bits if each instant's shadow is in memory.
    pub(in crate::desktop) fn all(&self) -> ProfileRequest<'_> {
        ProfileRequest {
            drawing: true,
            raster: true,
            report: true,
            bits: !self.hours.outlines.is_empty(),
            ..self.nothing()
        }
    }

    pub(in crate::desktop) fn write(
        &self,
        site: &Site,
        request: &ProfileRequest<'_>,
        sink: Sink<'_>,
        on_event: &mut OnEvent<'_>,
    ) -> anyhow::Result<()> {
        write_hours(site, &self.hours, request, sink, on_event)?;
        Ok(())
    }
}
