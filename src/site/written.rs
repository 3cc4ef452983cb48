//! Reads the user's path as a request: a site file, a folder, or a model with its place.

use super::error::{FieldLocation, SiteError};
use super::file::{ModelTable, SiteFile};
use super::keys;
use super::overrides::{Overrides, refuse};
use crate::formats::{self, ModelError, on_disk};
use crate::message::{Field, message};
use crate::sun::Place;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A request as written, and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenSite {
    /// The file as the user named it.
    pub file: String,
    /// The folder that relative paths start from.
    pub folder: PathBuf,
    /// Its contents.
    pub site: SiteFile,
    /// The text that was read, with comments; empty for a bare model.
    pub text: String,
}

/// The largest site file, bytes. A larger file is a model or something else.
const MOST_BYTES: u64 = 16_000_000;

/// Where the formats are documented.
const FORMATS_HINT: &str = "docs/formats.md lists all models that are read, and how to export them";

/// Decodes a site file's bytes.
fn text_of(file: &str, bytes: Vec<u8>) -> Result<String, SiteError> {
    // in UTF-16 every other byte of mostly ASCII text is 0
    let zeros = |parity: usize| bytes.iter().skip(parity).step_by(2).filter(|byte| **byte == 0).count();
    let is_wide = |parity: usize| bytes.len() >= 4 && 3 * zeros(parity) > bytes.len();
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) || is_wide(0) || is_wide(1) {
        return Err(SiteError::Encoding { file: file.to_owned(), what: "is written as UTF-16".to_owned() });
    }
    let has_zeros = bytes.contains(&0);
    match String::from_utf8(bytes) {
        Ok(text) if !has_zeros => Ok(text),
        Err(error) if !has_zeros => {
            let good = error.utf8_error().valid_up_to();
            let line = error.as_bytes()[..good].iter().filter(|byte| **byte == b'\n').count() + 1;
            let what = format!("has a letter in line {line} that is not UTF-8, but perhaps Latin-1 or Windows-1252");
            Err(SiteError::Encoding { file: file.to_owned(), what })
        }
        _ => Err(SiteError::Unreadable { path: file.to_owned(), why: "it is not text".to_owned() }),
    }
}

/// Whether a file may be meant as a site file, so that errors in it should be reported by line: it is named `.toml`, is
/// TOML, is text in a recognised encoding, or has one of a site file's tables.
fn may_be_site(path: &Path, bytes: &[u8]) -> bool {
    let is_called_so = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    let is_wide = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
    let has_table = |line: &[u8]| [&b"[place]"[..], b"[[model]]", b"[study]"].contains(&line.trim_ascii());
    let is_toml = || {
        let text = std::str::from_utf8(bytes).ok()?;
        toml::from_str::<toml::Table>(text.strip_prefix('\u{feff}').unwrap_or(text)).ok()
    };
    is_called_so || is_wide || bytes.split(|byte| *byte == b'\n').any(has_table) || is_toml().is_some()
}

impl WrittenSite {
    /// Reads the argument SITE: a site file, a folder that contains a `site.toml`, or a model whose place is in the
    /// file or in the request.
    ///
    /// # Errors
    /// A file that cannot be read, or a site file whose form is wrong.
    pub fn read(path: &Path, asked: &Overrides) -> Result<WrittenSite, SiteError> {
        let mut written = Self::read_as_it_is(path)?;
        written.add_models(&asked.beside)?;
        written.set_models(asked);
        if let Some([latitude, longitude]) = asked.place {
            if written.point()?.is_some() {
                return Err(refuse(
                    FieldLocation::Field(Field::Place),
                    message![format!("{} has its own [place]", written.file); "leave one of the two out"],
                ));
            }
            let table = written.site.place.get_or_insert_default();
            (table.latitude, table.longitude) = (Some(latitude), Some(longitude));
        }
        Ok(written)
    }

    /// As [`WrittenSite::read`], for the other state of a site: without its own place it has that of `first`.
    ///
    /// # Errors
    /// As [`WrittenSite::read`].
    pub(crate) fn read_beside(path: &Path, first: &WrittenSite, asked: &Overrides) -> Result<WrittenSite, SiteError> {
        let mut written = Self::read_as_it_is(path)?;
        written.set_models(asked);
        written.take_place_of(first)?;
        Ok(written)
    }

