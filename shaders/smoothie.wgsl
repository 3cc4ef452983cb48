// Smoothies: silhouette edges pushed outwards in the light's view, and how much of the light is seen past them.

@group(3) @binding(1) var receivers_depth: texture_depth_2d;
@group(3) @binding(2) var smoothies: texture_2d<f32>;
// The same for what lies behind receivers that shade nothing.
@group(3) @binding(3) var smoothies_beyond: texture_2d<f32>;

const PI: f32 = 3.14159265;

struct Smoothie {
    @builtin(position) position: vec4f,
    // The edge's ends in the map's plane, rightwards and upwards, and their depth.
    @location(0) @interpolate(flat) start: vec3f,
    @location(1) @interpolate(flat) end: vec3f,
    // How wide the smoothie is there, metres.
    @location(2) @interpolate(flat) widths: vec2f,
}

// The plane of the map in metres, rightwards and upwards: seen from the light.
fn metric(at: vec2f) -> vec2f {
    return vec2f(at.x, -at.y) * map.texel;
}

// What is thinner than this in the map's plane counts as nothing.
fn hair() -> f32 {
    return 0.05 * max(map.texel.x, map.texel.y);
}

// A lamp's as it is asked. The sun's as wide as the penumbra can become on its way to the lowest receiver and within what
// is seen, and no wider than is asked.
fn width_at(local: vec3f, depth: f32) -> f32 {
    if map.near > 0.0 {
        return map.width;
    }
    let farthest = min((local.z - view.lowest_z) / max(light.towards.z, 1e-4), map.farthest - depth);
    let of_disc = map.spread * max(farthest, 0.0);
    return select(of_disc, min(of_disc, map.width), map.width > 0.0);
}

// One rectangle an edge, from the edge outwards and beyond its ends as far: there it is the corner, whose alpha is the
// distance to the vertex. So corners meet whatever number of edges they have. The blocker lies on the edge's left.
@vertex
fn smoothie(@builtin(vertex_index) index: u32, @location(0) from_local: vec3f, @location(1) to_local: vec3f) -> Smoothie {
    let ends = array(in_map(from_local), in_map(to_local));
    let start = vec3f(metric(ends[0].xy), ends[0].z);
    let end = vec3f(metric(ends[1].xy), ends[1].z);
    let length = distance(start.xy, end.xy);
    let widths = vec2f(width_at(from_local, start.z), width_at(to_local, end.z));
    let width = max(widths.x, widths.y);
    // seen end-on, on the lowest receiver, or behind a lamp: no area
    if length < 1e-6 || width <= 0.0 || min(start.z, end.z) < map.near {
        return Smoothie(vec4f(0.0), vec3f(0.0), vec3f(0.0), vec2f(0.0));
    }
    let along = (end.xy - start.xy) / length;
    let outwards = vec2f(along.y, -along.x);
    // two triangles; odd corners lie at the end
    var corners = array(0u, 1u, 2u, 2u, 1u, 3u);
    let corner = corners[index];
    // a hair inwards, so that no texel is left out between blocker and smoothie
    let side = select(-hair(), width, corner >= 2u);
    let at = select(start.xy - along * width, end.xy + along * width, (corner & 1u) == 1u) + outwards * side;
    let clip = clip_from_map(vec4f(vec2f(at.x, -at.y) / map.texel, 0.0, 1.0));
    return Smoothie(vec4f(clip.xy, 0.5, 1.0), start, end, widths);
}

// How much of a disc is seen past a straight edge that covers all but this part of its width.
fn falloff(alpha: f32) -> f32 {
    let x = clamp(2.0 * alpha - 1.0, -1.0, 1.0);
    return 0.5 + (x * sqrt(1.0 - x * x) + asin(x)) / PI;
}

// How wide the penumbra of an edge is on a receiver, in the map's plane: alpha is divided by it. The sun's by its disc; a
// lamp's t · (1 − b/r) (E. Chan's thesis, equation 4.1).
fn penumbra(edge: f32, receiver: f32) -> f32 {
    if map.near > 0.0 {
        return map.width * (1.0 - edge / receiver);
    }
    let of_disc = map.spread * (receiver - edge);
    return select(of_disc, min(of_disc, map.width), map.width > 0.0);
}

