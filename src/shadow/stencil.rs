//! Stencil shadow volumes: exact hard shadows.
//!
//! Crow 1977; Heidmann's z-pass and Carmack's z-fail after seed 004, sections 3 to 6. Walls hang from the silhouette and
//! are extruded in the vertex shader; two-sided stencil with wrap counts them; a cell is in shadow where the count is
//! not 0. One render pass an instant: what faces away, then per batch of casters the count and its trace in the mask.
//!
//! - **z-pass** counts the walls in front of what is seen, so it needs no dark cap and walls that end at the lowest
//!   receiver. It is right where nothing of a volume is cut by the near plane: always in the plan, whose near plane
//!   lies above everything; in a camera view where no caster reaches into the near-clip volume, which is spanned by the
//!   near rectangle and the direction to the sun (seed 004, section 7). It needs the light cap where casters are not
//!   among what is seen.
//! - **z-fail** counts behind what is seen, in all other views: with light cap, and walls to the sun's point at infinity,
//!   which needs no dark cap. Depth is reversed, so that point has depth 0 exactly and no far plane cuts it.
//! - The stencil holds 8 bits: casters come in batches, none of which counts further ([`super::batch`]).
//!
//! Deviation from the seed: the general rule of [`crate::silhouette`] instead of well-wound closed meshes alone.

use super::batch::Batch;
use super::{DrawnMask, GpuSurface, Scene, ShadowError, Technique};
use crate::gpu::targets::{COUNTED, SHARE, Stages, whole};
use crate::gpu::{Gpu, shaders};
use crate::mesh::Mesh;
use crate::silhouette::Kind;
use crate::view::{Camera, Surface, View};
use crate::volume::Volume;
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;
use wgpu::*;

/// The technique, made for one scene and one view.
pub struct Stencil {
    scene: Scene,
    view: View,
    surface: GpuSurface,
    casters: Vec<Batch>,
    /// Every caster is among what is seen, so that z-pass needs no light cap.
    casters_are_seen: bool,
    vertices: Buffer,
    indices: Buffer,
    judged: TextureView,
    mask: Texture,
    pipelines: Pipelines,
    forced_z_fail: Option<bool>,
    /// What is uploaded at an instant; kept for its memory.
    upload: Vec<u32>,
}

/// One batch in the index buffer.
struct Counted {
    walls: Range<u32>,
    cap: Range<u32>,
}

struct Pipelines {
    facing: RenderPipeline,
    covered: RenderPipeline,
    plan: Counting,
    z_pass: Counting,
    z_fail: Counting,
}

struct Counting {
    wall: RenderPipeline,
    cap: RenderPipeline,
}

impl Stencil {
    /// Draws what is seen, uploads the casters, builds the pipelines.
    pub fn new(gpu: Arc<Gpu>, scene: Scene, view: View, finder: Kind) -> Result<Stencil, ShadowError> {
        let surface = GpuSurface::draw(Arc::clone(&gpu), &scene, view)?;
        let judged = whole(&surface.judged());
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let mask = gpu.texture("stencil.mask", view.size(), SHARE, usage);
        let twice: Vec<[f32; 4]> = scene
            .casters
            .vertices
            .iter()
            .flat_map(|vertex| [vertex.extend(1.0).to_array(), vertex.extend(0.0).to_array()])
            .collect();
        let size = (twice.len().max(1) * size_of::<[f32; 4]>()) as u64;
        let vertices = gpu.buffer("stencil.casters", size, BufferUsages::VERTEX | BufferUsages::COPY_DST)?;
        gpu.queue.write_buffer(&vertices, 0, bytemuck::cast_slice(&twice));
        let indices = gpu.buffer("stencil.indices", 4, BufferUsages::INDEX | BufferUsages::COPY_DST)?;
        let pipelines = Pipelines::new(&gpu, &surface);
        let casters_are_seen = holds_all(&scene);
        let casters = Batch::of(&scene.casters, finder);
        gpu.check()?;
        Ok(Stencil {
            scene,
            view,
            surface,
            casters,
            casters_are_seen,
            vertices,
            indices,
            judged,
            mask,
            pipelines,
            forced_z_fail: None,
            upload: Vec::new(),
        })
    }

    /// Counts camera views by z-fail (`true`) or z-pass (`false`), right or wrong: z-fail always is right, and z-pass must be
    /// seen to fail where it is not chosen.
    pub fn force_z_fail(&mut self, z_fail: bool) {
        self.forced_z_fail = Some(z_fail);
    }

