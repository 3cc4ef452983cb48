//! `[[area]]` and `[plot]`: borders, faces, and everything that is none.

use super::{fails, judged, notes};
use glam::{DVec2, dvec2};
use gnomon::site::{AreaSurface, JudgedArea, PlotSide};
use proptest::prelude::*;

fn area(corners: &str) -> String {
    format!("[[area]]\nname = \"Garden\"\npolygon = {corners}\n")
}

fn signed_area(ring: &[DVec2]) -> f64 {
    (0..ring.len()).map(|at| ring[at].perp_dot(ring[(at + 1) % ring.len()])).sum::<f64>() / 2.0
}

#[test]
fn a_polygon_as_meant() {
    for corners in [
        "[[0, 20], [10, 20], [10, 30], [0, 30]]",
        // clockwise, closed, and with a corner twice
        "[[0, 30], [10, 30], [10, 30], [10, 20], [0, 20], [0, 30]]",
    ] {
        let site = judged(&area(corners));
        let [JudgedArea { name, rings, surface: AreaSurface::Ground(above), dwelling: None }] = site.areas.as_slice()
        else {
            panic!("{:?}", site.areas)
        };
        assert_eq!((name.as_str(), *above, rings.len()), ("Garden", 0.0, 1));
        assert_eq!((rings[0].len(), signed_area(&rings[0])), (4, 100.0), "{rings:?}");
    }
    let site = judged(
        "[[area]]\npolygon = [[0, 0], [1, 0], [0, 1]]\nheight = 2.5\n[[area]]\npolygon = [[0, 0], [1, 0], [0, 1]]\nlevel = -1",
    );
    assert!(matches!(site.areas[0].surface, AreaSurface::Ground(2.5)), "{:?}", site.areas[0]);
    assert!(matches!(site.areas[1].surface, AreaSurface::Level(-1.0)), "{:?}", site.areas[1]);
    assert_eq!([&site.areas[0].name, &site.areas[1].name], ["area 1", "area 2"]);
}

#[test]
fn borders_that_bound_nothing_are_told() {
    let told =
        |corners: &str, words: &[&str]| fails(&area(corners), &[words, &["[[area]] polygon", "\"Garden\""]].concat());
    told("[]", &["0 corners", "at least three"]);
    told("[[0, 0], [1, 0], [0, 0]]", &["2 corners", "at least three"]);
    told("[[3, 3], [3, 3], [3, 3], [3, 3]]", &["1 corner "]);
    told("[[0, 0], [5, 5], [9, 9]]", &["no area", "one line"]);
    // a bow tie
    told("[[0, 0], [9, 9], [9, 0], [0, 9]]", &["crosses or touches itself", "corners 1 and 2", "corners 3 and 4"]);
    // a corner on another side
    told("[[0, 0], [10, 0], [10, 10], [5, 0], [0, 10]]", &["crosses or touches itself"]);
    // out and back along one line
    told("[[0, 0], [10, 0], [10, 10], [10, 5], [20, 5], [10, 5], [10, 2], [0, 10]]", &["crosses or touches itself"]);
    told("[[0, 0], [10, 0], [20, 0], [10, 0], [10, 10]]", &["crosses or touches itself", "corners 3 and 4"]);
    told("[[0, 0], [nan, 0], [1, 1]]", &["number 2", "50 km"]);
    told("[[0, 0], [inf, 0], [1, 1]]", &["number 2"]);
    told(
        "[[603000, 5341000], [603010, 5341000], [603000, 5341010]]",
        &["number 1", "50 km", "east and north of the place"],
    );
}

