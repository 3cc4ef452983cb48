//! Selects the objects of a document and their geometries.

use super::document::{CityDocument, CityObject, VertexTransform};
use super::surfaces::{CityShape, NO_SURFACES, Templates};
use crate::formats::ModelFault;
use crate::formats::city::{CityBuilder, CityObjectName, Rank, is_inside, is_part};
use rustc_hash::FxHashMap;
use std::borrow::Cow;

/// Adds the objects of a document to those of the file.
pub(super) fn add(
    document: &CityDocument<'_>,
    transform: &VertexTransform,
    templates: &Templates<'_>,
    builder: &mut CityBuilder,
) -> Result<(), ModelFault> {
    let objects = &document.objects.0;
    let shapes: Vec<Vec<CityShape<'_>>> =
        objects.iter().map(|(_, object)| shapes(object, document, transform, templates, builder)).collect();
    let replaced = replaced(objects, &shapes);
    for ((id, object), shapes) in objects.iter().zip(&shapes) {
        let Some(best) = best_of(shapes) else { continue };
        if replaced.get(id.as_ref()).is_some_and(|parts| *parts >= best) {
            builder.tally.add(kind_of(object), "its parts are used instead");
            continue;
        }
        let others = object.parents.iter().flatten().cloned();
        let name = object.attributes.as_ref().and_then(|attributes| attributes.name.clone());
        let others = others.chain(name).collect();
        let name = CityObjectName { kind: kind_of(object).to_owned(), id: id.to_string(), others };
        builder.object(name, best);
        for shape in shapes {
            if shape.rank == best {
                shape.build(builder)?;
            } else {
                builder.tally.add("geometries", "another level of detail of the object is used");
            }
        }
        builder.close();
    }
    Ok(())
}

/// The type of an object; extensions begin theirs with a plus sign.
fn kind_of<'a>(object: &'a CityObject<'_>) -> &'a str {
    object.kind.trim_start_matches('+')
}

/// The shapes of an object that may be used.
fn shapes<'a>(
    object: &'a CityObject<'_>,
    document: &'a CityDocument<'_>,
    transform: &VertexTransform,
    templates: &Templates<'a>,
    builder: &mut CityBuilder,
) -> Vec<CityShape<'a>> {
    let geometries = object.geometry.as_deref().unwrap_or_default();
    let unwanted = match kind_of(object) {
        kind if is_inside(kind) => Some("inside of a building"),
        "CityObjectGroup" => Some("outlines of groups"),
        _ => None,
    };
    if let Some(why) = unwanted {
        builder.tally.add_many(kind_of(object), why, u64::from(!geometries.is_empty()));
        return Vec::new();
    }
    let mut shapes = Vec::new();
    for geometry in geometries {
        match CityShape::of(geometry, document, transform, templates) {
            Ok(shape) => shapes.push(shape),
            Err(NO_SURFACES) => builder.tally.add(&geometry.kind, NO_SURFACES),
            Err(why) => builder.tally.add("GeometryInstance", why),
        }
    }
    shapes
}

/// The highest rank of several: solids come first, then surfaces.
fn best_of(shapes: &[CityShape<'_>]) -> Option<Rank> {
    shapes.iter().map(|shape| shape.rank).reduce(|best, next| if next > best { next } else { best })
}

/// The rank of the parts of each object that has some: an object that is no better is not used beside its parts.
fn replaced<'a>(
    objects: &'a [(Cow<'_, str>, CityObject<'_>)],
    shapes: &[Vec<CityShape<'_>>],
) -> FxHashMap<&'a str, Rank> {
    let mut replaced = FxHashMap::default();
    let parts = objects.iter().zip(shapes).filter(|((_, object), _)| is_part(kind_of(object)));
    for ((_, part), shapes) in parts {
        let Some(best) = best_of(shapes) else { continue };
        for parent in part.parents.iter().flatten() {
            let parts = replaced.entry(parent.as_str()).or_insert(best);
            if best > *parts {
                *parts = best;
            }
        }
    }
    replaced
}
