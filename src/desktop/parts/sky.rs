//! Overlays of the picture: the sun's path, the north arrow, the scale bar. egui draws the lines and the text,
//! positioned by the picture's view.

use crate::desktop::parts::theme::{self, SUN};
use crate::desktop::state::clock::Clock;
use crate::desktop::state::pick::Dome;
use crate::desktop::state::unit::Unit;
use crate::look::LOOK;
use crate::sun::Instant;
use crate::view::{Camera, View};
use eframe::egui::{self, Align2, Color32, FontId, Pos2, Rect, Sense, Shape, Stroke, Vec2, pos2, vec2};
use glam::DVec3;

/// The ink for the picture, which is bright in both themes.
pub(in crate::desktop) const INK: Color32 = Color32::from_rgb(LOOK.ink[0], LOOK.ink[1], LOOK.ink[2]);
const PATH: Color32 = Color32::from_rgb(196, 116, 30);

/// The position of a point of the world in the picture; `None` behind the eye.
pub(in crate::desktop) fn on_picture(view: &View, rect: Rect, point: DVec3) -> Option<Pos2> {
    let (x, y) = match view {
        View::Plan(grid) => {
            let (east, south) = (point.x - grid.west, grid.north - point.y);
            (east / (grid.east() - grid.west), south / (grid.north - grid.south()))
        }
        View::Camera(camera) => {
            let clip = camera.clip_from_world() * point.extend(1.0);
            if clip.w <= Camera::NEAR_M {
                return None;
            }
            (clip.x / clip.w * 0.5 + 0.5, 0.5 - clip.y / clip.w * 0.5)
        }
        View::Elevation(side) => {
            let ([right, up, _], half, from) = (side.axes(), side.half_size(), point - side.target);
            (from.dot(right) / half.x * 0.5 + 0.5, 0.5 - from.dot(up) / half.y * 0.5)
        }
    };
    Some(rect.min + vec2(x as f32 * rect.width(), y as f32 * rect.height()))
}

/// Draws the paths of the day and of the solstices, the hours, and the sun. Returns the second of the day to which the
/// sun was dragged along its path.
pub(in crate::desktop) fn path(ui: &egui::Ui, view: &View, rect: Rect, dome: &Dome, clock: &Clock) -> Option<f64> {
    let painter = ui.painter_at(rect);
    let place = |to_sun: DVec3| on_picture(view, rect, dome.at(to_sun));
    let line = |instants: &[Instant], stroke: Stroke| {
        let mut run: Vec<Pos2> = Vec::new();
        let mut runs = Vec::new();
        for instant in instants {
            match place(instant.to_sun).filter(|_| instant.to_sun.z >= 0.0) {
                Some(at) => run.push(at),
                None if run.len() > 1 => runs.push(std::mem::take(&mut run)),
                None => run.clear(),
            }
        }
        runs.push(run);
        for run in runs.into_iter().filter(|run| run.len() > 1) {
            painter.add(Shape::line(run, stroke));
        }
    };
    for solstice in &clock.solstices {
        line(solstice, Stroke::new(1.0, PATH.gamma_multiply(0.55)));
    }
    line(&clock.day, Stroke::new(2.0, PATH));
    for (hour, instant) in &clock.hours {
        if instant.to_sun.z < 0.0 {
            continue;
        }
        if let Some(at) = place(instant.to_sun) {
            painter.circle_filled(at, 2.5, PATH);
            if hour % 3 == 0 {
                label(&painter, at + vec2(0.0, -11.0), Align2::CENTER_CENTER, &format!("{hour}"));
            }
        }
    }
    let now = &clock.now;
    if now.to_sun.z < 0.0 {
        return None;
    }
    let at = place(now.to_sun).filter(|at| rect.contains(*at))?;
    let id = ui.scope_id().with("sun");
    let response = ui.interact(Rect::from_center_size(at, Vec2::splat(30.0)), id, Sense::drag());
    let radius = if response.hovered() || response.dragged() { 11.0 } else { 9.0 };
    painter.circle(at, radius, SUN, Stroke::new(1.5, PATH));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "The sun: drag it along its day"));
    let response = response.on_hover_cursor(egui::CursorIcon::Grab);
    let pointer = response.dragged().then(|| response.interact_pointer_pos())??;
    let by_day = clock.day.iter().enumerate().filter(|(_, instant)| instant.to_sun.z >= 0.0);
    let nearest = by_day.filter_map(|(index, instant)| Some((index, place(instant.to_sun)?.distance_sq(pointer))));
    let (index, _) = nearest.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(clock.day[index].time.signed_duration_since(clock.midnight).num_seconds() as f64)
}

