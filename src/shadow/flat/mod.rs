//! Hard shadows on a plane, exact, from edges alone. The casters are cut at the plane once; for every sun, their
//! silhouette is projected onto it and summed along the rows of a raster.
//!
//! Each face is turned to the sun, so that it adds one to the cells that it covers. The sum is the number of faces that
//! cover a cell; if it is not 0, the cell is in shadow. Along a row, a face's contribution begins and ends at its
//! edges, and cancels at edges between faces where one ends as the other begins. Only silhouette edges change the sum,
//! by their multiplicity. This is the rule of shadow volumes ([`crate::volume`]) in the plane, so casters need not be
//! clean. Running sums between edges are as old as scan conversion (W. Jack Bouknight, *A procedure for generation of
//! three-dimensional half-toned computer graphics presentations*, 1970). The only rounding is in projected points, in
//! double precision, and in the positions where edges cross rows, to steps of 2⁻³⁰ columns ([`scan`]). What cannot
//! reach the raster under a sun is skipped ([`clumps`]), so the cost of an instant depends only on what is between the
//! sun and the raster.

mod casters;
mod clumps;
mod edges;
mod scan;

pub(super) use casters::where_cut;
pub(super) use clumps::{Clumps, JudgedCells, RasterBounds};

use crate::mesh::Mesh;
use crate::view::Bits;
use casters::Casters;
use glam::{DAffine3, DVec2, DVec3};
use scan::Scan;

/// The shadow of one mesh on one plane.
pub(super) struct FlatShadow {
    raster_from_local: DAffine3,
    casters: Casters,
    scan: Scan,
}

impl FlatShadow {
    /// `raster_from_local` transforms metres around the mesh's origin to columns, rows and height above the plane.
    /// Centres of cells are whole numbers; nothing below the plane casts on it. Draws `size` columns and rows from
    /// `first` on.
    pub(super) fn new(mesh: &Mesh, raster_from_local: DAffine3, first: [u32; 2], size: [u32; 2]) -> FlatShadow {
        let casters = Casters::cut(mesh, &raster_from_local);
        let scan = Scan::new(&casters, first, size);
        FlatShadow { raster_from_local, casters, scan }
    }

    /// Draws another part of the same raster.
    pub(super) fn turn_to(&mut self, first: [u32; 2], size: [u32; 2]) {
        self.scan = Scan::new(&self.casters, first, size);
    }

    /// Returns the cells in shadow under a sun in front of the plane; the vector may have any length.
    ///
    /// A cell whose centre is on an edge belongs to the side of growing columns, then of growing rows.
    pub(super) fn draw(&mut self, to_sun: DVec3) -> &mut Bits {
        self.casters.project(to_sun, self.throw(to_sun), self.scan.bounds());
        self.scan.draw(&self.casters);
        if self.casters.has_far() && self.scan.is_lit() {
            self.casters.project_far(to_sun);
            self.scan.draw_further(&self.casters);
        }
        self.scan.bits()
    }

    /// The last result; the mesh's vertices as column, row and height; and its faces in clumps.
    pub(super) fn drawn(&mut self) -> (&mut Bits, &[DVec3], &Clumps) {
        let (points, clumps) = self.casters.standing();
        (self.scan.bits(), points, clumps)
    }

    /// Projects everything at every instant.
    #[cfg(feature = "test-hooks")]
    pub(super) fn stop_culling(&mut self) {
        self.casters.stop_culling();
    }

    /// For the last sun: the clumps that reached, all clumps, and the rows that the silhouette crossed.
    #[cfg(feature = "test-hooks")]
    pub(super) fn work(&self) -> [u64; 3] {
        [self.casters.reaching().len() as u64, self.casters.clumps() as u64, self.scan.rows_crossed()]
    }

    /// The columns and rows that a shadow falls away from the sun, per metre of height.
    pub(super) fn throw(&self, to_sun: DVec3) -> DVec2 {
        throw(&self.raster_from_local, to_sun)
    }
}

/// The columns and rows that a shadow falls away from the sun, per metre of height.
pub(super) fn throw(raster_from_local: &DAffine3, to_sun: DVec3) -> DVec2 {
    // the sun may be below the plane by rounding
    let along = raster_from_local.transform_vector3(to_sun);
    along.truncate() / along.z.max(1e-9 * along.length())
}
