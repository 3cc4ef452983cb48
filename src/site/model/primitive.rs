//! A mesh's primitives → which vertices make which triangles, grouped by material.

use super::Fault;
use super::accessor::{Accessors, Reader};
use super::document::Document;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;

const DRACO: &str = "KHR_draco_mesh_compression";

/// The triangles of a mesh, checked but for the values of its indices and positions.
pub(super) struct Surfaces<'a> {
    /// In the order in which the materials appear; those without triangles are left out.
    pub groups: Vec<Group<'a>>,
    /// Whether the mesh has one material, be it with triangles or without.
    pub one_material: bool,
}

/// The primitives of one mesh and material.
pub(super) struct Group<'a> {
    /// Its number, where it has one.
    pub material: Option<usize>,
    /// One or more, each with triangles.
    pub surfaces: Vec<Surface<'a>>,
}

/// A primitive with triangles.
pub(super) struct Surface<'a> {
    /// The mesh's number.
    pub mesh: usize,
    /// The primitive's number in it.
    pub primitive: usize,
    /// Its vertices.
    pub positions: Reader<'a>,
    /// One or more.
    pub triangles: usize,
    indices: Option<Reader<'a>>,
    mode: Mode,
}

impl Group<'_> {
    /// How many triangles all its primitives have.
    pub(super) fn triangles(&self) -> u64 {
        self.surfaces
            .iter()
            .map(|surface| surface.triangles as u64)
            .sum()
    }
}

/// Reads what the primitives of mesh `index` say; points and lines are skipped.
pub(super) fn surfaces<'a>(
    document: &Document,
    accessors: &mut Accessors<'a, '_>,
    index: usize,
) -> Result<Surfaces<'a>, Fault> {
    let mut groups: Vec<Group> = Vec::new();
    let mut group_of = BTreeMap::new();
    let primitives = document
        .meshes
        .get(index)
        .map_or(&[][..], |mesh| &mesh.primitives);
    for (number, primitive) in primitives.iter().enumerate() {
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => {
                mode
            }
            Checked::Valid(_) => continue,
            Checked::Invalid => {
                return Err(fault(index, number, "has a mode that glTF does not know"));
            }
        };
        let material = primitive.material.map(|material| material.value());
        if let Some(index_of_material) =
            material.filter(|&material| material >= document.materials.len())
        {
            return Err(Fault::NoSuch {
                user: format!("primitive {number} of mesh {index}"),
                what: "material",
                index: index_of_material,
                count: document.materials.len(),
            });
        }
        let group = *group_of.entry(material).or_insert_with(|| {
            groups.push(Group {
                material,
                surfaces: Vec::new(),
            });
            groups.len() - 1
        });
        let surface = surface(accessors, (index, number), primitive, mode)?;
        if let Some(group) = groups.get_mut(group).filter(|_| surface.triangles > 0) {
            group.surfaces.push(surface);
        }
    }
    groups.retain(|group| !group.surfaces.is_empty());
    Ok(Surfaces {
        groups,
        one_material: group_of.len() == 1,
    })
}

fn surface<'a>(
    accessors: &mut Accessors<'a, '_>,
    (mesh, number): (usize, usize),
    primitive: &Primitive,
    mode: Mode,
) -> Result<Surface<'a>, Fault> {
    let user = || format!("primitive {number} of mesh {mesh}");
    let extensions = primitive.extensions.as_ref();
    let is_compressed = extensions.is_some_and(|found| found.others.contains_key(DRACO));
    let compressed = || Fault::Compressed {
        what: format!("primitive {number} of mesh {mesh} is"),
        extension: DRACO.into(),
    };
    let Some(positions) = primitive
        .attributes
        .get(&Checked::Valid(Semantic::Positions))
    else {
        if is_compressed {
            return Err(compressed());
        }
        return Err(fault(mesh, number, "has no positions"));
    };
    let positions = accessors.get(positions.value(), user)?;
    let indices = match primitive.indices {
        Some(indices) => Some(accessors.get(indices.value(), user)?),
        None => None,
    };
    let all_stored = positions.has_view && indices.is_none_or(|indices| indices.has_view);
    if is_compressed && !all_stored {
        return Err(compressed());
    }
    // U32 is what KHR_mesh_quantization leaves out, too.
    if positions.shape != Type::Vec3 || positions.component == ComponentType::U32 {
        return Err(fault(
            mesh,
            number,
            "has positions of a type that glTF does not allow",
        ));
    }
    let is_index = |reader: Reader| {
        let whole = matches!(
            reader.component,
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32
        );
        whole && reader.shape == Type::Scalar
    };
    if !indices.is_none_or(is_index) {
        return Err(fault(
            mesh,
            number,
            "has indices of a type that glTF does not allow",
        ));
    }
    let corners = indices.map_or(positions.count, |indices| indices.count);
    let triangles = match mode {
        Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
        _ => corners / 3,
    };
    Ok(Surface {
        mesh,
        primitive: number,
        positions,
        triangles,
        indices,
        mode,
    })
}

impl Surface<'_> {
    /// The vertices of triangle `index`, counter-clockwise; each is one of `positions`.
    ///
    /// None for a triangle of a strip that only joins what lies before and behind it.
    pub(super) fn triangle(&self, index: usize) -> Result<Option<[usize; 3]>, Fault> {
        let corners = match self.mode {
            Mode::TriangleStrip if index % 2 == 0 => [index, index + 1, index + 2],
            Mode::TriangleStrip => [index, index + 2, index + 1],
            Mode::TriangleFan => [index + 1, index + 2, 0],
            _ => [index * 3, index * 3 + 1, index * 3 + 2],
        };
        let Some(indices) = self.indices else {
            return Ok(Some(corners));
        };
        let vertices = corners.map(|corner| indices.whole(corner));
        let restart = match indices.component {
            ComponentType::U8 => u32::from(u8::MAX),
            ComponentType::U16 => u32::from(u16::MAX),
            _ => u32::MAX,
        };
        for vertex in vertices {
            let count = self.positions.count;
            if vertex == restart || vertex as usize >= count {
                let why = if vertex == restart {
                    "glTF forbids that number"
                } else {
                    "that is out of range"
                };
                let problem =
                    format!("names vertex {vertex} of {count} in triangle {index}; {why}");
                return Err(fault(self.mesh, self.primitive, problem));
            }
        }
        let [a, b, c] = vertices.map(|vertex| vertex as usize);
        let joins = self.mode == Mode::TriangleStrip && (a == b || b == c || c == a);
        Ok((!joins).then_some([a, b, c]))
    }
}

pub(super) fn fault(mesh: usize, primitive: usize, problem: impl Into<String>) -> Fault {
    Fault::Primitive {
        mesh,
        primitive,
        problem: problem.into(),
    }
}