// How deep the ground lies at a place in the map; nowhere, where a lamp looks above the horizon.
fn ground_at(at: vec2f) -> f32 {
    let sum = dot(map.ground.xy, at) + map.ground.z;
    if map.near > 0.0 {
        return select(1e30, map.ground.w / sum, map.ground.w * sum > 0.0);
    }
    return sum;
}

// How deep what the light falls on first lies.
fn receiver_at(at: vec2f) -> f32 {
    return min(receiver_beyond(at), metres_of(textureLoad(receivers_depth, vec2i(at), 0)));
}

// The same without receivers that shade nothing: casters and the ground.
fn receiver_beyond(at: vec2f) -> f32 {
    return min(metres_of(textureLoad(map_depth, vec2i(at), 0)), ground_at(at));
}

@fragment
fn alpha(smoothie: Smoothie) -> @location(0) vec4f {
    return alpha_on(smoothie, receiver_at(smoothie.position.xy));
}

@fragment
fn alpha_beyond(smoothie: Smoothie) -> @location(0) vec4f {
    return alpha_on(smoothie, receiver_beyond(smoothie.position.xy));
}

// How much of the light is seen on a receiver so deep, and how deep the edge lies.
fn alpha_on(smoothie: Smoothie, receiver: f32) -> vec4f {
    let edge = smoothie.end.xy - smoothie.start.xy;
    let at = metric(smoothie.position.xy);
    let share = clamp(dot(at - smoothie.start.xy, edge) / dot(edge, edge), 0.0, 1.0);
    var nearest = mix(smoothie.start, smoothie.end, share);
    if map.near > 0.0 {
        // in perspective it is the inverse that is linear
        nearest.z = 1.0 / mix(1.0 / smoothie.start.z, 1.0 / smoothie.end.z, share);
    }
    let remapped_width = penumbra(nearest.z, receiver);
    // behind a blocker, or so near to its receiver that the edge is hard
    if remapped_width <= hair() {
        discard;
    }
    let drawn_width = mix(smoothie.widths.x, smoothie.widths.y, share);
    let remapped = distance(at, nearest.xy) / select(remapped_width, drawn_width, map.linear > 0.0);
    if remapped >= 1.0 {
        discard;
    }
    return vec4f(falloff(remapped), nearest.z, 0.0, 0.0);
}

// What a texel says of a cell: behind a blocker nothing is seen, behind a smoothie a part. A smoothie must lie nearer to
// the sun by all that the cell's plane falls away over a texel: at a roof's own edge it does not.
fn seen_past(cell: Cell, texel: vec2i) -> f32 {
    if is_outside(texel) {
        return 1.0;
    }
    if shaded(cell, texel) {
        return 0.0;
    }
    let slope = abs(cell.slope.x) + abs(cell.slope.y);
    let before_cell = cell.at.z - rounding(cell) - slope;
    var smoothie = textureLoad(smoothies, texel, 0);
    if metres_of(textureLoad(receivers_depth, texel, 0)) < before_cell {
        smoothie = textureLoad(smoothies_beyond, texel, 0);
    }
    let is_behind = smoothie.y < before_cell;
    return select(1.0, smoothie.x, is_behind);
}

// The four nearest texels, each compared, then interpolated.
@fragment
fn softened(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let asked = asked(pixel.xy);
    if !asked.is_open {
        return vec4f(asked.share);
    }
    let cell = asked.cell;
    let first = first_of_four(cell);
    let part = cell.at.xy - 0.5 - vec2f(first);
    let upper = mix(seen_past(cell, first), seen_past(cell, first + vec2i(1, 0)), part.x);
    let lower = mix(seen_past(cell, first + vec2i(0, 1)), seen_past(cell, first + vec2i(1, 1)), part.x);
    return vec4f(mix(upper, lower, part.y));
}
