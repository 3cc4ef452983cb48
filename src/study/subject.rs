//! The subject: what a technique judges in a view of a site.

use crate::choice::{Receivers, Subject};
use crate::site::{GroundKind, Site};
use crate::view::View;

/// The receivers of a view: for the plan those of the request, for a camera what it sees.
pub fn judged(site: &Site, view: &View) -> Receivers {
    match view {
        View::Plan(_) => site.receivers,
        View::Camera(_) | View::Elevation(_) => Receivers::Top,
    }
}

/// The subject of a view.
pub(super) fn subject(view: &View, receivers: Receivers, ground: GroundKind) -> Subject {
    match (view, receivers, ground) {
        (View::Camera(_), ..) => Subject::Camera,
        (View::Elevation(_), ..) => Subject::Side,
        (View::Plan(_), Receivers::Top, _) => Subject::Top,
        (View::Plan(_), Receivers::Ground, GroundKind::Plane) => Subject::Ground,
        (View::Plan(_), Receivers::Ground, GroundKind::Terrain) => Subject::Terrain,
        (View::Plan(_), Receivers::Patches, _) => Subject::Patches,
    }
}

/// The subject of a view of a site.
pub(super) fn subject_of(site: &Site, view: &View) -> Subject {
    subject(view, judged(site, view), site.ground.kind)
}
