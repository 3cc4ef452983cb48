//! How high may be built: against the rays one by one, and with the envelope put back as a building.

mod hours;
mod together;

use crate::shared::program::{PLACE, done, fails, names, site};
use glam::{DVec2, DVec3, dvec2, dvec3};
use gnomon::export::envelope::{EnvelopeMap, EnvelopeSolid};
use gnomon::export::figure;
use gnomon::mesh::{Mesh, Part};
use gnomon::rules::{Spell, total_secs};
use gnomon::shadow::ray_cast::RayCaster;
use gnomon::site::Ground;
use gnomon::study::envelope::{CountedHeights, DaysNeeded, EnvelopeOutcome, KeptPlace, KeptThing, SunNeeded, envelope};
use gnomon::sun::{Place, Sky, delta_t_secs};
use gnomon::sunlight::{Headroom, KeptSeconds, RaySource, roomiest};
use gnomon::view::Grid;
use serde_json::Value;
use std::ops::ControlFlow;

fn london() -> Place {
    Place::new("", 51.5, -0.13, 0.0, Some("Europe/London")).unwrap()
}

fn secs(utc: &str) -> i64 {
    utc.parse::<chrono::DateTime<chrono::Utc>>().unwrap().timestamp()
}

fn sky(place: &Place) -> Sky<'_> {
    Sky { place, delta_t_secs: delta_t_secs("2026-03-21T12:00:00Z".parse().unwrap()).unwrap(), air: None }
}

fn to_sun(sky: &Sky<'_>, secs: i64) -> DVec3 {
    use chrono::TimeZone;
    let utc = chrono::DateTime::from_timestamp(secs, 0).unwrap().naive_utc();
    sky.at(sky.place.time_zone.from_utc_datetime(&utc)).unwrap().to_sun
}

/// A plot of 20 m by 20 m around the place, without its north-eastern quarter.
fn plot() -> Headroom {
    let grid = Grid { west: -12.0, north: 12.0, cell: 1.0, width: 24, height: 24 };
    let is_plot = |index: usize| {
        let at = grid.centre(index as u32 % 24, index as u32 / 24);
        at.abs().max_element() < 10.0 && !(at.x > 0.0 && at.y > 0.0)
    };
    Headroom::new(grid, (0..grid.cells()).map(is_plot).collect())
}

fn border() -> Vec<DVec2> {
    vec![
        dvec2(-10.0, -10.0),
        dvec2(10.0, -10.0),
        dvec2(10.0, 0.0),
        dvec2(0.0, 0.0),
        dvec2(0.0, 10.0),
        dvec2(-10.0, 10.0),
    ]
}

/// Up to 60 m above the ground.
const HEIGHTS: CountedHeights = CountedHeights { ground: 0.0, most: 60.0 };

/// From here the sun stands over the plot from about 11:05 to 15:00 UTC, and for some six hours of the day's ten it does not.
const WINDOW: DVec3 = dvec3(3.0, 20.0, 2.0);

/// A window north of the plot that must keep so much of a day's sun between 7:00 and 17:00 UTC.
fn place(points: Vec<DVec3>, needed_secs: i64, at_once: bool) -> KeptPlace {
    let lit = vec![Spell::new(secs("2026-03-21T07:00:00Z"), secs("2026-03-21T17:00:00Z"))];
    KeptPlace { weight: 1.0, points, around_m: 0.0, days: vec![SunNeeded { lit, secs: needed_secs, at_once }] }
}

fn thing(places: Vec<KeptPlace>, needed: f64) -> KeptThing {
    KeptThing { name: "window".to_owned(), places, needed }
}

fn found(things: &[KeptThing], days: DaysNeeded) -> EnvelopeOutcome {
    let place = london();
    envelope(&sky(&place), (plot(), HEIGHTS), (things, days), &mut |_| ControlFlow::Continue(())).unwrap()
}

