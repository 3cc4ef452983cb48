//! The command as its users run it: files, streams and exit statuses.

mod animate;
mod check;
mod clock;
mod compare;
mod draw;
mod ground;
mod judge;
mod legend;
pub(crate) mod letters;
mod numbers;
mod patches;
mod rules;
mod sides;
mod techniques;
mod told;
pub(crate) mod units;
mod volumes;

use crate::shared::program::{PLACE, command, done, fails, gnomon, names, pixels, site, stderr};
use serde_json::{Value, json};
use std::process::Command;

#[test]
fn profile_writes_three_files() {
    let folder = site();
    let said = done(folder.path(), "profile . --engine cpu --size 64");
    assert_eq!(names(folder.path().join("out")), ["profile.json", "profile.png", "shadow-hours.tif"]);
    for word in ["profile.png", "shadow-hours.tif", "profile.json", "projected on the cpu", "h of shadow"] {
        assert!(said.contains(word), "{said}");
    }
    let json = std::fs::read_to_string(folder.path().join("out/profile.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let stages: Vec<_> = json["timings_secs"].as_object().unwrap().keys().map(String::as_str).collect();
    for stage in ["load", "prepare", "shadows", "picture", "raster", "total"] {
        assert!(stages.contains(&stage), "{stages:?}");
    }
}

#[test]
fn write_chooses_the_files() {
    let folder = site();
    done(folder.path(), "profile . --engine cpu --size 32 --write tif --out a");
    assert_eq!(names(folder.path().join("a")), ["shadow-hours.tif"]);
    done(folder.path(), "profile . --engine cpu --size 32 --write json,png --out deep/b");
    assert_eq!(names(folder.path().join("deep/b")), ["profile.json", "profile.png"]);
    fails(folder.path(), "profile . --write svg", 2, &["svg", "--write", "png, tif, glb, csv, json"]);
}

#[test]
fn json_is_the_file_and_alone_on_stdout() {
    let folder = site();
    let said =
        done(folder.path(), "profile . --engine cpu --json --region -20,-10,20,30 --cell 0.5 --receivers ground");
    assert_eq!(said, std::fs::read_to_string(folder.path().join("out/profile.json")).unwrap());
    let json: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(json["region"], json!([-20.0, -10.0, 20.0, 30.0]));
    assert_eq!((&json["width"], &json["height"], &json["cell"]), (&80.into(), &80.into(), &0.5.into()));
    assert_eq!((&json["technique"], &json["engine"]), (&"projected".into(), &"cpu".into()));
    assert_eq!((&json["receivers"], &json["silhouette"]), (&"ground".into(), &Value::Null));
    assert_eq!(json["instants"].as_array().unwrap().len(), 5);
    assert_eq!(json["refraction"], true);
}

#[test]
fn progress_is_plain_lines_and_quiet_is_silent() {
    let folder = site();
    let output = gnomon(folder.path(), "profile . --engine cpu --size 32 --write json");
    let told = stderr(&output);
    assert!(told.contains("100%") && told.contains("5 of 5 instants"), "{told}");
    for arguments in ["profile . --engine cpu --size 32 --quiet", "shadow . --at 2026-09-18T02:00 --engine cpu --quiet"]
    {
        let output = gnomon(folder.path(), arguments);
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    }
}

#[test]
fn masks_are_numbered_in_the_order_of_the_instants() {
    let folder = site();
    let options =
        "--engine cpu --region -60,-60,60,60 --cell 1 --write json --masks masks --from 5:00 --to 9:00 --step 1h";
    done(folder.path(), &format!("profile . {options}"));
    let expected: Vec<_> = (0..5).map(|index| format!("mask-{index:04}.png")).collect();
    assert_eq!(names(folder.path().join("masks")), expected);
    let mask = |name: &str| image::open(folder.path().join("masks").join(name)).unwrap().into_luma8();
    assert_eq!(mask("mask-0000.png").dimensions(), (120, 120));
    assert!(mask("mask-0000.png").pixels().all(|pixel| pixel.0 == [0]), "night");
    let morning = mask("mask-0004.png");
    assert!(morning.pixels().any(|pixel| pixel.0 == [0]) && morning.pixels().any(|pixel| pixel.0 == [255]));
}

#[test]
fn mistakes_are_told_in_one_line() {
    let folder = site();
    let path = folder.path();
    std::fs::write(path.join("key.toml"), PLACE.replace("latitude", "latitud")).unwrap();
    fails(path, "profile key.toml", 1, &["key.toml", "[place] latitud", "latitude in [place]"]);
    fails(path, "profile none.toml", 1, &["none.toml", "cannot be read"]);
    fails(path, "profile . --date 2026-02-30", 2, &["--date", "2026-02-30"]);
    fails(path, "profile . --tehnique auto", 2, &["--tehnique", "--technique", "--help"]);
    fails(path, "profile . --technique soft-texture", 2, &["--technique", "--receivers surfaces"]);
    fails(path, "profile . --engine gup", 2, &["gup", "gpu"]);
    fails(path, "profile tower.glb", 2, &["--place LAT,LON"]);
    fails(path, "profile tower.glb --place 98,2 --date 2026-09-18", 2, &["--place", "-90"]);
    fails(path, "profile tower.glb --place -33.8,151.2", 2, &["--date 2026-03-21"]);
    fails(path, "profile . --threads 0", 2, &["--threads"]);
    fails(path, "profile . --cell -1", 2, &["--cell", "above 0"]);
    fails(path, "profile . --at 2026-09-18T15:00", 2, &["--at"]);
    fails(path, "profile", 2, &["<SITE>"]);
    fails(path, "shadow .", 2, &["--at <T>"]);
    fails(path, "shadow . --at noonish", 2, &["--at", "noonish"]);
    fails(path, "shadow . --at 2026-09-18T15:00 --out a.jpg", 2, &["--out", "PNG"]);
    fails(path, "shadow . --at 2026-09-18T15:00 --out a.png --mask a.png", 2, &["--mask", "same"]);
    fails(path, "shadow . --at 2026-09-18T15:00 --view camera --cell 1", 2, &["--cell", "camera"]);
    fails(path, "sun . --engine cpu", 2, &["--engine"]);
    fails(path, "check none.glb", 1, &["none.glb", "there is no such file"]);
    assert!(names(path.join("out")).is_empty());
}

#[test]
fn choices_that_exclude_each_other_are_wrong_use() {
    let folder = site();
    let at = "shadow . --at 2026-09-18T15:00 --mask mask.png";
    fails(folder.path(), &format!("{at} --technique stencil --engine cpu"), 2, &["--engine", "ray-cast"]);
    fails(folder.path(), &format!("{at} --technique ray-cast --engine gpu"), 2, &["--engine", "stencil"]);
    fails(folder.path(), &format!("{at} --engine cpu --silhouette brute"), 2, &["--silhouette"]);
    fails(folder.path(), &format!("{at} --hextree-depth 4"), 2, &["--hextree-depth", "--silhouette hextree"]);
    fails(folder.path(), &format!("{at} --silhouette brute --hextree-depth 4"), 2, &["--hextree-depth"]);
    fails(folder.path(), &format!("{at} --silhouette hextree --hextree-depth 9"), 2, &["--hextree-depth", "1..=8"]);
    assert!(!folder.path().join("mask.png").exists());
}

#[test]
fn the_graphics_adapter_is_named() {
    let folder = site();
    for (receivers, technique, silhouette) in
        [("top", "stencil", "hextree".into()), ("ground", "projected", Value::Null)]
    {
        let options = format!("--engine gpu --size 64 --json --receivers {receivers}");
        let json: Value = serde_json::from_str(&done(folder.path(), &format!("profile . {options}"))).unwrap();
        assert_eq!((&json["technique"], &json["engine"]), (&technique.into(), &"gpu".into()));
        assert_eq!((&json["silhouette"], json["adapter"].is_string()), (&silhouette, true));
    }
}

#[test]
fn every_finder_draws_the_same_mask_and_is_named() {
    let folder = site();
    let mut masks = Vec::new();
    for (finder, name) in
        [("brute", "brute"), ("hextree", "hextree"), ("hextree --hextree-depth 2", "hextree"), ("gpu", "gpu")]
    {
        let at = format!("shadow . --at 2026-09-18T15:00 --size 200 --mask m.png --silhouette {finder} --json");
        let json: Value = serde_json::from_str(&done(folder.path(), &at)).unwrap();
        assert_eq!((&json["technique"], &json["silhouette"]), (&"stencil".into(), &name.into()), "{finder}");
        masks.push(std::fs::read(folder.path().join("m.png")).unwrap());
    }
    assert!(masks.iter().all(|mask| *mask == masks[0]));
    let rays = "profile . --technique ray-cast --silhouette gpu --size 64";
    fails(folder.path(), rays, 2, &["--silhouette", "leave it out"]);
}

/// A system whose only selected backend does not exist.
#[cfg(unix)]
#[test]
fn without_an_adapter_the_processor_draws_and_says_so() {
    let folder = site();
    let run = |options: &str| {
        let arguments = format!("profile . --size 32 --write json {options}");
        command(folder.path(), &arguments).env("WGPU_BACKEND", "dx12").output().unwrap()
    };
    let output = run("");
    assert_eq!(output.status.code(), Some(0));
    let told = stderr(&output);
    assert_eq!(told.matches("no graphics adapter was found: drawing on the processor").count(), 1, "{told}");
    for options in ["--engine gpu", "--technique stencil"] {
        let output = run(options);
        assert_eq!(output.status.code(), Some(1), "{options}");
        assert!(stderr(&output).contains("--engine cpu"), "{}", stderr(&output));
    }
}

#[test]
fn years_are_summed() {
    let folder = site();
    let years = "--engine cpu --size 8 --from 2026-01-01T00:00 --to 2029-01-01T00:00 --step 6h";
    // under the box the sun never shines
    let said = done(folder.path(), &format!("profile . --receivers ground --region -4,-4,4,4 {years}"));
    let hours = |before: &str| -> f64 {
        said.split(before).next().unwrap().split_whitespace().last().unwrap().parse().unwrap()
    };
    assert_eq!(hours(" h of shadow out of"), hours(" h with the sun"));
    assert!(hours(" h with the sun") > 12_000.0, "{said}");
}

#[test]
fn failures_leave_no_file() {
    let folder = site();
    std::fs::write(folder.path().join("out"), "in the way").unwrap();
    fails(folder.path(), "profile . --engine cpu --size 16", 1, &["out", "--out"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("out")).unwrap(), "in the way");
    assert_eq!(names(folder.path().to_owned()), ["open.glb", "out", "site.toml", "tower.glb"]);
}

/// Without a subcommand the window opens; without a display there is an error. A program without a window prints its
/// help.
#[test]
#[cfg(target_os = "linux")]
fn no_subcommand_is_the_window() {
    let mut program = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        program.env_remove(display);
    }
    let output = program.output().unwrap();
    if cfg!(feature = "desktop") {
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("without a display use the commands"), "{}", stderr(&output));
    } else {
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("Usage: gnomon"), "{}", stderr(&output));
    }
}

