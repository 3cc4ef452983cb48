//! Lines of equal height of an envelope: how high may be built on a plot.

use super::hours::label;
use super::labels::Labels;
use super::{Line, LineDrawing, LineGroup, Scale, fill, group, group_within, paths, stroke};
use crate::contour::{Contour, ScalarField, contours};
use crate::export::check_size;
use crate::export::envelope::EnvelopeMap;
use crate::export::figure::panel::Panel;
use crate::export::figure::picture::Fit;
use crate::export::figure::scale::{Rgb, mix};
use crate::export::figure::svg::{ACCENT, Block, INK, LetterStyle};
use crate::export::figure::text::{self, FontWeight};
use crate::export::figure::{self, words};
use crate::export::{ExportError, report};
use crate::look::LOOK;
use crate::site::GroundKind;

/// The colours of the ground, of buildings, of the lowest and of the greatest height, of where no sun is in the way, and of
/// lines.
const GROUND: Rgb = LOOK.lines_ground;
const BUILDING: Rgb = [227, 223, 214];
const LOW: Rgb = [252, 233, 196];
const HIGH: Rgb = [96, 132, 172];
const FREE: Rgb = [206, 219, 196];
const LINE: Rgb = [58, 66, 84];
const LABEL: LetterStyle = LetterStyle { size: 27.0, weight: FontWeight::Bold, colour: LINE };
const WIDTH: f64 = 2.6;
const SIDE_WIDTH: f64 = 1.6;
const APART: f64 = 240.0;
/// Neighbouring cells whose heights differ by more steps than this have a steep side between them.
const STEEP_STEPS: u64 = 2;
/// The most lines; more could not be told apart.
const MOST_LINES: f64 = 16.0;

/// Where at least so much may be built, with the colour up to the next band.
struct HeightBand {
    from_mm: u64,
    tone: Rgb,
    contours: Vec<Contour>,
}

/// `envelope`: a labelled line for each whole step of height, on a plan of the plot.
///
/// # Errors
/// [`ExportError::Size`] where heights or buildings do not fill the grid.
pub fn heights(map: &EnvelopeMap) -> Result<LineDrawing, ExportError> {
    let grid = map.grid;
    check_size("heights", map.heights.len(), grid.width, grid.height)?;
    check_size("buildings", map.buildings.len(), grid.width, grid.height)?;
    let range = map.range().unwrap_or_default();
    let step_mm = step_mm(range);
    let first = (f64::from(range[0]) * 1000.0 / step_mm as f64).floor().max(0.0) as u64;
    let last = (f64::from(range[1]) * 1000.0 / step_mm as f64).ceil().max(0.0) as u64;
    let drawn = beyond_border(map);
    let is_plot = |cell: usize| drawn[cell].is_some();
    // a millimetre more than the height, so that what is as high as a line lies above it
    let value = |cell: usize| drawn[cell].map_or(0, |height| (f64::from(height).max(0.0) * 1000.0) as u64 + 1);
    // a steep side, on which many lines would lie, is a line of its own
    let is_steep = |one: usize, other: usize| value(one).abs_diff(value(other)) > STEEP_STEPS * step_mm;
    let open = |one: usize, other: usize| is_plot(one) && is_plot(other) && !is_steep(one, other);
    let field = ScalarField { width: grid.width, height: grid.height, value: &value, open: &open };
    let cap_mm = (f64::from(map.cap_m) * 1000.0) as u64;
    let steps = (first..last.max(first + 1)).map(|step| step * step_mm).filter(|from_mm| *from_mm < cap_mm);
    let mut bands: Vec<HeightBand> =
        steps.map(|from_mm| HeightBand { from_mm, tone: LOW, contours: contours(&field, from_mm) }).collect();
    let count = bands.len();
    bands.iter_mut().enumerate().for_each(|(at, band)| band.tone = tone(at, count));
    if range[1] >= map.cap_m {
        bands.push(HeightBand { from_mm: cap_mm, tone: FREE, contours: contours(&field, cap_mm) });
    }
    let draw = |fit: Fit| sheet(map, &bands, step_mm, fit);
    let panel = panel(map, &bands, (step_mm, cap_mm), range);
    Ok(LineDrawing::new(&panel, (grid.width, grid.height), grid.cell, draw))
}

/// The heights, and around the plot's cells a ring of cells with the height of a neighbour. The plot's own cells end up
/// to half a cell before its border; with the ring, which is cut off at the border, colours and lines reach it.
fn beyond_border(map: &EnvelopeMap) -> Vec<Option<f32>> {
    let (width, height) = (map.grid.width as usize, map.grid.height as usize);
    let near = |cell: usize| {
        let (x, y) = (cell % width, cell / width);
        // those at a side go before those at a corner
        const AROUND: [(isize, isize); 8] = [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)];
        AROUND.iter().find_map(|(right, down)| {
            let x = x.checked_add_signed(*right).filter(|x| *x < width)?;
            let y = y.checked_add_signed(*down).filter(|y| *y < height)?;
            map.height(y * width + x)
        })
    };
    (0..map.heights.len()).map(|cell| map.height(cell).or_else(|| near(cell))).collect()
}

/// From line to line, millimetres: a round length of which there are few enough.
fn step_mm([low, high]: [f32; 2]) -> u64 {
    const STEPS: [u64; 9] = [100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000];
    let all = f64::from(high - low) * 1000.0;
    STEPS.into_iter().find(|step| all / *step as f64 <= MOST_LINES).unwrap_or(100_000)
}

/// The colour of a band among so many.
fn tone(band: usize, count: usize) -> Rgb {
    mix(LOW, HIGH, if count > 1 { band as f64 / (count - 1) as f64 } else { 0.5 })
}

