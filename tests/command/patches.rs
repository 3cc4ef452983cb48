//! `gnomon profile --receivers surfaces`: files, numbers and errors.

use crate::shared::program::{done, fails, gnomon, names, site, stderr};
use glam::DVec3;
use serde_json::Value;
use std::path::Path;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn profile(folder: &Path, options: &str) -> String {
    done(folder, &format!("profile . --receivers surfaces {options}"))
}

/// The lines of `surfaces.csv`, without its head.
fn lines(folder: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(folder.join("out/surfaces.csv")).unwrap();
    let (head, rest) = text.split_once("\r\n").unwrap();
    assert_eq!(
        head,
        "component,patch,area_m2,azimuth_deg,tilt_deg,hours_mean,hours_min,hours_max,share_1h,share_2h,share_3h,share_4h"
    );
    let fields = |line: &str| line.split(',').map(str::to_owned).collect();
    rest.split_terminator("\r\n").map(fields).collect()
}

/// The direction to the sun of each instant, and its weight in hours, from `gnomon sun`.
fn suns(folder: &Path, options: &str) -> Vec<(DVec3, f64)> {
    let report = json(&done(folder, &format!("sun . --json {options}")));
    let sun = |instant: &Value| {
        let [azimuth, altitude] =
            ["azimuth_deg", "altitude_deg"].map(|key| instant[key].as_f64().unwrap().to_radians());
        let to_sun = DVec3::new(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin());
        (to_sun, instant["weight_secs"].as_f64().unwrap() / 3600.0)
    };
    report["instants"].as_array().unwrap().iter().map(sun).collect()
}

