//! What is judged, as faces, lines and dots over the picture.

use crate::judgement::{DeemedBorder, Judgement, PartTriangle, triangles, triangles_of_faces};
use crate::rules::{Band, HeightOver, ResolvedRule, RuleReceiver};
use crate::site::{AreaSurface, JudgedArea, JudgedFacade, JudgedPlot, JudgedSite, JudgedWindow};
use crate::study::GroundHeights;
use glam::DVec3;

/// The height above its surface at which an area is drawn, metres.
const LIFT_M: f64 = 0.02;
/// The number of pieces along the side of an area.
const PIECES_ACROSS: f64 = 14.0;
/// About the number of pieces of all areas together.
const MOST_PIECES: f64 = 8000.0;
/// Up to this number of windows, each is drawn in four pieces, which are hidden one by one.
const MOST_QUARTERED: usize = 5000;
/// The distance between points along a line around a plot, metres.
const SPACING_M: f64 = 1.0;

/// A piece of a shape, small enough to be either seen or hidden.
#[derive(Clone, Copy, Debug)]
pub(in crate::desktop) enum ShapePiece {
    /// A triangle of an area.
    Triangle([DVec3; 3]),
    /// A part of a window.
    Quad([DVec3; 4]),
    /// A part of a line.
    Line([DVec3; 2]),
    /// A point.
    Dot(DVec3),
}

impl ShapePiece {
    /// Its corners.
    pub(in crate::desktop) fn corners(&self) -> &[DVec3] {
        match self {
            ShapePiece::Triangle(corners) => corners,
            ShapePiece::Quad(corners) => corners,
            ShapePiece::Line(ends) => ends,
            ShapePiece::Dot(at) => std::slice::from_ref(at),
        }
    }

    /// The point at which it is seen or hidden.
    pub(in crate::desktop) fn middle(&self) -> DVec3 {
        let corners = self.corners();
        corners.iter().sum::<DVec3>() / corners.len() as f64
    }
}

/// A receiver's shape as a whole.
#[derive(Clone, Copy, Debug)]
pub(in crate::desktop) struct ShapeExtent {
    pub(in crate::desktop) middle: DVec3,
    /// The length of its diagonal, metres.
    pub(in crate::desktop) size_m: f64,
    /// Its outward normal, if it has one.
    pub(in crate::desktop) normal: Option<DVec3>,
}

/// The shapes of receivers.
#[derive(Clone, Debug, Default)]
pub(in crate::desktop) struct VerdictShapes {
    /// All pieces, each with the index of its receiver.
    pub(in crate::desktop) pieces: Vec<(u32, ShapePiece)>,
    /// The extent of each receiver.
    pub(in crate::desktop) extents: Vec<ShapeExtent>,
}

impl VerdictShapes {
    /// What a rule judges of a site, in the order of a judgement's receivers.
    pub(in crate::desktop) fn of_receivers(site: &JudgedSite, judgement: &Judgement) -> VerdictShapes {
        let (rule, mut shapes) = (&judgement.rule, VerdictShapes::default());
        match &rule.receiver {
            RuleReceiver::Area { .. } => shapes.add_areas(site, &site.areas.iter().collect::<Vec<_>>()),
            RuleReceiver::Window { open_spaces, .. } => {
                shapes.add_windows(&site.windows);
                // open spaces of dwellings come after all windows
                let spaces = site.areas.iter().filter(|area| open_spaces.is_some() && area.dwelling.is_some());
                shapes.add_areas(site, &spaces.collect::<Vec<_>>());
            }
            // façades and bands without a point have no verdict
            RuleReceiver::Facade => {
                for receiver in &judgement.receivers {
                    let facade = site.facades.iter().find(|facade| facade.name == receiver.name);
                    shapes.add(facade.map_or(Vec::new(), dots), receiver.normal);
                }
            }
            RuleReceiver::Lines { bands, .. } => {
                for receiver in &judgement.receivers {
                    let is_its = |number: usize| receiver.name.starts_with(&format!("band {}, ", number + 1));
                    let band = (0..bands.len()).find(|number| is_its(*number)).map(|number| bands[number]);
                    let line = site.plot.as_ref().zip(band).map(|(plot, band)| inner_line(site, plot, rule, band));
                    shapes.add(line.unwrap_or_default(), None);
                }
            }
        }
        shapes
    }

    /// Everything that the site file says is judged, whatever a rule takes of it.
    pub(in crate::desktop) fn of_site(site: &JudgedSite) -> VerdictShapes {
        let mut shapes = VerdictShapes::default();
        shapes.add_areas(site, &site.areas.iter().collect::<Vec<_>>());
        site.facades.iter().for_each(|facade| shapes.add(dots(facade), None));
        shapes.add_windows(&site.windows);
        if let Some(plot) = &site.plot {
            let level = plot.mean_ground.unwrap_or(site.now.ground.level) + LIFT_M;
            let corners: Vec<DVec3> = plot.border.iter().map(|corner| corner.extend(level)).collect();
            shapes.add(outline(&corners, f64::INFINITY).collect(), None);
        }
        shapes
    }

    fn add(&mut self, pieces: Vec<ShapePiece>, normal: Option<DVec3>) {
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for corner in pieces.iter().flat_map(ShapePiece::corners) {
            bounds = [bounds[0].min(*corner), bounds[1].max(*corner)];
        }
        // a shape without a piece is at the place's point
        let [low, high] = if bounds[0].is_finite() { bounds } else { [DVec3::ZERO; 2] };
        let number = self.extents.len() as u32;
        self.pieces.extend(pieces.into_iter().map(|piece| (number, piece)));
        self.extents.push(ShapeExtent { middle: (low + high) / 2.0, size_m: (high - low).length(), normal });
    }

