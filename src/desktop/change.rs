//! What a change does to the sun: another state of the site, before, and the open one, after.

use super::hours::{Findings, StudyResult, cell_at, raster};
use super::loading::Project;
use super::work::Work;
use crate::deliver::Sink;
use crate::deliver::comparison::write_comparison;
use crate::export::comparison;
use crate::export::figure::ChangeColours;
use crate::picture::HoursRaster;
use crate::profile::Timings;
use crate::profile::comparison::Alteration;
use crate::site::{Method, Models, Overrides, Pair, Site, SiteError, WrittenSite};
use crate::study::{self, CompareOutcome, Event, OnEvent, Outcome, Stopwatch, StudyError};
use eframe::egui;
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;

/// A change that was found.
pub(super) struct ChangeResult {
    /// The state before, as it was asked.
    pub(super) before: Arc<WrittenSite>,
    /// What stands there before.
    pub(super) models: Models,
    /// Both states, without their models.
    pair: Pair,
    outcome: CompareOutcome,
    timings: Timings,
    /// As the drawing has them.
    pub(super) colours: ChangeColours,
}

/// What is known of the state that is compared with.
#[derive(Clone)]
pub(super) struct BeforeState {
    /// As it was written.
    pub(super) before: Arc<WrittenSite>,
    /// Its models. Those of a kept state stay as they were, whatever becomes of their files; those of another file are that
    /// file's.
    pub(super) models: Models,
    /// The hours of a state that was kept.
    pub(super) laid: Option<Arc<StudyResult>>,
}

impl BeforeState {
    /// Its models, where they need not be read anew.
    fn models(&self) -> Option<Models> {
        let holds = self.laid.is_some() || self.models.changed_file().is_none();
        holds.then(|| self.models.clone())
    }

    /// Its hours, where they are those of such a study.
    fn outcome(&self, site: &Site) -> Option<Outcome> {
        let laid = self.laid.as_ref()?;
        let known = &laid.site;
        let same = known.track == site.track
            && known.grid == site.grid
            && known.ground.level == site.ground.level
            && laid.method == site.method;
        match &laid.found {
            Findings::Shadow(hours) if same => Some(hours.outcome()),
            _ => None,
        }
    }
}

/// Reads another file as the state before; what names no place stands in that of the open site.
///
/// # Errors
/// As the command reads it.
pub(super) fn read(path: &Path, project: &Project) -> Result<WrittenSite, SiteError> {
    WrittenSite::read_beside(path, &project.written, &Overrides::default())
}

/// Finds what changes from `before` to the open site: over the study and on the plan of the latter.
pub(super) fn find(
    project: &Project,
    before: Arc<WrittenSite>,
    known: Option<BeforeState>,
    method: Method,
    number: u64,
    context: egui::Context,
) -> Work<StudyResult> {
    let site = Arc::clone(&project.site);
    let (mut after, written) = (project.written.clone(), project.written.site.clone());
    let (models_after, mark) = (project.models.clone(), project.models.mark());
    let (name, reading) = (project.name(), project.reading.clone());
    Work::start(context, move |on_event| {
        let mut watch = Stopwatch::start();
        // the picture lies on this ground
        after.site.ground.level = Some(site.ground.level);
        let asked = Overrides { technique: Some(method), ..Overrides::default() };
        let mut first = WrittenSite::clone(&before);
        first.site.study = after.site.study.clone();
        first.site.plan = after.site.plan.clone();
        first.site.camera = after.site.camera.clone();
        let at_hand = known.as_ref().and_then(BeforeState::models);
        let models = at_hand.map_or_else(|| Models::read(&first, |path, options| reading.read(path, options)), Ok)?;
        let takes_ground = first.site.ground.level.is_none() && !models.stand_on(site.ground.level);
        if takes_ground {
            first.site.ground.level = Some(site.ground.level);
        }
        let mut pair = Pair::with_models(&first, &after, &asked, |_| Ok(models.clone()), |_| Ok(models_after))?;
        if takes_ground {
            (pair.before.ground.from, pair.after.ground.from) = (site.ground.from, site.ground.from);
        }
        if pair.names[0] == pair.names[1] {
            pair.names = [format!("{name}, before"), format!("{name}, after")];
        }
        watch.lap("load");
        let known = known.and_then(|known| known.outcome(&pair.before));
        let outcome = compare(&pair, known, on_event)?;
        watch.lap("shadows");
        let timings = watch.stages();
        let surfaces = [&outcome.surfaces[0], &outcome.surfaces[1]];
        let (receivers, step_secs) = (pair.after.receivers, pair.after.track.step_secs);
        let colours = ChangeColours::of(&outcome.comparison, surfaces, receivers, step_secs);
        for site in [&mut pair.before, &mut pair.after] {
            site.mesh = site.mesh.of_components(&[]);
        }
        let found = Findings::Change(Box::new(ChangeResult { before, models, pair, outcome, timings, colours }));
        Ok(StudyResult { number, site, method, written, mark, found })
    })
}

/// Two studies tell how far they are as one does.
fn compare(pair: &Pair, known: Option<Outcome>, on_event: &mut OnEvent<'_>) -> Result<CompareOutcome, StudyError> {
    let Some(known) = known else {
        let mut before = 0;
        return study::compare(pair, &mut |event| match event {
            Event::Drawn { index, count, time, .. } => {
                let both = Event::Drawn { index: before + index, count: 2 * count, time, mask: None, bits: None };
                if index + 1 == count {
                    before = count;
                }
                on_event(both)
            }
            event => on_event(event),
        });
    };
    study::compare_with(pair, known, on_event)
}

impl ChangeResult {
    /// As the picture takes it.
    pub(super) fn raster(&self) -> HoursRaster<'_> {
        raster(self.outcome.comparison.grid(), &self.colours.of_cells, &self.outcome.surfaces[1].height_m)
    }

    /// The hours of sun at a point, before and after.
    pub(super) fn said(&self, point: DVec3) -> Option<String> {
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

    /// What the command would note of the models before.
    pub(super) fn notes_before(&self) -> &[String] {
        &self.pair.before.notes
    }

    /// What people call the states.
    pub(super) fn names(&self) -> &[String; 2] {
        &self.pair.names
    }

    /// The areas, as the command tells them.
    pub(super) fn rows(&self) -> Vec<[String; 3]> {
        comparison::rows(&self.outcome.comparison, &self.pair.after.track)
    }

    /// How much was compared.
    pub(super) fn extent(&self) -> String {
        comparison::extent(&self.outcome.comparison)
    }

    /// Writes the drawing, the raster and the report.
    pub(super) fn write(&self, sink: Sink<'_>, on_event: &mut OnEvent<'_>) -> anyhow::Result<()> {
        let watch = Stopwatch::after(self.timings.clone());
        write_comparison(&self.pair, &self.outcome, watch, sink, on_event)?;
        Ok(())
    }
}

/// A path that a state came from, as people call it.
pub(super) fn name_of(before: &WrittenSite) -> String {
    let named = before.site.place.as_ref().and_then(|place| place.name.clone());
    named.filter(|name| !name.trim().is_empty()).unwrap_or_else(|| super::loading::name_of(Path::new(&before.file)))
}
