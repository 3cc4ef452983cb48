//! What can be wrong with a request: each names the place where it was asked, and the way out.

use super::model::ModelError;
use crate::mesh::MeshError;
use crate::sun::SunError;
use std::fmt;

/// Where something was asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum At {
    /// In a site file.
    Key {
        /// The file, as the user named it.
        file: String,
        /// The table, with its brackets.
        table: String,
        /// The key in it; empty for the table itself.
        key: String,
    },
    /// On the command line: an option's name with its dashes.
    Option(&'static str),
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            At::Key { file, table, key } if key.is_empty() => write!(f, "{file}, {table}"),
            At::Key { file, table, key } => write!(f, "{file}, {table} {key}"),
            At::Option(name) => f.write_str(name),
        }
    }
}

/// Why there is no site. One line each.
#[derive(Debug, thiserror::Error)]
pub enum SiteError {
    /// The path is nothing that can be read.
    #[error(
        "{path} cannot be read: {why}; give a site file, a folder with a site.toml, or a model with --place LAT,LON"
    )]
    Unreadable {
        /// As the user named it.
        path: String,
        /// What the system says.
        why: String,
    },
    /// A model file, and nobody says where it stands.
    #[error("{path} is a model: say where it stands with --place LAT,LON, for example --place 48.8583,2.2945")]
    NoPlaceForModel {
        /// As the user named it.
        path: String,
    },
    /// A model in a format that is not read.
    #[error("{path} is neither a site file nor a glTF model; export the model as .glb or .gltf")]
    UnknownFormat {
        /// As the user named it.
        path: String,
    },
    /// Text, but not as site files have it.
    #[error("{file} {what}; save it as UTF-8")]
    Encoding {
        /// As the user named it.
        file: String,
        /// Subject's verb and object.
        what: String,
    },
    /// Not TOML.
    #[error("{file}, line {line} `{text}`: {what}; the file must be TOML")]
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
    /// Nothing that TOML can hold.
    #[error("the site cannot be written: {what}")]
    Unwritable {
        /// What the writer says.
        what: String,
    },
    /// A table or key that does not exist.
    #[error("{at} is not known; the nearest is {nearest}")]
    Unknown {
        /// The table or key.
        at: At,
        /// The nearest one, with its table.
        nearest: String,
    },
    /// A table or key that must be there.
    #[error("{file} has no {what}; add for example {example}")]
    Missing {
        /// As the user named it.
        file: String,
        /// The table or key.
        what: String,
        /// What to write.
        example: String,
    },
    /// A value that cannot be taken.
    #[error("{at}: {what}")]
    Value {
        /// Where it was asked.
        at: At,
        /// What is wrong, and the way out.
        what: String,
    },
    /// A place, reading or window that cannot be taken.
    #[error("{at}: {error}")]
    Sun {
        /// Where it was asked.
        at: At,
        /// Why.
        error: Box<SunError>,
    },
    /// The command needs a study.
    #[error("{file} does not say {missing} of the study; add {options}, or [study] to the site file")]
    NoStudy {
        /// As the user named it.
        file: String,
        /// The keys that are missing.
        missing: String,
        /// The options that would say it.
        options: String,
    },
    /// The command needs a probe.
    #[error(
        "{file} has no [[probe]]; add one with point = [12.0, -3.0, 4.5] to the site file, or ask for one point with --point 12,-3,4.5"
    )]
    NoProbe {
        /// As the user named it.
        file: String,
    },
    /// A name in `casts` or `receives` that no component has.
    #[error("{at}: no component, node, mesh or material is named \"{name}\"; the nearest is \"{nearest}\"")]
    UnknownName {
        /// Where it was asked.
        at: At,
        /// As written.
        name: String,
        /// The nearest name in that model.
        nearest: String,
    },
    /// The models hold nothing.
    #[error("{file}: the models hold no triangles, so nothing casts a shadow; check what was exported")]
    NoTriangles {
        /// As the user named it.
        file: String,
    },
    /// A model file cannot be read.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The parts make no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl SiteError {
    /// A fault of place or time, where it was asked.
    pub(super) fn sun(at: At, error: SunError) -> SiteError {
        SiteError::Sun { at, error: Box::new(error) }
    }

    /// Whether the command line was wrong (exit status 2) rather than a file (exit status 1).
    pub fn is_wrong_use(&self) -> bool {
        match self {
            SiteError::NoPlaceForModel { .. } | SiteError::NoStudy { .. } | SiteError::NoProbe { .. } => true,
            SiteError::Value { at, .. } | SiteError::Sun { at, .. } => matches!(at, At::Option(_)),
            _ => false,
        }
    }
}
