//! The atlas as rasters. The space between and around texels takes the values of their neighbours, so that no picture
//! shows an edge where the centre of a texel lies just beside its faces.

use super::PatchContext;
use crate::export::figure::scale::{Bands, NO_SUN, Rgb};
use crate::mesh::patches::{GUTTER, Patch, Patches};
use crate::sunlight::PatchHours;
use glam::DVec3;
use std::collections::VecDeque;

/// The hours of sun for drawing: the patch of each face, and the value of each texel.
pub struct Atlas {
    /// The patch of each face of the components that receive.
    pub patch_of: Vec<Option<u32>>,
    /// For each page, row by row, seconds in the sun times samples, as in [`PatchHours::lit`], or [`EMPTY`].
    pub(crate) pages: Vec<Vec<u32>>,
}

impl Atlas {
    /// Makes the atlas.
    pub fn of(found: &PatchContext) -> Atlas {
        let patches = found.patches;
        let mut patch_of = vec![None; found.mesh.faces.len()];
        for (number, patch) in patches.list.iter().enumerate() {
            for &face in &patches.faces[patch.faces.start as usize..patch.faces.end as usize] {
                patch_of[face as usize] = Some(number as u32);
            }
        }
        let received = found.mesh.components.iter().zip(found.receives).filter(|(_, receives)| **receives);
        let faces = received.flat_map(|(component, _)| component.faces.clone());
        let patch_of = faces.map(|face| patch_of[face as usize]).collect();
        Atlas { patch_of, pages: pages(patches, found.hours) }
    }

    /// The patch of a face, if the judged side of the face looks in the direction `facing`.
    pub fn patch<'a>(&self, patches: &'a Patches, face: u32, facing: DVec3) -> Option<&'a Patch> {
        let number = self.patch_of.get(face as usize).copied().flatten()?;
        let patch = &patches.list[number as usize];
        (patch.two_sided || patch.normal().dot(facing) > 0.0).then_some(patch)
    }

    /// The value of the texel of a patch that contains a point; the point is relative to [`Patches::origin`].
    pub fn lit(&self, patches: &Patches, patch: &Patch, point: DVec3) -> u32 {
        let place = patches.in_page(patch, point);
        // the centre of a pixel may lie slightly beside the face that it sees
        let [low, high] = [[patch.x, patch.y], [patch.x + patch.width - 1, patch.y + patch.height - 1]];
        let within = |axis: usize| (place[axis] as u32).clamp(low[axis], high[axis]) as usize;
        self.pages[patch.page as usize][within(1) * patches.page_size as usize + within(0)]
    }

    /// The pages in the drawing's colours.
    pub fn colours(&self, bands: &Bands, samples: u32) -> Vec<Vec<Rgb>> {
        let colour = |lit: &u32| if *lit == EMPTY { NO_SUN } else { bands.of_sun(*lit, samples) };
        self.pages.iter().map(|page| page.iter().map(colour).collect()).collect()
    }
}

/// A texel of a page that belongs to no patch.
pub(crate) const EMPTY: u32 = u32::MAX;

/// For each page, row by row, seconds in the sun times samples, as in [`PatchHours::lit`], or [`EMPTY`].
pub(crate) fn pages(patches: &Patches, hours: &PatchHours) -> Vec<Vec<u32>> {
    let side = patches.page_size as usize;
    let mut pages = vec![vec![EMPTY; side * side]; patches.pages as usize];
    for patch in &patches.list {
        let page = &mut pages[patch.page as usize];
        let mut spreading = VecDeque::new();
        for texel in patch.texels.start as usize..patch.texels.end as usize {
            let place = patches.texels[texel];
            let at = (patch.y as usize + usize::from(place.row)) * side + patch.x as usize + usize::from(place.column);
            page[at] = hours.lit[texel];
            spreading.push_back(at);
        }
        spread(patch, page, side, spreading);
    }
    pages
}

/// Gives each empty texel in the rectangle of a patch and in its gutter the value of the nearest texel, counted in
/// steps.
fn spread(patch: &Patch, page: &mut [u32], side: usize, mut spreading: VecDeque<usize>) {
    let (left, right) = ((patch.x - GUTTER) as usize, (patch.x + patch.width + GUTTER) as usize);
    let (top, bottom) = ((patch.y - GUTTER) as usize, (patch.y + patch.height + GUTTER) as usize);
    while let Some(at) = spreading.pop_front() {
        let (column, row) = (at % side, at / side);
        let neighbours = [
            (column > left).then(|| at - 1),
            (column + 1 < right).then(|| at + 1),
            (row > top).then(|| at - side),
            (row + 1 < bottom).then(|| at + side),
        ];
        for neighbour in neighbours.into_iter().flatten() {
            if page[neighbour] == EMPTY {
                page[neighbour] = page[at];
                spreading.push_back(neighbour);
            }
        }
    }
}
