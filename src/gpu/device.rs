//! One adapter, opened with all that it can do.

use super::timers::Timers;
use std::sync::{Arc, Mutex, OnceLock};
use wgpu::{
    Adapter, Backends, DeviceDescriptor, Features, Instance, InstanceDescriptor, PowerPreference, RequestAdapterOptions,
};

/// An open graphics adapter.
pub struct Gpu {
    /// Where resources are made.
    pub device: wgpu::Device,
    /// Where work goes in.
    pub queue: wgpu::Queue,
    /// What the adapter allows.
    pub limits: wgpu::Limits,
    name: String,
    software: bool,
    fault: Arc<Mutex<Option<String>>>,
    /// Where passes are timed.
    pub(super) timers: OnceLock<Timers>,
}

/// Why the GPU gives no answer.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// Nothing to draw with.
    #[error(
        "no graphics adapter was found; install a driver (on Linux mesa-vulkan-drivers draws in software) or draw on the processor with --engine cpu, without --silhouette"
    )]
    NoAdapter,
    /// There is one, but too little of one.
    #[error("the graphics adapter '{adapter}' cannot be used: {reason}; update its driver or use --engine cpu")]
    Unusable {
        /// The adapter's name.
        adapter: String,
        /// What is missing, or what the driver said.
        reason: String,
    },
    /// It failed while working.
    #[error("the graphics adapter '{adapter}' failed: {reason}; try larger cells (--cell) or --engine cpu")]
    Failed {
        /// The adapter's name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
}

/// What drawing needs beyond the least that WebGPU promises: a float depth beside the stencil.
const NEEDED: Features = Features::DEPTH32FLOAT_STENCIL8;
/// What some techniques need, and some adapters (all of GL) lack; and the clock for timers.
const WANTED: Features = Features::FLOAT32_BLENDABLE.union(Features::TIMESTAMP_QUERY);

impl Gpu {
    /// What may drive an adapter: OpenGL lacks too much of what is needed.
    pub const BACKENDS: Backends = Backends::PRIMARY;

    /// Opens the fastest adapter of the system. The usual environment variables of wgpu choose another one.
    pub fn open() -> Result<Gpu, GpuError> {
        pollster::block_on(async {
            let mut wanted = InstanceDescriptor::new_without_display_handle_from_env();
            wanted.backends &= Self::BACKENDS;
            let options = RequestAdapterOptions {
                power_preference: PowerPreference::HighPerformance,
                ..RequestAdapterOptions::default()
            };
            let adapter = Instance::new(wanted).request_adapter(&options).await.map_err(|_| GpuError::NoAdapter)?;
            check(&adapter)?;
            let (device, queue) = adapter
                .request_device(&Self::description(&adapter))
                .await
                .map_err(|error| unusable(&adapter, error.to_string()))?;
            Self::opened(&adapter, device, queue)
        })
    }

    /// How a device is to be asked of an adapter, so that all techniques draw on it: for whoever opens it elsewhere.
    pub fn description(adapter: &Adapter) -> DeviceDescriptor<'static> {
        DeviceDescriptor {
            label: Some("gnomon"),
            required_features: adapter.features() & (NEEDED | WANTED),
            required_limits: adapter.limits(),
            ..DeviceDescriptor::default()
        }
    }

    /// A device that is open already, by [`Gpu::description`].
    ///
    /// # Errors
    /// [`GpuError::Unusable`] where the adapter lacks what is needed.
    pub fn opened(adapter: &Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Result<Gpu, GpuError> {
        check(adapter)?;
        let fault = Arc::new(Mutex::new(None));
        let heard = Arc::clone(&fault);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut fault) = heard.lock() {
                fault.get_or_insert_with(|| error.to_string());
            }
        }));
        let info = adapter.get_info();
        let (name, software) = (info.name, info.device_type == wgpu::DeviceType::Cpu);
        Ok(Gpu { device, queue, limits: adapter.limits(), name, software, fault, timers: OnceLock::new() })
    }

    /// The adapter's name, as its driver says it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether the adapter is a program on the processor.
    pub fn software(&self) -> bool {
        self.software
    }

    /// Says so where the adapter cannot blend 32-bit floats, by which `what` is done.
    ///
    /// # Errors
    /// [`GpuError::Failed`]
    pub fn blends_float32(&self, what: &str) -> Result<(), GpuError> {
        match self.device.features().contains(Features::FLOAT32_BLENDABLE) {
            true => Ok(()),
            false => Err(self.failed(format!("{what} by blending 32-bit floats, which it cannot"))),
        }
    }

    /// Says what went wrong since the device was opened. wgpu reports faults (memory above all) beside the calls that
    /// cause them; whoever hands on a result asks here first.
    pub fn check(&self) -> Result<(), GpuError> {
        match self.fault.lock().map(|fault| fault.clone()) {
            Ok(None) => Ok(()),
            Ok(Some(reason)) => Err(self.failed(reason)),
            Err(_) => Err(self.failed("an error could not be told")),
        }
    }

    /// The error with the adapter's name.
    pub fn failed(&self, reason: impl ToString) -> GpuError {
        GpuError::Failed { adapter: self.name.clone(), reason: reason.to_string() }
    }
}

/// Whether an adapter has what is needed.
fn check(adapter: &Adapter) -> Result<(), GpuError> {
    match adapter.features().contains(NEEDED) {
        true => Ok(()),
        false => Err(unusable(adapter, "it has no 32-bit depth with stencil".into())),
    }
}

fn unusable(adapter: &Adapter, reason: String) -> GpuError {
    GpuError::Unusable { adapter: adapter.get_info().name, reason }
}
