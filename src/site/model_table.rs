//! Checks a table `[[model]]`.

use super::SiteError;
use super::file::Names;
use super::keys;
use super::overrides::refuse;
use super::placement::Placement;
use super::written::WrittenSite;
use crate::choice::ChoiceError;
use crate::formats::POINT_CLASSES;
use crate::message::{Message, message};
use glam::DVec3;
use std::path::PathBuf;

/// Returns the path of one of the models, and how it is read and placed.
pub(super) fn placed(written: &WrittenSite, index: usize) -> Result<(PathBuf, Placement), SiteError> {
    let table = &written.site.model[index];
    let wrong = |key: &str, message: Message| refuse(written.model_key(index, key), message);
    let Some(path) = &table.path else {
        let model = keys::numbered("model", index, written.site.model.len());
        return Err(written.missing(format!("path in {model}"), keys::example("model", "path")));
    };
    if let Some(north_deg) = table.north.filter(|north| !north.is_finite()) {
        return Err(wrong("north", message![format!("{north_deg} is not an angle"); "write degrees, for example 0.0"]));
    }
    let position = table.position.map(DVec3::from_array);
    if let Some(position) = position.filter(|position| !position.is_finite()) {
        let message = message![format!("{position} is not a point"); "write metres, for example [0.0, 0.0, 0.0]"];
        return Err(wrong("position", message));
    }
    let above_zero = |key: &str, value: Option<f64>, what: &str, hint: &'static str| match value {
        // true for NaN
        Some(value) if !(value.is_finite() && value > 0.0) => {
            Err(wrong(key, message![format!("{value} is not a {what}"); hint]))
        }
        value => Ok(value),
    };
    let hint = "write metres per model unit above 0, for example 0.001 for millimetres";
    let scale = above_zero("scale", table.scale, "scale", hint)?;
    let hint = "write metres above 0, for example 9.0";
    let default_height_m = above_zero("default_height", table.default_height, "height", hint)?;
    let hint = "write metres above 0, for example 0.5";
    let terrain_error_m = above_zero("terrain_error", table.terrain_error, "error", hint)?;
    let up = match &table.up {
        Some(word) => Some(word.parse().map_err(|error: ChoiceError| wrong("up", error.to_string().into()))?),
        None => None,
    };
    let placement = Placement {
        scene: table.scene.clone(),
        default_height_m,
        terrain_error_m,
        layers: table.layers.clone().map(Names::Some),
        point_classes: classes(table.classes.as_deref(), wrong)?,
        up,
        north_rad: table.north.map(f64::to_radians),
        position,
        scale,
        crs: table.crs.clone(),
    };
    Ok((written.folder.join(path), placement))
}

/// Checks the requested classes of points.
fn classes(asked: Option<&[String]>, wrong: impl Fn(&str, Message) -> SiteError) -> Result<Vec<String>, SiteError> {
    let asked = asked.unwrap_or_default();
    match asked.iter().find(|class| !POINT_CLASSES.contains(&class.as_str())) {
        Some(class) => {
            let what = format!("\"{class}\" is not a class of points");
            Err(wrong("classes", message![what; format!("write some of {}", POINT_CLASSES.join(", "))]))
        }
        None => Ok(asked.to_vec()),
    }
}
