//! The study of two states of a site: how a change affects the shadow.

use super::Outcome;
#[cfg(feature = "test-hooks")]
use super::{Event, OnEvent, StudyError, Wants, not_patches, run, tell};
use crate::choice::Receivers;
use crate::mesh::Mesh;
use crate::message::Message;
use crate::profile::Provenance;
use crate::profile::comparison::{Alteration, Comparison};
use crate::shadow::plan_surface;
#[cfg(feature = "test-hooks")]
use crate::site::Site;
use crate::site::{GroundKind, Pair};
use crate::view::Surface;

/// The answer to a study of two states.
#[derive(Clone, Debug)]
pub struct CompareOutcome {
    /// Both profiles, cell by cell.
    pub comparison: Comparison,
    /// What drew the states before and after.
    pub drawn: [Provenance; 2],
    /// What the cells see before and after. Under [`Receivers::Ground`] this includes the models.
    pub surfaces: [Surface; 2],
    /// The meshes whose faces the surfaces contain.
    pub meshes: [Mesh; 2],
    /// Notes on either state besides those of its site.
    pub notes: Vec<Message>,
}

/// Runs [`super::run`] for both states, before first.
///
/// # Errors
/// As [`super::run`].
#[cfg(feature = "test-hooks")]
pub fn compare(pair: &Pair, on_event: &mut OnEvent<'_>) -> Result<CompareOutcome, StudyError> {
    not_patches(&pair.before)?;
    not_patches(&pair.after)?;
    let before = study("before", &pair.before, &pair.names[0], on_event)?;
    let after = study("after", &pair.after, &pair.names[1], on_event)?;
    Ok(CompareOutcome::new(pair, before, after))
}

#[cfg(feature = "test-hooks")]
fn study(when: &str, site: &Site, name: &str, on_event: &mut OnEvent<'_>) -> Result<Outcome, StudyError> {
    tell(on_event, Event::Note(format!("{when}: {name}").into()))?;
    run(site, &Wants::default(), on_event)
}

impl CompareOutcome {
    /// Compares the outcomes of two states.
    ///
    /// Under [`Receivers::Top`] a cell is altered if it sees another surface after the change. Under
    /// [`Receivers::Ground`] it is altered only if its terrain changes height, since the ground is judged everywhere,
    /// also under buildings.
    pub fn new(pair: &Pair, before: Outcome, after: Outcome) -> CompareOutcome {
        // on the processor for both, so that an adapter's rounding cannot look like a change
        let [seen_before, seen_after] = [(&before, &pair.before), (&after, &pair.after)]
            .map(|(outcome, site)| plan_surface(&outcome.surface_mesh, site.ground.level, &site.grid));
        let altered = match pair.before.receivers {
            Receivers::Ground => altered_ground(pair),
            _ => Alteration::between(&seen_before, &seen_after),
        };
        let Outcome { profile: of_before, drawn: drawn_before, surface_mesh: mesh_before, mut notes, .. } = before;
        let Outcome { profile: of_after, drawn: drawn_after, surface_mesh: mesh_after, notes: notes_after, .. } = after;
        for note in notes_after {
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
        CompareOutcome {
            comparison: Comparison::new(of_before, of_after, altered),
            drawn: [drawn_before, drawn_after],
            surfaces: [seen_before, seen_after],
            meshes: [mesh_before, mesh_after],
            notes,
        }
    }
}

/// The cells whose ground changes height.
fn altered_ground(pair: &Pair) -> Vec<Alteration> {
    let states = [&pair.before, &pair.after];
    if states.iter().all(|site| site.ground.kind == GroundKind::Plane) {
        return vec![Alteration::No; pair.before.grid.cells()];
    }
    let [before, after] = states.map(|site| {
        let terrain = site.mesh.of_components(&site.judges(Receivers::Ground));
        plan_surface(&terrain, site.ground.level, &site.grid)
    });
    Alteration::between(&before, &after)
}
