//! The shadow volumes as a model: a binary glTF 2.0 file with one node per caster, for any model viewer.

use super::report::{GroundReport, PlaceReport, ground_report, place_report, stamp, tz_version};
use super::{ExportError, report};
use crate::mesh::Mesh;
use crate::message::{Message, Words};
use crate::site::Ground;
use crate::sun::{Instant, Place};
use crate::volume::solid::Solid;
use glam::Vec3;
use gltf::binary::{Glb, Header};
use serde::Serialize;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::Path;

/// The volumes of one instant, and their casters.
#[derive(Clone, Copy, Debug)]
pub struct Volumes<'a> {
    /// The place on Earth.
    pub place: &'a Place,
    /// The instant, with the sun's direction.
    pub instant: &'a Instant,
    /// Whether the sun's direction includes refraction.
    pub refraction: bool,
    /// The ground plane.
    pub ground: Ground,
    /// The mesh whose components cast.
    pub mesh: &'a Mesh,
    /// At most one solid per component.
    pub solids: &'a [Solid],
    /// The number of casting components without a solid.
    pub left_out: usize,
    /// Notes from reading the models.
    pub notes: &'a [Message],
    /// The face's words.
    pub words: &'a dyn Words,
}

impl Volumes<'_> {
    fn name(&self, solid: &Solid) -> &str {
        &self.mesh.components[solid.component].name
    }

    fn sun(&self) -> Value {
        json!({
            "time": stamp(&self.instant.time),
            "azimuth_deg": self.instant.azimuth_rad.to_degrees(),
            "altitude_deg": self.instant.altitude_rad.to_degrees(),
        })
    }
}

/// Constants of the format (glTF 2.0, section 5).
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The file: one scene, with a node for each solid, which has the caster's name and `extras` that say the time.
///
/// # Errors
/// [`ExportError::Encode`] if there is no solid, or if the file would be 4 GiB or larger; this is found before memory
/// is allocated.
pub fn glb(volumes: &Volumes<'_>) -> Result<Vec<u8>, ExportError> {
    // The format forbids empty lists, and an empty file would be of no use.
    if volumes.solids.is_empty() {
        return Err(refused("there is no volume"));
    }
    let size = |solid: &Solid| 12 * (solid.vertices.len() as u64 + solid.triangles.len() as u64);
    let data: u64 = volumes.solids.iter().map(size).sum();
    let document = serde_json::to_vec(&document(volumes)).map_err(refused)?;
    let total = 12 + 8 + document.len().next_multiple_of(4) as u64 + 8 + data;
    let Ok(length) = u32::try_from(total) else {
        let gib = total as f64 / f64::from(1 << 30);
        return Err(refused(format!("it would be {gib:.1} GiB, and a GLB holds at most 4; let fewer components cast")));
    };
    let mut bytes = Vec::with_capacity(data as usize);
    for solid in volumes.solids {
        bytes.extend(solid.vertices.iter().flat_map(|&vertex| in_gltf(vertex)).flat_map(f32::to_le_bytes));
        bytes.extend(solid.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes()));
    }
    let header = Header { magic: *b"glTF", version: 2, length };
    Glb { header, json: Cow::Owned(document), bin: Some(Cow::Owned(bytes)) }.to_vec().map_err(refused)
}

fn refused(why: impl ToString) -> ExportError {
    ExportError::encode("shadow volumes", why)
}

fn document(volumes: &Volumes<'_>) -> Value {
    let mut document = json!({
        "asset": {"version": "2.0", "generator": concat!("gnomon ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{
            "name": "shadow volumes",
            "extras": {
                "place": place_report(volumes.place),
                "tz_version": tz_version(volumes.place),
                "ground": volumes.ground.level,
                "refraction": volumes.refraction,
                "sun": volumes.sun(),
            },
        }],
    });
    let mut lists = SolidLists::default();
    for solid in volumes.solids {
        lists.add(volumes, solid);
    }
    document["scenes"][0]["nodes"] = (0..lists.nodes.len()).collect();
    document["nodes"] = lists.nodes.into();
    document["meshes"] = lists.meshes.into();
    document["accessors"] = lists.accessors.into();
    document["bufferViews"] = lists.views.into();
    document["buffers"] = json!([{"byteLength": lists.bytes}]);
    document["materials"] = json!([{
        "name": "shadow volume",
        "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 0.78, 0.08, 0.3], "metallicFactor": 0.0, "roughnessFactor": 1.0,
        },
        "alphaMode": "BLEND",
        "doubleSided": true,
    }]);
    document
}

