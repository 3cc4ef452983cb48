//! What only rays can tell: the outer side of panes and walls, reveals, and areas under something.

use super::{Drawing, HEAD, folder, judged, notes, open, write};
use glam::dvec3;
use gnomon::site::JudgedSite;
use gnomon::study::settle;

fn settled(tables: &str) -> JudgedSite {
    settle(judged(tables)).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(tables: &str, words: &[&str]) {
    let Err(error) = settle(judged(tables)) else { panic!("a mistake is taken: {words:?}") };
    let message = error.to_string();
    assert!(!message.contains('\n'), "{message}");
    for word in words {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
}

/// The pane in the south lies 15 cm behind its wall, the sheet in the west 20 cm, whose front looks into the room.
#[test]
fn panes_look_out_and_lie_in_their_wall() {
    let site = settled("[[window]]\ncomponent = \"glass\"");
    let [south, west] = site.windows.as_slice() else { panic!("{:?}", site.windows) };
    assert!(south.outward.distance(dvec3(0.0, -1.0, 0.0)) < 1e-6, "{south:?}");
    assert!(west.outward.distance(dvec3(-1.0, 0.0, 0.0)) < 1e-6, "{west:?}");
    assert!(south.corners.iter().all(|corner| (corner.y + 4.85).abs() < 1e-5), "{south:?}");
    assert!((south.reveal_m - 0.15).abs() < 1e-5 && (west.reveal_m - 0.2).abs() < 1e-5, "{south:?} {west:?}");
    assert!(site.windows.iter().all(|window| window.other_side.is_none()));
    // the sill's left end, seen from outside: west of a southern window, north of a western one
    assert!(south.corners[0].x < south.corners[1].x && west.corners[0].y > west.corners[1].y);
    let notes = notes(&site);
    assert!(notes.contains("the reveals of 2 windows are measured") && notes.contains("0.15 to 0.20 m"), "{notes}");
    let said = settled("[[window]]\ncomponent = \"glass\"\nreveal = 0.05");
    assert!(said.windows.iter().all(|window| window.reveal_m == 0.05));
}

/// The tower is a solid: whoever writes the corners of a window on it from inside looks into its wall.
#[test]
fn windows_that_look_into_their_wall_are_told() {
    let good = "[[window]]\nname = \"good\"\ncorners = [[-1, -50, 10], [1, -50, 10], [1, -50, 12], [-1, -50, 12]]\n";
    let turned = good.replace("good", "turned").replace(
        "[[-1, -50, 10], [1, -50, 10], [1, -50, 12], [-1, -50, 12]]",
        "[[1, -50, 10], [-1, -50, 10], [-1, -50, 12], [1, -50, 12]]",
    );
    let site = settled(good);
    assert_eq!((site.windows[0].outward, site.windows[0].reveal_m), (dvec3(0.0, -1.0, 0.0), 0.0));
    refused(
        &format!("{good}{turned}"),
        &["[[window]]", "1 window looks into its own wall", "\"turned\"", "seen from outside"],
    );
    // in the middle of a solid neither side sees anything
    let buried = good.replace("good", "buried").replace("-50, ", "-45, ");
    refused(&format!("{turned}{buried}"), &["2 windows look into their own wall", "\"turned\" and \"buried\""]);
}

/// A window that looks into its room rather than out is no mistake that rays can prove, and is said.
#[test]
fn windows_whose_other_side_is_more_open_are_said() {
    let inward = "[[window]]\nname = \"in\"\ncorners = [[1, -4.8, 1], [-1, -4.8, 1], [-1, -4.8, 2.5], [1, -4.8, 2.5]]\n[[window]]\ncomponent = \"glass\"";
    let notes = notes(&settled(inward));
    assert!(notes.contains("the other side of 1 window is far more open: \"in\""), "{notes}");
}

#[test]
fn walls_without_an_outer_side_are_judged_where_it_is_open() {
    let folder = folder("[[facade]]\ncomponent = \"screen\"\nheights = [2]\nspacing = 2");
    // a single sheet 1 m before a wall in the north, whose front looks at that
    let drawing = Drawing::default()
        .object("screen")
        .sheet([[5.0, 0.0, 0.0], [-5.0, 0.0, 0.0], [-5.0, 0.0, 5.0], [5.0, 0.0, 5.0]])
        .object("wall")
        .block([-50.0, 1.0, 0.0], [50.0, 2.0, 60.0]);
    write(&folder, "town.obj", &drawing.text);
    let loaded = open(folder.path());
    assert_eq!((loaded.facades[0].points.len(), loaded.facades[0].doubtful.len()), (5, 5));
    let site = settle(loaded).unwrap();
    let facade = &site.facades[0];
    assert!(facade.doubtful.is_empty() && facade.points.iter().all(|[_, normal]| normal.y < -0.99), "{facade:?}");
    assert!(notes(&site).contains("5 points on walls whose outer side is not known"), "{}", notes(&site));
}

#[test]
fn areas_under_something_are_said() {
    let area =
        |more: &str| format!("[[area]]\nname = \"Deck\"\npolygon = [[12, -4], [18, -4], [18, 4], [12, 4]]\n{more}\n");
    let under = notes(&settled(&area("")));
    assert!(under.contains("100 % of the area \"Deck\" lies less than 3 m under \"terrace\""), "{under}");
    for more in ["height = 3", "level = 3.0"] {
        let on_top = notes(&settled(&area(more)));
        assert!(!on_top.contains("\"Deck\""), "{on_top}");
    }
    // what is built over it is what is judged
    let built = notes(&settled(&format!("{}[before]\nabsent = \"terrace\"", area(""))));
    assert!(!built.contains("\"Deck\""), "{built}");
    let open = folder(&area(""));
    write(
        &open,
        "site.toml",
        &format!("{HEAD}{}", area("").replace("[[12, -4], [18, -4], [18, 4], [12, 4]]", "[[0, 20], [5, 20], [0, 25]]")),
    );
    assert!(!notes(&settle(super::open(open.path())).unwrap()).contains("\"Deck\""));
}

/// The sample has nothing in it that is told.
#[test]
fn the_headquarters_are_judged() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/headquarters/judged.toml");
    let site = settle(super::open(&path)).unwrap();
    assert_eq!((site.areas.len(), site.windows.len(), site.year), (20, 3, 2026));
    let plot = site.plot.as_ref().expect("a plot");
    assert!(plot.sides.len() == 4 && plot.sides.iter().all(|side| side.road_m == 18.0));
    let before = site.before.as_ref().expect("a state before");
    let casters = |casts: &[bool]| casts.iter().filter(|casts| **casts).count();
    assert!(casters(&before.casts) < casters(&site.now.casts));
    assert_eq!(site.now.ground.level, before.ground.level);
    assert!(site.windows.iter().all(|window| window.outward.distance(dvec3(0.0, -1.0, 0.0)) < 1e-9));
    let told = notes(&site);
    for word in ["lies less than", "far more open", "equally open"] {
        assert!(!told.contains(word), "{told}");
    }
}
