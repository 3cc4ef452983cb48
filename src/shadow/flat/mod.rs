//! Hard shadows on a plane, exactly and by edges alone. The casters are cut at the plane once; for every sun their
//! silhouette is projected onto it and summed along the rows of a raster.
//!
//! Each face is turned to the sun, so that it adds one to the cells that it covers; the sum is how many faces cover a
//! cell, and not 0 is shadow. A face's ones begin and end at its edges, and where faces meet that begin and end the same
//! ones nothing changes: only silhouette edges do, as often as their multiplicity says. It is the rule of shadow volumes
//! ([`crate::volume`]) in the plane, so casters need not be clean. The idea of running sums between edges is as old as
//! scan conversion (W. Jack Bouknight, *A procedure for generation of three-dimensional half-toned computer graphics
//! presentations*, 1970); nothing here is rounded but where a point falls, in double precision, and where an edge crosses
//! a row, to steps of 2⁻³⁰ columns ([`scan`]). What cannot reach the raster under a sun is left out ([`clumps`]), so that
//! an instant costs what stands before the sun there, and not what else there is.

mod casters;
mod clumps;
mod scan;

pub(super) use casters::where_cut;
pub(super) use clumps::{Clumps, Judged, RasterBounds};

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
    /// `raster_from_local` takes metres around the mesh's origin to columns, rows and the height above the plane.
    /// Centres of cells are whole numbers; what is not above the plane casts nothing on it. So many columns and rows
    /// are drawn, from the first ones on.
    pub(super) fn new(mesh: &Mesh, raster_from_local: DAffine3, first: [u32; 2], size: [u32; 2]) -> FlatShadow {
        let casters = Casters::cut(mesh, &raster_from_local);
        let scan = Scan::new(&casters, first, size);
        FlatShadow { raster_from_local, casters, scan }
    }

    /// Draws another part of the same raster.
    pub(super) fn turn_to(&mut self, first: [u32; 2], size: [u32; 2]) {
        self.scan = Scan::new(&self.casters, first, size);
    }

    /// Which cells are in shadow under a sun in front of the plane; the vector may have any length.
    ///
    /// A cell whose centre an edge meets takes what lies beyond the edge, in the direction of growing columns, then of
    /// growing rows.
    pub(super) fn draw(&mut self, to_sun: DVec3) -> &mut Bits {
        self.casters.project(to_sun, self.throw(to_sun), self.scan.bounds());
        self.scan.draw(&self.casters);
        if self.casters.has_far() && self.scan.is_lit() {
            self.casters.project_far(to_sun);
            self.scan.draw_further(&self.casters);
        }
        self.scan.bits()
    }

    /// As it was drawn last; and where the mesh's vertices stand, column, row and height, and its faces in clumps.
    pub(super) fn drawn(&mut self) -> (&mut Bits, &[DVec3], &Clumps) {
        let (points, clumps) = self.casters.standing();
        (self.scan.bits(), points, clumps)
    }

    /// Lets everything fall at every instant.
    #[cfg(feature = "test-hooks")]
    pub(super) fn stop_culling(&mut self) {
        self.casters.stop_culling();
    }

    /// Under the last sun: how many clumps reached, of how many, and how many rows their silhouette crossed.
    #[cfg(feature = "test-hooks")]
    pub(super) fn work(&self) -> [u64; 3] {
        [self.casters.reaching().len() as u64, self.casters.clumps() as u64, self.scan.rows_crossed()]
    }

    /// How many columns and rows away from the sun a shadow falls, a metre of height.
    pub(super) fn throw(&self, to_sun: DVec3) -> DVec2 {
        throw(&self.raster_from_local, to_sun)
    }
}

/// How many columns and rows away from the sun a shadow falls, a metre of height.
pub(super) fn throw(raster_from_local: &DAffine3, to_sun: DVec3) -> DVec2 {
    // the sun may be in the plane except for rounding
    let along = raster_from_local.transform_vector3(to_sun);
    along.truncate() / along.z.max(1e-9 * along.length())
}
