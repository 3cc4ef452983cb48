//! The picture of a view: sun and shadow in the colours of drawings, drawn by the GPU into a texture. Nothing is read
//! back, so that a window can show it in every frame.
//!
//! [`crate::export`] draws sheets on the processor, cell by cell; a test compares the two.

pub mod overlay;
mod patch_textures;
mod texels;

pub use patch_textures::PatchColours;
pub use texels::COLOURS;

use crate::gpu::layout::{self, PictureUniforms};
use crate::gpu::targets::{SHARE, Stages, whole};
use crate::gpu::{Gpu, shaders};
use crate::look::{LOOK, Look};
use crate::shadow::bindings::{PLANES_WIDTH, UNIFORM, bind_group_layout, texture_binding};
use crate::shadow::{DrawnMask, GpuSurface, Scene, ShadowError};
use crate::view::{Mask, View};
use glam::DVec3;
use patch_textures::textures;
use std::ops::Range;
use std::sync::Arc;
use texels::write;
use wgpu::*;

/// The hours of shadow of a profile, to show on the scene.
#[derive(Clone, Copy, Debug)]
pub struct HoursRaster<'a> {
    /// West and north edge, metres of the world frame.
    pub corner: [f64; 2],
    /// Side of a cell, metres.
    pub cell: f64,
    /// Columns and rows.
    pub size: (u32, u32),
    /// The colour of each cell, row 0 north.
    pub colours: &'a [[u8; 3]],
    /// The height of the surface on which each cell was counted, metres of the world frame.
    pub height_m: &'a [f32],
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// The distance from the eye to what it looks at, metres; things far behind that are hazy.
    pub focus_m: f64,
    /// The strength of the lines, 0 to 1.
    pub lines: f32,
    /// Whether lines are twice as wide, because the picture is shown at half its size.
    pub wide_lines: bool,
    /// Whether components have their own colours, as [`Picture::tint`] sets them.
    pub tinted: bool,
    /// Whether hours are shown instead of sun and shadow, as set by [`Picture::lay_hours`] or [`Picture::lay_patches`].
    pub hours: bool,
}

/// The picture of one scene in one view.
pub struct Picture {
    surface: GpuSurface,
    pipeline: RenderPipeline,
    group: BindGroupLayout,
    uniform: Buffer,
    look: Buffer,
    origin: DVec3,
    uploaded: Option<Texture>,
    hours: Option<HoursTextures>,
    tints: Option<Texture>,
    /// The receivers' faces that are terrain.
    terrain: Vec<Range<u32>>,
    overlay: [Option<Texture>; 2],
    cells: Option<Texture>,
    /// Bound to unused slots: a colour texture and a number texture.
    nothing: [Texture; 2],
}

/// What is shown on the scene.
enum HoursTextures {
    /// The plan's cells (corner and cell): their colours and heights.
    Plan([f32; 3], [Texture; 2]),
    /// Flat patches.
    Patches([Texture; 3]),
}

