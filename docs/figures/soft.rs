//! Soft edges: by a filtered map, by smoothies, and as they are (seed 000, figures 4-8 to 4-11).

use crate::filters::{afternoon, yard};
use crate::picture::{Part, Picture, RED, Rgb, mix};
use crate::scenes;
use crate::sheet::{PAPER, Panel, Row, Sheet};
use crate::stage::{DISC_POINTS, Stage, camera};
use anyhow::Result;
use glam::dvec3;
use gnomon::gpu::Gpu;
use gnomon::shadow::Technique;
use gnomon::shadow::shadow_map::Filter;
use gnomon::view::{Grid, Mask, View};
use std::sync::Arc;

/// The column's foot and its shadow.
const COLUMN: Part = [700, 560, 330, 300];

/// Figure 4-8: a row a size of map.
pub(crate) fn edges(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let stage = yard(gpu)?;
    let mut rows = Vec::new();
    for size in [256, 512, 1024] {
        let mut techniques: Vec<Box<dyn Technique>> =
            vec![Box::new(stage.map(size, Filter::None)?), Box::new(stage.map(size, Filter::FastFourByFour)?)];
        for width in [None, Some(0.15), Some(0.6)] {
            techniques.push(Box::new(stage.smoothie(size, width)?));
        }
        let mut row = Row { head: format!("{size}²"), ..Row::default() };
        for mut technique in techniques {
            let (mask, millis) = stage.timed(&mut *technique)?;
            let picture = stage.shaded(&mask).cropped(COLUMN);
            row.panels.push(Panel { picture, caption: vec![format!("{millis:.0} ms")] });
        }
        rows.push(row);
    }
    let heads = ["Map, 1 sample", "PCF, 16 samples", "Smoothie, the sun’s", "Smoothie, 0.15 m", "Smoothie, 0.6 m"];
    Ok(Sheet {
        title: "A shadow’s edge by technique and size of map".into(),
        note: "The foot of a column 3.2 m high and its shadow; the map holds all of a yard of 18 × 17 m.".into(),
        columns: heads.map(String::from).to_vec(),
        rows,
        ..Sheet::default()
    })
}

/// Darker than the truth, and lighter.
const DARKER: Rgb = [178, 24, 43];
const LIGHTER: Rgb = [33, 102, 172];

/// How much darker or lighter than the truth each cell is; all colour at a half.
fn difference(mask: &Mask, truth: &Mask) -> Picture {
    let pairs: Vec<(u8, u8)> = mask.share.iter().copied().zip(truth.share.iter().copied()).collect();
    Picture::of((mask.width, mask.height), &pairs, |&(share, truth)| {
        let by = (f64::from(share) - f64::from(truth)) / 128.0;
        mix(PAPER, if by < 0.0 { DARKER } else { LIGHTER }, by.abs().min(1.0))
    })
}

fn differences() -> Vec<(Rgb, String)> {
    vec![(DARKER, "darker than the truth by half the sun".into()), (LIGHTER, "lighter by as much".into())]
}

/// A row of smoothie, truth and how they differ; views have twice the panels' cells.
fn against_truth(stage: &Stage, map_size: u32, head: &str) -> Result<Row> {
    let mask = stage.mask(&mut stage.smoothie(map_size, None)?)?;
    let truth = stage.mask(&mut stage.rays(Some(DISC_POINTS)))?;
    let pictures = [stage.shaded(&mask), stage.shaded(&truth), difference(&mask, &truth)];
    let panels = pictures.map(|picture| Panel { picture: picture.shrunk(2), caption: vec![] });
    Ok(Row { head: head.into(), panels: panels.into() })
}

/// Figure 4-9.
pub(crate) fn beside_truth(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let size = (920, 640);
    let views = [
        ("Near", camera(dvec3(-0.2, -6.0, 4.6), dvec3(-2.6, 0.0, 2.2), 40.0, size)),
        ("Far", plan(dvec3(9.6, 9.5, 0.0), 0.005, size)),
    ];
    let mut rows = Vec::new();
    for (head, view) in views {
        rows.push(against_truth(&Stage::new(gpu, scenes::house(), view, afternoon())?, 2048, head)?);
    }
    Ok(Sheet {
        title: "Smoothies beside the sun’s disc".into(),
        note: "Near: a railing 1.7 m before its wall. Far: a chimney 9 m high, its shadow’s end seen from above."
            .into(),
        columns: ["Smoothie", "Ray casting, 256 points of the disc", "Difference"].map(String::from).to_vec(),
        legend: differences(),
        rows,
    })
}

/// A plan around a point.
fn plan(middle: glam::DVec3, cell: f64, (width, height): (u32, u32)) -> View {
    let west = middle.x - cell * f64::from(width) / 2.0;
    let north = middle.y + cell * f64::from(height) / 2.0;
    View::Plan(Grid { west, north, cell, width, height })
}

/// Figure 4-11.
pub(crate) fn overlap(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let size = (920, 640);
    let to_sun = crate::dense::to_sun(180.0, 52.0);
    let whole = camera(dvec3(7.0, -15.0, 9.0), dvec3(-0.5, 2.0, 3.6), 44.0, size);
    let stage = Stage::new(gpu, scenes::crossing(), whole, to_sun)?;
    let mask = stage.mask(&mut stage.rays(None))?;
    let overview = stage.shaded(&mask).framed([0, 0, 0, 0], 4, RED).shrunk(2);
    let view = plan(dvec3(-1.0, 3.6, 0.0), 0.005, size);
    let mut row = against_truth(&Stage::new(gpu, scenes::crossing(), view, to_sun)?, 2048, "")?;
    row.panels.insert(0, Panel { picture: overview, caption: vec![] });
    Ok(Sheet {
        title: "Penumbrae that overlap".into(),
        note: "A slit of 0.1 m between two plates 9 m above the ground, and two beams below it.".into(),
        columns: ["What stands there", "Smoothie", "256 points of the disc", "Difference"].map(String::from).to_vec(),
        legend: differences(),
        rows: vec![row],
    })
}
