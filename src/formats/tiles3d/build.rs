//! Joins the contents of tiles into one model.

use super::b3dm::{MAGIC, TileGltf, cesium_center, opened};
use crate::formats::gltf::GltfContext;
use crate::formats::left_out::{LeftOutTally, label, listed};
use crate::formats::{Coordinates, LeftOut, MAX_TRIANGLES, Model, ModelFault, ReadOptions, SeeThrough, Up, gltf};
use crate::mesh::Part;
use crate::message::{Message, few, message};
use glam::{DMat4, DVec3};
use std::path::Path;

/// The range of distances of the Earth's surface and what stands on it from the Earth's centre, metres, with a margin.
const EARTH_M: std::ops::Range<f64> = 6.3e6..6.42e6;

/// The most notes on contents that are passed on, as thousands of tiles have the same.
const MOST_NOTES: usize = 10;

/// Why a content is left out whose own error is reported.
const UNREADABLE: &str = "the file cannot be read";

/// Collects the parts of all contents.
pub(super) struct TileBuilder {
    parts: Vec<Part>,
    see_through: Vec<SeeThrough>,
    notes: Vec<Message>,
    failed: Vec<String>,
    tally: LeftOutTally,
    triangles: u64,
    scale: Option<f64>,
}

impl TileBuilder {
    pub(super) fn new(scale: Option<f64>) -> Self {
        Self {
            parts: Vec::new(),
            see_through: Vec::new(),
            notes: Vec::new(),
            failed: Vec::new(),
            tally: LeftOutTally::default(),
            triangles: 0,
            scale,
        }
    }

    /// Counts a content that cannot be used.
    pub(super) fn fail(&mut self, name: &str, fault: &ModelFault) {
        self.tally.add("contents", UNREADABLE);
        if self.failed.len() < MOST_NOTES {
            self.failed.push(format!("{name} {fault}"));
        }
    }

    /// Adds a content. `name` is empty for a file with a single content.
    pub(super) fn add(
        &mut self,
        path: &Path,
        bytes: &[u8],
        name: &str,
        world: DMat4,
        is_y_up: bool,
    ) -> Result<(), ModelFault> {
        let TileGltf { gltf, center, names } = match bytes {
            bytes if bytes.starts_with(MAGIC) => opened(bytes)?,
            bytes if bytes.starts_with(b"i3dm") || bytes.starts_with(b"pnts") || bytes.starts_with(b"cmpt") => {
                let kind = String::from_utf8_lossy(&bytes[..4]);
                self.tally.add(&kind, "Gnomon reads b3dm, glb and glTF");
                return Ok(());
            }
            gltf => TileGltf { gltf, center: DVec3::ZERO, names: Vec::new() },
        };
        let options = ReadOptions { scale: self.scale, ..ReadOptions::default() };
        let model = gltf::read_bytes(gltf, path, &options, GltfContext { applied: &["CESIUM_RTC"], batch: &names })?;
        let center = center + gltf::json_in(gltf).map_or(DVec3::ZERO, cesium_center);
        let turned = if is_y_up { DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2) } else { DMat4::IDENTITY };
        self.join(model, name, world * DMat4::from_translation(center), turned)
    }

    /// Adds the parts of a model. `turned` turns them z up, then `world` places them. The two are separate so that
    /// quarter turns are exact.
    fn join(&mut self, model: Model, name: &str, world: DMat4, turned: DMat4) -> Result<(), ModelFault> {
        let is_turned = turned != DMat4::IDENTITY;
        let is_mirrored = world.determinant() < 0.0;
        let scale = [world.x_axis, world.y_axis, world.z_axis].map(|axis| axis.truncate().length());
        let scale = scale.into_iter().fold(0.0, f64::max);
        let first = self.parts.len();
        for mut part in model.parts {
            for corner in &mut part.positions {
                let upright = if is_turned { DVec3::new(corner.x, -corner.z, corner.y) } else { *corner };
                *corner = world.transform_point3(upright);
            }
            if !part.positions.iter().all(|corner| corner.is_finite()) {
                return Err(
                    message!["has corners that are not finite after its tile's transform"; "export it again"].into()
                );
            }
            if is_mirrored {
                part.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
            }
            part.coarse.iter_mut().for_each(|coarse| coarse.step_m *= scale);
            if !name.is_empty() {
                part.name = label(&format!("{name}/{}", part.name));
                part.aliases.push(name.to_owned());
            }
            self.triangles += part.triangles.len() as u64;
            self.parts.push(part);
        }
        for see_through in model.see_through {
            let parts = see_through.parts.into_iter().map(|part| first + part);
            match self.see_through.iter_mut().find(|known| known.material == see_through.material) {
                Some(known) => known.parts.extend(parts),
                None => {
                    let parts = parts.collect();
                    self.see_through.push(SeeThrough { material: see_through.material, parts });
                }
            }
        }
        for note in model.notes {
            if self.notes.len() < MOST_NOTES && !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
        Ok(())
    }

    /// Refuses more triangles than a model may have.
    pub(super) fn check_size(&self) -> Result<(), Message> {
        if self.triangles > MAX_TRIANGLES {
            let what = format!("has more than {MAX_TRIANGLES} triangles, which is the most that a model may have");
            return Err(message![what; "export a smaller region"]);
        }
        Ok(())
    }

    pub(super) fn finish(self) -> Result<Model, ModelFault> {
        self.finish_with(LeftOutTally::default())
    }

    /// Returns the model, with what the tileset leaves out.
    pub(super) fn finish_with(mut self, tileset: LeftOutTally) -> Result<Model, ModelFault> {
        let mut left_out = self.tally.into_left_out();
        left_out.extend(tileset.into_left_out());
        if self.parts.is_empty() {
            return Err(nothing(self.failed, &left_out).into());
        }
        if !self.failed.is_empty() {
            let what = format!("has contents that cannot be read: {}", few(self.failed));
            self.notes.insert(0, message![what; "copy the whole folder, or export it again"]);
        }
        let coordinates = if is_on_earth(&self.parts) {
            Coordinates::Map("EPSG:4978".into())
        } else {
            self.notes.push(message![
                "has coordinates that are not relative to the Earth's centre, and is read as a drawing without a place"
            ]);
            Coordinates::Local
        };
        Ok(Model {
            parts: self.parts,
            up: Up::Z,
            up_is_said: true,
            unit_m: Some(1.0),
            coordinates,
            left_out,
            notes: self.notes,
            see_through: self.see_through,
            ..Model::default()
        })
    }
}

/// The error that nothing was read, and why.
fn nothing(failed: Vec<String>, left_out: &[LeftOut]) -> Message {
    let is_told = |one: &&LeftOut| one.what == "contents" && one.why == UNREADABLE;
    let others: Vec<LeftOut> = left_out.iter().filter(|one| !is_told(one)).cloned().collect();
    let why: Vec<String> = [few(failed), listed(&others)].into_iter().filter(|why| !why.is_empty()).collect();
    let why = if why.is_empty() { String::new() } else { format!(" ({})", why.join("; ")) };
    let what = format!("has no content in its folder that can be read{why}");
    message![what; "copy the whole folder of the tileset, with its contents"]
}

/// Whether parts lie at the Earth's surface, relative to its centre.
fn is_on_earth(parts: &[Part]) -> bool {
    let corners = || parts.iter().flat_map(|part| &part.positions);
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = corners().fold(start, |(low, high), &corner| (low.min(corner), high.max(corner)));
    EARTH_M.contains(&((low + high) / 2.0).length())
}
