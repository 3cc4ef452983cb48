//! Selects objects and their geometries, and resolves references.

use super::tables::{GmlGeometry, GmlMember, GmlMemberKind, GmlObject, GmlTables, NamedGml};
use crate::formats::ModelFault;
use crate::formats::city::{CityBuilder, CityObjectName, Rank, is_inside, is_part};
use crate::message::message;
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use std::hash::{Hash as _, Hasher as _};

/// The most references that may follow each other.
const MOST_DEEP: usize = 8;

/// How many times a file's number of polygons may be added, if objects share them.
const MOST_SHARED: usize = 8;

/// Adds the objects of a file.
pub(super) fn add(tables: &GmlTables, builder: &mut CityBuilder) -> Result<(), ModelFault> {
    let mut geometries: Vec<Vec<&GmlGeometry>> = tables.objects.iter().map(|_| Vec::new()).collect();
    for geometry in &tables.geometries {
        if let Some(own) = geometries.get_mut(geometry.object) {
            own.push(geometry);
        }
    }
    let best: Vec<Option<Rank>> = geometries.iter().map(|own| best_of(own)).collect();
    let replaced = replaced(&tables.objects, &best);
    let mut added = 0;
    for ((object, own), best) in tables.objects.iter().zip(&geometries).zip(&best) {
        let Some(best) = *best else { continue };
        let why = match object.kind.as_str() {
            kind if is_inside(kind) => Some("inside of a building"),
            "CityObjectGroup" => Some("outlines of groups"),
            _ if replaced.get(&object.serial).is_some_and(|parts| parts.lod >= best.lod) => {
                Some("its parts are used instead")
            }
            _ => None,
        };
        if let Some(why) = why {
            builder.tally.add(&object.kind, why);
            continue;
        }
        let others = object.around.iter().map(|(_, id)| id.clone()).filter(|id| !id.is_empty());
        let others = others.chain(object.name.clone()).collect();
        builder.object(CityObjectName { kind: object.kind.clone(), id: object.id.clone(), others }, best);
        added += add_geometries(tables, own, best.lod, builder)?;
        if added > tables.polygons.len().saturating_mul(MOST_SHARED).saturating_add(MOST_SHARED) {
            return Err(message!["refers to the same polygons again and again"; "export it without references"].into());
        }
    }
    builder.close();
    Ok(())
}

/// The highest level of detail with more than a few surfaces: windows alone are not a house.
fn best_of(own: &[&GmlGeometry]) -> Option<Rank> {
    let lod_of = |is_wanted: &dyn Fn(u8) -> bool| own.iter().map(|one| one.lod).filter(|&lod| is_wanted(lod)).max();
    let is_whole = |lod: u8| {
        let at = || own.iter().filter(|one| one.lod == lod);
        let has = |surface: &str| at().any(|one| one.surface == surface);
        at().any(|one| one.surface.is_empty()) || (has("RoofSurface") && has("WallSurface"))
    };
    let lod = lod_of(&is_whole).or_else(|| lod_of(&|_| true))?;
    let is_solid = own.iter().any(|one| one.lod == lod && one.is_solid);
    Some(Rank { is_solid, lod: f64::from(lod) })
}

/// The rank of the parts of each object that has some.
fn replaced(objects: &[GmlObject], best: &[Option<Rank>]) -> FxHashMap<u64, Rank> {
    let mut replaced: FxHashMap<u64, Rank> = FxHashMap::default();
    for (part, best) in objects.iter().zip(best).filter(|(object, _)| is_part(&object.kind)) {
        let (Some(&(whole, _)), Some(best)) = (part.around.last(), *best) else { continue };
        let parts = replaced.entry(whole).or_insert(best);
        if best.lod > parts.lod {
            *parts = best;
        }
    }
    replaced
}

/// Adds the geometries of one level of detail. Those of surfaces come first, since they say which surface a polygon
/// belongs to. Returns the number of polygons.
fn add_geometries(
    tables: &GmlTables,
    own: &[&GmlGeometry],
    lod: f64,
    builder: &mut CityBuilder,
) -> Result<usize, ModelFault> {
    let mut seen = SeenOfObject::default();
    for is_surface in [true, false] {
        for geometry in own.iter().filter(|one| one.surface.is_empty() != is_surface) {
            if f64::from(geometry.lod) == lod {
                let members = tables.members.get(geometry.members.clone()).unwrap_or_default();
                seen.may_repeat = is_surface;
                add_members(tables, members, &geometry.surface, false, MOST_DEEP, &mut seen, builder)?;
            } else {
                builder.tally.add("geometries", "another level of detail of the object is used");
            }
        }
    }
    Ok(seen.polygons.len())
}

/// What was already added of an object.
#[derive(Default)]
struct SeenOfObject {
    polygons: FxHashSet<usize>,
    groups: FxHashSet<(usize, usize)>,
    /// Hashes of the surfaces' polygons: some exporters write those of the solid a second time.
    places: FxHashSet<u64>,
    may_repeat: bool,
}

fn add_members(
    tables: &GmlTables,
    members: &[GmlMember],
    surface: &str,
    is_turned: bool,
    deep: usize,
    seen: &mut SeenOfObject,
    builder: &mut CityBuilder,
) -> Result<(), ModelFault> {
    for member in members {
        let is_turned = is_turned != member.is_turned;
        let id = match &member.what {
            GmlMemberKind::Polygon(polygon) => {
                add_polygon(tables, *polygon, surface, is_turned, seen, builder)?;
                continue;
            }
            GmlMemberKind::Reference(id) => id,
        };
        match tables.ids.get(id) {
            Some(NamedGml::Polygon(polygon)) => add_polygon(tables, *polygon, surface, is_turned, seen, builder)?,
            Some(NamedGml::Members(range)) if deep > 0 => {
                if seen.groups.insert((range.start, range.end)) {
                    let members = tables.members.get(range.clone()).unwrap_or_default();
                    add_members(tables, members, surface, is_turned, deep - 1, seen, builder)?;
                }
            }
            Some(NamedGml::Members(_)) => builder.tally.add("xlink:href", "the chain of references is too long"),
            None => builder.tally.add("xlink:href", "the reference is not in the file"),
        }
    }
    Ok(())
}

fn add_polygon(
    tables: &GmlTables,
    number: usize,
    surface: &str,
    is_turned: bool,
    seen: &mut SeenOfObject,
    builder: &mut CityBuilder,
) -> Result<(), ModelFault> {
    let Some(polygon) = tables.polygons.get(number) else { return Ok(()) };
    let (Some(points), Some(ends)) = (tables.points.get(polygon.points.clone()), tables.ends.get(polygon.ends.clone()))
    else {
        return Ok(());
    };
    if !seen.polygons.insert(number) {
        return Ok(());
    }
    let place = place_of(points);
    if seen.may_repeat {
        seen.places.insert(place);
    } else if seen.places.contains(&place) {
        return Ok(());
    }
    let ends: Vec<usize> = ends.iter().map(|end| end - polygon.points.start).collect();
    builder.face(surface, points, &ends, is_turned)
}

/// A hash of a polygon's corners, to a tenth of a millimetre, in any order.
fn place_of(points: &[DVec3]) -> u64 {
    let number = |point: &DVec3| {
        let mut hasher = rustc_hash::FxHasher::default();
        (*point * 1e4).round().to_array().map(|number| number as i64).hash(&mut hasher);
        hasher.finish()
    };
    points.iter().map(number).fold(points.len() as u64, u64::wrapping_add)
}
