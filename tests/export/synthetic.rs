//! A small synthetic town with its surface, sun and shadows, computed in simple and rough ways: good enough to look at
//! drawings.

use chrono::{NaiveDate, TimeDelta, TimeZone};
use glam::DVec3;
use gnomon::choice::{Engine, Finder, Method, Receivers, Settings};
use gnomon::export::figure::FigureContext;
use gnomon::mesh::{Mesh, Part};
use gnomon::profile::{Profile, Provenance};
use gnomon::site::Ground;
use gnomon::sun::{Day, Instant, Place, SunTrack, Zone, ZoneRules};
use gnomon::view::{Grid, Mask, Surface};
use rayon::prelude::*;

pub(super) struct Town {
    pub place: Place,
    pub track: SunTrack,
    pub mesh: Mesh,
    pub drawn: Provenance,
}

impl Town {
    /// `scale` metres a unit of a town some 300 units wide; the window is `from`..`to` seconds of the day.
    pub(super) fn new(scale: f64, from: u32, to: u32, step: u32) -> Town {
        Town {
            place: Place {
                name: "Karlsplatz, Vienna".to_owned(),
                latitude_deg: 48.2,
                longitude_deg: 16.38,
                elevation_m: 171.0,
                time_zone: vienna(),
            },
            track: track(from, to, step),
            mesh: mesh(scale),
            drawn: Provenance {
                technique: Method::Stencil,
                finder: Some(Finder::Brute),
                engine: Engine::Gpu,
                adapter: Some("llvmpipe (LLVM 19.1.7, 256 bits)".to_owned()),
                settings: Settings::NONE,
                resolution_secs: 0,
            },
        }
    }

    pub(super) fn scene<'a>(&'a self, surface: &'a Surface, receivers: Receivers) -> FigureContext<'a> {
        let Town { place, track, mesh, drawn, .. } = self;
        FigureContext { place, track, mesh, surface, receivers, ground: Ground::asked(0.0), drawn }
    }
}

fn vienna() -> Zone {
    ZoneRules::newest().zone("Europe/Vienna").expect("a zone")
}

/// A grid of `width` × `height` cells around the town's middle.
pub(super) fn grid(width: u32, height: u32, cell: f64) -> Grid {
    Grid { west: -0.5 * f64::from(width) * cell, north: 0.5 * f64::from(height) * cell, cell, width, height }
}

/// The sun on a September day at 48° north, to a degree or so.
pub(super) fn track(from: u32, to: u32, step: u32) -> SunTrack {
    let date = NaiveDate::from_ymd_opt(2026, 9, 18).unwrap();
    let time = |secs: i64| {
        let local = date.and_hms_opt(0, 0, 0).unwrap() + TimeDelta::seconds(secs);
        vienna().from_local_datetime(&local).unwrap()
    };
    let count = (to - from).checked_div(step).unwrap_or(0) + 1;
    let instants = (0..count).map(|i| {
        let secs = from + i * step;
        let (hour, latitude, tilt) =
            ((f64::from(secs) / 3600.0 - 12.8) * 15_f64.to_radians(), 48.2_f64.to_radians(), 1.7_f64.to_radians());
        let altitude = (latitude.sin() * tilt.sin() + latitude.cos() * tilt.cos() * hour.cos()).asin();
        let azimuth =
            std::f64::consts::PI + hour.sin().atan2(hour.cos() * latitude.sin() - tilt.tan() * latitude.cos());
        let half = if i == 0 || i + 1 == count { 2 } else { 1 };
        Instant {
            time: time(i64::from(secs)),
            to_sun: DVec3::new(altitude.cos() * azimuth.sin(), altitude.cos() * azimuth.cos(), altitude.sin()),
            azimuth_rad: azimuth,
            altitude_rad: altitude,
            weight_secs: step / half,
            gap_secs: if i > 0 && altitude >= 0.0 { step } else { 0 },
            night: altitude < 0.0,
        }
    });
    SunTrack {
        instants: instants.collect(),
        days: vec![Day {
            date,
            sunrise: Some(time(24_000)),
            noon: Some(time(46_080)),
            sunset: Some(time(68_400)),
            polar: None,
        }],
        each_day: None,
        step_secs: step,
        resolution_secs: 0,
        refraction: true,
        delta_t_secs: 69.2,
    }
}

