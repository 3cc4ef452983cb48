// A corner of a receiver's face, as the view sees it.

struct Corner {
    @builtin(position) @invariant position: vec4f,
    @location(0) @interpolate(flat) face: u32,
}

@vertex
fn receiver(@location(0) position: vec3f, @location(1) face: u32) -> Corner {
    return Corner(view.clip_from_local * vec4f(position, 1.0), face);
}
