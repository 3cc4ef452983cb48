//! The sun's view of a scene: parallel, and no larger than what can be in shadow needs.
//!
//! Only what a view sees is judged, and only what lies behind casters, seen from the sun, can be in shadow. So the map's
//! rectangle is what of two rectangles overlaps, around what is seen and around the casters, turned about the sun's rays
//! to where it is smallest. A caster outside of the view that shades something in it lies in that rectangle, however far
//! away it is; along the rays the map reaches over all casters.

use super::{GpuSurface, Scene, ShadowError};
use crate::gpu::layout;
use crate::sun::SUN_DISC_RAD;
use glam::{DMat4, DVec2, DVec3, DVec4};
use std::f64::consts::FRAC_PI_2;

/// How wide the sun's penumbra is a metre behind the edge that casts it, metres across the rays: 2·tan(θ/2).
fn spread() -> f64 {
    2.0 * (SUN_DISC_RAD / 2.0).tan()
}

/// Cells a side of the grid that groups the casters' corners.
const GROUPS: f64 = 8.0;
/// Angles that are tried for the rectangle, over a right angle.
const TURNS: u32 = 30;
/// Texels between what is needed and the map's border: filters reach over two.
const BORDER_TEXELS: f64 = 3.0;

/// What the map must hold, as points around the scene's origin whose hull does.
pub(super) struct Extents {
    casters: Vec<DVec3>,
    seen: Vec<DVec3>,
    /// Receivers that may lie beyond all casters.
    receivers: Vec<DVec3>,
    ground_z: f64,
}

impl Extents {
    pub(super) fn new(scene: &Scene, surface: &GpuSurface) -> Result<Extents, ShadowError> {
        let Scene { casters, receivers, ground } = scene;
        let corners = || casters.faces.iter().flatten().map(|&vertex| casters.vertices[vertex as usize].as_dvec3());
        let bounds =
            |bounds: Option<(DVec3, DVec3)>| bounds.map(|(low, high)| (low - casters.origin, high - casters.origin));
        let casters_boxes = bounds(casters.bounds()).map_or(Vec::new(), |(low, high)| grouped(corners(), low, high));
        let corners_of = |boxes: Vec<(DVec3, DVec3)>| boxes.into_iter().flat_map(corners_of_box).collect();
        Ok(Extents {
            casters: corners_of(casters_boxes),
            seen: corners_of(surface.boxes_of_seen()?),
            receivers: corners_of(bounds(receivers.bounds()).into_iter().collect()),
            ground_z: ground - casters.origin.z,
        })
    }

    /// The view along the sun's rays.
    pub(super) fn from_sun(&self, to_sun: DVec3) -> LightView {
        let (right, up) = to_sun.any_orthonormal_pair();
        // right × up must point to the viewer, who is the sun
        let up = if right.cross(up).dot(to_sun) < 0.0 { -up } else { up };
        let away = |points: &[DVec3]| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            points.iter().map(|point| -point.dot(to_sun)).fold(ends, |(low, high), at| (low.min(at), high.max(at)))
        };
        let (near, of_casters) = away(&self.casters);
        let far = of_casters.max(away(&self.receivers).1);
        if self.casters.is_empty() || self.seen.is_empty() {
            return LightView { to_sun, right, up, low: DVec2::ZERO, high: DVec2::ONE, near: 0.0, far: 1.0 };
        }
        let slack = 1e-3 * (far - near) + 0.01;
        let (near, far) = (near - slack, far + slack);
        let flat =
            |points: &[DVec3]| hull(points.iter().map(|point| DVec2::new(point.dot(right), point.dot(up))).collect());
        let (casters, seen) = (flat(&self.casters), flat(&self.seen));
        let penumbra = DVec2::splat(spread() * (far - near));
        let rectangle = |turn: DVec2| {
            let around = |points: &[DVec2]| {
                let ends = (DVec2::INFINITY, DVec2::NEG_INFINITY);
                let turned = points.iter().map(|point| DVec2::new(turn.dot(*point), turn.perp().dot(*point)));
                turned.fold(ends, |(low, high), at| (low.min(at), high.max(at)))
            };
            let ((low, high), (seen_low, seen_high)) = (around(&casters), around(&seen));
            (turn, (low - penumbra).max(seen_low), (high + penumbra).min(seen_high))
        };
        let area = |(_, low, high): &(DVec2, DVec2, DVec2)| {
            let size = (*high - *low).max(DVec2::ZERO);
            size.x * size.y
        };
        let turns = (0..TURNS).map(|turn| DVec2::from_angle(FRAC_PI_2 * f64::from(turn) / f64::from(TURNS)));
        let smallest = turns.map(rectangle).min_by(|one, other| area(one).total_cmp(&area(other)));
        let (turn, low, high) = smallest.unwrap_or((DVec2::X, DVec2::ZERO, DVec2::ONE));
        // where nothing overlaps, nothing is in shadow, and any rectangle will do
        let high = high.max(low + 0.01);
        let (right, up) = (right * turn.x + up * turn.y, up * turn.x - right * turn.y);
        LightView { to_sun, right, up, low, high, near, far }
    }
}

