//! What the site file gives: later messages blame the file for it, and name no keys where there is no file.

use super::error::FieldLocation;
use super::{Overrides, WrittenSite};
use crate::choice::{Method, Misfit};
use crate::message::Message;

/// What the site file gives of what later messages speak of.
#[derive(Clone, Debug, Default)]
#[doc(hidden)]
pub struct GivenByFile {
    /// Whether there are only models and no site file.
    is_bare_model: bool,
    /// The technique, and where the file names it.
    technique: Option<(Method, FieldLocation)>,
}

impl GivenByFile {
    pub(super) fn of(written: &WrittenSite, asked: &Overrides, method: Method) -> GivenByFile {
        let is_of_file = asked.technique.is_none() && written.site.study.technique.is_some();
        let technique = is_of_file.then(|| (method, written.key("study", "technique")));
        GivenByFile { is_bare_model: written.is_bare_model(), technique }
    }

    /// A message about the site, which names no keys of a site file where there is none.
    pub(crate) fn worded(&self, message: Message) -> Message {
        if self.is_bare_model { message.of_bare_model() } else { message }
    }

    /// Where the site file names the technique that does not fit, if it does.
    pub(crate) fn technique_at(&self, misfit: &Misfit) -> Option<&FieldLocation> {
        let Misfit::Technique { method, .. } = misfit else { return None };
        self.technique.as_ref().filter(|(of_file, _)| of_file == method).map(|(_, at)| at)
    }
}
