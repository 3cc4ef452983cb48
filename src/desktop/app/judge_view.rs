//! Verdicts on the picture, and the way from a line of the table to its spot.

use crate::desktop::app::judge_card::{self, CardAction};
use crate::desktop::app::state::Open;
use crate::desktop::parts::sky;
use crate::desktop::parts::theme;
use crate::desktop::parts::verdict::{self, VerdictPaint};
use crate::desktop::parts::verdict_layer::LayerRequest;
use crate::desktop::results::judged::{JudgedResult, LineOf};
use crate::desktop::state::eye::{Eye, Stand};
use crate::desktop::state::project::Project;
use crate::view::View;
use eframe::egui::{self, Color32, Rect, Stroke, Ui};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;

/// The most rings around points.
const MOST_RINGS: usize = 500;

/// Marks a line, and moves the view to the spot that decides it.
pub(in crate::desktop) fn choose(open: &mut Open, of: LineOf) {
    let Some(judged) = open.judge.shown().cloned() else { return };
    (open.judge.table.chosen, open.judge.table.day) = (Some(of), 0);
    // one card at a time
    (open.sunlight, open.sky, open.probing) = (None, None, None);
    let Some(spot) = spot(&judged, of) else { return };
    look(&mut open.viewer.eye, &open.project, &spot);
}

/// The card of the chosen line, with room for its buttons below what scrolls.
pub(in crate::desktop) fn card(ui: &mut Ui, open: &mut Open, buttons: f32) {
    match judge_card::show(ui, open, buttons) {
        Some(CardAction::Close) => open.judge.table.chosen = None,
        Some(CardAction::Choose(line)) => choose(open, line),
        None => {}
    }
}

/// Where a line is decided.
struct DecidingSpot {
    point: DVec3,
    /// The length of what is shown around it, metres.
    size_m: f64,
    normal: Option<DVec3>,
}

/// The deciding point of a receiver, or the middle of a group's.
fn spot(judged: &JudgedResult, of: LineOf) -> Option<DecidingSpot> {
    let receivers = judged.receivers_of(of);
    let point = |at: &usize| {
        let receiver = judged.judgement().receivers.get(*at)?;
        receiver.points.first().copied().or_else(|| judged.shapes.extents.get(*at).map(|extent| extent.middle))
    };
    let points: Vec<DVec3> = receivers.iter().filter_map(point).collect();
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let apart = points.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
    let size = |at: &usize| judged.shapes.extents.get(*at).map_or(0.0, |extent| extent.size_m);
    let largest = receivers.iter().map(size).fold(0.0, f64::max);
    let normal = receivers.first().and_then(|at| judged.shapes.extents.get(*at)).and_then(|extent| extent.normal);
    middle.is_finite().then_some(DecidingSpot { point: middle, size_m: largest.max(2.0 * apart).max(1.0), normal })
}

/// Moves the eye: in the plan and the sides above or in front of the spot, in perspective to where it is seen.
fn look(eye: &mut Eye, project: &Project, spot: &DecidingSpot) {
    if let Stand::Side(side) = eye.stand
        && spot.normal.is_some_and(|normal| normal.dot(side.to_viewer()) < 0.1)
    {
        eye.stand = Stand::Perspective;
    }
    eye.look_at(spot.point, spot.size_m);
    if eye.stand != Stand::Perspective {
        return;
    }
    let flat = spot.normal.filter(|normal| normal.truncate().length() > 0.2);
    let azimuth = flat.map_or(eye.azimuth_rad(), |normal| normal.x.atan2(normal.y));
    let altitudes: &[f64] = if flat.is_some() { &[0.25, 0.5, 0.8, 1.1] } else { &[0.7, 1.0, 1.3, 1.5] };
    let turns = if flat.is_some() { [0.0, PI / 6.0, -PI / 6.0, PI / 3.0] } else { [0.0, PI / 2.0, PI, -PI / 2.0] };
    // without a wall to stand in front of, it is first seen from where one looks already
    let looking = flat.is_none().then_some(*eye);
    let turned = altitudes.iter().flat_map(|altitude| turns.map(|turn| eye.turned(azimuth + turn, *altitude)));
    let tried = looking.into_iter().chain(turned);
    // above paving, and in front of a reveal's sill
    let from = spot.point + spot.normal.map_or(DVec3::Z * 0.5, |normal| normal * 0.05);
    let free = tried.clone().find(|tried| is_free(project, from, tried.camera((1, 1)).eye));
    // where nothing is free, it is seen as it would be with nothing in the way
    if let Some(eye_of_spot) = free.or_else(|| tried.clone().next()) {
        *eye = eye_of_spot;
    }
}

