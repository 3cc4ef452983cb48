//! What stands above a plane: points and edges, and for every sun the directions of the faces.

use super::clumps::{Clumps, JudgedCells, RasterBounds};
use super::edges::{CasterEdges, ClumpEdges, Edge, FaceSide};
use crate::mesh::{Incidence, Mesh, MeshBlock, lowest};
use glam::{DAffine3, DVec2, DVec3, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicI8, Ordering};

/// The greatest sine of the angle between two faces in one plane. If a sun sees the front of one and the back of the
/// other, it sees both edge-on, and the area that they cover is negligible.
const SAME_PLANE: f64 = 1e-9;

/// The edges of a mesh above a plane, and the sections where its faces cross the plane.
pub(super) struct Casters {
    /// Column, row, height.
    points: Vec<DVec3>,
    /// The normal of each group of coplanar faces, relative to the mesh's origin.
    normals: Vec<DVec3>,
    clumps: Clumps,
    edges: CasterEdges,
    /// The sections where faces cross the plane, from where they go down to where they go up, with their clump.
    sections: Vec<Section>,
    /// The clumps that can reach the drawn cells under the current sun.
    reaching: Vec<u32>,
    /// Those of them that are far away. They are used only if the others leave any light.
    far: Vec<u32>,
    /// For each group and direction (`FaceSide`), the change at an edge of a face turned to the sun; 0 if its clump
    /// does not reach.
    signs: Vec<AtomicI8>,
    throw: DVec2,
}

/// A projected silhouette edge: its ends, and the change of the sum where it is crossed, if it runs from lower rows to
/// higher ones.
pub(super) struct FallingEdge {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    pub(super) change: i32,
}

/// A section where a face crosses the plane.
pub(super) struct Section {
    ends: [u32; 2],
    pub(super) side: FaceSide,
    pub(super) clump: u32,
}

impl Casters {
    pub(super) fn cut(mesh: &Mesh, raster_from_local: &DAffine3) -> Casters {
        let points = mesh.vertices.par_iter().map(|vertex| raster_from_local.transform_point3(vertex.as_dvec3()));
        let mut points: Vec<DVec3> = points.collect();
        let (group_of, normals) = groups(mesh);
        let clumps = Clumps::of(mesh, &points, &group_of);
        let clump_of = clumps_of_groups(&clumps, normals.len());
        let no_side = FaceSide::new(normals.len() as u32, false);
        let runs = (0..mesh.edges.len().div_ceil(RUN)).into_par_iter().map(|run| {
            let run = run * RUN..((run + 1) * RUN).min(mesh.edges.len());
            EdgesAbove::cut(mesh, &points, run, |face| group_of[face as usize], no_side, &clump_of)
        });
        let runs: Vec<EdgesAbove> = runs.collect();
        let whole = points.len() as u32;
        let (mut edges, mut meets) = (Vec::with_capacity(runs.len()), Vec::new());
        for mut run in runs {
            let before = points.len() as u32 - whole;
            let of_all = |point: &mut u32| *point += if *point < whole { 0 } else { before };
            if !run.cuts.is_empty() && before > 0 {
                run.edges.edges.iter_mut().flat_map(|edge| &mut edge.ends).for_each(of_all);
                run.meets.iter_mut().for_each(|(_, _, cut)| of_all(cut));
            }
            meets.append(&mut run.meets);
            points.append(&mut run.cuts);
            edges.push(run.edges);
        }
        // a face goes down through the plane once and up once; the section runs between the two
        meets.par_sort_unstable();
        let sections = meets.chunks_exact(2).map(|meet| {
            let [(face, _, down), (_, _, up)] = [meet[0], meet[1]];
            let group = group_of[face as usize];
            Section { ends: [down, up], side: FaceSide::new(group, false), clump: clump_of[group as usize] }
        });
        let sections = sections.collect();
        // a side without a face adds nothing
        let signs = (0..2 * (normals.len() + 1)).map(|_| AtomicI8::new(0)).collect();
        let (reaching, far, throw) = (Vec::new(), Vec::new(), DVec2::ZERO);
        let edges = CasterEdges::AsCut(edges);
        Casters { points, normals, clumps, edges, sections, reaching, far, signs, throw }
    }

