//! What single precision can decide about rays and triangles: which rays certainly miss, which certainly hit, and which
//! triangles are certainly behind.
//!
//! A triangle is projected along the rays onto the plane across their longest axis, as in the double-precision test. A
//! ray misses it if one of the three edges' areas is certainly negative and another certainly positive. The error of
//! the areas is bounded by counting roundings (η is half an ulp of 1, 2⁻²⁴). Coordinates are relative to the beam, so
//! nearby values are accurate however far the mesh's origin is. Let L be the extent of two edges together along an
//! axis, and D an upper bound of all coordinates of triangle and rays, and of the triangle's corners relative to any
//! ray's origin. The error of a corner in the plane is 8ηD, of an edge 8ηL, so that of each edge's area is at most
//! 206ηLD, the third being the rest. The error of the double-precision test itself is below 2⁻⁴⁵D². So values farther
//! from 0 than 320ηLD + 2⁻⁴⁵D² have the right sign in both. The error of the whole area is 72ηL₁L₂, and that of the
//! volume by which a triangle is behind is 312ηL₁L₂D; in double precision they are 2⁻⁴⁴D² and 2⁻⁴⁴D³. A ray certainly
//! hits a triangle if all three areas are certainly positive, and the triangle is certainly not behind.

use super::frame::BeamFrame;
use super::lanes::Lanes;
use super::tree::{EIGHT, TriangleBlock};

const ETA: f32 = f32::EPSILON / 2.0;
/// The roundings in edges' areas.
const EDGE_ROUNDINGS: f32 = 320.0 * ETA;
const EDGE_DOUBLE: f32 = 1.0 / (1u64 << 45) as f32;
/// Twice the roundings of the area: beyond it, one of the two other areas, which is more than half of it, has the
/// opposite sign.
const AREA_ROUNDINGS: f32 = 256.0 * ETA;
const AREA_DOUBLE: f32 = 1.0 / (1u64 << 42) as f32;
/// The roundings of the volume.
const BEHIND_ROUNDINGS: f32 = 384.0 * ETA;
const BEHIND_DOUBLE: f32 = 1.0 / (1u64 << 43) as f32;

/// The roundings of a corner's height above the plane in which rays begin.
const HEIGHT_ROUNDINGS: f32 = 24.0 * ETA;
/// How far below that plane a triangle must lie, metres.
const BELOW_M: f32 = 1.0 / 4096.0;

/// Triangles in the plane across the rays, turned so that their areas are positive.
#[derive(Clone, Copy)]
pub(super) struct FlatTriangles<L> {
    /// A corner: right, up and ahead.
    corner: [L; 3],
    /// The vectors from it to the two others: right and up.
    edges: [[L; 2]; 2],
    area: L,
    /// The threshold for the sign of an edge's area, and the value that one area must exceed for another one to decide.
    off: L,
    over: L,
    /// The change of a ray's volume with its place, and the volume beyond which the triangle is behind.
    across: [L; 3],
    behind: L,
}

/// The plane in which the rays of a frame begin, by their axes: its unit normal to the side to which they go, and the
/// height of the reference above it.
#[derive(Clone, Copy)]
pub(super) struct StartPlane {
    pub(super) normal: [f32; 3],
    pub(super) height: f32,
}

/// What single precision is certain of, a bit for each lane.
#[derive(Clone, Copy)]
pub(super) struct Fates {
    /// The double-precision test would find no hit.
    pub(super) missed: u32,
    /// The double-precision test would find a hit.
    pub(super) hit: u32,
}

/// The number of values of a flat triangle.
const ROWS: usize = 14;

#[inline(always)]
fn area<L: Lanes>(one: [L; 2], other: [L; 2]) -> L {
    one[0].times(other[1]).minus(one[1].times(other[0]))
}

/// The variation of an edge's area over a frame's rays.
#[inline(always)]
fn swing<L: Lanes>(edge: [L; 2], half: [L; 3]) -> L {
    edge[0].size().times_plus(half[1], edge[1].size().times(half[0]))
}

/// A corner of a block's triangles, by the rays' axes.
#[inline(always)]
fn corner<L: Lanes>(frame: &BeamFrame<'_>, block: &TriangleBlock, corner: usize) -> [L; 3] {
    let [right, up, ahead] = frame.shear.axes;
    let along = &block.corners[corner];
    [L::load(&along[right]), L::load(&along[up]), L::load(&along[ahead])]
}

