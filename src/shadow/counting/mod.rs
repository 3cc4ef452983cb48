//! The count of shadow volumes in the stencil, for [`super::stencil`] and, behind a mask, for [`super::hybrid`].
//!
//! The method is F. Crow's, 1977, with Heidmann's z-pass and Carmack's z-fail, after *Geometry of Real Time Shadows*,
//! sections 3 to 6. Walls are extruded from the silhouette in the vertex shader; two-sided stencil operations with
//! wrap-around count them; a cell is in shadow if its count is not 0.
//!
//! - **z-pass** counts the walls in front of the visible point, so it needs no dark cap and no walls below the lowest
//!   receiver. It is right where the near plane cuts nothing of a volume: always in the plan, whose near plane lies
//!   above everything; and in a camera view where no caster reaches into the near-clip volume, which the near rectangle
//!   and the direction to the sun span (section 7), and which looks from above the ground, so that no ray meets the
//!   walls' open lower end. It needs the light cap where the view does not draw the casters themselves.
//! - **z-fail** counts behind the visible point, in all other views: with light cap, and walls to the sun's point at
//!   infinity, which needs no dark cap. Depth is reversed, so that point has depth 0 exactly and no far plane cuts it.
//! - The stencil has 8 bits, or 7 beside the mask: casters come in batches, none of which counts further (`batch.rs`).

mod bits;
mod ways;

pub(super) use bits::StencilBits;

use super::batch::{Batch, CountedWalls};
use super::near_clip::needs_z_fail;
use super::walls::borders::Borders;
use super::walls::{WallMaker, WallQuery};
use super::{GpuSurface, Scene, ShadowError, Silhouettes};
use crate::gpu::targets::{SUMMED, whole};
use crate::gpu::{Gpu, readback};
use crate::view::View;
use glam::DVec3;
use std::sync::Arc;
use ways::{CountPipelines, CountWays, covered};
use wgpu::*;

/// Counts one scene's volumes in one view.
pub(super) struct VolumeCounter {
    pub(super) scene: Scene,
    pub(super) view: View,
    pub(super) surface: GpuSurface,
    /// The depth at which cells are judged, with the stencil.
    pub(super) judged: Texture,
    judging: RenderPipeline,
    bits: StencilBits,
    casters: Vec<Batch>,
    /// Whether every caster is also visible geometry, so that z-pass needs no light cap.
    casters_are_seen: bool,
    /// Each vertex twice: at its place, and at the end of its wall.
    vertices: Buffer,
    maker: WallMaker,
    ways: CountWays,
    /// The same with fragments added up; made when first needed.
    adding: Option<CountWays>,
    covered: RenderPipeline,
    forced_z_fail: Option<bool>,
}

/// The volumes for one sun, ready to be drawn.
pub(super) struct VolumeCount<'a> {
    bits: StencilBits,
    found: Vec<CountedWalls<'a>>,
    with_cap: bool,
    surface: &'a GpuSurface,
    judged: &'a Texture,
    vertices: &'a Buffer,
    way: &'a CountPipelines,
    adding: Option<&'a CountPipelines>,
    covered: &'a RenderPipeline,
}

impl VolumeCounter {
    /// Draws what is seen, uploads the casters, and builds the pipelines.
    pub(super) fn new(
        gpu: Arc<Gpu>,
        scene: Scene,
        view: View,
        silhouettes: Silhouettes,
        bits: StencilBits,
    ) -> Result<VolumeCounter, ShadowError> {
        let surface = GpuSurface::draw(Arc::clone(&gpu), &scene, view)?;
        let judging = surface.judging();
        let judged = surface.judged(&judging);
        let twice: Vec<[f32; 4]> = scene
            .casters
            .vertices
            .iter()
            .flat_map(|vertex| [vertex.extend(1.0).to_array(), vertex.extend(0.0).to_array()])
            .collect();
        let vertices = gpu.uploaded("counting.casters", BufferUsages::VERTEX, &twice)?;
        let maker = WallMaker::new(&gpu, silhouettes);
        let ways = CountWays::counting(&surface, &maker, bits);
        let covered = covered(&surface, bits);
        let casters_are_seen = holds_all(&scene);
        let casters = Batch::of(&scene.casters);
        gpu.check()?;
        Ok(VolumeCounter {
            scene,
            view,
            surface,
            judged,
            judging,
            bits,
            casters,
            casters_are_seen,
            vertices,
            maker,
            ways,
            adding: None,
            covered,
            forced_z_fail: None,
        })
    }

    /// Turns to another view, and keeps the casters and their walls.
    pub(super) fn turn_to(&mut self, view: View) -> Result<(), ShadowError> {
        self.surface.look_at(&self.scene, view)?;
        self.judged = self.surface.judged(&self.judging);
        self.view = view;
        Ok(())
    }

