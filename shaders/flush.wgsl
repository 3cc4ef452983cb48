// Receivers that are flush with the ground, shown before it: the last one that is drawn stays, whatever rounding makes of
// its depth.

// Of each face of the receivers, in rows as their planes, whether it is flush with the ground: 1.
@group(2) @binding(0) var is_flush: texture_2d<u32>;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) face: u32,
}

@vertex
fn flush_receiver(@location(0) position: vec3f, @location(1) face: u32) -> Corner {
    return Corner(view.clip_from_local * vec4f(position, 1.0), face);
}

@fragment
fn flush_face(corner: Corner) -> @location(0) u32 {
    let nearest = seen_face(corner.position.xy);
    if nearest == SKY {
        discard;
    }
    if nearest != GROUND {
        let place = vec2u(nearest % PLANES_WIDTH, nearest / PLANES_WIDTH);
        if textureLoad(is_flush, place, 0).x == 0u {
            discard;
        }
    }
    return corner.face;
}
