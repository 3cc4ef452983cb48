// Cells compared with the map.

@group(3) @binding(0) var map_depth: texture_depth_2d;

// A cell as the map sees it.
struct Cell {
    // Column, row and depth of where it is judged.
    at: vec3f,
    // How much its plane falls away from the light, metres a column and metres a row.
    slope: vec2f,
    // Cosine of the angle between its normal and the direction to the light; not above 0 where it faces away.
    towards: f32,
}

fn cell_in_map(pixel: vec2f, normal: vec3f) -> Cell {
    let judged = seen_point(pixel) + normal * view.judged_above;
    let at = map.from_local * vec4f(judged, 1.0);
    // as long as one metre of depth
    let to_light = (light.towards.xyz - judged * light.towards.w) / at.w;
    let towards = dot(normal, to_light);
    let slope = vec2f(dot(normal, map.across.xyz), dot(normal, map.along.xyz)) * at.w / max(towards, 1e-4);
    return Cell(vec3f(at.xy / at.w, at.z), slope, towards / length(to_light));
}

fn is_outside(texel: vec2i) -> bool {
    return any(texel < vec2i(0)) || any(texel >= vec2i(i32(map.size)));
}

// Whether what a texel holds shades the cell. Beyond the map nothing does. The map's depth has its slope-scaled bias: as
// deep as the face is anywhere that this texel may be asked from, so that no surface shades itself.
fn shaded(cell: Cell, texel: vec2i) -> bool {
    if is_outside(texel) {
        return false;
    }
    return metres_of(textureLoad(map_depth, texel, 0)) < cell.at.z - map.bias;
}

// The first of the four texels whose centres lie around the cell: half a texel aside (seed 001, figure 6).
fn first_of_four(cell: Cell) -> vec2i {
    return vec2i(floor(cell.at.xy - 0.5));
}
