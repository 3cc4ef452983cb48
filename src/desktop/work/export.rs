//! Export: writes the site file, drawings, hours and animations, as the command makes them.

use crate::choice::Method;
use crate::deliver::animation::{self, AnimationRequest, FPS, WIDTH};
use crate::deliver::instant::{InstantRequest, Show, instant};
use crate::deliver::lines::Lines;
use crate::deliver::{Folder, Sink};
use crate::desktop::results::StudyResult;
use crate::desktop::state::eye::{Eye, Stand};
use crate::desktop::state::project::Project;
use crate::desktop::state::settings::WindowSettings;
use crate::desktop::state::technique;
use crate::desktop::work::{WHO, Work};
use crate::site::file::{CameraTable, SiteFile};
use crate::site::{Models, Overrides, Site, SiteError, WrittenSite};
use crate::study::{Event, FrameView, Stopwatch};
use crate::sun::Zone;
use crate::view::View;
use chrono::DateTime;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The eye as a site file's table, to the millimetre. In the plan, the table stays as it was.
fn camera(eye: &Eye, before: &CameraTable) -> CameraTable {
    let side = match eye.stand {
        Stand::Plan => return before.clone(),
        Stand::Perspective => None,
        Stand::Side(side) => Some(side.word().to_owned()),
    };
    let camera = eye.kept();
    let millimetres = |point: glam::DVec3| (point * 1000.0).round().to_array().map(|metres| metres / 1000.0 + 0.0);
    CameraTable {
        eye: Some(millimetres(camera.eye)),
        target: Some(millimetres(camera.target)),
        up: None,
        fov: Some((camera.fov_rad.to_degrees() * 1000.0).round() / 1000.0),
        side,
    }
}

/// Changes the relative paths in a site file that moves to another folder: of models and of what is judged.
pub(in crate::desktop) fn move_files(site: &mut SiteFile, from: &Path, to: &Path) {
    let models = site.model.iter_mut().filter_map(|model| model.path.as_mut());
    let areas = site.area.iter_mut().filter_map(|area| area.file.as_mut());
    let rooms = site.window.iter_mut().filter_map(|window| window.rooms.as_mut());
    let plot = site.plot.iter_mut().filter_map(|plot| plot.file.as_mut());
    let before = site.before.iter_mut().filter_map(|before| before.site.as_mut());
    for name in models.chain(areas).chain(rooms).chain(plot).chain(before) {
        *name = WrittenSite::name_in(to, &from.join(&*name));
    }
}

/// The site file for a path, so that it reopens with the same view.
pub(in crate::desktop) fn written(project: &Project, settings: &WindowSettings, eye: &Eye, path: &Path) -> WrittenSite {
    let mut site = settings.site.clone();
    site.camera = camera(eye, &site.camera);
    site.study.technique = match settings.shown.method {
        Method::Auto => None,
        method => Some(method.word().to_owned()),
    };
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    move_files(&mut site, &project.written.folder, &folder);
    WrittenSite { file: path.display().to_string(), folder, site, text: project.written.text.clone() }
}

/// The site as the eye sees it, through the saved camera, so that the drawing is the command's.
fn seen_from(project: &Project, settings: &WindowSettings, eye: &Eye) -> WrittenSite {
    let mut written = WrittenSite { site: settings.site.clone(), ..project.written.clone() };
    written.site.camera = camera(eye, &written.site.camera);
    written
}

/// Checks the exported site with the open models, whatever has become of their files.
fn site_of(written: &WrittenSite, overrides: &Overrides, models: Option<Models>) -> Result<Site, SiteError> {
    Site::with_models(written, overrides, || {
        models.map_or_else(|| Models::read(written, |path, options| overrides.reading.read(path, options)), Ok)
    })
}

fn view_from(site: &Site, eye: &Eye) -> View {
    match eye.stand {
        Stand::Plan => View::Plan(site.grid),
        Stand::Perspective | Stand::Side(_) => site.picture(),
    }
}

