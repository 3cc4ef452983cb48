//! A site judged by a rule in the window: the verdicts, their table and their spots, and the tools that draw what is
//! judged.

use super::exporting::{answer, menu};
use super::*;

/// The works with two areas: one in the shade of the eastern hall, which is proposed, and one far out in the sun.
fn judged_site() -> (tempfile::TempDir, PathBuf) {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let judged = "[before]\nabsent = [\"hall-east/wall\", \"hall-east/roof\"]\n\n# behind the hall\n[[area]]\n\
                  name = \"yard\"\npolygon = [[100, 40], [103, 40], [103, 43], [100, 43]]\n\n# far out\n[[area]]\n\
                  name = \"field\"\npolygon = [[60, -200], [64, -200], [64, -196], [60, -196]]\n";
    std::fs::write(&site, text + judged).unwrap();
    (folder, site)
}

const BRE: &str = "BRE BR 209, sun on the ground, United Kingdom";
const SECTION: &str = "Judge by a rule";

/// Opens the panel's section and chooses a rule in its list.
fn choose(harness: &mut Harness<'_, App>, rule: &str) {
    if harness.query_by_role_and_label(egui::Role::ComboBox, "Rule").is_none() {
        click(harness, SECTION);
        settle(harness);
    }
    pick(harness, "Rule", rule);
}

/// Chooses an entry of a list.
fn pick(harness: &mut Harness<'_, App>, list: &str, entry: &str) {
    harness.get_by_role_and_label(egui::Role::ComboBox, list).click_accesskit();
    settle(harness);
    click(harness, entry);
    settle(harness);
}

fn judge(harness: &mut Harness<'_, App>) {
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::J);
    harness.step();
    settle(harness);
}

fn press(harness: &mut Harness<'_, App>, modifiers: egui::Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.step();
    settle(harness);
}

/// Where a point of the plan is in the window.
fn on_plan(harness: &Harness<'_, App>, at: [f64; 2]) -> Pos2 {
    let gnomon::view::View::Plan(grid) = harness.state().wanted_view().unwrap().0 else { panic!("the plan") };
    let share = |from: f64, to: f64, at: f64| ((at - from) / (to - from)) as f32;
    let [x, y] = [share(grid.west, grid.east(), at[0]), share(grid.north, grid.south(), at[1])];
    harness.get_by_label("Model").rect().lerp_inside(egui::vec2(x, y))
}

/// The pixels of the picture that are as red as what fails.
fn failing(harness: &mut Harness<'_, App>) -> usize {
    let rect = harness.get_by_label("Model").rect();
    let picture = harness.render().unwrap();
    let is_failing = |(x, y, pixel): &(u32, u32, &image::Rgba<u8>)| {
        let [red, green, blue, _] = pixel.0.map(i32::from);
        rect.contains(egui::pos2(*x as f32, *y as f32)) && red - green > 60 && (green - blue).abs() < 25
    };
    picture.enumerate_pixels().filter(is_failing).count()
}

