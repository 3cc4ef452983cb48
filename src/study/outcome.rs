//! The outcomes of a study and of one instant.

use crate::mesh::Mesh;
use crate::message::Message;
use crate::profile::{Profile, Provenance, Statistics, Timings};
use crate::view::{FragmentCounts, Mask, Overlay, Surface};

/// The result of a study.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The shaded time.
    pub profile: Profile,
    /// What drew the masks.
    pub drawn: Provenance,
    /// What the cells see, if wanted; under [`Receivers::Ground`](crate::choice::Receivers::Ground) also with the
    /// models.
    pub surface: Option<Surface>,
    /// The mesh whose faces are in [`Surface::face`].
    pub surface_mesh: Mesh,
    /// The statistics of counting, if wanted.
    pub statistics: Option<Statistics>,
    /// Notes besides the site's own.
    pub notes: Vec<Message>,
    /// The stages `prepare` and `shadows`.
    pub timings: Timings,
}

/// The result of one instant.
#[derive(Clone, Debug)]
pub struct InstantOutcome {
    /// The share of the sun that each cell sees.
    pub mask: Mask,
    /// What drew the mask.
    pub drawn: Provenance,
    /// What the cells see, if wanted.
    pub surface: Option<Surface>,
    /// Volumes and silhouette, if wanted and if there is a camera and a sun.
    pub overlay: Option<Overlay>,
    /// How much work counting took, if wanted and if there is a sun.
    pub counted: Option<FragmentCounts>,
    /// The mesh whose faces are in [`Surface::face`].
    pub surface_mesh: Mesh,
    /// The stages `prepare` and `shadows`.
    pub timings: Timings,
}
