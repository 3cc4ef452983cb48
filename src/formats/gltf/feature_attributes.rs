//! The vertex attributes that say of which feature a vertex is, by their names without the underscore before them.

/// Of the batch table of a b3dm.
pub(super) const BATCH_ID: &str = "BATCHID";

/// Of `EXT_mesh_features`; a number follows.
pub(super) const FEATURE_ID: &str = "FEATURE_ID_";

/// Whether an attribute of that name may say of which feature a vertex is.
pub(super) fn names_features(attribute: &str) -> bool {
    attribute == BATCH_ID || attribute.starts_with(FEATURE_ID)
}
