//! The shaders' text: each stage joined with the common parts that it uses. WGSL has no includes, and needs none here.

use super::Gpu;
use wgpu::{ShaderModule, ShaderModuleDescriptor, ShaderSource};

macro_rules! joined {
    ($($part:literal),+) => {
        concat!($(include_str!(concat!("../../shaders/", $part, ".wgsl")), "\n"),+)
    };
}

/// What a view sees.
pub const SURFACE: &str = joined!("common/view", "surface");
/// Where it is judged.
pub const JUDGED: &str = joined!("common/view", "common/seen", "judged");
/// Stencil shadow volumes.
pub const STENCIL: &str = joined!("common/view", "common/seen", "stencil");
/// Depth as a light sees it.
pub const MAP: &str = joined!("common/map", "map");
/// Faces that fall onto a plan's raster.
pub const PROJECTED: &str = joined!("projected");
/// Shadow maps.
pub const SHADOW_MAP: &str = joined!("common/view", "common/seen", "common/map", "common/compared", "shadow_map");
/// Which cells a map decides.
pub const HYBRID: &str = joined!("common/view", "common/seen", "common/map", "common/compared", "hybrid");
/// Soft edges beside a map.
pub const SMOOTHIE: &str = joined!("common/view", "common/seen", "common/map", "common/compared", "smoothie");
/// Silhouettes as lines.
pub const OVERLAY: &str = joined!("common/view", "common/seen", "overlay");
/// Which faces a light shines on, and the light cap.
pub const FACES: &str = joined!("common/search", "faces");
/// Silhouettes as a list of walls.
pub const EXTRACTION: &str = joined!("common/search", "common/edge", "extraction");
/// Shadow volumes whose silhouettes the vertex shader decides.
pub const QUADRILATERALS: &str =
    joined!("common/view", "common/seen", "common/search", "common/edge", "stencil", "quadrilaterals");
/// Sun and shadow for the eye.
pub const PICTURE: &str = joined!("common/view", "common/seen", "picture");
/// A picture in a window's frame.
pub const SCREEN: &str = joined!("screen");
/// Masks times weights.
pub const ACCUMULATE: &str = joined!("accumulate");

/// Hard shadows on patches, added up.
pub const SOFT_TEXTURE: &str = joined!("soft_texture");

/// All shaders, by name.
pub const ALL: &[(&str, &str)] = &[
    ("surface", SURFACE),
    ("judged", JUDGED),
    ("stencil", STENCIL),
    ("projected", PROJECTED),
    ("map", MAP),
    ("shadow_map", SHADOW_MAP),
    ("hybrid", HYBRID),
    ("smoothie", SMOOTHIE),
    ("overlay", OVERLAY),
    ("faces", FACES),
    ("extraction", EXTRACTION),
    ("quadrilaterals", QUADRILATERALS),
    ("picture", PICTURE),
    ("screen", SCREEN),
    ("accumulate", ACCUMULATE),
    ("soft_texture", SOFT_TEXTURE),
];

impl Gpu {
    /// Compiles a shader.
    pub fn shader(&self, label: &str, text: &str) -> ShaderModule {
        self.device.create_shader_module(ShaderModuleDescriptor {
            label: Some(label),
            source: ShaderSource::Wgsl(text.into()),
        })
    }
}
