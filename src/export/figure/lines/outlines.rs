//! The hourly diagram: the shadow at each instant as a line with its time.

use super::base::Base;
use super::labels::{Labels, Spot};
use super::{LineDrawing, LineGroup, Scale, distance, fill, group};
use crate::contour::Contour;
use crate::export::figure::panel::Panel;
use crate::export::figure::picture::Fit;
use crate::export::figure::scale::{Rgb, mix};
use crate::export::figure::svg::{Block, LetterStyle};
use crate::export::figure::text::FontWeight;
use crate::export::figure::{self, FigureContext, UNJUDGED, plan, words};
use crate::export::{ExportError, check_size};
use crate::look::LOOK;
use crate::sun::Instant;
use crate::view::{Bits, Grid, SurfaceRows};

/// The greatest number of outlines; more are hard to tell apart.
pub const MOST_OUTLINES: usize = 24;

/// The shadow at one instant.
#[derive(Clone, Debug)]
pub struct Outline {
    /// The index of the instant in the track, from 0.
    pub index: usize,
    /// Which cells are in shadow.
    pub shadow: Bits,
}

/// The colours from morning to evening.
const DAY: [Rgb; 5] = [[24, 74, 150], [14, 120, 128], [96, 96, 24], [190, 84, 16], [150, 24, 60]];
/// Ground and roofs; lighter than under a single shadow.
const GROUND: Rgb = LOOK.lines_ground;
const ROOF: Rgb = [231, 224, 210];
const SHADE: Rgb = [92, 106, 132];
/// The darkness of the shade where the shadows of all instants overlap.
const DARKEST: f64 = 0.55;
/// The width of a line, page pixels.
const WIDTH: f64 = 3.0;
const LABEL: LetterStyle = LetterStyle { size: 31.0, weight: FontWeight::Bold, colour: [0; 3] };
/// The most labels of one instant, the share of the longest shadow's length from which a shadow gets more than one
/// label, and the least distance between them in pixels.
const MOST_LABELS: usize = 3;
const NEARLY: f64 = 0.7;
const APART: f64 = 600.0;
/// The distance between the positions that are tried, and between a line and a label beside it, pixels.
const PITCH: f64 = 16.0;
const BESIDE: f64 = 12.0;

/// `outlines`: the border of the shadow at each instant, in the track's order, with its time.
///
/// A line separates cells in shadow from cells in the sun. There are no lines along walls.
///
/// # Errors
/// [`ExportError::Size`] if the surface or a shadow does not fill the grid; [`ExportError::Encode`] if the track has no
/// such instant.
pub fn outlines<S: SurfaceRows>(
    scene: &FigureContext<S>,
    grid: &Grid,
    outlines: &[Outline],
) -> Result<LineDrawing, ExportError> {
    check_size("surface", scene.surface.cells(), grid.width, grid.height)?;
    let base = Base::new(scene, grid);
    let count = outlines.len();
    let drawn = outlines.iter().enumerate();
    let drawn = drawn.map(|(at, outline)| DrawnOutline::new(scene, grid, &base, outline, colour(at, count)));
    let mut drawn = drawn.collect::<Result<Vec<_>, _>>()?;
    let panel = panel(scene, grid, &drawn);
    let is_judged = !scene.is_ground_alone();
    let draw = |fit: Fit| sheet(&base, &mut drawn, is_judged, fit);
    Ok(LineDrawing::new(&panel, (grid.width, grid.height), grid.cell, draw))
}

/// The panel beside the outlines.
fn panel<S>(scene: &FigureContext<S>, grid: &Grid, drawn: &[DrawnOutline]) -> Panel {
    let mut panel = figure::panel_of_instants(scene, "Shadow outlines");
    panel.facts.push(("Cells", figure::cells(grid.width, grid.height, grid.cell)));
    panel.legend_head = "The shadow’s outline at".to_owned();
    panel.keys.extend(drawn.iter().map(|drawn| (drawn.colour, drawn.time.clone())));
    panel.legend.push((mix(GROUND, SHADE, opacity(drawn.len())), "in shadow at one of these times".to_owned()));
    if drawn.len() > 1 {
        panel.legend.push((mix(GROUND, SHADE, DARKEST), "in shadow at all of them".to_owned()));
    }
    if scene.is_ground_alone() {
        panel.legend.push((plan::ROOF_UNJUDGED, UNJUDGED.to_owned()));
    }
    panel
}

/// The drawing itself: ground and roofs, the overlapping shadows, then the lines with their times on top.
fn sheet(base: &Base, drawn: &mut [DrawnOutline], is_judged: bool, fit: Fit) -> Block {
    let scale = Scale::of(fit);
    let once = opacity(drawn.len());
    let mut block = Block::default();
    group(&mut block, "ground", |block| {
        block.fill([0.0, 0.0, f64::from(fit.pixels.0), f64::from(fit.pixels.1)], GROUND);
    });
    if is_judged {
        base.fill(&mut block, scale, ROOF);
    }
    group(&mut block, "shadows", |block| {
        drawn.iter().for_each(|drawn| fill(block, &scale.areas(&drawn.contours), SHADE, once));
    });
    if !is_judged {
        base.fill(&mut block, scale, plan::ROOF_UNJUDGED);
    }
    base.draw(&mut block, scale, ROOF);
    let mut labels = Labels::new(fit.pixels, LABEL, APART);
    base.footprints(scale).iter().for_each(|line| labels.avoid(line));
    group(&mut block, "outlines", |block| {
        for DrawnOutline { time, colour, contours, lines, .. } in &mut *drawn {
            *lines = scale.lines(contours);
            lines.all().for_each(|line| labels.avoid(line));
            lines.draw(block, WIDTH, *colour, time);
        }
    });
    (0..drawn.len()).for_each(|at| label(&mut labels, drawn, at, scale));
    labels.draw(&mut block);
    block
}

