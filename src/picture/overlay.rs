//! Shadow volumes and silhouette over a camera's picture, as in figures 5 and 6 of *Geometry of Real Time Shadows*.
//!
//! The volumes are those of [`crate::shadow::stencil`]: the same vertex stages and the same stencil, in which front and
//! back sides both count upwards here. So the picture shows what the technique counts, in layers.
//!
//! Two things differ from what the technique counts: each wall counts once, whatever its multiplicity, so that clean
//! solids are not twice as dark; and a count stays at 255 when it reaches that.

use crate::gpu::targets::{COUNTED, SHARE, Stages, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::shadow::{GpuSurface, Scene, ShadowError};
use crate::silhouette::ProcessorFinder;
use crate::view::{Camera, View};
use crate::volume::Volume;
use glam::{DVec3, Vec3};
use std::sync::Arc;
use wgpu::*;

/// Volumes and silhouette of one scene, for one camera and one sun at a time.
pub struct VolumePicture {
    scene: Scene,
    camera: Camera,
    surface: GpuSurface,
    volume: Volume,
    /// Each vertex twice: at its place, and at the end of its wall.
    vertices: Buffer,
    judging: RenderPipeline,
    wall: RenderPipeline,
    cap: RenderPipeline,
    line: RenderPipeline,
}

impl VolumePicture {
    /// Draws what the camera sees, finds the volumes, and builds the pipelines.
    pub fn new(gpu: Arc<Gpu>, scene: &Scene, camera: Camera, to_sun: DVec3) -> Result<VolumePicture, ShadowError> {
        let surface = GpuSurface::draw(Arc::clone(&gpu), scene, View::Camera(camera))?;
        let twice = scene.casters.vertices.iter().flat_map(|v| [v.extend(1.0).to_array(), v.extend(0.0).to_array()]);
        let vertices = gpu.uploaded("overlay.casters", BufferUsages::VERTEX, &twice.collect::<Vec<_>>())?;
        let [wall, cap] = layers(&surface);
        surface.set_sun(to_sun);
        Ok(VolumePicture {
            camera,
            volume: volume(scene, to_sun),
            vertices,
            judging: surface.judging(),
            wall,
            cap,
            line: lines(&surface),
            surface,
            scene: scene.clone(),
        })
    }

    /// Turns to another camera and sun; pipelines and casters are kept.
    ///
    /// # Errors
    /// As [`VolumePicture::new`].
    pub fn turn_to(&mut self, camera: Camera, to_sun: DVec3) -> Result<(), ShadowError> {
        self.surface.look_at(&self.scene, View::Camera(camera))?;
        self.surface.set_sun(to_sun);
        (self.camera, self.volume) = (camera, volume(&self.scene, to_sun));
        Ok(())
    }

    /// For each pixel, how many walls and caps lie in front of what is seen, at most 255. Walls end at the lowest
    /// receiver; caps are drawn only where the view does not show the casters themselves.
    pub fn layers(&self) -> Result<Vec<u8>, ShadowError> {
        let gpu = &self.surface.gpu;
        let walls = self.volume.walls.iter().flat_map(|&wall| Volume::wall(wall));
        let walls = walls.flatten().map(|(vertex, far)| vertex * 2 + u32::from(far));
        let cap = self.volume.light_cap.iter().flatten().map(|vertex| vertex * 2);
        let wall_count = self.volume.walls.len() as u32 * 6;
        let indices: Vec<u32> = walls.chain(cap).collect();
        let index_buffer = gpu.uploaded("overlay.indices", BufferUsages::INDEX, &indices)?;

        let judged = self.surface.judged(&self.judging);
        let unused = gpu.texture("overlay.unused", self.size(), SHARE, TextureUsages::RENDER_ATTACHMENT);
        let (unused_view, judged_view) = (whole(&unused), whole(&judged));
        let counted = RenderPassDepthStencilAttachment {
            view: &judged_view,
            depth_ops: None,
            stencil_ops: Some(Operations { load: LoadOp::Clear(0), store: StoreOp::Store }),
        };
        self.draw("overlay.volumes", &unused_view, Some(counted), |pass| {
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(index_buffer.slice(..), IndexFormat::Uint32);
            pass.set_pipeline(&self.wall);
            pass.draw_indexed(0..wall_count, 0, 0..1);
            pass.set_pipeline(&self.cap);
            pass.draw_indexed(wall_count..indices.len() as u32, 0, 0..1);
        });
        Ok(readback::texels(gpu, &judged, TextureAspect::StencilOnly)?)
    }

    /// For each pixel, how much of it the silhouette's lines cover, in 1/255. Hidden lines are not drawn.
    pub fn silhouette(&self) -> Result<Vec<u8>, ShadowError> {
        let gpu = &self.surface.gpu;
        let place = |vertex: u32| self.scene.casters.vertices[vertex as usize];
        let lines: Vec<[Vec3; 2]> = self.volume.walls.iter().map(|edge| edge.map(place)).collect();
        let buffer = gpu.uploaded("overlay.lines", BufferUsages::VERTEX, &lines)?;
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let ink = gpu.texture("overlay.ink", self.size(), SHARE, usage);
        self.draw("overlay.lines", &whole(&ink), None, |pass| {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.set_pipeline(&self.line);
            pass.draw(0..6, 0..lines.len() as u32);
        });
        Ok(readback::texels(gpu, &ink, TextureAspect::All)?)
    }

    fn size(&self) -> (u32, u32) {
        (self.camera.width, self.camera.height)
    }

    /// One pass over the picture.
    fn draw(
        &self,
        label: &str,
        target: &TextureView,
        depth_stencil_attachment: Option<RenderPassDepthStencilAttachment<'_>>,
        what: impl FnOnce(&mut RenderPass<'_>),
    ) {
        let gpu = &self.surface.gpu;
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
            })],
            depth_stencil_attachment,
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.surface.frame, &[]);
        pass.set_bind_group(1, &self.surface.seen, &[]);
        what(&mut pass);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
}

