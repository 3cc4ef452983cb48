// What is asked of a batch's faces and edges.

struct SearchUniforms {
    // Homogeneous, around the mesh's origin: the sun (to_sun, 0) or a lamp (position, 1).
    light: vec4f,
    // 6, or 3 where all walls end in one point.
    indices_per_wall: u32,
    // 1 where walls stand half as often.
    halved: u32,
    unused: vec2u,
}

@group(2) @binding(0) var<uniform> search: SearchUniforms;
