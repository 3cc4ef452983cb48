//! The wish: what the window wants to see.

use crate::desktop::results::StudyResult;
use crate::export::figure::Diagram;
use crate::picture::Style;
use crate::site::Site;
use crate::study::live::LiveMethod;
use crate::view::View;
use glam::DVec3;
use std::sync::Arc;

/// What the window wishes to see.
#[derive(Clone)]
pub(in crate::desktop) struct Wish {
    /// The site without what is hidden, and which one of those that were loaded.
    pub(in crate::desktop) site: Arc<Site>,
    /// Grows with every site loaded.
    pub(in crate::desktop) number: u64,
    /// With the picture's size in pixels.
    pub(in crate::desktop) view: View,
    /// How shadows are found.
    pub(in crate::desktop) way: LiveMethod,
    /// The unit vector to the sun.
    pub(in crate::desktop) to_sun: DVec3,
    /// How the picture is drawn.
    pub(in crate::desktop) style: Style,
    /// Hours to lie over the scene.
    pub(in crate::desktop) hours: Option<Arc<StudyResult>>,
    /// The volumes and the silhouette over it.
    pub(in crate::desktop) overlay: [bool; 2],
    /// What counting took, instead.
    pub(in crate::desktop) diagram: Option<Diagram>,
    /// Something moves: this is a quick look, and a better one will be wished for.
    pub(in crate::desktop) quick: bool,
}

impl Wish {
    /// Whether two wishes are for the same picture.
    pub(in crate::desktop) fn is_same(&self, other: &Wish) -> bool {
        let hours = |wish: &Wish| wish.hours.as_ref().map(|hours| hours.number);
        self.number == other.number
            && self.view == other.view
            && self.way == other.way
            && self.to_sun == other.to_sun
            && self.style == other.style
            && hours(self) == hours(other)
            && self.overlay == other.overlay
            && self.diagram == other.diagram
    }
}
