//! Stencil shadow volumes: exact hard shadows.
//!
//! One render pass per instant draws the faces that look away from the sun, then the casters' count and its result in
//! the mask. `counting` explains how volumes are counted.
//!
//! Deviation from *Geometry of Real Time Shadows*: the general rule of [`crate::silhouette`], instead of well-wound
//! closed meshes only.

use super::counting::{StencilBits, VolumeCounter};
use super::{DrawnMask, Scene, ShadowError, Silhouettes, Technique};
use crate::gpu::targets::{COUNTED, SHARE, Stages, whole};
use crate::gpu::{Gpu, shaders};
use crate::view::{FragmentCounts, Surface, View};
use glam::DVec3;
use std::sync::Arc;
use wgpu::*;

/// The technique, made for one scene and one view.
pub struct Stencil {
    counting: VolumeCounter,
    facing: RenderPipeline,
    mask: Texture,
}

impl Stencil {
    /// Draws what is seen, uploads the casters, and builds the pipelines.
    pub fn new(
        gpu: Arc<Gpu>,
        scene: Scene,
        view: View,
        silhouettes: impl Into<Silhouettes>,
    ) -> Result<Stencil, ShadowError> {
        let counting = VolumeCounter::new(Arc::clone(&gpu), scene, view, silhouettes.into(), StencilBits::All)?;
        let mask = counting.surface.mask("stencil.mask");
        let always = DepthStencilState {
            format: COUNTED,
            depth_write_enabled: Some(false),
            depth_compare: Some(CompareFunction::Always),
            stencil: StencilState::default(),
            bias: DepthBiasState::default(),
        };
        let stages = Stages {
            module: &gpu.shader("stencil", shaders::STENCIL),
            vertex: "whole_picture",
            fragment: "facing",
            buffers: &[],
            target: Some((SHARE, ColorWrites::ALL)),
            layout: Some(&counting.surface.seeing_layout(&[])),
        };
        let facing = gpu.pipeline("stencil.facing", stages, Some(always));
        gpu.check()?;
        Ok(Stencil { counting, facing, mask })
    }

    /// Counts camera views by z-fail (`true`) or z-pass (`false`), right or wrong. z-fail always is right; a test shows
    /// z-pass failing where it is not chosen.
    #[cfg(feature = "test-hooks")]
    pub fn force_z_fail(&mut self, z_fail: bool) {
        self.counting.force_z_fail(z_fail);
    }
}

impl Technique for Stencil {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let mut encoder = self.counting.surface.encoder();
        let count = self.counting.find(to_sun, &mut encoder)?;
        let nothing = Operations { load: LoadOp::Clear(0), store: StoreOp::Discard };
        let mut pass = count.pass(&mut encoder, "stencil", &whole(&self.mask), Color::BLACK, Some(nothing));
        pass.set_pipeline(&self.facing);
        pass.draw(0..3, 0..1);
        count.draw(&mut pass);
        drop(pass);
        let gpu = &self.counting.surface.gpu;
        gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(gpu, &self.mask))
    }

    fn turn_to(&mut self, view: View) -> Result<bool, ShadowError> {
        self.counting.turn_to(view)?;
        self.mask = self.counting.surface.mask("stencil.mask");
        Ok(true)
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.counting.surface.read()
    }

    fn counted(&mut self, to_sun: DVec3) -> Result<Option<FragmentCounts>, ShadowError> {
        self.counting.prepare_adding()?;
        let mut encoder = self.counting.surface.encoder();
        let reached = self.counting.find(to_sun, &mut encoder)?.fragments(encoder, None)?;
        let (width, height) = self.counting.view.size();
        let all = reached.iter().map(|&fragments| u64::from(fragments)).sum();
        Ok(Some(FragmentCounts { width, height, reached, all, decided: None }))
    }
}
