//! What drawings are made from, besides the answer itself.

use crate::mesh::Mesh;
use crate::profile::Provenance;
use crate::site::{Ground, Receivers};
use crate::sun::{Place, SunTrack};
use crate::view::Surface;

/// What every drawing needs besides the answer itself.
#[derive(Clone, Copy, Debug)]
pub struct FigureContext<'a, S = Surface> {
    /// Where on earth.
    pub place: &'a Place,
    /// The instants studied; the first one is drawn where there is one.
    pub track: &'a SunTrack,
    /// What stands there.
    pub mesh: &'a Mesh,
    /// What each cell of the view sees; of a plan's also some rows at a time.
    pub surface: &'a S,
    /// Which surfaces were judged.
    pub receivers: Receivers,
    /// The ground plane.
    pub ground: Ground,
    /// What drew.
    pub drawn: &'a Provenance,
}
