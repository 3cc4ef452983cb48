//! `gnomon compare`: against closed forms, and against two runs of `gnomon profile`.

use crate::shared::program::{PLACE, STUDY, done, fails, site};
use serde_json::Value;
use std::path::Path;
use tiff::decoder::{Decoder, DecodingResult};

/// Beside the tower of [`site`] a second one, 40 m to the east.
fn pair() -> tempfile::TempDir {
    let folder = site();
    let text = format!(
        "{PLACE}[[model]]\npath = \"tower.glb\"\n[[model]]\npath = \"tower.glb\"\nposition = [40, 0, 0]\n{STUDY}"
    );
    std::fs::write(folder.path().join("two.toml"), text).unwrap();
    folder
}

fn raster(path: &Path) -> Vec<f32> {
    let mut decoder = Decoder::new(std::fs::File::open(path).unwrap()).unwrap();
    let DecodingResult::F32(hours) = decoder.read_image().unwrap() else { panic!("not f32") };
    hours
}

const PLAN: &str = "--engine cpu --region -60,-30,90,90 --cell 0.5";

#[test]
fn the_difference_is_that_of_the_profiles() {
    let folder = pair();
    let file = |name: &str| folder.path().join(name);
    done(folder.path(), &format!("compare site.toml two.toml {PLAN} --out ab"));
    done(folder.path(), &format!("compare two.toml site.toml {PLAN} --out ba"));
    done(folder.path(), &format!("compare site.toml site.toml {PLAN} --out aa"));
    done(folder.path(), &format!("profile site.toml {PLAN} --write tif --out a"));
    done(folder.path(), &format!("profile two.toml {PLAN} --write tif --out b"));
    let [a, b] = ["a", "b"].map(|name| raster(&file(name).join("shadow-hours.tif")));
    let [ab, ba, aa] = ["ab", "ba", "aa"].map(|name| raster(&file(name).join("shadow-hours-difference.tif")));
    assert!(aa.iter().all(|hours| *hours == 0.0));
    for (cell, hours) in ab.iter().enumerate() {
        assert_eq!(hours.is_nan(), ba[cell].is_nan());
        assert!(hours.is_nan() || (*hours - (b[cell] - a[cell])).abs() < 1e-6 && *hours == -ba[cell], "{cell}");
    }
    // the new roof, 10 × 10 m in cells of half a metre
    assert_eq!(ab.iter().filter(|hours| hours.is_nan()).count(), 400);
    assert!(file("ab/compare.png").is_file());
}

#[test]
fn a_box_takes_the_sun_from_its_shadow() {
    let folder = pair();
    let window = "--from 11:00 --to 11:01 --step 1min";
    let said = done(folder.path(), &format!("compare site.toml two.toml {PLAN} {window} --json"));
    let json: Value = serde_json::from_str(&said).unwrap();
    let number = |pointer: &str| json.pointer(pointer).unwrap().as_f64().unwrap();
    let [azimuth, altitude] =
        ["azimuth_deg", "altitude_deg"].map(|angle| number(&format!("/instants/0/{angle}")).to_radians());
    // a box of 10 × 10 × 20 m sweeps its base along its shadow
    let length = 20.0 / altitude.tan();
    let area = 10.0 * length * (azimuth.sin().abs() + azimuth.cos().abs());
    let lost = number("/sun_lost/more_than/0/area_m2");
    assert!((lost - area).abs() < 0.03 * area, "{lost} of {area}");
    assert!((number("/sun_lost/most_hours") - 1.0 / 60.0).abs() < 1e-9);
    assert_eq!(number("/sun_gained/m2_hours"), 0.0);
    assert_eq!((number("/built_m2"), number("/cleared_m2")), (100.0, 0.0));
    // it lies where the shadow does
    let along = |at: f64| [40.0 - azimuth.sin() * at, -azimuth.cos() * at];
    let cell = |[x, y]: [f64; 2]| ((90.0 - y) / 0.5) as usize * 300 + ((x + 60.0) / 0.5) as usize;
    let hours = raster(&folder.path().join("out/shadow-hours-difference.tif"));
    assert!((hours[cell(along(length * 0.7))] - 1.0 / 60.0).abs() < 1e-6);
    assert_eq!(hours[cell(along(-length))], 0.0);
}

/// Names with equal beginnings and ends are shortened so that they differ: with other names the sheet differs.
#[test]
fn long_names_are_told_apart_on_the_sheet() {
    let folder = site();
    let path = folder.path();
    let deep = "a-folder-with-a-name-that-is-as-long-as-people-write-them/and-one-more-below-it";
    let sheet = |names: [&str; 2]| {
        for name in names {
            std::fs::create_dir_all(path.join(name).parent().unwrap()).unwrap();
            std::fs::copy(path.join("tower.glb"), path.join(name)).unwrap();
        }
        let study = "--place 48.8583,2.2945 --date 2026-09-18 --from 10:00 --to 12:00 --step 1h --engine cpu --size 60";
        done(path, &format!("compare {} {} {study}", names[0], names[1]));
        image::open(path.join("out/compare.png")).unwrap().into_rgb8()
    };
    let model = format!("{deep}/{deep}/tower.glb");
    for (one, other) in [
        // the same file in two folders, far down and above
        (format!("{deep}/existing/tower.glb"), format!("{deep}/proposed/tower.glb")),
        (format!("existing/{model}"), format!("proposed/{model}")),
        // two files of a folder, with long names that differ in the middle
        (
            format!("{deep}/{}-before-{}.glb", "x".repeat(60), "y".repeat(60)),
            format!("{deep}/{}-after-{}.glb", "x".repeat(60), "y".repeat(60)),
        ),
    ] {
        let (both, same) = (sheet([&one, &other]), sheet([&one, &one]));
        assert!(both != same, "{one} and {other} are cut alike");
    }
}

#[test]
fn another_place_or_ground_is_refused() {
    let folder = pair();
    let text = |more: &str| format!("{}[[model]]\npath = \"tower.glb\"\n{more}{STUDY}", PLACE);
    let write = |text: String| std::fs::write(folder.path().join("other.toml"), text).unwrap();
    write(text("").replace("48.8583", "48.9"));
    fails(
        folder.path(),
        "compare site.toml other.toml",
        1,
        &["other.toml", "latitude", "site.toml", "m from the place"],
    );
    write(text("").replace("[[model]]", "time_zone = \"Europe/London\"\n[[model]]"));
    fails(folder.path(), "compare site.toml other.toml", 1, &["time_zone", "Europe/London"]);
    write(text("[ground]\nlevel = 1.0\n"));
    fails(folder.path(), "compare site.toml other.toml", 1, &["[ground] level", "same level"]);
    fails(folder.path(), "compare site.toml two.toml --receivers surfaces", 2, &["--receivers"]);
}
