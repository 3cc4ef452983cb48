//! What is said about model files that cannot be opened, and about the position of those that can.

use crate::shared::program::{done, fails, site};
use base64::Engine as _;
use gnomon::cli::Options;
use gnomon::export::check::{CheckedMesh, TableExtent, table};
use gnomon::formats::{Anchor, AnchorPoint, Up};
use gnomon::mesh::report::components;
use gnomon::site::{Overrides, load_mesh};
use std::path::Path;

#[test]
fn a_model_that_is_not_there_is_told_without_a_site_file() {
    let folder = site();
    let told = ["missing.glb: there is no such file"];
    fails(folder.path(), "check missing.glb", 1, &told);
    fails(folder.path(), "profile missing.glb --place 48,2", 1, &told);
    let output = crate::shared::program::gnomon(folder.path(), "check missing.glb");
    let said = crate::shared::program::stderr(&output);
    assert!(!said.contains("[[model]]") && !said.contains("site file"), "{said}");
    // a model beside another one, too
    fails(
        folder.path(),
        "profile tower.glb missing.glb --place 48,2 --date 2026-03-21 --from 9:00 --to 17:00 --step 1h",
        1,
        &told,
    );
    // a site file's key is named where there is one
    std::fs::write(folder.path().join("one.toml"), "[[model]]\npath = \"missing.glb\"\n").unwrap();
    fails(folder.path(), "check one.toml", 1, &["[[model]]", "path", "there is no file"]);
}

#[cfg(unix)]
#[test]
fn a_special_file_is_no_model() {
    let folder = site();
    let pipe = folder.path().join("pipe.glb");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    fails(folder.path(), "check pipe.glb", 1, &["pipe.glb: is not a regular file"]);
}

#[test]
fn numbers_of_how_a_model_stands_are_short() {
    let folder = site();
    let loaded = load_mesh(&folder.path().join("open.glb"), &Overrides::default()).unwrap();
    let mut references = loaded.references.clone();
    references[0].unit_m = 0.025_400_000_000_000_002;
    references[0].north_deg = -0.001;
    references[0].convergence_deg = Some(-0.0);
    references[0].anchors = vec![Anchor { said_by: "TrueNorth", at: AnchorPoint::Nowhere, north_rad: Some(-1e-9) }];
    let of = |references: &[_]| {
        let reports = components(&loaded.mesh);
        let checked = CheckedMesh {
            mesh: &loaded.mesh,
            components: &reports,
            frame: loaded.frame,
            notes: &[],
            models: &loaded.models,
            references,
        };
        table(checked, TableExtent::Screen, &Options)
    };
    let told = of(&references);
    for words in ["unit 0.0254 m", "north 0.00° (the map's convergence there: 0.00°)", "\n  TrueNorth: north 0.00°\n"]
    {
        assert!(told.contains(words), "{told} lacks {words}");
    }
    // only a file whose y is up is turned
    let turned = "where: metres along the file's own axes, turned z up (x, −z, y of the file)\n";
    assert!(told.contains(turned), "{told}");
    references[0].up = Up::Z;
    assert!(of(&references).contains("where: metres along the file's own axes\n"));
}

#[test]
fn what_reaches_too_far_is_told_with_its_file_and_without_many_digits() {
    let folder = site();
    let far = |folder: &Path, name: &str, models: &str| std::fs::write(folder.join(name), models).unwrap();
    let place = "position = [0.0, 5e33, 0.0]\n";
    far(
        folder.path(),
        "far.toml",
        &format!("[[model]]\npath = \"tower.glb\"\n[[model]]\npath = \"open.glb\"\n{place}"),
    );
    fails(folder.path(), "check far.toml", 1, &[".glb: 'tower' reaches more than a million km from the middle"]);
}

#[test]
fn a_text_of_facets_without_its_end_is_told() {
    let folder = site();
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    std::fs::write(folder.path().join("m.stl"), format!("solid m\n{facet}")).unwrap();
    let told = done(folder.path(), "check m.stl");
    assert!(told.contains("note: m.stl ends without `endsolid`, so it may be cut off"), "{told}");
}

