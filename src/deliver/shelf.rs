//! What is kept of stopped studies: notes about them, the shelf of a window, and the state of a study on patches.

use super::disk::unfinished::{self, Checks, StoredStudy};
use super::parts::note;
use super::{DeliverError, Folder, Sink};
use crate::profile::Unfinished;
use crate::study::{Event, OnEvent, StudyError, tell};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The most work that is lost if a machine fails.
pub(super) const KEEP_EVERY: Duration = Duration::from_secs(60);

/// The number of stopped studies that are kept on a shelf.
const MOST_KEPT: usize = 4;

/// Which stopped studies in a folder the user is told about.
#[derive(Clone, Copy)]
pub(super) enum Beside<'a> {
    /// All but these, which belong to the same request.
    Studies(&'a [u64]),
    /// None, since another study of the same request is not known yet.
    Unknown,
    /// None, since nobody looks at a shelf.
    Shelf,
}

impl Beside<'_> {
    /// Removes files that no study can continue from, and notes other stopped studies in the folder.
    pub(super) fn tidy(self, folder: &Path, study: u64, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
        match self {
            Beside::Studies(others) => note(unfinished::tidy(folder, &[others, &[study]].concat()), on_event),
            Beside::Shelf => {
                unfinished::tidy(folder, &[study]);
                Ok(())
            }
            Beside::Unknown => Ok(()),
        }
    }
}

/// Notes where a stopped study will continue.
pub(super) fn note_kept(kept: Option<PathBuf>, on_event: &mut OnEvent<'_>) {
    if let Some(path) = kept {
        let note = format!("{} keeps what is done; the same study continues from there", path.display());
        let _ = on_event(Event::Note(note.into()));
    }
}

/// Notes what is kept of work that was ended while files were made, if there is a folder.
pub(super) fn note_end(kept: Option<Option<PathBuf>>, on_event: &mut OnEvent<'_>) {
    if let Some(None) = kept {
        let note = "what is done took little time and is not kept; the same study starts over";
        // whoever ended the work gets no further events
        let _ = on_event(Event::Note(note.to_owned().into()));
    }
    note_kept(kept.flatten(), on_event);
}

/// Notes that a study cannot continue because its files were changed.
pub(super) fn note_refused(path: &Path, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let what = "was changed since the study was stopped: the study starts over";
    note(Some(format!("{} {what}", path.display())), on_event)
}

/// Computes something to be shown. If the study is stopped, it is kept on the shelf among the newest studies, unless
/// another study works there. If it cannot be kept, it is computed nevertheless.
pub(super) fn find<'a, T>(
    shelf: Option<Folder<'a>>,
    on_event: &mut OnEvent<'_>,
    mut work: impl FnMut(Option<&'a Path>, &mut OnEvent<'_>) -> Result<T, DeliverError>,
) -> Result<T, DeliverError> {
    let open = match shelf.map(|folder| Sink::Folder(folder).open(&[], None)).transpose() {
        Ok(open) => open,
        Err(error) => {
            note(Some(format!("{error}; until then what is done is not kept")), on_event)?;
            None
        }
    };
    let folder = open.as_ref().and(shelf).map(|folder| folder.path);
    let mut found = work(folder, on_event);
    if let (Err(DeliverError::Export(error)), Some(_)) = (&found, folder) {
        // the shelf is a convenience: a full one must not stop the work
        note(Some(format!("{error}; the work is done again, and what is done is not kept")), on_event)?;
        tell(on_event, Event::StartsOver)?;
        found = work(None, on_event);
    }
    if let Some(folder) = folder {
        unfinished::keep_newest(folder, MOST_KEPT);
    }
    found
}

/// The state that a study on patches keeps in a folder while it runs.
pub(super) struct PatchStore<'a> {
    folder: Option<&'a Path>,
    beside: Beside<'a>,
    /// The study's fingerprint, once the study is prepared.
    study: Option<u64>,
    is_kept: bool,
    /// The first error of writing.
    fault: Option<DeliverError>,
}

impl<'a> PatchStore<'a> {
    pub(super) fn new(folder: Option<&'a Path>, beside: Beside<'a>) -> PatchStore<'a> {
        PatchStore { folder, beside, study: None, is_kept: false, fault: None }
    }

    /// How often the state is kept; `None` without a folder.
    pub(super) fn keep_every(&self) -> Option<Duration> {
        self.folder.map(|_| KEEP_EVERY)
    }

    /// Stores the data of an event, and passes the event on.
    pub(super) fn hear(&mut self, event: Event<'_>, on_event: &mut OnEvent<'_>) -> ControlFlow<()> {
        let done = match (&event, self.folder) {
            (Event::Prepared { number, begun }, Some(folder)) => {
                self.begun(folder, *number, on_event).map(|kept| *begun.borrow_mut() = kept)
            }
            (Event::Kept(done), Some(folder)) if self.study == Some(done.study) => {
                let kept = unfinished::keep(folder, done, &Checks::default()).map_err(DeliverError::from);
                kept.map(|()| self.is_kept = true)
            }
            _ => Ok(()),
        };
        if let Err(fault) = done {
            self.fault = Some(fault);
            return ControlFlow::Break(());
        }
        on_event(event)
    }

    /// The state of the stopped study.
    fn begun(
        &mut self,
        folder: &Path,
        number: u64,
        on_event: &mut OnEvent<'_>,
    ) -> Result<Option<Unfinished>, DeliverError> {
        match self.study {
            None => {
                self.study = Some(number);
                self.beside.tidy(folder, number, on_event)?;
            }
            // on another device it is a different study, so the first one's state does not fit
            Some(first) if first != number => return Ok(None),
            Some(_) => {}
        }
        match unfinished::kept(folder, number)? {
            StoredStudy::Nothing => Ok(None),
            StoredStudy::Whole(whole) => {
                self.is_kept = true;
                Ok(Some(whole.0))
            }
            StoredStudy::Damaged => {
                note_refused(&unfinished::path(folder, number), on_event)?;
                Ok(None)
            }
        }
    }

    /// The file that keeps the state, if the study can continue from it; `None` without a folder.
    pub(super) fn kept(&self) -> Option<Option<PathBuf>> {
        let kept = |folder| self.study.filter(|_| self.is_kept).map(|study| unfinished::path(folder, study));
        self.folder.map(kept)
    }

    /// The error that ended the work, if something could not be written.
    pub(super) fn take_fault(&mut self) -> Option<DeliverError> {
        self.fault.take()
    }

    /// Called when everything is in place: removes the state.
    pub(super) fn finish(&self) -> Result<(), DeliverError> {
        match self.folder.zip(self.study) {
            Some((folder, study)) => Ok(unfinished::remove(folder, study)?),
            None => Ok(()),
        }
    }
}
