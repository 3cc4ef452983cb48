//! How many fragments the hybrid's mask saves the count, in scenes where a hundred volumes overlap.

use crate::shared::dense::{self, Dense};
use crate::shared::drawing::gpu;
use gnomon::mesh::Mesh;
use gnomon::shadow::hybrid::Hybrid;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::view::View;

fn scene(parts: Vec<gnomon::mesh::Part>) -> Scene {
    let mesh = Mesh::build(parts).unwrap();
    Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 }
}

/// Fragments a cell that reach the count, without a mask and behind one of a map of `map_size` texels a side.
fn overdraw(Dense { parts, camera, to_sun }: Dense, map_size: u32) -> [f64; 2] {
    let (scene, view) = (scene(parts), View::Camera(camera));
    let mut stencil = Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::Hierarchy).unwrap();
    let mut hybrid = Hybrid::new(gpu(), scene, view, ProcessorFinder::Hierarchy, map_size).unwrap();
    let all = stencil.counted(to_sun).unwrap().unwrap();
    let masked = hybrid.counted(to_sun).unwrap().unwrap();
    let reached: u64 = masked.reached.iter().map(|&fragments| u64::from(fragments)).sum();
    [all.all, reached].map(|fragments| fragments as f64 / f64::from(all.width * all.height))
}

#[test]
fn the_mask_keeps_four_fifths_away_where_volumes_are_dense() {
    // bars that stand closer than a coarse map can tell are left to the volumes
    for (pitch, sizes) in [(0.85, &[256, 512, 1024][..]), (0.4, &[1024, 2048])] {
        for &size in sizes {
            let [all, behind_mask] = overdraw(dense::cage(pitch), size);
            println!("bars {pitch} m apart, {size}²: {all:.1} fragments a cell, {behind_mask:.1} behind the mask");
            assert!(all > 50.0, "{all:.1} fragments a cell");
            assert!(behind_mask * 5.0 <= all, "{size}²: {behind_mask:.1} of {all:.1} fragments a cell");
        }
    }
}

#[test]
fn dense_scenes_are_closed() {
    for (least, dense) in [(1_000, dense::cage(0.4)), (30_000, dense::tree()), (40_000, dense::curved())] {
        let mesh = scene(dense.parts).casters;
        assert!(mesh.faces.len() >= least, "{} triangles", mesh.faces.len());
        let open = (0..mesh.edges.len()).filter(|&edge| mesh.faces_at(edge).len() != 2).count();
        assert_eq!(open, 0);
    }
}
