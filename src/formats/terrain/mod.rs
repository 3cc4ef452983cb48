//! Terrain: heights on a raster, measured points, and triangulated surfaces → sheets of triangles that are the ground.
//!
//! Rasters and points become a `HeightGrid`, which `thin` turns into triangles that lie no farther from the heights
//! than a given error. LandXML already has triangles.

mod ascii_grid;
mod geokeys;
mod geotiff;
mod grid;
mod landxml;
mod las_sizes;
mod map;
mod no_data;
mod point_cells;
mod points;
mod raster_tags;
mod thin;

pub use ascii_grid::AsciiGrid;
pub use geotiff::GeoTiff;
pub use landxml::LandXml;
pub use points::{LasPoints, POINT_CLASSES};

use super::left_out::counted;
use super::{Coordinates, Model, ModelFault, PartKind, ReadOptions, Up};
use crate::mesh::Part;
use crate::message::{Message, message, setting};
use glam::DVec3;
use grid::HeightGrid;
use map::TerrainMap;

/// What a raster of heights gives: one part, thinned; `name` says what people call it.
fn model_of(grid: &HeightGrid, options: &ReadOptions, name: &str, map: TerrainMap) -> Result<Model, ModelFault> {
    let samples = grid.heights.len();
    let missing = grid.heights.iter().filter(|height| height.is_nan()).count();
    if missing == samples {
        let what = format!("has no heights: none of its {samples} cells has one");
        return Err(
            message![what; "export the part of the terrain that has heights, with the right value for no data"].into(),
        );
    }
    let sheet = thin::sheet(grid, map.error_m(options) as f32);
    if sheet.triangles.is_empty() {
        let what = format!("has {} heights, and no three of them side by side", samples - missing);
        return Err(
            message![what; "export a larger part of the terrain, with at least two rows and two columns"].into()
        );
    }
    let mut notes = Vec::new();
    notes.push(message![
        format!(
            "has {} heights {}, thinned to {} triangles that lie within {} m of them",
            samples - missing,
            grid.spacing(map.plan_unit),
            sheet.triangles.len(),
            options.terrain_error_m,
        );
        setting("[[model]]", "terrain_error", "`terrain_error` under [[model]]"), " says how close"
    ]);
    if missing > 0 {
        let (cells, are) = (counted(missing as u64, "cell"), if missing == 1 { "is" } else { "are" });
        notes.push(message![format!("has {cells} without a height, which {are} left out of the terrain")]);
    }
    Ok(of_metres(vec![(name.to_owned(), sheet.positions, sheet.triangles, PartKind::Terrain)], map, notes))
}

/// What one sheet is: its name, corners, triangles and kind.
type NamedSheet = (String, Vec<DVec3>, Vec<[u32; 3]>, PartKind);

/// A model of sheets whose heights are in metres, as thinning has them: they become the file's unit again, so that the
/// model says that unit, and `scale` can replace it.
fn of_metres(mut sheets: Vec<NamedSheet>, map: TerrainMap, notes: Vec<Message>) -> Model {
    let of_a_metre = map.of_a_metre();
    for (_, positions, ..) in &mut sheets {
        positions.iter_mut().for_each(|corner| corner.z *= of_a_metre);
    }
    of_sheets(sheets, map, notes)
}

/// A model of sheets in the file's own units, in the coordinates of a map where one is known.
fn of_sheets(sheets: Vec<NamedSheet>, map: TerrainMap, notes: Vec<Message>) -> Model {
    let kinds = sheets.iter().map(|(.., kind)| *kind).collect();
    let parts = sheets.into_iter().map(|(name, positions, triangles, _)| Part {
        aliases: vec![name.clone()],
        name,
        positions,
        triangles,
        ..Part::default()
    });
    Model {
        parts: parts.collect(),
        kinds,
        up: Up::Z,
        up_is_said: true,
        unit_m: map.unit_m,
        coordinates: map.crs.map_or(Coordinates::Local, Coordinates::Map),
        notes,
        ..Model::default()
    }
}
