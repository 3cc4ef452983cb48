//! Bare numbers: the hours of shadow as a GeoTIFF, a mask as an 8-bit gray PNG.

use super::{ExportError, check_size};
use crate::profile::Profile;
use crate::profile::comparison::Comparison;
use crate::sun::Place;
use crate::view::{Grid, Mask};
use rayon::prelude::*;
use std::io::{self, Cursor, Write};
use tiff::TiffError;
use tiff::encoder::compression::DeflateLevel;
use tiff::encoder::{Compression, TiffEncoder, colortype::Gray32Float};
use tiff::tags::Tag;

/// `shadow-hours.tif`: one band of `f32`, hours of shadow per cell, north up, nodata NaN.
///
/// The map frame is an azimuthal equidistant projection around the place on WGS 84, so that its metres east and north
/// are the world frame's. Deflated without a predictor: the crate's writer has none for floats, and hours repeat so
/// much that they shrink well without.
///
/// # Errors
/// [`ExportError::Size`] where the sums do not fill the grid; [`ExportError::Encode`] where the raster is too large.
pub fn geotiff(profile: &Profile, place: &Place) -> Result<Vec<u8>, ExportError> {
    let grid = &profile.grid;
    check_size("profile", profile.shaded.len(), grid.width, grid.height)?;
    let hours: Vec<f32> = (0..profile.shaded.len()).into_par_iter().map(|cell| profile.hours(cell)).collect();
    encode(grid, place, "hours of shadow", &hours).map_err(|error| ExportError::encode("GeoTIFF", error))
}

/// `shadow-hours-difference.tif`: as [`geotiff`], the hours of shadow after minus those before; NaN where they are not
/// compared.
///
/// # Errors
/// As [`geotiff`].
pub fn difference_geotiff(comparison: &Comparison, place: &Place) -> Result<Vec<u8>, ExportError> {
    let grid = comparison.grid();
    check_size("comparison", comparison.cells(), grid.width, grid.height)?;
    let hours: Vec<f32> = (0..comparison.cells()).into_par_iter().map(|cell| comparison.hours(cell)).collect();
    let what = "hours of shadow, after minus before";
    encode(grid, place, what, &hours).map_err(|error| ExportError::encode("GeoTIFF", error))
}

/// GDAL's own tag for what a band means.
const GDAL_METADATA: u16 = 42112;

fn encode(grid: &Grid, place: &Place, what: &str, hours: &[f32]) -> Result<Vec<u8>, TiffError> {
    let mut bytes = Cursor::new(Vec::new());
    let mut tiff = TiffEncoder::new(&mut bytes)?.with_compression(Compression::Deflate(DeflateLevel::Fast));
    let mut image = tiff.new_image::<Gray32Float>(grid.width, grid.height)?;
    let keys = geo_keys(place);
    let tags = image.encoder();
    tags.write_tag(Tag::Software, concat!("Gnomon ", env!("CARGO_PKG_VERSION")))?;
    tags.write_tag(Tag::ModelPixelScaleTag, &[grid.cell, grid.cell, 0.0][..])?;
    // Raster (0, 0), the north-west cell's outer corner, lies at (west, north).
    tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, grid.west, grid.north, 0.0][..])?;
    tags.write_tag(Tag::GeoKeyDirectoryTag, &keys.directory[..])?;
    tags.write_tag(Tag::GeoDoubleParamsTag, &keys.doubles[..])?;
    tags.write_tag(Tag::GeoAsciiParamsTag, keys.ascii.as_str())?;
    tags.write_tag(Tag::GdalNodata, "nan")?;
    tags.write_tag(
        Tag::Unknown(GDAL_METADATA),
        format!(
            "<GDALMetadata>\
             <Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">{what}</Item>\
             <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">h</Item>\
             </GDALMetadata>"
        )
        .as_str(),
    )?;
    image.write_data(hours)?;
    Ok(bytes.into_inner())
}

/// The three tags of OGC GeoTIFF 1.1 that say which map the raster lies on.
struct GeoKeys {
    directory: Vec<u16>,
    doubles: Vec<f64>,
    ascii: String,
}

