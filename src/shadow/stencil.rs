//! Stencil shadow volumes: exact hard shadows.
//!
//! Crow 1977; Heidmann's z-pass and Carmack's z-fail after seed 004, sections 3 to 6. Walls hang from the silhouette and
//! are extruded in the vertex shader; two-sided stencil with wrap counts them; a cell is in shadow where the count is
//! not 0. One render pass an instant: what faces away, then the casters' count and its trace in the mask.
//!
//! - **z-pass** counts the walls in front of what is seen, so it needs no dark cap and walls that end at the lowest
//!   receiver. It is right where nothing of a volume is cut by the near plane: always in the plan, whose near plane
//!   lies above everything; in a camera view where no caster reaches into the near-clip volume, which is spanned by the
//!   near rectangle and the direction to the sun (seed 004, section 7), and that looks from above the ground, so that no
//!   ray meets the walls' open lower end. It needs the light cap where casters are not among what is seen.
//! - **z-fail** counts behind what is seen, in all other views: with light cap, and walls to the sun's point at infinity,
//!   which needs no dark cap. Depth is reversed, so that point has depth 0 exactly and no far plane cuts it.
//! - The stencil holds 8 bits: casters come in batches, none of which counts further (`batch.rs`).
//!
//! Deviation from the seed: the general rule of [`crate::silhouette`] instead of well-wound closed meshes alone.

use super::batch::{Batch, MOST_COUNTED};
use super::walls::borders::Borders;
use super::walls::{Maker, Sought};
use super::{DrawnMask, GpuSurface, Scene, ShadowError, Silhouettes, Technique};
use crate::gpu::targets::{COUNTED, SHARE, Stages, whole};
use crate::gpu::{Gpu, shaders};
use crate::mesh::Mesh;
use crate::view::{Camera, Surface, View};
use glam::DVec3;
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
    /// Each vertex twice: where it is, and where its wall ends.
    vertices: Buffer,
    maker: Maker,
    judged: TextureView,
    mask: Texture,
    pipelines: Pipelines,
    forced_z_fail: Option<bool>,
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
    pub fn new(
        gpu: Arc<Gpu>,
        scene: Scene,
        view: View,
        silhouettes: impl Into<Silhouettes>,
    ) -> Result<Stencil, ShadowError> {
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
        let maker = Maker::new(&gpu, silhouettes.into());
        let pipelines = Pipelines::new(&gpu, &surface, &maker);
        let casters_are_seen = holds_all(&scene);
        let casters = Batch::of(&scene.casters);
        gpu.check()?;
        Ok(Stencil {
            scene,
            view,
            surface,
            casters,
            casters_are_seen,
            vertices,
            maker,
            judged,
            mask,
            pipelines,
            forced_z_fail: None,
        })
    }

    /// Counts camera views by z-fail (`true`) or z-pass (`false`), right or wrong: z-fail always is right, and z-pass must be
    /// seen to fail where it is not chosen.
    pub fn force_z_fail(&mut self, z_fail: bool) {
        self.forced_z_fail = Some(z_fail);
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
            View::Camera(camera) => self.forced_z_fail.unwrap_or_else(|| needs_z_fail(camera, to_sun, &self.scene)),
        };
        self.surface.set_sun(to_sun);
        let gpu = &self.surface.gpu;
        let counting = match self.view {
            View::Plan(_) => &self.pipelines.plan,
            View::Camera(_) if z_fail => &self.pipelines.z_fail,
            View::Camera(_) => &self.pipelines.z_pass,
        };
        let sought = Sought {
            local_light: self.scene.casters.local_light(to_sun.extend(0.0)),
            to_infinity: z_fail,
            with_cap: z_fail || !self.casters_are_seen,
            halved: false,
            borders: Some(Borders {
                clip_from_local: self.surface.clip_from_local,
                lowest_z: (!z_fail).then_some(self.surface.lowest_z),
                to_sun,
            }),
        };

        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut found = Vec::new();
        for batch in &mut self.casters {
            batch.find(&self.maker, sought, &mut encoder, &mut found)?;
        }
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
        pass.set_pipeline(&self.pipelines.facing);
        pass.draw(0..3, 0..1);
        let cover = |pass: &mut RenderPass<'_>| {
            pass.set_pipeline(&self.pipelines.covered);
            pass.draw(0..3, 0..1);
        };
        let mut counted = 0;
        for (walls, most) in found {
            if counted + most > MOST_COUNTED {
                cover(&mut pass);
                counted = 0;
            }
            counted += most;
            pass.set_pipeline(&counting.wall);
            walls.draw_walls(&mut pass);
            if sought.with_cap {
                pass.set_pipeline(&counting.cap);
                walls.draw_cap(&mut pass);
            }
        }
        cover(&mut pass);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(DrawnMask::Texture(gpu, &self.mask))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.surface.read()
    }
}

