//! Reads the output of the adapter's extraction as silhouettes. Shared by the tests and `try-models`.

use glam::DVec4;
use gnomon::mesh::Mesh;
use gnomon::silhouette::DirectedEdge;

/// The edges of walls, whose triangles must stand in the order that the stencil's shader needs: from the vertex nearer
/// to the sun on, or from their edge to the one point in which they end.
pub(crate) fn edges_of(mesh: &Mesh, indices: &[u32], light: DVec4, to_infinity: bool) -> Vec<DirectedEdge> {
    let end = |index: u32| index % 2 == 1;
    let edge_of = |wall: &[u32]| {
        if to_infinity {
            assert_eq!([end(wall[0]), end(wall[1]), end(wall[2])], [false, true, false]);
            return [wall[0] / 2, wall[2] / 2];
        }
        let [sunward, a, b, again, b_again, c] = *wall else { panic!("a wall of {} indices", wall.len()) };
        assert_eq!((sunward, b), (again, b_again));
        assert_eq!([end(sunward), end(a), end(b), end(c)], [false, end(a), true, !end(a)]);
        let (ends, other) = if end(a) { ([sunward, b], c) } else { ([b, sunward], a) };
        assert_eq!((a / 2, c / 2), if end(a) { (sunward / 2, b / 2) } else { (b / 2, sunward / 2) });
        let along = mesh.vertices[other as usize / 2] - mesh.vertices[sunward as usize / 2];
        let away = along.truncate().dot(light.as_vec4().truncate().truncate());
        assert!(away <= 1e-4 * along.length() * light.as_vec4().length(), "the first vertex is the nearer to the sun");
        ends.map(|index| index / 2)
    };
    indices.chunks(if to_infinity { 3 } else { 6 }).map(edge_of).collect()
}

/// The bits that say which faces of the cap were turned.
pub(crate) fn facing_of(mesh: &Mesh, cap: &[u32]) -> Vec<bool> {
    assert_eq!(cap.len(), mesh.faces.len() * 3);
    let facing = |(&[a, b, c], turned): (&[u32; 3], &[u32])| {
        let is_as_wound = turned == [a * 2, b * 2, c * 2];
        assert!(is_as_wound || turned == [a * 2, c * 2, b * 2], "a face of the cap is none of the mesh");
        is_as_wound
    };
    mesh.faces.iter().zip(cap.chunks(3)).map(facing).collect()
}

/// Whether a face is so nearly edge-on that the adapter may decide it either way.
pub(crate) fn near_edge_on(mesh: &Mesh, face: usize, light: DVec4) -> bool {
    let plane = mesh.planes()[face];
    plane.dot(light).abs() <= 1e-6 * plane.length() * light.length()
}
