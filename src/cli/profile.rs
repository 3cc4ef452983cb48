//! `gnomon profile`: the study, its files, and what it leaves where it is stopped.

use super::arguments::{ProfileArgs, Written};
use super::commands::{drawn_by, took};
use super::keeping::{Files, Sums, mask_path};
use super::progress::Progress;
use super::{interrupt, say, surfaces, who};
use crate::export::file::Beside;
use crate::export::report::Told;
use crate::export::workplace::Workplace;
use crate::export::{ExportError, bytes, figure, file, raster, report, unfinished};
use crate::profile::{Profile, Shaded, ShadedCells, Timings};
use crate::shadow::PlanSurface;
use crate::site::{Receivers, Site, inputs};
use crate::study::{self, Budget, Event, Stopwatch, Tiled, Wants};
use crate::sun::SunTrack;
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::fmt::Write;
use std::hash::BuildHasher;
use std::ops::ControlFlow;
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
    let outputs = outputs(asked, &kinds, &site);
    file::check_inputs(&inputs(&asked.site.path)?, &outputs)?;
    // A folder that cannot be written to is told before the work, not after it.
    let folders = [Some(&asked.out), asked.masks.as_ref()].into_iter().flatten().map(PathBuf::as_path);
    let workplace = Workplace::take(folders, &outputs, &who())?;
    let mut progress = Progress::new(asked.common.quiet);
    progress.note(workplace.note());
    if kinds.contains(&Written::Png) || asked.lines.given() {
        progress.letters([site.place.name.as_str()]);
    }
    watch.lap("load");

    let wanted = |kind| kinds.contains(&kind);
    // by which way a folder is named makes no other study
    let masks = asked.masks.as_ref().map(|folder| folder.canonicalize().unwrap_or_else(|_| folder.clone()));
    let wants = Wants {
        masks: asked.masks.is_some(),
        bits: asked.bits || asked.lines.outlines(),
        written: FxBuildHasher.hash_one(&masks),
        surface: false,
        statistics: asked.stats,
        lines: asked.lines.given(),
        // outlines are not kept
        keep_every: (!asked.lines.outlines()).then_some(KEEP_EVERY),
        budget: asked.memory.map(|bytes| Budget {
            bytes,
            drawing: if wanted(Written::Png) { figure::profile_bytes(&site.grid) } else { 0 },
        }),
    };
    let tiled = Tiled::new(&site, &wants, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    let number = tiled.number();
    let mut kept = Files::new(&site, asked, number)?;
    progress.note(unfinished::tidy(&asked.out, number));
    if let Some(bits) = &kept.bits {
        bits.check_room()?;
        progress.note(Some(format!("{} will take {}", bits.path().display(), bytes(bits.size()))));
    }
    let begun = kept.begun(&tiled, &site, &mut progress)?;
    let outcome = study::in_tiles(tiled, begun, &mut |event| {
        progress.hear(&event);
        match (kept.hear(&event, &site, &mut progress), &event) {
            // once an instant is drawn, what is done can be kept
            (ControlFlow::Continue(()), Event::Tile(_) | Event::Summed(_)) => ControlFlow::Continue(()),
            (ControlFlow::Continue(()), _) => interrupt::flow(),
            (stop, _) => stop,
        }
    });
    let outcome = match kept.fault.take() {
        Some(fault) => Err(anyhow::Error::from(fault)),
        None => outcome.map_err(anyhow::Error::from),
    };
    let outcome = outcome.inspect_err(|_| kept.leave(&mut progress))?;
    watch.laps(outcome.timings);

    let (day_secs, night_secs) = outcome.day_and_night_secs;
    let sums = std::mem::replace(&mut kept.sums, Sums::Memory(Arc::default()));
    let profile = Profile { grid: site.grid, shaded: sums, day_secs, night_secs };
    let drawn = &outcome.drawn;
    let mut files: Vec<(&str, Vec<u8>)> = Vec::new();
    let Site { place, track, receivers, ground, .. } = &site;
    let (receivers, ground, mesh) = (*receivers, *ground, &outcome.surface_mesh);
    let surface = LazyLock::new(|| PlanSurface::new(mesh, ground.level, &site.grid));
    let scene = || figure::Scene { place, track, mesh, surface: &*surface, receivers, ground, drawn };
    let picture = || {
        let draw = || figure::profile(&scene(), &profile);
        wanted(Written::Png).then(|| (Written::Png.file(site.receivers), timed("picture", draw)))
    };
    let raster = || {
        let path = asked.out.join(Written::Tif.file(site.receivers));
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
    let told = Told { receivers, ground, drawn, timings, statistics, notes: &site.notes };
    let json = report::profile_json(&profile, &site.place, &site.track, &told)?;
    // all are there before the first is put in its place
    let beside = |(name, bytes): &(&str, Vec<u8>)| Beside::of(&asked.out.join(name), bytes);
    let mut whole = files.iter().map(beside).collect::<Result<Vec<_>, _>>()?;
    if let Some(raster) = raster {
        raster.sync()?;
        whole.push(raster);
    }
    if wanted(Written::Json) {
        whole.push(beside(&(Written::Json.file(site.receivers), json.clone().into_bytes()))?);
    }
    let range = hours(&profile, &site.track);
    profile.shaded.check()?;
    // to sync large files takes long, and until here nothing is replaced
    kept.check(&mut progress)?;
    workplace.check()?;
    let mut text = String::new();
    for file in whole {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", file.path().display());
        file.put_in_place()?;
    }
    if let Some(bits) = kept.bits.take() {
        let _ = writeln!(text, "{}", bits.path().display());
        bits.finish()?;
    }
    // Windows removes no open file.
    drop(profile);
    unfinished::remove(&asked.out, number)?;
    if let Some(folder) = &asked.masks {
        let count = site.track.instants.len();
        let _ = writeln!(text, "{} ({count} masks)", folder.display());
        let beyond = Some(mask_path(folder, count)).filter(|path| path.exists());
        progress
            .note(beyond.map(|path| format!("{} and what follows it is of another study; remove it", path.display())));
    }
    if asked.common.json {
        return say(&json);
    }
    let _ = writeln!(text, "{}", drawn_by(drawn, &ground));
    text.push_str(&statistics.map(took).unwrap_or_default());
    text.push_str(&range);
    say(&text)
}

/// All that is written.
fn outputs(asked: &ProfileArgs, kinds: &[Written], site: &Site) -> Vec<PathBuf> {
    let bits = asked.bits.then_some("shadow.bits");
    let names = kinds.iter().map(|kind| kind.file(site.receivers)).chain(asked.lines.names()).chain(bits);
    let masks =
        asked.masks.iter().flat_map(|folder| (0..site.track.instants.len()).map(|index| mask_path(folder, index)));
    names.map(|name| asked.out.join(name)).chain(masks).collect()
}

/// Writes files into a folder, and names each in a line.
pub(super) fn written(folder: &Path, files: &[(&str, Vec<u8>)]) -> Result<String, ExportError> {
    file::write_all(folder, files)?;
    Ok(files.iter().map(|(name, _)| format!("{}\n", folder.join(name).display())).collect())
}

/// Work as a stage of its own, that is done beside others.
fn timed<T>(stage: &'static str, work: impl FnOnce() -> T) -> (T, Timings) {
    let started = time::Instant::now();
    let result = work();
    (result, Timings(vec![(stage, started.elapsed().as_secs_f64())]))
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
