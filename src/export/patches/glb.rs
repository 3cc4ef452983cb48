//! `surfaces.glb`: the model with its hours of sun as textures, a binary glTF 2.0 file that any model viewer opens.
//! It has one node per component and one primitive per page of the atlas; components that do not receive are plain. The
//! colours are those of the drawing, without shading by the viewer (KHR_materials_unlit). Each page also has a texture
//! with the numbers in 16-bit gray; `extras` of the scene say how many seconds a unit stands for.

use super::{Exposure, PatchContext, pages};
use crate::export::ExportError;
use crate::export::glb::{ARRAY_BUFFER, FLOAT, GlbFile, asset};
use crate::export::raster::png_bytes;
use crate::export::report::{place_report, stamp, tz_version};
use crate::export::volumes::in_gltf;
use crate::look::LOOK;
use crate::mesh::Component;
use crate::mesh::patches::Patch;
use glam::Vec3;
use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Constants of the format (glTF 2.0, section 5).
const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;
const CLAMP_TO_EDGE: u32 = 33071;

/// The name of this file in an error.
const WHAT: &str = "surfaces";

/// The value of a texel that belongs to no patch, in a texture of numbers.
const NO_NUMBER: u16 = u16::MAX;

/// The content of the file.
///
/// # Errors
/// [`ExportError::Encode`] if nothing receives, or if the file would be 4 GiB or larger.
pub fn glb(found: &PatchContext) -> Result<Vec<u8>, ExportError> {
    if found.patches.list.is_empty() {
        return Err(refused("no surface receives"));
    }
    let mut file = SurfaceFile::default();
    let seconds = seconds_a_unit(found);
    let pages = pages::pages(found.patches, found.hours);
    let images: Vec<[usize; 2]> =
        pages.iter().map(|page| file.images(found, page, seconds)).collect::<Result<_, _>>()?;
    let (mut nodes, mut meshes) = (Vec::new(), Vec::new());
    let mut node = |name: &str, primitives: Vec<Value>, extras: Value| {
        let translation = in_gltf(found.patches.origin.as_vec3());
        nodes.push(json!({"name": name, "mesh": meshes.len(), "translation": translation, "extras": extras}));
        meshes.push(json!({"name": name, "primitives": primitives}));
    };
    for (name, patches, exposure) in found.components() {
        let Exposure { area_m2, hours_mean, hours_min, hours_max, .. } = exposure;
        let extras =
            json!({"area_m2": area_m2, "hours_mean": hours_mean, "hours_min": hours_min, "hours_max": hours_max});
        node(name, file.primitives(found, patches), extras);
    }
    let components = found.mesh.components.iter().zip(found.receives);
    for (component, _) in components.filter(|(component, receives)| !**receives && !component.faces.is_empty()) {
        node(&component.name, vec![file.plain(found, component, pages.len())], json!({"judged": false}));
    }
    let materials: Vec<Value> = (0..pages.len()).map(material).chain([not_judged()]).collect();
    let mut document = json!({
        "asset": asset(),
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"name": "hours of sun", "nodes": (0..nodes.len()).collect::<Vec<_>>(), "extras": extras(found, seconds)}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "samplers": [{"magFilter": NEAREST, "minFilter": LINEAR, "wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE}],
    });
    document["textures"] =
        images.iter().flatten().map(|image| json!({"sampler": 0, "source": image})).collect::<Vec<_>>().into();
    document["images"] = file.images.into();
    file.glb.finish(WHAT, document)
}

fn refused(why: impl ToString) -> ExportError {
    ExportError::encode(WHAT, why)
}

/// How many seconds a unit in the textures of numbers stands for, so that the whole daylight fits.
fn seconds_a_unit(found: &PatchContext) -> u32 {
    found.hours.day_secs.div_ceil(u32::from(NO_NUMBER) - 1).max(1)
}

fn extras(found: &PatchContext, seconds: u32) -> Value {
    let instants = &found.track.instants;
    json!({
        "place": place_report(found.place),
        "tz_version": tz_version(found.place),
        "from": instants.first().map(|instant| stamp(&instant.time)),
        "to": instants.last().map(|instant| stamp(&instant.time)),
        "daylight_secs": found.hours.day_secs,
        "texel_m": found.patches.cell,
        "numbers": {"seconds_a_unit": seconds, "of_no_surface": NO_NUMBER},
    })
}

/// The material of a page: its first texture is colours, its second numbers.
fn material(page: usize) -> Value {
    json!({
        "name": format!("hours of sun, page {page}"),
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 2 * page}, "metallicFactor": 0.0, "roughnessFactor": 1.0,
        },
        "extensions": {"KHR_materials_unlit": {}},
        "doubleSided": true,
        "extras": {"numbers_texture": 2 * page + 1},
    })
}

