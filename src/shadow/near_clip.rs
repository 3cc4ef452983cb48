//! Whether a camera's near plane may cut a shadow volume: the test with the near-clip volume of *Geometry of Real Time
//! Shadows*, section 7.

use super::Scene;
use crate::mesh::Mesh;
use crate::view::Camera;
use glam::DVec3;

/// Whether z-pass may be wrong for a camera: the near plane may cut a volume, or the near rectangle is not wholly above
/// the ground, so that a ray may start below the walls' lower end or go there.
pub(super) fn needs_z_fail(camera: &Camera, to_sun: DVec3, scene: &Scene) -> bool {
    near_rectangle(camera).iter().any(|corner| corner.z < scene.ground)
        || near_clip_volume_touched(camera, to_sun, &scene.casters)
}

/// The corners of the camera's near rectangle in the world frame.
fn near_rectangle(camera: &Camera) -> [DVec3; 4] {
    let [right, up, forward] = camera.axes();
    let half = camera.half_size();
    let corner = |x: f64, y: f64| camera.eye + (forward + right * half.x * x + up * half.y * y) * Camera::NEAR_M;
    [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
}

/// Whether a caster may extend into the near-clip volume, the near rectangle swept towards the sun. Casters are
/// approximated by their components' boxes, so the result is conservative: it may be `true` unnecessarily, but is never
/// wrongly `false`.
pub fn near_clip_volume_touched(camera: &Camera, to_sun: DVec3, casters: &Mesh) -> bool {
    let forward = camera.axes()[2];
    let middle = camera.eye + forward * Camera::NEAR_M;
    let rectangle = near_rectangle(camera);
    // planes with the outside in front: four sides, and the rectangle itself on the side away from the sun
    let mut planes = Vec::from([forward * -forward.dot(to_sun).signum()].map(|normal| (normal, middle)));
    for index in 0..4 {
        let (from, to) = (rectangle[index], rectangle[(index + 1) % 4]);
        let normal = (to - from).cross(to_sun);
        let outward = if normal.dot(middle - from) > 0.0 { -normal } else { normal };
        planes.push((outward, from));
    }
    casters.components.iter().any(|component| {
        let Some((low, high)) = casters.bounds_of(component.faces.clone()) else { return false };
        // if the innermost corner is outside, so is the box
        let outside = |&(normal, point): &(DVec3, DVec3)| {
            let inmost = DVec3::select(normal.cmpgt(DVec3::ZERO), low, high);
            normal.dot(inmost - point) > 0.0
        };
        !planes.iter().any(outside)
    })
}