    /// Finds the volumes for a sun and writes their indices: walls and, with `cap`, the light cap.
    fn find_volumes(&mut self, to_sun: DVec3, z_fail: bool, cap: bool) -> Vec<Counted> {
        let mut counted = Vec::new();
        let upload = &mut self.upload;
        upload.clear();
        let mut write = |mesh: &Mesh, volume: Volume| {
            let first = upload.len() as u32;
            for wall in volume.walls {
                let [from, to] = wall.map(|vertex| [vertex * 2, vertex * 2 + 1]);
                let height = |index: u32| mesh.vertices[index as usize / 2].z;
                // counter-clockwise seen from outside, and first the highest vertex, from which the shader takes slivers' depth
                if z_fail {
                    upload.extend([from[0], to[1], to[0]]); // far ends are one point
                } else if height(from[0]) >= height(to[0]) {
                    upload.extend([from[0], from[1], to[1], from[0], to[1], to[0]]);
                } else {
                    upload.extend([to[0], from[0], from[1], to[0], from[1], to[1]]);
                }
            }
            let middle = upload.len() as u32;
            upload.extend(volume.light_cap.iter().flatten().map(|vertex| vertex * 2));
            counted.push(Counted { walls: first..middle, cap: middle..upload.len() as u32 });
        };
        for batch in &mut self.casters {
            batch.volumes(to_sun, cap, &mut write);
        }
        counted
    }

    fn upload_indices(&mut self) -> Result<(), ShadowError> {
        let gpu = &self.surface.gpu;
        let size = (self.upload.len() * 4) as u64;
        if size > self.indices.size() {
            // room for the next instants, whose silhouettes are much alike
            let roomy = (size + size / 2).next_multiple_of(4).min(gpu.limits.max_buffer_size.max(size));
            self.indices = gpu.buffer("stencil.indices", roomy, BufferUsages::INDEX | BufferUsages::COPY_DST)?;
        }
        gpu.queue.write_buffer(&self.indices, 0, bytemuck::cast_slice(&self.upload));
        Ok(())
    }
}

/// Whether every component that casts also receives.
fn holds_all(scene: &Scene) -> bool {
    let received: rustc_hash::FxHashSet<[u32; 3]> = scene.receivers.faces.iter().copied().collect();
    scene.casters.faces.iter().all(|face| received.contains(face))
}

impl Technique for Stencil {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let z_fail = match &self.view {
            View::Plan(_) => false,
            View::Camera(camera) => {
                self.forced_z_fail.unwrap_or_else(|| near_clip_volume_touched(camera, to_sun, &self.scene.casters))
            }
        };
        let counted = self.find_volumes(to_sun, z_fail, z_fail || !self.casters_are_seen);
        self.upload_indices()?;
        self.surface.set_sun(to_sun);
        let gpu = &self.surface.gpu;
        let counting = match self.view {
            View::Plan(_) => &self.pipelines.plan,
            View::Camera(_) if z_fail => &self.pipelines.z_fail,
            View::Camera(_) => &self.pipelines.z_pass,
        };

        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("stencil"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &whole(&self.mask),
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &self.judged,
                depth_ops: None,
                stencil_ops: Some(Operations { load: LoadOp::Clear(0), store: StoreOp::Discard }),
            }),
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.surface.frame, &[]);
        pass.set_bind_group(1, &self.surface.seen, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
        pass.set_pipeline(&self.pipelines.facing);
        pass.draw(0..3, 0..1);
        for Counted { walls, cap } in counted {
            pass.set_pipeline(&counting.wall);
            pass.draw_indexed(walls, 0, 0..1);
            if !cap.is_empty() {
                pass.set_pipeline(&counting.cap);
                pass.draw_indexed(cap, 0, 0..1);
            }
            pass.set_pipeline(&self.pipelines.covered);
            pass.draw(0..3, 0..1);
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(gpu, &self.mask))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.surface.read()
    }
}