impl Picture {
    /// Draws what is seen, and builds the pipeline.
    ///
    /// # Errors
    /// [`ShadowError`], where the view does not fit the adapter.
    pub fn new(gpu: Arc<Gpu>, scene: &Scene, view: View) -> Result<Picture, ShadowError> {
        let mut surface = GpuSurface::draw(Arc::clone(&gpu), scene, view)?;
        surface.show_flush()?;
        let plain = texture_binding(TextureSampleType::Float { filterable: false });
        let numbers = texture_binding(TextureSampleType::Uint);
        let pages = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: false },
            view_dimension: TextureViewDimension::D2Array,
            multisampled: false,
        };
        let plains = [plain; 7];
        let types: Vec<_> = [UNIFORM].into_iter().chain(plains).chain([numbers, plain, pages, UNIFORM]).collect();
        let group = bind_group_layout(&gpu, "picture", &types);
        let stages = Stages {
            module: &gpu.shader("picture", shaders::PICTURE),
            vertex: "whole_picture",
            fragment: "picture",
            buffers: &[],
            target: Some((COLOURS, ColorWrites::ALL)),
            layout: Some(&surface.seeing_layout(&[&group])),
        };
        let pipeline = gpu.pipeline("picture", stages, None);
        let nothing = [COLOURS, TextureFormat::R32Uint]
            .map(|format| gpu.texture("picture.nothing", (1, 1), format, TextureUsages::TEXTURE_BINDING));
        let look = gpu.uniform::<layout::LookUniforms>("picture.look");
        gpu.queue.write_buffer(&look, 0, bytemuck::bytes_of(&uniform(&LOOK)));
        gpu.check()?;
        let terrain = scene.receivers.components.iter().filter(|component| component.is_terrain);
        Ok(Picture {
            surface,
            look,
            pipeline,
            group,
            uniform: gpu.uniform::<PictureUniforms>("picture.shown"),
            origin: scene.receivers.origin,
            uploaded: None,
            hours: None,
            tints: None,
            terrain: terrain.map(|component| component.faces.clone()).collect(),
            overlay: [None, None],
            cells: None,
            nothing,
        })
    }

    /// Turns to another view of the same scene. If the face that each cell sees is known, nothing is drawn for it.
    ///
    /// # Errors
    /// As [`Picture::new`].
    pub fn look_at(&mut self, scene: &Scene, view: View, faces: Option<&[u32]>) -> Result<(), ShadowError> {
        match faces {
            Some(faces) => self.surface.see(scene, view, faces),
            None => {
                self.surface.look_at(scene, view)?;
                self.surface.show_flush()
            }
        }
    }

    /// A texture as large as a view, for [`Picture::draw`].
    pub fn target(gpu: &Gpu, view: &View) -> Texture {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        gpu.texture("picture", view.size(), COLOURS, usage)
    }

    /// Sets the colour of each face of the receivers, and which of them are terrain.
    pub fn tint(&mut self, colours: impl Iterator<Item = [u8; 3]>) {
        let mut texels: Vec<[u8; 4]> = colours.map(|[red, green, blue]| [red, green, blue, 0]).collect();
        let rows = texels.len().div_ceil(PLANES_WIDTH).max(1);
        texels.resize(rows * PLANES_WIDTH, [0; 4]);
        for run in &self.terrain {
            let faces = texels.iter_mut().take(run.end as usize).skip(run.start as usize);
            faces.for_each(|texel| texel[3] = 255);
        }
        let size = (PLANES_WIDTH as u32, rows as u32);
        self.tints = Some(self.upload("picture.tints", size, COLOURS, bytemuck::cast_slice(&texels)));
    }

    /// Shows hours on the scene, or removes them.
    pub fn lay_hours(&mut self, hours: Option<HoursRaster<'_>>) {
        self.hours = hours.map(|hours| {
            let texels: Vec<[u8; 4]> = hours.colours.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
            let heights: Vec<f32> =
                hours.height_m.iter().map(|height| (f64::from(*height) - self.origin.z) as f32).collect();
            let [west, north] = hours.corner;
            let corner = [(west - self.origin.x) as f32, (north - self.origin.y) as f32, hours.cell as f32];
            let colours = self.upload("picture.hours", hours.size, COLOURS, bytemuck::cast_slice(&texels));
            let format = TextureFormat::R32Float;
            let heights = self.upload("picture.heights", hours.size, format, bytemuck::cast_slice(&heights));
            HoursTextures::Plan(corner, [colours, heights])
        });
    }

    /// Shows patches on the scene. Faces without a patch stay plain.
    ///
    /// # Errors
    /// If the adapter cannot hold them.
    pub fn lay_patches(&mut self, colours: &PatchColours<'_>) -> Result<(), ShadowError> {
        self.hours = None;
        self.hours = Some(HoursTextures::Patches(textures(&self.surface.gpu, colours, self.origin)?));
        Ok(())
    }

    /// Shows shadow volumes (layers) and silhouette (ink) over the view, in rasters of the view's size or an integer
    /// multiple of it.
    pub fn lay_overlay(&mut self, size: (u32, u32), layers: Option<&[u8]>, ink: Option<&[u8]>) {
        self.overlay = [("picture.volumes", layers), ("picture.silhouette", ink)]
            .map(|(label, values)| values.map(|values| self.upload(label, size, SHARE, values)));
    }

    /// Paints the view's cells in colours of their own.
    pub fn paint(&mut self, size: (u32, u32), colours: &[[u8; 3]]) {
        let texels: Vec<[u8; 4]> = colours.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
        self.cells = Some(self.upload("picture.cells", size, COLOURS, bytemuck::cast_slice(&texels)));
    }

    /// Removes everything that belongs to a single view.
    pub fn clear(&mut self) {
        (self.overlay, self.cells) = ([None, None], None);
    }

    /// Draws the picture into the target. If sun and shadow are shown and the sun is not above the horizon,
    /// it is night, whatever the mask.
    ///
    /// # Errors
    /// If the adapter fails.
    pub fn draw(
        &mut self,
        mask: &DrawnMask<'_>,
        to_sun: DVec3,
        style: &Style,
        target: &Texture,
    ) -> Result<(), ShadowError> {
        match mask {
            DrawnMask::Memory(mask) => self.upload_mask(mask),
            DrawnMask::Bits(bits) => self.upload_mask(&bits.mask()),
            DrawnMask::Texture(..) => {}
        }
        let share = match mask {
            DrawnMask::Memory(_) | DrawnMask::Bits(_) => self.uploaded.as_ref().unwrap_or(&self.nothing[0]),
            DrawnMask::Texture(_, texture) => *texture,
        };
        let gpu = &self.surface.gpu;
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&self.uniforms(to_sun, style)));
        self.surface.set_sun(to_sun);
        let bound = self.bind(share);
        let mut encoder = self.surface.encoder();
        self.surface.draw_mask(&mut encoder, "picture", target, |pass| {
            pass.set_bind_group(2, &bound, &[]);
            pass.set_pipeline(&self.pipeline);
            pass.draw(0..3, 0..1);
        });
        gpu.queue.submit([encoder.finish()]);
        Ok(gpu.check()?)
    }

    /// The uniforms of one picture.
    fn uniforms(&self, to_sun: DVec3, style: &Style) -> PictureUniforms {
        let is = |there: bool| f32::from(u8::from(there));
        let ([west, north, cell], over) = match &self.hours {
            None => ([0.0, 0.0, 1.0], 0.0),
            Some(HoursTextures::Plan(corner, _)) => (*corner, 1.0),
            Some(HoursTextures::Patches(_)) => ([0.0, 0.0, 1.0], 2.0),
        };
        let hours = if style.hours { over } else { 0.0 };
        PictureUniforms {
            hours_corner: [west, north],
            hours_cell: cell,
            hours,
            focus: style.focus_m.max(1e-3) as f32,
            // hours belong to a day, whatever the clock says
            night: is(to_sun.z <= 0.0 && hours == 0.0),
            // lines could be mistaken for cells
            lines: if self.cells.is_some() { 0.0 } else { style.lines },
            both_sides: is(style.wide_lines),
            tinted: is(style.tinted && self.tints.is_some()),
            overlay: is(self.overlay.iter().any(Option::is_some)),
            painted: is(self.cells.is_some()),
            unused: 0.0,
        }
    }

    /// Binds the mask, and everything that is shown over the scene.
    fn bind(&self, share: &Texture) -> BindGroup {
        let (plan, patches) = match &self.hours {
            None => (None, None),
            Some(HoursTextures::Plan(_, textures)) => (Some(textures), None),
            Some(HoursTextures::Patches(textures)) => (None, Some(textures)),
        };
        let hours = |at: usize| plan.map(|textures| &textures[at]);
        let [volumes, silhouette] = &self.overlay;
        let further =
            [hours(0), hours(1), self.tints.as_ref(), volumes.as_ref(), silhouette.as_ref(), self.cells.as_ref()];
        let views: Vec<TextureView> = std::iter::once(Some(share))
            .chain(further)
            .map(|texture| whole(texture.unwrap_or(&self.nothing[0])))
            .chain(self.patch_views(patches))
            .collect();
        let textures = views.iter().enumerate().map(|(at, view)| (at as u32 + 1, BindingResource::TextureView(view)));
        let look = (views.len() as u32 + 1, self.look.as_entire_binding());
        let entries: Vec<_> =
            std::iter::once((0, self.uniform.as_entire_binding())).chain(textures).chain([look]).collect();
        self.surface.gpu.bind("picture", &self.group, &entries)
    }

    fn patch_views(&self, patches: Option<&[Texture; 3]>) -> [TextureView; 3] {
        let [colours, numbers] = &self.nothing;
        let [patch_of, frames, atlas] = patches.map_or([numbers, colours, colours], |textures| textures.each_ref());
        let layers = TextureViewDescriptor { dimension: Some(TextureViewDimension::D2Array), ..Default::default() };
        [whole(patch_of), whole(frames), atlas.create_view(&layers)]
    }

    fn upload_mask(&mut self, mask: &Mask) {
        let size = (mask.width, mask.height);
        let fits = |texture: &Texture| (texture.width(), texture.height()) == size;
        match self.uploaded.as_ref().filter(|texture| fits(texture)) {
            Some(texture) => write(&self.surface.gpu, texture, &mask.share),
            None => self.uploaded = Some(self.upload("picture.mask", size, SHARE, &mask.share)),
        }
    }

    fn upload(&self, label: &str, size: (u32, u32), format: TextureFormat, bytes: &[u8]) -> Texture {
        let gpu = &self.surface.gpu;
        let texture = gpu.texture(label, size, format, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
        write(gpu, &texture, bytes);
        texture
    }
}

