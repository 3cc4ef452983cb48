//! Traversal of the tree, and searches for single rays.

use super::frame::{BeamFrame, around, reference};
use super::lanes::{LaneWork, Lanes, Simd};
use super::prune::{Fates, FlatTriangles};
use super::shear::Shear;
use super::tree::{BLOCK, EIGHT, MOST_DEPTH, TriangleBlock, WideNode, WideTree};
use arrayvec::ArrayVec;
use glam::{DVec3, Vec3};

/// The most nodes and blocks on the stack of a search for the nearest: seven of each level, and the last level's eight.
const MOST_WAITING: usize = MOST_DEPTH * 7 + 8;

/// The visitor of the blocks that rays reach.
pub(super) trait BlockVisitor {
    /// Called for each node whose boxes are tested; for counts.
    #[inline(always)]
    fn enter(&mut self) {}
    /// Visits a block. Returns `false` to stop.
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool;
}

/// The visitor of blocks from near to far.
pub(super) trait NearestVisitor: BlockVisitor {
    /// The greatest distance that matters, metres from the frame's plane.
    fn farthest(&self) -> f32;
}

/// A block, and which of its triangles are tested.
#[derive(Clone, Copy)]
pub(super) struct AskedBlock {
    pub(super) at: u32,
    /// A bit for each.
    pub(super) triangles: u32,
}

#[inline(always)]
fn visit<S: Simd, V: BlockVisitor>(tree: &WideTree, frame: &BeamFrame<'_>, child: u32, visitor: &mut V) -> bool {
    let at = child & !BLOCK;
    let block = &tree.blocks[at as usize];
    visitor.visit::<S>(frame, AskedBlock { at, triangles: block.there }, block)
}

/// Visits the blocks that rays may meet, in any order. What waits is a node with the children that are left, as most
/// searches end before they come to them.
#[inline(always)]
pub(super) fn traverse<S: Simd, V: BlockVisitor>(tree: &WideTree, frame: &BeamFrame<'_>, visitor: &mut V) {
    let Some(mut node) = tree.nodes.first() else { return };
    let mut waiting = ArrayVec::<(&WideNode, u32), MOST_DEPTH>::new();
    visitor.enter();
    let mut met = frame.enter::<S::Eight>(node, f32::INFINITY).0;
    loop {
        if met == 0 {
            let Some(last) = waiting.pop() else { return };
            (node, met) = last;
        }
        let child = node.children[met.trailing_zeros() as usize];
        met &= met - 1;
        if child & BLOCK != 0 {
            if !visit::<S, V>(tree, frame, child, visitor) {
                return;
            }
            continue;
        }
        if met != 0 {
            waiting.push((node, met));
        }
        node = &tree.nodes[child as usize];
        visitor.enter();
        met = frame.enter::<S::Eight>(node, f32::INFINITY).0;
    }
}

/// Visits the blocks that rays may meet from near to far, up to the distance that matters.
#[inline(always)]
pub(super) fn traverse_nearest<S: Simd, V: NearestVisitor>(tree: &WideTree, frame: &BeamFrame<'_>, visitor: &mut V) {
    let mut waiting = ArrayVec::<(u32, f32), MOST_WAITING>::new();
    if !tree.nodes.is_empty() {
        // begins with the root
        waiting.push((0, f32::NEG_INFINITY));
    }
    while let Some((at, near)) = waiting.pop() {
        if near > visitor.farthest() {
            continue;
        }
        if at & BLOCK != 0 {
            if !visit::<S, V>(tree, frame, at, visitor) {
                return;
            }
            continue;
        }
        let node = &tree.nodes[at as usize];
        let (mut met, near) = frame.enter::<S::Eight>(node, visitor.farthest());
        let mut soonest = [0.0; EIGHT];
        near.store(&mut soonest);
        let first = waiting.len();
        while met != 0 {
            let slot = met.trailing_zeros() as usize;
            met &= met - 1;
            waiting.push((node.children[slot], soonest[slot]));
            let mut place = waiting.len() - 1;
            while place > first && waiting[place - 1].1 < waiting[place].1 {
                waiting.swap(place - 1, place);
                place -= 1;
            }
        }
    }
}

/// Finds whether a ray is blocked by those faces that are kept.
pub(super) struct BlockedRay<'a, K> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origin: DVec3,
    pub(super) keep: K,
}

impl<K: Fn(&[Vec3; 3]) -> bool> LaneWork for BlockedRay<'_, K> {
    type Output = bool;
    #[inline(always)]
    fn run<S: Simd>(self) -> bool {
        let (mut search, frame) = AnyHit::of(self.shear, self.origin, self.keep);
        traverse::<S, _>(self.tree, &frame, &mut search);
        search.hit
    }
}