/// The rays that an outcome keeps: from where, and in which direction.
fn rays(things: &[KeptThing], outcome: &EnvelopeOutcome) -> Vec<(DVec3, DVec3)> {
    let place = london();
    let sky = sky(&place);
    let mut rays = Vec::new();
    for (thing, kept) in things.iter().zip(&outcome.kept) {
        for (number, of_days) in &kept.places {
            for secs in of_days.iter().flat_map(|kept| &kept.spells).flat_map(|spell| spell.start..spell.end) {
                let to_sun = to_sun(&sky, secs);
                rays.extend(thing.places[*number].points.iter().map(|point| (*point, to_sun)));
            }
        }
    }
    rays
}

/// The height at which a ray comes over a cell, a millimetre wider on each side.
fn over(grid: &Grid, cell: usize, (from, along): (DVec3, DVec3)) -> Option<f64> {
    let centre = grid.centre(cell as u32 % grid.width, cell as u32 / grid.width);
    let half = grid.cell / 2.0 + 0.001;
    let (mut first, mut last) = (0.0f64, f64::INFINITY);
    for axis in 0..2 {
        let ends = [-half, half].map(|side| (centre[axis] + side - from[axis]) / along[axis]);
        (first, last) = (first.max(ends[0].min(ends[1])), last.min(ends[0].max(ends[1])));
    }
    (first <= last).then_some(from.z + along.z * first)
}

#[test]
fn each_cell_is_as_high_as_its_lowest_ray() {
    let things = [thing(vec![place(vec![WINDOW], 8 * 3600, false)], 1.0)];
    let outcome = found(&things, DaysNeeded::Each);
    let rays = rays(&things, &outcome);
    assert_eq!(rays.len(), 8 * 3600);
    let plot = plot();
    let mut bounded = 0;
    for (cell, top) in outcome.headroom.top.iter().enumerate() {
        let lowest = rays.iter().filter_map(|ray| over(&plot.grid, cell, *ray)).fold(f64::INFINITY, f64::min);
        let expected = if plot.inside[cell] { lowest } else { f64::INFINITY };
        assert!(*top == expected || (top - expected).abs() < 1e-9, "{cell}: {top} is not {expected}");
        bounded += usize::from(top.is_finite());
    }
    assert!(bounded > 20, "{bounded} cells under rays");
    let least = outcome.headroom.top.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((outcome.kept[0].lowest() - least).abs() < 1e-9);
}

/// A place that stands for a part of an area keeps the sun of all of that part, in the same seconds.
#[test]
fn a_place_keeps_the_sun_around_it() {
    const AROUND_M: f64 = 0.8;
    let one = KeptPlace { around_m: AROUND_M, ..place(vec![WINDOW], 8 * 3600, false) };
    let taken = |things: &[KeptThing]| {
        let outcome = found(things, DaysNeeded::Each);
        let building = building(&outcome.headroom, |_| 0.0);
        let around =
            (0..12).map(|way| DVec2::from_angle(f64::from(way) * std::f64::consts::FRAC_PI_6).extend(0.0) * AROUND_M);
        let all: Vec<DVec3> = around.collect();
        let rays = rays(things, &outcome);
        let begins =
            |(from, to_sun): &(DVec3, DVec3)| all.iter().map(|away| (from + away, *to_sun)).collect::<Vec<_>>();
        rays.iter()
            .step_by(10)
            .flat_map(begins)
            .filter(|(from, to_sun)| building.first_hit(*from, *to_sun).is_some())
            .count()
    };
    assert_eq!(taken(&[thing(vec![one.clone()], 1.0)]), 0);
    // as a point it does not
    assert!(taken(&[thing(vec![KeptPlace { around_m: 0.0, ..one }], 1.0)]) > 0);
}

/// A comparison with rays that could not fail would prove nothing: where the heights are too low, half a metre more takes
/// nothing.
#[test]
fn an_envelope_that_is_too_low_is_seen() {
    let things = [thing(vec![place(vec![WINDOW], 8 * 3600, false)], 1.0)];
    let outcome = found(&things, DaysNeeded::Each);
    let rays = rays(&things, &outcome);
    let takes = |higher: f64| {
        let building = building(&outcome.headroom, |_| higher);
        rays.iter().any(|(from, to_sun)| building.first_hit(*from, *to_sun).is_some())
    };
    assert_eq!([-1.0, 0.0, 0.5].map(takes), [false, false, true]);
    assert!(!takes(-1.0 + 0.5), "a metre too low, half a metre more still takes nothing");
}

