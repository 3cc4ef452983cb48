//! Hard shadows filled by the graphics adapter. Each patch is a viewport in its page, into which its occluders are
//! drawn; then every judged texel of the page that is not covered gets the sample's weight, in integers.
//!
//! One mask is used for all pages. For each sample the matrices of its patches and the lists of their occluders go to
//! the adapter; nothing is read back before the end.

use super::occluders::Occluders;
use super::query::{Choice, OccluderQuery, PatchJudgements, Sample, is_drawn, raster};
use crate::gpu::layout::TexelRunUniforms;
use crate::gpu::targets::{SHARE, Stages, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::mesh::Mesh;
use crate::mesh::patches::Patches;
use crate::shadow::ShadowError;
use crate::shadow::registered::{LEAST_W, RasterProjection};
use bytemuck::{Pod, Zeroable};
use glam::{DVec4, Vec3};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use wgpu::*;

/// The number of faces' corners that are uploaded at once.
const INDICES_AT_ONCE: usize = 3 << 19;
/// The number of patches whose occluders are found before they are drawn.
const PATCHES_AT_ONCE: usize = 1 << 12;
/// The depth per metre above the plane: small enough that nothing within the adapter's range is clipped.
const DEPTH_A_METRE: f64 = 1e-7;

/// `Onto` of the shader: a vertex buffer, one for each patch.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Onto([[f32; 4]; 4]);

/// The adapter's part of the technique.
pub(super) struct AdapterDrawer {
    gpu: Arc<Gpu>,
    /// The patches that are drawn, page by page.
    drawn: Vec<u32>,
    pages: Vec<Page>,
    /// The texel ranges of the drawn patches, in their order.
    texels: Vec<Range<u32>>,
    mask: Texture,
    vertices: Buffer,
    indices: Buffer,
    ontos: Buffer,
    weights: Buffer,
    sums: Buffer,
    occluder: RenderPipeline,
    add: ComputePipeline,
    bytes: u64,
}

/// The part of the atlas in one page.
struct Page {
    /// A range of the drawn patches.
    patches: Range<usize>,
    /// A range of the texels on the adapter.
    texels: Range<u32>,
    group: BindGroup,
}

/// A patch's occluders for one sample.
struct PatchOccluders {
    onto: Onto,
    indices: Vec<u32>,
    /// The number of faces after culling.
    found: usize,
}

impl Page {
    /// `buffers` are the texels' positions and patches, the patches' weights, and the texels' sums.
    fn new(gpu: &Gpu, add: &ComputePipeline, mask: &Texture, run: PageRun, buffers: [&Buffer; 4]) -> Page {
        let (patches, texels) = run;
        let run = gpu.uniform::<TexelRunUniforms>("soft_texture.run");
        let counted = TexelRunUniforms { first: texels.start, count: texels.end - texels.start };
        gpu.queue.write_buffer(&run, 0, bytemuck::bytes_of(&counted));
        let mask = whole(mask);
        let mut entries = vec![(0, BindingResource::TextureView(&mask))];
        let buffers = buffers.into_iter().chain([&run]);
        entries.extend((1..).zip(buffers.map(|buffer| buffer.as_entire_binding())));
        let group = gpu.bind("soft_texture.add", &add.get_bind_group_layout(0), &entries);
        Page { patches, texels, group }
    }
}

/// The drawn patches of one page, and their texels on the adapter.
type PageRun = (Range<usize>, Range<u32>);

/// The patches that are drawn, page by page, and their data for the adapter.
#[derive(Default)]
struct DrawnPatches {
    list: Vec<u32>,
    /// The texel range of each.
    texels: Vec<Range<u32>>,
    /// The position of each of these texels in its page: its column, and in the upper bits its row.
    places: Vec<u32>,
    /// The index of each texel's patch in the list.
    patch_of: Vec<u32>,
    runs: Vec<PageRun>,
}

impl DrawnPatches {
    fn of(patches: &Patches, choice: Choice) -> DrawnPatches {
        let is_drawn = |at: &u32| is_drawn(&patches.list[*at as usize], choice);
        let mut list: Vec<u32> = (0..patches.list.len() as u32).filter(is_drawn).collect();
        list.sort_by_key(|&at| patches.list[at as usize].page);
        let mut drawn = DrawnPatches::default();
        for (slot, &at) in list.iter().enumerate() {
            let patch = &patches.list[at as usize];
            let first = drawn.places.len() as u32;
            for texel in &patches.texels[patch.texels.start as usize..patch.texels.end as usize] {
                drawn.places.push((patch.x + u32::from(texel.column)) | (patch.y + u32::from(texel.row)) << 16);
                drawn.patch_of.push(slot as u32);
            }
            drawn.texels.push(patch.texels.clone());
            let last = drawn.places.len() as u32;
            let same_page = slot > 0 && patches.list[list[slot - 1] as usize].page == patch.page;
            match drawn.runs.last_mut().filter(|_| same_page) {
                Some((of_patches, of_texels)) => (of_patches.end, of_texels.end) = (slot + 1, last),
                None => drawn.runs.push((slot..slot + 1, first..last)),
            }
        }
        DrawnPatches { list, ..drawn }
    }
}

impl AdapterDrawer {
    pub(super) fn new(
        gpu: Arc<Gpu>,
        casters: &Mesh,
        patches: &Patches,
        choice: Choice,
    ) -> Result<AdapterDrawer, ShadowError> {
        let DrawnPatches { list: drawn, texels, places, patch_of, runs } = DrawnPatches::of(patches, choice);
        let most = gpu.most_storage();
        let storage = |label: &str, values: &[u32]| {
            let buffer = gpu.storage(label, size_of_val(values) as u64, most, BufferUsages::COPY_DST)?;
            gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(values));
            Ok::<_, ShadowError>(buffer)
        };
        let (places, patch_of) =
            (storage("soft_texture.places", &places)?, storage("soft_texture.patches", &patch_of)?);
        let sums = gpu.storage("soft_texture.sums", places.size(), most, BufferUsages::COPY_SRC)?;
        let weights = gpu.storage("soft_texture.weights", drawn.len() as u64 * 4, most, BufferUsages::COPY_DST)?;
        let ontos = (drawn.len().max(1) * size_of::<Onto>()) as u64;
        let ontos = gpu.buffer("soft_texture.ontos", ontos, BufferUsages::VERTEX | BufferUsages::COPY_DST)?;
        let vertices = gpu.uploaded("soft_texture.vertices", BufferUsages::VERTEX, &casters.vertices)?;
        let indices = gpu.buffer(
            "soft_texture.indices",
            INDICES_AT_ONCE as u64 * 4,
            BufferUsages::INDEX | BufferUsages::COPY_DST,
        )?;
        let side = if runs.is_empty() { 1 } else { patches.page_size };
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let mask = gpu.texture("soft_texture.mask", (side, side), SHARE, usage);

        let module = gpu.shader("soft_texture", shaders::SOFT_TEXTURE);
        let occluder = occluder(&gpu, &module);
        let add = gpu.compute("soft_texture.add", &module, "add");
        let page = |run| Page::new(&gpu, &add, &mask, run, [&places, &patch_of, &weights, &sums]);
        let pages = runs.into_iter().map(page).collect();
        let buffers = [&places, &patch_of, &sums, &weights, &ontos, &vertices, &indices];
        let bytes = buffers.map(Buffer::size).iter().sum::<u64>() + u64::from(side) * u64::from(side);
        gpu.check()?;
        Ok(AdapterDrawer {
            gpu,
            drawn,
            pages,
            texels,
            mask,
            vertices,
            indices,
            ontos,
            weights,
            sums,
            occluder,
            add,
            bytes,
        })
    }

    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Adds a sample to all drawn patches. Returns those that are left to rays, in order.
    pub(super) fn add(
        &self,
        sought: &OccluderQuery<'_>,
        casters: &Mesh,
        sample: &Sample,
    ) -> Result<(PatchJudgements, Vec<u32>), ShadowError> {
        let patches = sought.patches;
        let (mut judged, mut left) = (PatchJudgements::default(), Vec::new());
        let mut weights = vec![0; self.drawn.len()];
        for page in &self.pages {
            let mut canvas = Canvas { drawer: self, patches, cleared: false, indices: Vec::new(), draws: Vec::new() };
            for first in page.patches.clone().step_by(PATCHES_AT_ONCE) {
                let slots = first..page.patches.end.min(first + PATCHES_AT_ONCE);
                let find = |(waiting, found): &mut (Vec<u32>, Vec<u32>), slot: usize| {
                    let patch = &patches.list[self.drawn[slot] as usize];
                    let onto = RasterProjection::new(&raster(patch, patches.cell, sample.light)?, sample.light)?;
                    let Some(Occluders { corners, faces, .. }) = sought.find(patch, &onto, waiting, found) else {
                        return Some(Err(self.drawn[slot]));
                    };
                    // the adapter's single precision must not decide on faces in the patch itself
                    let above = |corner: Vec3| onto.height.dot(corner.as_dvec3().extend(1.0)) > 0.0;
                    let drawn = found.iter().filter(|at| corners[**at as usize].into_iter().any(above));
                    let indices = drawn.flat_map(|at| casters.faces[faces[*at as usize] as usize]).collect();
                    let onto = in_viewport(&onto, (patch.width, patch.height), sample.light);
                    Some(Ok(PatchOccluders { onto, indices, found: found.len() }))
                };
                let found: Vec<_> = slots.clone().into_par_iter().map_init(Default::default, find).collect();
                for (slot, occluded) in slots.zip(found) {
                    match occluded {
                        None => {}
                        Some(Err(patch)) => left.push(patch),
                        Some(Ok(occluded)) => {
                            weights[slot] = sample.weight;
                            judged.textures += 1;
                            judged.texture_texels += self.texels[slot].len() as u64;
                            judged.faces += occluded.found as u64;
                            canvas.draw(slot, &occluded);
                        }
                    }
                }
            }
            if weights[page.patches.clone()].iter().any(|weight| *weight > 0) {
                canvas.flush();
                self.gpu.queue.write_buffer(&self.weights, 0, bytemuck::cast_slice(&weights));
                self.count(page);
            }
        }
        self.gpu.check()?;
        left.sort_unstable();
        Ok((judged, left))
    }

    /// Adds the weight to every texel of a page that is not covered.
    fn count(&self, page: &Page) {
        let mut encoder = self.gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let described = ComputePassDescriptor { label: Some("soft_texture.add"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&described);
        pass.set_pipeline(&self.add);
        pass.set_bind_group(0, &page.group, &[]);
        self.gpu.dispatch(&mut pass, page.texels.end - page.texels.start);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// The sums of all texels of the patches; 0 for those that are not drawn.
    pub(super) fn sums(&self) -> Result<Vec<u32>, ShadowError> {
        let drawn: Vec<u32> = readback::values(&self.gpu, &self.sums)?;
        let count = self.texels.iter().map(|texels| texels.end).max().unwrap_or(0);
        let mut sums = vec![0; count as usize];
        let mut first = 0;
        for texels in &self.texels {
            let here = &mut sums[texels.start as usize..texels.end as usize];
            here.copy_from_slice(&drawn[first..first + here.len()]);
            first += here.len();
        }
        Ok(sums)
    }
}

/// The draws for a page.
struct Canvas<'a> {
    drawer: &'a AdapterDrawer,
    patches: &'a Patches,
    cleared: bool,
    indices: Vec<u32>,
    draws: Vec<(usize, Onto, Range<u32>)>,
}

impl Canvas<'_> {
    fn draw(&mut self, slot: usize, occluded: &PatchOccluders) {
        let mut rest = occluded.indices.as_slice();
        while !rest.is_empty() {
            if self.indices.len() == INDICES_AT_ONCE {
                self.flush();
            }
            let (now, later) = rest.split_at(rest.len().min(INDICES_AT_ONCE - self.indices.len()));
            let first = self.indices.len() as u32;
            self.indices.extend(now);
            self.draws.push((slot, occluded.onto, first..self.indices.len() as u32));
            rest = later;
        }
    }

    fn flush(&mut self) {
        let AdapterDrawer { gpu, mask, vertices, indices, ontos, occluder, drawn, .. } = self.drawer;
        gpu.queue.write_buffer(indices, 0, bytemuck::cast_slice(&self.indices));
        let matrices: Vec<Onto> = self.draws.iter().map(|(_, onto, _)| *onto).collect();
        gpu.queue.write_buffer(ontos, 0, bytemuck::cast_slice(&matrices));
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let load = if self.cleared { LoadOp::Load } else { LoadOp::Clear(Color::BLACK) };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("soft_texture"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &whole(mask),
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load, store: StoreOp::Store },
            })],
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(occluder);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_vertex_buffer(1, ontos.slice(..));
        pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
        for (number, (slot, _, range)) in (0..).zip(&self.draws) {
            let patch = &self.patches.list[drawn[*slot] as usize];
            let [x, y, width, height] = [patch.x, patch.y, patch.width, patch.height];
            pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
            pass.set_scissor_rect(x, y, width, height);
            pass.draw_indexed(range.clone(), 0, number..number + 1);
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        self.cleared = true;
        self.indices.clear();
        self.draws.clear();
    }
}