/// Whether z-pass may be wrong for a camera: the near plane may cut a volume, or the near rectangle is not wholly above the
/// ground, so that a ray may come from below the walls' lower end or go there.
fn needs_z_fail(camera: &Camera, to_sun: DVec3, scene: &Scene) -> bool {
    near_rectangle(camera).iter().any(|corner| corner.z < scene.ground)
        || near_clip_volume_touched(camera, to_sun, &scene.casters)
}

/// The corners of what a camera sees of its near plane, in the world frame.
fn near_rectangle(camera: &Camera) -> [DVec3; 4] {
    let [right, up, forward] = camera.axes();
    let half = camera.half_size();
    let corner = |x: f64, y: f64| camera.eye + (forward + right * half.x * x + up * half.y * y) * Camera::NEAR_M;
    [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
}

/// Whether a caster may reach into the near-clip volume, the near rectangle swept towards the sun. Boxes around
/// components stand for them, so the answer may be yes too often, never no.
pub fn near_clip_volume_touched(camera: &Camera, to_sun: DVec3, casters: &Mesh) -> bool {
    let forward = camera.axes()[2];
    let middle = camera.eye + forward * Camera::NEAR_M;
    let rectangle = near_rectangle(camera);
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
    fn new(gpu: &Gpu, surface: &GpuSurface, maker: &Maker) -> Pipelines {
        let module = gpu.shader("stencil", shaders::STENCIL);
        let layout = surface.seeing_layout(None);
        let corner = VertexBufferLayout {
            array_stride: size_of::<[f32; 4]>() as u64,
            step_mode: VertexStepMode::Vertex,
            attributes: &vertex_attr_array![0 => Float32x4],
        };
        let buffers = [Some(corner)];
        let pipeline = |label: &str, vertex: &str, fragment: &str, writes, depth_stencil| {
            let buffers: &[_] = if vertex == "whole_picture" { &[] } else { &buffers };
            let target = Some((SHARE, writes));
            let stages = Stages { module: &module, vertex, fragment, buffers, target, layout: Some(&layout) };
            gpu.pipeline(label, stages, Some(depth_stencil))
        };
        let wall_pipeline = |label: &str, end: &str, fragment: &str, depth_stencil| match maker.in_vertex_shader() {
            None => pipeline(label, &format!("wall_to_{end}"), fragment, ColorWrites::empty(), depth_stencil),
            Some((module, edges_layout)) => {
                let vertex = &format!("quadrilateral_to_{end}");
                let target = Some((SHARE, ColorWrites::empty()));
                let layout = surface.seeing_layout(Some(edges_layout));
                let stages = Stages { module, vertex, fragment, buffers: &[], target, layout: Some(&layout) };
                gpu.pipeline(label, stages, Some(depth_stencil))
            }
        };
        let whole_picture = |compare, pass_op| {
            let face = StencilFaceState { compare, pass_op, ..StencilFaceState::default() };
            state(CompareFunction::Always, face, face)
        };
        let [pass_front, pass_back] = [StencilOperation::IncrementWrap, StencilOperation::DecrementWrap]
            .map(|pass_op| StencilFaceState { pass_op, ..StencilFaceState::default() });
        let [fail_front, fail_back] = [StencilOperation::DecrementWrap, StencilOperation::IncrementWrap]
            .map(|depth_fail_op| StencilFaceState { depth_fail_op, ..StencilFaceState::default() });
        let counting = |name: &str, end, [wall_counted, cap, cap_counted]: [&str; 3], front, back| {
            // strictly nearer than what is judged
            let state = || state(CompareFunction::Greater, front, back);
            Counting {
                wall: wall_pipeline(&format!("stencil.{name}.wall"), end, wall_counted, state()),
                cap: pipeline(&format!("stencil.{name}.cap"), cap, cap_counted, ColorWrites::empty(), state()),
            }
        };
        let in_plan = ["counted_in_plan", "cap_in_plan", "cap_counted_in_plan"];
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
            plan: counting("plan", "lowest", in_plan, pass_front, pass_back),
            z_pass: counting("z_pass", "lowest", ["counted", "cap", "counted"], pass_front, pass_back),
            z_fail: counting("z_fail", "infinity", ["counted", "cap", "counted"], fail_front, fail_back),
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
