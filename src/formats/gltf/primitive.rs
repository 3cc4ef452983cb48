//! Reads a mesh's primitives as triangles of vertex indices, grouped by material.

use super::Fault;
use super::accessor::Accessors;
use super::document::Document;
use super::features::{Features, PrimitiveFeatures};
use super::reader::Reader;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;
use std::ops::Range;

/// The triangles of a mesh, checked except for the values of its indices and positions.
pub(super) struct MeshTriangles<'a> {
    /// The groups in the order in which their materials appear; those without triangles are left out.
    pub groups: Vec<MaterialGroup<'a>>,
    /// Whether the mesh has one material, including materials without triangles.
    pub one_material: bool,
}

/// The primitives of one mesh and material.
pub(super) struct MaterialGroup<'a> {
    /// Its index, if it has one.
    pub material: Option<usize>,
    /// Whether the colours of its vertices have an alpha channel.
    pub has_faded_vertices: bool,
    /// One or more, each with triangles.
    pub primitives: Vec<PrimitiveTriangles<'a>>,
}

/// A primitive with triangles.
pub(super) struct PrimitiveTriangles<'a> {
    /// The mesh's index.
    pub mesh: usize,
    /// The primitive's index in the mesh.
    pub primitive: usize,
    /// Its vertices.
    pub positions: Reader<'a>,
    /// The number of triangles, at least one.
    pub triangles: usize,
    /// The features of its vertices, if they have names.
    pub features: Option<PrimitiveFeatures<'a>>,
    indices: Option<Reader<'a>>,
    mode: Mode,
}

impl MaterialGroup<'_> {
    /// The number of triangles of all its primitives.
    pub(super) fn triangles(&self) -> u64 {
        self.primitives.iter().map(|primitive| primitive.triangles as u64).sum()
    }
}

/// Reads the primitives of mesh `index`; points and lines are skipped.
pub(super) fn of_mesh<'a>(
    document: &Document,
    accessors: &mut Accessors<'a, '_>,
    features: &Features,
    index: usize,
) -> Result<MeshTriangles<'a>, Fault> {
    let mut groups: Vec<MaterialGroup> = Vec::new();
    let mut group_of = BTreeMap::new();
    let primitives = document.meshes.get(index).map_or(&[][..], |mesh| &mesh.primitives);
    for (number, primitive) in primitives.iter().enumerate() {
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            Checked::Valid(_) => continue,
            Checked::Invalid => {
                return Err(Fault::of_primitive(index, number, "has a mode that glTF does not know"));
            }
        };
        let material = primitive.material.map(|material| material.value());
        let count = document.materials.len();
        if let Some(material) = material.filter(|&material| material >= count) {
            return Err(Fault::NoSuch {
                user: format!("primitive {number} of mesh {index}"),
                what: "material",
                index: material,
                count,
            });
        }
        let group = *group_of.entry(material).or_insert_with(|| {
            groups.push(MaterialGroup { material, has_faded_vertices: false, primitives: Vec::new() });
            groups.len() - 1
        });
        let mut triangles = triangles_of(accessors, (index, number), primitive, mode)?;
        if let Some(group) = groups.get_mut(group).filter(|_| triangles.triangles > 0) {
            group.has_faded_vertices |= has_faded_vertices(document, primitive);
            triangles.features = features.of_primitive(accessors, (index, number), primitive)?;
            group.primitives.push(triangles);
        }
    }
    groups.retain(|group| !group.primitives.is_empty());
    Ok(MeshTriangles { groups, one_material: group_of.len() == 1 })
}

/// Whether its vertices have colours with an alpha channel.
fn has_faded_vertices(document: &Document, primitive: &Primitive) -> bool {
    let colours = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0)));
    let accessor = colours.and_then(|colours| document.accessors.get(colours.value()));
    accessor.is_some_and(|accessor| accessor.type_ == Checked::Valid(Type::Vec4))
}

