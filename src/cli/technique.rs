//! The options for the technique. Their help comes from the table of techniques.

use crate::choice::{Engine, Filter, Finder, MAP_SIZE, Method, MethodRow, Setting, Settings, TABLE, listed};
use crate::silhouette::hextree::DEEPEST;
use crate::site::Overrides;
use clap::{Args, value_parser};

/// The technique.
#[derive(Debug, Args)]
pub(super) struct DrawArgs {
    #[arg(long, value_name = "NAME", help = techniques())]
    technique: Option<Method>,
    #[command(flatten)]
    finder: FinderArgs,
    #[arg(long, value_name = "NAME", help = one_of(Engine::WORDS))]
    engine: Option<Engine>,
    #[command(flatten)]
    maps: MapArgs,
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024), allow_negative_numbers = true,
          help = with(Setting::SunSamples, &samples()))]
    sun_samples: Option<u32>,
}

/// The finder of silhouettes.
#[derive(Debug, Args)]
pub(super) struct FinderArgs {
    #[arg(long, value_name = "NAME", help = with(Setting::Finder, &one_of(Finder::WORDS)))]
    silhouette: Option<Finder>,
    /// With --silhouette hextree: the paper's tree with this many levels (the paper's has 4) instead of the hierarchy
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(DEEPEST)),
          allow_negative_numbers = true)]
    hextree_depth: Option<u32>,
}

/// The options of techniques with a map.
#[derive(Debug, Args)]
pub(super) struct MapArgs {
    #[arg(long, value_name = "TEXELS", value_parser = value_parser!(u32).range(256..=8192),
          allow_negative_numbers = true,
          help = with(Setting::MapSize, &format!("texels along the map's side, 256 to 8192 [default: {MAP_SIZE}]")))]
    map_size: Option<u32>,
    #[arg(long, value_name = "NAME", help = with(Setting::Filter, &filters()))]
    pcf: Option<Filter>,
    #[arg(long, value_name = "M", allow_negative_numbers = true,
          help = with(Setting::SmoothieWidth, "greatest width of the soft edge, metres across the sun's rays \
                      [default: the width that the sun's disc gives it on the lowest receiver]"))]
    smoothie_width: Option<f64>,
}

/// Each technique with its advantage.
fn techniques() -> String {
    let told: Vec<_> = TABLE.iter().map(|row| format!("{}: {}", row.word, row.good_for)).collect();
    format!("{}. What each draws, and its errors: docs/techniques.md", told.join(". "))
}

/// `a, b or c`
fn one_of<T>(words: &[(&'static str, T)]) -> String {
    listed(&words.iter().map(|(word, _)| *word).collect::<Vec<_>>(), "or")
}

/// The help for an option of techniques.
fn with(setting: Setting, what: &str) -> String {
    format!("With {}: {what}", listed(&setting.users(), "and"))
}

fn filters() -> String {
    let default = TABLE.iter().find_map(|row| row.defaults.filter).map_or("", Filter::word);
    format!("filter of the comparisons: {} [default: {default}]", one_of(Filter::WORDS))
}

fn samples() -> String {
    let of_row = |row: &MethodRow| {
        row.defaults.sun_samples.map(|points| format!("; with {} in a camera's picture {points}", row.word))
    };
    let others: String = TABLE.iter().filter_map(of_row).collect();
    format!("number of points of the sun's disc, 1 to 1024 [default: its centre{others}]")
}

/// The help of `--stats`.
pub(super) fn stats() -> String {
    let counting = listed(&counting(), "and");
    format!(
        "Also the cost of counting shadow volumes, with {counting}: overdraw, and the share of silhouette cells (of all \
         cells, the sky included)"
    )
}

/// The help of `--show`.
pub(super) fn show() -> String {
    let by_map = listed(&showing_mask(), "and");
    let counting = listed(&counting(), "or");
    format!(
        "Also in the camera's drawing: shadow volumes in yellow, the silhouette in black, components in colours. Or \
         instead of sun and shadow, also on the plan: mask (with {by_map}: which cells the map decided, and which the volumes), \
         overdraw (with {counting}: counted fragments, as brightness)"
    )
}

/// The words of the techniques that can show a mask.
pub(super) fn showing_mask() -> Vec<&'static str> {
    TABLE.iter().filter(|row| row.shows_mask).map(|row| row.word).collect()
}

/// The words of the techniques that count volumes.
fn counting() -> Vec<&'static str> {
    TABLE.iter().filter(|row| row.counts).map(|row| row.word).collect()
}

impl DrawArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Overrides {
        let DrawArgs { technique, ref finder, engine, ref maps, sun_samples } = *self;
        let settings = maps.settings(sun_samples);
        finder.onto(Overrides { technique, engine, settings, ..asked })
    }
}

impl FinderArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Overrides {
        Overrides { silhouette: self.silhouette, hextree_depth: self.hextree_depth, ..asked }
    }
}

impl MapArgs {
    pub(super) fn settings(&self, sun_samples: Option<u32>) -> Settings {
        let MapArgs { map_size, pcf, smoothie_width } = *self;
        Settings { map_size, filter: pcf, smoothie_width_m: smoothie_width, sun_samples }
    }
}
