//! The models of a site where they stand, and which of their components are selected.

use super::contents::ReadContents;
use super::error::SiteError;
use super::extent::Bounds;
use super::file::{Names, PlaceTable};
use super::georeference::Georeference;
use super::ground::Ground;
use super::likeness::{self, Likeness, TakenFrame};
use super::mark::ModelsMark;
use super::model_place::{self, ModelElevation, ModelReference, ModelsFrame};
use super::model_table::placed;
use super::names::names_of;
use super::notes::FarFrom;
use super::overrides::refuse;
use super::placement::Placement;
use super::stand::{StandingModel, stand};
use super::standing::{self, TerrainFaces};
use super::written::{WrittenSite, bare_fault};
use super::{demolished, key_notes, layers, notes, on_terrain};
use crate::formats::{Coordinates, Model, ModelError, PartKind, ReadOptions, SeeThrough, Up, on_disk};
use crate::mesh::{Component, Mesh, MeshError};
use crate::message::{Message, few, message, set_to};
use glam::DVec3;
use std::cmp::Reverse;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// All models, joined to one mesh. They do not depend on what is asked of them. Clones share the large data.
#[derive(Clone, Debug)]
pub struct Models {
    pub(super) mesh: Mesh,
    pub(super) bounds: Bounds,
    /// Notes on how they were read, each a sentence without a full stop that names the model.
    notes: Vec<Message>,
    /// What they look like.
    pub(super) likenesses: Vec<Likeness>,
    /// The range of components of each model.
    of_model: Vec<Range<usize>>,
    /// The kind of each component, by its file.
    kinds: Vec<PartKind>,
    /// How the buildings of each model stand on the terrain.
    standing: Vec<Message>,
    /// What else each model contains.
    contents: Vec<ReadContents>,
    /// The see-through materials of each model; their part numbers are relative to the model.
    see_through: Vec<Vec<SeeThrough>>,
    sources: Vec<Source>,
    mark: ModelsMark,
    /// The place around which they stand, if one of them is placed on Earth.
    place: Option<[Option<f64>; 3]>,
    /// The place's numbers as written when the models were read.
    written_place: [Option<f64>; 3],
    proposed: Option<PlaceTable>,
    /// The place's elevation, if a model's file gives it and the site file does not.
    pub(super) elevation_m: Option<f64>,
    place_notes: Vec<Message>,
    references: Vec<ModelReference>,
}

/// The numbers of a place that determine where models stand.
fn numbers(table: &PlaceTable) -> [Option<f64>; 3] {
    [table.latitude, table.longitude, table.elevation]
}

/// The numbers of the place as written, and with what files propose.
fn places(written: &WrittenSite, proposed: Option<&PlaceTable>) -> [[Option<f64>; 3]; 2] {
    let table = written.site.place.clone().unwrap_or_default();
    let mut whole = table.clone();
    proposed.iter().for_each(|proposed| whole.complete_with(proposed));
    [numbers(&table), numbers(&whole)]
}

/// The file a model comes from, and where it stands.
#[derive(Clone, Debug, PartialEq)]
struct Source {
    file: PathBuf,
    placement: Placement,
    /// When the file was last changed, and its length; `None` if the system does not tell.
    stamp: Option<(SystemTime, u64)>,
}

