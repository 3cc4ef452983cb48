//! A light's view of a scene. The sun's view is parallel, and no larger than the area that can be in shadow.
//!
//! Only what a view sees is judged, and only what is behind casters as seen from the sun can be in shadow. So the map
//! covers the intersection of two rectangles, around what is seen and around the casters, rotated about the sun's rays
//! to the smallest intersection. A caster outside of the view that shades something in it is within that rectangle,
//! however far away it is; along the rays the map extends over all casters. A lamp's view is in perspective; it is for
//! smoothies, whose paper has lamps.

use super::{GpuSurface, Scene, ShadowError};
use crate::gpu::layout;
use crate::sun::SUN_DISC_RAD;
use glam::{DMat4, DVec2, DVec3, DVec4};
use std::f64::consts::FRAC_PI_2;

/// The width of the sun's penumbra one metre behind the edge that casts it, metres across the rays: 2·tan(θ/2).
fn spread() -> f64 {
    2.0 * (SUN_DISC_RAD / 2.0).tan()
}

/// The cells along a side of the grid that groups the casters' corners.
const GROUPS: f64 = 8.0;
/// The number of angles tried for the rectangle, over 90°.
const TURNS: u32 = 30;
/// The texels between the contents and the map's border: filters reach over two.
const BORDER_TEXELS: f64 = 3.0;

/// The contents of the map, as points around the scene's origin whose convex hull contains them.
pub(super) struct Extents {
    casters: Vec<DVec3>,
    seen: Vec<DVec3>,
    /// Receivers that may be beyond all casters.
    receivers: Vec<DVec3>,
    ground_z: f64,
    /// The highest point of the casters, metres above the scene's origin.
    casters_top: f64,
    /// The height from the lowest judged point to the highest caster, metres.
    fall: f64,
}

impl Extents {
    pub(super) fn new(scene: &Scene, surface: &GpuSurface) -> Result<Extents, ShadowError> {
        let Scene { casters, receivers, ground } = scene;
        let corners = || casters.faces.iter().flatten().map(|&vertex| casters.vertices[vertex as usize].as_dvec3());
        let bounds =
            |bounds: Option<(DVec3, DVec3)>| bounds.map(|(low, high)| (low - casters.origin, high - casters.origin));
        let casters_boxes = bounds(casters.bounds()).map_or(Vec::new(), |(low, high)| grouped(corners(), low, high));
        let mut extents = Extents {
            casters: corners_of(casters_boxes),
            seen: Vec::new(),
            receivers: corners_of(bounds(receivers.bounds()).into_iter().collect()),
            ground_z: ground - casters.origin.z,
            casters_top: casters.top() - casters.origin.z,
            fall: 0.0,
        };
        extents.turn_to(surface)?;
        Ok(extents)
    }

    /// Uses what another view of the same scene sees.
    pub(super) fn turn_to(&mut self, surface: &GpuSurface) -> Result<(), ShadowError> {
        self.seen = corners_of(surface.boxes_of_seen()?);
        self.fall = (self.casters_top - surface.lowest_z).max(0.0);
        Ok(())
    }

    /// The view along the sun's rays.
    pub(super) fn along_sun(&self, to_sun: DVec3) -> LightView {
        let (right, up) = axes(-to_sun);
        let away = |points: &[DVec3]| ends(points.iter().map(|point| -point.dot(to_sun)));
        let nothing = LightView {
            light: to_sun.extend(0.0),
            away: -to_sun,
            right,
            up,
            low: DVec2::ZERO,
            high: DVec2::ONE,
            near: 0.0,
            far: 1.0,
            farthest: 1.0,
        };
        if self.casters.is_empty() || self.seen.is_empty() {
            return nothing;
        }
        let (near, of_casters) = away(&self.casters);
        let far = of_casters.max(away(&self.receivers).1);
        let slack = 1e-3 * (far - near) + 0.01;
        let (near, far) = (near - slack, far + slack);
        let flat =
            |points: &[DVec3]| hull(points.iter().map(|point| DVec2::new(point.dot(right), point.dot(up))).collect());
        let (casters, seen) = (flat(&self.casters), flat(&self.seen));
        let farthest = away(&self.seen).1;
        let penumbra = DVec2::splat(spread() * (self.fall / to_sun.z.max(1e-4)).min((farthest - near).max(0.0)));
        let rectangle = |turn: DVec2| {
            let around = |points: &[DVec2]| {
                bounds(points.iter().map(|point| DVec2::new(turn.dot(*point), turn.perp().dot(*point))))
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
        let Some((turn, low, high)) = smallest else { return nothing };
        // without an intersection nothing is in shadow, and any rectangle will do
        let high = high.max(low + 0.01);
        let (right, up) = (right * turn.x + up * turn.y, up * turn.x - right * turn.y);
        LightView { right, up, low, high, near, far, farthest, ..nothing }
    }

    /// A lamp's view towards the middle of what is seen, limited to [`LAMP_SEES`] on each side and to the front of the
    /// lamp.
    pub(super) fn before_lamp(&self, lamp: DVec3) -> LightView {
        let middle =
            self.seen.iter().chain(&self.casters).sum::<DVec3>() / (self.seen.len() + self.casters.len()).max(1) as f64;
        let away = (middle - lamp).try_normalize().unwrap_or(DVec3::NEG_Z);
        let (right, up) = axes(away);
        let depths = self.casters.iter().chain(&self.receivers).chain(&self.seen).map(|point| (point - lamp).dot(away));
        let far = ends(depths).1.max(1.0) * 1.001;
        let before = |points: &[DVec3]| {
            // a box that extends behind the lamp fills the view
            let is_behind = points.iter().any(|point| (point - lamp).dot(away) < LAMP_NEAR_M);
            let at = |point: &DVec3| {
                DVec2::new((point - lamp).dot(right), (point - lamp).dot(up)) / (point - lamp).dot(away)
            };
            if is_behind { (-DVec2::INFINITY, DVec2::INFINITY) } else { bounds(points.iter().map(at)) }
        };
        let ((low, high), (seen_low, seen_high)) = (before(&self.casters), before(&self.seen));
        let sees = DVec2::splat(LAMP_SEES);
        let low = low.max(seen_low).max(-sees);
        LightView {
            light: lamp.extend(1.0),
            away,
            right,
            up,
            low,
            high: high.min(seen_high).min(sees).max(low + 1e-3),
            near: LAMP_NEAR_M,
            far,
            farthest: far,
        }
    }
}

/// The tangent of the greatest angle from a lamp's axis in its map: 63° on each side.
const LAMP_SEES: f64 = 2.0;
/// The near distance of a lamp's map, metres.
const LAMP_NEAR_M: f64 = 0.05;

/// The right and up axes of a view in a direction: right × up points to the viewer.
fn axes(away: DVec3) -> (DVec3, DVec3) {
    let (right, up) = away.any_orthonormal_pair();
    if right.cross(up).dot(away) > 0.0 { (right, -up) } else { (right, up) }
}

fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
}

fn bounds(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
}

/// Boxes around groups of nearby points.
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

fn corners_of(boxes: Vec<(DVec3, DVec3)>) -> Vec<DVec3> {
    boxes.into_iter().flat_map(corners_of_box).collect()
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

/// The settings of smoothies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Smoothies {
    /// Their width, metres; 0 for the width of the sun's penumbra.
    pub(super) width_m: f64,
    /// Whether their alpha is used without remapping.
    pub(super) linear: bool,
}

/// A light's view, around the scene's origin: parallel along the sun's rays, or a lamp's in perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LightView {
    /// Sun: w = 0; lamp: w = 1.
    light: DVec4,
    /// The direction of depth.
    away: DVec3,
    /// The map's axes: right × up points to the light.
    right: DVec3,
    up: DVec3,
    /// The rectangle on these axes, metres; for a lamp at a distance of one metre.
    low: DVec2,
    high: DVec2,
    /// The range of depth, metres: along the rays from the scene's origin, or from the lamp.
    near: f64,
    far: f64,
    /// The greatest depth of what is seen.
    farthest: f64,
}

