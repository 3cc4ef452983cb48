//! The hybrid of shadow map and volumes: exact hard shadows, counted only where the map cannot decide.
//!
//! E. Chan, *Efficient Shadow Algorithms on Graphics Hardware*, 2004, chapter 3. A map is drawn from the sun. A cell
//! whose four nearest texels agree takes their answer; the others, along the shadows' edges, are counted. The
//! computation mask is the stencil's top bit, which the count's test reads and nothing writes (WebGPU has no
//! depth-bounds test, and early stencil tests reject whole tiles as well). The count keeps the low seven bits, so
//! batches stay at 127 or below.
//!
//! Deviations: the view's own z-pass or z-fail instead of z-fail alone; the comparison uses the cell's own plane, so
//! that no bias lets light through between a shadow and its caster; cells whose plane is almost edge-on to the sun are
//! always counted.
//!
//! It is wrong where a caster, or a gap, is so thin that all four texels around a cell miss it.

use super::counting::{StencilBits, VolumeCounter};
use super::light_view::Smoothies;
use super::map::{DepthMap, compared_layout};
use super::{DrawnMask, Scene, ShadowError, Silhouettes, Technique};
use crate::gpu::targets::{COUNTED, SHARE, Stages, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::view::{Decider, FragmentCounts, Surface, View};
use glam::DVec3;
use std::sync::Arc;
use wgpu::*;

/// The technique, made for one scene and one view.
pub struct Hybrid {
    counting: VolumeCounter,
    map: DepthMap,
    compared: BindGroup,
    decided: RenderPipeline,
    mask: Texture,
}

/// At first every cell counts.
const ALL_COUNT: LoadOp<u32> = LoadOp::Clear(StencilBits::MASK);

impl Hybrid {
    /// Draws what is seen, uploads the casters, and builds the pipelines. The map has `map_size` texels per side.
    pub fn new(
        gpu: Arc<Gpu>,
        scene: Scene,
        view: View,
        silhouettes: impl Into<Silhouettes>,
        map_size: u32,
    ) -> Result<Hybrid, ShadowError> {
        let counting = VolumeCounter::new(Arc::clone(&gpu), scene, view, silhouettes.into(), StencilBits::BelowMask)?;
        let map = DepthMap::new(&counting.scene, &counting.surface, map_size, 0.0)?;
        let group = compared_layout(&gpu, &[]);
        let compared = gpu.bind("hybrid", &group, &[(0, BindingResource::TextureView(&whole(&map.depth)))]);
        let drop_bit = StencilFaceState { pass_op: StencilOperation::Zero, ..StencilFaceState::default() };
        let state = DepthStencilState {
            format: COUNTED,
            depth_write_enabled: Some(false),
            depth_compare: Some(CompareFunction::Always),
            stencil: StencilState { front: drop_bit, back: drop_bit, read_mask: 0, write_mask: StencilBits::MASK },
            bias: DepthBiasState::default(),
        };
        let stages = Stages {
            module: &gpu.shader("hybrid", shaders::HYBRID),
            vertex: "whole_picture",
            fragment: "decided",
            buffers: &[],
            target: Some((SHARE, ColorWrites::ALL)),
            layout: Some(&counting.surface.seeing_layout(&[&map.layout, &group])),
        };
        let decided = gpu.pipeline("hybrid.decided", stages, Some(state));
        let mask = counting.surface.mask("hybrid.mask");
        gpu.check()?;
        Ok(Hybrid { counting, map, compared, decided, mask })
    }

    /// As for the stencil: uses z-fail (`true`) or z-pass (`false`), right or wrong.
    #[cfg(feature = "test-hooks")]
    pub fn force_z_fail(&mut self, z_fail: bool) {
        self.counting.force_z_fail(z_fail);
    }

    /// Draws the mask. `store` says whether the stencil's mask is kept; volumes are counted only with `count`.
    fn draw_into(
        &mut self,
        to_sun: DVec3,
        mask: &Texture,
        store: StoreOp,
        counts: bool,
    ) -> Result<CommandEncoder, ShadowError> {
        self.map.aim(to_sun.extend(0.0), Smoothies::default());
        let mut encoder = self.counting.surface.encoder();
        self.map.draw(&self.counting.surface, &mut encoder);
        let count = self.counting.find(to_sun, &mut encoder)?;
        let stencil = Operations { load: ALL_COUNT, store };
        let mut pass = count.pass(&mut encoder, "hybrid", &whole(mask), Color::WHITE, Some(stencil));
        pass.set_bind_group(2, &self.map.bound, &[]);
        pass.set_bind_group(3, &self.compared, &[]);
        pass.set_pipeline(&self.decided);
        pass.draw(0..3, 0..1);
        if counts {
            count.draw(&mut pass);
        }
        drop(pass);
        Ok(encoder)
    }
}

impl Technique for Hybrid {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let mask = self.mask.clone();
        let encoder = self.draw_into(to_sun, &mask, StoreOp::Discard, true)?;
        let gpu = &self.counting.surface.gpu;
        gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(gpu, &self.mask))
    }

    fn turn_to(&mut self, view: View) -> Result<bool, ShadowError> {
        self.counting.turn_to(view)?;
        self.map.turn_to(&self.counting.surface)?;
        self.mask = self.counting.surface.mask("hybrid.mask");
        Ok(true)
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.counting.surface.read()
    }

    fn counted(&mut self, to_sun: DVec3) -> Result<Option<FragmentCounts>, ShadowError> {
        self.counting.prepare_adding()?;
        let gpu = Arc::clone(&self.counting.surface.gpu);
        let share = self.draw(to_sun)?.read()?.share;
        // draws only the mask again and keeps it, then adds up the fragments that pass it
        let unused = self.counting.surface.mask("hybrid.unused");
        let mut encoder = self.draw_into(to_sun, &unused, StoreOp::Store, false)?;
        let reached = self.counting.find(to_sun, &mut encoder)?.fragments(encoder, None)?;
        let bits: Vec<u8> = readback::texels(&gpu, &self.counting.judged, TextureAspect::StencilOnly)?;
        let mut encoder = self.counting.surface.encoder();
        let everywhere = Operations { load: ALL_COUNT, store: StoreOp::Discard };
        let all = self.counting.find(to_sun, &mut encoder)?.fragments(encoder, Some(everywhere))?;
        let decided =
            bits.iter().zip(&share).map(|(bits, share)| match (*bits >= StencilBits::MASK as u8, *share > 0) {
                (true, true) => Decider::VolumeLight,
                (true, false) => Decider::VolumeShadow,
                (false, true) => Decider::MapLight,
                (false, false) => Decider::MapShadow,
            });
        let (width, height) = self.counting.view.size();
        let all = all.iter().map(|&fragments| u64::from(fragments)).sum();
        Ok(Some(FragmentCounts { width, height, reached, all, decided: Some(decided.collect()) }))
    }
}
