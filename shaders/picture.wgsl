// What a view shows, for the eye: sun and shadow on matt card as drawings have them (src/export/figure), or hours of
// shadow over it. Colours are display values.

struct PictureUniforms {
    // Where the hours' raster begins (west, north), metres around the scene's origin; its cell, metres.
    hours_corner: vec2f,
    hours_cell: f32,
    // Instead of sun and shadow: 1 hours on the plan's cells, 2 on patches.
    hours: f32,
    // From the eye to what it looks at, metres.
    focus: f32,
    // 1 where sun and shadow are shown and the sun is below the horizon.
    night: f32,
    // How strong the lines are.
    lines: f32,
    // Lines are drawn on both sides of a border: 1, else on one.
    both_sides: f32,
    // Components in their own colours: 1.
    tinted: f32,
    // Shadow volumes and silhouette over the picture: 1.
    overlay: f32,
    // Cells in colours of their own instead of sun and shadow: 1.
    painted: f32,
    unused: f32,
}

// The look that drawings have (src/look.rs), field for field.
struct LookUniforms {
    building: vec3f,
    cut_earth: f32,
    ground: vec3f,
    sky: f32,
    sky_light: vec3f,
    sky_slope: f32,
    sun_light: vec3f,
    exposure: f32,
    horizon: vec3f,
    least_height: f32,
    zenith: vec3f,
    least_sun: f32,
    night: vec3f,
    pressed_above: f32,
    not_judged: vec3f,
    pressed_room: f32,
    plan_ground_sun: vec3f,
    sky_rise: f32,
    plan_ground_shade: vec3f,
    sky_most: f32,
    plan_roof_sun: vec3f,
    haze_begins: f32,
    plan_roof_shade: vec3f,
    haze_length: f32,
    line: vec3f,
    relief: f32,
    volume: vec3f,
    relief_of_hours: f32,
    silhouette: vec3f,
    relief_darkest: f32,
    hours_ground: vec3f,
    hours_card: f32,
    hours_card_slope: vec3f,
    hours_wall: f32,
    relief_lightest: f32,
    outline: f32,
    step: f32,
    foot: f32,
    crease: f32,
    crease_cos: f32,
    plan_crease_cos: f32,
    step_share: f32,
    side_step_pixels: f32,
    tinted_lines: f32,
    layer: f32,
    most_layers: f32,
    hours_wall_slope: f32,
    hours_height_m: f32,
    hours_least_up: f32,
    plan_tint_shade: f32,
    relief_level: f32,
    plan_step_least_m: f32,
    plan_step_most_m: f32,
    plan_wall_up: f32,
}

@group(2) @binding(0) var<uniform> shown: PictureUniforms;
@group(2) @binding(1) var share_of_sun: texture_2d<f32>;
// Colours of the hours' cells, and the height of the surface that they were counted on, around the scene's origin.
@group(2) @binding(2) var hours_colour: texture_2d<f32>;
@group(2) @binding(3) var hours_height: texture_2d<f32>;
// Colours of faces, in rows as their planes; alpha 1 is terrain.
@group(2) @binding(4) var tints: texture_2d<f32>;
// Layers of volumes and ink of the silhouette, twice as fine as the picture or as fine.
@group(2) @binding(5) var volumes: texture_2d<f32>;
@group(2) @binding(6) var silhouette: texture_2d<f32>;
@group(2) @binding(7) var cells: texture_2d<f32>;
// Of each face its patch, in rows as planes; of each patch four texels: corner and column of its first texel in its page,
// right and row, down and page (both directions over a texel's length), and columns, rows and how many sides are judged.
@group(2) @binding(8) var patch_of: texture_2d<u32>;
@group(2) @binding(9) var patch_frames: texture_2d<f32>;
@group(2) @binding(10) var atlas: texture_2d_array<f32>;
@group(2) @binding(11) var<uniform> look: LookUniforms;

