//! Models with bad coordinates: stray points far away, and corners that were rounded before they were read.

use crate::model::{I16, Model, U32};
use crate::shared::program::{done, gnomon, stderr};
use gnomon::choice::{Engine, Receivers};
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, InstantWants, Wants};
use gnomon::view::View;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::Path;
use tempfile::TempDir;

const SITE: &str = r#"
[place]
latitude = 48.2
longitude = 16.37
[ground]
level = 0.0
[study]
date = 2026-06-21
from = "11:00"
to = "15:00"
step = "5min"
resolution = "step"
[plan]
region = [-4, -4, 10, 10]
cell = 0.01
"#;

/// Forty slats of 5 cm × 4 m × 10 cm in a row, 3 m above the ground, in a file's own axes: corners and indices.
fn pergola() -> (Vec<[f64; 3]>, Vec<u32>) {
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut corners, mut indices) = (Vec::new(), Vec::new());
    for slat in 0..40 {
        let first = corners.len() as u32;
        let x = f64::from(slat) * 0.15;
        corners.extend(
            (0..8).map(|i| [x + 0.05 * f64::from(i & 1), 3.0 + 0.1 * f64::from(i >> 2), -4.0 * f64::from(i >> 1 & 1)]),
        );
        indices.extend(quads.iter().flat_map(|[a, b, c, d]| [a, b, c, a, c, d].map(|corner| first + corner)));
    }
    (corners, indices)
}

