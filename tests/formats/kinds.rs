//! What a reader says about parts, and about what it left out, is available everywhere.

use crate::shared::program::{PLACE, STUDY, site};
use crate::shared::said;
use gnomon::cli::Options;
use gnomon::export::check::{self, CheckedMesh, TableExtent};
use gnomon::formats::{self, LeftOut, Model, PartKind};
use gnomon::site::{Overrides, Site, WrittenSite, load_mesh};
use std::path::Path;

/// A tower, and its like as a road and as terrain.
fn three(folder: &Path) -> Model {
    let mut model = formats::read(&folder.join("tower.glb"), &formats::ReadOptions::default()).unwrap();
    let tower = model.parts[0].clone();
    for name in ["road", "hill"] {
        let mut part = tower.clone();
        part.name = name.to_owned();
        part.aliases = vec![name.to_owned(), "surroundings".to_owned()];
        model.parts.push(part);
    }
    model.kinds = vec![PartKind::Building, PartKind::GroundCover, PartKind::Terrain];
    let why = || "not built".to_owned();
    model.left_out = vec![
        LeftOut { what: "IfcGrid".to_owned(), count: 3, why: why() },
        LeftOut { what: "IfcSpace".to_owned(), count: 12, why: why() },
    ];
    model
}

fn loaded(keys: &str, asked: &Overrides) -> Site {
    let folder = site();
    let file = folder.path().join("site.toml");
    std::fs::write(&file, format!("{PLACE}[[model]]\npath = \"tower.glb\"\n{keys}\n{STUDY}")).unwrap();
    Site::load_with(&file, asked, |_, _| Ok(three(folder.path()))).unwrap()
}

#[test]
fn ground_cover_casts_only_where_it_is_named() {
    let casts = |keys: &str| loaded(keys, &Overrides::default()).casts;
    assert_eq!(casts(""), [true, false, true]);
    assert_eq!(casts("casts = [\"!tower\"]"), [false, false, true]);
    assert_eq!(casts("casts = [\"road\"]"), [false, true, false]);
    assert_eq!(casts("casts = [\"surroundings\", \"tower\"]"), [true; 3]);
    assert_eq!(casts("casts = false"), [false; 3]);
    assert_eq!(loaded("", &Overrides::default()).receives, [true; 3]);
    let is_said =
        |keys: &str| said(&loaded(keys, &Overrides::default()).notes).iter().any(|note| note.contains("\"road\""));
    assert!(is_said("") && !is_said("casts = [\"road\"]"), "a guess is told, and what is written is not");
}

#[test]
fn what_is_left_out_is_told_once_and_listed_by_check() {
    let notes = loaded("", &Overrides { words: &Options, ..Overrides::default() }).notes;
    let notes: Vec<String> = notes.iter().map(|note| note.in_words(&Options)).collect();
    let told = "tower.glb: 12 IfcSpace and 3 others left out; `gnomon check` lists them";
    assert_eq!(notes.iter().filter(|note| note.contains("left out")).collect::<Vec<_>>(), [told]);
    let elsewhere = said(&loaded("", &Overrides::default()).notes);
    assert!(elsewhere.iter().any(|note| note == "tower.glb: 12 IfcSpace and 3 others left out"), "{elsewhere:?}");
}

#[test]
fn check_lists_groups_kinds_and_what_is_left_out() {
    let folder = site();
    let written = WrittenSite::read(&folder.path().join("site.toml"), &Overrides::default()).unwrap();
    let models = gnomon::site::Models::read(&written, |_, _| Ok(three(folder.path()))).unwrap();
    let contents = models.contents(&written).remove(0);
    let groups: Vec<_> = contents.groups.iter().map(|group| (group.name.as_str(), group.components)).collect();
    assert_eq!(groups, [("surroundings", 2), ("default", 1), ("hill", 1), ("road", 1), ("tower", 1)]);
    assert_eq!(contents.kinds, PartKind::ALL.map(|kind| (kind, 1)));
    assert_eq!((contents.format, contents.left_out.len()), ("glTF", 2));
    let mesh = load_mesh(&folder.path().join("tower.glb"), &Overrides::default()).unwrap();
    assert_eq!(mesh.models.len(), 1);
    let mut all = models.contents(&written);
    all[0].file = "house.ifc".to_owned();
    let checked =
        CheckedMesh { mesh: &mesh.mesh, components: &[], frame: mesh.frame, notes: &[], models: &all, references: &[] };
    let table = check::table(checked, TableExtent::Screen, &Options);
    for line in [
        "house.ifc: glTF\n",
        "  kinds: 1 building, 1 terrain, 1 ground cover\n",
        "  groups: \"surroundings\" (2), \"default\" (1), \"hill\" (1), \"road\" (1), \"tower\" (1)\n",
        "  left out: 12 IfcSpace: not built\n",
        "  left out: 3 IfcGrid: not built\n",
    ] {
        assert!(table.contains(line), "{table} lacks {line}");
    }
}

#[test]
fn a_group_counts_the_components_that_are_called_so_themselves() {
    let folder = site();
    let written = WrittenSite::read(&folder.path().join("site.toml"), &Overrides::default()).unwrap();
    let mut model = three(folder.path());
    for (part, (name, aliases)) in model.parts.iter_mut().zip([
        ("IfcWall", &["Ground floor"][..]),
        ("IfcWall/Brick", &["IfcWall", "Ground floor", "Brick"]),
        ("IfcSlab", &["Ground floor"]),
    ]) {
        (part.name, part.aliases) = (name.to_owned(), aliases.iter().map(|alias| (*alias).to_owned()).collect());
    }
    let models = gnomon::site::Models::read(&written, |_, _| Ok(model.clone())).unwrap();
    let groups = &models.contents(&written)[0].groups;
    let groups: Vec<_> = groups.iter().map(|group| (group.name.as_str(), group.components)).collect();
    let expected = [("Ground floor", 3), ("IfcWall", 2), ("Brick", 1), ("IfcSlab", 1), ("IfcWall/Brick", 1)];
    assert_eq!(groups, expected);
}

#[test]
fn what_is_left_out_is_counted_in_words_for_one_and_many() {
    let told = |count: u64, what: &str| LeftOut { what: what.to_owned(), count, why: String::new() }.counted();
    assert_eq!(told(1, "faces"), "1 face");
    assert_eq!(told(2, "faces"), "2 faces");
    assert_eq!(told(1, "footprints"), "1 footprint");
    assert_eq!(told(1, "entities of the layer Faces"), "1 entity of the layer Faces");
    // a file's own terms are as they are
    assert_eq!(told(1, "IfcStairs"), "1 IfcStairs");
    assert_eq!(told(1, "pointsets"), "1 pointsets");
}
