//! The plane around a plot.

use super::{corner, judged, site};
use crate::shared::dense::cuboid;
use glam::dvec3;
use gnomon::rules::Verdict;
use gnomon::site::{JudgedPlot, JudgedSite, PlotSide};
use gnomon::sun::Place;

const JAPAN: &str = "jp-bsa-56-2";

/// A box of 20 by 10 m, 6 m above the plane at 1.5 m, on a plot that is 2 m wider all round.
fn boxed() -> JudgedSite {
    let place = Place::new("", 35.0, 135.0, 0.0, Some("Asia/Tokyo")).expect("a place");
    let mut asked = site(place, vec![cuboid("box", dvec3(-10.0, -5.0, 0.0), dvec3(10.0, 5.0, 7.5))], None);
    let border = vec![corner(-12.0, -7.0), corner(12.0, -7.0), corner(12.0, 7.0), corner(-12.0, 7.0)];
    asked.plot = Some(JudgedPlot { border, sides: vec![PlotSide::default(); 4], mean_ground: Some(0.0) });
    asked
}

fn options(far: &'static str) -> [(&'static str, &'static str); 4] {
    [("plane", "1.5"), ("near", "5h"), ("far", far), ("corners", "mitred")]
}

/// From 8 to 16 on a sundial are 28,810 s on this day, as noon comes later from day to day, and some of the 5 m line has no
/// sun in them. Probes each 0.25 m on the mitred 10 m line have at most 5,570 s of shadow, all of it where y is 17 and x from
/// ±6.25 to ±18.75; at ±6 it is 1.514 h and at ±19 1.518 h.
#[test]
fn the_worst_of_each_line_is_found() {
    let found = judged(&boxed(), JAPAN, &options("1h30"));
    let [near, far] = found.receivers.as_slice() else { panic!("two bands") };
    let hours = |of| super::value_secs(of) as f64 / 3600.0;
    assert!((hours(near) - 8.0028).abs() < 0.003, "{}", hours(near));
    assert!((hours(far) - 1.5472).abs() < 0.003, "{}", hours(far));
    let at = far.points[0];
    assert!((6.2..18.8).contains(&at.x.abs()) && (at.y - 17.0).abs() < 0.1 && at.z == 1.5, "{at}");
    assert_eq!([near.ruling.verdict, far.ruling.verdict], [Verdict::Fail, Verdict::Fail]);
    let kept = judged(&boxed(), JAPAN, &options("2h"));
    assert_eq!([kept.receivers[1].ruling.verdict, kept.verdict], [Verdict::Pass, Verdict::Fail]);
    assert!(found.receivers.iter().all(|band| band.takers[0].component == 0));
}

/// Such rules are of the building alone: a shed beside the plot changes nothing, and a note says that it does not count.
#[test]
fn what_stands_beside_the_plot_does_not_count() {
    let mut beside = boxed();
    let parts = vec![
        cuboid("box", dvec3(-10.0, -5.0, 0.0), dvec3(10.0, 5.0, 7.5)),
        cuboid("shed", dvec3(-4.0, 16.0, 0.0), dvec3(4.0, 20.0, 9.0)),
    ];
    let plot = beside.plot.take();
    beside = JudgedSite { plot, ..site(beside.place.clone(), parts, None) };
    let [alone, with_shed] = [boxed(), beside].map(|asked| judged(&asked, JAPAN, &options("2h")));
    for (one, other) in alone.receivers.iter().zip(&with_shed.receivers) {
        assert_eq!(super::value_secs(one), super::value_secs(other), "{}", one.name);
    }
    let said: Vec<String> = with_shed.notes.iter().map(|note| note.in_words(&gnomon::message::PlainWords)).collect();
    assert!(said.iter().any(|note| note.contains("1 component beside it is left out (\"shed\")")), "{said:?}");
    assert!(alone.notes.is_empty(), "{:?}", alone.notes);
}

/// A building across the plot whose corners all lie beside it stands there, and with nothing there nothing is judged.
#[test]
fn what_crosses_the_plot_stands_on_it() {
    let on = |part| {
        let mut asked = boxed();
        let plot = asked.plot.take();
        JudgedSite { plot, ..site(asked.place.clone(), vec![part], None) }
    };
    let across = on(cuboid("across", dvec3(-300.0, -5.0, 0.0), dvec3(300.0, 5.0, 7.5)));
    let found = judged(&across, JAPAN, &options("2h"));
    assert_eq!(found.verdict, Verdict::Fail);
    assert!(found.notes.is_empty(), "{:?}", found.notes);
    // a part of a plot is within one large triangle
    let around =
        judged(&on(cuboid("slab", dvec3(-300.0, -300.0, 5.0), dvec3(300.0, 300.0, 7.5))), JAPAN, &options("2h"));
    assert_eq!(around.verdict, Verdict::Fail);
    let beside = on(cuboid("beside", dvec3(100.0, -5.0, 0.0), dvec3(120.0, 5.0, 7.5)));
    let error = super::tried(&beside, JAPAN, &options("2h")).expect_err("nothing stands on the plot").to_string();
    assert!(error.contains("a building on the plot"), "{error}");
}

/// A road in the north moves the border, and a higher neighbour raises the plane.
#[test]
fn roads_and_levels_ease_it() {
    let worst = |sides: &[usize], side: PlotSide| {
        let mut asked = boxed();
        sides.iter().for_each(|at| asked.plot.as_mut().expect("a plot").sides[*at] = side);
        let found = judged(&asked, JAPAN, &options("2h"));
        (super::value_secs(&found.receivers[1]), found.receivers[1].points[0])
    };
    let near = |found: i64, probed: i64| assert!((found - probed).abs() <= 10, "{found} {probed}");
    let (plain, _) = worst(&[], PlotSide::default());
    // by probes each 0.25 m on the 10 m line, here and below
    let (beyond_road, at) = worst(&[2], PlotSide { road_m: 6.0, neighbour_higher_m: 0.0 });
    near(beyond_road, 3943);
    assert!((at.x.abs() - 22.0).abs() < 0.1, "{at}");
    let higher = PlotSide { road_m: 0.0, neighbour_higher_m: 3.0 };
    let (raised, at) = worst(&[0, 1, 2, 3], higher);
    near(raised, 3154);
    assert!((at.z - 2.5).abs() < 1e-9, "{at}");
    // beside a corner the lesser raise holds, so the north alone eases nothing there
    let (of_north, at) = worst(&[2], higher);
    near(of_north, plain);
    assert!(at.z == 1.5 && at.x.abs() >= 12.0 - 1e-6, "{at}");
}