/// The projection in the viewport of a patch: −1 to 1, with y up.
fn in_viewport(onto: &RasterProjection, (width, height): (u32, u32), light: DVec4) -> Onto {
    let across = (onto.column + onto.w * 0.5) * (2.0 / f64::from(width)) - onto.w;
    let up = onto.w - (onto.row + onto.w * 0.5) * (2.0 / f64::from(height));
    // depth is from 0 in the plane to w just below a lamp
    let front = onto.height.dot(light);
    let depth = if light.w == 0.0 { DEPTH_A_METRE } else { DEPTH_A_METRE.min(LEAST_W / front) };
    Onto([across, up, onto.w, onto.height * depth].map(|form| form.as_vec4().to_array()))
}

fn occluder(gpu: &Gpu, module: &ShaderModule) -> RenderPipeline {
    let vertex = VertexBufferLayout {
        array_stride: 12,
        step_mode: VertexStepMode::Vertex,
        attributes: &vertex_attr_array![0 => Float32x3],
    };
    let onto = VertexBufferLayout {
        array_stride: size_of::<Onto>() as u64,
        step_mode: VertexStepMode::Instance,
        attributes: &vertex_attr_array![1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4],
    };
    let stages = Stages {
        module,
        vertex: "occluder",
        fragment: "covered",
        buffers: &[Some(vertex), Some(onto)],
        target: Some((SHARE, ColorWrites::ALL)),
        layout: None,
    };
    gpu.pipeline("soft_texture.occluder", stages, None)
}
