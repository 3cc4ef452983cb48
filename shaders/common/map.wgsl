// The map: the sun's parallel view, in which a place is column and row in texels, and metres away from the sun.

struct Map {
    // Metres around the scene's origin → column, row, and metres from the map's near side.
    from_local: mat4x4f,
    // One texel to the right and one downwards, metres around the scene's origin.
    across: vec4f,
    along: vec4f,
    // The ground's depth: metres a column, metres a row, metres at the map's corner.
    ground: vec4f,
    // A texel's width and height, metres.
    texel: vec2f,
    // Texels a side.
    size: f32,
    // Metres from the near side to the far one.
    range: f32,
    // How much nearer to the sun a texel must be to shade a cell: metres, and texels of the cell's slope.
    bias: f32,
    slope_bias: f32,
    // Width of the sun's penumbra a metre behind an edge.
    spread: f32,
    // Width of smoothies, metres; 0 where the sun's disc decides.
    width: f32,
}

@group(2) @binding(0) var<uniform> map: Map;

fn in_map(local: vec3f) -> vec3f {
    return (map.from_local * vec4f(local, 1.0)).xyz;
}

fn clip_from_map(at: vec3f) -> vec4f {
    return vec4f(at.x / map.size * 2.0 - 1.0, 1.0 - at.y / map.size * 2.0, at.z / map.range, 1.0);
}

// What of a map's depth is metres; where nothing was drawn, none is so far.
fn metres_of(depth: f32) -> f32 {
    return select(depth * map.range, 1e30, depth >= 1.0);
}