// What a pixel sees, from its face's plane: the depth is not needed, which rays do not return.
fn point_on(face: u32, pixel: vec2f) -> vec3f {
    var plane = vec4f(0.0, 0.0, 1.0, -view.ground_z);
    if face != GROUND {
        plane = textureLoad(planes, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0);
    }
    if is_plan() {
        let at = at_in_plan(pixel);
        return vec3f(at, -(dot(plane.xy, at) + plane.w) / select(1e-6, plane.z, abs(plane.z) > 1e-6));
    }
    let along = ray(pixel);
    let away = dot(plane.xyz, along);
    let start = ray_start(pixel);
    return start.xyz - along * (dot(plane, start) / select(1e-6, away, abs(away) > 1e-6));
}

// What falls on a surface: sky from above, the sun where it is seen.
fn light_on(normal: vec3f, share: f32) -> vec3f {
    let exposed = (look.exposure - look.sky - look.sky_slope) / max(light.towards.z, look.least_height);
    let across = dot(normal, light.towards.xyz);
    let sun = select(0.0, max(exposed * across, look.least_sun), across > 0.0);
    return look.sky_light * (look.sky + look.sky_slope * normal.z) + look.sun_light * (sun * share);
}

fn sky(along: vec3f) -> vec3f {
    let height = clamp(along.z / length(along), 0.0, 1.0);
    return mix(look.horizon, look.zenith, sqrt(min(height * look.sky_rise, 1.0)) * look.sky_most);
}

// Compresses the brightest tenth instead of cutting it off.
fn display(colour: vec3f) -> vec3f {
    let over = colour - look.pressed_above;
    let pressed = look.pressed_above + look.pressed_room * (1.0 - exp(-over / look.pressed_room));
    return select(max(colour, vec3f(0.0)), pressed, over > vec3f(0.0));
}

fn at_night(colour: vec3f) -> vec3f {
    return display(select(colour, colour * look.night, shown.night == 1.0));
}

fn tint_of(face: u32) -> vec3f {
    if shown.tinted == 0.0 {
        return look.building;
    }
    return textureLoad(tints, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0).rgb;
}

// On the plan terrain is drawn as the ground that it is.
fn is_ground(face: u32) -> bool {
    return face == GROUND || textureLoad(tints, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0).a == 1.0;
}

// Hours at a seen point: colour, and 1 where that surface is the one that was counted.
fn hours_at(point: vec3f, normal: vec3f) -> vec4f {
    let at = (point.xy - shown.hours_corner) * vec2f(1.0, -1.0) / shown.hours_cell;
    let size = vec2f(textureDimensions(hours_colour));
    if any(at < vec2f(0.0)) || any(at >= size) || normal.z < look.hours_least_up {
        return vec4f(0.0);
    }
    let cell = vec2u(at);
    let steep = shown.hours_cell * length(normal.xy) / normal.z;
    let near = abs(textureLoad(hours_height, cell, 0).x - point.z) <= look.hours_height_m + steep;
    return vec4f(textureLoad(hours_colour, cell, 0).rgb, select(0.0, 1.0, near));
}

const NO_PATCH: u32 = 0xffffffffu;

// A patch's colour at a seen point.
fn on_patch(face: u32, point: vec3f, normal: vec3f) -> vec3f {
    let number = textureLoad(patch_of, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0).x;
    if number == NO_PATCH {
        return look.not_judged;
    }
    let first = vec2u(number * 4u % PLANES_WIDTH, number * 4u / PLANES_WIDTH);
    let corner = textureLoad(patch_frames, first, 0);
    let right = textureLoad(patch_frames, first + vec2u(1u, 0u), 0);
    let down = textureLoad(patch_frames, first + vec2u(2u, 0u), 0);
    let size = textureLoad(patch_frames, first + vec2u(3u, 0u), 0).xyz;
    if size.z < 2.0 && dot(cross(down.xyz, right.xyz), normal) <= 0.0 {
        return look.not_judged;
    }
    let from_corner = point - corner.xyz;
    let place = vec2f(dot(from_corner, right.xyz), dot(from_corner, down.xyz));
    let texel = vec2f(corner.w, right.w) + clamp(floor(place), vec2f(0.0), size.xy - 1.0);
    return textureLoad(atlas, vec2u(texel), u32(down.w), 0).rgb;
}