impl Models {
    /// Reads all models. At least one must have a triangle.
    ///
    /// # Errors
    /// Everything that can be wrong with a site file's models.
    pub fn read(
        written: &WrittenSite,
        read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
    ) -> Result<Models, SiteError> {
        if written.site.model.is_empty() {
            return Err(written.missing("[[model]]", "[[model]] with path = \"tower.glb\""));
        }
        // taken first, so that a change while reading is noticed
        let sources = sources(written)?;
        let PlacedModels { models: mut placed, proposed, elevation, place_notes, references } =
            read_placed(written, &read_model)?;
        on_terrain::settle(&mut placed);
        let is_on_earth = placed.iter().any(|placed| placed.is_on_earth);
        let (mut parts, mut models, mut notes, mut see_through) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        // for each model: unit and axis by its file, and how it was turned and moved
        let (mut said, mut contents, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
        for (index, placed) in placed.into_iter().enumerate() {
            let model = placed.model;
            said.push((TakenFrame::of_file(&model), (placed.north_rad, placed.position)));
            let first = parts.len();
            kinds.extend((0..model.parts.len()).map(|part| model.kind(part)));
            contents.push(ReadContents::of(&model));
            parts.extend(model.parts);
            let name = name(written, index);
            notes.extend(model.notes.into_iter().chain(placed.notes).map(|note| note.about(name)));
            models.push((name.to_owned(), first..parts.len()));
            see_through.push(model.see_through);
        }
        notes.extend(model_place::of_shifts(&references));
        let mesh = Mesh::build(parts).map_err(|error| no_mesh(&models, error))?;
        let likenesses = likenesses(written, &mesh, &models, &said);
        for (((model, components), likeness), place) in models.iter().zip(&likenesses).zip(&references) {
            notes.extend(notes::of_model(&mesh, model, components.clone(), &likeness.mends, place.crs.is_some()));
        }
        notes.extend(notes::of_all(&mesh, far_from(written, proposed.as_ref(), is_on_earth)));
        let likenesses = likenesses.into_iter().filter(|likeness| !likeness.mends.is_empty()).collect();
        let bounds = Bounds::of(&mesh).ok_or_else(|| SiteError::NoTriangles { file: written.file.clone() })?;
        let [written_place, place] = places(written, proposed.as_ref());
        let models = Models {
            mark: ModelsMark::default(),
            mesh,
            bounds,
            notes,
            likenesses,
            of_model: models.into_iter().map(|(_, components)| components).collect(),
            kinds,
            standing: Vec::new(),
            contents,
            see_through,
            sources,
            place: is_on_earth.then_some(place),
            written_place,
            proposed,
            elevation_m: elevation.map(|of| of.height_m),
            place_notes,
            references,
        };
        models.with_terrain(written)
    }

    /// Marks the terrain as the request says, otherwise as the files say, and notes how the buildings stand on it.
    ///
    /// # Errors
    /// [`SiteError::UnknownName`].
    pub(super) fn with_terrain(mut self, written: &WrittenSite) -> Result<Models, SiteError> {
        let mut is_terrain: Vec<bool> = self.kinds.iter().map(|kind| *kind == PartKind::Terrain).collect();
        for (index, (table, of_model)) in written.site.model.iter().zip(&self.of_model).enumerate() {
            if let Some(names) = &table.terrain {
                let components = &self.mesh.components[of_model.clone()];
                is_terrain[of_model.clone()].copy_from_slice(&chosen(written, index, "terrain", names, components)?);
            }
        }
        let components = &mut self.mesh.components;
        // nothing to do if the terrain is the same as when the buildings were examined
        if components.iter().zip(&is_terrain).all(|(component, is_terrain)| component.is_terrain == *is_terrain) {
            return Ok(self);
        }
        components.iter_mut().zip(is_terrain).for_each(|(component, is)| component.is_terrain = is);
        let terrain = TerrainFaces::of(&self.mesh);
        let stand = |(index, of_model): (usize, &Range<usize>)| {
            let is_terrain = |at: usize| self.mesh.components[at].is_terrain;
            let is_building = |at: &usize| self.kinds[*at] != PartKind::GroundCover && !is_terrain(*at);
            let buildings: Vec<usize> = of_model.clone().filter(is_building).collect();
            standing::note(&self.mesh, terrain.as_ref()?, &buildings, name(written, index))
        };
        self.standing = self.of_model.iter().enumerate().filter_map(stand).collect();
        Ok(self)
    }

    /// Whether these are the models that a request asks for, where it places them, and their files are unchanged.
    pub fn are_those_of(&self, written: &WrittenSite) -> bool {
        let is_it = |(index, source): (usize, &Source)| {
            placed(written, index).is_ok_and(|(file, placement)| file == source.file && placement == source.placement)
        };
        // a model placed on Earth moves if the place changes
        let place = written.site.place.as_ref().map(numbers).unwrap_or_default();
        let is_there = self.place.is_none_or(|here| place == here || place == self.written_place);
        is_there && written.site.model.len() == self.sources.len() && self.sources.iter().enumerate().all(is_it)
    }

    /// Whether one of them is placed on Earth.
    pub(super) fn stand_on_earth(&self) -> bool {
        self.place.is_some()
    }

    /// The parts of the place that a model's file proposes because the site file lacks them.
    pub fn proposed_place(&self) -> Option<&PlaceTable> {
        self.proposed.as_ref()
    }

    /// Notes on places in files that are not places, if the site is left without one.
    pub(super) fn place_notes(&self) -> &[Message] {
        &self.place_notes
    }

    /// What each model's file and the site file say about its coordinates.
    pub fn references(&self) -> &[ModelReference] {
        &self.references
    }

    /// Returns the first file that has changed since it was read. Files that a `.gltf` refers to are not checked.
    pub fn changed_file(&self) -> Option<&Path> {
        let changed = self.sources.iter().find(|source| source.stamp != stamp(&source.file));
        changed.map(|source| source.file.as_path())
    }

    /// A hash of all models: it changes with their triangles or names.
    pub fn mark(&self) -> u64 {
        self.mark.of(&self.mesh)
    }

    /// Whether the ground found under them for a request has this level, metres.
    pub fn stand_on(&self, written: &WrittenSite, level: f64) -> bool {
        let roles = self.roles(written);
        roles.is_ok_and(|[_, receives]| Ground::of(&self.mesh, self.bounds, &receives, None).is_at(level))
    }

    /// The number of components of each model.
    pub fn component_counts(&self) -> Vec<usize> {
        self.of_model.iter().map(Range::len).collect()
    }

    /// What was read of each model, with its components.
    pub(super) fn by_model(&self) -> impl Iterator<Item = (&ReadContents, &[Component])> {
        let of_model = self.of_model.iter().map(|range| &self.mesh.components[range.clone()]);
        self.contents.iter().zip(of_model)
    }

    /// For each component, whether it casts, and whether it receives, by the request. What is demolished does neither.
    pub(super) fn roles(&self, written: &WrittenSite) -> Result<[Vec<bool>; 2], SiteError> {
        let mut roles = self.roles_with_demolished(written)?;
        for gone in demolished::components(written, &self.mesh.components)? {
            roles.iter_mut().for_each(|role| role[gone] = false);
        }
        Ok(roles)
    }

    /// The same of all that stands before or now.
    pub(super) fn roles_with_demolished(&self, written: &WrittenSite) -> Result<[Vec<bool>; 2], SiteError> {
        let mut roles = [Vec::new(), Vec::new()];
        for (index, (table, of_model)) in written.site.model.iter().zip(&self.of_model).enumerate() {
            let components = &self.mesh.components[of_model.clone()];
            chosen(written, index, "casts", &table.casts, components)?;
            roles[0].extend(self.contents[index].casts(&table.casts, components));
            roles[1].extend(chosen(written, index, "receives", &table.receives, components)?);
        }
        Ok(roles)
    }

    /// Notes on how they were read, and on what casts, each a sentence without a full stop that names the model.
    pub(super) fn notes(&self, written: &WrittenSite, casts: &[bool]) -> Vec<Message> {
        let mut notes = self.notes_without_contents(written, casts);
        notes.extend(self.notes_on_contents(written));
        notes
    }

    /// The same notes without what [`Models::contents`] lists.
    pub(super) fn notes_without_contents(&self, written: &WrittenSite, casts: &[bool]) -> Vec<Message> {
        let mut notes: Vec<Message> = self.notes.iter().chain(&self.standing).cloned().collect();
        for (index, (of_model, materials)) in self.of_model.iter().zip(&self.see_through).enumerate() {
            let casts = &casts[of_model.clone()];
            let note = note_see_through(materials, casts);
            notes.extend(note.map(|note| note.about(name(written, index))));
        }
        notes.extend(demolished::note(written, &self.mesh.components));
        notes
    }
}

/// The error for parts that do not make a mesh; it names the model with the faulty part.
fn no_mesh(models: &[(String, Range<usize>)], error: MeshError) -> SiteError {
    let whose = |model: &&(String, Range<usize>)| match (&error, models.len()) {
        (_, 1) => true,
        (MeshError::TooWide { part, .. }, _) => model.1.contains(part),
        _ => false,
    };
    let file = models.iter().find(whose).map(|(file, _)| file.clone());
    SiteError::Mesh { file, error }
}

/// The point from which far-away models are measured: their own origin for a bare model without a place.
fn far_from(written: &WrittenSite, proposed: Option<&PlaceTable>, is_on_earth: bool) -> FarFrom {
    match !written.is_bare_model() || written.site.place.is_some() || proposed.is_some() {
        true if is_on_earth => FarFrom::PlaceOnEarth,
        true => FarFrom::Place,
        false => FarFrom::OwnZero,
    }
}

/// A note on the see-through materials of a model, which cast as solid, the most frequent first.
fn note_see_through(materials: &[SeeThrough], casts: &[bool]) -> Option<Message> {
    let casting = |material: &SeeThrough| material.parts.iter().filter(|&&part| casts[part]).count();
    let mut found: Vec<_> = materials.iter().map(|it| (casting(it), it)).filter(|(count, _)| *count > 0).collect();
    found.sort_by_key(|(count, _)| Reverse(*count));
    let first = &found.first()?.1.material;
    let told = found.iter().map(|(count, it)| format!("\"{}\" ({count})", it.material)).collect();
    let count: usize = found.iter().map(|(count, _)| count).sum();
    let (components, cast) = if count == 1 { ("component", "casts") } else { ("components", "cast") };
    let left_out = toml::Value::String(format!("!{first}"));
    Some(message![
        format!(
            "has {count} {components} of cut-out or translucent materials, which {cast} as if solid: {}",
            few(told)
        );
        set_to("[[model]]", "casts", format!("not {first}"), format!("casts = [{left_out}] under [[model]]")),
        format!(" leaves \"{first}\" out")
    ])
}

/// All models where they stand, and what their files say about that.
pub(super) struct PlacedModels {
    pub(super) models: Vec<StandingModel>,
    pub(super) proposed: Option<PlaceTable>,
    /// The place's elevation, if a model's file gives it and the site file does not.
    pub(super) elevation: Option<ModelElevation>,
    pub(super) place_notes: Vec<Message>,
    pub(super) references: Vec<ModelReference>,
}

/// A model as its file contains it, and what is said about where it stands.
type UnplacedModel = (Placement, Model, Georeference);

/// Reads the models, and finds the frame in which they stand.
fn read_unplaced(
    written: &WrittenSite,
    read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
) -> Result<(Vec<UnplacedModel>, ModelsFrame), SiteError> {
    let mut read: Vec<UnplacedModel> = Vec::new();
    for index in 0..written.site.model.len() {
        let (placement, mut model) = model(written, index, &read_model)?;
        if matches!(model.coordinates, Coordinates::Map(_)) {
            // a map's third coordinate is the height, whatever the format's axes are
            (model.up, model.up_is_said) = (Up::Z, true);
        }
        let said = Georeference::of(&model, &placement).map_err(|fault| written.model_fault(index, fault))?;
        read.push((placement, model, said));
    }
    let of_model = |(index, (placement, model, said))| (name(written, index), model, placement, said);
    let all = read.iter().map(|(placement, model, said)| (placement, model, said)).enumerate().map(of_model);
    let frame = model_place::frame(written, all)?;
    Ok((read, frame))
}

/// The place's elevation if a model's file gives it. The models are read for that, but not placed.
pub(super) fn read_elevation(
    written: &WrittenSite,
    read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
) -> Result<Option<ModelElevation>, SiteError> {
    Ok(read_unplaced(written, read_model)?.1.elevation)
}

/// Reads the models and places them in one frame: around the site's place, otherwise around the one that a file
/// proposes.
pub(super) fn read_placed(
    written: &WrittenSite,
    read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
) -> Result<PlacedModels, SiteError> {
    let (read, ModelsFrame { frame, proposed, elevation }) = read_unplaced(written, read_model)?;
    let mut placed = PlacedModels {
        models: Vec::new(),
        proposed: proposed.or_else(|| elevation.as_ref().map(ModelElevation::proposed)),
        elevation,
        place_notes: Vec::new(),
        references: Vec::new(),
    };
    for (index, (placement, model, mut said)) in read.into_iter().enumerate() {
        let of_elevation = placed.elevation.as_ref().filter(|of| of.model == index);
        said.notes.extend(of_elevation.map(|of| model_place::elevation_note(of.height_m)));
        said.notes.extend(key_notes::of(&written.site.model, index, &placement, &model));
        let name = name(written, index);
        let mut reference = ModelReference::of(name, &model, &placement, &said);
        if frame.is_none() {
            placed.place_notes.extend(said.notes.iter().cloned().map(|note| note.about(name)));
        }
        let standing = stand(model, &placement, said, frame.as_ref());
        let standing = standing.map_err(|fault| written.model_fault(index, fault))?;
        frame.iter().for_each(|frame| reference.place_in(frame, &placement, &standing));
        placed.references.push(reference);
        placed.models.push(standing);
    }
    Ok(placed)
}

/// Reads one of the models as its file contains it.
fn model(
    written: &WrittenSite,
    index: usize,
    read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
) -> Result<(Placement, Model), SiteError> {
    let (file, placement) = placed(written, index)?;
    let file = on_disk(&file);
    if written.is_bare_model() {
        bare_fault(&file)?;
    } else if !file.is_file() {
        return Err(refuse(written.model_key(index, "path"), no_file(name(written, index), &file)));
    }
    let read = read_model(&file, &placement.read_options()).map_err(|error| match error.fault.is_about_scene() {
        true => refuse(written.model_key(index, "scene"), error.to_string()),
        false => error.into(),
    });
    let mut model = read?;
    if let Some(names) = &placement.layers {
        layers::keep(&mut model, names, || written.model_key(index, "layers"))?;
    }
    Ok((placement, model))
}

/// The name of a model in messages: as in the site file.
pub(super) fn name(written: &WrittenSite, index: usize) -> &str {
    written.site.model.get(index).and_then(|table| table.path.as_deref()).unwrap_or_default()
}

/// The error for a missing file, and what may be wrong with its path.
fn no_file(path: &str, file: &Path) -> Message {
    let control = path.chars().find(|letter| letter.is_control()).map(|letter| match letter {
        '\t' => "a tab",
        '\n' | '\r' => "a line break",
        _ => "a control character",
    });
    match control {
        Some(letter) => message![
            format!(
                "{path:?} contains {letter}, which comes from a backslash in double quotes and the letter after it"
            );
            "write / between folders, or put the path in single quotes"
        ],
        None if path.contains('\\') => {
            message![
                format!("there is no file {}", file.display());
                "write / between folders, which every system reads"
            ]
        }
        None => message![
            format!("there is no file {}", file.display());
            "write the model's path relative to the site file's folder"
        ],
    }
}

fn sources(written: &WrittenSite) -> Result<Vec<Source>, SiteError> {
    let source = |index| {
        let (file, placement) = placed(written, index)?;
        Ok(Source { stamp: stamp(&file), file, placement })
    };
    (0..written.site.model.len()).map(source).collect()
}

fn stamp(file: &Path) -> Option<(SystemTime, u64)> {
    let told = on_disk(file).metadata().ok()?;
    Some((told.modified().ok()?, told.len()))
}

/// For each component, whether the names of a list (or all) select it.
fn chosen(
    written: &WrittenSite,
    index: usize,
    key: &str,
    names: &Names,
    components: &[Component],
) -> Result<Vec<bool>, SiteError> {
    match names.unknown(&names_of(components)) {
        Some((name, nearest)) => Err(SiteError::UnknownName { at: written.model_key(index, key), name, nearest }),
        None => Ok(names.chosen(components)),
    }
}

/// What each model looks like, given its file's unit and axis, and how it was turned and moved.
fn likenesses(
    written: &WrittenSite,
    mesh: &Mesh,
    models: &[(String, Range<usize>)],
    said: &[(TakenFrame, (f64, DVec3))],
) -> Vec<Likeness> {
    let tables = written.site.model.iter().zip(models).zip(said).enumerate();
    let looks = tables.map(|(index, ((table, (_, components)), (taken, stands)))| {
        let taken = taken.written(table.scale.is_some(), table.up.is_some());
        Likeness { model: index, mends: likeness::of(mesh, &mesh.components[components.clone()], *stands, taken) }
    });
    looks.collect()
}
