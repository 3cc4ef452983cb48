//! How the hybrid works, where it fails, and how it compares with its parents (figures 3-5 and 3-7 to 3-9 of E. Chan's
//! thesis).

use crate::dense::{self, Dense};
use crate::filters::{detail, yard};
use crate::picture::{Picture, RED, Rgb, mix};
use crate::sheet::{Panel, Row, Sheet};
use crate::stage::Stage;
use anyhow::{Context as _, Result};
use glam::{DVec3, dvec3};
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::shadow::Technique;

use gnomon::view::{Decider, FragmentCounts, Mask, View};
use std::sync::Arc;

/// The paper's colours.
fn colour_of(decided: &Decider) -> Rgb {
    match decided {
        Decider::MapShadow => [186, 52, 44],
        Decider::MapLight => [132, 166, 214],
        Decider::VolumeShadow => [0, 0, 0],
        Decider::VolumeLight => [88, 214, 74],
    }
}

fn colours() -> Vec<(Rgb, String)> {
    vec![
        (colour_of(&Decider::MapShadow), "map: shadow".into()),
        (colour_of(&Decider::MapLight), "map: light".into()),
        (colour_of(&Decider::VolumeShadow), "volumes: shadow".into()),
        (colour_of(&Decider::VolumeLight), "volumes: light".into()),
    ]
}

pub(crate) fn stage(gpu: &Arc<Gpu>, dense: Dense) -> Result<Stage> {
    Stage::new(gpu, dense.parts, View::Camera(dense.camera), dense.to_sun)
}

pub(crate) fn counted(stage: &Stage, technique: &mut dyn Technique) -> Result<FragmentCounts> {
    technique.counted(stage.to_sun)?.context("this technique counts")
}

fn decided(counted: &FragmentCounts) -> Result<Picture> {
    let decided = counted.decided.as_ref().context("the hybrid says what decided")?;
    Ok(Picture::of((counted.width, counted.height), decided, colour_of))
}

pub(crate) fn silhouette_share(counted: &FragmentCounts) -> f64 {
    let by_volumes = |decided: &&Decider| matches!(decided, Decider::VolumeShadow | Decider::VolumeLight);
    let decided = counted.decided.iter().flatten();
    decided.clone().filter(by_volumes).count() as f64 / decided.count().max(1) as f64
}

/// Figure 3-5.
pub(crate) fn mask(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let stage = yard(gpu)?;
    let part = detail(&stage);
    let panel = |picture: Picture, caption: [String; 2]| {
        let detail = picture.cropped(part).magnified(3);
        let whole = picture.framed(part, 5, RED).shrunk(4);
        [Panel { picture: whole, caption: vec![] }, Panel { picture: detail, caption: caption.into() }]
    };
    let by_map = stage.mask(&mut stage.map(256, Filter::None)?)?;
    let mut panels = vec![panel(stage.shaded(&by_map), ["Map alone, 256²".into(), "no filter".into()])];
    for size in [256, 1024] {
        let counted = counted(&stage, &mut stage.hybrid(size)?)?;
        let share = format!("{:.1}% of the cells count", 100.0 * silhouette_share(&counted));
        panels.push(panel(decided(&counted)?, [format!("Who decides, {size}²"), share]));
    }
    let hybrid = stage.mask(&mut stage.hybrid(256)?)?;
    panels.push(panel(stage.shaded(&hybrid), ["Hybrid, 256²".into(), "exact along edges".into()]));
    let (mut whole, mut detail) = (Row::default(), Row::default());
    for [above, below] in panels {
        whole.panels.push(above);
        detail.panels.push(below);
    }
    Ok(Sheet {
        title: "The hybrid’s mask".into(),
        note: "Where the four nearest texels of the map agree, the map decides; elsewhere volumes are counted.".into(),
        legend: colours(),
        rows: vec![whole, detail],
        ..Sheet::default()
    })
}

/// Figure 3-9.
pub(crate) fn overdraw(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let mut rows = Vec::new();
    for (head, dense) in [("Cage", dense::cage(0.4)), ("Tree", dense::tree())] {
        let stage = stage(gpu, dense)?;
        let seen = stage.shaded(&stage.mask(&mut stage.stencil()?)?).shrunk(3);
        let all = counted(&stage, &mut stage.stencil()?)?;
        let masked = counted(&stage, &mut stage.hybrid(1024)?)?;
        let layers = |counted: &FragmentCounts| {
            let picture = Picture::of((counted.width, counted.height), &counted.reached, |&layers| bright(layers));
            picture.shrunk(3)
        };
        let mean = |counted: &FragmentCounts| {
            let sum: u64 = counted.reached.iter().map(|&layers| u64::from(layers)).sum();
            sum as f64 / counted.reached.len() as f64
        };
        let share = format!("{:.1}% of the cells count", 100.0 * silhouette_share(&masked));
        let panel = |picture: Picture, caption: String| Panel { picture, caption: vec![caption] };
        rows.push(Row {
            head: head.into(),
            panels: vec![
                panel(seen, format!("{} triangles", stage.scene.casters.faces.len())),
                panel(layers(&all), format!("{:.1} layers a cell", mean(&all))),
                panel(layers(&masked), format!("{:.1} layers a cell", mean(&masked))),
                panel(decided(&masked)?.shrunk(3), share),
            ],
        });
    }
    let heads = ["What is seen", "Volumes", "Volumes behind the mask", "Who decides, map 1024²"];
    Ok(Sheet {
        title: "Walls and caps that reach the count".into(),
        note: "The brighter, the more layers of volumes are counted in a cell.".into(),
        legend: colours(),
        columns: heads.map(String::from).to_vec(),
        rows,
    })
}

