// What each cell sees, and its normal on the seen side.

const GROUND: u32 = 0xfffffffeu;
const SKY: u32 = 0xffffffffu;
// Planes of the receivers' faces lie in rows of this many texels.
const PLANES_WIDTH: u32 = 4096u;

@group(1) @binding(0) var faces: texture_2d<u32>;
@group(1) @binding(1) var planes: texture_2d<f32>;
@group(1) @binding(2) var depths: texture_depth_2d;

fn seen_face(pixel: vec2f) -> u32 {
    return textureLoad(faces, vec2u(pixel), 0).x;
}

// Metres east and north of a pixel's centre in the plan.
fn at_in_plan(pixel: vec2f) -> vec2f {
    let clip = (pixel / view.size * 2.0 - 1.0) * vec2f(1.0, -1.0);
    return (clip - view.clip_from_local[3].xy) / vec2f(view.clip_from_local[0].x, view.clip_from_local[1].y);
}

// What a pixel sees, metres around the scene's origin; not the sky.
fn seen_point(pixel: vec2f) -> vec3f {
    let depth = textureLoad(depths, vec2u(pixel), 0);
    if is_plan() {
        return vec3f(at_in_plan(pixel), (depth - view.clip_from_local[3].z) / view.clip_from_local[2].z);
    }
    return view.viewer.xyz + ray(pixel) * (view.depth_scale / depth);
}

// Zero where a face has no area.
fn seen_normal(face: u32) -> vec3f {
    var plane = vec4f(0.0, 0.0, 1.0, -view.ground_z);
    if face != GROUND {
        plane = textureLoad(planes, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0);
    }
    return select(plane.xyz, -plane.xyz, dot(plane, view.viewer) < 0.0);
}
