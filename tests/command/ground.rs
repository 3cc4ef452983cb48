//! The height of the ground: where it comes from, what the default is, and where it is reported.

use crate::model::{Model, U16};
use crate::shared::program::{command, done, fails, stderr};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;
use tiff::decoder::{Decoder, DecodingResult};

const STUDY: &str = "
[study]
date = 2026-03-21
from = \"9:00\"
to = \"15:00\"
step = \"10min\"
[plan]
region = [-60, -20, 60, 60]
cell = 0.5
";

/// A part's name, its corners (east, north, up) and its triangles.
type Named<'a> = (&'a str, Vec<[f32; 3]>, Vec<u16>);

/// Named parts as a binary glTF. Those of one name that follow each other are one node, each of a material of its own.
pub(crate) fn model(parts: &[Named<'_>]) -> Vec<u8> {
    let mut model = Model::new();
    let (mut meshes, mut nodes, mut materials) = (Vec::new(), Vec::new(), Vec::new());
    for node in parts.chunk_by(|one, other| one.0 == other.0) {
        nodes.push(json!({"mesh": meshes.len(), "name": node[0].0}));
        let primitives: Vec<Value> = node.iter().map(|part| primitive(&mut model, &mut materials, part)).collect();
        meshes.push(json!({"primitives": primitives}));
    }
    (model.json["meshes"], model.json["nodes"]) = (meshes.into(), nodes.into());
    model.json["materials"] = materials.into();
    model.glb()
}

fn primitive(model: &mut Model, materials: &mut Vec<Value>, (_, corners, triangles): &Named<'_>) -> Value {
    let corners: Vec<f32> = corners.iter().flat_map(|[east, north, up]| [*east, *up, -north]).collect();
    let bytes: Vec<u8> = triangles.iter().flat_map(|index| index.to_le_bytes()).collect();
    let positions = model.f32s("VEC3", &corners);
    let indices = model.accessor("SCALAR", U16, triangles.len(), &bytes);
    materials.push(json!({"name": format!("material {}", materials.len())}));
    json!({"attributes": {"POSITION": positions}, "indices": indices, "material": materials.len() - 1})
}

/// A closed box between two heights, around a middle east and north, with a half width.
pub(crate) fn block(
    name: &str,
    [east, north]: [f32; 2],
    half: f32,
    [low, high]: [f32; 2],
) -> (&str, Vec<[f32; 3]>, Vec<u16>) {
    let side = |i: usize, bit: usize, low: f32, high: f32| if i >> bit & 1 == 1 { high } else { low };
    let corner =
        |i| [side(i, 0, east - half, east + half), side(i, 1, north - half, north + half), side(i, 2, low, high)];
    let sides: [[u16; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    (name, (0..8).map(corner).collect(), triangles)
}

/// A sheet of 200 × 200 m that rises from one height in the west to another in the east.
fn slope(name: &str, [west, east]: [f32; 2]) -> (&str, Vec<[f32; 3]>, Vec<u16>) {
    let corners = vec![[-100.0, -100.0, west], [100.0, -100.0, east], [100.0, 100.0, east], [-100.0, 100.0, west]];
    (name, corners, vec![0, 1, 2, 0, 2, 3])
}

/// A folder with models and a site for each, with the same name; `ground` is added to its text.
fn sites(models: &[(&str, Vec<u8>, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, model, ground) in models {
        std::fs::write(folder.path().join(format!("{name}.glb")), model).unwrap();
        let place = "[place]\nlatitude = 48.2\nlongitude = 16.37\n";
        let text = format!("{place}[[model]]\npath = \"{name}.glb\"\n{ground}{STUDY}");
        std::fs::write(folder.path().join(format!("{name}.toml")), text).unwrap();
    }
    folder
}

/// A tower of 10 × 10 × 30 m with a cellar of 12 m, and without.
fn towers() -> TempDir {
    let tower = |low| model(&[block("tower", [0.0; 2], 5.0, [low, 30.0])]);
    sites(&[
        ("cellar", tower(-12.0), ""),
        ("said", tower(-12.0), "[ground]\nlevel = 0.0\n"),
        ("without", tower(0.0), ""),
    ])
}

/// The report of a command, and its notes.
fn told(folder: &Path, arguments: &str) -> (Value, String) {
    let output = command(folder, &format!("{arguments} --engine cpu --json")).output().unwrap();
    assert!(output.status.success(), "{arguments}: {}", stderr(&output));
    (serde_json::from_slice(&output.stdout).unwrap(), stderr(&output))
}

fn ground(report: &Value) -> (f64, &str, f64) {
    let number = |key: &str| report[key].as_f64().unwrap();
    (number("ground"), report["ground_from"].as_str().unwrap(), number("models_below_ground_m"))
}

/// Hours of shadow on the plan, m²·h.
fn shaded(folder: &Path) -> f64 {
    let mut decoder = Decoder::new(std::fs::File::open(folder.join("shadow-hours.tif")).unwrap()).unwrap();
    let DecodingResult::F32(hours) = decoder.read_image().unwrap() else { panic!("not f32") };
    hours.into_iter().map(f64::from).sum::<f64>() * 0.25
}

/// A raster of the projected box with pvlib's sun comes to 3762.1 m²·h; on the cellar's floor it is a third more.
#[test]
fn a_cellar_shades_nothing() {
    let folder = towers();
    let path = folder.path();
    for (site, expected) in [
        ("cellar", (0.0, "zero", 12.0)),
        ("said", (0.0, "site", 12.0)),
        ("without", (0.0, "lowest", 0.0)),
        ("cellar --ground 0", (0.0, "site", 12.0)),
    ] {
        let asked = site.replacen(' ', ".toml ", 1);
        let asked = if asked == site { format!("{site}.toml") } else { asked };
        let (report, notes) = told(path, &format!("profile {asked} --receivers ground --resolution step"));
        assert_eq!(ground(&report), expected, "{site}");
        let hours = shaded(&path.join("out"));
        assert!((hours - 3762.1).abs() < 1.0, "{site}: {hours}");
        let note = "the ground is at 0.00 m, where the models' own zero is; 12.00 m of the models lie below it";
        assert_eq!(notes.contains(note), expected.1 == "zero", "{site}: {notes}");
        assert!(expected.1 == "zero" || !notes.contains("ground"), "{site}: {notes}");
    }
    let (report, _) = told(path, "profile cellar.toml --receivers ground --ground -12 --resolution step");
    assert_eq!(ground(&report), (-12.0, "site", 0.0));
    assert!((shaded(&path.join("out")) - 5015.0).abs() < 2.0);
}

/// At noon the shadow of 30 m is 30 / tan 42.15° long: 33.1 m.
#[test]
fn the_noon_shadow_is_that_of_what_stands_above() {
    let folder = towers();
    let shadow = "shadow cellar.toml --at 12:02 --receivers ground --mask noon.png --engine cpu";
    done(folder.path(), shadow);
    let mask = image::open(folder.path().join("noon.png")).unwrap().into_luma8();
    // the column under the tower's middle, from its north wall up the sheet
    let dark = (0..mask.height()).filter(|row| mask.get_pixel(120, *row).0[0] == 0 && f64::from(*row) < 110.0).count();
    assert!((dark as f64 * 0.5 - 33.1).abs() <= 0.5, "{dark}");
}

#[test]
fn states_share_one_ground() {
    let folder = towers();
    let path = folder.path();
    for (pair, expected) in
        [("cellar.toml without.toml", (0.0, "zero", 12.0)), ("without.toml cellar.toml", (0.0, "lowest", 12.0))]
    {
        let (report, _) = told(path, &format!("compare {pair}"));
        assert_eq!(ground(&report), expected, "{pair}");
        for change in ["sun_lost", "sun_gained"] {
            assert_eq!(report[change]["m2_hours"], 0.0, "{pair}");
            assert_eq!(report[change]["more_than"][0]["area_m2"], 0.0, "{pair}");
        }
    }
    // a platform that nothing lies below, and a cellar under it: the ground is the platform's, and that is told
    let platform = |parts: &[[f32; 2]]| {
        model(&parts.iter().map(|heights| block("part", [0.0; 2], 5.0, *heights)).collect::<Vec<_>>())
    };
    let folder = sites(&[
        ("platform", platform(&[[2.0, 8.0]]), ""),
        ("dug", platform(&[[2.0, 8.0], [-3.0, 2.0]]), ""),
        ("low", platform(&[[2.0, 8.0]]), "[ground]\nlevel = 0.0\n"),
    ]);
    let path = folder.path();
    let (report, notes) = told(path, "compare platform.toml dug.toml");
    assert_eq!(ground(&report), (2.0, "lowest", 5.0));
    let note =
        "dug.toml has the ground of platform.toml, 2.00 m, since a comparison has only one; alone it would have 0.00 m";
    assert!(notes.contains(note), "{notes}");
    assert_eq!(report["sun_lost"]["m2_hours"], 0.0);
    let (_, notes) = told(path, "compare platform.toml platform.toml");
    assert!(!notes.contains("ground"), "{notes}");
    fails(
        path,
        "compare platform.toml low.toml",
        1,
        &["low.toml, [ground] level", "differs from the ground of", "2 m"],
    );
    let (report, _) = told(path, "compare platform.toml low.toml --ground -0.5");
    assert_eq!(ground(&report), (-0.5, "site", 0.0));
}

/// Rounding does not make a cellar: a model that reaches less than a millimetre below 0 stands on 0.
#[test]
fn models_on_zero_stand_on_their_lowest_point() {
    let tower = |low, high| model(&[block("tower", [0.0; 2], 5.0, [low, high])]);
    let folder = sites(&[
        ("rounded", tower(-1e-6, 30.0), ""),
        ("hair", tower(-0.0009, 30.0), ""),
        ("through", tower(-0.002, 30.0), ""),
        ("above", tower(402.5, 430.0), ""),
        ("buried", tower(-30.0, 0.0005), ""),
    ]);
    for (site, level, from) in [
        ("rounded", -1e-6, "lowest"),
        ("hair", -0.0009, "lowest"),
        ("through", 0.0, "zero"),
        ("above", 402.5, "lowest"),
        ("buried", -30.0, "lowest"),
    ] {
        let (report, notes) = told(folder.path(), &format!("shadow {site}.toml --at 12:00 --mask m.png"));
        let (ground, who, _) = ground(&report);
        assert!((ground - level).abs() < 1e-6 && who == from, "{site}: {ground} {who}");
        assert_eq!(notes.contains("the ground is at"), from == "zero", "{site}: {notes}");
    }
}

/// Terrain that falls below 0 is not hidden by a plane at 0: the hours on it are those on a sheet above nothing. If
/// that plane is requested, a note says what it hides.
#[test]
fn terrain_is_judged_as_what_it_is() {
    let tower = || block("tower", [0.0; 2], 5.0, [-8.0, 30.0]);
    let strip = |south: f32| -> Named<'static> {
        let (name, corners, triangles) = slope("meadow", [-3.0, 5.0]);
        let along = |[east, north, up]: [f32; 3]| [east, south + (north + 100.0) / 8.0, up];
        (name, corners.into_iter().map(along).collect(), triangles)
    };
    let strips = (0..8_u8).map(|at| strip(-100.0 + 25.0 * f32::from(at)));
    let folder = sites(&[
        ("hill", model(&[slope("meadow", [-3.0, 5.0]), tower()]), ""),
        // the same of one node in eight materials, none of which is a quarter of it
        ("mosaic", model(&strips.into_iter().chain([tower()]).collect::<Vec<_>>()), ""),
        ("polder", model(&[slope("meadow", [-0.42, -0.42]), block("house", [0.0; 2], 5.0, [-0.4, 9.0])]), ""),
        // no terrain: a sheet over the house, and a floor in its cellar that nobody sees from above
        (
            "roofed",
            model(&[block("house", [0.0; 2], 20.0, [-4.0, 6.0]), slope("roof", [7.0, 7.0]), slope("floor", [-4.0; 2])]),
            "",
        ),
    ]);
    let path = folder.path();
    let (report, notes) = told(path, "profile hill.toml");
    assert_eq!(ground(&report), (-8.0, "lowest", 0.0));
    let note = "the ground is at -8.00 m, the models' lowest point: at their own zero it would hide 38 % of what is seen of \
                \"meadow\"";
    assert!(notes.contains(note), "{notes}");
    let (report, notes) = told(path, "profile mosaic.toml --out mosaic");
    assert_eq!(ground(&report), (-8.0, "lowest", 0.0));
    assert!(notes.contains("it would hide 38 % of what is seen of \"meadow/material"), "{notes}");
    let found = std::fs::read(path.join("out/shadow-hours.tif")).unwrap();
    told(path, "profile hill.toml --ground -50");
    assert!(found == std::fs::read(path.join("out/shadow-hours.tif")).unwrap(), "the plane lies under all of it");
    let (report, notes) = told(path, "profile hill.toml --ground 0");
    assert_eq!(ground(&report), (0.0, "site", 8.0));
    let note = "the ground hides 38 % of what is seen of the models from above, of \"meadow\" most";
    assert!(notes.contains(note), "{notes}");
    let (report, _) = told(path, "profile polder.toml");
    assert_eq!(
        (&report["ground_from"], (report["ground"].as_f64().unwrap() * 1e4).round()),
        (&"lowest".into(), -4200.0)
    );
    let (report, notes) = told(path, "profile roofed.toml");
    assert_eq!(ground(&report), (0.0, "zero", 4.0));
    assert!(!notes.contains("hides"), "{notes}");
}

#[test]
fn the_ground_stands_in_every_answer() {
    let folder = towers();
    let path = folder.path();
    let line = "ground at -1.50 m; the models reach 10.50 m below it\n";
    let plan = "--ground -1.5 --engine cpu --size 40";
    for asked in [
        format!("profile cellar.toml {plan} --draw hours,outlines --step 1h"),
        "profile cellar.toml --ground -1.5 --engine cpu --receivers surfaces --patch-cell 5 --step 3h --out walls"
            .into(),
        format!("compare cellar.toml without.toml {plan} --step 3h"),
        format!("shadow cellar.toml {plan} --at 12:00"),
        format!("animate cellar.toml {plan} --step 3h --width 320"),
        "volumes cellar.toml --ground -1.5 --at 12:00".into(),
        "probe cellar.toml --ground -1.5 --point 0,20,1".into(),
        "verify cellar.toml --ground -1.5 --at 12:00 --size 32".into(),
    ] {
        let said = done(path, &asked);
        assert!(said.contains(line), "{asked}: {said}");
    }
    for svg in ["hours.svg", "outlines.svg"] {
        let svg = std::fs::read_to_string(path.join("out").join(svg)).unwrap();
        assert!(svg.contains(">Ground<") && svg.contains("−1.50 m; models reach 10.50 m below"), "{svg:.3000}");
    }
    for asked in ["volumes cellar.toml --at 12:00", "probe cellar.toml --point 0,20,1"] {
        let report: Value = serde_json::from_str(&done(path, &format!("{asked} --json --ground 2"))).unwrap();
        assert_eq!(ground(&report), (2.0, "site", 14.0), "{asked}");
    }
    let report: Value =
        serde_json::from_str(&done(path, "verify cellar.toml --at 12:00 --size 32 --json --ground 2")).unwrap();
    assert_eq!(ground(&report), (2.0, "site", 14.0));
}

#[test]
fn a_ground_that_is_none_is_refused() {
    let folder = towers();
    for level in ["nan", "inf", "1e9"] {
        let asked = format!("profile cellar.toml --ground {level}");
        fails(folder.path(), &asked, 2, &["--ground", "not a height of the ground", "0.0"]);
    }
    fails(folder.path(), "profile cellar.toml --ground low", 2, &["--ground", "low"]);
    // no sun position asks for it
    fails(folder.path(), "sun cellar.toml --ground 0", 2, &["--ground"]);
}

/// A probe below the ground is reported as such, for one day and for several, in every output.
#[test]
fn a_probe_under_the_ground_says_so() {
    let folder = towers();
    let path = folder.path();
    let day = done(path, "probe cellar.toml --point 20,0,-1.5 --out below.png");
    assert!(day.contains("1.50 m below the ground: no sun reaches it\n"), "{day}");
    assert!(day.contains("no sun: the point lies below the ground"), "{day}");
    let days = done(path, "probe cellar.toml --point 20,0,-1.5 --from-date 2026-03-20 --to-date 2026-03-22");
    assert!(days.contains("1.50 m below the ground: no sun reaches it\n"), "{days}");
    let json = |point: &str| -> Value {
        serde_json::from_str(&done(path, &format!("probe cellar.toml --point {point} --json"))).unwrap()
    };
    let [below, above] = ["20,0,-1.5", "20,0,0"].map(json);
    assert_eq!((&below["probes"][0]["below_ground_m"], &below["probes"][0]["seconds"]), (&1.5.into(), &0.into()));
    assert_eq!(above["probes"][0]["below_ground_m"], Value::Null);
    assert!(above["probes"][0]["seconds"].as_i64().unwrap() > 0);
    // a wall that stands in the shade says what it did
    let shade = done(path, "probe without.toml --point 0,5,1 --normal 0,-1,0");
    assert!(shade.contains("it stays behind what casts") && !shade.contains("below the ground"), "{shade}");
}