/// Draws the instant as the command does: on the site's plan, or as the eye sees it.
pub(in crate::desktop) fn drawing(
    project: &Project,
    settings: &WindowSettings,
    eye: Eye,
    time: DateTime<Zone>,
    path: PathBuf,
    context: egui::Context,
) -> Work<PathBuf> {
    let written = seen_from(project, settings, &eye);
    let models = project.models_of(&written);
    let (inputs, reading) = (project.inputs(settings.before.as_deref()), project.reading.clone());
    let shown = settings.shown;
    Work::start(context, move |on_event| {
        let is_perspective = eye.stand == Stand::Perspective;
        let shows_volumes = (shown.volumes || shown.silhouette) && is_perspective;
        let chosen = Some(shown.method).filter(|method| technique::draws(*method, eye.stand));
        let method = Method::of_volumes().filter(|_| shows_volumes).or(chosen).unwrap_or_default();
        // the region of this instant's shadows
        let overrides = Overrides { instant: Some(time), technique: Some(method), reading, ..Overrides::default() };
        let site = site_of(&written, &overrides, models)?;
        let request = InstantRequest {
            view: view_from(&site, &eye),
            drawing: Some(path.clone()),
            mask: None,
            show: Show {
                volumes: shown.volumes && is_perspective,
                silhouette: shown.silhouette && is_perspective,
                components: shown.tinted && eye.stand != Stand::Plan,
                diagram: shown.diagram.filter(|_| technique::counts(method)),
            },
            statistics: false,
            watch: Stopwatch::start(),
        };
        instant(&site, &request, Sink::Paths { inputs: &inputs }, on_event)?;
        Ok(path)
    })
}

/// Draws every instant of the study as the command does, into a folder: on the site's plan, or as the eye sees it.
pub(in crate::desktop) fn animation(
    project: &Project,
    settings: &WindowSettings,
    eye: Eye,
    folder: PathBuf,
    context: egui::Context,
) -> Work<PathBuf> {
    let written = seen_from(project, settings, &eye);
    let models = project.models_of(&written);
    let (inputs, reading) = (project.inputs(settings.before.as_deref()), project.reading.clone());
    let method = settings.shown.method;
    Work::start(context, move |on_event| {
        let method = if technique::draws(method, eye.stand) { method } else { Method::Auto };
        let overrides = Overrides { technique: Some(method), reading, ..Overrides::default() };
        let site = site_of(&written, &overrides, models)?;
        // the frames, and each again in the GIF
        let count = site.track.instants.len();
        let event_of = |index: usize| {
            let time = site.track.instants[index % count].time;
            Event::Drawn { index, count: 2 * count, time, mask: None, bits: None }
        };
        let view = view_from(&site, &eye);
        let request =
            AnimationRequest { view: FrameView::Still(view), width: WIDTH, fps: FPS, watch: Stopwatch::start() };
        let inside = Folder { path: &folder, who: WHO, inputs: &inputs };
        let mut in_gif = 0;
        let answer = animation::animation(&site, &request, inside, &mut |event| match event {
            Event::Drawn { index, .. } => on_event(event_of(index)),
            Event::Stage(_) => {
                in_gif += 1;
                on_event(event_of(count + in_gif - 1))
            }
            event => on_event(event),
        })?;
        Ok(answer.gif)
    })
}

/// Shows the progress of an export. Returns whether it was cancelled.
pub(in crate::desktop) fn progress(writing: &Work<PathBuf>, ui: &mut egui::Ui) -> bool {
    ui.horizontal(|ui| {
        let (done, count) = writing.progress();
        ui.label("Drawing");
        if count > 1 {
            let bar = egui::ProgressBar::new(done as f32 / count as f32);
            ui.add(bar.desired_width(220.0).show_percentage());
        } else {
            ui.add(egui::Spinner::new().size(16.0));
        }
        ui.button("Cancel the export").clicked()
    })
    .inner
}

/// Writes a result's files to a folder: all of them, or a line drawing.
pub(in crate::desktop) fn found(
    project: &Project,
    settings: &WindowSettings,
    result: Arc<StudyResult>,
    lines: Option<Lines>,
    folder: PathBuf,
    context: egui::Context,
) -> Work<PathBuf> {
    let inputs = project.inputs(settings.before.as_deref());
    Work::start(context, move |on_event| {
        result.write(lines, Sink::Folder(Folder { path: &folder, who: WHO, inputs: &inputs }), on_event)?;
        Ok(folder)
    })
}
