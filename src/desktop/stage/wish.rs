//! The wish: the picture that the window requests.

use crate::desktop::results::StudyResult;
use crate::export::figure::Diagram;
use crate::picture::Style;
use crate::site::Site;
use crate::study::live::LiveMethod;
use crate::view::View;
use glam::DVec3;
use std::sync::Arc;

/// The picture that the window requests.
#[derive(Clone)]
pub(in crate::desktop) struct Wish {
    /// The site without hidden components.
    pub(in crate::desktop) site: Arc<Site>,
    /// The number of the site, which grows with every site loaded.
    pub(in crate::desktop) number: u64,
    /// The view, with the picture's size in pixels.
    pub(in crate::desktop) view: View,
    /// The method for shadows.
    pub(in crate::desktop) way: LiveMethod,
    /// The unit vector to the sun.
    pub(in crate::desktop) to_sun: DVec3,
    /// How the picture is drawn.
    pub(in crate::desktop) style: Style,
    /// Hours to show on the scene.
    pub(in crate::desktop) hours: Option<Arc<StudyResult>>,
    /// Whether volumes and silhouette are shown over it.
    pub(in crate::desktop) overlay: [bool; 2],
    /// A diagram of counting, instead of sun and shadow.
    pub(in crate::desktop) diagram: Option<Diagram>,
    /// Whether this is a quick look during movement, to be followed by a better picture.
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
