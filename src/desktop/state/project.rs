//! The open site: as written, as meant, and what else the window needs to know of it.

use crate::desktop::state::settings::{Hidden, WindowSettings};
use crate::formats::ModelReader;
use crate::mesh::Mesh;
use crate::shadow::ray_cast::RayCaster;
use crate::site::file::{PlaceTable, SiteFile, Text};
use crate::site::{Models, Overrides, Site, SiteError, WrittenSite};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An open site.
pub(in crate::desktop) struct Project {
    /// Where its site file lies; none yet for a bare model.
    pub(in crate::desktop) path: Option<PathBuf>,
    /// As it is written.
    pub(in crate::desktop) written: WrittenSite,
    /// As it is meant.
    pub(in crate::desktop) site: Arc<Site>,
    /// What the picture leaves out.
    pub(in crate::desktop) hidden: Hidden,
    /// The site as the picture has it: what is hidden is looked through, as what does not receive is everywhere.
    pub(in crate::desktop) visible: Arc<Site>,
    /// Its models where they stand, whatever is asked of them.
    pub(in crate::desktop) models: Models,
    /// How its models are read.
    pub(in crate::desktop) reading: ModelReader,
    /// The colour of each component.
    pub(in crate::desktop) colours: Vec<[u8; 3]>,
    /// What is visible, to be asked what lies under the pointer; and whose faces those are.
    pub(in crate::desktop) seen: Arc<(Mesh, RayCaster)>,
    /// Models that came together with its site file, to be added to it.
    pub(in crate::desktop) beside: Vec<PathBuf>,
}

/// What an open site is made of.
pub(in crate::desktop) struct LoadedSite {
    pub(in crate::desktop) path: Option<PathBuf>,
    /// None if they are to be read again.
    pub(in crate::desktop) models: Option<Models>,
    pub(in crate::desktop) visible: Arc<Site>,
    pub(in crate::desktop) seen: Arc<(Mesh, RayCaster)>,
}

impl Project {
    /// What of it can be used for the site as it is written now; its models cannot where they are to be read again.
    pub(in crate::desktop) fn loaded(&self, reads_models: bool) -> LoadedSite {
        LoadedSite {
            path: self.path.clone(),
            models: (!reads_models).then(|| self.models.clone()),
            visible: Arc::clone(&self.visible),
            seen: Arc::clone(&self.seen),
        }
    }

    /// Its models, if they are those of a site as it is written.
    pub(in crate::desktop) fn models_of(&self, written: &WrittenSite) -> Option<Models> {
        self.models.are_those_of(written).then(|| self.models.clone())
    }

    /// The files that it is read from, and those of the state that it is compared with.
    pub(in crate::desktop) fn inputs(&self, before: Option<&WrittenSite>) -> Vec<PathBuf> {
        let of_before = before.map(|before| [vec![PathBuf::from(&before.file)], before.model_files()].concat());
        let files = self.path.iter().cloned().chain(self.written.model_files()).chain(self.written.judged_files());
        files.chain(of_before.unwrap_or_default()).collect()
    }

    /// Which of its files is no more what was read.
    pub(in crate::desktop) fn changed_file(&self) -> Option<&Path> {
        let site_file = self.path.as_deref().filter(|path| self.written.has_changed_at(path));
        self.models.changed_file().or(site_file)
    }

    /// As it is written on the disk now; the settings are those of the window where nobody has changed it there.
    ///
    /// # Errors
    /// What is wrong with its file.
    pub(in crate::desktop) fn on_disk(&self, now: &SiteFile) -> Result<WrittenSite, SiteError> {
        let of_window = || WrittenSite { site: now.clone(), ..self.written.clone() };
        let Some(path) = &self.path else { return Ok(of_window()) };
        let mut read = WrittenSite::read(path, &Overrides::default())?;
        if read.text == self.written.text {
            return Ok(of_window());
        }
        complete(&mut read.site);
        Ok(read)
    }

    /// The settings that it comes with.
    pub(in crate::desktop) fn settings(&self, before: &WindowSettings) -> WindowSettings {
        let mut shown = before.shown;
        shown.method = self.site.method;
        WindowSettings { site: self.written.site.clone(), shown, hidden: Arc::clone(&self.hidden), before: None }
    }

    /// What the site is called: its place, otherwise its file.
    pub(in crate::desktop) fn name(&self) -> String {
        let named = self.written.site.place.as_ref().and_then(|place: &PlaceTable| place.name.clone());
        named.filter(|name| !name.trim().is_empty()).unwrap_or_else(|| name_of(Path::new(&self.written.file)))
    }
}

/// What people call a file.
pub(in crate::desktop) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let folder = path.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    match folder {
        Some(folder) if name == "site.toml" => folder,
        _ => name,
    }
}

/// What a study must say and somebody left out: the March day of most rules, nine to five. A study of several days may
/// leave its hours out.
pub(in crate::desktop) fn complete(site: &mut SiteFile) {
    let study = &mut site.study;
    study.step.get_or_insert_with(|| "30min".to_owned());
    if study.dates.is_some() {
        return;
    }
    let from = study.from.get_or_insert_with(|| Text("9:00".to_owned()));
    let dated = from.0.contains('T') || from.0.matches('-').count() >= 2;
    if !dated {
        study.date.get_or_insert_with(|| Text("2026-03-21".to_owned()));
    }
    study.to.get_or_insert_with(|| Text("17:00".to_owned()));
}