/// The arrow that points north at the picture's middle.
pub(in crate::desktop) fn north(ui: &egui::Ui, view: &View, rect: Rect) {
    let north = match view {
        View::Plan(_) => vec2(0.0, -1.0),
        View::Elevation(_) | View::Camera(_) => {
            let [right, up, forward] = match view {
                View::Camera(camera) => camera.axes(),
                View::Elevation(side) => side.axes(),
                View::Plan(_) => [DVec3::X, DVec3::Y, DVec3::NEG_Z],
            };
            // in plan, whether seen from above or from the side
            let flat = DVec3::new(forward.x, forward.y, 0.0).normalize_or(up);
            vec2(right.y as f32, -(flat.y as f32))
        }
    };
    let north = north.normalized();
    let middle = rect.right_top() + vec2(-46.0, 46.0);
    let painter = ui.painter_at(rect);
    named(ui, Rect::from_center_size(middle, Vec2::splat(44.0)), "North arrow".to_owned());
    painter.circle(middle, 22.0, Color32::from_white_alpha(170), Stroke::new(1.0, INK.gamma_multiply(0.5)));
    let side = vec2(-north.y, north.x);
    let tip = middle + north * 13.0;
    let tail = middle - north * 10.0;
    let arrow = |side: Vec2| vec![tip, tail + side * 6.5, middle - north * 5.0];
    painter.add(Shape::convex_polygon(arrow(side), INK, Stroke::NONE));
    painter.add(Shape::convex_polygon(arrow(-side), Color32::WHITE, Stroke::new(1.0, INK)));
    painter.text(middle + north * 30.0, Align2::CENTER_CENTER, "N", theme::bold(13.0), INK);
}

/// A bar of a round length, true to scale at the picture's middle.
pub(in crate::desktop) fn scale_bar(ui: &egui::Ui, rect: Rect, metres_a_point: f64, feet: bool) {
    let unit = Unit::of(feet);
    let most = 150.0 * metres_a_point / unit.metres;
    let power = 10f64.powf(most.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().map(|step| step * power).find(|length| *length <= most).unwrap_or(power);
    let width = (round * unit.metres / metres_a_point) as f32;
    let right = rect.right_bottom() + vec2(-18.0, -18.0);
    let left = right - vec2(width, 0.0);
    let painter = ui.painter_at(rect);
    let stroke = Stroke::new(2.0, INK);
    painter.line_segment([left, right], stroke);
    for end in [left, right] {
        painter.line_segment([end - vec2(0.0, 5.0), end + vec2(0.0, 1.0)], stroke);
    }
    let text =
        if !feet && round >= 1000.0 { format!("{} km", round / 1000.0) } else { format!("{round} {}", unit.name) };
    named(ui, Rect::from_min_max(left - vec2(0.0, 5.0), right + vec2(0.0, 1.0)), format!("Scale bar: {text}"));
    label(&painter, pos2((left.x + right.x) / 2.0, right.y - 12.0), Align2::CENTER_CENTER, &text);
}

/// Gives an accessible name to something that is only painted.
fn named(ui: &egui::Ui, rect: Rect, name: String) {
    let id = ui.scope_id().with(name.split(':').next().unwrap_or_default());
    let response = ui.interact(rect, id, Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name.clone()));
}

/// Text with a light outline, legible on anything.
pub(in crate::desktop) fn label(painter: &egui::Painter, at: Pos2, align: Align2, text: &str) {
    let font = FontId::proportional(12.0);
    for rim in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
        painter.text(at + rim, align, text, font.clone(), Color32::from_white_alpha(190));
    }
    painter.text(at, align, text, font, INK);
}