    /// Projects along a sun what reaches some of the raster; `throw` is the shadow's columns and rows per metre of
    /// height. What is far away is projected later, on request.
    pub(super) fn project(&mut self, to_sun: DVec3, throw: DVec2, judged: RasterBounds) {
        self.turn(&self.reaching, None);
        self.throw = throw;
        let Casters { clumps, reaching, far, .. } = self;
        let judged = JudgedCells::new(judged, throw);
        clumps.reach(&judged, reaching);
        far.clear();
        let distance = |clump: &u32| judged.distance(&clumps.list()[*clump as usize].bounds);
        let farthest = reaching.iter().map(distance).fold(0.0, f64::max);
        let is_near = |clump: &u32| distance(clump) <= farthest * NEAR;
        let is_worth_it = reaching.iter().filter(|clump| is_near(clump)).count() < reaching.len() / 2;
        if is_worth_it && clumps.culling {
            far.extend(reaching.iter().copied().filter(|clump| !is_near(clump)));
            reaching.retain(is_near);
        }
        if reaching.len() < clumps.list().len() / 2 {
            self.edges.sort(clumps.list().len());
        }
        self.turn(&self.reaching, Some(to_sun));
    }

    /// Whether anything far away is not projected yet.
    pub(super) fn has_far(&self) -> bool {
        !self.far.is_empty()
    }

    /// Projects what is far away.
    pub(super) fn project_far(&mut self, to_sun: DVec3) {
        self.turn(&self.far, Some(to_sun));
        self.reaching.append(&mut self.far);
        self.reaching.sort_unstable();
    }

    /// Sets the changes at the edges of some clumps' faces for a sun, or to 0.
    fn turn(&self, clumps: &[u32], to_sun: Option<DVec3>) {
        clumps.par_iter().with_min_len(AT_ONCE).for_each(|&clump| {
            for group in self.clumps.list()[clump as usize].groups.clone() {
                let group = group as usize;
                let sign = to_sun.map_or(0, |to_sun| if self.normals[group].dot(to_sun) >= 0.0 { 1 } else { -1 });
                self.signs[2 * group].store(sign, Ordering::Relaxed);
                self.signs[2 * group + 1].store(-sign, Ordering::Relaxed);
            }
        });
    }

    /// The points (column, row, height), the mesh's vertices first, and the faces in clumps.
    pub(super) fn standing(&self) -> (&[DVec3], &Clumps) {
        (&self.points, &self.clumps)
    }

    /// Projects everything at every instant.
    #[cfg(feature = "test-hooks")]
    pub(super) fn stop_culling(&mut self) {
        self.clumps.culling = false;
    }

    /// The number of clumps, whether they reach or not.
    pub(super) fn clumps(&self) -> usize {
        self.clumps.list().len()
    }

    /// The clumps that reach under the current sun.
    pub(super) fn reaching(&self) -> &[u32] {
        &self.reaching
    }

    /// The edges of what reaches, silhouette or not, in tasks of about equal length.
    pub(super) fn runs(&self, runs: usize) -> Vec<Vec<&[Edge]>> {
        let slices = self.edges.of(&self.reaching, self.clumps());
        let each = slices.iter().map(|edges| edges.len()).sum::<usize>().div_ceil(runs).max(1);
        let mut split = vec![Vec::new(); runs];
        let (mut run, mut room) = (0, each);
        for mut edges in slices {
            while !edges.is_empty() {
                let (these, others) = edges.split_at(edges.len().min(room));
                room -= these.len();
                split[run].push(these);
                edges = others;
                if room == 0 {
                    (run, room) = (run + 1, each);
                }
            }
        }
        split
    }

