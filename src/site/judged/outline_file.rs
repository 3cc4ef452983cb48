//! Polygons of a GeoJSON file → metres around the place.

use super::asked_table::AskedTable;
use crate::crs::{Crs, GeodeticPoint, LocalFrame, MapToLocal};
use crate::formats::{Coordinates, NamedOutline, OutlineFile, read_outlines};
use crate::message::{Message, message};
use crate::site::error::SiteError;
use crate::sun::Place;
use glam::{DVec2, DVec3};

/// The polygons of one feature, metres east and north of the place.
#[derive(Debug)]
pub(super) struct PlacedOutline {
    /// Its name in the file, if it has one.
    pub(super) name: Option<String>,
    /// The dwelling whose open space it is, if the file says one.
    pub(super) dwelling: Option<String>,
    /// Its number in the file, from 1.
    pub(super) number: u64,
    /// Its borders and holes.
    pub(super) rings: Vec<Vec<DVec2>>,
}

/// The polygons of a file that a table names, and notes on how they were read.
///
/// # Errors
/// A file that cannot be read, an unknown reference system, and coordinates outside the area that it covers.
pub(super) fn outlines(
    table: &AskedTable,
    (name, crs): (&str, Option<&str>),
    place: &Place,
) -> Result<(Vec<PlacedOutline>, Vec<Message>), SiteError> {
    let path = table.file("file", name)?;
    let OutlineFile { outlines, coordinates, left_out, mut notes } = read_outlines(&path)?;
    let of_file = match &coordinates {
        Coordinates::Map(text) => Some(text.as_str()),
        Coordinates::Local => None,
    };
    let key = if crs.is_some() { "crs" } else { "file" };
    let crs = crs.or(of_file).map(|text| Crs::read(text).map_err(|error| table.wrong(key, error))).transpose()?;
    if crs.is_some() {
        // the note on coordinates without a reference system
        notes.retain(|_| coordinates != Coordinates::Local);
    }
    for left in &left_out {
        notes.push(Message::from(format!("has {} left out: {}", left.counted(), left.why)));
    }
    let frame = frame(place);
    let placed = outlines
        .into_iter()
        .map(|outline| placed(outline, crs.as_ref(), frame.as_ref()).map_err(|what| table.wrong("file", what)))
        .collect::<Result<_, _>>()?;
    Ok((placed, notes.into_iter().map(|note| note.about(name)).collect()))
}

/// Metres east and north of a place.
fn frame(place: &Place) -> Option<LocalFrame> {
    LocalFrame::around(GeodeticPoint {
        latitude_deg: place.latitude_deg,
        longitude_deg: place.longitude_deg,
        height_m: place.elevation_m,
    })
}

/// One feature in the frame of the place.
fn placed(outline: NamedOutline, crs: Option<&Crs>, frame: Option<&LocalFrame>) -> Result<PlacedOutline, Message> {
    let NamedOutline { name, dwelling, number, rings } = outline;
    let point = |at: DVec3| match crs {
        None => Ok(at.truncate()),
        Some(crs) => {
            let found = frame.and_then(|frame| MapToLocal { crs, frame }.point(at));
            found.map(DVec3::truncate).ok_or_else(|| {
                let what =
                    format!("feature {number} has a corner at {}, {}, where {} does not reach", at.x, at.y, crs.name());
                message![what; "write the reference system of its coordinates as `crs`"]
            })
        }
    };
    let rings = rings.into_iter().map(|ring| ring.into_iter().map(point).collect()).collect::<Result<_, _>>()?;
    Ok(PlacedOutline { name, dwelling, number, rings })
}
