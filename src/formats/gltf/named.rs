//! The files that a model refers to. They lie beside it and belong to its user, whether they are read or not.

use super::buffers::{has_scheme, percent_decode};
use super::container;
use crate::formats::source::beside;
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The references to files. Other data is ignored: a malformed image must not hide a buffer.
#[derive(Deserialize)]
struct Naming {
    #[serde(default)]
    buffers: Value,
    #[serde(default)]
    images: Value,
}

/// The files that a model refers to; empty if it cannot be read, which its reader reports.
pub(crate) fn named_by(model: &Path) -> Vec<PathBuf> {
    let Some(naming) = container::json_of_file(model).and_then(|json| serde_json::from_slice::<Naming>(&json).ok())
    else {
        return Vec::new();
    };
    let each = [naming.buffers, naming.images].into_iter().filter_map(|list| match list {
        Value::Array(list) => Some(list),
        _ => None,
    });
    let address =
        |one: &Value| one.get("uri").and_then(Value::as_str).filter(|uri| !has_scheme(uri)).map(str::to_owned);
    let addresses = each.flatten().filter_map(|one| address(&one));
    // what leads out of the folder is not read, so it is no input
    addresses.filter_map(|uri| beside(model, &percent_decode(&uri)?)).collect()
}