/// The volumes that are shown: each wall once.
fn volume(scene: &Scene, to_sun: DVec3) -> Volume {
    let casters = &scene.casters;
    let mut volume = Volume::find(casters, &mut *ProcessorFinder::BruteForce.build(casters), to_sun.extend(0.0), true);
    // repeated walls are consecutive
    volume.walls.dedup();
    volume
}

/// The pipelines that count walls and caps: fronts and backs both count upwards.
fn layers(surface: &GpuSurface) -> [RenderPipeline; 2] {
    let gpu = &surface.gpu;
    let module = gpu.shader("overlay.volumes", shaders::STENCIL);
    let layout = surface.seeing_layout(&[]);
    let corner = VertexBufferLayout {
        array_stride: size_of::<[f32; 4]>() as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &vertex_attr_array![0 => Float32x4],
    };
    let layer = StencilFaceState { pass_op: StencilOperation::IncrementClamp, ..StencilFaceState::default() };
    ["wall_to_lowest", "cap"].map(|vertex| {
        let stages = Stages {
            module: &module,
            vertex,
            fragment: "counted",
            buffers: &[Some(corner.clone())],
            target: Some((SHARE, ColorWrites::empty())),
            layout: Some(&layout),
        };
        let counts = DepthStencilState {
            format: COUNTED,
            depth_write_enabled: Some(false),
            depth_compare: Some(CompareFunction::Greater),
            stencil: StencilState { front: layer, back: layer, read_mask: 0xff, write_mask: 0xff },
            bias: DepthBiasState::default(),
        };
        gpu.pipeline(&format!("overlay.{vertex}"), stages, Some(counts))
    })
}

/// The pipeline that draws the silhouette: where lines overlap, the higher coverage.
fn lines(surface: &GpuSurface) -> RenderPipeline {
    let gpu = &surface.gpu;
    let ends = VertexBufferLayout {
        array_stride: size_of::<[Vec3; 2]>() as u64,
        step_mode: VertexStepMode::Instance,
        attributes: &vertex_attr_array![0 => Float32x3, 1 => Float32x3],
    };
    let stages = Stages {
        module: &gpu.shader("overlay", shaders::OVERLAY),
        vertex: "line",
        fragment: "ink",
        buffers: &[Some(ends)],
        target: Some((SHARE, ColorWrites::ALL)),
        layout: Some(&surface.seeing_layout(&[])),
    };
    let most =
        BlendComponent { src_factor: BlendFactor::One, dst_factor: BlendFactor::One, operation: BlendOperation::Max };
    gpu.blending_pipeline("overlay.lines", stages, None, Some(BlendState { color: most, alpha: most }))
}
