//! Reads reference systems in WKT of either version. A system is identified by its EPSG number, by its name, or by its
//! parameters, since the `.prj` files of some programs have no number.

use super::definition::{Definition, shortened, unknown};
use super::names::{by_code, by_name};
use crate::message::{Message, message};
use std::fmt::Write as _;

/// The deepest nesting of brackets; real texts have eight.
const DEEPEST: usize = 24;

/// `KEYWORD["text", 1.0, OTHER[…]]`
#[derive(Debug, Default)]
struct WktNode {
    /// In upper case.
    keyword: String,
    /// Its texts and numbers, in order, without quotes.
    values: Vec<String>,
    nodes: Vec<WktNode>,
}

/// Reads the definition in a WKT text.
///
/// # Errors
/// Text that cannot be read, or an unknown system.
pub(super) fn definition(text: &str) -> Result<Definition, Message> {
    let mut rest = text;
    let root = node(&mut rest, 0).ok_or_else(|| {
        message![
            format!("{} is not complete WKT", shortened(text));
            "write the system's number in the EPSG dataset instead, for example \"EPSG:25832\""
        ]
    })?;
    let root = match root.keyword.as_str() {
        "BOUNDCRS" => root.child(&["SOURCECRS"]).and_then(|source| source.nodes.first()).unwrap_or(&root),
        _ => &root,
    };
    let is_compound = matches!(root.keyword.as_str(), "COMPD_CS" | "COMPOUNDCRS");
    let ground = if is_compound { root.nodes.iter().find(|node| node.is_on_ground()) } else { Some(root) };
    let heights = root.child(&["VERT_CS", "VERTCRS", "VERTICALCRS"]);
    let height_unit_m = heights.and_then(WktNode::unit);
    let ground = ground.filter(|node| node.is_on_ground()).ok_or_else(|| unknown(text))?;
    let known = root.code().and_then(by_code).or_else(|| ground.code().and_then(by_code));
    let found = known.or_else(|| by_name(ground.name())).or_else(|| by_parameters(ground));
    let found = found.ok_or_else(|| unknown(ground.name()))?;
    Ok(Definition { height_unit_m: height_unit_m.or(found.height_unit_m), ..found })
}

/// Reads a node, and leaves the text after it.
fn node(rest: &mut &str, depth: usize) -> Option<WktNode> {
    let open = rest.find(['[', '('])?;
    let keyword = rest[..open].trim().to_uppercase();
    if depth > DEEPEST
        || keyword.is_empty()
        || !keyword.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
    {
        return None;
    }
    let mut found = WktNode { keyword, ..WktNode::default() };
    *rest = &rest[open + 1..];
    loop {
        *rest = rest.trim_start_matches(|letter: char| letter.is_whitespace() || letter == ',');
        if let Some(behind) = rest.strip_prefix([']', ')']) {
            *rest = behind;
            return Some(found);
        }
        if let Some(quoted) = rest.strip_prefix('"') {
            let end = quoted.find('"')?;
            found.values.push(quoted[..end].to_owned());
            *rest = &quoted[end + 1..];
            continue;
        }
        let end = rest.find(['[', '(', ']', ')', ','])?;
        if rest[end..].starts_with(['[', '(']) {
            found.nodes.push(node(rest, depth + 1)?);
        } else {
            found.values.push(rest[..end].trim().to_owned());
            *rest = &rest[end..];
        }
    }
}

impl WktNode {
    fn name(&self) -> &str {
        self.values.first().map_or("", String::as_str)
    }

    fn child(&self, keywords: &[&str]) -> Option<&WktNode> {
        self.nodes.iter().find(|node| keywords.contains(&node.keyword.as_str()))
    }

    /// The first node below this one, at any depth, with one of some keywords.
    fn below(&self, keywords: &[&str]) -> Option<&WktNode> {
        self.child(keywords).or_else(|| self.nodes.iter().find_map(|node| node.below(keywords)))
    }

    /// Its EPSG number.
    fn code(&self) -> Option<u32> {
        let ids = self.nodes.iter().filter(|node| matches!(node.keyword.as_str(), "AUTHORITY" | "ID"));
        let of_epsg = ids.filter(|id| id.name().eq_ignore_ascii_case("EPSG") || id.name().eq_ignore_ascii_case("ESRI"));
        of_epsg.filter_map(|id| id.number(1)).find(|code| *code >= 0.0 && *code < 1e7).map(|code| code as u32)
    }

    fn number(&self, index: usize) -> Option<f64> {
        self.values.get(index)?.parse().ok().filter(|value: &f64| value.is_finite())
    }

    fn is_on_ground(&self) -> bool {
        const GROUND: &[&str] = &[
            "PROJCS",
            "PROJCRS",
            "PROJECTEDCRS",
            "GEOGCS",
            "GEOGCRS",
            "GEOGRAPHICCRS",
            "GEODCRS",
            "GEODETICCRS",
            "GEOCCS",
            "BOUNDCRS",
        ];
        GROUND.contains(&self.keyword.as_str())
    }

    /// The unit of length in metres: its own, or that of its axes.
    fn unit(&self) -> Option<f64> {
        let units = &["UNIT", "LENGTHUNIT"];
        let unit = self.child(units).or_else(|| self.child(&["AXIS"])?.child(units))?;
        unit.number(1).filter(|unit| *unit > 0.0)
    }
}

