//! The vertex attributes that identify a vertex's feature, by their names without the leading underscore.

/// Of a b3dm's batch table.
pub(super) const BATCH_ID: &str = "BATCHID";

/// Of `EXT_mesh_features`; an index follows.
pub(super) const FEATURE_ID: &str = "FEATURE_ID_";

/// Whether an attribute of that name may identify features.
pub(super) fn names_features(attribute: &str) -> bool {
    attribute == BATCH_ID || attribute.starts_with(FEATURE_ID)
}
