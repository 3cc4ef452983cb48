//! The models of a site where they stand, and which of their components are chosen.

use super::asked::refuse;
use super::error::{SiteError, nearest};
use super::extent::Bounds;
use super::file::Names;
use super::keys;
use super::model::{ModelError, Placement};
use super::written::Written;
use crate::mesh::{Component, Mesh, Part};
use glam::DVec3;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The models, joined to one mesh, whatever is asked of them. A copy shares all that is large.
#[derive(Clone, Debug)]
pub struct Models {
    pub(super) mesh: Mesh,
    pub(super) bounds: Bounds,
    /// Which components are whose.
    of_model: Vec<Range<usize>>,
    sources: Vec<Source>,
}

/// Where a model comes from, and where it stands.
#[derive(Clone, Debug, PartialEq)]
struct Source {
    file: PathBuf,
    /// When the file was changed last, and its bytes; none where the system does not tell, and where the file names others
    /// that may change.
    stamp: Option<(SystemTime, u64)>,
    placement: Placement,
}

impl Models {
    /// Reads all of them; there must be a triangle.
    ///
    /// # Errors
    /// Everything that can be wrong with a site file's models.
    pub fn read(
        written: &Written,
        read_model: impl Fn(&Path, &Placement) -> Result<Vec<Part>, ModelError>,
    ) -> Result<Models, SiteError> {
        // a file that changes while it is read is read again
        let sources = sources(written)?;
        let (mesh, of_model) = mesh(written, read_model)?;
        let bounds = Bounds::of(&mesh).ok_or_else(|| SiteError::NoTriangles { file: written.file.clone() })?;
        Ok(Models { mesh, bounds, of_model, sources })
    }

    /// Whether these are the very models that a request asks for, standing where it says, their files unchanged since.
    pub fn are_those_of(&self, written: &Written) -> bool {
        sources(written).is_ok_and(|sources| sources == self.sources && sources.iter().all(|of| of.stamp.is_some()))
    }

    /// How many components each model has.
    pub fn component_counts(&self) -> Vec<usize> {
        self.of_model.iter().map(Range::len).collect()
    }

    /// Per component whether it casts, and whether it receives, as a request says it.
    pub(super) fn roles(&self, written: &Written) -> Result<[Vec<bool>; 2], SiteError> {
        let mut roles = [Vec::new(), Vec::new()];
        for (index, (table, of_model)) in written.site.model.iter().zip(&self.of_model).enumerate() {
            let components = &self.mesh.components[of_model.clone()];
            roles[0].extend(chosen(written, index, "casts", &table.casts, components)?);
            roles[1].extend(chosen(written, index, "receives", &table.receives, components)?);
        }
        Ok(roles)
    }
}

/// All models as one mesh, one component a part, in their order; and which are whose.
pub(super) fn mesh(
    written: &Written,
    read_model: impl Fn(&Path, &Placement) -> Result<Vec<Part>, ModelError>,
) -> Result<(Mesh, Vec<Range<usize>>), SiteError> {
    let count = written.site.model.len();
    if count == 0 {
        return Err(written.missing("[[model]]", "[[model]] with path = \"tower.glb\""));
    }
    let (mut parts, mut of_model) = (Vec::new(), Vec::new());
    for index in 0..count {
        let (file, placement) = placed(written, index)?;
        let first = parts.len();
        parts.extend(read_model(&file, &placement)?);
        of_model.push(first..parts.len());
    }
    Ok((Mesh::build(parts)?, of_model))
}

fn sources(written: &Written) -> Result<Vec<Source>, SiteError> {
    let source = |index| {
        let (file, placement) = placed(written, index)?;
        let is_whole = file.extension().is_some_and(|is| is.eq_ignore_ascii_case("glb"));
        let told = file.metadata().ok().filter(|_| is_whole);
        let stamp = told.and_then(|told| Some((told.modified().ok()?, told.len())));
        Ok(Source { file, stamp, placement })
    };
    (0..written.site.model.len()).map(source).collect()
}

/// Where one of the models lies, and where it stands.
fn placed(written: &Written, index: usize) -> Result<(PathBuf, Placement), SiteError> {
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
    Ok((file, Placement { north_rad: north_deg.to_radians(), position, scale }))
}

/// Per component, whether a name (or all) means it.
fn chosen(
    written: &Written,
    index: usize,
    key: &str,
    names: &Names,
    components: &[Component],
) -> Result<Vec<bool>, SiteError> {
    let names = match names {
        Names::All(all) => return Ok(vec![*all; components.len()]),
        Names::Some(names) => names,
    };
    let means = |name: &String, of: &Component| of.name == *name || of.aliases.contains(name);
    for name in names {
        if !components.iter().any(|component| means(name, component)) {
            let known = components.iter().flat_map(|of| of.aliases.iter().chain([&of.name])).map(String::as_str);
            return Err(SiteError::UnknownName {
                at: written.model_key(index, key),
                name: name.clone(),
                nearest: nearest(name, known).unwrap_or_default().to_owned(),
            });
        }
    }
    Ok(components.iter().map(|component| names.iter().any(|name| means(name, component))).collect())
}
