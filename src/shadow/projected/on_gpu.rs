//! Projected shadows on the ground by the graphics adapter, which projects the cut faces along the sun's rays and fills
//! them.
//!
//! It is one pass per instant, without depth, stencil or silhouette: the adapter's own scan conversion makes the union
//! of the faces. Positions are `f32` around the raster's middle, and corners are rounded to the adapter's lattice
//! (1/256 of a cell on all adapters that we know). A cell is that of ray casting unless it lies within 1/128 of a cell
//! of an edge; where shadows fall farther than 2¹⁵ cells the rounding of `f32` is added (2⁻²² of the distance).

use super::raster_from_local;
use crate::gpu::targets::{SHARE, Stages, whole};
use crate::gpu::{Gpu, layout, shaders};
use crate::mesh::Mesh;
use crate::shadow::flat::{throw, where_cut};
use crate::shadow::{DrawnMask, Scene, ShadowError, Technique, plan_surface};
use crate::view::{Grid, Surface};
use glam::{DAffine3, DVec3, dvec3};
use rayon::prelude::*;
use std::sync::Arc;
use wgpu::*;

/// The technique for the ground alone, made for one scene and one plan.
pub struct ProjectedOnGpu {
    gpu: Arc<Gpu>,
    raster_from_local: DAffine3,
    vertices: Buffer,
    indices: Buffer,
    count: u32,
    fall: Buffer,
    bound: BindGroup,
    pipeline: RenderPipeline,
    mask: Texture,
    receivers: Mesh,
    ground: f64,
    grid: Grid,
}

impl ProjectedOnGpu {
    /// Cuts the casters at the height at which the ground is judged, and uploads them. Only the ground may receive in
    /// the scene.
    ///
    /// # Errors
    /// [`ShadowError`] if the raster or the casters do not fit on the adapter.
    pub fn new(gpu: Arc<Gpu>, scene: &Scene, grid: Grid) -> Result<ProjectedOnGpu, ShadowError> {
        let Grid { width, height, .. } = grid;
        let largest = gpu.limits.max_texture_dimension_2d;
        if width.max(height) > largest {
            return Err(ShadowError::TooLarge { width, height, largest, adapter: gpu.name().to_owned() });
        }
        let raster_from_local = raster_from_local(scene, &grid);
        let (points, faces) = above(&scene.casters, &raster_from_local);
        // relative to the middle, where precision is highest; centres are half a cell from whole numbers
        let middle = dvec3(f64::from(width) - 1.0, f64::from(height) - 1.0, 0.0) / 2.0;
        let points: Vec<[f32; 3]> = points.par_iter().map(|point| (point - middle).as_vec3().to_array()).collect();
        let fall = gpu.uniform::<layout::FallUniforms>("projected.fall");
        let stages = Stages {
            module: &gpu.shader("projected", shaders::PROJECTED),
            vertex: "fallen",
            fragment: "shaded",
            buffers: &[Some(VertexBufferLayout {
                array_stride: 12,
                step_mode: VertexStepMode::Vertex,
                attributes: &vertex_attr_array![0 => Float32x3],
            })],
            target: Some((SHARE, ColorWrites::ALL)),
            layout: None,
        };
        let pipeline = gpu.pipeline("projected", stages, None);
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let projected = ProjectedOnGpu {
            vertices: gpu.uploaded("projected.vertices", BufferUsages::VERTEX, &points)?,
            indices: gpu.uploaded("projected.indices", BufferUsages::INDEX, &faces)?,
            count: faces.len() as u32 * 3,
            bound: gpu.bind("projected", &pipeline.get_bind_group_layout(0), &[(0, fall.as_entire_binding())]),
            mask: gpu.texture("projected.mask", (width, height), SHARE, usage),
            raster_from_local,
            fall,
            pipeline,
            receivers: scene.receivers.clone(),
            ground: scene.ground,
            grid,
            gpu,
        };
        projected.gpu.check()?;
        Ok(projected)
    }
}

impl Technique for ProjectedOnGpu {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let gpu = &self.gpu;
        let a_metre = throw(&self.raster_from_local, to_sun).as_vec2().to_array();
        let fall = layout::FallUniforms { a_metre, size: [self.grid.width as f32, self.grid.height as f32] };
        gpu.queue.write_buffer(&self.fall, 0, bytemuck::bytes_of(&fall));
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("projected"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &whole(&self.mask),
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::WHITE), store: StoreOp::Store },
            })],
            timestamp_writes: gpu.timed("projected"),
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bound, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(gpu, &self.mask))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        Ok(plan_surface(&self.receivers, self.ground, &self.grid))
    }
}

/// The parts of faces above the plane: points (column, row, height) and triangles.
fn above(mesh: &Mesh, raster_from_local: &DAffine3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let points = mesh.vertices.par_iter().map(|vertex| raster_from_local.transform_point3(vertex.as_dvec3()));
    let mut points: Vec<DVec3> = points.collect();
    let mut faces = Vec::with_capacity(mesh.faces.len());
    for &face in mesh.faces.iter() {
        let stands = face.map(|corner| points[corner as usize].z > 0.0);
        let count = stands.iter().filter(|stands| **stands).count();
        if count == 0 {
            continue;
        }
        // rotated so that the corner alone on its side comes first
        let alone = (0..3).find(|&at| stands[at] == (count == 1)).unwrap_or(0);
        let [one, next, last] = [0, 1, 2].map(|at| face[(alone + at) % 3]);
        if count == 3 {
            faces.push([one, next, last]);
            continue;
        }
        let [to_next, to_last] = [next, last].map(|other| {
            points.push(where_cut([one, other].map(|end| points[end as usize])));
            points.len() as u32 - 1
        });
        if count == 1 {
            faces.push([one, to_next, to_last]);
        } else {
            faces.extend([[to_next, next, last], [to_next, last, to_last]]);
        }
    }
    (points, faces)
}
