//! The strip chart: when probes are in the sun. The local time of day runs across, the days run down.

mod axes;
mod colours;
pub(super) mod labels;

use super::page::{self, PAPER};
use super::picture::{CellBorder, Fit, PagePicture, compose};
use super::scale::{Rgb, mix};
use super::svg::{ACCENT, Block, GRAY, INK, LetterStyle, TextAnchor};
use super::text;
use crate::export::ExportError;
use crate::export::probe::{clock, counted, lies};
use crate::message::{Field, Words, message};
use crate::site::{Ground, metres};
use crate::sun::{Day, Place, Zone};
use crate::sunlight::{Interval, ProbeIntervals, SunDay, Sunlight};
use axes::{HourAxis, Tick, ticks};
use chrono::{DateTime, NaiveDate};
use colours::{NIGHT, OUTSIDE, SHADE, SUN};

/// The strength of a grid line.
const GRID: f64 = 0.16;

/// The margins around the strips: days at the left, hours above and below.
const LEFT: f64 = 150.0;
const HOURS: f64 = 64.0;
const RIGHT: f64 = 24.0;
/// The height of the line of text above a strip, and the gap between strips.
const HEAD: f64 = 58.0;
const GAP: f64 = 62.0;
/// The least height of a strip, and the greatest height of a strip with a single day.
const LOWEST: f64 = 60.0;
const HIGHEST: f64 = 300.0;

/// The drawing of `gnomon probe`: a strip for each probe. If not all of them fit, the drawing says, in the interface's
/// `words`, where the others are.
///
/// # Errors
/// [`ExportError::Encode`] if the page cannot be drawn or encoded.
pub fn strips(sunlight: &Sunlight, place: &Place, ground: &Ground, words: &dyn Words) -> Result<Vec<u8>, ExportError> {
    let hours = HourAxis::of(&sunlight.days);
    let left = if sunlight.days.len() > 1 { LEFT } else { RIGHT };
    page::chart(&labels::panel(sunlight, place, ground), [left, HOURS, RIGHT, HOURS], |pixels| {
        draw(sunlight, &hours, pixels, words)
    })
}

/// The positions of the strips.
struct Strips {
    width: u32,
    height: u32,
    count: usize,
}

impl Strips {
    /// Strips as high as the space allows. If there are too many probes, only the first ones get strips.
    fn within(sunlight: &Sunlight, (width, height): (u32, u32)) -> Strips {
        let room = f64::from(height) + GAP;
        let most = (room / (HEAD + GAP + LOWEST)) as usize;
        let count = sunlight.probes.len().min(most);
        let highest = if sunlight.days.len() > 1 { f64::INFINITY } else { HIGHEST };
        let each = (room / count as f64 - HEAD - GAP).min(highest);
        Strips { width, height: each as u32, count }
    }

    /// A strip's upper edge.
    fn top(&self, strip: usize) -> u32 {
        HEAD as u32 + strip as u32 * (self.height + (HEAD + GAP) as u32)
    }
}

