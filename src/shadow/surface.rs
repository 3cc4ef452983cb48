//! What each cell of a view sees, on the GPU: a G-buffer that is drawn once for a scene and a view. It includes the
//! ground for the stencil technique.

use super::bindings::{Corner, UNIFORM, bind_group_layout, pipeline_layout, planes, texture_binding};
use super::flush_layer::{FlushCorners, FlushLayer};
use super::frame::{clip_from_local, uniform};
use super::{Scene, ShadowError};
use crate::gpu::layout::{self, LightUniforms};
use crate::gpu::targets::{COUNTED, DEPTH, NUMBER, SHARE, Stages, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::mesh::Mesh;
use crate::view::{Surface, View};
use glam::{DMat4, DVec3, DVec4};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};
use wgpu::*;

/// The number of faces that are uploaded at once: receivers are drawn only once, so no buffer of all of them is kept.
const FACES_AT_ONCE: usize = 1 << 18;

/// The number of tiles along a picture's longer side, each with a box around what it shows.
const TILES: u32 = 24;

/// Depth and face of what each cell sees, and the uniforms of the view.
pub struct GpuSurface {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) view: View,
    origin: DVec3,
    pub(crate) clip_from_local: DMat4,
    /// The lowest judged point, metres above the origin.
    pub(crate) lowest_z: f64,
    depth: Texture,
    faces: Texture,
    planes: Texture,
    /// The pipelines of the ground, and of receivers.
    pipelines: [RenderPipeline; 2],
    view_buffer: Buffer,
    light: Buffer,
    /// View and light.
    pub(crate) frame: BindGroup,
    /// The depth and the face of what is seen.
    pub(crate) seen: BindGroup,
    frame_layout: BindGroupLayout,
    seen_layout: BindGroupLayout,
    /// Receivers that are flush with the ground, and once they are shown what draws them.
    flush: FlushCorners,
    layer: OnceLock<FlushLayer>,
}

impl GpuSurface {
    /// Draws the receivers of a scene, and the ground.
    pub fn draw(gpu: Arc<Gpu>, scene: &Scene, view: View) -> Result<GpuSurface, ShadowError> {
        let (width, height) = view.size();
        let largest = gpu.limits.max_texture_dimension_2d;
        if width.max(height) > largest {
            return Err(ShadowError::TooLarge { width, height, largest, adapter: gpu.name().to_owned() });
        }
        let [depth, faces] = targets(&gpu, &view);
        let planes = planes(&gpu, &scene.receivers)?;

        let uniform = uniform(scene, &view);
        let view_buffer = gpu.uniform::<layout::ViewUniforms>("view");
        gpu.queue.write_buffer(&view_buffer, 0, bytemuck::bytes_of(&uniform));
        let light = gpu.uniform::<LightUniforms>("light");
        let frame_layout = bind_group_layout(&gpu, "frame", &[UNIFORM, UNIFORM]);
        let seen_layout = bind_group_layout(
            &gpu,
            "seen",
            &[
                texture_binding(TextureSampleType::Uint),
                texture_binding(TextureSampleType::Float { filterable: false }),
                texture_binding(TextureSampleType::Depth),
            ],
        );
        let frame =
            gpu.bind("frame", &frame_layout, &[(0, view_buffer.as_entire_binding()), (1, light.as_entire_binding())]);
        let seen = bind_seen(&gpu, &seen_layout, [&faces, &planes, &depth]);
        let clip_from_local = clip_from_local(scene, &view);
        let origin = scene.receivers.origin;
        let surface = GpuSurface {
            view,
            origin,
            clip_from_local,
            lowest_z: f64::from(uniform.lowest_z),
            depth,
            faces,
            planes,
            pipelines: pipelines(&gpu, &frame_layout),
            gpu,
            view_buffer,
            light,
            frame,
            seen,
            frame_layout,
            seen_layout,
            flush: FlushCorners::of(&scene.receivers, scene.ground),
            layer: OnceLock::new(),
        };
        surface.draw_receivers(&scene.receivers)?;
        Ok(surface)
    }

    /// Turns to another view of the same scene.
    pub(crate) fn look_at(&mut self, scene: &Scene, view: View) -> Result<(), ShadowError> {
        self.turn(scene, view)?;
        self.draw_receivers(&scene.receivers)
    }