#[inline(always)]
fn minus<L: Lanes>(one: [L; 3], other: [L; 3]) -> [L; 3] {
    [one[0].minus(other[0]), one[1].minus(other[1]), one[2].minus(other[2])]
}

#[inline(always)]
fn dot<L: Lanes>(one: [L; 3], other: [L; 3]) -> L {
    one[2].times_plus(other[2], one[1].times_plus(other[1], one[0].times(other[0])))
}

/// Projects a corner along the rays to the plane.
#[inline(always)]
fn flat<L: Lanes>(along: [L; 3], less_slope: [L; 2]) -> [L; 2] {
    [along[2].times_plus(less_slope[0], along[0]), along[2].times_plus(less_slope[1], along[1])]
}

/// A value of one triangle, in all lanes.
#[inline(always)]
fn taken<L: Lanes>(rows: &[[f32; EIGHT]; ROWS], at: usize, row: usize) -> L {
    L::splat(rows[row][at])
}

#[inline(always)]
fn reach<L: Lanes>(along: [L; 3]) -> L {
    along[0].size().most(along[1].size()).most(along[2].size())
}

impl<L: Lanes> FlatTriangles<L> {
    /// A block's triangles for the rays of a frame.
    #[inline(always)]
    pub(super) fn of(frame: &BeamFrame<'_>, block: &TriangleBlock) -> FlatTriangles<L> {
        let [first, second, third] = [corner(frame, block, 0), corner(frame, block, 1), corner(frame, block, 2)];
        let [right, up, ahead] = frame.reference;
        let a = minus(first, [L::splat(right), L::splat(up), L::splat(ahead)]);
        let (e, g) = (minus(second, first), minus(third, first));
        let less_slope = [L::splat(-frame.shear.slope[0]), L::splat(-frame.shear.slope[1])];
        let ([x, y], e_flat, g_flat) = (flat(a, less_slope), flat(e, less_slope), flat(g, less_slope));
        let signed = area(e_flat, g_flat);
        let turn = signed.sign();
        let whole = signed.size();
        let (e_reach, g_reach) = (reach(e), reach(g));
        let (length, lengths) = (e_reach.plus(g_reach), e_reach.times(g_reach));
        let far = reach(a).plus(length).plus(L::splat(frame.size));
        let far_squared = far.times(far);
        let off = length.times(far).times(L::splat(EDGE_ROUNDINGS)).plus(far_squared.times(L::splat(EDGE_DOUBLE)));
        let least = lengths.times(L::splat(AREA_ROUNDINGS)).plus(far_squared.times(L::splat(AREA_DOUBLE)));
        let volume = lengths.times(L::splat(BEHIND_ROUNDINGS)).plus(far_squared.times(L::splat(BEHIND_DOUBLE)));
        let sense = L::splat(frame.shear.sign);
        let turned = turn.times(sense);
        FlatTriangles {
            corner: [x, y, a[2]],
            edges: [[e_flat[0].times(turn), e_flat[1].times(turn)], [g_flat[0].times(turn), g_flat[1].times(turn)]],
            area: whole,
            off,
            // an edge-on triangle has no positive side, and no distance
            over: least.if_less(whole, L::splat(f32::NEG_INFINITY), off),
            across: [
                area([e[1], e[2]], [g[1], g[2]]).times(turned),
                area([e[2], e[0]], [g[2], g[0]]).times(turned),
                whole.times(sense),
            ],
            behind: least.if_less(whole, volume.times(far), L::splat(f32::INFINITY)),
        }
    }

    /// The three edges' areas of a ray, and the volume by which the triangle is behind it.
    #[inline(always)]
    fn areas(&self, ray: [L; 3]) -> ([L; 3], L) {
        let along = minus(ray, self.corner);
        let flat = [along[0], along[1]];
        let (one, last) = (area(self.edges[0], flat), area(flat, self.edges[1]));
        let volume = along[0].times(self.across[0]);
        let volume = along[1].times_plus(self.across[1], volume);
        ([one, self.area.minus(one).minus(last), last], along[2].times_plus(self.across[2], volume))
    }

