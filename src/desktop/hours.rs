//! The hours of shadow of the site's study, and when a single point lies in the sun: both found beside the window.

use super::loading::Project;
use crate::cli::one_line;
use crate::export::figure::scale::Bands;
use crate::export::{figure, raster, report};
use crate::profile::probe::Sunlight;
use crate::shadow::picture::Hours;
use crate::site::{Probing, Site};
use crate::study::{self, Event, Outcome, StudyError, Wants};
use crate::sun::DayWindow;
use crate::view::Probe;
use chrono::NaiveDate;
use eframe::egui;
use glam::DVec3;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};

/// Hours of shadow, ready to be laid over the scene.
pub(super) struct Laid {
    /// Grows with every answer.
    pub(super) number: u64,
    /// What was asked.
    pub(super) site: Arc<Site>,
    /// The answer.
    pub(super) outcome: Outcome,
    /// What its colours mean.
    pub(super) bands: Bands,
    colours: Vec<[u8; 3]>,
}

impl Laid {
    fn new(number: u64, site: Arc<Site>, outcome: Outcome) -> Laid {
        let bands = Bands::new(site.track.step_secs, outcome.profile.day_secs);
        let colours = outcome.profile.shaded.iter().map(|shaded| bands.colour(shaded)).collect();
        Laid { number, site, outcome, bands, colours }
    }

    /// As the picture takes them.
    pub(super) fn hours(&self) -> Hours<'_> {
        let grid = &self.outcome.profile.grid;
        Hours {
            corner: [grid.west, grid.north],
            cell: grid.cell,
            size: (grid.width, grid.height),
            colours: &self.colours,
            height_m: self.outcome.surface.as_ref().map_or(&[], |surface| &surface.height_m),
        }
    }

    /// The hours of shadow at a point, where its surface is the one that was counted.
    pub(super) fn at(&self, point: DVec3) -> Option<f64> {
        let grid = &self.outcome.profile.grid;
        let column = ((point.x - grid.west) / grid.cell).floor();
        let row = ((grid.north - point.y) / grid.cell).floor();
        let inside = column >= 0.0 && row >= 0.0 && column < f64::from(grid.width) && row < f64::from(grid.height);
        let cell = inside.then(|| row as usize * grid.width as usize + column as usize)?;
        let height = f64::from(*self.outcome.surface.as_ref()?.height_m.get(cell)?);
        let near = (height - point.z).abs() < grid.cell.max(0.05);
        near.then(|| f64::from(self.outcome.profile.hours(cell)))
    }

    /// The drawing, the raster and the report, as the command makes them.
    ///
    /// # Errors
    /// What the encoders say.
    pub(super) fn files(&self) -> anyhow::Result<[(&'static str, Vec<u8>); 3]> {
        let Outcome { profile, drawn, surface_mesh, timings, .. } = &self.outcome;
        let site = &self.site;
        let Some(surface) = &self.outcome.surface else {
            anyhow::bail!("what is seen is not there");
        };
        let (place, track, receivers) = (&site.place, &site.track, site.receivers);
        let scene = figure::Scene { place, track, mesh: surface_mesh, surface, receivers, drawn };
        let told = report::Told { receivers, drawn, timings, statistics: None };
        Ok([
            ("profile.png", figure::profile(&scene, profile)?),
            ("shadow-hours.tif", raster::geotiff(profile, place)?),
            ("profile.json", report::profile_json(profile, place, track, &told)?.into_bytes()),
        ])
    }
}

/// Work that goes on beside the window, and can be given up.
pub(super) struct Work<T> {
    progress: Arc<Mutex<(usize, usize)>>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<Result<T, String>>,
}

impl<T: Send + 'static> Work<T> {
    /// Begins; the work is given what hears its events.
    pub(super) fn start(
        context: egui::Context,
        work: impl FnOnce(&mut study::OnEvent<'_>) -> anyhow::Result<T> + Send + 'static,
    ) -> Work<T> {
        let (tell, result) = mpsc::channel();
        let progress = Arc::new(Mutex::new((0, 0)));
        let cancelled = Arc::new(AtomicBool::new(false));
        let (told, heard) = (Arc::clone(&progress), Arc::clone(&cancelled));
        std::thread::spawn(move || {
            let answer = work(&mut |event| {
                if let (Event::Drawn { index, count, .. }, Ok(mut told)) = (&event, told.lock()) {
                    *told = (index + 1, *count);
                }
                context.request_repaint();
                if heard.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            // who gave it up listens no more
            let _ = tell.send(answer.map_err(|error| one_line(&error)));
            context.request_repaint();
        });
        Work { progress, cancelled, result }
    }

    /// How much is done, of how much.
    pub(super) fn progress(&self) -> (usize, usize) {
        self.progress.lock().map(|progress| *progress).unwrap_or_default()
    }

    /// What came of it, once it is done.
    pub(super) fn done(&self) -> Option<Result<T, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err("the work ended early".to_owned())),
        }
    }
}

impl<T> Drop for Work<T> {
    fn drop(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

/// Adds up the hours of a site's study.
pub(super) fn add_up(site: Arc<Site>, number: u64, context: egui::Context) -> Work<Laid> {
    Work::start(context, move |on_event| {
        let wants = Wants { surface: true, ..Wants::default() };
        let outcome = study::run(&site, &wants, on_event)?;
        Ok(Laid::new(number, site, outcome))
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
            casts: site.casts.clone(),
            probes: vec![probe],
            days: vec![day],
            step_secs: STEP_SECS,
            refraction: site.track.refraction,
        };
        Ok(study::probe::probe(&probing, on_event)?)
    })
}
