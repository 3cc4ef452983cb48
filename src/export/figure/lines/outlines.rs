//! The hourly diagram: each instant's shadow as a line with its time.

use super::base::Base;
use super::labels::{self, Labels, Spot};
use super::{LineDrawing, Scale, distance, fill, group, paths, stroke};
use crate::export::figure::picture::Fit;
use crate::export::figure::scale::{Rgb, mix};
use crate::export::figure::svg::{Block, Style};
use crate::export::figure::text::Weight;
use crate::export::figure::{self, Scene, UNJUDGED, plan, words};
use crate::export::{ExportError, check_size};
use crate::profile::contour::Contour;
use crate::site::Receivers;
use crate::sun::Instant;
use crate::view::{Bits, Grid, SurfaceRows};

/// More are hard to tell apart.
pub const MOST_OUTLINES: usize = 24;

/// One instant's shadow.
#[derive(Clone, Debug)]
pub struct Outline {
    /// Which instant of the track, from 0.
    pub index: usize,
    /// Which cells are in shadow.
    pub shadow: Bits,
}

/// From morning to evening.
const DAY: [Rgb; 5] = [[24, 74, 150], [14, 120, 128], [96, 96, 24], [190, 84, 16], [150, 24, 60]];
/// Ground and roofs, lighter than under a single shadow.
const GROUND: Rgb = [251, 248, 240];
const ROOF: Rgb = [255, 255, 255];
const SHADE: Rgb = [92, 106, 132];
/// How dark the shade is where all instants lie over each other.
const DARKEST: f64 = 0.55;
const HALO: Rgb = [255, 255, 255];
/// Page pixels.
const WIDTH: f64 = 4.0;
const LABEL: Style = Style { size: 33.0, weight: Weight::Bold, colour: [0; 3] };
/// Shadows that are so much smaller than the instant's largest have no time of their own, and there are at most so many.
const SMALL: f64 = 0.25;
const MOST_LABELS: usize = 3;

/// `outlines`: the border of each instant's shadow, in the track's order, with its time.
///
/// A line parts cells in shadow from cells in the sun; along walls there is none.
///
/// # Errors
/// [`ExportError::Size`] where surface or a shadow do not fill the grid; [`ExportError::Encode`] where the track has no such
/// instant.
pub fn outlines<S: SurfaceRows>(
    scene: &Scene<S>,
    grid: &Grid,
    outlines: &[Outline],
) -> Result<LineDrawing, ExportError> {
    check_size("surface", scene.surface.cells(), grid.width, grid.height)?;
    let base = Base::new(scene, grid);
    let count = outlines.len();
    let mut drawn = Vec::new();
    for (at, Outline { index, shadow }) in outlines.iter().enumerate() {
        check_size("shadow", shadow.width as usize * shadow.height as usize, grid.width, grid.height)?;
        let instant = scene.track.instants.get(*index);
        let instant = instant.ok_or_else(|| ExportError::encode("outlines", "an instant is not of the track"))?;
        let contours = base.contours(&|cell| u64::from(shadow.contains(cell)), 0);
        let time = words::clock(&instant.time);
        drawn.push(Drawn { instant, time, colour: colour(at, count), contours });
    }

    let mut panel = figure::panel(scene, "Shadow outlines");
    panel.facts.push(("Cells", figure::cells(grid.width, grid.height, grid.cell)));
    panel.legend_head = "The shadow’s outline at".to_owned();
    panel.keys.extend(drawn.iter().map(|drawn| (drawn.colour, drawn.time.clone())));
    let once = opacity(count);
    panel.legend.push((mix(GROUND, SHADE, once), "in shadow at one of these times".to_owned()));
    if count > 1 {
        panel.legend.push((mix(GROUND, SHADE, DARKEST), "in shadow at all of them".to_owned()));
    }
    if scene.receivers == Receivers::Ground {
        panel.legend.push((plan::ROOF_UNJUDGED, UNJUDGED.to_owned()));
    }
    let draw = |fit: Fit| {
        let scale = Scale::of(fit);
        let mut block = Block::default();
        group(&mut block, "ground", |block| {
            block.fill([0.0, 0.0, f64::from(fit.pixels.0), f64::from(fit.pixels.1)], GROUND);
        });
        let is_judged = scene.receivers != Receivers::Ground;
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
        let mut labels = Labels::new(fit.pixels, LABEL);
        group(&mut block, "outlines", |block| {
            for Drawn { time, colour, contours, .. } in &drawn {
                let lines = scale.lines(contours);
                lines.iter().for_each(|line| labels.avoid(line));
                stroke(block, &paths(&lines), WIDTH, *colour, time);
            }
        });
        drawn.iter().for_each(|drawn| label(&mut labels, drawn, scale));
        labels.draw(&mut block, HALO);
        block
    };
    Ok(LineDrawing::new(&panel, (grid.width, grid.height), grid.cell, draw))
}

