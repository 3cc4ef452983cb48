//! Hidden parts are not drawn, but they still cast shadows.

use super::*;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::view::{Surface, View};

/// The site's components, and per pixel of a view which of them is seen there.
fn seen(site: &Path, view: View) -> (Vec<String>, Vec<Option<usize>>) {
    let Site { mesh, ground, .. } = Site::load(site, &Overrides::default()).unwrap();
    let scene = Scene { casters: mesh.of_components(&[]), receivers: mesh.clone(), ground: ground.level };
    let surface = RayCast::new(scene, view, None).surface().unwrap();
    let component = |face: &u32| {
        let of_mesh = *face != Surface::GROUND && *face != Surface::SKY;
        of_mesh.then(|| mesh.components.partition_point(|component| component.faces.end <= *face))
    };
    let of_pixels = surface.face.iter().map(component).collect();
    (mesh.components.into_iter().map(|component| component.name).collect(), of_pixels)
}

/// The component, not the last one, that is seen in the most pixels.
fn largest(names: &[String], of_pixels: &[Option<usize>]) -> usize {
    let pixels = |component: &usize| of_pixels.iter().filter(|of| **of == Some(*component)).count();
    (0..names.len() - 1).max_by_key(pixels).expect("components")
}

/// The position in the window of a pixel of the view.
fn place(harness: &Harness<'_, App>, view: View, pixel: usize) -> Pos2 {
    let (width, height) = view.size();
    let share = |at: u32, of: u32| (at as f32 + 0.5) / of as f32;
    let at = egui::vec2(share(pixel as u32 % width, width), share(pixel as u32 / width, height));
    harness.get_by_label("Model").rect().lerp_inside(at)
}

fn pixels(harness: &Harness<'_, App>) -> Vec<[u8; 4]> {
    harness.state().picture().unwrap().2
}

/// The picture is that of a site in which the component does not receive, and is therefore transparent; the site is
/// unchanged.
#[test]
fn hidden_component_is_looked_through_and_casts() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let (view, _) = harness.state().picture_view().unwrap();
    let (names, of_pixels) = seen(&site, view);
    let hidden = largest(&names, &of_pixels);
    let (before, written) = (pixels(&harness), harness.state().site_file().clone());
    click(&mut harness, "Components");
    click(&mut harness, &format!("{} visible", names[hidden]));
    settle(&mut harness);
    let without = pixels(&harness);
    assert!(*harness.state().site_file() == written, "the site is another one");

    let looked_through = {
        let others: Vec<String> = names.iter().filter(|name| **name != names[hidden]).cloned().collect();
        let text = std::fs::read_to_string(&site).unwrap();
        let receives = format!("path = \"works.glb\"\nreceives = {others:?}");
        let path = site.with_file_name("without.toml");
        std::fs::write(&path, text.replace("path = \"works.glb\"", &receives)).unwrap();
        let harness = window(Some(&path));
        pixels(&harness)
    };
    let differs =
        |one: &[[u8; 4]], other: &[[u8; 4]]| one.iter().zip(other).filter(|(one, other)| one != other).count();
    assert_eq!(differs(&without, &looked_through), 0);
    let own = of_pixels.iter().filter(|of| **of == Some(hidden)).count();
    assert!(differs(&before, &without) * 2 > own, "{own} pixels are the component's");

    click(&mut harness, "Show all");
    settle(&mut harness);
    assert_eq!(differs(&before, &pixels(&harness)), 0);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.step();
    settle(&mut harness);
    assert_eq!(differs(&without, &pixels(&harness)), 0, "it is hidden again");
    click(&mut harness, "Show all");
    settle(&mut harness);

    // what is clicked is hidden as well
    let own: Vec<usize> = (0..of_pixels.len()).filter(|at| of_pixels[*at] == Some(hidden)).collect();
    let at = place(&harness, view, own[own.len() / 2]);
    click_at(&mut harness, at);
    click(&mut harness, "Hide this component");
    settle(&mut harness);
    assert_eq!(differs(&without, &pixels(&harness)), 0, "what was clicked is hidden");
    assert!(harness.query_by_label("Forget the point").is_none(), "its point is hidden with it");
}

/// Hours on façades lie on the faces that they were found on, whichever of them are hidden; and are read there.
#[test]
fn hours_stay_on_the_faces_beside_hidden_ones() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let (view, _) = harness.state().picture_view().unwrap();
    let (names, of_pixels) = seen(&site, view);
    let hidden = largest(&names, &of_pixels);
    click(&mut harness, "On façades, too");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    let before = pixels(&harness);
    // a place of what comes after the hidden one, whose faces are counted on from there
    let later: Vec<usize> = (0..of_pixels.len()).filter(|at| of_pixels[*at].is_some_and(|of| of > hidden)).collect();
    let told = |harness: &mut Harness<'_, App>, at: usize| {
        harness.hover_at(place(harness, view, at));
        harness.run_steps(3);
        let part = "down on its face";
        harness.query_by_label_contains(part).is_some().then(|| named(harness, part).0)
    };
    let at = later.iter().copied().step_by(97).find(|at| told(&mut harness, *at).is_some()).expect("a face with hours");
    let said = told(&mut harness, at);

    click(&mut harness, "Components");
    click(&mut harness, &format!("{} visible", names[hidden]));
    settle(&mut harness);
    harness.get_by_label("Show the hours");
    let after = pixels(&harness);
    let changed = later.iter().filter(|at| before[**at] != after[**at]).count();
    // lines between them and the hidden one are gone
    assert!(changed * 50 <= later.len(), "{changed} of {} pixels have other hours", later.len());
    assert_eq!(told(&mut harness, at), said);
}

/// Names of related parts begin alike, so their ends are not cut off.
#[test]
fn names_that_are_cut_are_told_apart() {
    let mut harness = window(Some(&sample("headquarters")));
    click(&mut harness, "Components");
    let nodes = harness.query_all_by_role(egui::Role::Button);
    let shown = nodes.filter_map(|node| node.accesskit_node().value());
    let mut cut: Vec<String> = shown.filter(|name| name.contains('…') && !name.ends_with('…')).collect();
    let all = cut.len();
    cut.sort();
    cut.dedup();
    assert!(all > 2 && cut.len() == all, "{all} names: {cut:?}");
}
