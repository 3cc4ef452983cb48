//! The events of a study.

use super::gaps::Gaps;
use super::{StudyError, TiledStudy};
use crate::message::{Field, Message, message};
use crate::profile::{Shaded, Unfinished};
use crate::site::Site;
use crate::sun::Zone;
use crate::view::{Bits, Mask, Tile};
use chrono::DateTime;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Something that happens while a study runs.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// Something that the user should know about the result.
    Note(Message),
    /// A graphics adapter failed, and the work starts again. Everything that was reported is void, except for notes.
    StartsOver,
    /// The same study runs again. A listener that has stored its state ([`Event::Kept`]) can put it here, and the study
    /// continues from there.
    Resumes {
        /// The study.
        study: &'a TiledStudy<'a>,
        /// The state from which the study is to continue.
        begun: &'a RefCell<Option<Unfinished>>,
    },
    /// A study on patches whose state is to be kept (`patches_kept`) is prepared. A listener that has stored a state
    /// can put it here, and the study continues from there.
    Prepared {
        /// The study's fingerprint: a number made of everything that its result depends on.
        number: u64,
        /// The state from which the study is to continue.
        begun: &'a RefCell<Option<Unfinished>>,
    },
    /// Everything is prepared; drawing begins.
    Started {
        /// The number of instants, summed over the tiles.
        instants: usize,
        /// The number of tiles.
        tiles: usize,
    },
    /// Some of the instants were computed before the study was stopped, and are not drawn again.
    GoesOn {
        /// Their number.
        done: usize,
    },
    /// A tile of the plan begins or continues: the next instants belong to it.
    Tile(Tile),
    /// The tile's sums, once all of its instants are done.
    Summed(Arc<Shaded>),
    /// One instant is done. Within a tile instants come in order of time.
    Drawn {
        /// Its index, from 0.
        index: usize,
        /// The number of instants.
        count: usize,
        /// The local clock time at the place.
        time: DateTime<Zone>,
        /// Its mask, if masks are wanted.
        mask: Option<&'a Mask>,
        /// Which cells are in shadow, if that is wanted and the sun is up.
        bits: Option<&'a Bits>,
    },
    /// Some of the time before the next instant was searched. There is nothing to say of it; a listener may end the work.
    Between,
    /// The state so far. A listener that keeps it can continue the study later.
    Kept(&'a Unfinished),
    /// One more stage is done: of making files after the study, or of judging.
    Stage(&'static str),
}

/// Receives the events; [`ControlFlow::Break`] ends the work with [`StudyError::Interrupted`].
pub type OnEvent<'a> = dyn FnMut(Event<'_>) -> ControlFlow<()> + 'a;

/// Passes an event to the listener.
///
/// # Errors
/// [`StudyError::Interrupted`] if the listener ends the work.
pub(crate) fn tell(on_event: &mut OnEvent<'_>, event: Event<'_>) -> Result<(), StudyError> {
    match on_event(event) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(StudyError::Interrupted),
    }
}

/// Refuses a site whose lists do not match its components, as a program may have set them; then passes on its notes.
///
/// # Errors
/// [`StudyError::Components`]; [`StudyError::Interrupted`] if the listener ends the work.
pub(crate) fn note_site(site: &Site, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let components = site.mesh.components.len();
    for (list, flags) in [("casts", &site.casts), ("receives", &site.receives)] {
        if flags.len() != components {
            return Err(StudyError::Components { list, length: flags.len(), components });
        }
    }
    note_models(&site.notes, on_event)
}

/// Passes on the notes on the models: how they were read, how exact they are, and where they stand.
///
/// # Errors
/// [`StudyError::Interrupted`] if the listener ends the work.
pub(crate) fn note_models(notes: &[Message], on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    notes.iter().try_for_each(|note| tell(on_event, Event::Note(note.clone())))
}

/// Collects the note of an event, unless it is known or already collected.
pub(crate) fn gather(event: &Event<'_>, known: &[Message], notes: &mut Vec<Message>) {
    if let Event::Note(note) = event
        && !known.contains(note)
        && !notes.contains(note)
    {
        notes.push(note.clone());
    }
}

/// A note if hours are summed from the instants alone although times of change were requested.
pub(super) fn note_instants_alone(site: &Site, found_secs: u32, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    if found_secs > 0 || !Gaps::new(site, site.track.resolution_secs).any() {
        return Ok(());
    }
    let note = message![
        "hours are summed from the instants alone: only exact techniques, with the \
         sun as a point, find the light's changes between them";
        "choose such a technique, or set ", (Field::Resolution, "step")
    ];
    tell(on_event, Event::Note(note))
}

/// A note if the plan is done in tiles.
pub(super) fn note_tiles(tiles: &[Tile], on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let [first, _, ..] = tiles else { return Ok(()) };
    let [width, height] = first.size;
    tell(on_event, Event::Note(format!("the plan is done in {} tiles of {width} × {height} cells", tiles.len()).into()))
}
