// Receivers that are flush with the ground, shown before it: the last one that is drawn stays, whatever rounding makes of
// its depth.

// Of each face of the receivers, in rows as their planes, whether it is flush with the ground: 1.
@group(2) @binding(0) var is_flush: texture_2d<u32>;

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
