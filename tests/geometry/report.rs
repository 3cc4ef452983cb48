//! The defects of a mesh: open, crowded, flipped, degenerate, duplicate.

use super::{part, sphere};
use crate::shared::scenes::cuboid;
use glam::{DVec3, dvec3};
use gnomon::mesh::report::{ComponentReport, OpenKind, components};
use gnomon::mesh::{Mesh, Part};

fn block() -> Part {
    cuboid("block", dvec3(-5.0, -4.0, 0.0), dvec3(5.0, 4.0, 9.0))
}

fn of(part: Part) -> ComponentReport {
    components(&Mesh::build(vec![part]).unwrap()).remove(0)
}

/// Open, crowded, flipped edges; degenerate, duplicate triangles.
fn counts(report: &ComponentReport) -> [usize; 5] {
    [
        report.open_edges,
        report.crowded_edges,
        report.flipped_edges,
        report.degenerate_triangles,
        report.duplicate_triangles,
    ]
}

#[test]
fn clean_solids_have_nothing_said_against_them() {
    for solid in [block(), sphere(7.0, 24, 12)] {
        let triangles = solid.triangles.len();
        let report = of(solid);
        assert_eq!(counts(&report), [0; 5]);
        assert!(report.closed && report.clean());
        assert_eq!(report.triangles, triangles);
    }
}

#[test]
fn a_hole_is_open() {
    let mut holed = block();
    holed.triangles.remove(4);
    let report = of(holed);
    assert_eq!(counts(&report), [3, 0, 0, 0, 0]);
    assert!(!report.closed && !report.clean());
}

#[test]
fn a_book_is_crowded_at_its_spine() {
    let spine = [dvec3(0.0, 0.0, 0.0), dvec3(0.0, 0.0, 5.0)];
    let pages = |count: u32| {
        let outer = (0..count).map(|page| dvec3(f64::from(page).cos(), f64::from(page).sin(), 2.0));
        part(spine.into_iter().chain(outer).collect(), (0..count).map(|page| [0, 1, page + 2]).collect())
    };
    assert_eq!(counts(&of(pages(3))), [6, 1, 0, 0, 0]);
    assert_eq!(counts(&of(pages(4))), [8, 1, 0, 0, 0]);
    // two pages that both run up the spine
    assert_eq!(counts(&of(pages(2))), [4, 0, 1, 0, 0]);
}

#[test]
fn two_solids_at_one_edge_are_closed_and_crowded() {
    let other = cuboid("block", dvec3(5.0, 4.0, 0.0), dvec3(9.0, 9.0, 9.0));
    let report = of(crate::shared::scenes::joined(vec![block(), other]));
    assert_eq!(counts(&report), [0, 1, 0, 0, 0]);
    assert!(report.closed && !report.clean());
}

#[test]
fn a_flipped_triangle_is_flipped_at_its_edges() {
    let mut flipped = block();
    flipped.triangles[4].swap(1, 2);
    let report = of(flipped);
    assert_eq!(counts(&report), [0, 0, 3, 0, 0]);
    assert!(!report.closed);
    let mut inside_out = block();
    inside_out.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    assert_eq!(counts(&of(inside_out)), [0; 5]);
}

#[test]
fn triangles_without_area_and_repeated_ones_are_counted() {
    let mut needle = block();
    needle.positions.extend([dvec3(20.0, 0.0, 0.0), dvec3(21.0, 1.0, 0.0), dvec3(22.0, 2.0, 0.0)]);
    needle.triangles.push([8, 9, 10]);
    assert_eq!(counts(&of(needle)), [3, 0, 0, 1, 0]);

    let mut repeated = block();
    let [a, b, c] = repeated.triangles[4];
    repeated.triangles.push([b, c, a]);
    let report = of(repeated.clone());
    assert_eq!(counts(&report), [0, 3, 0, 0, 1]);
    assert!(!report.closed);
    repeated.triangles.push([a, c, b]);
    assert_eq!(counts(&of(repeated)), [0, 3, 0, 0, 2]);
}

#[test]
fn each_part_is_judged_for_itself() {
    let mut open = block();
    open.name = "open".into();
    open.triangles.pop();
    let away =
        Part { positions: block().positions.iter().map(|position| position + DVec3::X * 50.0).collect(), ..block() };
    let reports = components(&Mesh::build(vec![block(), open, away]).unwrap());
    let said: Vec<_> = reports.iter().map(|report| (report.name.as_str(), report.clean())).collect();
    assert_eq!(said, [("block", true), ("open", false), ("block", true)]);
}

/// Kind, edges, metres (to the millimetre) and middle of the places that are open.
fn open(report: &ComponentReport) -> Vec<(OpenKind, usize, f64, DVec3)> {
    let round = |metres: f64| (metres * 1000.0).round() / 1000.0;
    report.places.open.iter().map(|open| (open.kind, open.edges, round(open.length_m), open.near)).collect()
}

