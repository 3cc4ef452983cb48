//! The hextree's successor: classes of edges that share their answer, in a bounding volume hierarchy.
//!
//! As in [`super::hextree`], an edge between two faces is a segment of the dual space, and part of the silhouette when
//! the light's hyperplane separates the ends. Three things are different.
//!
//! - An edge between two faces in one plane is left out: its ends are the same point.
//! - Edges whose segments are equal are one **class**, which is tested once and answers with a run of edges. For the
//!   sun, w = 0, only normals matter, and buildings repeat theirs thousands of times. For a lamp the whole planes
//!   matter.
//! - Each node is bounded by a box around its own segments, whichever way they lie, so that none is stuck near the root
//!   because it crosses a border there. Classes are split at the median of the widest extent of both ends.
//!
//! Suns and lamps have a hierarchy each, built when it is first needed.

use super::finder::{DirectedEdge, QueryCost, SilhouetteFinder, append};
use super::hextree::DualFrame;
use crate::mesh::{Mesh, plane_faces};
use glam::{DVec4, Vec4};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::hint::black_box;
use std::ops::Range;

/// The finder: one hierarchy for suns and one for lamps.
#[derive(Debug, Default)]
pub struct Hierarchy {
    suns: Option<Classes>,
    lamps: Option<Classes>,
}

impl Hierarchy {
    /// The classes for a light, built on first use.
    pub fn classes(&mut self, mesh: &Mesh, local_light: DVec4) -> &Classes {
        let of_suns = local_light.w == 0.0;
        let classes = if of_suns { &mut self.suns } else { &mut self.lamps };
        classes.get_or_insert_with(|| Classes::new(mesh, of_suns))
    }
}

impl SilhouetteFinder for Hierarchy {
    fn find(&mut self, mesh: &Mesh, local_light: DVec4, silhouette: &mut Vec<DirectedEdge>) -> QueryCost {
        let classes = self.classes(mesh, local_light);
        let mut runs = Vec::new();
        let looked = classes.ask(local_light, &mut runs);
        silhouette.reserve(runs.iter().map(|run| run.edges.len() * run.multiplicity.unsigned_abs() as usize).sum());
        for ClassEdges { edges, multiplicity } in runs {
            let edges = classes.edges[edges.start as usize..edges.end as usize].iter();
            match multiplicity {
                2 => silhouette.extend(edges.flat_map(|&edge| [edge; 2])),
                -2 => silhouette.extend(edges.flat_map(|&[first, second]| [[second, first]; 2])),
                _ => edges.for_each(|&edge| append(silhouette, edge, multiplicity)),
            }
        }
        looked
    }
}

/// The edges of one mesh, grouped by the planes that decide whether they are silhouette.
#[derive(Debug)]
pub struct Classes {
    frame: DualFrame,
    /// Distinct planes; for suns, distinct normals, with w = 0.
    planes: Vec<DVec4>,
    /// The root first.
    nodes: Vec<HierarchyNode>,
    /// In the order of the leaves.
    pairs: Vec<PlanePair>,
    /// The dual of each pair.
    segments: Vec<[Vec4; 2]>,
    /// Classes that are not a segment; every query tests them.
    sums: Vec<PlaneSum>,
    /// Grouped by class.
    edges: Vec<DirectedEdge>,
}

/// The answer of a class: its edges, and their multiplicity in the silhouette.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassEdges {
    /// A range of the edges of [`Classes`], grouped by class.
    pub edges: Range<u32>,
    /// As [`super::multiplicity`].
    pub multiplicity: i32,
}

/// Edges between two planes. Each plane's sum of directions is `times`; with `turned`, the second's is the opposite.
#[derive(Clone, Copy, Debug)]
struct PlanePair {
    planes: [u32; 2],
    times: i32,
    turned: bool,
    first_edge: u32,
    edges: u32,
}

/// Edges with any number of faces: the sum of directions in each plane.
#[derive(Debug)]
struct PlaneSum {
    terms: Vec<(u32, i32)>,
    edges: Range<u32>,
}

