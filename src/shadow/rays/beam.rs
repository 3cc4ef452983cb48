//! Rays through the tree, one alone or up to 64 parallel ones at once.

use super::frame::{BeamFrame, around, reference};
use super::lanes::{LaneWork, Lanes, Simd};
use super::prune::FlatTriangles;
use super::shear::Shear;
use super::tree::{BLOCK, EIGHT, MOST_DEPTH, TriangleBlock, WideTree};
use arrayvec::ArrayVec;
use glam::{DVec3, Vec3};

/// How many rays a beam has at most.
pub(super) const MOST_RAYS: usize = 64;

/// Nodes and blocks that wait: of each level all but the one that was gone into, and the last level's eight.
const MOST_WAITING: usize = MOST_DEPTH * 7 + 8;

/// No level has more lanes.
const MOST_LANES: usize = 16;

/// What is done with the blocks that rays come to.
trait BlockVisitor {
    /// Whether blocks are visited from near to far, as far as they matter.
    const NEAREST_FIRST: bool;
    /// Returns `false` when nothing more is asked.
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, block: &TriangleBlock) -> bool;
    /// Beyond this nothing matters, metres from the frame's plane.
    fn farthest(&self) -> f32;
}

#[inline(always)]
fn traverse<S: Simd, V: BlockVisitor>(tree: &WideTree, frame: &BeamFrame<'_>, visitor: &mut V) {
    let mut waiting = ArrayVec::<(u32, f32), MOST_WAITING>::new();
    if !tree.nodes.is_empty() {
        // the root stands first
        waiting.push((0, f32::NEG_INFINITY));
    }
    while let Some((at, near)) = waiting.pop() {
        if V::NEAREST_FIRST && near > visitor.farthest() {
            continue;
        }
        if at & BLOCK != 0 {
            if !visitor.visit::<S>(frame, &tree.blocks[(at & !BLOCK) as usize]) {
                return;
            }
            continue;
        }
        let node = &tree.nodes[at as usize];
        let (mut met, near) = frame.enter::<S::Eight>(node, visitor.farthest());
        let mut soonest = [0.0; EIGHT];
        if V::NEAREST_FIRST {
            near.store(&mut soonest);
        }
        let first = waiting.len();
        while met != 0 {
            let slot = met.trailing_zeros() as usize;
            met &= met - 1;
            waiting.push((node.children[slot], soonest[slot]));
            if V::NEAREST_FIRST {
                let mut place = waiting.len() - 1;
                while place > first && waiting[place - 1].1 < waiting[place].1 {
                    waiting.swap(place - 1, place);
                    place -= 1;
                }
            }
        }
    }
}

/// Whether anything lies along a ray.
pub(super) struct BlockedRay<'a> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origin: DVec3,
}

impl LaneWork for BlockedRay<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<S: Simd>(self) -> bool {
        let BlockedRay { tree, shear, origin } = self;
        let reference = reference(shear, origin);
        let ray = around(shear, &reference, origin);
        let frame = BeamFrame::new(shear, reference, ray, ray);
        let mut search = AnyHit { shear, origin, ray, hit: false };
        traverse::<S, _>(tree, &frame, &mut search);
        search.hit
    }
}

struct AnyHit<'a> {
    shear: &'a Shear,
    origin: DVec3,
    ray: [f32; 3],
    hit: bool,
}

impl BlockVisitor for AnyHit<'_> {
    const NEAREST_FIRST: bool = true;
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, block: &TriangleBlock) -> bool {
        let missed = FlatTriangles::<S::Eight>::of(frame, block).missed(splat(self.ray));
        self.hit = bits(block.there & !missed).any(|at| self.shear.hit(self.origin, &block.triangle(at)).is_some());
        !self.hit
    }
    #[inline(always)]
    fn farthest(&self) -> f32 {
        f32::INFINITY
    }
}

/// The nearest face along a ray, and how many lengths of the direction away; of several that are equally near the first.
pub(super) struct FirstHit<'a> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origin: DVec3,
}

impl LaneWork for FirstHit<'_> {
    type Output = Option<(u32, f64)>;
    #[inline(always)]
    fn run<S: Simd>(self) -> Option<(u32, f64)> {
        let FirstHit { tree, shear, origin } = self;
        let reference = reference(shear, origin);
        let ray = around(shear, &reference, origin);
        let frame = BeamFrame::new(shear, reference, ray, ray);
        let mut search = NearestHit { shear, origin, ray, nearest: Nearest::NOTHING, farthest: f32::INFINITY };
        traverse::<S, _>(tree, &frame, &mut search);
        search.nearest.hit()
    }
}

