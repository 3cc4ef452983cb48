//! Draws a site in one view after another and under one sun after another, on an adapter that stays open.
//!
//! The techniques are those of `study::instant`; what differs is that resources are kept between pictures.

use super::chooser::choose;
use super::machine::Machine;
use super::{StudyError, night};
use crate::choice::{Method, Receivers, Settings};
use crate::gpu::Gpu;
use crate::picture::overlay::VolumePicture;
use crate::picture::{Picture, Style};
use crate::profile::Provenance;
use crate::shadow::ray_cast::RayCast;
use crate::shadow::{DrawnMask, Scene, Technique};
use crate::site::Site;
use crate::view::{Camera, FragmentCounts, Mask, View};
use glam::DVec3;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The greatest distance of an eye, in lengths of the models. The allowance for rounding in rays covers it.
pub(crate) const FARTHEST: f64 = 40.0;

/// How shadows are found in a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveMethod {
    /// The technique.
    pub method: Method,
    /// Its settings.
    pub settings: Settings,
}

impl LiveMethod {
    /// The fastest method on a software adapter: rays, one per pixel.
    ///
    /// The cost of maps and volumes grows with the model, and a quick look has few pixels. At a few hundred pixels a
    /// side, a map takes about as long as rays do on the tower (docs/benchmarks/desktop.md), and has coarse edges.
    pub fn quickest() -> LiveMethod {
        LiveMethod { method: Method::RayCast, settings: Settings::default() }
    }
}

/// A site, a view of it, and the resources that draw it.
pub struct Live {
    gpu: Arc<Gpu>,
    /// The site without its models.
    site: Site,
    view: View,
    scene: Scene,
    picture: Picture,
    /// The view of the picture's current surfaces, and whether rays computed them.
    looks_at: (View, bool),
    /// The technique, the view that it is turned to, and the method that it was made for.
    made: Option<(View, LiveMethod, Box<dyn Technique>)>,
    /// Ray casting turns to another view at no cost. It has this many samples of the sun.
    rays: Option<(RayCast, Option<u32>)>,
    /// The volumes and silhouette, with the camera that they were last drawn for.
    volumes: Option<VolumePicture>,
    night: Mask,
}

impl Live {
    /// Uploads the site, and draws what the view sees.
    ///
    /// # Errors
    /// [`StudyError::Shadow`] if the adapter cannot hold it.
    pub fn new(site: &Site, gpu: Arc<Gpu>, view: View) -> Result<Live, StudyError> {
        let casters = site.mesh.of_components(&site.casts);
        let receivers = site.mesh.of_components(&site.receives);
        let scene = Scene { casters, receivers, ground: site.ground.level };
        let picture = Picture::new(Arc::clone(&gpu), &scene, view)?;
        Ok(Live {
            gpu,
            site: without_models(site),
            view,
            scene,
            picture,
            looks_at: (view, false),
            made: None,
            rays: None,
            volumes: None,
            night: night(&view),
        })
    }

    /// Takes over a changed site, if the same models receive in the same way, and keeps everything that does not depend
    /// on the change. Returns `false` if the scene is a different one.
    pub fn change_to(&mut self, site: &Site) -> bool {
        let seen = |of: &Site| (of.receives.clone(), of.ground.level);
        let is_same_mesh = Arc::ptr_eq(&self.scene.receivers.vertices, &site.mesh.vertices);
        if !is_same_mesh || seen(&self.site) != seen(site) {
            return false;
        }
        let receiving = site.mesh.components.iter().zip(&site.receives).filter(|(_, receives)| **receives);
        let is_terrain = receiving.map(|(component, _)| component.is_terrain);
        if !self.scene.receivers.components.iter().map(|component| component.is_terrain).eq(is_terrain) {
            return false;
        }
        if self.site.casts != site.casts {
            self.scene.casters = site.mesh.of_components(&site.casts);
            (self.made, self.rays, self.volumes) = (None, None, None);
        }
        self.site = without_models(site);
        true
    }

    /// The picture, to lay something over it.
    pub fn picture(&mut self) -> &mut Picture {
        &mut self.picture
    }

    /// Turns to another view. What was laid over the old view is removed.
    pub fn look_at(&mut self, view: View) {
        if view != self.view {
            (self.view, self.night) = (view, night(&view));
        }
        self.picture.clear();
    }

