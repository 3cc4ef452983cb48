// Faces that fall along the sun onto a plan's raster.

struct FallUniforms {
    // Columns and rows that a shadow falls away from the sun, a metre of height.
    a_metre: vec2f,
    // Columns and rows of the raster.
    size: vec2f,
}

@group(0) @binding(0) var<uniform> fall: FallUniforms;

// Columns and rows from the raster's middle, and metres above the plane.
@vertex
fn fallen(@location(0) point: vec3f) -> @builtin(position) vec4f {
    let place = point.xy - fall.a_metre * point.z;
    return vec4f(place / fall.size * vec2f(2.0, -2.0), 0.0, 1.0);
}

@fragment
fn shaded() -> @location(0) vec4f {
    return vec4f(0.0);
}
