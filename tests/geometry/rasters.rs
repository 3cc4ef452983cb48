//! Rays from the cells of rasters, which are decided in rectangles, give the same results as the plain caster, with each
//! instruction set that the machine has.

use super::part;
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::rays::{BlockedCells, CellSet, PlainCaster, RasterFate, RayCaster, RayRaster, Shear, SimdLevel};
use std::collections::BTreeSet;

fn block(low: DVec3, high: DVec3) -> Part {
    let corner = |at: u32| {
        let pick = |bit: u32, axis: usize| if at >> bit & 1 == 1 { high[axis] } else { low[axis] };
        dvec3(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    part((0..8).map(corner).collect(), quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// Houses in a square, a wall that shades many of them, a lattice, and a slab on which they stand.
fn quarter() -> Mesh {
    let mut parts = vec![
        block(dvec3(-5.0, -5.0, -1.0), dvec3(60.0, 60.0, 0.0)),
        block(dvec3(-4.0, -4.0, 0.0), dvec3(55.0, -3.5, 40.0)),
    ];
    for (x, y) in (0..6).flat_map(|x| (0..6).map(move |y| (x, y))) {
        let low = dvec3(f64::from(x) * 9.0, f64::from(y) * 9.0, 0.0);
        parts.push(block(low, low + dvec3(5.0, 4.0, 3.0 + f64::from((x * 5 + y * 3) % 7))));
    }
    parts.extend((0..80).map(|at| {
        let low = dvec3(f64::from(at) * 0.5, 57.0, 0.0);
        block(low, low + dvec3(0.1, 0.1, 12.0))
    }));
    Mesh::build(parts).unwrap()
}

/// A raster: its corner, the steps along its rows and columns, and its size.
#[derive(Clone, Copy)]
struct Cells {
    corner: DVec3,
    steps: [DVec3; 2],
    size: [u32; 2],
}

impl Cells {
    /// A millimetre above the plane of its corner.
    fn origin(&self, column: u32, row: u32) -> DVec3 {
        let [right, down] = self.steps;
        let normal = self.normal();
        self.corner + right * (f64::from(column) + 0.5) + down * (f64::from(row) + 0.5) + normal * 0.001
    }

    fn normal(&self) -> DVec3 {
        self.steps[1].cross(self.steps[0]).normalize()
    }
}

/// Compares a raster with the plain caster. Returns its fate, and how many rays were tested by themselves.
fn agree(mesh: &Mesh, cells: Cells, asked: Option<&CellSet>, to_sun: DVec3) -> (RasterFate, u64) {
    let plain = PlainCaster::new(mesh, 200.0);
    let origin = |column, row| cells.origin(column, row) - mesh.origin;
    let normal = cells.normal();
    let plane = normal.extend(-normal.dot(origin(0, 0)));
    assert!(normal.dot(to_sun) > 0.0);
    let mut found = Vec::new();
    for level in SimdLevel::all() {
        let caster = RayCaster::new(mesh, 200.0).on(level);
        let raster = RayRaster { size: cells.size, plane, origin, asked };
        let mut blocked = BlockedCells::default();
        // the second time it begins with what blocked the last rays
        for _ in 0..2 {
            let (fate, rays) = caster.blocked_raster(&raster, &Shear::along(to_sun), &mut blocked);
            for (column, row) in (0..cells.size[1]).flat_map(|row| (0..cells.size[0]).map(move |column| (column, row)))
            {
                if asked.is_none_or(|asked| asked.has(column, row)) {
                    let said = match fate {
                        RasterFate::Open => false,
                        RasterFate::Blocked => true,
                        RasterFate::Mixed => blocked.cells().has(column, row),
                    };
                    let expected = plain.blocked(origin(column, row), to_sun);
                    assert_eq!(said, expected, "{level:?}: column {column}, row {row}, to {to_sun}");
                }
            }
            found.push((fate, rays));
        }
    }
    found[0]
}

const SUNS: [DVec3; 5] = [
    dvec3(0.31, -0.55, 0.77),
    dvec3(0.02, -0.9, 0.2),
    dvec3(0.6, -0.01, 0.1),
    dvec3(0.1, -0.1, 1.0),
    dvec3(0.9, -0.4, 0.004),
];

#[test]
fn rasters_on_the_ground_on_roofs_and_on_walls() {
    let mesh = quarter();
    let mut fates = BTreeSet::new();
    let (mut rays, mut cells) = (0, 0);
    for to_sun in SUNS {
        for size in [[1, 1], [8, 8], [9, 3], [3, 40], [70, 65], [130, 8]] {
            let ground = |x: f64, y: f64, z: f64| Cells {
                corner: dvec3(x, y, z),
                steps: [DVec3::X * 0.25, DVec3::NEG_Y * 0.25],
                size,
            };
            let wall = |x: f64, y: f64| Cells {
                corner: dvec3(x, y, 2.5),
                steps: [DVec3::X * 0.05, DVec3::NEG_Z * 0.05],
                size: [size[0].min(90), size[1].min(50)],
            };
            let on_edges = Cells { corner: dvec3(-0.125, 22.125, 0.0), ..ground(0.0, 0.0, 0.0) };
            for place in
                [ground(1.0, 22.0, 0.0), ground(40.0, 40.0, 30.0), ground(3.0, 56.0, 0.0), on_edges, wall(18.0, 18.0)]
            {
                let (fate, asked) = agree(&mesh, place, None, to_sun);
                fates.insert(format!("{fate:?}"));
                rays += asked;
                cells += u64::from(place.size[0]) * u64::from(place.size[1]);
            }
        }
    }
    assert_eq!(fates.len(), 3, "{fates:?}");
    assert!(rays > 1000 && rays * 2 < cells, "{rays} rays for {cells} cells");
}

#[test]
fn cells_that_are_not_asked_cost_no_ray() {
    let mesh = quarter();
    let cells = Cells { corner: dvec3(1.0, 22.0, 0.0), steps: [DVec3::X * 0.25, DVec3::NEG_Y * 0.25], size: [61, 75] };
    let mut asked = CellSet::default();
    asked.reset(61, 75);
    let mut count = 0;
    for (column, row) in (0..75).flat_map(|row| (0..61).map(move |column| (column, row))) {
        // a triangle, and one cell far from it
        if column + row < 40 || (column, row) == (60, 74) {
            asked.add(column, row);
            count += 1;
        }
    }
    let mut most = 0;
    for to_sun in SUNS {
        let (_, rays) = agree(&mesh, cells, Some(&asked), to_sun);
        assert!(rays <= count, "{rays} rays for {count} cells");
        most = most.max(rays);
    }
    assert!(most > 0);
}

#[test]
fn a_face_in_the_plane_of_the_raster_never_shades_it() {
    // the raster's own face, and one that is as far above the plane as rays begin below it
    let sheet = |z: f64| {
        let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)].map(|(x, y)| dvec3(x, y, z));
        part(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
    };
    let cells = Cells { corner: dvec3(0.0, 40.0, 0.0), steps: [DVec3::X, DVec3::NEG_Y], size: [40, 40] };
    for (above, expected) in [(0.0, RasterFate::Open), (0.002, RasterFate::Blocked)] {
        let mesh = Mesh::build(vec![sheet(0.0), sheet(above)]).unwrap();
        let (fate, _) = agree(&mesh, cells, None, dvec3(0.0003, -0.0002, 1.0));
        assert!(fate == expected || fate == RasterFate::Mixed, "{fate:?} for {above}");
    }
}
