//! `gnomon profile`: the study, its files, and what it leaves where it is stopped.

use super::arguments::{ProfileArgs, Written};
use super::commands::{drawn_by, took};
use super::progress::Progress;
use super::{interrupt, say, surfaces};
use crate::export::bits::{self, BitsFile};
use crate::export::figure::Outline;
use crate::export::report::Told;
use crate::export::sums::{self, SumsFile};
use crate::export::{ExportError, bytes, figure, file, raster, report, unfinished};
use crate::profile::{Part, Profile, Shaded, ShadedCells, Timings, Unfinished};
use crate::shadow::PlanSurface;
use crate::site::{Receivers, Site};
use crate::study::{self, Budget, Event, Stopwatch, StudyError, Wants};
use crate::sun::{Instant, SunTrack};
use crate::view::Tile;
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::fmt::Write;
use std::hash::BuildHasher;
use std::iter;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::{self, Duration};

/// How long work may be lost where a machine fails.
const KEEP_EVERY: Duration = Duration::from_secs(60);

/// `gnomon profile`
pub(super) fn profile(asked: &ProfileArgs) -> anyhow::Result<()> {
    let mut watch = Stopwatch::start();
    let site = Site::load(&asked.site.path, &asked.overrides())?;
    if site.receivers == Receivers::Surfaces {
        return surfaces::profile(asked, &site, watch);
    }
    let kinds = asked.wanted(&[Written::Png, Written::Tif, Written::Json])?;
    asked.lines.check(&site.track)?;
    // A folder that cannot be written to is told before the work, not after it.
    for folder in [Some(&asked.out), asked.masks.as_ref()].into_iter().flatten() {
        file::check_folder(folder)?;
    }
    let mut progress = Progress::new(asked.common.quiet);
    if kinds.contains(&Written::Png) || asked.lines.given() {
        progress.letters([site.place.name.as_str()]);
    }
    let mut kept = Files::new(&site, asked)?;
    if let Some(bits) = &kept.bits {
        bits.check_room()?;
        progress.hear(&Event::Note(format!("{} will take {}", bits.path().display(), bytes(bits.size()))));
    }
    let begun = kept.begun(&site)?;
    watch.lap("load");

    let wanted = |kind| kinds.contains(&kind);
    let wants = Wants {
        masks: asked.masks.is_some(),
        bits: asked.bits || asked.lines.outlines(),
        written: FxBuildHasher.hash_one(&asked.masks),
        surface: false,
        statistics: asked.stats,
        whole: asked.lines.given().then_some("--draw"),
        // outlines are not kept
        keep_every: (!asked.lines.outlines()).then_some(KEEP_EVERY),
        budget: asked.memory.map(|bytes| Budget {
            bytes,
            drawing: if wanted(Written::Png) { figure::profile_bytes(&site.grid) } else { 0 },
        }),
    };
    let outcome = study::in_tiles(&site, &wants, begun, &mut |event| {
        progress.hear(&event);
        match (kept.hear(&event, &site), &event) {
            // once an instant is drawn, what is done can be kept
            (ControlFlow::Continue(()), Event::Tile(_) | Event::Summed(_)) => ControlFlow::Continue(()),
            (ControlFlow::Continue(()), _) => interrupt::flow(),
            (stop, _) => stop,
        }
    });
    let outcome = match kept.fault.take() {
        Some(fault) => return Err(fault.into()),
        None => outcome.inspect_err(|_| kept.tell(&mut progress))?,
    };
    watch.laps(outcome.timings);

    let (day_secs, night_secs) = outcome.day_and_night_secs;
    let sums = std::mem::replace(&mut kept.sums, Sums::Memory(Arc::default()));
    let profile = Profile { grid: site.grid, shaded: sums, day_secs, night_secs };
    let drawn = &outcome.drawn;
    let mut files: Vec<(&str, Vec<u8>)> = Vec::new();
    let (place, track, receivers, mesh) = (&site.place, &site.track, site.receivers, &outcome.surface_mesh);
    let surface = LazyLock::new(|| PlanSurface::new(mesh, site.ground, &site.grid));
    let scene = || figure::Scene { place, track, mesh, surface: &*surface, receivers, drawn };
    let picture = || {
        let draw = || figure::profile(&scene(), &profile);
        wanted(Written::Png).then(|| ("profile.png", timed("picture", draw)))
    };
    let raster = || {
        let path = asked.out.join("shadow-hours.tif");
        let raster = || timed("raster", || raster::geotiff_file(&profile, &site.place, &path));
        wanted(Written::Tif).then(raster)
    };
    // much of either is for one processor alone
    let (picture, raster) = rayon::join(picture, raster);
    if let Some((name, (bytes, timing))) = picture {
        files.push((name, bytes?));
        watch.laps(timing);
    }
    let raster = match raster {
        Some((beside, timing)) => {
            watch.laps(timing);
            Some(beside?)
        }
        None => None,
    };
    profile.shaded.check()?;
    kept.check(&mut progress)?;
    // lines are drawn of a plan in one go
    if let (Sums::Memory(shaded), true) = (&profile.shaded, asked.lines.given()) {
        let profile = Profile { grid: site.grid, shaded: Shaded::clone(shaded), day_secs, night_secs };
        files.extend(asked.lines.files(&scene(), &profile, &kept.outlines)?);
        watch.lap("lines");
        kept.check(&mut progress)?;
    }
    let (statistics, timings) = (outcome.statistics.as_ref(), &watch.timings());
    let told = Told { receivers: site.receivers, drawn, timings, statistics, notes: &site.notes };
    let json = report::profile_json(&profile, &site.place, &site.track, &told)?;
    let mut text = written(&asked.out, &files)?;
    if let Some(raster) = raster {
        let _ = writeln!(text, "{}", raster.path().display());
        raster.put_in_place()?;
    }
    if wanted(Written::Json) {
        text += &written(&asked.out, &[("profile.json", json.clone().into_bytes())])?;
    }
    if let Some(bits) = kept.bits.take() {
        let _ = writeln!(text, "{}", bits.path().display());
        bits.finish()?;
    }
    unfinished::remove(&asked.out)?;
    let range = hours(&profile, &site.track);
    profile.shaded.check()?;
    // Windows removes no open file.
    drop(profile);
    sums::remove(&asked.out)?;
    if let Some(folder) = &asked.masks {
        let _ = writeln!(text, "{} ({} masks)", folder.display(), site.track.instants.len());
    }
    if asked.common.json {
        return say(&json);
    }
    let _ = writeln!(text, "{}", drawn_by(drawn));
    text.push_str(&statistics.map(took).unwrap_or_default());
    text.push_str(&range);
    say(&text)
}

