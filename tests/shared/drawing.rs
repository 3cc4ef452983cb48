//! What tests need for drawing: the adapter, small plans, suns.

pub(crate) use super::dense::to_sun;
use super::scenes::{cuboid, sheet};
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::gpu::Gpu;
use gnomon::mesh::Mesh;
use gnomon::shadow::Scene;
use gnomon::view::{Grid, View};
use std::sync::{Arc, OnceLock};

/// The adapter for all tests. Without one, tests fail; they are never skipped.
pub(crate) fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(Gpu::open().expect("the tests need a graphics adapter: run tests/run.sh"))))
}

pub(crate) fn scene_of(mesh: &Mesh, receivers: Receivers, ground: f64) -> Scene {
    let none = vec![false; mesh.components.len()];
    let receivers = match receivers {
        Receivers::Top | Receivers::Patches => mesh.clone(),
        Receivers::Ground => mesh.of_components(&none),
    };
    Scene { casters: mesh.clone(), receivers, ground }
}

pub(crate) fn plan(half: f64, cells: u32) -> View {
    View::Plan(Grid { west: -half, north: half, cell: 2.0 * half / f64::from(cells), width: cells, height: cells })
}

pub(crate) fn day() -> Vec<DVec3> {
    [(95.3, 3.1), (130.7, 24.4), (171.2, 51.9), (214.6, 38.8), (263.1, 9.7)].map(|(az, alt)| to_sun(az, alt)).to_vec()
}

/// A tower, a slab on edge and an open sheet, whose shadows cross.
pub(crate) fn crossing() -> Scene {
    let roof = [dvec3(8.0, -2.0, 5.0), dvec3(14.0, -2.0, 6.0), dvec3(14.0, 4.0, 6.0), dvec3(8.0, 4.0, 5.0)];
    let mesh = Mesh::build(vec![
        cuboid("tower", dvec3(-6.0, -6.0, 0.0), dvec3(6.0, 6.0, 30.0)),
        cuboid("slab", dvec3(-14.0, -1.0, 0.0), dvec3(-13.5, 8.0, 9.0)),
        sheet(roof),
    ]);
    scene_of(&mesh.unwrap(), Receivers::Top, 0.0)
}
