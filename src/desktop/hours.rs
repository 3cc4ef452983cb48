//! What is found of a site's study and lies over the scene; and when a single point lies in the sun. Both are found beside
//! the window.

use super::change::Change;
use super::facades::{self, Facades};
use super::loading::Project;
use super::pick::Under;
use super::settings::Settings;
use super::unit::Unit;
use super::work::Work;
use crate::cli::draw::Lines;
use crate::export::figure::Outline;
use crate::export::figure::scale::{Bands, NO_SHADOW, Rgb};
use crate::export::{figure, raster, report};
use crate::picture::{Hours, Picture};
use crate::profile::probe::Sunlight;
use crate::shadow::ShadowError;
use crate::site::file::SiteFile;
use crate::site::{Method, Probing, Site};
use crate::study::{self, Event, Outcome, StudyError, Wants};
use crate::sun::DayWindow;
use crate::view::{Bits, Grid, Probe, Surface};
use chrono::NaiveDate;
use eframe::egui;
use glam::DVec3;
use std::sync::Arc;

/// A file's name, and what is in it.
pub(super) type NamedFile = (&'static str, Vec<u8>);

/// What was found, ready to be laid over the scene.
pub(super) struct Laid {
    /// Grows with every answer.
    pub(super) number: u64,
    /// The open site that it was found of.
    pub(super) site: Arc<Site>,
    /// By which technique, as it was asked.
    pub(super) method: Method,
    /// The same as it was written.
    pub(super) written: SiteFile,
    /// The number of its models.
    pub(super) mark: u64,
    /// What.
    pub(super) found: Found,
}

/// What can be found.
pub(super) enum Found {
    /// The hours of shadow on ground and roofs.
    Shadow(Box<ShadowHours>),
    /// What changes from another state to that of the site.
    Change(Box<Change>),
    /// The hours of sun on façades and roofs.
    Facades(Box<Facades>),
}

impl Laid {
    /// Lays it over a picture of the site, or of what of it is visible.
    ///
    /// # Errors
    /// Where the adapter cannot hold it.
    pub(super) fn lay(&self, picture: &mut Picture, visible: &Site) -> Result<(), ShadowError> {
        match &self.found {
            Found::Shadow(hours) => picture.lay_hours(Some(hours.raster())),
            Found::Change(change) => picture.lay_hours(Some(change.raster())),
            Found::Facades(facades) => facades.lay(picture, &self.site, visible)?,
        }
        Ok(())
    }

    /// What it is, in a few words.
    pub(super) fn what(&self) -> &'static str {
        match &self.found {
            Found::Shadow(_) => "hours of shadow",
            Found::Change(_) => "sun lost and gained",
            Found::Facades(_) => "hours of sun",
        }
    }

    /// Whether it can lie over another site: hours on the plan lie wherever heights agree.
    pub(super) fn lies_on(&self, site: &Site) -> bool {
        let ours = &self.site;
        let same_mesh = || ours.mesh.vertices == site.mesh.vertices && ours.mesh.faces == site.mesh.faces;
        !matches!(self.found, Found::Facades(_)) || (ours.receives == site.receives && same_mesh())
    }

    /// What it says of a point, where its surface is the one that was counted.
    pub(super) fn said(&self, under: &Under, unit: Unit) -> Option<String> {
        match &self.found {
            Found::Shadow(hours) => hours.said(under.point),
            Found::Change(change) => change.said(under.point),
            Found::Facades(facades) => facades.said(under, unit),
        }
    }

    /// What its colours mean: a head, and each of them.
    pub(super) fn legend(&self) -> (String, Vec<(Rgb, String)>) {
        match &self.found {
            Found::Shadow(hours) => hours.legend(),
            Found::Change(change) => (change.colours.legend_head.clone(), change.colours.legend.clone()),
            Found::Facades(facades) => facades.legend.clone(),
        }
    }

    /// What its files are called.
    pub(super) fn names(&self) -> &'static [&'static str] {
        match &self.found {
            Found::Shadow(_) => &["profile.png", "shadow-hours.tif", "profile.json"],
            Found::Change(_) => &["compare.png", "shadow-hours-difference.tif", "compare.json"],
            Found::Facades(_) => &["surfaces.png", "surfaces.glb", "surfaces.csv", "profile.json"],
        }
    }

    /// Its files, as the command makes them.
    ///
    /// # Errors
    /// What the encoders say.
    pub(super) fn files(&self) -> anyhow::Result<Vec<NamedFile>> {
        match &self.found {
            Found::Shadow(hours) => hours.files(&self.site),
            Found::Change(change) => change.files(),
            Found::Facades(facades) => facades.files(&self.site),
        }
    }

    /// A drawing of its lines, as the command makes it.
    ///
    /// # Errors
    /// Where the study has no such lines, in the command's words; what the encoders say.
    pub(super) fn lines(&self, lines: Lines) -> anyhow::Result<Vec<NamedFile>> {
        let Found::Shadow(hours) = &self.found else {
            anyhow::bail!("lines are drawn of the hours of shadow on the plan; find those first");
        };
        lines.check(&self.site.track)?;
        let files = lines.files(&hours.scene(&self.site)?, &hours.outcome.profile, &hours.outlines)?;
        Ok(files.into())
    }

    /// Whether it is what the settings ask of the site.
    pub(super) fn is_asked(&self, project: &Project, settings: &Settings) -> bool {
        let is_found = match (&self.found, &settings.before) {
            (Found::Change(change), Some(before)) => change.before == *before,
            (Found::Shadow(_), None) => !settings.shown.facades,
            (Found::Facades(_), None) => settings.shown.facades,
            _ => false,
        };
        let method = match self.found {
            Found::Facades(_) => facades::method(settings),
            Found::Shadow(_) | Found::Change(_) => settings.shown.method,
        };
        let (then, now) = (&self.written, &project.written.site);
        let same_models = then.model == now.model && self.mark == project.models.mark();
        let of_models = same_models && then.ground == now.ground && then.place == now.place;
        let of_study = then.study == now.study && then.plan == now.plan;
        // undone and redone it is another site, and the same
        is_found && self.method == method && (Arc::ptr_eq(&self.site, &project.site) || (of_models && of_study))
    }

    /// The change, where it is one.
    pub(super) fn change(&self) -> Option<&Change> {
        match &self.found {
            Found::Change(change) => Some(change),
            _ => None,
        }
    }
}