/// PROJ's names of map parameters, with their normalised names in both WKT versions.
const PARAMETERS: &[(&str, &[&str])] = &[
    ("lat_0", &["latitudeoforigin", "latitudeofnaturalorigin", "latitudeoffalseorigin", "latitudeofcenter"]),
    (
        "lon_0",
        &[
            "centralmeridian",
            "longitudeofnaturalorigin",
            "longitudeoffalseorigin",
            "longitudeofcenter",
            "longitudeoforigin",
        ],
    ),
    ("k", &["scalefactor", "scalefactoratnaturalorigin"]),
    ("x_0", &["falseeasting", "eastingatfalseorigin"]),
    ("y_0", &["falsenorthing", "northingatfalseorigin"]),
    ("lat_1", &["standardparallel1", "latitudeof1ststandardparallel"]),
    ("lat_2", &["standardparallel2", "latitudeof2ndstandardparallel"]),
];

/// The projections whose parameters always have the same meaning.
const METHODS: &[(&str, &[&str])] = &[
    ("tmerc", &["transversemercator", "gausskruger"]),
    (
        "lcc",
        &[
            "lambertconformalconic",
            "lambertconformalconic1sp",
            "lambertconformalconic2sp",
            "lambertconicconformal1sp",
            "lambertconicconformal2sp",
        ],
    ),
    ("aea", &["albers", "albersconicequalarea", "albersequalarea"]),
    ("sterea", &["obliquestereographic", "doublestereographic"]),
];

/// Datums that are WGS 84 to within a metre, and some with a shift; normalised names without the `D_` of some programs.
const DATUMS: &[(&str, &str)] = &[
    ("wgs1984", "+datum=WGS84"),
    ("worldgeodeticsystem1984", "+datum=WGS84"),
    ("etrs1989", "+ellps=GRS80 +towgs84=0,0,0"),
    ("europeanterrestrialreferencesystem1989", "+ellps=GRS80 +towgs84=0,0,0"),
    ("northamerican1983", "+datum=NAD83"),
    ("northamericandatum1983", "+datum=NAD83"),
    ("gda1994", "+ellps=GRS80 +towgs84=0,0,0"),
    ("gda2020", "+ellps=GRS80 +towgs84=0,0,0"),
    ("nzgd2000", "+ellps=GRS80 +towgs84=0,0,0"),
    ("rgf1993", "+ellps=GRS80 +towgs84=0,0,0"),
    ("sweref99", "+ellps=GRS80 +towgs84=0,0,0"),
    ("deutscheshauptdreiecksnetz", "+datum=potsdam"),
    ("osgb1936", "+datum=OSGB36"),
    ("mgi", "+datum=hermannskogel"),
    ("northamerican1927", "+datum=NAD27"),
];

fn compared(name: &str) -> String {
    name.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// PROJ's text for a system without a number; `None` if a part of it is unknown.
fn by_parameters(crs: &WktNode) -> Option<Definition> {
    let datum = datum(crs)?;
    let name = shortened(crs.name());
    let definition = |proj: String| Definition { name, proj, height_unit_m: None, doubt: None };
    if !crs.keyword.starts_with("PROJ") {
        let is_geographic = crs.keyword.starts_with("GEOG");
        return is_geographic.then(|| definition(format!("+proj=longlat {datum} +no_defs")));
    }
    let method = compared(crs.below(&["PROJECTION", "METHOD"])?.name());
    let (proj, _) = METHODS.iter().find(|(_, names)| names.contains(&method.as_str()))?;
    let unit = crs.unit().unwrap_or(1.0);
    let mut text = format!("+proj={proj} {datum} +to_meter={unit}");
    let list = crs.child(&["CONVERSION"]).unwrap_or(crs);
    for parameter in list.nodes.iter().filter(|node| node.keyword == "PARAMETER") {
        let called = compared(parameter.name());
        let (key, _) = PARAMETERS.iter().find(|(_, names)| names.contains(&called.as_str()))?;
        let value = parameter.number(1)?;
        let is_length = matches!(*key, "x_0" | "y_0");
        // in version 2 each parameter has its unit, in version 1 it is the map's
        let own = parameter.child(&["LENGTHUNIT", "UNIT"]).and_then(|unit| unit.number(1));
        let metres = own.unwrap_or(if list.keyword == "CONVERSION" { 1.0 } else { unit });
        // writing to a String cannot fail
        let _ = write!(text, " +{key}={}", if is_length { value * metres } else { value });
    }
    text.push_str(" +no_defs");
    Some(definition(text))
}

/// The datum part of PROJ's text: a known datum, or its ellipsoid with the shift in the text.
fn datum(crs: &WktNode) -> Option<String> {
    let datum = crs.below(&["DATUM", "GEODETICDATUM", "ENSEMBLE"])?;
    // only degrees relative to Greenwich, so that no angle is misread
    let meridian = crs.below(&["PRIMEM", "PRIMEMERIDIAN"]).and_then(|meridian| meridian.number(1)).unwrap_or(0.0);
    let name = compared(datum.name().trim_start_matches("D_"));
    let known = DATUMS.iter().find(|(known, _)| *known == name).map(|(_, text)| (*text).to_owned());
    let of_text = || {
        let ellipsoid = crs.below(&["SPHEROID", "ELLIPSOID"])?;
        let (radius, flattening) = (ellipsoid.number(1)?, ellipsoid.number(2)?);
        let mut text = match flattening {
            0.0 => format!("+a={radius} +b={radius}"),
            _ => format!("+a={radius} +rf={flattening}"),
        };
        if let Some(shift) = crs.below(&["TOWGS84"]) {
            let _ = write!(text, " +towgs84={}", shift.values.join(","));
        }
        Some(text)
    };
    let text = known.or_else(of_text)?;
    Some(if meridian == 0.0 { text } else { format!("{text} +pm={meridian}") })
}