/// A tower with every face twice: `shared/cases/10-doubled-faces-area`.
#[test]
fn doubled_faces_count_once_in_all_files_and_are_told() {
    let folder = site();
    let low = [-5.0, 0.0, -5.0];
    let tower = super::units::blocks(&[(low, [5.0, 20.0, 5.0]), (low, [5.0, 20.0, 5.0])]);
    std::fs::write(folder.path().join("tower.glb"), tower.glb()).unwrap();
    let output = gnomon(folder.path(), "profile . --receivers surfaces --patch-cell 0.5");
    assert!(stderr(&output).contains("1000 m² of the surfaces exist twice and count once"), "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("tower: 1000 m²"));
    let lines = lines(folder.path());
    assert_eq!(lines[0][1..3], ["all".to_owned(), "1000.000000".to_owned()]);
    let sum: f64 = lines[1..].iter().map(|line| line[2].parse::<f64>().unwrap()).sum();
    assert!((sum - 1000.0).abs() < 1e-3, "{sum}");
    let report = json(&std::fs::read_to_string(folder.path().join("out/profile.json")).unwrap());
    assert!((report["doubled_m2"].as_f64().unwrap() - 1000.0).abs() < 1e-6, "{report}");
    assert_eq!(report["touching_m2"], 0.0);
    assert!((report["components"][0]["area_m2"].as_f64().unwrap() - 1000.0).abs() < 1e-6);
}

/// On a box that stands alone each side has the hours in which it faces the sun, all over.
#[test]
fn each_side_of_a_box_has_the_hours_in_which_it_faces_the_sun() {
    let folder = site();
    let window = "--from sunrise+0h20 --to sunset-0h20 --step 20min";
    let alone = "--resolution step";
    for engine in ["--technique ray-cast", ""] {
        let said = profile(folder.path(), &format!("{window} {alone} --patch-cell 0.5 {engine}"));
        assert!(said.contains("6 patches") && said.contains("tower: 1000 m²"), "{said}");
        let suns = suns(folder.path(), window);
        let day: f64 = suns.iter().map(|(_, hours)| hours).sum();
        let lines = lines(folder.path());
        assert_eq!((lines.len(), &lines[0][0][..], &lines[0][1][..]), (7, "tower", "all"));
        let mut seen = 0;
        for line in &lines[1..] {
            let number = |column: usize| line[column].parse::<f64>().unwrap();
            let tilt = number(4).to_radians();
            let azimuth = if line[3].is_empty() { 0.0 } else { number(3).to_radians() };
            let normal = DVec3::new(azimuth.sin() * tilt.sin(), azimuth.cos() * tilt.sin(), tilt.cos());
            let facing: f64 = suns.iter().filter(|(sun, _)| sun.dot(normal) > 1e-9).map(|(_, hours)| hours).sum();
            for column in [5, 6, 7] {
                assert!((number(column) - facing).abs() < 1e-3, "{line:?}: {facing} h");
            }
            for (column, hours) in [(8, 1.0), (9, 2.0), (10, 3.0), (11, 4.0)] {
                assert_eq!(number(column), f64::from(facing >= hours), "{line:?}");
            }
            let area = if line[3].is_empty() { 100.0 } else { 200.0 };
            assert!((number(2) - area).abs() < 1e-6, "{line:?}");
            seen += usize::from(facing > 1.0 && facing < day - 1.0);
        }
        assert!(seen >= 2, "walls have a part of the day");
        let mean: f64 = lines[0][5].parse().unwrap();
        let of_lines = |line: &Vec<String>| line[2].parse::<f64>().unwrap() * line[5].parse::<f64>().unwrap() / 1000.0;
        assert!((mean - lines[1..].iter().map(of_lines).sum::<f64>()).abs() < 1e-3);
    }
}

/// The texture's colours and numbers are those of the table, wherever a face is looked up in them.
#[test]
fn the_model_holds_the_hours_as_colours_and_as_numbers() {
    let folder = site();
    let window = "--from 10:00 --to 16:00 --step 1h";
    profile(folder.path(), &format!("{window} --patch-cell 0.7"));
    let bytes = std::fs::read(folder.path().join("out/surfaces.glb")).unwrap();
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = blob.unwrap();
    let scene: Value =
        serde_json::from_str(document.default_scene().unwrap().extras().as_ref().unwrap().get()).unwrap();
    let seconds = scene["numbers"]["seconds_a_unit"].as_f64().unwrap();
    let picture = |texture: usize| {
        let gltf::image::Source::View { view, mime_type } = document.textures().nth(texture).unwrap().source().source()
        else {
            panic!("in the file")
        };
        assert_eq!(mime_type, "image/png");
        image::load_from_memory(&blob[view.offset()..view.offset() + view.length()]).unwrap()
    };
    let lines = lines(folder.path());
    let mut colours = std::collections::BTreeMap::new();
    let node = document.nodes().next().unwrap();
    assert_eq!((node.name(), document.nodes().count()), (Some("tower"), 1));
    for primitive in node.mesh().unwrap().primitives() {
        let material = primitive.material();
        assert!(material.double_sided());
        let page = material.pbr_metallic_roughness().base_color_texture().unwrap().texture().index();
        let numbers: Value = serde_json::from_str(material.extras().as_ref().unwrap().get()).unwrap();
        let [painted, numbers] = [page, numbers["numbers_texture"].as_u64().unwrap() as usize].map(picture);
        let (painted, numbers) = (painted.to_rgb8(), numbers.to_luma16());
        let words = |accessor: gltf::Accessor| {
            let view = accessor.view().unwrap();
            let bytes = &blob[view.offset()..view.offset() + view.length()];
            bytes.chunks_exact(4).map(|word| <[u8; 4]>::try_from(word).unwrap()).collect::<Vec<_>>()
        };
        let floats =
            |semantic| words(primitive.get(&semantic).unwrap()).into_iter().map(f32::from_le_bytes).collect::<Vec<_>>();
        let positions = floats(gltf::Semantic::Positions);
        let positions: Vec<_> =
            positions.chunks_exact(3).map(|at| DVec3::new(at[0].into(), at[1].into(), at[2].into())).collect();
        let places = floats(gltf::Semantic::TexCoords(0));
        let places: Vec<_> = places.chunks_exact(2).map(|at| [at[0], at[1]]).collect();
        let corners = words(primitive.indices().unwrap()).into_iter().map(u32::from_le_bytes);
        let corners: Vec<_> = corners.map(|corner| corner as usize).collect();
        assert_eq!(corners.len(), 36);
        for triangle in corners.chunks_exact(3) {
            let at = |shares: [f32; 3]| {
                let of =
                    |axis: usize| (0..3).map(|corner| places[triangle[corner]][axis] * shares[corner]).sum::<f32>();
                [of(0) * painted.width() as f32, of(1) * painted.height() as f32].map(|place| place as u32)
            };
            let [a, b, c] = [0, 1, 2].map(|corner| positions[triangle[corner]]);
            // x east, y up, z south
            let normal = (b - a).cross(c - a).normalize();
            let tilt = normal.y.clamp(-1.0, 1.0).acos().to_degrees();
            let azimuth = normal.x.atan2(-normal.z).to_degrees().rem_euclid(360.0);
            let is_side = |line: &&Vec<String>| {
                let near = |column: usize, value: f64| (line[column].parse::<f64>().unwrap() - value).abs() < 0.01;
                line[1] != "all" && near(4, tilt) && (line[3].is_empty() || near(3, azimuth))
            };
            let line = lines.iter().find(is_side).unwrap();
            let hours: f64 = line[5].parse().unwrap();
            for shares in [[0.34, 0.33, 0.33], [0.96, 0.02, 0.02], [0.02, 0.96, 0.02], [0.49, 0.49, 0.02]] {
                let [x, y] = at(shares);
                let number = f64::from(numbers.get_pixel(x, y).0[0]) * seconds / 3600.0;
                assert!((number - hours).abs() < 1e-3, "{number} instead of {line:?}");
                let colour = painted.get_pixel(x, y).0;
                // one colour for one hour
                assert_eq!(*colours.entry((hours * 3600.0) as u64).or_insert(colour), colour);
            }
        }
    }
    assert!(colours.len() >= 4, "{colours:?}");
    let distinct: std::collections::BTreeSet<_> = colours.values().collect();
    assert!(distinct.len() + 1 >= colours.len(), "{colours:?}");
}

#[test]
fn what_does_not_receive_stands_in_the_model_without_hours() {
    let folder = site();
    let path = folder.path().join("site.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let other = "[[model]]\npath = \"open.glb\"\nposition = [40, 0, 0]\nreceives = false\n[study]";
    std::fs::write(&path, text.replace("[study]", other)).unwrap();
    profile(folder.path(), "--patch-cell 2 --write glb,csv --step 2h");
    let bytes = std::fs::read(folder.path().join("out/surfaces.glb")).unwrap();
    let document = gltf::Gltf::from_slice(&bytes).unwrap().document;
    assert_eq!(document.nodes().count(), 2);
    let plain = document.nodes().nth(1).unwrap().mesh().unwrap().primitives().next().unwrap();
    assert!(plain.get(&gltf::Semantic::TexCoords(0)).is_none());
    assert_eq!((plain.indices().unwrap().count(), plain.material().name()), (30, Some("not judged")));
    assert_eq!(lines(folder.path()).len(), 7);
}

#[test]
fn files_are_those_that_are_asked() {
    let folder = site();
    let report = json(&profile(folder.path(), "--patch-cell 1 --json"));
    let out = || names(folder.path().join("out"));
    assert_eq!(out(), ["profile.json", "surfaces.csv", "surfaces.glb", "surfaces.png"]);
    assert_eq!(json(&std::fs::read_to_string(folder.path().join("out/profile.json")).unwrap()), report);
    assert_eq!((&report["receivers"], &report["patch_cell"]), (&"surfaces".into(), &1.0.into()));
    assert!(report["region"].is_null() && report["width"].is_null());
    let component = &report["components"][0];
    assert_eq!((&component["component"], &component["patches"]), (&"tower".into(), &6.into()));
    std::fs::remove_dir_all(folder.path().join("out")).unwrap();
    profile(folder.path(), "--write csv --patch-cell 2");
    assert_eq!(out(), ["surfaces.csv"]);
}

#[test]
fn a_cell_that_is_too_small_grows_and_says_so() {
    let folder = site();
    let output =
        gnomon(folder.path(), "profile . --receivers surfaces --write json --patch-cell 0.0001 --json --step 2h");
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let report = json(&String::from_utf8(output.stdout).unwrap());
    assert_eq!(report["patch_cell_asked"], 0.0001);
    let cell = report["patch_cell"].as_f64().unwrap();
    assert!(
        cell > 0.001 && told.contains("note: surfaces have texels of 0.006 m instead of 0.0001 m"),
        "{cell}: {told}"
    );
}

#[test]
fn what_patches_cannot_have_is_told() {
    let folder = site();
    let path = folder.path();
    for (options, words) in [
        ("profile . --receivers surfaces --cell 1", &["--cell", "plan"][..]),
        ("profile . --receivers surfaces --region 0,0,1,1", &["--region"]),
        ("profile . --receivers surfaces --masks m", &["--masks"]),
        ("profile . --receivers surfaces --stats", &["--stats"]),
        ("profile . --receivers surfaces --bits", &["--bits"]),
        ("profile . --receivers surfaces --write tif", &["tif", "png, glb, csv, json"]),
        ("profile . --write glb", &["glb", "png, tif, json"]),
        ("profile . --patch-cell 1", &["--patch-cell", "--receivers surfaces"]),
        ("profile . --receivers surfaces --patch-cell 0", &["--patch-cell", "above 0"]),
        ("profile . --receivers surfaces --patch-cell NaN", &["--patch-cell", "above 0"]),
        ("profile . --receivers surfaces --technique stencil", &["--technique"]),
        ("profile . --receivers surfaces --technique smoothie", &["--technique"]),
        ("profile . --receivers surfaces --pcf none", &["--pcf"]),
        ("shadow . --at 2026-09-18T15:00 --receivers surfaces", &["--receivers", "profile"]),
        ("verify . --receivers surfaces", &["--receivers", "beside the plan"]),
    ] {
        fails(path, options, 2, words);
    }
    let nothing = std::fs::read_to_string(path.join("site.toml")).unwrap();
    std::fs::write(path.join("site.toml"), nothing.replace("path =", "receives = false\npath =")).unwrap();
    fails(path, "profile . --receivers surfaces", 1, &["receives"]);
    assert!(!path.join("out").exists() || names(path.join("out")).is_empty());
}

/// A single sheet has no outer side: the report has that note, too.
#[test]
fn what_a_study_notes_stands_in_its_report() {
    let folder = site();
    std::fs::write(folder.path().join("sheet.obj"), "v 0 0 0\nv 10 0 0\nv 10 0 6\nv 0 0 6\nf 1 2 3 4\n").unwrap();
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    std::fs::write(folder.path().join("site.toml"), text.replace("tower.glb\"", "sheet.obj\"\nup = \"z\"")).unwrap();
    let has = |command: &str, words: &str| {
        let report = json(&done(folder.path(), &format!("{command} --engine cpu --json")));
        let notes = report["notes"].as_array().unwrap();
        assert_eq!(
            notes.iter().filter(|note| note.as_str().unwrap().contains(words)).count(),
            1,
            "{command}: {report}"
        );
    };
    has("profile . --receivers surfaces", "1 of 1 patches (60 m²) has no known outer side");
    // a disc's changes of light are not found
    let soft = "--size 20 --technique ray-cast --sun-samples 2";
    for command in ["profile .", "compare . ."] {
        has(&format!("{command} {soft}"), "hours are summed from the instants alone");
    }
    has("shadow . --at 2026-09-18T01:00 --size 20", "night: the sun is");
}
