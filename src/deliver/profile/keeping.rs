//! Writes a study's files while it runs, and continues a stopped one.

use super::request::{ProfileRequest, mask_path};
use super::sums::Sums;
use crate::deliver::disk::bits::BitsFile;
use crate::deliver::disk::sums::SumsFile;
use crate::deliver::disk::unfinished::{self, Checks, StoredStudy};
use crate::deliver::parts::note;
use crate::deliver::shelf::{self, Beside};
use crate::deliver::{DeliverError, NamedFile};
use crate::export::figure::Outline;
use crate::export::{ExportError, bytes, checksum, file, raster};
use crate::profile::Unfinished;
use crate::site::Site;
use crate::study::{self, Event, OnEvent, StudyError, TiledStudy, tell};
use crate::sun::Instant;
use crate::view::{Bits, Tile};
use std::iter;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is written while the study runs: to a folder, from which the study can continue later, or to memory only.
pub(in crate::deliver) struct StudyStore<'a> {
    folder: Option<&'a Path>,
    /// The study's fingerprint.
    study: u64,
    /// The checksums of everything written so far.
    checks: Checks,
    /// The folder for the masks.
    masks: Option<&'a Path>,
    /// The masks, if there is no folder.
    pub(super) held_masks: Vec<NamedFile>,
    pub(super) bits: Option<BitsFile>,
    /// Each instant's shadow, if it is needed at the end.
    pub(super) outlines: Vec<Outline>,
    holds_outlines: bool,
    /// For each instant, the number of earlier instants with a sun; and the total at the end.
    with_sun: Vec<usize>,
    pub(super) sums: Sums,
    /// The sums of the stopped study that is continued.
    begun_sums: Option<SumsFile>,
    /// The current tile, and the number of tiles.
    tile: (Tile, usize),
    is_new: bool,
    /// Whether no tile was begun yet.
    is_first: bool,
    /// Whether there is a state from which the study can continue.
    is_kept: bool,
    /// The first error of writing.
    fault: Option<DeliverError>,
}

