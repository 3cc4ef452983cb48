//! The options that choose how shadows are found. Their help is read from the table of techniques.

use crate::choice::{Engine, Filter, Finder, MAP_SIZE, Method, MethodRow, Setting, Settings, TABLE, listed};
use crate::silhouette::hextree::DEEPEST;
use crate::site::Overrides;
use clap::{Args, value_parser};

/// How shadows are found.
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

/// Who finds silhouettes.
#[derive(Debug, Args)]
pub(super) struct FinderArgs {
    #[arg(long, value_name = "NAME", help = with(Setting::Finder, &one_of(Finder::WORDS)))]
    silhouette: Option<Finder>,
    /// With --silhouette hextree: the tree of the paper, so many levels deep (its own: 4), instead of its successor
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(DEEPEST)),
          allow_negative_numbers = true)]
    hextree_depth: Option<u32>,
}

/// What techniques with a map can be told.
#[derive(Debug, Args)]
pub(super) struct MapArgs {
    #[arg(long, value_name = "TEXELS", value_parser = value_parser!(u32).range(256..=8192),
          allow_negative_numbers = true,
          help = with(Setting::MapSize, &format!("texels along the map's side, 256 to 8192 [default: {MAP_SIZE}]")))]
    map_size: Option<u32>,
    #[arg(long, value_name = "NAME", help = with(Setting::Filter, &filters()))]
    pcf: Option<Filter>,
    #[arg(long, value_name = "M", allow_negative_numbers = true,
          help = with(Setting::SmoothieWidth, "how wide the soft edge is at most, metres across the sun's rays \
                      [default: as wide as the sun's disc makes it on the lowest receiver]"))]
    smoothie_width: Option<f64>,
}

/// Each technique with what it is good for.
fn techniques() -> String {
    let told: Vec<_> = TABLE.iter().map(|row| format!("{}: {}", row.word, row.good_for)).collect();
    format!("{}. What each draws and how wrong it can be: docs/techniques.md", told.join(". "))
}

/// `a, b or c`
fn one_of<T>(words: &[(&'static str, T)]) -> String {
    listed(&words.iter().map(|(word, _)| *word).collect::<Vec<_>>(), "or")
}

/// What an option says to the techniques that use it.
fn with(setting: Setting, what: &str) -> String {
    format!("With {}: {what}", listed(&setting.users(), "and"))
}

fn filters() -> String {
    let default = Method::ShadowMap.row().defaults.filter.map_or("", Filter::word);
    format!("how comparisons are filtered: {} [default: {default}]", one_of(Filter::WORDS))
}

fn samples() -> String {
    let MethodRow { word, defaults, .. } = Method::SoftTexture.row();
    let points = defaults.sun_samples.unwrap_or_default();
    format!(
        "so many points of the sun's disc, 1 to 1024 [default: its centre; with {word} in a camera's picture {points}]"
    )
}

/// What `--stats` tells.
pub(super) fn stats() -> String {
    let counting = listed(&counting(), "and");
    format!(
        "Also what counting the shadow volumes took, with {counting}: overdraw, and the share of silhouette cells (of all \
         cells, those of the sky too)"
    )
}

/// What `--show` shows.
pub(super) fn show() -> String {
    let by_map = listed(&showing_mask(), "and");
    let counting = listed(&counting(), "or");
    format!(
        "Also shown in the camera's drawing: shadow volumes in yellow, the silhouette in black, components in colours. Or \
         instead of sun and shadow, on the plan too: mask (with {by_map}: what the map decided and what the volumes did), \
         overdraw (with {counting}: fragments that were counted, as brightness)"
    )
}

/// The words of the techniques that show a mask of their own.
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
