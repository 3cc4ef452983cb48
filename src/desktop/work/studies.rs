//! Studies of the open site, computed in threads of their own, and the intervals in which a single point lies in the
//! sun.

use crate::choice::{Method, Receivers};
use crate::deliver::comparison::find_comparison;
use crate::deliver::lines::Lines;
use crate::deliver::patches::{answer, find_patches};
use crate::deliver::probe::{self, ProbeRequest};
use crate::deliver::profile::{ProfileRequest, find_hours};
use crate::deliver::{DeliverError, Folder, Sink};
use crate::desktop::results::before::BeforeState;
use crate::desktop::results::change::ChangeResult;
use crate::desktop::results::facades::Facades;
use crate::desktop::results::hours::ShadowHours;
use crate::desktop::results::{Findings, StudyResult};
use crate::desktop::state::project::Project;
use crate::desktop::work::{WHO, Work};
use crate::export::figure::{self, ChangeColours, Screen};
use crate::export::patches::Atlas;
use crate::site::{Models, Overrides, Pair, ProbeSite, Site, WrittenSite};
use crate::study::{CompareOutcome, Event, OnEvent, Outcome, Stopwatch, StudyError};
use crate::sun::DayWindow;
use crate::sunlight::Sunlight;
use crate::view::Probe;
use chrono::NaiveDate;
use eframe::egui;
use std::path::PathBuf;
use std::sync::Arc;

/// The request of a study besides its site.
pub(in crate::desktop) struct StudyOrder {
    /// The technique.
    pub(in crate::desktop) method: Method,
    /// The number of the answer.
    pub(in crate::desktop) number: u64,
    /// The folder for stopped studies; `None` to keep none.
    pub(in crate::desktop) studies: Option<PathBuf>,
    /// The context to repaint when there is a result.
    pub(in crate::desktop) context: egui::Context,
}

/// Computes the hours of a site's study. A stopped study is kept in `studies`.
pub(in crate::desktop) fn hours(project: &Project, order: StudyOrder) -> Work<StudyResult> {
    let StudyOrder { method, number, studies, context } = order;
    let (site, written) = (Arc::clone(&project.site), project.written.site.clone());
    let mark = project.models.mark();
    Work::start(context, move |on_event| {
        // few enough to keep if their outlines can be drawn
        let bits = Lines::Outlines.check(&site.track).is_ok();
        let request = ProfileRequest { bits, ..ProfileRequest::of(Stopwatch::start()) };
        let hours = find_hours(&Site { method, ..Site::clone(&site) }, &request, shelf(&studies), on_event)?;
        let found = Findings::Shadow(Box::new(ShadowHours::new(&site, hours)));
        Ok(StudyResult { number, site, method, written, mark, notes: Vec::new(), found })
    })
}

/// What is found of a clicked point.
pub(in crate::desktop) struct ClickedSun {
    /// When it lies in the sun.
    pub(in crate::desktop) sunlight: Sunlight,
    /// The picture of its sky.
    pub(in crate::desktop) sky: Option<Screen>,
}

/// Finds when a point lies in the sun on a date, and draws its sky.
pub(in crate::desktop) fn probe(
    project: &Project,
    probe: Probe,
    date: NaiveDate,
    context: egui::Context,
) -> Work<ClickedSun> {
    let site = Arc::clone(&project.site);
    Work::start(context, move |on_event| {
        let day = DayWindow::on(&site.place, date, None, None).map_err(StudyError::from)?;
        let probing = ProbeSite {
            ground: site.ground,
            place: site.place.clone(),
            mesh: site.mesh.clone(),
            notes: site.notes.clone(),
            words: site.words,
            casts: site.casts.clone(),
            probes: vec![probe],
            laid: Vec::new(),
            days: vec![day],
            refraction: site.track.refraction,
        };
        let sunlight = probe::probe(&probing, &ProbeRequest::default(), Sink::Memory, on_event)?.sunlight;
        let sky = probe::sky_card(&probing, &sunlight)?;
        Ok(ClickedSun { sunlight, sky })
    })
}

