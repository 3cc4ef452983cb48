//! Overdraw and silhouette cells of several scenes, as bars (figure 3-10 of E. Chan's thesis).

use crate::dense;
use crate::hybrid::{counted, silhouette_share, stage};
use crate::picture::{Picture, Rgb};
use crate::sheet::{GRAY, INK, PAPER, Panel, Row, Sheet, drawn_over, rectangle, text_element};
use crate::stage::Stage;
use anyhow::Result;
use gnomon::gpu::Gpu;
use gnomon::shadow::Scene;
use gnomon::site::{Overrides, Site};
use gnomon::view::{Camera, View};
use std::path::Path;
use std::sync::Arc;

const MAPS: [(u32, Rgb); 3] = [(256, [224, 164, 88]), (512, [190, 82, 44]), (1024, [58, 103, 155])];

pub(crate) fn bars(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let mut stages = Vec::new();
    for name in ["tower", "industry", "headquarters"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides::default())?;
        let casters = site.mesh.of_components(&site.casts);
        let scene = Scene { casters, receivers: site.mesh.of_components(&site.receives), ground: site.ground.level };
        let view = View::Camera(Camera { width: 1280, height: 800, ..site.camera });
        let instants: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).collect();
        stages.push((name, Stage::of(gpu, scene, view, instants[instants.len() / 2].to_sun)?));
    }
    stages.push(("cage", stage(gpu, dense::cage(0.4))?));
    stages.push(("tree", stage(gpu, dense::tree())?));
    stages.push(("ring", stage(gpu, dense::curved())?));

    let (left, right, bar, group) = (190.0, 1230.0, 26.0, 142.0);
    let mut svg = String::new();
    for share in [0, 20, 40, 60, 80, 100] {
        let x = left + (right - left) * f64::from(share) / 100.0;
        svg += &rectangle([x - 0.5, 34.0, 1.0, group * stages.len() as f64], [226, 222, 213]);
        svg += &text_element([x, 24.0], 22.0, 400, "middle", GRAY, &format!("{share}%"));
    }
    for (index, (name, stage)) in stages.iter().enumerate() {
        let top = 44.0 + group * index as f64;
        svg += &text_element([left - 14.0, top + 66.0], 26.0, 700, "end", INK, name);
        let all = counted(stage, &mut stage.stencil()?)?;
        let covered = all.reached.iter().filter(|&&layers| layers > 0).count() as f64 / all.reached.len() as f64;
        let layers = format!(
            "{:.0}% of the cells, {:.1} layers a cell",
            100.0 * covered,
            all.all as f64 / all.reached.len() as f64
        );
        let mut shares = vec![(covered, INK, layers)];
        for (size, colour) in MAPS {
            let masked = counted(stage, &mut stage.hybrid(size)?)?;
            let reached: u64 = masked.reached.iter().map(|&layers| u64::from(layers)).sum();
            let text = format!(
                "{:.1}% of the cells, {:.2} layers",
                100.0 * silhouette_share(&masked),
                reached as f64 / masked.reached.len() as f64
            );
            shares.push((silhouette_share(&masked), colour, text));
        }
        for (row, (share, colour, text)) in shares.into_iter().enumerate() {
            let y = top + (bar + 4.0) * row as f64;
            let width = ((right - left) * share).max(2.0);
            svg += &rectangle([left, y, width, bar], colour);
            let inside = share > 0.7;
            let (x, anchor) = if inside { (left + width - 10.0, "end") } else { (left + width + 10.0, "start") };
            svg += &text_element([x, y + 20.5], 22.0, 400, anchor, if inside { PAPER } else { INK }, &text);
        }
    }
    let page = Picture::filled(1270, 50 + (group * stages.len() as f64) as u32, PAPER);
    let mut legend = vec![(INK, "cells that volumes cover".to_owned())];
    legend.extend(MAPS.map(|(size, colour)| (colour, format!("that count, map {size}²"))));
    Ok(Sheet {
        title: "Overdraw of volumes, and how few cells count in the hybrid".into(),
        note: "Pictures of 1280 × 800 cells. Layers: walls and caps that reach the count, a cell of the picture."
            .into(),
        legend,
        rows: vec![Row {
            head: String::new(),
            panels: vec![Panel { picture: drawn_over(page, &svg)?, caption: vec![] }],
        }],
        ..Sheet::default()
    })
}
