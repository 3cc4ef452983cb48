//! Lists the files that a request reads, so that no answer overwrites one of them.

use super::SiteError;
use super::model_table::placed;
use super::written::WrittenSite;
use crate::formats;
use crate::formats::on_disk;
use std::iter;
use std::path::{Path, PathBuf};

/// Returns the files that a request reads: the site file, its models, and the files that those refer to. `path` is a
/// site file, a folder that contains a `site.toml`, or a model.
///
/// # Errors
/// A file that cannot be read, or a site file whose form is wrong.
pub fn inputs(path: &Path) -> Result<Vec<PathBuf>, SiteError> {
    let path = &*on_disk(path);
    let written = WrittenSite::read_as_it_is(path)?;
    let file = if path.is_dir() { path.join("site.toml") } else { path.to_owned() };
    Ok(iter::once(file).chain(written.model_files()).collect())
}

impl WrittenSite {
    /// Returns its models and the files that those refer to: buffers, and also images, although images are not read.
    pub fn model_files(&self) -> Vec<PathBuf> {
        let models = (0..self.site.model.len()).filter_map(|index| Some(on_disk(&placed(self, index).ok()?.0)));
        models.flat_map(|file| formats::named_by(&file).into_iter().chain([file])).collect()
    }
}
