//! What the app remembers from one start to the next.

use super::*;
use crate::desktop::exporting::menu;
use std::collections::HashMap;

/// eframe's storage, in memory.
#[derive(Clone, Default)]
struct Store(HashMap<String, String>);

impl eframe::Storage for Store {
    fn get_string(&self, key: &str) -> Option<String> {
        self.0.get(key).cloned()
    }

    fn set_string(&mut self, key: &str, value: String) {
        self.0.insert(key.to_owned(), value);
    }

    fn remove_string(&mut self, key: &str) {
        self.0.remove(key);
    }

    fn flush(&mut self) {}
}

/// The key under which eframe keeps what egui remembers.
const EGUI: &str = "egui";

/// Closes a window as eframe does.
fn close(mut harness: Harness<'static, App>) -> Store {
    let mut store = Store::default();
    eframe::App::save(harness.state_mut(), &mut store);
    assert!(eframe::App::persist_egui_memory(harness.state()));
    harness.ctx.memory(|memory| eframe::set_value(&mut store, EGUI, memory));
    store
}

/// Opens it again as eframe does: first egui's memory, then the app. Returns the resulting theme.
fn again(store: Store) -> (Harness<'static, App>, egui::ThemePreference) {
    let store: &'static Store = Box::leak(Box::new(store));
    let mut theme = egui::ThemePreference::System;
    let builder = Harness::<App>::builder().with_size([1280.0, 720.0]).wgpu_setup(desktop::setup());
    let mut harness = builder.build_eframe(|cc| {
        cc.storage = Some(store);
        if let Some(memory) = eframe::get_value(store, EGUI) {
            cc.egui_ctx.memory_mut(|now| *now = memory);
        }
        let app = App::new(cc, None).expect("an adapter");
        // the harness has a theme of its own afterwards
        theme = cc.egui_ctx.options(|options| options.theme_preference);
        app
    });
    settle(&mut harness);
    (harness, theme)
}

#[test]
fn files_units_theme_and_scale_are_kept() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "View");
    click(&mut harness, "Lengths in feet");
    if harness.query_by_label("Dark").is_none() {
        click(&mut harness, "View");
    }
    click(&mut harness, "Dark");
    if harness.query_by_label("The sun's path").is_none() {
        click(&mut harness, "View");
    }
    click(&mut harness, "The sun's path");
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    let left = |harness: &Harness<'_, App>| harness.get_by_label("Model").rect().left();
    let edge = egui::pos2(left(&harness) - 2.0, 300.0);
    drag(&mut harness, edge, egui::pos2(390.0, 300.0));
    harness.run_steps(2);
    assert!((left(&harness) - 390.0).abs() < 3.0, "{}", left(&harness));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Plus);
    harness.step();
    harness.step();
    let scale = harness.ctx.zoom_factor();
    assert!(scale > 1.05, "{scale}");
    let (mut harness, theme) = again(close(harness));
    assert_eq!(harness.ctx.zoom_factor(), scale);
    assert_eq!(theme, egui::ThemePreference::Dark);
    // a fresh start knows none of it
    let (fresh, theme) = again(Store::default());
    assert_eq!(fresh.ctx.zoom_factor(), 1.0);
    assert!(theme != egui::ThemePreference::Dark);
    drop(fresh);
    // the file that was open is in the list, by the name of its folder, and opens from there
    let name = folder.path().file_name().unwrap().to_string_lossy().into_owned();
    menu(&mut harness, "Open again");
    click(&mut harness, &name);
    settle(&mut harness);
    harness.get_by_label("Works");
    let bar = named(&harness, "Scale bar: ").0;
    assert!(bar.ends_with(" ft"), "{bar}");
    assert!(harness.query_by_label("The sun: drag it along its day").is_none(), "the sun's path was not shown");
    assert!((left(&harness) - 390.0).abs() < 3.0, "the panel is as wide as it was: {}", left(&harness));
}

/// By the menu and by keys; a second menu entry brings it back.
#[test]
fn interface_has_a_scale() {
    let mut harness = window(None);
    let scale = |harness: &Harness<'_, App>| harness.ctx.zoom_factor();
    for (key, wanted) in [(Key::Plus, 1.1), (Key::Plus, 1.2), (Key::Minus, 1.1), (Key::Num0, 1.0)] {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, key);
        harness.step();
        harness.step();
        assert!((scale(&harness) - wanted).abs() < 1e-6, "{key:?}: {}", scale(&harness));
    }
    for (entry, wanted) in [("Larger interface", 1.1), ("Interface at its own size", 1.0), ("Smaller interface", 0.9)] {
        click(&mut harness, "View");
        harness.get_by_label_contains("Interface at 1");
        harness.get_by_label_contains(entry).click_accesskit();
        harness.step();
        harness.step();
        assert!((scale(&harness) - wanted).abs() < 1e-6, "{entry}: {}", scale(&harness));
        harness.key_press(Key::Escape);
        harness.step();
        harness.step();
    }
}
