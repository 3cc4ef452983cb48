//! Reads meshes: sources of positions, and the triangles, polygons, strips and fans that use them.

use super::document::{DaeDocument, DaeGeometry};
use super::xml::{DaeXml, attribute, local_id};
use crate::formats::MAX_TRIANGLES;
use crate::formats::left_out::label;
use crate::formats::ply::of_strip;
use crate::message::{Message, message};
use glam::DVec3;
use quick_xml::events::BytesStart;
use rustc_hash::FxHashMap;

/// Numbers, and how points are stored in them.
#[derive(Default)]
struct DaeSource {
    numbers: Vec<f64>,
    offset: usize,
    stride: usize,
}

/// A mesh that is being read.
#[derive(Default)]
struct DaeMesh {
    sources: FxHashMap<String, DaeSource>,
    /// The id of the source of the positions.
    positions: Option<String>,
    primitives: Vec<DaePrimitive>,
}

/// Rings of vertices of one kind and material.
#[derive(Default)]
struct DaePrimitive {
    kind: String,
    material: Option<String>,
    /// The number of indices per corner, and which of them is the vertex.
    stride: usize,
    vertex: usize,
    vertices: Vec<u32>,
    /// The ends of rings; empty for triangles.
    ends: Vec<usize>,
    /// For each ring, whether it is a hole in the one before.
    holes: Vec<bool>,
}

impl DaeGeometry {
    /// Reads the current element as a geometry.
    pub(super) fn read(xml: &mut DaeXml, element: &BytesStart, document: &mut DaeDocument) -> Result<(), Message> {
        let id = attribute(element, "id").unwrap_or_default();
        let name = label(&attribute(element, "name").unwrap_or_default());
        let mut geometry = DaeGeometry { name, ..DaeGeometry::default() };
        xml.children(|xml, name, _| match name {
            "mesh" => {
                let mut mesh = DaeMesh::default();
                xml.children(|xml, name, element| mesh.element(xml, name, element, document))?;
                geometry.fill(mesh, document)
            }
            "convex_mesh" | "spline" | "brep" => {
                document.left_out.add(&format!("geometries of the kind {name}"), "only meshes are read");
                xml.skip()
            }
            _ => xml.skip(),
        })?;
        document.geometries.insert(id, geometry);
        Ok(())
    }

    /// Cuts a mesh into triangles.
    fn fill(&mut self, mesh: DaeMesh, document: &mut DaeDocument) -> Result<(), Message> {
        let source = mesh.positions.as_ref().and_then(|id| mesh.sources.get(id));
        if let Some(source) = source {
            self.positions = source.points();
        }
        for primitive in mesh.primitives {
            let count = self.positions.len();
            if let Some(vertex) = primitive.vertices.iter().find(|&&vertex| vertex as usize >= count) {
                let what = format!("has a face of `{}` with vertex {vertex}, but there are only {count}", self.name);
                return Err(message![what; "the file is damaged: export it again"]);
            }
            let triangles = self.cut(&primitive, document);
            document.triangles += triangles.len() as u64;
            if document.triangles > MAX_TRIANGLES {
                let what = format!("has more than {MAX_TRIANGLES} triangles");
                return Err(message![what; "export it in parts or with less detail"]);
            }
            if !triangles.is_empty() {
                self.surfaces.push((primitive.material, triangles));
            }
        }
        Ok(())
    }

    fn cut(&self, primitive: &DaePrimitive, document: &mut DaeDocument) -> Vec<[u32; 3]> {
        if primitive.kind == "triangles" {
            return primitive.vertices.as_chunks().0.to_vec();
        }
        let mut triangles = Vec::new();
        let mut corners: Vec<DVec3> = Vec::new();
        for (ring, ends) in primitive.rings() {
            match primitive.kind.as_str() {
                "tristrips" => triangles.extend(of_strip(ring)),
                "trifans" => triangles.extend(ring.windows(2).skip(1).filter_map(|two| match *two {
                    [a, b] => Some([*ring.first()?, a, b]),
                    _ => None,
                })),
                _ => {
                    corners.clear();
                    corners.extend(ring.iter().filter_map(|&vertex| self.positions.get(vertex as usize)));
                    let vertex = |corner: u32| ring.get(corner as usize).copied().unwrap_or(0);
                    let cut = document.cutter.triangles(&corners, &ends, &mut document.left_out);
                    triangles.extend(cut.iter().map(|triangle| triangle.map(vertex)));
                }
            }
        }
        triangles
    }
}

