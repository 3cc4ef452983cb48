//! Shifts of datums to WGS 84, by parameters only, since the program has no grids.

/// A definition that `proj4rs` accepts, with information about its datum.
pub(super) struct UsableText {
    pub(super) text: String,
    /// The datum or its parameters; empty if it is WGS 84 to within a metre.
    pub(super) shift: String,
    pub(super) doubt: Option<&'static str>,
}

/// NAD27 to WGS 84 in the contiguous United States, EPSG:1173.
const NAD27: &str = "+towgs84=-8,160,176";
/// NZGD49 to WGS 84, EPSG:1564.
const NZGD49: &str = "+towgs84=59.47,-5.04,187.44,0.47,-0.1,1.024,-4.5993";

const NAD27_DOUBT: &str = "Gnomon shifts NAD27 by three parameters, which are off by up to ten metres in the contiguous United States, and by \
     more elsewhere";
const UNKNOWN_DOUBT: &str =
    "how its datum is shifted to WGS 84 is not known here, so places in it may be off by some hundred metres";

/// Replaces grids in a definition by parameters, or refuses it. No file that a text names is opened.
pub(super) fn usable(definition: &str) -> Result<UsableText, &'static str> {
    let mut tokens: Vec<&str> = Vec::new();
    let (mut shift, mut doubt, mut is_known) = (String::new(), None, false);
    let mut ellipsoid = "WGS84";
    for token in definition.trim_end_matches('`').split_whitespace() {
        let (key, value) = token.trim_start_matches('+').split_once('=').unwrap_or((token.trim_start_matches('+'), ""));
        match (key, value) {
            ("nadgrids", "@null") => is_known = true,
            // an old grid of New Zealand
            ("nadgrids", "nzgd2kgrid0005.gsb") => {
                (shift, is_known) = (NZGD49.to_owned(), true);
                tokens.push(NZGD49);
                continue;
            }
            ("nadgrids", _) => return Err("shifting its datum needs a grid, which Gnomon does not have"),
            ("datum", "NAD27") => {
                (shift, is_known, doubt) = (NAD27.to_owned(), true, Some(NAD27_DOUBT));
                tokens.extend(["+ellps=clrk66", NAD27]);
                continue;
            }
            ("datum", name) => {
                is_known = true;
                if !matches!(name, "WGS84" | "NAD83") {
                    token.clone_into(&mut shift);
                }
            }
            ("towgs84", values) => {
                is_known = true;
                if values.split(',').any(|value| value.trim().parse() != Ok(0.0)) {
                    token.clone_into(&mut shift);
                }
            }
            ("ellps", name) => ellipsoid = name,
            ("a" | "R", _) => ellipsoid = "",
            ("geoidgrids", _) => continue,
            _ => {}
        }
        tokens.push(token);
    }
    let is_near_wgs84 = matches!(ellipsoid, "GRS80" | "WGS84");
    if !is_known && !is_near_wgs84 {
        doubt = Some(UNKNOWN_DOUBT);
    }
    Ok(UsableText { text: tokens.join(" "), shift, doubt })
}
