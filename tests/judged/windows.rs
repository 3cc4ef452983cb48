//! `[[window]]`: panes of components, and four corners.

use super::{Drawing, fails, judged, notes};
use glam::{DVec3, dvec3};
use gnomon::site::JudgedWindow;

const CORNERS: &str = "corners = [[-1, -5, 1], [1, -5, 1], [1, -5, 2.5], [-1, -5, 2.5]]";

fn middle(window: &JudgedWindow) -> DVec3 {
    window.corners.iter().sum::<DVec3>() / 4.0
}

#[test]
fn panes_of_a_component_are_windows() {
    let site = judged(
        "[[window]]\ncomponent = \"glass\"\nroom = \"living room\"\ndwelling = \"flat 1\"\nusage = \"living\"\nfloor = 0.2\ninner = 0.25\nroom_area = 20",
    );
    let [box_pane, sheet] = site.windows.as_slice() else { panic!("{:?}", site.windows) };
    assert_eq!([&box_pane.name, &sheet.name], ["glass 1", "glass 2"]);
    assert_eq!((box_pane.room.as_deref(), box_pane.dwelling.as_deref()), (Some("living room"), Some("flat 1")));
    assert_eq!((box_pane.usage.as_deref(), box_pane.floor, box_pane.inner_m), (Some("living"), Some(0.2), Some(0.25)));
    assert_eq!((box_pane.room_m2, box_pane.reveal_is_said), (Some(20.0), false));
    // both faces of the thin box, 2 cm apart, and both sides of the sheet in one plane
    let faces = |window: &JudgedWindow| {
        let other = window.other_side.expect("two sides");
        (window.corners[0], other.iter().sum::<DVec3>() / 4.0 - middle(window))
    };
    assert!((faces(box_pane).1.length() - 0.02).abs() < 1e-5, "{box_pane:?}");
    assert!(faces(sheet).1.length() < 1e-9, "{sheet:?}");
    for window in [box_pane, sheet] {
        let other = window.other_side.unwrap();
        for corners in [&window.corners, &other] {
            // the sill is level and below the head, and all four are seen counter-clockwise
            assert!(corners[0].z == corners[1].z && corners[2].z == corners[3].z && corners[0].z < corners[2].z);
            assert!(
                (corners[0].distance(corners[1]) - 2.0).abs() < 1e-5
                    && (corners[1].distance(corners[2]) - 1.5).abs() < 1e-5
            );
        }
        let seen = |corners: &[DVec3; 4]| (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize();
        assert!(seen(&window.corners).distance(window.outward) < 1e-9);
        assert!(seen(&other).distance(-window.outward) < 1e-9);
    }
    let glass = site.now.mesh.components.iter().position(|component| component.name == "glass").unwrap();
    assert_eq!(box_pane.component, Some(glass as u32));
    let casting = site.now.casts.iter().filter(|casts| **casts).count();
    assert!(!site.now.casts[glass] && casting == site.now.casts.len() - 1);
    assert!(
        notes(&site).contains("1 component of glass whose windows are judged lets the sun through"),
        "{}",
        notes(&site)
    );
    let named = judged("[[window]]\nname = \"south\"\ncomponent = [\"glass\", \"!house\"]\nreveal = 0.1");
    assert_eq!([&named.windows[0].name, &named.windows[1].name], ["south 1", "south 2"]);
    assert_eq!((named.windows[0].reveal_m, named.windows[0].reveal_is_said), (0.1, true));
}

/// Double glazing is one window, judged at its outermost faces; panes beside each other, and panes of two walls, are not.
#[test]
fn panes_behind_each_other_are_one_window() {
    let pane = |drawing: Drawing, [x, y]: [f64; 2]| drawing.block([x, y, 1.0], [x + 1.2, y + 0.006, 2.4]);
    // three panes of one window, its neighbour's single one, and one in the wall across a corridor
    let panes = [[0.0, 0.0], [0.0, 0.016], [0.01, 0.15], [1.25, 0.0], [0.0, 1.2]];
    let folder =
        super::folder("[[window]]\ncomponent = \"glass\"\n[[window]]\nname = \"sheets\"\ncomponent = \"sheets\"");
    let model = panes.into_iter().fold(Drawing::default().object("glass"), pane);
    // two sheets, one of which is turned the other way, and one at a right angle to them
    let sheet = |y: f64| [[5.0, y, 1.0], [6.0, y, 1.0], [6.0, y, 2.0], [5.0, y, 2.0]];
    let turned = {
        let [a, b, c, d] = sheet(0.1);
        [d, c, b, a]
    };
    let across = [[5.05, 0.0, 1.0], [5.05, 1.0, 1.0], [5.05, 1.0, 2.0], [5.05, 0.0, 2.0]];
    let model = model.object("sheets").sheet(sheet(0.0)).sheet(turned).sheet(across);
    super::write(&folder, "town.obj", &model.text);
    let site = super::open(&folder.path().join("site.toml"));
    let names: Vec<&str> = site.windows.iter().map(|window| window.name.as_str()).collect();
    assert_eq!(names, ["glass 1", "glass 2", "glass 3", "sheets 1", "sheets 2"]);
    // of the three, the front of the one and the back of the other
    let mut faces = [site.windows[0].corners, site.windows[0].other_side.unwrap()].map(|corners| corners[0].y);
    faces.sort_by(f64::total_cmp);
    assert!(faces[0].abs() < 1e-5 && (faces[1] - 0.156).abs() < 1e-5, "{faces:?}");
    let seen = |window: &JudgedWindow| {
        [window.corners, window.other_side.unwrap()].map(|corners| {
            let [a, b, _, d] = corners;
            (b - a).cross(d - a).normalize()
        })
    };
    assert!(site.windows.iter().map(seen).all(|[front, back]| front.distance(-back) < 1e-6));
    let said = notes(&site);
    assert!(said.contains("2 pieces of \"glass\" lie at most 20 cm behind others"), "{said}");
    assert!(said.contains("1 piece of \"sheets\" lies at most 20 cm behind others"), "{said}");
}

#[test]
fn corners_are_a_window() {
    let site = judged(&format!(
        "[[window]]\n{CORNERS}\n[[window]]\nname = \"bath\"\ncorners = [[3, 5, 2], [3, 5, 1], [2, 5, 1], [2, 5, 2]]"
    ));
    let [first, second] = site.windows.as_slice() else { panic!("{:?}", site.windows) };
    assert_eq!((first.name.as_str(), first.outward, first.component), ("window 1", dvec3(0.0, -1.0, 0.0), None));
    assert!(first.other_side.is_none() && first.corners[0] == dvec3(-1.0, -5.0, 1.0));
    // begins at its sill, whichever corner was first; seen from the north
    assert_eq!((second.name.as_str(), second.outward), ("bath", dvec3(0.0, 1.0, 0.0)));
    assert_eq!(
        second.corners,
        [dvec3(3.0, 5.0, 1.0), dvec3(2.0, 5.0, 1.0), dvec3(2.0, 5.0, 2.0), dvec3(3.0, 5.0, 2.0)]
    );
    assert!(site.now.casts.iter().all(|casts| *casts));
    for (corners, words) in [
        ("[[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, nan]]", &["not a point"][..]),
        ("[[nan, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]", &["not a point"]),
        ("[[0, 0, 0], [1e9, 0, 0], [1, 0, 1], [0, 0, 1]]", &["50 km"]),
        ("[[0, 0, 0], [0, 0, 0], [1, 0, 1], [0, 0, 1]]", &["corners 1 and 2", "one point"]),
        ("[[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]]", &["no rectangle", "order"]),
        ("[[0, 0, 0], [1, 0, 0], [1, 0.5, 1], [0, 0, 1]]", &["no rectangle"]),
        ("[[0, 0, 0], [1, 0, 0], [1.5, 0, 1], [0.5, 0, 1]]", &["no rectangle"]),
        ("[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]", &["no rectangle"]),
    ] {
        fails(&format!("[[window]]\ncorners = {corners}"), &[words, &["[[window]] corners"]].concat());
    }
}

#[test]
fn mistakes_in_windows_are_told() {
    fails("[[window]]\nroom = \"a\"", &["component or corners in [[window]]", "component = "]);
    fails(&format!("[[window]]\n{CORNERS}\ncomponent = \"glass\""), &["[[window]] corners", "`component`"]);
    fails("[[window]]\ncomponent = \"glas\"", &["[[window]] component", "\"glas\"", "\"glass\""]);
    fails("[[window]]\ncomponent = \"tower\"", &["[[window]] component", "no flat piece"]);
    fails(
        &"[[window]]\ncomponent = \"glass\"\n".repeat(2),
        &["[[window]] number 2 component", "\"glass\"", "another [[window]]"],
    );
    fails(&format!("[[window]]\nname = \"a\"\n{CORNERS}\n").repeat(2), &["[[window]] number 2 name", "\"a\""]);
    for key in ["reveal = -0.1", "inner = 11", "floor = nan", "room_area = 0"] {
        let name = key.split(' ').next().unwrap();
        fails(&format!("[[window]]\n{CORNERS}\n{key}"), &[&format!("[[window]] {name}"), "is not between"]);
    }
}

/// What is no pane is left out with a note, and what is no rectangle is judged as the one around it.
#[test]
fn bodies_are_no_windows() {
    let site = judged("[[window]]\ncomponent = [\"glass\", \"barn\"]");
    assert_eq!(site.windows.len(), 2);
    assert!(notes(&site).contains("1 piece of \"barn\" is not flat"), "{}", notes(&site));
}

/// All panes of the house have the name of their type and glass; the file's own names and storeys tell them apart.
#[test]
#[cfg(feature = "ifc")]
fn windows_have_the_names_that_tell_them_apart() {
    let folder = super::folder("[[window]]\ncomponent = \"IfcWindow\"");
    let house = concat!(env!("CARGO_MANIFEST_DIR"), "/sites/hillside/house.ifc");
    std::fs::copy(house, folder.path().join("house.ifc")).expect("a model");
    let site = std::fs::read_to_string(folder.path().join("site.toml")).expect("a site file");
    super::write(&folder, "site.toml", &site.replace("town.obj\"\nup = \"z\"", "house.ifc\""));
    let site = super::open(folder.path());
    assert_eq!(site.windows.len(), 20);
    for name in ["South wall, window 3, Upper floor", "West wall, window 1, Ground floor"] {
        assert!(site.windows.iter().any(|window| window.name == name), "{:?}", site.windows);
    }
    assert!(site.windows.iter().all(|window| !window.name.contains("Ifc")), "{:?}", site.windows);
}

/// Pieces of one object whose name ends in a number are not numbered with a second one.
#[test]
fn a_number_does_not_follow_a_number() {
    let site = judged("[[window]]\nname = \"bay 2\"\ncomponent = \"glass\"");
    assert_eq!([&site.windows[0].name, &site.windows[1].name], ["bay 2 (1)", "bay 2 (2)"]);
}
