//! Shadow maps with percentage closer filtering: the quick look.
//!
//! S. Brabec and H.-P. Seidel, *Hardware-accelerated Rendering of Antialiased Shadows with Shadow Maps*, 2001:
//! unfiltered (section 2), 2×2 by four renders in four channels (3), fast 2×2 and 4×4 from one map (4). Fast filters
//! gather their texels in the comparison itself, without a packed copy of the map: that pass only served machines
//! without loops in their shaders. The paper's 4 × 5 = 20 levels are 17, as four counts of 0 to 4 are added up.

use super::light_view::Smoothies;
use super::map::{DepthMap, PackedMap, SLOPE_BIAS_TEXELS, compared_layout};
use super::{DrawnMask, GpuSurface, Scene, ShadowError, Technique};
use crate::gpu::targets::{SHARE, Stages, whole};
use crate::gpu::{Gpu, shaders};
use crate::view::{Surface, View};
use glam::DVec3;
use std::sync::Arc;
use wgpu::*;

use crate::choice::Filter;

/// The technique, made for one scene and one view.
pub struct ShadowMap {
    scene: Scene,
    surface: GpuSurface,
    map: DepthMap,
    packed: Option<PackedMap>,
    compared: BindGroup,
    pipeline: RenderPipeline,
    mask: Texture,
}

impl ShadowMap {
    /// Draws what is seen, uploads the casters, and builds the pipelines.
    pub fn new(gpu: Arc<Gpu>, scene: &Scene, view: View, size: u32, filter: Filter) -> Result<ShadowMap, ShadowError> {
        Self::with_bias(gpu, scene, view, size, filter, SLOPE_BIAS_TEXELS)
    }

    /// The same with another slope-scaled bias, in texels. If it is too small, surfaces shade themselves; if it is too
    /// large, light falls between a shadow and its caster.
    pub fn with_bias(
        gpu: Arc<Gpu>,
        scene: &Scene,
        view: View,
        size: u32,
        filter: Filter,
        slope_bias: f32,
    ) -> Result<ShadowMap, ShadowError> {
        let surface = GpuSurface::draw(Arc::clone(&gpu), scene, view)?;
        let map = DepthMap::new(scene, &surface, size, slope_bias)?;
        let packed = (filter == Filter::TwoByTwo).then(|| PackedMap::new(&map, &surface));
        let (group, texture) = match &packed {
            Some(packed) => (packed_layout(&gpu), whole(&packed.packed)),
            None => (compared_layout(&gpu, &[]), whole(&map.depth)),
        };
        let compared = gpu.bind("shadow_map", &group, &[(0, BindingResource::TextureView(&texture))]);
        let stages = Stages {
            module: &gpu.shader("shadow_map", shaders::SHADOW_MAP),
            vertex: "whole_picture",
            fragment: match filter {
                Filter::None => "none",
                Filter::TwoByTwo => "two_by_two",
                Filter::FastTwoByTwo => "fast_two_by_two",
                Filter::FastFourByFour => "fast_four_by_four",
            },
            buffers: &[],
            target: Some((SHARE, ColorWrites::ALL)),
            layout: Some(&surface.seeing_layout(&[&map.layout, &group])),
        };
        let pipeline = gpu.pipeline("shadow_map", stages, None);
        let mask = surface.mask("shadow_map.mask");
        gpu.check()?;
        Ok(ShadowMap { scene: scene.clone(), surface, map, packed, compared, pipeline, mask })
    }

    /// The size of a texel across the rays of that sun, metres along the map's axes.
    #[cfg(feature = "test-hooks")]
    pub fn texel_m(&self, to_sun: DVec3) -> [f32; 2] {
        self.map.texel_m(to_sun)
    }
}

/// The layout for the packed depths, which are bound instead of the map's depth.
fn packed_layout(gpu: &Gpu) -> BindGroupLayout {
    let packed = super::bindings::texture_binding(TextureSampleType::Float { filterable: false });
    super::bindings::bind_group_layout(gpu, "packed", &[packed])
}

impl Technique for ShadowMap {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        self.surface.set_sun(to_sun);
        self.map.aim(to_sun.extend(0.0), Smoothies::default());
        let mut encoder = self.surface.encoder();
        match &self.packed {
            Some(packed) => packed.draw(&self.map, &self.surface, &mut encoder),
            None => self.map.draw(&self.surface, &mut encoder),
        }
        self.surface.draw_mask(&mut encoder, "shadow_map", &self.mask, |pass| {
            pass.set_bind_group(2, &self.map.bound, &[]);
            pass.set_bind_group(3, &self.compared, &[]);
            pass.set_pipeline(&self.pipeline);
            pass.draw(0..3, 0..1);
        });
        self.surface.gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(&self.surface.gpu, &self.mask))
    }

    fn turn_to(&mut self, view: View) -> Result<bool, ShadowError> {
        self.surface.look_at(&self.scene, view)?;
        self.map.turn_to(&self.surface)?;
        self.mask = self.surface.mask("shadow_map.mask");
        Ok(true)
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.surface.read()
    }
}
