//! The synthetic town as a camera sees it, by the simplest ray casting.

use super::synthetic::corners;
use glam::DVec3;
use gnomon::mesh::Mesh;
use gnomon::view::{Camera, Mask, Surface};
use rayon::prelude::*;

/// What the camera sees, and what the sun sees of it.
pub(super) fn photograph(mesh: &Mesh, camera: &Camera, to_sun: DVec3) -> (Surface, Mask) {
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let tall = (0.5 * camera.fov_rad).tan();
    let seen: Vec<(u32, f32, u8)> = (0..camera.width * camera.height)
        .into_par_iter()
        .map(|pixel| {
            let (c, r) = (f64::from(pixel % camera.width), f64::from(pixel / camera.width));
            let ray = forward
                + right * (tall * w / h * (2.0 * (c + 0.5) / w - 1.0))
                + right.cross(forward) * (tall * (1.0 - 2.0 * (r + 0.5) / h));
            let (mut face, mut near) = hit(mesh, camera.eye, ray).unwrap_or((Surface::SKY, f64::INFINITY));
            let ground = -camera.eye.z / ray.z;
            if ground > 0.0 && ground < near {
                (face, near) = (Surface::GROUND, ground);
            }
            let point = camera.eye + ray * near.min(1e9);
            let away = match face {
                Surface::SKY => return (face, f32::NAN, 0),
                Surface::GROUND => false,
                face => mesh.planes()[face as usize].truncate().dot(to_sun) <= 0.0,
            };
            let lit = !away && hit(mesh, point + to_sun * 0.01, to_sun).is_none();
            (face, point.z as f32, if lit { 255 } else { 0 })
        })
        .collect();
    let (width, height) = (camera.width, camera.height);
    let surface = Surface {
        width,
        height,
        face: seen.iter().map(|s| s.0).collect(),
        height_m: seen.iter().map(|s| s.1).collect(),
    };
    (surface, Mask { width, height, share: seen.iter().map(|s| s.2).collect() })
}

fn hit(mesh: &Mesh, from: DVec3, ray: DVec3) -> Option<(u32, f64)> {
    let faces = 0..mesh.faces.len();
    let hits = faces.filter_map(|face| {
        let [a, b, c] = corners(mesh, face);
        let (u, v) = (b - a, c - a);
        let p = ray.cross(v);
        let det = u.dot(p);
        let s = (from - a).dot(p) / det;
        let q = (from - a).cross(u);
        let (t, far) = (ray.dot(q) / det, v.dot(q) / det);
        (det != 0.0 && s >= 0.0 && t >= 0.0 && s + t <= 1.0 && far > 1e-6).then_some((face as u32, far))
    });
    hits.min_by(|a, b| a.1.total_cmp(&b.1))
}
