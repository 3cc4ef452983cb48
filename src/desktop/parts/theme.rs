//! The look of the window: one accent colour, quiet panels, the fonts of the drawings.

use crate::export::figure;
use crate::look::LOOK;
use eframe::egui::epaint::Shadow;
use eframe::egui::epaint::text::{FallbackRequest, FontInsert};
use eframe::egui::style::{HandleShape, Selection, WidgetVisuals, Widgets};
use eframe::egui::{
    self, Color32, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Stroke, TextStyle, Theme,
};
use std::sync::Arc;

/// The red-brown of the drawings.
pub(in crate::desktop) const ACCENT: Color32 = Color32::from_rgb(190, 82, 44);
/// The same colour on dark panels.
const ACCENT_ON_DARK: Color32 = Color32::from_rgb(228, 128, 84);
/// The colour of the sun.
pub(in crate::desktop) const SUN: Color32 = Color32::from_rgb(244, 178, 62);

/// The bold font.
pub(in crate::desktop) fn bold(size: f32) -> FontId {
    FontId::new(size, FontFamily::Name("bold".into()))
}

/// A dialog with a margin around its text.
pub(in crate::desktop) fn modal(context: &egui::Context, name: &str) -> egui::Modal {
    let frame = egui::Frame::popup(&context.global_style()).inner_margin(16.0);
    egui::Modal::new(egui::Id::unique(name)).frame(frame)
}

/// The width of a line of plain text, points.
pub(in crate::desktop) fn width_of(ui: &egui::Ui, text: &str) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

/// The accent colour of a theme.
pub(in crate::desktop) fn accent(visuals: &egui::Visuals) -> Color32 {
    if visuals.dark_mode { ACCENT_ON_DARK } else { ACCENT }
}

/// A font of the system for letters that the drawings' font lacks. Letters that none has are drawn as boxes.
fn system_font(request: &FallbackRequest<'_>) -> Option<FontInsert> {
    let (font, index) = figure::face_with(request.cluster.chars().next()?)?;
    let name = format!("system font for {}", request.cluster);
    Some(FontInsert::new(&name, FontData { index, ..FontData::from_owned(font) }, Vec::new()))
}

/// Sets fonts, spaces and colours of both themes.
pub(in crate::desktop) fn set(context: &egui::Context) {
    let mut fonts = FontDefinitions::empty();
    for (name, bytes, families) in [
        ("regular", notosans::REGULAR_TTF, [FontFamily::Proportional, FontFamily::Monospace].as_slice()),
        ("bold", notosans::BOLD_TTF, [FontFamily::Name("bold".into())].as_slice()),
    ] {
        fonts.font_data.insert(name.to_owned(), Arc::new(FontData::from_static(bytes)));
        for family in families {
            fonts.families.entry(family.clone()).or_default().push(name.to_owned());
        }
    }
    context.set_fonts(fonts);
    // names of components and of rules may be in any script
    context.add_font_provider(Arc::new(system_font));
    context.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Small, FontId::proportional(11.5)),
            (TextStyle::Body, FontId::proportional(13.5)),
            (TextStyle::Button, FontId::proportional(13.5)),
            (TextStyle::Monospace, FontId::proportional(13.5)),
            (TextStyle::Heading, bold(16.0)),
        ]
        .into();
        let spacing = &mut style.spacing;
        spacing.item_spacing = egui::vec2(8.0, 6.0);
        spacing.button_padding = egui::vec2(10.0, 4.0);
        spacing.interact_size.y = 24.0;
        spacing.menu_margin = egui::Margin::same(6);
        spacing.combo_width = 150.0;
        // beside the scrolled area, and not over it; visible if there is more to see
        spacing.scroll.floating_allocated_width = 8.0;
        (spacing.scroll.floating_width, spacing.scroll.dormant_handle_opacity) = (4.0, 0.35);
        // lists are fully visible
        spacing.combo_height = 400.0;
        style.animation_time = 0.08;
    });
    // if the system has no preference
    context.options_mut(|options| options.fallback_theme = Theme::Light);
    context.set_visuals_of(Theme::Light, visuals(false));
    context.set_visuals_of(Theme::Dark, visuals(true));
}

fn visuals(dark: bool) -> egui::Visuals {
    let gray = Color32::from_gray;
    // paper and ink, or slate and chalk; both slightly warm
    let tone = |light: [u8; 3], dusk: [u8; 3]| {
        let [r, g, b] = if dark { dusk } else { light };
        Color32::from_rgb(r, g, b)
    };
    let accent = if dark { ACCENT_ON_DARK } else { ACCENT };
    let panel = tone([246, 244, 240], [33, 34, 37]);
    let field = tone([255, 255, 254], [24, 25, 28]);
    let raised = tone([233, 230, 224], [50, 52, 56]);
    let over = tone([223, 219, 211], [62, 64, 69]);
    let hair = tone([216, 212, 204], [60, 62, 66]);
    let ink = tone(LOOK.ink, [228, 226, 221]);
    let quiet = tone([92, 96, 104], [160, 162, 166]);
    let widget = |fill, stroke: Color32, text| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, stroke),
        corner_radius: CornerRadius::same(5),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    let base = if dark { egui::Visuals::dark() } else { egui::Visuals::light() };
    egui::Visuals {
        widgets: Widgets {
            noninteractive: widget(panel, hair, ink),
            inactive: widget(raised, Color32::TRANSPARENT, ink),
            hovered: widget(over, hair, ink),
            active: widget(over, accent, ink),
            open: widget(over, hair, ink),
        },
        selection: Selection {
            bg_fill: accent.gamma_multiply(if dark { 0.45 } else { 0.28 }),
            stroke: Stroke::new(1.0, ink),
        },
        weak_text_color: Some(quiet),
        hyperlink_color: accent,
        faint_bg_color: raised,
        extreme_bg_color: field,
        text_edit_bg_color: Some(field),
        error_fg_color: tone([176, 36, 28], [255, 138, 122]),
        warn_fg_color: accent,
        window_fill: panel,
        panel_fill: panel,
        window_stroke: Stroke::new(1.0, hair),
        window_corner_radius: CornerRadius::same(8),
        menu_corner_radius: CornerRadius::same(7),
        window_shadow: Shadow { offset: [0, 6], blur: 22, spread: 0, color: Color32::from_black_alpha(46) },
        popup_shadow: Shadow { offset: [0, 4], blur: 14, spread: 0, color: Color32::from_black_alpha(38) },
        handle_shape: HandleShape::Circle,
        slider_trailing_fill: true,
        striped: false,
        indent_has_left_vline: false,
        collapsing_header_frame: false,
        code_bg_color: gray(if dark { 40 } else { 238 }),
        ..base
    }
}