fn sheet(map: &EnvelopeMap, bands: &[HeightBand], step_mm: u64, fit: Fit) -> Block {
    let scale = Scale::of(fit);
    let mut block = Block::default();
    group(&mut block, "ground", |block| {
        block.fill([0.0, 0.0, f64::from(fit.pixels.0), f64::from(fit.pixels.1)], GROUND);
    });
    let value = |cell: usize| u64::from(map.buildings[cell]);
    let field = ScalarField { width: map.grid.width, height: map.grid.height, value: &value, open: &|_, _| true };
    let buildings = contours(&field, 0);
    // below the heights, whose colours say how high: what stands on the plot is an outline there
    group(&mut block, "buildings", |block| fill(block, &scale.areas(&buildings), BUILDING, 1.0));
    let on_page =
        |x: f64, y: f64| scale.point([(x - map.grid.west) / map.grid.cell, (map.grid.north - y) / map.grid.cell]);
    let border: Line = map.border.iter().chain(map.border.first()).map(|at| on_page(at.x, at.y)).collect();
    let outline = paths(std::slice::from_ref(&border));
    let within_plot =
        |block: &mut Block, name: &str, what: &dyn Fn(&mut Block)| group_within(block, name, &outline, what);
    within_plot(&mut block, "heights", &|block| {
        bands.iter().for_each(|band| fill(block, &scale.areas(&band.contours), band.tone, 1.0));
    });
    within_plot(&mut block, "sides", &|block| {
        for band in bands {
            stroke(block, &scale.areas(&band.contours), SIDE_WIDTH, LINE, "");
        }
    });
    group(&mut block, "outlines", |block| scale.lines(&buildings).draw(block, 2.0, INK, ""));
    let lines: Vec<(String, LineGroup)> =
        bands.iter().map(|band| (said(band.from_mm, step_mm), scale.lines(&band.contours))).collect();
    within_plot(&mut block, "lines", &|block| {
        lines.iter().for_each(|(said, lines)| lines.draw(block, WIDTH, LINE, said));
    });
    group(&mut block, "plot", |block| stroke(block, &outline, 6.0, ACCENT, "the plot"));
    group(&mut block, "points", |block| {
        // what lies beyond the sheet is only counted
        let is_shown = |point: &&glam::DVec3| {
            let grid = &map.grid;
            (grid.west..=grid.east()).contains(&point.x) && (grid.south()..=grid.north).contains(&point.y)
        };
        for point in map.points.iter().filter(is_shown) {
            let [x, y] = on_page(point.x, point.y);
            block.ring(x, y, 8.0, 4.0, INK);
        }
    });
    let mut labels = Labels::new(fit.pixels, LABEL, APART);
    lines.iter().flat_map(|(_, lines)| lines.all()).for_each(|line| labels.avoid(line));
    // a thick line, which no label should break
    (0..4).for_each(|_| labels.avoid(&border));
    for (said, lines) in &lines {
        label(&mut labels, (said, LINE), lines);
    }
    labels.draw(&mut block);
    block
}

fn panel(map: &EnvelopeMap, bands: &[HeightBand], (step_mm, cap_mm): (u64, u64), [low, high]: [f32; 2]) -> Panel {
    let place = map.place;
    let name = text::clean(&place.name);
    let mut facts = vec![("Keeps", map.kept.to_owned()), ("Days", map.days.to_owned())];
    if !name.is_empty() {
        facts.push(("Place", words::coordinates(place)));
    }
    facts.push(("Ground", words::ground(map.ground)));
    if map.ground.kind == GroundKind::Terrain {
        facts.push(("Measured", format!("from {}, the lowest terrain on the plot", words::metres(map.foot_m))));
    }
    facts.push(("Cells", figure::cells(map.grid.width, map.grid.height, map.grid.cell)));
    facts.push(("Points", map.points.len().to_string()));
    facts.push(("Heights", format!("{} to {}", words::metres(low.into()), words::metres(high.into()))));
    facts.push(("Below", format!("{} m³", figure::panel::thousands(map.volume_m3()))));
    facts.push(("Refraction", words::refraction(map.refraction, place)));
    let legend = bands.iter().map(|band| {
        let from = said(band.from_mm, step_mm);
        let to = said((band.from_mm + step_mm).min(cap_mm), step_mm);
        (
            band.tone,
            if band.from_mm == cap_mm { format!("{from}: no sun in the way") } else { format!("{from} to {to}") },
        )
    });
    let mut legend: Vec<(Rgb, String)> = legend.collect();
    legend.push((BUILDING, "buildings".to_owned()));
    Panel {
        kicker: "How high may be built".to_owned(),
        title: if name.is_empty() { words::coordinates(place) } else { name },
        lead: vec![format!("at most {} where no sun is in the way", words::metres(map.cap_m.into()))],
        facts,
        sun: Vec::new(),
        legend_head: format!("Metres above {}", map.foot_said()),
        legend,
        keys: [(LINE, "lines of equal height".to_owned()), (ACCENT, "the plot".to_owned())]
            .into_iter()
            .chain((!map.points.is_empty()).then(|| (INK, "points whose sun is kept (rings)".to_owned())))
            .collect(),
        tz: report::tz_version(place),
        north_up: true,
    }
}

/// `12 m`, `12.5 m`.
fn said(mm: u64, step_mm: u64) -> String {
    if step_mm < 1000 || !mm.is_multiple_of(1000) {
        format!("{:.1} m", mm as f64 / 1000.0)
    } else {
        format!("{} m", mm / 1000)
    }
}