    /// Counts camera views by z-fail (`true`) or z-pass (`false`), right or wrong. z-fail always is right, and a test
    /// shows z-pass failing where it is not chosen.
    #[cfg(feature = "test-hooks")]
    pub(super) fn force_z_fail(&mut self, z_fail: bool) {
        self.forced_z_fail = Some(z_fail);
    }

    /// Prepares [`VolumeCount::fragments`], which adds up fragments.
    ///
    /// # Errors
    /// If the adapter cannot blend the sums.
    pub(super) fn prepare_adding(&mut self) -> Result<(), ShadowError> {
        if self.adding.is_none() {
            self.surface.gpu.blends_float32("overdraw is summed")?;
            self.adding = Some(CountWays::adding(&self.surface, &self.maker, self.bits));
        }
        Ok(())
    }

    /// Sets the sun and finds its volumes; the adapter's commands for that go into `encoder`.
    pub(super) fn find(&mut self, to_sun: DVec3, encoder: &mut CommandEncoder) -> Result<VolumeCount<'_>, ShadowError> {
        let z_fail = match &self.view {
            View::Plan(_) | View::Elevation(_) => false,
            View::Camera(camera) => self.forced_z_fail.unwrap_or_else(|| needs_z_fail(camera, to_sun, &self.scene)),
        };
        self.surface.set_sun(to_sun);
        let sought = WallQuery {
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
        let mut found = Vec::new();
        for batch in &mut self.casters {
            batch.find(&self.maker, sought, self.bits.most(), encoder, &mut found)?;
        }
        Ok(VolumeCount {
            bits: self.bits,
            found,
            with_cap: sought.with_cap,
            surface: &self.surface,
            judged: &self.judged,
            vertices: &self.vertices,
            way: self.ways.of(&self.view, z_fail),
            adding: self.adding.as_ref().map(|ways| ways.of(&self.view, z_fail)),
            covered: &self.covered,
        })
    }
}

/// Whether every component that casts also receives.
fn holds_all(scene: &Scene) -> bool {
    let received: rustc_hash::FxHashSet<[u32; 3]> = scene.receivers.faces.iter().copied().collect();
    scene.casters.faces.iter().all(|face| received.contains(face))
}

impl VolumeCount<'_> {
    /// A pass over the view's cells that clears the target to `first`, and the stencil as `stencil` says; without it
    /// the stencil of an earlier pass is kept.
    pub(super) fn pass<'e>(
        &self,
        encoder: &'e mut CommandEncoder,
        label: &str,
        target: &TextureView,
        first: Color,
        stencil: Option<Operations<u32>>,
    ) -> RenderPass<'e> {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(first), store: StoreOp::Store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &whole(self.judged),
                depth_ops: None,
                stencil_ops: stencil,
            }),
            timestamp_writes: self.surface.gpu.timed(label),
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.surface.frame, &[]);
        pass.set_bind_group(1, &self.surface.seen, &[]);
        pass
    }

    /// Counts, and writes 0 into the target wherever the count is not 0.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_stencil_reference(self.bits.reference());
        let cover = |pass: &mut RenderPass<'_>| {
            pass.set_pipeline(self.covered);
            pass.draw(0..3, 0..1);
        };
        let mut counted = 0;
        for (walls, most) in &self.found {
            if counted + most > self.bits.most() {
                cover(pass);
                counted = 0;
            }
            counted += most;
            pass.set_pipeline(&self.way.wall);
            walls.draw_walls(pass);
            if self.with_cap {
                pass.set_pipeline(&self.way.cap);
                walls.draw_cap(pass);
            }
        }
        cover(pass);
    }

    /// Counts for each cell the fragments of walls and caps that reach the count, before any depth test, in the cells
    /// that `stencil` or an earlier pass of the encoder selects. For statistics: the result is read back.
    ///
    /// # Errors
    /// If the adapter fails, or cannot blend the sums.
    pub(super) fn fragments(
        &self,
        mut encoder: CommandEncoder,
        stencil: Option<Operations<u32>>,
    ) -> Result<Vec<u32>, ShadowError> {
        let gpu = &self.surface.gpu;
        let Some(way) = self.adding else { return Err(gpu.failed("overdraw was not prepared").into()) };
        let size = (self.judged.width(), self.judged.height());
        let sum = gpu.texture("adding.sum", size, SUMMED, TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC);
        let mut pass = self.pass(&mut encoder, "adding", &whole(&sum), Color::BLACK, stencil);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_stencil_reference(self.bits.reference());
        for (walls, _) in &self.found {
            pass.set_pipeline(&way.wall);
            walls.draw_walls(&mut pass);
            if self.with_cap {
                pass.set_pipeline(&way.cap);
                walls.draw_cap(&mut pass);
            }
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        let sum: Vec<f32> = readback::texels(gpu, &sum, TextureAspect::All)?;
        Ok(sum.into_iter().map(|fragments| fragments as u32).collect())
    }
}