fn draw(sunlight: &Sunlight, hours: &HourAxis, pixels: (u32, u32), words: &dyn Words) -> (PagePicture, Block) {
    let strips = Strips::within(sunlight, pixels);
    let width = strips.width as usize;
    let mut picture = PagePicture { width: pixels.0, height: pixels.1, pixels: vec![PAPER; width * pixels.1 as usize] };
    let mut over = Block::default();
    let days: Vec<NaiveDate> = sunlight.days.iter().map(|day| day.window.day.date).collect();
    let row = f64::from(strips.height) / days.len() as f64;
    let ticks = if days.len() > 1 { ticks(&days, row) } else { Vec::new() };
    for (index, probed) in sunlight.probes.iter().take(strips.count).enumerate() {
        let top = strips.top(index);
        let strip = strip(sunlight, probed, hours, &ticks, &strips);
        let at = top as usize * width;
        picture.pixels[at..at + strip.len()].copy_from_slice(&strip);
        let mut lines = Block::default();
        head(&mut lines, sunlight, probed, f64::from(strips.width));
        curves(&mut lines, sunlight, hours, &strips);
        for tick in &ticks {
            let y = if tick.within { (tick.row as f64 + 0.5) * row + 11.0 } else { tick.row as f64 * row + 30.0 };
            lines.text(-18.0, y, TextAnchor::End, LetterStyle::LABEL, &tick.label);
        }
        if let ([day], [intervals]) = (sunlight.days.as_slice(), probed.days.as_slice()) {
            label(&mut lines, sunlight, (day, intervals), hours, &strips);
        }
        lines.frame([0.0, 0.0, f64::from(strips.width), f64::from(strips.height)], 3.0, GRAY);
        over.place(0.0, f64::from(top), &lines);
    }
    let bottom = f64::from(strips.top(strips.count.max(1) - 1) + strips.height);
    for hour in hours.first..=hours.last {
        let x = hours.at(hour * 3600) * f64::from(strips.width);
        let said = format!("{:02}:00", hour % 24);
        over.text(x, -14.0, TextAnchor::Middle, LetterStyle::LABEL, &said);
        over.text(x, bottom + 44.0, TextAnchor::Middle, LetterStyle::LABEL, &said);
    }
    if let ([probed], [_]) = (sunlight.probes.as_slice(), days.as_slice())
        && probed.longest().is_some()
    {
        let top = bottom + 150.0;
        let intervals: Vec<Interval> = probed.days.concat();
        over.place(0.0, top, &labels::intervals(sunlight, &intervals, f64::from(pixels.1) + HOURS - top));
    }
    if strips.count < sunlight.probes.len() {
        let more = format!("and {} more probes", sunlight.probes.len() - strips.count);
        let more = message![more; Field::Csv, " and ", Field::Json, " have all"].in_words(words);
        over.text(f64::from(strips.width), bottom + 84.0, TextAnchor::End, LetterStyle::LABEL, &more);
    }
    (picture, over)
}

/// The pixels of a strip: one row per day, with the lines of hours and dates.
fn strip(sunlight: &Sunlight, probed: &ProbeIntervals, hours: &HourAxis, ticks: &[Tick], strips: &Strips) -> Vec<Rgb> {
    let (width, height) = (strips.width as usize, strips.height as usize);
    let rows = sunlight.days.iter().zip(&probed.days);
    let colours: Vec<Rgb> = rows.flat_map(|(day, intervals)| colours(day, intervals, hours, width)).collect();
    let days = sunlight.days.len();
    let fit = Fit { cells: (strips.width, days as u32), pixels: (strips.width, strips.height) };
    let mut pixels = compose(fit, CellBorder::Sharp, &colours, |_, _| None).pixels;
    let mut line = |pixel: usize| {
        let light = pixels[pixel].iter().map(|part| u32::from(*part)).sum::<u32>() > 330;
        pixels[pixel] = mix(pixels[pixel], if light { INK } else { PAPER }, GRID);
    };
    for hour in hours.first + 1..hours.last {
        let x = (hours.at(hour * 3600) * width as f64) as usize;
        (0..height).for_each(|y| (x - 1..=x).for_each(|x| line(y * width + x)));
    }
    for tick in ticks.iter().filter(|tick| tick.row > 0) {
        let y = tick.row * height / days;
        (0..width).for_each(|x| line(y * width + x));
    }
    pixels
}

/// The colours of a day, averaged over the time that each column covers.
fn colours(day: &SunDay, intervals: &[Interval], hours: &HourAxis, columns: usize) -> Vec<Rgb> {
    let mut line = vec![OUTSIDE; columns];
    let mut paint = |from: DateTime<Zone>, to: DateTime<Zone>, colour: Rgb| {
        let [from, to] =
            [from, to].map(|time| hours.of_time(day, time) * columns as f64).map(|x| x.clamp(0.0, columns as f64));
        for (column, pixel) in line.iter_mut().enumerate().take(to.ceil() as usize).skip(from as usize) {
            let covered = to.min(column as f64 + 1.0) - from.max(column as f64);
            *pixel = mix(*pixel, colour, covered.clamp(0.0, 1.0));
        }
    };
    paint(day.window.from, day.window.to, NIGHT);
    day.up.iter().for_each(|up| paint(up.start, up.end, SHADE));
    intervals.iter().for_each(|interval| paint(interval.start, interval.end, SUN));
    line
}

