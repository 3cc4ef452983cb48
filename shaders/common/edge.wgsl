// What a face adds to the multiplicity of an edge, by the face's bit.

// Instead of a second face, where an edge has one.
const NO_FACE: u32 = 0xffffffffu;

// One bit a face, 32 a word: the light is on its front side or in its plane.
@group(2) @binding(1) var<storage, read> facing_bits: array<u32>;

// An incidence is a face and, in the lowest bit, whether it runs against the edge.
fn turned(incidence: u32) -> i32 {
    if incidence == NO_FACE {
        return 0;
    }
    let face = incidence >> 1u;
    let away = ~(facing_bits[face / 32u] >> (face % 32u)) & 1u;
    return 1 - 2 * i32((incidence & 1u) ^ away);
}