/// Whether a caster may reach into the near-clip volume, the near rectangle swept towards the sun. Boxes around
/// components stand for them, so the answer may be yes too often, never no.
pub fn near_clip_volume_touched(camera: &Camera, to_sun: DVec3, casters: &Mesh) -> bool {
    let [right, up, forward] = camera.axes();
    let middle = camera.eye + forward * Camera::NEAR_M;
    let half = camera.half_size() * Camera::NEAR_M;
    let corner = |x: f64, y: f64| middle + right * half.x * x + up * half.y * y;
    let rectangle = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    // planes with what is outside in front: four sides, and the rectangle itself on the side away from the sun
    let mut planes = Vec::from([forward * -forward.dot(to_sun).signum()].map(|normal| (normal, middle)));
    for index in 0..4 {
        let (from, to) = (rectangle[index], rectangle[(index + 1) % 4]);
        let normal = (to - from).cross(to_sun);
        let outward = if normal.dot(middle - from) > 0.0 { -normal } else { normal };
        planes.push((outward, from));
    }
    casters.components.iter().any(|component| {
        let Some((low, high)) = casters.bounds_of(component.faces.clone()) else { return false };
        // the corner farthest inwards lies outside: so does the box
        let outside = |&(normal, point): &(DVec3, DVec3)| {
            let inmost = DVec3::select(normal.cmpgt(DVec3::ZERO), low, high);
            normal.dot(inmost - point) > 0.0
        };
        !planes.iter().any(outside)
    })
}

impl Pipelines {
    fn new(gpu: &Gpu, surface: &GpuSurface) -> Pipelines {
        let module = gpu.shader("stencil", shaders::STENCIL);
        let layout = surface.seeing_layout();
        let corner = VertexBufferLayout {
            array_stride: size_of::<[f32; 4]>() as u64,
            step_mode: VertexStepMode::Vertex,
            attributes: &vertex_attr_array![0 => Float32x4],
        };
        let buffers = [Some(corner)];
        let pipeline = |label: &str, vertex, fragment, writes, depth_stencil| {
            let buffers: &[_] = if vertex == "whole_picture" { &[] } else { &buffers };
            let target = Some((SHARE, writes));
            let stages = Stages { module: &module, vertex, fragment, buffers, target, layout: Some(&layout) };
            gpu.pipeline(label, stages, Some(depth_stencil))
        };
        let whole_picture = |compare, pass_op| {
            let face = StencilFaceState { compare, pass_op, ..StencilFaceState::default() };
            state(CompareFunction::Always, face, face)
        };
        let [pass_front, pass_back] = [StencilOperation::IncrementWrap, StencilOperation::DecrementWrap]
            .map(|pass_op| StencilFaceState { pass_op, ..StencilFaceState::default() });
        let [fail_front, fail_back] = [StencilOperation::DecrementWrap, StencilOperation::IncrementWrap]
            .map(|depth_fail_op| StencilFaceState { depth_fail_op, ..StencilFaceState::default() });
        let counting = |name: &str,
                        [wall, cap]: [&'static str; 2],
                        [wall_counted, cap_counted]: [&'static str; 2],
                        front,
                        back| {
            // strictly nearer than what is judged
            let part = |part: &str, vertex: &'static str, counted: &'static str| {
                let state = state(CompareFunction::Greater, front, back);
                pipeline(&format!("stencil.{name}.{part}"), vertex, counted, ColorWrites::empty(), state)
            };
            Counting { wall: part("wall", wall, wall_counted), cap: part("cap", cap, cap_counted) }
        };
        let in_plan = ["counted_in_plan", "cap_counted_in_plan"];
        Pipelines {
            facing: pipeline(
                "stencil.facing",
                "whole_picture",
                "facing",
                ColorWrites::ALL,
                whole_picture(CompareFunction::Always, StencilOperation::Keep),
            ),
            covered: pipeline(
                "stencil.covered",
                "whole_picture",
                "covered",
                ColorWrites::ALL,
                whole_picture(CompareFunction::NotEqual, StencilOperation::Zero),
            ),
            plan: counting("plan", ["wall_to_lowest", "cap_in_plan"], in_plan, pass_front, pass_back),
            z_pass: counting("z_pass", ["wall_to_lowest", "cap"], ["counted"; 2], pass_front, pass_back),
            z_fail: counting("z_fail", ["wall_to_infinity", "cap"], ["counted"; 2], fail_front, fail_back),
        }
    }
}

/// The depth is only read; the stencil reference is 0 throughout.
fn state(depth_compare: CompareFunction, front: StencilFaceState, back: StencilFaceState) -> DepthStencilState {
    DepthStencilState {
        format: COUNTED,
        depth_write_enabled: Some(false),
        depth_compare: Some(depth_compare),
        stencil: StencilState { front, back, read_mask: 0xff, write_mask: 0xff },
        bias: DepthBiasState::default(),
    }
}
