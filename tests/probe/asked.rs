//! Probes on the command line and in the site file's `[[probe]]`.

use crate::shared::program::{PLACE, done, fails, site};
use serde_json::{Value, json};

const PROBES: &str = "
[[model]]
path = \"tower.glb\"

[[probe]]
name = \"window, \\\"north\\\"\"
point = [0, 20, 1.5]
normal = [0, -2, 0]

[[probe]]
point = [0.0, -30.0, 1.5]
";

/// A folder with a tower, and a site with two probes.
fn probes() -> tempfile::TempDir {
    let folder = site();
    let text = format!("{PLACE}{PROBES}[study]\ndate = 2026-03-21\n");
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    folder
}

fn keys(of: &Value) -> Vec<&str> {
    of.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn json_has_these_keys() {
    let folder = probes();
    let json: Value = serde_json::from_str(&done(folder.path(), "probe . --json --quiet")).unwrap();
    let head = ["gnomon", "ground", "ground_from", "models_below_ground_m", "notes", "place", "probes", "refraction"];
    assert_eq!(keys(&json), [&head[..], &["shortest_found_secs", "tz_version"]].concat());
    assert_eq!((&json["shortest_found_secs"], &json["place"]["name"]), (&1.into(), &"Paris".into()));
    let [window, free] = json["probes"].as_array().unwrap().as_slice() else { panic!("{json}") };
    assert_eq!(keys(window), ["below_ground_m", "days", "longest_seconds", "name", "normal", "point", "seconds"]);
    assert_eq!((&window["name"], &window["normal"]), (&"window, \"north\"".into(), &json!([0.0, -1.0, 0.0])));
    assert_eq!(
        (&free["name"], &free["normal"], &free["point"]),
        (&"probe 2".into(), &Value::Null, &json!([0.0, -30.0, 1.5]))
    );
    let day = &window["days"][0];
    assert_eq!(keys(day), ["date", "intervals", "longest_seconds", "seconds", "sunrise", "sunset"]);
    assert_eq!((&day["date"], &day["seconds"]), (&"2026-03-21".into(), &window["seconds"]));
    let intervals = day["intervals"].as_array().unwrap();
    assert_eq!(keys(&intervals[0]), ["blocked_after", "blocked_before", "end", "seconds", "start"]);
    let seconds = |of: &Value| of["seconds"].as_i64().unwrap();
    assert_eq!(intervals.iter().map(seconds).sum::<i64>(), seconds(window));
    assert_eq!(intervals.iter().map(seconds).max(), window["longest_seconds"].as_i64());
    // the tower stands in the south of the window at noon
    let blocked: Vec<_> = intervals.iter().flat_map(|it| [&it["blocked_before"], &it["blocked_after"]]).collect();
    assert_eq!(blocked, ["behind", "tower", "tower", "behind"]);
    let plain: Value = serde_json::from_str(&done(folder.path(), "probe . --json --no-refraction")).unwrap();
    assert_eq!((&plain["refraction"], &plain["shortest_found_secs"]), (&false.into(), &1.into()));
    assert!(seconds(&plain["probes"][1]) < seconds(free), "air bends the sun up");
}

#[test]
fn csv_has_a_line_an_interval() {
    let folder = probes();
    let options = "--from-date 2026-03-20 --to-date 2026-03-21 --from 11:00 --to 14:00 --quiet --json";
    let json: Value =
        serde_json::from_str(&done(folder.path(), &format!("probe . {options} --csv a/sun.csv"))).unwrap();
    let text = std::fs::read_to_string(folder.path().join("a/sun.csv")).unwrap();
    let mut expected = "probe,start,end,seconds,blocked_before,blocked_after\r\n".to_owned();
    for (probe, name) in json["probes"].as_array().unwrap().iter().zip(["\"window, \"\"north\"\"\"", "probe 2"]) {
        for interval in probe["days"].as_array().unwrap().iter().flat_map(|day| day["intervals"].as_array().unwrap()) {
            let [start, end, before, after] =
                ["start", "end", "blocked_before", "blocked_after"].map(|key| interval[key].as_str().unwrap());
            expected += &format!("{name},{start},{end},{},{before},{after}\r\n", interval["seconds"]);
        }
    }
    assert_eq!(text, expected);
    // the free one sees the sun all the while, and clock readings carry their offset
    let free = "probe 2,2026-03-20T11:00:00+01:00,2026-03-20T14:00:00+01:00,10800,window,window\r\n";
    assert!(text.contains(free), "{text}");
    assert_eq!(text.lines().count(), 1 + 2 * 3);
}

#[test]
fn text_tells_intervals_or_days_and_a_drawing_is_made() {
    let folder = probes();
    let said = done(folder.path(), "probe . --out day.png --quiet");
    for word in [
        "blocked before",
        "tower",
        "behind",
        "at (0, 20, 1.5), facing south",
        "free on all sides",
        "day.png",
        "of sun in 2 intervals",
    ] {
        assert!(said.contains(word), "{said}");
    }
    let said = done(folder.path(), "probe . --from-date 2026-03-01 --to-date 2026-03-31 --out a/range.png --quiet");
    for word in ["in 31 days", "2026-03-29", "least on", "most on", "To the second, nothing left out"] {
        assert!(said.contains(word), "{said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 130), "{said}");
    for name in ["day.png", "a/range.png"] {
        let picture = image::open(folder.path().join(name)).unwrap().into_rgb8();
        let count = |colour: [u8; 3]| picture.pixels().filter(|pixel| pixel.0 == colour).count();
        let [sun, shade, night] = [[250, 218, 128], [140, 152, 173], [62, 70, 88]].map(count);
        assert!(sun > 100_000 && shade > 50_000 && night > 50_000, "{name}: {sun} {shade} {night}");
    }
    let one = done(folder.path(), "probe tower.glb --place 48.8583,2.2945 --point 0,-30,1 --date 2026-06-21 --quiet");
    assert!(one.contains("point: at (0, -30, 1)") && one.contains("2026-06-21"), "{one}");
    // the study's window is not the probe's, and the file's probes step back before the command line's
    let study = done(folder.path(), "probe . --point 0,-30,1 --normal 0,0,1 --quiet");
    assert!(study.contains("horizon") && study.contains("facing upwards") && !study.contains("probe 2"), "{study}");
}

#[test]
fn points_of_a_table_are_probed() {
    let folder = probes();
    let path = folder.path();
    let table =
        "\u{feff}name,x,y,z,nx,ny,nz\r\n\"window, \"\"north\"\"\",0,20,1.5,0,-2,0\r\n\r\n , 0.0, -30.0, 1.5,,,\r\n";
    std::fs::write(path.join("points.csv"), table).unwrap();
    let probed = |asked: &str| -> Value { serde_json::from_str(&done(path, asked)).unwrap() };
    let own = probed("probe . --json --quiet");
    let mut of_table = probed("probe . --points points.csv --json --quiet --totals a/totals.csv");
    assert_eq!(of_table["probes"][1]["name"], "point 2");
    of_table["probes"][1]["name"] = "probe 2".into();
    assert_eq!(own["probes"], of_table["probes"]);
    let totals = std::fs::read_to_string(path.join("a/totals.csv")).unwrap();
    assert_eq!(totals.lines().count(), 1 + 2 * 3);
    let [seconds, longest] = ["seconds", "longest_seconds"].map(|key| &own["probes"][1][key]);
    for (unit, date) in [("day", "2026-03-21"), ("month", "2026-03"), ("year", "2026")] {
        let line = format!("point 2,{unit},{date},1,{seconds},{longest},");
        assert!(totals.contains(&line), "{line}: {totals}");
    }
    let free = "name,x,y,z\nfree,1,2,3";
    std::fs::write(path.join("free.csv"), free).unwrap();
    assert_eq!(probed("probe . --points free.csv --json --quiet")["probes"][0]["normal"], Value::Null);
    for (text, words) in [
        ("", &["line 1", "name,x,y,z,nx,ny,nz"][..]),
        ("name,x,y\na,1,2", &["line 1", "columns"]),
        ("name,x,y,z\na,1,2", &["line 2", "3 fields and 4 columns"]),
        ("name,x,y,z\na,1,2,3\n\nb,1,inf,3", &["line 4", "y is \"inf\""]),
        ("name,x,y,z\n\"a,1,2,3", &["line 2", "quote"]),
        ("name,x,y,z\na,1,2,3\na,1,2,3", &["line 3", "\"a\"", "own name"]),
        ("name,x,y,z,nx,ny,nz\na,1,2,3,0,0,0", &["line 2", "no direction"]),
        ("name,x,y,z,nx,ny,nz\na,1,2,3,0,1,", &["line 2", "nz is \"\""]),
        ("name,x,y,z\n", &["has no point"]),
    ] {
        std::fs::write(path.join("wrong.csv"), text).unwrap();
        let status = if words[0] == "has no point" { 2 } else { 1 };
        fails(path, "probe . --points wrong.csv", status, words);
    }
    fails(path, "probe . --points none.csv", 1, &["none.csv"]);
    fails(path, "probe . --points free.csv --point 1,2,3", 2, &["--points", "--point", "leave one"]);
    fails(path, "probe . --points free.csv --totals free.csv", 2, &["free.csv"]);
}

#[test]
fn points_are_laid_on_components() {
    let folder = probes();
    let path = folder.path();
    let probed = |asked: &str| -> Value { serde_json::from_str(&done(path, asked)).unwrap() };
    // a row around the tower of 10 x 10 m
    let row = probed("probe . --on tower --spacing 2 --height 5 --json --quiet");
    let laid = row["probes"].as_array().unwrap();
    assert_eq!(laid.len(), 4 * 5, "{row}");
    for probe in laid {
        let [x, y, z] = [0, 1, 2].map(|axis| probe["point"][axis].as_f64().unwrap());
        let [nx, ny, nz] = [0, 1, 2].map(|axis| probe["normal"][axis].as_f64().unwrap());
        let away = (x.abs().max(y.abs()) - 5.0).abs();
        assert!(away < 1e-6 && (z - 5.0).abs() < 1e-6 && nz.abs() < 1e-9, "{probe}");
        assert!((x * nx + y * ny - 5.0).abs() < 1e-6, "it looks outwards: {probe}");
    }
    let south: Vec<_> = laid.iter().filter(|probe| probe["normal"][1].as_f64().unwrap() < -0.5).collect();
    let mut along: Vec<f64> = south.iter().map(|probe| probe["point"][0].as_f64().unwrap().round()).collect();
    along.sort_by(f64::total_cmp);
    assert_eq!(along, [-4.0, -2.0, 0.0, 2.0, 4.0]);
    // one in the middle of its largest faces
    let one = probed("probe . --on tower --json --quiet");
    let [point] = one["probes"].as_array().unwrap().as_slice() else { panic!("{one}") };
    assert_eq!(point["name"], "tower");
    assert!((point["point"][2].as_f64().unwrap() - 10.0).abs() < 1e-6, "{point}");
    let text =
        done(path, "probe . --on tower --spacing 1 --height 5 --from-date 2026-03-01 --to-date 2026-03-02 --quiet");
    assert!(text.contains("40 probes, 2 days") && text.contains("tower 40"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 130), "{text}");
    fails(path, "probe . --on towr", 2, &["--on", "\"towr\"", "\"tower\""]);
    fails(path, "probe . --spacing 2", 2, &["--spacing", "--on"]);
    fails(path, "probe . --on tower --spacing 2", 2, &["--spacing", "--height"]);
    fails(path, "probe . --on tower --height 2", 2, &["--height", "--spacing"]);
    fails(path, "probe . --on tower --spacing 0 --height 2", 2, &["--spacing", "0.01"]);
    fails(path, "probe . --on tower --spacing 1 --height 99", 2, &["--on", "no face"]);
    fails(
        path,
        "probe . --on tower --spacing 0.01 --height 5 --from-date 2020-01-01 --to-date 2029-12-31",
        2,
        &["4000000"],
    );
}

#[test]
fn mistakes_are_told() {
    let folder = probes();
    let path = folder.path();
    let with = |name: &str, from: &str, to: &str| {
        let text = std::fs::read_to_string(path.join("site.toml")).unwrap();
        assert!(text.contains(from), "{from}");
        std::fs::write(path.join(name), text.replace(from, to)).unwrap();
    };
    for (from, to, words) in [
        ("point = [0, 20, 1.5]", "", &["point in [[probe]] number 1", "point = ["][..]),
        ("point = [0, 20, 1.5]", "point = [0, nan, 1]", &["[[probe]] number 1 point", "not a point"]),
        ("point = [0, 20, 1.5]", "point = [0, 20]", &["[[probe]] number 1 point", "length 3"]),
        ("[0, -2, 0]", "[0, 0, 0]", &["[[probe]] number 1 normal", "no direction"]),
        ("[0, -2, 0]", "[0, inf, 0]", &["[[probe]] number 1 normal", "no direction"]),
        ("normal =", "norml =", &["[[probe]] number 1 norml", "normal in [[probe]]"]),
        ("[[probe]]\npoint", "[[prob]]\npoint", &["[prob]", "[[probe]]"]),
        (
            "[[probe]]\npoint",
            "[[probe]]\nname = \"window, \\\"north\\\"\"\npoint",
            &["[[probe]] number 2 name", "own name"],
        ),
    ] {
        with("wrong.toml", from, to);
        fails(path, "probe wrong.toml", 1, words);
    }
    with("none.toml", PROBES, "[[model]]\npath = \"tower.glb\"\n");
    fails(path, "probe none.toml", 2, &["no [[probe]]", "--point 12,-3,4.5"]);
    with("undated.toml", "date = 2026-03-21", "");
    fails(path, "probe undated.toml", 2, &["date of the study", "--date 2026-03-21"]);
    fails(path, "probe . --point 1,2", 2, &["--point", "3 numbers"]);
    fails(path, "probe . --point 1,2,inf", 2, &["--point", "3 numbers"]);
    fails(path, "probe . --point 1,2,3 --normal 0,0,0", 2, &["--normal", "no direction"]);
    fails(path, "probe . --normal 0,0,1", 2, &["--normal", "--point"]);
    fails(path, "probe . --to-date 2026-04-01", 2, &["--to-date", "needs --from-date"]);
    fails(path, "probe . --from-date 2026-04-01", 2, &["--from-date", "needs --to-date"]);
    fails(path, "probe . --from-date 2026-04-02 --to-date 2026-04-01", 2, &["--to-date", "before", "exchange"]);
    fails(path, "probe . --from-date 2026-04-02 --to-date 2037-04-01", 2, &["--to-date", "3660"]);
    fails(
        path,
        "probe . --from-date 2026-04-01 --to-date 2026-04-02 --date 2026-04-01",
        2,
        &["--date", "leave one out"],
    );
    fails(path, "probe . --from 2026-04-01T10:00", 2, &["--from", "each day", "--date"]);
    fails(path, "probe . --from 10:00 --to 10:00", 2, &["--to", "empty"]);
    fails(path, "probe . --step 30s", 2, &["--step"]);
    fails(path, "probe . --out a.jpg", 2, &["--out", "PNG"]);
    fails(path, "probe . --csv a.txt", 2, &["--csv", "CSV"]);
    fails(path, "probe . --totals a.txt", 2, &["--totals", "CSV"]);
    fails(path, "probe . --technique ray-cast", 2, &["--technique"]);
}
