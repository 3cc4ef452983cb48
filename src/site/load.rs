//! Turns the request as written into the checked request.

use super::contents::ModelContents;
use super::error::{FieldLocation, SiteError};
use super::extent::with_shadows;
use super::given_by_file::GivenByFile;
use super::model_place::{ModelReference, elevation_note};
use super::models::{Models, name, read_elevation};
use super::overrides::{Overrides, refuse};
use super::written::WrittenSite;
use super::{Ground, Site, camera, ground, notes, plan, study};
use crate::choice::{ChoiceError, Finder, Method, Receivers};
use crate::formats::{Model, ModelError, ReadOptions};
use crate::mesh::Mesh;
use crate::mesh::patches::DEFAULT_CELL_M;
use crate::message::{Field, Message, Worded, message, set_to};
use crate::sun::{Place, SunTrack};
use glam::DVec3;
use std::path::Path;

/// A shadow longer than this many times the height does not enlarge the default region further. 4.3 is the ratio at an
/// altitude of 13°.
pub(super) const SHADOW_CUT: f64 = 4.3;
/// As [`SHADOW_CUT`], for what must be in the default camera's view.
pub(super) const VIEW_CUT: f64 = 1.5;

/// A place and its sun, without models.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedSun {
    /// Where on Earth.
    pub place: Place,
    /// The requested instants.
    pub track: SunTrack,
    /// Notes on where the place comes from, if a model's file gave it.
    pub notes: Vec<Message>,
}

/// Loads only the place and its sun. Models are read only if nothing else gives the place or its elevation.
///
/// # Errors
/// Everything that can be wrong with a site file's form, its place and its study.
pub fn load_sun(path: &Path, asked: &Overrides) -> Result<LoadedSun, SiteError> {
    let read = |path: &Path, options: &ReadOptions| asked.reading.read(path, options);
    let as_written = WrittenSite::read(path, asked)?;
    let (written, _) = as_written.located(|| Models::read(&as_written, read))?;
    let mut place = written.place(asked)?;
    let mut notes: Vec<Message> = written.place_note().into_iter().collect();
    if as_written.point()?.is_none() {
        notes.extend(written.place_doubt());
    } else {
        let (elevation_m, note) = elevation(&as_written, read)?;
        place.elevation_m = elevation_m.unwrap_or(place.elevation_m);
        notes.extend(note);
    }
    let track = study::track(&place, &written, asked)?;
    let notes = notes.into_iter().map(|note| written.worded(note)).collect();
    Ok(LoadedSun { place, track, notes })
}

/// The elevation of a place that is written without one, as a study of the same site would find it, and a note about
/// it.
fn elevation(
    written: &WrittenSite,
    read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
) -> Result<(Option<f64>, Option<Message>), SiteError> {
    let is_written = written.site.place.as_ref().is_some_and(|table| table.elevation.is_some());
    if is_written || written.site.model.is_empty() {
        return Ok((None, None));
    }
    match read_elevation(written, read_model) {
        Ok(elevation) => Ok(elevation.map_or((None, None), |of| {
            let note = elevation_note(of.height_m).about(name(written, of.model));
            (Some(of.height_m), Some(note))
        })),
        Err(SiteError::Model(error)) if error.is_given_up() => Err(SiteError::Model(error)),
        // the sun needs no model, and half a kilometre of elevation changes its direction by less than 0.001° by day
        Err(error) => {
            let mut note = message![
                "the elevation of the place is taken as 0, since a model that may give it cannot be read: ";
                "write ", set_to("[place]", "elevation", "35.0".to_owned(), "`elevation` in [place]".to_owned())
            ];
            note.what.extend(error.message().what);
            Ok((None, Some(note)))
        }
    }
}

/// The coordinates that a mesh is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateFrame {
    /// East, north and up from the place's point, with the models as a site places them.
    Place,
    /// A model file's own axes, turned z up.
    Model,
}

/// Models without a place and a study.
#[derive(Clone, Debug)]
pub struct LoadedMesh {
    /// All of them, welded.
    pub mesh: Mesh,
    /// The coordinates that the mesh is in.
    pub frame: CoordinateFrame,
    /// Notes on how the models were read, as in [`Site::notes`].
    pub notes: Vec<Message>,
    /// The contents of each file.
    pub models: Vec<ModelContents>,
    /// What is known about the coordinates of each.
    pub references: Vec<ModelReference>,
}

/// Loads only the models: a model file as it is, or a site's models where they stand. [`Overrides::up`] has priority
/// over the site file. Place and study may be absent.
///
/// # Errors
/// Everything that can be wrong with a site file's form and its models.
pub fn load_mesh(path: &Path, asked: &Overrides) -> Result<LoadedMesh, SiteError> {
    let Overrides { up, default_height, .. } = *asked;
    let of_models = Overrides { up, default_height, beside: asked.beside.clone(), ..Overrides::default() };
    let mut written = WrittenSite::read(path, &of_models)?;
    let is_bare = written.is_bare_model();
    let models = Models::read(&written, |path, options| asked.reading.read(path, options))?;
    let [casts, _] = models.roles(&written)?;
    // what was left out is listed separately
    let mut notes = models.notes_without_contents(&written, &casts);
    models.proposed_place().iter().for_each(|place| written.site.place.get_or_insert_default().complete_with(place));
    notes.splice(..0, written.place_note());
    let notes = notes.into_iter().map(|note| written.worded(note)).collect();
    let (references, contents) = (models.references().to_vec(), models.contents(&written));
    let frame = if is_bare && !models.stand_on_earth() { CoordinateFrame::Model } else { CoordinateFrame::Place };
    Ok(LoadedMesh { mesh: models.mesh, frame, notes, models: contents, references })
}

