//! How far the models and their shadows on the ground reach.

use crate::mesh::Mesh;
use crate::sun::SunTrack;
use glam::{DVec2, DVec3};

/// An upright box, metres in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Bounds {
    /// Around all faces; `None` where there are none.
    pub(super) fn of(mesh: &Mesh) -> Option<Bounds> {
        let mut bounds = Bounds { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        for corner in corners(mesh, |_| true) {
            bounds.low = bounds.low.min(corner);
            bounds.high = bounds.high.max(corner);
        }
        bounds.low.is_finite().then_some(bounds)
    }

    pub(super) fn centre(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }
}

/// The plan's rectangle around the models and the casters' shadows on the ground at the day instants,
/// each shadow cut at `cut` times the height above the ground. South-west and north-east corner, metres.
pub(super) fn with_shadows(
    mesh: &Mesh,
    bounds: Bounds,
    casts: &[bool],
    ground: f64,
    track: &SunTrack,
    cut: f64,
) -> [DVec2; 2] {
    // How far east and north a metre of height is thrown, over all instants. A corner's shadow lies at
    // corner + height × throw, so a side of the rectangle is reached at that side's extreme throw.
    let (mut low_throw, mut high_throw) = (DVec2::ZERO, DVec2::ZERO);
    for instant in track.instants.iter().filter(|instant| !instant.night) {
        let to_sun = instant.to_sun.truncate();
        let length = to_sun.length() / instant.to_sun.z.max(1e-9);
        let throw = -to_sun.normalize_or_zero() * length.min(cut);
        low_throw = low_throw.min(throw);
        high_throw = high_throw.max(throw);
    }
    let (mut low, mut high) = (bounds.low.truncate(), bounds.high.truncate());
    for corner in corners(mesh, |component| casts.get(component) == Some(&true)) {
        // What lies below the ground throws no shadow on it.
        let height = (corner.z - ground).max(0.0);
        low = low.min(corner.truncate() + height * low_throw);
        high = high.max(corner.truncate() + height * high_throw);
    }
    [low, high]
}

/// The corners of the faces of some components, in the world frame.
fn corners(mesh: &Mesh, of: impl Fn(usize) -> bool) -> impl Iterator<Item = DVec3> {
    let components = mesh.components.iter().enumerate();
    components
        .filter(move |(index, _)| of(*index))
        .flat_map(|(_, component)| component.faces.clone())
        .filter_map(|face| mesh.faces.get(face as usize))
        .flatten()
        .filter_map(|corner| mesh.vertices.get(*corner as usize))
        .map(|vertex| mesh.origin + vertex.as_dvec3())
}