#[test]
fn verdicts_are_a_table_and_lie_on_the_picture() {
    let (_folder, site) = judged_site();
    let mut harness = with_boxes(Some(&site));
    press(&mut harness, egui::Modifiers::NONE, Key::Num2);
    let before = failing(&mut harness);
    choose(&mut harness, BRE);
    harness.get_by_label_contains("Known as S: a third party's summary.");
    judge(&mut harness);
    harness.get_by_label("The site fails");
    harness.get_by_label("2 judged: 1 fail, 1 pass");
    harness.get_by_label_contains("check with your authority");
    // what fails goes first, with its margin, day and taker
    let (yard, yard_at) = named(&harness, "yard fails");
    assert!(yard.starts_with("yard fails: 43.") && yard.contains("for a limit of 50.00 %, margin −6."), "{yard}");
    assert!(yard.contains("on 2026-03-21, taken by tank-1/steel"), "{yard}");
    let (field, field_at) = named(&harness, "field passes");
    assert!(yard_at.top() < field_at.top(), "{field}");
    click(&mut harness, "Sort by name");
    assert!(named(&harness, "yard fails").1.top() > field_at.top() - 1.0, "by name the field goes first");

    // one click: the view is at its spot, and the strip of its day is shown
    harness.get_by_label_contains("yard fails").click_accesskit();
    settle(&mut harness);
    let gnomon::view::View::Plan(grid) = harness.state().wanted_view().unwrap().0 else { panic!("the plan") };
    let middle = [(grid.west + grid.east()) / 2.0, (grid.north + grid.south()) / 2.0];
    assert!((middle[0] - 101.5).abs() < 2.0 && (middle[1] - 41.5).abs() < 2.0, "{middle:?}");
    assert!(grid.east() - grid.west < 100.0, "the yard is large enough to be seen");
    harness.get_by_label("The day of 2026-03-21");
    harness.get_by_label("2026-03-21, which decides");
    harness.get_by_label_contains("hall-east/roof: ");
    assert!(harness.query_all_by_label_contains("before: ").count() > 0);
    let painted = failing(&mut harness);
    assert!(painted > before + 500, "{painted} pixels, and {before} before");
    click(&mut harness, "Show the verdicts");
    settle(&mut harness);
    assert!(harness.query_by_label("The site fails").is_none());
    let without = failing(&mut harness);
    assert!(without * 4 < painted, "{without} pixels without verdicts, {painted} with them");
}

/// The eye of the perspective moves to where a spot is seen.
#[test]
fn click_on_a_line_moves_the_perspective() {
    let (_folder, site) = judged_site();
    let mut harness = with_boxes(Some(&site));
    choose(&mut harness, BRE);
    judge(&mut harness);
    harness.get_by_label_contains("yard fails").click_accesskit();
    settle(&mut harness);
    let gnomon::view::View::Camera(camera) = harness.state().wanted_view().unwrap().0 else { panic!("a perspective") };
    assert!(camera.target.truncate().distance(glam::dvec2(101.5, 41.5)) < 3.0, "{:?}", camera.target);
    assert!(camera.eye.distance(camera.target) < 100.0, "{:?}", camera.eye);
    click(&mut harness, "Close the card");
    assert!(harness.query_by_label("The day of 2026-03-21").is_none());
}

#[test]
fn files_of_verdicts_are_those_of_the_command() {
    let (folder, site) = judged_site();
    let mut harness = with_boxes(Some(&site));
    choose(&mut harness, "CEQR Technical Manual, shadows, New York City");
    judge(&mut harness);
    harness.get_by_label("The site is only reported");
    menu(&mut harness, "Export the verdicts…");
    let out = folder.path().join("out");
    answer(&mut harness, &out, "Write");
    let table = folder.path().join("table.csv");
    let judged = std::process::Command::new(env!("CARGO_BIN_EXE_gnomon"))
        .args(["judge".as_ref(), site.as_os_str(), "--rule".as_ref(), "us-nyc-ceqr-shadows".as_ref()])
        .args(["--json".as_ref(), "--quiet".as_ref(), "--csv".as_ref(), table.as_os_str()])
        .output()
        .expect("the command");
    assert_eq!(judged.status.code(), Some(3), "{}", String::from_utf8_lossy(&judged.stderr));
    assert!(std::fs::read(out.join("judgement.csv")).unwrap() == std::fs::read(table).unwrap(), "the table differs");
    let [ours, theirs] = [std::fs::read(out.join("judgement.json")).unwrap(), judged.stdout]
        .map(|text| serde_json::from_slice::<serde_json::Value>(&text).unwrap());
    assert_eq!(ours, theirs);
}

