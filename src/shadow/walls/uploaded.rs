//! Walls from a finder on the processor: a list of indices that is uploaded at each instant.

use super::query::{WallQuery, Walls, sunward};
use crate::gpu::{Gpu, GpuError};
use crate::mesh::Mesh;
use crate::silhouette::{DirectedEdge, ProcessorFinder, SilhouetteFinder};
use crate::volume::Volume;
use std::sync::Arc;
use wgpu::{Buffer, BufferUsages, CommandEncoder, IndexFormat, RenderPass};

pub(super) struct UploadedWalls {
    gpu: Arc<Gpu>,
    finder: Box<dyn SilhouetteFinder>,
    indices: Buffer,
    /// The indices to upload, walls first; kept for its allocation.
    upload: Vec<u32>,
    /// The number of walls' indices.
    of_walls: u32,
}

impl UploadedWalls {
    pub(super) fn new(gpu: Arc<Gpu>, kind: ProcessorFinder, mesh: &Mesh) -> Result<UploadedWalls, GpuError> {
        let indices = buffer(&gpu, 4)?;
        Ok(UploadedWalls { gpu, finder: kind.build(mesh), indices, upload: Vec::new(), of_walls: 0 })
    }
}

fn buffer(gpu: &Gpu, size: u64) -> Result<Buffer, GpuError> {
    gpu.buffer("stencil.indices", size, BufferUsages::INDEX | BufferUsages::COPY_DST)
}

/// Appends a wall's triangles, counter-clockwise seen from outside.
fn append(upload: &mut Vec<u32>, mesh: &Mesh, wall: DirectedEdge, sought: &WallQuery) {
    let [from, to] = wall.map(|vertex| [vertex * 2, vertex * 2 + 1]);
    if sought.to_infinity {
        upload.extend([from[0], to[1], to[0]]); // far ends are one point
    } else if sunward(&mesh.vertices, wall, sought.local_light.as_vec4()) == wall[0] {
        upload.extend([from[0], from[1], to[1], from[0], to[1], to[0]]);
    } else {
        upload.extend([to[0], from[0], from[1], to[0], from[1], to[1]]);
    }
}

impl Walls for UploadedWalls {
    fn find(&mut self, mesh: &Mesh, sought: &WallQuery, _: &mut CommandEncoder) -> Result<bool, GpuError> {
        let volume = Volume::find(mesh, &mut *self.finder, sought.local_light, sought.with_cap);
        self.upload.clear();
        // repeated walls are consecutive
        for &wall in volume.walls.iter().step_by(if sought.halved { 2 } else { 1 }) {
            if !sought.borders.is_some_and(|borders| borders.hide(&mesh.vertices, wall)) {
                append(&mut self.upload, mesh, wall, sought);
            }
        }
        self.of_walls = self.upload.len() as u32;
        self.upload.extend(volume.light_cap.iter().flatten().map(|vertex| vertex * 2));

        let size = (self.upload.len() * 4) as u64;
        if size > self.indices.size() {
            // leaves room for the next instants, whose silhouettes are similar
            let roomy = (size + size / 2).next_multiple_of(4).min(self.gpu.limits.max_buffer_size.max(size));
            self.indices = buffer(&self.gpu, roomy)?;
        }
        self.gpu.queue.write_buffer(&self.indices, 0, bytemuck::cast_slice(&self.upload));
        Ok(!self.upload.is_empty())
    }

    fn draw_walls(&self, pass: &mut RenderPass<'_>) {
        pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(0..self.of_walls, 0, 0..1);
    }

    fn draw_cap(&self, pass: &mut RenderPass<'_>) {
        pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(self.of_walls..self.upload.len() as u32, 0, 0..1);
    }
}
