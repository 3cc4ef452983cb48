//! The window, driven by the names of its parts, as a person or assistive technology would drive it.

mod changing;
mod comparing;
mod exporting;
mod facades;
mod fitting;
mod hiding;
mod judging;
mod keeping;
mod killed;
mod lost;
mod opening;
mod playing;
mod reloading;
mod resizing;
mod saving;
mod showing;
mod soak;
mod typing;
mod viewing;
mod xvfb;

use eframe::egui::{self, Event, Key, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, HarnessBuilder};
use gnomon::desktop::{self, App};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The window, with a site if one is named, once everything is drawn.
pub(crate) fn window(path: Option<&Path>) -> Harness<'static, App> {
    scaled(path, 1.0, egui::Theme::Light)
}

/// The same in another theme, with a scale of the interface; always of 1280 × 720 pixels.
pub(crate) fn scaled(path: Option<&Path>, scale: f32, theme: egui::Theme) -> Harness<'static, App> {
    built(builder(scale, theme), path)
}

/// A window in which letters that no font has are boxes, as they are for users.
pub(crate) fn with_boxes(path: Option<&Path>) -> Harness<'static, App> {
    built(builder(1.0, egui::Theme::Light).allow_missing_glyphs(), path)
}

fn builder(scale: f32, theme: egui::Theme) -> HarnessBuilder<App> {
    Harness::<App>::builder()
        .with_size(egui::vec2(1280.0, 720.0) / scale)
        .with_pixels_per_point(scale)
        .with_theme(theme)
        .wgpu_setup(desktop::setup())
}

fn built(builder: HarnessBuilder<App>, path: Option<&Path>) -> Harness<'static, App> {
    let path = path.map(Path::to_owned);
    let mut harness =
        builder.build_eframe(move |cc| App::new(cc, path.as_deref()).expect("an adapter: run tests/run.sh"));
    settle(&mut harness);
    harness
}

/// Runs until no work is pending.
pub(crate) fn settle(harness: &mut Harness<'_, App>) {
    let begun = Instant::now();
    let mut calm = 0;
    while calm < 3 {
        harness.step();
        calm = if harness.state().is_settled() { calm + 1 } else { 0 };
        assert!(begun.elapsed() < Duration::from_secs(200), "the window does not come to rest");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A folder with a small site: the works, in Vienna, in cells of two metres.
pub(crate) fn small_site() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::copy(sample("industry/industry.glb"), folder.path().join("works.glb")).expect("a model");
    let site = folder.path().join("site.toml");
    let text = "[place]\nname = \"Works\"\nlatitude = 48.2\nlongitude = 16.37\n[[model]]\npath = \"works.glb\"\n\
                [study]\ndate = 2026-03-21\nfrom = \"9:00\"\nto = \"17:00\"\nstep = \"2h\"\n[plan]\ncell = 2.0\n";
    std::fs::write(&site, text).expect("a site file");
    (folder, site)
}

pub(crate) fn sample(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(path)
}

/// Clicks the part with this name, as assistive technology does, wherever its panel is scrolled to.
pub(crate) fn click(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click_accesskit();
    harness.step();
    harness.step();
}

/// Replaces the text of a field, and finishes it.
pub(crate) fn write(harness: &mut Harness<'_, App>, label: &str, text: &str) {
    type_into(harness, egui::Role::TextInput, label, text);
    harness.step();
}

/// The same with a number field, and waits for the result.
pub(crate) fn enter(harness: &mut Harness<'_, App>, label: &str, text: &str) {
    type_into(harness, egui::Role::SpinButton, label, text);
    settle(harness);
}

fn type_into(harness: &mut Harness<'_, App>, role: egui::Role, label: &str, text: &str) {
    harness.get_by_role_and_label(role, label).focus();
    harness.step();
    // a field of a number becomes one of text first
    harness.step();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text(text.to_owned()));
    harness.step();
    harness.key_press(Key::Enter);
    harness.step();
}

/// The complete name of the part whose name contains this, and its position.
pub(crate) fn named(harness: &Harness<'_, App>, part: &str) -> (String, egui::Rect) {
    let node = harness.get_by_label_contains(part);
    let whole = node.accesskit_node();
    (whole.label().or_else(|| whole.value()).unwrap_or_default(), node.rect())
}

/// The text of the part with this name, without the name.
pub(crate) fn value(harness: &Harness<'_, App>, label: &str) -> String {
    harness.get_by_role_and_label(egui::Role::TextInput, label).value().unwrap_or_default()
}

/// A dropped file, as a system hands it over.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

pub(crate) fn drop_file(harness: &mut Harness<'_, App>, path: &Path) {
    harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(path.to_owned())));
    harness.step();
    settle(harness);
}

/// A pointer that comes, presses and releases in one place; waits for the result.
pub(crate) fn click_at(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.hover_at(at);
    harness.step();
    harness.drag_at(at);
    harness.step();
    harness.drop_at(at);
    harness.step();
    settle(harness);
}

/// A pointer that presses, moves and releases.
pub(crate) fn drag(harness: &mut Harness<'_, App>, from: Pos2, to: Pos2) {
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for part in 1..=4 {
        harness.hover_at(from.lerp(to, part as f32 / 4.0));
        harness.step();
    }
    harness.drop_at(to);
    harness.step();
}
