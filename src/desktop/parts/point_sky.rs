//! The picture of a clicked point's sky.

use crate::export::figure::Screen;
use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, Ui, vec2};

/// The picture, and where egui has it.
pub(in crate::desktop) struct PointSky {
    screen: Screen,
    /// Of the context in which it was last shown.
    texture: Option<TextureHandle>,
}

impl PointSky {
    pub(in crate::desktop) fn new(screen: Screen) -> PointSky {
        PointSky { screen, texture: None }
    }

    /// Forgets where egui has it, because another context takes over.
    pub(in crate::desktop) fn forget_texture(&mut self) {
        self.texture = None;
    }

    /// As wide as there is room for, at most half its pixels.
    pub(in crate::desktop) fn show(&mut self, ui: &mut Ui) {
        let Screen { width, height, pixels } = &self.screen;
        let texture = self.texture.get_or_insert_with(|| {
            let image = ColorImage::from_rgb([*width as usize, *height as usize], bytemuck::cast_slice(pixels));
            ui.ctx().load_texture("sky of the point", image, TextureOptions::LINEAR)
        });
        let side = ui.available_width().min(*width as f32 / 2.0);
        let sized =
            egui::load::SizedTexture::new(texture.id(), vec2(side, side * *height as f32 / (*width).max(1) as f32));
        let shown = ui.add(egui::Image::new(sized).alt_text("The sky of the point"));
        shown.on_hover_text(
            "The sky above the point, as on a plan: north up, zenith in the middle. What stands before it, the sun's ways on \
             the 21st of each month, the hours of the clock, and yellow where this day's sun is seen",
        );
    }
}