struct NearestHit<'a> {
    shear: &'a Shear,
    origin: DVec3,
    ray: [f32; 3],
    nearest: Nearest,
    farthest: f32,
}

/// The nearest face so far.
#[derive(Clone, Copy)]
struct Nearest {
    distance: f64,
    face: u32,
}

impl Nearest {
    const NOTHING: Nearest = Nearest { distance: f64::INFINITY, face: u32::MAX };

    /// Takes a hit that is nearer, or as near and of a face that comes before.
    #[inline(always)]
    fn take(&mut self, distance: f64, face: u32) -> bool {
        let nearer =
            distance < self.distance || (distance == self.distance && distance < f64::INFINITY && face < self.face);
        if nearer {
            *self = Nearest { distance, face };
        }
        nearer
    }

    fn hit(self) -> Option<(u32, f64)> {
        (self.distance < f64::INFINITY).then_some((self.face, self.distance))
    }

    /// In metres from a frame's plane, rounded up.
    #[inline(always)]
    fn farthest(self, shear: &Shear, ray_ahead: f32, sign: f32) -> f32 {
        // a rounding more than the box's own padding does not matter
        ((self.distance / shear.scale.z.abs() + f64::from(ray_ahead * sign)) as f32).next_up()
    }
}

impl BlockVisitor for NearestHit<'_> {
    const NEAREST_FIRST: bool = true;
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, block: &TriangleBlock) -> bool {
        let missed = FlatTriangles::<S::Eight>::of(frame, block).missed(splat(self.ray));
        for at in bits(block.there & !missed) {
            if let Some(distance) = self.shear.hit(self.origin, &block.triangle(at))
                && self.nearest.take(distance, block.faces[at])
            {
                self.farthest = self.nearest.farthest(self.shear, self.ray[2], frame.shear.sign);
            }
        }
        true
    }
    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.farthest
    }
}

#[inline(always)]
fn splat<L: Lanes>(ray: [f32; 3]) -> [L; 3] {
    [L::splat(ray[0]), L::splat(ray[1]), L::splat(ray[2])]
}

/// The bits that are set.
#[inline(always)]
fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let at = (set != 0).then(|| set.trailing_zeros() as usize)?;
        set &= set - 1;
        Some(at)
    })
}

/// Parallel rays in groups that lie close together.
pub(super) struct Beam<'a> {
    shear: &'a Shear,
    reference: [f32; 3],
    /// Their origins, by the rays' axes.
    places: [[f64; MOST_RAYS]; 3],
    /// Of each ray, in the groups' order: where it meets the plane and how far ahead it begins.
    rays: [[f32; MOST_RAYS]; 3],
    /// Which ray it is.
    number: [u8; MOST_RAYS],
}

/// What rays of a group lie between.
#[derive(Clone, Copy)]
struct Spread {
    low: [f32; 3],
    high: [f32; 3],
}

