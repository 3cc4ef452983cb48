//! The answers of a study, and of one instant.

use crate::mesh::Mesh;
use crate::profile::{Profile, Provenance, Statistics, Timings};
use crate::view::{FragmentCounts, Mask, Overlay, Surface};

/// The answer to a study.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The shaded time.
    pub profile: Profile,
    /// What drew it.
    pub drawn: Provenance,
    /// What the cells see, where wanted: also under [`Receivers::Ground`](crate::choice::Receivers::Ground) with the models.
    pub surface: Option<Surface>,
    /// Whose faces [`Surface::face`] counts.
    pub surface_mesh: Mesh,
    /// What counting took, where wanted.
    pub statistics: Option<Statistics>,
    /// `prepare` and `shadows`.
    pub timings: Timings,
}

/// The answer for one instant.
#[derive(Clone, Debug)]
pub struct InstantOutcome {
    /// Which part of the sun each cell sees.
    pub mask: Mask,
    /// What drew it.
    pub drawn: Provenance,
    /// What the cells see, where wanted.
    pub surface: Option<Surface>,
    /// Volumes and silhouette, where wanted and where there is a camera and a sun.
    pub overlay: Option<Overlay>,
    /// What counting took, where wanted and where there is a sun.
    pub counted: Option<FragmentCounts>,
    /// Whose faces [`Surface::face`] counts.
    pub surface_mesh: Mesh,
    /// `prepare` and `shadows`.
    pub timings: Timings,
}
