//! The building in each of CityJSON's geometry types.

use super::block::{AT, corners, faces, model_of};
use gnomon::formats::Model;
use serde_json::{Value, json};

/// Steps of a millimetre around [`AT`].
pub(super) fn transform() -> Value {
    json!({"scale": [0.001, 0.001, 0.001], "translate": AT.to_array()})
}

pub(super) fn vertices() -> Vec<Value> {
    let steps = |metres: f64| (metres * 1000.0).round() as i64;
    corners().iter().map(|corner| json!(corner.to_array().map(steps))).collect()
}

/// Faces with one ring each.
pub(super) fn surfaces() -> Value {
    Value::Array(faces().iter().map(|(_, ring)| json!([ring])).collect())
}

pub(super) fn semantics() -> Value {
    json!({
        "surfaces": [{"type": "GroundSurface"}, {"type": "RoofSurface"}, {"type": "WallSurface"}],
        "values": [[0, 1, 2, 2, 2, 2, 2, 2]],
    })
}

pub(super) fn solid(lod: &str) -> Value {
    json!({"type": "Solid", "lod": lod, "boundaries": [surfaces()], "semantics": semantics()})
}

/// A file with these objects.
pub(super) fn city(objects: Value) -> Value {
    json!({
        "type": "CityJSON", "version": "2.0", "transform": transform(),
        "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/25832"},
        "CityObjects": objects, "vertices": vertices(),
    })
}

pub(super) fn building(geometry: Value) -> Value {
    json!({"b": {"type": "Building", "geometry": geometry}})
}

/// The building, as it is read.
pub(super) fn plain_model() -> Model {
    model_of("block.city.json", city(building(json!([solid("2.2")]))).to_string())
}