#[test]
fn a_hole_is_told_as_one_place() {
    let mut holed = block();
    // the lid: triangles 2 and 3 of the box
    holed.triangles.drain(2..4);
    let report = of(holed.clone());
    assert_eq!(open(&report), [(OpenKind::Hole, 4, 36.0, dvec3(0.0, 0.0, 9.0))]);
    // half of the west wall, too: the hole has a corner more
    let west =
        holed.triangles.iter().position(|face| face.iter().all(|&corner| holed.positions[corner as usize].x < 0.0));
    holed.triangles.remove(west.unwrap());
    let found = &open(&of(holed))[..];
    assert!(matches!(found, [(OpenKind::Hole, 5, ..)]), "{found:?}");
}

#[test]
fn a_sheet_has_a_rim_and_a_hole_in_it_is_a_hole() {
    // a frame of eight triangles around a square hole
    let ring =
        |half: f64| [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| dvec3(x * half, y * half, 2.0));
    let faces = (0..4).flat_map(|at| [[at, (at + 1) % 4, 4 + (at + 1) % 4], [at, 4 + (at + 1) % 4, 4 + at]]);
    let frame = part(ring(3.0).into_iter().chain(ring(1.0)).collect(), faces.collect());
    let middle = dvec3(0.0, 0.0, 2.0);
    assert_eq!(open(&of(frame)), [(OpenKind::Rim, 4, 24.0, middle), (OpenKind::Hole, 4, 8.0, middle)]);
}

#[test]
fn corners_within_an_open_edge_are_t_junctions() {
    // one triangle on one side of an edge, two on the other
    let split = |aside: f64| {
        let corners = [(0.0, 0.0), (8.0, 0.0), (4.0, 6.0), (3.0, aside), (4.0, -6.0)];
        let positions = corners.map(|(x, y)| dvec3(x, y, 7.0)).to_vec();
        of(part(positions, vec![[0, 1, 2], [0, 4, 3], [3, 4, 1]]))
    };
    let report = split(0.0);
    assert_eq!((report.open_edges, report.t_junctions), (7, 1));
    let found = &report.places.t_junctions[0];
    assert_eq!((found.at, found.edge.length_m), (dvec3(3.0, 0.0, 7.0), 8.0));
    assert_eq!(split(-0.01).t_junctions, 0);

    // the same within a closed surface: its seam lies on itself
    let mut seamed = block();
    let [a, b, c] = seamed.triangles[4];
    let middle = (seamed.positions[a as usize] + seamed.positions[b as usize]) / 2.0;
    seamed.positions.push(middle);
    seamed.triangles[4] = [a, 8, c];
    seamed.triangles.push([8, b, c]);
    let report = of(seamed);
    assert_eq!((report.open_edges, report.t_junctions), (3, 1));
    assert_eq!(report.places.open[0].kind, OpenKind::Seam);
    assert_eq!(report.places.t_junctions[0].at, middle);
}

#[test]
fn places_are_where_the_faults_are_the_longest_first() {
    let mut dirty = block();
    dirty.positions.iter_mut().for_each(|position| *position += dvec3(50_000.0, -70_000.0, 300.0));
    dirty.triangles[4].swap(1, 2);
    let report = of(dirty);
    let lengths: Vec<_> = report.places.flipped.iter().map(|edge| edge.length_m).collect();
    assert!(lengths.len() == 3 && lengths.is_sorted_by(|one, other| one >= other), "{lengths:?}");
    for edge in &report.places.flipped {
        assert_eq!((edge.from.distance(edge.to), edge.faces), (edge.length_m, 2));
        for end in [edge.from, edge.to] {
            let local = end - dvec3(50_000.0, -70_000.0, 300.0);
            assert!(local.x.abs() == 5.0 && local.y.abs() == 4.0 && [0.0, 9.0].contains(&local.z), "{local}");
        }
    }

    let mut needles = block();
    needles.positions.extend([dvec3(20.0, 0.0, 0.0), dvec3(21.0, 0.0, 0.0), dvec3(26.0, 0.0, 0.0)]);
    needles.triangles.extend([[8, 9, 10], [0, 0, 1], [0, 1, 0], needles.triangles[0]]);
    let places = of(needles).places;
    let found: Vec<_> = places.degenerate.iter().map(|place| place.length_m).collect();
    assert_eq!(found, [10.0, 10.0, 6.0]);
    assert_eq!(places.duplicate.len(), 1);

    let mut confetti = part(Vec::new(), Vec::new());
    for at in 0..150_u32 {
        let corner = dvec3(f64::from(at) * 9.0, 0.0, 0.0);
        let size = 1.0 + f64::from(at % 7);
        confetti.positions.extend([corner, corner + DVec3::X * size, corner + DVec3::Y * size]);
        confetti.triangles.push([at * 3, at * 3 + 1, at * 3 + 2]);
    }
    let report = of(confetti);
    assert_eq!((report.open_edges, report.places.open.len()), (450, 100));
    assert_eq!(report.places.open[0].kind, OpenKind::Rim);
    assert!(report.places.open.is_sorted_by(|one, other| one.length_m >= other.length_m));
}
