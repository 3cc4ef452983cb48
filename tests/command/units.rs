//! Models in other units, or lying on their side: a note says what they look like and which key corrects it.

use crate::model::{Model, U32};
use crate::shared::program::{PLACE, STUDY, done, fails, gnomon, stderr};
use crate::shared::said;
use gnomon::formats::Up;
use gnomon::site::{Mend, Overrides, Site};
use serde_json::json;
use tempfile::TempDir;

/// A closed box in a file's own axes.
fn block(low: [f64; 3], high: [f64; 3]) -> Model {
    blocks(&[(low, high)])
}

pub(crate) fn blocks(boxes: &[([f64; 3], [f64; 3])]) -> Model {
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut floats, mut indices) = (Vec::new(), Vec::new());
    for (low, high) in boxes {
        let first = floats.len() as u32 / 3;
        for i in 0..8 {
            floats.extend((0..3).map(|axis| if i >> axis & 1 == 1 { high[axis] } else { low[axis] } as f32));
        }
        indices.extend(quads.iter().flat_map(|[a, b, c, d]| [a, b, c, a, c, d].map(|corner| first + corner)));
    }
    let mut model = Model::new();
    let positions = model.f32s("VEC3", &floats);
    let bytes: Vec<u8> = indices.iter().flat_map(|index: &u32| index.to_le_bytes()).collect();
    let indices = model.accessor("SCALAR", U32, indices.len(), &bytes);
    model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    model.json["nodes"] = json!([{"mesh": 0, "name": "tower"}]);
    model
}

pub(crate) fn folder(model: &Model, keys: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("model.glb"), model.glb()).unwrap();
    std::fs::write(folder.path().join("site.toml"), format!("{PLACE}[[model]]\npath = \"model.glb\"\n{keys}{STUDY}"))
        .unwrap();
    folder
}

/// A tower of 10 × 10 × 30 m on the ground, with this many units per metre.
fn tower(units: f64) -> Model {
    block([-5.0 * units, 0.0, -5.0 * units], [5.0 * units, 30.0 * units, 5.0 * units])
}

/// The same, its z up.
pub(crate) fn lying() -> Model {
    block([-5.0, -5.0, 0.0], [5.0, 5.0, 30.0])
}

fn mends(model: &Model, keys: &str) -> Vec<Mend> {
    let folder = folder(model, keys);
    let site = Site::load(folder.path(), &Overrides::default()).unwrap();
    let told: Vec<_> = site.likenesses.iter().flat_map(|likeness| likeness.mends.clone()).collect();
    for mend in &told {
        assert!(said(&site.notes).iter().any(|note| note.contains(&format!("`{mend}`"))), "{mend}: {:?}", site.notes);
    }
    told
}

/// `shared/cases/13-units-and-axis`: neither check nor a study said anything.
#[test]
fn another_unit_is_told_with_its_key() {
    for (units, words) in [
        (1000.0, "model.glb is so large that its unit may be millimetres"),
        (100.0, "model.glb is so large that its unit may be centimetres or inches"),
        (39.37, "model.glb is so large that its unit may be centimetres or inches"),
    ] {
        let folder = folder(&tower(units), "");
        let study = gnomon(folder.path(), "shadow . --at 2026-09-18T12:00 --mask m.png --engine cpu --size 50");
        for told in [done(folder.path(), "check ."), done(folder.path(), "check model.glb"), stderr(&study)] {
            assert!(told.contains(words), "{told}");
            assert_eq!(told.contains("`scale = 0.001`"), units == 1000.0, "{told}");
            assert_eq!(told.contains("`scale = 0.01`") && told.contains("`scale = 0.0254`"), units < 1000.0, "{told}");
            assert!(!told.contains("on its side") && !told.contains("km from"), "{told}");
        }
    }
    // who says it is not asked again
    assert!(mends(&tower(1000.0), "scale = 0.001\n").is_empty());
    assert!(mends(&tower(1000.0), "scale = 1.0\n").is_empty());
}

#[test]
fn what_is_plausible_in_metres_is_not_doubted() {
    let city: Vec<_> = (0..100)
        .map(|index| {
            let (x, z) = (f64::from(index % 10) * 60.0, f64::from(index / 10) * 60.0);
            ([x, 0.0, z], [x + 40.0, if index == 55 { 400.0 } else { 20.0 }, z + 40.0])
        })
        .collect();
    let plausible = [
        ("a tower", tower(1.0)),
        ("the highest building", block([-30.0, 0.0, -30.0], [30.0, 828.0, 30.0])),
        ("a slab of flats", block([0.0, 0.0, 0.0], [120.0, 45.0, 12.0])),
        ("a wall", block([0.0, -0.5, 0.0], [80.0, 3.0, 0.3])),
        ("a city with a skyscraper", blocks(&city)),
        ("a house with a deep cellar", block([0.0, -4.0, 0.0], [12.0, 8.0, 10.0])),
        ("a chair", block([0.0, 0.0, 0.0], [0.5, 0.9, 0.5])),
    ];
    for (what, model) in plausible {
        assert!(mends(&model, "").is_empty(), "{what}");
    }
    // mountains are higher than houses, and have no walls
    let mut mountain = Model::new();
    let positions =
        mountain.f32s("VEC3", &[0.0, 0.0, 0.0, 9000.0, 0.0, 0.0, 4500.0, 2500.0, -4500.0, 0.0, 0.0, -9000.0]);
    let bytes: Vec<u8> = [0_u32, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()).collect();
    let indices = mountain.accessor("SCALAR", U32, 6, &bytes);
    mountain.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    mountain.json["nodes"] = json!([{"mesh": 0}]);
    assert!(mends(&mountain, "").is_empty());
}

