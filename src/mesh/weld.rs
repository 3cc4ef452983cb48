//! Corners that lie on each other become one vertex.

use super::Part;
use glam::{DVec3, I64Vec3, Vec3};
use rustc_hash::{FxBuildHasher, FxHashMap};

/// How far apart two corners may lie and still be one vertex, as a part of the component's size.
pub(super) const TOLERANCE: f64 = 1e-6;

/// Appends a part's vertices and faces to the mesh. Returns the triangles that collapsed, as two of their corners became
/// one, each as the line that is left.
pub(super) fn append(part: &Part, origin: DVec3, vertices: &mut Vec<Vec3>, faces: &mut Vec<[u32; 3]>) -> Vec<[u32; 2]> {
    let low = part.positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = part.positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = if low.x <= high.x { (high - low).length() } else { 0.0 };
    let mut welder = Welder::new((size * TOLERANCE) as f32, vertices, part.positions.len());
    let vertex_of: Vec<u32> =
        part.positions.iter().map(|&position| welder.vertex((position - origin).as_vec3())).collect();
    let mut collapsed = Vec::new();
    for triangle in &part.triangles {
        let face @ [a, b, c] = triangle.map(|corner| vertex_of[corner as usize]);
        if a == b || b == c || c == a {
            collapsed.push([a, if b == a { c } else { b }]);
        } else {
            faces.push(face);
        }
    }
    collapsed
}

/// Finds the vertex that lies on a point. Equal points are found by one look-up, which settles nearly all; the others
/// are sought in a grid whose cells are a few tolerances wide.
struct Welder<'a> {
    tolerance: f32,
    vertices: &'a mut Vec<Vec3>,
    /// The first of the part's own.
    first: usize,
    equal: FxHashMap<[u32; 3], u32>,
    /// A cell's last vertex, and for each vertex the one before it in its cell.
    near: FxHashMap<I64Vec3, u32>,
    before: Vec<u32>,
}

/// Before a cell's first vertex.
const NONE: u32 = u32::MAX;

impl<'a> Welder<'a> {
    fn new(tolerance: f32, vertices: &'a mut Vec<Vec3>, corners: usize) -> Self {
        Welder {
            tolerance,
            first: vertices.len(),
            vertices,
            equal: FxHashMap::with_capacity_and_hasher(corners, FxBuildHasher),
            near: FxHashMap::with_capacity_and_hasher(corners, FxBuildHasher),
            before: Vec::with_capacity(corners),
        }
    }

    fn vertex(&mut self, point: Vec3) -> u32 {
        let key = (point + Vec3::ZERO).to_array().map(f32::to_bits); // + 0 makes −0 and 0 one
        if let Some(&vertex) = self.equal.get(&key) {
            return vertex;
        }
        let vertex = self.nearby(point).unwrap_or_else(|| {
            let vertex = self.vertices.len() as u32;
            self.vertices.push(point);
            self.before.push(self.near.insert(self.cell(point), vertex).unwrap_or(NONE));
            vertex
        });
        self.equal.insert(key, vertex);
        vertex
    }

    fn nearby(&self, point: Vec3) -> Option<u32> {
        let (low, high) = (self.cell(point - self.tolerance), self.cell(point + self.tolerance));
        let cells = (low.x..=high.x)
            .flat_map(|x| (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| I64Vec3::new(x, y, z))));
        let before = |&vertex: &u32| Some(self.before[vertex as usize - self.first]).filter(|before| *before != NONE);
        cells
            .filter_map(|cell| self.near.get(&cell).copied())
            .flat_map(|last| std::iter::successors(Some(last), before))
            .find(|&vertex| self.vertices[vertex as usize].distance(point) <= self.tolerance)
    }

    fn cell(&self, point: Vec3) -> I64Vec3 {
        (point.as_dvec3() / f64::from(self.tolerance * 8.0).max(1e-9)).floor().as_i64vec3()
    }
}