fn before_camera(pixel: vec2f, face: u32) -> vec3f {
    let along = ray(pixel);
    if face == SKY {
        return at_night(sky(along));
    }
    let normal = seen_normal(face);
    let point = point_on(face, pixel);
    let share = textureLoad(share_of_sun, vec2u(pixel), 0).x;
    var card = look.ground;
    var haze = 0.0;
    if face == GROUND && is_elevation() {
        card *= look.cut_earth;
    } else if face == GROUND {
        let behind = distance(point, view.viewer.xyz) / shown.focus - look.haze_begins;
        haze = 1.0 - exp(-max(behind, 0.0) / look.haze_length);
    } else {
        card = tint_of(face);
    }
    if shown.hours == 0.0 {
        return at_night(mix(card * light_on(normal, share), look.horizon, haze));
    }
    if shown.hours == 2.0 && face == GROUND {
        return look.hours_ground;
    }
    if shown.hours == 2.0 {
        return on_patch(face, point, normal);
    }
    // what was not counted is plain card under the sky
    var hours = vec4f(0.0);
    if shown.hours == 1.0 {
        hours = hours_at(point, normal);
    }
    let plain = mix(card * (look.hours_card + dot(look.hours_card_slope, normal)), look.horizon, haze);
    return mix(plain, hours.rgb * (look.hours_wall + look.hours_wall_slope * normal.z), hours.a);
}

// Slopes away from the light are a little darker.
fn relief(normal: vec3f, strength: f32) -> f32 {
    // half-way between up and the sun; no branch, since lavapipe crashes where one compares with this uniform
    let across = vec3f(normalize(light.towards.xy + vec2f(1e-6, 0.0)), 1.0);
    let slope = clamp(1.0 + strength * (dot(normal, across) - 1.0), look.relief_darkest, look.relief_lightest);
    return select(slope, 1.0, normal.z > look.relief_level);
}

fn from_above(pixel: vec2f, face: u32) -> vec3f {
    let share = textureLoad(share_of_sun, vec2u(pixel), 0).x;
    let normal = seen_normal(face);
    let point = point_on(face, pixel);
    if shown.hours == 2.0 && face != GROUND {
        return on_patch(face, point, normal);
    }
    let hours = hours_at(point, normal);
    if shown.hours == 1.0 && hours.a == 1.0 {
        return hours.rgb * relief(normal, look.relief_of_hours);
    }
    if face == GROUND {
        return mix(look.plan_ground_shade, look.plan_ground_sun, select(share, 1.0, shown.hours > 0.0));
    }
    var roof = mix(look.plan_roof_shade, look.plan_roof_sun, share);
    if is_ground(face) {
        roof = mix(look.plan_ground_shade, look.plan_ground_sun, select(share, 1.0, shown.hours > 0.0));
    }
    if shown.tinted == 1.0 {
        roof = tint_of(face) * mix(look.plan_tint_shade, 1.0, share);
    }
    return roof * relief(normal, look.relief);
}

// Distance along the ray, in metres of depth, at which a face's plane is met.
fn depth_on_plane(face: u32, pixel: vec2f) -> f32 {
    let plane = textureLoad(planes, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0);
    return -dot(plane, ray_start(pixel)) / dot(plane.xyz, ray(pixel));
}

// How strong a line between two neighbours is: outlines, steps and creases.
fn line_between(a: vec2f, b: vec2f) -> f32 {
    let from_face = seen_face(a);
    let to_face = seen_face(b);
    if from_face == to_face {
        return 0.0;
    }
    if from_face >= GROUND && to_face >= GROUND {
        // the ground's line
        return select(0.0, look.step, is_elevation());
    }
    if is_plan() {
        return line_in_plan(a, b, from_face, to_face);
    }
    if from_face == SKY || to_face == SKY {
        return look.step;
    }
    if from_face == GROUND || to_face == GROUND {
        return look.foot;
    }
    let here = depth_on_plane(from_face, a) - depth_on_plane(to_face, a);
    let there = depth_on_plane(from_face, b) - depth_on_plane(to_face, b);
    var least = look.step_share * abs(depth_on_plane(from_face, a));
    if is_elevation() {
        least = look.side_step_pixels * 2.0 * length(view.up.xyz) / view.size.y;
    }
    // planes that cross between the two pixels adjoin, however steep; else there is air between them
    if here * there > 0.0 && min(abs(here), abs(there)) > least {
        return look.step;
    }
    let crease = dot(seen_normal(from_face), seen_normal(to_face)) < look.crease_cos;
    return select(0.0, look.crease, crease);
}

