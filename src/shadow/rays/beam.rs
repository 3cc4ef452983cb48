//! Up to 64 parallel rays at once: groups of nearby rays traverse the tree together.

use super::frame::{BeamFrame, around, reference};
use super::lanes::{LaneWork, Lanes, Simd};
use super::prune::{Fates, FlatTriangles, StartPlane};
use super::search::{AskedBlock, BlockVisitor, NearestFace, NearestVisitor, bits, traverse, traverse_nearest};
use super::shear::Shear;
use super::tree::{EIGHT, TriangleBlock, WideTree};
use glam::{DVec3, Vec3};
use std::marker::PhantomData;
use std::ops::Range;

/// The most rays of a beam.
pub(super) const MOST_RAYS: usize = 64;

/// The most lanes of any level.
const MOST_LANES: usize = 16;

/// Parallel rays, in groups of nearby ones.
pub(super) struct Beam<'a> {
    shear: &'a Shear,
    reference: [f32; 3],
    /// Their origins, by the rays' axes.
    places: [[f64; MOST_RAYS]; 3],
    /// For each ray, in group order: where it meets the plane, and how far ahead it begins.
    rays: [[f32; MOST_RAYS]; 3],
    /// The rays' original indices.
    number: [u8; MOST_RAYS],
}

/// The bounds of a group's rays.
#[derive(Clone, Copy)]
struct Spread {
    low: [f32; 3],
    high: [f32; 3],
}

impl Spread {
    const NOTHING: Spread = Spread { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    #[inline(always)]
    fn with(&mut self, ray: [f32; 3]) {
        for ((low, high), along) in self.low.iter_mut().zip(&mut self.high).zip(ray) {
            *low = if along < *low { along } else { *low };
            *high = if along > *high { along } else { *high };
        }
    }

    /// Half of the outline in the plane.
    fn outline(&self) -> f32 {
        self.high[0] - self.low[0] + self.high[1] - self.low[1]
    }
}

/// Two groups are separated if the sum of their outlines is shorter than this share of the whole's.
const APART: f32 = 0.8;

/// The outline of a square of 8 by 8 rays is 14 steps between rays, and somewhat more if it is skewed.
const MOST_STEPS: f32 = 24.0;

impl<'a> Beam<'a> {
    /// Makes a beam of 1 to [`MOST_RAYS`] rays.
    pub(super) fn new(shear: &'a Shear, origins: &[DVec3]) -> Beam<'a> {
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

    /// The frame of its first rays, all together.
    pub(super) fn frame(&self, rays: usize) -> BeamFrame<'a> {
        let Spread { low, high } = self.spread(0, rays);
        BeamFrame::new(self.shear, self.reference, low, high)
    }

    /// Whether rays in row order are so close together that no groups need to be found.
    fn is_even(&self, from: usize, to: usize, spread: &Spread) -> bool {
        let mut step = Spread::NOTHING;
        step.with(self.ray(from));
        step.with(self.ray((from + 1).min(to - 1)));
        spread.outline() <= step.outline() * MOST_STEPS
    }

    /// The group that begins with a ray: its end, and its bounds.
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

    /// The distances to a triangle of consecutive rays, one per lane, decided in double precision.
    #[inline(always)]
    fn hits<L: Lanes>(&self, first: usize, triangle: &[Vec3; 3]) -> [f64; MOST_LANES] {
        let mut distances = [f64::INFINITY; MOST_LANES];
        for from in (0..L::COUNT).step_by(EIGHT) {
            let [right, up, ahead] = &self.places;
            let at = first + from;
            if let (Some(right), Some(up), Some(ahead)) =
                (right[at..].first_chunk(), up[at..].first_chunk(), ahead[at..].first_chunk())
            {
                distances[from..from + EIGHT].copy_from_slice(&self.shear.hits([right, up, ahead], triangle));
            }
        }
        distances
    }

    /// The values of consecutive rays, one per lane.
    #[inline(always)]
    fn lanes<L: Lanes>(&self, at: usize) -> [L; 3] {
        let [right, up, ahead] = &self.rays;
        [L::load(&right[at..]), L::load(&up[at..]), L::load(&ahead[at..])]
    }
}

/// Tests which of some parallel rays are blocked: a bit for each.
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
            let mut search = AnyHits::of(&beam, from..to, None);
            traverse::<S, _>(tree, &frame, &mut search);
            let hit = search.blocked();
            for at in from..to {
                blocked |= (hit >> at & 1) << beam.number[at];
            }
            from = to;
        }
        blocked
    }
}

/// The bits of a group's rays.
fn group_bits(from: usize, to: usize) -> u64 {
    (u64::MAX >> (MOST_RAYS - (to - from))) << from
}

/// Sets of lanes with rays that may hit a triangle: the first ray's index, and a bit per lane. No closures, which are
/// not always inlined, so that their lanes would be called instead of compiled for the level.
struct LaneSets<L> {
    rays: u64,
    first: usize,
    lanes: PhantomData<L>,
}

