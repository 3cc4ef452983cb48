// Shadow volumes, extruded here; and the mask from their count.
//
// A caster's vertex comes twice: where it is (1) and where its wall ends (0).

struct Corner {
    @location(0) vertex: vec4f,
}

@vertex
fn cap(corner: Corner) -> @builtin(position) @invariant vec4f {
    return view.clip_from_local * vec4f(corner.vertex.xyz, 1.0);
}

// Caps in the plan, with what of a wall their depth needs.
@vertex
fn cap_in_plan(corner: Corner) -> Wall {
    let vertex = corner.vertex.xyz;
    let sunk = max(view.lowest_z - vertex.z, 0.0);
    return Wall(view.clip_from_local * vec4f(vertex, 1.0), vertex, sunk, 0.0);
}

struct Wall {
    @builtin(position) @invariant position: vec4f,
    // Where the triangle's first vertex comes from: of the wall's two casting vertices the one nearer to the sun.
    @location(0) @interpolate(flat, first) sunward: vec3f,
    // How far the wall reaches below the lowest point that is judged, metres; 0 where its edge is above that.
    @location(1) sunk: f32,
    // 0 where the wall hangs from its edge, 1 where it ends.
    @location(2) fallen: f32,
}

// Walls that end at the lowest point that is judged, at v − to_sun · height / to_sun.z. A sun on the horizon has it scaled
// by to_sun.z, so that nothing is divided by 0; all others not, so that in the plan everything is linear.
fn at_lowest(corner: vec4f) -> Wall {
    let vertex = corner.xyz;
    let height = vertex.z - view.lowest_z;
    if corner.w > 0.5 || height <= 0.0 {
        return Wall(view.clip_from_local * vec4f(vertex, 1.0), vertex, max(-height, 0.0), 1.0 - corner.w);
    }
    let rise = light.towards.z;
    if rise > 1e-3 {
        let end = vec3f(vertex.xy - light.towards.xy * (height / rise), view.lowest_z);
        return Wall(view.clip_from_local * vec4f(end, 1.0), vertex, 0.0, 1.0);
    }
    let end = view.clip_from_local * vec4f(vertex * rise - light.towards.xyz * height, rise);
    return Wall(end, vertex, 0.0, 1.0);
}

@vertex
fn wall_to_lowest(corner: Corner) -> Wall {
    return at_lowest(corner.vertex);
}

// Walls that end at the point at infinity away from the sun.
fn at_infinity(vertex: vec4f) -> vec4f {
    if vertex.w > 0.5 {
        return view.clip_from_local * vec4f(vertex.xyz, 1.0);
    }
    return view.clip_from_local * vec4f(-light.towards.xyz, 0.0);
}

@vertex
fn wall_to_infinity(corner: Corner) -> @builtin(position) @invariant vec4f {
    return at_infinity(corner.vertex);
}

// Volumes leave their trace in the stencil alone.
@fragment
fn counted() -> @location(0) vec4f {
    return vec4f(0.0);
}

// To be added up.
@fragment
fn one() -> @location(0) vec4f {
    return vec4f(1.0);
}

struct Counted {
    @builtin(frag_depth) depth: f32,
    @location(0) nothing: vec4f,
}

// The plan sees many walls edge-on: slivers that no cell's centre should meet, but that some do once corners are rounded
// to the raster, and whose depth there can be anything. Their depth is taken from the sun's ray through their sunward
// vertex, which is their lower end or lies in them; any depth between their lower and their upper end is as good.
//
// A sliver is so narrow that from its edge to its end it fits into 1/64 of a cell. Wider walls keep their own depth:
// where two meet in an edge it must be equal. What reaches into the ground has its height from above the ground alone,
// and so must be steep as if it ended there: else gentle slopes that come out of the ground by a hand's breadth would be
// slivers.
@fragment
fn counted_in_plan(wall: Wall) -> Counted {
    let depth = wall.position.z + view.depth_scale * wall.sunk;
    let height = wall.sunward.z - view.lowest_z;
    // written so that NaN counts as narrow and steep
    let wide = fwidth(wall.fallen) <= 64.0 || fwidth(depth) <= 64.0 * height * view.depth_scale;
    if !wide && height > 0.0 {
        return Counted(max(depth_in_plan(height_of_sliver(wall)), above_lowest()), vec4f(0.0));
    }
    return Counted(not_below_lowest(wall), vec4f(0.0));
}

@fragment
fn cap_counted_in_plan(cap: Wall) -> Counted {
    return Counted(not_below_lowest(cap), vec4f(0.0));
}

// What does not run into the ground is above the lowest point that is judged, whatever the rounding.
fn not_below_lowest(wall: Wall) -> f32 {
    return select(max(wall.position.z, above_lowest()), wall.position.z, wall.sunk > 0.0);
}

fn above_lowest() -> f32 {
    return depth_in_plan(view.lowest_z + 0.5 * view.judged_above);
}

fn depth_in_plan(z: f32) -> f32 {
    return view.clip_from_local[2].z * z + view.clip_from_local[3].z;
}

fn height_of_sliver(wall: Wall) -> f32 {
    let across = light.towards.xy;
    let along = dot(wall.sunward.xy - at_in_plan(wall.position.xy), across) / max(dot(across, across), 1e-12);
    return wall.sunward.z - max(along, 0.0) * light.towards.z;
}

// Before any volume: what faces away from the sun, or is edge-on to it, is in shadow; the sky is not.
@fragment
fn facing(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let face = seen_face(pixel.xy);
    let lit = face == SKY || dot(seen_normal(face), light.towards.xyz) > 0.0;
    return vec4f(select(0.0, 1.0, lit));
}

// Where the stencil test says that the count is not 0.
@fragment
fn covered() -> @location(0) vec4f {
    return vec4f(0.0);
}
