//! The position of the eye, overlays over the picture, and what can be shown instead of sun and shadow.

use super::exporting::{answer, menu};
use super::*;
use glam::DVec3;
use gnomon::export::figure;
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, InstantWants};
use gnomon::view::{Elevation, View};
use std::ops::ControlFlow;

fn view(harness: &Harness<'_, App>) -> View {
    harness.state().picture_view().expect("a picture").0
}

fn side(harness: &Harness<'_, App>) -> Elevation {
    match view(harness) {
        View::Elevation(side) => side,
        other => panic!("{other:?}"),
    }
}

/// The point in the readout, metres.
fn readout(harness: &Harness<'_, App>) -> DVec3 {
    let text = named(harness, " up, m").0.replace('−', "-");
    let said = text.rsplit("    ").next().unwrap_or_default().to_owned();
    let number = |unit: &str| -> f64 {
        let before = said.split(unit).next().unwrap_or_default();
        before.split_whitespace().last().and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{said}"))
    };
    DVec3::new(number(" E"), number(" N"), number(" up"))
}

fn hover(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.hover_at(at);
    harness.run_steps(3);
}

#[test]
fn point_under_the_pointer_stays() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    for key in [Key::Num1, Key::Num2] {
        harness.key_press(key);
        harness.step();
        settle(&mut harness);
        let at = harness.get_by_label("Model").rect().left_bottom() + egui::vec2(150.0, -80.0);
        hover(&mut harness, at);
        let before = readout(&harness);
        harness.event(Event::Zoom(2.0));
        harness.step();
        settle(&mut harness);
        hover(&mut harness, at + egui::vec2(1.0, 0.0));
        hover(&mut harness, at);
        let after = readout(&harness);
        assert!(before.distance(after) < 0.15, "{key:?}: {before}, then {after}");
        // and the hand takes it along, in the plan to the pixel
        if key == Key::Num2 {
            let to = at + egui::vec2(60.0, -40.0);
            drag(&mut harness, at, to);
            settle(&mut harness);
            hover(&mut harness, to + egui::vec2(1.0, 0.0));
            hover(&mut harness, to);
            let after = readout(&harness);
            assert!(before.truncate().distance(after.truncate()) < 0.15, "{before}, then {after}");
        }
    }
}

#[test]
fn elevations_look_level_from_their_side() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    for (key, name, from) in [
        (Key::Num3, "From north", DVec3::Y),
        (Key::Num4, "From east", DVec3::X),
        (Key::Num5, "From south", DVec3::NEG_Y),
        (Key::Num6, "From west", DVec3::NEG_X),
    ] {
        harness.key_press(key);
        harness.step();
        harness.key_press(Key::F);
        harness.step();
        settle(&mut harness);
        let by_key = side(&harness);
        assert_eq!(by_key.to_viewer, from, "{name}");
        // parallel: whatever the depth, a point of the picture is as far east or north and as high as the scale says
        let rect = harness.get_by_label("Model").rect();
        let metres = by_key.cell * f64::from(by_key.height) / f64::from(rect.height());
        let mut read = 0;
        for step in (-4..=4).flat_map(|x| (0..9).map(move |y| egui::vec2(x as f32 * 45.0, y as f32 * 20.0))) {
            hover(&mut harness, rect.center() + step);
            // between buildings there is the sky
            if harness.query_by_label_contains(" up, m").is_none() {
                continue;
            }
            read += 1;
            let off = readout(&harness) - by_key.target;
            let [right, up, _] = by_key.axes();
            let is = (off.dot(right) / metres, -off.dot(up) / metres);
            let wanted = (f64::from(step.x), f64::from(step.y));
            let near = 0.1 / metres + 0.5;
            assert!((is.0 - wanted.0).abs() < near && (is.1 - wanted.1).abs() < near, "{name}: {is:?}, not {wanted:?}");
        }
        assert!(read > 8, "{name}: {read} points of the model");
        harness.key_press(Key::Num1);
        harness.step();
        settle(&mut harness);
        click(&mut harness, "View");
        harness.get_by_label_contains(name).click_accesskit();
        harness.run_steps(2);
        settle(&mut harness);
        assert_eq!(side(&harness), by_key, "{name}");
        harness.key_press(Key::Escape);
        harness.run_steps(2);
    }
}

#[test]
fn north_and_scale_are_named() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.key_press(Key::Num2);
    harness.step();
    settle(&mut harness);
    let model = harness.get_by_label("Model").rect();
    assert!(model.contains_rect(harness.get_by_label("North arrow").rect()));
    let View::Plan(grid) = view(&harness) else { panic!("no plan") };
    let metres_a_point = grid.cell * f64::from(grid.width) / f64::from(model.width());
    let mut bar = |unit: &str, metres: f64| {
        let (name, rect) = named(&harness, "Scale bar: ");
        let said = name.strip_prefix("Scale bar: ").and_then(|said| said.strip_suffix(unit));
        let length: f64 = said.unwrap_or_else(|| panic!("{name}")).trim().parse().expect("a length");
        let drawn = f64::from(rect.width()) * metres_a_point / metres;
        assert!((drawn / length - 1.0).abs() < 0.01, "{name} is {drawn} long");
        click(&mut harness, "View");
        click(&mut harness, "Lengths in feet");
        harness.key_press(Key::Escape);
        harness.run_steps(2);
    };
    bar(" m", 1.0);
    bar(" ft", 0.3048);
}

