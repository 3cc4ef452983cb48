//! What a technique can do of what the window shows.

use crate::choice::{Engine, Method, Subject};
use crate::desktop::state::eye::Stand;

/// Whether a technique draws such a view.
pub(in crate::desktop) fn draws(method: Method, stand: Stand) -> bool {
    let subject = match stand {
        Stand::Perspective => Subject::Camera,
        Stand::Plan => Subject::Top,
        Stand::Side(_) => Subject::Side,
    };
    method.row().draws(Engine::Auto, subject)
}

/// Whether rays are cast, so that the sun's disc can be asked for.
pub(in crate::desktop) fn casts_rays(method: Method, software: bool) -> bool {
    method == Method::RayCast || (method == Method::Auto && software)
}

/// Whether a technique counts volumes.
pub(in crate::desktop) fn counts(method: Method) -> bool {
    method.row().counts
}