    /// Turns to another view whose faces are known for each cell. Depths are not known.
    pub(crate) fn see(&mut self, scene: &Scene, view: View, faces: &[u32]) -> Result<(), ShadowError> {
        self.turn(scene, view)?;
        let bytes_per_row = Some(view.size().0 * size_of::<u32>() as u32);
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        let (to, size) = (self.faces.as_image_copy(), self.faces.size());
        self.gpu.queue.write_texture(to, bytemuck::cast_slice(faces), layout, size);
        Ok(())
    }

    fn turn(&mut self, scene: &Scene, view: View) -> Result<(), ShadowError> {
        let (width, height) = view.size();
        let largest = self.gpu.limits.max_texture_dimension_2d;
        if width.max(height) > largest {
            return Err(ShadowError::TooLarge { width, height, largest, adapter: self.gpu.name().to_owned() });
        }
        if view.size() != self.view.size() {
            [self.depth, self.faces] = targets(&self.gpu, &view);
            self.seen = bind_seen(&self.gpu, &self.seen_layout, [&self.faces, &self.planes, &self.depth]);
        }
        let uniform = uniform(scene, &view);
        self.gpu.queue.write_buffer(&self.view_buffer, 0, bytemuck::bytes_of(&uniform));
        self.view = view;
        self.clip_from_local = clip_from_local(scene, &view);
        self.lowest_z = f64::from(uniform.lowest_z);
        Ok(())
    }