fn choose(harness: &mut Harness<'_, App>, list: &str, entry: &str) {
    harness.get_by_role_and_label(egui::Role::ComboBox, list).click();
    harness.run_steps(2);
    // wherever the list is scrolled to
    harness.get_by_label(entry).click_accesskit();
    harness.step();
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    harness.step();
    settle(harness);
}

#[test]
fn diagrams_and_the_disc_are_seen() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    choose(&mut harness, "Technique", "hybrid");
    let plain = harness.state().picture().unwrap().2;
    choose(&mut harness, "Picture of", "who decides a cell");
    let mask = harness.state().picture().unwrap().2;
    choose(&mut harness, "Picture of", "volumes counted");
    let counted = harness.state().picture().unwrap().2;
    assert_eq!(harness.state().picture_provenance().map(|drawn| drawn.technique.word()), Some("hybrid"));
    assert!(plain != mask && mask != counted && counted != plain, "three pictures");
    choose(&mut harness, "Technique", "ray-cast");
    let hard = harness.state().picture().unwrap().2;
    assert_eq!(harness.state().picture_provenance().map(|drawn| drawn.technique.word()), Some("ray-cast"));
    click(&mut harness, "The sun as a disc: soft edges");
    settle(&mut harness);
    let soft = harness.state().picture().unwrap().2;
    let changed = hard.iter().zip(&soft).filter(|(a, b)| a != b).count();
    assert!(changed > 100 && changed * 4 < hard.len(), "{changed} of {} pixels, those at edges", hard.len());
}

/// A side first shows everything: the models fill it, with the ground low in the picture. Showing everything does not
/// change other views.
#[test]
fn side_is_fitted_and_no_other_stand() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let mesh = Site::load(&site, &Overrides::default()).unwrap().mesh;
    let (low, high) = mesh.bounds().unwrap();
    let View::Camera(camera) = view(&harness) else { panic!("a camera") };
    let stand = |harness: &mut Harness<'_, App>, key| {
        harness.key_press(key);
        harness.step();
        settle(harness);
        view(harness)
    };
    let plan = stand(&mut harness, Key::Num2);
    for key in [Key::Num3, Key::Num4, Key::Num5, Key::Num6] {
        stand(&mut harness, key);
        let side = side(&harness);
        let [right, _, _] = side.axes();
        let half = side.half_size();
        let middle = (low + high) / 2.0 - side.target;
        let reach = (high - low).dot(right.abs()) / 2.0 / half.x + (middle.dot(right) / half.x).abs();
        // 0 is the foot of the picture and 1 its head
        let share = |z: f64| (z - side.target.z) / half.y * 0.5 + 0.5;
        let (ground, roof) = (share(0.0), share(high.z));
        assert!(reach <= 0.98 && roof <= 0.95, "{key:?}: all is seen, {reach}, {roof}");
        assert!(reach >= 0.8 || roof >= 0.8, "{key:?}: it fills the picture, {reach}, {roof}");
        assert!((0.1..0.25).contains(&ground), "{key:?}: the ground lies low, {ground}");
        // moved and shown whole again it is the same
        let at = harness.get_by_label("Model").rect().center();
        drag(&mut harness, at, at + egui::vec2(90.0, -30.0));
        settle(&mut harness);
        assert!(view(&harness) != View::Elevation(side), "{key:?}: a hand moves it");
        assert_eq!(stand(&mut harness, Key::F), View::Elevation(side), "{key:?}");
    }
    assert_eq!(stand(&mut harness, Key::Num1), View::Camera(camera), "the perspective has moved");
    assert_eq!(stand(&mut harness, Key::Num2), plan, "the plan has moved");
}

/// The sheet of a side shows at least as much as the window.
#[test]
fn exported_side_is_that_of_the_window() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.key_press(Key::Num5);
    harness.step();
    settle(&mut harness);
    let shown = side(&harness);
    menu(&mut harness, "Export the drawing…");
    let ours = folder.path().join("window.png");
    answer(&mut harness, &ours, "Write");
    let at = Overrides { at: "2026-03-21T13:00".parse().ok(), ..Overrides::default() };
    let site = Site::load(&site, &at).unwrap();
    let (width, height) = (site.camera.width, site.camera.height);
    let half = shown.half_size() * 2.0;
    let cell = (half.x / f64::from(width)).max(half.y / f64::from(height));
    let drawn = |cell: f64| {
        let view = View::Elevation(Elevation { cell, width, height, ..shown });
        let wants = InstantWants { surface: true, ..InstantWants::default() };
        let outcome = study::instant(&site, view, &wants, &mut |_| ControlFlow::Continue(())).unwrap();
        let (place, track, receivers) = (&site.place, &site.track, study::judged(&site, &view));
        let (mesh, surface, drawn) = (&outcome.surface_mesh, outcome.surface.as_ref().unwrap(), &outcome.drawn);
        let scene = figure::FigureContext { place, track, mesh, surface, receivers, ground: site.ground, drawn };
        figure::instant(&scene, &view, &outcome.mask, &figure::PictureExtras::default()).unwrap()
    };
    let [ours, right, near, far] = [std::fs::read(ours).unwrap(), drawn(cell), drawn(cell * 0.98), drawn(cell * 1.02)]
        .map(|bytes| image::load_from_memory(&bytes).unwrap().into_rgb8());
    // the picture in the window has whole pixels
    let differ = |other: &image::RgbImage| ours.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count();
    let [right, near, far] = [&right, &near, &far].map(differ);
    assert!(right * 3 < near.min(far), "{right} pixels are others, and {near} or {far} at another scale");
}
