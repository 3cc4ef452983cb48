// Which cells the map decides: all but those whose four nearest texels disagree, which keep their bit of the mask.

// A plane so steep against the sun's rays that it falls away this many times as far as it reaches is left to the volumes:
// over one texel it is no plane any more.
const STEEPEST: f32 = 50.0;

@fragment
fn decided(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let face = seen_face(pixel.xy);
    if face == SKY {
        return vec4f(1.0);
    }
    let normal = seen_normal(face);
    let towards = dot(normal, light.to_sun.xyz);
    if towards <= 0.0 {
        return vec4f(0.0);
    }
    let cell = cell_in_map(pixel.xy, normal);
    let first = first_of_four(cell);
    let count = shaded_of_four(cell, first);
    let is_beyond = is_outside(first) && is_outside(first + 1);
    if (count > 0u && count < 4u) || (towards * STEEPEST < 1.0 && !is_beyond) {
        discard;
    }
    return vec4f(1.0 - f32(count) / 4.0);
}
