//! How far the models and their shadows on the ground reach.

use crate::mesh::Mesh;
use crate::sun::SunTrack;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// An upright box, metres in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Bounds {
    /// Around all faces but strays that lie far off; `None` where there are none.
    pub(super) fn of(mesh: &Mesh) -> Option<Bounds> {
        let none = Bounds { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        let bounds = around(mesh, |_| true, none, |corner| Bounds { low: corner, high: corner });
        let bounds = if bounds.low.is_finite() { (bounds.low, bounds.high) } else { mesh.bounds()? };
        Some(Bounds { low: bounds.0, high: bounds.1 })
    }

    /// Around both.
    fn and(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub(super) fn centre(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }
}

/// The plan's rectangle around the models and the casters' shadows on the ground at the day instants, without strays; each
/// shadow is cut at `cut` times the height above the ground. South-west and north-east corner, metres.
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
    let shadow = |corner: DVec3| {
        // What lies below the ground throws no shadow on it.
        let height = (corner.z - ground).max(0.0);
        let [low, high] = [low_throw, high_throw].map(|throw| corner + (height * throw).extend(0.0));
        Bounds { low, high }
    };
    // what terrain shades beyond its own edge is no measured ground
    let casts = |at: usize| casts.get(at) == Some(&true) && !mesh.components[at].is_terrain;
    let Bounds { low, high } = around(mesh, casts, bounds, shadow);
    [low.truncate(), high.truncate()]
}

/// A box around `first` and what `tell` makes of every corner of the faces of some components, in the world frame; strays
/// that lie far off are left out.
fn around(mesh: &Mesh, of: impl Fn(usize) -> bool, first: Bounds, tell: impl Fn(DVec3) -> Bounds + Sync) -> Bounds {
    /// Faces that one task looks at, at the least.
    const AT_ONCE: usize = 1 << 12;
    let components = mesh.components.iter().enumerate().filter(|(index, _)| of(*index));
    components.fold(first, |bounds, (_, component)| {
        let faces = &mesh.faces[component.faces.start as usize..component.faces.end as usize];
        let of_face = |bounds: Bounds, face: &[u32; 3]| {
            let corners = face.iter().filter(|&&corner| mesh.is_at_home(corner));
            let points = corners.map(|&corner| mesh.origin + mesh.vertices[corner as usize].as_dvec3());
            points.map(&tell).fold(bounds, Bounds::and)
        };
        let parts = faces.par_iter().with_min_len(AT_ONCE).fold(|| first, of_face);
        parts.reduce(|| bounds, Bounds::and)
    })
}
