// Registered hard shadows: faces drawn onto the texels of a patch, and texels that see the sample counted.

// A patch and a sample, as `registered.rs` makes them; positions in the viewport of the patch.
struct Onto {
    @location(1) x: vec4f,
    @location(2) y: vec4f,
    @location(3) w: vec4f,
    @location(4) height: vec4f,
}

// Cut where the height is not above 0, or w too small.
@vertex
fn occluder(@location(0) position: vec3f, onto: Onto) -> @builtin(position) vec4f {
    let vertex = vec4f(position, 1.0);
    return vec4f(dot(onto.x, vertex), dot(onto.y, vertex), dot(onto.height, vertex), dot(onto.w, vertex));
}

@fragment
fn covered() -> @location(0) vec4f {
    return vec4f(1.0);
}

// Columns (low half) and rows of the judged texels in this page, and their patches.
@group(0) @binding(0) var mask: texture_2d<f32>;
@group(0) @binding(1) var<storage, read> places: array<u32>;
@group(0) @binding(2) var<storage, read> patches: array<u32>;
// The sample's weight for each patch: 0 where the sample is not in front of it.
@group(0) @binding(3) var<storage, read> weights: array<u32>;
@group(0) @binding(4) var<storage, read_write> sums: array<u32>;
@group(0) @binding(5) var<uniform> run: TexelRunUniforms;

// The texels of a page.
struct TexelRunUniforms {
    first: u32,
    count: u32,
}

@compute @workgroup_size(256)
fn add(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * groups.x + group.x) * 256u + local;
    if index >= run.count {
        return;
    }
    let texel = run.first + index;
    let place = places[texel];
    let covered = textureLoad(mask, vec2u(place & 0xffffu, place >> 16u), 0).r;
    if covered == 0.0 {
        sums[texel] += weights[patches[texel]];
    }
}