impl<L: Lanes> LaneSets<L> {
    #[inline(always)]
    fn of(rays: u64) -> LaneSets<L> {
        LaneSets { rays, first: rays.trailing_zeros() as usize / L::COUNT * L::COUNT, lanes: PhantomData }
    }
}

impl<L: Lanes> Iterator for LaneSets<L> {
    type Item = (usize, u32);
    #[inline(always)]
    fn next(&mut self) -> Option<(usize, u32)> {
        while self.first < MOST_RAYS && self.rays >> self.first != 0 {
            let first = self.first;
            let set = (self.rays >> first) as u32 & (u32::MAX >> (32 - L::COUNT));
            self.first += L::COUNT;
            if set != 0 {
                return Some((first, set));
            }
        }
        None
    }
}

/// The search for whatever blocks rays of a beam.
pub(super) struct AnyHits<'a> {
    beam: &'a Beam<'a>,
    asked: u64,
    /// The rays that are not blocked so far, in group order.
    open: u64,
    plane: Option<StartPlane>,
    /// The block that blocked the last of the rays.
    pub(super) last: Option<u32>,
}

impl<'a> AnyHits<'a> {
    /// The search for some rays, in group order, which all begin in the plane if there is one.
    pub(super) fn of(beam: &'a Beam<'a>, rays: Range<usize>, plane: Option<StartPlane>) -> AnyHits<'a> {
        let asked = group_bits(rays.start, rays.end);
        AnyHits { beam, asked, open: asked, plane, last: None }
    }

    /// The rays that are blocked, in group order.
    pub(super) fn blocked(&self) -> u64 {
        self.asked & !self.open
    }
}

impl BlockVisitor for AnyHits<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool {
        let flat = FlatTriangles::<S::Eight>::of(frame, block);
        let Fates { missed, hit } = flat.fates_of_all(frame);
        if asked.triangles & hit != 0 {
            (self.open, self.last) = (0, Some(asked.at));
            return false;
        }
        let mut met = asked.triangles & !missed;
        if let Some(plane) = self.plane.as_ref().filter(|_| met != 0) {
            met &= !flat.below(frame, block, plane);
        }
        if met == 0 {
            return true;
        }
        let rows = flat.rows();
        for at in bits(met) {
            let flat = FlatTriangles::<S::Many>::one(&rows, at);
            let triangle = block.triangle(at);
            let mut open = self.open;
            for (first, set) in LaneSets::<S::Many>::of(self.open) {
                let Fates { missed, hit } = flat.fates(self.beam.lanes(first));
                open &= !(u64::from(set & hit) << first);
                let asked = set & !missed & !hit;
                if asked != 0 {
                    let hits = self.beam.hits::<S::Many>(first, &triangle);
                    for lane in bits(asked) {
                        open &= !(u64::from(hits[lane] < f64::INFINITY) << (first + lane));
                    }
                }
            }
            self.open = open;
            if open == 0 {
                self.last = Some(asked.at);
                return false;
            }
        }
        true
    }
}

/// Finds the nearest face along each of some parallel rays, with the same result as for single rays.
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
            let nearest = [NearestFace::NOTHING; MOST_RAYS];
            let asked = group_bits(from, to);
            let mut search = NearestHits { beam: &beam, asked, nearest, farthest: f32::INFINITY };
            traverse_nearest::<S, _>(tree, &frame, &mut search);
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
    nearest: [NearestFace; MOST_RAYS],
    farthest: f32,
}

impl BlockVisitor for NearestHits<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool {
        let flat = FlatTriangles::<S::Eight>::of(frame, block);
        let met = asked.triangles & !flat.fates_of_all(frame).missed;
        if met == 0 {
            return true;
        }
        let rows = flat.rows();
        let mut nearer = false;
        for at in bits(met) {
            let flat = FlatTriangles::<S::Many>::one(&rows, at);
            let triangle = block.triangle(at);
            for (first, set) in LaneSets::<S::Many>::of(self.asked) {
                let asked = set & !flat.fates(self.beam.lanes(first)).missed;
                if asked != 0 {
                    let hits = self.beam.hits::<S::Many>(first, &triangle);
                    for lane in bits(asked) {
                        nearer |= self.nearest[first + lane].take(hits[lane], block.faces[at]);
                    }
                }
            }
        }
        if nearer {
            self.farthest = f32::NEG_INFINITY;
            for (first, set) in LaneSets::<S::Many>::of(self.asked) {
                for at in bits(set).map(|lane| first + lane) {
                    let farthest = self.nearest[at].farthest(self.beam.shear, self.beam.rays[2][at], frame.shear.sign);
                    self.farthest = self.farthest.max(farthest);
                }
            }
        }
        true
    }
}

impl NearestVisitor for NearestHits<'_> {
    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.farthest
    }
}
