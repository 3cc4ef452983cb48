//! The picture: its time, its techniques, its views.

use super::*;
use egui::Pos2;
use gnomon::export::figure::ground_tones;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::view::{Mask, Surface, View};

/// How many ground pixels of the picture contradict the mask, and how many pixels of each tone there are.
fn wrong(pixels: &[[u8; 4]], surface: &Surface, mask: &Mask, tones: [[u8; 3]; 2]) -> (usize, [usize; 2]) {
    let near = |pixel: &[u8; 4], tone: [u8; 3]| (0..3).all(|at| pixel[at].abs_diff(tone[at]) <= 2);
    let (mut wrong, mut counts) = (0, [0, 0]);
    for (cell, pixel) in pixels.iter().enumerate().filter(|(cell, _)| surface.face[*cell] == Surface::GROUND) {
        let shade = usize::from(mask.share[cell] == 0);
        if near(pixel, tones[shade]) {
            counts[shade] += 1;
        } else if near(pixel, tones[1 - shade]) {
            wrong += 1;
        }
    }
    (wrong, counts)
}

/// The window shows the engine's mask in the colours of a drawing.
#[test]
fn picture_is_the_engines_mask() {
    let path = sample("industry");
    let mut harness = window(Some(&path));
    write(&mut harness, "Clock", "16:00");
    settle(&mut harness);
    let (view, to_sun) = harness.state().picture_view().expect("a picture");
    let (width, height, pixels) = harness.state().picture().unwrap();
    assert_eq!(view.size(), (width, height));
    let site = Site::load(&path, &Overrides::default()).unwrap();
    let scene = Scene {
        casters: site.mesh.of_components(&site.casts),
        receivers: site.mesh.of_components(&site.receives),
        ground: site.ground.level,
    };
    let mut cast = RayCast::new(scene, view, None);
    let mut mask = cast.draw(to_sun).unwrap().read().unwrap();
    let surface = cast.surface().unwrap();
    let tones = ground_tones(to_sun);
    let (faults, [lit, shaded]) = wrong(&pixels, &surface, &mask, tones);
    assert!(lit > 10_000 && shaded > 2_000, "{lit} pixels in the sun and {shaded} in shadow");
    assert!(faults * 10_000 <= lit + shaded, "{faults} of {} pixels are wrong", lit + shaded);
    // a single wrong cell is seen
    let cell =
        surface.face.iter().zip(&pixels).position(|(face, pixel)| {
            *face == Surface::GROUND && (0..3).all(|at| pixel[at].abs_diff(tones[0][at]) <= 2)
        });
    let cell = cell.expect("a cell in the sun");
    mask.share[cell] = 255 - mask.share[cell];
    assert_eq!(wrong(&pixels, &surface, &mask, tones).0, faults + 1);
}

#[test]
fn time_is_dragged_typed_and_stepped() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.get_by_label("Time of day: 13:00");
    // by keys on the slider
    harness.get_by_label("Time of day: 13:00").focus();
    harness.step();
    harness.key_press(Key::ArrowRight);
    harness.step();
    harness.step();
    harness.get_by_label("Time of day: 13:05");
    // by the pointer, to the middle of the day's rail
    let rect = harness.get_by_label("Time of day: 13:05").rect();
    drag(&mut harness, Pos2::new(rect.left() + 100.0, rect.center().y), rect.center());
    harness.get_by_label("Time of day: 12:00");
    // by typing, and what is no time is told
    write(&mut harness, "Clock", "25:00");
    harness.get_by_label_contains("25:00");
    assert_eq!(value(&harness, "Clock"), "12:00");
    write(&mut harness, "Date", "2026-12-21");
    write(&mut harness, "Clock", "9:00");
    settle(&mut harness);
    harness.get_by_label("Day of the year: 21 December");
    harness.get_by_label_contains("(UTC+01:00)");
    // what `gnomon sun` prints for that time
    let at = Overrides { at: "2026-12-21T9:00".parse().ok(), ..Overrides::default() };
    let track = gnomon::site::load_sun(&site, &at).unwrap().track;
    harness.get_by_label(&format!("azimuth {:.1}°", track.instants[0].azimuth_deg()));
    harness.get_by_label(&format!("altitude {:.1}°", track.instants[0].altitude_deg()));
    // and its events, to the nearest minute
    for (date, utc) in [("2026-12-21", 1), ("2026-03-02", 1), ("2026-07-11", 2)] {
        write(&mut harness, "Date", date);
        let day = Overrides { at: format!("{date}T12:00").parse().ok(), ..Overrides::default() };
        let track = gnomon::site::load_sun(&site, &day).unwrap().track;
        let events = [track.days[0].sunrise, track.days[0].noon, track.days[0].sunset];
        for (event, name) in events.into_iter().zip(["sunrise", "noon", "sunset"]) {
            let secs = event.unwrap().timestamp() + utc * 3600;
            let minutes = (secs as f64 / 60.0).round() as i64 % 1440;
            harness.get_by_label(&format!("{name} {:02}:{:02}", minutes / 60, minutes % 60));
        }
    }
    write(&mut harness, "Date", "2026-06-21");
    harness.step();
    let clock = format!("(UTC+02:00, daylight saving), tz {}", gnomon::sun::ZoneRules::newest().version());
    harness.get_by_label_contains(&clock);
    // years for which the clock is a guess are told of
    assert!(harness.query_by_label_contains("governments may").is_none());
    write(&mut harness, "Date", "2100-06-21");
    harness.step();
    harness.get_by_label_contains("governments may have changed them since");
    harness.get_by_label_contains(&clock);
    write(&mut harness, "Date", "2026-06-21");
    harness.step();
    write(&mut harness, "Clock", "23:30");
    settle(&mut harness);
    harness.get_by_label("night");
    let (_, to_sun) = harness.state().picture_view().unwrap();
    assert!(to_sun.z < 0.0);
    // keys that go to no slider: an hour on, and play
    harness.get_by_label("Clock").focus();
    harness.key_press(Key::Escape);
    harness.step();
    click(&mut harness, "Play the day");
    harness.run_steps(3);
    assert!(harness.query_by_label("Time of day: 23:30").is_none(), "time goes on");
    click(&mut harness, "Play the day");
}