impl StudyStore<'_> {
    pub(super) fn new<'a>(
        site: &Site,
        asked: &ProfileRequest<'a>,
        folder: Option<&'a Path>,
        study: &TiledStudy<'_>,
    ) -> Result<StudyStore<'a>, ExportError> {
        let number = folder.map_or(0, |_| study.number());
        let bits = |folder| BitsFile::new(folder, number, site.grid, site.receivers, &site.track);
        let count = |before: &mut usize, instant: &Instant| {
            *before += usize::from(!instant.night);
            Some(*before)
        };
        Ok(StudyStore {
            with_sun: iter::once(0).chain(site.track.instants.iter().scan(0, count)).collect(),
            folder,
            study: number,
            checks: Checks::default(),
            masks: asked.masks,
            held_masks: Vec::new(),
            bits: folder.filter(|_| asked.bits).map(bits).transpose()?,
            outlines: Vec::new(),
            holds_outlines: asked.holds_outlines() || (asked.bits && folder.is_none()),
            sums: Sums::Memory(Arc::default()),
            begun_sums: None,
            tile: (site.grid.into(), 1),
            is_new: true,
            is_first: true,
            is_kept: false,
            fault: None,
        })
    }

    /// Notes what else is in the folder, and the size of what will be written.
    pub(super) fn look_around(&self, beside: Beside<'_>, on_event: &mut OnEvent<'_>) -> Result<(), DeliverError> {
        let Some(folder) = self.folder else { return Ok(()) };
        beside.tidy(folder, self.study, on_event)?;
        if let Some(bits) = &self.bits {
            bits.check_room()?;
            let is_to_stay = !matches!(beside, Beside::Shelf);
            let will_take = || format!("{} will take {}", bits.path().display(), bytes(bits.size()));
            note(is_to_stay.then(will_take), on_event)?;
        }
        Ok(())
    }

    /// The state of the stopped study, if all of its files are unchanged.
    pub(super) fn begun(
        &mut self,
        study: &TiledStudy<'_>,
        site: &Site,
        on_event: &mut OnEvent<'_>,
    ) -> Result<Option<Unfinished>, DeliverError> {
        // outlines of earlier instants are not stored
        let Some(folder) = self.folder.filter(|_| !self.holds_outlines) else { return Ok(None) };
        let (begun, checks) = match unfinished::kept(folder, self.study)? {
            StoredStudy::Nothing => return Ok(None),
            StoredStudy::Whole(whole) if study.is_of(&whole.0) => *whole,
            StoredStudy::Whole(_) | StoredStudy::Damaged => {
                shelf::note_refused(&unfinished::path(folder, self.study), on_event)?;
                return Ok(None);
            }
        };
        if let Some(other) = self.other_than_written(folder, study, site, &begun, &checks) {
            shelf::note_refused(&other, on_event)?;
            return Ok(None);
        }
        self.checks = checks;
        Ok(Some(begun))
    }

    /// Continues the study's other files. Returns the one that was changed, if any was.
    fn other_than_written(
        &mut self,
        folder: &Path,
        study: &TiledStudy<'_>,
        site: &Site,
        begun: &Unfinished,
        checks: &Checks,
    ) -> Option<PathBuf> {
        let count = site.track.instants.len();
        if let Some(masks) = self.masks {
            let is_it =
                |index: &usize| checksum::of_file(&mask_path(masks, *index)) == checks.masks.get(*index).copied();
            if let Some(other) = (0..begun.done.min(count)).find(|index| !is_it(index)) {
                return Some(mask_path(masks, other));
            }
        }
        if let Some(bits) = &mut self.bits {
            let drawn = (0..begun.done).map(|index| (index % count, study.tiles()[index / count]));
            let with_sun = drawn.filter(|(at, _)| !site.track.instants[*at].night);
            if !bits.go_on(with_sun.map(|(at, tile)| (self.with_sun[at], tile)), checks.bits) {
                return Some(bits.unfinished().to_owned());
            }
        }
        if begun.tiles > 1 {
            let tiles = &study.tiles()[..study.worked_on(begun.done)];
            let day_secs = study::day_and_night(&site.track).0;
            self.begun_sums = SumsFile::go_on(folder, self.study, site.grid, day_secs, tiles, checks.sums);
            if self.begun_sums.is_none() {
                return Some(unfinished::sums_path(folder, self.study));
            }
        }
        None
    }

    /// Reports that a stage of making the files is done.
    pub(in crate::deliver) fn stage(&self, stage: &'static str, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
        tell(on_event, Event::Stage(stage)).inspect_err(|_| shelf::note_end(self.folder.map(|_| self.kept()), on_event))
    }

    /// The fingerprint of the study.
    pub(in crate::deliver) fn number(&self) -> u64 {
        self.study
    }

    /// The file with the state, if there is a state from which the study can continue.
    pub(in crate::deliver) fn kept(&self) -> Option<PathBuf> {
        self.folder.filter(|_| self.is_kept).map(|folder| unfinished::path(folder, self.study))
    }

    /// Called when the work ends early: removes files that no study can continue from.
    pub(super) fn leave(&mut self, on_event: &mut OnEvent<'_>) {
        if let Some(folder) = self.folder
            && self.is_new
            && !self.is_first
            && !self.is_kept
        {
            // Windows cannot remove an open file
            (self.bits, self.sums) = (None, Sums::Memory(Arc::default()));
            // the first error is reported
            let _ = unfinished::remove(folder, self.study);
        }
        shelf::note_kept(self.kept(), on_event);
    }

    /// Called when everything is in place: removes the state.
    pub(in crate::deliver) fn finish(&self) -> Result<(), ExportError> {
        self.folder.map_or(Ok(()), |folder| unfinished::remove(folder, self.study))
    }

    /// The error that ended the work, if something could not be written.
    pub(super) fn take_fault(&mut self) -> Option<DeliverError> {
        self.fault.take()
    }

    /// Checks that there is room for everything, before the first tile.
    fn begin(&mut self, site: &Site) -> Result<(), ExportError> {
        let Some(folder) = self.folder else { return Ok(()) };
        if self.is_new {
            // files that are not continued must not look as if they were
            unfinished::remove(folder, self.study)?;
        }
        if self.tile.1 > 1 {
            let day_secs = study::day_and_night(&site.track).0;
            let begin = || SumsFile::begin(folder, self.study, site.grid, day_secs);
            self.sums = Sums::File(self.begun_sums.take().map_or_else(begin, Ok)?);
        }
        Ok(())
    }

    /// Writes the data of an event, and passes the event on. The work can only be ended once an instant is drawn and
    /// the state can be stored.
    pub(super) fn hear(&mut self, event: Event<'_>, site: &Site, on_event: &mut OnEvent<'_>) -> ControlFlow<()> {
        let done = match &event {
            // the study starts again on another device, and asks for its state
            Event::Resumes { study, begun } => self.begun(study, site, on_event).map(|kept| *begun.borrow_mut() = kept),
            event => self.write(event, site).map_err(DeliverError::from),
        };
        if let Err(fault) = done {
            self.fault = Some(fault);
            return ControlFlow::Break(());
        }
        let goes_on = matches!(event, Event::Tile(_) | Event::Summed(_));
        match on_event(event) {
            ControlFlow::Break(()) if !goes_on => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }

    fn write(&mut self, event: &Event<'_>, site: &Site) -> Result<(), ExportError> {
        match event {
            Event::StartsOver => {
                // Windows cannot remove an open file
                (self.is_new, self.is_first, self.is_kept) = (true, true, false);
                (self.sums, self.begun_sums) = (Sums::Memory(Arc::default()), None);
                (self.checks, self.outlines, self.held_masks) = (Checks::default(), Vec::new(), Vec::new());
                if let (Some(folder), Some(_)) = (self.folder, self.bits.take()) {
                    self.bits = Some(BitsFile::new(folder, self.study, site.grid, site.receivers, &site.track)?);
                }
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
                Sums::Memory(sums) => *sums = study::paste(sums, &self.tile.0, shaded),
                Sums::File(file) => file.put(&self.tile.0, shaded)?,
            },
            Event::Drawn { index, mask, bits, .. } => {
                let index = index % site.track.instants.len();
                if let (Some(mask), Some(folder)) = (mask, self.masks) {
                    self.put_mask(mask_path(folder, index), raster::mask_png(mask)?)?;
                }
                if let (Some(bits), true) = (bits, self.holds_outlines) {
                    self.hold(index, bits);
                }
                if let (Some(bits), Some(file)) = (bits, &mut self.bits) {
                    file.add(self.with_sun[index], &self.tile.0, bits)?;
                }
            }
            // after an error there is no state to continue from
            Event::Kept(done) if self.fault.is_none() => self.keep(done)?,
            Event::Note(_)
            | Event::Kept(_)
            | Event::Stage(_)
            | Event::Between
            | Event::Resumes { .. }
            | Event::Prepared { .. } => {}
        }
        Ok(())
    }

    fn put_mask(&mut self, path: PathBuf, bytes: Vec<u8>) -> Result<(), ExportError> {
        if self.folder.is_none() {
            self.held_masks.push((path, bytes));
            return Ok(());
        }
        file::write(&path, &bytes)?;
        self.checks.masks.push(checksum::checksum(&bytes));
        Ok(())
    }

    /// Adds a tile's part of an instant's shadow.
    fn hold(&mut self, index: usize, bits: &Bits) {
        let tile = &self.tile.0;
        if tile.is_whole() {
            self.outlines.push(Outline { index, shadow: bits.clone() });
            return;
        }
        let at = self.with_sun[index];
        if at == self.outlines.len() {
            self.outlines.push(Outline { index, shadow: Bits::new(tile.plan.width, tile.plan.height) });
        }
        self.outlines[at].shadow.paste(tile, bits);
    }

    /// Flushes everything to the disk, and writes the state.
    fn keep(&mut self, done: &Unfinished) -> Result<(), ExportError> {
        let Some(folder) = self.folder else { return Ok(()) };
        if let Some(file) = &mut self.bits {
            file.sync()?;
            self.checks.bits = file.checksum();
        }
        if let Sums::File(file) = &self.sums {
            file.sync()?;
            self.checks.sums = file.checksum();
        }
        unfinished::keep(folder, done, &self.checks)?;
        self.is_kept = true;
        Ok(())
    }
}
