//! Files in and out: dialogs of the system, or one in the window where the system has none; samples; what is handed in.

use super::eye::{Eye, Stand};
use super::hours::Laid;
use super::loading::Project;
use super::look;
use super::settings::Settings;
use super::view;
use super::work::Work;
use crate::cli::animate;
use crate::export::figure::Diagram;
use crate::export::{figure, file};
use crate::site::file::CameraTable;
use crate::site::{Method, Overrides, Site, Written, model};
use crate::study::{self, Event, InstantWants, StudyError};
use crate::view::View;
use chrono::DateTime;
use chrono_tz::Tz;
use eframe::egui;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// For what a path is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To open what lies there.
    Open,
    /// To compare the open site with what lies there.
    Compare,
    /// To write the site file.
    SaveSite,
    /// To write the drawing of the instant.
    Drawing,
    /// To write the hours, or the change, in a folder.
    Hours,
    /// To write the study as pictures and as a GIF, in a folder.
    Animation,
}

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Purpose::Open => "Open a site or a model",
            Purpose::Compare => "Compare with a site or a model: how it stood before",
            Purpose::SaveSite => "Save the site file",
            Purpose::Drawing => "Export the drawing",
            Purpose::Hours => "Export the hours: a folder for the files",
            Purpose::Animation => "Export the animation: a folder for day.gif and its pictures",
        }
    }

    /// Whether something is there already.
    fn reads(self) -> bool {
        matches!(self, Purpose::Open | Purpose::Compare)
    }

    fn name(self) -> &'static str {
        match self {
            Purpose::Open | Purpose::Compare => "",
            Purpose::SaveSite => "site.toml",
            Purpose::Drawing => "shadow.png",
            Purpose::Hours => "out",
            Purpose::Animation => "animation",
        }
    }
}

/// A path that is being asked for.
pub(super) struct Asking {
    purpose: Purpose,
    begun: Instant,
    answer: mpsc::Receiver<Option<PathBuf>>,
    /// The dialog in the window: what is typed.
    typed: Option<String>,
    /// It has been shown, and its field had the focus.
    is_met: bool,
}

/// What an asking came to.
pub(super) enum Answer {
    /// It goes on.
    None,
    /// A path.
    Path(Purpose, PathBuf),
    /// Nothing was chosen.
    Nothing,
}

impl Asking {
    /// Asks by the system's dialog, from a folder on.
    pub(super) fn start(purpose: Purpose, folder: Option<PathBuf>, context: egui::Context) -> Asking {
        let (tell, answer) = mpsc::channel();
        std::thread::spawn(move || {
            let mut dialog = rfd::FileDialog::new().set_title(purpose.title());
            if let Some(folder) = folder {
                dialog = dialog.set_directory(folder);
            }
            let path = match purpose {
                Purpose::Open | Purpose::Compare => dialog
                    .add_filter("Sites and models", &["toml", "glb", "gltf"])
                    .add_filter("All", &["*"])
                    .pick_file(),
                Purpose::SaveSite => dialog.add_filter("Site", &["toml"]).set_file_name(purpose.name()).save_file(),
                Purpose::Drawing => dialog.add_filter("PNG", &["png"]).set_file_name(purpose.name()).save_file(),
                Purpose::Hours | Purpose::Animation => dialog.pick_folder(),
            };
            // who closed the window listens no more
            let _ = tell.send(path);
            context.request_repaint();
        });
        Asking { purpose, begun: Instant::now(), answer, typed: None, is_met: false }
    }

    /// Looks for the answer; shows the dialog in the window where the system showed none.
    pub(super) fn show(&mut self, context: &egui::Context, folder: &Path) -> Answer {
        /// Nobody answers so soon: there was no dialog.
        const AT_ONCE: Duration = Duration::from_millis(400);
        match self.answer.try_recv() {
            Ok(Some(path)) => return Answer::Path(self.purpose, path),
            Ok(None) if self.begun.elapsed() > AT_ONCE => return Answer::Nothing,
            Ok(None) => self.typed = Some(folder.join(self.purpose.name()).display().to_string()),
            Err(_) => {}
        }
        let Some(typed) = &mut self.typed else { return Answer::None };
        let mut answer = Answer::None;
        let modal = look::modal(context, "path").show(context, |ui| {
            ui.set_width(520.0);
            ui.heading(self.purpose.title());
            ui.add_space(4.0);
            let label = ui.label("Path");
            let field = ui.add(egui::TextEdit::singleline(typed).desired_width(f32::INFINITY)).labelled_by(label.id);
            if !self.is_met {
                field.request_focus();
                self.is_met = true;
            }
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if self.purpose.reads() {
                listing(ui, typed);
            }
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                let go = match self.purpose {
                    Purpose::Open => "Open",
                    Purpose::Compare => "Compare",
                    _ => "Write",
                };
                if ui.button(go).clicked() || entered {
                    answer = Answer::Path(self.purpose, PathBuf::from(typed.trim()));
                }
                if ui.button("Cancel").clicked() {
                    answer = Answer::Nothing;
                }
            });
        });
        if modal.should_close() {
            answer = Answer::Nothing;
        }
        answer
    }
}

