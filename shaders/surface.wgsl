// What each cell sees of the receivers and the ground: depth and face. Drawn once per study.

@fragment
fn receiver_face(corner: Corner) -> @location(0) u32 {
    return corner.face;
}

struct Ground {
    @builtin(frag_depth) depth: f32,
    @location(0) face: u32,
}

// The ground's depth in closed form: it reaches to the horizon, where no triangle would.
@fragment
fn ground(@builtin(position) pixel: vec4f) -> Ground {
    if is_plan() {
        return Ground((view.clip_from_local * vec4f(0.0, 0.0, view.ground_z, 1.0)).z, 0xfffffffeu);
    }
    if is_elevation() {
        // earth that is cut hides all behind it
        if ray_start(pixel.xy).z >= view.ground_z {
            discard;
        }
        return Ground(1.0, 0xfffffffeu);
    }
    let distance = (view.ground_z - view.viewer.z) / ray(pixel.xy).z;
    if !(distance > view.depth_scale) {
        discard;
    }
    return Ground(view.depth_scale / distance, 0xfffffffeu);
}
