//! Sums every instant's shadows to the time in shadow, for the whole plan at once or tile by tile.

use super::again::persist;
use super::chooser::{choose, counting, not_patches};
use super::event::{gather, note_instants_alone, note_tiles};
use super::tile_sum::TileSum;
use super::tiled_study::TiledStudy;
use super::{CountingPurpose, Event, OnEvent, Outcome, SiteView, Stopwatch, StudyError, Wants};
use super::{day_and_night, note_site, subject_of, tell, tiles};
use crate::gpu::Gpu;
use crate::mesh::Mesh;
use crate::message::{Field, Message, aside, message};
use crate::profile::{Profile, Provenance, Shaded, Statistics, Timings, Unfinished};
use crate::shadow::{Technique, plan_surface};
use crate::site::Site;
use crate::sun;
use crate::view::{Surface, Tile, View};
use std::cell::{OnceCell, RefCell};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

/// The result of a study in tiles without the sums, which come with [`Event::Summed`].
#[derive(Clone, Debug)]
pub struct TiledOutcome {
    /// What drew the masks.
    pub drawn: Provenance,
    /// Seconds of the window with the sun above the horizon, and below it.
    pub day_and_night_secs: (u32, u32),
    /// What the cells see, if wanted.
    pub surface: Option<Surface>,
    /// The mesh whose faces are in [`Surface::face`].
    pub surface_mesh: Mesh,
    /// The statistics of counting, if wanted.
    pub statistics: Option<Statistics>,
    /// Notes besides [`Site::notes`].
    pub notes: Vec<Message>,
    /// The stages `prepare` and `shadows`.
    pub timings: Timings,
}

/// Runs the study: sums every instant's shadows to the time in shadow.
///
/// # Errors
/// [`StudyError`]. Contradictory choices are refused before anything is drawn.
pub fn run(site: &Site, wants: &Wants, on_event: &mut OnEvent<'_>) -> Result<Outcome, StudyError> {
    let (mut tile, mut whole) = (Tile::from(site.grid), Arc::default());
    let worked = in_tiles(TiledStudy::new(site, wants, on_event)?, None, &mut |event| {
        match &event {
            Event::StartsOver => whole = Arc::default(),
            // a resumed study would report only the remaining instants
            Event::Resumes { .. } => return ControlFlow::Continue(()),
            Event::Tile(next) => tile = *next,
            Event::Summed(shaded) => whole = paste(&whole, &tile, shaded),
            _ => {}
        }
        on_event(event)
    })?;
    let TiledOutcome { drawn, day_and_night_secs: (day_secs, night_secs), .. } = worked;
    let TiledOutcome { surface, surface_mesh, statistics, notes, timings, .. } = worked;
    let profile = Profile { grid: site.grid, shaded: Arc::unwrap_or_clone(whole), day_secs, night_secs };
    Ok(Outcome { profile, drawn, surface, surface_mesh, statistics, notes, timings })
}

/// The sums of a whole plan with those of a tile pasted in. An empty whole has no sums yet.
pub fn paste(whole: &Arc<Shaded>, tile: &Tile, shaded: &Arc<Shaded>) -> Arc<Shaded> {
    if tile.is_whole() {
        return Arc::clone(shaded);
    }
    let mut cells: Vec<u64> = if whole.is_empty() { vec![0; tile.plan.cells()] } else { whole.iter().collect() };
    let [left, top] = tile.first.map(|first| first as usize);
    let [width, _] = tile.size.map(|size| size as usize);
    for (cell, shaded) in shaded.iter().enumerate() {
        cells[(top + cell / width) * tile.plan.width as usize + left + cell % width] = shaded;
    }
    Arc::new(cells.into())
}