#[test]
fn keys_that_exclude_each_other_are_told() {
    fails("[[area]]\nname = \"a\"", &["polygon or file or component in [[area]]", "polygon = [["]);
    fails("[[area]]\npolygon = [[0, 0]]\ncomponent = \"terrace\"", &["[[area]] component", "`polygon`"]);
    fails("[[area]]\npolygon = [[0, 0], [1, 0], [0, 1]]\nheight = 1\nlevel = 1", &["[[area]] level", "`height`"]);
    fails("[[area]]\npolygon = [[0, 0], [1, 0], [0, 1]]\ncrs = \"EPSG:4326\"", &["[[area]] crs"]);
    fails("[[area]]\npolygon = [[0, 0], [1, 0], [0, 1]]\nheight = -1", &["[[area]] height", "-1"]);
    fails("[[area]]\npolygon = [[0, 0], [1, 0], [0, 1]]\nlevel = nan", &["[[area]] level", "NaN"]);
    fails("[[area]]\ncomponent = \"terrace\"\nlevel = 3", &["[[area]] level", "`component`"]);
    fails("[[area]]\ncomponent = \"terace\"", &["[[area]] component", "\"terace\"", "\"terrace\""]);
    fails("[[area]]\ncomponent = []", &["[[area]] component", "no component"]);
    let upright = super::folder("[[area]]\ncomponent = \"fence\"");
    let fence = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 0.0, 2.0], [0.0, 0.0, 2.0]];
    super::write(&upright, "town.obj", &super::Drawing::default().object("fence").sheet(fence).text);
    super::fails_in(upright.path(), &["[[area]] component", "no face that looks upward"]);
    let twice = format!("{}{}", area("[[0, 0], [1, 0], [0, 1]]"), area("[[5, 5], [6, 5], [5, 6]]"));
    fails(&twice, &["[[area]] number 2 name", "\"Garden\"", "own name"]);
}

#[test]
fn a_component_gives_its_upper_faces() {
    let site = judged("[[area]]\nname = \"Deck\"\ncomponent = [\"terrace\", \"barn\"]");
    let [JudgedArea { rings, surface: AreaSurface::Faces(faces), .. }] = site.areas.as_slice() else {
        panic!("{:?}", site.areas)
    };
    assert!(rings.is_empty());
    let up = |[a, b, c]: &[glam::DVec3; 3]| (*b - *a).cross(*c - *a).z / 2.0;
    let of_height = |z: f64| faces.iter().filter(|face| face[0].z == z).map(up).sum::<f64>();
    assert_eq!((faces.len(), of_height(3.0), of_height(6.0)), (4, 100.0, 100.0), "{faces:?}");
}

#[test]
fn a_plot_has_sides() {
    let border = "border = [[0, 0], [30, 0], [30, 20], [0, 20]]";
    let plot = |more: &str| judged(&format!("[plot]\n{border}\n{more}")).plot.expect("a plot");
    let plain = plot("");
    assert_eq!((plain.border.len(), plain.mean_ground), (4, None));
    assert!(plain.sides.iter().all(|side| *side == PlotSide::default()));
    let more = "roads = [{ side = 1, width = 6 }, { side = 4, width = 12.5 }]\nneighbours = [{ side = 3, higher = -1.5 }]\nmean_ground = 0.25";
    let full = plot(more);
    let side = |road_m: f64, neighbour_higher_m: f64| PlotSide { road_m, neighbour_higher_m };
    assert_eq!(full.sides, [side(6.0, 0.0), side(0.0, 0.0), side(0.0, -1.5), side(12.5, 0.0)]);
    assert_eq!(full.mean_ground, Some(0.25));
    // written clockwise: the sides keep what they were said to have
    let turned = judged(&format!("[plot]\nborder = [[0, 20], [30, 20], [30, 0], [0, 0], [0, 20]]\n{more}"))
        .plot
        .expect("a plot");
    let of = |plot: &gnomon::site::JudgedPlot, from: DVec2, to: DVec2| {
        let at = (0..4).find(|at| plot.border[*at] == from && plot.border[(at + 1) % 4] == to);
        plot.sides[at.expect("a side")]
    };
    assert!(signed_area(&turned.border) > 0.0);
    // its first side is the northern one, from the west to the east; inside it runs from the east to the west
    assert_eq!(of(&turned, dvec2(30.0, 20.0), dvec2(0.0, 20.0)), side(6.0, 0.0));
    assert_eq!(of(&turned, dvec2(0.0, 0.0), dvec2(30.0, 0.0)), side(0.0, -1.5));
    assert_eq!(of(&turned, dvec2(0.0, 20.0), dvec2(0.0, 0.0)), side(12.5, 0.0));
    for (more, words) in [
        ("roads = [{ side = 5, width = 6 }]", &["[plot] roads", "no side 5", "1 to 4"][..]),
        ("roads = [{ side = 0, width = 6 }]", &["no side 0"]),
        ("roads = [{ side = 1, width = 0 }]", &["[plot] roads", "width of 0"]),
        ("roads = [{ side = 1, width = 6 }, { side = 1, width = 7 }]", &["side 1", "twice"]),
        ("neighbours = [{ side = 1, higher = nan }]", &["[plot] neighbours", "NaN"]),
        ("neighbours = [{ side = 2, higher = 1 }, { side = 2, higher = 1 }]", &["side 2", "twice"]),
        ("mean_ground = inf", &["[plot] mean_ground"]),
        ("file = \"plot.geojson\"", &["[plot] file", "`border`"]),
    ] {
        fails(&format!("[plot]\n{border}\n{more}"), words);
    }
    fails("[plot]\nmean_ground = 0", &["border or file in [plot]"]);
    fails("[plot]\nborder = [[0, 0], [9, 9], [9, 0], [0, 9]]", &["[plot] border", "crosses or touches itself"]);
}

