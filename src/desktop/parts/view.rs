//! The picture, and pointer input on it.

use crate::choice::{Method, Settings};
use crate::desktop::parts::screen::Print;
use crate::desktop::parts::sky;
use crate::desktop::results::StudyResult;
use crate::desktop::stage::wish::Wish;
use crate::desktop::stage::{Stage, StagePicture};
use crate::desktop::state::clock::Clock;
use crate::desktop::state::eye::{Eye, Stand};
use crate::desktop::state::pick::{PickedPoint, dome, under};
use crate::desktop::state::project::Project;
use crate::desktop::state::settings::ShadowSettings;
use crate::desktop::state::technique::{counts, draws, of_disc};
use crate::picture::Style;
use crate::study::live::{FARTHEST, LiveMethod};
use crate::view::View;
use eframe::egui::{self, Align2, PointerButton, Rect, Sense, Ui};
use eframe::egui_wgpu::RenderState;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// The time without change before a better picture is drawn, seconds.
const STILL_SECS: f64 = 0.22;
/// The longest time of a quick look, seconds, which decides its size.
const QUICK_SECS: f64 = 0.06;
/// The number of points of the sun's disc for ray casting.
pub(in crate::desktop) const DISC_SAMPLES: u32 = 32;

/// The picture that is shown, and the one that is wanted.
pub(in crate::desktop) struct Viewer {
    /// The position of the eye.
    pub(in crate::desktop) eye: Eye,
    /// Whether everything should be shown once the picture's aspect ratio is known.
    fits: bool,
    shown: Option<StagePicture>,
    print: Option<Print>,
    wished: Option<Wish>,
    /// The best picture of the last frame's request, and when the request changed.
    best: Option<Wish>,
    moved_at: f64,
    /// The scale of a quick look relative to the full size.
    scale: f64,
    /// Why there is no picture.
    pub(in crate::desktop) fault: Option<String>,
    /// What is under the pointer.
    pub(in crate::desktop) under: Option<PickedPoint>,
}

/// What the view should show.
pub(in crate::desktop) struct ViewRequest<'a> {
    /// The site.
    pub(in crate::desktop) project: &'a Project,
    /// The number of this site among those that were loaded.
    pub(in crate::desktop) number: u64,
    /// How its shadows are shown.
    pub(in crate::desktop) choice: ShadowSettings,
    /// The computed hours, if they should be shown.
    pub(in crate::desktop) result: Option<&'a Arc<StudyResult>>,
    /// Whether the sun's path is drawn over it.
    pub(in crate::desktop) sun_path: bool,
    /// Whether lengths are in feet.
    pub(in crate::desktop) feet: bool,
}

impl Viewer {
    /// Looks at a site from its camera.
    pub(in crate::desktop) fn new(project: &Project) -> Viewer {
        Viewer {
            eye: Eye::of(&project.site, &project.written.site.camera),
            fits: false,
            shown: None,
            print: None,
            wished: None,
            best: None,
            moved_at: 0.0,
            scale: 0.5,
            fault: None,
            under: None,
        }
    }

    /// Shows everything from the current stand.
    pub(in crate::desktop) fn fit(&mut self) {
        self.fits = true;
    }

    /// Shows everything from all stands, after a change of scene.
    pub(in crate::desktop) fn fit_all(&mut self, project: &Project) {
        self.eye.forget_flat();
        let stand = std::mem::replace(&mut self.eye.stand, Stand::Perspective);
        self.eye.fit(extent(project, Stand::Perspective));
        self.eye.stand = stand;
    }

    /// Forgets pictures on a device that is lost.
    pub(in crate::desktop) fn forget_pictures(&mut self) {
        (self.shown, self.print, self.wished) = (None, None, None);
    }

    /// The newest picture.
    pub(in crate::desktop) fn shown(&self) -> Option<&StagePicture> {
        self.shown.as_ref()
    }