/// A model without a site file has no keys: what an option says is said with it, and a key is said to be one of a site file.
#[test]
fn hints_for_a_model_alone_name_options() {
    let folder = site();
    let town = r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"height": 12, "name": "hall"},
        "geometry": {"type": "Polygon", "coordinates": [[[16.3, 48.2], [16.301, 48.2], [16.301, 48.201], [16.3, 48.2]]]}}]}"#;
    std::fs::write(folder.path().join("town.geojson"), town).unwrap();
    let notes = |command: &str| {
        let output = crate::shared::program::gnomon(folder.path(), command);
        format!("{}{}", crate::shared::program::stderr(&output), String::from_utf8_lossy(&output.stdout))
    };
    for command in ["sun town.geojson --at 2026-06-21T12:00", "check town.geojson"] {
        let told = notes(command);
        let note = "place from town.geojson, ";
        assert!(told.contains(note) && told.contains("change it with --place LAT,LON"), "{told}");
        assert!(!told.contains("in [place]"), "{told}");
        assert!(told.matches("[[model]]").count() == told.matches("under [[model]] in a site file").count(), "{told}");
    }
    let json = done(folder.path(), "sun town.geojson --at 2026-06-21T12:00 --json");
    assert!(json.contains("place from town.geojson, ") && json.contains("change it with --place LAT,LON"), "{json}");
    // a site file has the keys
    std::fs::write(folder.path().join("town.toml"), "[[model]]\npath = \"town.geojson\"\n").unwrap();
    let told = notes("check town.toml");
    assert!(told.contains("latitude, longitude and elevation in [place] change it"), "{told}");
    assert!(told.contains("`crs` under [[model]] changes it") && !told.contains("in a site file"), "{told}");
}

/// What `gnomon sun` takes from models is said, whether it is asked as a table or as JSON.
#[test]
fn the_sun_says_what_it_takes_from_models() {
    let folder = site();
    let write = |name: &str, place: &str| {
        let corners = base64::engine::general_purpose::STANDARD
            .encode([0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).as_flattened());
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0],"extras":{{"gnomon":{{{place}}}}}}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "buffers":[{{"uri":"data:;base64,{corners}","byteLength":36}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}]}}"#
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    write("low.gltf", r#""latitude":42.3584,"longitude":-71.0598"#);
    write("high.gltf", r#""latitude":42.36,"longitude":-71.06,"elevation":35.0"#);
    std::fs::write(
        folder.path().join("both.toml"),
        "[[model]]\npath = \"low.gltf\"\n[[model]]\npath = \"high.gltf\"\n",
    )
    .unwrap();
    std::fs::write(folder.path().join("one.toml"), "[[model]]\npath = \"low.gltf\"\n").unwrap();
    let written = "[place]\nlatitude = 42.36\nlongitude = -71.06\n[[model]]\npath = \"high.gltf\"\n";
    std::fs::write(folder.path().join("written.toml"), written).unwrap();
    for (site, words) in [
        (
            "one.toml",
            &["place from low.gltf, gnomon: 42.3584 N 71.0598 W;", "low.gltf says by its gnomon", "Boston"][..],
        ),
        // a place that may be a program's own gives way to another
        ("both.toml", &["place from high.gltf, gnomon: 42.36 N 71.06 W, 35.00 m above the sea;"]),
        ("written.toml", &["high.gltf gives the elevation of the place, 35.00 m"]),
    ] {
        let asked = format!("sun {site} --at 2026-06-21T12:00");
        let told = crate::shared::program::stderr(&crate::shared::program::gnomon(folder.path(), &asked));
        let json = done(folder.path(), &format!("{asked} --json"));
        assert!(words.iter().all(|word| told.contains(word) && json.contains(word)), "{told}{json}");
    }
    write("low.gltf", r#""latitude":42.35,"longitude":-71.06"#);
    let told = done(folder.path(), "sun both.toml --at 2026-06-21T12:00 --json");
    let words = "place from low.gltf, gnomon: 42.35 N 71.06 W, 35.00 m above the sea, as high.gltf, gnomon says";
    assert!(told.contains(words) && !told.contains("Boston"), "{told}");
    // and not one of another town
    write("low.gltf", r#""latitude":42.0,"longitude":-71.0"#);
    let told = done(folder.path(), "sun both.toml --at 2026-06-21T12:00 --json");
    assert!(told.contains("42 N 71 W;") && !told.contains("above the sea"), "{told}");
}
