//! The envelope as a solid: a column on each cell, without walls between columns of equal height.

use super::map::EnvelopeMap;
use crate::export::ExportError;
use crate::export::glb::{GlbFile, asset};
use crate::export::report::place_report;
use crate::export::volumes::in_gltf;
use glam::{DVec3, Vec3};
use serde_json::json;
use std::fmt::Write;

/// The corners of a solid in metres of the world frame, and its triangles, seen counter-clockwise from outside.
#[derive(Clone, Debug, Default)]
pub struct EnvelopeSolid {
    /// East, north and up.
    pub corners: Vec<DVec3>,
    /// Triangles, as indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

/// The most cells of a solid; each has up to ten triangles.
const MOST_CELLS: usize = 1_000_000;

impl EnvelopeSolid {
    /// The solid of all cells whose height is above 0.
    ///
    /// # Errors
    /// [`ExportError::Encode`] if nothing may stand anywhere, or there are too many cells.
    pub fn of(map: &EnvelopeMap) -> Result<EnvelopeSolid, ExportError> {
        let (width, height) = (map.grid.width as usize, map.grid.height as usize);
        let top = |column: usize, row: usize| match column < width && row < height {
            true => map.height(row * width + column).map_or(0.0, f64::from).max(0.0),
            false => 0.0,
        };
        let count = (0..width * height).filter(|cell| top(cell % width, cell / width) > 0.0).count();
        if count == 0 {
            return Err(ExportError::encode(
                "envelope",
                "nothing may stand anywhere on the plot, so there is no solid",
            ));
        }
        if count > MOST_CELLS {
            let what = format!("{count} cells are too many for a solid, at most {MOST_CELLS}; take larger cells");
            return Err(ExportError::encode("envelope", what));
        }
        let mut solid = EnvelopeSolid::default();
        let foot = map.foot_m;
        for row in 0..height {
            for column in 0..width {
                let own = top(column, row);
                if own <= 0.0 {
                    continue;
                }
                let [west, east] = [column, column + 1].map(|at| map.grid.west + at as f64 * map.grid.cell);
                let [north, south] = [row, row + 1].map(|at| map.grid.north - at as f64 * map.grid.cell);
                let (low, high) = (foot, foot + own);
                let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
                solid.quad([
                    at(west, south, high),
                    at(east, south, high),
                    at(east, north, high),
                    at(west, north, high),
                ]);
                solid.quad([at(west, north, low), at(east, north, low), at(east, south, low), at(west, south, low)]);
                // the part of the wall above a lower neighbour; the lower cell has no wall there
                let sides = [
                    (row.checked_sub(1).map_or(0.0, |row| top(column, row)), [east, north], [west, north]),
                    (top(column, row + 1), [west, south], [east, south]),
                    (column.checked_sub(1).map_or(0.0, |column| top(column, row)), [west, north], [west, south]),
                    (top(column + 1, row), [east, south], [east, north]),
                ];
                for (other, [ax, ay], [bx, by]) in sides {
                    if other < own {
                        let low = foot + other;
                        solid.quad([at(ax, ay, low), at(bx, by, low), at(bx, by, high), at(ax, ay, high)]);
                    }
                }
            }
        }
        Ok(solid)
    }

    fn quad(&mut self, corners: [DVec3; 4]) {
        let first = self.corners.len() as u32;
        self.corners.extend(corners);
        self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }

    /// A binary glTF file: metres, y up, translucent.
    ///
    /// # Errors
    /// [`ExportError`] if the encoder fails.
    pub fn glb(&self, map: &EnvelopeMap) -> Result<Vec<u8>, ExportError> {
        let origin = self.corners.first().copied().unwrap_or_default().round();
        let corners: Vec<Vec3> =
            self.corners.iter().map(|corner| Vec3::from(in_gltf((corner - origin).as_vec3()))).collect();
        let mut file = GlbFile::default();
        let [position, indices] = file.triangles(&corners, self.triangles.as_flattened());
        let document = json!({
            "asset": asset(),
            "scene": 0,
            "scenes": [{"name": "envelope", "nodes": [0], "extras": {
                "place": place_report(map.place),
                "ground": map.ground.level,
                "foot_m": map.foot_m,
                "keeps": map.kept,
                "days": map.days,
                "highest_m": map.cap_m,
            }}],
            "nodes": [{"name": "envelope", "mesh": 0, "translation": [origin.x, origin.z, 0.0 - origin.y]}],
            "meshes": [{"name": "envelope", "primitives": [
                {"attributes": {"POSITION": position}, "indices": indices, "material": 0},
            ]}],
            "materials": [{
                "name": "envelope",
                "alphaMode": "BLEND",
                "doubleSided": true,
                "pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.7, 0.85, 0.6], "metallicFactor": 0.0},
            }],
        });
        file.finish("envelope", document)
    }

    /// A Wavefront OBJ file: metres, y up, as most programs expect.
    pub fn obj(&self, map: &EnvelopeMap) -> String {
        let mut text = format!(
            "# Gnomon {}: how high may be built; metres around the place, y up\n# keeps: {}, {}\no envelope\n",
            env!("CARGO_PKG_VERSION"),
            map.kept.replace(['\r', '\n'], " "),
            map.days.replace(['\r', '\n'], " "),
        );
        for corner in &self.corners {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "v {:.4} {:.4} {:.4}", corner.x, corner.z, 0.0 - corner.y);
        }
        for [a, b, c] in &self.triangles {
            let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
        }
        text
    }
}
