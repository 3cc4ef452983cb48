// The view, the light and the whole picture as one triangle. Positions are metres around the scene's origin.

struct ViewUniforms {
    // Depth is 1 near and 0 far.
    clip_from_local: mat4x4f,
    // Homogeneous: the eye, or for the plan the direction straight up, for an elevation that towards the viewer.
    viewer: vec4f,
    // The camera's axes; right and up reach to the picture's border at distance 1, in an elevation at any.
    right: vec4f,
    up: vec4f,
    forward: vec4f,
    ground_z: f32,
    // The lowest point that is judged.
    lowest_z: f32,
    judged_above: f32,
    // Plan: depth a metre of height. Camera: the near plane's distance, metres.
    depth_scale: f32,
    // Columns and rows.
    size: vec2f,
    unused: vec2f,
}

struct LightUniforms {
    // Homogeneous: the unit vector to the sun (w = 0), or a lamp's place around the scene's origin (w = 1).
    towards: vec4f,
}

@group(0) @binding(0) var<uniform> view: ViewUniforms;
@group(0) @binding(1) var<uniform> light: LightUniforms;

@vertex
fn whole_picture(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn is_plan() -> bool {
    return view.viewer.w == 0.0 && view.viewer.z != 0.0;
}

// A side along parallel, level rays.
fn is_elevation() -> bool {
    return view.viewer.w == 0.0 && view.viewer.z == 0.0;
}

// The camera's ray through a pixel's centre, as long as it needs to be one metre deep.
fn ray(pixel: vec2f) -> vec3f {
    if is_elevation() {
        return view.forward.xyz;
    }
    let at = pixel / view.size * 2.0 - 1.0;
    return view.forward.xyz + view.right.xyz * at.x - view.up.xyz * at.y;
}

// A point on that ray, homogeneous: the eye; in an elevation, the nearest to the origin.
fn ray_start(pixel: vec2f) -> vec4f {
    if !is_elevation() {
        return view.viewer;
    }
    let clip = (pixel / view.size * 2.0 - 1.0) * vec2f(1.0, -1.0) - view.clip_from_local[3].xy;
    return vec4f(view.right.xyz * clip.x + view.up.xyz * clip.y, 1.0);
}
