//! How high the ground lies below points, and which points lie below it.

use crate::mesh::Mesh;
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::ray_cast::RayCaster;
use crate::site::{Ground, GroundKind};
use crate::sunlight::JudgedPoint;
use glam::DVec3;

/// The ground, as points are judged above it.
pub(crate) struct GroundHeights {
    level: f64,
    terrain: Option<SeenTerrain>,
}

/// The terrain, seen from above.
struct SeenTerrain {
    rays: RayCaster,
    origin: DVec3,
    /// Above all of it, metres.
    top: f64,
}

impl GroundHeights {
    /// For points of the world near these.
    pub(crate) fn of(mesh: &Mesh, ground: &Ground, points: &[DVec3]) -> GroundHeights {
        let is_terrain: Vec<bool> = match ground.kind {
            GroundKind::Plane => Vec::new(),
            GroundKind::Terrain => mesh.components.iter().map(|component| component.is_terrain).collect(),
        };
        let terrain = mesh.of_components(&is_terrain);
        let (top, origin) = (terrain.top() + 1.0, terrain.origin);
        let reach = points.iter().map(|point| (point.with_z(top) - origin).abs().max_element()).fold(0.0, f64::max);
        let terrain =
            (!terrain.faces.is_empty()).then(|| SeenTerrain { rays: RayCaster::new(&terrain, reach), origin, top });
        GroundHeights { level: ground.level, terrain }
    }

    /// A plane alone, for points that are judged already.
    pub(super) fn plane(level: f64) -> GroundHeights {
        GroundHeights { level, terrain: None }
    }

    /// The terrain's height below a point, where it is not hidden by the plane above it.
    fn terrain_at(&self, point: DVec3) -> Option<f64> {
        let SeenTerrain { rays, origin, top } = self.terrain.as_ref()?;
        let (_, below) = rays.first_hit(point.with_z(*top) - origin, DVec3::NEG_Z)?;
        Some(top - below).filter(|height| *height >= self.level)
    }

    /// The ground's height below a point: the terrain's, or beside it the plane's.
    pub(crate) fn height(&self, point: DVec3) -> f64 {
        self.terrain_at(point).unwrap_or(self.level)
    }

    /// Where a point is judged: one on the terrain, as exactly as its heights are, a millimetre above it, as all receivers
    /// are.
    pub(super) fn judge(&self, point: DVec3, normal: Option<DVec3>) -> JudgedPoint {
        match self.terrain_at(point) {
            Some(height) if (point.z - height).abs() <= JUDGED_ABOVE_M => {
                JudgedPoint { point: point.with_z(height + JUDGED_ABOVE_M), normal, below_ground_m: None }
            }
            height => {
                let below = height.unwrap_or(self.level) - point.z;
                JudgedPoint { point, normal, below_ground_m: Some(below).filter(|below| *below > 0.0) }
            }
        }
    }
}