#[test]
fn help_and_version_are_printed() {
    let folder = site();
    assert!(done(folder.path(), "--version").starts_with("gnomon "));
    assert!(done(folder.path(), "--help").contains("Usage: gnomon"));
    assert!(done(folder.path(), "profile --help").contains("--masks"));
}

#[test]
fn shadow_draws_one_instant() {
    let folder = site();
    let at = "shadow tower.glb --place -33.8688,151.2093 --at 2026-06-21T09:00 --engine cpu";
    done(folder.path(), &format!("{at} --size 64"));
    assert!(image::open(folder.path().join("shadow.png")).is_ok());
    let said = done(folder.path(), &format!("{at} --region -30,-60,30,0 --cell 1 --mask m.png --json --no-refraction"));
    let json: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(json["region"], json!([-30.0, -60.0, 30.0, 0.0]));
    assert_eq!((json["instants"].as_array().unwrap().len(), &json["refraction"]), (1, &false.into()));
    assert_eq!(json["place"]["time_zone"], "Australia/Sydney");
    let mask = image::open(folder.path().join("m.png")).unwrap().into_luma8();
    // In the south the morning sun stands in the north-east: the shadow lies to the south-west.
    assert_eq!((mask.get_pixel(14, 14).0, mask.get_pixel(55, 14).0), ([0], [255]));
    assert_eq!(names(folder.path().to_owned()), ["m.png", "open.glb", "shadow.png", "site.toml", "tower.glb"]);
}

