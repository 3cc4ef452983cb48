//! The settings as one small value, and their history.

use crate::choice::Method;
use crate::export::figure::Diagram;
use crate::site::WrittenSite;
use crate::site::file::SiteFile;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Everything that undo restores: the site file, how its shadows are shown, what is hidden, and what it is compared
/// with.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::desktop) struct WindowSettings {
    /// The site file.
    pub(in crate::desktop) site: SiteFile,
    /// How its shadows are shown.
    pub(in crate::desktop) shown: ShadowSettings,
    /// The components that the picture leaves out, by name.
    pub(in crate::desktop) hidden: Hidden,
    /// The state that it is compared with.
    pub(in crate::desktop) before: Option<Arc<WrittenSite>>,
}

/// The names of components that the window's picture leaves out, whatever their roles.
pub(in crate::desktop) type Hidden = Arc<BTreeSet<String>>;

/// How shadows are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::desktop) struct ShadowSettings {
    /// The technique.
    pub(in crate::desktop) method: Method,
    /// Whether rays are cast to the whole disc of the sun, if rays are cast.
    pub(in crate::desktop) disc: bool,
    /// Whether shadow volumes are shown over the picture.
    pub(in crate::desktop) volumes: bool,
    /// Whether the silhouette is shown over the picture.
    pub(in crate::desktop) silhouette: bool,
    /// The diagram of counting that is shown instead of sun and shadow.
    pub(in crate::desktop) diagram: Option<Diagram>,
    /// Whether components have their own colours.
    pub(in crate::desktop) tinted: bool,
    /// Whether hours are computed on façades, too.
    pub(in crate::desktop) facades: bool,
}

/// The earlier settings, and those that were undone.
#[derive(Default)]
pub(in crate::desktop) struct History {
    past: Vec<WindowSettings>,
    future: Vec<WindowSettings>,
    last: WindowSettings,
}

impl History {
    /// The greatest number of earlier settings.
    const MOST: usize = 200;

    /// Starts over with another site.
    pub(in crate::desktop) fn restart(&mut self, now: &WindowSettings) {
        *self = History { last: now.clone(), ..History::default() };
    }

    /// Records settings after a change.
    pub(in crate::desktop) fn note(&mut self, now: &WindowSettings) {
        if *now != self.last {
            self.past.push(std::mem::replace(&mut self.last, now.clone()));
            self.future.clear();
            if self.past.len() > Self::MOST {
                self.past.remove(0);
            }
        }
    }

    /// Returns the settings before.
    pub(in crate::desktop) fn undo(&mut self) -> Option<WindowSettings> {
        let before = self.past.pop()?;
        self.future.push(std::mem::replace(&mut self.last, before.clone()));
        Some(before)
    }

    /// Returns the settings that were undone last.
    pub(in crate::desktop) fn redo(&mut self) -> Option<WindowSettings> {
        let after = self.future.pop()?;
        self.past.push(std::mem::replace(&mut self.last, after.clone()));
        Some(after)
    }

    /// Changes the site file in all of them.
    pub(in crate::desktop) fn change_all(&mut self, change: impl Fn(&mut SiteFile)) {
        let all = self.past.iter_mut().chain(&mut self.future).chain([&mut self.last]);
        all.for_each(|settings| change(&mut settings.site));
    }

    /// Whether there is something to undo, and to redo.
    pub(in crate::desktop) fn has(&self) -> [bool; 2] {
        [!self.past.is_empty(), !self.future.is_empty()]
    }
}
