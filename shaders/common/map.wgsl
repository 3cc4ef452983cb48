// The map: what the light sees. A place in it is column and row in texels, and a depth in metres: for the sun along its
// rays from the map's near side, for a lamp along the map's axis from the lamp.

struct MapUniforms {
    // Metres around the scene's origin → homogeneous column and row in texels, and depth in metres; w is 1 for the sun, the
    // depth itself for a lamp.
    from_local: mat4x4f,
    // One texel to the right and one downwards, metres around the scene's origin (a lamp's: a metre before it).
    across: vec4f,
    along: vec4f,
    // The ground's depth: metres a column, metres a row, metres at the map's corner, and 0; a lamp's: what w is divided by.
    ground: vec4f,
    // A texel's width and height, metres (a lamp's: a metre before it).
    texel: vec2f,
    // Texels a side.
    size: f32,
    // Depth at the far side and, for a lamp, at the near side, metres.
    range: f32,
    near: f32,
    // What rounding does to a depth, metres.
    bias: f32,
    // How many texels of its slope deeper a face is drawn.
    slope_bias: f32,
    // Width of the sun's penumbra a metre behind an edge.
    spread: f32,
    // Width of smoothies, metres (a lamp's: a metre before it); 0 where the sun's disc decides.
    width: f32,
    // Smoothies keep their alpha as it is drawn: 1, else 0.
    linear: f32,
    // Depth of the farthest receiver that is seen.
    farthest: f32,
    unused: f32,
}

@group(2) @binding(0) var<uniform> map: MapUniforms;

fn in_map(local: vec3f) -> vec3f {
    let at = map.from_local * vec4f(local, 1.0);
    return vec3f(at.xy / at.w, at.z);
}

// From homogeneous column and row, and depth. The sun's depth is linear; a lamp's 1 − near/depth, as rasterisers need it.
fn clip_from_map(at: vec4f) -> vec4f {
    let depth = (at.z - map.near) / select(map.range, 1.0 - map.near / map.range, map.near > 0.0);
    return vec4f(at.x / map.size * 2.0 - at.w, at.w - at.y / map.size * 2.0, depth, at.w);
}

// What of a map's depth is metres; where nothing was drawn, none is so far.
fn metres_of(depth: f32) -> f32 {
    if depth >= 1.0 {
        return 1e30;
    }
    return select(depth * map.range, map.near / (1.0 - depth * (1.0 - map.near / map.range)), map.near > 0.0);
}
