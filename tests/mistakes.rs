//! The message for every mistake in a site file or an option: one line with the file, the key and a way out.

use crate::shared::program::fails;
use crate::site::{SITE, folder, load, some};
use gnomon::cli::Options;
use gnomon::formats::{Model, ReadOptions};
use gnomon::mesh::Part;
use gnomon::message::Worded;
use gnomon::site::file::SiteFile;
use gnomon::site::{Overrides, Site, load_sun};
use proptest::prelude::*;
use std::path::Path;

/// Expects an error in the site file with this message.
fn told(from: &str, to: &str, words: &[&str]) {
    assert!(SITE.contains(from), "{from}");
    let message = complaint(&SITE.replace(from, to), &Overrides::default());
    for word in words.iter().chain(&["site.toml"]) {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
}

/// The message of what must fail, in one line.
fn complaint(site: &str, asked: &Overrides) -> String {
    let message = load(site, asked).expect_err("a mistake").in_words(&Options);
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn mistakes_in_the_site_file_are_told() {
    told("latitude =", "latitud =", &["[place] latitud", "latitude in [place]"]);
    told("step =", "cell = 1\nstep =", &["[study] cell", "cell in [plan]"]);
    told("[study]", "[studdy]", &["[studdy]", "[study]"]);
    told("[place]", "latitude = 4\n[place]", &["latitude in [place]"]);
    told("[[model]]", "[model]", &["[[model]]"]);
    told("latitude = 48.8583", "latitude = \"48\"", &["[place] latitude", "a number", "latitude = 48.8583"]);
    told("latitude = 48.8583", "latitude = 98", &["[place]", "-90", "90"]);
    told("latitude = 48.8583", "latitude = nan", &["[place]", "NaN"]);
    told("latitude = 48.8583", "", &["latitude in [place]", "latitude = 48.8583"]);
    told("Europe/Paris", "Europe/Pari", &["Europe/Paris"]);
    told("2026-09-18", "2026-09-31", &["line 14 `date"]);
    told("2026-09-18", "\"2026-09-31\"", &["[study] date", "2026-09-31"]);
    told("2026-09-18", "18", &["[study] date", "date = 2026-09-18"]);
    told("\"10:00\"", "\"ten\"", &["[study] from", "\"ten\"", "10:00"]);
    told("\"14:00\"", "\"10:00\"", &["[study] to", "empty"]);
    told("\"30min\"", "\"30\"", &["[study] step", "30min"]);
    told("\"30min\"", "\"0s\"", &["[study] step", "30min"]);
    told("\"30min\"", "\"30min\"\ntechnique = \"ray\"", &["[study] technique", "ray-cast"]);
    told("tower.glb", "towr.glb", &["[[model]] path", "towr.glb"]);
    told("path = \"tower.glb\"", "", &["path in [[model]]", "tower.glb"]);
    told("casts = [\"iron\"]", "casts = 1", &["[[model]] casts", "true, false or a list"]);
    told("casts = [\"iron\"]", "scale = 0", &["[[model]] scale", "above 0"]);
    told("casts = [\"iron\"]", "scale = inf", &["[[model]] scale"]);
    told("casts = [\"iron\"]", "north = nan", &["[[model]] north"]);
    told("casts = [\"iron\"]", "position = [1, 2]", &["[[model]] position", "length 3"]);
    told("casts = [\"iron\"]", "position = [1, 2, nan]", &["[[model]] position"]);
    told("[study]", "[ground]\nlevel = inf\n[study]", &["[ground] level"]);
    told("[study]", "[plan]\nregion = [3, 0, 3, 9]\n[study]", &["[plan] region", "west 3", "east 3"]);
    told("[study]", "[plan]\nregion = [0, 9, 3, 9]\n[study]", &["[plan] region", "south 9", "north 9"]);
    told("[study]", "[plan]\nregion = [0, nan, 3, 9]\n[study]", &["[plan] region"]);
    told("[study]", "[plan]\ncell = 0\n[study]", &["[plan] cell", "above 0"]);
    told("[study]", "[plan]\ncell = -1\n[study]", &["[plan] cell", "above 0"]);
    told("[study]", "[plan]\ncell = 0.0001\n[study]", &["[plan] cell", "at least"]);
    told("[study]", "[camera]\nfov = 171\n[study]", &["[camera] fov", "170"]);
    told("[study]", "[camera]\nup = [0, 0, 0]\n[study]", &["[camera] up"]);
    told("[study]", "[camera]\neye = [1, 2, 3]\ntarget = [1, 2, 3]\n[study]", &["[camera] eye"]);
    told("[study]", "[camera]\neye = [1, 2, 30]\ntarget = [1, 2, 3]\n[study]", &["[camera] up", "no direction is up"]);
    told("[study]", "[[[", &["line 13"]);
}

/// TOML makes another letter of a backslash and the one behind it, or refuses both.
#[test]
fn backslashes_in_paths_are_told() {
    let path = "path = \"tower.glb\"";
    told(
        path,
        r#"path = "models\tower.glb""#,
        &["[[model]] path", r"models\tower.glb", "a tab", "write /", "single quotes"],
    );
    told(path, r#"path = "C:\new\tower.glb""#, &["[[model]] path", "a line break", "write /", "single quotes"]);
    told(path, r#"path = "models\hall.glb""#, &["line 10", "backslash", "write /", "single quotes"]);
    told(path, r#"path = "C:\Users\hall.glb""#, &["line 10", "backslash", "single quotes"]);
    told(path, r"path = 'models\tower.glb'", &["[[model]] path", r"models\tower.glb", "write / between folders"]);
}

#[test]
fn other_encodings_are_told() {
    let wide = |order: fn(u16) -> [u8; 2]| SITE.encode_utf16().flat_map(order).collect::<Vec<u8>>();
    let marked = |mark: [u8; 2], order: fn(u16) -> [u8; 2]| [&mark[..], &wide(order)].concat();
    let latin: Vec<u8> =
        SITE.replace("Champ de Mars, Paris", "Pré").chars().map(|letter| letter as u32 as u8).collect();
    let of = |bytes: &[u8]| {
        let folder = folder("");
        std::fs::write(folder.path().join("site.toml"), bytes).unwrap();
        let message = load_sun(folder.path(), &Overrides::default()).expect_err("a mistake").to_string();
        assert!(message.contains("site.toml") && !message.contains('\n'), "{message}");
        message
    };
    for bytes in [
        marked([0xFF, 0xFE], u16::to_le_bytes),
        marked([0xFE, 0xFF], u16::to_be_bytes),
        wide(u16::to_le_bytes),
        wide(u16::to_be_bytes),
    ] {
        let message = of(&bytes);
        assert!(message.contains("UTF-16") && message.contains("save it as UTF-8"), "{message}");
    }
    let message = of(&latin);
    assert!(["line 3", "Latin-1", "save it as UTF-8"].iter().all(|word| message.contains(word)), "{message}");
    assert!(of(b"PK\x03\x04\x00\xE9\xFA\x10").contains("it is not text"));
    // a mark before UTF-8 is none of these
    let folder = folder(&format!("\u{feff}{SITE}"));
    assert!(load_sun(folder.path(), &Overrides::default()).is_ok());
}

#[test]
fn missing_tables_are_told() {
    let none = complaint("", &Overrides::default());
    assert!(none.contains("[place]") && none.contains("latitude = 48.8583"), "{none}");
    let models = &SITE[..SITE.find("[[model]]").unwrap()];
    let study = &SITE[SITE.find("[study]").unwrap()..];
    let no_model = complaint(&format!("{models}{study}"), &Overrides::default());
    assert!(no_model.contains("[[model]]"), "{no_model}");
    let no_study = complaint(&SITE[..SITE.find("[study]").unwrap()], &Overrides::default());
    assert!(no_study.contains("--date 2026-03-21 --from 9:00 --to 17:00 --step 1h"), "{no_study}");
    told("step = \"30min\"", "", &["step of the study", "--step 1h"]);
    let empty = |_: &Path, _: &ReadOptions| Ok(Model { parts: vec![Part::default()], ..Model::default() });
    let site = SITE.replace("casts = [\"iron\"]", "");
    let message = Site::load_with(folder(&site).path(), &Overrides::default(), empty).expect_err("nothing").to_string();
    assert!(message.contains("no triangles"), "{message}");
}

#[test]
fn wrong_options_are_wrong_use() {
    let wrong = |asked: Overrides, word: &str| {
        let error = load(SITE, &asked).expect_err("a mistake");
        assert!(error.is_wrong_use(), "{error}");
        assert!(error.in_words(&Options).contains(word), "{error}");
    };
    let none = Overrides::default;
    wrong(Overrides { place: Some([48.0, 2.0]), ..none() }, "--place");
    wrong(Overrides { from: some("2026-03-29T02:30"), ..none() }, "2026-03-29T03:30+02:00");
    wrong(Overrides { date: some("2026-10-25"), to: some("02:30"), from: some("1:00"), ..none() }, "--to");
    wrong(Overrides { step_secs: Some(0), ..none() }, "--step");
    wrong(Overrides { at: some("2026-09-18T15:00"), step_secs: Some(3600), ..none() }, "--step");
    wrong(Overrides { at: some("2026-09-18T15:00"), date: some("2026-09-19"), ..none() }, "two dates");
    wrong(Overrides { region: Some([1.0, 2.0, f64::NAN, 4.0]), ..none() }, "--region");
    wrong(Overrides { region: Some([3.0, 2.0, 1.0, 4.0]), ..none() }, "west 3");
    wrong(Overrides { cell: Some(f64::NAN), ..none() }, "--cell");
    wrong(Overrides { cell: Some(1e-9), ..none() }, "at least");
    wrong(Overrides { cell: Some(1.0), size: Some(1), ..none() }, "--cell");
    wrong(Overrides { size: Some(0), ..none() }, "--size");
    wrong(Overrides { size: Some(u32::MAX), ..none() }, "2³¹");
}

/// Options are read before anything else, and errors about them name the option.
#[test]
fn values_that_cannot_be_read_name_their_option() {
    let folder = folder(SITE);
    for (command, option, value, word) in [
        ("sun", "--place", "Vienna", "\"Vienna\" is not a place"),
        ("sun", "--place", "98,16", "latitude 98 is not between -90 and 90 degrees"),
        ("sun", "--date", "soon", "soon"),
        ("sun", "--from-date", "soon", "soon"),
        ("sun", "--to-date", "soon", "soon"),
        ("sun", "--from", "25:00", "25:00"),
        ("sun", "--to", "25:00", "25:00"),
        ("sun", "--step", "soon", "soon"),
        ("sun", "--at", "noonish", "noonish"),
        ("volumes", "--at", "noonish", "noonish"),
        ("shadow --at 12:00", "--date", "soon", "soon"),
        ("profile", "--resolution", "soon", "\"soon\" is not a resolution"),
        ("profile", "--region", "1,2,3", "\"1,2,3\" is not 4 numbers with commas between them"),
        ("profile", "--region", "1,2,3,x", "write for example --region -300,-300,300,300"),
        ("probe", "--point", "1,2", "write for example --point 12,-3,4.5"),
        ("probe --point 1,2,3", "--normal", "up", "write for example --normal 0,-1,0"),
        ("probe --point 1,2,3", "--from", "soon", "soon"),
    ] {
        fails(folder.path(), &format!("{command} . {option} {value}"), 2, &[&format!("{option}: "), word]);
    }
}

#[test]
fn unknown_names_are_told() {
    told("[\"iron\"]", "[\"irn\"]", &["[[model]] casts", "\"irn\"", "\"iron\""]);
    let two = SITE.replace("[study]", "[[model]]\npath = \"tower.glb\"\nreceives = [\"gras\"]\n[study]");
    let message = complaint(&two, &Overrides::default());
    assert!(message.contains("[[model]] number 2 receives") && message.contains("\"grass\""), "{message}");
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC{0,40}", keys in "(\\[(place|model|study)\\]\n|(path|from|casts) = [0-9\"\\[a-z.:-]{0,6}\n){0,6}") {
        let _ = SiteFile::parse("site.toml", &text);
        let _ = SiteFile::parse("site.toml", &keys);
    }
}
