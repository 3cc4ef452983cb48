//! `[[area]]` → areas.

use super::asked_table::{AskedTable, TakenNames};
use super::outline_file::{PlacedOutline, outlines};
use super::request::{AreaSurface, JudgedArea};
use super::rings;
use crate::choice::nearest;
use crate::formats::composed;
use crate::mesh::Mesh;
use crate::mesh::patches::{MOST_TEXELS, Patches};
use crate::message::{Message, message};
use crate::site::error::SiteError;
use crate::site::judged_tables::{AreaTable, WrittenNames};
use crate::site::written::WrittenSite;
use crate::sun::Place;
use glam::{DVec2, DVec3, Vec3};

/// Steeper faces do not belong to an area: the cosine of 60°.
const LEAST_UP: f64 = 0.5;
/// The greatest height of an area above the ground or the place, metres.
const HIGHEST_M: f64 = 1e5;
/// The side of the patches' texels, metres. Only the patches' faces are used.
const CELL_M: f64 = 1.0;
/// The most areas that are judged at once.
const MOST_AREAS: usize = 10_000;

/// The areas of a site file, and notes on them.
///
/// # Errors
/// The first area that is wrong.
pub(super) fn areas(
    written: &WrittenSite,
    place: &Place,
    mesh: &Mesh,
) -> Result<(Vec<JudgedArea>, Vec<Message>), SiteError> {
    let (mut areas, mut notes, mut names) = (Vec::new(), Vec::new(), TakenNames::default());
    for (index, area) in written.site.area.iter().enumerate() {
        let table = AskedTable { written, name: "area", at: (index, written.site.area.len()) };
        let of_table = of_table(&table, area, (place, mesh), &mut notes)?;
        let dwelling = table.named(area.dwelling.as_ref()).map(str::to_owned);
        // what a file says of a polygon goes before the table's key, which holds for all of them
        for area in of_table.into_iter().map(|of| JudgedArea { dwelling: of.dwelling.or(dwelling.clone()), ..of }) {
            if !names.take(&area.name) {
                let what = format!("\"{}\" is the name of another area, too", area.name);
                return Err(table.wrong("name", message![what; "give each its own name"]));
            }
            areas.push(area);
        }
        if areas.len() > MOST_AREAS {
            let what = format!("there are more than {MOST_AREAS} areas");
            return Err(table.wrong("", message![what; "judge fewer at once"]));
        }
    }
    Ok((areas, notes))
}

/// The areas of one table.
fn of_table(
    table: &AskedTable,
    area: &AreaTable,
    (place, mesh): (&Place, &Mesh),
    notes: &mut Vec<Message>,
) -> Result<Vec<JudgedArea>, SiteError> {
    let keys =
        [("polygon", area.polygon.is_some()), ("file", area.file.is_some()), ("component", area.component.is_some())];
    let key = table.one_of(&keys)?;
    if key != "file" {
        table.needless("crs", area.crs.is_some(), key)?;
    }
    let name = || table.named(area.name.as_ref()).map_or_else(|| format!("area {}", table.at.0 + 1), str::to_owned);
    if let Some(names) = &area.component {
        table.needless("height", area.height.is_some(), key)?;
        table.needless("level", area.level.is_some(), key)?;
        let surface = AreaSurface::Faces(upper_faces(table, names, mesh)?);
        return Ok(vec![JudgedArea { name: name(), rings: Vec::new(), surface, dwelling: None }]);
    }
    let height = table.within("height", area.height, 0.0, HIGHEST_M)?;
    let level = table.within("level", area.level, -HIGHEST_M, HIGHEST_M)?;
    table.needless("level", level.is_some() && height.is_some(), "height")?;
    let surface = level.map_or(AreaSurface::Ground(height.unwrap_or(0.0)), AreaSurface::Level);
    if let Some(corners) = &area.polygon {
        let corners = corners.iter().map(|corner| DVec2::from_array(*corner)).collect();
        return Ok(vec![bounded(table, key, (name(), &[corners], surface))?]);
    }
    let file = (area.file.as_deref().unwrap_or_default(), area.crs.as_deref());
    let (outlines, of_file) = outlines(table, file, place)?;
    notes.extend(of_file.into_iter().filter(|note| !notes.contains(note)).collect::<Vec<_>>());
    of_outlines(table, (file.0, outlines), table.named(area.name.as_ref()), &surface)
}

/// An area within borders, which are checked.
fn bounded(
    table: &AskedTable,
    key: &str,
    (name, written, surface): (String, &[Vec<DVec2>], AreaSurface),
) -> Result<JudgedArea, SiteError> {
    let rings = rings::checked(written).map_err(|fault| table.wrong(key, fault.about(&format!("\"{name}\""))))?;
    let rings = rings.into_iter().map(|ring| ring.corners).collect();
    Ok(JudgedArea { name, rings, surface, dwelling: None })
}

/// The polygons of a file that are meant: all, or those with the given name.
fn of_outlines(
    table: &AskedTable,
    (file, outlines): (&str, Vec<PlacedOutline>),
    asked: Option<&str>,
    surface: &AreaSurface,
) -> Result<Vec<JudgedArea>, SiteError> {
    let is_alone = outlines.len() == 1;
    let (mut areas, mut known) = (Vec::new(), Vec::new());
    for PlacedOutline { name, dwelling, number, rings } in outlines {
        let name = match (name, asked) {
            (None, None) => {
                let what = format!("feature {number} has no `name`");
                return Err(table.wrong("file", message![what; "give each polygon a property `name`"]));
            }
            (Some(name), None) => name,
            (None, Some(asked)) if is_alone => asked.to_owned(),
            (Some(name), Some(asked)) if composed(&name) == composed(asked) => name,
            (name, Some(_)) => {
                known.extend(name);
                continue;
            }
        };
        areas.push(JudgedArea { dwelling, ..bounded(table, "file", (name, &rings, surface.clone()))? });
    }
    match asked {
        Some(asked) if areas.is_empty() => {
            let what = format!("no polygon of {file} is named \"{asked}\"");
            let nearest = nearest(asked, known.iter().map(String::as_str));
            let hint =
                nearest.map_or("name its polygons".to_owned(), |nearest| format!("the nearest is \"{nearest}\""));
            Err(table.wrong("name", message![what; hint]))
        }
        _ => Ok(areas),
    }
}

/// The upward faces of some components, in the world frame.
fn upper_faces(table: &AskedTable, names: &WrittenNames, mesh: &Mesh) -> Result<Vec<[DVec3; 3]>, SiteError> {
    let chosen = table.chosen("component", names, mesh)?;
    let patches = Patches::of(mesh, &chosen, CELL_M, MOST_TEXELS);
    let mut faces = Vec::new();
    for patch in &patches.list {
        let up = patch.normal().z;
        if up < LEAST_UP && !(patch.two_sided && up <= -LEAST_UP) {
            continue;
        }
        for face in &patches.faces[patch.faces.start as usize..patch.faces.end as usize] {
            let [a, b, c] = mesh.corners(*face as usize).map(Vec3::as_dvec3).map(|corner| mesh.origin + corner);
            // a face may be wound the other way than its patch
            let is_up = (b - a).cross(c - a).z > 0.0;
            faces.push(if is_up { [a, b, c] } else { [a, c, b] });
        }
    }
    match faces.is_empty() {
        true => {
            let what = "has no face that looks upward, up to 60° steep";
            Err(table.wrong("component", message![what; "name what has one"]))
        }
        false => Ok(faces),
    }
}