/// The look as the shader's uniform.
fn uniform(look: &Look) -> layout::LookUniforms {
    let linear = |colour: DVec3| colour.as_vec3().to_array();
    let bytes = |colour: [u8; 3]| colour.map(|value| f32::from(value) / 255.0);
    layout::LookUniforms {
        building: linear(look.building),
        cut_earth: look.cut_earth as f32,
        ground: linear(look.ground),
        sky: look.sky as f32,
        sky_light: linear(look.sky_light),
        sky_slope: look.sky_slope as f32,
        sun_light: linear(look.sun_light),
        exposure: look.exposure as f32,
        horizon: linear(look.horizon),
        least_height: look.least_height as f32,
        zenith: linear(look.zenith),
        least_sun: look.least_sun as f32,
        night: linear(look.night),
        pressed_above: look.pressed_above as f32,
        not_judged: bytes(look.not_judged),
        pressed_room: look.pressed_room as f32,
        plan_ground_sun: bytes(look.plan_ground_sun),
        sky_rise: look.sky_rise as f32,
        plan_ground_shade: bytes(look.plan_ground_shade),
        sky_most: look.sky_most as f32,
        plan_roof_sun: bytes(look.plan_roof_sun),
        haze_begins: look.haze_begins as f32,
        plan_roof_shade: bytes(look.plan_roof_shade),
        haze_length: look.haze_length as f32,
        line: bytes(look.line),
        relief: look.relief as f32,
        volume: bytes(look.volume),
        relief_of_hours: look.relief_of_hours as f32,
        silhouette: bytes(look.silhouette),
        relief_darkest: look.relief_darkest as f32,
        hours_ground: bytes(look.hours_ground),
        hours_card: look.hours_card as f32,
        hours_card_slope: linear(look.hours_card_slope),
        hours_wall: look.hours_wall as f32,
        relief_lightest: look.relief_lightest as f32,
        outline: look.outline,
        step: look.step,
        foot: look.foot,
        crease: look.crease,
        crease_cos: look.crease_cos as f32,
        plan_crease_cos: look.plan_crease_cos as f32,
        step_share: look.step_share as f32,
        side_step_pixels: look.side_step_pixels as f32,
        tinted_lines: look.tinted_lines,
        layer: look.layer as f32,
        most_layers: look.most_layers as f32,
        hours_wall_slope: look.hours_wall_slope as f32,
        hours_height_m: look.hours_height_m as f32,
        hours_least_up: look.hours_least_up as f32,
        plan_tint_shade: look.plan_tint_shade as f32,
        relief_level: look.relief_level as f32,
        plan_step_least_m: look.plan_step_least_m as f32,
        plan_step_most_m: look.plan_step_most_m as f32,
        plan_wall_up: look.plan_wall_up as f32,
    }
}
