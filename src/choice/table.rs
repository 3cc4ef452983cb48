//! The table of techniques: one row for each technique's abilities.

use super::{Engine, Filter, Finder, Settings};
use crate::message::Field;

/// The subject of a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The plan, on the highest surface under each cell.
    Top,
    /// The plan, on the ground alone.
    Ground,
    /// The plan, on the terrain alone, if that is the ground.
    Terrain,
    /// What a camera sees in perspective.
    Camera,
    /// A side, or what the sun sees, along parallel rays.
    Side,
    /// All flat patches of the receivers.
    Patches,
}

impl Subject {
    /// All subjects.
    pub const ALL: [Subject; 6] =
        [Subject::Top, Subject::Ground, Subject::Terrain, Subject::Camera, Subject::Side, Subject::Patches];

    /// The subject as the object of a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Subject::Top => "the plan's highest surfaces",
            Subject::Ground => "the plan's ground",
            Subject::Terrain => "terrain as the plan's ground",
            Subject::Camera => "a camera's picture",
            Subject::Side => "a side",
            Subject::Patches => "façades and roofs",
        }
    }

    /// The field and the value that ask for it.
    pub(super) fn choice(self) -> (Field, &'static str) {
        match self {
            Subject::Top => (Field::Receivers, "top"),
            Subject::Ground | Subject::Terrain => (Field::Receivers, "ground"),
            Subject::Camera => (Field::View, "camera"),
            Subject::Side => (Field::View, "north, east, south, west or sun"),
            Subject::Patches => (Field::Receivers, "surfaces"),
        }
    }

    /// The words of the techniques that draw the subject on a machine, without `auto`.
    pub fn drawn_by(self, engine: Engine) -> Vec<&'static str> {
        let rows = TABLE.iter().filter(|row| row.method != Method::Auto && row.draws(engine, self));
        rows.map(|row| row.word).collect()
    }
}

/// An option that only some techniques use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// The finder; see [`MethodRow::finders`].
    Finder,
    /// [`Settings::map_size`]
    MapSize,
    /// [`Settings::filter`]
    Filter,
    /// [`Settings::smoothie_width_m`]
    SmoothieWidth,
    /// [`Settings::sun_samples`]
    SunSamples,
}

impl Setting {
    /// All settings.
    pub const ALL: [Setting; 5] =
        [Setting::Finder, Setting::MapSize, Setting::Filter, Setting::SmoothieWidth, Setting::SunSamples];

    /// The field that sets it.
    pub fn field(self) -> Field {
        match self {
            Setting::Finder => Field::Silhouette,
            Setting::MapSize => Field::MapSize,
            Setting::Filter => Field::Pcf,
            Setting::SmoothieWidth => Field::SmoothieWidth,
            Setting::SunSamples => Field::SunSamples,
        }
    }

    /// The words of the techniques that use it.
    pub fn users(self) -> Vec<&'static str> {
        TABLE.iter().filter(|row| row.uses(self)).map(|row| row.word).collect()
    }
}

/// What a technique searches singly between two instants, and only where these differ. All else it draws at each moment, so
/// that nothing is missed there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SinglySearched {
    /// It draws all.
    Nothing,
    /// What a plan sees above the ground.
    AboveGround,
    /// All cells or texels.
    Everything,
}

/// The truth that a technique is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Ray casting to the sun's centre.
    Centre,
    /// Ray casting to points of the sun's disc.
    Disc,
    /// Rays to the sun's centre that test every face, without the trees.
    EveryFace,
}

/// A technique's promise, from the strictest on; the truth itself comes last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Promise {
    /// The truth, except for the rounding of corners at a shadow's edge. Decides whether the verification passes.
    Exact,
    /// Exact, except where its map misses a caster or a gap. Those cells are counted separately.
    ExactButForMap,
    /// Approximately the truth.
    Near,
    /// The truth itself. Also decides whether the verification passes.
    Same,
}

