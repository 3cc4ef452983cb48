//! Where points lie, and what spells have in common.

use super::corner;
use glam::DVec2;
use gnomon::judgement::{CountedParts, DeemedBorder, LitSpell, SpellBound, both, clipped, triangles};
use gnomon::rules::{Band, CornerRule, DeemedBoundary, RuleReceiver, Spell};
use gnomon::site::{AreaSurface, JudgedArea, JudgedPlot, PlotSide};

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

/// The square metres of an area that are at least 3 m wide, and those that are not.
fn wide(rings: Vec<Vec<DVec2>>) -> [f64; 2] {
    let receiver = RuleReceiver::Area { least_width_m: 3.0 };
    let area = JudgedArea { name: "any".into(), rings, surface: AreaSurface::Ground(0.0), dwelling: None };
    let parts = CountedParts::of(&receiver, &area);
    [parts.m2(), parts.narrow_m2]
}

#[test]
fn narrow_parts_are_cut_and_corners_are_kept() {
    let near = |[wide, narrow]: [f64; 2], expected: [f64; 2]| {
        assert!(
            (wide - expected[0]).abs() < 0.01 && (narrow - expected[1]).abs() < 0.01,
            "{wide} {narrow} {expected:?}"
        );
    };
    assert_eq!(wide(vec![rectangle([0.0, 0.0], [3.0, 10.0])]), [30.0, 0.0]);
    assert_eq!(wide(vec![rectangle([0.0, 0.0], [2.99, 10.0])]), [0.0, 2.99 * 10.0]);
    let corners = |of: &[[f64; 2]]| of.iter().map(|[x, y]| corner(*x, *y)).collect::<Vec<_>>();
    // two courts with a passage of 2 m between them
    let courts = [
        [0.0, 0.0],
        [6.0, 0.0],
        [6.0, 2.0],
        [12.0, 2.0],
        [12.0, 0.0],
        [18.0, 0.0],
        [18.0, 6.0],
        [12.0, 6.0],
        [12.0, 4.0],
        [6.0, 4.0],
        [6.0, 6.0],
        [0.0, 6.0],
    ];
    near(wide(vec![corners(&courts)]), [72.0, 12.0]);
    // far from the place
    let far = |ring: &[[f64; 2]]| corners(&ring.iter().map(|[x, y]| [x + 45e3, y - 45e3]).collect::<Vec<_>>());
    near(wide(vec![far(&courts)]), [72.0, 12.0]);
    // a pond a metre from two sides
    let pond: Vec<DVec2> = rectangle([1.0, 1.0], [4.0, 4.0]).into_iter().rev().collect();
    near(wide(vec![rectangle([0.0, 0.0], [10.0, 10.0]), pond]), [84.0, 7.0]);
    // arms of 4 m, and a corner of 80°
    let ell = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]];
    assert_eq!(wide(vec![corners(&ell)]), [64.0, 0.0]);
    let leaning = [[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [1.4, 8.0]];
    assert_eq!(wide(vec![corners(&leaning)])[1], 0.0);
    // the tip of a corner of 17° is cut off, and never more than is narrower
    let [kept, cut] = wide(vec![corners(&[[0.0, 0.0], [20.0, 0.0], [20.0, 6.0]])]);
    assert!((kept + cut - 60.0).abs() < 1e-6 && cut > 5.0 && cut < 15.0, "{kept} {cut}");
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
