//! Finds parts of patches that are not surfaces of their own: those that exist twice, and those between solids that
//! touch.
//!
//! Patches share a place if one lies in the other's plane, within the millimetre at which receivers are judged. If two
//! outer sides face each other there, each has a solid behind it, so no sun reaches them. Everything else that shares a
//! place is one surface, which counts in the first patch that has it.
//!
//! If two solids of one component share the exact corners of a wall, nothing shows its outer side. Its two sides run in
//! opposite directions, like those of a sheet whose back is in the file; but all around the wall there are faces in
//! front of it and behind it.

use super::texels::place;
use super::{FLAT_ANGLE_DEG, Patch, Patches, UncountedArea, gather};
use crate::mesh::scan::{self, Coverage};
use crate::mesh::{Mesh, planes};
use glam::{DVec2, DVec4, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use std::time::Duration;

/// Surfaces closer to a plane than this are in the plane, metres.
const ONE_PLANE_M: f64 = 0.001;
/// An outside in front of a plane may be this far behind it by rounding, metres. What is deeper is the plane's own
/// back, as in thin sheet metal.
const BEHIND_M: f64 = 0.0001;
/// A texel's place must be shared this far around its centre, in texels, so that surfaces that only meet at an edge
/// share nothing.
const AROUND: f64 = 0.01;
/// The offset from a texel's centre, in texels, at which a patch's own faces are counted; chosen to avoid edges.
const BESIDE: DVec2 = DVec2::new(0.012_345_67, 0.007_891_01);

/// A flat surface with which a patch may share its place.
struct FlatSurface<'a> {
    component: u32,
    /// Whether its outer side is unknown, and other faces are in front of it and behind it all around.
    between: bool,
    plane: DVec4,
    two_sided: bool,
    casts: bool,
    receives: bool,
    faces: &'a [u32],
}

/// All flat surfaces, in a spatial index.
struct FlatSurfaces<'a> {
    list: Vec<FlatSurface<'a>>,
    boxes: Vec<Aabb>,
    tree: Bvh2,
}

/// The part of a patch that counts.
struct CountedArea {
    area_m2: f64,
    uncounted: Vec<u32>,
    left_out: UncountedArea,
}

impl Patches {
    /// Excludes from all sums what is not a surface of its own.
    pub fn leave_out_shared(&mut self, mesh: &Mesh, casts: &[bool], receives: &[bool]) {
        let only_cast: Vec<bool> = casts.iter().zip(receives).map(|(casts, receives)| *casts && !receives).collect();
        let beside = gather::gather(mesh, &only_cast);
        let edges = planes::sides(mesh);
        let between =
            |faces: &[u32], plane: DVec4, two_sided: bool| two_sided && is_between(mesh, &edges, faces, plane);
        let received = self.list.iter().map(|patch| FlatSurface {
            component: patch.component,
            between: between(self.faces_of(patch), patch.plane, patch.two_sided),
            plane: patch.plane,
            two_sided: patch.two_sided,
            casts: casts[patch.component as usize],
            receives: true,
            faces: self.faces_of(patch),
        });
        let passed = beside.iter().map(|flat| FlatSurface {
            component: flat.component,
            between: between(&flat.faces, flat.plane, flat.two_sided),
            plane: flat.plane,
            two_sided: flat.two_sided,
            casts: true,
            receives: false,
            faces: &flat.faces,
        });
        let list: Vec<FlatSurface> = received.chain(passed).collect();
        let boxes: Vec<Aabb> = list.iter().map(|other| around(mesh, other.faces)).collect();
        let tree = build_bvh2(&boxes, BvhBuildParams::fast_build(), &mut Duration::default());
        let others = FlatSurfaces { list, boxes, tree };
        let counted: Vec<CountedArea> =
            (0..self.list.len()).into_par_iter().map(|number| self.counted(mesh, &others, number)).collect();
        for (patch, counted) in self.list.iter_mut().zip(counted) {
            (patch.area_m2, patch.uncounted) = (counted.area_m2, counted.uncounted);
            self.left_out.doubled_m2 += counted.left_out.doubled_m2;
            self.left_out.touching_m2 += counted.left_out.touching_m2;
        }
    }

    fn faces_of(&self, patch: &Patch) -> &[u32] {
        &self.faces[patch.faces.start as usize..patch.faces.end as usize]
    }

    fn counted(&self, mesh: &Mesh, others: &FlatSurfaces, number: usize) -> CountedArea {
        let patch = &self.list[number];
        let once = self.covered_once(mesh, patch);
        let mut area_m2 = if once < 1.0 { patch.area_m2 * once } else { patch.area_m2 };
        let mut left_out = UncountedArea { doubled_m2: patch.area_m2 - area_m2, touching_m2: 0.0 };
        let mut uncounted = Vec::new();
        let (again, touching) = others.sharing(patch, number);
        if again.is_empty() && touching.is_empty() {
            return CountedArea { area_m2, uncounted, left_out };
        }
        let again = self.covered_by(mesh, patch, &again, -ONE_PLANE_M);
        let touching = self.covered_by(mesh, patch, &touching, -BEHIND_M);
        if again.is_none() && touching.is_none() {
            return CountedArea { area_m2, uncounted, left_out };
        }
        let (mut doubled, mut touched) = (0, 0);
        for number in patch.texels.clone() {
            let texel = self.texels[number as usize];
            let lies_in = |covers: &Option<[Coverage; 4]>| {
                let covers = covers.as_ref();
                covers.is_some_and(|covers| covers.iter().all(|it| it.get(texel.column.into(), texel.row.into())))
            };
            let (is_touching, is_again) = (lies_in(&touching), lies_in(&again));
            touched += u32::from(is_touching);
            doubled += u32::from(is_again && !is_touching);
            if is_touching || is_again {
                uncounted.push(number);
            }
        }
        if !uncounted.is_empty() {
            let of_texels = |count: u32| area_m2 * f64::from(count) / patch.texels.len() as f64;
            left_out.doubled_m2 += of_texels(doubled);
            left_out.touching_m2 += of_texels(touched);
            area_m2 = of_texels(patch.texels.len() as u32 - doubled - touched);
        }
        CountedArea { area_m2, uncounted, left_out }
    }

