// Adds a mask's shadow, in 1/255, times the seconds that it stands for. Integers: the same sum on every machine.

struct WeightUniforms {
    secs: u32,
}

@group(0) @binding(0) var mask: texture_2d<f32>;
@group(0) @binding(1) var sum: texture_storage_2d<r32uint, read_write>;
@group(0) @binding(2) var<uniform> weight: WeightUniforms;

@compute @workgroup_size(16, 16)
fn accumulate(@builtin(global_invocation_id) cell: vec3u) {
    if any(cell.xy >= textureDimensions(mask)) {
        return;
    }
    let shadow = 255u - u32(round(textureLoad(mask, cell.xy, 0).x * 255.0));
    if shadow > 0u {
        textureStore(sum, cell.xy, textureLoad(sum, cell.xy) + shadow * weight.secs);
    }
}
