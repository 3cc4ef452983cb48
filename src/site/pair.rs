//! Two states of one site that are compared: with the same place, study, plan and ground, and with other models.

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

/// Places nearer to each other than this are one, metres along the ground and in height.
const ONE_PLACE_M: f64 = 1.0;
/// Metres of a degree of latitude.
const DEGREE_M: f64 = 111_195.0;

/// The existing and the proposed site. Place, instants, grid and ground are equal to the bit.
#[derive(Clone, Debug)]
pub struct Pair {
    /// What stands there before.
    pub before: Site,
    /// What stands there after.
    pub after: Site,
    /// What people call them: their places' names where those differ, otherwise their files.
    pub names: [String; 2],
}

impl Pair {
    /// Reads and checks both. Study, plan, camera and, where `after` says none, place and ground are those of `before`;
    /// a region that nobody names holds the models and shadows of both.
    ///
    /// # Errors
    /// As [`Site::load`]; and where `after` says another place, time zone or ground.
    pub fn load(before: &Path, after: &Path, asked: &Overrides) -> Result<Pair, SiteError> {
        let before = WrittenSite::read(before, asked)?;
        let after = WrittenSite::read_beside(after, &before, asked)?;
        Self::of(&before, &after, asked, |path, options| asked.reading.read(path, options))
    }

    /// As [`Pair::load`], of two requests that are in memory, with another reader of model files.
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

    /// As [`Pair::of`], with models of either that may have been read before.
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
        // what says no place, not even by a model's file of its own, stands in that of the other
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
            // the command line's goes before what either says
            Some(level) if asked.ground.is_none() && !first.ground.is_at(level) => {
                let what =
                    format!("{level} m is another ground than that of {}, {} m", before.file, first.ground.level);
                return Err(refuse(after.key("ground", "level"), message![what; "write the same level in both"]));
            }
            _ => table.ground.level = Some(first.ground.level),
        }
        // a model's file has said it for both
        if let Some((place, height_m)) = second.site.place.as_mut().zip(elevation.get()) {
            place.elevation = Some(height_m);
        }
        let mut second = Site::with_models(&second, asked, || models_after(&second))?;
        // one sun, where a file of the second alone says an elevation
        (second.place, second.track) = (first.place.clone(), first.track.clone());
        let [(low, high), (other_low, other_high)] = [&first, &second].map(|site| {
            // a site has a triangle
            let bounds = Bounds::of(&site.mesh).unwrap_or_default();
            let [low, high] = with_shadows(&site.mesh, bounds, &site.casts, site.ground.level, &site.track, SHADOW_CUT);
            (low, high)
        });
        first.grid = plan::grid(before, asked, || [low.min(other_low), high.max(other_high)])?;
        second.grid = first.grid;
        // where nobody says it
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

    /// What the user should know of how the models of both were read, each told once.
    pub fn notes(&self) -> Vec<Message> {
        let mut notes = self.before.notes.clone();
        notes.extend(self.after.notes.iter().filter(|note| !self.before.notes.contains(note)).cloned());
        notes
    }
}

/// What people call two states: their places' names where those differ, otherwise their files.
fn told_apart(places: [&str; 2], files: [&WrittenSite; 2]) -> [String; 2] {
    let names = places.map(str::trim);
    let told_apart = composed(names[0]) != composed(names[1]) && names.iter().all(|name| !name.is_empty());
    if told_apart { names.map(str::to_owned) } else { files.map(|written| written.file.clone()) }
}

/// The name of the place of `after`; or why it is another place than that of `before`.
pub(super) fn same_place(before: &WrittenSite, after: &WrittenSite, asked: &Overrides) -> Result<String, SiteError> {
    let (here, there) = (before.place(asked)?, after.place(asked)?);
    let north = (there.latitude_deg - here.latitude_deg) * DEGREE_M;
    let turned = (there.longitude_deg - here.longitude_deg + 180.0).rem_euclid(360.0) - 180.0;
    let east = turned * DEGREE_M * here.latitude_deg.to_radians().cos();
    let fault = |key: &str, what: String| {
        let what = format!("{what} {}", before.file);
        Err(refuse(after.key("place", key), message![what; "both must have one place, since the sun is one"]))
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

/// That the second state has the ground of the first, and which it would have alone.
fn note_ground([before, after]: [&WrittenSite; 2], ground: &Ground, alone: f64) -> Option<Message> {
    (!ground.is_at(alone)).then(|| {
        let level = metres(ground.level);
        message![
            format!("{} has the ground of {}, {level}, since a comparison has one", after.file, before.file);
            format!("alone it would have {}", metres(alone))
        ]
    })
}
