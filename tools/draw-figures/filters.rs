//! The filters of the shadow map side by side (figure 7 of Brabec and Seidel).

use crate::picture::{Part, RED};
use crate::scenes;
use crate::sheet::{Panel, Row, Sheet};
use crate::stage::{Stage, camera};
use anyhow::Result;
use glam::{DVec3, dvec3};
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::shadow::Technique;

use std::sync::Arc;

/// The house from the yard, in the afternoon.
pub(crate) fn yard(gpu: &Arc<Gpu>) -> Result<Stage> {
    let view = camera(dvec3(9.5, -21.5, 9.0), dvec3(1.4, -1.5, 3.9), 36.0, (1488, 960));
    Stage::new(gpu, scenes::house(), view, afternoon())
}

/// The sun in the south-west.
pub(crate) fn afternoon() -> DVec3 {
    crate::dense::to_sun(222.0, 39.0)
}

/// Of the yard's picture, the shadow of the balcony's corner on the wall.
pub(crate) fn detail(stage: &Stage) -> Part {
    stage.around(dvec3(2.1, 0.0, 2.3), 124, 80)
}

pub(crate) fn filters(gpu: &Arc<Gpu>) -> Result<Sheet> {
    const FILTERS: [(Filter, &str, &str); 4] = [
        (Filter::None, "No filter", "2 levels"),
        (Filter::TwoByTwo, "PCF 2×2", "4 renders, 5 levels"),
        (Filter::FastTwoByTwo, "Fast PCF 2×2", "5 levels"),
        (Filter::FastFourByFour, "Fast PCF 4×4", "17 levels"),
    ];
    let stage = yard(gpu)?;
    let detail = detail(&stage);
    let mut rows = [Row::default(), Row::default()];
    let mut maps: Vec<Box<dyn Technique>> = Vec::new();
    for (filter, ..) in FILTERS {
        maps.push(Box::new(stage.map(512, filter)?));
    }
    for ((_, name, levels), (mask, millis)) in FILTERS.into_iter().zip(stage.timed(&mut maps)?) {
        let picture = stage.shaded(&mask);
        let whole = picture.clone().framed(detail, 5, RED).shrunk(4);
        rows[0].panels.push(Panel { picture: whole, caption: vec![] });
        let caption = vec![name.to_owned(), format!("{levels}, {millis:.0} ms")];
        rows[1].panels.push(Panel { picture: picture.cropped(detail).magnified(3), caption });
    }
    Ok(Sheet {
        title: "Shadow map: its filters".into(),
        note: "A map of 512 × 512; below, what is framed, three times as large.".into(),
        rows: rows.into(),
        ..Sheet::default()
    })
}
