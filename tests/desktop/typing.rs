//! Numbers, degrees, dates and times as people type them, and errors beside their fields.

use super::*;

/// Whether the window contains this text, also as a part of another.
fn says(harness: &Harness<'_, App>, text: &str) -> bool {
    harness.query_by_label_contains(text).is_some()
}

#[test]
fn decimal_comma_is_a_decimal_point_in_every_number() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    enter(&mut harness, "scale", "0,001");
    assert_eq!(harness.state().site_file().model[0].scale, Some(0.001));
    enter(&mut harness, "scale", "0,5");
    assert_eq!(harness.state().site_file().model[0].scale, Some(0.5));
    enter(&mut harness, "Model north", "12,5");
    assert_eq!(harness.state().site_file().model[0].north, Some(12.5));
    let place = |harness: &Harness<'_, App>| harness.state().site_file().place.clone().unwrap();
    enter(&mut harness, "Elevation", "1.234,5");
    assert_eq!(place(&harness).elevation, Some(1234.5));
    enter(&mut harness, "Latitude", "48,25");
    assert_eq!(place(&harness).latitude, Some(48.25));
    click(&mut harness, "View");
    click(&mut harness, "Lengths in feet");
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    enter(&mut harness, "Elevation", "0,5");
    assert_eq!(place(&harness).elevation, Some(0.152));
    // what cannot be is no more taken than what cannot be read, and the field says what counts
    for (label, text, told) in [
        ("scale", "0", "0 is not between 0.000001 and 1000000 metres per unit"),
        ("scale", "1,2,3", "\"1,2,3\" is not a number; write for example 0.5 or 0,5"),
        ("Elevation", "high", "\"high\" is not a number"),
        ("Model north", "400", "400 is not between −360 and 360 degrees"),
    ] {
        enter(&mut harness, label, text);
        assert!(says(&harness, told), "{label}: {text}");
    }
    let model = &harness.state().site_file().model[0];
    assert_eq!((model.scale, model.north), (Some(0.5), Some(12.5)));
    assert_eq!(place(&harness).elevation, Some(0.152));
    // the next number that can be read takes the words away
    enter(&mut harness, "scale", "2");
    assert!(!says(&harness, "\"1,2,3\" is not a number"), "the scale was mended");
}

/// A field that is entered and left keeps its value, including decimals that it does not show.
#[test]
fn field_that_is_left_alone_keeps_all_its_decimals() {
    let (_folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    std::fs::write(&site, text.replace("latitude = 48.2\n", "latitude = 48.208174123\n")).unwrap();
    let mut harness = window(Some(&site));
    harness.get_by_role_and_label(egui::Role::SpinButton, "Latitude").focus();
    harness.run_steps(3);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(harness.state().site_file().place.clone().unwrap().latitude, Some(48.208174123));
}

#[test]
fn degrees_are_read_and_a_pasted_place_fills_both_fields() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let place = |harness: &Harness<'_, App>| {
        let place = harness.state().site_file().place.clone().unwrap();
        [place.latitude.unwrap(), place.longitude.unwrap()]
    };
    for (label, text, wanted) in [
        ("Latitude", "48°12'30\" N", [48.0 + 12.5 / 60.0, 16.37]),
        ("Longitude", "70°30′ W", [48.0 + 12.5 / 60.0, -70.5]),
        ("Latitude", "-33.86, 151.2", [-33.86, 151.2]),
        ("Longitude", "48.2082° N, 16.3738° E", [48.2082, 16.3738]),
        ("Latitude", "59,33; 18,07", [59.33, 18.07]),
    ] {
        enter(&mut harness, label, text);
        let read = place(&harness);
        assert!((0..2).all(|at| (read[at] - wanted[at]).abs() < 1e-9), "{text}: {read:?}");
    }
    harness.get_by_label_contains("Europe/Stockholm");
    let before = place(&harness);
    for (label, text, told) in [
        ("Latitude", "98", "latitude 98 is not between −90 and 90 degrees"),
        ("Latitude", "98, 16", "latitude 98 is not between −90 and 90 degrees"),
        ("Longitude", "east", "\"east\" is not a longitude; write degrees"),
    ] {
        enter(&mut harness, label, text);
        assert!(says(&harness, told), "{text}");
        let (_, field) = named(&harness, told);
        let below = harness.get_by_role_and_label(egui::Role::SpinButton, label).rect().bottom();
        assert!((0.0..20.0).contains(&(field.top() - below)), "below its field: {field:?}, {below}");
    }
    assert_eq!(place(&harness), before);
    // undo brings back another value, and the words of this one go
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.step();
    settle(&mut harness);
    assert!(!says(&harness, "is not between −90"));
}

