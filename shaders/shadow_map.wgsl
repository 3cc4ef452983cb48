// Shadow maps: the share of a cell's comparisons that see the sun.

@group(3) @binding(0) var packed: texture_2d<f32>;

// How many of the four texels from `corner` on shade the cell.
fn shaded_of_four(cell: Cell, corner: vec2i) -> u32 {
    var count = 0u;
    for (var index = 0; index < 4; index++) {
        count += u32(shaded(cell, corner + vec2i(index & 1, index >> 1u)));
    }
    return count;
}

// The nearest texel.
@fragment
fn none(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let asked = asked(pixel.xy);
    if !asked.is_open {
        return vec4f(asked.share);
    }
    return vec4f(1.0 - f32(shaded(asked.cell, vec2i(floor(asked.cell.at.xy)))));
}

// The four depths that are packed into the nearest texel: 5 levels.
@fragment
fn two_by_two(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let asked = asked(pixel.xy);
    if !asked.is_open {
        return vec4f(asked.share);
    }
    let cell = asked.cell;
    let texel = vec2i(floor(cell.at.xy));
    if is_outside(texel) {
        return vec4f(1.0);
    }
    let depths = textureLoad(packed, texel, 0);
    var count = 0u;
    for (var index = 0u; index < 4u; index++) {
        let shift = vec2f(f32(index & 1u), f32(index >> 1u)) * 0.5 - 0.25;
        count += u32(shades(depths[index], vec2f(texel) + 0.5 + shift, cell));
    }
    return vec4f(1.0 - f32(count) / 4.0);
}

// The four nearest texels of one map: 5 levels.
@fragment
fn fast_two_by_two(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let asked = asked(pixel.xy);
    if !asked.is_open {
        return vec4f(asked.share);
    }
    return vec4f(1.0 - f32(shaded_of_four(asked.cell, first_of_four(asked.cell))) / 4.0);
}

// The sixteen nearest texels, in four fours: 17 levels.
@fragment
fn fast_four_by_four(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let asked = asked(pixel.xy);
    if !asked.is_open {
        return vec4f(asked.share);
    }
    let first = first_of_four(asked.cell) - 1;
    var count = 0u;
    for (var index = 0; index < 4; index++) {
        count += shaded_of_four(asked.cell, first + 2 * vec2i(index & 1, index >> 1u));
    }
    return vec4f(1.0 - f32(count) / 16.0);
}
