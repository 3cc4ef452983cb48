//! Reads LandXML: surveyors' triangulated surfaces.

use super::map::TerrainMap;
use super::{NamedSheet, of_sheets};
use crate::formats::source::stem;
use crate::formats::whole::whole_file;
use crate::formats::{Format, LeftOut, Model, ModelFault, PartKind, ReadOptions, composed};
use crate::message::{Message, message};
use glam::DVec3;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use rustc_hash::FxHashMap;
use std::path::Path;

/// LandXML, `.xml`.
pub struct LandXml;

impl Format for LandXml {
    fn name(&self) -> &'static str {
        "LandXML"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["landxml", "xml"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        // the root element, in any encoding that contains ASCII
        head.windows(8).any(|word| word == b"<LandXML")
    }

    fn read(&self, path: &Path, _: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let mut file = LandXmlFile::default();
        let mut reader = Reader::from_reader(&bytes[..]);
        let mut buffer = Vec::new();
        loop {
            buffer.clear();
            match reader.read_event_into(&mut buffer).map_err(|error| damaged(error, reader.error_position()))? {
                Event::Start(start) => file.open(&start),
                Event::Empty(start) => {
                    file.open(&start);
                    file.close(start.local_name().as_ref())?;
                }
                Event::Text(text) => file.text.push_str(&text),
                Event::End(end) => file.close(end.local_name().as_ref())?,
                Event::Eof => break,
                // entities are not expanded: numbers have none
                _ => (),
            }
        }
        file.model(path)
    }
}

/// What was read of a file so far.
#[derive(Default)]
struct LandXmlFile {
    /// Metres per unit, if the file gives it.
    unit_m: Option<f64>,
    crs: Option<String>,
    /// The current surface.
    surface: Option<TinSurface>,
    surfaces: Vec<TinSurface>,
    /// Surfaces without triangles.
    without: u64,
    /// The number of faces marked as invisible.
    hidden: u64,
    /// The id of the current point, and whether the current face is hidden.
    point: Option<String>,
    is_hidden: bool,
    text: String,
}

#[derive(Default)]
struct TinSurface {
    name: String,
    numbers: FxHashMap<String, u32>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl LandXmlFile {
    fn open(&mut self, start: &BytesStart) {
        self.text.clear();
        match start.local_name().as_ref() {
            "Imperial" | "Metric" => {
                self.unit_m = attribute(start, "linearUnit").and_then(|unit| unit_m(&unit)).or(self.unit_m);
            }
            "CoordinateSystem" => {
                let code = attribute(start, "epsgCode").filter(|code| !code.is_empty() && code != "0");
                let code = code.map(|code| format!("EPSG:{}", code.trim_start_matches("EPSG:")));
                let name = attribute(start, "name").filter(|name| !name.trim().is_empty());
                self.crs = code.or_else(|| attribute(start, "ogcWktCode")).or(name).or(self.crs.take());
            }
            "Surface" => {
                let name = attribute(start, "name").unwrap_or_default();
                self.surface = Some(TinSurface { name: composed(name.trim()).into_owned(), ..TinSurface::default() });
            }
            "P" => self.point = attribute(start, "id"),
            "F" => self.is_hidden = attribute(start, "i").is_some_and(|hidden| hidden == "1"),
            _ => (),
        }
    }

    fn close(&mut self, name: &str) -> Result<(), ModelFault> {
        match (name, &mut self.surface) {
            ("P", Some(surface)) => {
                if let Some(id) = self.point.take() {
                    surface.point(id, &self.text)?;
                }
            }
            ("F", Some(surface)) => {
                if std::mem::take(&mut self.is_hidden) {
                    self.hidden += 1;
                } else {
                    surface.face(&self.text)?;
                }
            }
            ("Surface", _) => match self.surface.take() {
                Some(surface) if !surface.triangles.is_empty() => self.surfaces.push(surface),
                _ => self.without += 1,
            },
            _ => (),
        }
        self.text.clear();
        Ok(())
    }

    fn model(self, path: &Path) -> Result<Model, ModelFault> {
        let mut notes: Vec<Message> = Vec::new();
        // without a map, all three coordinates are in the file's unit
        let map = TerrainMap::of(self.crs, self.unit_m, self.unit_m, &mut notes);
        let sheets = self.surfaces.into_iter().map(|surface| -> NamedSheet {
            let name = if surface.name.is_empty() { stem(path) } else { surface.name };
            (name, surface.positions, surface.triangles, PartKind::Terrain)
        });
        let mut model = of_sheets(sheets.collect(), map, notes);
        let mut left_out = |what: &str, count: u64, why: &str| {
            if count > 0 {
                model.left_out.push(LeftOut { what: what.into(), count, why: why.into() });
            }
        };
        left_out("hidden faces", self.hidden, "the file marks them as not part of the surface");
        left_out("surfaces without triangles", self.without, "they are not TINs: export them triangulated");
        Ok(model)
    }
}

impl TinSurface {
    /// Reads a point: northing, easting, height.
    fn point(&mut self, id: String, text: &str) -> Result<(), ModelFault> {
        let numbers: Vec<f64> = text.split_ascii_whitespace().map_while(|word| word.parse().ok()).collect();
        let [northing, easting, height, ..] = numbers[..] else {
            return Err(
                message![format!("has no northing, easting and height in point {id}"); "export it again"].into()
            );
        };
        self.numbers.insert(id, self.positions.len() as u32);
        self.positions.push(DVec3::new(easting, northing, height));
        Ok(())
    }

    /// Reads a face: the ids of its three points, in either winding.
    fn face(&mut self, text: &str) -> Result<(), ModelFault> {
        let mut corners = text.split_ascii_whitespace().map(|id| self.numbers.get(id).copied());
        let (Some(Some(a)), Some(Some(b)), Some(Some(c))) = (corners.next(), corners.next(), corners.next()) else {
            return Err(message![
                format!("has a face with the points \"{}\", some of which are missing", text.trim());
                "export it again"
            ]
            .into());
        };
        let at = |corner: u32| self.positions[corner as usize].truncate();
        let looks_up = (at(b) - at(a)).perp_dot(at(c) - at(a)) >= 0.0;
        self.triangles.push(if looks_up { [a, b, c] } else { [a, c, b] });
        Ok(())
    }
}

fn attribute(start: &BytesStart, name: &str) -> Option<String> {
    let found = start.try_get_attribute(name).ok()??;
    Some(found.value.into_owned())
}

/// Metres per unit, by LandXML's names.
fn unit_m(name: &str) -> Option<f64> {
    match name {
        "millimeter" => Some(0.001),
        "centimeter" => Some(0.01),
        "meter" => Some(1.0),
        "kilometer" => Some(1000.0),
        "inch" => Some(0.0254),
        "foot" => Some(0.3048),
        "USSurveyFoot" => Some(1200.0 / 3937.0),
        _ => None,
    }
}

fn damaged(error: quick_xml::Error, at: u64) -> ModelFault {
    message![format!("is damaged at byte {at} ({error})"); "copy or export it again"].into()
}