/// Writes files into a folder, and names each in a line.
pub(super) fn written(folder: &Path, files: &[(&str, Vec<u8>)]) -> Result<String, ExportError> {
    let mut text = String::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        file::write(&path, bytes)?;
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", path.display());
    }
    Ok(text)
}

/// Work as a stage of its own, that is done beside others.
fn timed<T>(stage: &'static str, work: impl FnOnce() -> T) -> (T, Timings) {
    let started = time::Instant::now();
    let result = work();
    (result, Timings(vec![(stage, started.elapsed().as_secs_f64())]))
}

/// The sums: in memory where the plan is done in one go, else in a file.
enum Sums {
    Memory(Arc<Shaded>),
    File(SumsFile),
}

impl Sums {
    fn check(&self) -> Result<(), ExportError> {
        match self {
            Sums::Memory(_) => Ok(()),
            Sums::File(file) => file.check(),
        }
    }
}

impl ShadedCells for Sums {
    fn cells(&self) -> usize {
        match self {
            Sums::Memory(shaded) => shaded.cells(),
            Sums::File(file) => file.cells(),
        }
    }

    fn part(&self, cells: Range<usize>) -> Part<'_> {
        match self {
            Sums::Memory(shaded) => shaded.part(cells),
            Sums::File(file) => file.part(cells),
        }
    }
}

/// What is written while the study goes on.
struct Files<'a> {
    out: &'a Path,
    masks: Option<&'a Path>,
    bits: Option<BitsFile>,
    /// Each instant's shadow, where outlines are drawn when all is done.
    outlines: Vec<Outline>,
    draws_outlines: bool,
    /// How many instants before each have a sun; one more than there are.
    with_sun: Vec<usize>,
    sums: Sums,
    /// The tile that is worked on, of how many, and whether this run begins anew.
    tile: (Tile, usize),
    is_new: bool,
    /// Whether no tile was begun yet.
    is_first: bool,
    /// Whether there is something to go on from.
    is_kept: bool,
    /// What could not be written.
    fault: Option<ExportError>,
}

