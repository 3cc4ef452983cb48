//! A finely curved dome of 200,000 triangles without coplanar ones: many edges, few of them silhouettes.

use glam::dvec3;
use gnomon::mesh::Part;
use std::f64::consts::{FRAC_PI_2, TAU};

/// An oblate dome of 60 × 48 × 31 m, closed by a floor; rows lie staggered so that no four corners make a flat.
pub(crate) fn dome() -> Part {
    const AROUND: u32 = 400;
    const ROWS: u32 = 250;
    let mut positions = Vec::new();
    for row in 0..ROWS {
        let height = FRAC_PI_2 * f64::from(row) / f64::from(ROWS);
        for column in 0..AROUND {
            let turn = TAU * (f64::from(column) + 0.5 * f64::from(row % 2)) / f64::from(AROUND);
            positions.push(dvec3(
                30.0 * turn.cos() * height.cos(),
                24.0 * turn.sin() * height.cos(),
                31.0 * height.sin(),
            ));
        }
    }
    let (top, floor) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([dvec3(0.0, 0.0, 31.0), dvec3(0.0, 0.0, 0.0)]);
    let mut triangles = Vec::new();
    for column in 0..AROUND {
        let next = (column + 1) % AROUND;
        triangles.push([floor, next, column]);
        let last = (ROWS - 1) * AROUND;
        triangles.push([last + column, last + next, top]);
        for row in 0..ROWS - 1 {
            let [low, low_next] = [column, next].map(|column| row * AROUND + column);
            let [high, high_next] = [low + AROUND, low_next + AROUND];
            // an odd row lies half a step on
            if row % 2 == 0 {
                triangles.extend([[low, low_next, high], [low_next, high_next, high]]);
            } else {
                triangles.extend([[low, low_next, high_next], [low, high_next, high]]);
            }
        }
    }
    Part { name: "dome".into(), positions, triangles, ..Part::default() }
}