impl DaePrimitive {
    /// Each ring with its holes, and the end of each.
    fn rings(&self) -> impl Iterator<Item = (&[u32], Vec<usize>)> {
        let mut at = 0_usize;
        std::iter::from_fn(move || {
            let begin = at.checked_sub(1).and_then(|last| self.ends.get(last)).map_or(0, |&end| end);
            let mut end = *self.ends.get(at)?;
            let mut ends = vec![end - begin];
            at += 1;
            while self.holes.get(at) == Some(&true) {
                end = *self.ends.get(at)?;
                ends.push(end - begin);
                at += 1;
            }
            Some((self.vertices.get(begin..end)?, ends))
        })
    }

    /// Adds the corners in the current element as one ring.
    fn ring(&mut self, xml: &mut DaeXml, is_hole: bool) -> Result<(), Message> {
        self.corners(xml)?;
        self.ends.push(self.vertices.len());
        self.holes.push(is_hole);
        Ok(())
    }

    fn corners(&mut self, xml: &mut DaeXml) -> Result<(), Message> {
        let (stride, vertex) = (self.stride.max(1), self.vertex);
        xml.wholes(|before, whole| {
            if before % stride == vertex {
                self.vertices.push(whole);
            }
        })
    }
}

impl DaeMesh {
    fn element(
        &mut self,
        xml: &mut DaeXml,
        name: &str,
        element: &BytesStart,
        document: &mut DaeDocument,
    ) -> Result<(), Message> {
        match name {
            "source" => {
                let id = attribute(element, "id").unwrap_or_default();
                let source = DaeSource::read(xml)?;
                self.sources.insert(id, source);
                Ok(())
            }
            "vertices" => xml.each("input", |xml, element| {
                if attribute(element, "semantic").as_deref() == Some("POSITION") {
                    self.positions = local_id(element, "source");
                }
                xml.skip()
            }),
            "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => {
                let material = attribute(element, "material");
                let mut primitive = DaePrimitive { kind: name.to_owned(), material, ..DaePrimitive::default() };
                primitive.read(xml)?;
                self.primitives.push(primitive);
                Ok(())
            }
            "lines" | "linestrips" => {
                document.left_out.add("line sets", "no surface");
                xml.skip()
            }
            _ => xml.skip(),
        }
    }
}

impl DaePrimitive {
    fn read(&mut self, xml: &mut DaeXml) -> Result<(), Message> {
        let mut counts: Vec<u32> = Vec::new();
        xml.children(|xml, name, element| match name {
            "input" => {
                let offset = attribute(element, "offset").and_then(|offset| offset.trim().parse::<u16>().ok());
                let offset = usize::from(offset.unwrap_or(0));
                self.stride = self.stride.max(offset + 1);
                if attribute(element, "semantic").as_deref() == Some("VERTEX") {
                    self.vertex = offset;
                }
                xml.skip()
            }
            "vcount" => xml.wholes(|_, count| counts.push(count)),
            "p" if self.kind == "triangles" || self.kind == "polylist" => self.corners(xml),
            "p" => self.ring(xml, false),
            "ph" => xml.children(|xml, name, _| match name {
                "p" => self.ring(xml, false),
                "h" => self.ring(xml, true),
                _ => xml.skip(),
            }),
            _ => xml.skip(),
        })?;
        if self.kind == "polylist" {
            self.count_out(&counts)?;
        }
        Ok(())
    }

    /// Splits the corners of a list of polygons by the number of corners of each.
    fn count_out(&mut self, counts: &[u32]) -> Result<(), Message> {
        let mut end = 0_usize;
        for &count in counts {
            end = end.saturating_add(count as usize);
            if end > self.vertices.len() {
                return Err(message![
                    "has a list of polygons with fewer corners than it states"; "the file is damaged: export it again"
                ]);
            }
            self.ends.push(end);
            self.holes.push(false);
        }
        Ok(())
    }
}

impl DaeSource {
    fn read(xml: &mut DaeXml) -> Result<Self, Message> {
        let mut source = Self { stride: 3, ..Self::default() };
        xml.children(|xml, name, _| match name {
            "float_array" => {
                source.numbers = xml.numbers()?;
                Ok(())
            }
            "technique_common" => xml.each("accessor", |xml, element| {
                let count = |name| attribute(element, name).and_then(|text| text.trim().parse::<u16>().ok());
                source.offset = count("offset").unwrap_or(0).into();
                source.stride = count("stride").unwrap_or(1).into();
                xml.skip()
            }),
            _ => xml.skip(),
        })?;
        Ok(source)
    }

    fn points(&self) -> Vec<DVec3> {
        let numbers = self.numbers.get(self.offset..).unwrap_or_default();
        let each = numbers.chunks(self.stride.max(3));
        each.filter_map(|point| point.first_chunk().map(|&point| DVec3::from_array(point))).collect()
    }
}