/// The lists of the document; each solid adds to them.
#[derive(Default)]
struct SolidLists {
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    /// The length of the buffer so far.
    bytes: usize,
}

impl SolidLists {
    fn add(&mut self, volumes: &Volumes<'_>, solid: &Solid) {
        let name = volumes.name(solid);
        let mut extras = volumes.sun();
        extras["caster"] = json!(name);
        self.nodes.push(json!({
            "name": name, "mesh": self.meshes.len(), "translation": in_gltf(solid.origin.as_vec3()), "extras": extras,
        }));
        let positions = self.accessors.len();
        self.meshes.push(json!({
            "name": name,
            "primitives": [{"attributes": {"POSITION": positions}, "indices": positions + 1, "material": 0}],
        }));
        let points = || solid.vertices.iter().map(|&vertex| Vec3::from(in_gltf(vertex)));
        let (vertices, corners) = (solid.vertices.len(), solid.triangles.len() * 3);
        let view = self.view(vertices * 12, ARRAY_BUFFER);
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "type": "VEC3", "count": vertices,
            "min": points().fold(Vec3::INFINITY, Vec3::min).to_array(),
            "max": points().fold(Vec3::NEG_INFINITY, Vec3::max).to_array(),
        }));
        let view = self.view(corners * 4, ELEMENT_ARRAY_BUFFER);
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "type": "SCALAR", "count": corners,
        }));
    }

    /// Adds the next part of the buffer. Returns its index.
    fn view(&mut self, length: usize, target: u32) -> usize {
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes, "byteLength": length, "target": target}));
        self.bytes += length;
        self.views.len() - 1
    }
}

/// East, north and up in glTF's axes: x east, y up, z south.
pub(super) fn in_gltf(point: Vec3) -> [f32; 3] {
    // + 0 turns −0 into 0
    [point.x, point.z, 0.0 - point.y].map(|metres| metres + 0.0)
}

#[derive(Serialize)]
struct VolumesReport<'a> {
    gnomon: &'static str,
    file: String,
    place: PlaceReport<'a>,
    tz_version: String,
    #[serde(flatten)]
    ground: GroundReport,
    refraction: bool,
    sun: Value,
    volumes: Vec<VolumeLine<'a>>,
    left_out: usize,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct VolumeLine<'a> {
    name: &'a str,
    triangles: usize,
    length_m: f64,
    closed: bool,
}

/// The JSON of `gnomon volumes`: which file was written, and for each volume whether it is closed.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(volumes: &Volumes<'_>, file: &Path) -> Result<String, ExportError> {
    let line = |solid| VolumeLine {
        name: volumes.name(solid),
        triangles: solid.triangles.len(),
        length_m: solid.length_m,
        closed: solid.closed(),
    };
    report::json(&VolumesReport {
        gnomon: env!("CARGO_PKG_VERSION"),
        file: file.display().to_string(),
        place: place_report(volumes.place),
        tz_version: tz_version(volumes.place),
        ground: ground_report(&volumes.ground),
        refraction: volumes.refraction,
        sun: volumes.sun(),
        volumes: volumes.solids.iter().map(line).collect(),
        left_out: volumes.left_out,
        notes: report::said(volumes.notes, volumes.words),
    })
}

/// What was written, and the ground at which the volumes end: two lines, the last without a line break.
pub(crate) fn summary(volumes: &Volumes<'_>) -> String {
    let triangles: usize = volumes.solids.iter().map(|solid| solid.triangles.len()).sum();
    format!(
        "{} of {triangles} triangles; the sun at azimuth {:.2}°, altitude {:.2}°\nground at {}",
        match volumes.solids.len() {
            1 => "1 shadow volume".to_owned(),
            count => format!("{count} shadow volumes"),
        },
        volumes.instant.azimuth_rad.to_degrees(),
        volumes.instant.altitude_rad.to_degrees(),
        volumes.ground.said(),
    )
}
