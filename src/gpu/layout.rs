//! The structs that shaders share with Rust, field for field. A test compares them with the shaders' own.

use bytemuck::{Pod, Zeroable};

/// `ViewUniforms` of `shaders/common/view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct ViewUniforms {
    /// The transform from metres around the scene's origin to clip space, with depth 1 near and 0 far.
    pub clip_from_local: [[f32; 4]; 4],
    /// The viewer as a homogeneous point: the eye, or for the plan the direction straight up.
    pub viewer: [f32; 4],
    /// The camera's right, as long as half the picture's width at distance 1.
    pub right: [f32; 4],
    /// The camera's up, as long as half the picture's height at distance 1.
    pub up: [f32; 4],
    /// The camera's forward, a unit vector.
    pub forward: [f32; 4],
    /// The height of the ground, metres.
    pub ground_z: f32,
    /// The height of the lowest judged point, metres.
    pub lowest_z: f32,
    /// The height above itself at which a receiver is judged, metres.
    pub judged_above: f32,
    /// For the plan, depth per metre of height; for a camera, the distance of the near plane in metres.
    pub depth_scale: f32,
    /// Columns and rows.
    pub size: [f32; 2],
    /// Padding: WGSL rounds a struct up to its alignment.
    pub unused: [f32; 2],
}

/// `LightUniforms` of `shaders/common/view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct LightUniforms {
    /// The light as a homogeneous point: a unit vector towards a light at infinity (w = 0), or a lamp's position (w =
    /// 1).
    pub towards: [f32; 4],
}

/// `MapUniforms` of `shaders/common/map.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct MapUniforms {
    /// The transform from metres around the scene's origin to the homogeneous column and row in texels, and the depth
    /// in metres.
    pub from_local: [[f32; 4]; 4],
    /// One texel to the right, metres in the scene's axes (for a lamp, at a distance of one metre).
    pub across: [f32; 4],
    /// One texel down, likewise.
    pub along: [f32; 4],
    /// The ground's depth: metres per column, metres per row, metres at the map's corner, and 0. If the last value is
    /// not 0, the depth is that value divided by the same sum.
    pub ground: [f32; 4],
    /// A texel's width and height, metres; for a lamp, at a distance of one metre.
    pub texel: [f32; 2],
    /// The texels per side.
    pub size: f32,
    /// The depth at the map's far side, metres.
    pub range: f32,
    /// The depth at its near side, metres: 0 for the sun, more for a lamp.
    pub near: f32,
    /// The bias against rounding of depths, metres.
    pub bias: f32,
    /// The slope-scaled bias, in texels.
    pub slope_bias: f32,
    /// The width of the penumbra per metre behind an edge.
    pub spread: f32,
    /// The width of smoothies, metres; 0 for that of the light's penumbra.
    pub width: f32,
    /// 1 if the alpha of smoothies is used as it is drawn.
    pub linear: f32,
    /// The depth of the farthest visible receiver, metres.
    pub farthest: f32,
    /// Padding: WGSL rounds a struct up to its alignment.
    pub unused: f32,
}

/// `PictureUniforms` of `shaders/picture.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PictureUniforms {
    /// The north-west corner of the hours' raster, metres around the scene's origin.
    pub hours_corner: [f32; 2],
    /// The side of its cells, metres.
    pub hours_cell: f32,
    /// What is shown instead of sun and shadow: 1 hours on the plan's cells, 2 hours on patches.
    pub hours: f32,
    /// The distance from the eye to what it looks at, metres.
    pub focus: f32,
    /// 1 if sun and shadow are shown and the sun is below the horizon.
    pub night: f32,
    /// The strength of the lines, 0 to 1.
    pub lines: f32,
    /// 1 if lines are drawn on both sides of a border.
    pub both_sides: f32,
    /// 1 if components have their own colours.
    pub tinted: f32,
    /// 1 if volumes and silhouette are shown over the picture.
    pub overlay: f32,
    /// 1 if cells have colours of their own.
    pub painted: f32,
    /// Padding: WGSL rounds a struct up to its alignment.
    pub unused: f32,
}

/// `LookUniforms` of `shaders/picture.wgsl`: the values of `crate::look::Look`, colours as display values from 0 to 1.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[expect(missing_docs, reason = "each field is documented where the look is")]
pub struct LookUniforms {
    pub building: [f32; 3],
    pub cut_earth: f32,
    pub ground: [f32; 3],
    pub sky: f32,
    pub sky_light: [f32; 3],
    pub sky_slope: f32,
    pub sun_light: [f32; 3],
    pub exposure: f32,
    pub horizon: [f32; 3],
    pub least_height: f32,
    pub zenith: [f32; 3],
    pub least_sun: f32,
    pub night: [f32; 3],
    pub pressed_above: f32,
    pub not_judged: [f32; 3],
    pub pressed_room: f32,
    pub plan_ground_sun: [f32; 3],
    pub sky_rise: f32,
    pub plan_ground_shade: [f32; 3],
    pub sky_most: f32,
    pub plan_roof_sun: [f32; 3],
    pub haze_begins: f32,
    pub plan_roof_shade: [f32; 3],
    pub haze_length: f32,
    pub line: [f32; 3],
    pub relief: f32,
    pub volume: [f32; 3],
    pub relief_of_hours: f32,
    pub silhouette: [f32; 3],
    pub relief_darkest: f32,
    pub hours_ground: [f32; 3],
    pub hours_card: f32,
    pub hours_card_slope: [f32; 3],
    pub hours_wall: f32,
    pub relief_lightest: f32,
    pub outline: f32,
    pub step: f32,
    pub foot: f32,
    pub crease: f32,
    pub crease_cos: f32,
    pub plan_crease_cos: f32,
    pub step_share: f32,
    pub side_step_pixels: f32,
    pub tinted_lines: f32,
    pub layer: f32,
    pub most_layers: f32,
    pub hours_wall_slope: f32,
    pub hours_height_m: f32,
    pub hours_least_up: f32,
    pub plan_tint_shade: f32,
    pub relief_level: f32,
    pub plan_step_least_m: f32,
    pub plan_step_most_m: f32,
    pub plan_wall_up: f32,
}

