//! Reads terrain: heights on a raster, measured points, and triangulated surfaces become sheets of triangles that are
//! the ground.
//!
//! Rasters and points become a `HeightGrid`, from which `thin` makes triangles within a given distance of the heights.
//! LandXML already has triangles.

mod ascii_grid;
mod geokeys;
mod geotiff;
mod grid;
mod landxml;
mod las_records;
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

/// The model of a raster of heights: one thinned part called `name`.
fn model_of(grid: &HeightGrid, options: &ReadOptions, name: &str, map: TerrainMap) -> Result<Model, ModelFault> {
    let samples = grid.heights.len();
    let missing = grid.heights.iter().filter(|height| height.is_nan()).count();
    if missing == samples {
        let what = format!("has no heights in any of its {samples} cells");
        return Err(
            message![what; "export the part of the terrain that has heights, with the correct no-data value"].into()
        );
    }
    let sheet = thin::sheet(grid, map.error_m(options) as f32);
    if sheet.triangles.is_empty() {
        let what = format!("has {} heights, but no three next to each other", samples - missing);
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
        setting("[[model]]", "terrain_error", "`terrain_error` under [[model]]"), " changes that distance"
    ]);
    if missing > 0 {
        let (cells, are) = (counted(missing as u64, "cell"), if missing == 1 { "is" } else { "are" });
        notes.push(message![format!("has {cells} without a height, which {are} left out of the terrain")]);
    }
    Ok(of_metres(vec![(name.to_owned(), sheet.positions, sheet.triangles, PartKind::Terrain)], map, notes))
}

/// A sheet: its name, corners, triangles and kind.
type NamedSheet = (String, Vec<DVec3>, Vec<[u32; 3]>, PartKind);

/// A model of sheets with heights in metres, as thinning returns them. They are converted back to the file's unit, so
/// that the model states that unit and `scale` can override it.
fn of_metres(mut sheets: Vec<NamedSheet>, map: TerrainMap, notes: Vec<Message>) -> Model {
    let of_a_metre = map.of_a_metre();
    for (_, positions, ..) in &mut sheets {
        positions.iter_mut().for_each(|corner| corner.z *= of_a_metre);
    }
    of_sheets(sheets, map, notes)
}

/// A model of sheets in the file's own units, in map coordinates if a map is known.
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