/// The text above a strip: the probe's name, and how much sun it gets.
fn head(lines: &mut Block, sunlight: &Sunlight, probed: &ProbeIntervals, width: f64) {
    let longest = probed.longest().map_or(0, Interval::secs);
    let sums = match (probed.days.as_slice(), longest) {
        (_, 0) => match probed.below_ground_m {
            Some(below) => format!("no sun: {} below the ground", metres(below)),
            None => "no sun".to_owned(),
        },
        ([day], _) => {
            format!("{} of sun in {}, the longest {}", clock(probed.secs()), counted(day.len()), clock(longest))
        }
        _ => format!("{} of sun, the longest interval {}", clock(probed.secs()), clock(longest)),
    };
    lines.text(width, -18.0, TextAnchor::End, LetterStyle::BODY, &sums);
    let mut room = width - text::width(&sums, LetterStyle::BODY.weight, LetterStyle::BODY.size) - 40.0;
    let name = text::wrap(&probed.probe.name, LetterStyle::HEAD.weight, LetterStyle::HEAD.size, room, 1).concat();
    lines.text(0.0, -18.0, TextAnchor::Start, LetterStyle::HEAD, &name);
    let taken = text::width(&name, LetterStyle::HEAD.weight, LetterStyle::HEAD.size) + 26.0;
    room -= taken;
    let lies = lies(&probed.probe).replace("(-", "(−").replace(" -", " −");
    if sunlight.probes.len() > 1 && text::width(&lies, LetterStyle::LABEL.weight, LetterStyle::LABEL.size) <= room {
        lines.text(taken, -18.0, TextAnchor::Start, LetterStyle::LABEL, &lies);
    }
}

/// The curves of sunrise and sunset over a strip's days.
fn curves(lines: &mut Block, sunlight: &Sunlight, hours: &HourAxis, strips: &Strips) {
    /// The greatest step between neighbouring days, in hours, over which a curve continues: enough where clocks are put
    /// forward or back, but not from one midnight to the other.
    const FARTHEST: f64 = 3.0;
    let row = f64::from(strips.height) / sunlight.days.len() as f64;
    let hour = f64::from(strips.width) / (hours.last - hours.first) as f64;
    let mut curve = |event: fn(&Day) -> Option<DateTime<Zone>>| {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for (index, day) in sunlight.days.iter().enumerate() {
            let x = event(&day.window.day).map(|time| hours.of_time(day, time) * f64::from(strips.width));
            let goes_on = |x: f64| points.last().is_none_or(|[last, _]| (x - last).abs() < FARTHEST * hour);
            if !x.is_some_and(goes_on) {
                lines.polyline(&points, 3.0, ACCENT);
                points.clear();
            }
            points.extend(x.into_iter().flat_map(|x| [0.0, 1.0].map(|part| [x, (index as f64 + part) * row])));
        }
        lines.polyline(&points, 3.0, ACCENT);
    };
    curve(|day| day.sunrise);
    curve(|day| day.sunset);
}

/// The labels on the strip of a single day: the times of each interval, and what blocks the sun between them.
fn label(
    lines: &mut Block,
    sunlight: &Sunlight,
    (day, intervals): (&SunDay, &[Interval]),
    hours: &HourAxis,
    strips: &Strips,
) {
    let width = f64::from(strips.width);
    let x = |time| hours.of_time(day, time) * width;
    let middle = f64::from(strips.height) / 2.0;
    let mut write = |from: f64, to: f64, colour: Rgb, said: &[String]| {
        let style = LetterStyle { colour, ..LetterStyle::BODY };
        let room = to - from - 16.0;
        if said.iter().all(|line| text::width(line, style.weight, style.size) <= room) {
            let first = middle - style.leading() * (said.len() as f64 / 2.0 - 0.5) + style.size * 0.36;
            for (index, line) in said.iter().enumerate() {
                lines.text((from + to) / 2.0, first + style.leading() * index as f64, TextAnchor::Middle, style, line);
            }
        }
    };
    for interval in intervals {
        let [from, to] = [interval.start, interval.end].map(|time| time.format("%H:%M:%S").to_string());
        let said = [format!("{from} –"), to, format!("({})", clock(interval.secs()))];
        write(x(interval.start), x(interval.end), INK, &said);
    }
    for pair in intervals.windows(2) {
        let [after, before] = [pair[0].after, pair[1].before].map(|blocked| text::clean(&sunlight.name(blocked)));
        let said = if after == before { vec![after] } else { vec![after, "…".to_owned(), before] };
        write(x(pair[0].end), x(pair[1].start), INK, &said);
    }
}
