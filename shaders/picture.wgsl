// What a view shows, for the eye: sun and shadow on matt card as drawings have them (src/export/figure), or hours of
// shadow over it. Colours are display values.

struct Shown {
    // Where the hours' raster begins (west, north), metres around the scene's origin; its cell, metres.
    hours_corner: vec2f,
    hours_cell: f32,
    // Instead of sun and shadow: 1 hours on the plan's cells, 2 on patches.
    hours: f32,
    // From the eye to what it looks at, metres.
    focus: f32,
    // 1 where the sun is below the horizon.
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

@group(2) @binding(0) var<uniform> shown: Shown;
@group(2) @binding(1) var share_of_sun: texture_2d<f32>;
// Colours of the hours' cells, and the height of the surface that they were counted on, around the scene's origin.
@group(2) @binding(2) var hours_colour: texture_2d<f32>;
@group(2) @binding(3) var hours_height: texture_2d<f32>;
// Colours of faces, in rows as their planes.
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

// What a pixel sees, from its face's plane: depths are not needed, which rays do not tell.
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

// Reflectance of card and ground, and the light of sky and sun (src/export/figure/perspective.rs).
const BUILDING = vec3f(0.995, 0.975, 0.935);
const GROUND_CARD = vec3f(0.965, 0.945, 0.895);
const SKY_LIGHT = vec3f(0.90, 0.97, 1.12);
const SUN_LIGHT = vec3f(1.10, 1.00, 0.84);
const HORIZON = vec3f(0.945, 0.942, 0.925);
const ZENITH = vec3f(0.640, 0.745, 0.850);
const NIGHT = vec3f(0.62, 0.66, 0.76);
// Earth that a side cuts, against the ground's card.
const CUT_EARTH = 0.90;
const LINE = vec3f(24.0, 27.0, 34.0) / 255.0;
const VOLUME = vec3f(250.0, 205.0, 40.0) / 255.0;
const SILHOUETTE = vec3f(10.0, 10.0, 12.0) / 255.0;

// The plan's colours (src/export/figure/plan.rs).
const PLAN_GROUND_SUN = vec3f(246.0, 240.0, 226.0) / 255.0;
const PLAN_GROUND_SHADE = vec3f(140.0, 152.0, 173.0) / 255.0;
const PLAN_ROOF_SUN = vec3f(255.0, 255.0, 253.0) / 255.0;
const PLAN_ROOF_SHADE = vec3f(174.0, 183.0, 198.0) / 255.0;

// What falls on a surface: sky from above, the sun where it is seen.
fn light_on(normal: vec3f, share: f32) -> vec3f {
    let exposed = (0.98 - 0.50 - 0.09) / max(light.towards.z, 0.32);
    let across = dot(normal, light.towards.xyz);
    let sun = select(0.0, max(exposed * across, 0.26), across > 0.0);
    return SKY_LIGHT * (0.50 + 0.09 * normal.z) + SUN_LIGHT * (sun * share);
}

fn sky(along: vec3f) -> vec3f {
    let height = clamp(along.z / length(along), 0.0, 1.0);
    return mix(HORIZON, ZENITH, sqrt(min(height * 1.6, 1.0)) * 0.85);
}

// The brightest tenth is pressed together instead of cut off.
fn display(colour: vec3f) -> vec3f {
    let over = colour - 0.9;
    return select(max(colour, vec3f(0.0)), 0.9 + 0.1 * (1.0 - exp(-over / 0.1)), over > vec3f(0.0));
}

fn at_night(colour: vec3f) -> vec3f {
    return display(select(colour, colour * NIGHT, shown.night == 1.0));
}

fn tint_of(face: u32) -> vec3f {
    if shown.tinted == 0.0 {
        return BUILDING;
    }
    return textureLoad(tints, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0).rgb;
}

// Hours at a seen point: colour, and 1 where that surface is the one that was counted.
fn hours_at(point: vec3f, normal: vec3f) -> vec4f {
    let at = (point.xy - shown.hours_corner) * vec2f(1.0, -1.0) / shown.hours_cell;
    let size = vec2f(textureDimensions(hours_colour));
    if any(at < vec2f(0.0)) || any(at >= size) || normal.z < 0.05 {
        return vec4f(0.0);
    }
    let cell = vec2u(at);
    let steep = shown.hours_cell * length(normal.xy) / normal.z;
    let near = abs(textureLoad(hours_height, cell, 0).x - point.z) <= 0.02 + steep;
    return vec4f(textureLoad(hours_colour, cell, 0).rgb, select(0.0, 1.0, near));
}

const NO_PATCH: u32 = 0xffffffffu;
// The colour of what is not judged (src/export/figure/surfaces.rs).
const NOT_JUDGED = vec3f(200.0, 191.0, 182.0) / 255.0;

// A patch's colour at a seen point.
fn on_patch(face: u32, point: vec3f, normal: vec3f) -> vec3f {
    let number = textureLoad(patch_of, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0).x;
    if number == NO_PATCH {
        return NOT_JUDGED;
    }
    let first = vec2u(number * 4u % PLANES_WIDTH, number * 4u / PLANES_WIDTH);
    let corner = textureLoad(patch_frames, first, 0);
    let right = textureLoad(patch_frames, first + vec2u(1u, 0u), 0);
    let down = textureLoad(patch_frames, first + vec2u(2u, 0u), 0);
    let size = textureLoad(patch_frames, first + vec2u(3u, 0u), 0).xyz;
    if size.z < 2.0 && dot(cross(down.xyz, right.xyz), normal) <= 0.0 {
        return NOT_JUDGED;
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
    var card = GROUND_CARD;
    var haze = 0.0;
    if face == GROUND && is_elevation() {
        card *= CUT_EARTH;
    } else if face == GROUND {
        haze = 1.0 - exp(-max(distance(point, view.viewer.xyz) / shown.focus - 1.3, 0.0) / 3.5);
    } else {
        card = tint_of(face);
    }
    if shown.hours == 0.0 {
        return at_night(mix(card * light_on(normal, share), HORIZON, haze));
    }
    if shown.hours == 2.0 && face != GROUND {
        return on_patch(face, point, normal);
    }
    // what was not counted is plain card under the sky
    var hours = vec4f(0.0);
    if shown.hours == 1.0 {
        hours = hours_at(point, normal);
    }
    let plain = mix(card * (0.74 + 0.18 * normal.z + 0.05 * normal.x - 0.03 * normal.y), HORIZON, haze);
    return mix(plain, hours.rgb * (0.90 + 0.10 * normal.z), hours.a);
}

// Slopes away from the light are a little darker.
fn relief(normal: vec3f, strength: f32) -> f32 {
    if normal.z > 0.9999 || shown.night == 1.0 {
        return 1.0;
    }
    let across = vec3f(normalize(light.towards.xy + vec2f(1e-6, 0.0)), 1.0) * 0.70710678;
    return clamp(1.0 + strength * (dot(normal, across) / across.z - 1.0), 0.70, 1.04);
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
        return hours.rgb * relief(normal, 0.10);
    }
    if face == GROUND {
        return mix(PLAN_GROUND_SHADE, PLAN_GROUND_SUN, select(share, 1.0, shown.hours > 0.0));
    }
    var roof = mix(PLAN_ROOF_SHADE, PLAN_ROOF_SUN, share);
    if shown.tinted == 1.0 {
        roof = tint_of(face) * mix(0.78, 1.0, share);
    }
    return roof * relief(normal, 0.26);
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
        return select(0.0, 0.9, is_elevation());
    }
    if is_plan() {
        return line_in_plan(a, b, from_face, to_face);
    }
    if from_face == SKY || to_face == SKY {
        return 0.75;
    }
    if from_face == GROUND || to_face == GROUND {
        return 0.6;
    }
    let here = depth_on_plane(from_face, a) - depth_on_plane(to_face, a);
    let there = depth_on_plane(from_face, b) - depth_on_plane(to_face, b);
    var least = 0.004 * abs(depth_on_plane(from_face, a));
    if is_elevation() {
        least = 4.0 * length(view.up.xyz) / view.size.y;
    }
    // planes that cross between the two pixels adjoin, however steep; else there is air between them
    if here * there > 0.0 && min(abs(here), abs(there)) > least {
        return 0.75;
    }
    let crease = dot(seen_normal(from_face), seen_normal(to_face)) < 0.985;
    return select(0.0, 0.45, crease);
}

