//! The files from which a request is read, so that no answer is written over one of them.

use super::SiteError;
use super::file::SiteFile;
use super::model_table::placed;
use super::written::WrittenSite;
use crate::formats;
use crate::formats::on_disk;
use std::iter;
use std::path::{Path, PathBuf};

/// The files from which a request is read: the site file, its models, the files that those name, and the files of what is
/// judged. `path` is a site file, a folder that contains a `site.toml`, or a model.
///
/// # Errors
/// What cannot be read, and what is wrong with a site file's form.
pub fn inputs(path: &Path) -> Result<Vec<PathBuf>, SiteError> {
    let path = &*on_disk(path);
    let written = WrittenSite::read_as_it_is(path)?;
    let file = if path.is_dir() { path.join("site.toml") } else { path.to_owned() };
    Ok(iter::once(file).chain(written.model_files()).chain(written.judged_files()).collect())
}

impl WrittenSite {
    /// Its models, and the files that those name: buffers, and also pictures, which are not read.
    pub fn model_files(&self) -> Vec<PathBuf> {
        let models = (0..self.site.model.len()).filter_map(|index| Some(on_disk(&placed(self, index).ok()?.0)));
        models.flat_map(|file| formats::named_by(&file).into_iter().chain([file])).collect()
    }

    /// The files that say what is judged: areas, the plot, rooms, and the state before with its models.
    pub fn judged_files(&self) -> Vec<PathBuf> {
        let SiteFile { area, window, plot, before, .. } = &self.site;
        let areas = area.iter().filter_map(|area| area.file.as_ref());
        let rooms = window.iter().filter_map(|window| window.rooms.as_ref());
        let named = areas.chain(rooms).chain(plot.iter().filter_map(|plot| plot.file.as_ref()));
        let mut files: Vec<PathBuf> = named.map(|file| on_disk(&self.folder.join(file))).collect();
        if let Some(site) = before.as_ref().and_then(|before| before.site.as_ref()) {
            let path = on_disk(&self.folder.join(site));
            // one that cannot be read names nothing
            files.extend(WrittenSite::read_as_it_is(&path).map_or_else(|_| Vec::new(), |other| other.model_files()));
            files.push(if path.is_dir() { path.join("site.toml") } else { path });
        }
        files.sort_unstable();
        files.dedup();
        files
    }
}
