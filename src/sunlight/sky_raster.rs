//! What stands in front of a point in each direction of its sky: one ray for each cell of a picture of the sky.

use super::JudgedPoint;
use crate::mesh::Mesh;
use crate::shadow::ray_cast::RayCaster;
use crate::view::SkyPicture;
use glam::DVec2;
use rayon::prelude::*;

/// What a direction of the sky meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SkyCell {
    /// Nothing: a sun there is seen. Also for cells outside of the picture's disc.
    Free,
    /// The point's own plane: the direction is behind it, or in it.
    Behind,
    /// The ground: the point lies below it.
    Ground,
    /// The nearest component that casts, by its index in [`super::Sunlight::components`].
    Component(u32),
}

/// What stands in front of a point.
#[derive(Clone, Debug)]
pub struct SkyRaster {
    /// The picture that the cells fill.
    pub picture: SkyPicture,
    /// The cells, row 0 first, each found at its centre.
    pub cells: Vec<SkyCell>,
}

/// The search for the skies of points.
pub struct SkyCaster {
    casters: Mesh,
    rays: RayCaster,
}

impl SkyCaster {
    /// A search for points that are judged there.
    pub fn new(casters: Mesh, points: &[JudgedPoint]) -> SkyCaster {
        let reach = points.iter().map(|at| (at.point - casters.origin).abs().max_element());
        let rays = RayCaster::new(&casters, reach.fold(0.0, f64::max));
        SkyCaster { casters, rays }
    }

    /// The sky of a point.
    pub fn raster(&self, at: &JudgedPoint, picture: SkyPicture) -> SkyRaster {
        let width = picture.width as usize;
        let mut cells = vec![SkyCell::Free; width * picture.height as usize];
        let rows = cells.par_chunks_mut(width.max(1)).enumerate();
        rows.for_each(|(row, cells)| {
            for (column, cell) in cells.iter_mut().enumerate() {
                *cell = self.cell(at, &picture, DVec2::new(column as f64 + 0.5, row as f64 + 0.5));
            }
        });
        SkyRaster { picture, cells }
    }

    fn cell(&self, at: &JudgedPoint, picture: &SkyPicture, place: DVec2) -> SkyCell {
        let Some(to) = picture.direction(place) else { return SkyCell::Free };
        if at.normal.is_some_and(|normal| normal.dot(to) <= 0.0) {
            return SkyCell::Behind;
        }
        if at.below_ground_m.is_some() {
            return SkyCell::Ground;
        }
        let Some((face, _)) = self.rays.first_hit(at.point - self.casters.origin, to) else { return SkyCell::Free };
        SkyCell::Component(self.casters.components.partition_point(|component| component.faces.end <= face) as u32)
    }
}