/// What is missing is one error, with the labels of the window; what has to be chosen is said beside it.
#[test]
fn missing_things_are_named_by_their_labels() {
    let (_folder, site) = small_site();
    let mut harness = with_boxes(Some(&site));
    judge(&mut harness);
    let fault = |harness: &Harness<'_, App>| harness.state().fault_and_notice()[0].map(str::to_owned).unwrap();
    assert_eq!(fault(&harness), "Choose a rule under \"Judge by a rule\" first");
    settle(&mut harness);
    pick(&mut harness, "Rule", BRE);
    judge(&mut harness);
    let said = fault(&harness);
    assert!(said.contains("needs an area; the state before"), "{said}");
    assert!(said.contains("\"Draw an area\" under Judge by a rule"), "{said}");
    assert!(said.contains("a component's name under Components"), "{said}");
    assert!(!said.contains("[[area]]") && !said.contains("--"), "{said}");

    choose(&mut harness, "EN 17037, exposure to sunlight, Europe (CEN)");
    harness.get_by_label_contains("must be chosen: the sun's altitude in degrees above which it counts");
    judge(&mut harness);
    let said = fault(&harness);
    assert!(said.contains("choose \"above\""), "{said}");
    write(&mut harness, "above", "1e9");
    settle(&mut harness);
    harness.get_by_label_contains("1e9 is not a number from 0 to 45");
}

/// An area is drawn by clicks, named, undone, and saved with the comments of the file.
#[test]
fn area_is_drawn_on_the_plan() {
    let (_folder, site) = judged_site();
    let mut harness = with_boxes(Some(&site));
    click(&mut harness, SECTION);
    settle(&mut harness);
    click(&mut harness, "Draw an area");
    settle(&mut harness);
    let draw = |harness: &mut Harness<'_, App>, corners: &[[f64; 2]]| {
        for corner in corners {
            let at = on_plan(harness, *corner);
            click_at(harness, at);
            // two clicks in one place within a moment would be a double click
            harness.run_steps(30);
        }
    };
    let corners = [[-20.0, -60.0], [20.0, -60.0], [20.0, -40.0]];
    // two sides that cross bound no area
    draw(&mut harness, &[corners[0], corners[2], corners[1], [-20.0, -40.0]]);
    press(&mut harness, egui::Modifiers::NONE, Key::Enter);
    let said = harness.state().fault_and_notice()[0].map(str::to_owned).unwrap();
    assert!(said.starts_with("The outline "), "{said}");
    assert_eq!(harness.state().site_file().area.len(), 2);
    press(&mut harness, egui::Modifiers::NONE, Key::Escape);

    click(&mut harness, "Draw an area");
    settle(&mut harness);
    draw(&mut harness, &corners);
    draw(&mut harness, &[[-60.0, -70.0]]);
    // the last corner is taken back
    press(&mut harness, egui::Modifiers::COMMAND, Key::Z);
    press(&mut harness, egui::Modifiers::NONE, Key::Enter);
    let areas = harness.state().site_file().area.clone();
    assert_eq!(areas.len(), 3);
    let drawn = areas[2].polygon.clone().unwrap();
    assert_eq!(drawn.len(), 3);
    for (corner, wanted) in drawn.iter().zip(corners) {
        assert!((corner[0] - wanted[0]).abs() < 1.0 && (corner[1] - wanted[1]).abs() < 1.0, "{drawn:?}");
    }
    write(&mut harness, "Name of area 3", "lawn");
    settle(&mut harness);
    press(&mut harness, egui::Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.state().site_file().area[2].name.as_deref(), Some("area 3"));
    press(&mut harness, egui::Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.state().site_file().area.len(), 2);
    let redo = egui::Modifiers { shift: true, ..egui::Modifiers::COMMAND };
    press(&mut harness, redo, Key::Z);
    press(&mut harness, redo, Key::Z);
    click(&mut harness, "Remove area 1");
    settle(&mut harness);
    press(&mut harness, egui::Modifiers::COMMAND, Key::S);
    let text = std::fs::read_to_string(&site).unwrap();
    assert!(text.contains("# far out\n[[area]]\nname = \"field\"") && !text.contains("behind the hall"), "{text}");
    assert!(text.contains("name = \"lawn\""), "{text}");
}

