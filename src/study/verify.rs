//! Compares every technique with ray casting, on the plan or on façades and roofs, so that users can see on their own site how
//! far to
//! trust each one.
//!
//! [`verify`] makes the techniques, and [`hold`] compares them with the truth, instant by instant; what draws no plan is
//! compared in [`super::verify_surfaces`]. At some cells, ray
//! casting with its trees is compared with ray casting against every face.

use super::again::persist;
use super::chooser::opened;
use super::machine::Machine;
use super::verify_surfaces::SurfaceTrials;
use super::{Event, OnEvent, SiteView, StudyError, day_and_night, note_site, subject_of, tell, tiles};
use crate::choice::{Engine, Method, MethodRow, Promise, Receivers, Subject, TABLE, Truth};
use crate::gpu::Gpu;
use crate::mesh::report;
use crate::message::{Field, message};
use crate::profile::Provenance;
use crate::shadow::ray_cast::RayCast;
use crate::shadow::{ShadowError, Technique};
use crate::site::Site;
use crate::sun::Instant;
use crate::verification::{Difference, Row, Tally, Verification, is_edge_cell};
use crate::view::{Decider, Mask, View};
use rayon::prelude::*;
use std::sync::Arc;
use std::time;

/// The default number of cells along the plan's longer side.
pub const SIZE: u32 = 512;
/// The default number of samples of the sun's disc.
const SUN_SAMPLES: u32 = 64;
/// The number of cells of a study at which ray casting is compared with itself without trees; half of them are edge
/// cells.
const MOST_SAMPLED: usize = 200;

/// The share of an exact technique's edge cells that may differ: on the ground under clean models, and elsewhere.
const EDGE_SHARE_CLEAN: f64 = 0.005;
const EDGE_SHARE: f64 = 0.01;

/// A technique to compare with the truth.
pub struct Trial {
    /// What draws its masks.
    pub drawn: Provenance,
    /// The truth that it is compared with.
    pub against: Truth,
    /// What it promises.
    pub promise: Promise,
    /// The technique, made for the site's plan.
    pub technique: Box<dyn Technique>,
}

/// Compares every technique with ray casting, at the study's instants.
///
/// # Errors
/// [`StudyError`]. A study that is all at night, or a machine without a graphics adapter, is refused before anything is
/// drawn.
pub fn verify(site: &Site, on_event: &mut OnEvent<'_>) -> Result<Verification, StudyError> {
    if site.receivers == Receivers::Patches {
        let message = message!["surfaces are compared beside the plan"; "take top or ground for that, or leave it out"];
        return Err(StudyError::Conflict { field: Field::Receivers, message });
    }
    by_day(site)?;
    note_site(site, on_event)?;
    // all techniques are wanted, so none may replace another
    persist(site, false, on_event, &mut |site, gpu, on_event| {
        let gpu = opened(gpu).map_err(|error| StudyError::NoVerification(error.why()))?;
        let trials = trials(&gpu, site, on_event)?;
        hold(site, trials, SurfaceTrials::new(site, &gpu)?, on_event)
    })
}

/// The techniques, made for a site's plan on an adapter.
fn trials(gpu: &Arc<Gpu>, site: &Site, on_event: &mut OnEvent<'_>) -> Result<Vec<Trial>, StudyError> {
    let view = View::Plan(site.grid);
    let subject = subject_of(site, &view);
    tiles::at_once(site.grid, subject, &Machine::rays(None))?;
    let mut trials = Vec::new();
    for row in held() {
        if row.blends_float32 && gpu.blends_float32("").is_err() {
            let note = format!("{} is left out: '{}' cannot blend 32-bit floats", row.word, gpu.name());
            tell(on_event, Event::Note(note.into()))?;
            continue;
        }
        for engine in [Engine::Cpu, Engine::Gpu].into_iter().filter(|engine| row.draws(*engine, subject)) {
            let machine = match engine {
                Engine::Gpu => Machine::on(Arc::clone(gpu), row.method, site),
                Engine::Auto | Engine::Cpu => Machine::on_processor(row.method, site),
            };
            tiles::at_once(site.grid, subject, &machine)?;
            let technique = SiteView { site, machine: &machine, view, receivers: site.receivers }.technique()?;
            let MethodRow { against, promise, .. } = *row;
            trials.push(Trial { drawn: machine.drawn(), against, promise, technique });
        }
    }
    Ok(trials)
}

