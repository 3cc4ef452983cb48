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

// Depth of the cell's plane at a place in the map.
fn plane_depth(cell: Cell, at: vec2f) -> f32 {
    return cell.at.z + dot(cell.slope, at - cell.at.xy);
}

// What rounding does to a depth: metres, and the map's corners lie on 1/256 of a texel.
fn rounding(cell: Cell) -> f32 {
    return map.bias + 0.02 * (abs(cell.slope.x) + abs(cell.slope.y));
}

// Whether a depth of the map, sampled at a place in it, shades the cell: it must lie nearer to the light than the cell, and
// than the cell's plane at that place. By the first a lit wall does not shade the ground at its foot, by the second no
// plane shades itself; what is left for the slope-scaled bias, which the map's depth has, is curvature and corners.
fn shades(depth: f32, sampled_at: vec2f, cell: Cell) -> bool {
    return metres_of(depth) < min(cell.at.z, plane_depth(cell, sampled_at)) - rounding(cell);
}

// Whether what a texel holds shades the cell. Beyond the map nothing does.
fn shaded(cell: Cell, texel: vec2i) -> bool {
    return !is_outside(texel) && shades(textureLoad(map_depth, texel, 0), vec2f(texel) + 0.5, cell);
}

// The first of the four texels whose centres lie around the cell: half a texel aside (Brabec and Seidel, figure 6).
fn first_of_four(cell: Cell) -> vec2i {
    return vec2i(floor(cell.at.xy - 0.5));
}

// A cell that is to be compared (open), or the share of one that needs no map: the sky sees the light, what faces away does
// not.
struct Asked {
    share: f32,
    is_open: bool,
    cell: Cell,
}

fn asked(pixel: vec2f) -> Asked {
    let face = seen_face(pixel);
    if face == SKY {
        return Asked(1.0, false, Cell());
    }
    let cell = cell_in_map(pixel, seen_normal(face));
    return Asked(0.0, cell.towards > 0.0, cell);
}
