//! One of the tables that say what is judged, with the checks that their keys share.

use crate::formats::{composed, on_disk};
use crate::mesh::Mesh;
use crate::message::{Message, message};
use crate::site::error::{FieldLocation, SiteError};
use crate::site::file::Names;
use crate::site::judged_tables::WrittenNames;
use crate::site::keys;
use crate::site::names::names_of;
use crate::site::overrides::refuse;
use crate::site::written::WrittenSite;
use rustc_hash::FxHashSet;
use std::path::PathBuf;

/// One of the tables.
#[derive(Clone, Copy, Debug)]
pub(super) struct AskedTable<'a> {
    /// The request.
    pub(super) written: &'a WrittenSite,
    /// The table's name.
    pub(super) name: &'static str,
    /// Its index, and the number of such tables.
    pub(super) at: (usize, usize),
}

impl AskedTable<'_> {
    /// The location of one of its keys.
    pub(super) fn key(&self, key: &str) -> FieldLocation {
        self.written.list_key(self.name, self.at, key)
    }

    /// The error for a value that cannot be used.
    pub(super) fn wrong(&self, key: &str, message: impl Into<Message>) -> SiteError {
        refuse(self.key(key), message)
    }

    /// Returns the one key of several that the table has.
    ///
    /// # Errors
    /// If it has none of them, or more than one.
    pub(super) fn one_of(&self, keys: &[(&'static str, bool)]) -> Result<&'static str, SiteError> {
        let mut written = keys.iter().filter(|(_, is_written)| *is_written).map(|(key, _)| *key);
        match (written.next(), written.next()) {
            (Some(key), None) => Ok(key),
            (Some(first), Some(second)) => {
                Err(self.wrong(second, message![format!("says nothing beside `{first}`"); "leave one of the two out"]))
            }
            (None, _) => {
                let names: Vec<_> = keys.iter().map(|(key, _)| *key).collect();
                let table = keys::numbered(self.name, self.at.0, self.at.1);
                let (key, _) = keys[0];
                Err(self.written.missing(format!("{} in {table}", names.join(" or ")), keys::example(self.name, key)))
            }
        }
    }

    /// Refuses a key that has no meaning beside another.
    pub(super) fn needless(&self, key: &str, is_written: bool, beside: &str) -> Result<(), SiteError> {
        match is_written {
            true => Err(self.wrong(key, message![format!("says nothing beside `{beside}`"); "leave it out"])),
            false => Ok(()),
        }
    }

    /// A number between two others, both included.
    pub(super) fn within(&self, key: &str, value: Option<f64>, low: f64, high: f64) -> Result<Option<f64>, SiteError> {
        match value {
            Some(value) if !(low..=high).contains(&value) => {
                let what = format!("{value} is not between {low} and {high}");
                let example = keys::example(self.name, key);
                Err(self.wrong(key, message![what; format!("write for example {example}")]))
            }
            // −0 is 0
            value => Ok(value.map(|value| value + 0.0)),
        }
    }

    /// Returns for each component whether it has one of a key's names.
    ///
    /// # Errors
    /// A name that no component has, and names that choose no component.
    pub(super) fn chosen(&self, key: &str, names: &WrittenNames, mesh: &Mesh) -> Result<Vec<bool>, SiteError> {
        let names = Names::Some(names.0.clone());
        if let Some((name, nearest)) = names.unknown(&names_of(&mesh.components)) {
            return Err(SiteError::UnknownName { at: self.key(key), name, nearest });
        }
        let chosen = names.chosen(&mesh.components);
        match chosen.contains(&true) {
            true => Ok(chosen),
            false => Err(self.wrong(key, message!["means no component"; "name one"])),
        }
    }

    /// The path of a file that it names, which exists.
    pub(super) fn file(&self, key: &str, name: &str) -> Result<PathBuf, SiteError> {
        let path = on_disk(&self.written.folder.join(name));
        if path.is_file() {
            return Ok(path);
        }
        let what = format!("there is no file {}", path.display());
        Err(self.wrong(key, message![what; "write where it lies, from the site file's folder"]))
    }

    /// Its name, if it has one.
    pub(super) fn named<'b>(&self, name: Option<&'b String>) -> Option<&'b str> {
        name.map(|name| name.trim()).filter(|name| !name.is_empty())
    }
}

/// The names that are taken.
#[derive(Debug, Default)]
pub(super) struct TakenNames(FxHashSet<String>);

impl TakenNames {
    /// Takes a name, unless another one has it.
    pub(super) fn take(&mut self, name: &str) -> bool {
        self.0.insert(composed(name).into_owned())
    }
}
