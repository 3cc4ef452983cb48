//! Where points lie, and what spells have in common.

use super::corner;
use glam::DVec2;
use gnomon::judgement::{DeemedBorder, LitSpell, SpellBound, both, clipped, narrow_place, triangles};
use gnomon::rules::{Band, CornerRule, DeemedBoundary, Spell};
use gnomon::site::{JudgedPlot, PlotSide};

fn rectangle([west, south]: [f64; 2], [east, north]: [f64; 2]) -> Vec<DVec2> {
    vec![corner(west, south), corner(east, south), corner(east, north), corner(west, north)]
}

#[test]
fn triangles_cover_a_polygon_with_holes() {
    let ell = vec![
        corner(0.0, 0.0),
        corner(10.0, 1.0),
        corner(9.0, 4.0),
        corner(4.0, 3.5),
        corner(3.0, 9.0),
        corner(-1.0, 8.0),
    ];
    let hole: Vec<DVec2> = rectangle([0.5, 1.0], [1.5, 3.0]).into_iter().rev().collect();
    let other = rectangle([20.0, 0.0], [21.0, 1.0]);
    let shoelace = |ring: &[DVec2]| -> f64 {
        (0..ring.len()).map(|at| ring[at].perp_dot(ring[(at + 1) % ring.len()])).sum::<f64>() / 2.0
    };
    let rings = vec![ell, hole, other];
    let expected: f64 = rings.iter().map(|ring| shoelace(ring)).sum();
    let found: f64 = triangles(&rings).iter().map(|part| part.m2).sum();
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    assert!(triangles(&[]).is_empty());
}

#[test]
fn narrow_places_are_found() {
    assert_eq!(narrow_place(&[rectangle([0.0, 0.0], [3.0, 10.0])], 3.0), None);
    let (_, wide) = narrow_place(&[rectangle([0.0, 0.0], [2.5, 10.0])], 3.0).expect("narrow");
    assert!((wide - 2.5).abs() < 1e-9);
    // a passage beside a court
    let court = vec![
        corner(0.0, 0.0),
        corner(10.0, 0.0),
        corner(10.0, 1.5),
        corner(5.0, 1.5),
        corner(5.0, 8.0),
        corner(0.0, 8.0),
    ];
    let (at, wide) = narrow_place(&[court], 3.0).expect("narrow");
    assert!((wide - 1.5).abs() < 1e-9 && at.x > 5.0, "{at} {wide}");
    // a corner of 80° is none
    let leaning = vec![corner(0.0, 0.0), corner(10.0, 0.0), corner(10.0, 8.0), corner(1.4, 8.0)];
    assert_eq!(narrow_place(&[leaning], 3.0), None);
    let tip = vec![corner(0.0, 0.0), corner(20.0, 0.0), corner(20.0, 6.0)];
    assert!(narrow_place(&[tip], 3.0).is_some());
}

/// A road of 6, 12 and 14 m moves the border by 3, 7 and 9 m.
#[test]
fn the_deemed_border_lies_in_the_road() {
    for (road_m, out) in [(0.0, 0.0), (6.0, 3.0), (12.0, 7.0), (14.0, 9.0)] {
        let mut sides = vec![PlotSide::default(); 4];
        sides[2] = PlotSide { road_m, neighbour_higher_m: 3.0 };
        let plot = JudgedPlot { border: rectangle([0.0, 0.0], [20.0, 10.0]), sides, mean_ground: None };
        let border = DeemedBorder::of(&plot, Some(DeemedBoundary::Japan), CornerRule::Round);
        assert!((border.distance_m(corner(5.0, 30.0)) - (20.0 - out)).abs() < 1e-9, "{road_m}");
        assert!((border.distance_m(corner(5.0, -4.0)) - 4.0).abs() < 1e-9);
        assert!(border.distance_m(corner(5.0, 5.0)) < 0.0);
        assert_eq!([border.spot(corner(5.0, 30.0)).raised_m, border.spot(corner(5.0, -4.0)).raised_m], [1.0, 0.0]);
        let plain = DeemedBorder::of(&plot, None, CornerRule::Round);
        assert!((plain.distance_m(corner(5.0, 30.0)) - 20.0).abs() < 1e-9);
    }
}

#[test]
fn lines_go_round_corners_or_straight_on() {
    let plot = JudgedPlot {
        border: rectangle([0.0, 0.0], [20.0, 10.0]),
        sides: vec![PlotSide::default(); 4],
        mean_ground: None,
    };
    let band = Band { from_m: 5.0, to_m: 10.0 };
    for (corners, farthest) in [(CornerRule::Round, 5.0), (CornerRule::Mitred, 50f64.sqrt())] {
        let border = DeemedBorder::of(&plot, None, corners);
        let spots = border.spots(Band { from_m: 5.0, to_m: 5.0 + 1e-9 }, 100.0, 0.5);
        let from_plot = |at: DVec2| at.distance(at.clamp(DVec2::ZERO, corner(20.0, 10.0)));
        let most = spots.iter().map(|spot| from_plot(spot.at)).fold(0.0, f64::max);
        assert!((most - farthest).abs() < 1e-6, "{corners:?} {most}");
        assert!(spots.iter().all(|spot| (border.distance_m(spot.at) - 5.0).abs() < 1e-6), "{corners:?}");
        let all = border.spots(band, 100.0, 0.5);
        assert!(all.len() > spots.len());
        assert!(all.iter().all(|spot| border.is_in(band, spot.at)));
        // what lies a little inside is put onto the line
        let inside = corner(23.0, 13.5);
        assert!((border.distance_m(border.onto(band, inside)) - 5.0).abs() < 1e-6, "{corners:?}");
    }
}

#[test]
fn spells_keep_what_bounds_them() {
    let lit = |start, end, before, after| LitSpell { spell: Spell::new(start, end), before, after };
    let (wall, tree) = (SpellBound::Component(1), SpellBound::Component(2));
    let one = [lit(100, 200, wall, tree), lit(300, 400, tree, wall)];
    let cut = clipped(&one, &[Spell::new(150, 350)], SpellBound::Cut);
    assert_eq!(cut, [lit(150, 200, SpellBound::Cut, tree), lit(300, 350, tree, SpellBound::Cut)]);
    // a second or two are the same moment, and the nearer cause is told
    let same = clipped(&one, &[Spell::new(101, 199)], SpellBound::Cut);
    assert_eq!(same, [lit(101, 199, wall, tree)]);
    assert_eq!(both(&one, &[]), []);
}