#[test]
fn dates_and_times_are_read_and_written_as_the_site_file_says_them() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    for (label, text) in [("Window", "9"), ("to", "4.30 pm"), ("Study date", "21.12.2026"), ("step", "0,5 h")] {
        write(&mut harness, label, text);
        settle(&mut harness);
    }
    let study = |harness: &Harness<'_, App>| {
        let study = harness.state().site_file().study.clone();
        [study.from, study.to, study.date].map(|text| text.unwrap().0).into_iter().chain(study.step).collect::<Vec<_>>()
    };
    let wanted = ["9:00", "16:30", "2026-12-21", "30min"];
    assert_eq!(study(&harness), wanted);
    for (label, text, told) in [
        ("Window", "25", "\"25\" is not a time; write 16:30, 16.30, 4 pm, sunrise or sunset-1h30"),
        ("to", "24:00", "a day has no 24 o'clock; write 0:00 for its end"),
        ("Study date", "05/06/2026", "can be 5 June 2026 or 6 May 2026; write 2026-06-05 or 2026-05-06"),
        ("step", "30", "\"30\" is not a step; write 30min, 1h, 1h30 or 90s"),
    ] {
        write(&mut harness, label, text);
        settle(&mut harness);
        assert!(says(&harness, told), "{label}: {text}");
    }
    assert_eq!(study(&harness), wanted, "what is refused changes nothing");
    assert_eq!(value(&harness, "Study date"), "2026-12-21", "the field says what counts");
    // the instant that is shown
    write(&mut harness, "Date", "21/6/2026");
    write(&mut harness, "Clock", "16.30");
    settle(&mut harness);
    assert_eq!((value(&harness, "Date"), value(&harness, "Clock")), ("2026-06-21".into(), "16:30".into()));
    write(&mut harness, "Date", "5/6/2026");
    settle(&mut harness);
    assert!(says(&harness, "\"5/6/2026\" can be 5 June 2026 or 6 May 2026"));
    assert_eq!(value(&harness, "Date"), "2026-06-21");
    write(&mut harness, "Clock", "17");
    settle(&mut harness);
    assert_eq!(value(&harness, "Clock"), "17:00");
}

/// Errors about an invalid study use the panel's labels, not the keys of a site file or options of the command.
#[test]
fn what_is_wrong_with_a_study_is_told_by_the_labels() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let set = |harness: &mut Harness<'_, App>, label: &str, text: &str| {
        write(harness, label, text);
        settle(harness);
        harness.state().fault_and_notice()[0].map(str::to_owned)
    };
    let told = set(&mut harness, "to", "9:00").expect("nothing from nine to nine");
    let wanted = "Window, to: the window from 9:00 to 9:00 is empty; give a later `\"to\"`";
    assert!(told.starts_with(wanted), "{told}");
    assert!(says(&harness, "give a later \"to\", or for a whole day"), "no accents stand in the window");
    let told = set(&mut harness, "to", " ").expect("no end");
    assert!(told.ends_with("site.toml does not say \"to\" of the study"), "{told}");
    assert_eq!(set(&mut harness, "to", "17:00"), None);
}

/// Errors about what a technique cannot do use the panel's labels.
#[test]
fn what_a_technique_cannot_do_is_told_by_the_labels() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.get_by_role_and_label(egui::Role::ComboBox, "Technique").click();
    harness.run_steps(2);
    harness.get_by_label("soft-texture").click();
    harness.step();
    settle(&mut harness);
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    let told = harness.state().fault_and_notice()[0].expect("it draws no plan").to_owned();
    assert!(told.starts_with("Technique: soft-texture ") && !told.contains("--"), "{told}");
}

/// Unreadable text keeps the dialog open, with the text and the reason.
#[test]
fn dialog_stays_open_over_what_cannot_be_read() {
    let mut harness = window(None);
    drop_file(&mut harness, &sample("industry/industry.glb"));
    let go = |harness: &mut Harness<'_, App>| {
        click(harness, "Open it there");
        settle(harness);
    };
    write(&mut harness, "Latitude, longitude", "Vienna");
    settle(&mut harness);
    assert!(says(&harness, "\"Vienna\" is not a place; write latitude and longitude in degrees"));
    assert_eq!(value(&harness, "Latitude, longitude"), "Vienna");
    write(&mut harness, "Latitude, longitude", "98, 16.37");
    settle(&mut harness);
    assert!(says(&harness, "latitude 98 is not between −90 and 90 degrees"));
    write(&mut harness, "Model north", "up");
    write(&mut harness, "Latitude, longitude", "48,2; 16,37");
    settle(&mut harness);
    assert!(says(&harness, "\"up\" is not a number"), "the north cannot be read");
    assert!(!says(&harness, "is not a place"), "the place was mended");
    write(&mut harness, "Model north", "22,5°");
    go(&mut harness);
    let site = harness.state().site_file();
    let place = site.place.clone().expect("it is open");
    assert_eq!((place.latitude, place.longitude, site.model[0].north), (Some(48.2), Some(16.37), Some(22.5)));
}
