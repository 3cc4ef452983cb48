//! Packs the patches into the pages of the atlas, in shelves, the highest first.

use super::frame::PatchFrame;
use super::{GUTTER, MOST_PAGE, Patches};

/// The cell size for which the atlas has at most `most` texels and every patch fits in a page, and the side of a page.
/// Each patch has at least one texel, so with more patches than `most` there are more texels.
pub(super) fn fitting_cell(frames: &[PatchFrame], asked: f64, most: usize) -> (f64, u32) {
    let mut cell = asked;
    loop {
        let (mut total, mut longest) = (0.0, 1);
        for frame in frames {
            let [width, height] = frame.texels(cell);
            total += f64::from(width + 2 * GUTTER) * f64::from(height + 2 * GUTTER);
            longest = longest.max(width).max(height);
        }
        let too_long = f64::from(longest) / f64::from(MOST_PAGE - 2 * GUTTER);
        let over = (total / most as f64).max(too_long * too_long);
        if over <= 1.0 || longest == 1 {
            // shelves waste some of a page
            let side = ((total * 1.1).sqrt() as u32).max(longest + 2 * GUTTER).next_power_of_two();
            return (cell, side.clamp(64, MOST_PAGE));
        }
        cell *= over.sqrt().max(1.01);
    }
}

/// Sets the position of every patch.
pub(super) fn place(patches: &mut Patches) {
    let side = patches.page_size;
    let mut highest_first: Vec<u32> = (0..patches.list.len() as u32).collect();
    highest_first.sort_by_key(|&at| {
        let patch = &patches.list[at as usize];
        (std::cmp::Reverse(patch.height), std::cmp::Reverse(patch.width), at)
    });
    let (mut page, mut x, mut y, mut shelf) = (0, 0, 0, 0);
    for at in highest_first {
        let patch = &mut patches.list[at as usize];
        let (width, height) = (patch.width + 2 * GUTTER, patch.height + 2 * GUTTER);
        if x + width > side {
            (x, y, shelf) = (0, y + shelf, 0);
        }
        if y + height > side {
            (page, x, y, shelf) = (page + 1, 0, 0, 0);
        }
        (patch.page, patch.x, patch.y) = (page, x + GUTTER, y + GUTTER);
        x += width;
        shelf = shelf.max(height);
        patches.pages = page + 1;
    }
}
