//! Cells that a shadow map gets wrong far from any shadow edge: acne, and light between a shadow and its caster. Shared
//! by the tests and the benchmark of the bias.

use glam::DVec3;
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::{Scene, ShadowError, Technique};
use gnomon::verification::Edges;
use gnomon::view::{Mask, View};
use std::sync::Arc;

/// Cells on the wrong side of half the sun that lie further from a shadow's edge than two texels, of all cells.
#[derive(Debug, Default)]
pub(crate) struct FarWrong {
    pub(crate) cells: usize,
    pub(crate) lighter: usize,
    pub(crate) darker: usize,
}

impl FarWrong {
    pub(crate) fn share(&self) -> f64 {
        (self.lighter + self.darker) as f64 / self.cells as f64
    }

    /// Adds those of a mask whose texels have this size in cells.
    pub(crate) fn add(&mut self, drawn: &Mask, truth: &Mask, texel_cells: f64) {
        let edges = Edges::of(truth);
        self.cells += truth.share.len();
        for (at, (&share, &right)) in drawn.share.iter().zip(&truth.share).enumerate() {
            let is_far = || {
                let (column, row) = (at as u32 % truth.width, at as u32 / truth.width);
                edges.distance(column, row).is_none_or(|distance| distance > 2.0 * texel_cells)
            };
            if (share > 127) != (right > 127) && is_far() {
                *(if share > right { &mut self.lighter } else { &mut self.darker }) += 1;
            }
        }
    }
}

/// A map of the plan for some suns, with its default bias or another. The size of texels is measured across the rays,
/// without their stretching on the ground by a low sun.
pub(crate) fn far_wrong(
    gpu: &Arc<Gpu>,
    scene: &Scene,
    view: View,
    suns: &[DVec3],
    (size, filter): (u32, Filter),
    bias: Option<f32>,
) -> Result<FarWrong, ShadowError> {
    let View::Plan(grid) = view else { return Ok(FarWrong::default()) };
    let mut map = match bias {
        None => ShadowMap::new(Arc::clone(gpu), scene, view, size, filter)?,
        Some(bias) => ShadowMap::with_bias(Arc::clone(gpu), scene, view, size, filter, bias)?,
    };
    let mut truth = RayCast::new(scene.clone(), view, None);
    let mut sum = FarWrong::default();
    for &sun in suns {
        let [across, along] = map.texel_m(sun);
        let texel_cells = f64::from(across.max(along)) / grid.cell;
        sum.add(&map.draw(sun)?.read()?, &truth.draw(sun)?.read()?, texel_cells);
    }
    Ok(sum)
}
