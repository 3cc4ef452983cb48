//! Draws the picture and the panels' background into the window's frame, with two shaders that do nothing else.
//!
//! egui has one fragment shader for everything, including text. On a software adapter it takes ten times as long for a
//! picture as sampling the picture does, in every frame.

use crate::gpu::shaders;
use eframe::egui::{Color32, PaintCallback, PaintCallbackInfo, Rect};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use wgpu::*;

/// The pipelines, one set per window, stored where egui's renderer finds them.
struct ScreenPipelines {
    shows: RenderPipeline,
    fills: RenderPipeline,
    colour: Buffer,
    filled: BindGroup,
    sampler: Sampler,
}

/// Prepares the window's renderer.
pub(in crate::desktop) fn set_up(render: &RenderState) {
    let device = &render.device;
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: Some("screen"),
        source: ShaderSource::Wgsl(shaders::SCREEN.into()),
    });
    let linear = render.target_format.is_srgb();
    let pipeline = |label, fragment| {
        device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(label),
            layout: None,
            vertex: VertexState {
                module: &module,
                entry_point: Some("whole_viewport"),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: None,
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(render.target_format.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    let shows = pipeline("screen.picture", if linear { "show_linear" } else { "show" });
    let fills = pipeline("screen.ground", if linear { "fill_linear" } else { "fill" });
    let colour = device.create_buffer(&BufferDescriptor {
        label: Some("screen.colour"),
        size: size_of::<[f32; 4]>() as u64,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let filled = device.create_bind_group(&BindGroupDescriptor {
        label: Some("screen.ground"),
        layout: &fills.get_bind_group_layout(0),
        entries: &[BindGroupEntry { binding: 0, resource: colour.as_entire_binding() }],
    });
    let sampler = device.create_sampler(&SamplerDescriptor {
        label: Some("screen"),
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    });
    let screen = ScreenPipelines { shows, fills, colour, filled, sampler };
    render.renderer.write().callback_resources.insert(screen);
}

/// A picture that frames can show.
#[derive(Clone)]
pub(in crate::desktop) struct Print(BindGroup);

impl Print {
    /// Makes a print of a texture, which may be redrawn at any time.
    pub(in crate::desktop) fn of(texture: &Texture, render: &RenderState) -> Option<Print> {
        let renderer = render.renderer.read();
        let screen: &ScreenPipelines = renderer.callback_resources.get()?;
        let view = texture.create_view(&TextureViewDescriptor::default());
        let entries = [
            BindGroupEntry { binding: 1, resource: BindingResource::TextureView(&view) },
            BindGroupEntry { binding: 2, resource: BindingResource::Sampler(&screen.sampler) },
        ];
        Some(Print(render.device.create_bind_group(&BindGroupDescriptor {
            label: Some("screen.picture"),
            layout: &screen.shows.get_bind_group_layout(0),
            entries: &entries,
        })))
    }

    /// Shows it in a rectangle, scaled to it.
    pub(in crate::desktop) fn shown_in(&self, rect: Rect) -> PaintCallback {
        Callback::new_paint_callback(rect, self.clone())
    }
}

impl CallbackTrait for Print {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut RenderPass<'static>, resources: &CallbackResources) {
        if let Some(screen) = resources.get::<ScreenPipelines>() {
            pass.set_pipeline(&screen.shows);
            pass.set_bind_group(0, &self.0, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// The background colour of a frame's panels.
struct PanelColour(Color32);

/// Fills a rectangle as the first thing in the frame, with one colour per frame.
pub(in crate::desktop) fn ground(rect: Rect, colour: Color32) -> PaintCallback {
    Callback::new_paint_callback(rect, PanelColour(colour))
}

impl CallbackTrait for PanelColour {
    fn prepare(
        &self,
        _: &Device,
        queue: &Queue,
        _: &ScreenDescriptor,
        _: &mut CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<CommandBuffer> {
        if let Some(screen) = resources.get::<ScreenPipelines>() {
            let colour = self.0.to_normalized_gamma_f32();
            queue.write_buffer(&screen.colour, 0, bytemuck::bytes_of(&colour));
        }
        Vec::new()
    }

    fn paint(&self, _: PaintCallbackInfo, pass: &mut RenderPass<'static>, resources: &CallbackResources) {
        if let Some(screen) = resources.get::<ScreenPipelines>() {
            pass.set_pipeline(&screen.fills);
            pass.set_bind_group(0, &screen.filled, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}