    fn draw_receivers(&self, receivers: &Mesh) -> Result<(), ShadowError> {
        let gpu = &self.gpu;
        let [ground, receiver] = &self.pipelines;
        let at_once = receivers.faces.len().clamp(1, FACES_AT_ONCE);
        let vertices = gpu.buffer(
            "surface.receivers",
            (at_once * 3 * size_of::<Corner>()) as u64,
            BufferUsages::VERTEX | BufferUsages::COPY_DST,
        )?;
        // receivers first: where the ground and a receiver are equally deep, the receiver is seen
        let runs = (0..receivers.faces.len()).step_by(at_once).map(Some).chain([None]);
        for (index, run) in runs.enumerate() {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let load = |first| if index == 0 { LoadOp::Clear(first) } else { LoadOp::Load };
            let face_load = if index == 0 {
                LoadOp::Clear(Color { r: f64::from(Surface::SKY), ..Color::default() })
            } else {
                LoadOp::Load
            };
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("surface"),
                color_attachments: &[Some(RenderPassColorAttachment {
                    view: &whole(&self.faces),
                    depth_slice: None,
                    resolve_target: None,
                    ops: Operations { load: face_load, store: StoreOp::Store },
                })],
                depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                    view: &whole(&self.depth),
                    depth_ops: Some(Operations { load: load(0.0), store: StoreOp::Store }),
                    stencil_ops: None,
                }),
                ..RenderPassDescriptor::default()
            });
            pass.set_bind_group(0, &self.frame, &[]);
            if let Some(first) = run {
                let count = at_once.min(receivers.faces.len() - first);
                let corners: Vec<Corner> = (first..first + count)
                    .into_par_iter()
                    .filter(|&face| !seen_edge_on(receivers, face, &self.view))
                    .flat_map_iter(|face| Corner::of(receivers, face as u32))
                    .collect();
                gpu.queue.write_buffer(&vertices, 0, bytemuck::cast_slice(&corners));
                pass.set_pipeline(receiver);
                pass.set_vertex_buffer(0, vertices.slice(..));
                pass.draw(0..corners.len() as u32, 0..1);
            } else {
                pass.set_pipeline(ground);
                pass.draw(0..3, 0..1);
            }
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        }
        Ok(gpu.check()?)
    }

    /// An empty mask of the view.
    pub(crate) fn mask(&self, label: &str) -> Texture {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        self.gpu.texture(label, self.view.size(), SHARE, usage)
    }

    /// A pass over all of a mask, without depth.
    pub(crate) fn draw_mask(
        &self,
        encoder: &mut CommandEncoder,
        label: &str,
        mask: &Texture,
        what: impl FnOnce(&mut RenderPass<'_>),
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &whole(mask),
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
            })],
            timestamp_writes: self.gpu.timed(label),
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(1, &self.seen, &[]);
        what(&mut pass);
    }

    /// Boxes around what is seen, metres around the scene's origin: one for each tile of the picture, without the sky.
    pub(crate) fn boxes_of_seen(&self) -> Result<Vec<(DVec3, DVec3)>, ShadowError> {
        let face: Vec<u32> = readback::texels(&self.gpu, &self.faces, TextureAspect::All)?;
        let depth: Vec<f32> = readback::texels(&self.gpu, &self.depth, TextureAspect::DepthOnly)?;
        let (width, height) = self.view.size();
        let tile = (width.max(height).div_ceil(TILES)).max(1) as usize;
        let across = (width as usize).div_ceil(tile);
        let local_from_clip = self.clip_from_local.inverse();
        let boxes = (0..(height as usize).div_ceil(tile)).into_par_iter().flat_map_iter(|tile_row| {
            let mut boxes = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); across];
            let first = tile_row * tile * width as usize;
            let last = ((tile_row + 1) * tile * width as usize).min(face.len());
            for at in (first..last).filter(|&at| face[at] != Surface::SKY) {
                let point = self.point(&local_from_clip, at as u32, depth[at]);
                let (low, high) = &mut boxes[at % width as usize / tile];
                (*low, *high) = (low.min(point), high.max(point));
            }
            boxes.into_iter().filter(|(low, high)| low.x <= high.x)
        });
        Ok(boxes.collect())
    }

    /// The point that a pixel sees at a depth, metres relative to the scene's origin.
    fn point(&self, local_from_clip: &DMat4, at: u32, depth: f32) -> DVec3 {
        let (width, height) = self.view.size();
        let (column, row) = (at % width, at / width);
        let x = (f64::from(column) + 0.5) / f64::from(width) * 2.0 - 1.0;
        let y = 1.0 - (f64::from(row) + 0.5) / f64::from(height) * 2.0;
        local_from_clip.project_point3(DVec3::new(x, y, f64::from(depth)))
    }

    /// An encoder for the commands of an instant.
    pub(crate) fn encoder(&self) -> CommandEncoder {
        self.gpu.device.create_command_encoder(&CommandEncoderDescriptor::default())
    }

    /// The layout of pipelines that read the view, what is seen, and further bindings.
    pub(crate) fn seeing_layout(&self, further: &[&BindGroupLayout]) -> PipelineLayout {
        let groups: Vec<_> =
            [&self.frame_layout, &self.seen_layout].into_iter().chain(further.iter().copied()).collect();
        pipeline_layout(&self.gpu, &groups)
    }

    /// The pipeline that draws the depth at which each cell is judged.
    pub(crate) fn judging(&self) -> RenderPipeline {
        let always = DepthStencilState {
            format: COUNTED,
            depth_write_enabled: Some(true),
            depth_compare: Some(CompareFunction::Always),
            stencil: StencilState::default(),
            bias: DepthBiasState::default(),
        };
        let stages = Stages {
            module: &self.gpu.shader("judged", shaders::JUDGED),
            vertex: "whole_picture",
            fragment: "judged_depth",
            buffers: &[],
            target: None,
            layout: Some(&self.seeing_layout(&[])),
        };
        self.gpu.pipeline("judged", stages, Some(always))
    }

    /// The depth at which each cell is judged, in a texture with a stencil.
    pub(crate) fn judged(&self, judging: &RenderPipeline) -> Texture {
        let gpu = &self.gpu;
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let judged = gpu.texture("surface.judged", self.view.size(), COUNTED, usage);
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("judged"),
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &whole(&judged),
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store }),
                stencil_ops: Some(Operations { load: LoadOp::Clear(0), store: StoreOp::Store }),
            }),
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(judging);
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(1, &self.seen, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        judged
    }

    /// Sets the sun for what is drawn next.
    pub(crate) fn set_sun(&self, to_sun: DVec3) {
        self.set_light(to_sun.extend(0.0));
    }

    /// Sets a light relative to the scene's origin (sun: w = 0, lamp: w = 1).
    pub(crate) fn set_light(&self, local_light: DVec4) {
        let light = LightUniforms { towards: local_light.as_vec4().to_array() };
        self.gpu.queue.write_buffer(&self.light, 0, bytemuck::bytes_of(&light));
    }

    /// The faces that a picture shows, where they are not those that are judged: with receivers that are flush with the
    /// ground before it.
    fn shown(&self) -> Result<Option<Texture>, ShadowError> {
        if self.flush.is_empty() {
            return Ok(None);
        }
        let layer = match self.layer.get() {
            Some(layer) => layer,
            None => {
                let group = FlushLayer::group(&self.gpu);
                let layout = self.seeing_layout(&[&group]);
                let layer = FlushLayer::new(&self.gpu, &self.flush, &group, &layout)?;
                self.layer.get_or_init(|| layer)
            }
        };
        let shown = faces_target(&self.gpu, "surface.shown", &self.view);
        let mut encoder = self.encoder();
        encoder.copy_texture_to_texture(self.faces.as_image_copy(), shown.as_image_copy(), shown.size());
        layer.draw(&mut encoder, &shown, [&self.frame, &self.seen]);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()?;
        Ok(Some(shown))
    }

    /// Replaces the faces that are judged by those that are shown. For pictures, in which nothing is judged.
    pub(crate) fn show_flush(&mut self) -> Result<(), ShadowError> {
        if let Some(shown) = self.shown()? {
            self.faces = shown;
            self.seen = bind_seen(&self.gpu, &self.seen_layout, [&self.faces, &self.planes, &self.depth]);
        }
        Ok(())
    }

    /// The surface in the processor's memory.
    pub fn read(&self) -> Result<Surface, ShadowError> {
        let shown = self.shown()?;
        let faces = shown.as_ref().unwrap_or(&self.faces);
        let face: Vec<u32> = readback::texels(&self.gpu, faces, TextureAspect::All)?;
        let depth: Vec<f32> = readback::texels(&self.gpu, &self.depth, TextureAspect::DepthOnly)?;
        let (width, height) = self.view.size();
        let local_from_clip = self.clip_from_local.inverse();
        let height_of = |(at, (&face, &depth)): (usize, (&u32, &f32))| {
            if face == Surface::SKY {
                return f32::NAN;
            }
            (self.point(&local_from_clip, at as u32, depth).z + self.origin.z) as f32
        };
        let height_m = face.par_iter().zip(&depth).enumerate().map(height_of).collect();
        Ok(Surface { width, height, face, height_m })
    }
}