impl LightView {
    /// The uniform for a map with `size` texels per side.
    pub(super) fn uniform(
        &self,
        extents: &Extents,
        size: u32,
        slope_bias: f32,
        smoothies: Smoothies,
    ) -> layout::MapUniforms {
        let &LightView { light, away, right, up, near, far, .. } = self;
        let border = (self.high - self.low) * (BORDER_TEXELS / (f64::from(size) - 2.0 * BORDER_TEXELS));
        let (low, high) = (self.low - border, self.high + border);
        let texel = (high - low) / f64::from(size);
        let lamp = light.truncate() * light.w;
        // a lamp's extent grows with depth, the sun's does not
        let row =
            |axis: DVec3, offset: f64| (axis + away * offset * light.w).extend(offset * (1.0 - light.w)).to_array();
        let depth = away.extend(-near * (1.0 - light.w));
        let w = away.extend(0.0) * light.w + DVec4::W * (1.0 - light.w);
        let rows = [
            row(right / texel.x, -low.x / texel.x),
            row(-up / texel.y, high.y / texel.y),
            depth.to_array(),
            w.to_array(),
        ];
        let from_local = DMat4::from_cols_array_2d(&rows).transpose() * DMat4::from_translation(-lamp);
        let reach = [low.abs(), high.abs()]
            .map(|ends| ends.max_element())
            .into_iter()
            .fold(near.abs().max(far.abs()), f64::max);
        let vector = |vector: DVec3| vector.extend(0.0).as_vec4().to_array();
        layout::MapUniforms {
            from_local: from_local.as_mat4().to_cols_array_2d(),
            across: vector(right * texel.x),
            along: vector(-up * texel.y),
            ground: self.ground(extents.ground_z, low, high, texel).map(|value| value as f32),
            texel: texel.as_vec2().to_array(),
            size: size as f32,
            range: (far - near * (1.0 - light.w)) as f32,
            near: (near * light.w) as f32,
            bias: (BIAS_M + 4.0 * f64::from(f32::EPSILON) * reach) as f32,
            slope_bias,
            spread: spread() as f32,
            width: smoothies.width_m as f32,
            linear: f32::from(u8::from(smoothies.linear)),
            farthest: (self.farthest - near * (1.0 - light.w)) as f32,
            unused: 0.0,
        }
    }

    /// The depth of the ground along a ray through the map, as a linear function of column and row, or its
    /// reciprocal's.
    fn ground(&self, ground_z: f64, low: DVec2, high: DVec2, texel: DVec2) -> [f64; 4] {
        let &LightView { light, away, right, up, near, .. } = self;
        let sum = [right.z * texel.x, -up.z * texel.y, right.z * low.x + up.z * high.y];
        if light.w > 0.0 {
            // a ray of one metre depth descends by the sum
            return [sum[0], sum[1], sum[2] + away.z, ground_z - light.z];
        }
        let rise = light.z.max(1e-4);
        [sum[0] / rise, sum[1] / rise, (sum[2] - ground_z) / rise - near, 0.0]
    }
}

/// How much nearer to the sun than a cell a texel must be to shade it, metres along the rays, besides rounding.
const BIAS_M: f64 = 0.0002;
