//! How buildings stand on terrain: whether they float above it or reach below it.
//!
//! Models and terrain come from different sources with different origins, and a plan does not show that a house floats.
//! A *building* here is whatever is connected in plan and is not terrain. Connection is tested on a raster: a
//! building's cells contain corners or edges of its faces, or have centres covered by its faces.

use super::ground::metres;
use super::terrain::FIRST;
use crate::mesh::Mesh;
use crate::mesh::scan::{by_rows, spans, wholes};
use crate::message::{Message, MessagePart, message, setting};
use glam::{DVec2, DVec3, Vec3Swizzles as _};

/// The most cells along the longer side of a model's plan.
const MOST_CELLS: f64 = 512.0;
/// The least side of a cell, metres; smaller ones would not show more.
const LEAST_CELL_M: f64 = 0.25;
/// The least height or depth that gets a note, metres: terrain is thinned to this.
const TOLD_M: f64 = 0.1;
/// Points within this height of the lowest one belong to the foot, metres.
const LEVEL_M: f64 = 0.001;
/// A cell without terrain.
const NOTHING: u32 = u32::MAX;

pub(super) struct TerrainFaces(Vec<u32>);

impl TerrainFaces {
    /// `None` without terrain.
    pub(super) fn of(mesh: &Mesh) -> Option<TerrainFaces> {
        let terrain = mesh.components.iter().filter(|component| component.is_terrain);
        let faces: Vec<u32> = terrain.flat_map(|component| component.faces.clone()).collect();
        (!faces.is_empty()).then_some(TerrainFaces(faces))
    }
}

/// A note on how many of a model's buildings float above the terrain, reach below it or stand beyond its edge. It is a
/// sentence without a full stop that begins with the model's name. `components` are those of the model that are not
/// terrain.
pub(super) fn note(mesh: &Mesh, terrain: &TerrainFaces, components: &[usize], model: &str) -> Option<Message> {
    let faces: Vec<u32> = components.iter().flat_map(|&at| mesh.components[at].faces.clone()).collect();
    let raster = CellRaster::around(mesh, &faces)?;
    let buildings = raster.buildings(mesh, terrain, &faces);
    let of = |amount: fn(&Building) -> f64| {
        let told = buildings.iter().map(amount).filter(|amount| *amount > TOLD_M);
        told.fold((0, 0.0), |(count, most): (usize, f64), amount| (count + 1, most.max(amount)))
    };
    let (floating, highest) = of(|building| building.floats_m);
    let (sunk, deepest) = of(|building| if building.is_buried { 0.0 } else { building.sinks_m });
    let (buried, lowest) = of(|building| if building.is_buried { building.sinks_m } else { 0.0 });
    let beside = buildings.iter().filter(|building| building.is_beside).count();
    let verb = |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let mut told = Vec::new();
    if floating > 0 {
        let verb = verb(floating, "floats", "float");
        told.push(format!("{verb} more than {TOLD_M} m above the terrain, by up to {}", metres(highest)));
    }
    if sunk > 0 {
        let verb = verb(sunk, "reaches", "reach");
        told.push(format!("{verb} below the terrain, as cellars do, by up to {}", metres(deepest)));
    }
    // nobody builds like this, but heights measured from elsewhere look like it
    if buried > 0 {
        let verb = verb(buried, "lies", "lie");
        told.push(format!("{verb} wholly below the terrain, down to {} below it, and cannot be seen", metres(lowest)));
    }
    // if all buildings are beyond the edge, the terrain is of another place, or meant for one of several models
    if beside > 0 {
        told.push(format!("{} beyond the terrain's edge", verb(beside, "stands", "stand")));
    }
    let what = match buildings.len() {
        _ if told.is_empty() => return None,
        1 => format!("{model} has 1 building: {}", told.join("; ")),
        count => format!("{model} has {count} buildings: {}", told.join("; ")),
    };
    Some(match (floating > 0, buried > 0) {
        (true, _) => message![what; "light falls under what floats: ", position(), " moves a model"],
        (false, true) => message![
            what;
            "unless these are cellars, its heights are measured from elsewhere: ", position(), " moves a model"
        ],
        (false, false) => message![what],
    })
}

