//! Rasters of numbers: the hours of shadow as a GeoTIFF, a mask as an 8-bit gray PNG.

use super::envelope::EnvelopeMap;
use super::file::{self, TemporaryFile};
use super::{ExportError, check_size};
use crate::profile::comparison::Comparison;
use crate::profile::{Profile, ShadedCells, hours};
use crate::site::GroundKind;
use crate::sun::Place;
use crate::view::{Grid, Mask};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::ops::Range;
use std::path::Path;
use tiff::TiffError;
use tiff::encoder::{DirectoryEncoder, TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, SampleFormat, Tag};

/// `shadow-hours.tif`: one band of `f32`, hours of shadow per cell, north up, nodata NaN.
/// The map frame is an azimuthal equidistant projection around the place on WGS 84, so that its metres east and north
/// are those of the world frame. Deflated without a predictor: hours repeat so often that they compress well.
///
/// # Errors
/// [`ExportError::Size`] if the sums do not fill the grid; [`ExportError::Encode`] if the raster is too large.
pub fn geotiff<S: ShadedCells>(profile: &Profile<S>, place: &Place) -> Result<Vec<u8>, ExportError> {
    check_profile(profile)?;
    let mut bytes = Cursor::new(Vec::new());
    write_geotiff(profile, place, &mut bytes).map_err(|error| ExportError::encode("GeoTIFF", error))?;
    Ok(bytes.into_inner())
}

/// As [`geotiff`], but written to a temporary file strip by strip, so that it is never completely in memory.
///
/// # Errors
/// As [`geotiff`]; [`ExportError::Write`] if the file system fails.
pub(crate) fn geotiff_file<S: ShadedCells>(
    profile: &Profile<S>,
    place: &Place,
    path: &Path,
) -> Result<TemporaryFile, ExportError> {
    check_profile(profile)?;
    let mut beside = TemporaryFile::open(path)?;
    let mut file = BufWriter::with_capacity(1 << 20, &mut beside.file);
    let written = write_geotiff(profile, place, &mut file).and_then(|()| Ok(file.flush()?));
    drop(file);
    match written {
        Ok(()) => Ok(beside),
        Err(TiffError::IoError(error)) => Err(file::failed(path, file::WRITING, error)),
        Err(error) => Err(ExportError::encode("GeoTIFF", error)),
    }
}

fn check_profile<S: ShadedCells>(profile: &Profile<S>) -> Result<(), ExportError> {
    check_size("profile", profile.shaded.cells(), profile.grid.width, profile.grid.height)
}

fn write_geotiff<S: ShadedCells>(
    profile: &Profile<S>,
    place: &Place,
    to: &mut (impl Write + Seek),
) -> Result<(), TiffError> {
    let grid = &profile.grid;
    let hours = |cells: Range<usize>| {
        let part = profile.shaded.part(cells);
        (0..part.len()).map(|cell| hours(part.of(cell))).collect()
    };
    encode(grid, place, BandMeaning::hours("hours of shadow"), hours, to)
}

/// `shadow-hours-difference.tif`: as [`geotiff`], but the hours of shadow after minus those before; NaN where cells are
/// not compared.
///
/// # Errors
/// As [`geotiff`].
pub(crate) fn difference_geotiff(comparison: &Comparison, place: &Place) -> Result<Vec<u8>, ExportError> {
    let grid = comparison.grid();
    check_size("comparison", comparison.cells(), grid.width, grid.height)?;
    let hours = |cells: Range<usize>| cells.map(|cell| comparison.hours(cell)).collect();
    let what = BandMeaning::hours("hours of shadow, after minus before");
    let mut bytes = Cursor::new(Vec::new());
    encode(grid, place, what, hours, &mut bytes).map_err(|error| ExportError::encode("GeoTIFF", error))?;
    Ok(bytes.into_inner())
}

/// `envelope.tif`: as [`geotiff`], the greatest height that may be built, metres above [`EnvelopeMap::foot_m`]; NaN beside the plot.
///
/// # Errors
/// As [`geotiff`].
pub(crate) fn heights_geotiff(map: &EnvelopeMap) -> Result<Vec<u8>, ExportError> {
    check_size("heights", map.heights.len(), map.grid.width, map.grid.height)?;
    let heights = |cells: Range<usize>| map.heights[cells].to_vec();
    let what = match map.ground.kind {
        GroundKind::Plane => "greatest height that may be built, above the ground",
        GroundKind::Terrain => "greatest height that may be built, above the lowest terrain on the plot",
    };
    let band = BandMeaning { what, unit: "m" };
    let mut bytes = Cursor::new(Vec::new());
    encode(map.grid, map.place, band, heights, &mut bytes).map_err(|error| ExportError::encode("GeoTIFF", error))?;
    Ok(bytes.into_inner())
}

/// What a band's numbers are.
#[derive(Clone, Copy)]
struct BandMeaning {
    what: &'static str,
    unit: &'static str,
}

impl BandMeaning {
    /// Numbers of hours.
    fn hours(what: &'static str) -> BandMeaning {
        BandMeaning { what, unit: "h" }
    }
}

