//! Reads GeoTIFF elevation: striped, tiled or planar, of any number type.

use super::geokeys::MapKeys;
use super::grid::HeightGrid;
use super::map::TerrainMap;
use super::raster_tags::{self, PIXEL_SCALE, TIE_POINT, Tiff};
use super::{model_of, no_data};
use crate::formats::source::stem;
use crate::formats::whole::{sibling, sidecar};
use crate::formats::{Format, Model, ModelFault, ReadOptions};
use crate::message::message;
use glam::DVec2;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use tiff::TiffError;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

/// The tags of GeoTIFF.
const TRANSFORMATION: Tag = Tag::Unknown(34264);
const KEY_DIRECTORY: Tag = Tag::Unknown(34735);
const KEY_TEXTS: Tag = Tag::Unknown(34737);

/// A byte of a file cannot become more, by any of the compressions that are read: DEFLATE makes 1032 of it, LZW about 1400.
const MAX_OF_A_BYTE: u64 = 2048;

/// GeoTIFF elevation, `.tif`.
pub struct GeoTiff;

impl Format for GeoTiff {
    fn name(&self) -> &'static str {
        "GeoTIFF"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["tif", "tiff"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["terrain_error"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|mark| head.starts_with(*mark))
    }

    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        true
    }

    fn named_by(&self, path: &Path) -> Vec<PathBuf> {
        sibling(path, "tfw").into_iter().collect()
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let file = File::open(path).map_err(ModelFault::unreadable)?;
        let most = file.metadata().map_err(ModelFault::unreadable)?.len().saturating_mul(MAX_OF_A_BYTE);
        let mut limits = Limits::default();
        limits.decoding_buffer_size = most.clamp(1 << 20, 1 << 30) as usize;
        limits.intermediate_buffer_size = limits.decoding_buffer_size;
        limits.ifd_value_size = 1 << 26;
        let mut tiff = Decoder::new(BufReader::new(file)).map_err(damaged)?.with_limits(limits);
        let (columns, rows) = tiff.dimensions().map_err(damaged)?;
        let count = HeightGrid::counted(columns.into(), rows.into())?;
        if count as u64 > most {
            let what = format!("is cut off: it says that it has {columns} × {rows} heights, and is too short for them");
            return Err(message![what; "copy or export it again"].into());
        }
        let keys = keys(&mut tiff);
        let (first, steps) = placed(&mut tiff, &keys, path)?;
        let mut notes = Vec::new();
        raster_tags::refuse_pictures(&mut tiff, &mut notes)?;
        let [factor, addend] = raster_tags::height_of_number(&mut tiff, &mut notes)?;
        let mut heights = heights(&mut tiff, [columns, rows], count)?;
        let map = TerrainMap::of(keys.crs, keys.height_unit_m, keys.map_unit_m, &mut notes);
        let number_m = map.height_unit_m * factor.abs();
        no_data::remove(&mut heights, raster_tags::no_data(&mut tiff), number_m, &mut notes);
        let metres = |number: f32| ((f64::from(number) * factor + addend) * map.height_unit_m) as f32;
        heights.iter_mut().for_each(|height| *height = metres(*height));
        let grid = HeightGrid { columns: columns as usize, rows: rows as usize, heights, first, steps };
        let mut model = model_of(&grid, options, &stem(path), map)?;
        model.notes.extend(notes);
        model.left_out.extend(raster_tags::further_bands(&mut tiff));
        Ok(model)
    }
}

fn keys(tiff: &mut Tiff) -> MapKeys {
    let directory = tiff.get_tag_u16_vec(KEY_DIRECTORY).unwrap_or_default();
    let texts = tiff.get_tag_ascii_string(KEY_TEXTS).unwrap_or_default();
    MapKeys::of(&directory, &texts)
}