    fn add_areas(&mut self, site: &JudgedSite, areas: &[&JudgedArea]) {
        let parts: Vec<Vec<PartTriangle>> = areas.iter().map(|area| parts(area)).collect();
        let corners = || parts.iter().flatten().flat_map(|part| part.corners);
        let heights = GroundHeights::of(&site.now.mesh, &site.now.ground, &corners().collect::<Vec<_>>());
        let all_m2: f64 = parts.iter().flatten().map(|part| part.m2).sum();
        for (area, parts) in areas.iter().zip(parts) {
            let m2: f64 = parts.iter().map(|part| part.m2).sum();
            let longest = (m2.sqrt() / PIECES_ACROSS).max((all_m2 / MOST_PIECES).sqrt()).max(1e-3);
            let place = |corner: DVec3| match area.surface {
                AreaSurface::Level(level) => corner.with_z(level + LIFT_M),
                AreaSurface::Ground(above) => corner.with_z(heights.height(corner) + above + LIFT_M),
                AreaSurface::Faces(_) => corner + DVec3::Z * LIFT_M,
            };
            let mut pieces = Vec::new();
            parts.iter().for_each(|part| {
                cut(part.corners, longest, &mut |corners| {
                    pieces.push(ShapePiece::Triangle(corners.map(place)));
                })
            });
            for ring in &area.rings {
                let corners: Vec<DVec3> = ring.iter().map(|corner| corner.extend(0.0)).collect();
                pieces.extend(outline(&corners, longest).map(|piece| match piece {
                    ShapePiece::Line(ends) => ShapePiece::Line(ends.map(place)),
                    other => other,
                }));
            }
            self.add(pieces, None);
        }
    }

    fn add_windows(&mut self, windows: &[JudgedWindow]) {
        let parts = if windows.len() > MOST_QUARTERED { 1 } else { 2 };
        for JudgedWindow { corners: [a, b, c, d], outward, .. } in windows {
            let out = *outward * LIFT_M;
            let at = |x: usize, y: usize| {
                let [x, y] = [x, y].map(|step| step as f64 / f64::from(parts));
                a.lerp(*b, x).lerp(d.lerp(*c, x), y) + out
            };
            let cells = (0..parts as usize).flat_map(|x| (0..parts as usize).map(move |y| (x, y)));
            let quad = |(x, y)| ShapePiece::Quad([at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
            self.add(cells.map(quad).collect(), Some(*outward));
        }
    }
}

/// The points of a façade.
fn dots(facade: &JudgedFacade) -> Vec<ShapePiece> {
    facade.points.iter().map(|[at, normal]| ShapePiece::Dot(at + normal * LIFT_M)).collect()
}

/// The inner line of a band of the plane around a plot.
fn inner_line(site: &JudgedSite, plot: &JudgedPlot, rule: &ResolvedRule, band: Band) -> Vec<ShapePiece> {
    let RuleReceiver::Lines { height_m, over, deemed, corners, .. } = &rule.receiver else { return Vec::new() };
    let base = match over {
        HeightOver::MeanGround => plot.mean_ground,
        HeightOver::Ground | HeightOver::Floor => None,
    };
    let plane = base.unwrap_or(site.now.ground.level) + height_m;
    let inner = Band { to_m: band.from_m, ..band };
    let spots = DeemedBorder::of(plot, *deemed, *corners).spots(inner, band.from_m, SPACING_M);
    let points: Vec<DVec3> = spots.iter().map(|spot| spot.at.extend(plane + spot.raised_m)).collect();
    // the line is broken in front of a reflex corner
    let gap = 3.0 * SPACING_M.max(band.from_m * 0.05);
    let joined = points.windows(2).filter(|ends| ends[0].distance(ends[1]) < gap);
    joined.map(|ends| ShapePiece::Line([ends[0], ends[1]])).collect()
}

fn parts(area: &JudgedArea) -> Vec<PartTriangle> {
    match &area.surface {
        AreaSurface::Faces(faces) => triangles_of_faces(faces),
        AreaSurface::Level(_) | AreaSurface::Ground(_) => triangles(&area.rings),
    }
}

/// Halves a triangle's longest side until no side is longer than this.
fn cut(corners: [DVec3; 3], longest: f64, add: &mut impl FnMut([DVec3; 3])) {
    let mut left = vec![corners];
    while let Some([a, b, c]) = left.pop() {
        let sides = [a.distance(b), b.distance(c), c.distance(a)];
        let most = sides.into_iter().fold(0.0, f64::max);
        if most <= longest {
            add([a, b, c]);
        } else if sides[0] == most {
            let middle = (a + b) / 2.0;
            left.extend([[a, middle, c], [middle, b, c]]);
        } else if sides[1] == most {
            let middle = (b + c) / 2.0;
            left.extend([[a, b, middle], [a, middle, c]]);
        } else {
            let middle = (c + a) / 2.0;
            left.extend([[a, b, middle], [middle, b, c]]);
        }
    }
}

/// The lines around corners, none longer than this.
fn outline(corners: &[DVec3], longest: f64) -> impl Iterator<Item = ShapePiece> {
    (0..corners.len()).flat_map(move |at| {
        let [from, to] = [corners[at], corners[(at + 1) % corners.len()]];
        let parts = (from.distance(to) / longest).ceil().clamp(1.0, 1000.0);
        let on = move |step: usize| from.lerp(to, step as f64 / parts);
        (0..parts as usize).map(move |step| ShapePiece::Line([on(step), on(step + 1)]))
    })
}