/// GDAL's own tag for the meaning of a band.
const GDAL_METADATA: u16 = 42112;
/// The size of a strip before it is deflated, bytes.
const STRIP_BYTES: usize = 1_000_000;
/// The size from which a raster's offsets may not fit 32 bits.
const MOST_CLASSIC: u64 = 4_000_000_000;

fn encode(
    grid: &Grid,
    place: &Place,
    band: BandMeaning,
    hours: impl Fn(Range<usize>) -> Vec<f32> + Sync,
    to: &mut (impl Write + Seek),
) -> Result<(), TiffError> {
    if grid.cells() as u64 * 4 < MOST_CLASSIC {
        let offsets = |offsets: &[u64], directory: &mut DirectoryEncoder<'_, _, TiffKindStandard>| {
            let offsets: Vec<u32> = offsets.iter().map(|&at| u32::try_from(at)).collect::<Result<_, _>>()?;
            directory.write_tag(Tag::StripOffsets, &offsets[..])
        };
        encode_as(TiffEncoder::new(to)?, grid, place, band, hours, offsets)
    } else {
        let offsets = |offsets: &[u64], directory: &mut DirectoryEncoder<'_, _, TiffKindBig>| {
            directory.write_tag(Tag::StripOffsets, offsets)
        };
        encode_as(TiffEncoder::new_big(to)?, grid, place, band, hours, offsets)
    }
}

/// The crate can only deflate a whole image, so strips are deflated here, as many at once as there are processors.
fn encode_as<W: Write + Seek, K: TiffKind>(
    mut tiff: TiffEncoder<W, K>,
    grid: &Grid,
    place: &Place,
    band: BandMeaning,
    hours: impl Fn(Range<usize>) -> Vec<f32> + Sync,
    write_offsets: impl FnOnce(&[u64], &mut DirectoryEncoder<'_, W, K>) -> Result<(), TiffError>,
) -> Result<(), TiffError> {
    let mut tags = tiff.image_directory()?;
    let (width, height) = (grid.width as usize, grid.height as usize);
    let rows_a_strip = STRIP_BYTES.div_ceil(width * size_of::<f32>());
    let strips: Vec<Range<usize>> =
        (0..height).step_by(rows_a_strip).map(|row| row * width..(row + rows_a_strip).min(height) * width).collect();
    let (mut offsets, mut lengths) = (Vec::new(), Vec::new());
    for some in strips.chunks(rayon::current_num_threads()) {
        let deflated: Vec<_> = some.par_iter().map(|cells| deflate(&hours(cells.clone()))).collect();
        for strip in deflated {
            let strip = strip?;
            offsets.push(tags.write_data(&strip[..])?);
            lengths.push(u32::try_from(strip.len())?);
        }
    }
    let keys = geo_keys(place);
    tags.write_tag(Tag::ImageWidth, grid.width)?;
    tags.write_tag(Tag::ImageLength, grid.height)?;
    tags.write_tag(Tag::BitsPerSample, 32_u16)?;
    tags.write_tag(Tag::Compression, CompressionMethod::Deflate.to_u16())?;
    tags.write_tag(Tag::PhotometricInterpretation, PhotometricInterpretation::BlackIsZero.to_u16())?;
    tags.write_tag(Tag::SamplesPerPixel, 1_u16)?;
    tags.write_tag(Tag::SampleFormat, SampleFormat::IEEEFP.to_u16())?;
    tags.write_tag(Tag::RowsPerStrip, u32::try_from(rows_a_strip)?)?;
    write_offsets(&offsets, &mut tags)?;
    tags.write_tag(Tag::StripByteCounts, &lengths[..])?;
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
             <Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">{}</Item>\
             <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{}</Item>\
             </GDALMetadata>",
            band.what, band.unit
        )
        .as_str(),
    )?;
    tags.finish()
}

/// The numbers in the machine's byte order, as the file's header declares, deflated.
fn deflate(hours: &[f32]) -> io::Result<Vec<u8>> {
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
    zlib.write_all(bytemuck::cast_slice(hours))?;
    zlib.finish()
}

/// The three tags of OGC GeoTIFF 1.1 that define the map of the raster.
struct GeoKeys {
    directory: Vec<u16>,
    doubles: Vec<f64>,
    ascii: String,
}

/// The keys of an azimuthal equidistant projection around the place, after OGC 19-008r4, annex B, and GeoTIFF 1.0,
/// section 6.3.
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
/// [`ExportError::Size`] if the shares do not fill the mask; [`ExportError::Encode`] if the encoder fails.
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

/// As [`png_bytes`], but written piece by piece.
pub(super) fn png_rows(
    (width, height): (u32, u32),
    (color, depth): (png::ColorType, png::BitDepth),
    dots_per_metre: Option<u32>,
    pieces: impl FnOnce(&mut (dyn FnMut(&[u8]) -> io::Result<()> + Send)) -> Result<(), png::EncodingError>,
) -> Result<Vec<u8>, png::EncodingError> {
    /// How many bytes are compressed before they are written.
    const AT_ONCE: usize = 1 << 16;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    if color == png::ColorType::Rgb {
        // for drawings the files are as small as if all filters were tried on each row, in a fraction of the time
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
