//! Lines of equal hours of shadow.

use super::base::Base;
use super::labels::{self, Labels, Spot};
use super::{LineDrawing, LineGroup, Scale, fill, group, length};
use crate::contour::Contour;
use crate::export::figure::scale::{Bands, NO_SHADOW, Rgb, mix};
use crate::export::figure::svg::{Block, LetterStyle};
use crate::export::figure::text::FontWeight;
use crate::export::figure::{self, FigureContext, plan, words};
use crate::export::{ExportError, check_size};
use crate::profile::Profile;
use crate::view::SurfaceRows;
use std::collections::{BTreeMap, BTreeSet};

/// The colours of the lines, and of their labels.
const LINE: Rgb = [172, 56, 22];
const LABEL: LetterStyle = LetterStyle { size: 27.0, weight: FontWeight::Bold, colour: LINE };
/// The width of a line, page pixels.
const WIDTH: f64 = 2.6;
/// How much lighter the bands are than the profile's, since lines and labels lie over them.
const LIGHTER: f64 = 0.5;
/// The length of line per label, the shortest line that gets a label, and the least distance between equal labels:
/// pixels.
const PART: f64 = 1300.0;
const SHORT: f64 = 130.0;
const APART: f64 = 240.0;

/// `hours`: the profile's bands, and a labelled line for each whole hour of shadow. If a band is wider than an hour, or
/// if the window has no whole hour, the lines are the limits of the bands.
///
/// A line separates cells with more shadow than its label says from those with at most as much. There are no lines
/// along walls.
///
/// # Errors
/// [`ExportError::Size`] if surface or profile do not fill the grid.
pub fn iso_hours<S: SurfaceRows>(scene: &FigureContext<S>, profile: &Profile) -> Result<LineDrawing, ExportError> {
    let grid = &profile.grid;
    check_size("profile", profile.shaded.len(), grid.width, grid.height)?;
    check_size("surface", scene.surface.cells(), grid.width, grid.height)?;
    let bands = Bands::new(scene.track.step_secs, profile.day_secs);
    let lighter = |colour| mix(colour, NO_SHADOW, LIGHTER);
    let base = Base::new(scene, grid);
    let value = |cell| profile.shaded.of(cell);
    let each = line_secs(&bands);
    let by_line = (1..).map(|line| line * each).take_while(|secs| *secs < profile.day_secs);
    let by_band = (0..bands.colours.len() as u32).map(|band| band * bands.band_secs);
    let thresholds: BTreeSet<u32> = by_line.clone().chain(by_band).collect();
    let of_secs = |secs| (secs, base.contours(&value, 255 * u64::from(secs)));
    let contours: BTreeMap<u32, Vec<Contour>> = thresholds.into_iter().map(of_secs).collect();

    let mut panel = figure::profile_panel(scene, profile, "Lines of equal shadow");
    for (colour, _) in panel.legend.iter_mut().filter(|(colour, _)| *colour != plan::ROOF_UNJUDGED) {
        *colour = lighter(*colour);
    }
    let is_drawn = |secs: &u32| contours[secs].iter().any(|contour| contour.drawn.contains(&true));
    let drawn: Vec<u32> = by_line.filter(is_drawn).collect();
    match drawn.as_slice() {
        [] => panel.facts.push(("Lines", format!("none: the shadow passes {} nowhere but at walls", said(each)))),
        [one] => panel.keys.push((LINE, format!("{} of shadow", said(*one)))),
        [.., last] => panel.keys.push((LINE, format!("each {} of shadow, to {}", said(each), said(*last)))),
    }
    let draw = |fit: figure::picture::Fit| {
        let scale = Scale::of(fit);
        let mut block = Block::default();
        group(&mut block, "bands", |block| {
            block.fill([0.0, 0.0, f64::from(fit.pixels.0), f64::from(fit.pixels.1)], lighter(NO_SHADOW));
            for (band, colour) in bands.colours.iter().enumerate() {
                let contours = &contours[&(band as u32 * bands.band_secs)];
                fill(block, &scale.areas(contours), lighter(*colour), 1.0);
            }
        });
        if scene.is_ground_alone() {
            base.fill(&mut block, scale, plan::ROOF_UNJUDGED);
        }
        let lines: Vec<(u32, LineGroup)> = drawn.iter().map(|secs| (*secs, scale.lines(&contours[secs]))).collect();
        group(&mut block, "iso-hours", |block| {
            for (secs, lines) in &lines {
                lines.draw(block, WIDTH, LINE, &said(*secs));
            }
        });
        base.draw(&mut block, scale, NO_SHADOW);
        let mut labels = Labels::new(fit.pixels, LABEL, APART);
        lines.iter().flat_map(|(_, lines)| lines.all()).for_each(|line| labels.avoid(line));
        base.footprints(scale).iter().for_each(|line| labels.avoid(line));
        for (secs, lines) in &lines {
            label(&mut labels, (&said(*secs), LINE), lines);
        }
        labels.draw(&mut block);
        block
    };
    Ok(LineDrawing::new(&panel, (grid.width, grid.height), grid.cell, draw))
}

/// Labels each line that is long enough with its hours, repeatedly. If no line is, one label stands beside the longest.
pub(super) fn label(labels: &mut Labels, (said, colour): (&str, Rgb), lines: &LineGroup) {
    /// The gap between a line and a label beside it, pixels.
    const BESIDE: f64 = 10.0;
    let half = labels.half(said);
    let mut is_placed = false;
    for line in &lines.large {
        let length = length(line);
        if length < SHORT {
            break;
        }
        let parts = (length / PART).ceil().max(1.0);
        for part in 0..parts as usize {
            let ends = [part as f64, part as f64 + 1.0].map(|at| at * length / parts);
            is_placed |= labels.place(said, colour, &mut labels::along(line, ends, 2.0 * half[0]));
        }
    }
    let longest = lines.all().max_by(|a, b| length(a).total_cmp(&length(b)));
    if let (false, Some(line)) = (is_placed, longest) {
        let beside = |[x, y]: &[f64; 2]| {
            let [right, down] = half.map(|half| half + BESIDE);
            [[*x, y - down], [*x, y + down], [x - right, *y], [x + right, *y]].map(|at| Spot {
                at,
                angle: 0.0,
                cost: 0.0,
            })
        };
        labels.place(said, colour, &mut line.iter().flat_map(beside).collect::<Vec<_>>());
    }
}

/// The step between lines, seconds.
fn line_secs(bands: &Bands) -> u32 {
    const HOUR: u32 = 3600;
    if bands.day_secs > HOUR { bands.band_secs.max(HOUR) } else { bands.band_secs }
}

/// `2 h`, `30 min`.
fn said(secs: u32) -> String {
    words::long_duration(secs)
}