/// The middle of the first cell, and the steps to its neighbours.
fn placed(tiff: &mut Tiff, keys: &MapKeys, path: &Path) -> Result<(DVec2, [DVec2; 2]), ModelFault> {
    let numbers = |tiff: &mut Tiff, tag| tiff.get_tag_f64_vec(tag).unwrap_or_default();
    let middle = if keys.is_point { 0.0 } else { 0.5 };
    let (scale, ties) = (numbers(tiff, PIXEL_SCALE), numbers(tiff, TIE_POINT));
    let found = if let ([dx, dy, ..], [column, row, _, x, y, ..]) = (&scale[..], &ties[..]) {
        let steps = [DVec2::new(*dx, 0.0), DVec2::new(0.0, -dy)];
        Some((DVec2::new(*x, *y) + steps[0] * (middle - column) + steps[1] * (middle - row), steps))
    } else if let [a, b, _, x, c, d, _, y, ..] = numbers(tiff, TRANSFORMATION)[..] {
        let steps = [DVec2::new(a, c), DVec2::new(b, d)];
        Some((DVec2::new(x, y) + (steps[0] + steps[1]) * middle, steps))
    } else {
        world_file(path)?
    };
    let is_usable = |(first, [across, down]): &(DVec2, [DVec2; 2])| {
        first.is_finite()
            && across.is_finite()
            && down.is_finite()
            && across.perp_dot(*down).is_normal()
            && across.length_squared().is_normal()
            && down.length_squared().is_normal()
    };
    found.filter(is_usable).ok_or_else(|| {
        message![
            "does not say where it lies, so it is a picture and not terrain";
            "export it as GeoTIFF with its coordinates, or put its world file (.tfw) beside it"
        ]
        .into()
    })
}

/// The position from a `.tfw` beside it, which has the steps, then the middle of the first cell.
fn world_file(path: &Path) -> Result<Option<(DVec2, [DVec2; 2])>, ModelFault> {
    let text = sidecar(path, "tfw")?.unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let numbers: Vec<f64> = text.split_ascii_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [a, c, b, d, x, y] = numbers[..] else { return Ok(None) };
    Ok(Some((DVec2::new(x, y), [DVec2::new(a, c), DVec2::new(b, d)])))
}

/// The numbers of the first band, row by row.
fn heights(tiff: &mut Tiff, [columns, rows]: [u32; 2], count: usize) -> Result<Vec<f32>, ModelFault> {
    let (chunk_width, chunk_height) = tiff.chunk_dimensions();
    if chunk_width == 0 || chunk_height == 0 {
        return Err(message!["has tiles of no size"; "export it again"].into());
    }
    let mut heights = vec![f32::NAN; count];
    let across = columns.div_ceil(chunk_width);
    let chunks = u64::from(across) * u64::from(rows.div_ceil(chunk_height));
    for chunk in 0..u32::try_from(chunks).unwrap_or(u32::MAX) {
        let numbers = numbers(tiff.read_chunk(chunk).map_err(damaged)?);
        let (width, height) = tiff.chunk_data_dimensions(chunk);
        let cells = u64::from(width) * u64::from(height);
        // if bands are interleaved, the first of each cell's numbers is the height
        let bands = (numbers.len() as u64 / cells.max(1)).max(1) as usize;
        let [west, north] = [chunk % across * chunk_width, chunk / across * chunk_height];
        for (row, line) in numbers.chunks_exact(width as usize * bands).take(height as usize).enumerate() {
            let start = (north as usize + row) * columns as usize + west as usize;
            let target = heights.get_mut(start..).unwrap_or_default();
            target.iter_mut().zip(line.iter().step_by(bands)).take(width as usize).for_each(|(to, from)| *to = *from);
        }
    }
    Ok(heights)
}

fn numbers(read: DecodingResult) -> Vec<f32> {
    macro_rules! all {
        ($($kind:ident),+) => {
            match read {
                DecodingResult::F32(numbers) => numbers,
                DecodingResult::F16(numbers) => numbers.into_iter().map(f32::from).collect(),
                $(DecodingResult::$kind(numbers) => numbers.into_iter().map(|number| number as f32).collect(),)+
            }
        };
    }
    all!(U8, U16, U32, U64, F64, I8, I16, I32, I64)
}

fn damaged(error: TiffError) -> ModelFault {
    let hint = match error {
        TiffError::UnsupportedError(_) => {
            "export it uncompressed or with DEFLATE (gdal_translate -co COMPRESS=DEFLATE)"
        }
        TiffError::LimitsExceeded => "export it in smaller tiles (gdal_translate -co TILED=YES)",
        _ => "copy or export it again",
    };
    message![format!("cannot be read as GeoTIFF ({error})"); hint].into()
}
