//! What is found of a site's study and lies over the scene; and when a single point lies in the sun. Both are found beside
//! the window.

use super::change::ChangeResult;
use super::export::WHO;
use super::facades::{self, Facades};
use super::loading::Project;
use super::pick::PickedPoint;
use super::settings::WindowSettings;
use super::unit::Unit;
use super::work::Work;
use crate::choice::Method;
use crate::deliver::lines::Lines;
use crate::deliver::probe::{self, ProbeRequest};
use crate::deliver::profile::{Hours, ProfileRequest, find_hours, write_hours};
use crate::deliver::{Folder, Sink, comparison};
use crate::export::figure::scale::{Bands, NO_SHADOW, Rgb};
use crate::picture::{HoursRaster, Picture};
use crate::profile::{Profile, Shaded, hours as hours_of};
use crate::shadow::{ShadowError, plan_surface};
use crate::site::file::SiteFile;
use crate::site::{ProbeSite, Site};
use crate::study::{OnEvent, Outcome, Stopwatch, StudyError};
use crate::sun::DayWindow;
use crate::sunlight::Sunlight;
use crate::view::{Grid, Probe, Surface};
use chrono::NaiveDate;
use eframe::egui;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// What was found, ready to be laid over the scene.
pub(super) struct StudyResult {
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
    pub(super) found: Findings,
}

/// What can be found.
pub(super) enum Findings {
    /// The hours of shadow on ground and roofs.
    Shadow(Box<ShadowHours>),
    /// What changes from another state to that of the site.
    Change(Box<ChangeResult>),
    /// The hours of sun on façades and roofs.
    Facades(Box<Facades>),
}

impl StudyResult {
    /// Lays it over a picture of the site, or of what of it is visible.
    ///
    /// # Errors
    /// Where the adapter cannot hold it.
    pub(super) fn lay(&self, picture: &mut Picture, visible: &Site) -> Result<(), ShadowError> {
        match &self.found {
            Findings::Shadow(hours) => picture.lay_hours(Some(hours.raster())),
            Findings::Change(change) => picture.lay_hours(Some(change.raster())),
            Findings::Facades(facades) => facades.lay(picture, &self.site, visible)?,
        }
        Ok(())
    }

    /// What it is, in a few words.
    pub(super) fn what(&self) -> &'static str {
        match &self.found {
            Findings::Shadow(_) => "hours of shadow",
            Findings::Change(_) => "sun lost and gained",
            Findings::Facades(_) => "hours of sun",
        }
    }

    /// Whether it can lie over another site: hours on the plan lie wherever heights agree.
    pub(super) fn lies_on(&self, site: &Site) -> bool {
        let ours = &self.site;
        let same_mesh = || ours.mesh.vertices == site.mesh.vertices && ours.mesh.faces == site.mesh.faces;
        !matches!(self.found, Findings::Facades(_)) || (ours.receives == site.receives && same_mesh())
    }

    /// What it says of a point, where its surface is the one that was counted.
    pub(super) fn said(&self, under: &PickedPoint, unit: Unit) -> Option<String> {
        match &self.found {
            Findings::Shadow(hours) => hours.said(under.point),
            Findings::Change(change) => change.said(under.point),
            Findings::Facades(facades) => facades.said(under, unit),
        }
    }

    /// What its colours mean: a head, and each of them.
    pub(super) fn legend(&self) -> (String, Vec<(Rgb, String)>) {
        match &self.found {
            Findings::Shadow(hours) => hours.legend(),
            Findings::Change(change) => (change.colours.legend_head.clone(), change.colours.legend.clone()),
            Findings::Facades(facades) => facades.legend.clone(),
        }
    }

    /// What its files are called.
    pub(super) fn names(&self) -> Vec<PathBuf> {
        match &self.found {
            Findings::Shadow(hours) => hours.all().names(),
            Findings::Change(_) => comparison::names().to_vec(),
            Findings::Facades(facades) => facades.all().names(),
        }
    }

    /// Writes its files, or a drawing of its lines, as the command does.
    ///
    /// # Errors
    /// Where the study has no such lines, or the files cannot be written.
    pub(super) fn write(&self, lines: Option<Lines>, sink: Sink<'_>, on_event: &mut OnEvent<'_>) -> anyhow::Result<()> {
        match (&self.found, lines) {
            (Findings::Shadow(hours), None) => hours.write(&self.site, &hours.all(), sink, on_event),
            (Findings::Shadow(hours), Some(lines)) => {
                let lines = ProfileRequest { lines: &[lines], ..hours.nothing() };
                hours.write(&self.site, &lines, sink, on_event)
            }
            (_, Some(_)) => anyhow::bail!("lines are drawn of the hours of shadow on the plan; find those first"),
            (Findings::Change(change), None) => change.write(sink, on_event),
            (Findings::Facades(facades), None) => facades.write(&self.site, sink, on_event),
        }
    }

    /// Whether it is what the settings ask of the site.
    pub(super) fn is_asked(&self, project: &Project, settings: &WindowSettings) -> bool {
        let is_found = match (&self.found, &settings.before) {
            (Findings::Change(change), Some(before)) => change.before == *before,
            (Findings::Shadow(_), None) => !settings.shown.facades,
            (Findings::Facades(_), None) => settings.shown.facades,
            _ => false,
        };
        let method = match self.found {
            Findings::Facades(_) => facades::method(settings),
            Findings::Shadow(_) | Findings::Change(_) => settings.shown.method,
        };
        let (then, now) = (&self.written, &project.written.site);
        let same_models = then.model == now.model && self.mark == project.models.mark();
        let of_models = same_models && then.ground == now.ground && then.place == now.place;
        let of_study = then.study == now.study && then.plan == now.plan;
        // undone and redone it is another site, and the same
        is_found && self.method == method && (Arc::ptr_eq(&self.site, &project.site) || (of_models && of_study))
    }

    /// The change, where it is one.
    pub(super) fn change(&self) -> Option<&ChangeResult> {
        match &self.found {
            Findings::Change(change) => Some(change),
            _ => None,
        }
    }
}

