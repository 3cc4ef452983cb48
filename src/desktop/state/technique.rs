//! What a technique supports in the window.

use crate::choice::{Engine, Method, Subject};
use crate::desktop::state::eye::Stand;

/// Whether a technique draws the view of a stand.
pub(in crate::desktop) fn draws(method: Method, stand: Stand) -> bool {
    let subject = match stand {
        Stand::Perspective => Subject::Camera,
        Stand::Plan => Subject::Top,
        Stand::Side(_) => Subject::Side,
    };
    method.row().draws(Engine::Auto, subject)
}

/// Whether rays are cast, so that the sun can be a disc.
pub(in crate::desktop) fn casts_rays(method: Method, software: bool) -> bool {
    method == Method::RayCast || (method == Method::Auto && software)
}

/// Whether a technique counts volumes.
pub(in crate::desktop) fn counts(method: Method) -> bool {
    method.row().counts
}
