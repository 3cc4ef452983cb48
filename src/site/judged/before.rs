//! `[before]` → the state with which the site is compared.

use super::asked_table::AskedTable;
use super::request::JudgedState;
use crate::formats::on_disk;
use crate::mesh::Mesh;
use crate::message::{Message, message};
use crate::site::error::SiteError;
use crate::site::judged_tables::BeforeTable;
use crate::site::models::Models;
use crate::site::overrides::{Overrides, refuse};
use crate::site::pair::same_place;
use crate::site::written::WrittenSite;
use crate::site::{Ground, ground};
use crate::sun::Place;
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// The state of the site that is judged.
pub(super) struct AskedSite<'a> {
    pub(super) written: &'a WrittenSite,
    pub(super) place: &'a Place,
    pub(super) models: &'a Models,
    /// The ground's height, if it is given.
    pub(super) level: Option<f64>,
    /// For each component, whether its pieces are windows.
    pub(super) is_glass: &'a [bool],
}

/// Both states, the one that is judged and the one before if the site file has one, and notes on the models of the
/// latter.
///
/// # Errors
/// An error in the table, or in the site that it names.
pub(super) fn states(
    site: &AskedSite,
    asked: &Overrides,
) -> Result<(JudgedState, Option<JudgedState>, Vec<Message>), SiteError> {
    let Models { mesh, bounds, .. } = site.models;
    let [casts, receives] = site.models.roles(site.written)?;
    let state = |mesh: &Arc<Mesh>, casts: Vec<bool>, ground| JudgedState {
        mesh: Arc::clone(mesh),
        casts: casts.iter().zip(site.is_glass).map(|(casts, is_glass)| *casts && !is_glass).collect(),
        ground,
    };
    let mesh = Arc::new(mesh.clone());
    let of_own = |level| Ground::of(&mesh, *bounds, &receives, level);
    let Some(before) = &site.written.site.before else {
        return Ok((state(&mesh, casts, of_own(site.level)), None, Vec::new()));
    };
    let table = AskedTable { written: site.written, name: "before", at: (0, 1) };
    if let Some(name) = &before.site {
        table.needless("absent", before.absent.is_some(), "site")?;
        table.needless("demolished", before.demolished.is_some(), "site")?;
        let (other, notes) = other_site(site, &table, name, asked)?;
        let level = other.ground.level;
        let mut ground = of_own(Some(level));
        ground.from = other.ground.from;
        return Ok((state(&mesh, casts, ground), Some(other), notes));
    }
    let ground = of_own(site.level);
    let casts_before = casts_before(site, &table, before)?;
    Ok((state(&mesh, casts, ground), Some(state(&mesh, casts_before, ground)), Vec::new()))
}

/// For each component of the same models, whether it casts in the state before.
fn casts_before(site: &AskedSite, table: &AskedTable, before: &BeforeTable) -> Result<Vec<bool>, SiteError> {
    let keys = [("absent", before.absent.is_some()), ("demolished", before.demolished.is_some())];
    if keys.iter().all(|(_, is_written)| !is_written) {
        table.one_of(&[("site", false), ("absent", false), ("demolished", false)])?;
    }
    let mut casts = site.models.roles_with_demolished(site.written)?[0].clone();
    if let Some(names) = &before.absent {
        let absent = table.chosen("absent", names, &site.models.mesh)?;
        if let Some(names) = &before.demolished {
            let demolished = table.chosen("demolished", names, &site.models.mesh)?;
            let both = (0..absent.len()).find(|at| absent[*at] && demolished[*at]);
            if let Some(both) = both {
                let what = format!("\"{}\" is demolished, too", site.models.mesh.components[both].name);
                return Err(table.wrong("absent", message![what; "a component stands before, or after, or in both"]));
            }
        }
        casts.iter_mut().zip(absent).for_each(|(casts, is_absent)| *casts &= !is_absent);
    }
    Ok(casts)
}

/// The state of another site file, at the place of this one and on the same ground.
fn other_site(
    site: &AskedSite,
    table: &AskedTable,
    name: &str,
    asked: &Overrides,
) -> Result<(JudgedState, Vec<Message>), SiteError> {
    let path = on_disk(&site.written.folder.join(name));
    if !path.exists() {
        let what = format!("there is no file {}", path.display());
        return Err(table.wrong("site", message![what; "write where it lies, from the site file's folder"]));
    }
    let mut other = WrittenSite::read_beside(&path, site.written, asked)?;
    // a model's file may have given it
    let mut own = site.written.clone();
    own.site.place.get_or_insert_default().elevation = Some(site.place.elevation_m);
    other.site.place.get_or_insert_default().elevation.get_or_insert(site.place.elevation_m);
    same_place(&own, &other, asked)?;
    other.site.place.clone_from(&own.site.place);
    let models = Models::read(&other, |path, options| asked.reading.read(path, options))?.with_terrain(&other)?;
    let [casts, receives] = models.roles(&other)?;
    let notes = models.notes(&other, &casts);
    let level = one_level(site, &other, asked)?;
    let ground = Ground::of(&models.mesh, models.bounds, &receives, level);
    // the glass of one state is that of the other, too, by its name
    let own = site.models.mesh.components.iter().zip(site.is_glass);
    let glass: FxHashSet<&str> =
        own.filter(|(_, is_glass)| **is_glass).map(|(component, _)| component.name.as_str()).collect();
    let components = models.mesh.components.iter();
    let casts = components.zip(casts).map(|(of, casts)| casts && !glass.contains(of.name.as_str())).collect();
    Ok((JudgedState { mesh: Arc::new(models.mesh), casts, ground }, notes))
}

/// The height of both states' ground, if it is given.
fn one_level(site: &AskedSite, other: &WrittenSite, asked: &Overrides) -> Result<Option<f64>, SiteError> {
    let of_other = ground::level(other, asked)?;
    match (site.level, of_other) {
        (Some(own), Some(level)) if !Ground::asked(own).is_at(level) => {
            let what = format!("{level} m is another ground than that of {}, {own} m", site.written.file);
            Err(refuse(other.key("ground", "level"), message![what; "write the same level in both"]))
        }
        (own, of_other) => Ok(own.or(of_other)),
    }
}
