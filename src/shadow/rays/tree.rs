//! The tree: nodes of eight boxes above blocks of eight triangles.
//!
//! Built from the top by the binned surface area heuristic (Wald, *On fast Construction of SAH-based Bounding Volume
//! Hierarchies*, 2007), eight parts at once: as long as there is room in a node, its largest part is divided. The crate
//! obvhs takes three times as long to build a tree of quantised boxes, returns triangles only one by one, and orders
//! equal hits differently.

use crate::mesh::Mesh;
use arrayvec::ArrayVec;
use glam::{Vec3, Vec3A};
use rayon::prelude::*;
use std::ops::Range;

/// The number of boxes in a node, and of triangles in a block.
pub(super) const EIGHT: usize = 8;
/// From this depth on parts are halved by count, which limits the depth to [`MOST_DEPTH`].
const DIVIDED_BY_AREA: usize = 16;
/// With eight parts at a time, 2³² triangles take eleven more levels.
pub(super) const MOST_DEPTH: usize = DIVIDED_BY_AREA + 12;
/// Parts with at least this many triangles are built in parallel.
const SIDE_BY_SIDE: usize = 1 << 14;
const BINS: usize = 16;

/// Eight boxes with their contents.
#[repr(C, align(32))]
pub(super) struct WideNode {
    /// The lowest x, y, z of each box, then the highest. An absent box ends before it begins.
    pub(super) planes: [[f32; EIGHT]; 6],
    pub(super) children: [u32; EIGHT],
}

/// Up to eight triangles side by side.
#[repr(C, align(32))]
pub(super) struct TriangleBlock {
    /// By corner, axis and triangle.
    pub(super) corners: [[[f32; EIGHT]; 3]; 3],
    pub(super) faces: [u32; EIGHT],
    /// A bit for each triangle that is present.
    pub(super) there: u32,
}

impl TriangleBlock {
    /// A triangle's corners.
    #[inline(always)]
    pub(super) fn triangle(&self, at: usize) -> [Vec3; 3] {
        let corner = |corner: usize| {
            let [x, y, z] = &self.corners[corner];
            Vec3::new(x[at], y[at], z[at])
        };
        [corner(0), corner(1), corner(2)]
    }
}

/// Marks a child as a block instead of a node.
pub(super) const BLOCK: u32 = 1 << 31;

/// Nodes, the root first, and blocks.
pub(super) struct WideTree {
    pub(super) nodes: Vec<WideNode>,
    pub(super) blocks: Vec<TriangleBlock>,
}

#[derive(Clone, Copy)]
struct FaceBox {
    low: Vec3A,
    high: Vec3A,
    face: u32,
}

#[derive(Clone, Copy)]
struct BoxExtent {
    low: Vec3A,
    high: Vec3A,
}