    /// The area of a patch as a share of its faces' area, if those overlap; normally 1.
    fn covered_once(&self, mesh: &Mesh, patch: &Patch) -> f64 {
        let faces = self.faces_of(patch);
        if faces.len() < 2 {
            return 1.0;
        }
        let mut bits = Coverage::empty(patch.width, patch.height);
        let mut times = 0;
        for &face in faces {
            let mut corners =
                mesh.corners(face as usize).map(|corner| place(patch, corner.as_dvec3(), self.cell) - BESIDE);
            bits.cover(corners);
            corners.sort_unstable_by(|one, other| scan::by_rows(*one, *other));
            let columns = |from: f64, to: f64| scan::wholes([from, to], 0..patch.width as usize).len();
            scan::spans(corners, 0..patch.height as usize, |_, from, to| times += columns(from, to));
        }
        let once = bits.count();
        if once < times { once as f64 / times as f64 } else { 1.0 }
    }

    /// The texels that lie wholly in other surfaces: these must cover four points around the centre. Only surfaces no
    /// lower than `least` above the patch's plane count; `None` if there is none.
    fn covered_by(&self, mesh: &Mesh, patch: &Patch, others: &[&FlatSurface], least: f64) -> Option<[Coverage; 4]> {
        let in_plane = |corner: &Vec3| (least..=ONE_PLANE_M).contains(&patch.plane.dot(corner.as_dvec3().extend(1.0)));
        let faces = others.iter().flat_map(|other| other.faces).map(|&face| mesh.corners(face as usize));
        let faces: Vec<[Vec3; 3]> = faces.filter(|corners| corners.iter().all(in_plane)).collect();
        if faces.is_empty() {
            return None;
        }
        // the point at which a patch without centres is judged
        let aside = patch.alone.map_or(DVec2::ZERO, |point| {
            let texel = self.texels[patch.texels.start as usize];
            place(patch, point, self.cell) - DVec2::new(texel.column.into(), texel.row.into())
        });
        let around = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        Some(around.map(|(right, down)| {
            let shift = aside + DVec2::new(right, down) * AROUND;
            let mut bits = Coverage::empty(patch.width, patch.height);
            for corners in &faces {
                bits.cover(corners.map(|corner| place(patch, corner.as_dvec3(), self.cell) - shift));
            }
            bits
        }))
    }
}

impl FlatSurfaces<'_> {
    /// The surfaces that may share their place with a patch: those that it may repeat, and those that it may touch.
    fn sharing(&self, patch: &Patch, number: usize) -> (Vec<&FlatSurface<'_>>, Vec<&FlatSurface<'_>>) {
        let least_cosine = FLAT_ANGLE_DEG.to_radians().cos();
        let (mut again, mut touching) = (Vec::new(), Vec::new());
        self.tree.aabb_traverse(self.boxes[number], |tree, node| {
            let node = &tree.nodes[node as usize];
            let first = node.first_index as usize;
            for &at in &tree.primitive_indices[first..first + node.prim_count as usize] {
                let (at, other) = (at as usize, &self.list[at as usize]);
                let cosine = other.plane.truncate().dot(patch.normal());
                if at == number || cosine.abs() < least_cosine || !self.boxes[at].intersect_aabb(&self.boxes[number]) {
                    continue;
                }
                let is_other_side = other.between && self.list[number].between && other.component == patch.component;
                let looks_at_it = cosine < 0.0 && (!other.two_sided && !patch.two_sided || is_other_side);
                if looks_at_it && other.casts {
                    touching.push(other);
                } else if !looks_at_it && other.receives && at < number {
                    again.push(other);
                }
            }
            true
        });
        (again, touching)
    }
}

/// Whether, at every edge around faces in a plane, other faces are in front of the plane and behind it.
fn is_between(mesh: &Mesh, edges: &[[u32; 3]], faces: &[u32], plane: DVec4) -> bool {
    let own: FxHashSet<u32> = faces.iter().copied().collect();
    let around = faces
        .iter()
        .flat_map(|&face| edges[face as usize])
        .filter(|&edge| mesh.faces_at(edge as usize).iter().filter(|at| own.contains(&at.face())).count() == 1);
    let stands = |edge: u32, side: f64| {
        let corners = mesh.faces_at(edge as usize).iter().flat_map(|at| mesh.corners(at.face() as usize));
        corners.map(|corner| plane.dot(corner.as_dvec3().extend(1.0)) * side).any(|above| above > ONE_PLANE_M)
    };
    let mut around = around.peekable();
    around.peek().is_some() && around.all(|edge| stands(edge, 1.0) && stands(edge, -1.0))
}

/// A box around faces, with the tolerance within which two planes are the same.
fn around(mesh: &Mesh, faces: &[u32]) -> Aabb {
    let corners = || faces.iter().flat_map(|&face| mesh.corners(face as usize)).map(Vec3A::from);
    let low = corners().fold(Vec3A::INFINITY, Vec3A::min);
    let high = corners().fold(Vec3A::NEG_INFINITY, Vec3A::max);
    let wide = Vec3A::splat(ONE_PLANE_M as f32);
    Aabb::new(low - wide, high + wide)
}