/// What a technique is and can do.
#[derive(Debug)]
pub struct MethodRow {
    /// The technique.
    pub method: Method,
    /// The word by which people choose it.
    pub word: &'static str,
    /// Its name in a drawing.
    pub name: &'static str,
    /// What it is good for, in half a line.
    pub good_for: &'static str,
    /// Its possible errors.
    pub wrong: &'static str,
    /// The subjects that it draws on the processor.
    pub on_cpu: &'static [Subject],
    /// The subjects that it draws on the graphics adapter.
    pub on_gpu: &'static [Subject],
    /// The finders that it can use, besides [`Finder::Auto`].
    pub finders: &'static [Finder],
    /// The other options that it uses.
    pub settings: &'static [Setting],
    /// The defaults of these options.
    pub defaults: Settings,
    /// Whether it counts shadow volumes, so that statistics of counting exist.
    pub counts: bool,
    /// Whether it can also draw the volumes themselves and the silhouette that they start from; one technique does.
    pub draws_volumes: bool,
    /// Whether its map decides some cells and volumes the others, so that a diagram of this can be shown.
    pub shows_mask: bool,
    /// Whether it blends 32-bit floats, which not every adapter supports.
    pub blends_float32: bool,
    /// Whether it draws the ground's plane on the processor at each moment between two instants, as that costs little.
    pub draws_ground_between: bool,
    /// The truth with which `verify` compares it.
    pub against: Truth,
    /// What `verify` requires of it.
    pub promise: Promise,
    /// The same on façades and roofs, against rays to the sun's centre; `None` where it draws none.
    pub on_patches: Option<Promise>,
}

