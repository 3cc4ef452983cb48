//! The request as written → as meant.

use super::asked::{Overrides, refuse};
use super::error::{At, SiteError, nearest};
use super::extent::{Bounds, with_shadows};
use super::file::Names;
use super::model::{self, ModelError, Placement};
use super::written::Written;
use super::{Finder, Method, Receivers, Site, camera, keys, plan, study};
use crate::mesh::patches::DEFAULT_CELL_M;
use crate::mesh::{Mesh, Part};
use crate::sun::{Place, SunTrack};
use glam::DVec3;
use std::path::Path;

/// A shadow that is longer than this, in heights, does not make the default region larger:
/// 4.3 is the length at an altitude of 13°.
pub(super) const SHADOW_CUT: f64 = 4.3;
/// As [`SHADOW_CUT`], for what the default camera must see.
const VIEW_CUT: f64 = 1.5;

/// The place and its sun alone; the models are not read.
///
/// # Errors
/// Everything that can be wrong with a site file's form, its place and its study.
pub fn load_sun(path: &Path, asked: &Overrides) -> Result<(Place, SunTrack), SiteError> {
    let written = Written::read(path, asked)?;
    let place = written.place(asked)?;
    let track = study::track(&place, &written, asked)?;
    Ok((place, track))
}

/// Whose coordinates a mesh has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// East, north, up from the place's point: models as a site places them.
    Place,
    /// A model file's own axes, turned z up.
    Model,
}

/// The models' mesh alone: of a model file as it is, or of a site's models where they stand. Place and study may be
/// absent.
///
/// # Errors
/// Everything that can be wrong with a site file's form and its models.
pub fn load_mesh(path: &Path) -> Result<(Mesh, Frame), SiteError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if matches!(extension.as_str(), "glb" | "gltf") && !path.is_dir() {
        return Ok((Mesh::build(model::load(path, &Placement::default())?)?, Frame::Model));
    }
    let written = Written::read(path, &Overrides::default())?;
    if written.site.model.is_empty() {
        return Err(no_model(&written));
    }
    let mut parts = Vec::new();
    for index in 0..written.site.model.len() {
        parts.extend(read(&written, index, &model::load)?);
    }
    Ok((Mesh::build(parts)?, Frame::Place))
}

impl Site {
    /// Reads and checks a request: `path` is a site file, a folder that holds a `site.toml`,
    /// or a model file together with `asked.place`.
    ///
    /// # Errors
    /// Everything that can be wrong with it, each naming the file, the key or option, and the way out.
    pub fn load(path: &Path, asked: &Overrides) -> Result<Site, SiteError> {
        Self::load_with(path, asked, model::load)
    }

    /// As [`Site::load`], with another reader of model files.
    ///
    /// # Errors
    /// As [`Site::load`].
    pub fn load_with(
        path: &Path,
        asked: &Overrides,
        read_model: impl Fn(&Path, &Placement) -> Result<Vec<Part>, ModelError>,
    ) -> Result<Site, SiteError> {
        Self::of(&Written::read(path, asked)?, asked, read_model)
    }

    /// As [`Site::load_with`], of a request that is in memory.
    ///
    /// # Errors
    /// As [`Site::load`].
    pub fn of(
        written: &Written,
        asked: &Overrides,
        read_model: impl Fn(&Path, &Placement) -> Result<Vec<Part>, ModelError>,
    ) -> Result<Site, SiteError> {
        let place = written.place(asked)?;
        // Cheap and quick to fail; models come last.
        let track = study::track(&place, written, asked)?;
        let method = method(written, asked)?;
        if asked.hextree_depth.is_some() && asked.silhouette != Some(Finder::Hextree) {
            let what = "is the depth of the paper's hextree; say --silhouette hextree with it, or leave it out";
            return Err(refuse(At::Option("--hextree-depth"), what));
        }
        // a NaN is not above zero either
        if let Some(width) = asked.settings.smoothie_width_m.filter(|width| !(width.is_finite() && *width > 0.0)) {
            let what = format!("{width} is no width; write metres above 0, for example --smoothie-width 0.5");
            return Err(refuse(At::Option("--smoothie-width"), what));
        }
        let receivers = asked.receivers.unwrap_or_default();
        let patch_cell = patch_cell(receivers, asked)?;
        let level = ground_level(written)?;
        let Models { mesh, casts, receives, bounds } = Models::read(written, read_model)?;
        let ground = level.unwrap_or(bounds.low.z);
        let shadows = |cut| with_shadows(&mesh, bounds, &casts, ground, &track, cut);
        let grid = plan::grid(written, asked, shadows(SHADOW_CUT))?;
        let camera = camera::camera(written, bounds, shadows(VIEW_CUT), ground, &track)?;
        Ok(Site {
            place,
            mesh,
            casts,
            receives,
            ground,
            track,
            grid,
            camera,
            receivers,
            patch_cell,
            method,
            finder: asked.silhouette.unwrap_or_default(),
            hextree_depth: asked.hextree_depth,
            engine: asked.engine.unwrap_or_default(),
            settings: asked.settings,
        })
    }
}

/// The models, and what the site file says of their components.
pub(super) struct Models {
    pub(super) mesh: Mesh,
    pub(super) casts: Vec<bool>,
    pub(super) receives: Vec<bool>,
    pub(super) bounds: Bounds,
}