impl BoxExtent {
    const NOTHING: BoxExtent = BoxExtent { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    fn with(self, low: Vec3A, high: Vec3A) -> BoxExtent {
        BoxExtent { low: self.low.min(low), high: self.high.max(high) }
    }

    fn of(boxed: &[FaceBox]) -> BoxExtent {
        boxed.iter().fold(BoxExtent::NOTHING, |extent, one| extent.with(one.low, one.high))
    }

    /// Half of its surface area, square metres; 0 if it is empty.
    fn area(&self) -> f32 {
        let size = (self.high - self.low).max(Vec3A::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

impl WideTree {
    /// Builds the tree. Boxes are larger than their faces by `padding` metres on each side.
    pub(super) fn new(mesh: &Mesh, padding: f32) -> WideTree {
        let boxed = |face: usize| {
            let [a, b, c] = mesh.corners(face).map(Vec3A::from);
            FaceBox { low: a.min(b).min(c), high: a.max(b).max(c), face: face as u32 }
        };
        let mut faces: Vec<FaceBox> = (0..mesh.faces.len()).into_par_iter().map(boxed).collect();
        let mut grown = GrowingTree { padding, ..GrowingTree::default() };
        if !faces.is_empty() {
            grown.node(&mut faces, 0, 0);
        }
        let blocks = grown.blocks.into_par_iter().map(|of| block(mesh, &faces[of])).collect();
        WideTree { nodes: grown.nodes, blocks }
    }
}

fn block(mesh: &Mesh, faces: &[FaceBox]) -> TriangleBlock {
    let there = (1 << faces.len()) - 1;
    let mut block = TriangleBlock { corners: [[[0.0; EIGHT]; 3]; 3], faces: [u32::MAX; EIGHT], there };
    for (at, boxed) in faces.iter().enumerate() {
        block.faces[at] = boxed.face;
        for (corner, position) in mesh.corners(boxed.face as usize).into_iter().enumerate() {
            for axis in 0..3 {
                block.corners[corner][axis][at] = position[axis];
            }
        }
    }
    block
}

/// A tree during construction, with the ranges of sorted faces in its blocks.
#[derive(Default)]
struct GrowingTree {
    padding: f32,
    nodes: Vec<WideNode>,
    blocks: Vec<Range<usize>>,
}

impl GrowingTree {
    /// Adds a node for some faces, from index `first` on, with everything below it. Returns its index.
    fn node(&mut self, faces: &mut [FaceBox], first: usize, depth: usize) -> u32 {
        let at = self.nodes.len();
        let mut node = WideNode { planes: [[f32::INFINITY; EIGHT]; 6], children: [0; EIGHT] };
        node.planes[3..].fill([f32::NEG_INFINITY; EIGHT]);
        let side_by_side = faces.len() >= SIDE_BY_SIDE;
        let parts = divided(faces, first, depth);
        for (slot, FacePart { extent, .. }) in parts.iter().enumerate() {
            for axis in 0..3 {
                node.planes[axis][slot] = extent.low[axis] - self.padding;
                node.planes[3 + axis][slot] = extent.high[axis] + self.padding;
            }
        }
        self.nodes.push(node);
        let children: ArrayVec<u32, EIGHT> = if side_by_side {
            let padding = self.padding;
            let grow = |part: FacePart<'_>| {
                let mut grown = GrowingTree { padding, ..GrowingTree::default() };
                let root = grown.child(part, depth + 1);
                (grown, root)
            };
            let grown: Vec<(GrowingTree, u32)> =
                parts.into_iter().collect::<Vec<_>>().into_par_iter().map(grow).collect();
            grown.into_iter().map(|(grown, root)| self.append(grown, root)).collect()
        } else {
            parts.into_iter().map(|part| self.child(part, depth + 1)).collect()
        };
        self.nodes[at].children[..children.len()].copy_from_slice(&children);
        at as u32
    }

    /// Adds a part, as a block if it fits in one.
    fn child(&mut self, FacePart { faces, first, .. }: FacePart<'_>, depth: usize) -> u32 {
        if faces.len() > EIGHT {
            return self.node(faces, first, depth);
        }
        self.blocks.push(first..first + faces.len());
        (self.blocks.len() - 1) as u32 | BLOCK
    }

    /// Appends a tree that was built in parallel. Returns the new index of its root.
    fn append(&mut self, mut other: GrowingTree, root: u32) -> u32 {
        let (nodes, blocks) = (self.nodes.len() as u32, self.blocks.len() as u32);
        let moved = |child: u32| child + if child & BLOCK != 0 { blocks } else { nodes };
        for node in &mut other.nodes {
            node.children = node.children.map(moved);
        }
        self.nodes.append(&mut other.nodes);
        self.blocks.append(&mut other.blocks);
        moved(root)
    }
}

/// A part of the faces: its faces, the index of the first, and its box.
struct FacePart<'a> {
    extent: BoxExtent,
    first: usize,
    faces: &'a mut [FaceBox],
}

impl FacePart<'_> {
    fn of(faces: &mut [FaceBox], first: usize) -> FacePart<'_> {
        FacePart { extent: BoxExtent::of(faces), first, faces }
    }

