//! Small meshes of each kind: clean, open, crowded, nested, touching.

pub(crate) use super::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::mesh::Part;

/// Several parts as one component.
pub(crate) fn joined(parts: Vec<Part>) -> Part {
    let mut whole = Part::default();
    for part in parts {
        let base = whole.positions.len() as u32;
        whole.name = part.name;
        whole.positions.extend(part.positions);
        whole.triangles.extend(part.triangles.iter().map(|triangle| triangle.map(|corner| corner + base)));
    }
    whole
}

/// A page from an edge at (x, y), standing up: an open sheet.
pub(crate) fn sheet(corners: [DVec3; 4]) -> Part {
    Part { name: "sheet".into(), positions: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Part::default() }
}

/// Horizontal plates above each other, as closed slabs or, where they have no thickness, as single sheets.
pub(crate) fn stack(plates: u32, thickness: f64) -> Part {
    let plate = |index: u32| {
        let z = 1.0 + 0.01 * f64::from(index);
        let (low, high) = (dvec3(-4.0, -4.0, z), dvec3(4.0, 4.0, z + thickness));
        if thickness > 0.0 {
            return cuboid("stack", low, high);
        }
        sheet([low, dvec3(high.x, low.y, z), high, dvec3(low.x, high.y, z)])
    };
    joined((0..plates).map(plate).collect())
}

/// Named scenes, each a list of components.
pub(crate) fn small() -> Vec<(&'static str, Vec<Part>)> {
    let book = {
        let spine = [dvec3(1.3, 0.2, 0.5), dvec3(1.3, 0.2, 12.5)];
        let page = |x: f64, y: f64| sheet([spine[0], dvec3(x, y, 0.5), dvec3(x, y, 12.5), spine[1]]);
        joined(vec![page(9.1, 3.2), page(-7.7, 6.3), page(-2.1, -8.9)])
    };
    let mut half_flipped = cuboid("flipped", dvec3(-6.3, -5.1, 0.0), dvec3(5.2, 4.4, 9.3));
    half_flipped.triangles.iter_mut().step_by(3).for_each(|triangle| triangle.swap(1, 2));
    let mut doubled = cuboid("doubled", dvec3(-6.3, -5.1, 2.0), dvec3(5.2, 4.4, 9.3));
    let again = doubled.triangles[2..7].to_vec();
    doubled.triangles.extend(again);
    vec![
        ("box", vec![cuboid("box", dvec3(-5.2, -4.1, 0.0), dvec3(4.3, 6.4, 14.2))]),
        (
            "open plate",
            vec![sheet([dvec3(-7.1, -5.3, 6.0), dvec3(6.2, -6.4, 7.0), dvec3(8.3, 5.1, 9.0), dvec3(-5.4, 7.2, 8.0)])],
        ),
        ("book of three pages", vec![book]),
        (
            "nested",
            vec![
                cuboid("outer", dvec3(-9.3, -8.2, 0.0), dvec3(8.1, 9.4, 12.0)),
                cuboid("inner", dvec3(-4.3, -3.2, 1.0), dvec3(3.1, 4.4, 18.0)),
            ],
        ),
        (
            "touching",
            vec![joined(vec![
                cuboid("touching", dvec3(-9.0, -5.0, 0.0), dvec3(0.0, 5.0, 8.0)),
                cuboid("touching", dvec3(0.0, -5.0, 0.0), dvec3(9.0, 5.0, 14.0)),
                cuboid("touching", dvec3(-9.0, -5.0, 8.0), dvec3(0.0, 5.0, 11.0)),
            ])],
        ),
        ("half flipped", vec![half_flipped]),
        ("doubled faces", vec![doubled]),
        ("through the ground", vec![cuboid("cellar", dvec3(-5.2, -4.1, -7.0), dvec3(4.3, 6.4, 5.2))]),
    ]
}
