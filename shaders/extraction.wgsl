// All edges asked at once: the walls of those that are silhouette, as the list that is drawn next.

struct EdgeRecord {
    first: u32,
    second: u32,
    // The faces at it, as they run from `first` to `second`; `b` may be NO_FACE. Where there are more than two: CROWDED and
    // where they begin in `crowds`, and how many they are.
    a: u32,
    b: u32,
    // East and north from the first vertex to the second.
    along: vec2f,
}

const CROWDED: u32 = 0x80000000u;

// The arguments of an indirect draw.
struct DrawArguments {
    index_count: atomic<u32>,
    instance_count: u32,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32,
}

@group(2) @binding(2) var<storage, read> edges: array<EdgeRecord>;
@group(2) @binding(3) var<storage, read> crowds: array<u32>;
@group(2) @binding(4) var<storage, read_write> indices: array<u32>;
@group(2) @binding(5) var<storage, read_write> arguments: DrawArguments;

fn multiplicity(edge: EdgeRecord) -> i32 {
    if (edge.a & CROWDED) == 0u {
        return turned(edge.a) + turned(edge.b);
    }
    let first = edge.a & ~CROWDED;
    var sum = 0;
    for (var at = first; at < first + edge.b; at++) {
        sum += turned(crowds[at]);
    }
    return sum;
}

// Places are first given out in the workgroup, then once a workgroup in the whole list.
var<workgroup> in_group: atomic<u32>;
var<workgroup> before_group: u32;

@compute @workgroup_size(256)
fn extract(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let at = (group.y * groups.x + group.x) * 256u + lane;
    var edge = EdgeRecord();
    var sum = 0;
    if at < arrayLength(&edges) {
        edge = edges[at];
        sum = multiplicity(edge);
    }
    let walls = u32(abs(sum)) >> search.halved;
    let before = atomicAdd(&in_group, walls * search.indices_per_wall);
    workgroupBarrier();
    if lane == 0u {
        before_group = atomicAdd(&arguments.index_count, atomicLoad(&in_group));
    }
    let first = workgroupUniformLoad(&before_group) + before;

    // a wall's triangles begin at the vertex nearer to the sun; a vertex comes twice: where it is, and where its wall ends
    let turns = dot(edge.along, search.light.xy) > 0.0;
    let sunward = select(edge.first, edge.second, turns) * 2u;
    let other = select(edge.second, edge.first, turns) * 2u;
    sum = select(sum, -sum, turns);
    for (var wall = 0u; wall < walls; wall++) {
        let place = first + wall * search.indices_per_wall;
        if search.indices_per_wall == 3u {
            indices[place] = select(other, sunward, sum > 0);
            indices[place + 1u] = sunward + 1u;
            indices[place + 2u] = select(sunward, other, sum > 0);
        } else {
            indices[place] = sunward;
            indices[place + 1u] = select(other, sunward + 1u, sum > 0);
            indices[place + 2u] = other + 1u;
            indices[place + 3u] = sunward;
            indices[place + 4u] = other + 1u;
            indices[place + 5u] = select(sunward + 1u, other, sum > 0);
        }
    }
}
