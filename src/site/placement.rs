//! What a site file says of where a model stands, and the models that stand by that alone.

use super::file::Names;
use crate::formats::{Model, ReadOptions, SceneName, Up};
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

/// How a model is read, and where it stands: it is scaled, turned, then moved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placement {
    /// The scene; by default the file's default scene.
    pub scene: Option<SceneName>,
    /// Metres from the ground to the roof of a footprint whose file says no height.
    pub default_height_m: Option<f64>,
    /// The greatest distance of a thinned terrain from its heights, metres.
    pub terrain_error_m: Option<f64>,
    /// The classes of measured points that are read besides the ground.
    pub point_classes: Vec<String>,
    /// Which parts of the file are read; all where none are said.
    pub layers: Option<Names>,
    /// Which of the model's axes is up; as its file or format says where none is said.
    pub up: Option<Up>,
    /// Radians clockwise from the model's north (−Z if its y is up, +Y if its z is) to true north; the model is turned
    /// by that angle the other way. By default the file's, otherwise 0.
    pub north_rad: Option<f64>,
    /// Metres east, north and up. By default where the file says, otherwise at the place.
    pub position: Option<DVec3>,
    /// Metres per model unit, above zero; by default the file's, otherwise 1.
    pub scale: Option<f64>,
    /// The reference system of its coordinates; by default the file's.
    pub crs: Option<String>,
}

impl Placement {
    /// The options for the reader.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions {
            scene: self.scene.clone(),
            scale: self.scale,
            default_height_m: self.default_height_m,
            terrain_error_m: self.terrain_error_m.unwrap_or(ReadOptions::TERRAIN_ERROR_M),
            point_classes: self.point_classes.clone(),
        }
    }

    /// Places a model by these values alone, whatever its file says of the Earth: positions and steps become metres in
    /// the world frame.
    pub fn place(&self, model: Model) -> Model {
        self.place_at(model, self.north_rad.unwrap_or_default(), self.position.unwrap_or_default())
    }

    /// The same with a north and a position that come from elsewhere, too.
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

    /// Metres of a model's unit.
    pub(super) fn unit_m(&self, model: &Model) -> f64 {
        self.scale.or(model.unit_m).unwrap_or(1.0)
    }

    /// A model that is y up has its north at −z: (x, y, z) becomes (x, −z, y). A model that is z up has the world's
    /// axes.
    pub(super) fn upright(&self, model: &Model) -> DMat3 {
        match self.up.unwrap_or(model.up) {
            Up::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            Up::Z => DMat3::IDENTITY,
        }
    }
}
