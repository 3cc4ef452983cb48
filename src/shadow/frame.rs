//! A view's transform as shaders read it.

use super::{JUDGED_ABOVE_M, Scene};
use crate::gpu::layout;
use crate::view::{Camera, Elevation, View};
use glam::{DMat4, DVec3, DVec4};

/// The transform from metres around the scene's origin to clip space, with depth 1 near and 0 far.
pub(super) fn clip_from_local(scene: &Scene, view: &View) -> DMat4 {
    let to_world = DMat4::from_translation(scene.casters.origin);
    match view {
        View::Camera(camera) => camera.clip_from_world() * to_world,
        View::Elevation(side) => {
            let [right, up, _] = side.axes();
            let (low, high) = depths(scene, side);
            let half = side.half_size();
            let row = |axis: DVec3, half: f64, middle: f64| (axis / half).extend(-middle / half);
            let rows = [
                row(right, half.x, side.target.dot(right)),
                row(up, half.y, side.target.dot(up)),
                row(side.to_viewer, high - low, low),
                DVec4::W,
            ];
            DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose() * to_world
        }
        View::Plan(grid) => {
            let [west, south, east, north] = grid.region();
            let (low, high) = heights(scene);
            let span = DVec3::new((east - west) / 2.0, (north - south) / 2.0, high - low);
            let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, low);
            DMat4::from_scale(span.recip()) * DMat4::from_translation(-middle) * to_world
        }
    }
}

/// The range of heights of the plan's depth, metres of the world frame. Nothing is cut at the upper end, so counting in
/// front of what is seen is right; what is cut at the lower end is below the ground.
fn heights(scene: &Scene) -> (f64, f64) {
    let high = scene.casters.top().max(scene.receivers.top()).max(scene.ground);
    (scene.ground - 1.0, high + 1.0)
}

/// The range of depths of a side, metres towards the viewer.
fn depths(scene: &Scene, side: &Elevation) -> (f64, f64) {
    let (low, high) = scene.receivers.bounds().unwrap_or_default();
    let towards = side.to_viewer;
    let end =
        |nearest: DVec3, farthest: DVec3| DVec3::select(towards.cmpgt(DVec3::ZERO), nearest, farthest).dot(towards);
    (end(low, high) - 1.0, end(high, low) + 1.0)
}

pub(super) fn uniform(scene: &Scene, view: &View) -> layout::ViewUniforms {
    let origin = scene.casters.origin;
    let world_viewer = view.viewer();
    let viewer = world_viewer - DVec4::from((origin, 0.0)) * world_viewer.w;
    let (width, height) = view.size();
    let lowest_receiver = scene.receivers.bounds().map_or(scene.ground, |(low, _)| low.z.min(scene.ground));
    let ([right, up, forward], lowest, depth_scale) = match view {
        // the plan sees nothing below the ground, and no undersides
        View::Plan(_) => {
            let (low, high) = heights(scene);
            ([DVec3::X, DVec3::Y, DVec3::NEG_Z], scene.ground + JUDGED_ABOVE_M, 1.0 / (high - low))
        }
        View::Camera(camera) => {
            let [right, up, forward] = camera.axes();
            let half = camera.half_size();
            ([right * half.x, up * half.y, forward], lowest_receiver - JUDGED_ABOVE_M, Camera::NEAR_M)
        }
        View::Elevation(side) => {
            let [right, up, forward] = side.axes();
            let half = side.half_size();
            let (low, high) = depths(scene, side);
            ([right * half.x, up * half.y, forward], scene.ground + JUDGED_ABOVE_M, 1.0 / (high - low))
        }
    };
    let direction = |axis: DVec3| axis.extend(0.0).as_vec4().to_array();
    layout::ViewUniforms {
        clip_from_local: clip_from_local(scene, view).as_mat4().to_cols_array_2d(),
        viewer: viewer.as_vec4().to_array(),
        right: direction(right),
        up: direction(up),
        forward: direction(forward),
        ground_z: (scene.ground - origin.z) as f32,
        lowest_z: (lowest - origin.z) as f32,
        judged_above: JUDGED_ABOVE_M as f32,
        depth_scale: depth_scale as f32,
        size: [width as f32, height as f32],
        unused: [0.0; 2],
    }
}
