// Shadow volumes, extruded here; and the mask from their count.
//
// A caster's vertex comes twice: where it is (1) and where its wall ends (0).

struct Corner {
    @location(0) vertex: vec4f,
}

fn stays(corner: Corner) -> bool {
    return corner.vertex.w > 0.5;
}

@vertex
fn cap(corner: Corner) -> @builtin(position) @invariant vec4f {
    return view.clip_from_local * vec4f(corner.vertex.xyz, 1.0);
}

// Walls that end at the lowest receiver. The end is v − to_sun · height / to_sun.z, scaled by to_sun.z, so that a sun
// on the horizon needs no division.
@vertex
fn wall_to_lowest(corner: Corner) -> @builtin(position) @invariant vec4f {
    let height = corner.vertex.z - view.lowest_z;
    if stays(corner) || height <= 0.0 {
        return view.clip_from_local * vec4f(corner.vertex.xyz, 1.0);
    }
    let rise = light.to_sun.z;
    return view.clip_from_local * vec4f(corner.vertex.xyz * rise - light.to_sun.xyz * height, rise);
}

// Walls that end at the point at infinity away from the sun.
@vertex
fn wall_to_infinity(corner: Corner) -> @builtin(position) @invariant vec4f {
    if stays(corner) {
        return view.clip_from_local * vec4f(corner.vertex.xyz, 1.0);
    }
    return view.clip_from_local * vec4f(-light.to_sun.xyz, 0.0);
}

// Volumes leave their trace in the stencil alone.
@fragment
fn counted() -> @location(0) vec4f {
    return vec4f(0.0);
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