/// Boxes around groups of points that lie near to each other.
fn grouped(points: impl Iterator<Item = DVec3>, low: DVec3, high: DVec3) -> Vec<(DVec3, DVec3)> {
    let scale = (GROUPS - 1e-6) / (high - low).max(DVec3::splat(1e-9));
    let side = GROUPS as usize;
    let mut boxes = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); side * side * side];
    for point in points {
        let at = ((point - low) * scale).as_uvec3().min(glam::UVec3::splat(side as u32 - 1)).as_usizevec3();
        let (low, high) = &mut boxes[(at.z * side + at.y) * side + at.x];
        (*low, *high) = (low.min(point), high.max(point));
    }
    boxes.retain(|(low, high)| low.x <= high.x);
    boxes
}

fn corners_of_box((low, high): (DVec3, DVec3)) -> impl Iterator<Item = DVec3> {
    (0..8).map(move |index| DVec3::select(glam::BVec3::new(index & 1 == 0, index & 2 == 0, index & 4 == 0), low, high))
}

/// The corners of the convex hull (Andrew's monotone chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut hull: Vec<DVec2> = Vec::new();
    for round in 0..2 {
        let first = hull.len();
        for &point in &points {
            while hull.len() >= first + 2
                && (hull[hull.len() - 1] - hull[hull.len() - 2]).perp_dot(point - hull[hull.len() - 2]) <= 0.0
            {
                hull.pop();
            }
            hull.push(point);
        }
        if round == 0 {
            points.reverse();
        }
    }
    hull
}

/// A parallel view along the sun's rays, in metres around the scene's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LightView {
    to_sun: DVec3,
    /// The map's axes: right × up points to the sun.
    right: DVec3,
    up: DVec3,
    /// The rectangle on these axes.
    low: DVec2,
    high: DVec2,
    /// From where to where along the rays, away from the sun.
    near: f64,
    far: f64,
}

impl LightView {
    /// The uniform for a map of `size` texels a side, and smoothies of a fixed width, or 0 where it is the sun's.
    pub(super) fn uniform(&self, extents: &Extents, size: u32, width_m: f64) -> layout::Map {
        let &LightView { to_sun, right, up, near, far, .. } = self;
        let border = (self.high - self.low) * (BORDER_TEXELS / (f64::from(size) - 2.0 * BORDER_TEXELS));
        let (low, high) = (self.low - border, self.high + border);
        let texel = (high - low) / f64::from(size);
        let rows = [
            (right / texel.x).extend(-low.x / texel.x),
            (-up / texel.y).extend(high.y / texel.y),
            (-to_sun).extend(-near),
            DVec4::W,
        ];
        let from_local = DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
        // the ground's depth where a ray through the map's corner meets it, and how it grows over the map
        let rise = to_sun.z.max(1e-4);
        let ground_at_corner = (right.z * low.x + up.z * high.y - extents.ground_z) / rise - near;
        let ground = [right.z * texel.x / rise, -up.z * texel.y / rise, ground_at_corner, 0.0];
        let reach = [low.abs(), high.abs(), DVec2::new(near.abs(), far.abs())]
            .into_iter()
            .fold(0.0, |reach: f64, ends| reach.max(ends.max_element()));
        let vector = |vector: DVec3| vector.extend(0.0).as_vec4().to_array();
        layout::Map {
            from_local: from_local.as_mat4().to_cols_array_2d(),
            across: vector(right * texel.x),
            along: vector(-up * texel.y),
            ground: ground.map(|value| value as f32),
            texel: texel.as_vec2().to_array(),
            size: size as f32,
            range: (far - near) as f32,
            bias: (BIAS_M + 4.0 * f64::from(f32::EPSILON) * reach) as f32,
            slope_bias: SLOPE_BIAS_TEXELS as f32,
            spread: spread() as f32,
            width: width_m as f32,
        }
    }
}

/// How much nearer to the sun than a cell a texel must be to shade it, metres along the rays; and rounding beside it.
const BIAS_M: f64 = 0.0002;
/// The same for each metre that the cell's plane falls away over a texel, in texels: the map's own rounding of corners is
/// 1/256 of a texel. Measured: docs/benchmarks/techniques.md.
const SLOPE_BIAS_TEXELS: f64 = 0.02;