impl Spread {
    const NOTHING: Spread = Spread { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    #[inline(always)]
    fn with(&mut self, ray: [f32; 3]) {
        for at in 0..3 {
            self.low[at] = if ray[at] < self.low[at] { ray[at] } else { self.low[at] };
            self.high[at] = if ray[at] > self.high[at] { ray[at] } else { self.high[at] };
        }
    }

    /// Half of the outline in the plane.
    fn outline(&self) -> f32 {
        self.high[0] - self.low[0] + self.high[1] - self.low[1]
    }
}

/// Two groups are asked apart if their outlines are together so much shorter than the whole's.
const APART: f32 = 0.8;

/// The outline of a square of 8 by 8 rays is 14 steps from one to the next, and somewhat more where it is askew.
const MOST_STEPS: f32 = 24.0;

impl<'a> Beam<'a> {
    /// Up to [`MOST_RAYS`] rays, one at least.
    fn new(shear: &'a Shear, origins: &[DVec3]) -> Beam<'a> {
        let reference = reference(shear, origins[0]);
        let mut beam = Beam {
            shear,
            reference,
            places: [[0.0; MOST_RAYS]; 3],
            rays: [[0.0; MOST_RAYS]; 3],
            number: std::array::from_fn(|at| at as u8),
        };
        for (at, &origin) in origins.iter().enumerate() {
            let ray = around(shear, &reference, origin);
            for axis in 0..3 {
                beam.rays[axis][at] = ray[axis];
                beam.places[axis][at] = origin[shear.axes[axis]];
            }
        }
        beam
    }

    fn ray(&self, at: usize) -> [f32; 3] {
        let [right, up, ahead] = &self.rays;
        [right[at], up[at], ahead[at]]
    }

    fn spread(&self, from: usize, to: usize) -> Spread {
        let mut spread = Spread::NOTHING;
        for at in from..to {
            spread.with(self.ray(at));
        }
        spread
    }

    /// Whether rays that come row by row lie so near each other that there is nothing to look for.
    fn is_even(&self, from: usize, to: usize, spread: &Spread) -> bool {
        let mut step = Spread::NOTHING;
        step.with(self.ray(from));
        step.with(self.ray((from + 1).min(to - 1)));
        spread.outline() <= step.outline() * MOST_STEPS
    }

    /// The next group that begins with a ray: where it ends, and what it lies between.
    fn group(&mut self, from: usize, mut to: usize) -> (usize, Spread) {
        let mut spread = self.spread(from, to);
        if self.is_even(from, to, &spread) {
            return (to, spread);
        }
        loop {
            let Spread { low, high } = spread;
            let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
            let middle = (low[axis] + high[axis]) * 0.5;
            let (mut lower, mut upper) = (Spread::NOTHING, Spread::NOTHING);
            let mut count = 0;
            for at in from..to {
                let ray = self.ray(at);
                if ray[axis] < middle {
                    lower.with(ray);
                    count += 1;
                } else {
                    upper.with(ray);
                }
            }
            if count == 0 || count == to - from || lower.outline() + upper.outline() > spread.outline() * APART {
                return (to, spread);
            }
            let mut place = from;
            for at in from..to {
                if self.rays[axis][at] < middle {
                    self.rays.iter_mut().for_each(|rays| rays.swap(place, at));
                    self.places.iter_mut().for_each(|places| places.swap(place, at));
                    self.number.swap(place, at);
                    place += 1;
                }
            }
            (to, spread) = (place, lower);
        }
    }

    /// How far the rays from one on, as many as there are lanes, go to a triangle that they hit: decided in double precision.
    #[inline(always)]
    fn hits<L: Lanes>(&self, first: usize, triangle: &[Vec3; 3]) -> [f64; MOST_LANES] {
        let mut distances = [f64::INFINITY; MOST_LANES];
        for from in (0..L::COUNT).step_by(EIGHT) {
            let [right, up, ahead] = &self.places;
            let eight = |places: &'_ [f64; MOST_RAYS]| places[first + from..].first_chunk().copied();
            if let (Some(right), Some(up), Some(ahead)) = (eight(right), eight(up), eight(ahead)) {
                distances[from..from + EIGHT].copy_from_slice(&self.shear.hits([&right, &up, &ahead], triangle));
            }
        }
        distances
    }

    /// The rays of some lanes.
    #[inline(always)]
    fn lanes<L: Lanes>(&self, at: usize) -> [L; 3] {
        let [right, up, ahead] = &self.rays;
        [L::load(&right[at..]), L::load(&up[at..]), L::load(&ahead[at..])]
    }
}

/// Which of some parallel rays anything lies along: a bit for each.
pub(super) struct BlockedBeam<'a> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origins: &'a [DVec3],
}

impl LaneWork for BlockedBeam<'_> {
    type Output = u64;
    #[inline(always)]
    fn run<S: Simd>(self) -> u64 {
        let BlockedBeam { tree, shear, origins } = self;
        let mut beam = Beam::new(shear, origins);
        let (mut from, mut blocked) = (0, 0);
        while from < origins.len() {
            let (to, spread) = beam.group(from, origins.len());
            let frame = BeamFrame::new(shear, beam.reference, spread.low, spread.high);
            let asked = group_bits(from, to);
            let mut search = AnyHits { beam: &beam, open: asked };
            traverse::<S, _>(tree, &frame, &mut search);
            let hit = asked & !search.open;
            for at in from..to {
                blocked |= (hit >> at & 1) << beam.number[at];
            }
            from = to;
        }
        blocked
    }
}

/// Bits of a group's rays.
fn group_bits(from: usize, to: usize) -> u64 {
    (u64::MAX >> (MOST_RAYS - (to - from))) << from
}

