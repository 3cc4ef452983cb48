//! The atlas as rasters: what texels came to, and between and around them what their neighbours did, so that no picture
//! shows an edge where a texel's centre lies just beside its faces.

use crate::mesh::patches::{GUTTER, Patch, Patches};
use crate::profile::surfaces::SurfaceHours;
use std::collections::VecDeque;

/// A texel of a page that belongs to no patch.
pub(crate) const EMPTY: u32 = u32::MAX;

/// Per page, row by row, seconds in the sun times samples, as [`SurfaceHours::lit`], or [`EMPTY`].
pub(crate) fn pages(patches: &Patches, hours: &SurfaceHours) -> Vec<Vec<u32>> {
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

/// Gives what is empty within a patch's rectangle and its gutter the value of the texel that is the fewest steps away.
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
