//! The techniques and their options on the command line.

use crate::shared::program::{done, fails, gnomon, pixels, site};
use gnomon::choice::TABLE;
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn every_technique_draws_a_profile_and_is_named() {
    let folder = site();
    let mut hours = Vec::new();
    for (technique, engine, silhouette) in [
        ("stencil", "gpu", "hextree"),
        ("hybrid", "gpu", "hextree"),
        ("smoothie", "gpu", "hextree"),
        ("shadow-map", "gpu", ""),
        ("ray-cast", "cpu", ""),
    ] {
        let report = json(&done(
            folder.path(),
            &format!("profile . --size 64 --resolution step --technique {technique} --json"),
        ));
        assert_eq!((&report["technique"], &report["engine"]), (&technique.into(), &engine.into()));
        assert_eq!(report["silhouette"].as_str().unwrap_or_default(), silhouette, "{technique}");
        let map_size = report["map_size"].as_u64();
        assert_eq!(map_size, (!matches!(technique, "stencil" | "ray-cast")).then_some(2048), "{technique}");
        assert_eq!(report["pcf"].as_str(), (technique == "shadow-map").then_some("fast-2x2"), "{technique}");
        assert!(report["sun_samples"].is_null() && report["smoothie_width"].is_null());
        assert!(report["statistics"].is_null(), "statistics are not asked");
        hours.push(std::fs::read(folder.path().join("out/shadow-hours.tif")).unwrap());
    }
    // hard and exact ones agree to the second on a box; soft and coarse ones do not
    assert!(hours[0] == hours[1] && hours[0] == hours[4]);
    assert!(hours[2] != hours[0] && hours[3] != hours[0]);
}

#[test]
fn the_ground_alone_is_projected_on_either_machine() {
    let folder = site();
    let draw = |options: &str| {
        let report = json(&done(
            folder.path(),
            &format!("profile . --size 64 --resolution step --receivers ground --json {options}"),
        ));
        let drew = [&report["technique"], &report["engine"]].map(|word| word.as_str().unwrap().to_owned());
        (drew.join(" "), std::fs::read(folder.path().join("out/shadow-hours.tif")).unwrap())
    };
    let (asked, hours) = draw("--technique projected --engine gpu");
    assert_eq!(asked, "projected gpu");
    for (options, drew) in [
        ("--technique projected", "projected cpu"),
        ("--engine gpu", "projected gpu"),
        ("", "projected cpu"),
        ("--engine gpu --silhouette brute", "stencil gpu"),
        ("--technique stencil", "stencil gpu"),
    ] {
        // on a box they agree to the second
        assert!(draw(options) == (drew.to_owned(), hours.clone()), "{options}");
    }
    let refused = "--technique projected --engine gpu";
    fails(folder.path(), &format!("profile . --size 16 {refused}"), 2, &["--engine", "--receivers ground"]);
    fails(
        folder.path(),
        &format!("shadow . --at 15:00 --date 2026-09-18 --view camera {refused}"),
        2,
        &["--technique"],
    );
}

#[test]
fn the_options_of_a_technique_change_what_it_draws() {
    let folder = site();
    let draw = |options: &str| {
        done(folder.path(), &format!("shadow . --at 2026-09-18T15:00 --size 300 --mask m.png {options}"));
        std::fs::read(folder.path().join("m.png")).unwrap()
    };
    for (one, other) in [
        ("--technique shadow-map --pcf none", "--technique shadow-map --pcf 2x2"),
        ("--technique shadow-map", "--technique shadow-map --pcf fast-4x4"),
        ("--technique shadow-map --map-size 256", "--technique shadow-map --map-size 300"),
        ("--technique smoothie", "--technique smoothie --smoothie-width 0.01"),
        ("--technique ray-cast", "--technique ray-cast --sun-samples 16"),
        ("--technique ray-cast --sun-samples 4", "--technique ray-cast --sun-samples 5"),
    ] {
        assert!(draw(one) != draw(other), "{one} and {other} are the same");
    }
    assert_eq!(draw("--technique shadow-map"), draw("--technique shadow-map --pcf fast-2x2 --map-size 2048"));
    // a technique in the site file takes its options, too
    let study = "\ntechnique = \"smoothie\"\n";
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap() + study;
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    assert_eq!(draw("--smoothie-width 0.2"), draw("--technique smoothie --smoothie-width 0.2"));
}

#[test]
fn options_that_nothing_uses_are_wrong_use() {
    let folder = site();
    for (options, option) in [
        ("--map-size 512", "--map-size"),
        ("--map-size 512 --technique stencil", "--map-size"),
        ("--map-size 512 --engine cpu", "--map-size"),
        ("--pcf none --technique hybrid", "--pcf"),
        ("--pcf none", "--pcf"),
        ("--smoothie-width 1 --technique shadow-map", "--smoothie-width"),
        ("--sun-samples 16", "--sun-samples"),
        ("--sun-samples 16 --technique smoothie", "--sun-samples"),
        ("--silhouette brute --technique shadow-map", "--silhouette"),
        ("--silhouette gpu --technique smoothie", "--silhouette"),
        ("--technique hybrid --engine cpu", "--engine"),
        ("--stats --technique shadow-map", "--stats"),
        ("--stats --technique hybrid --engine cpu", "--stats"),
    ] {
        for command in ["profile .", "shadow . --at 15:00 --date 2026-09-18"] {
            fails(folder.path(), &format!("{command} --size 16 {options}"), 2, &[option]);
        }
    }
    for (options, said) in [
        ("--map-size 255", "--map-size"),
        ("--map-size 9000", "--map-size"),
        ("--pcf 3x3", "fast-2x2"),
        ("--smoothie-width 0", "above 0"),
        ("--smoothie-width nan", "above 0"),
        ("--sun-samples 0", "--sun-samples"),
    ] {
        fails(folder.path(), &format!("profile . --size 16 --technique smoothie {options}"), 2, &[said]);
    }
}