/// Folders, sites and models around what is typed, to be clicked.
fn listing(ui: &mut egui::Ui, typed: &mut String) {
    let path = PathBuf::from(typed.trim());
    let folder = if path.is_dir() { path } else { path.parent().map(Path::to_owned).unwrap_or_default() };
    let is_ours = |path: &Path| {
        let kind = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        path.is_dir() || matches!(kind.as_str(), "toml" | "glb" | "gltf")
    };
    let Ok(entries) = folder.read_dir() else { return };
    let visible = |path: &PathBuf| path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.'));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(|path| is_ours(path)).collect();
    paths.retain(visible);
    paths.sort_by_key(|path| (!path.is_dir(), path.clone()));
    egui::ScrollArea::vertical().max_height(220.0).show(ui, |ui| {
        if let Some(parent) = folder.parent()
            && ui.button("Folder above").clicked()
        {
            *typed = parent.display().to_string();
        }
        for path in paths {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let name = if path.is_dir() { format!("{name}/") } else { name };
            if ui.selectable_label(*typed == path.display().to_string(), name).clicked() {
                *typed = path.display().to_string();
            }
        }
    });
}

/// The sample sites: their names, and where each lies once it is written out.
pub(super) const SAMPLES: [&str; 3] = ["tower", "industry", "headquarters"];

/// Writes a sample where it can be opened, and says where that is.
///
/// # Errors
/// Where the system's folder for such files cannot be written to.
pub(super) fn sample(name: &str) -> anyhow::Result<PathBuf> {
    let (toml, model): (&str, &[u8]) = match name {
        "tower" => (include_str!("../../sites/tower/site.toml"), include_bytes!("../../sites/tower/tower.glb")),
        "industry" => {
            (include_str!("../../sites/industry/site.toml"), include_bytes!("../../sites/industry/industry.glb"))
        }
        _ => (
            include_str!("../../sites/headquarters/site.toml"),
            include_bytes!("../../sites/headquarters/headquarters.glb"),
        ),
    };
    let folder = std::env::temp_dir().join(format!("gnomon-{}-samples", env!("CARGO_PKG_VERSION"))).join(name);
    file::write(&folder.join(format!("{name}.glb")), model)?;
    let path = folder.join("site.toml");
    file::write(&path, toml.as_bytes())?;
    Ok(path)
}

/// The eye of the perspective, as a site file says it: to the millimetre.
fn camera(eye: &Eye) -> CameraTable {
    let camera = eye.camera((16, 10));
    let millimetres = |point: glam::DVec3| (point * 1000.0).round().to_array().map(|metres| metres / 1000.0 + 0.0);
    CameraTable {
        eye: Some(millimetres(camera.eye)),
        target: Some(millimetres(camera.target)),
        up: None,
        fov: Some((camera.fov_rad.to_degrees() * 1000.0).round() / 1000.0),
    }
}

/// What a site file at a path is to say, so that it reopens to the same view.
pub(super) fn written(project: &Project, settings: &Settings, eye: &Eye, path: &Path) -> Written {
    let mut site = settings.site.clone();
    if eye.stand == Stand::Perspective {
        site.camera = camera(eye);
    }
    site.study.technique = match settings.shown.method {
        Method::Auto => None,
        method => Some(method.word().to_owned()),
    };
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    for model in &mut site.model {
        let Some(name) = &mut model.path else { continue };
        let there = project.written.folder.join(&*name);
        let there = std::path::absolute(&there).unwrap_or(there);
        let here = std::path::absolute(&folder).unwrap_or(folder.clone());
        // beside or below the site file the path is relative, so that both can move together
        let relative = there.strip_prefix(&here).map(Path::to_owned).unwrap_or(there);
        *name = relative.display().to_string().replace('\\', "/");
    }
    Written { file: path.display().to_string(), folder, site, text: project.written.text.clone() }
}

/// The site as the eye of the perspective sees it.
fn seen_from(project: &Project, settings: &Settings, eye: &Eye) -> Written {
    let mut written = Written { site: settings.site.clone(), ..project.written.clone() };
    if eye.stand == Stand::Perspective {
        // the command draws from the saved camera, and so the same drawing
        written.site.camera = camera(eye);
    }
    written
}

