//! Reads XML events into tables. Elements are recognised by their local names, which are the same in versions 2 and 3
//! with few exceptions.

use super::polygon::{OpenPolygon, add_positions};
use super::tables::{GmlGeometry, GmlMember, GmlMemberKind, GmlObject, GmlTables, NamedGml};
use crate::message::{Message, message};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::io::BufRead;

/// The deepest that elements may be nested.
const MOST_DEEP: usize = 200;

/// The longest name or id that is kept.
const MOST_NAME_BYTES: usize = 1000;

/// The role of an element for the elements within it.
enum ElementRole {
    /// An object, or a candidate: it is an object if it contains a geometry.
    Feature(GmlFeature),
    /// A property with the geometry of a feature.
    Property(GmlProperty),
    /// A surface, a shell or a solid, whose members begin at this index.
    Group {
        first: usize,
        is_turned: bool,
    },
    /// A polygon, a patch or a triangle.
    Polygon,
    Ring,
    /// Text that is read, numbers or letters.
    Text,
    /// An element whose content is skipped.
    Skipped,
    /// Anything else.
    Other,
}

struct GmlFeature {
    serial: u64,
    kind: String,
    /// Whether it is a surface of the enclosing feature.
    is_surface: bool,
    name: Option<String>,
    object: Option<usize>,
    /// The number of objects and of library shapes before it.
    before: (usize, u64),
}

struct GmlProperty {
    lod: u8,
    is_solid: bool,
    first: usize,
}

/// An element that has not ended yet.
struct OpenElement {
    role: ElementRole,
    id: Option<String>,
    /// The numbers in a position, as the nearest element says.
    dimension: Option<u8>,
}

pub(super) fn scan(text: Box<dyn BufRead>) -> Result<GmlTables, Message> {
    let mut reader = Reader::from_reader(text);
    let mut scan = GmlScan {
        tables: GmlTables::default(),
        frames: Vec::new(),
        polygon: None,
        text: String::new(),
        serial: 0,
        implicit: 0,
    };
    let mut buffer = Vec::new();
    let mut has_root = false;
    loop {
        buffer.clear();
        let event = reader.read_event_into(&mut buffer);
        match event {
            Ok(Event::Start(element)) => {
                has_root = true;
                scan.open(&element)?;
            }
            Ok(Event::Empty(element)) => {
                scan.open(&element)?;
                scan.close(element.local_name().as_ref());
            }
            Ok(Event::End(element)) => scan.close(element.local_name().as_ref()),
            Ok(Event::Text(text)) => scan.add_text(&text),
            Ok(Event::CData(text)) => scan.add_text(&text),
            Ok(Event::GeneralRef(reference)) => scan.add_text(predefined(&reference)),
            Ok(Event::Eof) => break,
            Ok(_) => {}
            Err(error) => {
                let what = format!("is no XML at its byte {} ({error})", reader.error_position());
                return Err(message![what; "export it again"]);
            }
        }
    }
    if !has_root || !scan.frames.is_empty() {
        return Err(message!["is cut off"; "copy or export it again"]);
    }
    Ok(scan.tables)
}

/// The character of an entity that XML itself defines; others are not expanded.
fn predefined(name: &str) -> &'static str {
    match name {
        "amp" => "&",
        "lt" => "<",
        "gt" => ">",
        "quot" => "\"",
        "apos" => "'",
        _ => " ",
    }
}

struct GmlScan {
    tables: GmlTables,
    frames: Vec<OpenElement>,
    polygon: Option<OpenPolygon>,
    text: String,
    serial: u64,
    implicit: u64,
}

/// The attributes that are used.
#[derive(Default)]
struct GmlAttributes {
    id: Option<String>,
    href: Option<String>,
    dimension: Option<u8>,
    is_reversed: bool,
}

