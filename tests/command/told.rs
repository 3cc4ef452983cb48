//! What is said about model files that cannot be opened, and about the position of those that can.

use crate::shared::program::{done, fails, site};
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
