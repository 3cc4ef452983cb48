//! The window's own graphics device, and the stage that works beside it.

use crate::desktop::parts::screen;
use crate::desktop::stage::Stage;
use crate::gpu::{Gpu, GpuError};
use eframe::CreationContext;
use eframe::egui_wgpu::RenderState;

/// The window's device, and the stage beside it.
pub(in crate::desktop) fn devices(cc: &CreationContext<'_>) -> Result<(Gpu, RenderState, Stage), GpuError> {
    let render = cc.wgpu_render_state.clone().ok_or(GpuError::NoAdapter)?;
    screen::set_up(&render);
    let gpu = Gpu::opened(&render.adapter, render.device.clone(), render.queue.clone());
    let stage = Stage::new(render.clone(), cc.egui_ctx.clone());
    Ok((gpu, render, stage))
}