/// Eight children: a box around the segments of each, and a sphere with the same centre. The values are stored side by
/// side for SIMD.
#[derive(Clone, Copy, Debug)]
struct HierarchyNode {
    centre: [[f32; WIDTH]; 4],
    half: [[f32; WIDTH]; 4],
    /// Negative for an absent child, so that it is never hit.
    radius: [f32; WIDTH],
    /// For a leaf its first class, otherwise a node.
    at: [u32; WIDTH],
    /// For a leaf the number of its classes, otherwise 0.
    classes: [u32; WIDTH],
}

/// The children per node.
const WIDTH: usize = 8;
/// The most classes in a leaf. With 3 to 10, queries on the dome test about as much.
const LEAF: usize = 8;
/// The least distance from 0 at which the sign of an `f32` product is trusted, for points and lights of length 1;
/// closer to 0 the planes themselves decide.
const MARGIN: f32 = 2e-6;

impl Classes {
    fn new(mesh: &Mesh, of_suns: bool) -> Classes {
        let (planes, plane_of) = distinct_planes(mesh, of_suns);
        let mut of_pairs: Vec<([u32; 2], i32, bool, DirectedEdge)> = Vec::new();
        let mut of_sums: Vec<(Vec<(u32, i32)>, DirectedEdge)> = Vec::new();
        for (at, &edge) in mesh.edges.iter().enumerate() {
            let mut terms: Vec<(u32, i32)> = Vec::new();
            for incidence in mesh.faces_at(at) {
                let plane = plane_of[incidence.face() as usize];
                match terms.iter_mut().find(|term| term.0 == plane) {
                    Some(term) => term.1 += incidence.direction(),
                    None => terms.push((plane, incidence.direction())),
                }
            }
            terms.retain(|term| term.1 != 0);
            terms.sort_unstable();
            // one direction for all edges of a class
            let against = terms.first().is_some_and(|term| term.1 < 0);
            let edge = if against { [edge[1], edge[0]] } else { edge };
            terms.iter_mut().for_each(|term| term.1 = if against { -term.1 } else { term.1 });
            match *terms {
                [] => (),
                [one, other] if one.1 == other.1.abs() => {
                    of_pairs.push(([one.0, other.0], one.1, other.1 < 0, edge));
                }
                _ => of_sums.push((terms, edge)),
            }
        }
        of_pairs.par_sort_unstable();
        of_sums.par_sort_unstable();

        let frame = if of_suns { DualFrame::OF_SUNS } else { DualFrame::around(mesh) };
        let mut edges = Vec::with_capacity(of_pairs.len() + of_sums.len());
        let mut pairs = Vec::new();
        for group in of_pairs.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
            let (planes, times, turned, _) = group[0];
            pairs.push(PlanePair { planes, times, turned, first_edge: edges.len() as u32, edges: group.len() as u32 });
            edges.extend(group.iter().map(|class| class.3));
        }
        let mut sums = Vec::new();
        for group in of_sums.chunk_by(|a, b| a.0 == b.0) {
            let first = edges.len() as u32;
            edges.extend(group.iter().map(|class| class.1));
            sums.push(PlaneSum { terms: group[0].0.clone(), edges: first..edges.len() as u32 });
        }
        let mut classes = Classes { frame, planes, nodes: Vec::new(), pairs, segments: Vec::new(), sums, edges };
        classes.bound();
        classes
    }

    /// Builds the hierarchy over the pairs, and sorts them in the order of its leaves.
    fn bound(&mut self) {
        let duals: Vec<DVec4> = self.planes.iter().map(|&plane| self.frame.dual(plane)).collect();
        let dual = |pair: &PlanePair| {
            let [one, other] = pair.planes.map(|plane| duals[plane as usize].as_vec4());
            Segment { ends: [one, if pair.turned { other } else { -other }], pair: *pair }
        };
        let mut segments: Vec<Segment> = self.pairs.iter().map(dual).collect();
        if !segments.is_empty() {
            bound(&mut segments, 0, &mut self.nodes);
        }
        self.pairs = segments.iter().map(|segment| segment.pair).collect();
        self.segments = segments.iter().map(|segment| segment.ends).collect();
    }

    /// Finds the classes that are part of the silhouette for a light relative to the mesh's origin.
    pub fn ask(&self, local_light: DVec4, runs: &mut Vec<ClassEdges>) -> QueryCost {
        let before = runs.len();
        for sum in &self.sums {
            let facing = |plane| self.facing(plane, local_light);
            let multiplicity = sum.terms.iter().map(|&(plane, times)| times * facing(plane)).sum();
            if multiplicity != 0 {
                runs.push(ClassEdges { edges: sum.edges.clone(), multiplicity });
            }
        }
        let light = self.frame.light(local_light).as_vec4();
        let (leaves, visited) = self.leaves(light);
        let mut looked = QueryCost { at: self.sums.len() + visited, found: 0 };
        let mut crossed = Vec::new();
        for leaf in leaves {
            looked.at += leaf.len();
            for pair in leaf {
                let [one, other] = self.segments[pair].map(|end| light.dot(end));
                let certain = one.abs().min(other.abs()) > MARGIN;
                if !certain || (one > 0.0) != (other > 0.0) {
                    crossed.push((pair, certain, one > 0.0));
                }
            }
        }
        for (pair, certain, before_first) in crossed {
            let PlanePair { planes, times, turned, first_edge, edges } = self.pairs[pair];
            let multiplicity = if certain {
                // the ends are on different sides, so both planes' sums have the first one's sign
                if before_first { 2 * times } else { -2 * times }
            } else {
                let [one, other] = planes.map(|plane| self.facing(plane, local_light));
                times * (one + if turned { -other } else { other })
            };
            if multiplicity != 0 {
                runs.push(ClassEdges { edges: first_edge..first_edge + edges, multiplicity });
            }
        }
        looked.found = runs.len() - before;
        looked
    }

    /// The pairs in the boxes that a light's hyperplane crosses, and the number of tested boxes.
    ///
    /// It proceeds level by level and touches a level's memory before testing it, so that loads overlap. Between two
    /// queries the caches have been used for much else, and waiting for each node in turn would take most of the time.
    fn leaves(&self, light: Vec4) -> (Vec<Range<usize>>, usize) {
        let (mut leaves, mut visited) = (Vec::new(), 0);
        let mut level = Vec::from_iter((!self.nodes.is_empty()).then_some(0));
        while !level.is_empty() {
            black_box(level.iter().map(|&at| self.nodes[at as usize].touched()).sum::<f32>());
            let mut below = Vec::new();
            for at in level {
                let node: &HierarchyNode = &self.nodes[at as usize];
                for (child, distance) in node.distances(light).into_iter().enumerate() {
                    visited += usize::from(node.radius[child] >= 0.0);
                    if distance > MARGIN {
                        continue;
                    }
                    let (at, classes) = (node.at[child], node.classes[child]);
                    if classes == 0 {
                        below.push(at);
                    } else {
                        leaves.push(at as usize..(at + classes) as usize);
                    }
                }
            }
            level = below;
        }
        // a cache line of 64 bytes holds two segments
        let touched =
            |leaf: &Range<usize>| self.segments[leaf.clone()].iter().step_by(2).map(|ends| ends[0].x).sum::<f32>();
        black_box(leaves.iter().map(touched).sum::<f32>());
        (leaves, visited)
    }

    /// +1 if the light is on the front side of a plane or in it, otherwise −1.
    fn facing(&self, plane: u32, local_light: DVec4) -> i32 {
        if plane_faces(self.planes[plane as usize], local_light) { 1 } else { -1 }
    }

    /// The number of classes.
    #[cfg(feature = "test-hooks")]
    pub fn count(&self) -> usize {
        self.pairs.len() + self.sums.len()
    }

    /// The size of hierarchy, classes and edges in memory, bytes.
    #[cfg(feature = "test-hooks")]
    pub fn bytes(&self) -> usize {
        let terms: usize = self.sums.iter().map(|sum| sum.terms.len()).sum();
        self.planes.len() * size_of::<DVec4>()
            + self.nodes.len() * size_of::<HierarchyNode>()
            + self.pairs.len() * (size_of::<PlanePair>() + size_of::<[Vec4; 2]>())
            + self.sums.len() * size_of::<PlaneSum>()
            + terms * size_of::<(u32, i32)>()
            + self.edges.len() * size_of::<DirectedEdge>()
    }
}

