//! What can be wrong with a request. Each error names the place where the request is made, and says what to do.

use super::typed::TypedError;
use crate::formats::ModelError;
use crate::mesh::MeshError;
use crate::message::{Field, Message, Piece, Worded, message, pieces, plain_display};
use crate::sun::SunError;

/// The place where something was requested.
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
    /// A field that a face sets beside the site file.
    Field(Field),
}

impl FieldLocation {
    fn piece(&self) -> Piece {
        match self.clone() {
            FieldLocation::Key { file, table, key } => Piece::At { file, table, key },
            FieldLocation::Field(field) => field.into(),
        }
    }

    /// What is said of it: of a site file its fields are keys.
    fn tells(&self, message: Message) -> Message {
        match self {
            FieldLocation::Key { .. } => message.of_keys().of(self.piece()),
            FieldLocation::Field(_) => message.of(self.piece()),
        }
    }
}

/// Why there is no site, in one line.
#[derive(Debug, thiserror::Error)]
pub enum SiteError {
    /// The path cannot be read as a file.
    Unreadable {
        /// As the user named it.
        path: String,
        /// What the system says.
        why: String,
    },
    /// The path is a model file, and nothing says where it stands.
    NoPlaceForModel {
        /// As the user named it.
        path: String,
        /// What its file says of a place that is none.
        said: Option<Box<Message>>,
    },
    /// The model's format is not read; with a hint.
    UnknownFormat(Message),
    /// The text is not in an encoding of site files.
    Encoding {
        /// As the user named it.
        file: String,
        /// Subject's verb and object.
        what: String,
    },
    /// Not TOML.
    Toml {
        /// As the user named it.
        file: String,
        /// From 1.
        line: usize,
        /// That line.
        text: String,
        /// What the parser says.
        what: String,
    },
    /// The value cannot be written as TOML.
    Unwritable {
        /// What the writer says.
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
        /// As the user named it.
        file: String,
        /// The table or key.
        what: String,
        /// What to write.
        example: String,
    },
    /// A value that cannot be used.
    Value {
        /// Where it was asked.
        at: FieldLocation,
        /// What is wrong, and a hint.
        message: Box<Message>,
    },
    /// A place, reading or window that cannot be used.
    Sun {
        /// Where it was asked.
        at: FieldLocation,
        /// Why.
        error: Box<SunError>,
    },
    /// The command needs a study.
    NoStudy {
        /// As the user named it.
        file: String,
        /// What is missing, each with an example.
        missing: Vec<(Field, &'static str)>,
    },
    /// The command needs a probe.
    NoProbe {
        /// As the user named it.
        file: String,
    },
    /// A name that no component has, in `layers`, `casts`, `receives` or `terrain`, or of components on which points are laid.
    UnknownName {
        /// Where it was asked.
        at: FieldLocation,
        /// As written.
        name: String,
        /// The nearest name in that model.
        nearest: String,
    },
    /// The models contain no triangles.
    NoTriangles {
        /// As the user named it.
        file: String,
    },
    /// A mesh in memory has no triangles.
    EmptyMesh,
    /// A model file cannot be read.
    Model(#[from] ModelError),
    /// The parts cannot become a mesh.
    Mesh {
        /// The model whose part is at fault, as the user named it, where one is.
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
                Piece::Where(Field::Place, pieces![" with ", (Field::Place, "LAT,LON")])
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
            SiteError::UnknownFormat(message) => message.clone(),
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
                Piece::Where(Field::Point, pieces![", or ask for one point with ", (Field::Point, "12,-3,4.5")])
            ],
            SiteError::UnknownName { at, name, nearest } => {
                let what = format!("no component or group is named \"{name}\"");
                at.tells(message![what; format!("the nearest is \"{nearest}\"")])
            }
            SiteError::NoTriangles { file } => message![
                format!("{file}: the models hold no triangles, so nothing casts a shadow");
                "check what was exported"
            ],
            SiteError::EmptyMesh => {
                message!["the mesh holds no triangles, so nothing casts a shadow"; "give it parts that do"]
            }
            SiteError::Model(error) => error.message(),
            SiteError::Mesh { file: Some(file), error } => format!("{file}: {error}").into(),
            SiteError::Mesh { file: None, error } => error.to_string().into(),
        }
    }
}

fn no_study(file: &str, missing: &[(Field, &'static str)]) -> Message {
    let between = |text: &'static str, piece: fn(&(Field, &'static str)) -> Piece| {
        let pieces = missing.iter().map(|missing| [piece(missing), text.into()]);
        pieces.flatten().take((2 * missing.len()).saturating_sub(1)).collect::<Vec<_>>()
    };
    let (keys, settings) = (between(", ", |(field, _)| Piece::Key(*field)), between(" ", |missing| (*missing).into()));
    Message {
        what: [pieces![format!("{file} does not say ")], keys, pieces![" of the study"]].concat(),
        hint: vec![Piece::Where(
            Field::From,
            [pieces!["add "], settings, pieces![", or [study] to the site file"]].concat(),
        )],
    }
}

impl SiteError {
    /// A fault of place or time, where it was asked.
    pub(super) fn sun(at: FieldLocation, error: SunError) -> SiteError {
        SiteError::Sun { at, error: Box::new(error) }
    }

    /// A value that cannot be read, where it was asked.
    pub(crate) fn typed(at: FieldLocation, error: impl Into<TypedError>) -> SiteError {
        match error.into() {
            TypedError::Sun(error) => SiteError::sun(at, error),
            error => SiteError::Value { at, message: Box::new(error.message()) },
        }
    }

    /// Whether the reading of a model was cancelled, and nothing is wrong.
    pub fn is_given_up(&self) -> bool {
        matches!(self, SiteError::Model(error) if error.is_given_up())
    }

    /// Whether the command line was wrong (exit status 2) rather than a file (exit status 1).
    pub fn is_wrong_use(&self) -> bool {
        match self {
            SiteError::NoPlaceForModel { .. } | SiteError::NoStudy { .. } | SiteError::NoProbe { .. } => true,
            SiteError::Value { at, .. } | SiteError::Sun { at, .. } | SiteError::UnknownName { at, .. } => {
                matches!(at, FieldLocation::Field(_))
            }
            _ => false,
        }
    }
}