impl Site {
    /// Reads and checks a request. `path` is a site file, a folder that contains a `site.toml`, or a model file, whose
    /// place is in the file or in `asked.place`.
    ///
    /// # Errors
    /// Anything wrong with it. Each error names the file and the key or option, and has a hint.
    pub fn load(path: &Path, asked: &Overrides) -> Result<Site, SiteError> {
        Self::load_with(path, asked, |path, options| asked.reading.read(path, options))
    }

    /// As [`Site::load`], with a different reader of model files.
    ///
    /// # Errors
    /// As [`Site::load`].
    #[doc(hidden)]
    pub fn load_with(
        path: &Path,
        asked: &Overrides,
        read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
    ) -> Result<Site, SiteError> {
        Self::of(&WrittenSite::read(path, asked)?, asked, read_model)
    }

    /// As [`Site::load_with`], for a request in memory.
    ///
    /// # Errors
    /// As [`Site::load`].
    #[doc(hidden)]
    pub fn of(
        written: &WrittenSite,
        asked: &Overrides,
        read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
    ) -> Result<Site, SiteError> {
        Self::with_models(written, asked, || Models::read(written, read_model))
    }

    /// As [`Site::of`], with models that may have been read before.
    ///
    /// # Errors
    /// As [`Site::load`].
    #[doc(hidden)]
    pub fn with_models(
        written: &WrittenSite,
        asked: &Overrides,
        models: impl FnOnce() -> Result<Models, SiteError>,
    ) -> Result<Site, SiteError> {
        let (written, models) = written.located(models)?;
        let written = &*written;
        let mut place = written.place(asked)?;
        // Quick checks first; models come last.
        let mut track = study::track(&place, written, asked)?;
        let method = method(written, asked)?;
        check_settings(asked)?;
        let receivers = asked.receivers.unwrap_or_default();
        let patch_cell = patch_cell(receivers, asked)?;
        let level = ground::level(written, asked)?;
        let models = models()?.with_terrain(written)?;
        if let Some(elevation_m) = models.elevation_m {
            place.elevation_m = elevation_m;
            track = study::track(&place, written, asked)?;
        }
        let [casts, receives] = models.roles(written)?;
        let mut notes: Vec<Message> = written.place_note().into_iter().collect();
        notes.extend(models.notes(written, &casts));
        let Models { mesh, bounds, likenesses, .. } = models;
        let ground = Ground::of(&mesh, bounds, &receives, level);
        notes.extend(ground.notes(&mesh, &receives, receivers));
        let shadows = |cut| with_shadows(&mesh, bounds, &casts, ground.level, &track, cut);
        let grid = plan::grid(written, asked, || shadows(SHADOW_CUT))?;
        let side = camera::side(written, asked)?;
        let camera = camera::camera(written, side, bounds, shadows(VIEW_CUT), ground.level, &track)?;
        let eye = written.site.camera.eye.map(DVec3::from_array);
        let notes = notes.into_iter().chain(track.notes()).chain(notes::on_view(&mesh, &grid, eye));
        let notes = notes.map(|note| written.worded(note)).collect();
        Ok(Site {
            place,
            mesh,
            notes,
            words: asked.words,
            by_file: GivenByFile::of(written, asked, method),
            likenesses,
            casts,
            receives,
            ground,
            track,
            grid,
            camera,
            side,
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

/// Refuses options that have no effect, and values that cannot be used.
fn check_settings(asked: &Overrides) -> Result<(), SiteError> {
    if asked.hextree_depth.is_some() && asked.silhouette != Some(Finder::Hextree) {
        let message = message![
            "only the paper's hextree has a depth";
            "set ", (Field::Silhouette, "hextree"), " as well, or leave it out"
        ];
        return Err(refuse(FieldLocation::Field(Field::HextreeDepth), message));
    }
    // true for NaN
    if let Some(width) = asked.settings.smoothie_width_m.filter(|width| !(width.is_finite() && *width > 0.0)) {
        let message = message![
            format!("{width} is not the width of a smoothie");
            "write metres above 0, for example ", (Field::SmoothieWidth, "0.5")
        ];
        return Err(refuse(FieldLocation::Field(Field::SmoothieWidth), message));
    }
    Ok(())
}

fn method(written: &WrittenSite, asked: &Overrides) -> Result<Method, SiteError> {
    match (asked.technique, &written.site.study.technique) {
        (Some(method), _) => Ok(method),
        (None, Some(word)) => {
            word.parse().map_err(|error: ChoiceError| refuse(written.key("study", "technique"), error.to_string()))
        }
        (None, None) => Ok(Method::default()),
    }
}

/// The side of a texel on patches, metres.
fn patch_cell(receivers: Receivers, asked: &Overrides) -> Result<f64, SiteError> {
    let at = FieldLocation::Field(Field::PatchCell);
    match asked.patch_cell {
        None => Ok(DEFAULT_CELL_M),
        Some(_) if receivers != Receivers::Patches => {
            let message = message![
                "only surfaces have such cells";
                "set ", (Field::Receivers, "surfaces"), " as well, or leave it out"
            ];
            Err(refuse(at, message))
        }
        Some(cell) if cell.is_finite() && cell > 0.0 => Ok(cell),
        Some(cell) => {
            let what = format!("{cell} is not the side of a cell");
            Err(refuse(at, message![what; "write metres above 0, for example ", (Field::PatchCell, "0.25")]))
        }
    }
}
