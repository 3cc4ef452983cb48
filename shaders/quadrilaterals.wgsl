// Every edge is a quadrilateral of two triangles, in as many instances as its wall can stand; it collapses into one
// point where its multiplicity says so. Joined to the stencil's own stages.

struct Quadrilateral {
    first: vec3f,
    a: u32,
    second: vec3f,
    b: u32,
}

@group(2) @binding(2) var<storage, read> quadrilaterals: array<Quadrilateral>;

// Where a corner is; and 1 if it stays there, 0 if it goes to where its wall ends.
fn corner_of(vertex: u32, instance: u32) -> vec4f {
    let edge = quadrilaterals[vertex / 6u];
    // a wall's triangles begin at the vertex nearer to the sun
    let turns = dot(edge.second.xy - edge.first.xy, search.light.xy) > 0.0;
    let sunward = vec4f(select(edge.first, edge.second, turns), 1.0);
    let sum = (turned(edge.a) + turned(edge.b)) * select(1, -1, turns);
    if (u32(abs(sum)) >> search.halved) <= instance {
        return sunward;
    }
    let other = vec4f(select(edge.second, edge.first, turns), 1.0);
    let sunward_end = vec4f(sunward.xyz, 0.0);
    switch vertex % 6u {
        case 1u: { return select(other, sunward_end, sum > 0); }
        case 2u, 4u: { return vec4f(other.xyz, 0.0); }
        case 5u: { return select(sunward_end, other, sum > 0); }
        default: { return sunward; }
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
