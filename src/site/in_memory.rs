//! A site that a program makes without a file.

use super::error::{FieldLocation, SiteError};
use super::extent::{Bounds, with_shadows};
use super::given_by_file::GivenByFile;
use super::load::VIEW_CUT;
use super::overrides::refuse;
use super::{Ground, Site, camera, ground, notes, plan};
use crate::choice::{Engine, Finder, Method, Receivers, Settings};
use crate::mesh::Mesh;
use crate::mesh::patches::DEFAULT_CELL_M;
use crate::message::{Field, PlainWords, message};
use crate::sun::{Place, SunTrack};
use crate::view::Grid;

impl Site {
    /// Makes a site from a mesh in the world frame, with the same defaults as a site file. Everything casts and
    /// receives, technique and engine are chosen for the machine, and the camera sees everything. To change that, set
    /// the fields. A study refuses `casts` and `receives` unless they have one entry for each component.
    ///
    /// If no height is given, the ground is found as for a file: at the mesh's own zero, or at its lowest point.
    /// Components marked as terrain ([`crate::mesh::Component::is_terrain`]) are the ground.
    ///
    /// # Errors
    /// A mesh without a triangle, a height that is not one, a track without an instant, or a grid that is not a plan.
    pub fn in_memory(
        place: Place,
        mesh: Mesh,
        ground: Option<f64>,
        track: SunTrack,
        grid: Grid,
    ) -> Result<Site, SiteError> {
        let bounds = Bounds::of(&mesh).ok_or(SiteError::EmptyMesh)?;
        let level = ground.map(|level| ground::checked(level, FieldLocation::Field(Field::Ground))).transpose()?;
        if track.instants.is_empty() {
            return Err(refuse(FieldLocation::Field(Field::From), message!["the track has no instant"; "add one"]));
        }
        plan::check(&grid)?;
        let all = vec![true; mesh.components.len()];
        let ground = Ground::of(&mesh, bounds, &all, level);
        let shadows = with_shadows(&mesh, bounds, &all, ground.level, &track, VIEW_CUT);
        let camera = camera::found(place.latitude_deg, bounds, shadows, ground.level, &track);
        let receivers = Receivers::default();
        let of_mesh =
            notes::of_all(&mesh, notes::FarFrom::Place).into_iter().chain(ground.notes(&mesh, &all, receivers));
        let notes = of_mesh.chain(track.notes()).chain(notes::on_view(&mesh, &grid, None)).collect();
        Ok(Site {
            place,
            mesh,
            notes,
            words: &PlainWords,
            by_file: GivenByFile::default(),
            likenesses: Vec::new(),
            casts: all.clone(),
            receives: all,
            ground,
            track,
            grid,
            camera,
            side: None,
            receivers,
            patch_cell: DEFAULT_CELL_M,
            method: Method::default(),
            finder: Finder::default(),
            hextree_depth: None,
            engine: Engine::default(),
            settings: Settings::NONE,
        })
    }
}
