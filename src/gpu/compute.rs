//! Compute passes: one invocation for each of many items.

use super::{Gpu, GpuError};
use wgpu::*;

/// Invocations of a workgroup, as the shaders write it.
const GROUP: u32 = 256;

impl Gpu {
    /// A compute pipeline, its layout derived from the shader.
    pub(crate) fn compute(&self, label: &str, module: &ShaderModule, entry: &str) -> ComputePipeline {
        self.device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(label),
            layout: None,
            module,
            entry_point: Some(entry),
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        })
    }

    /// The most bytes of a buffer that a shader can reach.
    pub(crate) fn most_storage(&self) -> u64 {
        self.limits.max_storage_buffer_binding_size.min(self.limits.max_buffer_size)
    }

    /// A buffer for shaders, or an error before allocating one that is larger than `most` bytes.
    pub(crate) fn storage(&self, label: &str, size: u64, most: u64, usage: BufferUsages) -> Result<Buffer, GpuError> {
        if size > most {
            return Err(self.failed(format!("{label} takes {size} bytes, more than the {most} that its shaders reach")));
        }
        // a binding must not be empty
        self.buffer(label, size.max(16), usage | BufferUsages::STORAGE)
    }

    /// Dispatches an invocation for each of `count` items, in a square of workgroups: a single row may be longer than
    /// the adapter allows.
    pub(crate) fn dispatch(&self, pass: &mut ComputePass<'_>, count: u32) {
        let groups = count.div_ceil(GROUP);
        if groups > 0 {
            let across = groups.isqrt();
            pass.dispatch_workgroups(across, groups.div_ceil(across), 1);
        }
    }
}