/// STL is assumed to have z up, but may have y up.
#[test]
fn a_model_that_is_taken_for_z_up_may_lie_the_other_way() {
    let [low, high] = [[-5.0, 0.0, -5.0], [5.0, 30.0, 5.0]];
    let corner = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { low[axis] } else { high[axis] });
    let mut text = String::from("solid tower\n");
    for [a, b, c, d] in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle.map(corner) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text += "endsolid\n";
    let site = |keys: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("model.stl"), &text).unwrap();
        let written = format!("{PLACE}[[model]]\npath = \"model.stl\"\n{keys}{STUDY}");
        std::fs::write(folder.path().join("site.toml"), written).unwrap();
        Site::load(folder.path(), &Overrides::default()).unwrap()
    };
    let lying = site("");
    assert_eq!(lying.likenesses[0].mends, [Mend::Up(Up::Y)]);
    let words = "model.stl looks as if it lies on its side, with its y up";
    assert!(
        said(&lying.notes).iter().any(|note| note.contains(words) && note.contains("`up = \"y\"`")),
        "{:?}",
        lying.notes
    );
    let standing = site("up = \"y\"\n");
    assert!(standing.likenesses.is_empty());
    assert_eq!((lying.mesh.top(), standing.mesh.top()), (5.0, 30.0));
}

#[test]
fn a_model_on_its_side_is_told_and_stands_with_its_key() {
    let words = "model.glb looks as if it lies on its side";
    let folder = folder(&lying(), "");
    let study = gnomon(folder.path(), "shadow . --at 2026-09-18T12:00 --mask m.png --engine cpu --size 50");
    let [by_site, by_model] = ["check .", "check model.glb"].map(|command| done(folder.path(), command));
    for (told, key) in [(by_site, "`up = \"z\"`"), (by_model, "--up z"), (stderr(&study), "`up = \"z\"`")] {
        assert!(told.contains(words) && told.contains(key) && !told.contains("scale"), "{told}");
    }
    assert!(!done(folder.path(), "check model.glb --up z").contains(words));
    assert!(mends(&lying(), "up = \"y\"\n").is_empty());
    let top = |keys: &str, asked: &Overrides| {
        let folder = self::folder(&lying(), keys);
        let site = Site::load(folder.path(), asked).unwrap();
        assert!(site.likenesses.is_empty());
        site.mesh.top()
    };
    assert_eq!(top("up = \"z\"\n", &Overrides::default()), 30.0);
    let asked = Overrides { up: Some("z".parse().unwrap()), ..Overrides::default() };
    assert_eq!(top("", &asked), 30.0);
    assert_eq!(top("up = \"y\"\n", &asked), 30.0);

    // a house whose roof looks south instead of up
    let mut house = Model::new();
    let corners: [[f32; 3]; 6] = [
        [20.0, 30.0, 3.0],
        [30.0, 30.0, 3.0],
        [20.0, 34.0, 6.0],
        [30.0, 34.0, 6.0],
        [20.0, 38.0, 3.0],
        [30.0, 38.0, 3.0],
    ];
    let positions = house.f32s("VEC3", &corners.concat());
    let bytes: Vec<u8> =
        [0_u32, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4].iter().flat_map(|index| index.to_le_bytes()).collect();
    let indices = house.accessor("SCALAR", U32, 12, &bytes);
    house.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    house.json["nodes"] = json!([{"mesh": 0}]);
    assert_eq!(mends(&house, "north = 30.0\n").len(), 1);
}

#[test]
fn an_axis_that_is_none_is_refused() {
    let folder = folder(&lying(), "up = \"x\"\n");
    fails(folder.path(), "check .", 1, &["site.toml", "up", "\"x\" is not one of y, z"]);
    let other = self::folder(&lying(), "");
    let wrong = gnomon(other.path(), "check model.glb --up x");
    assert_eq!(wrong.status.code(), Some(2), "{}", stderr(&wrong));
    let sun = gnomon(other.path(), "sun . --up z");
    assert_eq!(sun.status.code(), Some(2), "{}", stderr(&sun));
}

#[test]
fn both_states_of_a_comparison_are_turned_up() {
    let folder = folder(&lying(), "");
    std::fs::copy(folder.path().join("site.toml"), folder.path().join("after.toml")).unwrap();
    let asked = Overrides { up: Some("z".parse().unwrap()), ..Overrides::default() };
    let pair = gnomon::site::Pair::load(folder.path(), &folder.path().join("after.toml"), &asked).unwrap();
    assert_eq!([pair.before.mesh.top(), pair.after.mesh.top()], [30.0, 30.0]);
}

#[test]
fn samples_and_their_tables_say_nothing_of_units() {
    for name in ["tower", "industry", "headquarters"] {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides::default()).unwrap();
        assert!(
            site.likenesses.is_empty() && !said(&site.notes).iter().any(|note| note.contains("looks")),
            "{name}: {:?}",
            site.notes
        );
    }
}