impl<'a> TiledStudy<'a> {
    /// Prepares a study: chooses what draws it, and its tiles.
    ///
    /// # Errors
    /// [`StudyError`], such as contradictory choices or [`StudyError::LittleMemory`].
    pub fn new(site: &'a Site, wants: &Wants, on_event: &mut OnEvent<'_>) -> Result<TiledStudy<'a>, StudyError> {
        not_patches(site)?;
        note_site(site, on_event)?;
        let mut notes = Vec::new();
        let study = TiledStudy::of(None, site, wants, &mut |event| {
            gather(&event, &site.notes, &mut notes);
            on_event(event)
        })?;
        // not a note of the outcome: tiles do not change the result
        note_tiles(&study.tiles, on_event)?;
        Ok(TiledStudy { notes, ..study })
    }

    /// Computes a part of the study, for a program that distributes the work: the shaded time of one tile at some of
    /// the instants, which may come from another process. Time between two instants belongs to the later one. Sums of
    /// instants that make up the track add up to the tile's own sum to the bit, and [`paste`](super::paste) joins
    /// tiles. If the device fails, so does this call. The listener receives [`Event::Drawn`] after each of the instants,
    /// and can end the work also between them ([`Event::Between`]).
    ///
    /// # Errors
    /// [`StudyError::OtherTile`] for a tile of another study; [`StudyError::Shadow`] if drawing fails;
    /// [`StudyError::Interrupted`] if the listener ends the work.
    pub fn sum(&self, tile: Tile, instants: &[sun::Instant], on_event: &mut OnEvent<'_>) -> Result<Shaded, StudyError> {
        if !self.tiles.contains(&tile) {
            return Err(StudyError::OtherTile);
        }
        let mut technique = self.look().technique_of(tile)?;
        let mut sum = TileSum::new(self.site, self.drawn().resolution_secs, self.machine.gpu(), &tile);
        let track = &self.site.track.instants;
        for (index, instant) in instants.iter().enumerate() {
            let at = track.binary_search_by_key(&instant.time, |own| own.time);
            match at.ok().filter(|at| track[*at].weight_secs == instant.weight_secs) {
                _ if instant.night => {}
                Some(at) => {
                    let go_on = &mut || tell(on_event, Event::Between);
                    sum.add(at, technique.as_mut(), &Wants::default(), go_on)?;
                }
                None => sum.add_mask(&technique.draw(instant.to_sun)?, instant.weight_secs)?,
            }
            let (count, time) = (instants.len(), instant.time);
            tell(on_event, Event::Drawn { index, count, time, mask: None, bits: None })?;
        }
        Ok(sum.finish()?)
    }

    fn of(
        gpu: Option<&Arc<Gpu>>,
        site: &'a Site,
        wants: &Wants,
        on_event: &mut OnEvent<'_>,
    ) -> Result<TiledStudy<'a>, StudyError> {
        let watch = Stopwatch::start();
        let view = View::Plan(site.grid);
        let machine = match wants.statistics {
            true => counting(gpu, site, &view, CountingPurpose::Statistics.field())?,
            false => choose(gpu, site, &view, on_event)?,
        };
        let tiles = tiles::of(site, &machine, wants, day_and_night(&site.track).0)?;
        check_tiles(&tiles, wants)?;
        note_instants_alone(site, machine.drawn_over(site, subject_of(site, &view)).resolution_secs, on_event)?;
        Ok(TiledStudy { site, wants: wants.clone(), machine, tiles, number: OnceCell::new(), notes: Vec::new(), watch })
    }
}

