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

/// The technique that draws the sun as a disc, if the chosen one can. On a software adapter `auto` chooses it for the
/// window's pictures.
pub(in crate::desktop) fn of_disc(method: Method, software: bool) -> Option<Method> {
    let is_chosen = |of_discs: &Method| method == *of_discs || method == Method::Auto && software;
    Method::of_discs().filter(is_chosen)
}

/// Whether a technique counts volumes.
pub(in crate::desktop) fn counts(method: Method) -> bool {
    method.row().counts
}