    /// The benefit of dividing it; 0 if it fits half a block, which is not worth another box.
    fn weight(&self) -> f32 {
        if self.faces.len() > EIGHT / 2 { self.extent.area() } else { -1.0 }
    }
}

/// Up to eight parts of some faces.
fn divided(faces: &mut [FaceBox], first: usize, depth: usize) -> ArrayVec<FacePart<'_>, EIGHT> {
    let mut parts = ArrayVec::new();
    parts.push(FacePart::of(faces, first));
    while parts.len() < EIGHT {
        let largest = (0..parts.len()).max_by(|&one, &other| parts[one].weight().total_cmp(&parts[other].weight()));
        let Some(largest) = largest.filter(|&at| parts[at].weight() >= 0.0) else { break };
        let FacePart { faces, first, .. } = parts.swap_remove(largest);
        let middle = if depth < DIVIDED_BY_AREA { by_area(faces) } else { None };
        let middle = middle.unwrap_or(faces.len() / 2);
        let (one, other) = faces.split_at_mut(middle);
        parts.push(FacePart::of(one, first));
        parts.push(FacePart::of(other, first + middle));
    }
    parts
}

/// Sorts faces for the cheapest division. Returns its index; `None` if all are at one place.
fn by_area(faces: &mut [FaceBox]) -> Option<usize> {
    let centre = |boxed: &FaceBox| boxed.low + boxed.high;
    let centres = faces.iter().fold(BoxExtent::NOTHING, |extent, boxed| extent.with(centre(boxed), centre(boxed)));
    let size = centres.high - centres.low;
    // only the longest axis: the two others take three times as long without a noticeable gain
    let axis = size.max_position();
    let per_metre = BINS as f32 * 0.999 / size[axis];
    let bin = |boxed: &FaceBox| (((centre(boxed)[axis] - centres.low[axis]) * per_metre) as usize).min(BINS - 1);
    let mut bins = [(BoxExtent::NOTHING, 0u32); BINS];
    for boxed in faces.iter() {
        let (extent, count) = &mut bins[bin(boxed)];
        *extent = extent.with(boxed.low, boxed.high);
        *count += 1;
    }
    let first = cheapest(&bins)?;
    Some(partition(faces, |boxed| bin(boxed) < first))
}

/// The bin at which the upper part begins; `None` if all are in one.
fn cheapest(bins: &[(BoxExtent, u32); BINS]) -> Option<usize> {
    let mut above = [(0.0, 0); BINS];
    let mut so_far = (BoxExtent::NOTHING, 0);
    for at in (1..BINS).rev() {
        so_far = (so_far.0.with(bins[at].0.low, bins[at].0.high), so_far.1 + bins[at].1);
        above[at] = (so_far.0.area(), so_far.1);
    }
    let mut so_far = (BoxExtent::NOTHING, 0);
    let mut best: Option<(usize, f32)> = None;
    for at in 1..BINS {
        let (extent, count) = bins[at - 1];
        so_far = (so_far.0.with(extent.low, extent.high), so_far.1 + count);
        let (area, rest) = above[at];
        let cost = so_far.0.area() * so_far.1 as f32 + area * rest as f32;
        if so_far.1 > 0 && rest > 0 && best.is_none_or(|(_, least)| cost < least) {
            best = Some((at, cost));
        }
    }
    best.map(|(at, _)| at)
}

/// Moves the selected ones to the front, and returns their number.
fn partition(faces: &mut [FaceBox], first: impl Fn(&FaceBox) -> bool) -> usize {
    let (mut from, mut to) = (0, faces.len());
    loop {
        while from < to && first(&faces[from]) {
            from += 1;
        }
        while from < to && !first(&faces[to - 1]) {
            to -= 1;
        }
        if from >= to {
            return from;
        }
        faces.swap(from, to - 1);
    }
}