impl GmlScan {
    fn open(&mut self, element: &BytesStart<'_>) -> Result<(), Message> {
        if self.frames.len() >= MOST_DEEP {
            return Err(message![format!("has elements in more than {MOST_DEEP} others"); "export it again"]);
        }
        let local = element.local_name();
        let name: &str = local.as_ref();
        let is_within_skipped = self.frames.last().is_some_and(|frame| matches!(frame.role, ElementRole::Skipped));
        if is_within_skipped || is_skipped(name) {
            if !is_within_skipped && name == "ImplicitGeometry" {
                self.implicit += 1;
                self.tables.tally.add("ImplicitGeometry", "library shapes that are placed by a reference");
            }
            self.frames.push(OpenElement { role: ElementRole::Skipped, id: None, dimension: None });
            return Ok(());
        }
        let attributes = self.attributes(element, name);
        let dimension = attributes.dimension.or(self.frames.last().and_then(|frame| frame.dimension));
        let role = self.role(name, &attributes);
        if let Some(href) = &attributes.href {
            self.refer(name, href);
        }
        self.frames.push(OpenElement { role, id: attributes.id, dimension });
        Ok(())
    }

    fn attributes(&mut self, element: &BytesStart<'_>, name: &str) -> GmlAttributes {
        let mut found = GmlAttributes::default();
        for attribute in element.attributes().with_checks(false).flatten() {
            let key = attribute.key.local_name();
            let value = attribute.value.as_ref();
            match key.as_ref() {
                "id" if value.len() <= MOST_NAME_BYTES => found.id = Some(value.to_owned()),
                "href" if value.len() <= MOST_NAME_BYTES => found.href = Some(value.to_owned()),
                "srsDimension" => found.dimension = value.trim().parse().ok(),
                "orientation" if name == "OrientableSurface" => found.is_reversed = value.trim() == "-",
                "srsName" if value.len() <= MOST_NAME_BYTES => match &self.tables.system {
                    None => self.tables.system = Some(value.to_owned()),
                    Some(system) => self.tables.other_systems += u64::from(system != value),
                },
                _ => {}
            }
        }
        found
    }

    fn role(&mut self, name: &str, attributes: &GmlAttributes) -> ElementRole {
        match name {
            "posList" | "pos" | "coordinates" => {
                self.text.clear();
                return ElementRole::Text;
            }
            "name" if self.in_feature() => {
                self.text.clear();
                return ElementRole::Text;
            }
            "LinearRing" | "Ring" => return ElementRole::Ring,
            "Polygon" | "PolygonPatch" | "Triangle" | "Rectangle" => {
                self.polygon = Some(OpenPolygon::begin(&self.tables));
                return ElementRole::Polygon;
            }
            "Arc" | "ArcString" | "Circle" | "ArcByCenterPoint" | "BSpline" if self.polygon.is_some() => {
                self.tables.tally.add(name, "bounds of faces, of which only the points are read");
            }
            _ => {}
        }
        if is_group(name) {
            self.mark_solid(name);
            return ElementRole::Group { first: self.tables.members.len(), is_turned: attributes.is_reversed };
        }
        if self.in_feature() && name.starts_with(|c: char| c.is_lowercase()) {
            let lod = name.strip_prefix("lod").and_then(|rest| rest.chars().next()?.to_digit(10));
            let lod = lod.map_or(1, |lod| lod as u8);
            return ElementRole::Property(GmlProperty { lod, is_solid: false, first: self.tables.members.len() });
        }
        if name.starts_with(|c: char| c.is_uppercase()) && !is_never_feature(name) {
            self.serial += 1;
            let is_surface = is_surface(name);
            return ElementRole::Feature(GmlFeature {
                serial: self.serial,
                kind: name.to_owned(),
                is_surface,
                name: None,
                object: None,
                before: self.told(),
            });
        }
        ElementRole::Other
    }

    /// The number of objects and of library shapes so far.
    fn told(&self) -> (usize, u64) {
        (self.tables.objects.len(), self.implicit)
    }

