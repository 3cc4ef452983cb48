//! The polygons of a GeoJSON file as they are, for areas and plots: nothing is extruded.

use super::Footprints;
use super::footprint::RingPolygon;
use super::geojson;
use crate::formats::whole::{whole_file, without_mark};
use crate::formats::{Coordinates, LeftOut, ModelError, ModelFault};
use crate::message::{Message, message};
use glam::DVec3;
use std::path::Path;

/// All polygons of a file.
#[derive(Debug)]
pub(crate) struct OutlineFile {
    /// Those of each feature that has any.
    pub(crate) outlines: Vec<NamedOutline>,
    /// What their coordinates are.
    pub(crate) coordinates: Coordinates,
    /// What was left out.
    pub(crate) left_out: Vec<LeftOut>,
    /// What the user should know, each with the file for its subject.
    pub(crate) notes: Vec<Message>,
}

/// The polygons of one feature.
#[derive(Debug)]
pub(crate) struct NamedOutline {
    /// What the file calls it.
    pub(crate) name: Option<String>,
    /// The dwelling whose open space it is, as the file says it.
    pub(crate) dwelling: Option<String>,
    /// Its number in the file, from 1.
    pub(crate) number: u64,
    /// All borders and holes, in the file's coordinates.
    pub(crate) rings: Vec<Vec<DVec3>>,
}

/// Reads the polygons of a GeoJSON file.
///
/// # Errors
/// What is wrong with the file.
pub(crate) fn read_outlines(path: &Path) -> Result<OutlineFile, ModelError> {
    read(path).map_err(|fault| ModelError { file: path.to_owned(), fault })
}

fn read(path: &Path) -> Result<OutlineFile, ModelFault> {
    let bytes = whole_file(path)?;
    let mut read = Footprints::default();
    let crs = geojson::read(without_mark(&bytes), &mut read)?;
    let coordinates = geojson::coordinates_of(crs.as_ref(), &mut read);
    if read.features.is_empty() {
        return Err(message!["has no polygon"; "export the areas as GeoJSON polygons"].into());
    }
    let outline = |feature: super::footprint::Footprint| NamedOutline {
        name: feature.tags.name.clone(),
        dwelling: feature.tags.dwelling.clone(),
        number: feature.number,
        rings: feature.polygons.iter().flat_map(rings).collect(),
    };
    Ok(OutlineFile {
        outlines: read.features.into_iter().map(outline).collect(),
        coordinates,
        left_out: read.tally.into_left_out(),
        notes: read.notes,
    })
}

/// The rings of a polygon, one after the other.
fn rings(polygon: &RingPolygon) -> Vec<Vec<DVec3>> {
    let starts = [0].into_iter().chain(polygon.ends.iter().copied());
    starts.zip(&polygon.ends).map(|(start, end)| polygon.points[start..*end].to_vec()).collect()
}