/// Whether nothing of the models lies between two points.
fn is_free(project: &Project, from: DVec3, to: DVec3) -> bool {
    let (mesh, rays) = &*project.seen;
    let Some(along) = (to - from).try_normalize() else { return true };
    rays.first_hit(from - mesh.origin, along).is_none_or(|(_, hit)| hit > from.distance(to))
}

/// Draws what is judged over the picture: in the colours of its verdicts, or while it is edited in one colour.
pub(in crate::desktop) fn show(ui: &Ui, open: &mut Open, view: &View, rect: Rect) {
    let (project, number) = (&open.project, open.number);
    let desk = &mut open.judge;
    if desk.tool.is_some() {
        let sketch = &desk.sketch;
        // of a different scene until it is found again
        let numbers = (number, u64::MAX - sketch.number);
        let request = LayerRequest { project, numbers, shapes: &sketch.shapes, paint: &|_| None, marked: &[] };
        desk.layer.show(ui, view, rect, &request);
        return;
    }
    let Some(judged) = desk.shown().cloned() else { return };
    let marked = desk.table.chosen.map_or(Vec::new(), |of| judged.receivers_of(of));
    let verdict_of = |at: usize| judged.judgement().receivers.get(at).map(|of| of.ruling.verdict);
    let paint = |at: usize| verdict_of(at).map(VerdictPaint::of);
    let numbers = (number, judged.number);
    let request = LayerRequest { project, numbers, shapes: &judged.shapes, paint: &paint, marked: &marked };
    let over = desk.layer.show(ui, view, rect, &request);
    mark(ui, &judged, &marked, view, rect);
    name(ui, &judged, over);
}

/// Rings around the points that decide the chosen line.
fn mark(ui: &Ui, judged: &Arc<JudgedResult>, marked: &[usize], view: &View, rect: Rect) {
    let painter = ui.painter_at(rect);
    // rings around everything mark nothing
    for receiver in marked.iter().take(MOST_RINGS).filter_map(|at| judged.judgement().receivers.get(*at)) {
        for at in receiver.points.iter().filter_map(|point| sky::on_picture(view, rect, *point)) {
            painter.circle_stroke(at, 9.0, Stroke::new(4.0, Color32::WHITE));
            painter.circle_stroke(at, 9.0, Stroke::new(2.5, theme::ACCENT));
        }
    }
}

/// The name of what lies under the pointer, and its verdict.
fn name(ui: &Ui, judged: &JudgedResult, over: Option<usize>) {
    let line = over.and_then(|over| judged.lines.iter().find(|line| line.of == LineOf::Receiver(over)));
    let pointer = ui.input(|input| input.pointer.hover_pos());
    let (Some(line), Some(pointer)) = (line, pointer) else { return };
    // not through a card above the picture
    if ui.ctx().layer_id_at(pointer).is_some_and(|layer| layer != ui.layer_id()) {
        return;
    }
    let margin = if line.margin == "-" { String::new() } else { format!(", margin {}", line.margin) };
    let text = format!("{} {}: {}{margin}", line.name, verdict::word(line.verdict), line.value);
    sky::label(&ui.painter().clone(), pointer + egui::vec2(14.0, 18.0), egui::Align2::LEFT_TOP, &text);
}
