//! The shaders' text: each stage is concatenated with the common parts that it uses. WGSL has no includes, and needs
//! none here.

use super::Gpu;
use wgpu::{ShaderModule, ShaderModuleDescriptor, ShaderSource};

/// A constant for each shader, and all of them by name.
macro_rules! shaders {
    ($($(#[$doc:meta])+ $constant:ident $name:literal: $($part:literal),+;)+) => {
        $($(#[$doc])+
        pub const $constant: &str = concat!($(include_str!(concat!("../../shaders/", $part, ".wgsl")), "\n"),+);)+

        /// All shaders, by name.
        #[cfg(feature = "test-hooks")]
        pub const ALL: &[(&str, &str)] = &[$(($name, $constant)),+];
    };
}

shaders! {
    /// What a view sees: the G-buffer.
    SURFACE "surface": "common/view", "common/receiver", "surface";
    /// Receivers that are flush with the ground, shown before it.
    FLUSH "flush": "common/view", "common/seen", "common/receiver", "flush";
    /// The depth at which each cell is judged.
    JUDGED "judged": "common/view", "common/seen", "judged";
    /// Stencil shadow volumes.
    STENCIL "stencil": "common/view", "common/seen", "stencil";
    /// Faces that are projected onto a plan's raster.
    PROJECTED "projected": "projected";
    /// Depth as a light sees it.
    MAP "map": "common/map", "map";
    /// Shadow maps.
    SHADOW_MAP "shadow_map": "common/view", "common/seen", "common/map", "common/compared", "shadow_map";
    /// Which cells a map decides.
    HYBRID "hybrid": "common/view", "common/seen", "common/map", "common/compared", "hybrid";
    /// Soft edges beside a map.
    SMOOTHIE "smoothie": "common/view", "common/seen", "common/map", "common/compared", "smoothie";
    /// Silhouettes as lines.
    OVERLAY "overlay": "common/view", "common/seen", "overlay";
    /// Which faces a light shines on, and the light cap.
    FACES "faces": "common/search", "faces";
    /// Silhouettes as a list of walls.
    EXTRACTION "extraction": "common/search", "common/edge", "extraction";
    /// Shadow volumes whose silhouettes the vertex shader decides.
    QUADRILATERALS "quadrilaterals": "common/view", "common/seen", "common/search", "common/edge", "stencil", "quadrilaterals";
    /// Sun and shadow for the eye.
    PICTURE "picture": "common/view", "common/seen", "picture";
    /// A picture in a window's frame.
    SCREEN "screen": "screen";
    /// Masks times weights.
    ACCUMULATE "accumulate": "accumulate";
    /// Hard shadows on patches, added up.
    SOFT_TEXTURE "soft_texture": "soft_texture";
}

#[doc(hidden)]
impl Gpu {
    /// Compiles a shader.
    pub fn shader(&self, label: &str, text: &str) -> ShaderModule {
        self.device.create_shader_module(ShaderModuleDescriptor {
            label: Some(label),
            source: ShaderSource::Wgsl(text.into()),
        })
    }
}
