//! Nothing is cut off at any scale of the interface, and the panel keeps the width that the user gave it.

use super::exporting::answer;
use super::*;
use egui::accesskit::Role;

/// On a window of 1280 × 720 pixels.
const SCALES: [f32; 4] = [1.0, 1.25, 1.5, 2.0];

fn screen(harness: &Harness<'_, App>) -> egui::Rect {
    harness.ctx.content_rect().expand(0.5)
}

/// A text or a button.
struct Part {
    name: String,
    rect: egui::Rect,
    /// The part of the frame that it belongs to: the panel, the menu bar, the bar below; otherwise it lies over the
    /// picture.
    pane: Option<usize>,
}

fn parts(harness: &Harness<'_, App>) -> Vec<Part> {
    let told = |role| matches!(role, Role::Label | Role::Button | Role::CheckBox | Role::TextInput | Role::ComboBox);
    let pane = |node: &egui_kittest::Node<'_>| {
        let mut at = Some(node.accesskit_node());
        while let Some(node) = at.filter(|node| node.role() != Role::Pane) {
            at = node.parent();
        }
        at.map(|pane| pane.id())
    };
    let panes = [(Role::DisclosureTriangle, "Place"), (Role::Button, "File"), (Role::TextInput, "Clock")];
    let panes = panes.map(|(role, name)| pane(&harness.get_by_role_and_label(role, name)));
    let nodes = harness.query_all_by(|node| told(node.role()));
    let of = |node: egui_kittest::Node<'_>| {
        let whole = node.accesskit_node();
        let name = whole.label().or_else(|| whole.value()).unwrap_or_default();
        let pane = pane(&node);
        Part { name, rect: node.rect(), pane: panes.iter().position(|one| *one == pane) }
    };
    nodes.map(of).collect()
}

/// The first part that leaves the window or the panel to a side.
fn cut_at_a_side(harness: &Harness<'_, App>) -> Option<String> {
    let (screen, panel) = (screen(harness), harness.get_by_label("Model").rect().left());
    let right = |part: &Part| if part.pane == Some(0) { panel } else { screen.right() };
    let leaves = |part: &Part| part.rect.left() < screen.left() || part.rect.right() > right(part);
    parts(harness).into_iter().find(leaves).map(|part| format!("{}: {:?}", part.name, part.rect))
}

/// Two that lie over each other in the same part of the frame.
fn over_each_other(harness: &Harness<'_, App>) -> Option<[String; 2]> {
    let parts: Vec<Part> = parts(harness).into_iter().filter(|part| part.pane.is_some()).collect();
    let pairs = parts.iter().enumerate().flat_map(|(at, one)| parts[..at].iter().map(move |other| [one, other]));
    let over =
        |[one, other]: &[&Part; 2]| one.pane == other.pane && one.rect.shrink(1.0).intersects(other.rect.shrink(1.0));
    pairs.into_iter().find(over).map(|pair| pair.map(|part| part.name.clone()))
}

/// Clicks a point of the ground in the picture, and leaves the pointer there.
fn click_the_ground(harness: &mut Harness<'_, App>) {
    let rect = harness.get_by_label("Model").rect();
    // beside the legend
    let at = rect.right_center() + egui::vec2(-60.0, rect.height() * 0.35);
    click_at(harness, at);
    harness.hover_at(at + egui::vec2(1.0, 0.0));
    harness.run_steps(2);
}

/// Moves the pointer to a wall, whose description is long: as much is shown as there is room for, in whole words.
fn read_a_wall(harness: &mut Harness<'_, App>) {
    let rect = harness.get_by_label("Model").rect();
    let read = |harness: &Harness<'_, App>| {
        let node = harness.query_by_label_contains("down on its face")?;
        let whole = node.accesskit_node();
        Some((whole.label().or_else(|| whole.value()).unwrap_or_default(), node.rect()))
    };
    for at in 0..400 {
        let [x, y] = [at % 20, at / 20].map(|at| (at as f32 + 0.5) / 20.0);
        harness.hover_at(rect.lerp_inside(egui::vec2(x, y)));
        harness.run_steps(2);
        if let Some((text, rect)) = read(harness) {
            let font = egui::FontId::proportional(13.5);
            let galley = harness.ctx.fonts_mut(|fonts| fonts.layout_no_wrap(text.clone(), font, egui::Color32::BLACK));
            assert!(rect.width() > galley.size().x - 1.0, "{text} has {} of {}", rect.width(), galley.size().x);
            return;
        }
    }
    panic!("there is no wall");
}

#[test]
fn nothing_is_cut_off() {
    let (_folder, site) = small_site();
    for scale in SCALES {
        let theme = if scale == 1.25 { egui::Theme::Dark } else { egui::Theme::Light };
        let mut harness = scaled(Some(&site), scale, theme);
        // the longest zone
        write(&mut harness, "Date", "2026-06-21");
        for (facades, what) in [(false, "h of shadow"), (true, "h of sun")] {
            if facades {
                click(&mut harness, "On façades, too");
            }
            click(&mut harness, "Find the hours");
            settle(&mut harness);
            click_the_ground(&mut harness);
            assert_eq!(cut_at_a_side(&harness), None, "{what} at {scale}");
            assert_eq!(over_each_other(&harness), None, "{what} at {scale}");
            let model = harness.get_by_label("Model").rect();
            for name in ["Sun at ", "Keep in the site file", "Forget the point"] {
                let card = harness.get_by_label_contains(name).rect();
                assert!(model.contains_rect(card), "{name} at {scale}: {card:?} in {model:?}");
            }
            // a small picture is covered by it
            click(&mut harness, "Forget the point");
            if facades {
                read_a_wall(&mut harness);
                assert_eq!(over_each_other(&harness), None, "a wall at {scale}");
            }
        }
        for name in ["Time of day", "Day of the year", "azimuth", "altitude", "(UTC+02:00, daylight saving)"] {
            let rect = harness.get_by_label_contains(name).rect();
            assert!(screen(&harness).contains_rect(rect), "{name} at {scale}: {rect:?}");
        }
        let model = harness.get_by_label("Model").rect();
        assert!(model.width() > 200.0 && model.height() > 120.0, "a picture at {scale}: {model:?}");
    }
}

