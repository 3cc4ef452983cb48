//! The context of a drawing: everything it is made from except the result itself.

use crate::choice::Receivers;
use crate::mesh::Mesh;
use crate::profile::Provenance;
use crate::site::Ground;
use crate::sun::{Place, SunTrack};
use crate::view::Surface;

/// What every drawing needs besides the result itself.
#[derive(Clone, Copy, Debug)]
pub struct FigureContext<'a, S = Surface> {
    /// The place on Earth.
    pub place: &'a Place,
    /// The instants of the study. A drawing of one instant shows the first.
    pub track: &'a SunTrack,
    /// The mesh of the site.
    pub mesh: &'a Mesh,
    /// What each cell of the view sees. For a plan it can also be read a few rows at a time.
    pub surface: &'a S,
    /// What was judged.
    pub receivers: Receivers,
    /// The ground.
    pub ground: Ground,
    /// How the result was computed.
    pub drawn: &'a Provenance,
}

impl<S> FigureContext<'_, S> {
    /// Whether only the ground was judged, not the buildings.
    pub(super) fn is_ground_alone(&self) -> bool {
        self.receivers == Receivers::Ground
    }

    /// Whether a cell of the plan is drawn as ground, be it the plane or terrain.
    pub(super) fn is_ground(&self, face: u32) -> bool {
        face == Surface::GROUND || self.mesh.is_terrain(face)
    }
}
