// The silhouette as lines over a camera's picture: each edge a quadrilateral as wide as the line, hidden where the
// picture shows something nearer.

// Half a line's width, pixels.
const RADIUS: f32 = 1.2;
// An edge lies on what is seen, give or take rounding: depth by so much nearer still shows, 1 cm in 50 m.
const TOWARDS_EYE: f32 = 1.0002;

struct Line {
    @builtin(position) position: vec4f,
    // The ends on the picture: column and row in pixels, and depth.
    @location(0) @interpolate(flat) start: vec3f,
    @location(1) @interpolate(flat) end: vec3f,
}

fn on_picture(clip: vec4f) -> vec3f {
    let at = clip.xyz / clip.w;
    return vec3f((vec2f(at.x, -at.y) * 0.5 + 0.5) * view.size, at.z);
}

// One end, moved along the edge to the near plane where it lies before it; w is the distance along the camera's axis.
fn in_front(end: vec4f, other: vec4f) -> vec4f {
    let near = view.depth_scale;
    if end.w >= near || other.w <= near {
        return end;
    }
    return mix(other, end, (other.w - near) / (other.w - end.w));
}

@vertex
fn line(@builtin(vertex_index) index: u32, @location(0) from_local: vec3f, @location(1) to_local: vec3f) -> Line {
    let ends = array(view.clip_from_local * vec4f(from_local, 1.0), view.clip_from_local * vec4f(to_local, 1.0));
    if max(ends[0].w, ends[1].w) <= view.depth_scale {
        return Line(vec4f(0.0), vec3f(0.0), vec3f(0.0)); // behind the eye: no area
    }
    let start = on_picture(in_front(ends[0], ends[1]));
    let end = on_picture(in_front(ends[1], ends[0]));
    let length = distance(start.xy, end.xy);
    let along = select(vec2f(1.0, 0.0), (end.xy - start.xy) / length, length > 1e-6);
    let across = vec2f(-along.y, along.x);
    // two triangles; odd corners lie at the end
    var corners = array(0u, 1u, 2u, 2u, 1u, 3u);
    let corner = corners[index];
    let reach = RADIUS + 1.0;
    let at_end = (corner & 1u) == 1u;
    let side = select(-reach, reach, corner >= 2u);
    let at = select(start.xy - along * reach, end.xy + along * reach, at_end) + across * side;
    let clip = (at / view.size * 2.0 - 1.0) * vec2f(1.0, -1.0);
    return Line(vec4f(clip, 0.0, 1.0), start, end);
}

// Depth at which the ray through a point of the picture meets the plane of a face.
fn depth_on(face: u32, pixel: vec2f) -> f32 {
    var plane = vec4f(0.0, 0.0, 1.0, -view.ground_z);
    if face != GROUND {
        plane = textureLoad(planes, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0);
    }
    return -view.depth_scale * dot(plane.xyz, ray(pixel)) / dot(plane, view.viewer);
}

// Whether all that is seen around a point of the line lies before it. Of the four cells around, one that does not is
// enough: at an edge they see different faces. And of each the plane is asked where it meets the point's own ray, for
// at the cell's centre a face that slopes towards the eye is nearer than its own edge.
fn hidden(point: vec3f) -> bool {
    let corner = vec2i(floor(point.xy - 0.5));
    let last = vec2i(view.size) - 1;
    let nearest = point.z * TOWARDS_EYE;
    for (var index = 0; index < 4; index++) {
        let cell = clamp(corner + vec2i(index & 1, index >> 1u), vec2i(0), last);
        let face = textureLoad(faces, cell, 0).x;
        if face == SKY || textureLoad(depths, cell, 0) <= nearest || depth_on(face, point.xy) <= nearest {
            return false;
        }
    }
    return true;
}

// How much of the pixel the line covers.
@fragment
fn ink(line: Line) -> @location(0) vec4f {
    let pixel = line.position.xy;
    let along = line.end.xy - line.start.xy;
    let share = clamp(dot(pixel - line.start.xy, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    // depth on the picture is linear along a line
    let point = mix(line.start, line.end, share);
    let cover = clamp(RADIUS + 0.5 - distance(pixel, point.xy), 0.0, 1.0);
    if cover == 0.0 || hidden(point) {
        discard;
    }
    return vec4f(cover);
}