/// Heights above the ground, as a building: all of them, or one cell of them higher.
fn building(headroom: &Headroom, higher: impl Fn(usize) -> f64) -> RayCaster {
    let heights: Vec<f32> = (0..headroom.top.len())
        .map(|cell| match headroom.inside[cell] {
            true => (headroom.top[cell].min(60.0) - 0.001 + higher(cell)) as f32,
            false => f32::NAN,
        })
        .collect();
    let (place, ground) = (london(), Ground::asked(0.0));
    let solid = EnvelopeSolid::of(&map(&place, &ground, headroom, &heights, &[false; 576])).unwrap();
    let part =
        Part { name: "envelope".into(), positions: solid.corners, triangles: solid.triangles, ..Part::default() };
    RayCaster::new(&Mesh::build_around(vec![part], DVec3::ZERO).unwrap(), 100.0)
}

fn map<'a>(
    place: &'a Place,
    ground: &'a Ground,
    headroom: &'a Headroom,
    heights: &'a [f32],
    buildings: &'a [bool],
) -> EnvelopeMap<'a> {
    EnvelopeMap {
        place,
        ground,
        foot_m: 0.0,
        grid: &headroom.grid,
        heights,
        cap_m: 60.0,
        border: &[],
        buildings,
        points: &[WINDOW],
        kept: "8 h of sun",
        days: "21 March 2026",
        refraction: false,
    }
}

/// Put back as a building the envelope takes no second of the sun that is kept, and half a metre more on any cell takes some.
#[test]
fn the_envelope_as_a_building_takes_nothing() {
    let second = dvec3(-7.0, 14.0, 1.0);
    let things = [
        thing(vec![place(vec![WINDOW], 8 * 3600, false)], 1.0),
        thing(vec![place(vec![second, second + DVec3::X], 5 * 3600, true)], 1.0),
    ];
    let outcome = found(&things, DaysNeeded::Each);
    let rays = rays(&things, &outcome);
    let blocked = |building: &RayCaster| {
        rays.iter().filter(|(from, to_sun)| building.first_hit(*from, *to_sun).is_some()).count()
    };
    assert_eq!(blocked(&building(&outcome.headroom, |_| 0.0)), 0);
    let bounded: Vec<usize> = (0..576).filter(|cell| outcome.headroom.top[*cell] < 60.0).collect();
    assert!(bounded.len() > 40, "{}", bounded.len());
    assert!(blocked(&building(&outcome.headroom, |_| 0.5)) > 0);
    // and so does nearly each cell alone: some are met by nothing but the millimetre by which cells are wider
    let raised: Vec<usize> = bounded.iter().copied().step_by(7).collect();
    let takes = |cell: &&usize| {
        let building = building(&outcome.headroom, |other| if other == **cell { 0.5 } else { 0.0 });
        blocked(&building) > 0
    };
    let taking = raised.iter().filter(takes).count();
    assert!(taking * 10 >= raised.len() * 9, "{taking} of {} cells", raised.len());
}

/// No other hours leave more below their lowest ray: not those that are chosen at once, nor any others.
#[test]
fn the_hours_that_leave_the_most_room_are_kept() {
    let (place_on_earth, plot) = (london(), plot());
    let sky = sky(&place_on_earth);
    let start = secs("2026-03-21T07:00:00Z");
    let heights: Vec<f64> =
        (start..start + 10 * 3600).map(|secs| plot.lowest(RaySource::point(WINDOW), to_sun(&sky, secs))).collect();
    let [at_once, any] = [true, false].map(|at_once| {
        let things = [thing(vec![place(vec![WINDOW], 8 * 3600, at_once)], 1.0)];
        found(&things, DaysNeeded::Each).kept[0].places[0].1[0].clone()
    });
    assert_eq!(at_once.spells.len(), 1);
    assert_eq!((total_secs(&at_once.spells), total_secs(&any.spells)), (8 * 3600, 8 * 3600));
    assert!(any.lowest >= at_once.lowest && at_once.lowest.is_finite());
    for begin in (0..=2 * 3600).step_by(300) {
        let other = heights[begin..begin + 8 * 3600].iter().copied().fold(f64::INFINITY, f64::min);
        assert!(other <= at_once.lowest + 1e-9, "{other} from {begin} s on, and not {}", at_once.lowest);
    }
    let mut sorted = heights;
    sorted.sort_by(|one, other| other.total_cmp(one));
    assert!((sorted[8 * 3600 - 1] - any.lowest).abs() < 1e-9, "{} is not {}", any.lowest, sorted[8 * 3600 - 1]);
}