    /// The sections with the plane, for any sun: each as an edge whose change must be multiplied by the sign of its
    /// side.
    pub(super) fn sections(&self) -> impl Iterator<Item = (FallingEdge, &Section)> {
        self.sections.iter().map(|section| {
            let [from, to] = section.ends.map(|end| self.points[end as usize].xy());
            (FallingEdge { from, to, change: 1 }, section)
        })
    }

    /// The change that a face on a side makes under the current sun.
    pub(super) fn sign(&self, side: FaceSide) -> i32 {
        i32::from(self.signs[side.index()].load(Ordering::Relaxed))
    }

    /// Calls `tell` with the silhouette edges among some edges.
    pub(super) fn silhouette(&self, edges: &[Edge], mut tell: impl FnMut(FallingEdge)) {
        const AT_ONCE: usize = 128;
        let change = |edge: &Edge| -> i32 { edge.sides.map(|side| self.sign(side)).iter().sum() };
        for edges in edges.chunks(AT_ONCE) {
            // collects first, then calls: whether an edge is silhouette is unpredictable for the processor
            let (mut found, mut count) = ([0_u8; AT_ONCE], 0);
            for (at, edge) in edges.iter().enumerate() {
                found[count] = at as u8;
                count += usize::from(change(edge) != 0);
            }
            for at in &found[..count] {
                let edge = &edges[usize::from(*at)];
                let [from, to] = edge.ends.map(|end| {
                    let point = self.points[end as usize];
                    point.xy() - self.throw * point.z
                });
                tell(FallingEdge { from, to, change: change(edge) });
            }
        }
    }
}

/// Clumps within this share of the greatest distance are near. Under a low sun in a city they leave no light, and there
/// may be ten times as many beyond them.
const NEAR: f64 = 1.0 / 8.0;

/// The least number of clumps for one task.
const AT_ONCE: usize = 1 << 8;

/// The clump of each group. What belongs to no group gets the index after the last.
fn clumps_of_groups(clumps: &Clumps, groups: usize) -> Vec<u32> {
    let mut clump_of = vec![clumps.list().len() as u32; groups + 1];
    for (number, clump) in (0..).zip(clumps.list()) {
        clump_of[clump.groups.start as usize..clump.groups.end as usize].fill(number);
    }
    clump_of
}

/// The number of the mesh's edges for one task.
const RUN: usize = 1 << 13;

/// The part of some edges that is above the plane.
#[derive(Default)]
struct EdgesAbove {
    edges: ClumpEdges,
    /// Where they cross the plane; these points follow the mesh's vertices.
    cuts: Vec<DVec3>,
    /// Faces that cross the plane, whether upwards, and at which point.
    meets: Vec<(u32, bool, u32)>,
}

impl EdgesAbove {
    fn cut(
        mesh: &Mesh,
        points: &[DVec3],
        run: Range<usize>,
        group_of: impl Fn(u32) -> u32,
        no_side: FaceSide,
        clump_of: &[u32],
    ) -> EdgesAbove {
        let mut above = EdgesAbove { edges: ClumpEdges::with_capacity(run.len()), ..EdgesAbove::default() };
        let clump = |sides: [FaceSide; 2]| {
            let [one, other] = sides.map(|side| clump_of[side.group()]);
            // a side without a face is in no clump
            if one == other || sides[1] == no_side { one } else { clump_of[no_side.group()] }
        };
        for at in run {
            let mut ends = mesh.edges[at];
            let [first, last] = ends.map(|end| points[end as usize].z > 0.0);
            if !first && !last {
                continue;
            }
            let faces = mesh.faces_at(at);
            let side = |face: Incidence| FaceSide::new(group_of(face.face()), face.direction() < 0);
            if first != last {
                // a point in the plane is its own shadow
                let cut = (points.len() + above.cuts.len()) as u32;
                above.cuts.push(where_cut(ends.map(|end| points[end as usize])));
                ends[usize::from(first)] = cut;
                // a face that runs along the edge goes up if the edge's second end is above
                above.meets.extend(faces.iter().map(|face| (face.face(), (face.direction() > 0) == last, cut)));
            }
            if let [one, other] = faces
                && side(*one).is_other_side_of(side(*other))
            {
                continue;
            }
            for pair in faces.chunks(2) {
                let sides = [side(pair[0]), pair.get(1).map_or(no_side, |face| side(*face))];
                above.edges.push(Edge { ends, sides }, clump(sides));
            }
        }
        above
    }
}

