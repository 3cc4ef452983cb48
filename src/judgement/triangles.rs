//! Areas as triangles that cover them exactly.

use glam::{DVec2, DVec3};

/// A slab of a polygon that is thinner than this is left out, metres.
const THIN_M: f64 = 1e-9;

/// A triangle of an area.
#[derive(Clone, Copy, Debug)]
pub struct PartTriangle {
    /// Its corners; their z is 0 if the area lies on the ground.
    pub corners: [DVec3; 3],
    /// Its area, square metres.
    pub m2: f64,
    /// The upward normal, if it is a face of a component.
    pub normal: Option<DVec3>,
}

impl PartTriangle {
    fn new(corners: [DVec3; 3], is_face: bool) -> Option<PartTriangle> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let m2 = normal.length() / 2.0;
        let normal = if normal.z < 0.0 { -normal } else { normal };
        (m2 > 0.0).then(|| PartTriangle { corners, m2, normal: is_face.then(|| normal / (2.0 * m2)) })
    }
}

/// The triangles, at height 0, of what lies within an odd number of rings. They cover it exactly and do not overlap.
pub fn triangles(rings: &[Vec<DVec2>]) -> Vec<PartTriangle> {
    let sides: Vec<[DVec2; 2]> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|at| [ring[at], ring[(at + 1) % ring.len()]]))
        .map(|[a, b]| if a.y <= b.y { [a, b] } else { [b, a] })
        .collect();
    let mut levels: Vec<f64> = sides.iter().flatten().map(|corner| corner.y).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|one, other| (*one - *other).abs() < THIN_M);
    let mut found = Vec::new();
    for slab in levels.windows(2) {
        let [low, high] = [slab[0], slab[1]];
        let middle = (low + high) / 2.0;
        let mut crossing: Vec<[DVec2; 3]> = sides
            .iter()
            .filter(|[below, above]| below.y <= middle && middle < above.y)
            .map(|side| [low, middle, high].map(|y| on(side, y)))
            .collect();
        crossing.sort_by(|one, other| one[1].x.total_cmp(&other[1].x));
        for pair in crossing.chunks_exact(2) {
            let corners = [pair[0][0], pair[1][0], pair[1][2], pair[0][2]].map(|corner| corner.extend(0.0));
            let [a, b, c, d] = corners;
            found.extend([[a, b, c], [a, c, d]].into_iter().filter_map(|three| PartTriangle::new(three, false)));
        }
    }
    found
}

fn on([below, above]: &[DVec2; 2], y: f64) -> DVec2 {
    let part = ((y - below.y) / (above.y - below.y)).clamp(0.0, 1.0);
    DVec2::new(below.x + part * (above.x - below.x), y)
}

/// The triangles of a component's upper faces.
pub fn triangles_of_faces(faces: &[[DVec3; 3]]) -> Vec<PartTriangle> {
    faces.iter().filter_map(|corners| PartTriangle::new(*corners, true)).collect()
}