/// The rows of the techniques that are compared: exact ones first, as the hybrid's map is compared with one of them.
fn held() -> Vec<&'static MethodRow> {
    let is_held = |row: &&MethodRow| row.method != Method::Auto && row.promise != Promise::Same;
    let mut rows: Vec<&MethodRow> = TABLE.iter().filter(is_held).collect();
    rows.sort_by_key(|row| row.promise);
    rows
}

/// Compares techniques with the truth, and ray casting with itself; some of them on façades and roofs.
///
/// # Errors
/// As [`verify`].
pub fn hold(
    site: &Site,
    trials: Vec<Trial>,
    mut surfaces: Option<SurfaceTrials>,
    on_event: &mut OnEvent<'_>,
) -> Result<Verification, StudyError> {
    let instants = by_day(site)?;
    let (day_secs, _) = day_and_night(&site.track);
    let sun_samples = site.settings.sun_samples.unwrap_or(SUN_SAMPLES);
    let mut centre = TruthCaster::new(site, None);
    let mut disc = TruthCaster::new(site, Some(sun_samples));
    let mut held: Vec<_> = trials.into_iter().map(|trial| (trial, Tally::new(&site.grid))).collect();
    let mut trees = Tally::new(&site.grid);

    let count = instants.len();
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    for (index, instant) in instants.iter().enumerate() {
        centre.draw(instant)?;
        disc.draw(instant)?;
        let mut exact = None;
        for (trial, tally) in &mut held {
            let truth = if trial.against == Truth::Disc { &mut disc } else { &mut centre };
            let mask = compare(trial, tally, truth, instant, exact.as_ref())?;
            if trial.promise == Promise::Exact {
                exact.get_or_insert(mask);
            }
        }
        let sampled = MOST_SAMPLED * index / count..MOST_SAMPLED * (index + 1) / count;
        without_trees(&centre, instant, &spread(&centre.mask, sampled), &mut trees);
        if let Some(surfaces) = &mut surfaces {
            surfaces.compare(instant)?;
        }
        tell(on_event, Event::Drawn { index, count, time: instant.time, mask: None, bits: None })?;
    }

    let (cast, disc_secs) = (centre.machine.drawn(), disc.tally.secs());
    let centre_secs = centre.tally.secs();
    let [centre, disc] = [centre.tally.sum()?, disc.tally.sum()?];
    let mut rows = Vec::new();
    for (Trial { drawn, against, promise, .. }, tally) in held {
        let truth = if against == Truth::Disc { &disc } else { &centre };
        rows.push(tally.row(drawn, against, promise, (day_secs > 0).then_some(truth))?);
    }
    let compared = surfaces.as_ref().map(SurfaceTrials::compared);
    rows.extend(surfaces.into_iter().flat_map(|surfaces| surfaces.rows(day_secs > 0)));
    let trees = trees.row(cast, Truth::EveryFace, Promise::Same, None)?;
    rows.push(Row { secs: centre_secs, ..trees });
    let clean = report::components(&site.mesh).iter().zip(&site.casts).all(|(part, casts)| !casts || part.clean());
    let (grid, edge_share) = (site.grid, edge_share(site, clean));
    Ok(Verification { grid, instants: count, clean, edge_share, sun_samples, disc_secs, surfaces: compared, rows })
}

/// Which part of an exact technique's edge cells may differ on a site's plan.
fn edge_share(site: &Site, clean: bool) -> f64 {
    let is_plane = subject_of(site, &View::Plan(site.grid)) == Subject::Ground;
    if clean && is_plane { EDGE_SHARE_CLEAN } else { EDGE_SHARE }
}

/// The instants by day.
fn by_day(site: &Site) -> Result<Vec<&Instant>, StudyError> {
    let instants: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).collect();
    if instants.is_empty() { Err(StudyError::NoDay) } else { Ok(instants) }
}

