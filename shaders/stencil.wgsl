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

struct Wall {
    @builtin(position) @invariant position: vec4f,
    // Depth of the triangle's first vertex: in the plan the wall's highest.
    @location(0) @interpolate(flat, first) top: f32,
}

// Walls that end at the lowest receiver. The end is v − to_sun · height / to_sun.z, scaled by to_sun.z, so that a sun
// on the horizon needs no division.
fn at_lowest(vertex: vec4f) -> Wall {
    let here = view.clip_from_local * vec4f(vertex.xyz, 1.0);
    let height = vertex.z - view.lowest_z;
    if vertex.w > 0.5 || height <= 0.0 {
        return Wall(here, here.z);
    }
    let rise = light.to_sun.z;
    let end = view.clip_from_local * vec4f(vertex.xyz * rise - light.to_sun.xyz * height, rise);
    return Wall(end, here.z);
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
    return view.clip_from_local * vec4f(-light.to_sun.xyz, 0.0);
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

struct Counted {
    @builtin(frag_depth) depth: f32,
    @location(0) nothing: vec4f,
}

// The plan sees many walls edge-on: slivers whose depth, extrapolated to a cell's centre that they do not hold, can be
// anything. A wall is never below the lowest receiver, and never above its highest vertex. The latter bounds slivers
// alone (steeper than 1 km a cell): wider walls that meet in an edge have equal depths there, which must stay equal.
@fragment
fn counted_in_plan(wall: Wall) -> Counted {
    let depth = wall.position.z;
    let lowest = view.clip_from_local * vec4f(0.0, 0.0, view.lowest_z + 1.5 * view.judged_above, 1.0);
    let steep = fwidth(depth) > view.depth_scale * 1000.0;
    return Counted(max(select(depth, min(depth, wall.top), steep), lowest.z), vec4f(0.0));
}

// Before any volume: what faces away from the sun, or is edge-on to it, is in shadow; the sky is not.
@fragment
fn facing(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let face = seen_face(pixel.xy);
    let lit = face == SKY || dot(seen_normal(face), light.to_sun.xyz) > 0.0;
    return vec4f(select(0.0, 1.0, lit));
}

// Where the stencil test says that the count is not 0.
@fragment
fn covered() -> @location(0) vec4f {
    return vec4f(0.0);
}