/// A node with this mesh in single precision.
fn add(model: &mut Model, name: &str, corners: &[[f64; 3]], indices: &[u32]) {
    let floats: Vec<f32> = corners.iter().flatten().map(|&number| number as f32).collect();
    let positions = model.f32s("VEC3", &floats);
    let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    let indices = model.accessor("SCALAR", U32, indices.len(), &bytes);
    let mesh = json!({"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]});
    for (list, value) in [("meshes", mesh), ("nodes", Value::Null)] {
        if model.json[list].is_null() {
            model.json[list] = json!([]);
        }
        let at = model.json[list].as_array().unwrap().len();
        let value = if value.is_null() { json!({"name": name, "mesh": at}) } else { value };
        crate::model::push(&mut model.json[list], value);
    }
}

fn folder(model: &Model, keys: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pergola.glb"), model.glb()).unwrap();
    std::fs::write(folder.path().join("site.toml"), format!("[[model]]\npath = \"pergola.glb\"\n{keys}{SITE}"))
        .unwrap();
    folder
}

/// The pergola, optionally with a triangle in the same primitive at a distance to the east, in metres: it is there, or
/// reaches from the pergola to there.
fn strayed(metres: Option<f64>, from: From) -> TempDir {
    let (mut corners, mut indices) = pergola();
    if let Some(east) = metres {
        let first = corners.len() as u32;
        corners.extend(match from {
            From::There => [[east, 0.0, 0.0], [east + 1.0, 0.0, 0.0], [east, 0.0, -1.0]],
            From::Home => [[0.0, 0.0, 0.0], [east, 0.0, 0.0], [0.0, 0.0, -1.0]],
        });
        indices.extend([first, first + 1, first + 2]);
    }
    let mut model = Model::new();
    add(&mut model, "slats", &corners, &indices);
    folder(&model, "")
}

#[derive(Clone, Copy)]
enum From {
    There,
    Home,
}

/// Square metres of shadow times hours over the window, and square metres at 13:00.
fn shadow(folder: &Path) -> (f64, f64) {
    let asked = Overrides { receivers: Some(Receivers::Ground), engine: Some(Engine::Cpu), ..Overrides::default() };
    let site = Site::load(folder, &asked).unwrap();
    let cell = site.grid.cell * site.grid.cell;
    let outcome = study::run(&site, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    let cells = (site.grid.width * site.grid.height) as usize;
    let hours: f64 = (0..cells).map(|at| f64::from(outcome.profile.hours(at))).sum();
    let at = Overrides { at: "2026-06-21T13:00".parse().ok(), ..asked };
    let site = Site::load(folder, &at).unwrap();
    let wants = InstantWants::default();
    let mask = study::instant(&site, View::Plan(site.grid), &wants, &mut |_| ControlFlow::Continue(())).unwrap().mask;
    (hours * cell, mask.share.iter().filter(|share| **share == 0).count() as f64 * cell)
}

/// `shared/cases/07-weld-stray`: 17.6 m²h and no shadow at 13:00 before, 50.0 m²h and 8.10 m² without the stray.
#[test]
fn a_pergola_with_a_stray_shades_as_it_does_without() {
    let right = shadow(strayed(None, From::There).path());
    assert!((right.0 - 50.0).abs() < 0.1 && (right.1 - 8.10).abs() < 0.05, "{right:?}");
    for (km, from) in [(60.0, From::There), (1000.0, From::There), (60.0, From::Home), (1000.0, From::Home)] {
        assert_eq!(shadow(strayed(Some(km * 1000.0), from).path()), right, "{km} km");
    }
}

#[test]
fn a_stray_is_named_and_nothing_of_home_is_called_wrong() {
    let words = "has 1 triangle of 'slats' up to 60 km from everything else";
    for from in [From::Home, From::There] {
        let folder = strayed(Some(60_000.0), from);
        let shadow =
            gnomon(folder.path(), "shadow . --at 2026-06-21T13:00 --mask m.png --receivers ground --engine cpu");
        assert!(stderr(&shadow).contains(words) && !stderr(&shadow).contains("position"), "{}", stderr(&shadow));
        let table = done(folder.path(), "check site.toml");
        assert!(table.contains(words), "{table}");
    }
    let folder = strayed(Some(60_000.0), From::There);
    let report: Value = serde_json::from_str(&done(folder.path(), "check pergola.glb --json")).unwrap();
    assert_eq!(report["components"][0]["degenerate_triangles"], 0);
    assert_eq!(report["components"][0]["open_edges"], 3);
    // the default region is that of the pergola and its shadow
    std::fs::write(
        folder.path().join("site.toml"),
        format!("[[model]]\npath = \"pergola.glb\"\n{}", SITE.split_once("[plan]").unwrap().0),
    )
    .unwrap();
    let site = Site::load(folder.path(), &Overrides::default()).unwrap();
    assert!(site.grid.width as f64 * site.grid.cell < 30.0, "{:?}", site.grid);
    assert!(site.camera.eye.length() < 100.0, "{:?}", site.camera);
}

/// `shared/cases/08-map-coordinates-in-f32`: steps of 0.06 m east and 0.5 m north; no note before.
#[test]
fn corners_rounded_by_map_coordinates_are_told_in_metres() {
    let (mut corners, indices) = pergola();
    corners.iter_mut().for_each(|[x, _, z]| (*x, *z) = (*x + 691_607.253, *z - 5_334_762.118));
    let mut model = Model::new();
    add(&mut model, "slats", &corners, &indices);
    let folder = self::folder(&model, "position = [-691607.253, -5334762.118, 0]\n");
    let words =
        "pergola.glb has corners rounded to 0.5 m, as their numbers are too large for single precision ('slats')";
    let study = gnomon(folder.path(), "shadow . --at 2026-06-21T13:00 --mask m.png --receivers ground --engine cpu");
    assert!(stderr(&study).contains(words) && stderr(&study).contains("move the origin"), "{}", stderr(&study));
    for asked in ["check .", "check pergola.glb"] {
        let table = done(folder.path(), asked);
        assert!(table.contains(words) && !table.contains("still right"), "{table}");
    }

    // on the node nothing is lost
    let (corners, indices) = pergola();
    let mut model = Model::new();
    add(&mut model, "slats", &corners, &indices);
    model.json["nodes"][0]["translation"] = json!([691_607.253, 0.0, -5_334_762.118]);
    let folder = self::folder(&model, "position = [-691607.253, -5334762.118, 0]\n");
    assert!(!done(folder.path(), "check .").contains("rounded"));
}

#[test]
fn quantised_corners_are_as_coarse_as_their_own_steps() {
    for (size, told) in [(60.0, Some("0.0018 m")), (20.0, None)] {
        let mut model = Model::new();
        let bytes: Vec<u8> =
            [0_i16, 0, 0, 32767, 0, 0, 0, 0, -32767].iter().flat_map(|number| number.to_le_bytes()).collect();
        let positions = model.accessor("VEC3", I16, 3, &bytes);
        model.json["accessors"][positions]["normalized"] = true.into();
        model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}}]}]);
        model.json["nodes"] = json!([{"mesh": 0, "name": "sail", "scale": [size, size, size]}]);
        model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        let folder = folder(&model, "");
        let table = done(folder.path(), "check .");
        match told {
            Some(step) => assert!(table.contains(step) && table.contains("quantisation"), "{table}"),
            None => assert!(!table.contains("rounded"), "{table}"),
        }
    }
    // single precision holds 10 km to a millimetre
    let part = |east: f32| {
        let mut model = Model::new();
        let positions = model.f32s("VEC3", &[east, 0.0, 0.0, east + 1.0, 0.0, 0.0, east, 0.0, -1.0]);
        model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}}]}]);
        model.json["nodes"] = json!([{"mesh": 0}]);
        model.part()
    };
    assert!(part(10_000.0).coarse.is_empty());
    assert_eq!(part(20_000.0).coarse.len(), 1);
    assert_eq!(part(20_000.0).coarse[0].step_m, 1.0 / 512.0);
}
