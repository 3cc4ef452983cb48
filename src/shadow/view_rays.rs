//! The rays along which a view's cells see: of a plan, a camera, a side, or the sun.

use super::Scene;
use crate::view::{Camera, Elevation, Grid, Lens, View};
use glam::{DVec2, DVec3};

/// The offset of a cell's ray, in cells, for edges that run exactly through its centre: it sees what is east of the
/// edge, or south of an edge that runs from west to east. This is the rasterisers' top-left rule, so that models whose
/// walls are on whole cells give the same plan on every machine. A ten-thousandth is just larger than the rounding of
/// corners.
pub(super) const TIE: DVec2 = DVec2::new(1e-4, -1e-5);

/// The rays of a view's cells.
pub(super) struct Rays {
    pub(super) view: View,
    /// The first column and row of the part that is drawn.
    first: [u32; 2],
    /// The scene's origin.
    origin: DVec3,
    start: RayStart,
}

/// Where rays start.
enum RayStart {
    /// A height above everything, in the world frame, from which the plan looks down.
    Above(Grid, f64),
    /// A camera's eye; its rays begin at the near plane.
    Eye(DVec3, Lens),
    /// The distance in front of a side's plane from which everything lies behind it.
    Before(Elevation, f64),
}

impl Rays {
    pub(super) fn new(scene: &Scene, view: View) -> Rays {
        let start = match view {
            View::Plan(grid) => RayStart::Above(grid, scene.receivers.top().max(scene.ground) + 1.0),
            View::Camera(camera) => RayStart::Eye(camera.eye, camera.lens()),
            View::Elevation(side) => {
                let (low, high) = scene.receivers.bounds().unwrap_or_default();
                RayStart::Before(side, away(&side, (low, high)))
            }
        };
        Rays { view, first: [0, 0], origin: scene.casters.origin, start }
    }

    /// The rays of the part that begins at this column and row.
    pub(super) fn of_part(scene: &Scene, view: View, first: [u32; 2]) -> Rays {
        Rays { first, ..Rays::new(scene, view) }
    }

    /// Whether what is seen of the ground there is cut earth.
    #[inline(always)]
    pub(super) fn is_cut(&self, distance: f64) -> bool {
        distance == 0.0 && matches!(self.view, View::Elevation(side) if side.is_level())
    }

    /// The direction of all rays, if they are parallel.
    pub(super) fn shared_direction(&self) -> Option<DVec3> {
        match &self.start {
            RayStart::Above(..) => Some(DVec3::NEG_Z),
            RayStart::Eye(..) => None,
            RayStart::Before(side, _) => Some(-side.to_viewer),
        }
    }

    /// A cell's ray: its start relative to the scene's origin, and its unit direction.
    #[inline(always)]
    pub(super) fn of(&self, column: u32, row: u32) -> (DVec3, DVec3) {
        let (column, row) = (self.first[0] + column, self.first[1] + row);
        match &self.start {
            RayStart::Above(grid, top) => {
                let at = grid.centre(column, row) + TIE * grid.cell;
                (at.extend(*top) - self.origin, DVec3::NEG_Z)
            }
            RayStart::Eye(eye, lens) => {
                let direction = lens.direction(column, row);
                let near = direction * (Camera::NEAR_M / direction.dot(lens.forward()));
                (*eye + near - self.origin, direction)
            }
            RayStart::Before(side, away) => {
                (side.centre(column, row) + side.to_viewer * *away - self.origin, -side.to_viewer)
            }
        }
    }
}

/// The distance in front of its plane at which a view along parallel rays starts, metres: in front of a box.
fn away(side: &Elevation, (low, high): (DVec3, DVec3)) -> f64 {
    let nearest = DVec3::select(side.to_viewer.cmpgt(DVec3::ZERO), high, low);
    (nearest - side.target).dot(side.to_viewer) + 1.0
}

/// The distance from the origin at which rays start, metres.
pub(super) fn reach(scene: &Scene, view: &View) -> f64 {
    let farthest = match view {
        View::Plan(grid) => {
            let [west, south, east, north] = grid.region();
            DVec3::new(west.abs().max(east.abs()), south.abs().max(north.abs()), scene.ground.abs())
        }
        View::Camera(camera) => camera.eye.abs(),
        View::Elevation(side) => {
            let (low, high) = scene.receivers.bounds().unwrap_or_default();
            let half = side.half_size();
            if side.is_level() {
                (side.target.abs() + half.max_element()).max(low.abs()).max(high.abs()) + 1.0
            } else {
                side.target.abs() + half.length() + away(side, (low, high)).abs()
            }
        }
    };
    (farthest + scene.casters.origin.abs()).max_element()
}
