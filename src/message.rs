//! Messages for people that do not depend on the face that shows them: text in which the fields of the request are
//! marked.
//!
//! An error or a note names a [`Field`], and each face has [`Words`] for it: the command an option, the window a label.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// The fields of a request, each with its name outside of the faces.
macro_rules! fields {
    ($($(#[$doc:meta])* $field:ident => $name:literal,)+) => {
        /// The fields of a request.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[non_exhaustive]
        pub enum Field { $($(#[$doc])* $field,)+ }

        impl Field {
            /// All fields.
            pub const ALL: &'static [Field] = &[$(Field::$field,)+];

            /// Its name where no face has a word for it.
            pub fn name(self) -> &'static str {
                match self { $(Field::$field => $name,)+ }
            }
        }
    };
}

fields! {
    /// Latitude and longitude.
    Place => "place",
    /// The up axis of all models.
    Up => "up",
    /// The height of footprints whose files give none.
    DefaultHeight => "default height",
    /// The time limit of reading a model.
    ReadTime => "time to read a model",
    /// The memory limit of reading a model.
    ReadMemory => "memory to read a model",
    /// The list of what a model contains, and of what was left out.
    Check => "check",
    /// The height of the ground.
    Ground => "ground",
    /// The day of the study.
    Date => "date",
    /// The first of several days.
    FromDate => "first day",
    /// The last of several days.
    ToDate => "last day",
    /// The beginning of the window.
    From => "from",
    /// Its end.
    To => "to",
    /// The time between two instants.
    Step => "step",
    /// The precision of times of change.
    Resolution => "resolution",
    /// A single instant, instead of the study.
    At => "instant",
    /// A single probe, instead of the site file's.
    Point => "point",
    /// That probe's normal.
    Normal => "normal",
    /// A table of points.
    Points => "table of points",
    /// Components on which points are laid.
    On => "components with points",
    /// The distance between points along walls.
    Spacing => "spacing of points",
    /// The height of these points above the ground.
    Height => "height of points",
    /// The rectangle of the plan.
    Region => "region",
    /// The side of a cell.
    Cell => "cell",
    /// The number of cells along the longer side.
    Size => "size",
    /// What is judged.
    Receivers => "receivers",
    /// The view from which the shadows are seen.
    View => "view",
    /// The side of a texel on patches.
    PatchCell => "cell on surfaces",
    /// How shadows are found.
    Technique => "technique",
    /// The finder of silhouettes.
    Silhouette => "silhouette",
    /// The depth of the paper's hextree.
    HextreeDepth => "hextree depth",
    /// The machine that draws.
    Engine => "engine",
    /// The number of texels along a shadow map's side.
    MapSize => "map size",
    /// The filter of a shadow map's comparisons.
    Pcf => "filter",
    /// The width of smoothies.
    SmoothieWidth => "smoothie width",
    /// The number of points of the sun's disc.
    SunSamples => "points of the sun's disc",
    /// Volumes and silhouette over the picture.
    Volumes => "volumes and silhouette",
    /// A diagram of whether the map or the volumes decide each cell.
    MaskDiagram => "picture of the mask",
    /// A diagram of the number of counted fragments.
    OverdrawDiagram => "picture of the overdraw",
    /// The statistics of counting.
    Statistics => "statistics",
    /// Line drawings.
    Lines => "drawings of lines",
    /// A drawing of the outlines at each instant.
    Outlines => "a drawing of outlines",
    /// Every instant's mask.
    Masks => "masks",
    /// Every instant's mask, one bit per cell.
    Bits => "bits",
    /// The memory budget.
    Memory => "memory",
    /// The hours of sun that must stay.
    Hours => "hours",
    /// The drawing of a point's sky.
    Sky => "a drawing of the sky",
    /// The path of the answer.
    Out => "output",
    /// The answer as CSV.
    Csv => "CSV",
    /// Lists in full.
    All => "full lists",
    /// The answer as JSON.
    Json => "JSON",
}

/// The words of a face for the fields of a request.
pub trait Words: fmt::Debug + Send + Sync {
    /// The word for a field; `None` if the face does not have the field.
    fn name(&self, _field: Field) -> Option<&'static str> {
        None
    }

    /// The word for a field of the site file, in a sentence about one of its keys.
    fn key(&self, field: Field) -> &'static str {
        field.name()
    }

    /// The word for a key that may be set in any site file, perhaps to a value. `written` is how a site file would have
    /// it: `` `level` in [ground] ``.
    fn setting(&self, _table: &str, _key: &str, _value: Option<&str>, written: &str) -> String {
        written.to_owned()
    }

    /// The word for a key of a site file; an empty key is the table itself.
    fn at(&self, file: &str, table: &str, key: &str) -> String {
        let gap = if key.is_empty() { "" } else { " " };
        format!("{file}, {table}{gap}{key}")
    }
}

/// The words outside of the faces: the fields' own names.
#[derive(Clone, Copy, Debug)]
pub struct PlainWords;

impl Words for PlainWords {}

impl Default for &dyn Words {
    fn default() -> Self {
        &PlainWords
    }
}

/// A piece of a message.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum MessagePart {
    /// Text as it is.
    Text(Cow<'static, str>),
    /// A field.
    Field(Field),
    /// A field with a value.
    Set(Field, Cow<'static, str>),
    /// A field, as a key of the site file.
    Key(Field),
    /// A key in a table of a file.
    At {
        /// The file as the user named it.
        file: String,
        /// The table with its brackets.
        table: String,
        /// The key; empty for the table itself.
        key: String,
    },
    /// A key that may be set in any site, for faces that have a word for it.
    Setting {
        /// The table with its brackets.
        table: Cow<'static, str>,
        /// The key.
        key: Cow<'static, str>,
        /// The value that it should be set to.
        value: Option<String>,
        /// How a site file has it, in a sentence.
        written: Cow<'static, str>,
        /// What a face may have in its place: only said where there is no site file.
        field: Option<Field>,
    },
    /// Pieces that only faces with a certain field show.
    Where(Field, Vec<MessagePart>),
}

impl From<&'static str> for MessagePart {
    fn from(text: &'static str) -> MessagePart {
        MessagePart::Text(text.into())
    }
}

impl From<String> for MessagePart {
    fn from(text: String) -> MessagePart {
        MessagePart::Text(text.into())
    }
}

impl From<Field> for MessagePart {
    fn from(field: Field) -> MessagePart {
        MessagePart::Field(field)
    }
}

impl From<(Field, &'static str)> for MessagePart {
    fn from((field, value): (Field, &'static str)) -> MessagePart {
        MessagePart::Set(field, value.into())
    }
}

impl From<(Field, String)> for MessagePart {
    fn from((field, value): (Field, String)) -> MessagePart {
        MessagePart::Set(field, value.into())
    }
}

/// A message: what is wrong, or what the user should know; and separately the hint, what can be done.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Message {
    /// What is wrong, or what the user should know.
    pub what: Vec<MessagePart>,
    /// What can be done; empty if nothing can, or if the message already says it.
    pub hint: Vec<MessagePart>,
}

/// Makes pieces from texts and fields.
macro_rules! pieces {
    ($($piece:expr),*) => { vec![$($crate::message::MessagePart::from($piece)),*] };
}

/// Makes a [`Message`]: the pieces of what is wrong, and after a semicolon those of the hint.
macro_rules! message {
    ($($what:expr),+ $(; $($hint:expr),+)?) => {
        $crate::message::Message {
            what: $crate::message::pieces![$($what),+],
            hint: $crate::message::pieces![$($($hint),+)?],
        }
    };
}

pub(crate) use {message, pieces};

/// A field in parentheses, for faces that have it, as an addition to the text before it.
pub(crate) fn aside(field: Field) -> MessagePart {
    MessagePart::Where(field, pieces![" (", field, ")"])
}

/// A key that may be set, in the wording for a site file.
pub(crate) fn setting(table: &'static str, key: &'static str, written: &'static str) -> MessagePart {
    MessagePart::Setting { table: table.into(), key: key.into(), value: None, written: written.into(), field: None }
}

/// The same with a value to set.
pub(crate) fn set_to(table: &'static str, key: &'static str, value: String, written: String) -> MessagePart {
    MessagePart::Setting {
        table: table.into(),
        key: key.into(),
        value: Some(value),
        written: written.into(),
        field: None,
    }
}

/// The point of the place: latitude and longitude under `[place]`, as `written` has them in a sentence.
pub(crate) fn place_setting(written: &'static str) -> MessagePart {
    setting("[place]", "", written)
}

/// The field that a face may have for a key, and its value where the key has none.
fn field_of(table: &str, key: &str) -> Option<(Field, Option<&'static str>)> {
    match (table, key) {
        ("[place]", "") => Some((Field::Place, Some("LAT,LON"))),
        ("[[model]]", "up") => Some((Field::Up, None)),
        ("[[model]]", "default_height") => Some((Field::DefaultHeight, None)),
        ("[ground]", "level") => Some((Field::Ground, None)),
        _ => None,
    }
}

impl From<String> for Message {
    fn from(what: String) -> Message {
        message![what]
    }
}

impl Message {
    /// The same message about a field or a key: `step: …`.
    pub(crate) fn of(mut self, at: MessagePart) -> Message {
        self.what.splice(..0, [at, ": ".into()]);
        self
    }

    /// The same message with a subject: `tower.glb …`.
    pub(crate) fn about(mut self, subject: &str) -> Message {
        self.what.splice(..0, [MessagePart::from(format!("{subject} "))]);
        self
    }

    /// The same message about a site file, whose fields are keys.
    pub(crate) fn of_keys(mut self) -> Message {
        let keyed = |piece: &mut MessagePart| {
            if let MessagePart::Field(field) = *piece {
                *piece = MessagePart::Key(field);
            }
        };
        self.what.iter_mut().chain(&mut self.hint).for_each(keyed);
        self
    }

    /// The same of a model without a site file: a key is a face's field where it has one, and is otherwise said to be one
    /// of a site file.
    pub(crate) fn of_bare_model(mut self) -> Message {
        let mut replaced = Vec::new();
        for piece in self.what.iter_mut().chain(&mut self.hint) {
            let MessagePart::Setting { table, key, value, written, field } = piece else { continue };
            if let Some((of_key, its)) = field_of(table, key) {
                *field = Some(of_key);
                *value = value.take().or_else(|| its.map(str::to_owned));
                replaced.push(of_key);
            }
            if written.contains('[') && !written.contains("site file") {
                *written = format!("{written} in a site file").into();
            }
        }
        // what would only say the same field again
        let is_new = |piece: &MessagePart| !matches!(piece, MessagePart::Where(field, _) if replaced.contains(field));
        self.what.retain(is_new);
        self.hint.retain(is_new);
        self
    }

    /// The message in the words of a face, on one line: what is wrong, then the hint.
    pub fn in_words(&self, words: &dyn Words) -> String {
        let (mut text, mut hint) = (String::new(), String::new());
        write(&mut text, &self.what, words);
        write(&mut hint, &self.hint, words);
        if !hint.is_empty() {
            text.push_str("; ");
            text.push_str(&hint);
        }
        text
    }
}

fn write(text: &mut String, pieces: &[MessagePart], words: &dyn Words) {
    let name = |field: Field| words.name(field).unwrap_or_else(|| field.name());
    for piece in pieces {
        match piece {
            MessagePart::Text(piece) => text.push_str(piece),
            MessagePart::Field(field) => text.push_str(name(*field)),
            MessagePart::Set(field, value) => text.extend([name(*field), " ", value]),
            MessagePart::Key(field) => text.push_str(words.key(*field)),
            MessagePart::Setting { table, key, value, written, field } => {
                match field.and_then(|field| words.name(field)) {
                    Some(name) => {
                        text.push_str(name);
                        value.iter().for_each(|value| text.extend([" ", value]));
                    }
                    None => text.push_str(&words.setting(table, key, value.as_deref(), written)),
                }
            }
            MessagePart::At { file, table, key } => text.push_str(&words.at(file, table, key)),
            MessagePart::Where(field, pieces) if words.name(*field).is_some() => write(text, pieces, words),
            MessagePart::Where(..) => {}
        }
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words(&PlainWords))
    }
}

/// An error whose message names fields. Its `Display` uses [`PlainWords`].
pub trait Worded {
    /// What is wrong, and the hint.
    fn message(&self) -> Message;

    /// The same in the words of a face.
    fn in_words(&self, words: &dyn Words) -> String {
        self.message().in_words(words)
    }
}

/// Implements `Display` of an error in plain words.
macro_rules! plain_display {
    ($error:ty) => {
        impl std::fmt::Display for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(&$crate::message::Worded::message(self), f)
            }
        }
    };
}

pub(crate) use plain_display;

/// A distance in words. One that is larger than any map is a mistake, and its digits mean nothing.
pub(crate) fn kilometres(km: f64) -> String {
    if km > 1e6 { "more than a million km".to_owned() } else { format!("{km:.0} km") }
}

/// Lists things in a message: the first ones, and the number of the others. `a`, `a and b`, `a, b and 7 more`.
pub(crate) fn few(mut items: Vec<String>) -> String {
    const MOST: usize = 5;
    // never "1 more", since that item would fit as well
    if items.len() > MOST {
        let more = items.len() - (MOST - 1);
        items.truncate(MOST - 1);
        items.push(format!("{more} more"));
    }
    match items.as_slice() {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => items.concat(),
    }
}