impl Models {
    /// Reads all of them; there must be a triangle.
    pub(super) fn read(
        written: &Written,
        read_model: impl Fn(&Path, &Placement) -> Result<Vec<Part>, ModelError>,
    ) -> Result<Models, SiteError> {
        if written.site.model.is_empty() {
            return Err(no_model(written));
        }
        let mut parts = Vec::new();
        let (mut casts, mut receives) = (Vec::new(), Vec::new());
        for index in 0..written.site.model.len() {
            let model = read(written, index, &read_model)?;
            let table = &written.site.model[index];
            casts.extend(chosen(written, index, "casts", &table.casts, &model)?);
            receives.extend(chosen(written, index, "receives", &table.receives, &model)?);
            parts.extend(model);
        }
        // One component a part, in their order: `casts` and `receives` fit the mesh.
        let mesh = Mesh::build(parts)?;
        let bounds = Bounds::of(&mesh).ok_or_else(|| SiteError::NoTriangles { file: written.file.clone() })?;
        Ok(Models { mesh, casts, receives, bounds })
    }
}

fn no_model(written: &Written) -> SiteError {
    written.missing("[[model]]", "[[model]] with path = \"tower.glb\"")
}

fn method(written: &Written, asked: &Overrides) -> Result<Method, SiteError> {
    match (asked.technique, &written.site.study.technique) {
        (Some(method), _) => Ok(method),
        (None, Some(word)) => word
            .parse()
            .map_err(|error: super::ChoiceError| refuse(written.key("study", "technique"), error.to_string())),
        (None, None) => Ok(Method::default()),
    }
}

/// The ground's height, where it is written.
pub(super) fn ground_level(written: &Written) -> Result<Option<f64>, SiteError> {
    match written.site.ground.level {
        Some(level) if !level.is_finite() => {
            let what = format!("{level} is no height; write metres, for example 0.0");
            Err(refuse(written.key("ground", "level"), what))
        }
        level => Ok(level),
    }
}

/// Metres of a texel on surfaces.
fn patch_cell(receivers: Receivers, asked: &Overrides) -> Result<f64, SiteError> {
    let at = At::Option("--patch-cell");
    match asked.patch_cell {
        None => Ok(DEFAULT_CELL_M),
        Some(_) if receivers != Receivers::Surfaces => {
            Err(refuse(at, "is the cell on surfaces; say --receivers surfaces with it, or leave it out"))
        }
        Some(cell) if cell.is_finite() && cell > 0.0 => Ok(cell),
        Some(cell) => {
            Err(refuse(at, format!("{cell} is no cell; write metres above 0, for example --patch-cell 0.25")))
        }
    }
}

/// The parts of one of the models.
fn read(
    written: &Written,
    index: usize,
    read_model: &impl Fn(&Path, &Placement) -> Result<Vec<Part>, ModelError>,
) -> Result<Vec<Part>, SiteError> {
    let table = &written.site.model[index];
    let at = |key: &str| written.model_key(index, key);
    let Some(path) = &table.path else {
        let model = keys::numbered("model", index, written.site.model.len());
        return Err(written.missing(format!("path in {model}"), keys::example("model", "path")));
    };
    let north_deg = table.north.unwrap_or(0.0);
    if !north_deg.is_finite() {
        return Err(refuse(at("north"), format!("{north_deg} is no angle; write degrees, for example 0.0")));
    }
    let position = DVec3::from_array(table.position.unwrap_or_default());
    if !position.is_finite() {
        return Err(refuse(
            at("position"),
            format!("{position} is no point; write metres, for example [0.0, 0.0, 0.0]"),
        ));
    }
    let scale = table.scale.unwrap_or(1.0);
    // A NaN is not above zero either.
    if !(scale.is_finite() && scale > 0.0) {
        return Err(refuse(
            at("scale"),
            format!("{scale} is no scale; write metres per model unit above 0, for example 0.001 for millimetres"),
        ));
    }
    let file = written.folder.join(path);
    if !file.is_file() {
        return Err(refuse(
            at("path"),
            format!("there is no file {}; write where the model lies, from the site file's folder", file.display()),
        ));
    }
    let placement = Placement { north_rad: north_deg.to_radians(), position, scale };
    Ok(read_model(&file, &placement)?)
}

/// Per part, whether a name (or all) means it.
fn chosen(written: &Written, index: usize, key: &str, names: &Names, parts: &[Part]) -> Result<Vec<bool>, SiteError> {
    let names = match names {
        Names::All(all) => return Ok(vec![*all; parts.len()]),
        Names::Some(names) => names,
    };
    let means = |name: &String, part: &Part| part.name == *name || part.aliases.contains(name);
    for name in names {
        if !parts.iter().any(|part| means(name, part)) {
            let known = parts.iter().flat_map(|part| part.aliases.iter().chain([&part.name])).map(String::as_str);
            return Err(SiteError::UnknownName {
                at: written.model_key(index, key),
                name: name.clone(),
                nearest: nearest(name, known).unwrap_or_default().to_owned(),
            });
        }
    }
    Ok(parts.iter().map(|part| names.iter().any(|name| means(name, part))).collect())
}
