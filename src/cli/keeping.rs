//! What `gnomon profile` writes while the study goes on; and what it goes on from.

use super::arguments::ProfileArgs;
use super::interrupt;
use super::progress::Progress;
use crate::export::bits::BitsFile;
use crate::export::figure::Outline;
use crate::export::sums::SumsFile;
use crate::export::unfinished::{Checks, Kept};
use crate::export::{ExportError, checksum, file, raster, unfinished};
use crate::profile::{Part, Shaded, ShadedCells, Unfinished};
use crate::site::Site;
use crate::study::{self, Event, StudyError, Tiled};
use crate::sun::Instant;
use crate::view::Tile;
use std::iter;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The sums: in memory where the plan is done in one go, else in a file.
pub(super) enum Sums {
    Memory(Arc<Shaded>),
    File(SumsFile),
}

impl Sums {
    pub(super) fn check(&self) -> Result<(), ExportError> {
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
pub(super) struct Files<'a> {
    out: &'a Path,
    /// The study's number.
    study: u64,
    /// The checksums of what was written so far.
    checks: Checks,
    masks: Option<&'a Path>,
    pub(super) bits: Option<BitsFile>,
    /// Each instant's shadow, where outlines are drawn when all is done.
    pub(super) outlines: Vec<Outline>,
    draws_outlines: bool,
    /// How many instants before each have a sun; one more than there are.
    with_sun: Vec<usize>,
    pub(super) sums: Sums,
    /// The sums that are gone on with.
    begun_sums: Option<SumsFile>,
    /// The tile that is worked on, of how many, and whether this run begins anew.
    tile: (Tile, usize),
    is_new: bool,
    /// Whether no tile was begun yet.
    is_first: bool,
    /// Whether there is something to go on from.
    is_kept: bool,
    /// What could not be written.
    pub(super) fault: Option<ExportError>,
}

impl Files<'_> {
    pub(super) fn new<'a>(site: &Site, asked: &'a ProfileArgs, study: u64) -> Result<Files<'a>, ExportError> {
        let bits = || BitsFile::new(&asked.out, study, site.grid, site.receivers, &site.track);
        let bits = asked.bits.then(bits).transpose()?;
        let count = |before: &mut usize, instant: &Instant| {
            *before += usize::from(!instant.night);
            Some(*before)
        };
        let with_sun = iter::once(0).chain(site.track.instants.iter().scan(0, count)).collect();
        Ok(Files {
            with_sun,
            out: &asked.out,
            study,
            checks: Checks::default(),
            masks: asked.masks.as_deref(),
            bits,
            outlines: Vec::new(),
            draws_outlines: asked.lines.outlines(),
            sums: Sums::Memory(Arc::default()),
            begun_sums: None,
            tile: (site.grid.into(), 1),
            is_new: true,
            is_first: true,
            is_kept: false,
            fault: None,
        })
    }

    /// What the study left when it was stopped, where all that it wrote is still there as it was written.
    pub(super) fn begun(
        &mut self,
        study: &Tiled<'_>,
        site: &Site,
        progress: &mut Progress,
    ) -> Result<Option<Unfinished>, ExportError> {
        // nothing keeps the outlines of instants that were drawn before
        if self.draws_outlines {
            return Ok(None);
        }
        let (begun, checks) = match unfinished::kept(self.out, self.study)? {
            Kept::Nothing => return Ok(None),
            Kept::Whole(whole) if study.is_of(&whole.0) => *whole,
            Kept::Whole(_) | Kept::Damaged => return Ok(anew(&unfinished::path(self.out, self.study), progress)),
        };
        if let Some(folder) = self.masks {
            let count = begun.done.min(site.track.instants.len());
            let is_it =
                |index: &usize| checksum::of_file(&mask_path(folder, *index)) == checks.masks.get(*index).copied();
            if let Some(other) = (0..count).find(|index| !is_it(index)) {
                return Ok(anew(&mask_path(folder, other), progress));
            }
        }
        if let Some(bits) = &mut self.bits {
            let count = site.track.instants.len();
            let drawn = (0..begun.done).map(|index| (index % count, study.tiles()[index / count]));
            let with_sun = drawn.filter(|(at, _)| !site.track.instants[*at].night);
            if !bits.go_on(with_sun.map(|(at, tile)| (self.with_sun[at], tile)), checks.bits) {
                return Ok(anew(bits.unfinished(), progress));
            }
        }
        if begun.tiles > 1 {
            let tiles = &study.tiles()[..study.worked_on(begun.done)];
            let day_secs = study::day_and_night(&site.track).0;
            self.begun_sums = SumsFile::go_on(self.out, self.study, site.grid, day_secs, tiles, checks.sums);
            if self.begun_sums.is_none() {
                return Ok(anew(&unfinished::sums_path(self.out, self.study), progress));
            }
        }
        self.checks = checks;
        Ok(Some(begun))
    }

    /// Fails after Ctrl-C, between stages.
    pub(super) fn check(&self, progress: &mut Progress) -> Result<(), StudyError> {
        interrupt::check().inspect_err(|_| {
            if !self.is_kept {
                let note = "what is done took little time and is not kept; the same command begins anew";
                progress.hear(&Event::Note(note.to_owned()));
            }
            self.tell(progress);
        })
    }

    /// The work ends before all is done: what nobody can go on from does not stay.
    pub(super) fn leave(&mut self, progress: &mut Progress) {
        if self.is_new && !self.is_first && !self.is_kept {
            // Windows removes no open file
            (self.bits, self.sums) = (None, Sums::Memory(Arc::default()));
            // the first error is the one to tell
            let _ = unfinished::remove(self.out, self.study);
        }
        self.tell(progress);
    }

    /// Tells who ended the work where it goes on.
    fn tell(&self, progress: &mut Progress) {
        if self.is_kept {
            let path = unfinished::path(self.out, self.study);
            let note = format!("{} keeps what is done; the same command goes on from there", path.display());
            progress.hear(&Event::Note(note));
        }
    }

    /// Makes room for what is written, before the first tile.
    fn begin(&mut self, site: &Site) -> Result<(), ExportError> {
        if self.is_new {
            // what does not go on must not be taken for what does
            unfinished::remove(self.out, self.study)?;
        }
        if self.tile.1 > 1 {
            let day_secs = study::day_and_night(&site.track).0;
            let begin = || SumsFile::begin(self.out, self.study, site.grid, day_secs);
            self.sums = Sums::File(self.begun_sums.take().map_or_else(begin, Ok)?);
        }
        Ok(())
    }

    pub(super) fn hear(&mut self, event: &Event<'_>, site: &Site, progress: &mut Progress) -> ControlFlow<()> {
        let done = match event {
            Event::Resumes { study, begun } => self.begun(study, site, progress).map(|kept| *begun.borrow_mut() = kept),
            event => self.write(event, site),
        };
        match done {
            Ok(()) => ControlFlow::Continue(()),
            Err(fault) => {
                self.fault = Some(fault);
                ControlFlow::Break(())
            }
        }
    }

    fn write(&mut self, event: &Event<'_>, site: &Site) -> Result<(), ExportError> {
        match event {
            Event::Anew => {
                // Windows removes no open file
                (self.is_new, self.is_first, self.is_kept) = (true, true, false);
                (self.sums, self.begun_sums) = (Sums::Memory(Arc::default()), None);
                (self.checks, self.outlines) = (Checks::default(), Vec::new());
                let new = |_| BitsFile::new(self.out, self.study, site.grid, site.receivers, &site.track);
                self.bits = self.bits.take().map(new).transpose()?;
            }
            Event::Started { tiles, .. } => self.tile.1 = *tiles,
            Event::GoesOn { .. } => {
                (self.is_new, self.is_kept) = (false, true);
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
                    let bytes = raster::mask_png(mask)?;
                    file::write(&mask_path(folder, index), &bytes)?;
                    self.checks.masks.push(checksum::checksum(&bytes));
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
                    self.checks.bits = file.checksum();
                }
                if let Sums::File(file) = &self.sums {
                    file.sync()?;
                    self.checks.sums = file.checksum();
                }
                unfinished::keep(self.out, done, &self.checks)?;
                self.is_kept = true;
            }
            _ => {}
        }
        Ok(())
    }
}

/// Tells that what a study left cannot be gone on with.
fn anew(path: &Path, progress: &mut Progress) -> Option<Unfinished> {
    let what = "is not what the study left there when it was stopped: it begins anew";
    progress.note(Some(format!("{} {what}", path.display())));
    None
}

pub(super) fn mask_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("mask-{index:04}.png"))
}
