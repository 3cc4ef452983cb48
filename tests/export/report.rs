//! The reports' keys and words.

use super::synthetic::{self, Town};
use gnomon::choice::Receivers;
use gnomon::export::report::{self, ReportContext};
use gnomon::message::PlainWords;
use gnomon::profile::{Profile, Timings};
use gnomon::site::Ground;
use gnomon::sun::Polar;
use serde_json::Value;

/// The keys of a JSON object in the order of the text.
fn keys(text: &str, indent: usize) -> Vec<&str> {
    let start = format!("{}\"", " ".repeat(indent));
    text.lines().filter_map(|line| line.strip_prefix(&start)?.split_once("\":").map(|(key, _)| key)).collect()
}

#[test]
fn profile_json_is_the_contract() {
    let town = Town::new(1.0, 32_400, 61_200, 1800);
    let grid = synthetic::grid(8, 4, 0.5);
    let profile: Profile = Profile { grid, shaded: vec![0_u32; 32].into(), day_secs: 28_800, night_secs: 0 };
    let timings = Timings(vec![("load", 0.5), ("draw", 1.5), ("total", 2.25)]);
    let write = |town: &Town| {
        let (receivers, drawn, notes) =
            (Receivers::Ground, &town.drawn, &["hut.glb leaves something out".to_owned().into()]);
        let ground = Ground::asked(0.0);
        let told =
            ReportContext { receivers, ground, drawn, timings: &timings, statistics: None, notes, words: &PlainWords };
        report::profile_json(&profile, &town.place, &town.track, &told).unwrap()
    };
    let text = write(&town);
    let contract = [
        "gnomon",
        "place",
        "region",
        "cell",
        "width",
        "height",
        "receivers",
        "ground",
        "ground_from",
        "models_below_ground_m",
        "technique",
        "silhouette",
        "engine",
        "adapter",
        "resolution_secs",
        "between_instants",
        "refraction",
        "delta_t_secs",
        "instants",
        "days",
        "timings_secs",
    ];
    let ours = [
        "map_size",
        "pcf",
        "smoothie_width",
        "sun_samples",
        "refraction_celsius",
        "refraction_millibar",
        "algorithm",
        "delta_t_source",
        "notes",
        "tz_version",
    ];
    let mut found = keys(&text, 2);
    found.retain(|key| !ours.contains(key));
    assert_eq!(found, contract);

    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["notes"], serde_json::json!(["hut.glb leaves something out"]));
    assert_eq!(json["gnomon"], env!("CARGO_PKG_VERSION"));
    assert_eq!(json["place"]["time_zone"], "Europe/Vienna");
    assert_eq!(json["place"].as_object().unwrap().len(), 5);
    assert_eq!(json["region"], serde_json::json!([-2.0, -1.0, 2.0, 1.0]));
    assert_eq!((&json["receivers"], &json["engine"]), (&"ground".into(), &"gpu".into()));
    let first = &json["instants"][0];
    assert_eq!(first["time"], "2026-09-18T09:00:00+02:00");
    assert_eq!((&first["weight_secs"], &first["night"]), (&900.into(), &false.into()));
    assert_eq!(first.as_object().unwrap().len(), 5);
    assert_eq!(json["days"][0]["sunset"], "2026-09-18T19:00:00+02:00");
    assert_eq!(keys(&text[text.find("timings_secs").unwrap()..], 4), ["load", "draw", "total"]);
    // The standard atmosphere at 171 m, from its published table between 100 m and 200 m: 1001.3 and 989.5 hPa.
    let millibar = json["refraction_millibar"].as_f64().unwrap();
    assert!((millibar - 992.9).abs() < 0.2, "{millibar}");

    let mut town = town;
    town.drawn.finder = None;
    town.drawn.adapter = None;
    town.track.refraction = false;
    let json: Value = serde_json::from_str(&write(&town)).unwrap();
    for key in ["silhouette", "adapter", "refraction_celsius"] {
        assert!(json[key].is_null() && json.as_object().unwrap().contains_key(key), "{key}");
    }
}

#[test]
fn sun_json_has_the_same_parts() {
    let town = Town::new(1.0, 32_400, 61_200, 3600);
    let text = report::sun_json(&town.place, &town.track, &[], &PlainWords).unwrap();
    assert_eq!(keys(&text, 2), ["place", "tz_version", "instants", "days", "notes"]);
}

#[test]
fn the_table_says_night_and_polar_days() {
    let mut town = Town::new(1.0, 4 * 3600, 16 * 3600, 6 * 3600);
    let table = report::sun_table(&town.place, &town.track);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 1 + 3 + 1 + 1 + 1, "{table}");
    assert!(lines[1].contains("04:00:00+02:00") && lines[1].ends_with("night"), "{table}");
    assert!(lines[2].ends_with("21600"), "{table}");
    assert!(lines[6].contains("06:40:00") && lines[6].contains("12:48:00"), "{table}");

    (town.track.days[0].sunrise, town.track.days[0].sunset) = (None, None);
    town.track.days[0].polar = Some(Polar::Night);
    let table = report::sun_table(&town.place, &town.track);
    assert!(table.ends_with("-  the sun stays down\n"), "{table}");
    town.track.days[0].polar = Some(Polar::Day);
    assert!(report::sun_table(&town.place, &town.track).ends_with("-  the sun stays up\n"));
}