    /// The best picture of the last frame's request.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn best(&self) -> Option<&Wish> {
        self.best.as_ref()
    }

    /// Whether the picture on the screen is the best one for the request.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn is_settled(&self) -> bool {
        let both = self.shown.as_ref().zip(self.best.as_ref());
        both.is_some_and(|(shown, best)| shown.wish.is_same(best))
    }

    /// Takes the pictures that the stage has drawn.
    pub(in crate::desktop) fn receive(&mut self, stage: &Stage, render: &RenderState) {
        match stage.done() {
            None => {}
            Some(Err(fault)) => self.fault = Some(fault),
            Some(Ok(shown)) => {
                self.fault = None;
                self.adapt(&shown);
                let is_new = self.shown.as_ref().is_none_or(|before| before.texture != shown.texture);
                if is_new {
                    self.print = Print::of(&shown.texture, render);
                }
                self.shown = Some(shown);
            }
        }
    }

    /// Chooses the size of the next quick look from the time that rays took for this picture. Sizes differ by steps,
    /// since the stage prepares the view again for each new size; the size grows only if there is time to spare.
    fn adapt(&mut self, shown: &StagePicture) {
        const SIZES: [f64; 8] = [0.12, 0.18, 0.25, 0.35, 0.5, 0.7, 0.85, 1.0];
        let Some(best) = &self.best else { return };
        let by_quickest = shown.provenance.technique == LiveMethod::quickest().method;
        if !by_quickest || shown.wish.way.settings != LiveMethod::quickest().settings {
            return;
        }
        let side = |view: &View| f64::from(view.size().0.max(1));
        let scale = side(&shown.wish.view) / side(&best.view);
        let takes = |size: f64| shown.secs * (size / scale).powi(2);
        let fitting = SIZES.into_iter().rev().find(|size| takes(*size) <= QUICK_SECS).unwrap_or(SIZES[0]);
        if takes(self.scale) > 1.5 * QUICK_SECS || takes(fitting) < 0.7 * QUICK_SECS {
            self.scale = fitting;
        }
    }

    /// Shows the picture, moves the eye, and requests the next picture. Returns the point of the model that was
    /// clicked.
    pub(in crate::desktop) fn show(
        &mut self,
        ui: &mut Ui,
        stage: &Stage,
        software: bool,
        request: &ViewRequest<'_>,
        clock: &mut Clock,
    ) -> Option<PickedPoint> {
        let rect = ui.available_rect_before_wrap();
        self.eye.width_by_height = f64::from(rect.width() / rect.height().max(1.0));
        if std::mem::take(&mut self.fits) || !self.eye.is_framed() {
            self.eye.fit(extent(request.project, self.eye.stand));
        }
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Model"));
        self.wish(ui, rect, stage, software, request, clock);
        let (Some(shown), Some(print)) = (&self.shown, &self.print) else {
            let painter = ui.painter_at(rect);
            painter.rect_filled(rect, 0.0, egui::Color32::from_rgb(236, 235, 230));
            sky::label(&painter, rect.center(), Align2::CENTER_CENTER, "Drawing the first picture");
            self.move_eye(ui, rect, &response, request.project);
            return None;
        };
        ui.painter().add(print.shown_in(rect));
        let view = shown.wish.view;
        let dome = dome(request.project);
        if request.sun_path
            && let Some(secs) = sky::path(ui, &view, rect, &dome, clock)
        {
            clock.set_secs(secs);
        }
        sky::north(ui, &view, rect);
        let metres_a_point = self.eye.metres_a_pixel(1) / f64::from(rect.height());
        sky::scale_bar(ui, rect, metres_a_point, request.feet);
        self.status(ui, rect, software, request);

        let pointer = response.hover_pos().filter(|_| !response.dragged());
        self.under = pointer.and_then(|pointer| under(request.project, &view, rect, pointer));
        let clicked = response.clicked().then(|| self.under.clone()).flatten();
        self.move_eye(ui, rect, &response, request.project);
        clicked
    }

    /// Requests the picture of this moment: a quick look while something moves, the best picture when everything is
    /// still.
    fn wish(&mut self, ui: &Ui, rect: Rect, stage: &Stage, software: bool, request: &ViewRequest<'_>, clock: &Clock) {
        let now = ui.input(|input| input.time);
        let pixels = f64::from(ui.pixels_per_point());
        let sized = |scale: f64| {
            let side = |points: f32| (f64::from(points) * pixels * scale).round().clamp(16.0, 8192.0) as u32;
            (side(rect.width()), side(rect.height()))
        };
        // an adapter draws at twice the resolution, which the screen then smooths
        let best = self.best_wish(sized(if software { 1.0 } else { 2.0 }), software, request, clock);
        if self.best.as_ref().is_none_or(|before| !before.is_same(&best)) {
            // the first picture is the best one at once
            self.moved_at = if self.best.is_some() { now } else { f64::NEG_INFINITY };
            self.best = Some(best.clone());
        }
        let wish = if now - self.moved_at < STILL_SECS {
            ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(STILL_SECS));
            self.quick_wish(best, sized(if software { self.scale } else { 1.0 }), software)
        } else {
            best
        };
        if self.wished.as_ref().is_none_or(|before| !before.is_same(&wish)) {
            stage.wish(wish.clone());
            self.wished = Some(wish);
        }
    }

    /// The best picture of the request, in that many pixels.
    fn best_wish(&self, size: (u32, u32), software: bool, request: &ViewRequest<'_>, clock: &Clock) -> Wish {
        let choice = request.choice;
        let stand = self.eye.stand;
        let is_perspective = stand == Stand::Perspective;
        let method = if draws(choice.method, stand) { choice.method } else { Method::Auto };
        let disc = of_disc(method, software).filter(|_| choice.disc);
        let way = LiveMethod {
            method: disc.unwrap_or(method),
            settings: Settings { sun_samples: disc.map(|_| DISC_SAMPLES), ..Settings::default() },
        };
        let style = Style {
            focus_m: self.eye.camera((1, 1)).target.distance(self.eye.camera((1, 1)).eye),
            // lines one pixel wide look heavier than on paper
            lines: if software { 0.62 } else { 1.0 },
            wide_lines: !software,
            tinted: choice.tinted,
            hours: request.result.is_some(),
        };
        Wish {
            site: Arc::clone(&request.project.visible),
            number: request.number,
            view: self.eye.view(size),
            way,
            to_sun: clock.now.to_sun,
            style,
            hours: request.result.cloned(),
            overlay: [choice.volumes && is_perspective, choice.silhouette && is_perspective],
            diagram: choice.diagram.filter(|_| counts(method)),
            quick: false,
        }
    }

    /// A quick look at the same.
    fn quick_wish(&self, best: Wish, size: (u32, u32), software: bool) -> Wish {
        Wish {
            view: self.eye.view(size),
            way: if software { LiveMethod::quickest() } else { best.way },
            style: Style { wide_lines: false, lines: if software { 0.45 } else { 0.62 }, ..best.style },
            overlay: [false; 2],
            diagram: None,
            quick: true,
            ..best
        }
    }

    fn move_eye(&mut self, ui: &Ui, rect: Rect, response: &egui::Response, project: &Project) {
        let height = (rect.height() * ui.pixels_per_point()).round().max(1.0) as u32;
        let pixels = f64::from(ui.pixels_per_point());
        let delta = response.drag_delta();
        let delta = DVec2::new(f64::from(delta.x), f64::from(delta.y)) * pixels;
        let shift = ui.input(|input| input.modifiers.shift);
        let pans = shift || response.dragged_by(PointerButton::Secondary) || response.dragged_by(PointerButton::Middle);
        if response.dragged() && delta != DVec2::ZERO {
            if self.eye.stand == Stand::Perspective && !pans {
                self.eye.orbit(delta, f64::from(height));
            } else {
                self.eye.pan(delta, height);
            }
        }
        if let Some(pointer) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = f64::from(scroll * 0.0025).exp() * f64::from(pinch);
            if factor != 1.0 {
                let from = (pointer - rect.center()) * ui.pixels_per_point();
                let size = dome(project).radius;
                let limits = [size * 0.02, size * FARTHEST / 12.0];
                let view = self.eye.view(((rect.width() * ui.pixels_per_point()).round().max(1.0) as u32, height));
                let about = under(project, &view, rect, pointer).map_or_else(
                    || self.eye.beside_target(DVec2::new(f64::from(from.x), f64::from(from.y)), height),
                    |under| under.point,
                );
                self.eye.zoom(factor, about, limits);
            }
        }
    }

    /// The provenance of the picture, in its corner.
    fn status(&self, ui: &Ui, rect: Rect, software: bool, request: &ViewRequest<'_>) {
        let Some(shown) = &self.shown else { return };
        let provenance = &shown.provenance;
        let over = shown.wish.hours.as_ref().filter(|_| shown.wish.style.hours && !shown.plain);
        let mut text = if let Some(result) = over {
            result.what().to_owned()
        } else if shown.wish.to_sun.z <= 0.0 {
            "night: nothing sees the sun".to_owned()
        } else {
            format!("{} on the {}", provenance.technique, provenance.engine)
        };
        if let Some(samples) = shown.wish.way.settings.sun_samples {
            text += &format!(", {samples} points of the sun");
        }
        if shown.wish.quick && software {
            let chosen = if request.choice.method == Method::Auto { "" } else { request.choice.method.word() };
            let then = if chosen.is_empty() { String::new() } else { format!(", then {chosen}") };
            text = format!("moving: {text} at {:.0}%{then}", self.scale * 100.0);
        }
        let painter = ui.painter_at(rect);
        sky::label(&painter, rect.left_bottom() + egui::vec2(14.0, -12.0), Align2::LEFT_BOTTOM, &text);
    }
}

/// The extent to show from a stand: the models; from a side, their part above the ground; in the plan, also their
/// shadows.
fn extent(project: &Project, stand: Stand) -> (DVec3, DVec3) {
    let site = &project.site;
    let (low, high) = site.mesh.bounds_at_home().unwrap_or((DVec3::ZERO, DVec3::ONE));
    match stand {
        Stand::Perspective => (low, high),
        Stand::Plan => {
            let [west, south, east, north] = site.grid.region();
            (DVec3::new(west, south, site.ground.level), DVec3::new(east, north, site.ground.level))
        }
        _ => (low.with_z(site.ground.level), high.with_z(high.z.max(site.ground.level))),
    }
}