/// The hours of shadow on ground and roofs.
pub(super) struct ShadowHours {
    /// The answer.
    pub(super) outcome: Outcome,
    /// Each instant's shadow, where outlines can be drawn of the study.
    outlines: Vec<Outline>,
    bands: Bands,
    colours: Vec<Rgb>,
}

impl ShadowHours {
    fn new(site: &Site, outcome: Outcome, outlines: Vec<Outline>) -> ShadowHours {
        let bands = Bands::new(site.track.step_secs, outcome.profile.day_secs);
        let colours = outcome.profile.shaded.iter().map(|shaded| bands.colour(shaded)).collect();
        ShadowHours { outcome, outlines, bands, colours }
    }

    fn raster(&self) -> Hours<'_> {
        let height_m = self.outcome.surface.as_ref().map_or([].as_slice(), |surface| &surface.height_m);
        raster(&self.outcome.profile.grid, &self.colours, height_m)
    }

    fn said(&self, point: DVec3) -> Option<String> {
        let cell = cell_at(&self.outcome.profile.grid, self.outcome.surface.as_ref()?, point)?;
        Some(format!("{:.2} h of shadow", self.outcome.profile.hours(cell)))
    }

    fn legend(&self) -> (String, Vec<(Rgb, String)>) {
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

    /// The drawing, the raster and the report.
    fn files(&self, site: &Site) -> anyhow::Result<Vec<NamedFile>> {
        let Outcome { profile, drawn, timings, .. } = &self.outcome;
        let Site { receivers, ground, notes, .. } = site;
        let told = report::Told { receivers: *receivers, ground: *ground, drawn, timings, statistics: None, notes };
        Ok(vec![
            ("profile.png", figure::profile(&self.scene(site)?, profile)?),
            ("shadow-hours.tif", raster::geotiff(profile, &site.place)?),
            ("profile.json", report::profile_json(profile, &site.place, &site.track, &told)?.into_bytes()),
        ])
    }

    fn scene<'a>(&'a self, site: &'a Site) -> anyhow::Result<figure::Scene<'a>> {
        let Outcome { drawn, surface, surface_mesh: mesh, .. } = &self.outcome;
        let Some(surface) = surface else { anyhow::bail!("what is seen is not there") };
        let Site { place, track, receivers, ground, .. } = site;
        Ok(figure::Scene { place, track, mesh, surface, receivers: *receivers, ground: *ground, drawn })
    }
}

