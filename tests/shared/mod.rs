//! What several tests need: scenes, drawing them, running the program, and folders.

pub(crate) mod dense;
pub(crate) mod dome;
pub(crate) mod drawing;
pub(crate) mod far_wrong;
pub(crate) mod memory;
pub(crate) mod program;
pub(crate) mod scenes;

use gnomon::message::Message;

/// Notes in plain words.
pub(crate) fn said(notes: &[Message]) -> Vec<String> {
    notes.iter().map(Message::to_string).collect()
}
