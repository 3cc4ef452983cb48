//! Volumes as solids for other programs: one for each component, cut at the ground, closed.
//!
//! The solid is the sum of the prisms between the casting faces and their shadows on the ground. The faces, turned to
//! the sun, are its light cap; the same faces, projected along the sun onto the ground, are its dark cap; there are
//! walls where the directions of the faces at an edge do not cancel. It is closed in that signed sense whatever the
//! mesh, and may overlap itself: its winding number at a point is the number of casting faces between the point and the
//! sun.
//!
//! A closed, well-wound component needs only that half of its faces through which rays from inside leave towards the
//! sun. Then most points are covered once, not twice, and the building itself is part of the solid. In all other
//! components every face casts.

use super::Volume;
use crate::mesh::{Component, Mesh};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// The volume of one component.
#[derive(Clone, Debug)]
pub struct Solid {
    /// The index of the component in the mesh.
    pub component: usize,
    /// World position of the local origin, whole metres near the caster, so that far sites keep their precision.
    pub origin: DVec3,
    /// Distinct positions, metres relative to `origin` in the world's axes.
    pub vertices: Vec<Vec3>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The greatest horizontal length of its shadow, metres.
    pub length_m: f64,
}

/// The volumes of all casters at one instant.
#[derive(Clone, Debug, Default)]
pub struct Solids {
    /// In the components' order.
    pub solids: Vec<Solid>,
    /// The number of casting components without a solid: they are below the ground, or edge-on to the sun.
    pub left_out: usize,
}

/// Why there are no solids.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SolidError {
    /// The sun is not above the horizon, so shadows do not end.
    #[error("the sun is not above the horizon, so no shadow ends on the ground; ask for another time")]
    NoSun,
    /// There are too many casting faces for a file.
    #[error("{0} triangles cast, which exceeds the 4 GiB of a GLB file; let fewer parts cast with `casts`")]
    TooLarge(usize),
}

/// The most casting faces whose volumes may fit in a file, by the bytes of one cap of half of them. Vertices can then
/// be counted in 32 bits, too.
const MOST_CASTING: usize = u32::MAX as usize / 12;

/// The sine of the angle between a face's plane and the sun below which the face has no shadow.
const EDGE_ON: f64 = 1e-9;

/// The volumes of the components that cast, between them and a ground plane at this height, metres.
///
/// # Errors
/// [`SolidError`], before memory is allocated.
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

/// Which half of the faces is enough: those that face the sun (`true`) if the component is closed, well wound and not
/// inside out, the others if it is inside out. `None` if all are needed.
fn half_that_casts(mesh: &Mesh, component: &Component) -> Option<bool> {
    let paired = |edge: u32| match mesh.faces_at(edge as usize) {
        [one, other] => one.direction() + other.direction() == 0,
        _ => false,
    };
    if component.faces.is_empty() || !component.edges.clone().all(paired) {
        return None;
    }
    // relative to one of its own corners, where the tetrahedra are small
    let around = mesh.corners(component.faces.start as usize)[0].as_dvec3();
    let tetrahedron = |face: u32| {
        let [a, b, c] = mesh.corners(face as usize).map(|corner| corner.as_dvec3() - around);
        a.dot(b.cross(c))
    };
    Some(component.faces.clone().map(tetrahedron).sum::<f64>() >= 0.0)
}

/// Faces turned to the sun, cut at the ground. An edge is always cut at the same point.
struct CutFaces<'a> {
    mesh: &'a Mesh,
    ground: f64,
    /// In the world frame; none is below the ground.
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

    /// Adds the part of a face above the ground; a face in the ground's plane has no shadow on it.
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

    /// The vertex where an edge crosses the ground, the same for all of its faces.
    fn section(&mut self, [from, to]: [u32; 2]) -> u32 {
        let edge = [from.min(to), from.max(to)];
        let [low, high] = edge.map(|vertex| self.world(vertex));
        let [below, above] = edge.map(|vertex| self.height(vertex));
        let position = low.lerp(high, below / (below - above)).with_z(self.ground);
        *self.of_edge.entry(edge).or_insert_with(|| append(&mut self.points, position))
    }

    /// The solid; `None` if nothing is above the ground. `along` is the sun's ray for one metre of height.
    fn solid(self, component: usize, along: DVec3) -> Option<Solid> {
        if self.triangles.is_empty() {
            return None;
        }
        let (low, high) = self
            .points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &point| (low.min(point), high.max(point)));
        // near the caster, which is inspected closely, and exact in `f32`, as files store it
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

/// The edges at which the directions of the triangles do not cancel, repeated by their sum.
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

/// Removes triangles with two equal corners after rounding, and pairs of opposite triangles: neither encloses anything,
/// and the sum of directions at each edge stays the same.
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

/// The distinct keys in order, with the sums of their signs that are not 0.
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

/// Points rounded to `f32`; equal ones are one vertex.
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

    /// The triangles, with the vertices that they use.
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
