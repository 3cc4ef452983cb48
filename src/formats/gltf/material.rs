//! Whether a material is see-through. Every material casts as if solid nevertheless.

use serde::Deserialize;
use serde_json::Value;

/// A material. Broken appearance data is accepted, since no shadow depends on it.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub name: Option<String>,
    #[serde(default)]
    alpha_mode: Value,
    #[serde(default)]
    pbr_metallic_roughness: Value,
    #[serde(default)]
    extensions: Value,
}

impl Material {
    /// Whether it is cut out (`MASK`) or translucent (`BLEND`, KHR_materials_transmission).
    ///
    /// Many exporters write `BLEND` for everything. The material is opaque if neither a texture, nor the factor, nor
    /// the vertices' colours (`has_faded_vertices`) can make its alpha less than 1.
    pub(super) fn is_see_through(&self, has_faded_vertices: bool) -> bool {
        let fades = |of: &Value, factor: &str, texture: &str| {
            of[factor][3].as_f64().is_some_and(|alpha| alpha < 1.0) || of[texture].is_object()
        };
        let older = &self.extensions["KHR_materials_pbrSpecularGlossiness"];
        let alpha_counts = matches!(self.alpha_mode.as_str(), Some("MASK" | "BLEND"));
        let is_faded = alpha_counts
            && (has_faded_vertices
                || fades(&self.pbr_metallic_roughness, "baseColorFactor", "baseColorTexture")
                || fades(older, "diffuseFactor", "diffuseTexture"));
        let transmitted = &self.extensions["KHR_materials_transmission"]["transmissionFactor"];
        is_faded || transmitted.as_f64().is_some_and(|factor| factor > 0.0)
    }
}