/// Ray casting as the truth.
struct TruthCaster {
    machine: Machine,
    view: View,
    rays: RayCast,
    mask: Mask,
    tally: Tally,
}

impl TruthCaster {
    fn new(site: &Site, sun_samples: Option<u32>) -> TruthCaster {
        let machine = Machine::rays(sun_samples);
        let view = View::Plan(site.grid);
        let scene = SiteView { site, machine: &machine, view, receivers: site.receivers }.scene();
        TruthCaster {
            machine,
            view,
            rays: RayCast::new(scene, view, sun_samples),
            mask: Mask { width: 0, height: 0, share: Vec::new() },
            tally: Tally::new(&site.grid),
        }
    }

    fn draw(&mut self, instant: &Instant) -> Result<(), ShadowError> {
        let started = time::Instant::now();
        self.mask = self.rays.draw(instant.to_sun)?.read()?;
        self.tally.draw(&self.mask, instant.weight_secs, started.elapsed().as_secs_f64())
    }
}

/// Draws one instant and compares it with the truth. `exact` is the mask of a technique without a map.
fn compare(
    trial: &mut Trial,
    tally: &mut Tally,
    truth: &mut TruthCaster,
    instant: &Instant,
    exact: Option<&Mask>,
) -> Result<Mask, ShadowError> {
    let started = time::Instant::now();
    let mask = trial.technique.draw(instant.to_sun)?.read()?;
    tally.draw(&mask, instant.weight_secs, started.elapsed().as_secs_f64())?;
    tally.compare(mask.share.iter().zip(&truth.mask.share));

    // cells that the map missed are counted separately, so here they are replaced by the truth
    let mut judged = mask.clone();
    let mut missed = 0;
    if let (Promise::ExactButForMap, Some(exact)) = (trial.promise, exact)
        && mask != *exact
        && let Some(decided) = trial.technique.counted(instant.to_sun)?.and_then(|counted| counted.decided)
    {
        for (cell, decided) in decided.into_iter().enumerate() {
            let by_map = matches!(decided, Decider::MapShadow | Decider::MapLight);
            if by_map && mask.share[cell] != exact.share[cell] {
                judged.share[cell] = truth.mask.share[cell];
                missed += 1;
            }
        }
    }
    let mut difference = Difference::by_half(&judged, &truth.mask);
    let with_thin = difference.other_differ;
    if trial.promise != Promise::Near {
        difference.except_thin(&mut truth.rays, truth.view, instant.to_sun)?;
    }
    let thin = with_thin - difference.other_differ;
    tally.differ(difference, thin, missed, &truth.mask);
    Ok(mask)
}

/// Compares some cells of ray casting with a test of every face.
fn without_trees(cast: &TruthCaster, instant: &Instant, cells: &[(u32, u32)], tally: &mut Tally) {
    let TruthCaster { rays, mask, .. } = cast;
    let share = |&(column, row): &(u32, u32)| rays.share_without_trees(column, row, instant.to_sun);
    let truth: Vec<u8> = cells.par_iter().map(share).collect();
    let shares: Vec<u8> = cells.iter().map(|&(column, row)| mask.share[(row * mask.width + column) as usize]).collect();
    tally.compare(shares.iter().zip(&truth));
    tally.differ(Difference::at(cells, mask, &truth), 0, 0, mask);
}

/// Returns cells spread over a mask, half of them edge cells if there are any. Different numbers give different cells.
pub fn spread(mask: &Mask, numbers: std::ops::Range<usize>) -> Vec<(u32, u32)> {
    let at = |cell: usize| (cell as u32 % mask.width, cell as u32 / mask.width);
    let all = mask.share.len();
    let edge: Vec<usize> = (0..all)
        .filter(|&cell| {
            let (column, row) = at(cell);
            is_edge_cell(mask, column, row)
        })
        .collect();
    // multiples of the golden ratio are spread evenly, however many there are
    let place = |number: usize, among: usize| ((number as f64 * 0.618_033_988_749_895).fract() * among as f64) as usize;
    let cell = |number: usize| match number % 2 {
        0 if !edge.is_empty() => edge[place(number / 2, edge.len())],
        _ => place(number, all),
    };
    numbers.map(|number| at(cell(number))).collect()
}