    /// Draws the view under a sun into the target (of [`Picture::target`]), and returns what drew it. If the sun is
    /// below the horizon it is night.
    ///
    /// # Errors
    /// [`StudyError::Misfit`] if the method does not fit the view; otherwise errors of drawing.
    pub fn draw(
        &mut self,
        way: &LiveMethod,
        to_sun: DVec3,
        style: &Style,
        target: &wgpu::Texture,
    ) -> Result<Provenance, StudyError> {
        let machine = self.machine(way)?;
        let drawn = machine.drawn();
        let is_night = to_sun.z <= 0.0;
        if machine.method() == Method::RayCast {
            let sun_samples = machine.settings().sun_samples;
            let rays = self.rays.take().filter(|(_, samples)| *samples == sun_samples);
            let new = || (RayCast::new(self.scene.clone(), far_view(&self.scene), sun_samples), sun_samples);
            let (rays, _) = self.rays.insert(rays.unwrap_or_else(new));
            if rays.view() != self.view {
                rays.look_at(self.view);
            }
            if self.looks_at != (self.view, true) {
                self.picture.look_at(&self.scene, self.view, Some(&rays.faces()))?;
                self.looks_at = (self.view, true);
            }
            let mask = if is_night { DrawnMask::Memory(&self.night) } else { rays.draw(to_sun)? };
            self.picture.draw(&mask, to_sun, style, target)?;
            return Ok(drawn);
        }
        if self.looks_at != (self.view, false) {
            self.picture.look_at(&self.scene, self.view, None)?;
            self.looks_at = (self.view, false);
        }
        if is_night {
            self.picture.draw(&DrawnMask::Memory(&self.night), to_sun, style, target)?;
            return Ok(drawn);
        }
        let technique = made(&mut self.made, machine, (self.view, *way), &self.scene)?;
        self.picture.draw(&technique.draw(to_sun)?, to_sun, style, target)?;
        Ok(drawn)
    }

    /// Returns how much counting the sun takes in this view, if the technique counts.
    ///
    /// # Errors
    /// As [`Live::draw`].
    pub fn counted(&mut self, way: &LiveMethod, to_sun: DVec3) -> Result<Option<FragmentCounts>, StudyError> {
        let machine = self.machine(way)?;
        if to_sun.z <= 0.0 || machine.gpu().is_none() {
            return Ok(None);
        }
        let technique = made(&mut self.made, machine, (self.view, *way), &self.scene)?;
        Ok(technique.counted(to_sun)?)
    }

    /// Lays shadow volumes and silhouette over a camera's view.
    ///
    /// # Errors
    /// Errors of drawing.
    pub fn lay_overlay(&mut self, to_sun: DVec3, volumes: bool, silhouette: bool) -> Result<(), StudyError> {
        let View::Camera(camera) = self.view else { return Ok(()) };
        if to_sun.z <= 0.0 || !(volumes || silhouette) {
            return Ok(());
        }
        // twice the resolution, so that lines are as thin as in a drawing
        let most = self.gpu.limits.max_texture_dimension_2d;
        let times = if camera.width.max(camera.height) * 2 <= most { 2 } else { 1 };
        let fine = Camera { width: camera.width * times, height: camera.height * times, ..camera };
        let seen = match self.volumes.take() {
            Some(mut kept) => {
                kept.turn_to(fine, to_sun)?;
                kept
            }
            None => VolumePicture::new(Arc::clone(&self.gpu), &self.scene, fine, to_sun)?,
        };
        let seen = self.volumes.insert(seen);
        let layers = volumes.then(|| seen.layers()).transpose()?;
        let ink = silhouette.then(|| seen.silhouette()).transpose()?;
        self.picture.lay_overlay((fine.width, fine.height), layers.as_deref(), ink.as_deref());
        Ok(())
    }

    /// The machine that the command would choose.
    fn machine(&mut self, way: &LiveMethod) -> Result<Machine, StudyError> {
        (self.site.method, self.site.settings) = (way.method, way.settings);
        choose(Some(&self.gpu), &self.site, &self.view, &mut |_| ControlFlow::Continue(()))
    }
}

/// The site without its models. A live view judges everything that it sees.
fn without_models(site: &Site) -> Site {
    Site { mesh: site.mesh.of_components(&[]), receivers: Receivers::Top, ..site.clone() }
}

/// The current technique, turned to the view; a new one if it cannot turn or was made for a different method.
fn made<'a>(
    at_hand: &'a mut Option<(View, LiveMethod, Box<dyn Technique>)>,
    machine: Machine,
    (view, way): (View, LiveMethod),
    scene: &Scene,
) -> Result<&'a mut Box<dyn Technique>, StudyError> {
    let kept = match at_hand.take().filter(|(_, of_way, _)| *of_way == way) {
        Some((of_view, _, mut technique)) => (of_view == view || technique.turn_to(view)?).then_some(technique),
        None => None,
    };
    let technique = match kept {
        Some(kept) => kept,
        None => machine.technique(scene.clone(), view)?,
    };
    Ok(&mut at_hand.insert((view, way, technique)).2)
}

/// A view with one cell from the greatest distance, for rays that will turn to all other views.
pub(crate) fn far_view(scene: &Scene) -> View {
    let (low, high) = scene.receivers.bounds().or(scene.casters.bounds()).unwrap_or_default();
    let length = (high - low).length().max(1.0) * FARTHEST;
    let target = (low + high) / 2.0;
    let eye = target + DVec3::new(length, -length, length);
    View::Camera(Camera { eye, target, up: DVec3::Z, fov_rad: 0.01, width: 1, height: 1 })
}