/// Azimuthal equidistant around the place; numbers as in OGC 19-008r4, annex B, and GeoTIFF 1.0, section 6.3.
fn geo_keys(place: &Place) -> GeoKeys {
    const DOUBLES: u16 = 34736;
    const ASCII: u16 = 34737;
    const USER_DEFINED: u16 = 32767;
    let citation = "Gnomon local azimuthal equidistant|";
    let geographic = "WGS 84|";
    // Citations are plain ASCII, ended by a bar and found by length and offset. Key, where, count, value:
    let entries: [[u16; 4]; 14] = [
        [1024, 0, 1, 1],                                               // GTModelType: projected
        [1025, 0, 1, 1],                                               // GTRasterType: pixel is area
        [2048, 0, 1, 4326],                                            // GeodeticCRS: WGS 84
        [2049, ASCII, geographic.len() as u16, citation.len() as u16], // GeodeticCitation
        [2054, 0, 1, 9102],                                            // GeogAngularUnits: degree
        [3072, 0, 1, USER_DEFINED],                                    // ProjectedCRS
        [3073, ASCII, citation.len() as u16, 0],                       // ProjectedCitation
        [3074, 0, 1, USER_DEFINED],                                    // Projection
        [3075, 0, 1, 12],                                              // ProjMethod: CT_AzimuthalEquidistant
        [3076, 0, 1, 9001],                                            // ProjLinearUnits: metre
        [3082, DOUBLES, 1, 2],                                         // FalseEasting
        [3083, DOUBLES, 1, 3],                                         // FalseNorthing
        [3088, DOUBLES, 1, 0],                                         // CenterLong
        [3089, DOUBLES, 1, 1],                                         // CenterLat
    ];
    let mut directory = vec![1, 1, 0, entries.len() as u16];
    directory.extend(entries.iter().flatten());
    GeoKeys {
        directory,
        doubles: vec![place.longitude_deg, place.latitude_deg, 0.0, 0.0],
        ascii: format!("{citation}{geographic}"),
    }
}

/// The bare mask: 8-bit gray, row 0 north, 255 where the whole sun is seen.
///
/// # Errors
/// [`ExportError::Size`] where the shares do not fill the mask; [`ExportError::Encode`] where the encoder refuses.
pub fn mask_png(mask: &Mask) -> Result<Vec<u8>, ExportError> {
    check_size("mask", mask.share.len(), mask.width, mask.height)?;
    png_bytes((mask.width, mask.height), (png::ColorType::Grayscale, png::BitDepth::Eight), None, &mask.share)
        .map_err(|error| ExportError::encode("mask PNG", error))
}

/// A PNG, compressed fast; `dots_per_metre` is its size on paper.
pub(super) fn png_bytes(
    size: (u32, u32),
    kind: (png::ColorType, png::BitDepth),
    dots_per_metre: Option<u32>,
    pixels: &[u8],
) -> Result<Vec<u8>, png::EncodingError> {
    png_rows(size, kind, dots_per_metre, |write| write(pixels).map_err(Into::into))
}

/// The same, written piece by piece.
pub(super) fn png_rows(
    (width, height): (u32, u32),
    (color, depth): (png::ColorType, png::BitDepth),
    dots_per_metre: Option<u32>,
    pieces: impl FnOnce(&mut (dyn FnMut(&[u8]) -> io::Result<()> + Send)) -> Result<(), png::EncodingError>,
) -> Result<Vec<u8>, png::EncodingError> {
    /// Bytes that are compressed before they go out.
    const AT_ONCE: usize = 1 << 16;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    if color == png::ColorType::Rgb {
        // on drawings no larger than trying all filters on each row, and in a fraction of the time
        encoder.set_filter(png::Filter::Paeth);
    }
    encoder.set_pixel_dims(dots_per_metre.map(|dots| png::PixelDimensions {
        xppu: dots,
        yppu: dots,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer_with_size(AT_ONCE)?;
    pieces(&mut |piece| rows.write_all(piece))?;
    rows.finish()?;
    writer.finish()?;
    Ok(bytes)
}
