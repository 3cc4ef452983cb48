//! The colours of hours of shadow: bands of whole steps on an even scale that colour-blind people can read.

/// An sRGB colour.
pub type Rgb = [u8; 3];

/// Crameri's `davos`, reversed, at tenths from its light end: cream, sage, slate, navy.
///
/// F. Crameri, Scientific colour maps 8.0 (2023), doi:10.5281/zenodo.1243862: even in lightness, safe for the
/// colour-blind, and readable in black and white.
const DAVOS_REVERSED: [Rgb; 11] = [
    [254, 254, 254],
    [245, 245, 215],
    [212, 219, 168],
    [166, 183, 138],
    [132, 158, 137],
    [107, 141, 147],
    [84, 125, 156],
    [58, 103, 155],
    [35, 74, 140],
    [15, 40, 109],
    [0, 5, 74],
];

/// The part of the colour map that is used: its light end is reserved for no shadow at all, its dark end for lines
/// drawn over it.
const LIGHTEST: f64 = 0.16;
const DARKEST: f64 = 0.88;

/// No shadow at all: the paper's own colour, so that sunny ground stays quiet.
pub const NO_SHADOW: Rgb = [254, 253, 249];

/// No sun at all: a colour off the scale, so that it is not mistaken for a little sun.
pub(crate) const NO_SUN: Rgb = [70, 66, 74];

/// The greatest number of bands; more are hard to tell apart.
pub(crate) const MOST_BANDS: u32 = 16;

/// Round durations for bands wider than a step, in seconds: from a second to a hundred days of daylight.
const ROUND_SECS: [u32; 27] = [
    1, 2, 5, 10, 15, 20, 30, 60, 120, 300, 600, 900, 1_200, 1_800, 3_600, 7_200, 10_800, 14_400, 21_600, 36_000,
    72_000, 180_000, 360_000, 720_000, 1_800_000, 3_600_000, 7_200_000,
];

/// The bands of one drawing: none for no shadow at all, then (0, band], (band, 2 band], … up to the window's daylight.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// Width of a band, seconds.
    pub band_secs: u32,
    /// The longest shadow there can be, seconds.
    pub day_secs: u32,
    /// The colour of each band, the shortest shadow first.
    pub colours: Vec<Rgb>,
}

impl Bands {
    /// Bands of one `step_secs` if that gives few enough; otherwise of a round duration, a multiple of the step if
    /// possible.
    pub fn new(step_secs: u32, day_secs: u32) -> Bands {
        let band_secs = band_secs(step_secs, day_secs, MOST_BANDS);
        let count = day_secs.div_ceil(band_secs);
        Bands { band_secs, day_secs, colours: (0..count).map(|band| colour(band, count)).collect() }
    }

    /// The colour of a time in shadow, in units of 1/255 s.
    pub fn colour(&self, shaded: u64) -> Rgb {
        if shaded == 0 {
            return NO_SHADOW;
        }
        // A shadow of exactly one band belongs to that band, not to the next.
        let (most, width) = (shaded - 1, 255 * u64::from(self.band_secs));
        let band = match (u32::try_from(most), u32::try_from(width)) {
            // narrower integers divide in half the time
            (Ok(most), Ok(width)) => u64::from(most / width),
            _ => most / width,
        };
        let last = self.colours.len().saturating_sub(1);
        let band = usize::try_from(band).unwrap_or(last).min(last);
        self.colours.get(band).copied().unwrap_or(NO_SHADOW)
    }

    /// The same colours for time in the sun, the lightest for the most. `lit` is in seconds, summed over the sun
    /// samples that are seen, of `samples` in all. No sun at all has a colour of its own; a band contains its lower
    /// bound, and the last one also the whole daylight.
    pub fn of_sun(&self, lit: u32, samples: u32) -> Rgb {
        if lit == 0 {
            return NO_SUN;
        }
        let band = u64::from(lit) / (u64::from(samples.max(1)) * u64::from(self.band_secs));
        let last = self.colours.len().saturating_sub(1);
        let band = usize::try_from(band).unwrap_or(last).min(last);
        self.colours.get(last - band).copied().unwrap_or(NO_SUN)
    }

    /// The bounds of a band, seconds; the last band ends with the daylight.
    pub fn bounds(&self, band: usize) -> (u32, u32) {
        let from = (band as u32).saturating_mul(self.band_secs);
        (from, from.saturating_add(self.band_secs).min(self.day_secs))
    }
}

/// The width of bands in seconds, so that there are at most `most_bands`.
pub(super) fn band_secs(step_secs: u32, all_secs: u32, most_bands: u32) -> u32 {
    let step = step_secs.max(1);
    let few = |secs: &u32| all_secs.div_ceil(*secs) <= most_bands;
    let round = || ROUND_SECS.iter().copied().filter(|secs| *secs >= step);
    Some(step)
        .filter(few)
        .or_else(|| round().filter(few).find(|secs| secs % step == 0))
        .or_else(|| round().find(few))
        .unwrap_or_else(|| all_secs.div_ceil(most_bands))
}

fn colour(band: u32, count: u32) -> Rgb {
    let share = if count > 1 { f64::from(band) / f64::from(count - 1) } else { 0.5 };
    let at = (LIGHTEST + share * (DARKEST - LIGHTEST)) * (DAVOS_REVERSED.len() - 1) as f64;
    let low = (at as usize).min(DAVOS_REVERSED.len() - 2);
    mix(DAVOS_REVERSED[low], DAVOS_REVERSED[low + 1], at - low as f64)
}

/// A mixture of `a` (share 0) and `b` (share 1), in sRGB.
pub(super) fn mix(a: Rgb, b: Rgb, share: f64) -> Rgb {
    std::array::from_fn(|i| (f64::from(a[i]) + (f64::from(b[i]) - f64::from(a[i])) * share).round() as u8)
}
