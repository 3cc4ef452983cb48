//! What is at a point of the picture, and the extent of the models.

use crate::desktop::state::project::Project;
use crate::view::{Surface, View};
use eframe::egui::{self, Rect};
use glam::DVec3;

/// What is under the pointer.
#[derive(Clone, Debug)]
pub(in crate::desktop) struct PickedPoint {
    /// Metres in the world frame.
    pub(in crate::desktop) point: DVec3,
    /// The unit normal of its surface, on the visible side.
    pub(in crate::desktop) normal: DVec3,
    /// The index among the faces that receive, hidden ones included; `None` on the ground.
    pub(in crate::desktop) face: Option<u32>,
    /// The component's name, or that of the ground.
    pub(in crate::desktop) name: String,
}

/// The dome on which the sun's path is drawn: around the models, on the ground.
#[derive(Clone, Copy)]
pub(in crate::desktop) struct Dome {
    /// Its middle, metres.
    pub(in crate::desktop) centre: DVec3,
    pub(in crate::desktop) radius: f64,
}

impl Dome {
    pub(in crate::desktop) fn at(&self, to_sun: DVec3) -> DVec3 {
        self.centre + to_sun * self.radius
    }
}

/// The dome around the models.
pub(in crate::desktop) fn dome(project: &Project) -> Dome {
    let (low, high) = project.site.mesh.bounds_at_home().unwrap_or((DVec3::ZERO, DVec3::ONE));
    let centre = (low + high) / 2.0;
    let radius = (high - low).truncate().length() / 2.0;
    Dome {
        centre: centre.truncate().extend(project.site.ground.level),
        radius: (radius * 0.9).max(high.z - low.z).max(1.0),
    }
}

/// What is at a position in the picture.
pub(in crate::desktop) fn under(
    project: &Project,
    view: &View,
    rect: Rect,
    pointer: egui::Pos2,
) -> Option<PickedPoint> {
    let (mesh, rays) = &*project.seen;
    let at = (pointer - rect.min) / rect.size();
    let (x, y) = (f64::from(at.x), f64::from(at.y));
    let top = mesh.top().max(project.site.ground.level) + 1.0;
    let (from, along) = match view {
        View::Plan(grid) => {
            let east = grid.west + x * (grid.east() - grid.west);
            let north = grid.north - y * (grid.north - grid.south());
            (DVec3::new(east, north, top), DVec3::NEG_Z)
        }
        View::Camera(camera) => {
            let [right, up, forward] = camera.axes();
            let half = camera.half_size();
            let along = forward + right * (half.x * (x * 2.0 - 1.0)) + up * (half.y * (1.0 - y * 2.0));
            (camera.eye, along.normalize())
        }
        View::Elevation(side) => {
            let ([right, up, forward], half) = (side.axes(), side.half_size());
            let at = side.target + right * (half.x * (x * 2.0 - 1.0)) + up * (half.y * (1.0 - y * 2.0));
            let dome = dome(project);
            // in front of everything
            let away = (dome.centre - at).dot(side.to_viewer) + dome.radius * 4.0;
            (at + side.to_viewer * away, forward)
        }
    };
    let hit = rays.first_hit(from - mesh.origin, along);
    let ground = (project.site.ground.level - from.z) / along.z;
    let ground = Some(ground).filter(|distance| *distance > 0.0 && distance.is_finite());
    let (nearest, distance) = match hit {
        Some((face, distance)) if ground.is_none_or(|ground| distance <= ground) => (face, distance),
        _ => (Surface::GROUND, ground?),
    };
    // as pictures show it
    let face = project.flush.as_ref().map_or(nearest, |flush| flush.seen(nearest, (from - mesh.origin, along)));
    let point = from + along * distance;
    if face == Surface::GROUND {
        return Some(PickedPoint { point, normal: DVec3::Z, face: None, name: "ground".to_owned() });
    }
    let plane = mesh.planes()[face as usize].truncate();
    let normal = if plane.dot(along) > 0.0 { -plane } else { plane };
    let component = mesh.components.partition_point(|component| component.faces.end <= face);
    let name = mesh.components.get(component)?.name.clone();
    Some(PickedPoint { point, normal, face: Some(among_receivers(project, face)), name })
}

/// Converts the index of a visible face to that among the faces that receive.
fn among_receivers(project: &Project, face: u32) -> u32 {
    let Project { site, visible, .. } = project;
    let (mut passed, mut hidden) = (0, 0);
    let roles = site.receives.iter().zip(&visible.receives);
    for (component, (receives, visible)) in site.mesh.components.iter().zip(roles) {
        match (receives, visible) {
            (_, true) => passed += component.faces.len() as u32,
            (true, false) => hidden += component.faces.len() as u32,
            (false, false) => {}
        }
        if face < passed {
            break;
        }
    }
    face + hidden
}