/// A class during construction.
#[derive(Clone, Copy)]
struct Segment {
    ends: [Vec4; 2],
    pair: PlanePair,
}

impl HierarchyNode {
    /// Reads one value of every 64 bytes.
    fn touched(&self) -> f32 {
        self.centre[0][0] + self.centre[2][0] + self.half[0][0] + self.half[2][0] + self.radius[0]
    }

    /// For each child, the distance by which a light's hyperplane misses its box or its sphere; at most 0 if it crosses
    /// both.
    fn distances(&self, light: Vec4) -> [f32; WIDTH] {
        let (light, light_abs) = (light.to_array(), light.abs().to_array());
        std::array::from_fn(|child| {
            let (mut along, mut half) = (0.0, 0.0);
            for axis in 0..4 {
                along += light[axis] * self.centre[axis][child];
                half += light_abs[axis] * self.half[axis][child];
            }
            along.abs() - f32::min(half, self.radius[child])
        })
    }
}

/// Appends the node over some segments and those below it, and sorts the segments in the order of the leaves.
fn bound(segments: &mut [Segment], first: u32, nodes: &mut Vec<HierarchyNode>) {
    let nothing = [0.0; WIDTH];
    let index = nodes.len();
    nodes.push(HierarchyNode {
        centre: [nothing; 4],
        half: [nothing; 4],
        radius: [f32::NEG_INFINITY; WIDTH],
        at: [0; WIDTH],
        classes: [0; WIDTH],
    });
    let mut at = first;
    for (child, part) in parts(segments, WIDTH).into_iter().enumerate() {
        let ends = || part.iter().flat_map(|segment| segment.ends);
        let (low, high) = extent(ends());
        let centre = (low + high) / 2.0;
        let node = &mut nodes[index];
        for axis in 0..4 {
            node.centre[axis][child] = centre[axis];
            node.half[axis][child] = (high[axis] - low[axis]) / 2.0;
        }
        node.radius[child] = ends().map(|end| end.distance(centre)).fold(0.0, f32::max);
        let count = part.len() as u32;
        if part.len() <= LEAF {
            (node.at[child], node.classes[child]) = (at, count);
        } else {
            nodes[index].at[child] = nodes.len() as u32;
            bound(part, at, nodes);
        }
        at += count;
    }
}