fn mesh(scale: f64) -> Mesh {
    let mut town = Part { name: "town".to_owned(), ..Part::default() };
    let mut house = |x: f64, y: f64, w: f64, d: f64, eaves: f64, ridge: f64, turn: f64| {
        let at = |u: f64, v: f64, z: f64| {
            let (sin, cos) = turn.to_radians().sin_cos();
            DVec3::new(x + u * cos - v * sin, y + u * sin + v * cos, z) * scale
        };
        let low = [(-w, -d), (w, -d), (w, d), (-w, d)];
        let base = low.map(|(u, v)| at(u, v, 0.0));
        let top = low.map(|(u, v)| at(u, v, eaves));
        let ends = [at(-w, 0.0, ridge), at(w, 0.0, ridge)];
        let mut add = |a: DVec3, b: DVec3, c: DVec3| {
            let first = town.positions.len() as u32;
            town.positions.extend([a, b, c]);
            town.triangles.push([first, first + 1, first + 2]);
        };
        for i in 0..4 {
            let j = (i + 1) % 4;
            add(base[i], base[j], top[j]);
            add(base[i], top[j], top[i]);
        }
        if ridge <= eaves {
            add(top[0], top[1], top[2]);
            add(top[0], top[2], top[3]);
            return;
        }
        add(top[1], top[2], ends[1]);
        add(top[3], top[0], ends[0]);
        for (a, b, c, d) in [(top[0], top[1], ends[1], ends[0]), (top[2], top[3], ends[0], ends[1])] {
            add(a, b, c);
            add(a, c, d);
        }
    };
    house(-10.0, 5.0, 9.0, 9.0, 62.0, 0.0, 20.0); // a tower
    house(-10.0, 5.0, 6.0, 6.0, 68.0, 0.0, 20.0);
    house(-10.0, 5.0, 22.0, 15.0, 14.0, 0.0, 20.0);
    house(60.0, 40.0, 30.0, 7.0, 12.0, 18.0, -8.0); // pitched rows
    house(60.0, 8.0, 30.0, 7.0, 12.0, 18.0, -8.0);
    house(-75.0, 45.0, 24.0, 8.0, 9.0, 15.0, 64.0);
    house(-75.0, -30.0, 16.0, 16.0, 21.0, 0.0, 0.0); // a block with a set-back
    house(-75.0, -30.0, 10.0, 10.0, 26.0, 0.0, 0.0);
    house(30.0, -50.0, 40.0, 6.0, 10.0, 15.0, 4.0);
    house(100.0, -40.0, 8.0, 8.0, 6.0, 10.0, 30.0);
    house(10.0, 70.0, 20.0, 8.0, 8.0, 13.0, 0.0);
    house(-20.0, -70.0, 30.0, 12.0, 0.004, 0.0, 0.0); // paving
    Mesh::build(vec![town]).expect("a small town")
}

pub(super) fn corners(mesh: &Mesh, face: usize) -> [DVec3; 3] {
    mesh.faces[face].map(|v| mesh.vertices[v as usize].as_dvec3() + mesh.origin)
}

