//! The models of a site where they stand, and which of their components are chosen.

use super::asked::refuse;
use super::error::{SiteError, nearest};
use super::extent::Bounds;
use super::file::Names;
use super::ground::Ground;
use super::keys;
use super::load::Frame;
use super::model::{Model, ModelError, Placement};
use super::notes;
use super::written::Written;
use crate::mesh::{Component, Mesh};
use glam::DVec3;
use rustc_hash::FxBuildHasher;
use std::hash::BuildHasher;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The models, joined to one mesh, whatever is asked of them. A copy shares all that is large.
#[derive(Clone, Debug)]
pub struct Models {
    pub(super) mesh: Mesh,
    pub(super) bounds: Bounds,
    /// What the user should know of how they were read, each a sentence without its stop that names the model.
    pub(super) notes: Vec<String>,
    /// Which components are whose.
    of_model: Vec<Range<usize>>,
    sources: Vec<Source>,
    mark: u64,
}

/// Where a model comes from, and where it stands.
#[derive(Clone, Debug, PartialEq)]
struct Source {
    file: PathBuf,
    placement: Placement,
    /// When the file was changed last, and its bytes; none where the system does not tell.
    stamp: Option<(SystemTime, u64)>,
}

impl Models {
    /// Reads all of them; there must be a triangle.
    ///
    /// # Errors
    /// Everything that can be wrong with a site file's models.
    pub fn read(
        written: &Written,
        read_model: impl Fn(&Path, &Placement) -> Result<Model, ModelError>,
    ) -> Result<Models, SiteError> {
        // a file that changes while it is read has changed since
        let sources = sources(written)?;
        let Joined { mesh, of_model, notes } = join(written, read_model)?;
        let bounds = Bounds::of(&mesh).ok_or_else(|| SiteError::NoTriangles { file: written.file.clone() })?;
        let names = mesh.components.iter().map(|component| (&component.name, &component.faces));
        let mark = FxBuildHasher.hash_one((
            bytemuck::cast_slice::<_, u8>(&mesh.vertices),
            bytemuck::cast_slice::<_, u8>(&mesh.faces),
            mesh.origin.to_array().map(f64::to_bits),
            names.collect::<Vec<_>>(),
        ));
        Ok(Models { mesh, bounds, notes, of_model, sources, mark })
    }

    /// Whether these are the models that a request asks for, standing where it says; as they were when they were read.
    pub fn are_those_of(&self, written: &Written) -> bool {
        let is_it = |(index, source): (usize, &Source)| {
            placed(written, index).is_ok_and(|(file, placement)| file == source.file && placement == source.placement)
        };
        written.site.model.len() == self.sources.len() && self.sources.iter().enumerate().all(is_it)
    }

    /// The first of the files that is no more what was read. A file that a `.gltf` names is not asked.
    pub fn changed_file(&self) -> Option<&Path> {
        let changed = self.sources.iter().find(|source| source.stamp != stamp(&source.file));
        changed.map(|source| source.file.as_path())
    }

    /// A number of all that stands there: other triangles, or other names, have another one.
    pub fn mark(&self) -> u64 {
        self.mark
    }

    /// Whether the ground that is found under them is this one, metres.
    pub fn stand_on(&self, level: f64) -> bool {
        Ground::of(&self.mesh, self.bounds, None).is_at(level)
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

/// All models as one mesh, one component a part, in their order.
pub(super) struct Joined {
    pub(super) mesh: Mesh,
    /// Which components are whose.
    of_model: Vec<Range<usize>>,
    pub(super) notes: Vec<String>,
}

/// Reads all models.
pub(super) fn join(
    written: &Written,
    read_model: impl Fn(&Path, &Placement) -> Result<Model, ModelError>,
) -> Result<Joined, SiteError> {
    let count = written.site.model.len();
    if count == 0 {
        return Err(written.missing("[[model]]", "[[model]] with path = \"tower.glb\""));
    }
    let (mut parts, mut models, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for index in 0..count {
        let (file, placement) = placed(written, index)?;
        if !file.is_file() {
            let path = written.site.model[index].path.as_deref().unwrap_or_default();
            return Err(refuse(written.model_key(index, "path"), no_file(path, &file)));
        }
        let first = parts.len();
        let model = read_model(&file, &placement)?;
        parts.extend(model.parts);
        let name = written.site.model[index].path.as_deref().unwrap_or_default();
        notes.extend(model.notes.into_iter().map(|note| format!("{name} {note}")));
        models.push((name.to_owned(), first..parts.len()));
    }
    let mesh = Mesh::build(parts)?;
    notes.extend(notes::of(&mesh, Frame::Place, &models));
    Ok(Joined { mesh, of_model: models.into_iter().map(|(_, components)| components).collect(), notes })
}

/// That a model's file is not there, and what may be wrong with its path.
fn no_file(path: &str, file: &Path) -> String {
    let control = path.chars().find(|letter| letter.is_control()).map(|letter| match letter {
        '\t' => "a tab",
        '\n' | '\r' => "a line break",
        _ => "a control character",
    });
    match control {
        Some(letter) => format!(
            "{path:?} has {letter} in it, which a backslash in double quotes makes of the letter behind it; write / between \
             folders, or put the path in single quotes"
        ),
        None if path.contains('\\') => {
            format!("there is no file {}; write / between folders, which every system reads", file.display())
        }
        None => format!("there is no file {}; write where the model lies, from the site file's folder", file.display()),
    }
}

fn sources(written: &Written) -> Result<Vec<Source>, SiteError> {
    let source = |index| {
        let (file, placement) = placed(written, index)?;
        Ok(Source { stamp: stamp(&file), file, placement })
    };
    (0..written.site.model.len()).map(source).collect()
}

fn stamp(file: &Path) -> Option<(SystemTime, u64)> {
    let told = file.metadata().ok()?;
    Some((told.modified().ok()?, told.len()))
}

/// Where one of the models lies, and where it stands.
pub(super) fn placed(written: &Written, index: usize) -> Result<(PathBuf, Placement), SiteError> {
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
    Ok((written.folder.join(path), Placement { north_rad: north_deg.to_radians(), position, scale }))
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
