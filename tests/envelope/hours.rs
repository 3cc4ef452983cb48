//! `gnomon envelope --hours`: given hours, without a rule.

use super::SITE;
use crate::shared::program::{PLACE, done, fails, site};
use serde_json::Value;
use std::fs::write;
use std::path::Path;

/// A lawn beside the window, and a wall of the tower's site that looks onto the plot from the east.
const MORE: &str = "
[[area]]
name = \"lawn\"
polygon = [[-6, 14], [6, 14], [6, 20], [-6, 20]]
";

/// The same nine hours as a rule of windows, and as one of areas.
fn rule(id: &str, receiver: &str) -> String {
    format!(
        "[rule]\nid = \"{id}\"\nname = \"{id}\"\nregion = \"here\"\nkind = \"guidance\"\nedition = \"1\"\nconfidence = \"M\"\n\
         [clock]\nkind = \"legal\"\n[[day]]\ndays = [\"03-21\"]\nwindows = [[\"07:00\", \"17:00\"]]\n\
         [receiver]\n{receiver}\n[count]\nwhat = \"sun\"\nhow = \"total\"\n[[pass]]\nat_least = \"9h\"\n"
    )
}

fn asked(path: &Path, arguments: &str) -> Value {
    serde_json::from_str(&done(path, &format!("{arguments} --json --quiet"))).unwrap()
}

/// What keeps nine hours by the envelope keeps them by a rule of nine hours, if the envelope is built.
#[test]
fn given_hours_are_kept_when_it_is_built() {
    let folder = site();
    let path = folder.path();
    write(path.join("site.toml"), format!("{PLACE}{SITE}{MORE}")).unwrap();
    write(path.join("windows.toml"), rule("windows", "kind = \"window\"\nat = \"middle-outside\"")).unwrap();
    write(path.join("areas.toml"), rule("areas", "kind = \"area\"")).unwrap();
    let days = "--from 07:00 --to 17:00";
    let json = asked(path, &format!("envelope . --hours 9 {days} --cell 1 --highest 50"));
    assert_eq!((&json["rule"], &json["hours_secs"], &json["options"]), (&Value::Null, &32_400.into(), &Value::Null));
    assert_eq!(json["days"][0]["windows"][0][1], "2026-03-21T17:00:00+01:00");
    let kept = json["kept"].as_array().unwrap();
    assert_eq!([&kept[0]["name"], &kept[1]["name"]], ["north", "lawn"]);
    let window = &kept[0]["places"][0]["days"];
    assert_eq!((&window[0]["date"], &window[0]["seconds"]), (&"2026-03-21".into(), &32_400.into()));
    assert!(window[1].is_null(), "the study has one day");
    assert!(kept[1]["places"].as_array().unwrap().len() > 20, "places all over the lawn");
    let glb =
        format!("{PLACE}{SITE}{MORE}").replace("tower.glb", "out/envelope.glb").replace("\"tower\"", "\"envelope\"");
    write(path.join("kept.toml"), &glb).unwrap();
    for rule in ["windows", "areas"] {
        let judged = asked(path, &format!("judge kept.toml --rule {rule}"));
        assert_eq!(judged["verdict"], "pass", "{rule}: {judged}");
    }
    // half a metre more on the whole is too much for the nearer one, the lawn
    let higher = glb.replace("[before]", "position = [0.0, 0.0, 0.5]\n[ground]\nlevel = 0.0\n[before]");
    write(path.join("higher.toml"), higher).unwrap();
    let judged = crate::shared::program::gnomon(path, "judge higher.toml --rule areas --quiet");
    assert_eq!(judged.status.code(), Some(1), "{}", String::from_utf8_lossy(&judged.stdout));
    let said = done(path, &format!("envelope . --hours 1h30 {days} --date 2026-06-21 --cell 1 --out again --quiet"));
    for word in ["2026-06-21", "keeps 1h30min of sun on each day, from 07:00 to 17:00", "by no rule"] {
        assert!(said.contains(word), "{word}: {said}");
    }
}

/// The hours are those of the study's own window, unless an option sets another.
#[test]
fn the_window_of_the_study_counts() {
    let folder = site();
    let path = folder.path();
    let study = SITE.replace("date = 2026-03-21", "from = \"2026-03-21T10:00\"\nto = \"14:00\"");
    write(path.join("site.toml"), format!("{PLACE}{study}")).unwrap();
    let json = asked(path, "envelope . --hours 4 --cell 1");
    assert_eq!(json["kept"][0]["places"][0]["days"][0]["seconds"], 4 * 3600);
    assert_eq!(json["kept"][0]["lacks"], false);
    // five hours are more than the window has
    let json = asked(path, "envelope . --hours 5 --cell 1 --out b");
    assert_eq!(json["kept"][0]["lacks"], true);
    assert_eq!(json["kept"][0]["places"][0]["days"][0]["seconds"], 4 * 3600);
    let json =
        asked(path, "envelope . --hours 1 --from-date 2026-03-21 --to-date 2026-03-23 --from 09:00 --cell 1 --out c");
    assert_eq!(json["kept"][0]["places"][0]["days"].as_array().unwrap().len(), 3);
}

#[test]
fn mistakes_about_hours_are_told() {
    let folder = site();
    let path = folder.path();
    write(path.join("site.toml"), format!("{PLACE}{SITE}")).unwrap();
    fails(path, "envelope . --quiet", 2, &["--rule ID", "--hours 2", "gnomon rules"]);
    fails(path, "envelope . --hours 2 --rule pl-wt-60", 2, &["--rule", "--hours"]);
    fails(path, "envelope . --rule pl-wt-60 --date 2026-03-21", 2, &["--date", "--hours"]);
    fails(path, "envelope . --hours 2 --set clock=legal", 2, &["--set", "--rule ID"]);
    for hours in ["0", "-1", "25", "two", "nan", "1e99"] {
        fails(path, &format!("envelope . --hours {hours}"), 2, &["--hours", "at most 24"]);
    }
    fails(path, "envelope . --hours 2 --from 10:00 --to 10:00", 2, &["--to"]);
    fails(path, "envelope . --hours 2 --from 22:00 --to 23:00 --quiet", 1, &["no sun", "--from"]);
    // the plot is smaller than a cell
    fails(path, "envelope . --hours 2 --cell 100 --quiet", 2, &["--cell", "on the plot", "smaller"]);
    // everything that lacks, in one line
    let bare = "[[model]]\npath = \"tower.glb\"\n[study]\ndate = 2026-03-21\n";
    write(path.join("site.toml"), format!("{PLACE}{bare}")).unwrap();
    let needs = [
        "--hours needs a window, an area or a façade",
        "the plot",
        "add [[window]], [[area]] or [[facade]] and [plot]",
    ];
    fails(path, "envelope . --hours 2 --quiet", 2, &needs);
    fails(
        path,
        "envelope . --rule pl-wt-60 --set clock=legal --quiet",
        2,
        &["a window; the plot", "[[window]] and [plot]"],
    );
    assert!(crate::shared::program::names(path.join("out")).is_empty(), "nothing is written");
}
