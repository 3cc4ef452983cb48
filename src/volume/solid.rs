//! Volumes as solids for other programs: one for each component, cut at the ground, closed.
//!
//! The solid is the sum of the prisms between the casting faces and their shadows on the ground. The faces, turned to
//! the sun, are its light cap; the same faces, projected along the sun onto the ground, are its dark cap; walls hang
//! where the directions of the faces at an edge do not cancel. It is closed in that signed sense whatever the mesh, and
//! it may overlap itself: how often it winds around a point is how many casting faces lie between the point and the
//! sun.
//!
//! A closed, well-wound component needs only the half of its faces through which rays from inside leave to the sun.
//! Then most points are covered once, not twice, and the building itself is in the solid. In all other components every
//! face casts.

use super::Volume;
use crate::mesh::{Component, Mesh};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// The volume of one component.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Whose volume: an index of the mesh's components.
    pub component: usize,
    /// World position of the local origin, whole metres near the caster, so that far sites keep their precision.
    pub origin: DVec3,
    /// Metres around `origin` in the world's axes, no two alike.
    pub vertices: Vec<Vec3>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// How far over the ground the longest shadow reaches from the point that casts it, metres.
    pub length_m: f64,
}

/// The volumes of all casters at one instant.
#[derive(Clone, Debug, Default)]
pub struct Solids {
    /// In the components' order.
    pub solids: Vec<Solid>,
    /// How many casting components have none: they lie below the ground, or edge-on to the sun.
    pub left_out: usize,
}

/// Why there are no solids.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SolidError {
    /// Shadows do not end.
    #[error("the sun is not above the horizon, so no shadow ends on the ground; ask for another time")]
    NoSun,
    /// Already the casting faces would fill a file.
    #[error("{0} triangles cast, and a GLB file ends at 4 GiB; let fewer parts cast with `casts`")]
    TooLarge(usize),
}

/// The most casting faces of which a file can hold the volumes, by the bytes of one cap of half of them; vertices can
/// then be counted in 32 bits, too.
const MOST_CASTING: usize = u32::MAX as usize / 12;

/// A face whose plane is so near to the sun (sine of the angle) throws no shadow.
const EDGE_ON: f64 = 1e-9;

/// The volumes of the components that cast, between them and a ground plane at this height, metres.
///
/// # Errors
/// [`SolidError`], before memory is taken.
pub fn solids(mesh: &Mesh, casts: &[bool], to_sun: DVec3, ground: f64) -> Result<Solids, SolidError> {
    let along = -to_sun / to_sun.z;
    if !(to_sun.z > 0.0 && along.is_finite()) {
        return Err(SolidError::NoSun);
    }
    let casting: Vec<usize> =
        (0..mesh.components.len()).filter(|&component| casts.get(component) == Some(&true)).collect();
    let faces: usize = casting.iter().map(|&component| mesh.components[component].faces.len()).sum();
    if faces > MOST_CASTING {
        return Err(SolidError::TooLarge(faces));
    }
    let light = to_sun.extend(0.0);
    let facing = mesh.facing(light);
    let of = |&component: &usize| {
        let caster = &mesh.components[component];
        let half = half_that_casts(mesh, caster);
        let mut cut = CutFaces::new(mesh, ground);
        for face in caster.faces.clone() {
            let towards = facing[face as usize];
            let edge_on = mesh.planes()[face as usize].dot(light).abs() <= EDGE_ON;
            if !edge_on && half.is_none_or(|half| half == towards) {
                let [a, b, c] = mesh.faces[face as usize];
                cut.add(if towards { [a, b, c] } else { [a, c, b] });
            }
        }
        cut.solid(component, along)
    };
    let solids: Vec<Solid> = casting.par_iter().filter_map(of).collect();
    Ok(Solids { left_out: casting.len() - solids.len(), solids })
}

