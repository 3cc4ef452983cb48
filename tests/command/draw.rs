//! `gnomon profile --draw`: the drawn lines against closed forms and against the raster.

use crate::shared::program::{done, fails, names, site};
use serde_json::Value;
use std::path::Path;
use tiff::decoder::{Decoder, DecodingResult};

const PLAN: &str = "--engine cpu --receivers ground --region -70,-30,50,60 --cell 0.25";

/// An attribute's value in an element's text.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let after = element.split(&format!(" {name}=\"")).nth(1).unwrap_or_else(|| panic!("{name} in {element}"));
    after.split('"').next().unwrap()
}

/// The elements of a kind within the group of a name, each from its name up to the next one's.
fn elements<'a>(svg: &'a str, group: &str, kind: &str) -> Vec<&'a str> {
    let within = svg.split(&format!("<g id=\"{group}\">")).nth(1).unwrap_or_else(|| panic!("no {group}"));
    within.split("</g>").next().unwrap().split(&format!("<{kind}")).skip(1).collect()
}

/// From the sheet to metres east and north, by the frame around the picture: its line lies outside of it.
struct Place {
    corner: [f64; 2],
    scale: [f64; 2],
}

impl Place {
    fn of(svg: &str, [west, south, east, north]: [f64; 4]) -> Place {
        let frame = svg.rsplit("<rect").next().unwrap();
        let line: f64 = attribute(frame, "stroke-width").parse().unwrap();
        let [width, height] = ["width", "height"].map(|side| attribute(frame, side).parse::<f64>().unwrap() - line);
        Place { corner: [west, north], scale: [(east - west) / width, (south - north) / height] }
    }

    fn metres(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.corner[axis] + at[axis] * self.scale[axis])
    }
}

