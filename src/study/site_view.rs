//! One view of a site: what is judged in it, and which parts of the site it contains.

use super::machine::Machine;
use super::{InstantWants, StudyError};
use crate::choice::Receivers;
use crate::mesh::Mesh;
use crate::picture::overlay::VolumePicture;
use crate::shadow::ray_cast::RayCast;
use crate::shadow::{GpuSurface, Scene, ShadowError, Technique, plan_surface};
use crate::site::Site;
use crate::view::{Camera, Mask, Overlay, Surface, Tile, View};
use glam::DVec3;

/// One view of a site, by one machine.
pub(super) struct SiteView<'a> {
    pub(super) site: &'a Site,
    pub(super) machine: &'a Machine,
    pub(super) view: View,
    pub(super) receivers: Receivers,
}

impl SiteView<'_> {
    pub(super) fn technique(&self) -> Result<Box<dyn Technique>, StudyError> {
        self.machine.technique(self.scene(), self.view)
    }

    pub(super) fn technique_of(&self, tile: Tile) -> Result<Box<dyn Technique>, StudyError> {
        self.machine.technique_of(self.scene(), tile)
    }

    pub(super) fn scene(&self) -> Scene {
        let mesh = &self.site.mesh;
        let receivers = mesh.of_components(&self.site.judges(self.receivers));
        let casters = mesh.of_components(&self.site.casts);
        Scene { casters, receivers, ground: self.site.ground.level }
    }

    /// The volumes and silhouette of a camera's picture, at twice its resolution: a drawing on paper shows more detail.
    pub(super) fn overlay(&self, wants: &InstantWants, to_sun: DVec3) -> Result<Option<Overlay>, ShadowError> {
        let (Some(gpu), View::Camera(camera)) = (self.machine.gpu(), self.view) else { return Ok(None) };
        if !(wants.volumes || wants.silhouette) {
            return Ok(None);
        }
        let fine = Camera { width: camera.width * 2, height: camera.height * 2, ..camera };
        let scene = self.scene();
        let picture = VolumePicture::new(gpu, &scene, fine, to_sun)?;
        Ok(Some(Overlay {
            width: fine.width,
            height: fine.height,
            layers: wants.volumes.then(|| picture.layers()).transpose()?,
            silhouette: wants.silhouette.then(|| picture.silhouette()).transpose()?,
        }))
    }

    /// The mesh that the drawing shows: the receivers; if only the ground is judged, all models.
    pub(super) fn surface_mesh(&self) -> Mesh {
        match self.receivers {
            Receivers::Top | Receivers::Patches => self.site.mesh.of_components(&self.site.receives),
            Receivers::Ground => self.site.mesh.clone(),
        }
    }

    pub(super) fn surface(&self, technique: &dyn Technique) -> Result<Surface, ShadowError> {
        if self.receivers != Receivers::Ground {
            return technique.surface();
        }
        let receivers = self.surface_mesh();
        match (self.machine.gpu(), self.view) {
            (None, View::Plan(grid)) => Ok(plan_surface(&receivers, self.site.ground.level, &grid)),
            (gpu, view) => {
                let casters = self.site.mesh.of_components(&[]);
                let scene = Scene { casters, receivers, ground: self.site.ground.level };
                match gpu {
                    Some(gpu) => GpuSurface::draw(gpu, &scene, view)?.read(),
                    None => RayCast::new(scene, view, None).surface(),
                }
            }
        }
    }
}

/// A mask in which nothing sees the sun.
pub(super) fn night(view: &View) -> Mask {
    let (width, height) = view.size();
    Mask { width, height, share: vec![0; width as usize * height as usize] }
}