/// Which faces alone are enough: those that face the sun (`true`) where the component is closed, well wound and not
/// inside out, those that do not where it is inside out. None where all are needed.
fn half_that_casts(mesh: &Mesh, component: &Component) -> Option<bool> {
    let paired = |edge: u32| match mesh.faces_at(edge as usize) {
        [one, other] => one.direction() + other.direction() == 0,
        _ => false,
    };
    if component.faces.is_empty() || !component.edges.clone().all(paired) {
        return None;
    }
    // around one of its own corners, where the tetrahedra are small
    let around = mesh.corners(component.faces.start as usize)[0].as_dvec3();
    let tetrahedron = |face: u32| {
        let [a, b, c] = mesh.corners(face as usize).map(|corner| corner.as_dvec3() - around);
        a.dot(b.cross(c))
    };
    Some(component.faces.clone().map(tetrahedron).sum::<f64>() >= 0.0)
}

/// Faces turned to the sun, cut at the ground. What is cut at one edge is cut in one point.
struct CutFaces<'a> {
    mesh: &'a Mesh,
    ground: f64,
    /// In the world frame, none below the ground.
    points: Vec<DVec3>,
    of_vertex: FxHashMap<u32, u32>,
    of_edge: FxHashMap<[u32; 2], u32>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> CutFaces<'a> {
    fn new(mesh: &'a Mesh, ground: f64) -> Self {
        let (of_vertex, of_edge) = Default::default();
        CutFaces { mesh, ground, points: Vec::new(), of_vertex, of_edge, triangles: Vec::new() }
    }

    /// Adds what of a face is above the ground; a face in the ground throws no shadow on it.
    fn add(&mut self, face: [u32; 3]) {
        let heights = face.map(|vertex| self.height(vertex));
        if heights.iter().all(|&height| height <= 0.0) {
            return;
        }
        let mut corners = [0; 4];
        let mut count = 0;
        let mut append = |point| {
            corners[count] = point;
            count += 1;
        };
        for (at, next) in [(0, 1), (1, 2), (2, 0)] {
            if heights[at] >= 0.0 {
                append(self.vertex(face[at]));
            }
            if heights[at] * heights[next] < 0.0 {
                append(self.section([face[at], face[next]]));
            }
        }
        self.triangles.extend((2..count).map(|last| [corners[0], corners[last - 1], corners[last]]));
    }

    fn world(&self, vertex: u32) -> DVec3 {
        self.mesh.origin + self.mesh.vertices[vertex as usize].as_dvec3()
    }

    fn height(&self, vertex: u32) -> f64 {
        self.world(vertex).z - self.ground
    }

    fn vertex(&mut self, vertex: u32) -> u32 {
        let position = self.world(vertex);
        *self.of_vertex.entry(vertex).or_insert_with(|| append(&mut self.points, position))
    }

    /// Where an edge goes through the ground, the same whichever face asks.
    fn section(&mut self, [from, to]: [u32; 2]) -> u32 {
        let edge = [from.min(to), from.max(to)];
        let [low, high] = edge.map(|vertex| self.world(vertex));
        let [below, above] = edge.map(|vertex| self.height(vertex));
        let position = low.lerp(high, below / (below - above)).with_z(self.ground);
        *self.of_edge.entry(edge).or_insert_with(|| append(&mut self.points, position))
    }

    /// Caps and walls, or nothing where nothing is above the ground. `along` leads a metre down along the sun's rays.
    fn solid(self, component: usize, along: DVec3) -> Option<Solid> {
        if self.triangles.is_empty() {
            return None;
        }
        let (low, high) = self
            .points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &point| (low.min(point), high.max(point)));
        // of the near end, which is looked at closely; a number that `f32` holds, as files keep it
        let origin = ((low + high) / 2.0).with_z(self.ground).round().as_vec3().as_dvec3();
        let mut rounded = RoundedPoints::default();
        let near: Vec<u32> = self.points.iter().map(|&point| rounded.vertex(point - origin)).collect();
        let far = |point: &DVec3| (*point + along * (point.z - self.ground)).with_z(self.ground);
        let far: Vec<u32> = self.points.iter().map(|point| rounded.vertex(far(point) - origin)).collect();

        let light_cap = self.triangles.iter().map(|face| face.map(|point| near[point as usize]));
        let dark_cap = self.triangles.iter().map(|&[a, b, c]| [a, c, b].map(|point| far[point as usize]));
        let hang = |(point, is_far): (u32, bool)| if is_far { far[point as usize] } else { near[point as usize] };
        let walls = borders(&self.triangles).into_iter().flat_map(Volume::wall).map(|wall| wall.map(hang));
        let triangles = without_nothing(light_cap.chain(dark_cap).chain(walls));
        let length_m = (high.z - self.ground) * along.truncate().length();
        let solid = rounded.solid(triangles);
        (!solid.1.is_empty()).then_some(Solid { component, origin, vertices: solid.0, triangles: solid.1, length_m })
    }
}

