//! Draws the pictures of `docs/desktop.md`: `cargo run --example draw-window`. It drives the real window by the names
//! of its parts, without a screen.

use anyhow::{Result, anyhow, bail};
use eframe::egui::{Event, Key, Modifiers, Role, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use gnomon::desktop::{self, App};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn main() -> Result<()> {
    let mut window = open("headquarters", Theme::Light)?;
    write(&mut window, "Clock", "15:30")?;
    keep(&mut window, "headquarters")?;

    click(&mut window, "Find the hours")?;
    keep(&mut window, "hours")?;

    window.key_press(Key::Num2);
    window.step();
    window.key_press(Key::F);
    keep(&mut window, "plan")?;

    let mut window = open("headquarters", Theme::Light)?;
    // what is told of the change needs its place
    click(&mut window, "Shadows")?;
    press(&mut window, "Compare with")?;
    press(&mut window, "Another file…")?;
    answer(&mut window, &sample("headquarters/without.toml"))?;
    keep(&mut window, "change")?;

    let mut window = open("headquarters/judged.toml", Theme::Light)?;
    for section in ["Shadows", "Hours of shadow", "Place", "Judge by a rule"] {
        click(&mut window, section)?;
    }
    choose(&mut window, "Rule", "BRE BR 209, sun on the ground, United Kingdom")?;
    window.key_press_modifiers(Modifiers::COMMAND, Key::J);
    window.step();
    settle(&mut window)?;
    let line = window.query_by_label_contains("flats, northern lawn fails").ok_or_else(|| anyhow!("no verdict"))?;
    line.click_accesskit();
    keep(&mut window, "judged")?;

    let mut window = open("tower", Theme::Light)?;
    choose(&mut window, "Technique", "stencil")?;
    click(&mut window, "Volumes")?;
    click(&mut window, "Silhouette")?;
    keep(&mut window, "volumes")?;

    let mut window = open("industry", Theme::Dark)?;
    click(&mut window, "On façades, too")?;
    click(&mut window, "Find the hours")?;
    keep(&mut window, "facades")?;

    let mut window = open("industry", Theme::Dark)?;
    write(&mut window, "Clock", "17:30")?;
    let model = window.get_by_label("Model").rect();
    let point = model.center() + eframe::egui::vec2(-190.0, 190.0);
    window.hover_at(point);
    window.step();
    window.drag_at(point);
    window.step();
    window.drop_at(point);
    keep(&mut window, "dark")
}

fn sample(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(path)
}

fn open(name: &str, theme: Theme) -> Result<Harness<'static, App>> {
    let path = sample(name);
    let mut fault = None;
    let mut window = Harness::<App>::builder()
        .allow_missing_glyphs()
        .with_size([1280.0, 720.0])
        .with_theme(theme)
        .wgpu_setup(desktop::setup())
        .build_eframe(|cc| {
            App::new(cc, Some(&path)).map_err(|error| fault = Some(error.to_string())).expect("an adapter")
        });
    if let Some(fault) = fault {
        bail!(fault);
    }
    settle(&mut window)?;
    Ok(window)
}

fn settle(window: &mut Harness<'_, App>) -> Result<()> {
    let begun = Instant::now();
    let mut calm = 0;
    while calm < 3 {
        window.step();
        calm = if window.state().is_settled() { calm + 1 } else { 0 };
        if begun.elapsed() > Duration::from_secs(300) {
            bail!("the window does not come to rest");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

fn click(window: &mut Harness<'_, App>, label: &str) -> Result<()> {
    press(window, label)?;
    settle(window)
}

/// Clicks without waiting for the result.
fn press(window: &mut Harness<'_, App>, label: &str) -> Result<()> {
    window.query_by_label(label).ok_or_else(|| anyhow!("there is no {label}"))?.click();
    window.step();
    window.step();
    Ok(())
}

/// Enters a path in the window's own dialog, which is used if the system has none.
fn answer(window: &mut Harness<'_, App>, path: &Path) -> Result<()> {
    let begun = Instant::now();
    while window.query_by_role_and_label(Role::TextInput, "Path").is_none() {
        window.step();
        std::thread::sleep(Duration::from_millis(5));
        if begun.elapsed() > Duration::from_secs(20) {
            bail!("no dialog came");
        }
    }
    write(window, "Path", &path.display().to_string())
}

fn choose(window: &mut Harness<'_, App>, list: &str, entry: &str) -> Result<()> {
    window.get_by_role_and_label(Role::ComboBox, list).click();
    settle(window)?;
    // the entry may lie below the part of a long list that is seen
    window.query_by_label(entry).ok_or_else(|| anyhow!("there is no {entry}"))?.click_accesskit();
    window.step();
    settle(window)
}

fn write(window: &mut Harness<'_, App>, label: &str, text: &str) -> Result<()> {
    window.get_by_role_and_label(Role::TextInput, label).focus();
    window.step();
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.step();
    window.event(Event::Text(text.to_owned()));
    window.step();
    window.key_press(Key::Enter);
    window.step();
    settle(window)
}

/// Renders the window into a picture of the documentation.
fn keep(window: &mut Harness<'_, App>, name: &str) -> Result<()> {
    settle(window)?;
    window.remove_cursor();
    window.step();
    settle(window)?;
    let picture = window.render().map_err(|error| anyhow!(error))?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/pictures/window-{name}.png"));
    image::DynamicImage::ImageRgba8(picture).into_rgb8().save(&path)?;
    println!("{}", path.display());
    Ok(())
}