/// Computes the hours of sun on the patches of a site.
pub(in crate::desktop) fn facades(project: &Project, order: StudyOrder) -> Work<StudyResult> {
    let StudyOrder { method, number, studies, context } = order;
    let (site, written) = (Arc::clone(&project.site), project.written.site.clone());
    let mark = project.models.mark();
    Work::start(context, move |on_event| {
        let judged = Site { receivers: Receivers::Patches, method, ..Site::clone(&site) };
        let outcome = find_patches(&judged, shelf(&studies), on_event)?;
        let answer = answer(&site, &outcome);
        let atlas = Atlas::of(&answer);
        let pages = atlas.colours(&answer.bands(), outcome.hours.samples);
        let legend = figure::patches_legend(&answer);
        let found = Findings::Facades(Box::new(Facades { outcome, atlas, pages, legend }));
        Ok(StudyResult { number, site, method, written, mark, notes: Vec::new(), found })
    })
}

/// Computes the change from `before` to the open site, with the study and the plan of the latter.
pub(in crate::desktop) fn change(
    project: &Project,
    before: Arc<WrittenSite>,
    state: Option<BeforeState>,
    order: StudyOrder,
) -> Work<StudyResult> {
    let StudyOrder { method, number, studies, context } = order;
    let site = Arc::clone(&project.site);
    let (mut after, written) = (project.written.clone(), project.written.site.clone());
    let (models_after, mark) = (project.models.clone(), project.models.mark());
    let (name, reading) = (project.name(), project.reading.clone());
    Work::start(context, move |on_event| {
        let mut watch = Stopwatch::start();
        // the picture has this ground
        after.site.ground.level = Some(site.ground.level);
        let overrides = Overrides { technique: Some(method), ..Overrides::default() };
        let mut first = WrittenSite::clone(&before);
        first.site.study = after.site.study.clone();
        first.site.plan = after.site.plan.clone();
        first.site.camera = after.site.camera.clone();
        let at_hand = state.as_ref().and_then(BeforeState::models);
        let models = at_hand.map_or_else(|| Models::read(&first, |path, options| reading.read(path, options)), Ok)?;
        let takes_ground = first.site.ground.level.is_none() && !models.stand_on(&first, site.ground.level);
        if takes_ground {
            first.site.ground.level = Some(site.ground.level);
        }
        let mut pair = Pair::with_models(&first, &after, &overrides, |_| Ok(models.clone()), |_| Ok(models_after))?;
        if takes_ground {
            (pair.before.ground.from, pair.after.ground.from) = (site.ground.from, site.ground.from);
        }
        if pair.names[0] == pair.names[1] {
            pair.names = [format!("{name}, before"), format!("{name}, after")];
        }
        watch.lap("load");
        let outcome_before = state.and_then(|state| state.outcome(&pair.before));
        let outcome = compare(&pair, outcome_before.as_ref(), shelf(&studies), on_event)?;
        watch.lap("shadows");
        let timings = watch.stages();
        let surfaces = [&outcome.surfaces[0], &outcome.surfaces[1]];
        let (receivers, step_secs) = (pair.after.receivers, pair.after.track.step_secs);
        let colours = ChangeColours::of(&outcome.comparison, surfaces, &outcome.meshes[1], receivers, step_secs);
        for site in [&mut pair.before, &mut pair.after] {
            site.mesh = site.mesh.of_components(&[]);
        }
        let found = Findings::Change(Box::new(ChangeResult { before, models, pair, outcome, timings, colours }));
        Ok(StudyResult { number, site, method, written, mark, notes: Vec::new(), found })
    })
}

/// Shows the progress of two studies as that of one.
fn compare(
    pair: &Pair,
    before: Option<&Outcome>,
    shelf: Option<Folder<'_>>,
    on_event: &mut OnEvent<'_>,
) -> Result<CompareOutcome, DeliverError> {
    let is_both = before.is_none();
    // work that starts over is for the same state
    let (mut begun, mut is_again) = (0_usize, false);
    find_comparison(pair, before, shelf, &mut |event| match event {
        Event::Drawn { index, count, time, .. } if is_both => {
            let done = if begun > 1 { count } else { 0 };
            on_event(Event::Drawn { index: done + index, count: 2 * count, time, mask: None, bits: None })
        }
        event => {
            match event {
                Event::Started { .. } if !std::mem::take(&mut is_again) => begun += 1,
                Event::StartsOver => is_again = true,
                _ => {}
            }
            on_event(event)
        }
    })
}

/// The folder for stopped studies.
fn shelf(studies: &Option<PathBuf>) -> Option<Folder<'_>> {
    studies.as_deref().map(|path| Folder { path, who: WHO, inputs: &[] })
}
