//! `gnomon volumes`: the model, the output about it, and errors.

use crate::shared::program::{PLACE, done, fails, gnomon, names, site, stderr};
use serde_json::Value;

#[test]
fn volumes_are_a_model_that_others_read() {
    let folder = site();
    let path = folder.path().join("volumes.glb");
    let said = done(folder.path(), "volumes . --at 2026-09-18T15:00");
    assert!(said.starts_with("volumes.glb\n1 shadow volume of "), "{said}");

    let file = gltf::Gltf::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let node = file.default_scene().unwrap().nodes().next().unwrap();
    let extras: Value = serde_json::from_str(node.extras().as_ref().unwrap().get()).unwrap();
    assert_eq!((node.name(), &extras["caster"]), (Some("tower"), &"tower".into()));
    assert_eq!(extras["time"], "2026-09-18T15:00:00+02:00");
    let scene: Value = serde_json::from_str(file.default_scene().unwrap().extras().as_ref().unwrap().get()).unwrap();
    assert_eq!((&scene["place"]["name"], &scene["ground"]), (&"Paris".into(), &0.0.into()));
    let material = file.materials().next().unwrap();
    assert!(material.double_sided() && material.alpha_mode() == gltf::material::AlphaMode::Blend);

    let sun: Value = serde_json::from_str(&done(folder.path(), "sun . --at 2026-09-18T15:00 --json")).unwrap();
    for key in ["time", "azimuth_deg", "altitude_deg"] {
        assert_eq!(extras[key], sun["instants"][0][key]);
    }
    // our own reader finds the caster's name, and a solid with the shadow's length
    let mesh = gnomon::site::load_mesh(&path, &gnomon::site::Overrides::default()).unwrap().mesh;
    assert_eq!(mesh.components[0].name, "tower");
    assert!(gnomon::mesh::report::components(&mesh)[0].closed);
    let (low, high) = mesh.bounds().unwrap();
    let altitude_rad = extras["altitude_deg"].as_f64().unwrap().to_radians();
    let azimuth_rad = extras["azimuth_deg"].as_f64().unwrap().to_radians();
    assert!((high.y - 5.0 + 20.0 / altitude_rad.tan() * azimuth_rad.cos()).abs() < 1e-3);
    assert_eq!((low.z, high.z), (0.0, 20.0));
}

#[test]
fn volumes_say_what_they_did() {
    let folder = site();
    let options = "volumes open.glb --place 48.8583,2.2945 --at 15:00 --date 2026-09-18 --out a/v.glb";
    let json: Value = serde_json::from_str(&done(folder.path(), &format!("{options} --json"))).unwrap();
    assert_eq!((&json["file"], &json["volumes"][0]["name"]), (&"a/v.glb".into(), &"tower".into()));
    assert_eq!((&json["volumes"][0]["closed"], &json["left_out"]), (&true.into(), &0.into()));
    assert_eq!(json["sun"]["time"], "2026-09-18T15:00:00+02:00");

    // one part stands in the ground, and one on it
    let deep = "[[model]]\npath = \"tower.glb\"\nposition = [0, 0, -30]\n[ground]\nlevel = 0.0\n";
    std::fs::write(folder.path().join("deep.toml"), format!("{PLACE}[[model]]\npath = \"open.glb\"\n{deep}")).unwrap();
    let output = gnomon(folder.path(), "volumes deep.toml --at 2026-09-18T15:00");
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("note: 1 component casts nothing"), "{}", stderr(&output));
    std::fs::write(folder.path().join("deep.toml"), format!("{PLACE}{deep}")).unwrap();
    fails(folder.path(), "volumes deep.toml --at 2026-09-18T15:00 --quiet", 1, &["nothing above the ground", "level"]);
    let long = gnomon(folder.path(), "volumes . --at 2026-09-18T19:52 --out long.glb --no-refraction");
    assert!(stderr(&long).contains("volumes are up to 16 km long"), "{}", stderr(&long));
}

#[test]
fn volumes_that_cannot_be_are_told() {
    let folder = site();
    fails(folder.path(), "volumes . --at 2026-09-18T02:00", 1, &["no sun at 2026-09-18 02:00", "below the horizon"]);
    fails(folder.path(), "volumes .", 2, &["--at <T>"]);
    fails(folder.path(), "volumes . --at 2026-09-18T15:00 --out v.obj", 2, &["--out", ".glb", "v.obj"]);
    fails(folder.path(), "volumes tower.glb --at 2026-09-18T15:00", 2, &["--place LAT,LON"]);
    fails(folder.path(), "volumes . --at 2026-09-18T15:00 --engine cpu", 2, &["--engine"]);
    fails(folder.path(), "volumes . --at 2026-09-18T15:00 --out site.toml/v.glb", 1, &["cannot write", "--out"]);
    assert_eq!(names(folder.path().to_owned()), ["open.glb", "site.toml", "tower.glb"]);
}

/// Where there is no site file, a way out is an option, or is said to be a key of a site file.
#[test]
fn without_a_site_file_no_key_is_named_as_if_there_were_one() {
    let folder = site();
    let none =
        gnomon(folder.path(), "volumes open.glb --place 48.8583,2.2945 --at 2026-09-18T15:00 --ground 500 --quiet");
    let said = stderr(&none);
    assert!(said.contains("nothing above the ground casts") && said.contains("--ground"), "{said}");
    assert!(said.contains("`casts` under [[model]] in a site file") && !said.contains("`level`"), "{said}");
}
