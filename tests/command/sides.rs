//! `--view south` and `[camera] side`: the command draws a side along parallel rays; and `--view sun`.

use crate::shared::program::{done, fails, pixels, site};
use serde_json::{Value, json};
use std::path::Path;

const AT: &str = "shadow . --at 2026-09-18T15:00";

/// Another camera in the site file.
fn write(folder: &Path, camera: &str) {
    let path = folder.join("site.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let before = text.split("[camera]").next().unwrap();
    std::fs::write(path, format!("{before}[camera]\n{camera}\n")).unwrap();
}

fn drawn(folder: &Path, options: &str) -> (Value, Vec<u8>) {
    let said = done(folder, &format!("{AT} {options} --out side.png --json"));
    (serde_json::from_str(&said).unwrap(), std::fs::read(folder.join("side.png")).unwrap())
}

/// Without a camera in the site file the models fill the picture, the ground's line low in it; the side away from the sun
/// is dark, cell for cell.
#[test]
fn a_side_holds_the_models_to_scale() {
    let folder = site();
    let said = done(folder.path(), &format!("{AT} --view north --mask m.png --json"));
    let json: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(json["to_viewer"], json!([0.0, 1.0, 0.0]));
    // the tower is 10 m wide and 20 m high, and has 16% of the picture below it and 10% above
    let [cell, middle] = [&json["cell"], &json["target"][2]].map(|number| number.as_f64().unwrap());
    assert!((cell - 20.0 / 740.0).abs() < 1e-9, "{cell}");
    assert!((middle - 340.0 * cell).abs() < 1e-9, "{middle}");
    let mask = image::open(folder.path().join("m.png")).unwrap().into_luma8();
    assert_eq!(mask.dimensions(), (1600, 1000));
    for (column, row, pixel) in mask.enumerate_pixels() {
        let (x, z) = ((f64::from(column) + 0.5 - 800.0) * cell, middle - (f64::from(row) + 0.5 - 500.0) * cell);
        let dark = x.abs() < 5.0 && z > 0.0 && z < 20.0;
        assert_eq!(pixel.0, [if dark { 0 } else { 255 }], "at {x}, {z}");
    }
}

/// If the site file names only the point, a side shows enough around it to contain the models.
#[test]
fn a_side_holds_the_models_about_a_point() {
    let folder = site();
    let cell = |target: &str| {
        write(folder.path(), &format!("side = \"south\"\ntarget = {target}"));
        drawn(folder.path(), "--view camera").0["cell"].as_f64().unwrap()
    };
    let held = |target: &str, metres: f64, cells: f64| {
        let cell = cell(target);
        assert!((cell - metres / cells).abs() < 1e-9, "{target}: {cell}");
    };
    // the ground 16% above the foot, the roof 10% below the head, a wall 4% beside the edge
    held("[0, 0, 10]", 10.0, 340.0);
    held("[0, 0, 1]", 19.0, 400.0);
    held("[-30, 0, 5]", 35.0, 0.46 * 1600.0);
}

/// A side in the site file equals the option's; with a camera there, it shows as much at the same point. The camera of
/// a perspective does not affect a side that only an option requests.
#[test]
fn the_site_file_names_a_side() {
    let folder = site();
    let (_, south) = drawn(folder.path(), "--view south");
    write(folder.path(), "side = \"south\"");
    assert!(drawn(folder.path(), "--view camera").1 == south, "another side");
    // the option goes before the file
    assert!(drawn(folder.path(), "--view east").1 != south, "the same side");
    let eye = "eye = [30, -40, 8]\ntarget = [0, 0, 8]\nfov = 90";
    write(folder.path(), &format!("{eye}\nside = \"west\""));
    let (json, west) = drawn(folder.path(), "--view camera");
    assert_eq!((&json["target"], &json["to_viewer"]), (&json!([0.0, 0.0, 8.0]), &json!([-1.0, 0.0, 0.0])));
    let cell = json["cell"].as_f64().unwrap();
    assert!((cell - 2.0 * 50.0 / 1000.0).abs() < 1e-9, "{cell}");
    assert!(drawn(folder.path(), "--view west").1 == west, "another side");
    write(folder.path(), eye);
    assert!(drawn(folder.path(), "--view south").1 == south, "the perspective's frame");
    let (json, perspective) = drawn(folder.path(), "--view camera");
    assert!(json["camera"].is_object() && perspective != west, "{json}");
    // frames are drawn from there, too
    let frames = "animate . --view west --from 14:00 --to 15:00 --step 1h --width 3508 --quiet";
    done(folder.path(), frames);
    let [frame, sheet] = ["out/frame-0001.png", "side.png"].map(|name| image::open(folder.path().join(name)).unwrap());
    assert!(frame.into_rgb8() != sheet.into_rgb8(), "the side is in no frame");
    drawn(folder.path(), "--view west");
    let [frame, sheet] = ["out/frame-0001.png", "side.png"].map(|name| image::open(folder.path().join(name)).unwrap());
    assert!(frame.into_rgb8() == sheet.into_rgb8(), "the frame is another sheet");
}

/// Hours on patches are seen as the site's camera sees them: from the north the wall has no sun.
#[test]
fn hours_on_patches_are_seen_from_a_side() {
    let folder = site();
    let dark = |side: &str| {
        write(folder.path(), &format!("side = \"{side}\""));
        done(folder.path(), "profile . --receivers surfaces --patch-cell 1 --write png --quiet");
        let no_sun = [70, 66, 74];
        pixels(folder.path().join("out/surfaces.png"), |colour| colour == no_sun)
    };
    let (north, south) = (dark("north"), dark("south"));
    assert!(north > south + 500_000, "{north} and {south} dark pixels");
}

#[test]
fn what_a_side_cannot_have_is_told() {
    let folder = site();
    let refused = |options: &str, words: &[&str]| fails(folder.path(), &format!("{AT} {options}"), 2, words);
    refused("--view up", &["up", "plan, camera, north, east, south, west, sun"]);
    refused("--view south --cell 1", &["--cell", "--view south", "leave one out"]);
    refused("--view south --receivers ground", &["--receivers", "--view south"]);
    for show in ["volumes", "silhouette", "overdraw"] {
        refused(&format!("--view south --show {show}"), &["--show", "a side is drawn by ray casting", "leave it out"]);
    }
    refused("--view south --stats", &["--stats", "a side is drawn by ray casting"]);
    refused("--view south --technique stencil", &["--technique", "ray-cast"]);
    refused("--view south --engine gpu", &["--engine", "on the cpu"]);
    refused("--view south --silhouette hextree", &["--silhouette"]);
    write(folder.path(), "side = \"sout\"");
    for options in ["--view camera", "--view plan"] {
        fails(
            folder.path(),
            &format!("{AT} {options}"),
            1,
            &["[camera] side", "north, east, south, west", "\"south\""],
        );
    }
    write(folder.path(), "side = 4");
    fails(folder.path(), &format!("{AT} --view camera"), 1, &["[camera] side", "side = \"south\""]);
    write(folder.path(), "sides = \"south\"");
    fails(folder.path(), &format!("{AT} --view camera"), 1, &["side in [camera]"]);
}

/// From the sun everything that is seen is lit, and the report says from where that is; an animation follows the sun.
#[test]
fn the_sun_sees_what_is_lit() {
    let folder = site();
    let said = done(folder.path(), &format!("{AT} --view sun --out sun.png --mask m.png --json"));
    let json: Value = serde_json::from_str(&said).unwrap();
    let to_viewer: Vec<f64> = json["to_viewer"].as_array().unwrap().iter().map(|part| part.as_f64().unwrap()).collect();
    let instant = &json["instants"][0];
    let [azimuth, altitude] = ["azimuth_deg", "altitude_deg"].map(|key| instant[key].as_f64().unwrap().to_radians());
    let to_sun = [azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin()];
    assert!(to_viewer.iter().zip(to_sun).all(|(one, other)| (one - other).abs() < 1e-6), "{to_viewer:?} {to_sun:?}");
    let dark = |name: &str| {
        let mask = image::open(folder.path().join(name)).unwrap().into_luma8();
        mask.pixels().filter(|pixel| pixel.0 == [0]).count()
    };
    // along silhouettes alone, of 1,600,000 pixels
    let silhouettes = dark("m.png");
    assert!(silhouettes < 2_000, "{silhouettes} dark pixels");
    // which a picture from elsewhere shows to be a bound that can be broken
    done(folder.path(), &format!("{AT} --view east --mask e.png"));
    assert!(dark("e.png") > 100_000, "the east side has no shadow in the afternoon");
    done(folder.path(), "animate . --view sun --from 14:00 --to 16:00 --step 1h --width 3508 --quiet");
    let frame = |index: usize| {
        let path = folder.path().join(format!("out/frame-000{index}.png"));
        image::open(path).unwrap().into_rgb8()
    };
    assert!(frame(0) != frame(1), "the sun does not move");
    fails(
        folder.path(),
        "shadow . --at 2026-09-18T23:00 --view sun",
        1,
        &["--view", "2026-09-18 23:00", "below the horizon"],
    );
    fails(
        folder.path(),
        "animate . --view sun --from 18:00 --to 22:00 --step 1h",
        1,
        &["--view", "below the horizon", "times of day"],
    );
    let refused = |options: &str, words: &[&str]| fails(folder.path(), &format!("{AT} --view sun {options}"), 2, words);
    refused("--cell 1", &["--cell", "--view sun", "leave one out"]);
    refused("--technique stencil", &["--technique", "ray-cast"]);
    refused("--show volumes", &["--show", "leave it out"]);
}
