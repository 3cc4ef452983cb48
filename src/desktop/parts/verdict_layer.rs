//! What is judged over the picture, in the colours of its verdicts. What the models hide is left out.

use crate::desktop::parts::sky;
use crate::desktop::parts::theme;
use crate::desktop::parts::verdict::VerdictPaint;
use crate::desktop::results::verdict_shapes::{ShapePiece, VerdictShapes};
use crate::desktop::state::pick::dome;
use crate::desktop::state::project::Project;
use crate::view::View;
use eframe::egui::epaint::CircleShape;
use eframe::egui::{self, Color32, Pos2, Rect, Shape, Stroke, Ui};
use glam::DVec3;
use std::time::{Duration, Instant};

/// How long rays are cast for one frame.
const A_FRAME: Duration = Duration::from_millis(8);
/// The opacity of faces.
const OPACITY: f32 = 0.62;

/// Which pieces of the shown shapes are seen. It is found again for each view, over several frames if there are many.
#[derive(Default)]
pub(in crate::desktop) struct VerdictLayer {
    of: Option<(u64, u64, View)>,
    seen: Vec<bool>,
}

/// The shapes to show.
pub(in crate::desktop) struct LayerRequest<'a> {
    pub(in crate::desktop) project: &'a Project,
    /// The number of the site, and that of the shapes.
    pub(in crate::desktop) numbers: (u64, u64),
    pub(in crate::desktop) shapes: &'a VerdictShapes,
    /// How a receiver is painted; without it, it is outlined alone.
    pub(in crate::desktop) paint: &'a dyn Fn(usize) -> Option<VerdictPaint>,
    /// The receivers that are marked.
    pub(in crate::desktop) marked: &'a [usize],
}

impl VerdictLayer {
    /// Whether it is known of all pieces whether they are seen.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn is_done(&self, shapes: &VerdictShapes) -> bool {
        self.seen.len() >= shapes.pieces.len()
    }

    /// Shows the shapes. Returns the receiver under the pointer.
    pub(in crate::desktop) fn show(
        &mut self,
        ui: &Ui,
        view: &View,
        rect: Rect,
        request: &LayerRequest<'_>,
    ) -> Option<usize> {
        self.look(ui, view, request);
        let painter = ui.painter_at(rect);
        let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|at| rect.contains(*at));
        let (mut faces, mut over) = (egui::Mesh::default(), None);
        let (mut hatched, mut above) = (Vec::new(), Vec::new());
        let pieces = request.shapes.pieces.iter().zip(&self.seen).filter(|(_, is_seen)| **is_seen);
        for ((number, piece), _) in pieces {
            let number = *number as usize;
            let corners: Option<Vec<Pos2>> =
                piece.corners().iter().map(|corner| sky::on_picture(view, rect, *corner)).collect();
            let Some(corners) = corners.filter(|corners| is_within(corners, rect)) else { continue };
            if pointer.is_some_and(|pointer| is_at(&corners, pointer)) {
                over = Some(number);
            }
            let paint = (request.paint)(number);
            match (piece, paint) {
                (ShapePiece::Triangle(_) | ShapePiece::Quad(_), Some(paint)) => {
                    add_face(&mut faces, &corners, paint.colour.gamma_multiply(OPACITY));
                    hatched.push((corners, paint));
                }
                (ShapePiece::Triangle(_), None) => {}
                (ShapePiece::Quad(_), None) => {
                    add_face(&mut faces, &corners, theme::ACCENT.gamma_multiply(0.5));
                }
                (ShapePiece::Line(_), paint) => {
                    let colour = paint.map_or(theme::ACCENT, VerdictPaint::ink);
                    let width = if request.marked.contains(&number) { 3.5 } else { 1.8 };
                    above.push(Shape::line(corners, Stroke::new(width, colour)));
                }
                (ShapePiece::Dot(_), paint) => above.push(dot(corners[0], paint)),
            }
        }
        painter.add(Shape::mesh(faces));
        hatched.iter().for_each(|(corners, paint)| paint.hatch(&painter, corners));
        painter.extend(above);
        over
    }

    /// Finds of as many pieces as a frame allows whether they are seen.
    fn look(&mut self, ui: &Ui, view: &View, request: &LayerRequest<'_>) {
        let (site, shapes) = request.numbers;
        if self.of != Some((site, shapes, *view)) {
            (self.of, self.seen) = (Some((site, shapes, *view)), Vec::new());
        }
        let pieces = &request.shapes.pieces;
        let begun = Instant::now();
        while self.seen.len() < pieces.len() {
            let piece = &pieces[self.seen.len()].1;
            self.seen.push(is_seen(request.project, view, piece.middle() + DVec3::Z * above(piece)));
            if self.seen.len().is_multiple_of(64) && begun.elapsed() > A_FRAME {
                ui.ctx().request_repaint();
                return;
            }
        }
    }
}

