//! Finds the outlines of buildings that their parts replace.
//!
//! OpenStreetMap has a building as an outline and, if somebody mapped it in more detail, as parts within it, each with
//! its own height. Both together would give the whole building its greatest height.

use super::extrude::{FlatPolygon, FootprintOutline};
use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

/// The share of an outline that parts must cover to replace it.
const COVERED: f64 = 0.9;

/// The number of sample points along each side of an outline's box.
const SAMPLES: usize = 24;

/// The most outlines that are tested for one part: no real file has so many above each other.
const MOST_ABOVE: usize = 64;

/// The outlines that parts replace.
pub(super) struct Replacements {
    /// The indices of the outlines that are replaced.
    pub whole: FxHashSet<usize>,
    /// The number of outlines that are partly covered, and kept.
    pub partly: usize,
}

/// Finds the outlines that parts cover.
pub(super) fn replaced_by_parts(outlines: &[FootprintOutline]) -> Replacements {
    let mut replaced = Replacements { whole: FxHashSet::default(), partly: 0 };
    if !outlines.iter().any(|outline| outline.tags.is_part()) {
        return replaced;
    }
    let index = BoxIndex::of(outlines);
    let mut parts_of: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    for (at, part) in outlines.iter().enumerate().filter(|(_, outline)| outline.tags.is_part()) {
        let Some(point) = part.polygons.first().and_then(FlatPolygon::inner_point) else { continue };
        for outline in index.around(point).take(MOST_ABOVE) {
            if outlines[outline].polygons.iter().any(|polygon| polygon.holds(point)) {
                parts_of.entry(outline).or_default().push(at);
            }
        }
    }
    for (outline, parts) in parts_of {
        let parts: Vec<&FootprintOutline> = parts.iter().filter_map(|&part| outlines.get(part)).collect();
        match outlines.get(outline).map(|outline| covered(outline, &parts)) {
            Some(share) if share >= COVERED => {
                replaced.whole.insert(outline);
            }
            _ => replaced.partly += 1,
        }
    }
    replaced
}

/// The share of an outline that parts cover.
fn covered(outline: &FootprintOutline, parts: &[&FootprintOutline]) -> f64 {
    let (mut inside, mut covered) = (0_u32, 0_u32);
    for polygon in &outline.polygons {
        let (low, high) = polygon.bounds();
        let step = (high - low) / SAMPLES as f64;
        for sample in 0..SAMPLES * SAMPLES {
            let cell = DVec2::new((sample % SAMPLES) as f64 + 0.5, (sample / SAMPLES) as f64 + 0.5);
            let point = low + step * cell;
            if polygon.holds(point) {
                inside += 1;
                let holds = |part: &&FootprintOutline| part.polygons.iter().any(|polygon| polygon.holds(point));
                covered += u32::from(parts.iter().any(holds));
            }
        }
    }
    f64::from(covered) / f64::from(inside.max(1))
}

/// A spatial index of outlines: each is in the cells of one level of a pyramid of grids, whose cells are at least as
/// large as its box.
struct BoxIndex {
    low: DVec2,
    /// The side of the coarsest cell.
    side: f64,
    cells: FxHashMap<(u8, u32, u32), Vec<usize>>,
}

/// The number of levels: the finest cells are about the size of a house in a country.
const LEVELS: u8 = 24;

impl BoxIndex {
    fn of(outlines: &[FootprintOutline]) -> Self {
        let boxes = outlines.iter().flat_map(|outline| &outline.polygons).map(FlatPolygon::bounds);
        let (low, high) =
            boxes.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |all, one| (all.0.min(one.0), all.1.max(one.1)));
        let side = (high - low).max_element().max(f64::MIN_POSITIVE);
        let mut index = Self { low, side, cells: FxHashMap::default() };
        for (at, outline) in outlines.iter().enumerate().filter(|(_, outline)| !outline.tags.is_part()) {
            for polygon in &outline.polygons {
                index.add(at, polygon.bounds());
            }
        }
        index
    }

    fn add(&mut self, outline: usize, (low, high): (DVec2, DVec2)) {
        let size = (high - low).max_element().max(f64::MIN_POSITIVE);
        // the finest level with cells as large as the box, so that the box touches at most four of them
        let level = ((self.side / size).log2().floor().clamp(0.0, f64::from(LEVELS - 1))) as u8;
        let ([x0, y0], [x1, y1]) = (self.cell(level, low), self.cell(level, high));
        for x in x0..=x1.min(x0.saturating_add(1)) {
            for y in y0..=y1.min(y0.saturating_add(1)) {
                self.cells.entry((level, x, y)).or_default().push(outline);
            }
        }
    }

    fn cell(&self, level: u8, point: DVec2) -> [u32; 2] {
        let cells = (point - self.low) / self.side * f64::from(1_u32 << level);
        [cells.x as u32, cells.y as u32]
    }

    /// The outlines whose boxes may contain a point.
    fn around(&self, point: DVec2) -> impl Iterator<Item = usize> + '_ {
        (0..LEVELS).flat_map(move |level| {
            let [x, y] = self.cell(level, point);
            self.cells.get(&(level, x, y)).into_iter().flatten().copied()
        })
    }
}
