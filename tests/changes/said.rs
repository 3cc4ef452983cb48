//! The options for times of change, and the messages about them.

use super::{sample, secs};
use crate::shared::program::{done, fails, gnomon, site, stderr};
use gnomon::choice::{Engine, Method, Settings};
use gnomon::cli::Options;
use gnomon::message::Worded;
use gnomon::site::{Overrides, Site};
use gnomon::study::{Event, TiledStudy, Wants};
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::Path;

#[test]
fn the_resolution_is_a_minute_or_what_is_asked() {
    let found = |step: &str, resolution: Option<&str>| {
        let asked =
            Overrides { step_secs: secs(step), resolution_secs: resolution.and_then(secs), ..Overrides::default() };
        sample("tower", asked).track.resolution_secs
    };
    let asked = [("1h", None), ("30s", None), ("1h", Some("10s")), ("1h", Some("1h")), ("1h", Some("step"))];
    assert_eq!(asked.map(|(step, resolution)| found(step, resolution)), [60, 30, 10, 3600, 0]);
    let at = Overrides { at: "2026-09-18T12:00".parse().ok(), ..Overrides::default() };
    assert_eq!(sample("tower", at).track.resolution_secs, 0);
}

#[test]
fn what_is_no_resolution_is_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/tower");
    let refused = |asked: Overrides| Site::load(&folder, &asked).unwrap_err().in_words(&Options);
    let error = refused(Overrides { step_secs: secs("1h"), resolution_secs: secs("2h"), ..Overrides::default() });
    assert!(error.contains("--resolution") && error.contains("step for the instants alone"), "{error}");
    let written = site();
    for option in ["soon", "0s", "", "2h"].map(|text| format!("--resolution={text}")) {
        let words = ["--resolution", "step for the instants alone"];
        fails(written.path(), &format!("profile . --step 1h {option}"), 2, &words);
    }
    let at = "12:00".parse().ok();
    let error = refused(Overrides { at, resolution_secs: secs("1min"), ..Overrides::default() });
    assert!(error.contains("--resolution") && error.contains("--at"), "{error}");
}

#[test]
fn it_is_said_with_the_hours() {
    let folder = site();
    let at = folder.path();
    let profile = "profile . --engine cpu --size 40 --step 1h --write json";
    let json = |more: &str| serde_json::from_str::<Value>(&done(at, &format!("{profile} {more} --json"))).unwrap();
    let said = |json: &Value| (json["resolution_secs"].clone(), json["between_instants"].clone());
    let found = "changes found to 1 min; ";
    let to_a_minute = format!("{found}above the ground light or shade shorter than 1 h may be missed");
    assert_eq!(said(&json("")), (60.into(), to_a_minute.clone().into()));
    // drawn at every moment, and searched ray by ray
    let missed = [("--receivers ground", "1 min"), ("--technique ray-cast", "1 h")];
    for (more, shortest) in missed {
        let words = format!("{found}light or shade shorter than {shortest} may be missed");
        assert_eq!(said(&json(more)), (60.into(), words.into()), "{more}");
    }
    let alone = "counted at instants 1 h apart, and not between them";
    assert_eq!(said(&json("--resolution step")), (0.into(), alone.into()));
    assert_eq!(said(&json("--resolution 1h")), (3600.into(), Value::Null));
    let soft = json("--technique ray-cast --sun-samples 2");
    assert_eq!(said(&soft), (0.into(), alone.into()));
    assert!(done(at, profile).contains(&to_a_minute));
    assert!(done(at, &format!("{profile} --resolution step")).contains(alone));
    fails(at, &format!("{profile} --resolution 2h"), 2, &["--resolution", "longer than the step"]);
    let told = stderr(&gnomon(at, &format!("{profile} --technique ray-cast --sun-samples 2")));
    assert!(told.contains("from the instants alone") && told.contains("--resolution step"), "{told}");
    let plain = stderr(&gnomon(at, &format!("{profile} --resolution step --technique ray-cast --sun-samples 2")));
    assert!(!plain.contains("instants alone"), "{plain}");
}

#[test]
fn another_resolution_is_another_study_and_inexact_techniques_have_none() {
    let number = |resolution: &str, change: fn(&mut Site)| {
        let asked = Overrides {
            step_secs: secs("1h"),
            resolution_secs: secs(resolution),
            size: Some(40),
            ..Overrides::default()
        };
        let mut site = sample("tower", asked);
        change(&mut site);
        let mut notes = 0;
        let study = TiledStudy::new(&site, &Wants::default(), &mut |event| {
            notes += usize::from(matches!(event, Event::Note(note) if note.to_string().contains("instants alone")));
            ControlFlow::Continue(())
        });
        (study.unwrap().number(), notes)
    };
    let exact = |site: &mut Site| site.engine = Engine::Cpu;
    let minute = number("1min", exact);
    assert_eq!(minute, number("1min", exact));
    assert_ne!(minute.0, number("10s", exact).0);
    assert_ne!(minute.0, number("step", exact).0);
    assert_eq!((minute.1, number("step", exact).1), (0, 0));
    let soft = |site: &mut Site| {
        (site.engine, site.method) = (Engine::Cpu, Method::RayCast);
        site.settings = Settings { sun_samples: Some(2), ..Settings::NONE };
    };
    let map = |site: &mut Site| site.method = Method::ShadowMap;
    for change in [soft, map] {
        let (found, notes) = number("1min", change);
        assert_eq!((found, notes, 0), (number("step", change).0, 1, number("step", change).1));
    }
}