/// 0 black, then the brighter the more; 250 and more white.
fn bright(layers: u32) -> Rgb {
    let share = (f64::from(layers) / 250.0).min(1.0).sqrt();
    let yellow = [255, 214, 64];
    if share < 0.7 { mix([16, 16, 20], yellow, share / 0.7) } else { mix(yellow, [255, 255, 255], (share - 0.7) / 0.3) }
}

/// In shadow where the truth sees the sun, and the other way round.
const FALSE_SHADOW: Rgb = [224, 30, 30];
const FALSE_LIGHT: Rgb = [16, 168, 62];

/// What differs from the truth, and how many cells of all that are.
fn marked(stage: &Stage, mask: &Mask, truth: &Mask) -> (Picture, String) {
    let mark = |(&share, &truth): (&u8, &u8)| match (share >= 128, truth >= 128) {
        (false, true) => Some(FALSE_SHADOW),
        (true, false) => Some(FALSE_LIGHT),
        _ => None,
    };
    let marks: Vec<Option<Rgb>> = mask.share.iter().zip(&truth.share).map(mark).collect();
    let wrong = marks.iter().flatten().count();
    let mut picture = stage.shaded(mask);
    for (pixel, mark) in picture.pixels.iter_mut().zip(marks) {
        *pixel = mark.unwrap_or(*pixel);
    }
    (picture, format!("{wrong} cells are wrong"))
}

/// The middle of the tree's shadow.
const SHADOW: DVec3 = dvec3(-6.3, 4.0, 0.0);

/// Figure 3-8.
pub(crate) fn artifacts(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let stage = stage(gpu, dense::tree())?;
    let part = stage.around(SHADOW, 190, 124);
    let truth = stage.mask(&mut stage.stencil()?)?;
    let mut rows = Vec::new();
    for head in ["Map", "Hybrid"] {
        let mut row = Row { head: head.into(), ..Row::default() };
        for size in [256, 512, 1024] {
            let mask = match head {
                "Map" => stage.mask(&mut stage.map(size, Filter::None)?)?,
                _ => stage.mask(&mut stage.hybrid(size)?)?,
            };
            let (picture, wrong) = marked(&stage, &mask, &truth);
            row.panels.push(Panel { picture: picture.cropped(part).magnified(2), caption: vec![wrong] });
        }
        let picture = stage.shaded(&truth).cropped(part).magnified(2);
        row.panels.push(Panel { picture, caption: vec![] });
        rows.push(row);
    }
    Ok(Sheet {
        title: "What a low resolution costs".into(),
        note: "The shadow of a tree, many of whose branches are thinner than a texel; of 1280 × 800 cells.".into(),
        legend: vec![(FALSE_SHADOW, "shadow that is not there".into()), (FALSE_LIGHT, "shadow that is missing".into())],
        columns: ["256²", "512²", "1024²", "Volumes"].map(String::from).to_vec(),
        rows,
    })
}

/// Figure 3-7.
pub(crate) fn beside(gpu: &Arc<Gpu>) -> Result<Sheet> {
    let mut rows = Vec::new();
    for (head, dense, middle) in [("Cage", dense::cage(0.4), dvec3(3.9, 1.2, 0.1)), ("Tree", dense::tree(), SHADOW)] {
        let stage = stage(gpu, dense)?;
        let detail = stage.around(middle, 142, 88);
        let (mut whole, mut below) = (Row { head: head.into(), ..Row::default() }, Row::default());
        let mut techniques: [Box<dyn Technique>; 3] = [
            Box::new(stage.map(1024, Filter::FastTwoByTwo)?),
            Box::new(stage.hybrid(1024)?),
            Box::new(stage.stencil()?),
        ];
        for (mask, millis) in stage.timed(&mut techniques)? {
            let picture = stage.shaded(&mask);
            let magnified = picture.cropped(detail).magnified(3);
            below.panels.push(Panel { picture: magnified, caption: vec![format!("{millis:.0} ms")] });
            let picture = picture.framed(detail, 4, RED).shrunk(3);
            whole.panels.push(Panel { picture, caption: vec![] });
        }
        rows.extend([whole, below]);
    }
    Ok(Sheet {
        title: "Map, hybrid and volumes".into(),
        note: "1280 × 800 cells, maps of 1024²; below, what is framed, three times as large.".into(),
        columns: ["Shadow map, fast PCF 2×2", "Hybrid", "Stencil shadow volumes"].map(String::from).to_vec(),
        rows,
        ..Sheet::default()
    })
}