/// A new border of the plot has other sides, so what was said of the old ones goes.
#[test]
fn plot_is_drawn_on_the_plan() {
    let (_folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let plot = "[plot]\nborder = [[-90, -90], [90, -90], [90, 90]]\nroads = [{ side = 1, width = 6.0 }]\n";
    std::fs::write(&site, text + plot).unwrap();
    let mut harness = with_boxes(Some(&site));
    click(&mut harness, SECTION);
    settle(&mut harness);
    click(&mut harness, "Draw the plot");
    settle(&mut harness);
    for corner in [[-80.0, -80.0], [80.0, -80.0], [80.0, 80.0], [-80.0, 80.0], [-80.0, -80.0]] {
        let at = on_plan(&harness, corner);
        click_at(&mut harness, at);
        harness.run_steps(30);
    }
    let plot = harness.state().site_file().plot.clone().unwrap();
    assert_eq!((plot.border.unwrap().len(), plot.roads), (4, None));
    let notice = harness.state().fault_and_notice()[1].map(str::to_owned).unwrap();
    assert!(notice.starts_with("The roads and neighbours of the old border are left out"), "{notice}");
    click(&mut harness, "Remove the plot");
    settle(&mut harness);
    assert!(harness.state().site_file().plot.is_none());
}

/// A click takes a component, and one with Ctrl all of its kind; a second click takes them away.
#[test]
fn windows_are_picked_by_clicks() {
    let (_folder, site) = small_site();
    let mut harness = with_boxes(Some(&site));
    press(&mut harness, egui::Modifiers::NONE, Key::Num2);
    click(&mut harness, SECTION);
    settle(&mut harness);
    click(&mut harness, "Pick windows");
    settle(&mut harness);
    let works = gnomon::site::Site::load(&site, &gnomon::site::Overrides::default()).unwrap();
    let component = |name: &str| works.mesh.components.iter().find(|component| component.name == name).unwrap();
    let middle = |name: &str| {
        let face = component(name).faces.start as usize;
        works.mesh.corners(face).map(|corner| works.mesh.origin + corner.as_dvec3()).iter().sum::<glam::DVec3>() / 3.0
    };
    let roof = middle("hall-east/roof");
    let at = on_plan(&harness, [roof.x, roof.y]);
    click_at(&mut harness, at);
    let names = |harness: &Harness<'_, App>| -> Vec<Vec<String>> {
        let windows = &harness.state().site_file().window;
        windows.iter().map(|window| window.component.clone().map(|names| names.0).unwrap_or_default()).collect()
    };
    assert_eq!(names(&harness), [["hall-east/roof"]]);
    assert!(harness.query_by_label_contains("has no flat piece").is_none(), "it has flat pieces");
    harness.run_steps(30);
    click_at(&mut harness, at);
    assert!(names(&harness).is_empty());
    harness.run_steps(30);
    harness.event(Event::ModifiersChanged(egui::Modifiers::COMMAND));
    click_at(&mut harness, at);
    assert_eq!(names(&harness), [["roof"]], "the name that all roofs share");
    // what is no pane is told while windows are picked
    harness.event(Event::ModifiersChanged(egui::Modifiers::NONE));
    harness.run_steps(30);
    click(&mut harness, "Remove windows 1");
    settle(&mut harness);
    let faces = component("tank-1/steel").faces.clone();
    let corners = faces.flat_map(|face| works.mesh.corners(face as usize)).map(|corner| corner.as_dvec3());
    let (low, high) = corners.fold((glam::DVec3::INFINITY, glam::DVec3::NEG_INFINITY), |(low, high), corner| {
        (low.min(corner), high.max(corner))
    });
    let tank = works.mesh.origin + (low + high) / 2.0;
    let at = on_plan(&harness, [tank.x, tank.y]);
    click_at(&mut harness, at);
    settle(&mut harness);
    assert_eq!(names(&harness), [["tank-1/steel"]]);
    harness.get_by_label_contains("has no flat piece, as a pane is");
    // rules about rooms and dwellings ask for these, and an undo takes them back one by one
    let said = |harness: &Harness<'_, App>| {
        let window = &harness.state().site_file().window[0];
        [window.room.clone(), window.dwelling.clone(), window.usage.clone()]
    };
    for (field, value) in [("Room", "kitchen"), ("Dwelling", "flat 1"), ("Use", "living")] {
        write(&mut harness, &format!("{field} of windows 1"), value);
        settle(&mut harness);
    }
    assert_eq!(said(&harness), ["kitchen", "flat 1", "living"].map(|text| Some(text.to_owned())));
    press(&mut harness, egui::Modifiers::COMMAND, Key::Z);
    assert_eq!(said(&harness)[2], None);
    press(&mut harness, egui::Modifiers::NONE, Key::Escape);
}