/// Of several places those that leave the most, of several days the best, and all that there is where it is too little.
#[test]
fn places_and_days_are_chosen() {
    let far = dvec3(0.0, 60.0, 2.0);
    let near = dvec3(0.0, 11.0, 0.5);
    const MOST: i64 = 34_200;
    let half = [thing(vec![place(vec![near], MOST, false), place(vec![far], MOST, false)], 1.0)];
    let kept = &found(&half, DaysNeeded::Each).kept[0];
    assert_eq!(kept.places.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [1], "the far one leaves more");
    let both = [thing(half[0].places.clone(), 2.0)];
    assert_eq!(found(&both, DaysNeeded::Each).kept[0].places.len(), 2);
    // of two days the one whose sun does not stand over the plot
    let mut twice = place(vec![WINDOW], 3600, false);
    let at_noon = vec![Spell::new(secs("2026-03-21T11:30:00Z"), secs("2026-03-21T12:45:00Z"))];
    let early = vec![Spell::new(secs("2026-03-21T10:00:00Z"), secs("2026-03-21T11:15:00Z"))];
    twice.days = [early, at_noon].map(|lit| SunNeeded { lit, secs: 3600, at_once: false }).to_vec();
    let one = found(&[thing(vec![twice.clone()], 1.0)], DaysNeeded::One);
    let each = found(&[thing(vec![twice], 1.0)], DaysNeeded::Each);
    assert_eq!((one.kept[0].places[0].1.len(), each.kept[0].places[0].1.len()), (1, 2));
    let best = each.kept[0].places[0].1.iter().map(|kept| kept.lowest).fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(one.kept[0].lowest(), best);
    // twelve hours of ten
    let lacking = found(&[thing(vec![place(vec![WINDOW], 12 * 3600, false)], 1.0)], DaysNeeded::Each);
    assert!(lacking.kept[0].lacks());
    assert_eq!(total_secs(&lacking.kept[0].places[0].1[0].spells), 10 * 3600);
    let nothing = roomiest(&[(0, 1.0)], 0, false);
    assert_eq!(nothing, Some(KeptSeconds { spells: Vec::new(), lowest: f64::INFINITY }));
}

#[test]
fn more_rays_than_can_be_asked_are_refused() {
    let things = [thing(vec![place(vec![WINDOW; 60_000], 3600, false)], 1.0)];
    let place = london();
    let asked = (things.as_slice(), DaysNeeded::Each);
    let error = envelope(&sky(&place), (plot(), HEIGHTS), asked, &mut |_| ControlFlow::Continue(()));
    let said = error.unwrap_err().to_string();
    assert!(said.contains("2160000000") && said.contains("fewer days"), "{said}");
}

