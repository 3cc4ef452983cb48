//! A slow, simple reference for projected shadows: each face is cut, projected and scan-converted separately.

use super::DVec3;
use glam::DVec2;
use gnomon::shadow::{JUDGED_ABOVE_M, Scene};
use gnomon::view::Grid;

/// The offset for a centre exactly on an edge, in cells: it belongs to the side to the east, then to the south.
const TIE: DVec2 = DVec2::new(1e-4, 1e-5);

/// The share of each cell: 0 if the faces cover its centre, seen along the sun, otherwise 255.
pub(crate) fn scanned(scene: &Scene, grid: &Grid, to_sun: DVec3) -> Vec<u8> {
    let mut raster = Raster { grid: *grid, share: vec![255; grid.cells()] };
    let throw = to_sun.truncate() / to_sun.z.max(1e-9);
    let scale = DVec2::new(1.0, -1.0) / grid.cell;
    for face in scene.casters.faces.iter() {
        let corners = face.map(|vertex| {
            let world = scene.casters.vertices[vertex as usize].as_dvec3() + scene.casters.origin;
            let height = world.z - (scene.ground + JUDGED_ABOVE_M);
            let at = (world.truncate() - throw * height - DVec2::new(grid.west, grid.north)) * scale;
            Place { at: at - 0.5 - TIE, height }
        });
        raster.cover_face(corners);
    }
    raster.share
}

/// A vertex seen along the sun.
#[derive(Clone, Copy)]
struct Place {
    /// Where it is projected to, in cells from the grid's north-west corner, such that centres are whole numbers.
    at: DVec2,
    /// How high above the judged height it stands, metres.
    height: f64,
}

struct Raster {
    grid: Grid,
    share: Vec<u8>,
}

impl Raster {
    /// Covers the cells under a face that is cut at the judged height: the part above it is a triangle or a
    /// quadrilateral.
    fn cover_face(&mut self, face: [Place; 3]) {
        let above = face.map(|place| place.height > 0.0);
        match above.iter().filter(|above| **above).count() {
            0 => {}
            3 => self.cover(face.map(|place| place.at)),
            count => {
                // turned so that the one that stands alone on its side is first
                let alone = (0..3).find(|&at| above[at] == (count == 1)).unwrap_or(0);
                let [one, next, last] = [face[alone], face[(alone + 1) % 3], face[(alone + 2) % 3]];
                let (to_next, to_last) = (cut(one, next), cut(one, last));
                if count == 1 {
                    self.cover([one.at, to_next, to_last]);
                } else {
                    self.cover([to_next, next.at, last.at]);
                    self.cover([to_next, last.at, to_last]);
                }
            }
        }
    }

    /// Covers all cells whose centres lie in a triangle or on its edge.
    fn cover(&mut self, mut corners: [DVec2; 3]) {
        corners.sort_unstable_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
        let [top, middle, bottom] = corners;
        // beyond the raster, or where it is no number
        let first = top.y.ceil().max(0.0);
        let last = bottom.y.floor().min(f64::from(self.grid.height) - 1.0);
        let (west, east) = (top.x.min(middle.x).min(bottom.x), top.x.max(middle.x).max(bottom.x));
        if !(first <= last && west.ceil().max(0.0) <= east.floor().min(f64::from(self.grid.width) - 1.0)) {
            return;
        }
        let [long, upper, lower] =
            [Side::between(top, bottom), Side::between(top, middle), Side::between(middle, bottom)];
        for row in first as i64..=last as i64 {
            let y = row as f64;
            // at the middle's height both short sides end
            let [one, other] = match (y <= middle.y, y >= middle.y) {
                (true, true) => [upper.x_at(y), lower.x_at(y)],
                (true, false) => [upper.x_at(y); 2],
                _ => [lower.x_at(y); 2],
            };
            let along = long.x_at(y);
            self.cover_row(row, along.min(one).min(other), along.max(one).max(other));
        }
    }

    /// Covers the cells of a row whose centres lie from one place to another.
    fn cover_row(&mut self, row: i64, from: f64, to: f64) {
        let width = self.grid.width as usize;
        let first = from.ceil().max(0.0);
        let last = to.floor().min(width as f64 - 1.0);
        if first <= last {
            self.share[row as usize * width..][first as usize..=last as usize].fill(0);
        }
    }
}

/// Where the line between two vertices crosses the judged height. The same whichever is named first.
fn cut(one: Place, other: Place) -> DVec2 {
    let (low, high) = if one.height < other.height { (one, other) } else { (other, one) };
    // projection is linear, below the judged height as well
    low.at + (high.at - low.at) * (-low.height / (high.height - low.height))
}

/// A triangle's side, from its upper to its lower end.
struct Side {
    start: DVec2,
    end: DVec2,
    /// Columns a row; not used where the side is level.
    slope: f64,
}

impl Side {
    fn between(start: DVec2, end: DVec2) -> Side {
        Side { start, end, slope: (end.x - start.x) / (end.y - start.y) }
    }

    /// Its column at a row between its ends.
    fn x_at(&self, y: f64) -> f64 {
        if y >= self.end.y { self.end.x } else { self.start.x + (y - self.start.y) * self.slope }
    }
}