/// Where an edge from above the plane to below crosses it. The result does not depend on the order of the ends.
pub(in crate::shadow) fn where_cut([one, other]: [DVec3; 2]) -> DVec3 {
    let (low, high) = if one.z < other.z { (one, other) } else { (other, one) };
    low.lerp(high, -low.z / (high.z - low.z)).xy().extend(0.0)
}

/// The group of every face, and the normal of every group. A group is faces that meet at edges and are coplanar, such
/// as a whole wall.
fn groups(mesh: &Mesh) -> (Vec<u32>, Vec<DVec3>) {
    let of_blocks: Vec<BlockGroups> = mesh.blocks().par_iter().map(|block| BlockGroups::of(mesh, block)).collect();
    let mut group_of = Vec::with_capacity(mesh.faces.len());
    let mut normals = Vec::with_capacity(of_blocks.iter().map(|block| block.normals.len()).sum());
    for block in of_blocks {
        let before = normals.len() as u32;
        group_of.extend(block.group_of.iter().map(|group| before + group));
        normals.extend(block.normals);
    }
    (group_of, normals)
}

/// The groups of a block's faces, counted from 0.
struct BlockGroups {
    group_of: Vec<u32>,
    normals: Vec<DVec3>,
}

impl BlockGroups {
    fn of(mesh: &Mesh, block: &MeshBlock) -> BlockGroups {
        let before = block.faces.start;
        // corners are f32, so this is nearly exact
        let normal = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|vertex| mesh.vertices[vertex as usize].as_dvec3());
            (b - a).cross(c - a)
        };
        let faces = mesh.faces[before as usize..block.faces.end as usize].par_iter().with_min_len(RUN);
        let of_faces: Vec<DVec3> = faces.map(normal).collect();
        let lie_in_one_plane = |edge: u32| {
            let [one, other] = mesh.faces_at(edge as usize) else { return false };
            let [a, b] = [one, other].map(|face| of_faces[(face.face() - before) as usize]);
            one.direction() != other.direction()
                && a.dot(b) > 0.0
                && a.cross(b).length_squared() <= SAME_PLANE * SAME_PLANE * a.length_squared() * b.length_squared()
        };
        let edges = block.edges.clone().into_par_iter().with_min_len(RUN);
        let flat: Vec<bool> = edges.map(lie_in_one_plane).collect();
        let mut above: Vec<u32> = (0..of_faces.len() as u32).collect();
        for (edge, _) in block.edges.clone().zip(&flat).filter(|(_, is_flat)| **is_flat) {
            let face = |at: usize| mesh.faces_at(edge as usize)[at].face() - before;
            let [one, other] = [0, 1].map(|at| lowest(&mut above, face(at)));
            above[one.max(other) as usize] = one.min(other);
        }
        Self::numbered(&of_faces, above)
    }

    /// Numbers the groups in the order of their first faces, to which `above` leads. The largest face's normal
    /// represents the group.
    fn numbered(of_faces: &[DVec3], mut above: Vec<u32>) -> BlockGroups {
        let mut normals: Vec<DVec3> = Vec::new();
        let mut group_of = vec![0; above.len()];
        for face in 0..above.len() {
            let first = lowest(&mut above, face as u32) as usize;
            if first == face {
                group_of[face] = normals.len() as u32;
                normals.push(of_faces[face]);
            } else {
                let group = group_of[first];
                group_of[face] = group;
                let normal = &mut normals[group as usize];
                if of_faces[face].length_squared() > normal.length_squared() {
                    *normal = of_faces[face];
                }
            }
        }
        BlockGroups { group_of, normals }
    }
}