#[test]
fn statistics_tell_what_was_counted() {
    let folder = site();
    let at = "shadow . --at 2026-09-18T15:00 --size 200 --mask m.png --stats";
    let said = done(folder.path(), &format!("{at} --technique hybrid"));
    assert!(said.contains("silhouette cells: ") && said.contains("without the mask"), "{said}");
    let of = |options: &str| json(&done(folder.path(), &format!("{at} --json {options}")))["statistics"].clone();
    let (hybrid, stencil) = (of("--technique hybrid"), of("--technique stencil"));
    let number = |of: &Value, key: &str| of[key].as_u64().unwrap();
    assert!(stencil["silhouette_cells"].is_null());
    assert_eq!(number(&stencil, "fragments"), number(&stencil, "fragments_without_mask"));
    assert_eq!(number(&hybrid, "fragments_without_mask"), number(&stencil, "fragments"));
    assert!(number(&hybrid, "fragments") * 3 < number(&stencil, "fragments") && number(&hybrid, "fragments") > 0);
    let cells = number(&hybrid, "cells");
    assert!(number(&hybrid, "silhouette_cells") * 10 < cells && cells > 10_000);
    // by itself it counts with the stencil, and a profile adds the instants up
    assert_eq!(of("")["fragments"], stencil["fragments"]);
    let profile = json(&done(folder.path(), "profile . --size 64 --write json --stats --json"));
    let width = profile["width"].as_u64().unwrap() * profile["height"].as_u64().unwrap();
    assert_eq!(number(&profile["statistics"], "cells"), 5 * width);
    assert!(gnomon(folder.path(), "profile . --size 64 --write json --stats").status.success());
}

#[test]
fn show_draws_the_mask_and_overdraw() {
    let folder = site();
    let at = "shadow . --at 2026-09-18T15:00 --json";
    for view in ["plan", "camera"] {
        done(folder.path(), &format!("{at} --view {view} --technique hybrid --map-size 256 --show mask --out m.png"));
        done(folder.path(), &format!("{at} --view {view} --technique stencil --show overdraw --out o.png"));
        let count = |name: &str, colour: [u8; 3]| pixels(folder.path().join(name), |pixel| pixel == colour);
        let [map_shadow, map_light, volume_shadow, volume_light] =
            [[196, 60, 48], [122, 164, 220], [12, 12, 14], [70, 190, 80]].map(|colour| count("m.png", colour));
        assert!(map_shadow > 20_000 && map_light > 20_000, "{view}: {map_shadow} {map_light}");
        assert!(volume_shadow > 500 && volume_light > 500, "{view}: {volume_shadow} {volume_light}");
        assert!(count("o.png", [18, 18, 22]) > 20_000 && count("o.png", [255, 255, 255]) > 1000, "{view}");
    }
    for (options, said) in [
        ("--show mask", "--technique hybrid"),
        ("--show overdraw --technique projected", "--technique stencil or hybrid without --engine cpu"),
        ("--show overdraw --technique smoothie", "--show overdraw"),
        ("--show mask,overdraw --technique hybrid", "alone"),
        ("--show overdraw,volumes --view camera", "alone"),
    ] {
        fails(folder.path(), &format!("{at} --out m.png {options}"), 2, &[said]);
    }
    for row in TABLE.iter().filter(|row| !row.shows_mask) {
        let options = format!("--show mask --technique {}", row.word);
        fails(folder.path(), &format!("{at} --out m.png {options}"), 2, &["--show mask", "--technique hybrid"]);
    }
}

#[test]
fn a_technique_in_the_site_file_is_shown_and_night_is_told() {
    let folder = site();
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap() + "\ntechnique = \"hybrid\"\n";
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    done(folder.path(), "shadow . --at 2026-09-18T15:00 --size 100 --show mask --out m.png");
    assert!(pixels(folder.path().join("m.png"), |pixel| pixel == [196, 60, 48]) > 1000);
    for night in [
        "shadow . --at 2026-09-18T02:00 --size 32 --show mask --out n.png",
        "shadow . --at 2026-09-18T02:00 --size 32 --stats --mask n.png",
        "profile . --size 32 --write json --stats --from 1:00 --to 3:00",
    ] {
        let output = gnomon(folder.path(), night);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success() && told.contains("nothing is counted"), "{night}: {told}");
        assert!(!String::from_utf8_lossy(&output.stdout).contains("overdraw"), "{night}");
    }
}

/// What the site file chose is blamed on its key, and what the command line chose on its option.
#[test]
fn a_technique_that_does_not_fit_is_blamed_on_who_chose_it() {
    let folder = site();
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    let named = text.replace("[study]\n", "[study]\ntechnique = \"projected\"\n");
    assert_ne!(text, named);
    std::fs::write(folder.path().join("named.toml"), named).unwrap();
    let arguments = "shadow named.toml --at 2026-09-18T15:00 --view camera";
    fails(folder.path(), arguments, 2, &["named.toml, [study] technique: projected does not draw"]);
    fails(folder.path(), &format!("{arguments} --technique projected"), 2, &["--technique: projected does not draw"]);
}