fn view_from(site: &Site, eye: &Eye) -> View {
    match eye.stand {
        Stand::Plan => View::Plan(site.grid),
        Stand::Perspective => View::Camera(site.camera),
        _ => View::Camera(eye.camera((site.camera.width, site.camera.height))),
    }
}

/// Draws the instant as the command does: on the site's plan, or as the eye sees it.
pub(super) fn drawing(
    project: &Project,
    settings: &Settings,
    eye: Eye,
    time: DateTime<Tz>,
    path: PathBuf,
    context: egui::Context,
) -> Work<PathBuf> {
    let written = seen_from(project, settings, &eye);
    let shown = settings.shown;
    Work::start(context, move |on_event| {
        let is_plan = eye.stand == Stand::Plan;
        let method = match shown.method {
            // volumes and silhouette are the stencil's
            _ if (shown.volumes || shown.silhouette) && !is_plan => Method::Stencil,
            method if view::draws(method, is_plan) => method,
            _ => Method::Auto,
        };
        // as the command reads it, for the region of this instant's shadows
        let at = Some(time.format("%Y-%m-%dT%H:%M:%S%:z").to_string());
        let asked = Overrides { at, technique: Some(method), ..Overrides::default() };
        let site = Site::of(&written, &asked, model::load)?;
        let view = view_from(&site, &eye);
        let wants = InstantWants {
            surface: true,
            volumes: shown.volumes && !is_plan,
            silhouette: shown.silhouette && !is_plan,
            counted: shown.diagram.filter(|_| view::counts(method)).map(|diagram| match diagram {
                Diagram::Mask => "--show mask",
                Diagram::Overdraw => "--show overdraw",
            }),
        };
        let outcome = study::instant(&site, view, &wants, on_event)?;
        let Some(surface) = &outcome.surface else { anyhow::bail!("what is seen is not there") };
        let scene = figure::Scene {
            place: &site.place,
            track: &site.track,
            mesh: &outcome.surface_mesh,
            surface,
            receivers: study::judged(&site, &view),
            drawn: &outcome.drawn,
        };
        let seen = site.casts.iter().zip(&site.receives).filter(|(_, seen)| **seen);
        let casts: Vec<bool> = seen.map(|(casts, _)| *casts).collect();
        let components = (shown.tinted && !is_plan).then_some(casts.as_slice());
        let counted = outcome.counted.as_ref().zip(shown.diagram);
        let shown = figure::Shown { overlay: outcome.overlay.as_ref(), casts: components, counted };
        file::write(&path, &figure::instant(&scene, &view, &outcome.mask, &shown)?)?;
        Ok(path)
    })
}

/// Draws every instant of the study as the command does, into a folder: on the site's plan, or as the eye sees it.
pub(super) fn animation(
    project: &Project,
    settings: &Settings,
    eye: Eye,
    folder: PathBuf,
    context: egui::Context,
) -> Work<PathBuf> {
    let written = seen_from(project, settings, &eye);
    let method = settings.shown.method;
    Work::start(context, move |on_event| {
        let method = if view::draws(method, eye.stand == Stand::Plan) { method } else { Method::Auto };
        let asked = Overrides { technique: Some(method), ..Overrides::default() };
        let site = Site::of(&written, &asked, model::load)?;
        let count = animate::check(&site)?;
        file::check_folder(&folder)?;
        // the frames, and then each once more in the GIF
        let both = 2 * count;
        let drawn = |index: usize| {
            let time = site.track.instants[index % count].time;
            Event::Drawn { index, count: both, time, mask: None, bits: None }
        };
        let view = view_from(&site, &eye);
        let (_, frames) = animate::frames(&site, view, &folder, animate::WIDTH, &mut |event| match event {
            Event::Drawn { index, .. } => on_event(drawn(index)),
            event => on_event(event),
        })?;
        animate::gif(frames, count, animate::FPS, &mut |index| match on_event(drawn(count + index)) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(StudyError::Interrupted),
        })
    })
}

/// Shows how far a file is; whether it is given up.
pub(super) fn progress(writing: &Work<PathBuf>, ui: &mut egui::Ui) -> bool {
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

/// Writes the hours into a folder.
pub(super) fn hours(laid: Arc<Laid>, folder: PathBuf, context: egui::Context) -> Work<PathBuf> {
    Work::start(context, move |_| {
        for (name, bytes) in laid.files()? {
            file::write(&folder.join(name), &bytes)?;
        }
        Ok(folder)
    })
}
