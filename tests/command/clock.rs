//! Every result says which time zone rules were used, and warns about years for which the rules are a guess.

use crate::shared::program::{done, fails, gnomon, names, site, stderr};
use gnomon::sun::ZoneRules;
use serde_json::Value;
use std::path::Path;

fn version() -> String {
    ZoneRules::newest().version().to_string()
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// The JSON chunk of a binary glTF file.
fn extras(path: &Path) -> Value {
    let file = gltf::Gltf::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let extras = file.default_scene().unwrap().extras().as_ref().map(|extras| extras.get().to_owned());
    json(&extras.expect("extras"))
}

/// Every command whose hours depend on local time, with a plan so small that it is fast.
const COMMANDS: [&str; 8] = [
    "sun .",
    "shadow . --at 2100-07-01T12:00 --engine cpu --size 16",
    "profile . --engine cpu --size 16 --out plan",
    "profile . --receivers surfaces --engine cpu --patch-cell 5 --out faces",
    "compare . open.toml --engine cpu --size 16 --out pair",
    "animate . --engine cpu --size 16 --width 320 --out film",
    "volumes . --at 2100-07-01T12:00",
    "probe . --point 12,-3,4.5",
];

#[test]
fn far_years_are_noted_once_and_reports_name_the_rules() {
    let folder = site();
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap().replace("2026-09-18", "2100-07-01");
    std::fs::write(folder.path().join("site.toml"), &text).unwrap();
    std::fs::write(folder.path().join("open.toml"), text.replace("tower.glb", "open.glb")).unwrap();
    let note = format!(
        "2100 is more than a year after tz {}, whose rules are used for the clock of Europe/Paris; governments may have \
         changed them since",
        version()
    );
    for command in COMMANDS.iter().chain(&["verify . --size 16 --sun-samples 1 --step 2h"]) {
        let output = gnomon(folder.path(), &format!("{command} --json"));
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{command}: {told}");
        assert_eq!(told.matches(&format!("note: {note}")).count(), 1, "{command}: {told}");
        let report = json(&String::from_utf8(output.stdout).unwrap());
        assert_eq!(report["tz_version"], version(), "{command}");
        assert_eq!(report["notes"], Value::from(vec![note.clone()]), "{command}");
        if let Some(instants) = report["instants"].as_array() {
            assert!(instants.iter().all(|one| one["time"].as_str().unwrap().ends_with("+02:00")), "{command}");
        }
    }
    for file in ["volumes.glb", "faces/surfaces.glb"] {
        assert_eq!(extras(&folder.path().join(file))["tz_version"], version(), "{file}");
    }
    for file in ["plan/profile.json", "faces/profile.json", "pair/compare.json"] {
        let report = json(&std::fs::read_to_string(folder.path().join(file)).unwrap());
        assert_eq!(report["tz_version"], version(), "{file}");
    }
    assert_eq!(stderr(&gnomon(folder.path(), "sun . --quiet")), "");
    // an offset is nobody's to change
    let fixed = text.replace("[[model]]", "time_zone = \"Etc/GMT-2\"\n[[model]]");
    std::fs::write(folder.path().join("site.toml"), fixed).unwrap();
    assert_eq!(stderr(&gnomon(folder.path(), "sun .")), "");
}

#[test]
fn near_years_are_not_doubted_and_the_table_names_the_rules() {
    let folder = site();
    let output = gnomon(folder.path(), "sun .");
    assert_eq!(stderr(&output), "");
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.starts_with(&format!("Europe/Paris, tz {} ", version())), "{table}");
    assert_eq!(json(&done(folder.path(), "sun . --json"))["notes"], Value::Array(Vec::new()));
    // a long name moves head and rows alike
    let table =
        done(folder.path(), "sun tower.glb --place -54.8,-68.3 --date 2026-09-18 --from 10:00 --to 12:00 --step 1h");
    let mut lines = table.lines();
    let head = lines.next().unwrap();
    assert!(head.starts_with("America/Argentina/Ushuaia, tz "), "{table}");
    assert_eq!(lines.next().unwrap().chars().count(), head.chars().count(), "{table}");
    let probe = done(folder.path(), "probe . --point 12,-3,4.5");
    assert!(probe.trim_end().ends_with(&format!("clock: Europe/Paris, tz {}", version())), "{probe}");
    assert!(done(folder.path(), "--version").trim_end().ends_with(&format!("(tz {})", version())));
}

#[test]
fn zones_that_are_none_are_told_in_a_line() {
    let folder = site();
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    for (zone, words) in [
        ("+02:00", ["time_zone", "Etc/GMT-2", "has the opposite sign", "Europe/Paris"]),
        ("Munich", ["\"Munich\"", "[place]", "leave time_zone out", "Europe/Paris"]),
    ] {
        let named = text.replace("[[model]]", &format!("time_zone = \"{zone}\"\n[[model]]"));
        std::fs::write(folder.path().join("site.toml"), named).unwrap();
        fails(folder.path(), "sun .", 1, &words);
    }
    assert_eq!(names(folder.path().to_owned()), ["open.glb", "site.toml", "tower.glb"]);
}