/// The hours of shadow on ground and roofs.
pub(super) struct ShadowHours {
    /// The answer, with each instant's shadow where outlines can be drawn of the study.
    hours: Hours,
    /// Its sums.
    shaded: Arc<Shaded>,
    /// What the cells see.
    surface: Surface,
    bands: Bands,
    colours: Vec<Rgb>,
}

impl ShadowHours {
    fn new(site: &Site, hours: Hours) -> ShadowHours {
        let shaded = hours.shaded().cloned().unwrap_or_default();
        let surface = plan_surface(&hours.surface_mesh, site.ground.level, &site.grid);
        let bands = Bands::new(site.track.step_secs, hours.profile.day_secs);
        let colours = shaded.iter().map(|shaded| bands.colour(shaded)).collect();
        ShadowHours { hours, shaded, surface, bands, colours }
    }

    fn raster(&self) -> HoursRaster<'_> {
        raster(&self.hours.profile.grid, &self.colours, &self.surface.height_m)
    }

    /// As a study of the plan answers.
    pub(super) fn outcome(&self) -> Outcome {
        let Hours { profile: Profile { grid, day_secs, night_secs, .. }, .. } = self.hours;
        let Hours { drawn, surface_mesh, statistics, timings, .. } = &self.hours;
        Outcome {
            profile: Profile { grid, shaded: Shaded::clone(&self.shaded), day_secs, night_secs },
            drawn: drawn.clone(),
            surface: None,
            surface_mesh: surface_mesh.clone(),
            statistics: *statistics,
            timings: timings.clone(),
        }
    }

    fn said(&self, point: DVec3) -> Option<String> {
        let cell = cell_at(&self.hours.profile.grid, &self.surface, point)?;
        Some(format!("{:.2} h of shadow", hours_of(self.shaded.of(cell))))
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

    /// No file yet.
    fn nothing(&self) -> ProfileRequest<'_> {
        ProfileRequest::of(Stopwatch::after(self.hours.timings.clone()))
    }

    /// The drawing, the raster and the report; bits where each instant's shadow is at hand.
    fn all(&self) -> ProfileRequest<'_> {
        ProfileRequest {
            drawing: true,
            raster: true,
            report: true,
            bits: !self.hours.outlines.is_empty(),
            ..self.nothing()
        }
    }

    fn write(
        &self,
        site: &Site,
        asked: &ProfileRequest<'_>,
        sink: Sink<'_>,
        on_event: &mut OnEvent<'_>,
    ) -> anyhow::Result<()> {
        write_hours(site, &self.hours, asked, sink, on_event)?;
        Ok(())
    }
}

/// Colours of a plan's cells, as the picture takes them.
pub(super) fn raster<'a>(grid: &Grid, colours: &'a [Rgb], height_m: &'a [f32]) -> HoursRaster<'a> {
    let size = (grid.width, grid.height);
    HoursRaster { corner: [grid.west, grid.north], cell: grid.cell, size, colours, height_m }
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

/// Adds up the hours of a site's study, which is kept among `studies` where it is stopped.
pub(super) fn add_up(
    project: &Project,
    method: Method,
    number: u64,
    studies: Option<PathBuf>,
    context: egui::Context,
) -> Work<StudyResult> {
    let (site, written) = (Arc::clone(&project.site), project.written.site.clone());
    let mark = project.models.mark();
    Work::start(context, move |on_event| {
        // they are few where they can be drawn
        let bits = Lines::Outlines.check(&site.track).is_ok();
        let asked = ProfileRequest { bits, ..ProfileRequest::of(Stopwatch::start()) };
        let shelf = studies.as_deref().map(|path| Folder { path, who: WHO, inputs: &[] });
        let hours = find_hours(&Site { method, ..Site::clone(&site) }, &asked, shelf, on_event)?;
        let found = Findings::Shadow(Box::new(ShadowHours::new(&site, hours)));
        Ok(StudyResult { number, site, method, written, mark, found })
    })
}

/// Finds when a point lies in the sun on a date.
pub(super) fn probe(project: &Project, probe: Probe, date: NaiveDate, context: egui::Context) -> Work<Sunlight> {
    const STEP_SECS: u32 = 60;
    let site = Arc::clone(&project.site);
    Work::start(context, move |on_event| {
        let day = DayWindow::on(&site.place, date, None, None).map_err(StudyError::from)?;
        let probing = ProbeSite {
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
        Ok(probe::probe(&probing, &ProbeRequest::default(), Sink::Memory, on_event)?.sunlight)
    })
}