/// The textures for the depth and the faces of what is seen.
fn targets(gpu: &Gpu, view: &View) -> [Texture; 2] {
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    [gpu.texture("surface.depth", view.size(), DEPTH, usage), faces_target(gpu, "surface.faces", view)]
}

fn faces_target(gpu: &Gpu, label: &str, view: &View) -> Texture {
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
    gpu.texture(label, view.size(), NUMBER, usage | TextureUsages::COPY_SRC | TextureUsages::COPY_DST)
}

fn bind_seen(gpu: &Gpu, layout: &BindGroupLayout, textures: [&Texture; 3]) -> BindGroup {
    let views = textures.map(whole);
    let entry = |at: usize| (at as u32, BindingResource::TextureView(&views[at]));
    gpu.bind("seen", layout, &[entry(0), entry(1), entry(2)])
}

/// The pipelines of the ground, and of receivers.
fn pipelines(gpu: &Gpu, frame_layout: &BindGroupLayout) -> [RenderPipeline; 2] {
    let module = gpu.shader("surface", shaders::SURFACE);
    let layout = pipeline_layout(gpu, &[frame_layout]);
    let stages = |vertex, fragment, buffers| Stages {
        module: &module,
        vertex,
        fragment,
        buffers,
        target: Some((NUMBER, ColorWrites::ALL)),
        layout: Some(&layout),
    };
    let nearest = DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(CompareFunction::Greater),
        stencil: StencilState::default(),
        bias: DepthBiasState::default(),
    };
    let buffers = [Some(Corner::LAYOUT)];
    [
        gpu.pipeline("surface.ground", stages("whole_picture", "ground", &[]), Some(nearest.clone())),
        gpu.pipeline("surface.receiver", stages("receiver", "receiver_face", &buffers), Some(nearest)),
    ]
}

/// Whether the plan sees a steep face so much from its edge that it is thinner than the raster's rounding of corners:
/// no cell's centre should see it, and one that did would find any depth. Slivers in a roof fill it, and stay.
fn seen_edge_on(mesh: &Mesh, face: usize, view: &View) -> bool {
    let View::Plan(grid) = view else { return false };
    let [a, b, c] = mesh.corners(face).map(|corner| corner.as_dvec3().truncate());
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let twice_area = (b - a).perp_dot(c - a).abs();
    mesh.planes()[face].z.abs() < 0.01 && twice_area < longest * grid.cell / 256.0
}