fn position() -> MessagePart {
    setting("[[model]]", "position", "`position` under [[model]]")
}

/// How one building stands, metres.
#[derive(Clone, Copy, Default)]
struct Building {
    /// The greatest height of its foot above the terrain.
    floats_m: f64,
    /// Its greatest depth below the terrain.
    sinks_m: f64,
    /// Whether all of it is below the terrain.
    is_buried: bool,
    /// Whether there is no terrain below it.
    is_beside: bool,
}

/// The part of a model in one cell.
#[derive(Clone, Copy)]
struct BuiltCell {
    /// The height of its lowest point, metres; infinite if the cell is empty.
    lowest: f64,
    /// The height of that point above the terrain (the greatest of equally low points); NaN without terrain.
    above: f64,
    /// The greatest depth of its points below the terrain.
    below: f64,
    /// The greatest height of its points above the terrain; −∞ without terrain.
    highest: f64,
}

/// Square cells over the plan of some faces.
struct CellRaster {
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl CellRaster {
    /// Cells over those faces that stand at home; `None` if none does.
    fn around(mesh: &Mesh, faces: &[u32]) -> Option<CellRaster> {
        let points = || faces.iter().filter(|face| is_at_home(mesh, **face)).flat_map(|&face| corners(mesh, face));
        let low = points().fold(DVec3::INFINITY, DVec3::min).truncate();
        let size = points().fold(DVec3::NEG_INFINITY, DVec3::max).truncate() - low;
        let cell = (size.max_element() / (MOST_CELLS - 1.0)).max(LEAST_CELL_M);
        // one more, as a point may lie on the far border
        let [columns, rows] = size.to_array().map(|side| (side / cell) as usize + 1);
        low.is_finite().then_some(CellRaster { low, cell, columns, rows })
    }

    fn cell_of(&self, at: DVec2) -> usize {
        let [column, row] = ((at - self.low) / self.cell).to_array().map(|at| at as usize);
        row.min(self.rows - 1) * self.columns + column.min(self.columns - 1)
    }

    /// Calls `tell` with each cell whose centre a face covers, and the face's point there.
    fn cover(&self, [a, b, c]: [DVec3; 3], mut tell: impl FnMut(usize, DVec3)) {
        let normal = (b - a).cross(c - a);
        // vertical: it covers nothing
        if normal.z.abs() <= 1e-9 * normal.length() {
            return;
        }
        let mut in_cells = [a, b, c].map(|corner| (corner.xy() - self.low) / self.cell - FIRST);
        in_cells.sort_unstable_by(|one, other| by_rows(*one, *other));
        spans(in_cells, 0..self.rows, |row, from, to| {
            for column in wholes([from, to], 0..self.columns) {
                let at = self.low + (DVec2::new(column as f64, row as f64) + FIRST) * self.cell;
                tell(row * self.columns + column, at.extend(on_plane([a, b, c], at)));
            }
        });
    }

    /// For each cell, the terrain's highest face.
    fn terrain(&self, mesh: &Mesh, terrain: &TerrainFaces) -> Vec<u32> {
        let mut highest = vec![(f64::NEG_INFINITY, NOTHING); self.columns * self.rows];
        for &face in &terrain.0 {
            self.cover(corners(mesh, face), |cell, point| {
                if point.z > highest[cell].0 {
                    highest[cell] = (point.z, face);
                }
            });
        }
        highest.into_iter().map(|(_, face)| face).collect()
    }

    fn buildings(&self, mesh: &Mesh, terrain: &TerrainFaces, faces: &[u32]) -> Vec<Building> {
        let terrain = self.terrain(mesh, terrain);
        let empty = BuiltCell { lowest: f64::INFINITY, above: f64::NAN, below: 0.0, highest: f64::NEG_INFINITY };
        let mut cells = vec![empty; self.columns * self.rows];
        let mut add = |cell: usize, point: DVec3| {
            let above = match terrain[cell] {
                NOTHING => f64::NAN,
                face => point.z - on_plane(corners(mesh, face), point.xy()),
            };
            let built = &mut cells[cell];
            built.below = built.below.max(-above);
            built.highest = built.highest.max(above);
            if point.z < built.lowest - LEVEL_M {
                (built.lowest, built.above) = (point.z, above);
            } else if point.z <= built.lowest + LEVEL_M {
                // `f64::max` ignores NaN
                (built.lowest, built.above) = (built.lowest.min(point.z), built.above.max(above));
            }
        };
        for &face in faces.iter().filter(|face| is_at_home(mesh, **face)) {
            let [a, b, c] = corners(mesh, face);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let steps = ((to - from).truncate().length() / self.cell).ceil().max(1.0);
                for step in 0..steps as usize {
                    let point = from.lerp(to, step as f64 / steps);
                    add(self.cell_of(point.truncate()), point);
                }
            }
            self.cover([a, b, c], &mut add);
        }
        self.islands(&cells).iter().map(|island| building(&cells, island)).collect()
    }