/// The material of components that do not receive, in the drawing's colour for "not judged".
fn not_judged() -> Value {
    // to linear light, as the format requires
    let [red, green, blue] = LOOK.not_judged.map(|value| (f64::from(value) / 255.0).powf(2.2));
    json!({
        "name": "not judged",
        "pbrMetallicRoughness": {
            "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0,
        },
        "extensions": {"KHR_materials_unlit": {}},
        "doubleSided": true,
    })
}

/// The file while it is assembled.
#[derive(Default)]
struct SurfaceFile {
    glb: GlbFile,
    images: Vec<Value>,
}

impl SurfaceFile {
    /// A page's colours and numbers.
    fn images(&mut self, found: &PatchContext, page: &[u32], seconds: u32) -> Result<[usize; 2], ExportError> {
        let (bands, samples, side) = (found.bands(), found.hours.samples, found.patches.page_size);
        let is_empty = |lit: u32| lit == pages::EMPTY;
        let colour = |&lit: &u32| if is_empty(lit) { [255; 3] } else { bands.of_sun(lit, samples) };
        let number = |&lit: &u32| match is_empty(lit) {
            true => NO_NUMBER,
            false => (f64::from(lit) / (f64::from(samples) * f64::from(seconds))).round() as u16,
        };
        let colours: Vec<u8> = page.iter().flat_map(colour).collect();
        let numbers: Vec<u8> = page.iter().map(number).flat_map(u16::to_be_bytes).collect();
        let mut image = |name: &str, kind, pixels: &[u8]| {
            let bytes = png_bytes((side, side), kind, None, pixels).map_err(refused)?;
            let view = self.glb.view(bytes, None);
            self.images.push(json!({"name": name, "mimeType": "image/png", "bufferView": view}));
            Ok::<_, ExportError>(self.images.len() - 1)
        };
        Ok([
            image("colours", (png::ColorType::Rgb, png::BitDepth::Eight), &colours)?,
            image("numbers", (png::ColorType::Grayscale, png::BitDepth::Sixteen), &numbers)?,
        ])
    }

    /// The patches of a component, one primitive per page. Patches share no vertices, since each has its own texture
    /// coordinates.
    fn primitives(&mut self, found: &PatchContext, patches: &[Patch]) -> Vec<Value> {
        let mut of_pages: BTreeMap<u32, Vec<&Patch>> = BTreeMap::new();
        patches.iter().for_each(|patch| of_pages.entry(patch.page).or_default().push(patch));
        let primitive = |(page, patches): (u32, Vec<&Patch>)| {
            let (mut positions, mut places, mut corners) = (Vec::new(), Vec::new(), Vec::new());
            for patch in patches {
                append(found, patch, &mut positions, &mut places, &mut corners);
            }
            let place = self.glb.accessor(
                json!({"componentType": FLOAT, "type": "VEC2", "count": places.len()}),
                places.iter().flatten().copied().flat_map(f32::to_le_bytes),
                ARRAY_BUFFER,
            );
            let [position, indices] = self.glb.triangles(&positions, &corners);
            json!({"attributes": {"POSITION": position, "TEXCOORD_0": place}, "indices": indices, "material": page})
        };
        of_pages.into_iter().map(primitive).collect()
    }

    /// A component that does not receive, unchanged.
    fn plain(&mut self, found: &PatchContext, component: &Component, material: usize) -> Value {
        let mesh = found.mesh;
        let mut positions = Vec::new();
        let mut known: FxHashMap<u32, u32> = FxHashMap::default();
        let faces = &mesh.faces[component.faces.start as usize..component.faces.end as usize];
        let mut corner = |&vertex: &u32| {
            *known.entry(vertex).or_insert_with(|| {
                positions.push(Vec3::from(in_gltf(mesh.vertices[vertex as usize])));
                positions.len() as u32 - 1
            })
        };
        let corners: Vec<u32> = faces.iter().flatten().map(&mut corner).collect();
        let [position, indices] = self.glb.triangles(&positions, &corners);
        json!({"attributes": {"POSITION": position}, "indices": indices, "material": material})
    }
}

/// Adds the faces of a patch, wound so that their fronts are on the judged side.
fn append(
    found: &PatchContext,
    patch: &Patch,
    positions: &mut Vec<Vec3>,
    places: &mut Vec<[f32; 2]>,
    corners: &mut Vec<u32>,
) {
    let (mesh, patches) = (found.mesh, found.patches);
    let side = f64::from(patches.page_size);
    let mut known: FxHashMap<u32, u32> = FxHashMap::default();
    for &face in &patches.faces[patch.faces.start as usize..patch.faces.end as usize] {
        let mut face_corners = mesh.faces[face as usize].map(|vertex| {
            *known.entry(vertex).or_insert_with(|| {
                let local = mesh.vertices[vertex as usize];
                positions.push(Vec3::from(in_gltf(local)));
                places.push(patches.in_page(patch, local.as_dvec3()).map(|texels| (texels / side) as f32));
                positions.len() as u32 - 1
            })
        });
        if mesh.planes()[face as usize].truncate().dot(patch.normal()) < 0.0 {
            face_corners.swap(1, 2);
        }
        corners.extend(face_corners);
    }
}