    /// Whether the innermost element is a feature.
    fn in_feature(&self) -> bool {
        self.frames.last().is_some_and(|frame| matches!(frame.role, ElementRole::Feature(_)))
    }

    fn mark_solid(&mut self, name: &str) {
        if !matches!(name, "Solid" | "MultiSolid" | "CompositeSolid") {
            return;
        }
        let property = self.frames.iter_mut().rev().find_map(|frame| match &mut frame.role {
            ElementRole::Property(property) => Some(property),
            _ => None,
        });
        property.into_iter().for_each(|property| property.is_solid = true);
    }

    /// Records a reference within a geometry, or in the property that contains it.
    fn refer(&mut self, name: &str, href: &str) {
        let is_geometry = name.starts_with("lod")
            || matches!(
                name,
                "surfaceMember" | "baseSurface" | "exterior" | "interior" | "solidMember" | "shellMember" | "tin"
            );
        if !is_geometry {
            return;
        }
        let Some(id) = href.strip_prefix('#') else {
            self.tables.tally.add("xlink:href", "the reference is to another file");
            return;
        };
        self.add_member(GmlMemberKind::Reference(id.to_owned()));
    }

    fn add_member(&mut self, what: GmlMemberKind) {
        let turns = self.frames.iter().filter(|frame| matches!(frame.role, ElementRole::Group { is_turned: true, .. }));
        let is_turned = turns.count() % 2 == 1;
        self.tables.members.push(GmlMember { what, is_turned });
    }

    fn add_text(&mut self, text: &str) {
        if self.frames.last().is_some_and(|frame| matches!(frame.role, ElementRole::Text)) {
            self.text.push_str(text);
        }
    }

    fn close(&mut self, name: &str) {
        let Some(frame) = self.frames.pop() else { return };
        match frame.role {
            ElementRole::Text => self.end_text(name, frame.dimension),
            ElementRole::Ring => {
                if let Some(polygon) = &mut self.polygon {
                    polygon.end_ring(&mut self.tables);
                }
            }
            ElementRole::Polygon => {
                let Some(polygon) = self.polygon.take() else { return };
                match polygon.end(&mut self.tables) {
                    Some(polygon) => {
                        frame.id.into_iter().for_each(|id| self.name(id, NamedGml::Polygon(polygon)));
                        self.add_member(GmlMemberKind::Polygon(polygon));
                    }
                    None => self.tables.tally.add("faces", "no corners, or a damaged position"),
                }
            }
            ElementRole::Group { first, .. } => {
                let members = first..self.tables.members.len();
                frame.id.into_iter().for_each(|id| self.name(id, NamedGml::Members(members.clone())));
            }
            ElementRole::Property(property) => self.end_property(property, name),
            ElementRole::Feature(feature) => {
                let is_inner = self.frames.iter().any(|frame| matches!(frame.role, ElementRole::Feature(_)));
                if !is_inner && feature.before == self.told() {
                    self.tables.tally.add(&feature.kind, "no surfaces");
                }
                if let Some(object) = feature.object.and_then(|object| self.tables.objects.get_mut(object)) {
                    object.name = feature.name;
                }
            }
            ElementRole::Skipped | ElementRole::Other => {}
        }
    }

    fn name(&mut self, id: String, named: NamedGml) {
        self.tables.ids.entry(id).or_insert(named);
    }

    fn end_text(&mut self, name: &str, dimension: Option<u8>) {
        match name {
            "name" => {
                let text = self.text.trim();
                if let Some(OpenElement { role: ElementRole::Feature(feature), .. }) = self.frames.last_mut() {
                    let is_told = !text.is_empty() && text.len() <= MOST_NAME_BYTES;
                    feature.name = feature.name.take().or_else(|| is_told.then(|| text.to_owned()));
                }
            }
            "posList" | "pos" | "coordinates" => {
                let Some(polygon) = &mut self.polygon else { return };
                let separated = if name == "coordinates" { self.text.replace(',', " ") } else { String::new() };
                let text = if name == "coordinates" { &separated } else { &self.text };
                if add_positions(text, dimension, &mut self.tables.points).is_err() {
                    polygon.give_up();
                }
            }
            _ => {}
        }
    }

