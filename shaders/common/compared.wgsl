// Cells compared with the map.

@group(3) @binding(0) var map_depth: texture_depth_2d;

// A cell as the map sees it.
struct Cell {
    // Column, row and depth of where it is judged.
    at: vec3f,
    // How much its plane falls away from the sun, metres a column and metres a row.
    slope: vec2f,
}

fn cell_in_map(pixel: vec2f, normal: vec3f) -> Cell {
    let at = in_map(seen_point(pixel) + normal * view.judged_above);
    let towards = max(dot(normal, light.to_sun.xyz), 1e-4);
    return Cell(at, vec2f(dot(normal, map.across.xyz), dot(normal, map.along.xyz)) / towards);
}

// Depth of the cell's plane at a place in the map: what a texel is compared with is the plane where its own sample lies.
fn plane_depth(cell: Cell, at: vec2f) -> f32 {
    return cell.at.z + dot(cell.slope, at - cell.at.xy);
}

// The bias, which grows with the slope (seed 003, slope-scaled bias).
fn margin(cell: Cell) -> f32 {
    return map.bias + map.slope_bias * (abs(cell.slope.x) + abs(cell.slope.y));
}

fn is_outside(texel: vec2i) -> bool {
    return any(texel < vec2i(0)) || any(texel >= vec2i(i32(map.size)));
}

// Whether what a texel holds shades the cell. Beyond the map nothing does.
fn shaded(cell: Cell, texel: vec2i) -> bool {
    if is_outside(texel) {
        return false;
    }
    let depth = metres_of(textureLoad(map_depth, texel, 0));
    return depth < plane_depth(cell, vec2f(texel) + 0.5) - margin(cell);
}

// How many of the four texels from `corner` on shade the cell.
fn shaded_of_four(cell: Cell, corner: vec2i) -> u32 {
    var count = 0u;
    for (var index = 0; index < 4; index++) {
        count += u32(shaded(cell, corner + vec2i(index & 1, index >> 1u)));
    }
    return count;
}

// The first of the four texels whose centres lie around the cell: half a texel aside (seed 001, figure 6).
fn first_of_four(cell: Cell) -> vec2i {
    return vec2i(floor(cell.at.xy - 0.5));
}