#[test]
fn shadow_at_night_is_drawn_and_said() {
    let folder = site();
    let options = "--at 2026-09-18T02:00 --engine cpu --size 16 --out n.png --mask m.png";
    let output = gnomon(folder.path(), &format!("shadow . {options}"));
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("night"), "{}", stderr(&output));
    let mask = image::open(folder.path().join("m.png")).unwrap().into_luma8();
    assert!(mask.pixels().all(|pixel| pixel.0 == [0]));
    assert!(folder.path().join("n.png").exists());
}

#[test]
fn shadow_is_seen_by_a_camera() {
    let folder = site();
    let said =
        done(folder.path(), "shadow . --at 15:00 --date 2026-09-18 --engine cpu --view camera --json --mask m.png");
    let json: Value = serde_json::from_str(&said).unwrap();
    assert_eq!((&json["width"], &json["region"], &json["receivers"]), (&1600.into(), &Value::Null, &"top".into()));
    assert_eq!(json["camera"]["up"], json!([0.0, 0.0, 1.0]));
    let mask = image::open(folder.path().join("m.png")).unwrap().into_luma8();
    assert_eq!(mask.dimensions(), (1600, 1000));
    assert!(mask.pixels().any(|pixel| pixel.0 == [0]) && mask.pixels().any(|pixel| pixel.0 == [255]));
}