/// How far above a piece it is sought whether it is seen, metres: paving, and terrain between two corners, hide no area.
fn above(piece: &ShapePiece) -> f64 {
    match piece {
        ShapePiece::Triangle(_) | ShapePiece::Line(_) => 0.35,
        ShapePiece::Quad(_) | ShapePiece::Dot(_) => 0.0,
    }
}

/// Whether nothing of the models lies in front of a point. From above, everything is shown.
fn is_seen(project: &Project, view: &View, point: DVec3) -> bool {
    let (mesh, rays) = &*project.seen;
    let from = match view {
        View::Plan(_) => return true,
        View::Camera(camera) => camera.eye,
        View::Elevation(side) => {
            let dome = dome(project);
            let away = (dome.centre - point).dot(side.to_viewer).max(0.0) + dome.radius * 4.0;
            point + side.to_viewer * away
        }
    };
    let distance = from.distance(point);
    let Some(along) = (point - from).try_normalize() else { return false };
    // a pane lies in its own glass, and an area on its terrain
    let within = 0.03 + 1e-3 * distance;
    rays.first_hit(from - mesh.origin, along).is_none_or(|(_, hit)| hit >= distance - within)
}

fn dot(at: Pos2, paint: Option<VerdictPaint>) -> Shape {
    let (colour, ink) = paint.map_or((theme::ACCENT, Color32::WHITE), |paint| (paint.colour, paint.ink()));
    CircleShape { center: at, radius: 4.0, fill: colour, stroke: Stroke::new(1.5, ink) }.into()
}

fn add_face(mesh: &mut egui::Mesh, corners: &[Pos2], colour: Color32) {
    let first = mesh.vertices.len() as u32;
    corners.iter().for_each(|corner| mesh.colored_vertex(*corner, colour));
    for at in 1..corners.len() as u32 - 1 {
        mesh.add_triangle(first, first + at, first + at + 1);
    }
}

/// Whether some of it may be in the picture.
fn is_within(corners: &[Pos2], rect: Rect) -> bool {
    let bounds = Rect::from_points(corners);
    bounds.is_finite() && bounds.expand(4.0).intersects(rect)
}

/// Whether a position lies on a convex outline, or near a line or a dot.
fn is_at(corners: &[Pos2], at: Pos2) -> bool {
    match corners {
        [dot] => dot.distance(at) < 6.0,
        [from, to] => {
            let (along, length) = (*to - *from, (*to - *from).length_sq());
            let part = if length > 0.0 { ((at - *from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
            (*from + along * part).distance(at) < 5.0
        }
        corners => {
            let turn = |number: usize| {
                let [a, b] = [corners[number], corners[(number + 1) % corners.len()]];
                (b - a).x * (at - a).y - (b - a).y * (at - a).x
            };
            let turns: Vec<f32> = (0..corners.len()).map(turn).collect();
            turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0)
        }
    }
}
