// Which cells the map decides: all but those whose four nearest texels disagree, which keep their bit of the mask.

// A plane so steep against the sun's rays that it falls away this many times as far as it reaches is left to the volumes:
// over one texel it is no plane any more.
const STEEPEST: f32 = 50.0;

// How many of the four texels from `first` on lie before the cell's own plane. Even a caster that stands on the
// plane lies before it. Where that is too strict, texels disagree, and the volumes decide.
fn before_plane_of_four(cell: Cell, first: vec2i) -> u32 {
    let rounding = rounding(cell);
    var count = 0u;
    for (var index = 0; index < 4; index++) {
        let texel = first + vec2i(index & 1, index >> 1u);
        if is_outside(texel) {
            continue;
        }
        let plane = plane_depth(cell, vec2f(texel) + 0.5);
        count += u32(metres_of(textureLoad(map_depth, texel, 0)) < plane - rounding);
    }
    return count;
}

@fragment
fn decided(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let asked = asked(pixel.xy);
    if !asked.is_open {
        return vec4f(asked.share);
    }
    let cell = asked.cell;
    let first = first_of_four(cell);
    let count = before_plane_of_four(cell, first);
    let is_beyond = is_outside(first) && is_outside(first + 1);
    if (count > 0u && count < 4u) || (cell.towards * STEEPEST < 1.0 && !is_beyond) {
        discard;
    }
    return vec4f(1.0 - f32(count) / 4.0);
}