/// The highest face under each cell.
pub(super) fn plan(mesh: &Mesh, grid: &Grid) -> Surface {
    let mut surface = Surface {
        width: grid.width,
        height: grid.height,
        face: vec![Surface::GROUND; grid.cells()],
        height_m: vec![0.0; grid.cells()],
    };
    for face in 0..mesh.faces.len() {
        let plane = mesh.planes()[face];
        let normal = plane.truncate();
        if normal.z < 1e-6 {
            continue;
        }
        let points = corners(mesh, face);
        let side = |p: DVec3, a: DVec3, b: DVec3| (b - a).cross(p - a).z >= 0.0;
        let column = |x: f64| ((x - grid.west) / grid.cell).clamp(0.0, f64::from(grid.width)) as u32;
        let row = |y: f64| ((grid.north - y) / grid.cell).clamp(0.0, f64::from(grid.height)) as u32;
        let low = points[0].min(points[1]).min(points[2]);
        let high = points[0].max(points[1]).max(points[2]);
        for r in row(high.y)..(row(low.y) + 1).min(grid.height) {
            for c in column(low.x)..(column(high.x) + 1).min(grid.width) {
                let p = grid.centre(c, r).extend(0.0);
                if (0..3).all(|i| side(p, points[i], points[(i + 1) % 3])) {
                    let z = points[0].z - normal.truncate().dot((p - points[0]).truncate()) / normal.z;
                    let cell = (r * grid.width + c) as usize;
                    if z as f32 > surface.height_m[cell] {
                        surface.height_m[cell] = z as f32;
                        surface.face[cell] = face as u32;
                    }
                }
            }
        }
    }
    surface
}

/// What the sun sees of a height field: the shade's height is swept away from the sun, row by row.
pub(super) fn mask(surface: &Surface, grid: &Grid, sun: &Instant, receivers: Receivers) -> Mask {
    let (w, h) = (grid.width as i64, grid.height as i64);
    let (dx, dy) = (sun.to_sun.x, -sun.to_sun.y);
    let by_row = dy.abs() >= dx.abs();
    let major = if by_row { dy } else { dx };
    let across = if by_row { dx } else { dy } / major.abs();
    let drop = grid.cell * (1.0 + across * across).sqrt() * sun.altitude_rad.tan();
    let (lines, length) = if by_row { (h, w) } else { (w, h) };
    let index = |line: i64, at: i64| if by_row { line * w + at } else { at * w + line } as usize;
    let mut shade = vec![f64::NEG_INFINITY; grid.cells()];
    let mut share = vec![0; grid.cells()];
    for i in 0..lines {
        let line = if major < 0.0 { i } else { lines - 1 - i };
        for at in 0..length {
            let cell = index(line, at);
            let (from, x) = (line + if major < 0.0 { -1 } else { 1 }, at as f64 + across);
            let left = x.floor() as i64;
            let mut height = f64::NEG_INFINITY;
            if i > 0 && left >= 0 && left + 1 < length {
                let top = |at: i64| {
                    let cell = index(from, at);
                    shade[cell].max(f64::from(surface.height_m[cell]))
                };
                height = top(left) + (top(left + 1) - top(left)) * (x - left as f64) - drop;
            }
            shade[cell] = height;
            let own = match receivers {
                Receivers::Top | Receivers::Patches => f64::from(surface.height_m[cell]),
                Receivers::Ground => 0.0,
            };
            let under = receivers == Receivers::Ground && surface.height_m[cell] > 0.01;
            share[cell] = if sun.night || height > own + 0.05 || under { 0 } else { 255 };
        }
    }
    Mask { width: grid.width, height: grid.height, share }
}

pub(super) fn profile(town: &Town, surface: &Surface, grid: Grid, receivers: Receivers) -> Profile {
    let zero = Profile { grid, shaded: vec![0_u32; grid.cells()].into(), day_secs: 0, night_secs: 0 };
    let one = |sun: &Instant| {
        let mut profile = zero.clone();
        if sun.night {
            profile.night_secs = sun.weight_secs;
        } else {
            profile.day_secs = sun.weight_secs;
            let mask = mask(surface, &grid, sun, receivers);
            let sums = mask.share.iter().map(|share| u32::from(255 - share) * sun.weight_secs);
            profile.shaded = sums.collect::<Vec<u32>>().into();
        }
        profile
    };
    let add = |mut a: Profile, b: Profile| {
        a.day_secs += b.day_secs;
        a.night_secs += b.night_secs;
        a.shaded = a.shaded.iter().zip(b.shaded.iter()).map(|(a, b)| a + b).collect::<Vec<u64>>().into();
        a
    };
    town.track.instants.par_iter().map(one).reduce(|| zero.clone(), add)
}
