// Which faces a light shines on, one bit a face; and the light cap, each face turned by its bit.

// Planes lie in rows of this many texels.
const PLANES_WIDTH: u32 = 4096u;

@group(2) @binding(1) var<storage, read_write> facing_bits: array<u32>;
@group(2) @binding(2) var planes: texture_2d<f32>;

var<workgroup> words: array<atomic<u32>, 8>;

@compute @workgroup_size(256)
fn decide(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let face = (group.y * groups.x + group.x) * 256u + lane;
    let plane = textureLoad(planes, vec2u(face % PLANES_WIDTH, face / PLANES_WIDTH), 0);
    if dot(plane, search.light) >= 0.0 {
        atomicOr(&words[lane / 32u], 1u << (lane % 32u));
    }
    workgroupBarrier();
    if lane % 32u == 0u && face / 32u < arrayLength(&facing_bits) {
        facing_bits[face / 32u] = atomicLoad(&words[lane / 32u]);
    }
}

struct FaceRecord {
    // Of the mesh, counter-clockwise seen from its front side.
    corners: vec3u,
    number: u32,
}

@group(2) @binding(3) var<storage, read> faces: array<FaceRecord>;
@group(2) @binding(4) var<storage, read_write> indices: array<u32>;

@compute @workgroup_size(256)
fn cap(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let at = (group.y * groups.x + group.x) * 256u + lane;
    if at >= arrayLength(&faces) {
        return;
    }
    let face = faces[at];
    let towards = (facing_bits[face.number / 32u] >> (face.number % 32u) & 1u) == 1u;
    let corners = select(face.corners.xzy, face.corners, towards);
    // a vertex comes twice, first where it is
    indices[at * 3u] = corners.x * 2u;
    indices[at * 3u + 1u] = corners.y * 2u;
    indices[at * 3u + 2u] = corners.z * 2u;
}
