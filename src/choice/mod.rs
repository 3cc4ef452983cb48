//! What people choose: technique, finder, engine, filter and receivers, and a table that says what each technique can
//! do.
//!
//! The command's help, the window's menus, the documents, `verify` and the checks of what fits together
//! ([`MethodRow::fit`], [`MethodRow::check`]) all read [`TABLE`]. A new technique is a row there.

mod fit;
mod table;
mod words;

pub use fit::Misfit;
#[doc(hidden)]
pub use table::{MAP_SIZE, MethodRow, Promise, SinglySearched, TABLE, Truth};
pub use table::{Method, Setting, Subject};
#[doc(hidden)]
pub use words::{ChoiceError, listed};
pub(crate) use words::{find, nearest, read, words};

/// What is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Receivers {
    /// The highest receiving surface under each cell, the ground included.
    #[default]
    Top,
    /// The ground, as if buildings only cast: the terrain seen from above if there is any, and the plane beyond it.
    Ground,
    /// All patches of receiving models, walls and undersides included, on their outer side.
    Patches,
}

/// The finder of silhouettes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Finder {
    /// The fastest one for the work.
    #[default]
    Auto,
    /// One pass over all edges, on the processor.
    Brute,
    /// A search in dual space: classes of edges under a hierarchy, or, with a depth, the paper's tree.
    Hextree,
    /// One pass over all edges, on the graphics adapter.
    Gpu,
}

/// The filter of a shadow map's comparisons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// No filter, the nearest texel alone: 2 levels.
    None,
    /// Four maps, each offset by a quarter of a texel, in four channels: 5 levels.
    TwoByTwo,
    /// The four nearest texels of one map: 5 levels.
    FastTwoByTwo,
    /// The sixteen nearest texels of one map: 17 levels.
    FastFourByFour,
}

/// The machine that draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Engine {
    /// The graphics adapter if there is one, otherwise the processor.
    #[default]
    Auto,
    /// The graphics adapter, or an error.
    Gpu,
    /// The processor.
    Cpu,
}

/// The settings of single techniques. Settings that are absent have the default of the technique.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The number of texels along a shadow map's side.
    pub map_size: Option<u32>,
    /// The filter of the map's comparisons.
    pub filter: Option<Filter>,
    /// The greatest width of smoothies, metres across the sun's rays.
    pub smoothie_width_m: Option<f64>,
    /// The number of points of the sun's disc for ray casting.
    pub sun_samples: Option<u32>,
}

impl Settings {
    /// No setting has a value.
    pub const NONE: Settings = Settings { map_size: None, filter: None, smoothie_width_m: None, sun_samples: None };
}

words!(
    Filter,
    [
        "none" => Filter::None,
        "2x2" => Filter::TwoByTwo,
        "fast-2x2" => Filter::FastTwoByTwo,
        "fast-4x4" => Filter::FastFourByFour
    ]
);
words!(
    Finder,
    [
        "auto" => Finder::Auto,
        "brute" => Finder::Brute,
        "hextree" => Finder::Hextree,
        "gpu" => Finder::Gpu
    ]
);
words!(Engine, ["auto" => Engine::Auto, "gpu" => Engine::Gpu, "cpu" => Engine::Cpu]);
words!(
    Receivers,
    [
        "top" => Receivers::Top,
        "ground" => Receivers::Ground,
        "surfaces" => Receivers::Patches
    ]
);
