//! Silhouettes found on the GPU: one pass over all edges writes the list of walls and the arguments of the indirect
//! draw, and nothing is read back.
//!
//! The twin of [`crate::silhouette::brute_force`]. (Akenine-Möller, Haines and Hoffman, *Real-Time Rendering*, 3rd
//! edition, 2008, section 9.1, extract silhouettes in the vertex shader, since there were no compute passes:
//! `Silhouettes::InVertexShader`, for comparison in tests and benches. Here only silhouette edges become vertices.)
//! Facing is a bit from `super::faces`. Edges are split into runs, so short that their buffers fit the adapter's
//! bindings even if all of their edges are silhouette.

use super::faces::{self, Faces, GROUP};
use super::query::{NO_FACE, WallQuery, Walls, along, packed};
use crate::gpu::{Gpu, GpuError, layout, shaders};
use crate::mesh::Mesh;
use std::sync::Arc;
use wgpu::{
    BindGroup, Buffer, BufferUsages, CommandEncoder, ComputePassDescriptor, ComputePipeline, IndexFormat, RenderPass,
};

/// Flags an edge with more than two faces (`CROWDED` of `shaders/extraction.wgsl`).
const CROWDED: u32 = 1 << 31;

/// The draw arguments before edges are added.
const NOTHING_DRAWN: layout::DrawArguments =
    layout::DrawArguments { index_count: 0, instance_count: 1, first_index: 0, base_vertex: 0, first_instance: 0 };

/// The pipelines, shared by all meshes.
pub struct ExtractionProgram {
    pub(super) faces: Arc<faces::FacingProgram>,
    extract: ComputePipeline,
}

impl ExtractionProgram {
    /// Compiles the shaders.
    pub fn new(gpu: &Arc<Gpu>) -> ExtractionProgram {
        let module = gpu.shader("extraction", shaders::EXTRACTION);
        ExtractionProgram {
            faces: Arc::new(faces::FacingProgram::new(gpu)),
            extract: gpu.compute("extraction", &module, "extract"),
        }
    }
}

/// The edges of one mesh on the GPU.
pub struct Extraction {
    gpu: Arc<Gpu>,
    extract: ComputePipeline,
    most: u64,
    faces: Faces,
    runs: Vec<EdgeRun>,
}

/// A run of edges.
struct EdgeRun {
    count: u32,
    edges: Buffer,
    /// The faces at crowded edges.
    crowds: Buffer,
    /// The total number of faces at the edges: the most walls that there can be.
    most_walls: u64,
    arguments: Buffer,
    /// Made when first needed, and replaced if it becomes too small.
    list: Option<WallList>,
}

/// The buffer for a run's walls.
struct WallList {
    indices: Buffer,
    bound: BindGroup,
}

/// A run before it is uploaded.
#[derive(Default)]
struct EdgeRunData {
    edges: Vec<layout::EdgeRecord>,
    crowds: Vec<u32>,
    most_walls: u64,
}

impl EdgeRunData {
    fn add(&mut self, mesh: &Mesh, edge: usize) {
        let [first, second] = mesh.edges[edge];
        let faces = mesh.faces_at(edge);
        let [a, b] = match *faces {
            [a] => [packed(a), NO_FACE],
            [a, b] => [packed(a), packed(b)],
            _ => [CROWDED | self.crowds.len() as u32, faces.len() as u32],
        };
        if faces.len() > 2 {
            self.crowds.extend(faces.iter().map(|&face| packed(face)));
        }
        let along = along(&mesh.vertices, [first, second]).to_array();
        self.edges.push(layout::EdgeRecord { first, second, a, b, along });
        self.most_walls += faces.len() as u64;
    }

    /// Whether an edge with this many faces still fits into buffers of `most` bytes.
    fn has_room(&self, faces: usize, most: u64) -> bool {
        let edges = (self.edges.len() as u64 + 1) * size_of::<layout::EdgeRecord>() as u64;
        let crowds = (self.crowds.len() + faces) as u64 * 4;
        let list = (self.most_walls + faces as u64) * 24; // six indices a wall
        edges.max(crowds).max(list) <= most
    }

    fn uploaded(self, gpu: &Gpu, most: u64) -> Result<EdgeRun, GpuError> {
        let edges_size = size_of_val(&self.edges[..]) as u64;
        let edges = gpu.storage("extraction.edges", edges_size, most, BufferUsages::COPY_DST)?;
        let crowds_size = size_of_val(&self.crowds[..]) as u64;
        let crowds = gpu.storage("extraction.crowds", crowds_size, most, BufferUsages::COPY_DST)?;
        let usage = BufferUsages::INDIRECT | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        let arguments_size = size_of::<layout::DrawArguments>() as u64;
        let arguments = gpu.storage("extraction.arguments", arguments_size, most, usage)?;
        gpu.queue.write_buffer(&edges, 0, bytemuck::cast_slice(&self.edges));
        gpu.queue.write_buffer(&crowds, 0, bytemuck::cast_slice(&self.crowds));
        let EdgeRunData { edges: gathered, most_walls, .. } = self;
        Ok(EdgeRun { count: gathered.len() as u32, edges, crowds, most_walls, arguments, list: None })
    }
}