/// Sums every instant's shadows. A study that was stopped continues from the state `begun`, and its sums are the same
/// to the bit; tiles before the unfinished one are not reported again. The state of a different study is ignored. After
/// [`Event::StartsOver`] everything is reported from the first instant on, or from the state put into
/// [`Event::Resumes`].
///
/// # Errors
/// [`StudyError`]
pub fn in_tiles(
    tiled: TiledStudy<'_>,
    begun: Option<Unfinished>,
    on_event: &mut OnEvent<'_>,
) -> Result<TiledOutcome, StudyError> {
    let (site, wants) = (tiled.site, tiled.wants.clone());
    // the fingerprint is needed only if the state is kept
    let number = wants.keep_every.map(|_| tiled.number());
    let mut notes = tiled.notes.clone();
    let mut at_hand = Some((tiled, begun));
    let hear: &mut OnEvent<'_> = &mut |event| {
        gather(&event, &site.notes, &mut notes);
        on_event(event)
    };
    // only an adapter reports counts
    let worked = persist(site, !wants.statistics, hear, &mut |again, gpu, on_event| {
        if let Some((tiled, begun)) = at_hand.take() {
            return once(tiled, begun, on_event);
        }
        let mut tiled = TiledStudy::of(gpu, again, &wants, on_event)?;
        let begun = RefCell::new(None);
        if number.is_some_and(|number| number == tiled.number()) {
            tell(on_event, Event::Resumes { study: &tiled, begun: &begun })?;
        } else {
            // what another machine takes over is a different study, and must not be continued as this one
            tiled.wants.keep_every = None;
        }
        once(tiled, begun.into_inner(), on_event)
    })?;
    Ok(TiledOutcome { notes, ..worked })
}

/// As [`in_tiles`], on one machine.
fn once(
    tiled: TiledStudy<'_>,
    begun: Option<Unfinished>,
    on_event: &mut OnEvent<'_>,
) -> Result<TiledOutcome, StudyError> {
    let begun = begun.filter(|begun| tiled.is_of(begun));
    let first = tiled.worked_on(begun.as_ref().map_or(0, |begun| begun.done));
    let study = tiled.wants.keep_every.map_or(0, |_| tiled.number());
    let drawn = tiled.drawn();
    let TiledStudy { site, wants, machine, tiles, mut watch, .. } = tiled;
    let look = SiteView { site, machine: &machine, view: View::Plan(site.grid), receivers: site.receivers };
    let count = tiles.len() * site.track.instants.len();
    let mut statistics = wants.statistics.then(Statistics::default);
    let (mut done, mut begun_with) = (0, None);
    if let Some(begun) = begun {
        (done, statistics, begun_with) = (begun.done, begun.statistics, Some(begun.shaded));
    }
    let mut technique = look.technique_of(tiles[first])?;
    let surface = match wants.surface {
        true if tiles.len() > 1 => Some(plan_surface(&look.surface_mesh(), site.ground.level, &site.grid)),
        true => Some(look.surface(&*technique)?),
        false => None,
    };
    watch.lap("prepare");

    tell(on_event, Event::Started { instants: count, tiles: tiles.len() })?;
    if done > 0 {
        tell(on_event, Event::GoesOn { done })?;
    }
    let kept = (Instant::now(), done > 0);
    let resolution_secs = drawn.resolution_secs;
    let mut work =
        TileWork { look: &look, wants: &wants, resolution_secs, study, tiles: tiles.len(), done, statistics, kept };
    for (number, tile) in tiles.iter().enumerate().skip(first) {
        if number > first && !technique.turn_to_tile(*tile)? {
            technique = look.technique_of(*tile)?;
        }
        tell(on_event, Event::Tile(*tile))?;
        let shaded = work.sum((number, tile), technique.as_mut(), begun_with.take(), on_event)?;
        tell(on_event, Event::Summed(Arc::new(shaded)))?;
    }
    statistics = work.statistics;
    if statistics.is_some_and(|statistics| statistics.cells == 0) {
        tell(on_event, Event::Note(super::NOTHING_COUNTED.to_owned().into()))?;
        statistics = None;
    }
    watch.lap("shadows");
    Ok(TiledOutcome {
        drawn,
        day_and_night_secs: day_and_night(&site.track),
        surface,
        surface_mesh: look.surface_mesh(),
        statistics,
        notes: Vec::new(),
        timings: watch.stages,
    })
}