/// `WeightUniforms` of `shaders/accumulate.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct WeightUniforms {
    /// The seconds for which a mask counts.
    pub secs: u32,
}

/// `SearchUniforms` of `shaders/common/search.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct SearchUniforms {
    /// The light as a homogeneous point around the mesh's origin.
    pub light: [f32; 4],
    /// The number of indices per wall: 6, or 3 if all walls end in one point.
    pub indices_per_wall: u32,
    /// 1 if walls are drawn half as often.
    pub halved: u32,
    /// Padding: WGSL rounds a struct up to its alignment.
    pub unused: [u32; 2],
}

/// `FaceRecord` of `shaders/faces.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FaceRecord {
    /// The indices of its vertices in the mesh.
    pub corners: [u32; 3],
    /// The index of the face, which is that of its bit.
    pub number: u32,
}

/// `EdgeRecord` of `shaders/extraction.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct EdgeRecord {
    /// The edge's first vertex.
    pub first: u32,
    /// The edge's second vertex.
    pub second: u32,
    /// A face at it, or, if it has more than two, the beginning of their list.
    pub a: u32,
    /// Another face at it, or none, or the length of that list.
    pub b: u32,
    /// Metres east and north from the first vertex to the second.
    pub along: [f32; 2],
}

/// `DrawArguments` of `shaders/extraction.wgsl`: those of an indirect draw.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct DrawArguments {
    /// The number of indices to draw.
    pub index_count: u32,
    /// The number of instances.
    pub instance_count: u32,
    /// The first index.
    pub first_index: u32,
    /// The number that is added to each index.
    pub base_vertex: i32,
    /// The first instance.
    pub first_instance: u32,
}

/// `Quadrilateral` of `shaders/quadrilaterals.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[cfg(feature = "test-hooks")]
pub struct Quadrilateral {
    /// The first vertex, metres around the mesh's origin.
    pub first: [f32; 3],
    /// A face at it.
    pub a: u32,
    /// The second vertex, metres around the mesh's origin.
    pub second: [f32; 3],
    /// Another face at it, or none.
    pub b: u32,
}

/// `FallUniforms` of `shaders/projected.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FallUniforms {
    /// The columns and rows by which a shadow falls away from the sun, per metre of height.
    pub a_metre: [f32; 2],
    /// Columns and rows of the raster.
    pub size: [f32; 2],
}

/// `TexelRunUniforms` of `shaders/soft_texture.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct TexelRunUniforms {
    /// The first texel of a page.
    pub first: u32,
    /// The number of texels in the run.
    pub count: u32,
}

/// A struct as Rust lays it out.
#[cfg(feature = "test-hooks")]
pub struct StructLayout {
    /// Its name, in Rust and in WGSL.
    pub name: &'static str,
    /// Its size, bytes.
    pub size: usize,
    /// Names and byte offsets, in order.
    pub fields: &'static [(&'static str, usize)],
}

#[cfg(feature = "test-hooks")]
macro_rules! layout {
    ($name:ident: $($field:ident),+) => {
        StructLayout {
            name: stringify!($name),
            size: size_of::<$name>(),
            fields: &[$((stringify!($field), std::mem::offset_of!($name, $field))),+],
        }
    };
}

/// All structs that Rust and the shaders share.
#[cfg(feature = "test-hooks")]
pub const ALL: &[StructLayout] = &[
    layout!(ViewUniforms: clip_from_local, viewer, right, up, forward, ground_z, lowest_z, judged_above, depth_scale, size, unused),
    layout!(LightUniforms: towards),
    layout!(MapUniforms: from_local, across, along, ground, texel, size, range, near, bias, slope_bias, spread, width, linear, farthest, unused),
    layout!(SearchUniforms: light, indices_per_wall, halved, unused),
    layout!(FaceRecord: corners, number),
    layout!(EdgeRecord: first, second, a, b, along),
    layout!(DrawArguments: index_count, instance_count, first_index, base_vertex, first_instance),
    layout!(Quadrilateral: first, a, second, b),
    layout!(PictureUniforms: hours_corner, hours_cell, hours, focus, night, lines, both_sides, tinted, overlay, painted, unused),
    layout!(LookUniforms: building, cut_earth, ground, sky, sky_light, sky_slope, sun_light, exposure, horizon, least_height, zenith, least_sun, night, pressed_above, not_judged, pressed_room, plan_ground_sun, sky_rise, plan_ground_shade, sky_most, plan_roof_sun, haze_begins, plan_roof_shade, haze_length, line, relief, volume, relief_of_hours, silhouette, relief_darkest, hours_ground, hours_card, hours_card_slope, hours_wall, relief_lightest, outline, step, foot, crease, crease_cos, plan_crease_cos, step_share, side_step_pixels, tinted_lines, layer, most_layers, hours_wall_slope, hours_height_m, hours_least_up, plan_tint_shade, relief_level, plan_step_least_m, plan_step_most_m, plan_wall_up),
    layout!(WeightUniforms: secs),
    layout!(FallUniforms: a_metre, size),
    layout!(TexelRunUniforms: first, count),
];