pub(super) struct AnyHit<'a, K> {
    shear: &'a Shear,
    origin: DVec3,
    ray: [f32; 3],
    keep: K,
    hit: bool,
}

impl<'a, K> AnyHit<'a, K> {
    /// The search for a ray, and its frame.
    #[inline(always)]
    pub(super) fn of(shear: &'a Shear, origin: DVec3, keep: K) -> (AnyHit<'a, K>, BeamFrame<'a>) {
        let reference = reference(shear, origin);
        let ray = around(shear, &reference, origin);
        (AnyHit { shear, origin, ray, keep, hit: false }, BeamFrame::new(shear, reference, ray, ray))
    }
}

impl<K: Fn(&[Vec3; 3]) -> bool> BlockVisitor for AnyHit<'_, K> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool {
        let Fates { missed, hit } = FlatTriangles::<S::Eight>::of(frame, block).fates(splat(self.ray));
        let is_kept = |at| (self.keep)(&block.triangle(at));
        let is_hit = |at| self.shear.hit(self.origin, &block.triangle(at)).is_some() && is_kept(at);
        self.hit = bits(asked.triangles & hit).any(is_kept) || bits(asked.triangles & !missed & !hit).any(is_hit);
        !self.hit
    }
}

/// Finds the nearest face along a ray of those that are kept, with its distance in lengths of the direction; of equally
/// near ones the first.
pub(super) struct FirstHit<'a, K> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origin: DVec3,
    pub(super) keep: K,
}

impl<K: Fn(&[Vec3; 3]) -> bool> LaneWork for FirstHit<'_, K> {
    type Output = Option<(u32, f64)>;
    #[inline(always)]
    fn run<S: Simd>(self) -> Option<(u32, f64)> {
        let FirstHit { tree, shear, origin, keep } = self;
        let reference = reference(shear, origin);
        let ray = around(shear, &reference, origin);
        let frame = BeamFrame::new(shear, reference, ray, ray);
        let mut search =
            NearestHit { shear, origin, ray, keep, nearest: NearestFace::NOTHING, farthest: f32::INFINITY };
        traverse_nearest::<S, _>(tree, &frame, &mut search);
        search.nearest.hit()
    }
}

struct NearestHit<'a, K> {
    shear: &'a Shear,
    origin: DVec3,
    ray: [f32; 3],
    keep: K,
    nearest: NearestFace,
    farthest: f32,
}

/// The nearest face so far.
#[derive(Clone, Copy)]
pub(super) struct NearestFace {
    distance: f64,
    face: u32,
}

impl NearestFace {
    pub(super) const NOTHING: NearestFace = NearestFace { distance: f64::INFINITY, face: u32::MAX };

    /// Takes a hit that is nearer, or equally near with a lower face index.
    #[inline(always)]
    pub(super) fn take(&mut self, distance: f64, face: u32) -> bool {
        let nearer =
            distance < self.distance || (distance == self.distance && distance < f64::INFINITY && face < self.face);
        if nearer {
            *self = NearestFace { distance, face };
        }
        nearer
    }

    pub(super) fn hit(self) -> Option<(u32, f64)> {
        (self.distance < f64::INFINITY).then_some((self.face, self.distance))
    }

    /// The distance in metres from a frame's plane, rounded up.
    #[inline(always)]
    pub(super) fn farthest(self, shear: &Shear, ray_ahead: f32, sign: f32) -> f32 {
        // one more rounding is within the boxes' padding
        ((self.distance / shear.scale.z.abs() + f64::from(ray_ahead * sign)) as f32).next_up()
    }
}

impl<K: Fn(&[Vec3; 3]) -> bool> BlockVisitor for NearestHit<'_, K> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool {
        let missed = FlatTriangles::<S::Eight>::of(frame, block).fates(splat(self.ray)).missed;
        for at in bits(asked.triangles & !missed) {
            let triangle = block.triangle(at);
            if let Some(distance) = self.shear.hit(self.origin, &triangle)
                && (self.keep)(&triangle)
                && self.nearest.take(distance, block.faces[at])
            {
                self.farthest = self.nearest.farthest(self.shear, self.ray[2], frame.shear.sign);
            }
        }
        true
    }
}

impl<K: Fn(&[Vec3; 3]) -> bool> NearestVisitor for NearestHit<'_, K> {
    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.farthest
    }
}

#[inline(always)]
fn splat<L: Lanes>(ray: [f32; 3]) -> [L; 3] {
    [L::splat(ray[0]), L::splat(ray[1]), L::splat(ray[2])]
}

/// The indices of the bits that are set.
#[inline(always)]
pub(super) fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let at = (set != 0).then(|| set.trailing_zeros() as usize)?;
        set &= set - 1;
        Some(at)
    })
}
