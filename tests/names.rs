//! Names of components and files in site files, and the results of sites whose models need more than their triangles to
//! be read.

use crate::model::poses::{morphing, skinned};
use crate::model::{Model, push};
use crate::shared::said;
use crate::site::{SITE, folder, tower};
use gnomon::choice::{Engine, Receivers};
use gnomon::site::{Models, Overrides, Site, WrittenSite};
use gnomon::study::{self, Wants};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::Path;

/// Whether tower and yard cast, where the tower is of iron and the yard of grass.
fn casts(list: &str) -> Result<Vec<bool>, String> {
    let site = SITE.replace("casts = [\"iron\"]", &format!("casts = {list}"));
    let site = Site::load_with(folder(&site).path(), &Overrides::default(), tower);
    site.map(|site| site.casts).map_err(|error| error.to_string())
}

#[test]
fn a_list_may_say_what_does_not_cast() {
    let cases = [
        (r#"["!grass"]"#, [true, false]),
        (r#"["!iron", "!yard"]"#, [false, false]),
        (r#"["tower", "grass"]"#, [true, true]),
        (r#"["tower", "yard", "!iron"]"#, [false, true]),
        (r#"["!yard", "yard"]"#, [false, false]),
        ("[]", [false, false]),
    ];
    for (list, expected) in cases {
        assert_eq!(casts(list).unwrap(), expected, "{list}");
    }
    let told = casts(r#"["!gras"]"#).unwrap_err();
    assert!(told.contains("named \"!gras\"; the nearest is \"!grass\""), "{told}");
    let told = casts(r#"["tower", "!"]"#).unwrap_err();
    assert!(told.contains("named \"!\""), "{told}");
}

/// Where something is really named `!grass`, that is meant; with one more `!` it is what does not cast.
#[test]
fn names_may_begin_with_a_mark() {
    let marked = |path: &Path, placement: &_| {
        let mut model = tower(path, placement)?;
        model.parts[1].aliases[1] = "!grass".to_owned();
        Ok(model)
    };
    for (list, expected) in [("!grass", [false, true]), ("!!grass", [true, false])] {
        let site = SITE.replace("\"iron\"", &format!("\"{list}\""));
        let site = Site::load_with(folder(&site).path(), &Overrides::default(), marked).unwrap();
        assert_eq!(site.casts, expected, "{list}");
    }
}

#[test]
fn names_match_however_they_are_composed() {
    let (composed, apart) = ("Fa\u{e7}ade", "Fac\u{327}ade");
    for (own, asked) in [(composed, apart), (apart, composed), (apart, apart)] {
        let named = |path: &Path, placement: &_| {
            let mut model = tower(path, placement)?;
            model.parts[0].aliases[1] = own.to_owned();
            Ok(model)
        };
        for (list, expected) in [(asked.to_owned(), [true, false]), (format!("!{asked}"), [false, true])] {
            let site = SITE.replace("\"iron\"", &format!("\"{list}\""));
            let site = Site::load_with(folder(&site).path(), &Overrides::default(), named).unwrap();
            assert_eq!(site.casts, expected, "{list:?}");
        }
        let site = SITE.replace("\"iron\"", &format!("\"{asked}s\""));
        let told = Site::load_with(folder(&site).path(), &Overrides::default(), named).unwrap_err().to_string();
        assert!(told.contains(&format!("named \"{asked}s\"; the nearest is \"{own}\"")), "{told}");
    }
}

/// macOS decomposes letters in file names, but other sources do not.
#[test]
fn files_are_found_however_their_names_are_composed() {
    let (composed, apart) = ("Fa\u{e7}ade", "Fac\u{327}ade");
    for (on_disk, written) in [(composed, apart), (apart, composed), (apart, apart)] {
        let site = SITE.replace("tower.glb", &format!("{written}/{written}.glb"));
        let folder = folder(&site);
        let models = folder.path().join(on_disk);
        std::fs::create_dir(&models).unwrap();
        std::fs::write(models.join(format!("{on_disk}.glb")), "").unwrap();
        let read = WrittenSite::read(folder.path(), &Overrides::default()).unwrap();
        let models = Models::read(&read, tower).unwrap();
        assert!(models.are_those_of(&read));
        assert_eq!(models.changed_file(), None);
        std::fs::write(folder.path().join(on_disk).join(format!("{on_disk}.glb")), "changed").unwrap();
        assert!(models.changed_file().is_some(), "{on_disk:?}");
        std::fs::rename(folder.path().join("site.toml"), folder.path().join(format!("{on_disk}.toml"))).unwrap();
        let site = folder.path().join(format!("{written}.toml"));
        Site::load_with(&site, &Overrides::default(), tower).expect("the site file itself");
    }
    let two = folder(&SITE.replace("tower.glb", &format!("{composed}.glb")));
    std::fs::write(two.path().join(format!("{apart}s.glb")), "").unwrap();
    let told = Site::load_with(two.path(), &Overrides::default(), tower).unwrap_err().to_string();
    assert!(told.contains("[[model]] path") && told.contains("there is no file"), "{told}");

    // a buffer beside a model
    let mut model = Model::triangle();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(format!("{apart}.bin")), &model.bytes).unwrap();
    model.json["buffers"] = json!([{"byteLength": model.bytes.len(), "uri": "Fa%C3%A7ade.bin"}]);
    let path = folder.path().join("model.gltf");
    std::fs::write(&path, model.gltf().to_string()).unwrap();
    assert_eq!(crate::model::load_path(&path).unwrap().len(), 1);
}

#[test]
fn a_scene_is_named_in_the_site_file() {
    let mut model = crate::model::poses::tower(30.0);
    model.json["nodes"] = json!([{"mesh": 0, "name": "tower"}, {"mesh": 0, "name": "shed", "scale": [1, 0.1, 1]}]);
    model.json["scenes"] = json!([{"nodes": [0], "name": "existing"}, {"nodes": [0, 1], "name": "proposed"}]);
    let read = |key: &str| {
        let folder = folder(&SITE.replace("casts = [\"iron\"]", key));
        std::fs::write(folder.path().join("tower.glb"), model.glb()).unwrap();
        Site::load(folder.path(), &Overrides::default()).map_err(|error| error.to_string())
    };
    let components = |key: &str| read(key).unwrap().mesh.components.len();
    assert_eq!((components(""), components("scene = 1"), components("scene = \"proposed\"")), (1, 2, 2));
    let notes = said(&read("").unwrap().notes);
    assert!(notes[0].starts_with("tower.glb has 2 scenes, of which \"existing\" (0) is read"), "{notes:?}");
    assert!(read("scene = \"existing\"").unwrap().notes.is_empty());
    let told = read("scene = \"propsed\"").unwrap_err();
    for word in ["site.toml, [[model]] scene", "no scene \"propsed\"", "\"existing\" (0) and \"proposed\" (1)"] {
        assert!(told.contains(word), "'{word}' is missing in: {told}");
    }
    for wrong in ["scene = -1", "scene = 1.5", "scene = [\"a\"]"] {
        let told = read(wrong).unwrap_err();
        assert!(told.contains("[[model]] scene") && told.contains("scene = \"existing\""), "{told}");
    }
}

/// Another scene is another model: the one that was read is not reused.
#[test]
fn models_are_read_again_for_another_scene() {
    let folder = folder(SITE);
    let mut written = WrittenSite::read(folder.path(), &Overrides::default()).unwrap();
    let models = Models::read(&written, tower).unwrap();
    written.site.model[0].scene = Some(gnomon::formats::SceneName::Number(1));
    assert!(!models.are_those_of(&written));
    let text = written.site.to_toml().unwrap();
    assert!(text.contains("scene = 1"), "{text}");
}

/// Transparent components that cast are reported as long as they cast.
#[test]
fn see_through_materials_that_cast_are_told() {
    let mut model = crate::model::poses::tower(30.0);
    model.json["materials"] = json!([
        {"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.3]}},
        {"name": "leaves", "alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
        {"name": "brick"},
    ]);
    let primitive = model.primitive().clone();
    let mesh = |material: usize| {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(material);
        json!({"primitives": [primitive]})
    };
    model.json["meshes"] = (0..3).map(mesh).collect();
    model.json["nodes"] = json!([{"mesh": 0, "name": "front"}, {"mesh": 1, "name": "tree"}, {"mesh": 1, "name": "bush"},
        {"mesh": 2, "name": "house"}]);
    let notes = |key: &str| {
        let folder = folder(&SITE.replace("casts = [\"iron\"]", key));
        std::fs::write(folder.path().join("tower.glb"), model.glb()).unwrap();
        let notes = Site::load(folder.path(), &Overrides::default()).unwrap().notes;
        assert_eq!(
            gnomon::site::load_mesh(folder.path(), &Overrides::default()).unwrap().notes,
            notes,
            "check says the same"
        );
        said(&notes)
    };
    let of_three = "tower.glb has 3 components of cut-out or translucent materials, which cast as if solid: \"leaves\" (2) \
                    and \"glass\" (1); casts = [\"!leaves\"] under [[model]] leaves \"leaves\" out";
    assert_eq!(notes(""), [of_three]);
    let of_one = "tower.glb has 1 component of cut-out or translucent materials, which casts as if solid: \"glass\" (1); \
                  casts = [\"!glass\"] under [[model]] leaves \"glass\" out";
    assert_eq!(notes("casts = [\"!leaves\"]"), [of_one]);
    assert!(notes("casts = [\"!leaves\", \"!glass\"]").is_empty());
    assert!(notes("casts = [\"house\"]").is_empty());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tower.glb");
    std::fs::write(&path, model.glb()).unwrap();
    let of_bare = of_three.replace("under [[model]]", "under [[model]] in a site file");
    assert_eq!(said(&gnomon::site::load_mesh(&path, &Overrides::default()).unwrap().notes), [of_bare], "a bare model");
}

/// The sum of a study's shadow on the ground, m²·h.
fn shaded_m2_hours(model: &Model) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("tower.glb"), model.glb()).unwrap();
    let site = "[place]\nlatitude = 48.2\nlongitude = 16.37\n[[model]]\npath = \"tower.glb\"\n[ground]\nlevel = 0.0\n\
                [study]\ndate = 2026-03-21\nfrom = \"9:00\"\nto = \"15:00\"\nstep = \"1h\"\n\
                resolution = \"step\"\n[plan]\nregion = [-70, -10, 70, 70]\ncell = 0.5\n";
    std::fs::write(folder.path().join("site.toml"), site).unwrap();
    let (receivers, engine) = (Some(Receivers::Ground), Some(Engine::Cpu));
    let site = Site::load(folder.path(), &Overrides { receivers, engine, ..Overrides::default() }).unwrap();
    let outcome = study::run(&site, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    let cells = outcome.profile.shaded.iter().map(|shaded| shaded as f64 / 255.0 / 3600.0);
    cells.sum::<f64>() * 0.25
}

/// A tower of 10 × 10 × 30 m on the origin, in five ways that glTF has to say it. Its shadow is that of the same tower as
/// plain triangles, which ray casting bears out; the number is that of shared case 04.
#[test]
fn the_same_tower_has_the_same_shadow() {
    let mut of_mesh = morphing();
    of_mesh.json["meshes"][0]["weights"] = json!([1, 0]);
    let mut of_node = morphing();
    of_node.json["nodes"][0]["weights"] = json!([1, 0]);
    let in_cm = skinned(100.0, json!({"scale": [0.01, 0.01, 0.01]}));
    let mut moved = skinned(1.0, json!({}));
    moved.json["nodes"][0]["translation"] = json!([50, 0, 0]);
    let mut with_option = crate::model::poses::tower(30.0);
    let option =
        json!({"mesh": 0, "translation": [-30, 0, -20], "extensions": {"KHR_node_visibility": {"visible": false}}});
    push(&mut with_option.json["nodes"], option);
    let plain = shaded_m2_hours(&crate::model::poses::tower(30.0));
    assert!((plain - 3787.5).abs() < 1e-6, "{plain}");
    for (what, model) in [
        ("weights of the mesh", of_mesh),
        ("weights of the node", of_node),
        ("a joint that scales", in_cm),
        ("a skinned node that is moved", moved),
        ("a hidden option", with_option),
    ] {
        assert_eq!(shaded_m2_hours(&model), plain, "{what}");
    }
}

/// The note is printed with every result: on stderr, in the report, by check on stdout.
#[test]
fn what_is_left_out_is_told_with_every_answer() {
    let folder = crate::shared::program::site();
    let mut model = crate::model::poses::tower(20.0);
    push(
        &mut model.json["nodes"],
        json!({"mesh": 0, "name": "B", "extensions": {"KHR_node_visibility": {"visible": false}}}),
    );
    std::fs::write(folder.path().join("tower.glb"), model.glb()).unwrap();
    let told = "tower.glb has 1 node with a mesh that is hidden (KHR_node_visibility) and left out, at \"B\"";
    let noted = json!([told]);
    for study in [
        "profile . --engine cpu --size 64 --json",
        "profile . --receivers surfaces --engine cpu --patch-cell 5 --json",
        "compare . . --engine cpu --size 64 --json",
        "shadow . --at 2026-09-18T11:00 --size 64 --engine cpu --json",
        "animate . --width 320 --engine cpu --size 64 --json",
        "probe . --date 2026-09-18 --point 0,-9,1 --json",
        "volumes . --at 2026-09-18T11:00 --out volumes.glb --json",
    ] {
        let output = crate::shared::program::gnomon(folder.path(), study);
        let stderr = crate::shared::program::stderr(&output);
        assert!(stderr.contains(&format!("note: {told}\n")), "{study}: {stderr}");
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect(study);
        assert_eq!(report["notes"], noted, "{study}");
    }
    let report = std::fs::read_to_string(folder.path().join("out/profile.json")).unwrap();
    assert_eq!(serde_json::from_str::<serde_json::Value>(&report).unwrap()["notes"], noted);
    let check = crate::shared::program::done(folder.path(), "check tower.glb");
    assert!(check.contains(&format!("\nnote: {told}\n")), "{check}");
    let check = crate::shared::program::done(folder.path(), "check . --json");
    assert_eq!(serde_json::from_str::<serde_json::Value>(&check).unwrap()["notes"], noted);
}
