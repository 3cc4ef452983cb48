//! The timers of the adapter's passes.

use crate::shared::drawing::{plan, scene_of, to_sun};
use crate::shared::scenes::cuboid;
use glam::dvec3;
use gnomon::choice::Receivers;
use gnomon::gpu::Gpu;
use gnomon::mesh::Mesh;
use gnomon::shadow::{Silhouettes, Technique, hybrid::Hybrid};
use std::sync::Arc;

#[test]
fn passes_are_timed_when_asked_and_only_then() {
    // an adapter of its own: the other tests' passes are not to be timed
    let gpu = Arc::new(Gpu::open().unwrap());
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-5.2, -4.1, 0.0), dvec3(4.3, 6.4, 14.2))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Top, 0.0);
    let mut hybrid = Hybrid::new(Arc::clone(&gpu), scene, plan(40.0, 400), Silhouettes::OnGpu, 256).unwrap();
    hybrid.draw(to_sun(140.0, 30.0)).unwrap();
    assert!(gpu.pass_times().unwrap().is_empty(), "nobody asked");
    gpu.time_passes().unwrap();
    for _ in 0..2 {
        hybrid.draw(to_sun(140.0, 30.0)).unwrap();
        let times = gpu.pass_times().unwrap();
        let labels: Vec<&str> = times.iter().map(|(label, _)| label.as_str()).collect();
        assert_eq!(labels, ["map", "faces", "extraction", "hybrid"]);
        assert!(times.iter().all(|(_, millis)| (0.0..1e4).contains(millis)), "{times:?}");
        assert!(times[3].1 > 0.0, "{times:?}");
        println!("{times:?}");
    }
}