struct Drawn<'a> {
    instant: &'a Instant,
    time: String,
    colour: Rgb,
    contours: Vec<Contour>,
}

/// The time at the far ends of the largest shadows.
fn label(labels: &mut Labels, drawn: &Drawn, scale: Scale) {
    let Drawn { instant, time, colour, contours } = drawn;
    let mut shadows: Vec<&Contour> = contours.iter().filter(|shadow| shadow.area() > 0.0).collect();
    shadows.sort_by(|a, b| b.area().total_cmp(&a.area()));
    let least = SMALL * shadows.first().map_or(0.0, |shadow| shadow.area());
    // rows run southwards
    let away = [-instant.to_sun.x, instant.to_sun.y];
    let length = away[0].hypot(away[1]).max(1e-9);
    let away = away.map(|part| part / length);
    let mut placed = 0;
    for shadow in shadows {
        if placed > 0 && (shadow.area() < least || placed == MOST_LABELS) {
            break;
        }
        let lines = scale.lines(std::slice::from_ref(shadow));
        let spots: Vec<Spot> = lines.iter().flat_map(|line| spots(line, away, labels.half(time))).collect();
        placed += usize::from(labels.place(time, *colour, spots));
    }
}

/// Beyond a line's points and on them, better the farther away they lie.
fn spots(line: &[[f64; 2]], away: [f64; 2], half: [f64; 2]) -> Vec<Spot> {
    /// Between the line and the letters' edge, pixels.
    const BESIDE: f64 = 12.0;
    let reach = |at: &[f64; 2]| at[0] * away[0] + at[1] * away[1];
    let farthest = line.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
    let out = half[0] * away[0].abs() + half[1] * away[1].abs() + BESIDE;
    let mut spots = Vec::new();
    for ends in line.windows(2) {
        let steps = (distance(ends[0], ends[1]) / 20.0).ceil().max(1.0);
        for step in 0..=steps as usize {
            let share = step as f64 / steps;
            let at = [0, 1].map(|axis| ends[0][axis] + (ends[1][axis] - ends[0][axis]) * share);
            let short = farthest - reach(&at);
            let beyond = [0, 1].map(|axis| at[axis] + out * away[axis]);
            spots.push(Spot { at: beyond, angle: 0.0, cost: short * 0.5 });
            spots.push(Spot { at, angle: 0.0, cost: 60.0 + short * 0.5 });
        }
    }
    spots.extend(labels::along(line, [0.0, f64::INFINITY], 2.0 * half[0]).into_iter().map(|spot| {
        let short = farthest - reach(&spot.at);
        Spot { cost: spot.cost + 40.0 + short * 0.5, ..spot }
    }));
    spots
}

/// Of one of so many shadows that lie over each other.
fn opacity(count: usize) -> f64 {
    1.0 - (1.0 - DARKEST).powf(1.0 / count.max(1) as f64)
}

fn colour(at: usize, count: usize) -> Rgb {
    let share = if count > 1 { at as f64 / (count - 1) as f64 } else { 0.0 };
    let place = share * (DAY.len() - 1) as f64;
    let low = (place as usize).min(DAY.len() - 2);
    mix(DAY[low], DAY[low + 1], place - low as f64)
}