/// Defines the enum of techniques, the table and the words from one list of rows.
macro_rules! techniques {
    ($($(#[$of:meta])+ $name:ident: $word:literal, { $($field:ident: $value:expr,)+ })+) => {
        /// The technique that finds shadows.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
        #[non_exhaustive]
        pub enum Method { $($(#[$of])+ $name),+ }

        impl Method {
            /// The words with their techniques.
            pub const WORDS: &'static [(&'static str, Method)] = &[$(($word, Method::$name)),+];
        }

        /// All techniques in the order of help and menus; the first is `auto`.
        pub static TABLE: &[MethodRow] = &[$(MethodRow { method: Method::$name, word: $word, $($field: $value),+ }),+];
    };
}

/// Plan and perspective.
const SEEN: &[Subject] = &[Subject::Top, Subject::Ground, Subject::Terrain, Subject::Camera];
/// All finders.
const FINDERS: &[Finder] = &[Finder::Brute, Finder::Hextree, Finder::Gpu];
/// The default number of texels along a map's side.
pub const MAP_SIZE: u32 = 2048;

techniques! {
    /// The fastest exact technique for the work.
    #[default]
    Auto: "auto", {
        name: "the fastest exact technique",
        good_for: "the fastest exact one for the request and the machine",
        wrong: "as the technique that it chooses",
        on_cpu: &Subject::ALL,
        on_gpu: &[Subject::Top, Subject::Ground, Subject::Terrain, Subject::Camera, Subject::Patches],
        finders: &[],
        settings: &[],
        defaults: Settings::NONE,
        counts: false,
        draws_volumes: false,
        shows_mask: false,
        blends_float32: false,
        draws_ground_between: false,
        against: Truth::Centre,
        promise: Promise::Exact,
        on_patches: Some(Promise::Exact),
    }
    /// Stencil shadow volumes.
    Stencil: "stencil", {
        name: "stencil shadow volumes",
        good_for: "exact, on a graphics adapter: shadow volumes are counted",
        wrong: "cells within 1/256 of a cell of an edge",
        on_cpu: &[],
        on_gpu: SEEN,
        finders: FINDERS,
        settings: &[],
        defaults: Settings::NONE,
        counts: true,
        draws_volumes: true,
        shows_mask: false,
        blends_float32: false,
        draws_ground_between: false,
        against: Truth::Centre,
        promise: Promise::Exact,
        on_patches: None,
    }
    /// Faces projected onto the ground.
    Projected: "projected", {
        name: "projected shadows",
        good_for: "exact, for the plan: faces are projected along the sun; by far the fastest on the ground alone",
        wrong: "not at all, for the model as given; on a graphics adapter cells within 1/128 of a cell of an edge",
        on_cpu: &[Subject::Top, Subject::Ground, Subject::Terrain],
        on_gpu: &[Subject::Ground],
        finders: &[],
        settings: &[],
        defaults: Settings::NONE,
        counts: false,
        draws_volumes: false,
        shows_mask: false,
        blends_float32: false,
        draws_ground_between: true,
        against: Truth::Centre,
        promise: Promise::Exact,
        on_patches: None,
    }
    /// A depth map drawn from the sun.
    ShadowMap: "shadow-map", {
        name: "shadow map",
        good_for: "a quick look",
        wrong: "an edge is as coarse as a texel of its map",
        on_cpu: &[],
        on_gpu: SEEN,
        finders: &[],
        settings: &[Setting::MapSize, Setting::Filter],
        defaults: Settings { map_size: Some(MAP_SIZE), filter: Some(Filter::FastTwoByTwo), ..Settings::NONE },
        counts: false,
        draws_volumes: false,
        shows_mask: false,
        blends_float32: false,
        draws_ground_between: false,
        against: Truth::Centre,
        promise: Promise::Near,
        on_patches: None,
    }
    /// A depth map, and volumes where the map cannot decide.
    Hybrid: "hybrid", {
        name: "shadow map and volumes",
        good_for: "exact except for thin parts; quick where many of them cast volumes over each other",
        wrong: "misses what is thinner than a texel of its map",
        on_cpu: &[],
        on_gpu: SEEN,
        finders: FINDERS,
        settings: &[Setting::MapSize],
        defaults: Settings { map_size: Some(MAP_SIZE), ..Settings::NONE },
        counts: true,
        draws_volumes: false,
        shows_mask: true,
        blends_float32: false,
        draws_ground_between: false,
        against: Truth::Centre,
        promise: Promise::ExactButForMap,
        on_patches: None,
    }
    /// A depth map with soft edges.
    Smoothie: "smoothie", {
        name: "smoothies (soft edges, outside of the hard ones)",
        good_for: "pictures with the soft edge of a real sun",
        wrong: "shadows are too large by half of their soft edge, and slits close: not for hours",
        on_cpu: &[],
        on_gpu: SEEN,
        finders: &[Finder::Brute, Finder::Hextree],
        settings: &[Setting::MapSize, Setting::SmoothieWidth],
        defaults: Settings { map_size: Some(MAP_SIZE), ..Settings::NONE },
        counts: false,
        draws_volumes: false,
        shows_mask: false,
        blends_float32: true,
        draws_ground_between: false,
        against: Truth::Disc,
        promise: Promise::Near,
        on_patches: None,
    }
    /// Registered hard shadows on flat patches, added up.
    SoftTexture: "soft-texture", {
        name: "soft shadow textures",
        good_for: "hours on façades and roofs; in a camera's picture the sun as a disc on what is flat",
        wrong: "not at all on surfaces, for the model as given; pixels at edges, by one or two in 255 on average",
        on_cpu: &[Subject::Camera, Subject::Patches],
        on_gpu: &[Subject::Patches],
        finders: &[],
        settings: &[Setting::SunSamples],
        defaults: Settings { sun_samples: Some(64), ..Settings::NONE },
        counts: false,
        draws_volumes: false,
        shows_mask: false,
        blends_float32: false,
        draws_ground_between: false,
        against: Truth::Disc,
        promise: Promise::Near,
        on_patches: Some(Promise::Exact),
    }
    /// Ray casting.
    RayCast: "ray-cast", {
        name: "ray casting",
        good_for: "exact, on the processor; with points of the sun's disc the exact soft edge of a real sun",
        wrong: "not at all, for the model as given",
        on_cpu: &Subject::ALL,
        on_gpu: &[],
        finders: &[],
        settings: &[Setting::SunSamples],
        defaults: Settings::NONE,
        counts: false,
        draws_volumes: false,
        shows_mask: false,
        blends_float32: false,
        draws_ground_between: false,
        against: Truth::EveryFace,
        promise: Promise::Same,
        on_patches: Some(Promise::Same),
    }
}

impl Method {
    /// The row of the technique.
    #[doc(hidden)]
    pub fn row(self) -> &'static MethodRow {
        // the table and the enum are made from the same list
        &TABLE[self as usize]
    }

    /// The word of the technique.
    pub fn word(self) -> &'static str {
        self.row().word
    }

    /// The technique that also draws volumes and silhouette.
    pub(crate) fn of_volumes() -> Option<Method> {
        TABLE.iter().find(|row| row.draws_volumes).map(|row| row.method)
    }

    /// The technique that draws the sun as a point or, on request, as a disc.
    #[cfg(feature = "desktop")]
    pub(crate) fn of_discs() -> Option<Method> {
        TABLE.iter().find(|row| row.offers_disc()).map(|row| row.method)
    }
}

super::read!(Method);

impl MethodRow {
    /// The subjects that it draws on a machine; for [`Engine::Auto`], on either.
    pub fn draws(&self, engine: Engine, subject: Subject) -> bool {
        let (on_cpu, on_gpu) = (self.on_cpu.contains(&subject), self.on_gpu.contains(&subject));
        match engine {
            Engine::Auto => on_cpu || on_gpu,
            Engine::Cpu => on_cpu,
            Engine::Gpu => on_gpu,
        }
    }

    /// Whether times of change of single cells can be found between two instants: its masks are the truth except for
    /// rounding or what its map misses, and the sun is a point.
    pub fn finds_changes(&self, subject: Subject, sun_samples: Option<u32>) -> bool {
        sun_samples.is_none() && (subject == Subject::Patches || self.promise != Promise::Near)
    }

    /// What it searches singly between two instants, on the machine that draws, where it finds changes.
    pub fn searches_singly(&self, engine: Engine, subject: Subject) -> SinglySearched {
        match (engine, subject) {
            (Engine::Gpu, _) => SinglySearched::Nothing,
            (_, Subject::Ground) if self.draws_ground_between => SinglySearched::Nothing,
            (_, Subject::Top) if self.draws_ground_between => SinglySearched::AboveGround,
            _ => SinglySearched::Everything,
        }
    }

    /// Whether the sun is a point for it unless a disc is requested.
    #[cfg(feature = "desktop")]
    pub(crate) fn offers_disc(&self) -> bool {
        self.uses(Setting::SunSamples) && self.defaults.sun_samples.is_none()
    }

    /// Whether it uses an option.
    pub fn uses(&self, setting: Setting) -> bool {
        match setting {
            Setting::Finder => !self.finders.is_empty(),
            _ => self.settings.contains(&setting),
        }
    }

    /// The settings that it uses, as requested, otherwise its defaults. Settings that it does not use are absent.
    pub fn set(&self, asked: &Settings) -> Settings {
        let Settings { map_size, filter, smoothie_width_m, sun_samples } = *asked;
        let uses = |setting| self.uses(setting);
        Settings {
            map_size: map_size.filter(|_| uses(Setting::MapSize)).or(self.defaults.map_size),
            filter: filter.filter(|_| uses(Setting::Filter)).or(self.defaults.filter),
            smoothie_width_m: smoothie_width_m
                .filter(|_| uses(Setting::SmoothieWidth))
                .or(self.defaults.smoothie_width_m),
            sun_samples: sun_samples.filter(|_| uses(Setting::SunSamples)).or(self.defaults.sun_samples),
        }
    }
}