/// Colours of a plan's cells, as the picture takes them.
pub(super) fn raster<'a>(grid: &Grid, colours: &'a [Rgb], height_m: &'a [f32]) -> Hours<'a> {
    let size = (grid.width, grid.height);
    Hours { corner: [grid.west, grid.north], cell: grid.cell, size, colours, height_m }
}

/// The cell in which a point lies, where it lies on the surface that the cell sees.
pub(super) fn cell_at(grid: &Grid, surface: &Surface, point: DVec3) -> Option<usize> {
    let column = ((point.x - grid.west) / grid.cell).floor();
    let row = ((grid.north - point.y) / grid.cell).floor();
    let inside = column >= 0.0 && row >= 0.0 && column < f64::from(grid.width) && row < f64::from(grid.height);
    let cell = inside.then(|| row as usize * grid.width as usize + column as usize)?;
    let height = f64::from(*surface.height_m.get(cell)?);
    ((height - point.z).abs() < grid.cell.max(0.05)).then_some(cell)
}

/// Adds up the hours of a site's study.
pub(super) fn add_up(project: &Project, method: Method, number: u64, context: egui::Context) -> Work<Laid> {
    let (site, written) = (Arc::clone(&project.site), project.written.site.clone());
    let mark = project.models.mark();
    Work::start(context, move |on_event| {
        // they are few where they can be drawn
        let bits = Lines::Outlines.check(&site.track).is_ok();
        let wants = Wants { surface: true, bits, ..Wants::default() };
        let mut outlines = Vec::new();
        let outcome = study::run(&Site { method, ..Site::clone(&site) }, &wants, &mut |event| {
            match &event {
                Event::Drawn { index, bits: Some(shadow), .. } => {
                    outlines.push(Outline { index: *index, shadow: Bits::clone(shadow) });
                }
                Event::Anew => outlines.clear(),
                _ => {}
            }
            on_event(event)
        })?;
        let found = Found::Shadow(Box::new(ShadowHours::new(&site, outcome, outlines)));
        Ok(Laid { number, site, method, written, mark, found })
    })
}

/// Finds when a point lies in the sun on a date.
pub(super) fn probe(project: &Project, probe: Probe, date: NaiveDate, context: egui::Context) -> Work<Sunlight> {
    const STEP_SECS: u32 = 60;
    let site = Arc::clone(&project.site);
    Work::start(context, move |on_event| {
        let day = DayWindow::on(&site.place, date, None, None).map_err(StudyError::from)?;
        let probing = Probing {
            ground: site.ground,
            place: site.place.clone(),
            mesh: site.mesh.clone(),
            notes: site.notes.clone(),
            casts: site.casts.clone(),
            probes: vec![probe],
            days: vec![day],
            step_secs: STEP_SECS,
            refraction: site.track.refraction,
        };
        Ok(study::probe::probe(&probing, on_event)?)
    })
}
