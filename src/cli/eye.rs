//! `--view`: the view of the shadows.

use super::wrong_use::WrongUse;
use crate::site::Site;
use crate::study::FrameView;
use crate::view::{Side, View};
use clap::ValueEnum;

/// The view of the shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Viewpoint {
    /// From above, north up
    Plan,
    /// The site's camera: in perspective, or the side that the site file names
    Camera,
    /// From the north, along parallel, horizontal rays, true to scale
    North,
    /// The same from the east
    East,
    /// The same from the south
    South,
    /// The same from the west
    West,
    /// As the sun sees it, along its rays: what is seen there is lit
    Sun,
}

impl Viewpoint {
    /// The side, if the view is one.
    pub(super) fn side(self) -> Option<Side> {
        match self {
            Viewpoint::Plan | Viewpoint::Camera | Viewpoint::Sun => None,
            Viewpoint::North => Some(Side::North),
            Viewpoint::East => Some(Side::East),
            Viewpoint::South => Some(Side::South),
            Viewpoint::West => Some(Side::West),
        }
    }

    /// The view of a site that was requested with that side.
    pub(super) fn of(self, site: &Site) -> FrameView {
        match self {
            Viewpoint::Plan => FrameView::Still(View::Plan(site.grid)),
            Viewpoint::Sun => FrameView::Sun,
            _ => FrameView::Still(site.picture()),
        }
    }

    /// Refuses options of the plan for other views.
    pub(super) fn check(self, of_plan: &[&str]) -> Result<(), WrongUse> {
        match (self, of_plan) {
            (Viewpoint::Plan, _) | (_, []) => Ok(()),
            (_, [option, ..]) => {
                let word = self.to_possible_value().map_or_else(String::new, |word| word.get_name().to_owned());
                Err(WrongUse(format!("{option} is for the plan, but --view {word} has none; leave one out")))
            }
        }
    }
}
