//! The definition of a reference system, and the error for a text that does not name one.

use crate::message::{Message, message};

/// A system's definition, before its conversion is set up.
#[derive(Debug)]
pub(super) struct Definition {
    pub name: String,
    /// The definition as text for PROJ.
    pub proj: String,
    pub height_unit_m: Option<f64>,
    pub doubt: Option<&'static str>,
}

/// A text shortened for a message.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 60;
    let one_line: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match one_line.char_indices().nth(MOST) {
        Some((end, _)) => format!("\"{}…\"", &one_line[..end]),
        None => format!("\"{one_line}\""),
    }
}

pub(super) fn unknown(text: &str) -> Message {
    message![
        format!("{} is not a reference system that Gnomon knows", shortened(text));
        "write its number in the EPSG dataset, for example \"EPSG:25832\""
    ]
}
