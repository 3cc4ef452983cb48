//! Turns the boundaries of a geometry into faces.

use super::document::{Boundaries, CityDocument, CityGeometry, SurfaceNumbers, VertexTransform};
use crate::formats::ModelFault;
use crate::formats::city::{CityBuilder, Rank};
use glam::{DMat4, DVec3};

/// The shapes that instances refer to, shared by all lines of a sequence.
#[derive(Clone, Copy)]
pub(super) struct Templates<'a> {
    shapes: &'a [CityGeometry],
    vertices: &'a [[f64; 3]],
}

impl<'a> Templates<'a> {
    /// Reads them from the first document.
    pub(super) fn of(document: &'a CityDocument<'_>) -> Self {
        let templates = document.templates.as_ref();
        Self {
            shapes: templates.map_or(&[], |templates| &templates.templates),
            vertices: templates.map_or(&[], |templates| &templates.vertices),
        }
    }
}

/// A geometry with surfaces, with the source of its vertices.
pub(super) struct CityShape<'a> {
    geometry: &'a CityGeometry,
    vertices: &'a [[f64; 3]],
    transform: VertexTransform,
    /// The transform of an instance.
    stands: Option<DMat4>,
    /// Its rank among the object's geometries.
    pub rank: Rank,
    /// The number of lists around a face.
    depth: usize,
}

/// Why a geometry has no shape.
pub(super) const NO_SURFACES: &str = "no surfaces";

impl<'a> CityShape<'a> {
    /// The shape of a geometry, or why it has none.
    pub(super) fn of(
        geometry: &'a CityGeometry,
        document: &'a CityDocument<'_>,
        transform: &VertexTransform,
        templates: &Templates<'a>,
    ) -> Result<Self, &'static str> {
        let (shape, vertices, own, stands) = match geometry.kind.as_str() {
            "GeometryInstance" => {
                let shape = geometry.template.and_then(|template| templates.shapes.get(template));
                let shape = shape.ok_or("the template is not in the file")?;
                let Boundaries::Ring(at) = &geometry.boundaries else { return Err("they have no position") };
                let at =
                    at.first().and_then(|&at| document.vertices.get(at as usize)).ok_or("they have no position")?;
                let rows =
                    geometry.matrix.map_or(DMat4::IDENTITY, |matrix| DMat4::from_cols_array(&matrix).transpose());
                let stands = DMat4::from_translation(transform.apply(*at)) * rows;
                (shape, templates.vertices, VertexTransform::default(), Some(stands))
            }
            _ => (geometry, document.vertices.as_slice(), *transform, None),
        };
        let depth = match shape.kind.as_str() {
            "MultiSurface" | "CompositeSurface" => 1,
            "Solid" => 2,
            "MultiSolid" | "CompositeSolid" => 3,
            _ => return Err(NO_SURFACES),
        };
        let lod = shape.lod.as_deref().or(geometry.lod.as_deref()).unwrap_or_default();
        let lod = lod.trim().parse().ok().filter(|lod: &f64| lod.is_finite()).unwrap_or(0.0);
        Ok(Self { geometry: shape, vertices, transform: own, stands, rank: Rank { is_solid: depth > 1, lod }, depth })
    }

    /// Gives its faces to the builder.
    pub(super) fn build(&self, builder: &mut CityBuilder) -> Result<(), ModelFault> {
        let numbers = self.geometry.semantics.as_ref().map_or(&SurfaceNumbers::None, |semantics| &semantics.values);
        let mut face = FaceOfRings { points: Vec::new(), ends: Vec::new() };
        self.walk(&self.geometry.boundaries, self.depth, numbers, &mut face, builder)
    }

    /// Descends through nested lists; at depth 0 there is a face.
    fn walk(
        &self,
        boundaries: &Boundaries,
        depth: usize,
        numbers: &SurfaceNumbers,
        face: &mut FaceOfRings,
        builder: &mut CityBuilder,
    ) -> Result<(), ModelFault> {
        let Boundaries::Lists(lists) = boundaries else {
            builder.tally.add("geometries", "boundaries nested as those of a different type");
            return Ok(());
        };
        if depth == 0 {
            return self.face(lists, numbers, face, builder);
        }
        for (at, inner) in lists.iter().enumerate() {
            let inner_numbers = match numbers {
                SurfaceNumbers::Lists(lists) => lists.get(at).unwrap_or(&SurfaceNumbers::None),
                // one number for everything within, as some exporters write
                one => one,
            };
            self.walk(inner, depth - 1, inner_numbers, face, builder)?;
        }
        Ok(())
    }

    fn face(
        &self,
        rings: &[Boundaries],
        number: &SurfaceNumbers,
        face: &mut FaceOfRings,
        builder: &mut CityBuilder,
    ) -> Result<(), ModelFault> {
        face.points.clear();
        face.ends.clear();
        for ring in rings {
            let Boundaries::Ring(ring) = ring else {
                builder.tally.add("faces", "rings that are not lists of vertices");
                return Ok(());
            };
            for &vertex in ring {
                let Some(&vertex) = self.vertices.get(vertex as usize) else {
                    builder.tally.add("faces", "a vertex is not in the file");
                    return Ok(());
                };
                face.points.push(self.place(vertex));
            }
            face.ends.push(face.points.len());
        }
        let is_mirrored = self.stands.is_some_and(|stands| stands.determinant() < 0.0);
        builder.face(self.surface(number), &face.points, &face.ends, is_mirrored)
    }

    /// The kind of surface; empty if there is none.
    fn surface(&self, number: &SurfaceNumbers) -> &str {
        let SurfaceNumbers::Number(number) = number else { return "" };
        let surfaces = self.geometry.semantics.as_ref().map(|semantics| semantics.surfaces.as_slice());
        surfaces.and_then(|surfaces| surfaces.get(*number)).map_or("", |surface| surface.kind.trim_start_matches('+'))
    }

    fn place(&self, vertex: [f64; 3]) -> DVec3 {
        let vertex = self.transform.apply(vertex);
        self.stands.map_or(vertex, |stands| stands.transform_point3(vertex))
    }
}

/// The rings of one face, with buffers that are reused.
struct FaceOfRings {
    points: Vec<DVec3>,
    ends: Vec<usize>,
}
