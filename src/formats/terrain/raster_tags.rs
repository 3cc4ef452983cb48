//! Interprets a GeoTIFF's tags: whether its numbers are heights, and how they are scaled.

use crate::formats::{LeftOut, ModelFault};
use crate::message::{Message, message};
use std::fs::File;
use std::io::BufReader;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// A file that is being read.
pub(super) type Tiff = Decoder<BufReader<File>>;

/// The steps between cells, and a tie point; both with heights.
pub(super) const PIXEL_SCALE: Tag = Tag::Unknown(33550);
pub(super) const TIE_POINT: Tag = Tag::Unknown(33922);

/// GDAL's tag for the value of missing heights.
const NO_DATA: Tag = Tag::Unknown(42113);
/// GDAL's XML metadata.
const METADATA: Tag = Tag::Unknown(42112);

/// Refuses pictures, and notes if a raster looks like one.
pub(super) fn refuse_pictures(tiff: &mut Tiff, notes: &mut Vec<Message>) -> Result<(), ModelFault> {
    let colours = match tiff.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation).ok().flatten() {
        Some(2) => "RGB",
        Some(3) => "a palette",
        Some(4) => "a mask",
        Some(5) => "CMYK",
        Some(6) => "YCbCr",
        Some(8..=10) => "CIE L*a*b*",
        _ => {
            let bits = tiff.find_tag_unsigned_vec::<u16>(Tag::BitsPerSample).ok().flatten().unwrap_or_default();
            if bits.first().is_some_and(|&bits| bits <= 8) {
                let what = "has numbers of 8 bits, like pictures and hillshades; they are taken as heights";
                notes.push(message![what; "if it is a picture, export the elevation itself"]);
            }
            return Ok(());
        }
    };
    let what = format!("is a picture ({colours}) and not terrain");
    Err(message![what; "open the elevation of the place, whose numbers are heights"].into())
}

/// The bands after the first.
pub(super) fn further_bands(tiff: &mut Tiff) -> Option<LeftOut> {
    let bands = tiff.find_tag_unsigned::<u16>(Tag::SamplesPerPixel).ok().flatten()?;
    let why = "the first band is taken as the heights".to_owned();
    (bands > 1).then(|| LeftOut { what: "further bands".to_owned(), count: u64::from(bands - 1), why })
}

/// The value that means no height, if the file gives it.
pub(super) fn no_data(tiff: &mut Tiff) -> Option<f32> {
    let text = tiff.get_tag_ascii_string(NO_DATA).ok()?;
    text.trim_end_matches('\0').trim().parse::<f64>().ok().map(|number| number as f32)
}

/// The factor and the offset from a number to a height. GDAL writes them as metadata; otherwise z of the pixel scale
/// and the tie point give them. A scale of 0 means that numbers are not positions.
pub(super) fn height_of_number(tiff: &mut Tiff, notes: &mut Vec<Message>) -> Result<[f64; 2], ModelFault> {
    let metadata = tiff.get_tag_ascii_string(METADATA).unwrap_or_default();
    let [factor, addend] = ["scale", "offset"].map(|role| item(&metadata, role));
    let numbers = |tiff: &mut Tiff, tag| tiff.get_tag_f64_vec(tag).unwrap_or_default();
    let scale = numbers(tiff, PIXEL_SCALE).get(2).copied().unwrap_or_default();
    let ties = numbers(tiff, TIE_POINT);
    let [number, height] = [2, 5].map(|at| ties.get(at).copied().unwrap_or_default());
    let found = match (factor, addend) {
        (None, None) if scale == 0.0 && (number, height) != (0.0, 0.0) => {
            let what =
                format!("has a tie point at the height {height} but no scale of heights, so its heights are not known");
            return Err(message![what; "export it again, with gdal_translate or from a GIS"].into());
        }
        (None, None) if scale == 0.0 => [1.0, 0.0],
        (None, None) => [scale, height - number * scale],
        _ => [factor.unwrap_or(1.0), addend.unwrap_or(0.0)],
    };
    let [factor, addend] = found;
    if !(factor.is_normal() && addend.is_finite()) {
        let what = format!("says that a height is {factor} times a number plus {addend}");
        return Err(message![what; "export it again"].into());
    }
    if found != [1.0, 0.0] {
        notes.push(message![format!(
            "says that a height is {factor} times a number plus {addend}, and is read accordingly"
        )]);
    }
    Ok(found)
}

/// The number of the first band's item with a role: `<Item name="SCALE" sample="0" role="scale">0.1</Item>`.
fn item(metadata: &str, role: &str) -> Option<f64> {
    let role = format!("role=\"{role}\"");
    metadata.split("<Item ").skip(1).find_map(|item| {
        let (attributes, content) = item.split_once('>')?;
        let is_first = attributes.contains("sample=\"0\"");
        (is_first && attributes.contains(&role)).then(|| content.split('<').next()?.trim().parse().ok()).flatten()
    })
}
