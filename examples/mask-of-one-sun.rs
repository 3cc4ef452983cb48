//! Which cells of a plan are in shadow for one direction of the sun, by a given technique.

use gnomon::glam::dvec3;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::sun::Position;
use gnomon::view::{Grid, View};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let positions = vec![dvec3(0.0, 0.0, 0.0), dvec3(10.0, 0.0, 0.0), dvec3(10.0, 0.0, 6.0), dvec3(0.0, 0.0, 6.0)];
    let wall = Part { name: "wall".to_owned(), positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Part::default() };
    let mesh = Mesh::build(vec![wall])?;
    let scene = Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 };
    let grid = Grid { west: -10.0, north: 15.0, cell: 0.5, width: 60, height: 40 };

    // Made once for a scene and a view, it draws one sun after another.
    let mut technique = RayCast::new(scene, View::Plan(grid), None);
    let to_sun = Position { azimuth_deg: 180.0, altitude_deg: 45.0 }.to_sun();
    let mask = technique.draw(to_sun)?.read()?;

    // At 45° a shadow is as long as its caster is high: 10 m by 6 m, in cells of half a metre.
    let dark = mask.share.iter().filter(|&&share| share == 0).count();
    println!("{} m² in shadow", dark as f64 * grid.cell * grid.cell);
    assert_eq!(dark, 20 * 12);
    Ok(())
}