#[test]
fn techniques_are_chosen_and_said() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    for (word, technique) in
        [("stencil", "stencil"), ("hybrid", "hybrid"), ("smoothie", "smoothie"), ("shadow-map", "shadow-map")]
    {
        harness.get_by_role_and_label(egui::Role::ComboBox, "Technique").click();
        harness.step();
        harness.step();
        harness.get_by_label(word).click();
        harness.step();
        settle(&mut harness);
        assert_eq!(harness.state().picture_provenance().map(|drawn| drawn.technique.word()), Some(technique));
    }
    // volumes and silhouette lie over the picture
    let before = harness.state().picture().unwrap();
    click(&mut harness, "Volumes");
    settle(&mut harness);
    let yellow = harness.state().picture().unwrap();
    assert!(before.2 != yellow.2, "volumes are seen");
    click(&mut harness, "Silhouette");
    settle(&mut harness);
    assert!(yellow.2 != harness.state().picture().unwrap().2, "lines are seen");
}

#[test]
fn eye_turns_comes_nearer_and_stands_elsewhere() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let camera = |harness: &Harness<'_, App>| match harness.state().picture_view() {
        Some((View::Camera(camera), _)) => camera,
        other => panic!("a camera, not {other:?}"),
    };
    let first = camera(&harness);
    let rect = harness.get_by_label("Model").rect();
    let corner = rect.left_bottom() + egui::vec2(120.0, -60.0);
    drag(&mut harness, corner, corner + egui::vec2(80.0, 0.0));
    settle(&mut harness);
    let turned = camera(&harness);
    let [near, far] = [turned.target.distance(first.target), turned.eye.distance(first.eye)];
    assert!(near < 1e-6 && far > 1.0, "the eye turns around the target: {near}, {far}");
    // nearer about the pointer: what lies under it stays there
    harness.hover_at(corner);
    harness.step();
    harness.event(egui::Event::Zoom(2.0));
    harness.step();
    settle(&mut harness);
    let nearer = camera(&harness);
    let lengths = [&turned, &nearer].map(|camera| camera.eye.distance(camera.target));
    assert!((lengths[0] / lengths[1] - 2.0).abs() < 1e-6, "{lengths:?}");
    assert!(nearer.target.distance(turned.target) > 1.0, "zoom is about the pointer");
    for (key, is_plan) in [(Key::Num2, true), (Key::Num5, false), (Key::Num1, false)] {
        harness.key_press(key);
        harness.step();
        settle(&mut harness);
        assert_eq!(matches!(harness.state().picture_view(), Some((View::Plan(_), _))), is_plan);
    }
    harness.key_press(Key::F);
    harness.step();
    settle(&mut harness);
    assert_ne!(camera(&harness), nearer);
}

#[test]
fn sun_is_dragged_along_its_day() {
    let mut harness = window(Some(&sample("headquarters")));
    let sun = harness.get_by_label("The sun: drag it along its day").rect().center();
    // westwards along the arc, which from here goes to the left
    drag(&mut harness, sun, sun - egui::vec2(110.0, -10.0));
    settle(&mut harness);
    let later = harness.query_by_label("Time of day: 13:00").is_none();
    assert!(later, "the time follows the sun");
    let azimuth =
        harness.state().picture_view().map(|(_, to_sun)| to_sun.x.atan2(to_sun.y).to_degrees().rem_euclid(360.0));
    assert!(azimuth.is_some_and(|azimuth| azimuth > 200.0), "{azimuth:?}");
}

/// A component that is switched off casts no shadow any more, and is named in the site file.
#[test]
fn components_are_switched() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let before = harness.state().picture().unwrap();
    click(&mut harness, "Components");
    let loaded = Site::load(&site, &Overrides::default()).unwrap();
    let name = loaded.mesh.components[0].name.clone();
    click(&mut harness, &format!("{name} casts"));
    settle(&mut harness);
    assert!(before.2 != harness.state().picture().unwrap().2, "a shadow is gone");
    let gnomon::site::file::Names::Some(casts) = harness.state().site_file().model[0].casts.clone() else {
        panic!("some cast, not all")
    };
    assert_eq!(casts.len(), loaded.mesh.components.len() - 1);
    assert!(!casts.contains(&name));
    let switched = harness.state().picture().unwrap();
    click(&mut harness, "In their own colours");
    settle(&mut harness);
    assert!(switched.2 != harness.state().picture().unwrap().2, "colours are seen");
}
