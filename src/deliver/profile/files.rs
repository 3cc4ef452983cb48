//! Writes computed hours to their files.

use super::hours::{Hours, Range};
use super::request::{DRAWING, ProfileRequest, RASTER, REPORT};
use crate::deliver::DeliverError;
use crate::deliver::disk::bits;
use crate::deliver::parts::{DrawnView, figure_context, report_context};
use crate::deliver::sink::{OpenSink, WholeFile};
use crate::export::report::{self, ReportContext};
use crate::export::{ExportError, figure, raster};
use crate::profile::{Profile, Shaded, Timings};
use crate::shadow::PlanSurface;
use crate::site::Site;
use crate::study::{Stopwatch, StudyError};
use std::path::Path;
use std::sync::LazyLock;
use std::time::Instant;

/// All files, complete but not yet in place.
pub(super) struct Pieces {
    pub(super) ready: Vec<WholeFile>,
    /// `profile.json`
    pub(super) report: String,
    pub(super) range: Range,
}

/// Makes the requested files; `bits` are for the outlines. `stage` is called for each stage, and may end the work.
pub(super) fn make(
    site: &Site,
    hours: &Hours,
    asked: &ProfileRequest<'_>,
    open: &OpenSink<'_>,
    watch: &mut Stopwatch,
    stage: &mut dyn FnMut(&'static str) -> Result<(), StudyError>,
) -> Result<Pieces, DeliverError> {
    let Hours { profile, drawn, surface_mesh: mesh, .. } = hours;
    let surface = LazyLock::new(|| PlanSurface::new(mesh, site.ground.level, &site.grid));
    let scene = || figure_context(site, DrawnView { receivers: site.receivers, surface: &*surface, mesh, drawn });
    let picture = || asked.drawing.then(|| timed("picture", || figure::profile(&scene(), profile)));
    let raster = || asked.raster.then(|| timed("raster", || raster_of(site, hours, open)));
    // much of both runs on a single processor
    let (picture, raster) = rayon::join(picture, raster);
    let mut files = Vec::new();
    if let Some((bytes, timing)) = picture {
        files.push((DRAWING.into(), bytes?));
        watch.laps(timing);
    }
    let raster = match raster {
        Some((ready, timing)) => {
            watch.laps(timing);
            Some(ready?)
        }
        None => None,
    };
    profile.shaded.check()?;
    stage("picture")?;
    if let (Some(shaded), false) = (hours.shaded(), asked.lines.is_empty()) {
        let Profile { grid, day_secs, night_secs, .. } = *profile;
        let profile = Profile { grid, shaded: Shaded::clone(shaded), day_secs, night_secs };
        for lines in asked.lines {
            files.extend(lines.files(&scene(), &profile, &hours.outlines)?);
        }
        watch.lap("lines");
        stage("lines")?;
    }
    let timings = &watch.timings();
    let (notes, statistics) = (&[&site.notes[..], &hours.notes].concat(), hours.statistics.as_ref());
    let told = ReportContext { notes, ..report_context(site, site.receivers, drawn, timings, statistics) };
    let report = report::profile_json(profile, &site.place, &site.track, &told)?;
    // all files are complete before the first is put in place
    let mut ready = files.into_iter().map(|file| open.ready(file)).collect::<Result<Vec<_>, _>>()?;
    ready.extend(raster);
    if asked.report {
        ready.push(open.ready((REPORT.into(), report.clone().into_bytes()))?);
    }
    if asked.bits {
        let shadows = hours.outlines.iter().map(|outline| &outline.shadow);
        let bytes = bits::encode(site.grid, site.receivers, &site.track, shadows)?;
        ready.push(open.ready((bits::NAME.into(), bytes))?);
    }
    let range = hours.range();
    profile.shaded.check()?;
    // syncing large files takes long, and nothing has been replaced so far
    stage("files")?;
    Ok(Pieces { ready, report, range })
}

/// Writes the raster to a temporary name while it is computed.
fn raster_of(site: &Site, hours: &Hours, open: &OpenSink<'_>) -> Result<WholeFile, ExportError> {
    match open.path(Path::new(RASTER)) {
        Some(path) => {
            let beside = raster::geotiff_file(&hours.profile, &site.place, &path)?;
            beside.sync()?;
            Ok(WholeFile::Disk(beside))
        }
        None => open.ready((RASTER.into(), raster::geotiff(&hours.profile, &site.place)?)),
    }
}

/// Times work that is a stage of its own, concurrent with other work.
fn timed<T>(stage: &'static str, work: impl FnOnce() -> T) -> (T, Timings) {
    let started = Instant::now();
    let result = work();
    (result, Timings(vec![(stage, started.elapsed().as_secs_f64())]))
}
