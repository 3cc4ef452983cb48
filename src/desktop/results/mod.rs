//! The results of a site's study, ready to be shown on the scene.

pub(in crate::desktop) mod before;
pub(in crate::desktop) mod cells;
pub(in crate::desktop) mod change;
pub(in crate::desktop) mod facades;
pub(in crate::desktop) mod hours;
pub(in crate::desktop) mod judged;
pub(in crate::desktop) mod verdict_shapes;

use crate::choice::Method;
use crate::deliver::lines::Lines;
use crate::deliver::profile::ProfileRequest;
use crate::deliver::{Sink, comparison};
use crate::desktop::state::pick::PickedPoint;
use crate::desktop::state::project::Project;
use crate::desktop::state::settings::WindowSettings;
use crate::desktop::state::unit::Unit;
use crate::export::figure::scale::Rgb;
use crate::message::Message;
use crate::picture::Picture;
use crate::shadow::ShadowError;
use crate::site::Site;
use crate::site::file::SiteFile;
use crate::study::OnEvent;
use change::ChangeResult;
use facades::Facades;
use hours::ShadowHours;
use std::path::PathBuf;
use std::sync::Arc;

/// A result, ready to be shown on the scene.
pub(in crate::desktop) struct StudyResult {
    /// Grows with every answer.
    pub(in crate::desktop) number: u64,
    /// The open site for which it was computed.
    pub(in crate::desktop) site: Arc<Site>,
    /// The technique that was requested.
    pub(in crate::desktop) method: Method,
    /// The same site as it was written.
    pub(in crate::desktop) written: SiteFile,
    /// The hash of its models.
    pub(in crate::desktop) mark: u64,
    /// Notes from its computation, besides those on the site.
    pub(in crate::desktop) notes: Vec<Message>,
    /// The findings.
    pub(in crate::desktop) found: Findings,
}

/// The kinds of findings.
pub(in crate::desktop) enum Findings {
    /// The hours of shadow on ground and roofs.
    Shadow(Box<ShadowHours>),
    /// The change from another state to that of the site.
    Change(Box<ChangeResult>),
    /// The hours of sun on façades and roofs.
    Facades(Box<Facades>),
}

impl StudyResult {
    /// Adds the notes from its computation: of those on models, only the ones on a state before.
    pub(in crate::desktop) fn noted(mut self, mut notes: Vec<Message>) -> StudyResult {
        let after = self.change().map_or(&[][..], |change| &change.pair.after.notes);
        notes.retain(|note| !self.site.notes.contains(note) && !after.contains(note));
        self.notes = notes;
        self
    }

    /// Shows the findings on a picture of the site, or of its visible part.
    ///
    /// # Errors
    /// If the adapter cannot hold them.
    pub(in crate::desktop) fn lay(&self, picture: &mut Picture, visible: &Site) -> Result<(), ShadowError> {
        match &self.found {
            Findings::Shadow(hours) => picture.lay_hours(Some(hours.raster())),
            Findings::Change(change) => picture.lay_hours(Some(change.raster())),
            Findings::Facades(facades) => facades.lay(picture, &self.site, visible)?,
        }
        Ok(())
    }

    /// The findings in a few words.
    pub(in crate::desktop) fn what(&self) -> &'static str {
        match &self.found {
            Findings::Shadow(_) => "hours of shadow",
            Findings::Change(_) => "sun lost and gained",
            Findings::Facades(_) => "hours of sun",
        }
    }

    /// Whether they can be shown on another site: hours on the plan can wherever heights match.
    pub(in crate::desktop) fn lies_on(&self, site: &Site) -> bool {
        let ours = &self.site;
        let same_mesh = || ours.mesh.vertices == site.mesh.vertices && ours.mesh.faces == site.mesh.faces;
        !matches!(self.found, Findings::Facades(_)) || (ours.receives == site.receives && same_mesh())
    }

    /// Their value at a point, if its surface is the one that was judged.
    pub(in crate::desktop) fn said(&self, under: &PickedPoint, unit: Unit) -> Option<String> {
        match &self.found {
            Findings::Shadow(hours) => hours.said(under.point),
            Findings::Change(change) => change.said(under.point),
            Findings::Facades(facades) => facades.said(under, unit),
        }
    }

    /// Their legend: a heading, and each colour.
    pub(in crate::desktop) fn legend(&self) -> (String, Vec<(Rgb, String)>) {
        match &self.found {
            Findings::Shadow(hours) => hours.legend(),
            Findings::Change(change) => (change.colours.legend_head.clone(), change.colours.legend.clone()),
            Findings::Facades(facades) => facades.legend.clone(),
        }
    }

    /// The names of their files.
    pub(in crate::desktop) fn names(&self) -> Vec<PathBuf> {
        match &self.found {
            Findings::Shadow(hours) => hours.all().names(),
            Findings::Change(_) => comparison::names().to_vec(),
            Findings::Facades(facades) => facades.all().names(),
        }
    }

    /// Writes its files, or a drawing of its lines, as the command does.
    ///
    /// # Errors
    /// If the study has no such lines, or the files cannot be written.
    pub(in crate::desktop) fn write(
        &self,
        lines: Option<Lines>,
        sink: Sink<'_>,
        on_event: &mut OnEvent<'_>,
    ) -> anyhow::Result<()> {
        match (&self.found, lines) {
            (Findings::Shadow(hours), None) => hours.write(&self.site, &hours.all(), sink, on_event),
            (Findings::Shadow(hours), Some(lines)) => {
                let lines = ProfileRequest { lines: &[lines], ..hours.nothing() };
                hours.write(&self.site, &lines, sink, on_event)
            }
            (_, Some(_)) => anyhow::bail!("lines are drawn of the hours of shadow on the plan; find those first"),
            (Findings::Change(change), None) => change.write(sink, on_event),
            (Findings::Facades(facades), None) => facades.write(&self.site, sink, on_event),
        }
    }

    /// Whether they match the settings' request for the site.
    pub(in crate::desktop) fn is_asked(&self, project: &Project, settings: &WindowSettings) -> bool {
        let is_found = match (&self.found, &settings.before) {
            (Findings::Change(change), Some(before)) => change.before == *before,
            (Findings::Shadow(_), None) => !settings.shown.facades,
            (Findings::Facades(_), None) => settings.shown.facades,
            _ => false,
        };
        let method = match self.found {
            Findings::Facades(_) => facades::method(settings),
            Findings::Shadow(_) | Findings::Change(_) => settings.shown.method,
        };
        let (then, now) = (&self.written, &project.written.site);
        let same_models = then.model == now.model && self.mark == project.models.mark();
        let of_models = same_models && then.ground == now.ground && then.place == now.place;
        let of_study = then.study == now.study && then.plan == now.plan;
        // after undo and redo it is a different object, but the same site
        is_found && self.method == method && (Arc::ptr_eq(&self.site, &project.site) || (of_models && of_study))
    }

    /// The change, if it is one.
    pub(in crate::desktop) fn change(&self) -> Option<&ChangeResult> {
        match &self.found {
            Findings::Change(change) => Some(change),
            _ => None,
        }
    }
}
