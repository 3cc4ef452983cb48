//! `[[facade]]` → points on façades.

use super::asked_table::{AskedTable, TakenNames};
use super::request::JudgedFacade;
use crate::mesh::Mesh;
use crate::mesh::patches::{MOST_TEXELS, Patch, Patches};
use crate::message::{Message, message};
use crate::site::error::SiteError;
use crate::site::judged_tables::FacadeTable;
use crate::site::laid::row;
use crate::site::written::WrittenSite;

/// The distance between points if none is given, metres.
const SPACING_M: f64 = 1.0;
/// The least and the greatest distance between points, metres.
const SPACINGS_M: [f64; 2] = [0.05, 1000.0];
/// The greatest height of a row above or below zero, metres.
const HIGHEST_M: f64 = 1e4;
/// The most points that are judged at once.
const MOST_POINTS: usize = 200_000;

/// The façades of a site file, on a ground at this height, and notes on them.
///
/// # Errors
/// The first façade that is wrong.
pub(super) fn facades(
    written: &WrittenSite,
    mesh: &Mesh,
    ground: f64,
) -> Result<(Vec<JudgedFacade>, Vec<Message>), SiteError> {
    let (mut facades, mut notes, mut names) = (Vec::new(), Vec::new(), TakenNames::default());
    let mut points = 0;
    for (index, facade) in written.site.facade.iter().enumerate() {
        let table = AskedTable { written, name: "facade", at: (index, written.site.facade.len()) };
        let facade = of_table(&table, facade, (mesh, ground), &mut notes)?;
        if !names.take(&facade.name) {
            let what = format!("\"{}\" is the name of another façade, too", facade.name);
            return Err(table.wrong("name", message![what; "give each its own name"]));
        }
        points += facade.points.len();
        if points > MOST_POINTS {
            let what = format!("there are more than {MOST_POINTS} points on façades");
            return Err(table.wrong("spacing", message![what; "write a greater one, or name fewer components"]));
        }
        facades.push(facade);
    }
    Ok((facades, notes))
}

fn of_table(
    table: &AskedTable,
    facade: &FacadeTable,
    (mesh, ground): (&Mesh, f64),
    notes: &mut Vec<Message>,
) -> Result<JudgedFacade, SiteError> {
    table.one_of(&[("component", facade.component.is_some())])?;
    let spacing = table.within("spacing", facade.spacing, SPACINGS_M[0], SPACINGS_M[1])?.unwrap_or(SPACING_M);
    for height in facade.heights.iter().flatten() {
        table.within("heights", Some(*height), -HIGHEST_M, HIGHEST_M)?;
    }
    if facade.heights.as_ref().is_some_and(Vec::is_empty) {
        return Err(table.wrong("heights", message!["names no height"; "write one, or leave the key out"]));
    }
    let name = table.named(facade.name.as_ref());
    let name = name.map_or_else(|| format!("façade {}", table.at.0 + 1), str::to_owned);
    let chosen = match &facade.component {
        Some(names) => table.chosen("component", names, mesh)?,
        None => Vec::new(),
    };
    let patches = Patches::of(mesh, &chosen, spacing.max(0.25), MOST_TEXELS);
    let mut of = JudgedFacade { name, points: Vec::new(), doubtful: Vec::new() };
    for patch in &patches.list {
        let heights = match &facade.heights {
            Some(heights) => heights.iter().map(|height| ground + height).collect(),
            None => rows(mesh, &patches, patch, spacing),
        };
        for height in heights {
            for sides in row(mesh, &patches, patch, [spacing, height], MOST_POINTS) {
                let Some([point, normal]) = sides.first().copied() else { continue };
                of.doubtful.extend((sides.len() > 1).then_some(of.points.len()));
                of.points.push([point, normal]);
            }
            if of.points.len() > MOST_POINTS {
                // the caller reports that
                return Ok(of);
            }
        }
    }
    if of.points.is_empty() {
        let what = "has no upright face at these heights";
        return Err(table.wrong("component", message![what; "name walls, or other heights"]));
    }
    let rows = if facade.heights.is_some() { "at the heights written" } else { "in rows as far apart" };
    notes.push(Message::from(format!(
        "\"{}\" is judged at {} points, {spacing} m apart, {rows}",
        of.name,
        of.points.len()
    )));
    Ok(of)
}

/// The heights of the rows from the bottom of an upright patch to its top, half a spacing from both; a lower patch has
/// one row in its middle.
fn rows(mesh: &Mesh, patches: &Patches, patch: &Patch, spacing: f64) -> Vec<f64> {
    let faces = &patches.faces[patch.faces.start as usize..patch.faces.end as usize];
    let heights = || faces.iter().flat_map(|face| mesh.corners(*face as usize)).map(|corner| f64::from(corner.z));
    let low = heights().fold(f64::INFINITY, f64::min);
    let high = heights().fold(f64::NEG_INFINITY, f64::max);
    let count = (((high - low) / spacing + 1e-6) as usize).clamp(1, MOST_POINTS + 1);
    let first = mesh.origin.z + (low + high) / 2.0 - spacing * (count - 1) as f64 / 2.0;
    (0..count).map(|row| first + spacing * row as f64).collect()
}
