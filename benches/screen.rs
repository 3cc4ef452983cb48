//! Draws the real window without a screen: frames are drawn as eframe draws them and waited for. They are not read
//! back, since a window does not read its frames back either, and reading takes longer than drawing.

use eframe::egui::{self, TexturesDelta};
use eframe::egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor, WgpuConfiguration};
use egui_kittest::TestRenderer;
use gnomon::desktop;
use std::time::Duration;

/// Draws the window into a texture that stays where it is.
pub(crate) struct Screen {
    state: RenderState,
    frame: wgpu::Texture,
}

impl Screen {
    /// A screen of this size in pixels, on the window's own device.
    pub(crate) fn new(width: u32, height: u32) -> Screen {
        let config = WgpuConfiguration { wgpu_setup: desktop::setup(), ..WgpuConfiguration::default() };
        let instance = pollster::block_on(config.wgpu_setup.new_instance());
        let state = RenderState::create(
            &config,
            &instance,
            None,
            RendererOptions { dithering: false, ..RendererOptions::default() },
        );
        let state = pollster::block_on(state).expect("a graphics adapter");
        let frame = state.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("screen"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: state.target_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        Screen { state, frame }
    }
}

impl TestRenderer for Screen {
    fn setup_eframe(&self, cc: &mut eframe::CreationContext<'_>, frame: &mut eframe::Frame) {
        cc.wgpu_render_state = Some(self.state.clone());
        frame.wgpu_render_state = Some(self.state.clone());
    }

    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        let RenderState { device, queue, renderer, .. } = &self.state;
        let mut renderer = renderer.write();
        for (id, images) in delta.set.drain() {
            images.iter().for_each(|image| renderer.update_texture(device, queue, id, image));
        }
        delta.free.drain().for_each(|id| renderer.free_texture(&id));
    }

    fn render(&mut self, context: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        let RenderState { device, queue, renderer, .. } = &self.state;
        let pixels_per_point = context.pixels_per_point();
        let screen = ScreenDescriptor { pixels_per_point, size_in_pixels: [self.frame.width(), self.frame.height()] };
        let shapes = context.tessellate(output.shapes.clone(), pixels_per_point);
        let mut renderer = renderer.write();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let uploads = renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
        let view = self.frame.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("screen"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..wgpu::RenderPassDescriptor::default()
            })
            .forget_lifetime();
        renderer.render(&mut pass, &shapes, &screen);
        drop(pass);
        drop(renderer);
        let submission_index = Some(queue.submit(uploads.into_iter().chain([encoder.finish()])));
        // this frame alone: what the picture's own thread asks for meanwhile is not its matter
        let end = wgpu::PollType::Wait { submission_index, timeout: Some(Duration::from_secs(10)) };
        device.poll(end).map_err(|error| error.to_string())?;
        Ok(image::RgbaImage::new(1, 1))
    }
}