/// A component stands before, after, or in both states.
#[test]
fn component_is_proposed_or_demolished() {
    let (_folder, site) = small_site();
    let mut harness = with_boxes(Some(&site));
    click(&mut harness, "Components");
    settle(&mut harness);
    let set = |harness: &mut Harness<'_, App>, name: &str, state: &str| {
        click(harness, name);
        click(harness, state);
        settle(harness);
    };
    set(&mut harness, "hall-east/roof", "Proposed");
    let before = |harness: &Harness<'_, App>| harness.state().site_file().before.clone();
    let names = |names: Option<gnomon::site::judged_tables::WrittenNames>| names.map(|names| names.0);
    assert_eq!(names(before(&harness).unwrap().absent), Some(vec!["hall-east/roof".to_owned()]));
    set(&mut harness, "hall-east/roof (proposed)", "Demolished");
    let both = before(&harness).unwrap();
    assert_eq!((names(both.absent), names(both.demolished)), (None, Some(vec!["hall-east/roof".to_owned()])));
    // it is in no picture and no study, and its switches say why
    assert!(harness.get_by_label("hall-east/roof casts").accesskit_node().is_disabled());
    // switching another one leaves its own roles as they are
    click(&mut harness, "hall-east/wall casts");
    settle(&mut harness);
    set(&mut harness, "hall-east/roof (demolished)", "Existing");
    assert_eq!(before(&harness), None);
    let casts = harness.get_by_label("hall-east/roof casts");
    assert_eq!(casts.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True), "it casts again");
    press(&mut harness, egui::Modifiers::COMMAND, Key::Z);
    harness.get_by_label("hall-east/roof (demolished)");
}

#[test]
fn rule_beside_the_site_is_listed() {
    let (folder, site) = judged_site();
    let text = gnomon::rules::built_in_text("uk-bre-209-sun-on-ground").expect("built in");
    let own = text.replace("BRE BR 209, sun on the ground", "Our own rule");
    std::fs::write(folder.path().join("own.toml"), own).unwrap();
    std::fs::write(folder.path().join("broken.toml"), "[rule]\nid = 1\n").unwrap();
    let mut harness = with_boxes(Some(&site));
    choose(&mut harness, "Our own rule, United Kingdom");
    judge(&mut harness);
    harness.get_by_label("Our own rule, United Kingdom");
    harness.get_by_label("The site fails");
    // a rule whose file changes is another one, once it is read again
    let changed = std::fs::read_to_string(folder.path().join("own.toml")).unwrap().replace("2h", "3h");
    std::fs::write(folder.path().join("own.toml"), changed).unwrap();
    harness.get_by_role_and_label(egui::Role::ComboBox, "Rule").click_accesskit();
    settle(&mut harness);
    harness.get_by_role_and_label(egui::Role::Button, "Our own rule, United Kingdom").click_accesskit();
    settle(&mut harness);
    harness.get_by_label("The request has changed since.");
    judge(&mut harness);
    assert!(harness.query_by_label("The request has changed since.").is_none());
    // a changed request is told from what was judged
    click(&mut harness, "Remove area 2");
    settle(&mut harness);
    harness.get_by_label("The request has changed since.");
}

/// In another folder the site file still finds what says what is judged.
#[test]
fn files_of_what_is_judged_are_found_from_another_folder() {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let before = folder.path().join("before.toml");
    std::fs::write(&before, &text).unwrap();
    std::fs::write(&site, text + "[before]\nsite = \"before.toml\"\n").unwrap();
    let mut harness = with_boxes(Some(&site));
    let other = folder.path().join("other");
    std::fs::create_dir(&other).unwrap();
    menu(&mut harness, "Save as…");
    answer(&mut harness, &other.join("site.toml"), "Write");
    let written = gnomon::site::WrittenSite::read(&other, &gnomon::site::Overrides::default()).unwrap();
    let site_before = written.site.before.unwrap().site.unwrap();
    assert!(written.folder.join(&site_before).is_file(), "{site_before}");
}
