// Every edge is a quadrilateral of two triangles, in as many instances as its wall can stand; it collapses into one
// point where its multiplicity says so. Joined to the stencil's own stages.

struct Quadrilateral {
    // The vertex from which a wall's triangles begin.
    top: vec3f,
    a: u32,
    other: vec3f,
    b: u32,
}

@group(2) @binding(2) var<storage, read> quadrilaterals: array<Quadrilateral>;

// Where a corner is; and 1 if it stays there, 0 if it goes to where its wall ends.
fn corner_of(vertex: u32, instance: u32) -> vec4f {
    let edge = quadrilaterals[vertex / 6u];
    let top = vec4f(edge.top, 1.0);
    let sum = turned(edge.a) + turned(edge.b);
    if (u32(abs(sum)) >> search.halved) <= instance {
        return top;
    }
    let other = vec4f(edge.other, 1.0);
    let top_end = vec4f(edge.top, 0.0);
    switch vertex % 6u {
        case 1u: { return select(other, top_end, sum > 0); }
        case 2u, 4u: { return vec4f(edge.other, 0.0); }
        case 5u: { return select(top_end, other, sum > 0); }
        default: { return top; }
    }
}

@vertex
fn quadrilateral_to_lowest(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Wall {
    return at_lowest(corner_of(vertex, instance));
}

@vertex
fn quadrilateral_to_infinity(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
) -> @builtin(position) @invariant vec4f {
    return at_infinity(corner_of(vertex, instance));
}
