//! Writes a model as it was read to a binary glTF 2.0 file: in metres, y up, one node per component.
//!
//! Corners are `f32` around one common origin in whole metres, which is the translation of the nodes. A model near its
//! own zero keeps that zero, and one that was read from glTF keeps its exact numbers. What glTF cannot express is in
//! `extras` under `gnomon`: for a component its other names and its kind; for the scene where its zero is on Earth,
//! which way true north is, and what else the file says about itself. `formats::gltf::own` reads it.

use super::contents::{self, ContentsReport, MostLines};
use super::glb::{GlbFile, asset};
use super::volumes::in_gltf;
use super::{ExportError, report};
use crate::formats::{Anchor, AnchorPoint, LeftOut, Model, PartKind};
use crate::message::{Field, Words};
use crate::site::PlacedModel;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::Path;

/// The name of this file in an error.
const WHAT: &str = "model";

/// A model whose corners are nearer to its zero than this keeps its zero, metres. `f32` has steps of 0.06 mm there.
const NEAR_M: f64 = 1000.0;

/// The content of the file.
///
/// # Errors
/// [`ExportError::Encode`] if it would be 4 GiB or larger; this is found before memory is allocated.
pub fn glb(placed: &PlacedModel) -> Result<Vec<u8>, ExportError> {
    let parts = &placed.model.parts;
    let size = parts.iter().map(|part| 12 * (part.positions.len() as u64 + part.triangles.len() as u64)).sum();
    if size > u64::from(u32::MAX) {
        return Err(too_large(size));
    }
    let (origin, material_of) = (origin(placed), materials(&placed.model));
    let mut file = GlbFile::default();
    let (mut nodes, mut meshes) = (Vec::with_capacity(parts.len()), Vec::with_capacity(parts.len()));
    for (index, part) in parts.iter().enumerate() {
        let local = |corner: &DVec3| Vec3::from(in_gltf((corner - origin).as_vec3()));
        let positions: Vec<Vec3> = part.positions.par_iter().map(local).collect();
        let [position, indices] = file.triangles(&positions, part.triangles.as_flattened());
        let mut primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
        if let Some(material) = material_of[index] {
            primitive["material"] = material.into();
        }
        meshes.push(json!({"name": part.name, "primitives": [primitive]}));
        let mut node = json!({"name": part.name, "mesh": index});
        if origin != DVec3::ZERO {
            node["translation"] = json!([origin.x, origin.z, 0.0 - origin.y]);
        }
        node["extras"] = json!({"gnomon": component(&placed.model, index)});
        nodes.push(node);
    }
    let mut document = json!({
        "asset": asset(),
        "scene": 0,
        "scenes": [{
            "name": placed.name,
            "nodes": (0..nodes.len()).collect::<Vec<_>>(),
            "extras": {"gnomon": scene(placed)},
        }],
        "nodes": nodes,
        "meshes": meshes,
    });
    // glTF forbids empty lists
    if !placed.model.see_through.is_empty() {
        document["materials"] = placed.model.see_through.iter().map(|it| translucent(&it.material)).collect();
    }
    file.finish(WHAT, document).map_err(|error| match error {
        ExportError::LargeGlb { size } => too_large(size),
        error => error,
    })
}

/// For each part, which of the see-through materials it has.
fn materials(model: &Model) -> Vec<Option<usize>> {
    let mut of_part = vec![None; model.parts.len()];
    for (index, material) in model.see_through.iter().enumerate() {
        for part in &material.parts {
            of_part[*part] = Some(index);
        }
    }
    of_part
}

/// A see-through material. How transparent it is, is not known.
fn translucent(name: &str) -> Value {
    json!({
        "name": name,
        "alphaMode": "BLEND",
        "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [1.0, 1.0, 1.0, 0.5], "metallicFactor": 0.0},
    })
}

/// The extras of a component.
fn component(model: &Model, index: usize) -> Value {
    let mut told = json!({"aliases": model.parts[index].aliases});
    let kind = model.kind(index);
    if kind != PartKind::Building {
        told["kind"] = kind.word().into();
    }
    if model.is_from_ground(index) {
        told["from_ground"] = true.into();
    }
    told
}

fn too_large(size: u64) -> ExportError {
    let gib = size as f64 / f64::from(1 << 30);
    ExportError::encode(WHAT, format!("it would be {gib:.1} GiB, and a GLB holds at most 4; export the model in parts"))
}

/// The point to which all corners are relative.
fn origin(placed: &PlacedModel) -> DVec3 {
    let corners = placed.model.parts.par_iter().flat_map(|part| &part.positions);
    let none = || (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = corners
        .fold(none, |(low, high), corner| (low.min(*corner), high.max(*corner)))
        .reduce(none, |one, other| (one.0.min(other.0), one.1.max(other.1)));
    match low.abs().max(high.abs()).max_element() < NEAR_M {
        true => DVec3::ZERO,
        // +0 turns −0 into 0
        false => ((low + high) / 2.0).round() + 0.0,
    }
}

/// What the file says about the model as a whole.
fn scene(placed: &PlacedModel) -> Value {
    let model = &placed.model;
    let left_out = |LeftOut { what, count, why }: &LeftOut| json!({"what": what, "count": count, "why": why});
    let mut told = placed.zero.as_ref().map_or(json!({}), |zero| anchor(zero, placed.scale_m));
    told["source"] = json!(placed.name);
    told["format"] = model.format.into();
    told["left_out"] = model.left_out.iter().map(left_out).collect();
    // glTF defines unit and axis, but many programs write other ones: this says that they are meant
    if placed.unit_is_said {
        told["unit_m"] = 1.0.into();
    }
    if placed.up_is_said {
        told["up"] = "y".into();
    }
    if !model.anchors.is_empty() {
        let said = |found: &Anchor| {
            let mut told = anchor(found, placed.scale_m);
            told["said_by"] = found.said_by.into();
            told
        };
        told["anchors"] = model.anchors.iter().map(said).collect();
    }
    told
}

/// An anchor. Directions are clockwise from the model's north, −z, in degrees.
fn anchor(anchor: &Anchor, scale_m: f64) -> Value {
    let mut told = match &anchor.at {
        AnchorPoint::Map { crs, easting, northing, height, scale } => json!({
            "crs": crs, "easting": easting, "northing": northing, "height": height, "map_metres": scale / scale_m,
        }),
        AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m } => json!({
            "latitude": latitude_deg, "longitude": longitude_deg, "elevation": elevation_m,
        }),
        AnchorPoint::Nowhere => json!({}),
    };
    if let Some(north) = anchor.north_rad {
        told["north"] = north.to_degrees().into();
    }
    told
}

/// The JSON of `gnomon convert`: which file was written, and its content.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(placed: &PlacedModel, file: &Path) -> Result<String, ExportError> {
    report::json(&json!({
        "gnomon": env!("CARGO_PKG_VERSION"),
        "file": file.display().to_string(),
        "components": placed.model.parts.len(),
        "triangles": placed.model.triangles(),
        "model": ContentsReport::of(&placed.contents),
        "notes": placed.notes,
    }))
}

/// What was written, and what of the file was left out, as lines for people.
pub(crate) fn summary(placed: &PlacedModel, words: &dyn Words) -> String {
    let (parts, triangles) = (placed.model.parts.len(), placed.model.triangles());
    let components = if parts == 1 { "component" } else { "components" };
    let faces = if triangles == 1 { "triangle" } else { "triangles" };
    format!(
        "{parts} {components}, {triangles} {faces}\n{}",
        contents::table(std::slice::from_ref(&placed.contents), MostLines::OrSee(Field::Json), words)
    )
}
