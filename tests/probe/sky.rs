//! `gnomon probe --sky`: where directions lie in the charts, what stands before a point, and the sun's lines, by closed
//! forms and published positions.

use super::{at, date, day, found, paris, place, probing};
use crate::shared::program::{done, fails, names, pixels, site};
use crate::shared::scenes::sheet;
use chrono::{Datelike, NaiveDate};
use glam::{DVec2, DVec3, dvec3};
use gnomon::deliver::probe::sky_card;
use gnomon::export::figure::{SkyContext, sky_colours, sky_pictures, sky_sheet};
use gnomon::mesh::Part;
use gnomon::site::ProbeSite;
use gnomon::study::sky::{MOST_WAYS, SkySearch};
use gnomon::sun::{Air, Place};
use gnomon::sunlight::{HourLine, SkyCell, SkyLines, SkyRaster};
use gnomon::view::{SkyPicture, SkyProjection};
use std::f64::consts::PI;

/// Degrees clockwise from north, and above the horizon.
fn direction(azimuth_deg: f64, altitude_deg: f64) -> DVec3 {
    let (azimuth, altitude) = (azimuth_deg.to_radians(), altitude_deg.to_radians());
    dvec3(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}

fn azimuth_and_altitude(to: DVec3) -> [f64; 2] {
    [to.x.atan2(to.y).to_degrees().rem_euclid(360.0), to.z.asin().to_degrees()]
}

#[test]
fn directions_lie_where_the_projections_have_them() {
    let (disc, strip) = (SkyPicture::stereographic(600), SkyPicture::cylindrical(720, PI));
    assert_eq!((strip.width, strip.height), (720, 180));
    for altitude in [0.0, 10.0, 30.0, 45.0, 77.5, 89.0] {
        for azimuth in [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 359.0] {
            let to = direction(azimuth, altitude);
            let radius = 300.0 * (45.0 - altitude / 2.0f64).to_radians().tan();
            let (sin, cos) = azimuth.to_radians().sin_cos();
            // east at the right and north up, as a plan
            let expected = DVec2::new(300.0 + sin * radius, 300.0 - cos * radius);
            assert!((disc.place(to) - expected).length() < 1e-9, "{azimuth}, {altitude}: {}", disc.place(to));
            // two pixels a degree, south in the middle
            let expected = DVec2::new(azimuth * 2.0, 180.0 - altitude * 2.0);
            assert!((strip.place(to) - expected).length() < 1e-9, "{azimuth}, {altitude}: {}", strip.place(to));
            for picture in [&disc, &strip] {
                let back = picture.direction(picture.place(to)).unwrap();
                assert!((back - to).length() < 1e-9, "{azimuth}, {altitude}: {back} is not {to}");
            }
        }
    }
    assert_eq!(disc.place(DVec3::Z), DVec2::splat(300.0));
    // what stands at the horizon reaches a little over the rim, and there is no more beyond that
    assert_eq!(disc.direction(DVec2::new(300.0, -3.0)), Some(DVec3::Y));
    assert_eq!(disc.direction(DVec2::new(10.0, 10.0)), None);
}

/// A wall from the north-north-west to the north-north-east, as high as it is far.
fn north_wall(top: f64) -> Part {
    let corner = |x: f64, z: f64| dvec3(x, 10.0, z);
    Part { name: "wall".into(), ..sheet([corner(-5.0, 0.0), corner(5.0, 0.0), corner(5.0, top), corner(-5.0, top)]) }
}

fn skies(asked: &ProbeSite) -> [SkyRaster; 2] {
    let sunlight = found(asked);
    SkySearch::new(asked, &sunlight).rasters(0, [SkyPicture::stereographic(300), SkyPicture::cylindrical(720, PI)])
}

/// Expects that all cells see the wall where the closed form says so, and nothing else.
fn sees_the_wall(skies: &[SkyRaster; 2], top: f64) {
    for sky in skies {
        let mut seen = 0;
        for (index, cell) in sky.cells.iter().enumerate() {
            let (column, row) = (index as u32 % sky.picture.width, index as u32 / sky.picture.width);
            let centre = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let is_wall = sky.picture.direction(centre).is_some_and(|to| {
                // where the ray meets the wall's plane, 10 m to the north
                let meets = to * (10.0 / to.y);
                to.y > 0.0 && meets.x.abs() < 5.0 && meets.z < top
            });
            let expected = if is_wall { SkyCell::Component(0) } else { SkyCell::Free };
            assert_eq!(*cell, expected, "{:?} at {centre}", sky.picture.projection);
            seen += usize::from(is_wall);
        }
        assert!(seen > 500, "{seen} cells of the wall");
    }
}

#[test]
fn a_wall_covers_the_cells_of_its_azimuths_and_altitudes() {
    let day = day(&paris(), "2026-03-21", None);
    let asked = probing(&paris(), vec![north_wall(10.0)], vec![at(DVec3::ZERO, None)], vec![day]);
    let skies = skies(&asked);
    sees_the_wall(&skies, 10.0);
    // its upper edge is at 45° in the north, half a radius from the horizon: tan(22.5°) of the radius from the middle
    let [disc, _] = &skies;
    let column = |row: usize| disc.cells[row * 300 + 150];
    let edge = (0..150).rfind(|row| column(*row) != SkyCell::Free).unwrap();
    assert!((150.0 - edge as f64 - 1.0 - 150.0 * 22.5f64.to_radians().tan()).abs() < 1.0, "{edge}");
}

/// The comparison can fail.
#[test]
#[should_panic(expected = "Stereographic")]
fn a_wall_of_another_height_is_seen_in_the_sky() {
    let day = day(&paris(), "2026-03-21", None);
    let asked = probing(&paris(), vec![north_wall(10.5)], vec![at(DVec3::ZERO, None)], vec![day]);
    sees_the_wall(&skies(&asked), 10.0);
}

#[test]
fn the_points_plane_and_the_ground_hide_the_sky() {
    let day = day(&paris(), "2026-03-21", None);
    let with = |probe| probing(&paris(), vec![north_wall(10.0)], vec![probe], vec![day.clone()]);
    let tilted = dvec3(0.0, -2.0, 1.0).normalize();
    for normal in [DVec3::NEG_Y, tilted] {
        for sky in skies(&with(at(DVec3::ZERO, Some(normal)))) {
            let (width, mut free) = (sky.picture.width, 0);
            for (index, cell) in sky.cells.iter().enumerate() {
                let centre = DVec2::new((index as u32 % width) as f64 + 0.5, (index as u32 / width) as f64 + 0.5);
                let Some(to) = sky.picture.direction(centre) else { continue };
                let expected = if to.dot(normal) <= 0.0 { SkyCell::Behind } else { SkyCell::Free };
                // the wall stands behind the upright plane, and half above the tilted one
                if normal == DVec3::NEG_Y || expected == SkyCell::Behind {
                    assert_eq!(*cell, expected, "{to}");
                }
                free += usize::from(*cell == SkyCell::Free);
            }
            assert!(free > 10_000, "{free}");
        }
    }
    for sky in skies(&with(at(dvec3(0.0, 0.0, -1.0), None))) {
        assert!(sky.cells.iter().all(|cell| matches!(cell, SkyCell::Ground | SkyCell::Free)));
        assert_eq!(sky.cells[sky.cells.len() / 2 + sky.picture.width as usize / 2], SkyCell::Ground);
    }
}

fn lines(place: &Place) -> SkyLines {
    SkyLines::of_year(place, 2026, Some(Air::standard(place.elevation_m))).unwrap()
}

fn on(line: &HourLine, day: NaiveDate) -> Option<[f64; 2]> {
    let at = line.runs.iter().flatten().find(|(date, _)| *date == day)?;
    Some(azimuth_and_altitude(at.1))
}

fn sea_level(latitude: f64, longitude: f64, zone: &str) -> Place {
    Place::new("somewhere", latitude, longitude, 0.0, Some(zone)).unwrap()
}

/// Positions of pvlib 0.16.1 at whole hours of legal time, in summer time and in standard time, north and south.
#[test]
fn clock_hours_lie_at_published_positions() {
    for (latitude, longitude, zone, on_day, hour, azimuth, altitude) in [
        (51.5074, -0.1278, "Europe/London", "2026-06-21", 16, 247.54136, 46.00681),
        (40.7128, -74.006, "America/New_York", "2026-12-21", 12, 181.48021, 25.86787),
        (-33.8688, 151.2093, "Australia/Sydney", "2026-06-21", 15, 316.25634, 18.09058),
    ] {
        let place = sea_level(latitude, longitude, zone);
        let lines = lines(&place);
        let seen = on(&lines.clock_hours[hour], date(on_day)).unwrap();
        assert!((seen[0] - azimuth).abs() < 2e-3 && (seen[1] - altitude).abs() < 2e-3, "{zone}: {seen:?}");
        // and the way of that day passes there
        let month = date(on_day).month0() as usize;
        assert_eq!(lines.months[month].date, date(on_day));
        let to = direction(azimuth, altitude);
        let near = lines.months[month].runs.iter().flatten().map(|at| at.angle_between(to).to_degrees());
        assert!(near.fold(f64::INFINITY, f64::min) < 0.51, "{zone}: the way of {on_day}");
    }
}

/// A line breaks off where the clock is changed, and runs on without a jump everywhere else.
#[test]
fn clock_hours_break_where_clocks_are_changed() {
    let lines = lines(&paris());
    let noon = &lines.clock_hours[13];
    let ends: Vec<_> = noon.runs.iter().map(|run| [run[0].0, run[run.len() - 1].0]).collect();
    let expected = [["2026-01-01", "2026-03-28"], ["2026-03-29", "2026-10-24"], ["2026-10-25", "2026-12-31"]];
    assert_eq!(ends, expected.map(|ends| ends.map(date)));
    for run in lines.clock_hours.iter().flat_map(|hour| &hour.runs) {
        let steps = run.windows(2).map(|ends| ends[0].1.angle_between(ends[1].1).to_degrees());
        assert!(steps.fold(0.0, f64::max) < 3.5);
        assert!(run.iter().all(|(_, to)| to.z >= 0.0), "below the horizon");
    }
    // 12:00 in winter is where 13:00 in summer is: on the same figure of eight
    let summer = azimuth_and_altitude(lines.clock_hours[13].runs[1][0].1);
    let winter = azimuth_and_altitude(lines.clock_hours[12].runs[0].last().unwrap().1);
    assert!((summer[0] - winter[0]).abs() < 0.7 && (summer[1] - winter[1]).abs() < 0.7, "{winter:?} {summer:?}");
}

/// A sundial's hour is 15° of hour angle: from the direction alone, without air.
#[test]
fn solar_hours_are_hour_angles() {
    for latitude in [48.8583, -33.9, 5.0] {
        let place = sea_level(latitude, 2.2945, "Europe/Paris");
        let lines = SkyLines::of_year(&place, 2026, None).unwrap();
        let (sin, cos) = latitude.to_radians().sin_cos();
        let mut seen = 0;
        for line in &lines.solar_hours {
            for (date, to) in line.runs.iter().flatten().filter(|(_, to)| to.z > 0.0) {
                let hour_angle = (-to.x).atan2(to.z * cos - to.y * sin).to_degrees();
                let off = (hour_angle - 15.0 * (f64::from(line.hour) - 12.0) + 180.0).rem_euclid(360.0) - 180.0;
                // what is seen from the Earth's surface lies up to 0.0024° off
                assert!(off.abs() < 0.02, "{latitude}, {date}, hour {}: {hour_angle}", line.hour);
                seen += 1;
            }
        }
        assert!(seen > 150, "{seen}");
    }
    // at noon of the solstices the sun stands in the meridian, the tropic's latitude above or below the equator
    let lines = SkyLines::of_year(&paris(), 2026, None).unwrap();
    for (on_day, declination) in [("2026-06-21", 23.436), ("2026-12-21", -23.436)] {
        let [azimuth, altitude] = on(&lines.solar_hours[12], date(on_day)).unwrap();
        assert!((azimuth - 180.0).abs() < 0.02, "{azimuth}");
        assert!((altitude - (90.0 - 48.8583 + declination)).abs() < 0.01, "{altitude}");
    }
}

/// North of the circle the June sun goes around and the December one stays down; at the equator the equinox passes near
/// the zenith.
#[test]
fn charts_of_far_places_have_what_there_is() {
    let tromso = lines(&sea_level(69.65, 18.96, "Europe/Oslo"));
    assert!(tromso.months[11].runs.is_empty());
    assert_eq!(tromso.months[5].runs.len(), 1);
    let turn: Vec<_> = tromso.months[5].runs[0].iter().map(|to| azimuth_and_altitude(*to)[0]).collect();
    assert!((0..36).all(|tenth| turn.iter().any(|azimuth| (azimuth / 10.0) as u32 == tenth)), "{turn:?}");
    assert!(tromso.clock_hours.iter().all(|hour| on(hour, date("2026-06-21")).is_some()));
    assert!(tromso.clock_hours.iter().all(|hour| on(hour, date("2026-12-21")).is_none()));
    let quito = lines(&sea_level(-0.18, -78.47, "America/Guayaquil"));
    let highest = quito.months[2].runs[0].iter().map(|to| to.z).fold(0.0, f64::max);
    assert!(highest.asin().to_degrees() > 88.5, "{highest}");
    assert_eq!(
        sky_pictures(&place(-33.9, 151.2, "Australia/Sydney"))[1].projection,
        SkyProjection::Cylindrical { middle_rad: 0.0 }
    );
    // a zone without a day in the year of its calendar's change, and the last years
    let samoa = sea_level(-13.83, -171.77, "Pacific/Apia");
    for year in [2011, 1600, 2999] {
        let lines = SkyLines::of_year(&samoa, year, None).unwrap();
        assert_eq!(lines.months.len(), 12, "{year}");
    }
    assert!(SkyLines::of_year(&samoa, 3000, None).is_err());
}

/// The way in the sun is that of the intervals, to the second, and does not meet the wall.
#[test]
fn the_lit_way_is_that_of_the_intervals() {
    let place = paris();
    let days = vec![day(&place, "2026-06-21", None), day(&place, "2026-12-21", Some(["10:00", "14:00"]))];
    let south = |[x, z]: [f64; 2]| dvec3(x, -10.0, z);
    let wall = sheet([[-5.0, 0.0], [5.0, 0.0], [5.0, 30.0], [-5.0, 30.0]].map(south));
    let asked = probing(&place, vec![wall], vec![at(DVec3::ZERO, None)], days);
    let sunlight = found(&asked);
    let search = SkySearch::new(&asked, &sunlight);
    let ways = search.ways(0).unwrap();
    assert_eq!(ways.len(), 2);
    let air = Some(Air::standard(place.elevation_m));
    for (way, (day, intervals)) in ways.iter().zip(sunlight.days.iter().zip(&sunlight.probes[0].days)) {
        assert_eq!((way.way.date, &way.intervals), (day.window.day.date, intervals));
        assert!(!intervals.is_empty() && way.lit.len() == intervals.len());
        for (interval, lit) in intervals.iter().zip(&way.lit) {
            let delta_t_secs = gnomon::sun::delta_t_secs(interval.start.to_utc()).unwrap();
            let sky = gnomon::sun::Sky { place: &place, delta_t_secs, air };
            for (time, to) in [(interval.start, lit[0]), (interval.end, lit[lit.len() - 1])] {
                assert!(sky.at(time).unwrap().to_sun.angle_between(to) < 1e-6);
            }
            let hidden = |to: &&DVec3| to.y < 0.0 && (to.x / to.y * 10.0).abs() < 4.99 && to.z / -to.y * 10.0 < 29.99;
            assert_eq!(lit.iter().filter(hidden).count(), 0);
        }
        for run in &way.way.runs {
            let (last, above) = run.split_last().unwrap();
            assert!(above.iter().all(|to| to.z >= -1e-6), "{above:?}");
            // the end is the first second after sunset, and in a second the sun sinks by at most a turn's 86,164th
            assert!(last.z > -std::f64::consts::TAU / 86_164.0, "{}", last.z);
        }
    }
    // of many days a dozen, with the first and the last
    let many = (1..=31).map(|on| super::day(&place, &format!("2026-05-{on:02}"), None)).collect();
    let asked = probing(&place, vec![north_wall(10.0)], vec![at(DVec3::ZERO, None)], many);
    let sunlight = found(&asked);
    let ways = SkySearch::new(&asked, &sunlight).ways(0).unwrap();
    let dates: Vec<_> = ways.iter().map(|way| way.way.date).collect();
    assert_eq!((dates.len(), dates[0], dates[MOST_WAYS - 1]), (MOST_WAYS, date("2026-05-01"), date("2026-05-31")));
}

/// The sheet says what it shows, and the wall fills as much of it as of the rasters.
#[test]
fn the_sheet_shows_what_was_found() {
    let place = paris();
    let window = vec![day(&place, "2026-03-21", None)];
    let asked = probing(&place, vec![north_wall(10.0)], vec![at(DVec3::ZERO, None)], window);
    let sunlight = found(&asked);
    let search = SkySearch::new(&asked, &sunlight);
    let (rasters, lines) = (search.rasters(0, sky_pictures(&place)), search.lines().unwrap());
    let (ways, colours) = (search.ways(0).unwrap(), sky_colours(&asked.mesh, &asked.casts));
    let (place, ground) = (&asked.place, &asked.ground);
    let shown =
        SkyContext { place, ground, sunlight: &sunlight, probe: 0, lines: &lines, ways: &ways, colours: &colours };
    let drawing = sky_sheet(&shown, &rasters);
    let svg = drawing.svg();
    for word in
        [">N<", ">E<", ">S<", ">W<", ">XII<", ">12<", ">13<", ">21 Jun<", ">21 Dec<", ">30°<", ">wall<", ">150°<"]
    {
        assert!(svg.contains(word), "no {word}");
    }
    for group in ["stereographic-obstacles", "cylindrical-obstacles"] {
        assert_eq!(svg.matches(&format!("id=\"{group}\"")).count(), 1, "{group}");
    }
    let page = image::load_from_memory(&drawing.png().unwrap()).unwrap().to_rgb8();
    let drawn = page.pixels().filter(|pixel| pixel.0 == colours[0]).count() as f64;
    let cells = |sky: &SkyRaster| {
        // what lies over the disc's rim is cut
        let is_within = |index: usize| {
            let at = DVec2::new((index as u32 % sky.picture.width) as f64, (index as u32 / sky.picture.width) as f64);
            let radius = f64::from(sky.picture.width) / 2.0;
            sky.picture.projection != SkyProjection::Stereographic || (at - radius).length() < radius
        };
        let walls = sky.cells.iter().enumerate().filter(|(index, cell)| **cell != SkyCell::Free && is_within(*index));
        walls.count()
    };
    let expected = 4.0 * rasters.iter().map(|sky| cells(sky) as f64).sum::<f64>();
    // without the grid and its letters; the legend has a little of it, too
    assert!((0.88..1.03).contains(&(drawn / expected)), "{drawn} of {expected} pixels");
    // the plane's limit is an area of its own
    let facing = probing(
        &asked.place,
        vec![north_wall(10.0)],
        vec![at(DVec3::ZERO, Some(DVec3::NEG_Y))],
        vec![day(&asked.place, "2026-03-21", None)],
    );
    let sunlight = found(&facing);
    let search = SkySearch::new(&facing, &sunlight);
    let rasters = search.rasters(0, sky_pictures(&facing.place));
    let ways = search.ways(0).unwrap();
    let shown = SkyContext { sunlight: &sunlight, ways: &ways, ..shown };
    let svg = sky_sheet(&shown, &rasters).svg();
    assert!(svg.contains("behind the point’s plane") && !svg.contains(">wall<"));
}

#[test]
fn every_point_has_a_sheet_of_its_own() {
    let folder = site();
    let path = folder.path();
    let table = "name,x,y,z,nx,ny,nz\nnorth,0,20,1.5,0,1,0\nfree,0,-30,1.5,,,\n";
    std::fs::write(path.join("points.csv"), table).unwrap();
    let said = done(path, "probe . --points points.csv --sky out/sky.v1.svg --date 2026-03-21 --quiet");
    assert!(said.contains("sky.v1-1.svg") && said.contains("sky.v1-2.svg"), "{said}");
    assert_eq!(names(path.join("out")), ["sky.v1-1.svg", "sky.v1-2.svg"]);
    let [north, free] =
        ["sky.v1-1.svg", "sky.v1-2.svg"].map(|name| std::fs::read_to_string(path.join("out").join(name)).unwrap());
    assert!(north.contains("behind the point’s plane") && north.contains(">north<"));
    assert!(free.contains(">tower<") && !free.contains("behind the point’s plane"));
    let said = done(path, "probe . --point 0,-30,1.5 --sky sky.png --date 2026-03-21 --quiet");
    assert!(said.contains("sky.png"), "{said}");
    assert!(pixels(path.join("sky.png"), |colour| colour == [240, 164, 0]) > 20_000, "the sun's way");
    let many: String = (0..101).map(|at| format!("p{at},{at},-30,1\n")).collect();
    std::fs::write(path.join("many.csv"), format!("name,x,y,z\n{many}")).unwrap();
    fails(path, "probe . --points many.csv --sky many.png", 2, &["--sky", "101 points", "at most 100"]);
    fails(path, "probe . --point 0,0,30 --sky sky.pdf", 2, &["--sky", "PNG or SVG", ".png or .svg"]);
    fails(path, "probe . --point 0,0,30 --sky tower.glb", 2, &["--sky"]);
}

/// The window's card has the disc alone, in the same colours.
#[test]
fn a_card_shows_the_disc() {
    let window = vec![day(&paris(), "2026-03-21", None)];
    let asked = probing(&paris(), vec![north_wall(10.0)], vec![at(DVec3::ZERO, None)], window);
    let sunlight = found(&asked);
    let card = sky_card(&asked, &sunlight).unwrap().unwrap();
    assert_eq!(card.pixels.len(), card.width as usize * card.height as usize);
    let wall = sky_colours(&asked.mesh, &asked.casts)[0];
    let of = |colour: [u8; 3]| {
        let drawn = (0..card.pixels.len()).filter(|at| card.pixels[*at] == colour);
        drawn.map(|at| DVec2::new((at as u32 % card.width) as f64, (at as u32 / card.width) as f64)).collect::<Vec<_>>()
    };
    // the wall in the north, the sun's way south of the zenith
    let middle = f64::from(card.height) / 2.0;
    let (walls, ways) = (of(wall), of([240, 164, 0]));
    assert!(walls.len() > 5_000 && walls.iter().all(|at| at.y < middle), "{}", walls.len());
    assert!(ways.len() > 1_000 && ways.iter().all(|at| at.y > middle - 10.0), "{}", ways.len());
}

/// The lines of a year use one ΔT. At the year's ends the sun stands where its own ΔT has it to 0.03 s of its way, and a
/// difference of an hour would be seen.
#[test]
fn one_delta_t_a_year_is_enough() {
    use gnomon::sun::{Sky, delta_t_secs};
    let paris = paris();
    for year in [1600, 1750, 1900, 1987, 2026, 2100, 2500, 2999] {
        let at = |text: String| -> chrono::DateTime<chrono::Utc> { text.parse().unwrap() };
        let of_year = delta_t_secs(at(format!("{year}-07-01T00:00:00Z"))).unwrap();
        for day in ["01-01T12:00:00Z", "12-31T12:00:00Z"] {
            let time = at(format!("{year}-{day}"));
            let seen = |delta_t_secs: f64| {
                let sky = Sky { place: &paris, delta_t_secs, air: None };
                sky.at(time.with_timezone(&paris.time_zone)).unwrap().to_sun
            };
            let own = seen(delta_t_secs(time).unwrap());
            // radians a second
            let speed = 2.0 * PI / 86_400.0;
            assert!(own.distance(seen(of_year)) < 0.03 * speed, "{year}: {} s", own.distance(seen(of_year)) / speed);
            assert!(own.distance(seen(of_year + 3600.0)) > speed);
        }
    }
}
