//! Terrain in drawings of the plan: drawn as ground, with the same lines and areas as the plane if it is flat.

use super::{drawn, mesh, site, terrain};
use crate::shared::scenes::cuboid;
use glam::dvec3;
use gnomon::deliver::Sink;
use gnomon::deliver::volumes::volumes;
use gnomon::export::figure::{self, FigureContext};
use gnomon::mesh::Mesh;
use gnomon::profile::Profile;
use gnomon::profile::Provenance;
use gnomon::site::Site;
use gnomon::study::Event;
use gnomon::view::Surface;
use std::ops::ControlFlow;
use std::path::Path;

/// A group of a drawing's SVG, up to its end; empty if there is none.
fn group<'a>(svg: &'a str, name: &str) -> &'a str {
    let after = svg.split(&format!("<g id=\"{name}\">")).nth(1).unwrap_or_default();
    after.split("</g>").next().unwrap_or_default()
}

fn context<'a>(site: &'a Site, (mesh, surface): (&'a Mesh, &'a Surface), drawn: &'a Provenance) -> FigureContext<'a> {
    let Site { place, track, receivers, ground, .. } = site;
    FigureContext { place, track, mesh, surface, receivers: *receivers, ground: *ground, drawn }
}

fn hours(site: &Site) -> (String, Vec<[u8; 3]>) {
    let (outcome, _) = drawn(site);
    let surface = outcome.surface.as_ref().unwrap();
    let scene = context(site, (&outcome.surface_mesh, surface), &outcome.drawn);
    let profile: &Profile = &outcome.profile;
    let svg = figure::iso_hours(&scene, profile).unwrap().svg();
    let page = image::load_from_memory(&figure::profile(&scene, profile).unwrap()).unwrap().to_rgb8();
    (svg, page.pixels().map(|pixel| pixel.0).collect())
}

/// Volumes are cut at a plane, and the output says so.
#[test]
fn volumes_say_that_they_do_not_end_at_the_terrain() {
    let block = || cuboid("box", dvec3(-6.0, -4.0, 2.5), dvec3(7.0, 5.0, 21.0));
    let of = |site: &Site| {
        let mut told = String::new();
        let mut hear = |event: Event<'_>| {
            if let Event::Note(note) = event {
                told.push_str(&note.to_string());
            }
            ControlFlow::Continue(())
        };
        let answer = volumes(site, Path::new("volumes.glb"), Sink::Memory, &mut hear).unwrap();
        (told, answer.report)
    };
    let words = "the volumes end at a plane at 2.50 m, and not at the terrain";
    let (told, report) = of(&site(mesh(vec![terrain(400.0, |_, _| 2.5), block()]), Some(2.5)));
    assert!(told.contains(words) && report.contains(words), "{told} {report}");
    let (told, report) = of(&site(Mesh::build(vec![block()]).unwrap(), Some(2.5)));
    assert!(!told.contains("end at a plane") && !report.contains("end at a plane"), "{told}");
}

#[test]
fn terrain_is_drawn_as_the_ground_that_it_is() {
    let block = || cuboid("box", dvec3(-6.0, -4.0, 2.5), dvec3(7.0, 5.0, 21.0));
    let on_plane = site(Mesh::build(vec![block()]).unwrap(), Some(2.5));
    let on_terrain = site(mesh(vec![terrain(400.0, |_, _| 2.5), block()]), Some(2.5));
    let [(plane, plane_page), (level, level_page)] = [&on_plane, &on_terrain].map(hours);
    for name in ["bands", "roofs", "iso-hours", "buildings"] {
        assert!(!group(&plane, name).is_empty(), "{name}");
        assert_eq!(group(&plane, name), group(&level, name), "{name}");
    }
    // the panel says what the ground is
    assert!(level.contains("terrain; beyond it 2.50 m") && !plane.contains("terrain"));
    let differ = plane_page.iter().zip(&level_page).filter(|(one, other)| one != other).count();
    assert!(differ < plane_page.len() / 100, "{differ} pixels differ, and not the panel's line alone");

    // as a roof it would be judged nowhere
    let mut as_roof = on_terrain;
    as_roof.mesh.components[0].is_terrain = false;
    let (roof, roof_page) = hours(&as_roof);
    assert_ne!(group(&roof, "iso-hours"), group(&plane, "iso-hours"));
    let differ = plane_page.iter().zip(&roof_page).filter(|(one, other)| one != other).count();
    assert!(differ > plane_page.len() / 10, "{differ} pixels differ");
}

#[test]
fn lines_of_hours_lie_on_a_slope_and_the_slope_has_no_outline() {
    let slope = |x: f64, _: f64| 0.25 * x;
    let block = cuboid("box", dvec3(-6.0, -4.0, -8.0), dvec3(7.0, 5.0, 21.0));
    let (with, _) = hours(&site(mesh(vec![terrain(400.0, slope), block]), None));
    assert!(!group(&with, "iso-hours").is_empty() && !group(&with, "roofs").is_empty());
    let (bare, _) = hours(&site(mesh(vec![terrain(400.0, slope)]), None));
    assert_eq!(["roofs", "buildings"].map(|name| group(&bare, name)), ["", ""]);
}
