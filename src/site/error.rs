//! Errors in a request. Each names where the value was given, and says what to do.

use super::typed::TypedError;
use crate::formats::ModelError;
use crate::mesh::MeshError;
use crate::message::{Field, Message, MessagePart, Worded, message, pieces, plain_display};
use crate::sun::SunError;

/// Where a value was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldLocation {
    /// In a site file.
    Key {
        /// The file, as the user named it.
        file: String,
        /// The table, with its brackets.
        table: String,
        /// The key in it; empty for the table itself.
        key: String,
    },
    /// A field set by a face.
    Field(Field),
}

impl FieldLocation {
    fn piece(&self) -> MessagePart {
        match self.clone() {
            FieldLocation::Key { file, table, key } => MessagePart::At { file, table, key },
            FieldLocation::Field(field) => field.into(),
        }
    }

    /// A message about it; for a site file, fields are worded as keys.
    pub(crate) fn tells(&self, message: Message) -> Message {
        match self {
            FieldLocation::Key { .. } => message.of_keys().of(self.piece()),
            FieldLocation::Field(_) => message.of(self.piece()),
        }
    }
}

/// Why a site could not be loaded, in one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SiteError {
    /// The path cannot be read as a file.
    Unreadable {
        /// The path as the user gave it.
        path: String,
        /// The operating system's message.
        why: String,
    },
    /// The path is a model file, and neither it nor the user says where the model stands.
    NoPlaceForModel {
        /// The path as the user gave it.
        path: String,
        /// What the file says about its place, if that is not a place.
        said: Option<Box<Message>>,
    },
    /// The file's format is not one that is read; with a hint.
    UnknownFormat(Message),
    /// A file that cannot be read together with the one named before it; with a hint.
    Beside(Message),
    /// The text's encoding is not one that site files may have.
    Encoding {
        /// The file as the user gave it.
        file: String,
        /// The predicate of a sentence about the file.
        what: String,
    },
    /// The text is not TOML.
    Toml {
        /// The file as the user gave it.
        file: String,
        /// The line number, from 1.
        line: usize,
        /// That line.
        text: String,
        /// The parser's message.
        what: String,
    },
    /// The value cannot be written as TOML.
    Unwritable {
        /// The writer's message.
        what: String,
    },
    /// A table or key that does not exist.
    Unknown {
        /// The table or key.
        at: FieldLocation,
        /// The nearest one, with its table.
        nearest: String,
    },
    /// A required table or key is missing.
    Missing {
        /// The file as the user gave it.
        file: String,
        /// The table or key.
        what: String,
        /// An example of it.
        example: String,
    },
    /// A value that cannot be used.
    Value {
        /// Where it was given.
        at: FieldLocation,
        /// What is wrong, and a hint.
        message: Box<Message>,
    },
    /// A place, reading or window that cannot be used.
    Sun {
        /// Where it was given.
        at: FieldLocation,
        /// Why.
        error: Box<SunError>,
    },
    /// The request has no study, and the command needs one.
    NoStudy {
        /// The file as the user gave it.
        file: String,
        /// The missing fields, each with an example.
        missing: Vec<(Field, &'static str)>,
    },
    /// The request has no probe, and the command needs one.
    NoProbe {
        /// The file as the user gave it.
        file: String,
    },
    /// A name in `layers`, `casts`, `receives` or `terrain`, or of components to lay points on, that no component has.
    UnknownName {
        /// Where it was given.
        at: FieldLocation,
        /// The name as written.
        name: String,
        /// The nearest name in that model.
        nearest: String,
    },
    /// The models have no triangles.
    NoTriangles {
        /// The file as the user gave it.
        file: String,
    },
    /// A mesh in memory has no triangles.
    EmptyMesh,
    /// A model file cannot be read.
    Model(#[from] ModelError),
    /// The parts do not make a mesh.
    Mesh {
        /// The model at fault as the user gave it, if the fault is in one.
        file: Option<String>,
        /// Why.
        error: MeshError,
    },
}

plain_display!(SiteError);

impl Worded for SiteError {
    fn message(&self) -> Message {
        match self {
            SiteError::Unreadable { path, why } => message![
                format!("{path} cannot be read: {why}");
                "give a site file, a folder with a site.toml, or a model",
                MessagePart::Where(Field::Place, pieces![" with ", (Field::Place, "LAT,LON")])
            ],
            SiteError::NoPlaceForModel { said: Some(said), .. } => Message {
                hint: pieces!["say where it stands with ", (Field::Place, "LAT,LON")],
                ..Message::clone(said)
            },
            SiteError::NoPlaceForModel { path, said: None } => message![
                format!("{path} is a model whose file does not say its place: say where it stands with "),
                (Field::Place, "LAT,LON"),
                ", for example ",
                (Field::Place, "48.8583,2.2945")
            ],
            SiteError::UnknownFormat(message) | SiteError::Beside(message) => message.clone(),
            SiteError::Encoding { file, what } => message![format!("{file} {what}"); "save it as UTF-8"],
            SiteError::Toml { file, line, text, what } => {
                message![format!("{file}, line {line} `{text}`: {what}"); "the file must be TOML"]
            }
            SiteError::Unwritable { what } => format!("the site cannot be written: {what}").into(),
            SiteError::Unknown { at, nearest } => {
                message![at.piece(), " is not known"; format!("the nearest is {nearest}")]
            }
            SiteError::Missing { file, what, example } => {
                message![format!("{file} has no {what}"); format!("add for example {example}")]
            }
            SiteError::Value { at, message } => at.tells(Message::clone(message)),
            SiteError::Sun { at, error } => at.tells(error.message()),
            SiteError::NoStudy { file, missing } => no_study(file, missing),
            SiteError::NoProbe { file } => message![
                format!("{file} has no [[probe]]");
                "add one with point = [12.0, -3.0, 4.5] to the site file",
                MessagePart::Where(Field::Point, pieces![", or ask for one point with ", (Field::Point, "12,-3,4.5")])
            ],
            SiteError::UnknownName { at, name, nearest } => {
                let what = format!("no component or group is named \"{name}\"");
                at.tells(message![what; format!("the nearest is \"{nearest}\"")])
            }
            SiteError::NoTriangles { file } => message![
                format!("{file}: the models have no triangles, so nothing casts a shadow");
                "check what was exported"
            ],
            SiteError::EmptyMesh => {
                message!["the mesh has no triangles, so nothing casts a shadow"; "add parts with triangles"]
            }
            SiteError::Model(error) => error.message(),
            SiteError::Mesh { file: Some(file), error } => format!("{file}: {error}").into(),
            SiteError::Mesh { file: None, error } => error.to_string().into(),
        }
    }
}

fn no_study(file: &str, missing: &[(Field, &'static str)]) -> Message {
    let between = |text: &'static str, piece: fn(&(Field, &'static str)) -> MessagePart| {
        let pieces = missing.iter().map(|missing| [piece(missing), text.into()]);
        pieces.flatten().take((2 * missing.len()).saturating_sub(1)).collect::<Vec<_>>()
    };
    let (keys, settings) =
        (between(", ", |(field, _)| MessagePart::Key(*field)), between(" ", |missing| (*missing).into()));
    Message {
        what: [pieces![format!("{file} does not say ")], keys, pieces![" of the study"]].concat(),
        hint: vec![MessagePart::Where(
            Field::From,
            [pieces!["add "], settings, pieces![", or [study] to the site file"]].concat(),
        )],
    }
}

impl SiteError {
    /// An error of place or time, with where the value was given.
    pub(super) fn sun(at: FieldLocation, error: SunError) -> SiteError {
        SiteError::Sun { at, error: Box::new(error) }
    }

    /// A value that cannot be read, with where it was given.
    pub(crate) fn typed(at: FieldLocation, error: impl Into<TypedError>) -> SiteError {
        match error.into() {
            TypedError::Sun(error) => SiteError::sun(at, error),
            error => SiteError::Value { at, message: Box::new(error.message()) },
        }
    }

    /// Whether the user cancelled the reading of a model, so that nothing is wrong.
    pub fn is_given_up(&self) -> bool {
        matches!(self, SiteError::Model(error) if error.is_given_up())
    }

    /// Whether the command line was wrong (exit status 2) rather than a file (exit status 1).
    pub fn is_wrong_use(&self) -> bool {
        match self {
            SiteError::NoPlaceForModel { .. }
            | SiteError::NoStudy { .. }
            | SiteError::NoProbe { .. }
            | SiteError::Beside(_) => true,
            SiteError::Value { at, .. } | SiteError::Sun { at, .. } | SiteError::UnknownName { at, .. } => {
                matches!(at, FieldLocation::Field(_))
            }
            _ => false,
        }
    }
}