#[test]
fn show_draws_volumes_silhouette_and_components() {
    let folder = site();
    let at = "shadow . --at 2026-09-18T15:00 --view camera --json";
    done(folder.path(), &format!("{at} --out plain.png --engine cpu"));
    // auto would cast rays on a software adapter; volumes are the stencil's
    let said = done(folder.path(), &format!("{at} --out volumes.png --show volumes,silhouette"));
    let json: Value = serde_json::from_str(&said).unwrap();
    assert_eq!((&json["technique"], &json["engine"]), (&"stencil".into(), &"gpu".into()));
    done(folder.path(), &format!("{at} --out parts.png --show components --engine cpu"));
    let count = |name: &str, so: &dyn Fn([u8; 3]) -> bool| pixels(folder.path().join(name), so);
    let yellow = |[red, green, blue]: [u8; 3]| red > 200 && green > 180 && blue < 165;
    let black = |colour: [u8; 3]| colour.iter().all(|part| *part < 14);
    assert!(count("volumes.png", &yellow) > count("plain.png", &yellow) + 20_000);
    assert!(count("volumes.png", &black) > count("plain.png", &black) + 5000);
    // the one component has the first colour, also in the legend
    let mint = |colour| colour == [139, 212, 188];
    assert!(count("parts.png", &mint) > 3000 && count("plain.png", &mint) == 0);
}

#[test]
fn show_is_for_a_cameras_drawing_by_the_stencil() {
    let folder = site();
    let at = "shadow . --at 2026-09-18T15:00";
    fails(folder.path(), &format!("{at} --show volumes"), 2, &["--show", "add --view camera, or leave it out"]);
    fails(folder.path(), &format!("{at} --show components"), 2, &["--show", "--view camera or a side"]);
    fails(folder.path(), &format!("{at} --view camera --mask m.png --show components"), 2, &["--show", "--out"]);
    fails(folder.path(), &format!("{at} --view camera --show walls"), 2, &["walls", "volumes, silhouette, components"]);
    for options in ["--engine cpu", "--technique ray-cast"] {
        let arguments = format!("{at} --view camera --show silhouette {options}");
        fails(folder.path(), &arguments, 2, &["--show", "--technique stencil", "leave them out"]);
    }
    assert_eq!(names(folder.path().to_owned()), ["open.glb", "site.toml", "tower.glb"]);
    let night = "shadow . --at 2026-09-18T02:00 --view camera --show volumes,silhouette,components";
    let output = gnomon(folder.path(), night);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("no volumes and no silhouette"), "{}", stderr(&output));
}

#[cfg(unix)]
#[test]
fn volumes_without_an_adapter_are_told_apart() {
    let folder = site();
    let arguments = "shadow . --at 2026-09-18T15:00 --view camera --show volumes";
    let output = command(folder.path(), arguments).env("WGPU_BACKEND", "dx12").output().unwrap();
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    for word in ["--show", "no graphics adapter was found", "install a driver", "leave them out"] {
        assert!(told.contains(word), "{told}");
    }
    assert!(!folder.path().join("shadow.png").exists());
}

