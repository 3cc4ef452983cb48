//! Reads Esri's ASCII grid: a header of names and numbers, then heights, the northernmost row first.

use super::grid::HeightGrid;
use super::map::TerrainMap;
use super::{model_of, no_data};
use crate::formats::source::stem;
use crate::formats::whole::{sidecar, whole_file};
use crate::formats::{Format, Model, ModelFault, ReadOptions};
use crate::message::message;
use glam::DVec2;
use std::path::Path;

/// Esri's ASCII grid, `.asc` and `.grd`.
pub struct AsciiGrid;

impl Format for AsciiGrid {
    fn name(&self) -> &'static str {
        "ASCII grid"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["asc"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["terrain_error"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        head.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"ncols"))
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let text = std::str::from_utf8(&bytes).map_err(|_| message!["is not text"; "export it again"])?;
        let (mut grid, no_data) = grid(text)?;
        let mut notes = Vec::new();
        let map = TerrainMap::of(beside(path)?, None, None, &mut notes);
        no_data::remove(&mut grid.heights, no_data, map.height_unit_m, &mut notes);
        grid.heights.iter_mut().for_each(|height| *height *= map.height_unit_m as f32);
        let mut model = model_of(&grid, options, &stem(path), map)?;
        model.notes.extend(notes);
        Ok(model)
    }
}

/// The reference system in the `.prj` file beside a grid.
fn beside(path: &Path) -> Result<Option<String>, ModelFault> {
    let text = sidecar(path, "prj")?.and_then(|text| String::from_utf8(text).ok());
    Ok(text.filter(|text| !text.trim().is_empty()))
}

/// The header of a grid, with required and optional values.
#[derive(Default)]
struct GridHead {
    columns: Option<u64>,
    rows: Option<u64>,
    /// The west and south border, and whether they are those of a cell's corner.
    corner: [Option<(f64, bool)>; 2],
    cell: [Option<f64>; 2],
    no_data: Option<f64>,
}

impl GridHead {
    fn set(&mut self, key: &str, value: f64) -> bool {
        match key.to_ascii_lowercase().as_str() {
            "ncols" => self.columns = Some(value as u64),
            "nrows" => self.rows = Some(value as u64),
            "xllcorner" => self.corner[0] = Some((value, true)),
            "yllcorner" => self.corner[1] = Some((value, true)),
            "xllcenter" => self.corner[0] = Some((value, false)),
            "yllcenter" => self.corner[1] = Some((value, false)),
            "cellsize" => self.cell = [Some(value); 2],
            "dx" => self.cell[0] = Some(value),
            "dy" => self.cell[1] = Some(value),
            "nodata_value" => self.no_data = Some(value),
            _ => return false,
        }
        true
    }
}

/// The heights as written, and the value that means no height.
fn grid(text: &str) -> Result<(HeightGrid, Option<f32>), ModelFault> {
    let mut words = text.split_ascii_whitespace().peekable();
    let mut head = GridHead::default();
    while let Some(key) = words.next_if(|word| !word.starts_with(|first: char| "+-.0123456789".contains(first))) {
        let value = words.next().and_then(number);
        if !value.is_some_and(|value| head.set(key, value)) {
            return Err(message![format!("has the unknown name \"{key}\" in its header"); "export it again"].into());
        }
    }
    let missing = |key: &str| message![format!("has no `{key}` in its header"); "export it again"];
    let columns = head.columns.ok_or_else(|| missing("ncols"))?;
    let rows = head.rows.ok_or_else(|| missing("nrows"))?;
    let [Some((west, of_x)), Some((south, of_y))] = head.corner else { return Err(missing("xllcorner").into()) };
    let [Some(dx), Some(dy)] = head.cell else { return Err(missing("cellsize").into()) };
    if !(dx > 0.0 && dy > 0.0 && dx.is_finite() && dy.is_finite() && west.is_finite() && south.is_finite()) {
        return Err(message![format!("has cells of {dx} × {dy}"); "export it again"].into());
    }
    let count = HeightGrid::counted(columns, rows)?;
    // each height takes at least two bytes
    if count > text.len() {
        return Err(cut_off(text.len(), count));
    }
    let mut heights = Vec::with_capacity(count);
    for word in words.by_ref().take(count) {
        let Some(height) = number(word) else {
            return Err(message![format!("has \"{word}\" instead of a height"); "export it again"].into());
        };
        heights.push(height as f32);
    }
    if heights.len() < count {
        return Err(cut_off(heights.len(), count));
    }
    if words.next().is_some() {
        return Err(message![format!("has more than {columns} × {rows} heights"); "export it again"].into());
    }
    let middle = |of_corner: bool, cell: f64| if of_corner { cell / 2.0 } else { 0.0 };
    let first = DVec2::new(west + middle(of_x, dx), south + middle(of_y, dy) + (rows - 1) as f64 * dy);
    let steps = [DVec2::new(dx, 0.0), DVec2::new(0.0, -dy)];
    let grid = HeightGrid { columns: columns as usize, rows: rows as usize, heights, first, steps };
    Ok((grid, head.no_data.map(|number| number as f32)))
}

/// A number with a decimal point or comma.
fn number(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| word.replace(',', ".").parse().ok()).filter(|number: &f64| number.is_finite())
}

fn cut_off(found: usize, count: usize) -> ModelFault {
    message![format!("is cut off: it has {found} of {count} heights"); "copy or export it again"].into()
}
