//! Converts many points of a map to the site's frame.

use super::{Crs, CrsKind, LocalFrame};
use glam::DVec3;
use rayon::prelude::*;

/// Up to this many points are converted exactly. For more, a lattice of exact conversions is computed and interpolated.
const MOST_EXACT: usize = 100_000;

/// The side of a lattice's cell, metres (degrees for maps in degrees). A projection's third derivative of about 1/R²
/// per metre makes an error of less than a tenth of a millimetre at latitudes below 85°.
const CELL_M: f64 = 500.0;
const CELL_DEG: f64 = 0.004;

/// The conversion from a map to a place's frame.
#[derive(Clone, Copy, Debug)]
pub struct MapToLocal<'a> {
    /// The map's system.
    pub crs: &'a Crs,
    /// The place's frame.
    pub frame: &'a LocalFrame,
}

impl MapToLocal<'_> {
    /// Converts a point of the map, in the units of [`Crs::to_wgs84`].
    pub fn point(&self, at: DVec3) -> Option<DVec3> {
        self.frame.point(self.crs.to_wgs84(at)?)
    }

    /// Converts many points in place.
    ///
    /// # Errors
    /// The index of the first point that is outside of the map or too far away. That point is unchanged, and the others
    /// are undefined.
    pub fn convert(&self, points: &mut [DVec3]) -> Result<(), usize> {
        if points.len() > MOST_EXACT
            && self.crs.kind() != CrsKind::EarthCentred
            && let Some(lattice) = Lattice::over(self, points)
        {
            points.par_iter_mut().for_each(|point| *point = lattice.at(*point));
            return Ok(());
        }
        let failed = points.par_iter_mut().enumerate().filter_map(|(index, point)| match self.point(*point) {
            Some(local) => {
                *point = local;
                None
            }
            None => Some(index),
        });
        failed.min().map_or(Ok(()), Err)
    }
}

/// Exact conversions at the nodes of square cells, nine per cell. Between them parabolas along both axes interpolate.
struct Lattice {
    low: [f64; 2],
    /// The distance between nodes: half a cell.
    step: f64,
    /// The number of cells along x and y.
    cells: [usize; 2],
    /// Row by row, for height 0.
    nodes: Vec<DVec3>,
}

impl Lattice {
    /// A lattice over all points; `None` if it would take as long as the points themselves, or leaves the map.
    fn over(to: &MapToLocal, points: &[DVec3]) -> Option<Lattice> {
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let wider = |(low, high): (DVec3, DVec3), at: &DVec3| (low.min(*at), high.max(*at));
        if !points.par_iter().all(|point| point.is_finite()) {
            return None;
        }
        let both = |one: (DVec3, DVec3), other: (DVec3, DVec3)| (one.0.min(other.0), one.1.max(other.1));
        let (low, high) = points.par_iter().fold(|| none, wider).reduce(|| none, both);
        let cell = match to.crs.kind() {
            CrsKind::Geographic => CELL_DEG,
            _ => CELL_M / to.crs.unit_m(),
        };
        let count = |size: f64| (size / cell).floor() + 1.0;
        let cells = [count(high.x - low.x), count(high.y - low.y)];
        let nodes = (2.0 * cells[0] + 1.0) * (2.0 * cells[1] + 1.0);
        if nodes >= points.len() as f64 / 4.0 {
            return None;
        }
        let cells = cells.map(|count| count as usize);
        let (width, height, step) = (2 * cells[0] + 1, 2 * cells[1] + 1, cell / 2.0);
        let node = |index: usize| {
            let (column, row) = ((index % width) as f64, (index / width) as f64);
            to.point(DVec3::new(low.x + column * step, low.y + row * step, 0.0))
        };
        let nodes = (0..width * height).into_par_iter().map(node).collect::<Option<Vec<_>>>()?;
        Some(Lattice { low: [low.x, low.y], step, cells, nodes })
    }

    /// Interpolates a point, which keeps its height above the place.
    fn at(&self, point: DVec3) -> DVec3 {
        let along = |axis: usize, value: f64| {
            let cell = ((value - self.low[axis]) / (2.0 * self.step)).floor().clamp(0.0, (self.cells[axis] - 1) as f64);
            let t = (value - self.low[axis]) / self.step - 2.0 * cell;
            // Lagrange's parabolas through 0, 1 and 2
            (2 * cell as usize, [(t - 1.0) * (t - 2.0) / 2.0, t * (2.0 - t), t * (t - 1.0) / 2.0])
        };
        let (column, across) = along(0, point.x);
        let (row, up) = along(1, point.y);
        let width = 2 * self.cells[0] + 1;
        let mut sum = DVec3::ZERO;
        for (rows, weight) in up.iter().enumerate() {
            for (columns, other) in across.iter().enumerate() {
                sum += self.nodes[(row + rows) * width + column + columns] * (weight * other);
            }
        }
        DVec3::new(sum.x, sum.y, point.z + sum.z)
    }
}
