//! The extent of the models, and of their shadows on the ground.

use crate::mesh::Mesh;
use crate::sun::SunTrack;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// An axis-aligned box, metres in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Bounds {
    /// The box around all faces except distant strays; `None` without faces.
    pub(super) fn of(mesh: &Mesh) -> Option<Bounds> {
        mesh.bounds_at_home().map(|(low, high)| Bounds { low, high })
    }

    /// The union.
    fn and(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub(super) fn centre(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }
}

/// The plan's rectangle around the models and the casters' shadows on the ground at the day's instants, without strays.
/// Each shadow is cut at `cut` times the caster's height above the ground. South-west and north-east corner, metres.
pub(super) fn with_shadows(
    mesh: &Mesh,
    bounds: Bounds,
    casts: &[bool],
    ground: f64,
    track: &SunTrack,
    cut: f64,
) -> [DVec2; 2] {
    // The extreme shadow vectors, east and north, per metre of height over all instants. A corner's shadow lies at
    // corner + height × vector, so each side of the rectangle is reached with that side's extreme.
    let (mut low_throw, mut high_throw) = (DVec2::ZERO, DVec2::ZERO);
    for instant in track.instants.iter().filter(|instant| !instant.night) {
        let to_sun = instant.to_sun.truncate();
        let length = to_sun.length() / instant.to_sun.z.max(1e-9);
        let throw = -to_sun.normalize_or_zero() * length.min(cut);
        low_throw = low_throw.min(throw);
        high_throw = high_throw.max(throw);
    }
    let shadow = |corner: DVec3| {
        // below the ground nothing casts a shadow on it
        let height = (corner.z - ground).max(0.0);
        let [low, high] = [low_throw, high_throw].map(|throw| corner + (height * throw).extend(0.0));
        Bounds { low, high }
    };
    // terrain's shadow beyond its own edge would fall on ground that was not measured
    let casts = |at: usize| casts.get(at) == Some(&true) && !mesh.components[at].is_terrain;
    let Bounds { low, high } = around(mesh, casts, bounds, shadow);
    [low.truncate(), high.truncate()]
}

/// The union of `first` and the boxes that `tell` makes of every corner of the chosen components' faces, in the world
/// frame, without distant strays.
fn around(mesh: &Mesh, of: impl Fn(usize) -> bool, first: Bounds, tell: impl Fn(DVec3) -> Bounds + Sync) -> Bounds {
    /// The least number of faces for one task.
    const AT_ONCE: usize = 1 << 12;
    let are_all_home = mesh.are_all_at_home();
    let components = mesh.components.iter().enumerate().filter(|(index, _)| of(*index));
    components.fold(first, |bounds, (_, component)| {
        let faces = &mesh.faces[component.faces.start as usize..component.faces.end as usize];
        let of_face = |bounds: Bounds, face: &[u32; 3]| {
            let corners = face.iter().filter(|&&corner| are_all_home || mesh.is_at_home(corner));
            let points = corners.map(|&corner| mesh.origin + mesh.vertices[corner as usize].as_dvec3());
            points.map(&tell).fold(bounds, Bounds::and)
        };
        let parts = faces.par_iter().with_min_len(AT_ONCE).fold(|| first, of_face);
        parts.reduce(|| bounds, Bounds::and)
    })
}