/// The change, its areas, and the values at a point.
#[test]
fn change_is_whole_at_every_scale() {
    let (_folder, site) = small_site();
    let before = site.with_file_name("before.toml");
    let text = std::fs::read_to_string(&site).unwrap().replace("Works", "Works as they have stood since 1911");
    std::fs::write(&before, text.replace("path = \"works.glb\"", "path = \"works.glb\"\ncasts = false")).unwrap();
    for scale in SCALES {
        let mut harness = scaled(Some(&site), scale, egui::Theme::Light);
        let width = harness.get_by_label("Model").rect().left();
        click(&mut harness, "Compare with");
        click(&mut harness, "Another file…");
        answer(&mut harness, &before, "Compare");
        click_the_ground(&mut harness);
        harness.get_by_label("Sun lost and gained");
        assert_eq!(cut_at_a_side(&harness), None, "{scale}");
        assert_eq!(over_each_other(&harness), None, "{scale}");
        assert_eq!(harness.get_by_label("Model").rect().left(), width, "the panel has grown at {scale}");
    }
}

#[test]
fn panel_is_as_wide_as_it_is_made() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let left = |harness: &Harness<'_, App>| harness.get_by_label("Model").rect().left();
    let edge = egui::pos2(left(&harness) - 2.0, 300.0);
    drag(&mut harness, edge, egui::pos2(400.0, 300.0));
    settle(&mut harness);
    let wide = left(&harness);
    assert!((wide - 400.0).abs() < 3.0, "{wide}");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    click(&mut harness, "Components");
    settle(&mut harness);
    assert_eq!(left(&harness), wide);
    // nor do numbers that have no room in it
    let text = std::fs::read_to_string(&site).unwrap();
    let vast = text.replace("[plan]\ncell = 2.0\n", "").replace(".glb\"", ".glb\"\nscale = 9000.0");
    std::fs::write(&site, &vast).unwrap();
    let before = site.with_file_name("before.toml");
    std::fs::write(&before, vast.replace("scale", "casts = false\nscale").replace("Works", "Bare")).unwrap();
    drop_file(&mut harness, &site);
    drag(&mut harness, egui::pos2(wide - 2.0, 300.0), egui::pos2(310.0, 300.0));
    settle(&mut harness);
    let narrow = left(&harness);
    assert!((narrow - 310.0).abs() < 3.0, "{narrow}");
    click(&mut harness, "Compare with");
    click(&mut harness, "Another file…");
    answer(&mut harness, &before, "Compare");
    harness.get_by_label("Sun lost and gained");
    assert_eq!(left(&harness), narrow, "the panel has grown");
    drag(&mut harness, egui::pos2(narrow - 2.0, 300.0), egui::pos2(100.0, 300.0));
    settle(&mut harness);
    // not so narrow that it would cut what it says
    assert!((295.0..=305.0).contains(&left(&harness)), "{}", left(&harness));
}

#[test]
fn lists_and_menus_are_seen_whole_or_scrolled() {
    let (_folder, site) = small_site();
    let bars = |harness: &Harness<'_, App>| harness.query_all_by(|node| node.role() == Role::ScrollBar).count();
    for scale in SCALES {
        let mut harness = scaled(Some(&site), scale, egui::Theme::Light);
        if scale == 1.0 {
            let before = bars(&harness);
            harness.get_by_role_and_label(egui::Role::ComboBox, "Technique").click();
            harness.run_steps(3);
            assert_eq!(bars(&harness), before, "the list of techniques is scrolled");
            for word in ["auto", "stencil", "projected", "shadow-map", "hybrid", "smoothie", "soft-texture", "ray-cast"]
            {
                let rect = harness.query_all_by_label(word).map(|node| node.rect()).next_back().expect(word);
                assert!(screen(&harness).contains_rect(rect), "{word}: {rect:?}");
            }
            harness.key_press(Key::Escape);
            harness.run_steps(2);
        }
        for (menu, last) in [("File", "Copy the picture"), ("View", "Interface at its own size")] {
            let before = bars(&harness);
            click(&mut harness, menu);
            harness.run_steps(2);
            assert_eq!(cut_at_a_side(&harness), None, "{menu} at {scale}");
            assert!(scale > 1.0 || bars(&harness) == before, "{menu} is scrolled");
            let at = harness.get_by_label_contains(last).rect();
            harness.hover_at(egui::pos2(at.left() + 20.0, 60.0));
            for _ in 0..40 {
                let delta = egui::vec2(0.0, -60.0);
                let (unit, modifiers) = (egui::MouseWheelUnit::Point, egui::Modifiers::NONE);
                let (phase, source) = (egui::TouchPhase::Move, egui::MouseWheelSource::Unknown);
                harness.event(Event::MouseWheel { unit, delta, modifiers, phase, source });
                harness.step();
            }
            let rect = harness.get_by_label_contains(last).rect();
            assert!(screen(&harness).contains_rect(rect), "{last} at {scale}: {rect:?}");
            harness.key_press(Key::Escape);
            harness.run_steps(2);
        }
    }
}