/// What persists from instant to instant, and from tile to tile.
struct TileWork<'a> {
    look: &'a SiteView<'a>,
    wants: &'a Wants,
    /// The precision of times of change; 0 if none are searched.
    resolution_secs: u32,
    /// The study's fingerprint.
    study: u64,
    /// The number of tiles.
    tiles: usize,
    /// The number of instants done before, counted for each tile.
    done: usize,
    statistics: Option<Statistics>,
    /// When the state was last kept, and whether it was at all.
    kept: (Instant, bool),
}

impl TileWork<'_> {
    /// The sums of a tile, added to those that it was `begun` with.
    fn sum(
        &mut self,
        (number, tile): (usize, &Tile),
        technique: &mut dyn Technique,
        begun: Option<Shaded>,
        on_event: &mut OnEvent<'_>,
    ) -> Result<Shaded, StudyError> {
        let instants = &self.look.site.track.instants;
        let count = self.tiles * instants.len();
        let mut sum = TileSum::new(self.look.site, self.resolution_secs, self.look.machine.gpu(), tile);
        let before = number * instants.len();
        let done_of_it = self.done.saturating_sub(before);
        if let Some(shaded) = begun {
            sum.begin_with(&shaded, done_of_it);
        }
        for (at, instant) in instants.iter().enumerate().skip(done_of_it) {
            let index = before + at;
            // the sums of a gap that is left in its midst are of no use
            let keeps = self.wants.keep_every.is_some() && sum.searches_before(at);
            let before_gap = keeps.then(|| sum.so_far()).transpose()?;
            let added = sum.add(at, technique, self.wants, &mut || tell(on_event, Event::Between));
            if let (Err(StudyError::Interrupted), Some(shaded)) = (&added, before_gap) {
                self.keep(index, shaded, on_event)?;
            }
            let (mask, bits) = added?;
            self.count(instant, technique)?;
            let (mask, bits) = (mask.as_ref(), bits.as_ref());
            let told = tell(on_event, Event::Drawn { index, count, time: instant.time, mask, bits });
            // long work, or work with files, is kept before a drawing is made of it
            let is_last = index + 1 == count && (self.tiles > 1 || self.wants.bits || self.kept.1);
            let is_due = |every| told.is_err() || is_last || self.kept.0.elapsed() >= every;
            if self.wants.keep_every.is_some_and(is_due) {
                self.keep(index + 1, sum.so_far()?, on_event)?;
            }
            told?;
        }
        Ok(sum.finish()?)
    }

    /// Adds the counts of an instant, if statistics are wanted.
    fn count(&mut self, instant: &sun::Instant, technique: &mut dyn Technique) -> Result<(), StudyError> {
        if !instant.night
            && let Some(statistics) = &mut self.statistics
            && let Some(counted) = technique.counted(instant.to_sun)?
        {
            statistics.add(&counted);
        }
        Ok(())
    }

    /// Reports the state after a number of instants.
    fn keep(&mut self, done: usize, shaded: Shaded, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
        let TileWork { study, tiles, statistics, .. } = *self;
        tell(on_event, Event::Kept(&Unfinished { study, tiles, done, shaded, statistics }))?;
        self.kept = (Instant::now(), true);
        Ok(())
    }
}

/// Refuses tiles for outputs that need the whole plan.
fn check_tiles(tiles: &[Tile], wants: &Wants) -> Result<(), StudyError> {
    if tiles.len() < 2 {
        return Ok(());
    }
    if wants.masks {
        let message = message![
            "the plan is done in tiles, but masks are written whole";
            "choose ", Field::Bits, ", which contains the same, or larger cells", aside(Field::Cell)
        ];
        return Err(StudyError::Conflict { field: Field::Masks, message });
    }
    if wants.lines {
        let message = message![
            "the plan is done in tiles, but lines are drawn from the whole";
            "take larger cells", aside(Field::Cell), ", leave ", Field::Memory, " out, or leave this out"
        ];
        return Err(StudyError::Conflict { field: Field::Lines, message });
    }
    Ok(())
}
