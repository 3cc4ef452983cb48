//! Several model files make one site.

use crate::shared::program::{done, fails, site};
use gnomon::site::{Overrides, SiteError, WrittenSite};
use serde_json::Value;
use std::path::PathBuf;

fn asked(beside: &[PathBuf]) -> Overrides {
    Overrides { place: Some([48.8, 2.3]), beside: beside.to_vec(), ..Overrides::default() }
}

#[test]
fn models_beside_a_model_stand_in_its_site() {
    let folder = site();
    let [tower, open] = ["tower.glb", "open.glb"].map(|name| folder.path().join(name));
    let other = tempfile::tempdir().unwrap();
    let far = other.path().join("far.glb");
    std::fs::copy(&open, &far).unwrap();
    let written = WrittenSite::read(&tower, &asked(&[open.clone(), far.clone()])).unwrap();
    let paths: Vec<_> = written.site.model.iter().map(|model| model.path.clone().unwrap()).collect();
    assert_eq!(paths, ["tower.glb".to_owned(), "open.glb".to_owned(), far.display().to_string()]);
    assert_eq!(written.model_files(), [tower, open, far]);
}

#[test]
fn site_file_takes_no_models_beside_it() {
    let folder = site();
    let [file, open, toml] = ["site.toml", "open.glb", "other.toml"].map(|name| folder.path().join(name));
    let none = Overrides { place: None, ..asked(&[open]) };
    let error = WrittenSite::read(&file, &none).unwrap_err();
    assert!(error.is_wrong_use() && error.to_string().contains("[[model]]"), "{error}");
    let error: SiteError = WrittenSite::read(&folder.path().join("tower.glb"), &asked(&[toml])).unwrap_err();
    assert!(error.is_wrong_use() && error.to_string().contains("other.toml is not a model"), "{error}");
}

#[test]
fn command_takes_several_models() {
    let folder = site();
    let common = "--place 48.8,2.3 --at 2026-09-18T12:00 --engine cpu --size 40 --mask m.png --json";
    let report: Value =
        serde_json::from_str(&done(folder.path(), &format!("shadow tower.glb open.glb {common}"))).unwrap();
    assert!(report["place"]["latitude"] == 48.8, "{report}");
    // neither is written over
    let over = common.replace("m.png", "m.png --out open.glb");
    fails(folder.path(), &format!("shadow tower.glb open.glb {over}"), 2, &["--out writes PNG"]);
    fails(folder.path(), &format!("shadow site.toml open.glb {}", &common[17..]), 2, &["open.glb", "[[model]]"]);
}

/// `default_height` is a key of a model, and an option for all of them.
#[test]
fn default_height_reaches_the_reader() {
    let folder = site();
    let file = folder.path().join("site.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let height = |keys: &str, default_height| {
        std::fs::write(&file, text.replace("[[model]]\n", &format!("[[model]]\n{keys}\n"))).unwrap();
        let asked = Overrides { default_height, ..Overrides::default() };
        let written = WrittenSite::read(&file, &asked).unwrap();
        let heard = std::cell::Cell::new(None);
        gnomon::site::Models::read(&written, |path, options| {
            heard.set(options.default_height_m);
            gnomon::formats::read(path, options)
        })
        .map(|_| heard.get())
        .map_err(|error| error.to_string())
    };
    assert_eq!(height("", None), Ok(None));
    assert_eq!(height("default_height = 9.5", None), Ok(Some(9.5)));
    assert_eq!(height("default_height = 9.5", Some(3.0)), Ok(Some(3.0)));
    assert!(height("default_height = -1.0", None).unwrap_err().contains("default_height"));
    fails(folder.path(), "check tower.glb --default-height -3", 2, &["--default-height", "metres above 0"]);
}