fn append(points: &mut Vec<DVec3>, point: DVec3) -> u32 {
    points.push(point);
    points.len() as u32 - 1
}

/// The edges at which the directions of the triangles do not cancel, each as often as their sum says.
fn borders(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    summed(triangles.iter().flat_map(|&[a, b, c]| {
        [[a, b], [b, c], [c, a]].map(|[from, to]| ([from.min(to), from.max(to)], if from < to { 1 } else { -1 }))
    }))
    .into_iter()
    .flat_map(|([from, to], sum)| {
        let edge = if sum > 0 { [from, to] } else { [to, from] };
        std::iter::repeat_n(edge, sum.unsigned_abs() as usize)
    })
    .collect()
}

/// Without the triangles of which rounding made two corners one, and without pairs that lie on each other back to back:
/// neither encloses anything, and at each edge the sum of directions stays.
fn without_nothing(triangles: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 3]> {
    let signed = triangles.filter(|[a, b, c]| a != b && b != c && c != a).map(|[a, b, c]| {
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        let turned = [[a, b, c], [b, c, a], [c, a, b]].contains(&sorted);
        (sorted, if turned { 1 } else { -1 })
    });
    summed(signed)
        .into_iter()
        .flat_map(|([a, b, c], sum)| {
            let face = if sum > 0 { [a, b, c] } else { [a, c, b] };
            std::iter::repeat_n(face, sum.unsigned_abs() as usize)
        })
        .collect()
}

/// Each key once, in order, with the sum of its signs where that is not 0.
fn summed<K: Ord>(signed: impl Iterator<Item = (K, i32)>) -> Vec<(K, i32)> {
    let mut all: Vec<(K, i32)> = signed.collect();
    all.sort_unstable_by(|one, other| one.0.cmp(&other.0));
    all.dedup_by(|next, first| {
        let same = next.0 == first.0;
        first.1 += if same { next.1 } else { 0 };
        same
    });
    all.retain(|(_, sum)| *sum != 0);
    all
}

/// Points as `f32`; those that become equal are one vertex.
#[derive(Default)]
struct RoundedPoints {
    vertices: Vec<Vec3>,
    of_bits: FxHashMap<[u32; 3], u32>,
}

impl RoundedPoints {
    fn vertex(&mut self, point: DVec3) -> u32 {
        let vertex = point.as_vec3() + Vec3::ZERO; // + 0 makes −0 and 0 one
        *self.of_bits.entry(vertex.to_array().map(f32::to_bits)).or_insert_with(|| {
            self.vertices.push(vertex);
            self.vertices.len() as u32 - 1
        })
    }

    /// The triangles, and the vertices that they have.
    fn solid(self, mut triangles: Vec<[u32; 3]>) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut vertices = Vec::new();
        let mut kept = vec![u32::MAX; self.vertices.len()];
        for corner in triangles.iter_mut().flatten() {
            let kept = &mut kept[*corner as usize];
            if *kept == u32::MAX {
                *kept = vertices.len() as u32;
                vertices.push(self.vertices[*corner as usize]);
            }
            *corner = *kept;
        }
        (vertices, triangles)
    }
}

impl Solid {
    /// Whether it is closed: at every edge between two positions the directions of the triangles cancel.
    pub fn closed(&self) -> bool {
        let mut rounded = RoundedPoints::default();
        let welded: Vec<u32> = self.vertices.iter().map(|vertex| rounded.vertex(vertex.as_dvec3())).collect();
        let triangles: Vec<_> = self.triangles.iter().map(|face| face.map(|corner| welded[corner as usize])).collect();
        // an edge from a vertex to itself runs both ways
        borders(&triangles).into_iter().all(|[from, to]| from == to)
    }

    /// The corners of a triangle, metres of the world frame.
    #[cfg(feature = "test-hooks")]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|corner| self.origin + self.vertices[corner as usize].as_dvec3())
    }
}
