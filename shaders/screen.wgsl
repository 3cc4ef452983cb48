// A picture, or one colour, into a frame of the window. All values are display values; a frame that keeps linear light is
// given that.

@group(0) @binding(0) var<uniform> colour: vec4f;
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,
}

@vertex
fn whole_viewport(@builtin(vertex_index) index: u32) -> Corner {
    let at = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Corner(vec4f(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0), at);
}

fn linear(display: vec3f) -> vec3f {
    return select(pow((display + 0.055) / 1.055, vec3f(2.4)), display / 12.92, display <= vec3f(0.04045));
}

@fragment
fn show(corner: Corner) -> @location(0) vec4f {
    return textureSampleLevel(picture, smooth_sampler, corner.at, 0.0);
}

@fragment
fn show_linear(corner: Corner) -> @location(0) vec4f {
    return vec4f(linear(textureSampleLevel(picture, smooth_sampler, corner.at, 0.0).rgb), 1.0);
}

@fragment
fn fill() -> @location(0) vec4f {
    return colour;
}

@fragment
fn fill_linear() -> @location(0) vec4f {
    return vec4f(linear(colour.rgb), 1.0);
}
