//! The pipelines that count, and those that measure counting.

use super::StencilBits;
use crate::gpu::shaders;
use crate::gpu::targets::{COUNTED, SHARE, SUMMED, Stages};
use crate::shadow::GpuSurface;
use crate::shadow::walls::WallMaker;
use crate::view::View;
use wgpu::*;

/// The pipelines of the three ways of counting.
pub(super) struct CountWays {
    plan: CountPipelines,
    z_pass: CountPipelines,
    z_fail: CountPipelines,
}

pub(super) struct CountPipelines {
    pub(super) wall: RenderPipeline,
    pub(super) cap: RenderPipeline,
}

/// What walls and caps write in a cell.
struct Trace<'a> {
    label: &'a str,
    target: (TextureFormat, ColorWrites),
    blend: Option<BlendState>,
    /// The entry points for walls and caps, in the plan and elsewhere.
    plan: [&'a str; 3],
    camera: [&'a str; 3],
}

impl CountWays {
    pub(super) fn of(&self, view: &View, z_fail: bool) -> &CountPipelines {
        match view {
            View::Plan(_) => &self.plan,
            View::Camera(_) if z_fail => &self.z_fail,
            View::Camera(_) | View::Elevation(_) => &self.z_pass,
        }
    }

    pub(super) fn counting(surface: &GpuSurface, maker: &WallMaker, bits: StencilBits) -> CountWays {
        use StencilOperation::{DecrementWrap, IncrementWrap, Keep};
        let trace = Trace {
            label: "counting",
            target: (SHARE, ColorWrites::empty()),
            blend: None,
            plan: ["counted_in_plan", "cap_in_plan", "cap_counted_in_plan"],
            camera: ["counted", "cap", "counted"],
        };
        let state = |front, back| DepthStencilState {
            format: COUNTED,
            depth_write_enabled: Some(false),
            // strictly nearer than the judged point
            depth_compare: Some(CompareFunction::Greater),
            stencil: StencilState { front, back, read_mask: bits.reference(), write_mask: bits.most() },
            bias: DepthBiasState::default(),
        };
        let passing = || state(bits.face(IncrementWrap, Keep), bits.face(DecrementWrap, Keep));
        let failing = || state(bits.face(Keep, DecrementWrap), bits.face(Keep, IncrementWrap));
        CountWays::new(surface, maker, &trace, passing, failing)
    }

    pub(super) fn adding(surface: &GpuSurface, maker: &WallMaker, bits: StencilBits) -> CountWays {
        let sum = BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Add,
        };
        let trace = Trace {
            label: "adding",
            target: (SUMMED, ColorWrites::RED),
            blend: Some(BlendState { color: sum, alpha: sum }),
            plan: ["one", "cap", "one"],
            camera: ["one", "cap", "one"],
        };
        let face = bits.face(StencilOperation::Keep, StencilOperation::Keep);
        let state = || DepthStencilState {
            format: COUNTED,
            depth_write_enabled: Some(false),
            depth_compare: Some(CompareFunction::Always),
            stencil: StencilState { front: face, back: face, read_mask: bits.reference(), write_mask: 0 },
            bias: DepthBiasState::default(),
        };
        CountWays::new(surface, maker, &trace, state, state)
    }

    fn new(
        surface: &GpuSurface,
        maker: &WallMaker,
        trace: &Trace<'_>,
        passing: impl Fn() -> DepthStencilState,
        failing: impl Fn() -> DepthStencilState,
    ) -> CountWays {
        let gpu = &surface.gpu;
        let module = gpu.shader("stencil", shaders::STENCIL);
        let layout = surface.seeing_layout(&[]);
        let corner = VertexBufferLayout {
            array_stride: size_of::<[f32; 4]>() as u64,
            step_mode: VertexStepMode::Vertex,
            attributes: &vertex_attr_array![0 => Float32x4],
        };
        let corners = [Some(corner)];
        let pipeline =
            |label: &str, stages: Stages<'_>, state| gpu.blending_pipeline(label, stages, Some(state), trace.blend);
        let base = Stages {
            module: &module,
            vertex: "",
            fragment: "",
            buffers: &corners,
            target: Some(trace.target),
            layout: Some(&layout),
        };
        let way =
            |name: &str, end: &str, [wall, cap, cap_fragment]: [&str; 3], state: &dyn Fn() -> DepthStencilState| {
                let wall_label = format!("{}.{name}.wall", trace.label);
                let wall = match maker.in_vertex_shader() {
                    None => {
                        let vertex = &format!("wall_to_{end}");
                        pipeline(&wall_label, Stages { vertex, fragment: wall, ..base }, state())
                    }
                    Some((module, edges)) => {
                        let layout = surface.seeing_layout(&[edges]);
                        let vertex = &format!("quadrilateral_to_{end}");
                        let stages =
                            Stages { module, vertex, fragment: wall, buffers: &[], layout: Some(&layout), ..base };
                        pipeline(&wall_label, stages, state())
                    }
                };
                let cap = Stages { vertex: cap, fragment: cap_fragment, ..base };
                CountPipelines { wall, cap: pipeline(&format!("{}.{name}.cap", trace.label), cap, state()) }
            };
        CountWays {
            plan: way("plan", "lowest", trace.plan, &passing),
            z_pass: way("z_pass", "lowest", trace.camera, &passing),
            z_fail: way("z_fail", "infinity", trace.camera, &failing),
        }
    }
}

/// Draws 0 where the count is not 0, and resets it to 0.
pub(super) fn covered(surface: &GpuSurface, bits: StencilBits) -> RenderPipeline {
    let gpu = &surface.gpu;
    let face = StencilFaceState {
        compare: CompareFunction::NotEqual,
        pass_op: StencilOperation::Zero,
        ..StencilFaceState::default()
    };
    let state = DepthStencilState {
        format: COUNTED,
        depth_write_enabled: Some(false),
        depth_compare: Some(CompareFunction::Always),
        // the mask's bit is not compared
        stencil: StencilState { front: face, back: face, read_mask: bits.most(), write_mask: bits.most() },
        bias: DepthBiasState::default(),
    };
    let stages = Stages {
        module: &gpu.shader("stencil", shaders::STENCIL),
        vertex: "whole_picture",
        fragment: "covered",
        buffers: &[],
        target: Some((SHARE, ColorWrites::ALL)),
        layout: Some(&surface.seeing_layout(&[])),
    };
    gpu.pipeline("counting.covered", stages, Some(state))
}
