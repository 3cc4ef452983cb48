//! What is protected on a site keeps its sun when the envelope is built: windows, areas, façades and lines together.

use super::{area, corner, judged, nothing, site, window};
use glam::{DVec3, dvec3};
use gnomon::export::envelope::{EnvelopeMap, EnvelopeSolid};
use gnomon::mesh::Part;
use gnomon::rules::{Rule, SunDemand, Verdict, built_in_text, common, total_secs};
use gnomon::site::{JudgedFacade, JudgedPlot, JudgedSite, PlotSide};
use gnomon::study::envelope::{CountedHeights, DaysNeeded, EnvelopeOutcome, KeptSun, KeptThing, SunNeeded, envelope};
use gnomon::study::judge::{kept_by, plot_to_build_on};
use gnomon::study::plot_cells::{cells_within, plot_grid};
use gnomon::sun::{DayWindow, Place, Sky, delta_t_secs};
use gnomon::sunlight::Headroom;
use std::ops::ControlFlow;

const HIGHEST_M: f64 = 9.0;
const JAPAN: [(&str, &str); 3] = [("plane", "1.5"), ("near", "3h"), ("far", "2h")];

/// A plot, and around it a window, a lawn and a façade; lines around it are judged, too.
fn asked(parts: Vec<Part>) -> JudgedSite {
    let place = Place::new("", 35.0, 135.0, 0.0, Some("Asia/Tokyo")).expect("a place");
    let mut site = site(place, parts, None);
    let border = vec![corner(-5.0, -4.0), corner(5.0, -4.0), corner(5.0, 4.0), corner(-5.0, 4.0)];
    site.plot = Some(JudgedPlot { border, sides: vec![PlotSide::default(); 4], mean_ground: Some(0.0) });
    site.windows = vec![window("to the north", dvec3(1.0, 9.0, 1.0), DVec3::NEG_Y)];
    site.areas = vec![area("lawn", [-8.0, 7.0], [-4.0, 9.0])];
    let points = (0..4).map(|at| [dvec3(8.0, f64::from(at), 1.5), DVec3::NEG_X]).collect();
    site.facades = vec![JudgedFacade { name: "to the east".into(), points, doubtful: Vec::new() }];
    site
}

/// Everything that is protected on a site: six hours of the day for what it names, and what Japan asks of the lines.
fn protected(site: &JudgedSite) -> Vec<KeptThing> {
    let day = "2026-12-22".parse().expect("a date");
    let reading = |text: &str| text.parse().expect("a reading");
    let days = [DayWindow::on(&site.place, day, Some(&reading("08:00")), Some(&reading("16:00"))).expect("a window")];
    let rule = Rule::parse("jp", built_in_text("jp-bsa-56-2").expect("built in")).expect("a rule");
    let resolved = rule.resolve(&JAPAN).expect("options");
    let mut things = Vec::new();
    for demand in [SunDemand::Hours(6 * 3600, &days), SunDemand::Rule(&rule.source, &resolved)] {
        assert_eq!(plot_to_build_on(site, demand).expect("a plot").border.len(), 4);
        let kept = kept_by(site, demand, HIGHEST_M, &mut |_| ControlFlow::Continue(())).expect("kept");
        assert_eq!((kept.days.len(), kept.needed), (1, DaysNeeded::Each));
        things.extend(kept.things);
    }
    things
}

/// How much of the sun that is kept is taken, in seconds, once something stands on the plot.
fn taken(outcome: &EnvelopeOutcome, built: &[KeptThing]) -> i64 {
    let of_sun =
        |now: &SunNeeded, kept: &KeptSun| total_secs(&kept.spells) - total_secs(&common(&now.lit, &kept.spells));
    let of = |(kept, now): (&gnomon::study::envelope::KeptOf, &KeptThing)| -> i64 {
        let places = kept.places.iter().map(|(number, days)| (&now.places[*number], days));
        places.flat_map(|(now, days)| days.iter().map(move |kept| of_sun(&now.days[kept.day], kept))).sum()
    };
    outcome.kept.iter().zip(built).map(of).sum()
}

fn built(site: &JudgedSite, headroom: &Headroom, higher: f64) -> Part {
    let of = |(top, inside): (&f64, &bool)| match inside {
        true => (top.min(HIGHEST_M) - 0.001 + higher).max(0.0) as f32,
        false => f32::NAN,
    };
    let heights: Vec<f32> = headroom.top.iter().zip(&headroom.inside).map(of).collect();
    let map = EnvelopeMap {
        place: &site.place,
        ground: &site.now.ground,
        foot_m: site.now.ground.level,
        grid: &headroom.grid,
        heights: &heights,
        cap_m: HIGHEST_M as f32,
        border: &[],
        buildings: &vec![false; heights.len()],
        points: &[],
        kept: "",
        days: "",
        refraction: false,
    };
    let solid = EnvelopeSolid::of(&map).expect("a solid");
    Part { name: "built".into(), positions: solid.corners, triangles: solid.triangles, ..Part::default() }
}

#[test]
fn windows_areas_facades_and_lines_keep_their_sun() {
    let empty = asked(vec![nothing()]);
    let things = protected(&empty);
    let names: Vec<&str> = things.iter().map(|thing| thing.name.as_str()).collect();
    assert_eq!(names[..3], ["to the north", "to the east", "lawn"]);
    assert!(names.len() == 5 && names[3].starts_with("band 1") && names[4].starts_with("band 2"), "{names:?}");
    let plot = empty.plot.as_ref().expect("a plot");
    let grid = plot_grid(plot, Some(1.0)).expect("a grid");
    let room = Headroom::new(grid, cells_within(&plot.border, &grid));
    let time = "2026-12-22T00:00:00Z".parse().expect("a time");
    let sky = Sky { place: &empty.place, delta_t_secs: delta_t_secs(time).expect("ΔT"), air: None };
    let heights = CountedHeights { ground: 0.0, most: HIGHEST_M };
    let demand = (things.as_slice(), DaysNeeded::Each);
    let outcome = envelope(&sky, (room, heights), demand, &mut |_| ControlFlow::Continue(())).expect("an envelope");
    let low = outcome.headroom.top.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(low > 1.0 && low < HIGHEST_M, "{low}");
    assert!(outcome.kept.iter().filter(|kept| kept.lowest() < HIGHEST_M).count() > 1, "several of them bound it");
    let takes = |higher: f64| taken(&outcome, &protected(&asked(vec![built(&empty, &outcome.headroom, higher)])));
    // nothing is taken, and with half a metre more something is; that a metre less and half a metre more take nothing
    // shows that the second can fail
    assert_eq!([takes(0.0), takes(-1.0 + 0.5)], [0, 0]);
    assert!(takes(0.5) > 0);
    // of the lines, more places are judged than are kept
    let verdict =
        |higher: f64| judged(&asked(vec![built(&empty, &outcome.headroom, higher)]), "jp-bsa-56-2", &JAPAN).verdict;
    assert_eq!(verdict(0.0), Verdict::Pass);
}