/// The lines of a path's data; closed ones end where they begin.
fn lines(data: &str) -> Vec<Vec<[f64; 2]>> {
    let of_one = |text: &str| {
        let points = text.trim_end_matches('Z').split('L').map(|point| {
            let (x, y) = point.split_once(' ').unwrap();
            [x, y].map(|number| number.parse::<f64>().unwrap())
        });
        let mut points: Vec<_> = points.collect();
        if text.ends_with('Z') {
            points.push(points[0]);
        }
        points
    };
    data.split('M').skip(1).map(of_one).collect()
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// How far a point lies from a polygon's border.
fn off(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    let from_edge = polygon.iter().zip(next).map(|([ax, ay], [bx, by])| {
        let (dx, dy) = (bx - ax, by - ay);
        let share = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        (ax + dx * share - x).hypot(ay + dy * share - y)
    });
    from_edge.fold(f64::INFINITY, f64::min)
}

#[test]
fn outlines_are_the_shadows_of_a_box() {
    let folder = site();
    let out = folder.path().join("out");
    let said = done(folder.path(), &format!("profile . {PLAN} --draw outlines --write json"));
    assert_eq!(names(out.clone()), ["outlines.png", "outlines.svg", "profile.json"]);
    assert!(said.contains("outlines.svg"), "{said}");
    let svg = std::fs::read_to_string(out.join("outlines.svg")).unwrap();
    let place = Place::of(&svg, [-70.0, -30.0, 50.0, 60.0]);
    let paths = elements(&svg, "outlines", "path");
    let labels = elements(&svg, "labels", "text");
    let report = json(&out.join("profile.json"));
    let instants = report["instants"].as_array().unwrap();
    assert_eq!((paths.len(), instants.len()), (5, 5));
    for (path, instant) in paths.iter().zip(instants) {
        let time = instant["time"].as_str().unwrap().split('T').nth(1).unwrap()[..5].to_owned();
        assert!(path.contains(&format!("<title>{time}</title>")), "{time}: {path}");
        // a box of 10 × 10 × 20 m darkens its base and what that sweeps over, away from the sun
        let [azimuth, altitude] =
            ["azimuth_deg", "altitude_deg"].map(|angle| instant[angle].as_f64().unwrap().to_radians());
        let length = 20.0 / altitude.tan();
        let shift = [-azimuth.sin() * length, -azimuth.cos() * length];
        // in the morning the sun is in the south-east, and the shadow's corner behind is not seen
        assert!(shift[0] < 0.0 && shift[1] > 0.0);
        let far = [[-5.0, -5.0], [-5.0, 5.0], [5.0, 5.0]].map(|base| [base[0] + shift[0], base[1] + shift[1]]);
        let shadow = [[5.0, 5.0], [5.0, -5.0], [-5.0, -5.0], far[0], far[1], far[2]];
        let lines = lines(attribute(path, "d"));
        let [line] = &lines[..] else { panic!("{time}: {} lines", lines.len()) };
        let line: Vec<_> = line.iter().map(|point| place.metres(*point)).collect();
        assert!(line.len() < 40, "{time}: {} corners", line.len());
        for point in &line {
            // at the box the base itself is not judged, and the line ends
            let at_box = point.iter().all(|part| part.abs() < 5.4);
            assert!(at_box || off(&shadow, *point) < 0.25, "{time}: {point:?} lies {} m off", off(&shadow, *point));
        }
        let nearest = |corner: &[f64; 2]| {
            line.iter().map(|[x, y]| (x - corner[0]).hypot(y - corner[1])).fold(f64::INFINITY, f64::min)
        };
        for corner in &far {
            assert!(nearest(corner) < 0.5, "{time}: the corner {corner:?} is {} m away", nearest(corner));
        }
        // its time stands beyond the far end
        let label = labels.iter().find(|label| label.contains(&format!(">{time}<"))).expect("a label");
        let (x, y) = attribute(label, "transform")["translate(".len()..].split_once(' ').unwrap();
        let at = place.metres([x.parse().unwrap(), y.trim_end_matches(')').parse().unwrap()]);
        let reach = |at: [f64; 2]| (at[0] * shift[0] + at[1] * shift[1]) / length;
        let farthest = far.iter().map(|corner| reach(*corner)).fold(0.0, f64::max);
        assert!(reach(at) > farthest && reach(at) < farthest + 5.0, "{time} stands at {at:?}");
    }
}

#[test]
fn hours_part_the_cells_of_the_raster() {
    let folder = site();
    let out = folder.path().join("out");
    done(folder.path(), &format!("profile . {PLAN} --from 9:00 --to 17:00 --draw hours --write tif,json"));
    assert_eq!(names(out.clone()), ["hours.png", "hours.svg", "profile.json", "shadow-hours.tif"]);
    let svg = std::fs::read_to_string(out.join("hours.svg")).unwrap();
    let mut decoder = Decoder::new(std::fs::File::open(out.join("shadow-hours.tif")).unwrap()).unwrap();
    let DecodingResult::F32(hours) = decoder.read_image().unwrap() else { panic!("not f32") };
    let (width, height) = (480, 360);
    assert_eq!(hours.len(), width * height);
    let most = hours.iter().enumerate().filter(|(cell, _)| !under_box(*cell, width)).map(|(_, hours)| *hours);
    let most = most.fold(0.0, f32::max);
    let place = Place::of(&svg, [0.0, height as f64, width as f64, 0.0]);
    let paths = elements(&svg, "iso-hours", "path");
    let labels = elements(&svg, "labels", "text");
    for hour in 1..=most.ceil() as usize - 1 {
        let title = format!("<title>{hour} h</title>");
        let of_hour: Vec<_> = paths.iter().filter(|path| path.contains(&title)).collect();
        let mut crossed = std::collections::BTreeSet::new();
        for line in of_hour.iter().flat_map(|path| lines(attribute(path, "d"))) {
            let line: Vec<_> = line.iter().map(|point| place.metres(*point)).collect();
            for ends in line.windows(2) {
                for (along, across) in [(0, 1), (1, 0)] {
                    let [low, high] = [ends[0][across].min(ends[1][across]), ends[0][across].max(ends[1][across])];
                    for middle in (low as usize..=high as usize).map(|at| at as f64 + 0.5) {
                        if middle <= low || middle > high {
                            continue;
                        }
                        let share = (middle - ends[0][across]) / (ends[1][across] - ends[0][across]);
                        let at = ends[0][along] + (ends[1][along] - ends[0][along]) * share - 0.5;
                        let cell = |at: usize| {
                            if along == 0 { middle as usize * width + at } else { at * width + middle as usize }
                        };
                        crossed.insert((cell(at as usize), cell(at as usize + 1)));
                    }
                }
            }
        }
        let above = |cell: usize| hours[cell] > hour as f32 + 1e-5;
        for (a, b) in &crossed {
            assert!(above(*a) != above(*b), "{hour} h: a line between {} and {}", hours[*a], hours[*b]);
        }
        let beside = |cell: usize| (0..height * width).contains(&cell) && cell % width + 1 < width;
        for cell in (0..width * (height - 1)).filter(|cell| beside(*cell)) {
            for next in [cell + 1, cell + width] {
                if above(cell) != above(next) && !crossed.contains(&(cell, next)) {
                    assert!(under_box(cell, width) || under_box(next, width), "{hour} h: no line at {cell}");
                }
            }
        }
        assert!(crossed.len() > 40, "{hour} h: {}", crossed.len());
        assert!(labels.iter().any(|label| label.contains(&format!(">{hour} h<"))), "{hour} h has no label");
    }
}

/// Whether a cell lies under the box, where the ground is not judged.
fn under_box(cell: usize, width: usize) -> bool {
    let (east, north) = ((cell % width) as f64 * 0.25 - 69.875, 59.875 - (cell / width) as f64 * 0.25);
    east.abs() < 5.0 && north.abs() < 5.0
}

#[test]
fn no_line_is_drawn_where_nothing_is_judged() {
    let folder = site();
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    // two metres above the ground it lets some sun in under it
    let text = text.replace("[study]", "position = [0, 0, 2]\n[study]");
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    done(folder.path(), &format!("profile . {PLAN} --draw outlines --write json"));
    let svg = std::fs::read_to_string(folder.path().join("out/outlines.svg")).unwrap();
    let place = Place::of(&svg, [-70.0, -30.0, 50.0, 60.0]);
    for path in elements(&svg, "outlines", "path") {
        let points: Vec<_> = lines(attribute(path, "d")).concat().iter().map(|point| place.metres(*point)).collect();
        assert!(points.len() > 4 && points.iter().any(|[x, y]| x.abs().max(y.abs()) < 5.5), "none at the box");
        assert!(points.iter().all(|[x, y]| x.abs().max(y.abs()) > 4.5), "a line under the box: {points:?}");
    }
}

#[test]
fn times_do_not_lie_on_each_other() {
    let folder = site();
    let day = "--from 8:00 --to 19:00 --step 30min";
    done(folder.path(), &format!("profile . --engine cpu --size 500 {day} --draw outlines,hours --write json"));
    let out = folder.path().join("out");
    assert_eq!(names(out.clone()), ["hours.png", "hours.svg", "outlines.png", "outlines.svg", "profile.json"]);
    let svg = std::fs::read_to_string(out.join("outlines.svg")).unwrap();
    let labels = elements(&svg, "labels", "text");
    let places: Vec<[f64; 2]> = labels
        .iter()
        .map(|label| {
            let (x, y) = attribute(label, "transform")["translate(".len()..].split_once(' ').unwrap();
            [x.parse().unwrap(), y.trim_end_matches(')').parse().unwrap()]
        })
        .collect();
    assert!(places.len() >= 23, "{} times", places.len());
    for (at, a) in places.iter().enumerate() {
        for b in &places[..at] {
            // five digits of 31 pixels are 85 wide and 22 high
            assert!((a[0] - b[0]).abs() > 84.0 || (a[1] - b[1]).abs() > 24.0, "{a:?} and {b:?}");
        }
    }
    // the SVG is whole and of the sheet's size, and the PNG is of the size of all drawings
    assert!(svg.starts_with("<svg xmlns=") && svg.trim_end().ends_with("</svg>"));
    assert_eq!((attribute(&svg, "width"), attribute(&svg, "viewBox")), ("420mm", "0 0 3508 2480"));
    let page = image::open(out.join("outlines.png")).unwrap();
    assert_eq!((page.width(), page.height()), (3508, 2480));
}

/// If the sun does not set, a window may run past midnight: it is shorter than a day, so that no time is repeated.
#[test]
fn outlines_run_past_midnight_in_summer() {
    let folder = site();
    let place = "latitude = 69.65\nlongitude = 18.96\n";
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    let text = text.replace("latitude = 48.8583\nlongitude = 2.2945\n", place);
    std::fs::write(folder.path().join("north.toml"), &text).unwrap();
    std::fs::write(folder.path().join("day.toml"), text.replace("from =", "# from =").replace("to =", "# to ="))
        .unwrap();
    let drawn = |window: &str| {
        let asked = "profile north.toml --date 2026-06-21 --draw outlines --write json --engine cpu --size 100";
        done(folder.path(), &format!("{asked} {window}"));
        std::fs::read_to_string(folder.path().join("out/outlines.svg")).unwrap()
    };
    let svg = drawn("--from 22:00 --to 2:00 --step 1h");
    for time in ["22:00", "23:00", "00:00", "01:00", "02:00"] {
        assert!(svg.contains(&format!(">{time}<")), "no {time}");
    }
    let svg = drawn("--from 1:00 --to 0:00 --step 1h");
    assert!(svg.contains(">01:00<") && svg.contains(">00:00<"));
    // a whole day has its midnight twice
    let dates = "--from-date 2026-06-21 --to-date 2026-06-21 --step 2h";
    fails(folder.path(), &format!("profile day.toml --draw outlines {dates}"), 2, &["one day", "--from and --to"]);
}

#[test]
fn what_cannot_be_drawn_is_told() {
    let folder = site();
    let path = folder.path();
    for (options, words) in [
        ("profile . --draw hours --receivers surfaces", &["--draw", "--receivers surfaces"][..]),
        ("profile . --draw outlines --step 5min", &["25 instants", "at most 24", "--step", "10min"]),
        ("profile . --draw outlines --from-date 2026-03-01 --to-date 2026-03-02", &["one day", "--date 2026-03-01"]),
        ("profile . --draw outlines --from 23:00 --to 23:30", &["--draw", "no sun"]),
        ("profile . --draw hours --from 23:00 --to 23:30", &["--draw", "no sun"]),
        ("profile . --draw contours", &["contours", "hours, outlines"]),
    ] {
        fails(path, options, 2, words);
    }
    // the days, and a window with its own date in place of them
    let days = "dates = [\"2026-03-01\", \"2026-03-02\"]";
    let text = std::fs::read_to_string(path.join("site.toml")).unwrap();
    std::fs::write(path.join("days.toml"), text.replace("date = 2026-09-18", days)).unwrap();
    fails(path, "profile days.toml --draw outlines", 2, &["one day", "--date 2026-03-01 with --from and --to"]);
    assert!(names(path.join("out")).is_empty());
    let window = "--date 2026-03-01 --from 10:00 --to 12:00";
    done(path, &format!("profile days.toml --draw outlines --engine cpu --size 60 --write json {window}"));
    // a day is counted by its instants with a sun: the whole of it is 25 instants, of which 13 have one
    let date = "--from-date 2026-09-18 --to-date 2026-09-18 --from 0:00 --to 23:59 --step 1h";
    done(path, &format!("profile . --engine cpu --size 60 {date} --draw outlines --write json"));
}