struct DrawnOutline<'a> {
    instant: &'a Instant,
    time: String,
    colour: Rgb,
    contours: Vec<Contour>,
    /// The outline as lines, once the sheet is laid out.
    lines: LineGroup,
    shadow: &'a Bits,
}

impl<'a> DrawnOutline<'a> {
    fn new<S>(
        scene: &FigureContext<'a, S>,
        grid: &Grid,
        base: &Base,
        outline: &'a Outline,
        colour: Rgb,
    ) -> Result<DrawnOutline<'a>, ExportError> {
        let Outline { index, shadow } = outline;
        check_size("shadow", shadow.width as usize * shadow.height as usize, grid.width, grid.height)?;
        let instant = scene.track.instants.get(*index);
        let instant = instant.ok_or_else(|| ExportError::encode("outlines", "an instant is not of the track"))?;
        let contours = base.contours(&|cell| u64::from(shadow.contains(cell)), 0);
        let time = words::clock(&instant.time);
        Ok(DrawnOutline { instant, time, colour, contours, lines: LineGroup::default(), shadow })
    }
}

/// Labels each outline with its time where the shadow is longest, and a few more times along long shadows in open sun.
fn label(labels: &mut Labels, drawn: &[DrawnOutline], at: usize, scale: Scale) {
    let DrawnOutline { instant, time, colour, lines, shadow, .. } = &drawn[at];
    // rows count southwards
    let away = [-instant.to_sun.x, instant.to_sun.y];
    let length = away[0].hypot(away[1]).max(1e-9);
    let away = away.map(|part| part / length);
    let half = labels.half(time);
    let out = half[0] * away[0].abs() + half[1] * away[1].abs() + BESIDE;
    let along = |from: [f64; 2], step: f64| [0, 1].map(|axis| from[axis] + away[axis] * step);
    let is_shady = |at| cell(shadow, scale, at).is_none_or(|cell| drawn.iter().any(|it| it.shadow.contains(cell)));

    let (mut spots, mut long_ones) = (Vec::new(), Vec::new());
    let lines = if lines.large.is_empty() { &lines.small } else { &lines.large };
    for ends in lines.iter().flat_map(|line| line.windows(2)) {
        let steps = (distance(ends[0], ends[1]) / PITCH).ceil().max(1.0);
        for step in 0..=steps as usize {
            let share = step as f64 / steps;
            let at = [0, 1].map(|axis| ends[0][axis] + (ends[1][axis] - ends[0][axis]) * share);
            let short = -(at[0] * away[0] + at[1] * away[1]);
            spots.push(Spot { at, angle: 0.0, cost: short + 60.0 });
            let beyond = along(at, out);
            if is_shady(beyond) {
                spots.push(Spot { at: beyond, angle: 0.0, cost: short + 40.0 });
            } else {
                spots.push(Spot { at: beyond, angle: 0.0, cost: short });
                let back = (1..).map(|step| along(at, -scale.0[0] * f64::from(step)));
                let dark = |at: &[f64; 2]| cell(shadow, scale, *at).is_some_and(|cell| shadow.contains(cell));
                let long = back.take_while(dark).count() as f64 * scale.0[0];
                long_ones.push(Spot { at: beyond, angle: 0.0, cost: -long });
            }
        }
    }
    labels.place(time, *colour, &mut spots);
    let longest = long_ones.iter().map(|spot| -spot.cost).fold(0.0, f64::max);
    long_ones.retain(|spot| -spot.cost >= NEARLY * longest && labels.is_clear(time, spot));
    for _ in 1..MOST_LABELS {
        labels.place(time, *colour, &mut long_ones);
    }
}

/// The cell under a point of the picture.
fn cell(of: &Bits, scale: Scale, at: [f64; 2]) -> Option<usize> {
    let at = [0, 1].map(|axis| at[axis] / scale.0[axis]);
    let is_within = at.iter().zip([of.width, of.height]).all(|(at, count)| *at >= 0.0 && *at < f64::from(count));
    is_within.then(|| at[1] as usize * of.width as usize + at[0] as usize)
}

/// The opacity of a single shadow if `count` overlap.
fn opacity(count: usize) -> f64 {
    1.0 - (1.0 - DARKEST).powf(1.0 / count.max(1) as f64)
}

fn colour(at: usize, count: usize) -> Rgb {
    let share = if count > 1 { at as f64 / (count - 1) as f64 } else { 0.0 };
    let place = share * (DAY.len() - 1) as f64;
    let low = (place as usize).min(DAY.len() - 2);
    mix(DAY[low], DAY[low + 1], place - low as f64)
}
