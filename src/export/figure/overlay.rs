//! Draws volumes and silhouette over a finished picture: translucent yellow, and black lines above it.

use super::picture::{CellBorder, CellSpan, PagePicture, spans};
use super::scale::{Rgb, mix};
use crate::look::LOOK;
use crate::view::Overlay;
use rayon::prelude::*;

/// The opacity of this many layers.
fn opacity(layers: u8) -> f64 {
    (1.0 - (1.0 - LOOK.layer).powi(i32::from(layers))).min(LOOK.most_layers)
}

/// For the legend: the colour of sunny ground behind two volumes, which have two walls each.
pub(super) fn volume_tone(ground: Rgb) -> Rgb {
    mix(ground, LOOK.volume, opacity(4))
}

/// Draws the overlay over the picture, averaged by area.
pub(super) fn lay(picture: &mut PagePicture, overlay: &Overlay) {
    let opacities: [f32; 256] = std::array::from_fn(|layers| opacity(layers as u8) as f32);
    let (width, height) = (picture.width as usize, picture.height as usize);
    let columns = spans(overlay.width as usize, width, CellBorder::Sharp);
    let rows = spans(overlay.height as usize, height, CellBorder::Sharp);
    let average = |values: &Option<Vec<u8>>, columns: &CellSpan, rows: &CellSpan, worth: &dyn Fn(u8) -> f32| {
        let Some(values) = values else { return 0.0 };
        let (mut sum, mut total) = (0.0, 0.0);
        for row in rows.cells.clone() {
            for column in columns.cells.clone() {
                let weight = rows.weight(row) * columns.weight(column);
                sum += weight * worth(values[row * overlay.width as usize + column]);
                total += weight;
            }
        }
        f64::from(sum / total)
    };
    picture.pixels.par_chunks_mut(width).zip(&rows).for_each(|(line, rows)| {
        for (pixel, columns) in line.iter_mut().zip(&columns) {
            let yellow = average(&overlay.layers, columns, rows, &|layers| opacities[usize::from(layers)]);
            let black = average(&overlay.silhouette, columns, rows, &|cover| f32::from(cover) / 255.0);
            *pixel = mix(mix(*pixel, LOOK.volume, yellow), LOOK.silhouette, black);
        }
    });
}
