//! An output that is one of the inputs is refused before any work, by whatever path it is named.

use super::bytes;
use crate::shared::program::{PLACE, done, fails, site};
use std::fs;
use std::path::{Path, PathBuf};

const AT: &str = "--at 2026-09-18T15:00";

/// A site whose model names files beside it: a buffer, and pictures that nobody reads.
fn site_with_pictures(folder: &Path) {
    let glb = bytes(&folder.join("tower.glb"));
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let mut json: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    json["buffers"][0]["uri"] = "wall%2B.png".into();
    let picture = |name: &str| serde_json::json!({"uri": name});
    json["images"] = serde_json::json!([{"uri": 7}, picture("mask-0003.png"), picture("frame-0001.png"), picture("data:image/png;,")]);
    fs::write(folder.join("wall+.png"), &glb[20 + length + 8..]).unwrap();
    for name in ["mask-0003.png", "frame-0001.png"] {
        fs::write(folder.join(name), "a picture").unwrap();
    }
    fs::write(folder.join("tower.gltf"), json.to_string()).unwrap();
    let text = fs::read_to_string(folder.join("site.toml")).unwrap();
    fs::write(folder.join("pictures.toml"), text.replace("tower.glb", "tower.gltf")).unwrap();
}

/// Every file of a folder and those below it.
fn all(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let (folders, files): (Vec<_>, Vec<_>) = paths.into_iter().partition(|path| path.is_dir());
    let mut all: Vec<_> = files.into_iter().map(|path| (path.clone(), bytes(&path))).collect();
    all.extend(folders.iter().flat_map(|folder| self::all(folder)));
    all
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let folder = site();
    let path = folder.path();
    site_with_pictures(path);
    let text = fs::read_to_string(path.join("site.toml")).unwrap();
    fs::create_dir(path.join("out")).unwrap();
    fs::copy(path.join("tower.glb"), path.join("out/surfaces.glb")).unwrap();
    for (name, model) in
        [("surfaces.toml", "out/surfaces.glb"), ("out/compare.json", "surfaces.glb"), ("site.csv", "tower.glb")]
    {
        fs::write(path.join(name), text.replace("tower.glb", model)).unwrap();
    }
    fs::write(path.join("profile.json"), text).unwrap();
    let before = all(path);
    for (asked, named) in [
        (format!("volumes . {AT} --out tower.glb"), ["tower.glb", "./tower.glb"]),
        (format!("volumes tower.glb --place 48.8,2.3 {AT} --out ./tower.glb"), ["./tower.glb", "tower.glb"]),
        ("profile surfaces.toml --receivers surfaces --engine cpu".into(), ["out/surfaces.glb"; 2]),
        ("profile profile.json --engine cpu --out .".into(), ["profile.json"; 2]),
        ("profile pictures.toml --engine cpu --masks .".into(), ["mask-0003.png"; 2]),
        (format!("shadow pictures.toml {AT} --out wall+.png"), ["wall+.png"; 2]),
        (format!("shadow pictures.toml {AT} --mask mask-0003.png"), ["mask-0003.png"; 2]),
        ("animate pictures.toml --engine cpu --out .".into(), ["frame-0001.png"; 2]),
        ("compare . out/compare.json --engine cpu".into(), ["out/compare.json"; 2]),
        ("compare out/compare.json . --engine cpu".into(), ["out/compare.json"; 2]),
        ("probe site.csv --point 20,20,2 --csv site.csv".into(), ["site.csv"; 2]),
        ("probe pictures.toml --point 20,20,2 --out wall+.png".into(), ["wall+.png"; 2]),
    ] {
        fails(
            path,
            &asked,
            2,
            &["cannot write", named[0], named[1], "the site is read from", "another name or folder"],
        );
    }
    assert!(all(path) == before);
    // what is not asked for is not in the way
    done(path, "profile surfaces.toml --receivers surfaces --engine cpu --write csv");
    done(path, "profile pictures.toml --engine cpu --out . --size 20 --write json");
    assert!(bytes(&path.join("out/surfaces.glb")) == bytes(&path.join("tower.glb")));
}

/// By file, not by name.
#[cfg(unix)]
#[test]
fn links_do_not_hide_what_is_read() {
    let folder = site();
    let path = folder.path();
    let model = bytes(&path.join("tower.glb"));
    std::os::unix::fs::symlink("tower.glb", path.join("symbolic.glb")).unwrap();
    fs::hard_link(path.join("tower.glb"), path.join("hard.glb")).unwrap();
    std::os::unix::fs::symlink(".", path.join("here")).unwrap();
    for name in ["symbolic.glb", "hard.glb", "here/tower.glb", "here/here/hard.glb"] {
        fails(path, &format!("volumes . {AT} --out {name}"), 2, &[name, "./tower.glb", "the site is read from"]);
    }
    // the model itself may be a link, too
    fs::write(path.join("linked.toml"), format!("{PLACE}[[model]]\npath = \"here/symbolic.glb\"\n")).unwrap();
    fails(path, &format!("volumes linked.toml {AT} --out tower.glb"), 2, &["tower.glb", "here/symbolic.glb"]);
    // another file of the same bytes is none of them
    fs::write(path.join("copy.glb"), &model).unwrap();
    done(path, &format!("volumes . {AT} --out copy.glb"));
    assert!(bytes(&path.join("tower.glb")) == model && bytes(&path.join("copy.glb")) != model);
}