    /// What is certain of a ray, lane by lane.
    #[inline(always)]
    pub(super) fn fates(&self, ray: [L; 3]) -> Fates {
        let ([one, other, last], volume) = self.areas(ray);
        let lowest = one.least(other).least(last);
        let highest = one.most(other).most(last);
        let beside = lowest.less(L::splat(0.0).minus(self.off)) & self.over.less(highest);
        let before = volume.less(L::splat(0.0).minus(self.behind));
        Fates { missed: beside | self.behind.less(volume), hit: self.off.less(lowest) & before }
    }

    /// What is certain of all rays of a frame, triangle by triangle.
    #[inline(always)]
    pub(super) fn fates_of_all(&self, frame: &BeamFrame<'_>) -> Fates {
        let [right, up, ahead] = frame.middle;
        let ([one, other, last], volume) = self.areas([L::splat(right), L::splat(up), L::splat(ahead)]);
        let [right, up, ahead] = frame.half;
        let half = [L::splat(right), L::splat(up), L::splat(ahead)];
        let [e, g] = self.edges;
        let third = [g[0].minus(e[0]), g[1].minus(e[1])];
        let (of_e, of_third, of_g) = (swing(e, half), swing(third, half), swing(g, half));
        let highest = one.plus(of_e).least(other.plus(of_third)).least(last.plus(of_g));
        let lowest = one.minus(of_e).least(other.minus(of_third)).least(last.minus(of_g));
        let one_sided = self.over.less(L::splat(f32::MIN));
        let beside = highest.less(L::splat(0.0).minus(self.off)) & one_sided;
        let swings = self.across[0].size().times(half[0]);
        let swings = self.across[1].size().times_plus(half[1], swings);
        let swings = self.across[2].size().times_plus(half[2], swings);
        let before = volume.plus(swings).less(L::splat(0.0).minus(self.behind));
        Fates { missed: beside | self.behind.less(volume.minus(swings)), hit: self.off.less(lowest) & before }
    }

    /// The triangles of the block that lie below the plane in which rays of a frame begin, so that all of them miss.
    #[inline(always)]
    pub(super) fn below(&self, frame: &BeamFrame<'_>, block: &TriangleBlock, plane: &StartPlane) -> u32 {
        let [first, second, third] = [corner(frame, block, 0), corner(frame, block, 1), corner(frame, block, 2)];
        let [right, up, ahead] = frame.reference;
        let a = minus(first, [L::splat(right), L::splat(up), L::splat(ahead)]);
        let (e, g) = (minus(second, first), minus(third, first));
        let [x, y, z] = plane.normal;
        let normal = [L::splat(x), L::splat(y), L::splat(z)];
        let height = dot(a, normal).plus(L::splat(plane.height));
        let highest = height.most(height.plus(dot(e, normal))).most(height.plus(dot(g, normal)));
        let far = reach(a).plus(reach(e).plus(reach(g))).plus(L::splat(frame.size));
        let low = far.times(L::splat(-HEIGHT_ROUNDINGS)).minus(L::splat(BELOW_M));
        // the volume by which it is behind is larger than the error of the double-precision test
        let volume = far.times(far).times(far).times(L::splat(BEHIND_DOUBLE));
        highest.less(low) & volume.less(self.area.times(L::splat(BELOW_M)))
    }

    /// The values of all triangles, from which each can be taken singly.
    #[inline(always)]
    pub(super) fn rows(self) -> [[f32; EIGHT]; ROWS] {
        let mut rows = [[0.0; EIGHT]; ROWS];
        let FlatTriangles { corner, edges: [e, g], area, off, over, across, behind } = self;
        let numbers = [
            corner[0], corner[1], corner[2], e[0], e[1], g[0], g[1], area, off, over, across[0], across[1], across[2],
            behind,
        ];
        for (row, lanes) in rows.iter_mut().zip(numbers) {
            lanes.store(row);
        }
        rows
    }

    /// One triangle in all lanes.
    #[inline(always)]
    pub(super) fn one(rows: &[[f32; EIGHT]; ROWS], at: usize) -> FlatTriangles<L> {
        let edges = [[taken(rows, at, 3), taken(rows, at, 4)], [taken(rows, at, 5), taken(rows, at, 6)]];
        FlatTriangles {
            corner: [taken(rows, at, 0), taken(rows, at, 1), taken(rows, at, 2)],
            edges,
            area: taken(rows, at, 7),
            off: taken(rows, at, 8),
            over: taken(rows, at, 9),
            across: [taken(rows, at, 10), taken(rows, at, 11), taken(rows, at, 12)],
            behind: taken(rows, at, 13),
        }
    }
}