impl Extraction {
    /// Uploads the edges of a mesh, in runs whose buffers have at most `most` bytes.
    pub fn new(program: &ExtractionProgram, mesh: &Mesh, most: u64) -> Result<Extraction, GpuError> {
        let gpu = Arc::clone(&program.faces.gpu);
        let mut runs = Vec::new();
        let mut run = EdgeRunData::default();
        for edge in 0..mesh.edges.len() {
            if !run.edges.is_empty() && !run.has_room(mesh.faces_at(edge).len(), most) {
                runs.push(std::mem::take(&mut run).uploaded(&gpu, most)?);
            }
            run.add(mesh, edge);
        }
        if !run.edges.is_empty() {
            runs.push(run.uploaded(&gpu, most)?);
        }
        let faces = Faces::new(&program.faces, mesh, most)?;
        gpu.check()?;
        Ok(Extraction { gpu, extract: program.extract.clone(), most, faces, runs })
    }

    /// The number of runs of edges.
    #[cfg(feature = "test-hooks")]
    pub fn runs(&self) -> usize {
        self.runs.len()
    }

    /// Reads back the lists that were written last, walls and cap. Drawing does not need this: it reads them on the
    /// GPU.
    #[cfg(feature = "test-hooks")]
    pub fn read(&self) -> Result<[Vec<u32>; 2], GpuError> {
        let mut walls = Vec::new();
        for run in &self.runs {
            let drawn: Vec<u32> = crate::gpu::readback::values(&self.gpu, &run.arguments)?;
            if let Some(list) = &run.list {
                let indices: Vec<u32> = crate::gpu::readback::values(&self.gpu, &list.indices)?;
                walls.extend(&indices[..drawn[0] as usize]);
            }
        }
        let mut cap = Vec::new();
        for (indices, count) in self.faces.cap() {
            cap.extend(&crate::gpu::readback::values::<u32>(&self.gpu, indices)?[..count as usize]);
        }
        Ok([walls, cap])
    }
}

impl EdgeRun {
    /// Makes the list as long as it may need to be.
    fn make_list(&mut self, extraction: &Extraction, sought: &WallQuery) -> Result<(), GpuError> {
        let gpu = &extraction.gpu;
        let most_walls = self.most_walls >> u32::from(sought.halved);
        let size = most_walls * u64::from(sought.indices_per_wall()) * 4;
        if self.list.as_ref().is_some_and(|list| list.indices.size() >= size) {
            return Ok(());
        }
        let usage = BufferUsages::INDEX | BufferUsages::COPY_SRC;
        let indices = gpu.storage("extraction.walls", size, extraction.most, usage)?;
        let bound = gpu.bind(
            "extraction",
            &extraction.extract.get_bind_group_layout(GROUP),
            &[
                (0, extraction.faces.search.as_entire_binding()),
                (1, extraction.faces.facing.as_entire_binding()),
                (2, self.edges.as_entire_binding()),
                (3, self.crowds.as_entire_binding()),
                (4, indices.as_entire_binding()),
                (5, self.arguments.as_entire_binding()),
            ],
        );
        self.list = Some(WallList { indices, bound });
        Ok(())
    }
}

impl Walls for Extraction {
    fn find(&mut self, mesh: &Mesh, sought: &WallQuery, encoder: &mut CommandEncoder) -> Result<bool, GpuError> {
        let mut runs = std::mem::take(&mut self.runs);
        let made = runs.iter_mut().try_for_each(|run| run.make_list(self, sought));
        self.runs = runs;
        made?;
        self.faces.find(mesh, sought, encoder)?;
        let timestamp_writes = self.gpu.timed_compute("extraction");
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("extraction"), timestamp_writes });
        pass.set_pipeline(&self.extract);
        for run in &self.runs {
            let Some(list) = &run.list else { continue };
            self.gpu.queue.write_buffer(&run.arguments, 0, bytemuck::bytes_of(&NOTHING_DRAWN));
            pass.set_bind_group(GROUP, &list.bound, &[]);
            self.gpu.dispatch(&mut pass, run.count);
        }
        Ok(true)
    }

    fn draw_walls(&self, pass: &mut RenderPass<'_>) {
        for run in &self.runs {
            let Some(list) = &run.list else { continue };
            pass.set_index_buffer(list.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed_indirect(&run.arguments, 0);
        }
    }

    fn draw_cap(&self, pass: &mut RenderPass<'_>) {
        self.faces.draw_cap(pass);
    }
}