fn line_in_plan(a: vec2f, b: vec2f, from_face: u32, to_face: u32) -> f32 {
    let from_normal = seen_normal(from_face);
    let to_normal = seen_normal(to_face);
    let from_point = point_on(from_face, a);
    let to_point = point_on(to_face, b);
    let half = (to_point.xy - from_point.xy) * 0.5;
    let from_rise = select(0.0, -dot(from_normal.xy, half) / from_normal.z, from_normal.z >= look.plan_wall_up);
    let to_rise = select(0.0, -dot(to_normal.xy, -half) / to_normal.z, to_normal.z >= look.plan_wall_up);
    let jump = abs(from_point.z + from_rise - to_point.z - to_rise);
    let step = clamp(length(half), look.plan_step_least_m, look.plan_step_most_m) + abs(from_rise) + abs(to_rise);
    // the ground has no lines of its own but where it steps
    let are_ground = vec2<bool>(is_ground(from_face), is_ground(to_face));
    if all(are_ground) {
        return select(0.0, look.step, jump > step);
    }
    if any(are_ground) {
        return select(look.crease, look.outline, jump > step);
    }
    let crease = select(0.0, look.crease, dot(from_normal, to_normal) < look.plan_crease_cos);
    return select(crease, look.step, jump > step);
}

fn lines_at(pixel: vec2f) -> f32 {
    let last = view.size - 0.5;
    var ink = 0.0;
    if pixel.x < last.x {
        ink = line_between(pixel, pixel + vec2f(1.0, 0.0));
    }
    if pixel.y < last.y {
        ink = max(ink, line_between(pixel, pixel + vec2f(0.0, 1.0)));
    }
    if shown.both_sides == 1.0 {
        if pixel.x > 1.0 {
            ink = max(ink, line_between(pixel - vec2f(1.0, 0.0), pixel));
        }
        if pixel.y > 1.0 {
            ink = max(ink, line_between(pixel - vec2f(0.0, 1.0), pixel));
        }
    }
    // colours tell parts from each other, and lines upon lines would hide the colours of fine parts
    return ink * shown.lines * select(1.0, look.tinted_lines, shown.tinted == 1.0 && !is_plan());
}

// The overlay's value at a pixel: of its texels there the mean.
fn overlay_at(texture: texture_2d<f32>, pixel: vec2f, layers: bool) -> f32 {
    let scale = textureDimensions(texture) / vec2u(view.size);
    let first = vec2u(pixel) * scale;
    var sum = 0.0;
    for (var row = 0u; row < scale.y; row++) {
        for (var column = 0u; column < scale.x; column++) {
            let value = textureLoad(texture, first + vec2u(column, row), 0).x;
            // so much of what lies behind it one layer hides, and all together at most
            sum += select(value, min(1.0 - pow(1.0 - look.layer, value * 255.0), look.most_layers), layers);
        }
    }
    return sum / f32(max(scale.x * scale.y, 1u));
}

@fragment
fn picture(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = position.xy;
    let face = seen_face(pixel);
    var colour: vec3f;
    if shown.painted == 1.0 && face != SKY {
        colour = textureLoad(cells, vec2u(pixel), 0).rgb;
    } else if is_plan() {
        colour = from_above(pixel, face);
    } else {
        colour = before_camera(pixel, face);
    }
    colour = mix(colour, look.line, lines_at(pixel));
    if shown.overlay == 1.0 {
        colour = mix(colour, look.volume, overlay_at(volumes, pixel, true));
        colour = mix(colour, look.silhouette, overlay_at(silhouette, pixel, false));
    }
    return vec4f(colour, 1.0);
}