/// Repeatedly halves segments at the median of the widest extent of either end, into at most `most` parts.
fn parts(segments: &mut [Segment], most: usize) -> Vec<&mut [Segment]> {
    if most < 2 || segments.len() <= LEAF {
        return vec![segments];
    }
    let extents = [0, 1].map(|end| extent(segments.iter().map(|segment| segment.ends[end])));
    let spread = |(end, axis): (usize, usize)| (extents[end].1 - extents[end].0)[axis];
    let ways = (0..2).flat_map(|end| (0..4).map(move |axis| (end, axis)));
    let (end, axis) = ways.max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or((0, 0));
    let middle = segments.len() / 2;
    segments.select_nth_unstable_by(middle, |a, b| a.ends[end][axis].total_cmp(&b.ends[end][axis]));
    let (lower, upper) = segments.split_at_mut(middle);
    let mut halves = parts(lower, most / 2);
    halves.extend(parts(upper, most / 2));
    halves
}

/// The corners of a box around points.
fn extent(points: impl Iterator<Item = Vec4>) -> (Vec4, Vec4) {
    points.fold((Vec4::INFINITY, Vec4::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
}

/// The distinct planes, for suns only their normals, and for each face the index of its plane.
fn distinct_planes(mesh: &Mesh, of_suns: bool) -> (Vec<DVec4>, Vec<u32>) {
    let mut planes = Vec::new();
    let mut known: FxHashMap<[u64; 4], u32> = FxHashMap::default();
    let mut number = |plane: &DVec4| {
        let plane = if of_suns { plane.truncate().extend(0.0) } else { *plane };
        *known.entry(plane.to_array().map(f64::to_bits)).or_insert_with(|| {
            planes.push(plane);
            planes.len() as u32 - 1
        })
    };
    let plane_of = mesh.planes().iter().map(&mut number).collect();
    (planes, plane_of)
}