#[test]
fn sun_is_a_table_or_json() {
    let folder = site();
    let table = done(folder.path(), "sun .");
    for word in ["azimuth", "altitude", "weight", "2026-09-18T10:00:00+02:00", "sunrise", "sunset"] {
        assert!(table.contains(word), "{table}");
    }
    let json: Value = serde_json::from_str(&done(folder.path(), "sun . --at 2026-06-21T12:00 --json")).unwrap();
    let keys: Vec<_> = json.as_object().unwrap().keys().collect();
    assert_eq!(keys, ["days", "instants", "notes", "place", "tz_version"]);
    assert_eq!(json["instants"][0]["time"], "2026-06-21T12:00:00+02:00");
}

#[test]
fn check_says_what_is_wrong() {
    let folder = site();
    let clean = done(folder.path(), "check tower.glb");
    assert!(clean.contains("1 component, 12 triangles, 8 vertices") && clean.contains("nothing wrong"), "{clean}");
    let dirty = done(folder.path(), "check open.glb");
    assert!(dirty.contains("open (4): edges with one face") && !dirty.contains("nothing wrong"), "{dirty}");
    let json: Value = serde_json::from_str(&done(folder.path(), "check open.glb --json")).unwrap();
    let part = json!({"name": "tower", "triangles": 10, "closed": false, "open_edges": 4, "crowded_edges": 0,
        "flipped_edges": 0, "degenerate_triangles": 0, "duplicate_triangles": 0, "t_junctions": 0,
        "places": {"open": [{"kind": "hole", "edges": 4, "length_m": 40.0, "near": [0.0, 0.0, 20.0],
            "from": json["components"][0]["places"]["open"][0]["from"],
            "to": json["components"][0]["places"]["open"][0]["to"]}]}});
    let frame = "metres along the file's own axes, turned z up (x, −z, y of the file)";
    let model = json!({"name": "open.glb", "unit_m": 1.0, "unit_is_said": false, "up": "y", "up_is_said": false, "crs": null, "file_place": null, "meridian_deg": null,
        "said_by": null, "place": null, "anchors": [], "north_deg": 0.0, "convergence_deg": null,
        "file": "open.glb", "format": "glTF", "kinds": {"building": 1}, "groups": [{"name": "default", "components": 1}, {"name": "tower", "components": 1}],
        "left_out": []});
    let said =
        json!({"triangles": 10, "vertices": 8, "model": model, "frame": frame, "components": [part], "notes": []});
    assert_eq!(json, said);
    assert!(dirty.contains("\nopen.glb: glTF\n"), "{dirty}");
    assert!(
        clean.contains("tower.glb: unit 1 m (assumed), y up (assumed), north 0.00°, no place on Earth\n"),
        "{clean}"
    );
    assert!(dirty.contains("  tower: a hole of 4 edges, 40.00 m around, near (0.000, 0.000, 20.000)\n"), "{dirty}");
    // A site's models, and neither place nor study is asked for.
    std::fs::write(folder.path().join("bare.toml"), "[[model]]\npath = \"open.glb\"\n").unwrap();
    let placed = dirty.replace(frame, "metres east, north, up from the place");
    assert_eq!(done(folder.path(), "check bare.toml"), placed);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_work_without_an_answer() {
    use std::io::{BufRead, BufReader};
    use std::process::Stdio;
    let folder = site();
    let day = "--from 8:00 --to 18:00 --step 1s";
    let mut child = command(folder.path(), &format!("profile . --engine cpu --size 256 {day}"))
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    // The first tenth is done: it is in the middle of its work.
    let mut told = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(told.next().unwrap().unwrap().contains("10%"));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let told: Vec<String> = told.map(Result::unwrap).collect();
    assert_eq!((child.wait().unwrap().code(), told.last().unwrap().as_str()), (Some(130), "error: interrupted"));
    assert!(told.iter().any(|line| line.contains("the same study continues from there")), "{told:?}");
    // no file of the answer, and what it goes on from
    assert_eq!(crate::shared::program::numberless(&folder.path().join("out")), ["profile.N.unfinished"]);
}
