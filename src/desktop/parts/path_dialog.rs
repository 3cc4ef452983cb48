//! Asks for paths with the system's dialogs, or with a dialog in the window if the system has none. It also offers the
//! samples.

use crate::deliver::lines::Lines;
use crate::desktop::parts::question::Question;
use crate::desktop::parts::theme;
use crate::export::animation::Frames;
use crate::formats::FORMATS;
use eframe::egui;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The purposes for which a path is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum Purpose {
    /// Opens what is there.
    Open,
    /// Compares the open site with what is there.
    Compare,
    /// Writes the site file.
    SaveSite,
    /// Writes the drawing of the instant.
    Drawing,
    /// Writes the hours, or the change, into a folder.
    Hours,
    /// Writes the hours as a line drawing, into a folder.
    Lines(Lines),
    /// Writes the verdicts, into a folder.
    Verdicts,
    /// Writes the study as pictures and as a GIF, into a folder.
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
            Purpose::Lines(Lines::Hours) => "Export the iso-hour lines: a folder for hours.png and hours.svg",
            Purpose::Lines(Lines::Outlines) => "Export the outlines: a folder for outlines.png and outlines.svg",
            Purpose::Verdicts => "Export the verdicts: a folder for judgement.json and judgement.csv",
            Purpose::Animation => "Export the animation: a folder for day.gif and its pictures",
        }
    }

    /// Whether the path must already exist.
    fn reads(self) -> bool {
        matches!(self, Purpose::Open | Purpose::Compare)
    }

    /// Whether it is a folder, and not a file.
    fn is_folder(self) -> bool {
        matches!(self, Purpose::Hours | Purpose::Lines(_) | Purpose::Verdicts | Purpose::Animation)
    }

    /// The name that is proposed, beside the open site.
    pub(in crate::desktop) fn name(self) -> &'static str {
        match self {
            Purpose::Open | Purpose::Compare => "",
            Purpose::SaveSite => "site.toml",
            Purpose::Drawing => "shadow.png",
            Purpose::Hours | Purpose::Lines(_) | Purpose::Verdicts => "out",
            Purpose::Animation => "animation",
        }
    }
}

/// A path that is being asked for.
pub(in crate::desktop) struct PathDialog {
    purpose: Purpose,
    begun: Instant,
    answer: mpsc::Receiver<Option<PathBuf>>,
    /// The proposed path.
    proposed: PathBuf,
    /// The names of the files that will be written into a folder; an animation has its own.
    files: Vec<PathBuf>,
    /// The text typed into the dialog in the window.
    typed: Option<String>,
    /// Whether it was shown, and its field had the focus.
    is_met: bool,
    /// The path that was chosen, and the file that is already there.
    replaces: Option<(PathBuf, PathBuf)>,
}

/// The answer of a dialog.
pub(in crate::desktop) enum DialogAnswer {
    /// The dialog stays open.
    None,
    /// A path was chosen.
    Path(Purpose, PathBuf),
    /// The dialog was closed without a choice.
    Nothing,
}

impl PathDialog {
    /// Asks by the system's dialog, beginning with the proposed path; `files` are the names of what will be written
    /// into a folder.
    pub(in crate::desktop) fn start(
        purpose: Purpose,
        proposed: PathBuf,
        files: Vec<PathBuf>,
        context: egui::Context,
    ) -> PathDialog {
        let (tell, answer) = mpsc::channel();
        let folder = if purpose.reads() { Some(proposed.as_path()) } else { proposed.parent() }.map(Path::to_owned);
        let name = proposed.file_name().map(OsStr::to_owned);
        std::thread::spawn(move || {
            let mut dialog = rfd::FileDialog::new().set_title(purpose.title());
            if let Some(folder) = folder {
                dialog = dialog.set_directory(folder);
            }
            let name = name.unwrap_or_default().to_string_lossy().into_owned();
            // the system asks before a file is replaced
            let path = match purpose {
                Purpose::Open | Purpose::Compare => {
                    dialog.add_filter("Sites and models", &endings()).add_filter("All", &["*"]).pick_file()
                }
                Purpose::SaveSite => dialog.add_filter("Site", &["toml"]).set_file_name(name).save_file(),
                Purpose::Drawing => dialog.add_filter("PNG", &["png"]).set_file_name(name).save_file(),
                Purpose::Hours | Purpose::Lines(_) | Purpose::Verdicts | Purpose::Animation => dialog.pick_folder(),
            };
            // if the window is closed, nobody receives this
            let _ = tell.send(path);
            context.request_repaint();
        });
        let begun = Instant::now();
        PathDialog { purpose, begun, answer, proposed, files, typed: None, is_met: false, replaces: None }
    }

