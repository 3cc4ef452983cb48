//! What is said of a mesh: open, crowded, flipped, degenerate, duplicate.

use super::{part, sphere};
use crate::exact::scenes::cuboid;
use glam::{DVec3, dvec3};
use gnomon::mesh::report::{ComponentReport, components};
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
    let report = of(crate::exact::scenes::joined(vec![block(), other]));
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