fn triangles_of<'a>(
    accessors: &mut Accessors<'a, '_>,
    (mesh, number): (usize, usize),
    primitive: &Primitive,
    mode: Mode,
) -> Result<PrimitiveTriangles<'a>, Fault> {
    let fault = |problem| Err(Fault::of_primitive(mesh, number, problem));
    let user = || format!("primitive {number} of mesh {mesh}");
    let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let positions = positions.map(|accessor| accessor.value());
    let indices = primitive.indices.map(|accessor| accessor.value());
    let Some(positions) = positions else {
        return fault("has no positions");
    };
    let positions = accessors.get(positions, user)?;
    // KHR_mesh_quantization allows all integer types except u32.
    if positions.shape != Type::Vec3 || positions.component == ComponentType::U32 {
        return fault("has positions of a type that glTF does not allow");
    }
    let indices = match indices {
        Some(indices) => Some(accessors.get(indices, user)?),
        None => None,
    };
    let is_index = |reader: Reader| {
        use ComponentType::{U8, U16, U32};
        matches!(reader.component, U8 | U16 | U32) && reader.shape == Type::Scalar
    };
    if !indices.is_none_or(is_index) {
        return fault("has indices of a type that glTF does not allow");
    }
    let corners = indices.map_or(positions.count, |indices| indices.count);
    let triangles = match mode {
        Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
        _ => corners / 3,
    };
    Ok(PrimitiveTriangles { mesh, primitive: number, positions, triangles, features: None, indices, mode })
}

impl PrimitiveTriangles<'_> {
    /// The vertices of some of its triangles, counter-clockwise, as indices into `positions`.
    ///
    /// Degenerate triangles of a strip, which only join its parts, are left out.
    pub(super) fn corners(&self, triangles: Range<usize>) -> Result<Vec<[u32; 3]>, Fault> {
        if let (Mode::Triangles, Some(indices)) = (self.mode, self.indices) {
            // a fast path for nearly all files: checks all indices together
            let vertices = indices.wholes(triangles.start * 3..triangles.end * 3);
            let most = self.positions.count.min(restart(&indices) as usize);
            if vertices.iter().all(|&vertex| (vertex as usize) < most) {
                return Ok(vertices.as_chunks().0.to_vec());
            }
        }
        triangles.filter_map(|index| self.triangle(index).transpose()).collect()
    }

    /// The vertices of triangle `index`; `None` for a degenerate triangle of a strip.
    fn triangle(&self, index: usize) -> Result<Option<[u32; 3]>, Fault> {
        let corners = match self.mode {
            Mode::TriangleStrip if index.is_multiple_of(2) => [index, index + 1, index + 2],
            Mode::TriangleStrip => [index, index + 2, index + 1],
            Mode::TriangleFan => [index + 1, index + 2, 0],
            _ => [index * 3, index * 3 + 1, index * 3 + 2],
        };
        let Some(indices) = self.indices else {
            // fits: triangles are counted in 32 bits
            return Ok(Some(corners.map(|corner| corner as u32)));
        };
        let vertices = corners.map(|corner| indices.whole(corner));
        for vertex in vertices {
            let count = self.positions.count;
            let is_restart = vertex == restart(&indices);
            if is_restart || vertex as usize >= count {
                let why = if is_restart { "glTF forbids that number" } else { "that is out of range" };
                let problem = format!("has vertex {vertex} of {count} in triangle {index}; {why}");
                return Err(Fault::of_primitive(self.mesh, self.primitive, problem));
            }
        }
        let [a, b, c] = vertices;
        let joins = self.mode == Mode::TriangleStrip && (a == b || b == c || c == a);
        Ok((!joins).then_some(vertices))
    }
}

/// The largest value of the type, which glTF reserves.
fn restart(indices: &Reader) -> u32 {
    match indices.component {
        ComponentType::U8 => u8::MAX.into(),
        ComponentType::U16 => u16::MAX.into(),
        _ => u32::MAX,
    }
}
