//! What a site file says about where a model stands; and models that only it places.

use super::file::Names;
use crate::formats::{Model, ReadOptions, SceneName, Up};
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

/// How a model is read and where it stands. It is scaled, then turned, then moved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placement {
    /// The scene; by default the file's default scene.
    pub scene: Option<SceneName>,
    /// The height of a footprint whose file gives none, metres.
    pub default_height_m: Option<f64>,
    /// The greatest error of a thinned terrain, metres.
    pub terrain_error_m: Option<f64>,
    /// The classes of measured points that are read besides the ground.
    pub point_classes: Vec<String>,
    /// The parts of the file that are read; by default all.
    pub layers: Option<Names>,
    /// The model's up axis; by default the file's or the format's.
    pub up: Option<Up>,
    /// Radians clockwise from the model's north (−Z if it is y up, +Y if it is z up) to true north. The model is turned
    /// by that angle the other way. By default the file's, otherwise 0.
    pub north_rad: Option<f64>,
    /// Metres east, north and up. By default as the file says, otherwise at the place.
    pub position: Option<DVec3>,
    /// Metres per model unit, above 0; by default the file's, otherwise 1.
    pub scale: Option<f64>,
    /// The reference system of its coordinates; by default the file's.
    pub crs: Option<String>,
}

impl Placement {
    /// The options for reading its file.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions {
            scene: self.scene.clone(),
            scale: self.scale,
            default_height_m: self.default_height_m,
            terrain_error_m: self.terrain_error_m.unwrap_or(ReadOptions::TERRAIN_ERROR_M),
            point_classes: self.point_classes.clone(),
        }
    }

    /// Places a model by these values alone, whatever its file says about its place on Earth. Positions and steps
    /// become metres in the world frame.
    pub fn place(&self, model: Model) -> Model {
        self.place_at(model, self.north_rad.unwrap_or_default(), self.position.unwrap_or_default())
    }

    /// The same, with north and position from another source.
    pub(super) fn place_at(&self, mut model: Model, north_rad: f64, position: DVec3) -> Model {
        let scale = self.unit_m(&model);
        let turned = DMat3::from_rotation_z(north_rad);
        let world_from_model = DAffine3::from_mat3_translation(turned * self.upright(&model) * scale, position);
        for part in &mut model.parts {
            let corners = part.positions.par_iter_mut();
            corners.for_each(|corner| *corner = world_from_model.transform_point3(*corner));
            part.coarse.iter_mut().for_each(|run| run.step_m *= scale);
        }
        model
    }

    /// The length of a model's unit, metres.
    pub(super) fn unit_m(&self, model: &Model) -> f64 {
        self.scale.or(model.unit_m).unwrap_or(1.0)
    }

    /// The rotation to z up. A y-up model has its north at −z: (x, y, z) becomes (x, −z, y). A z-up model already has
    /// the world's axes.
    pub(super) fn upright(&self, model: &Model) -> DMat3 {
        match self.up.unwrap_or(model.up) {
            Up::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            Up::Z => DMat3::IDENTITY,
        }
    }
}