    /// Takes the place of another state if this one gives no point of the Earth.
    ///
    /// # Errors
    /// A latitude without a longitude, or a longitude without a latitude.
    pub(super) fn take_place_of(&mut self, first: &WrittenSite) -> Result<(), SiteError> {
        if self.point()?.is_some() {
            return Ok(());
        }
        match (&mut self.site.place, &first.site.place) {
            (Some(own), Some(other)) => own.complete_with(other),
            (own, other) => own.clone_from(other),
        }
        Ok(())
    }

    /// Adds models to a bare one.
    fn add_models(&mut self, files: &[PathBuf]) -> Result<(), SiteError> {
        for file in files {
            let name = file.display().to_string();
            if !self.text.is_empty() {
                let what = format!("{name} is named beside the site file {}", self.file);
                return Err(SiteError::Beside(message![what; "add it as a [[model]] in the site file"]));
            }
            if !formats::is_model(file) {
                let what = format!("{name} is not a model of a known format");
                return Err(SiteError::Beside(message![what; "give only model files, or one site"]));
            }
            self.site.model.push(ModelTable { path: Some(self.path_of(file)), ..ModelTable::default() });
        }
        Ok(())
    }

    /// Sets the up axis and the height of footprints for all models, if the command line gives them.
    fn set_models(&mut self, asked: &Overrides) {
        if let Some(height) = asked.default_height {
            self.site.model.iter_mut().for_each(|model| model.default_height = Some(height));
        }
        if let Some(up) = asked.up {
            self.site.model.iter_mut().for_each(|model| model.up = Some(up.word().to_owned()));
        }
    }

    pub(super) fn read_as_it_is(path: &Path) -> Result<WrittenSite, SiteError> {
        let path = &*on_disk(path);
        if path.is_dir() {
            return Self::read_file(&path.join("site.toml"));
        }
        if formats::is_model(path) {
            return Self::of_model(path);
        }
        match formats::refusal(path) {
            Some(refusal) => Err(SiteError::UnknownFormat(refusal.about(&path.display().to_string()))),
            None => Self::read_file(path),
        }
    }

    fn read_file(path: &Path) -> Result<WrittenSite, SiteError> {
        let file = path.display().to_string();
        let unreadable = |error: std::io::Error| SiteError::Unreadable { path: file.clone(), why: error.to_string() };
        let length = std::fs::metadata(path).map_err(unreadable)?.len();
        if length > MOST_BYTES {
            let what = format!("{file} has {length} bytes, but a site file has at most 16 MB");
            return Err(SiteError::UnknownFormat(message![what; FORMATS_HINT]));
        }
        let bytes = std::fs::read(path).map_err(unreadable)?;
        if !may_be_site(path, &bytes) {
            let what = format!("{file} is neither a site file nor a model that Gnomon reads");
            return Err(SiteError::UnknownFormat(message![what; FORMATS_HINT]));
        }
        let text = text_of(&file, bytes)?;
        Ok(WrittenSite {
            site: SiteFile::parse(&file, &text)?,
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            file,
            text,
        })
    }

    /// The paths of its models, in order.
    pub fn model_paths(&self) -> Vec<PathBuf> {
        self.site.model.iter().filter_map(|model| Some(self.folder.join(model.path.as_ref()?))).collect()
    }

    /// A file's path as this site writes it: relative if the file is in the site file's folder or below.
    pub fn path_of(&self, file: &Path) -> String {
        WrittenSite::name_in(&self.folder, file)
    }

    /// A file's path as a site file in a folder writes it: relative if the file is in that folder or below, so that
    /// both can move together.
    pub fn name_in(folder: &Path, file: &Path) -> String {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let there = absolute(file);
        let path = there.strip_prefix(absolute(folder)).unwrap_or(&there).display().to_string();
        if cfg!(windows) { path.replace('\\', "/") } else { path }
    }

