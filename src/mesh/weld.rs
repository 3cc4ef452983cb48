//! Welds coincident corners into one vertex.

use super::Part;
use super::together::{CornerGroup, CornerGroups};
use glam::{DVec3, UVec3, Vec3};
use rustc_hash::FxHashMap;

/// The distance within which two corners are one vertex, as a share of the size of what stands together: eight to
/// sixteen steps of `f32` at its ends.
const TOLERANCE: f64 = 1e-6;
/// The upper limit of that distance, metres: receivers are judged this far above themselves, and models have no smaller
/// details.
const MOST_M: f64 = 0.001;

/// The lower limit, in steps of `f32` at the largest coordinate: files round by one step either way on each axis.
const LEAST_STEPS: f64 = 2.0;

/// The distance within which corners are one vertex, for a component of this size that stands together, with no
/// coordinate larger than `reach`; metres.
pub(super) fn tolerance(size: f64, reach: f64) -> f64 {
    let reach = reach as f32;
    let step = f64::from(reach.next_up() - reach);
    (size * TOLERANCE).max(LEAST_STEPS * step).min(MOST_M)
}

/// A welded part. Its vertex indices start at 0.
pub(super) struct WeldedPart {
    pub(super) vertices: Vec<Vec3>,
    pub(super) faces: Vec<[u32; 3]>,
    /// The triangles that collapsed because two of their corners were joined, each as the remaining line.
    pub(super) collapsed: Vec<[u32; 2]>,
    /// The number of those whose three corners were distinct in the file.
    pub(super) flattened: usize,
}

/// Welds a part relative to the origin. Groups that are far from each other are welded separately.
pub(super) fn weld(part: &Part, origin: DVec3, together: &CornerGroups) -> WeldedPart {
    let local = |position: DVec3| (position - origin).as_vec3();
    let welder = |group: &CornerGroup| {
        Welder::new(local(group.low), tolerance(group.size(), group.reach()) as f32, group.corners)
    };
    let (groups, group_of) = together.in_part(part);
    let mut welders: Vec<Welder> = groups.iter().map(welder).collect();
    let mut vertex_of: Vec<u32> = match &group_of {
        None => welders.first_mut().map_or(Vec::new(), |welder| {
            part.positions.iter().map(|&position| welder.vertex(local(position))).collect()
        }),
        Some(group_of) => {
            let corners = part.positions.iter().zip(group_of);
            corners.map(|(&position, &group)| welders[group as usize].vertex(local(position))).collect()
        }
    };
    let mut vertices = Vec::new();
    if let Some(group_of) = group_of {
        let mut first = Vec::new();
        for welder in welders {
            first.push(vertices.len() as u32);
            vertices.extend(welder.vertices);
        }
        vertex_of.iter_mut().zip(group_of).for_each(|(vertex, group)| *vertex += first[group as usize]);
    } else if let Some(welder) = welders.pop() {
        vertices = welder.vertices;
    }
    let mut welded =
        WeldedPart { vertices, faces: Vec::with_capacity(part.triangles.len()), collapsed: Vec::new(), flattened: 0 };
    for triangle in &part.triangles {
        let face @ [a, b, c] = triangle.map(|corner| vertex_of[corner as usize]);
        if a == b || b == c || c == a {
            welded.collapsed.push([a, if b == a { c } else { b }]);
            let [a, b, c] = triangle.map(|corner| part.positions[corner as usize]);
            welded.flattened += usize::from(a != b && b != c && c != a);
        } else {
            welded.faces.push(face);
        }
    }
    welded
}

/// Finds the vertex at a point, in a grid whose cells are a few tolerances wide. Cells share the buckets of a hash
/// table: an unsuccessful search costs a look at the bucket's last vertex.
struct Welder {
    tolerance: f32,
    /// The grid's lower corner, and the number of cells per metre.
    low: Vec3,
    cells_a_metre: f32,
    vertices: Vec<Vec3>,
    /// Each bucket's last vertex, and for each vertex the one before it in its bucket.
    last: Vec<u32>,
    before: Vec<u32>,
    /// Points that were joined to another vertex; an equal point is joined to the same one.
    welded: FxHashMap<[u32; 3], u32>,
}

/// Marks the end of a bucket's list.
const NONE: u32 = u32::MAX;
/// The width of a cell in tolerances: small enough that few distinct vertices share one.
const CELL: f32 = 16.0;

impl Welder {
    fn new(low: Vec3, tolerance: f32, corners: usize) -> Self {
        Welder {
            tolerance,
            low,
            cells_a_metre: 1.0 / (tolerance * CELL).max(1e-9),
            vertices: Vec::with_capacity(corners),
            last: vec![NONE; (2 * corners).next_power_of_two()],
            before: Vec::with_capacity(corners),
            welded: FxHashMap::default(),
        }
    }

    fn vertex(&mut self, point: Vec3) -> u32 {
        let cells = [self.cell(point - self.tolerance), self.cell(point + self.tolerance)];
        // most points are not near their cell's border
        let is_within = cells[0] == cells[1];
        let bucket = self.bucket(if is_within { cells[0] } else { self.cell(point) });
        if let Some(equal) = self.in_bucket(bucket).find(|&vertex| self.vertices[vertex as usize] == point) {
            return equal;
        }
        let key = (point + Vec3::ZERO).to_array().map(f32::to_bits); // + 0 makes −0 and 0 one
        if let Some(&vertex) = self.welded.get(&key) {
            return vertex;
        }
        let near = match is_within {
            true => self.nearby(point, bucket),
            false => self.in_any(point, cells),
        };
        if let Some(vertex) = near {
            self.welded.insert(key, vertex);
            return vertex;
        }
        let vertex = self.vertices.len() as u32;
        self.vertices.push(point);
        self.before.push(std::mem::replace(&mut self.last[bucket], vertex));
        vertex
    }

    /// A vertex near a point in any cell of a range.
    fn in_any(&self, point: Vec3, [low, high]: [UVec3; 2]) -> Option<u32> {
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    let near = self.nearby(point, self.bucket(UVec3::new(x, y, z)));
                    if near.is_some() {
                        return near;
                    }
                }
            }
        }
        None
    }

    /// A vertex of a bucket near a point.
    fn nearby(&self, point: Vec3, bucket: usize) -> Option<u32> {
        self.in_bucket(bucket).find(|&vertex| self.vertices[vertex as usize].distance(point) <= self.tolerance)
    }

    /// The vertices of a bucket, the last one first.
    fn in_bucket(&self, bucket: usize) -> impl Iterator<Item = u32> {
        let is_one = |vertex: &u32| *vertex != NONE;
        let last = Some(self.last[bucket]).filter(is_one);
        std::iter::successors(last, move |&vertex| Some(self.before[vertex as usize]).filter(is_one))
    }

    fn cell(&self, point: Vec3) -> UVec3 {
        ((point - self.low) * self.cells_a_metre).as_uvec3()
    }

    fn bucket(&self, cell: UVec3) -> usize {
        // a part is some ten thousand cells wide
        let key = u64::from(cell.x) ^ u64::from(cell.y) << 21 ^ u64::from(cell.z) << 42;
        // D. Knuth, The Art of Computer Programming 3, 1973, section 6.4: 2⁶⁴ over the golden ratio
        (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize & (self.last.len() - 1)
    }
}
