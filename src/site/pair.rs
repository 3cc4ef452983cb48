//! Two states of one site that are compared. Place, study, plan and ground are the same, and the models differ.

use super::error::SiteError;
use super::extent::{Bounds, with_shadows};
use super::load::SHADOW_CUT;
use super::models::Models;
use super::overrides::{Overrides, refuse};
use super::written::WrittenSite;
use super::{Ground, GroundFrom, Site, metres, plan};
use crate::formats::composed;
use crate::formats::{Model, ModelError, ReadOptions};
use crate::message::{Message, message};
use std::cell::Cell;
use std::path::Path;

/// Places closer to each other than this are the same, metres horizontally and in height.
const ONE_PLACE_M: f64 = 1.0;
/// Metres per degree of latitude.
const DEGREE_M: f64 = 111_195.0;

/// The existing and the proposed site. Place, instants, grid and ground are identical to the bit.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The state before.
    pub before: Site,
    /// The state after.
    pub after: Site,
    /// Their names: those of their places if they differ, otherwise their files.
    pub names: [String; 2],
}

impl Pair {
    /// Reads and checks both. Study, plan and camera are those of `before`, as are place and ground if `after` has
    /// none. A region that is not given contains the models and shadows of both.
    ///
    /// # Errors
    /// As [`Site::load`]; and a different place, time zone or ground in `after`.
    pub fn load(before: &Path, after: &Path, asked: &Overrides) -> Result<Pair, SiteError> {
        let before = WrittenSite::read(before, asked)?;
        let after = WrittenSite::read_beside(after, &before, asked)?;
        Self::of(&before, &after, asked, |path, options| asked.reading.read(path, options))
    }

    /// As [`Pair::load`], for two requests in memory, with a different reader of model files.
    ///
    /// # Errors
    /// As [`Pair::load`].
    pub fn of(
        before: &WrittenSite,
        after: &WrittenSite,
        asked: &Overrides,
        read_model: impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError>,
    ) -> Result<Pair, SiteError> {
        let read = |written: &WrittenSite| Models::read(written, &read_model);
        Self::with_models(before, after, asked, read, read)
    }

    /// As [`Pair::of`], with models of either state that may have been read before.
    ///
    /// # Errors
    /// As [`Pair::load`].
    pub fn with_models(
        before: &WrittenSite,
        after: &WrittenSite,
        asked: &Overrides,
        models_before: impl FnOnce(&WrittenSite) -> Result<Models, SiteError>,
        models_after: impl FnOnce(&WrittenSite) -> Result<Models, SiteError>,
    ) -> Result<Pair, SiteError> {
        let (before, models_before) = before.located(|| models_before(before))?;
        let before = &*before;
        let mut second = after.clone();
        // a state without a place, its model files' included, takes the other one's
        second.take_place_of(before)?;
        let after_name = same_place(before, &second, asked)?;
        let table = &mut second.site;
        table.place.clone_from(&before.site.place);
        table.study = before.site.study.clone();
        table.plan = before.site.plan.clone();
        table.camera = before.site.camera.clone();
        let elevation = Cell::new(None);
        let models_before = || models_before().inspect(|models| elevation.set(models.elevation_m));
        let mut first = Site::with_models(before, asked, models_before)?;
        match table.ground.level {
            // the command line has priority over both files
            Some(level) if asked.ground.is_none() && !first.ground.is_at(level) => {
                let what = format!("{level} m differs from the ground of {}, {} m", before.file, first.ground.level);
                return Err(refuse(after.key("ground", "level"), message![what; "write the same level in both"]));
            }
            _ => table.ground.level = Some(first.ground.level),
        }
        // a model's file has given it for both
        if let Some((place, height_m)) = second.site.place.as_mut().zip(elevation.get()) {
            place.elevation = Some(height_m);
        }
        let mut second = Site::with_models(&second, asked, || models_after(&second))?;
        // both have the same sun, if only a file of the second gives an elevation
        (second.place, second.track) = (first.place.clone(), first.track.clone());
        let [(low, high), (other_low, other_high)] = [&first, &second].map(|site| {
            // a site always has a triangle
            let bounds = Bounds::of(&site.mesh).unwrap_or_default();
            let [low, high] = with_shadows(&site.mesh, bounds, &site.casts, site.ground.level, &site.track, SHADOW_CUT);
            (low, high)
        });
        first.grid = plan::grid(before, asked, || [low.min(other_low), high.max(other_high)])?;
        second.grid = first.grid;
        // if neither file gives it
        if after.site.ground.level.is_none() && first.ground.from != GroundFrom::Site {
            let alone = Ground::found(&second.mesh, &second.receives).level;
            second.notes.extend(note_ground([before, after], &first.ground, alone));
        }
        let lowest = first.ground.lowest.min(second.ground.lowest);
        (first.ground.lowest, second.ground.lowest) = (lowest, lowest);
        second.ground.from = first.ground.from;

        let names = told_apart([&first.place.name, &after_name], [before, after]);
        second.place.name = after_name;
        Ok(Pair { before: first, after: second, names })
    }

    /// Notes on how the models of both were read, without repetition.
    pub fn notes(&self) -> Vec<Message> {
        let mut notes = self.before.notes.clone();
        notes.extend(self.after.notes.iter().filter(|note| !self.before.notes.contains(note)).cloned());
        notes
    }
}

/// The names of two states: those of their places if they differ, otherwise their files.
fn told_apart(places: [&str; 2], files: [&WrittenSite; 2]) -> [String; 2] {
    let names = places.map(str::trim);
    let told_apart = composed(names[0]) != composed(names[1]) && names.iter().all(|name| !name.is_empty());
    if told_apart { names.map(str::to_owned) } else { files.map(|written| written.file.clone()) }
}

/// The name of the place of `after`, or the error that it differs from the place of `before`.
pub(super) fn same_place(before: &WrittenSite, after: &WrittenSite, asked: &Overrides) -> Result<String, SiteError> {
    let (here, there) = (before.place(asked)?, after.place(asked)?);
    let north = (there.latitude_deg - here.latitude_deg) * DEGREE_M;
    let turned = (there.longitude_deg - here.longitude_deg + 180.0).rem_euclid(360.0) - 180.0;
    let east = turned * DEGREE_M * here.latitude_deg.to_radians().cos();
    let fault = |key: &str, what: String| {
        let what = format!("{what} {}", before.file);
        Err(refuse(
            after.key("place", key),
            message![what; "both must have the same place, since they have the same sun"],
        ))
    };
    let apart = north.hypot(east);
    if apart > ONE_PLACE_M {
        return fault("latitude", format!("it lies {apart:.0} m from the place of"));
    }
    let higher = there.elevation_m - here.elevation_m;
    if higher.abs() > ONE_PLACE_M {
        return fault("elevation", format!("{} m is {higher:+.0} m from that of", there.elevation_m));
    }
    if there.time_zone != here.time_zone {
        return fault("time_zone", format!("{} is not {}, as of", there.time_zone, here.time_zone));
    }
    Ok(there.name)
}

/// A note that the second state has the ground of the first, and which ground it would have alone.
fn note_ground([before, after]: [&WrittenSite; 2], ground: &Ground, alone: f64) -> Option<Message> {
    (!ground.is_at(alone)).then(|| {
        let level = metres(ground.level);
        message![
            format!("{} has the ground of {}, {level}, since a comparison has only one", after.file, before.file);
            format!("alone it would have {}", metres(alone))
        ]
    })
}