/// Rays of a group that a triangle may be hit by: calls with the first of each set of lanes, and a bit a lane.
#[inline(always)]
fn each_set<L: Lanes>(rays: u64, mut ask: impl FnMut(usize, u32)) {
    let mut first = rays.trailing_zeros() as usize / L::COUNT * L::COUNT;
    while first < MOST_RAYS && rays >> first != 0 {
        let set = (rays >> first) as u32 & (u32::MAX >> (32 - L::COUNT));
        if set != 0 {
            ask(first, set);
        }
        first += L::COUNT;
    }
}

struct AnyHits<'a> {
    beam: &'a Beam<'a>,
    /// The rays that nothing has been met by yet, in the groups' order.
    open: u64,
}

impl BlockVisitor for AnyHits<'_> {
    const NEAREST_FIRST: bool = false;
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, block: &TriangleBlock) -> bool {
        let flat = FlatTriangles::<S::Eight>::of(frame, block);
        let met = block.there & !flat.missed_by_all(frame);
        if met == 0 {
            return true;
        }
        let rows = flat.rows();
        for at in bits(met) {
            let flat = FlatTriangles::<S::Many>::one(&rows, at);
            let triangle = block.triangle(at);
            let mut open = self.open;
            each_set::<S::Many>(self.open, |first, set| {
                let asked = set & !flat.missed(self.beam.lanes(first));
                if asked != 0 {
                    let hits = self.beam.hits::<S::Many>(first, &triangle);
                    for lane in bits(asked) {
                        open &= !(u64::from(hits[lane] < f64::INFINITY) << (first + lane));
                    }
                }
            });
            self.open = open;
            if open == 0 {
                return false;
            }
        }
        true
    }
    #[inline(always)]
    fn farthest(&self) -> f32 {
        f32::INFINITY
    }
}

/// As [`FirstHit`], of some parallel rays.
pub(super) struct FirstHits<'a> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origins: &'a [DVec3],
    pub(super) hits: &'a mut [Option<(u32, f64)>],
}

impl LaneWork for FirstHits<'_> {
    type Output = ();
    #[inline(always)]
    fn run<S: Simd>(self) {
        let FirstHits { tree, shear, origins, hits } = self;
        let mut beam = Beam::new(shear, origins);
        let mut from = 0;
        while from < origins.len() {
            let (to, spread) = beam.group(from, origins.len());
            let frame = BeamFrame::new(shear, beam.reference, spread.low, spread.high);
            let nearest = [Nearest::NOTHING; MOST_RAYS];
            let asked = group_bits(from, to);
            let mut search = NearestHits { beam: &beam, asked, nearest, farthest: f32::INFINITY };
            traverse::<S, _>(tree, &frame, &mut search);
            for at in from..to {
                hits[beam.number[at] as usize] = search.nearest[at].hit();
            }
            from = to;
        }
    }
}

struct NearestHits<'a> {
    beam: &'a Beam<'a>,
    asked: u64,
    nearest: [Nearest; MOST_RAYS],
    farthest: f32,
}

impl BlockVisitor for NearestHits<'_> {
    const NEAREST_FIRST: bool = true;
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, block: &TriangleBlock) -> bool {
        let flat = FlatTriangles::<S::Eight>::of(frame, block);
        let met = block.there & !flat.missed_by_all(frame);
        if met == 0 {
            return true;
        }
        let rows = flat.rows();
        let mut nearer = false;
        for at in bits(met) {
            let flat = FlatTriangles::<S::Many>::one(&rows, at);
            let triangle = block.triangle(at);
            each_set::<S::Many>(self.asked, |first, set| {
                let asked = set & !flat.missed(self.beam.lanes(first));
                if asked != 0 {
                    let hits = self.beam.hits::<S::Many>(first, &triangle);
                    for lane in bits(asked) {
                        nearer |= self.nearest[first + lane].take(hits[lane], block.faces[at]);
                    }
                }
            });
        }
        if nearer {
            self.farthest = f32::NEG_INFINITY;
            each_set::<S::Many>(self.asked, |first, set| {
                for at in bits(set).map(|lane| first + lane) {
                    let farthest = self.nearest[at].farthest(self.beam.shear, self.beam.rays[2][at], frame.shear.sign);
                    self.farthest = self.farthest.max(farthest);
                }
            });
        }
        true
    }
    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.farthest
    }
}
