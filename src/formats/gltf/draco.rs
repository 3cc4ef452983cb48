//! KHR_draco_mesh_compression: decodes a primitive's compressed bytes into the elements of its accessors.
//!
//! The decoder is `draco-core`, which is pure Rust. Its input is untrusted, so a panic in it is caught.

use super::document::Document;
use super::feature_attributes::names_features;
use super::{Fault, MAX_TRIANGLES};
use draco_core::mesh_decoder::MeshDecoder;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::{Checked, USize64};
use serde_json::Value;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

const DRACO: &str = "KHR_draco_mesh_compression";

/// The elements of an accessor, one after another.
pub(super) struct UnpackedElements {
    pub bytes: Vec<u8>,
    /// The step between neighbouring values, if they were quantised.
    pub step: Option<f64>,
}

/// A primitive's compression; `None` if it is not compressed, or is also stored uncompressed.
pub(super) fn compression<'a>(document: &Document, primitive: &'a Primitive) -> Option<&'a Value> {
    let said = primitive.extensions.as_ref()?.others.get(DRACO)?;
    let is_stored = |accessor: usize| {
        let accessor = document.accessors.get(accessor);
        accessor.is_some_and(|accessor| accessor.buffer_view.is_some())
    };
    let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let is_plain = positions.is_some_and(|positions| is_stored(positions.value()))
        && primitive.indices.is_none_or(|indices| is_stored(indices.value()));
    (!is_plain).then_some(said)
}

/// Whether the file has compressed primitives.
pub(super) fn is_used(document: &Document) -> bool {
    let mut primitives = document.meshes.iter().flat_map(|mesh| &mesh.primitives);
    primitives.any(|primitive| compression(document, primitive).is_some())
}

/// The view with a primitive's compressed bytes.
pub(super) fn view(said: &Value) -> Option<usize> {
    usize::try_from(said.get("bufferView")?.as_u64()?).ok()
}

/// Unpacks a primitive's indices, and the attributes that move its vertices or identify their features.
pub(super) fn unpack(
    document: &Document,
    (mesh, number): (usize, usize),
    primitive: &Primitive,
    (said, source): (&Value, &[u8]),
    into: &mut BTreeMap<usize, UnpackedElements>,
) -> Result<(), Fault> {
    let fault = |problem: String| Fault::of_primitive(mesh, number, format!("{problem} (Draco)"));
    if primitive.mode != Checked::Valid(Mode::Triangles) {
        return Err(fault("is compressed, and is not a list of triangles".into()));
    }
    let decoded = decode(source).map_err(|why| fault(format!("cannot be unpacked: {why}")))?;
    let points = decoded.num_points();
    for (semantic, accessor) in &primitive.attributes {
        let name = match semantic {
            Checked::Valid(Semantic::Positions) => "POSITION".to_owned(),
            Checked::Valid(Semantic::Joints(set)) => format!("JOINTS_{set}"),
            Checked::Valid(Semantic::Weights(set)) => format!("WEIGHTS_{set}"),
            Checked::Valid(Semantic::Extras(name)) if names_features(name) => format!("_{name}"),
            // no other attribute affects positions or features
            _ => continue,
        };
        let id = said.get("attributes").and_then(|ids| ids.get(&name)?.as_u64());
        let Some(id) = id.and_then(|id| u32::try_from(id).ok()) else { continue };
        let index = accessor.value();
        let Some((component, shape)) = element(document, index, points) else {
            return Err(fault(format!("unpacks to {points} vertices, but accessor {index} has a different number")));
        };
        let Some(attribute) = decoded.attribute_by_unique_id(id) else {
            return Err(fault(format!("has no {name} in its unpacked attributes")));
        };
        let numbers = attribute.read_f32s(points, shape.multiplicity());
        let step = if name == "POSITION" { rounding(source, &numbers) } else { None };
        into.insert(index, UnpackedElements { bytes: stored(&numbers, component), step });
    }
    let Some(indices) = primitive.indices.map(|indices| indices.value()) else { return Ok(()) };
    let corners: Vec<u32> = decoded.faces().iter().flatten().map(|point| point.0).collect();
    let Some((component, _)) = element(document, indices, corners.len()) else {
        return Err(fault(format!(
            "unpacks to {} corners, but accessor {indices} has a different number",
            corners.len()
        )));
    };
    let bytes = match component {
        ComponentType::U8 => corners.iter().map(|&corner| corner as u8).collect(),
        ComponentType::U16 => corners.iter().flat_map(|&corner| (corner as u16).to_le_bytes()).collect(),
        _ => corners.iter().flat_map(|corner| corner.to_le_bytes()).collect(),
    };
    into.insert(indices, UnpackedElements { bytes, step: None });
    Ok(())
}

