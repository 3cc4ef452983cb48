//! Every key that a site file may have. The parser refuses all others, errors take their examples from this table, and
//! `docs/site-file.md` is generated from it.

use crate::choice::Method;
use crate::view::Side;

/// One key of the site file.
#[derive(Clone, Copy, Debug)]
pub struct SiteKey {
    /// The table to which it belongs.
    pub table: &'static str,
    /// Its name.
    pub key: &'static str,
    /// The type of its value.
    pub value: ValueType,
    /// The unit of its number; empty if it is not a number with a unit.
    pub unit: &'static str,
    /// What applies if the key is absent.
    pub default: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// The key as it is written.
    pub example: &'static str,
}

/// The types of values.
#[derive(Clone, Copy, Debug)]
pub enum ValueType {
    /// Text in quotes.
    Text,
    /// Text in quotes, or one of TOML's dates or times.
    Moment,
    /// Two moments in a list.
    TwoMoments,
    /// A number.
    Number,
    /// This many numbers in a list.
    Numbers(usize),
    /// Text in quotes, or a whole number.
    TextOrNumber,
    /// `true`, `false`, or a list of names.
    Names,
    /// A list of texts in quotes.
    Texts,
    /// Text in quotes, or a list of them.
    TextOrTexts,
    /// Any number of numbers in a list.
    NumberList,
    /// Any number of corners, each a list of two numbers.
    Corners,
    /// Four points, each a list of three numbers.
    FourPoints,
    /// A list of inline tables with a whole number for `side`, and a number for this key.
    Sides(&'static str),
    /// One of some words, in quotes.
    Word(fn() -> Vec<&'static str>),
}

/// The tables in the order of the documentation: the name, whether there may be several, and what the table is about.
pub const SITE_TABLES: &[(&str, bool, &str)] = &[
    ("place", false, "Where on earth the models stand."),
    ("model", true, "A model file of any [format](formats.md). There is one table for each model, and at least one."),
    ("ground", false, "The horizontal plane that is the ground outside of any terrain."),
    ("study", false, "The instants that are computed. Options of the command can replace or supply single keys."),
    ("plan", false, "The raster of cells on which ground and roofs are judged."),
    ("camera", false, "The perspective's camera, or the side that an elevation shows."),
    ("probe", true, "A point whose times in the sun `gnomon probe` finds. There may be any number."),
    (
        "area",
        true,
        "An area that a [rule](rules/README.md) judges: a garden, a park, a roof terrace. There may be any number.",
    ),
    (
        "window",
        true,
        "A window that a [rule](rules/README.md) judges, or all panes of some components. There may be any number.",
    ),
    (
        "facade",
        true,
        "A façade that a [rule](rules/README.md) judges, with windows or without. There may be any number.",
    ),
    ("plot", false, "The plot that is built on, for [rules](rules/README.md) that judge lines around it."),
    (
        "before",
        false,
        "The state before, with which a [rule](rules/README.md) compares the site: another site file, or what of this one stands only before or only after.",
    ),
];

const fn key(table: &'static str, key: &'static str, value: ValueType, example: &'static str) -> SiteKey {
    SiteKey { table, key, value, unit: "", default: "", meaning: "", example }
}

impl SiteKey {
    const fn unit(self, unit: &'static str) -> Self {
        SiteKey { unit, ..self }
    }

    const fn default(self, default: &'static str) -> Self {
        SiteKey { default, ..self }
    }

    const fn means(self, meaning: &'static str) -> Self {
        SiteKey { meaning, ..self }
    }
}

fn technique_words() -> Vec<&'static str> {
    Method::WORDS.iter().map(|(word, _)| *word).collect()
}

fn side_words() -> Vec<&'static str> {
    Side::WORDS.iter().map(|(word, _)| *word).collect()
}

fn up_words() -> Vec<&'static str> {
    crate::formats::Up::WORDS.iter().map(|(word, _)| *word).collect()
}