#[test]
fn a_facade_has_points() {
    let site = judged("[[facade]]\nname = \"Barn\"\ncomponent = \"barn\"\nspacing = 2.0\nheights = [1.5, 4.5]");
    let [facade] = site.facades.as_slice() else { panic!("{:?}", site.facades) };
    // five points a side, two rows, four sides
    assert_eq!((facade.name.as_str(), facade.points.len(), facade.doubtful.len()), ("Barn", 40, 0));
    for [point, normal] in &facade.points {
        let from_middle = *point - glam::dvec3(35.0, 0.0, point.z);
        assert!(normal.dot(from_middle) > 4.99 && [1.5, 4.5].contains(&point.z), "{point} {normal}");
    }
    assert!(notes(&site).contains("\"Barn\" is judged at 40 points, 2 m apart"), "{}", notes(&site));
    // 10 × 6 m in rows a metre apart
    let site = judged("[[facade]]\ncomponent = \"barn\"");
    assert_eq!((site.facades[0].name.as_str(), site.facades[0].points.len()), ("façade 1", 240));
    let heights: Vec<f64> = site.facades[0].points.iter().map(|[point, _]| point.z).collect();
    assert_eq!((heights.iter().copied().fold(9.0, f64::min), heights.iter().copied().fold(0.0, f64::max)), (0.5, 5.5));
    for (more, words) in [
        ("spacing = 0", &["[[facade]] spacing", "0.05"][..]),
        ("spacing = nan", &["[[facade]] spacing"]),
        ("heights = []", &["[[facade]] heights", "no height"]),
        ("heights = [1, inf]", &["[[facade]] heights"]),
        ("heights = [100]", &["[[facade]] component", "no upright face"]),
    ] {
        fails(&format!("[[facade]]\ncomponent = \"barn\"\n{more}"), words);
    }
    fails("[[facade]]\nspacing = 1", &["component in [[facade]]"]);
    fails("[[facade]]\ncomponent = \"tower\"\nspacing = 0.05", &["[[facade]] spacing", "more than"]);
    let twice = "[[facade]]\nname = \"a\"\ncomponent = \"barn\"\n".repeat(2);
    fails(&twice, &["[[facade]] number 2 name", "\"a\""]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// Whatever the corners are, they bound an area or are refused in one line; what is taken crosses nowhere.
    #[test]
    fn any_corners_are_an_area_or_a_mistake(corners in prop::collection::vec((-4i32..5, -4i32..5), 0..8)) {
        let text: Vec<String> = corners.iter().map(|(x, y)| format!("[{x}, {y}]")).collect();
        let folder = super::folder(&area(&format!("[{}]", text.join(", "))));
        match gnomon::site::load_judged(folder.path(), &gnomon::site::Overrides::default()) {
            Err(error) => prop_assert!(!error.to_string().contains('\n')),
            Ok(site) => {
                let ring = &site.areas[0].rings[0];
                prop_assert!(signed_area(ring) > 0.0);
                let side = |at: usize| (ring[at], ring[(at + 1) % ring.len()]);
                for one in 0..ring.len() {
                    for other in 0..one {
                        let ((a, b), (c, d)) = (side(one), side(other));
                        let beside = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
                        let crosses = beside(a, b, c) * beside(a, b, d) < 0.0 && beside(c, d, a) * beside(c, d, b) < 0.0;
                        prop_assert!(!crosses, "{ring:?}");
                    }
                }
            }
        }
    }
}