    /// The connected groups of built cells, also across corners.
    fn islands(&self, cells: &[BuiltCell]) -> Vec<Vec<usize>> {
        let mut is_open: Vec<bool> = cells.iter().map(|cell| cell.lowest.is_finite()).collect();
        let mut islands = Vec::new();
        for first in 0..cells.len() {
            if !std::mem::take(&mut is_open[first]) {
                continue;
            }
            let (mut island, mut done) = (vec![first], 0);
            while let Some(&cell) = island.get(done) {
                done += 1;
                let (row, column) = (cell / self.columns, cell % self.columns);
                for row in row.saturating_sub(1)..=(row + 1).min(self.rows - 1) {
                    for column in column.saturating_sub(1)..=(column + 1).min(self.columns - 1) {
                        let next = row * self.columns + column;
                        if std::mem::take(&mut is_open[next]) {
                            island.push(next);
                        }
                    }
                }
            }
            islands.push(island);
        }
        islands
    }
}

/// How a building stands. Its foot consists of the cells that reach as low as any other, within `LEVEL_M`: eaves and
/// balconies are above it.
fn building(cells: &[BuiltCell], island: &[usize]) -> Building {
    let of_island = || island.iter().map(|&cell| &cells[cell]);
    let lowest = of_island().map(|cell| cell.lowest).fold(f64::INFINITY, f64::min);
    let highest = of_island().map(|cell| cell.highest).fold(f64::NEG_INFINITY, f64::max);
    let foot = of_island().filter(|cell| cell.lowest <= lowest + TOLD_M);
    Building {
        // the maximum ignores NaN
        floats_m: foot.map(|cell| cell.above).fold(0.0, f64::max),
        sinks_m: of_island().map(|cell| cell.below).fold(0.0, f64::max),
        // beyond the terrain's edge it may be visible
        is_buried: highest < 0.0 && of_island().all(|cell| !cell.above.is_nan()),
        is_beside: of_island().all(|cell| cell.above.is_nan()),
    }
}

fn corners(mesh: &Mesh, face: u32) -> [DVec3; 3] {
    mesh.corners(face as usize).map(|corner| mesh.origin + corner.as_dvec3())
}

fn is_at_home(mesh: &Mesh, face: u32) -> bool {
    mesh.faces[face as usize].iter().all(|&vertex| mesh.is_at_home(vertex))
}

/// The height of a face's plane at a point in plan, limited to the face's own heights.
fn on_plane([a, b, c]: [DVec3; 3], at: DVec2) -> f64 {
    let normal = (b - a).cross(c - a);
    let z = a.z - normal.xy().dot(at - a.xy()) / normal.z;
    z.max(a.z.min(b.z).min(c.z)).min(a.z.max(b.z).max(c.z))
}
