// Depth as the sun sees it.

// The last one is no shift; the others put four maps a quarter of a texel from the texel's centre (seed 001, figure 3).
var<private> jitter: array<vec2f, 5> =
    array(vec2f(-0.25, -0.25), vec2f(0.25, -0.25), vec2f(-0.25, 0.25), vec2f(0.25, 0.25), vec2f(0.0));

// The instance says which shift.
@vertex
fn seen_from_sun(@location(0) local: vec3f, @builtin(instance_index) shift: u32) -> @builtin(position) vec4f {
    let at = in_map(local);
    return clip_from_map(vec3f(at.xy - jitter[shift], at.z));
}

// Where four depths are packed into the channels of one texel.
@fragment
fn depth_as_colour(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(at.z);
}