    /// Whether the site file at a path has changed. If it cannot be read, the next reader reports that.
    pub fn has_changed_at(&self, path: &Path) -> bool {
        std::fs::read(path).is_ok_and(|bytes| bytes != self.text.as_bytes())
    }

    fn of_model(path: &Path) -> Result<WrittenSite, SiteError> {
        let file = path.display().to_string();
        bare_fault(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(WrittenSite {
            file,
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            site: SiteFile {
                model: vec![ModelTable { path: Some(name), ..ModelTable::default() }],
                ..SiteFile::default()
            },
            text: String::new(),
        })
    }

    /// The location of a key of this file.
    pub(super) fn key(&self, table: &str, key: &str) -> FieldLocation {
        FieldLocation::Key { file: self.file.clone(), table: keys::bracketed(table), key: key.to_owned() }
    }

    /// The location of a key of one of the models.
    pub(super) fn model_key(&self, index: usize, key: &str) -> FieldLocation {
        self.list_key("model", (index, self.site.model.len()), key)
    }

    /// The location of a key of one of the probes.
    pub(super) fn probe_key(&self, index: usize, key: &str) -> FieldLocation {
        self.list_key("probe", (index, self.site.probe.len()), key)
    }

    /// Where a key of one of so many tables of a list stands.
    pub(super) fn list_key(&self, list: &str, (index, count): (usize, usize), key: &str) -> FieldLocation {
        let table = keys::numbered(list, index, count);
        FieldLocation::Key { file: self.file.clone(), table, key: key.to_owned() }
    }

    /// The error for a missing key.
    pub(super) fn missing(&self, what: impl Into<String>, example: impl Into<String>) -> SiteError {
        SiteError::Missing { file: self.file.clone(), what: what.into(), example: example.into() }
    }

    /// The error for a missing latitude and longitude.
    pub(super) fn no_point(&self, example: &str) -> SiteError {
        match self.site.place {
            None => self.missing("[place]", format!("[place] with {example}")),
            Some(_) => self.missing("latitude and longitude in [place]", example),
        }
    }

    /// Latitude and longitude as written; `None` if neither is.
    ///
    /// # Errors
    /// Only one of them.
    pub(super) fn point(&self) -> Result<Option<[f64; 2]>, SiteError> {
        let written = self.site.place.as_ref().map(|table| (table.latitude, table.longitude)).unwrap_or_default();
        let missing = |key: &str| Err(self.missing(format!("{key} in [place]"), keys::example("place", key)));
        match written {
            (None, None) => Ok(None),
            (Some(latitude), Some(longitude)) => Ok(Some([latitude, longitude])),
            (Some(_), None) => missing("longitude"),
            (None, Some(_)) => missing("latitude"),
        }
    }

    pub(super) fn place(&self, asked: &Overrides) -> Result<Place, SiteError> {
        const EXAMPLE: &str = "latitude = 48.8583 and longitude = 2.2945";
        let point = self.point()?;
        let Some((table, [latitude, longitude])) = self.site.place.as_ref().zip(point) else {
            return Err(self.no_point(EXAMPLE));
        };
        Place::new(
            table.name.as_deref().unwrap_or_default(),
            latitude,
            longitude,
            table.elevation.unwrap_or(0.0),
            table.time_zone.as_deref(),
        )
        .map_err(|error| {
            let at = match asked.place {
                Some(_) => FieldLocation::Field(Field::Place),
                None => self.key("place", ""),
            };
            SiteError::sun(at, error)
        })
    }
}

/// Refuses a model on the command line that cannot be opened.
pub(super) fn bare_fault(file: &Path) -> Result<(), ModelError> {
    let fault = match std::fs::metadata(file) {
        Ok(found) if found.is_file() => return Ok(()),
        Ok(_) => message!["is not a regular file"; "give a model file"],
        Err(error) if error.kind() == ErrorKind::NotFound => {
            message!["there is no such file"; "check its name and its folder"]
        }
        Err(error) => message![format!("cannot be read: {error}"); "check who may read it"],
    };
    Err(ModelError { file: file.to_owned(), fault: fault.into() })
}