fn line_in_plan(a: vec2f, b: vec2f, from_face: u32, to_face: u32) -> f32 {
    let from_normal = seen_normal(from_face);
    let to_normal = seen_normal(to_face);
    let from_point = point_on(from_face, a);
    let to_point = point_on(to_face, b);
    let half = (to_point.xy - from_point.xy) * 0.5;
    let from_rise = select(0.0, -dot(from_normal.xy, half) / from_normal.z, from_normal.z > 0.1);
    let to_rise = select(0.0, -dot(to_normal.xy, -half) / to_normal.z, to_normal.z > 0.1);
    let jump = abs(from_point.z + from_rise - to_point.z - to_rise);
    let step = clamp(length(half), 0.02, 0.5) + abs(from_rise) + abs(to_rise);
    if from_face == GROUND || to_face == GROUND {
        return select(0.45, 0.9, jump > step);
    }
    let crease = select(0.0, 0.45, dot(from_normal, to_normal) < 0.990);
    return select(crease, 0.75, jump > step);
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
    return ink * shown.lines;
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
            sum += select(value, min(1.0 - pow(1.0 - 0.27, value * 255.0), 0.62), layers);
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
    colour = mix(colour, LINE, lines_at(pixel));
    if shown.overlay == 1.0 {
        colour = mix(colour, VOLUME, overlay_at(volumes, pixel, true));
        colour = mix(colour, SILHOUETTE, overlay_at(silhouette, pixel, false));
    }
    return vec4f(colour, 1.0);
}