#[test]
fn drawing_and_solid_say_the_heights() {
    let things = [thing(vec![place(vec![WINDOW], 8 * 3600, false)], 1.0)];
    let outcome = found(&things, DaysNeeded::Each);
    let heights: Vec<f32> = (0..576)
        .map(|cell| if outcome.headroom.inside[cell] { outcome.headroom.top[cell].min(60.0) as f32 } else { f32::NAN })
        .collect();
    let (place, ground, border) = (london(), Ground::asked(0.0), border());
    let mut buildings = vec![false; 576];
    buildings[25..29].fill(true);
    let map = EnvelopeMap { border: &border, ..map(&place, &ground, &outcome.headroom, &heights, &buildings) };
    let drawing = figure::heights(&map).unwrap();
    let svg = drawing.svg();
    for word in ["How high may be built", "8 h of sun", "21 March 2026", "buildings", " m</text>", "the plot"] {
        assert!(svg.contains(word), "no {word}");
    }
    assert!(drawing.png().unwrap().len() > 10_000);
    // the solid's volume is that of the cells, by the divergence theorem
    let solid = EnvelopeSolid::of(&map).unwrap();
    let volume: f64 = solid
        .triangles
        .iter()
        .map(|three| {
            let [a, b, c] = three.map(|corner| solid.corners[corner as usize]);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!((volume - map.volume_m3()).abs() < 1e-3 * volume, "{volume} is not {}", map.volume_m3());
    let obj = solid.obj(&map);
    assert_eq!(obj.lines().filter(|line| line.starts_with("f ")).count(), solid.triangles.len());
    let glb = solid.glb(&map).unwrap();
    assert_eq!(&glb[..4], b"glTF");
    // nothing to build is no solid, and too much is none either
    let none = vec![0.0; 576];
    let error = EnvelopeSolid::of(&EnvelopeMap { heights: &none, ..map }).unwrap_err().to_string();
    assert!(error.contains("nothing may stand"), "{error}");
}

/// A plot with a tower on it, which did not stand before, and a window north of it.
const SITE: &str = "
[[model]]
path = \"tower.glb\"

[before]
absent = [\"tower\"]

[plot]
border = [[-8, -8], [8, -8], [8, 8], [-8, 8]]

[[window]]
name = \"north\"
corners = [[-1, 30, 1.5], [1, 30, 1.5], [1, 30, 3], [-1, 30, 3]]
room = \"kitchen\"
dwelling = \"1\"

[study]
date = 2026-03-21
";

/// The command writes what it found, and what it found keeps the window's sun: the tower itself may be no higher than that.
#[test]
fn the_command_writes_heights_that_keep_the_sun() {
    let folder = site();
    let path = folder.path();
    std::fs::write(path.join("site.toml"), format!("{PLACE}{SITE}")).unwrap();
    // so much that the sun over the plot cannot be left out
    let asked = "envelope . --rule pl-wt-60 --set clock=legal --set hours=9h --cell 1 --highest 50";
    let json: Value = serde_json::from_str(&done(path, &format!("{asked} --json --quiet"))).unwrap();
    assert_eq!(
        names(path.join("out")),
        ["envelope.glb", "envelope.json", "envelope.obj", "envelope.png", "envelope.svg", "envelope.tif"]
    );
    assert_eq!((&json["rule"]["id"], &json["options"]["clock"]), (&"pl-wt-60".into(), &"legal".into()));
    assert_eq!(
        (&json["cell"], &json["highest_m"], &json["kept"][0]["name"]),
        (&1.0.into(), &50.0.into(), &"north".into())
    );
    let days = json["kept"][0]["places"][0]["days"].as_array().unwrap();
    assert_eq!(days.len(), 2, "two equinoxes");
    assert!(days.iter().all(|day| day["seconds"].as_i64() == Some(9 * 3600)), "{days:?}");
    // heights in a GeoTIFF: the plot alone has any
    let tif = std::fs::read(path.join("out/envelope.tif")).unwrap();
    let mut tif = tiff::decoder::Decoder::new(std::io::Cursor::new(tif)).unwrap();
    let tiff::decoder::DecodingResult::F32(heights) = tif.read_image().unwrap() else { panic!("no floats") };
    let inside = heights.iter().filter(|height| !height.is_nan()).count();
    assert_eq!(inside, 16 * 16);
    let [least, greatest] = ["least_m", "greatest_m"].map(|key| json[key].as_f64().unwrap());
    assert!(0.0 < least && least < greatest && greatest <= 50.0, "{least} {greatest}");
    // the envelope as the site's model keeps what the rule asks, to the second
    let glb = format!("{PLACE}{}", SITE.replace("tower.glb", "out/envelope.glb").replace("\"tower\"", "\"envelope\""));
    std::fs::write(path.join("kept.toml"), glb).unwrap();
    let judged: Value = serde_json::from_str(&done(
        path,
        "judge kept.toml --rule pl-wt-60 --set clock=legal --set hours=9h --json --quiet",
    ))
    .unwrap();
    assert_eq!(judged["verdict"], "pass");
    assert!(judged["receivers"][0]["margin_secs"].as_i64().is_some_and(|margin| margin >= 0), "{judged}");
    // the tower is higher than it may be, and says so
    let said = done(path, &format!("{asked} --out again --quiet"));
    for word in ["envelope.tif", "north", "lowest ray", "check with your authority", "chosen: clock = legal"] {
        assert!(said.to_lowercase().contains(word), "{word}: {said}");
    }
}

/// On a level terrain 12 m up, whose models reach far below it, heights are those on a plane at 12 m.
#[test]
fn on_terrain_heights_are_above_its_lowest_point_on_the_plot() {
    let folder = site();
    let path = folder.path();
    let tables = SITE.replace("1.5]", "13.5]").replace("3]]", "15]]").replace(" 3],", " 15],");
    let field = "o field\nv -200 -200 12\nv 200 -200 12\nv 200 200 12\nv -200 200 12\nf 1 2 3 4\n";
    let pit = "o pit\nv 90 90 -30\nv 91 90 -30\nv 90 91 -30\nf 1 2 3\n";
    std::fs::write(path.join("field.obj"), field).unwrap();
    std::fs::write(path.join("pit.obj"), pit).unwrap();
    let obj = |name: &str, more: &str| format!("[[model]]\npath = \"{name}.obj\"\nup = \"z\"\n{more}\n");
    let models = obj("pit", "") + &obj("field", "terrain = true");
    std::fs::write(path.join("terrain.toml"), format!("{PLACE}{models}{tables}")).unwrap();
    std::fs::write(path.join("plane.toml"), format!("{PLACE}{}[ground]\nlevel = 12\n{tables}", obj("pit", "")))
        .unwrap();
    let asked = |name: &str| {
        let asked =
            format!("envelope {name}.toml --rule pl-wt-60 --set clock=legal --set hours=9h --cell 1 --highest 50");
        let json = done(path, &format!("{asked} --json --out {name} --quiet"));
        (serde_json::from_str::<Value>(&json).unwrap(), std::fs::read(path.join(name).join("envelope.obj")).unwrap())
    };
    let ((terrain, solid), (plane, solid_on_plane)) = (asked("terrain"), asked("plane"));
    assert_eq!([&terrain["ground_from"], &plane["ground_from"]], ["terrain", "site"]);
    assert_eq!([&terrain["heights_above"], &plane["heights_above"]], ["the lowest terrain on the plot", "the ground"]);
    for key in ["foot_m", "least_m", "greatest_m", "volume_m3"] {
        let [one, other] = [&terrain, &plane].map(|json| json[key].as_f64().unwrap());
        assert!((one - other).abs() < 2e-3 * other, "{key}: {one} {other}");
    }
    assert_eq!(solid.iter().filter(|b| **b == b'\n').count(), solid_on_plane.iter().filter(|b| **b == b'\n').count());
    let notes = terrain["notes"].to_string();
    assert!(notes.contains("lowest point of the terrain on the plot, which is at 12.00 m"), "{notes}");
}

#[test]
fn what_an_envelope_needs_is_told() {
    let folder = site();
    let path = folder.path();
    let asked = "envelope . --rule pl-wt-60 --set clock=legal --quiet";
    let without_plot = SITE.replace("[plot]\nborder = [[-8, -8], [8, -8], [8, 8], [-8, 8]]\n", "");
    std::fs::write(path.join("site.toml"), format!("{PLACE}{without_plot}")).unwrap();
    fails(path, asked, 2, &["pl-wt-60", "plot"]);
    std::fs::write(path.join("site.toml"), format!("{PLACE}{SITE}")).unwrap();
    fails(path, "envelope . --rule us-sf-295 --quiet", 2, &["us-sf-295"]);
    fails(path, "envelope . --rule us-nyc-ceqr-shadows --quiet", 2, &["us-nyc-ceqr-shadows"]);
    fails(path, &format!("{asked} --cell 0"), 2, &["--cell"]);
    fails(path, &format!("{asked} --highest 0"), 2, &["--highest"]);
    fails(path, &format!("{asked} --cell 0.011"), 2, &["--cell", "larger"]);
    fails(path, "envelope . --rule nothing --quiet", 2, &["nothing", "gnomon rules"]);
}