/// Every key, by table.
pub const SITE_KEYS: &[SiteKey] = &[
    key("place", "name", ValueType::Text, "name = \"Champ de Mars, Paris\"")
        .default("none")
        .means("The place's name in drawings and reports."),
    key("place", "latitude", ValueType::Number, "latitude = 48.8583")
        .unit("degrees")
        .default("required, unless a model's file gives the place")
        .means("North is positive, −90 to 90."),
    key("place", "longitude", ValueType::Number, "longitude = 2.2945")
        .unit("degrees")
        .default("as `latitude`")
        .means("East is positive, −180 to 180."),
    key("place", "elevation", ValueType::Number, "elevation = 35.0")
        .unit("metres")
        .default("as a model's file says, otherwise 0")
        .means("Height above sea level, −500 to 9000. It sets the air's pressure, and so refraction."),
    key("place", "time_zone", ValueType::Text, "time_zone = \"Europe/Paris\"")
        .default("found from the coordinates")
        .means("The IANA name of the time zone."),
    key("model", "path", ValueType::Text, "path = \"tower.glb\"")
        .default("required")
        .means("The file, relative to the site file, or absolute."),
    key("model", "scene", ValueType::TextOrNumber, "scene = \"existing\"")
        .default("the file's default scene, or its first")
        .means(
            "Which scene of a glTF file is read: its name, or its number from 0. Two scenes of one name need the \
             number.",
        ),
    key("model", "up", ValueType::Word(up_words), "up = \"z\"")
        .default("as the file says, otherwise as usual for its [format](formats.md)")
        .means("Which axis of the model points upwards."),
    key("model", "north", ValueType::Number, "north = 0.0").unit("degrees").default("as the file says, otherwise 0").means(
        "The angle clockwise from the model's north to true north. The model's north is −z, or +y where z is \
             up.",
    ),
    key("model", "position", ValueType::Numbers(3), "position = [0.0, 0.0, 0.0]")
        .unit("metres")
        .default("as the file says, otherwise `[0, 0, 0]`")
        .means(
            "The model's origin, in metres east, north and up of the place. The model is scaled first, then \
             turned, then moved.",
        ),
    key("model", "scale", ValueType::Number, "scale = 1.0")
        .unit("metres")
        .default("as the file says, otherwise 1")
        .means("The length of one unit of the model: 0.001 for a model in millimetres."),
    key("model", "default_height", ValueType::Number, "default_height = 9.0")
        .unit("metres")
        .default("none: such footprints are left out")
        .means("The height of [footprints](formats.md#footprints) that have none."),
    key("model", "terrain_error", ValueType::Number, "terrain_error = 0.1")
        .unit("metres")
        .default("0.1")
        .means("The greatest vertical distance of the triangles from the heights of a [raster](formats.md#geotiff)."),
    key("model", "classes", ValueType::Texts, "classes = [\"building\", \"vegetation\"]")
        .default("the ground alone")
        .means(
            "Which classes of [measured points](formats.md#las-and-laz) are read besides the ground: `building`, \
             `vegetation`, `bridge`, `water`.",
        ),
    key("model", "layers", ValueType::Texts, "layers = [\"walls\", \"!furniture\"]").default("all").means(
        "What of the file is read, by names as in `casts`: layers, storeys, groups, materials or components. The rest \
             stands nowhere, and is counted among what was left out.",
    ),
    key("model", "crs", ValueType::Text, "crs = \"EPSG:25832\"").default("as the file says").means(
        "The reference system of the model's coordinates, which determines position and north: its number in the EPSG \
             dataset, its name, WKT, or PROJ's text. See [georeference.md](georeference.md).",
    ),
    key("model", "casts", ValueType::Names, "casts = [\"roof\", \"walls\"]").default("true").means(
        "What casts shadows: everything but ground cover (roads, water), nothing, or what has one of the names; \
             `\"!glass\"` excludes what has the name glass.",
    ),
    key("model", "receives", ValueType::Names, "receives = true")
        .default("true")
        .means("What is judged, by names as in `casts`. Judging and drawings look through what does not receive."),
    key("model", "terrain", ValueType::Names, "terrain = true")
        .default("what the file's format marks as terrain")
        .means("What is [terrain](#terrain), by names as in `casts`: the measured ground."),
    key("ground", "level", ValueType::Number, "level = 0.0")
        .unit("metres")
        .default("[found from the models](#the-ground)")
        .means("The ground's height above the place's point."),
    key("study", "date", ValueType::Moment, "date = 2026-09-18")
        .default("`date` or `dates` is required")
        .means("The day."),
    key("study", "dates", ValueType::TwoMoments, "dates = [\"2026-01-01\", \"2026-12-31\"]")
        .default("`date` or `dates` is required")
        .means(
            "The first and the last of several days, at most ten years apart, each with the same window. Not \
             together with `date`.",
        ),
    key("study", "from", ValueType::Moment, "from = \"10:00\"")
        .default("with `dates` the day's beginning, otherwise required")
        .means("Where each day's window begins: a local clock time, `\"sunrise\"` or `\"sunrise+1h30\"`."),
    key("study", "to", ValueType::Moment, "to = \"14:00\"")
        .default("with `dates` the day's end, otherwise required")
        .means(
            "Where the window ends; a clock time earlier than `from` is on the next day. `\"sunset-1h30\"` is \
             allowed, too.",
        ),
    key("study", "step", ValueType::Text, "step = \"30min\"")
        .default("required")
        .means("The time from one instant to the next: `\"30min\"`, `\"1h\"`, `\"1h30\"`, `\"90s\"`."),
    key("study", "resolution", ValueType::Text, "resolution = \"1min\"")
        .default("on a single day `\"1min\"`, or the step where that is shorter; on several days `\"step\"`")
        .means(
            "The precision of the moments at which a cell's light changes between two instants, which are found by halving; see \
             [techniques.md](techniques.md#between-instants). `\"step\"` uses the instants alone.",
        ),
    key("study", "technique", ValueType::Word(technique_words), "technique = \"auto\"")
        .default("`\"auto\"`, the fastest exact one")
        .means("How shadows are found; see [techniques.md](techniques.md)."),
    key("plan", "region", ValueType::Numbers(4), "region = [-300, -300, 300, 300]")
        .unit("metres")
        .default("the models and their shadows, each shadow cut at 4.3 times its height (a sun below 13°)")
        .means("The rectangle's west, south, east and north border, measured from the place."),
    key("plan", "cell", ValueType::Number, "cell = 0.5")
        .unit("metres")
        .default("the longer side over 2048, but at least a millimetre")
        .means("The side of a cell."),
    key("camera", "eye", ValueType::Numbers(3), "eye = [250, -300, 180]")
        .unit("metres")
        .default("from the sunlit side, with the models and their shadows in view")
        .means("The camera's position, east, north and up of the place."),
    key("camera", "target", ValueType::Numbers(3), "target = [0, 0, 60]")
        .unit("metres")
        .default("the middle of what is in view")
        .means("The point that the camera looks at."),
    key("camera", "up", ValueType::Numbers(3), "up = [0, 0, 1]")
        .default("`[0, 0, 1]`")
        .means("The direction that is up in the picture."),
    key("camera", "fov", ValueType::Number, "fov = 40.0")
        .unit("degrees")
        .default("40")
        .means("The vertical field of view, 1 to 170."),
    key("camera", "side", ValueType::Word(side_words), "side = \"south\"").default("none").means(
        "Shows this side as an elevation, along parallel rays, instead of the perspective. It shows the same extent as the \
             perspective at `target`; without `eye`, all models.",
    ),
    key("probe", "name", ValueType::Text, "name = \"kitchen window\"")
        .default("probe 1, probe 2, …")
        .means("The point's name in the answer."),
    key("probe", "point", ValueType::Numbers(3), "point = [12.0, -3.0, 4.5]")
        .unit("metres")
        .default("required")
        .means("Its position, east, north and up of the place."),
    key("probe", "normal", ValueType::Numbers(3), "normal = [0, -1, 0]")
        .default("none: the sun may come from all sides")
        .means("The direction that it faces, like a window's, as a vector of any length except 0."),
    key("area", "name", ValueType::Text, "name = \"Garden, no. 12\"")
        .default("area 1, area 2, …; of a file each polygon's `name`")
        .means("What the verdict calls it. Beside `file` it chooses the polygon of that name."),
    key("area", "polygon", ValueType::Corners, "polygon = [[20, 95], [32, 95], [32, 104], [20, 104]]")
        .unit("metres")
        .default("`polygon`, `file` or `component` must be written")
        .means("Its corners in their order, east and north of the place. Its border must not cross or touch itself."),
    key("area", "file", ValueType::Text, "file = \"areas.geojson\"")
        .default("as `polygon`")
        .means("A GeoJSON file, relative to the site file, of whose polygons each is an area of its own, with its holes; its properties `name` and `dwelling` go before the keys."),
    key("area", "crs", ValueType::Text, "crs = \"EPSG:25832\"").default("as the file says").means(
        "The reference system of the file's coordinates, as `crs` under [[model]]. Coordinates of no map are metres east and \
         north of the place.",
    ),
    key("area", "component", ValueType::TextOrTexts, "component = \"roof garden\"")
        .default("as `polygon`")
        .means("The upper faces of these components, up to 60° steep, by names as in `casts`."),
    key("area", "height", ValueType::Number, "height = 0.0")
        .unit("metres")
        .default("0: on the ground, which is the terrain, or where there is none the plane")
        .means("How high above the ground it lies, following the terrain."),
    key("area", "level", ValueType::Number, "level = 12.5")
        .unit("metres")
        .default("none: it follows the ground")
        .means("The height above the place's point of an area that is level wherever the ground lies: a roof terrace, a podium."),
    key("area", "dwelling", ValueType::Text, "dwelling = \"flat 12\"")
        .default("none")
        .means("The dwelling whose open space it is, as of a window. Only rules that judge dwellings ask for it."),
    key("window", "name", ValueType::Text, "name = \"kitchen\"")
        .default("of a component's names the one that tells it best from the others, or window 1, window 2, …")
        .means("What the verdict calls it; several panes are numbered."),
    key("window", "component", ValueType::TextOrTexts, "component = \"IfcWindow/Glass\"")
        .default("`component` or `corners` must be written")
        .means(
            "The components that are glass, by names as in `casts`: each flat piece that is connected is one window. They let \
             light through and cast nothing where a rule is judged.",
        ),
    key("window", "corners", ValueType::FourPoints, "corners = [[0, 0, 1], [1.2, 0, 1], [1.2, 0, 2.4], [0, 0, 2.4]]")
        .unit("metres")
        .default("as `component`")
        .means(
            "The corners of its glass as they are seen from outside: the sill's left and right end, the head's right and left \
             end.",
        ),
    key("window", "room", ValueType::Text, "room = \"living room\"")
        .default("none")
        .means("The room to which it belongs."),
    key("window", "dwelling", ValueType::Text, "dwelling = \"flat 3\"")
        .default("none")
        .means("The dwelling to which its room belongs."),
    key("window", "usage", ValueType::Text, "usage = \"living\"")
        .default("none")
        .means("What the room is used for, in the rule's own word."),
    key("window", "reveal", ValueType::Number, "reveal = 0.15")
        .unit("metres")
        .default("measured at the wall beside it")
        .means("How far the glass lies behind the wall's outer plane."),
    key("window", "inner", ValueType::Number, "inner = 0.2")
        .unit("metres")
        .default("none; a rule that judges the wall's inner plane asks for it")
        .means("How far the wall's inner plane lies behind the glass."),
    key("window", "floor", ValueType::Number, "floor = 3.2")
        .unit("metres")
        .default("none; a rule that counts from the floor asks for it")
        .means("The height of the room's floor above the place's point."),
    key("window", "room_area", ValueType::Number, "room_area = 24.5")
        .unit("square metres")
        .default("none; a rule that weighs rooms asks for it")
        .means("The floor area of the room."),
    key("window", "rooms", ValueType::Text, "rooms = \"rooms.csv\"").default("none").means(
        "A [table](#windows-and-their-rooms) that says the room of each window by its name. It goes before the other keys.",
    ),
    key("facade", "name", ValueType::Text, "name = \"south front\"")
        .default("façade 1, façade 2, …")
        .means("What the verdict calls it."),
    key("facade", "component", ValueType::TextOrTexts, "component = \"IfcWall/Render\"")
        .default("must be written")
        .means("The components whose upright faces are judged, by names as in `casts`."),
    key("facade", "spacing", ValueType::Number, "spacing = 1.0")
        .unit("metres")
        .default("1")
        .means("From point to point along the wall, and from row to row."),
    key("facade", "heights", ValueType::NumberList, "heights = [1.5, 4.5]")
        .unit("metres")
        .default("rows from the bottom to the top, `spacing` apart")
        .means("The heights of the rows of points above the ground's plane."),
    key("plot", "border", ValueType::Corners, "border = [[0, 0], [30, 0], [30, 20], [0, 20]]")
        .unit("metres")
        .default("`border` or `file` must be written")
        .means("Its corners in their order, east and north of the place."),
    key("plot", "file", ValueType::Text, "file = \"plot.geojson\"")
        .default("as `border`")
        .means("A GeoJSON file with one polygon."),
    key("plot", "crs", ValueType::Text, "crs = \"EPSG:25832\"")
        .default("as the file says")
        .means("The reference system of the file's coordinates."),
    key("plot", "roads", ValueType::Sides("width"), "roads = [{ side = 1, width = 6.0 }]")
        .unit("metres")
        .default("none")
        .means("The sides along which a road or water lies, with its width. Side 1 runs from the first corner to the second."),
    key("plot", "neighbours", ValueType::Sides("higher"), "neighbours = [{ side = 3, higher = 1.5 }]")
        .unit("metres")
        .default("none: level with the mean ground")
        .means("By how much the neighbour's ground along a side lies higher than the mean ground; negative where it lies lower."),
    key("plot", "mean_ground", ValueType::Number, "mean_ground = 0.2")
        .unit("metres")
        .default("none; a rule that counts from it asks for it")
        .means("The mean level of the ground at the building, above the place's point."),
    key("before", "site", ValueType::Text, "site = \"without.toml\"")
        .default("this one, with `absent` or `demolished`")
        .means("The site file of the state before. Its models and its ground count; place and days are those of this one."),
    key("before", "absent", ValueType::TextOrTexts, "absent = [\"proposed\"]")
        .default("none")
        .means("The components that do not stand before, by names as in `casts`."),
    key("before", "demolished", ValueType::TextOrTexts, "demolished = [\"old barn\"]")
        .default("none")
        .means(
            "The components that stand before alone, by names as in `casts`: in no other study of this site they cast or \
             receive.",
        ),
];