impl Files<'_> {
    fn new<'a>(site: &Site, asked: &'a ProfileArgs) -> Result<Files<'a>, ExportError> {
        let bits = asked.bits.then(|| BitsFile::new(&asked.out, site.grid, site.receivers, &site.track)).transpose()?;
        let count = |before: &mut usize, instant: &Instant| {
            *before += usize::from(!instant.night);
            Some(*before)
        };
        let with_sun = iter::once(0).chain(site.track.instants.iter().scan(0, count)).collect();
        Ok(Files {
            with_sun,
            out: &asked.out,
            masks: asked.masks.as_deref(),
            bits,
            outlines: Vec::new(),
            draws_outlines: asked.lines.outlines(),
            sums: Sums::Memory(Arc::default()),
            tile: (site.grid.into(), 1),
            is_new: true,
            is_first: true,
            is_kept: false,
            fault: None,
        })
    }

    /// What a stopped study left, where all that it wrote is still there.
    fn begun(&mut self, site: &Site) -> Result<Option<Unfinished>, ExportError> {
        // nothing keeps the outlines of instants that were drawn before
        if self.draws_outlines {
            return Ok(None);
        }
        let Some(begun) = unfinished::kept(self.out)? else { return Ok(None) };
        let in_tiles = begun.tiles > 1;
        let done = begun.done.min(site.track.instants.len());
        let masks = |folder: &Path| (0..done).all(|index| mask_path(folder, index).is_file());
        let has_masks = self.masks.is_none_or(masks);
        let has_bits = self.bits.as_ref().is_none_or(|bits| bits.has(self.with_sun[done], begun.tiles));
        let has_sums = !in_tiles || sums::has(self.out, &site.grid, study::day_and_night(&site.track).0);
        Ok((has_masks && has_bits && has_sums).then_some(begun))
    }

    /// Fails after Ctrl-C, between stages.
    fn check(&self, progress: &mut Progress) -> Result<(), StudyError> {
        interrupt::check().inspect_err(|_| {
            if !self.is_kept {
                let note = "what is done took little time and is not kept; the same command begins anew";
                progress.hear(&Event::Note(note.to_owned()));
            }
            self.tell(progress);
        })
    }

    /// Tells who ended the work where it goes on.
    fn tell(&self, progress: &mut Progress) {
        if self.is_kept {
            let path = unfinished::path(self.out);
            let note = format!("{} keeps what is done; the same command goes on from there", path.display());
            progress.hear(&Event::Note(note));
        }
    }

    /// Makes room for what is written, before the first tile.
    fn begin(&mut self, site: &Site) -> Result<(), ExportError> {
        if self.is_new {
            // what another study left there is not gone on with, and must not be taken for this one's
            unfinished::remove(self.out)?;
            bits::remove(self.out)?;
            sums::remove(self.out)?;
        }
        if self.tile.1 > 1 {
            let day_secs = study::day_and_night(&site.track).0;
            self.sums = Sums::File(SumsFile::open(self.out, site.grid, day_secs, !self.is_new)?);
        }
        Ok(())
    }

    fn hear(&mut self, event: &Event<'_>, site: &Site) -> ControlFlow<()> {
        match self.write(event, site) {
            Ok(()) => ControlFlow::Continue(()),
            Err(fault) => {
                self.fault = Some(fault);
                ControlFlow::Break(())
            }
        }
    }

    fn write(&mut self, event: &Event<'_>, site: &Site) -> Result<(), ExportError> {
        match event {
            Event::Started { tiles, .. } => self.tile.1 = *tiles,
            Event::GoesOn { .. } => {
                self.is_new = false;
                if let Some(file) = &mut self.bits {
                    file.begin(true)?;
                }
            }
            Event::Tile(tile) => {
                self.tile.0 = *tile;
                if std::mem::take(&mut self.is_first) {
                    self.begin(site)?;
                }
            }
            Event::Summed(shaded) => match &mut self.sums {
                Sums::Memory(sums) => *sums = Arc::clone(shaded),
                Sums::File(file) => file.put(&self.tile.0, shaded)?,
            },
            Event::Drawn { index, mask, bits, .. } => {
                let index = index % site.track.instants.len();
                if let (Some(mask), Some(folder)) = (mask, self.masks) {
                    file::write(&mask_path(folder, index), &raster::mask_png(mask)?)?;
                }
                if let (Some(bits), true) = (bits, self.draws_outlines) {
                    self.outlines.push(Outline { index, shadow: (*bits).clone() });
                }
                if let (Some(bits), Some(file)) = (bits, &mut self.bits) {
                    file.add(self.with_sun[index], &self.tile.0, bits)?;
                }
            }
            // after a fault there is nothing to go on from
            Event::Kept(done) if self.fault.is_none() => {
                if let Some(file) = &mut self.bits {
                    file.sync()?;
                }
                if let Sums::File(file) = &self.sums {
                    file.sync()?;
                }
                unfinished::keep(self.out, done)?;
                self.is_kept = true;
            }
            _ => {}
        }
        Ok(())
    }
}

fn mask_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("mask-{index:04}.png"))
}

/// The range of the answer, in two lines.
fn hours(profile: &Profile<Sums>, track: &SunTrack) -> String {
    let width = profile.grid.width as usize;
    let both = |[least, most]: [u64; 2], [its_least, its_most]: [u64; 2]| [least.min(its_least), most.max(its_most)];
    let of_row = |row: usize| {
        let part = profile.shaded.part(row * width..(row + 1) * width);
        (0..width).map(|cell| [part.of(cell); 2]).fold([u64::MAX, 0], both)
    };
    let rows = (0..profile.grid.height as usize).into_par_iter().with_min_len(64);
    let [least, most] = rows.map(of_row).reduce(|| [u64::MAX, 0], both);
    let hours = |secs: f64| secs / 3600.0;
    let night = track.instants.iter().filter(|instant| instant.night).count();
    format!(
        "{:.2} to {:.2} h of shadow out of {:.2} h with the sun above the horizon\n{} × {} cells of {} m, {} instants{}\n",
        hours(least as f64 / 255.0),
        hours(most as f64 / 255.0),
        hours(f64::from(profile.day_secs)),
        profile.grid.width,
        profile.grid.height,
        (profile.grid.cell * 1e6).round() / 1e6,
        track.instants.len(),
        if night > 0 { format!(", {night} of them at night") } else { String::new() },
    )
}
