//! `gnomon judge`: verdicts, exit statuses, and what is told with them.

use crate::shared::program::{PLACE, fails, gnomon, site, stderr};
use serde_json::Value;
use std::path::Path;

const BRE: &str = "uk-bre-209-sun-on-ground";

/// A folder with a tower that was not there before, and a site with one area: before the tower's north side, where the sun
/// comes for little more than an hour, or far in the south.
fn judged(area: &str) -> tempfile::TempDir {
    let folder = site();
    let polygon = match area {
        "dark" => "[[-4, 5.2], [4, 5.2], [4, 6], [-4, 6]]",
        _ => "[[-20, -60], [20, -60], [20, -40], [-20, -40]]",
    };
    let text = format!(
        "{PLACE}[[model]]\npath = \"tower.glb\"\n\n[study]\ndate = 2026-03-21\n\n[before]\nabsent = [\"tower\"]\n\n\
         [[area]]\nname = \"court, {area}\"\npolygon = {polygon}\n"
    );
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    folder
}

fn answered(folder: &Path, arguments: &str, status: i32) -> String {
    let output = gnomon(folder, arguments);
    assert_eq!(output.status.code(), Some(status), "{arguments}: {}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn verdicts_are_exit_statuses() {
    let (light, dark) = (judged("light"), judged("dark"));
    let passes = answered(light.path(), &format!("judge . --rule {BRE} --quiet"), 0);
    assert!(passes.starts_with("pass: BRE BR 209"), "{passes}");
    let misses = answered(dark.path(), &format!("judge . --rule {BRE} --quiet"), 1);
    let says = [
        "fail: ",
        "court, dark",
        "tower",
        "check with your authority",
        "options: loss = both",
        "assumed: ",
        "known as S",
    ];
    for word in says {
        assert!(misses.contains(word), "{word}: {misses}");
    }
    let told = answered(dark.path(), "judge . --rule us-nyc-ceqr-shadows --quiet", 3);
    assert!(told.starts_with("report: "), "{told}");
}

#[test]
fn json_has_what_a_verdict_rests_on() {
    let folder = judged("dark");
    let text = answered(folder.path(), &format!("judge . --rule {BRE} --json --csv table.csv --quiet"), 1);
    let json: Value = serde_json::from_str(&text).unwrap();
    let keys = |of: &Value| of.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    for key in
        ["check_with_your_authority", "clock", "criteria", "days", "options", "receivers", "rule", "sun", "tz_version"]
    {
        assert!(keys(&json).contains(&key.to_owned()), "{key}");
    }
    assert_eq!(
        (&json["verdict"], &json["options"]["loss"], &json["year"]),
        (&"fail".into(), &"both".into(), &2026.into())
    );
    let receiver = &json["receivers"][0];
    assert_eq!((&receiver["kind"], &receiver["share_limit"]), (&"area".into(), &0.5.into()));
    let number = |key: &str| receiver[key].as_f64().unwrap_or_else(|| panic!("{key}: {receiver}"));
    assert!((number("share_margin") - (number("share") - 0.5)).abs() < 1e-12);
    assert_eq!(number("share_error_odds"), 1e-9);
    assert!(number("share_error") <= 0.001 && (number("share_before") - 1.0).abs() < 1e-9, "{receiver}");
    assert_eq!(receiver["takes"][0]["component"], "tower");
    // the point's seconds are those of its spells
    let secs =
        |spells: &Value| spells.as_array().unwrap().iter().map(|it| it["seconds"].as_i64().unwrap()).sum::<i64>();
    assert_eq!(secs(&receiver["spells"]), receiver["seconds_by_day"][0].as_i64().unwrap());
    assert_eq!(secs(&receiver["spells_before"]), receiver["seconds_before_by_day"][0].as_i64().unwrap());
    let table = std::fs::read_to_string(folder.path().join("table.csv")).unwrap();
    assert!(
        table.starts_with("name,kind,dwelling") && table.contains("\"court, dark\",area,,,,fail,,2026-03-21,"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 2);
}

#[test]
fn a_rule_beside_the_site_goes_first() {
    let folder = judged("dark");
    let text = gnomon::rules::built_in_text(BRE).unwrap().replace("\"2h\"", "\"1min\"");
    std::fs::write(folder.path().join(format!("{BRE}.toml")), text).unwrap();
    answered(folder.path(), &format!("judge . --rule {BRE} --quiet"), 0);
}

#[test]
fn wrong_use_is_one_line() {
    let folder = judged("dark");
    let at = folder.path();
    fails(at, "judge .", 2, &["--rule"]);
    fails(at, "judge . --rule uk-bre", 2, &["no rule `uk-bre`", BRE, "gnomon rules"]);
    fails(at, &format!("judge . --rule {BRE} --set loss"), 2, &["--set loss", "hours=2h"]);
    fails(at, &format!("judge . --rule {BRE} --set loss=none"), 2, &["loss", "both or either"]);
    fails(at, &format!("judge . --rule {BRE} --set los=both"), 2, &["no option `los`", "`loss`"]);
    fails(at, &format!("judge . --rule {BRE} --set loss=both --set loss=either"), 2, &["twice"]);
    fails(at, "judge . --rule au-nsw-adg-4a1", 2, &["`hours`", "--set NAME=VALUE"]);
    fails(at, &format!("judge . --rule {BRE} --csv table.txt"), 2, &["--csv", ".csv"]);
    // a date that no option sets
    let dateless = std::fs::read_to_string(at.join("site.toml")).unwrap().replace("date = 2026-03-21", "");
    std::fs::write(at.join("dateless.toml"), dateless).unwrap();
    let told = stderr(&gnomon(at, &format!("judge dateless.toml --rule {BRE}")));
    assert!(told.contains("[study] date") && told.contains("date = 2026-03-21") && !told.contains("--date"), "{told}");
    // all that the rule needs
    fails(at, "judge . --rule nl-tno-light --quiet", 2, &["nl-tno-light needs a window"]);
}
