//! Soft edges: by a filtered map, by smoothies, and the true ones (figures 4-8 to 4-11 of E. Chan's thesis).

use crate::filters::afternoon;
use crate::picture::{Picture, RED, Rgb, mix};
use crate::scenes;
use crate::sheet::{Panel, Row, Sheet};
use crate::stage::{DISC_POINTS, Stage, camera, plan};
use anyhow::Result;
use glam::dvec3;
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::shadow::Technique;

use gnomon::view::{Mask, View};
use std::sync::Arc;

/// Figure 4-8: a row a size of map.
pub(crate) fn edges(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let yard = plan(dvec3(3.0, 3.5, 0.0), 0.0125, (2080, 2000));
    let stage = Stage::new(gpu, scenes::house(), View::Plan(yard), afternoon())?;
    // the chimney's shadow ends here
    let end = dvec3(13.4, 9.9, 0.0);
    let part = stage.around(end, 300, 250);
    let small = Stage::new(gpu, scenes::house(), View::Plan(plan(end, 0.0125, (300, 250))), afternoon())?;
    let truth = small.shaded(&small.mask(&mut small.rays(Some(DISC_POINTS)))?);
    let mut rows = Vec::new();
    for size in [256, 512, 1024] {
        let mut techniques: [Box<dyn Technique>; 4] = [
            Box::new(stage.map(size, Filter::None)?),
            Box::new(stage.map(size, Filter::FastFourByFour)?),
            Box::new(stage.smoothie(size, Some(0.05))?),
            Box::new(stage.smoothie(size, None)?),
        ];
        let mut row = Row { head: format!("{size}²"), ..Row::default() };
        for (mask, millis) in stage.timed(&mut techniques)? {
            let picture = stage.shaded(&mask).cropped(part);
            row.panels.push(Panel { picture, caption: vec![format!("{millis:.0} ms")] });
        }
        row.panels.push(Panel { picture: truth.clone(), caption: vec![] });
        rows.push(row);
    }
    let heads =
        ["Map, 1 sample", "PCF, 16 samples", "Smoothie, 0.05 m", "Smoothie, the sun’s", "256 points of the disc"];
    Ok(Sheet {
        title: "A shadow’s edge by technique and size of map".into(),
        note: "Where the shadow of a chimney 10.5 m high ends, 3.75 m of a plan of 26 × 25 m that one map holds."
            .into(),
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
        mix([255; 3], if by < 0.0 { DARKER } else { LIGHTER }, by.abs().min(1.0))
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
        ("Near", camera(dvec3(3.6, -4.4, 2.6), dvec3(2.15, 0.0, 2.1), 30.0, size)),
        ("Far", View::Plan(plan(dvec3(13.2, 9.7, 0.0), 0.005, size))),
    ];
    let mut rows = Vec::new();
    for (head, view) in views {
        rows.push(against_truth(&Stage::new(gpu, scenes::house(), view, afternoon())?, 2048, head)?);
    }
    Ok(Sheet {
        title: "Smoothies beside the sun’s disc".into(),
        note: "Near: a railing, up to 1.7 m before its wall. Far: where the shadow of a chimney 10.5 m high ends."
            .into(),
        columns: ["Smoothie", "256 points of the disc", "Difference"].map(String::from).to_vec(),
        legend: differences(),
        rows,
    })
}

/// Figure 4-10.
pub(crate) fn remap(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let to_sun = crate::dense::to_sun(172.0, 50.0);
    let whole = camera(dvec3(-14.0, -14.0, 9.5), dvec3(0.0, -0.6, 2.9), 38.0, (920, 640));
    let grid = plan(dvec3(-1.47, 0.0, 0.0), 0.001, (920, 640));
    let over = Stage::new(gpu, scenes::two_plates(), whole, to_sun)?;
    let mask = over.mask(&mut over.rays(None))?;
    let mut panels = vec![over.shaded(&mask).framed(over.part_of(&grid), 4, RED)];
    let stage = Stage::new(gpu, scenes::two_plates(), View::Plan(grid), to_sun)?;
    for linear in [true, false] {
        let mut smoothie = stage.smoothie(2048, None)?;
        smoothie.force_linear(linear);
        panels.push(stage.shaded(&stage.mask(&mut smoothie)?));
    }
    panels.push(stage.shaded(&stage.mask(&mut stage.rays(Some(DISC_POINTS)))?));
    let panels = panels.into_iter().map(|picture| Panel { picture: picture.shrunk(2), caption: vec![] }).collect();
    Ok(Sheet {
        title: "One edge over two receivers".into(),
        note: "The upper plate’s shadow falls on the lower one 1.6 m below it, and on the ground 6 m below it.".into(),
        columns: ["What stands there", "Alpha as drawn", "Alpha remapped", "256 points of the disc"]
            .map(String::from)
            .to_vec(),
        rows: vec![Row { head: String::new(), panels }],
        ..Sheet::default()
    })
}

/// Figure 4-11.
pub(crate) fn overlap(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let size = (920, 640);
    let to_sun = crate::dense::to_sun(180.0, 52.0);
    let whole = camera(dvec3(12.0, -7.0, 11.0), dvec3(0.0, 4.0, 4.3), 39.0, size);
    let grid = plan(dvec3(0.0, 8.2, 0.0), 0.002, size);
    let stage = Stage::new(gpu, scenes::crossing(), whole, to_sun)?;
    let mask = stage.mask(&mut stage.rays(None))?;
    let overview = stage.shaded(&mask).framed(stage.part_of(&grid), 4, RED).shrunk(2);
    let view = View::Plan(grid);
    let mut row = against_truth(&Stage::new(gpu, scenes::crossing(), view, to_sun)?, 2048, "")?;
    row.panels.insert(0, Panel { picture: overview, caption: vec![] });
    Ok(Sheet {
        title: "Penumbrae that overlap".into(),
        note: "A slit of 0.12 m between two plates 9 m above the ground, and poles of 0.14 m below it; 1.8 m of the ground.".into(),
        columns: ["What stands there", "Smoothie", "256 points of the disc", "Difference"].map(String::from).to_vec(),
        legend: differences(),
        rows: vec![row],
    })
}