fn decode(source: &[u8]) -> Result<Mesh, String> {
    let limits = DecodeLimits::default().with_max_faces(MAX_TRIANGLES).with_max_points(3 * MAX_TRIANGLES);
    let decode = || {
        let (mut buffer, mut mesh) = (DecoderBuffer::new(source).with_limits(limits), Mesh::new());
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh)
    };
    match catch_unwind(AssertUnwindSafe(decode)) {
        Ok(Ok(mesh)) => Ok(mesh),
        Ok(Err(error)) => Err(error.to_string()),
        Err(_) => Err("its bytes are damaged".into()),
    }
}

/// The type of an accessor's elements, if it has `count` of them.
fn element(document: &Document, accessor: usize, count: usize) -> Option<(ComponentType, Type)> {
    let accessor = document.accessors.get(accessor)?;
    let (Checked::Valid(component), Checked::Valid(shape)) = (&accessor.component_type, &accessor.type_) else {
        return None;
    };
    let USize64(said) = accessor.count;
    (said == count as u64).then_some((component.0, *shape))
}

fn stored(numbers: &[f32], component: ComponentType) -> Vec<u8> {
    let each = numbers.iter();
    match component {
        ComponentType::I8 => each.flat_map(|&number| (number as i8).to_le_bytes()).collect(),
        ComponentType::U8 => each.flat_map(|&number| (number as u8).to_le_bytes()).collect(),
        ComponentType::I16 => each.flat_map(|&number| (number as i16).to_le_bytes()).collect(),
        ComponentType::U16 => each.flat_map(|&number| (number as u16).to_le_bytes()).collect(),
        ComponentType::U32 => each.flat_map(|&number| (number as u32).to_le_bytes()).collect(),
        ComponentType::F32 => each.flat_map(|number| number.to_le_bytes()).collect(),
    }
}

/// The step to which positions were quantised; `None` if they were not. The decoder does not report it, but the stream
/// contains it (specification, "DecodeQuantizationData"): the minimum of each axis, which is also in the positions,
/// then the largest range of an axis, and the number of bits that divide it.
fn rounding(source: &[u8], numbers: &[f32]) -> Option<f64> {
    let points = numbers.as_chunks::<3>().0;
    let first = points.first()?;
    let (mut low, mut high) = (*first, *first);
    for point in points {
        for (axis, &number) in point.iter().enumerate() {
            if let (Some(low), Some(high)) = (low.get_mut(axis), high.get_mut(axis)) {
                (*low, *high) = (low.min(number), high.max(number));
            }
        }
    }
    let reach = low.iter().zip(&high).map(|(low, high)| high - low).fold(0.0, f32::max);
    let [x, y, z] = low.map(f32::to_le_bytes);
    let least = [x, y, z].concat();
    source.windows(17).find_map(|bytes| {
        let (numbers, behind) = bytes.split_at_checked(12)?;
        let (range, bits) = behind.split_first_chunk::<4>()?;
        let (range, bits) = (f32::from_le_bytes(*range), *bits.first()?);
        let is_it = numbers == least && (1..=30).contains(&bits) && (range - reach).abs() <= 1e-3 * reach;
        is_it.then(|| f64::from(range) / f64::from((1_u32 << bits) - 1))
    })
}
