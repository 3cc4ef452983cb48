// The depth at which each cell is judged: one millimetre above what it sees, along the normal of the seen side.
//
// The seen plane is moved by that much, and the cell looks at the moved plane; that differs from moving the seen point
// by a millimetre along the plane at the most. Planes steeper than 1 in 100 against the ray are moved by a tenth of a
// metre along it and no more.

@fragment
fn judged_depth(@builtin(position) pixel: vec4f) -> @builtin(frag_depth) f32 {
    let face = seen_face(pixel.xy);
    if face == SKY {
        return 0.0;
    }
    let depth = textureLoad(depths, vec2u(pixel.xy), 0);
    let normal = seen_normal(face);
    if is_plan() {
        return depth + view.depth_scale * view.judged_above / max(normal.z, 0.01);
    }
    let ray = ray(pixel.xy);
    let across = max(-dot(normal, normalize(ray)), 0.01);
    let distance = view.depth_scale / depth - view.judged_above / (across * length(ray));
    return min(view.depth_scale / distance, 1.0);
}