    /// The purpose of the path.
    pub(in crate::desktop) fn purpose(&self) -> Purpose {
        self.purpose
    }

    /// Looks for the answer. If the system showed no dialog, it shows the one in the window.
    pub(in crate::desktop) fn show(&mut self, context: &egui::Context) -> DialogAnswer {
        /// Answers faster than a person could give mean that the system showed no dialog.
        const AT_ONCE: Duration = Duration::from_millis(400);
        match self.answer.try_recv() {
            Ok(Some(path)) if self.purpose.is_folder() => return self.choose(path),
            Ok(Some(path)) => return DialogAnswer::Path(self.purpose, path),
            Ok(None) if self.begun.elapsed() > AT_ONCE => return DialogAnswer::Nothing,
            Ok(None) => self.typed = Some(self.proposed.display().to_string()),
            Err(_) => {}
        }
        if self.replaces.is_some() {
            return self.ask_replacing(context);
        }
        let Some(typed) = &mut self.typed else { return DialogAnswer::None };
        let mut chosen = None;
        let mut closes = false;
        let modal = theme::modal(context, "path").show(context, |ui| {
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
                let is_said = !typed.trim().is_empty();
                let goes = ui.add_enabled(is_said, egui::Button::new(go)).clicked() || entered;
                if goes && is_said {
                    chosen = Some(PathBuf::from(typed.trim()));
                }
                closes = ui.button("Cancel").clicked();
            });
        });
        match chosen {
            _ if closes || modal.should_close() => DialogAnswer::Nothing,
            Some(path) => self.choose(path),
            None => DialogAnswer::None,
        }
    }

    /// Accepts a path. An existing file is only replaced after a question.
    fn choose(&mut self, path: PathBuf) -> DialogAnswer {
        let is_there = |file: &PathBuf| file.is_file();
        let there = match self.purpose {
            purpose if purpose.reads() => None,
            Purpose::Animation => Frames::there(&path),
            purpose if purpose.is_folder() => self.files.iter().map(|name| path.join(name)).find(is_there),
            _ => Some(path.clone()).filter(is_there),
        };
        let Some(there) = there else { return DialogAnswer::Path(self.purpose, path) };
        self.replaces = Some((path, there));
        DialogAnswer::None
    }

    fn ask_replacing(&mut self, context: &egui::Context) -> DialogAnswer {
        let Some((path, there)) = &self.replaces else { return DialogAnswer::None };
        let name = there.file_name().unwrap_or_default().to_string_lossy();
        let others = if self.purpose.is_folder() { " Files of the same names are replaced." } else { "" };
        let question = Question {
            heading: "Replace what is there?",
            text: &format!("{name} is there already.{others}"),
            path: &there.display().to_string(),
            answers: ["Replace", "Cancel"],
            first: 1,
        };
        match question.show(context) {
            None => DialogAnswer::None,
            Some(0) => DialogAnswer::Path(self.purpose, path.clone()),
            // back to the path, if it was typed here
            Some(_) => {
                (self.replaces, self.is_met) = (None, false);
                if self.typed.is_some() { DialogAnswer::None } else { DialogAnswer::Nothing }
            }
        }
    }
}

/// The endings of names of sites and models.
fn endings() -> Vec<&'static str> {
    ["toml"].into_iter().chain(FORMATS.iter().flat_map(|format| format.endings()).copied()).collect()
}

/// Folders, sites and models around the typed path, to click on.
fn listing(ui: &mut egui::Ui, typed: &mut String) {
    let path = PathBuf::from(typed.trim());
    let folder = if path.is_dir() { path } else { path.parent().map(Path::to_owned).unwrap_or_default() };
    let is_ours = |path: &Path| {
        let kind = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        path.is_dir() || endings().contains(&kind.as_str())
    };
    let Ok(entries) = folder.read_dir() else { return };
    let visible = |path: &PathBuf| path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.'));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(|path| is_ours(path)).collect();
    paths.retain(visible);
    paths.sort_by_key(|path| (!path.is_dir(), path.clone()));
    // leaves room for the dialog's heading, field and buttons
    let most = (ui.ctx().content_rect().height() - 210.0).clamp(60.0, 220.0);
    egui::ScrollArea::vertical().max_height(most).show(ui, |ui| {
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
