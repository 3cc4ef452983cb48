//! The files from which a request is read, so that no answer is written over one of them.

use super::SiteError;
use super::model_table::placed;
use super::written::WrittenSite;
use crate::formats;
use crate::formats::on_disk;
use std::iter;
use std::path::{Path, PathBuf};

/// The files from which a request is read: the site file, its models, and the files that those name. `path` is a site
/// file, a folder that contains a `site.toml`, or a model.
///
/// # Errors
/// What cannot be read, and what is wrong with a site file's form.
pub fn inputs(path: &Path) -> Result<Vec<PathBuf>, SiteError> {
    let path = &*on_disk(path);
    let written = WrittenSite::read_as_it_is(path)?;
    let file = if path.is_dir() { path.join("site.toml") } else { path.to_owned() };
    Ok(iter::once(file).chain(written.model_files()).collect())
}

impl WrittenSite {
    /// Its models, and the files that those name: buffers, and also pictures, which are not read.
    pub fn model_files(&self) -> Vec<PathBuf> {
        let models = (0..self.site.model.len()).filter_map(|index| Some(on_disk(&placed(self, index).ok()?.0)));
        models.flat_map(|file| formats::named_by(&file).into_iter().chain([file])).collect()
    }
}