    /// Ends a property. Its geometry belongs to its object, or to one of the object's surfaces.
    fn end_property(&mut self, property: GmlProperty, name: &str) {
        let members = property.first..self.tables.members.len();
        if members.is_empty() || self.is_taken(&members) {
            return;
        }
        let is_solid = property.is_solid || name.ends_with("Solid");
        let surface = self.frames.iter().rev().find_map(|frame| match &frame.role {
            ElementRole::Feature(feature) => {
                Some(if feature.is_surface { feature.kind.clone() } else { String::new() })
            }
            _ => None,
        });
        let Some(object) = self.object() else {
            self.tables.tally.add("geometries", "they belong to no object");
            return;
        };
        let surface = surface.unwrap_or_default();
        self.tables.geometries.push(GmlGeometry { object, surface, lod: property.lod, is_solid, members });
    }

    /// Whether members already belong to a geometry: a property around a building's surfaces contains all of theirs.
    fn is_taken(&self, members: &std::ops::Range<usize>) -> bool {
        self.tables.geometries.last().is_some_and(|last| last.members.end > members.start)
    }

    /// The object that the innermost feature is, or is a surface of.
    fn object(&mut self) -> Option<usize> {
        let at =
            self.frames.iter().rposition(|frame| matches!(&frame.role, ElementRole::Feature(it) if !it.is_surface))?;
        if let Some(OpenElement { role: ElementRole::Feature(GmlFeature { object: Some(object), .. }), .. }) =
            self.frames.get(at)
        {
            return Some(*object);
        }
        let around = self.frames[..at].iter().filter_map(|frame| match &frame.role {
            ElementRole::Feature(feature) if !feature.is_surface => {
                Some((feature.serial, frame.id.clone().unwrap_or_default()))
            }
            _ => None,
        });
        let around: Vec<(u64, String)> = around.collect();
        let frame = self.frames.get_mut(at)?;
        let ElementRole::Feature(feature) = &mut frame.role else { return None };
        feature.object = Some(self.tables.objects.len());
        let id = frame.id.clone().unwrap_or_default();
        let (kind, serial) = (feature.kind.clone(), feature.serial);
        self.tables.objects.push(GmlObject { kind, id, name: None, serial, around });
        feature.object
    }
}

/// Elements whose polygons are not used, or that have none.
fn is_skipped(name: &str) -> bool {
    matches!(
        name,
        "ImplicitGeometry"
            | "appearance"
            | "appearanceMember"
            | "Appearance"
            | "extent"
            | "address"
            | "xalAddress"
            | "metaDataProperty"
            | "stringAttribute"
            | "intAttribute"
            | "doubleAttribute"
            | "genericAttribute"
    )
}

fn is_group(name: &str) -> bool {
    matches!(
        name,
        "MultiSurface"
            | "CompositeSurface"
            | "Surface"
            | "PolyhedralSurface"
            | "TriangulatedSurface"
            | "Tin"
            | "OrientableSurface"
            | "Shell"
            | "Solid"
            | "MultiSolid"
            | "CompositeSolid"
            | "MultiGeometry"
            | "GeometricComplex"
    )
}

/// Elements that begin with a capital but are not features.
fn is_never_feature(name: &str) -> bool {
    matches!(
        name,
        "CityModel" | "FeatureCollection" | "Envelope" | "LineString" | "Curve" | "Point" | "MultiCurve" | "MultiPoint"
    )
}

/// Surfaces of the enclosing feature: those around a building, its openings, the lanes of a road.
fn is_surface(name: &str) -> bool {
    name.ends_with("Surface") || matches!(name, "Door" | "Window" | "TrafficArea" | "AuxiliaryTrafficArea")
}
