//! Smoothies: a shadow map with the soft edge of a real sun.
//!
//! E. Chan, *Efficient Shadow Algorithms on Graphics Hardware*, 2004, chapter 4. Silhouette edges are extended outwards
//! in the light's view and drawn beside the map, with the share of the light that is visible past each, and its depth.
//! A cell behind the map's casters is in shadow, one behind a smoothie partly.
//!
//! Deviations, for the sun and for clean corners:
//!
//! - The penumbra d metres behind an edge is 2·d·tan(θ/2) wide, θ = 0.533°; the thesis's 1 − b/r is a lamp's, and is
//!   kept for lamps (`Smoothie::draw_lamp`, a hook for tests).
//! - A smoothie is as wide as its own penumbra can become on the lowest receiver, instead of one width for all.
//! - It is one rectangle around its edge, longer than it by its width at both ends, and alpha is the distance to the
//!   edge (beyond its ends, to the vertex). With minimum blending that is the union of what the thesis draws as edges,
//!   as corners, and as corners of more than two edges, and has no seams.
//! - Parts that only receive, and the ground, have their depth in the sun's view, but shade nothing. What lies behind
//!   such receivers, for example behind glass, has smoothies as wide as they are on that receiver; behind two of them,
//!   as wide as on the last one.
//!
//! Smoothies grow outwards only: the umbra is as large as the hard shadow, all of the penumbra lies outside of it, and
//! the line of half the light is half a penumbra too far out.

use super::light_view::Smoothies;
use super::map::{DepthMap, SLOPE_BIAS_TEXELS, Triangles, compared_layout, depth};
use super::{DrawnMask, GpuSurface, Scene, ShadowError, Technique};
use crate::gpu::targets::{SHARE, Stages, whole};
use crate::gpu::{Gpu, shaders};
use crate::silhouette::{DirectedEdge, ProcessorFinder, SilhouetteFinder};
use crate::view::{Surface, View};
use glam::{DVec3, DVec4, Vec3};
use std::sync::Arc;
use wgpu::*;

/// The share past a smoothie, and its depth.
const SMOOTHIES: TextureFormat = TextureFormat::Rg32Float;

/// The technique, made for one scene and one view.
pub struct Smoothie {
    scene: Scene,
    surface: GpuSurface,
    map: DepthMap,
    finder: Box<dyn SilhouetteFinder>,
    asked: Smoothies,
    /// What receives but does not cast, if there is anything.
    receivers: Option<SmoothieReceivers>,
    smoothies: Layer,
    edges: Buffer,
    /// The data to upload, kept for its allocation.
    upload: Vec<[Vec3; 2]>,
    depths: BindGroup,
    compared: BindGroup,
    softened: RenderPipeline,
    mask: Texture,
}

/// What receives but does not cast, and the smoothies on what is behind it.
struct SmoothieReceivers {
    triangles: Triangles,
    depth: Texture,
    beyond: Layer,
}

/// All smoothies, as wide as they are on some receivers.
struct Layer {
    texture: Texture,
    edge: RenderPipeline,
}

impl Layer {
    /// A layer whose alpha is computed by the shader's function of that name.
    fn new(gpu: &Gpu, module: &ShaderModule, layout: &PipelineLayout, size: (u32, u32), alpha: &str) -> Layer {
        let ends = VertexBufferLayout {
            array_stride: size_of::<[Vec3; 2]>() as u64,
            step_mode: VertexStepMode::Instance,
            attributes: &vertex_attr_array![0 => Float32x3, 1 => Float32x3],
        };
        let stages = Stages {
            module,
            vertex: "smoothie",
            fragment: alpha,
            buffers: &[Some(ends)],
            target: Some((SMOOTHIES, ColorWrites::ALL)),
            layout: Some(layout),
        };
        // where smoothies overlap, the darker one and the nearer one to the sun
        let least = BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Min,
        };
        let blend = Some(BlendState { color: least, alpha: least });
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        Layer {
            texture: gpu.texture("smoothie.smoothies", size, SMOOTHIES, usage),
            edge: gpu.blending_pipeline("smoothie.edge", stages, None, blend),
        }
    }
}

