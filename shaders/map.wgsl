// Depth as the light sees it.

// The last one is no shift; the others put four maps a quarter of a texel from the texel's centre (Brabec and
// Seidel, figure 3).
var<private> jitter: array<vec2f, 5> =
    array(vec2f(-0.25, -0.25), vec2f(0.25, -0.25), vec2f(-0.25, 0.25), vec2f(0.25, 0.25), vec2f(0.0));

// The instance says which shift.
@vertex
fn seen_from_light(@location(0) local: vec3f, @builtin(instance_index) shift: u32) -> @builtin(position) vec4f {
    let at = map.from_local * vec4f(local, 1.0);
    return clip_from_map(vec4f(at.xy - jitter[shift] * at.w, at.zw));
}

// Where four depths are packed into the channels of one texel, with the bias that the adapter gives to depth alone.
@fragment
fn depth_as_colour(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(at.z + map.slope_bias * max(abs(dpdx(at.z)), abs(dpdy(at.z))));
}