impl Smoothie {
    /// Draws what is seen, uploads casters and receivers, and builds the pipelines. Smoothies are `width_m` metres
    /// wide, or as wide as the sun's disc makes them.
    pub fn new(
        gpu: Arc<Gpu>,
        scene: Scene,
        view: View,
        finder: ProcessorFinder,
        map_size: u32,
        width_m: Option<f64>,
    ) -> Result<Smoothie, ShadowError> {
        gpu.blends_float32("smoothies are laid over each other")?;
        let surface = GpuSurface::draw(Arc::clone(&gpu), &scene, view)?;
        let map = DepthMap::new(&scene, &surface, map_size, SLOPE_BIAS_TEXELS)?;
        let cast: rustc_hash::FxHashSet<[u32; 3]> = scene.casters.faces.iter().copied().collect();
        let triangles = Triangles::uploaded(&gpu, &scene.receivers, |face| !cast.contains(face))?;

        let module = gpu.shader("smoothie", shaders::SMOOTHIE);
        let depths_layout = compared_layout(&gpu, &[TextureSampleType::Depth]);
        let layout = surface.seeing_layout(&[&map.layout, &depths_layout]);
        let layer = |alpha| Layer::new(&gpu, &module, &layout, map.size(), alpha);
        let smoothies = layer("alpha");
        let receivers = (!triangles.is_empty()).then(|| SmoothieReceivers {
            triangles,
            depth: depth(&gpu, "smoothie.receivers", map_size),
            beyond: layer("alpha_beyond"),
        });
        // without such receivers nothing is behind them
        let (receivers_depth, beyond) =
            receivers.as_ref().map_or((&map.depth, &smoothies), |receivers| (&receivers.depth, &receivers.beyond));
        let views = [&map.depth, receivers_depth, &smoothies.texture, &beyond.texture].map(whole);
        let resources = [0, 1, 2, 3].map(|binding| (binding as u32, BindingResource::TextureView(&views[binding])));
        let depths = gpu.bind("smoothie.depths", &depths_layout, &resources[..2]);
        let float = TextureSampleType::Float { filterable: false };
        let compared_layout = compared_layout(&gpu, &[TextureSampleType::Depth, float, float]);
        let compared = gpu.bind("smoothie.compared", &compared_layout, &resources);
        let softened = softened(&gpu, &module, &surface.seeing_layout(&[&map.layout, &compared_layout]));
        let mask = surface.mask("smoothie.mask");
        let edges = gpu.uploaded("smoothie.edges", BufferUsages::VERTEX, &[[Vec3::ZERO; 2]])?;
        gpu.check()?;
        Ok(Smoothie {
            finder: finder.build(&scene.casters),
            scene,
            surface,
            map,
            asked: Smoothies { width_m: width_m.unwrap_or(0.0), linear: false },
            receivers,
            smoothies,
            edges,
            upload: Vec::new(),
            depths,
            compared,
            softened,
            mask,
        })
    }

    /// Uses alpha as it is drawn (`true`), so that every penumbra is as wide as its smoothie, wherever it falls; for
    /// comparison, as in the thesis's figures 4-4 and 4-10.
    #[cfg(feature = "test-hooks")]
    pub fn force_linear(&mut self, linear: bool) {
        self.asked.linear = linear;
    }

    /// Draws the mask for a lamp in the world frame, with alpha remapped by the thesis's α / (1 − b/r). `width` is the
    /// thesis's t, metres in a plane at a distance of one metre from the lamp. The lamp sees 63° to each side of the
    /// middle of what is seen; everything beyond that counts as lit.
    ///
    /// # Errors
    /// As [`Technique::draw`].
    #[cfg(feature = "test-hooks")]
    pub fn draw_lamp(&mut self, lamp: DVec3, width: f64) -> Result<DrawnMask<'_>, ShadowError> {
        self.draw_light(self.scene.casters.local_light(lamp.extend(1.0)), Smoothies { width_m: width, ..self.asked })
    }

    /// Uploads the silhouette, each edge once, whatever its multiplicity.
    fn find(&mut self, local_light: DVec4) -> Result<u32, ShadowError> {
        let casters = &self.scene.casters;
        let mut silhouette: Vec<DirectedEdge> = Vec::new();
        self.finder.find(casters, local_light, &mut silhouette);
        // repeated edges are consecutive
        silhouette.dedup();
        self.upload.clear();
        self.upload.extend(silhouette.iter().map(|edge| edge.map(|vertex| casters.vertices[vertex as usize])));
        let gpu = &self.surface.gpu;
        let bytes: &[u8] = bytemuck::cast_slice(&self.upload);
        if bytes.len() as u64 > self.edges.size() {
            // leaves room for the next instants, whose silhouettes are similar
            let size = (bytes.len() as u64 * 3 / 2).next_multiple_of(4);
            self.edges = gpu.buffer("smoothie.edges", size, BufferUsages::VERTEX | BufferUsages::COPY_DST)?;
        }
        gpu.queue.write_buffer(&self.edges, 0, bytes);
        Ok(self.upload.len() as u32)
    }

    fn draw_light(&mut self, local_light: DVec4, asked: Smoothies) -> Result<DrawnMask<'_>, ShadowError> {
        let count = self.find(local_light)?;
        let Smoothie { surface, map, .. } = &*self;
        surface.set_light(local_light);
        map.aim(local_light, asked);
        let mut encoder = surface.encoder();
        map.draw(surface, &mut encoder);
        if let Some(SmoothieReceivers { triangles, depth, .. }) = &self.receivers {
            map.draw_triangles(surface, &mut encoder, depth, triangles);
        }
        let layers = [Some(&self.smoothies), self.receivers.as_ref().map(|receivers| &receivers.beyond)];
        for layer in layers.into_iter().flatten() {
            self.draw_layer(layer, count, &mut encoder);
        }
        surface.draw_mask(&mut encoder, "smoothie", &self.mask, |pass| {
            pass.set_bind_group(2, &map.bound, &[]);
            pass.set_bind_group(3, &self.compared, &[]);
            pass.set_pipeline(&self.softened);
            pass.draw(0..3, 0..1);
        });
        surface.gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(&self.surface.gpu, &self.mask))
    }

    /// Draws all smoothies into one of the layers.
    fn draw_layer(&self, layer: &Layer, count: u32, encoder: &mut CommandEncoder) {
        let Smoothie { surface, map, .. } = self;
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("smoothie.edges"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &whole(&layer.texture),
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(NOTHING), store: StoreOp::Store },
            })],
            timestamp_writes: surface.gpu.timed("smoothie.edges"),
            ..RenderPassDescriptor::default()
        });
        map.bind(surface, &mut pass);
        pass.set_bind_group(3, &self.depths, &[]);
        pass.set_pipeline(&layer.edge);
        pass.set_vertex_buffer(0, self.edges.slice(..));
        pass.draw(0..6, 0..count);
    }
}

impl Technique for Smoothie {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        self.draw_light(to_sun.extend(0.0), self.asked)
    }

    fn turn_to(&mut self, view: View) -> Result<bool, ShadowError> {
        self.surface.look_at(&self.scene, view)?;
        self.map.turn_to(&self.surface)?;
        self.mask = self.surface.mask("smoothie.mask");
        Ok(true)
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.surface.read()
    }
}

/// The pipeline that draws the mask from the map and the smoothies.
fn softened(gpu: &Gpu, module: &ShaderModule, layout: &PipelineLayout) -> RenderPipeline {
    let stages = Stages {
        module,
        vertex: "whole_picture",
        fragment: "softened",
        buffers: &[],
        target: Some((SHARE, ColorWrites::ALL)),
        layout: Some(layout),
    };
    gpu.pipeline("smoothie.softened", stages, None)
}

/// The clear value without smoothies: the whole sun, and infinitely deep.
const NOTHING: Color = Color { r: 1.0, g: 1e30, b: 0.0, a: 0.0 };
