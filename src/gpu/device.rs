//! An adapter, opened with all features and limits that it has and the program uses.

#[cfg(feature = "test-hooks")]
use super::timers::Timers;
use crate::message::{Field, Message, MessagePart, Worded, aside, message, pieces, plain_display};
use std::sync::{Arc, Mutex};
use wgpu::{
    Adapter, Backends, DeviceDescriptor, Features, Instance, InstanceDescriptor, PollType, PowerPreference,
    RequestAdapterOptions,
};

/// An open graphics adapter.
pub struct Gpu {
    /// The device, which makes resources.
    pub device: wgpu::Device,
    /// The queue to which work is submitted.
    pub queue: wgpu::Queue,
    /// The adapter's limits.
    pub limits: wgpu::Limits,
    name: String,
    software: bool,
    fault: Arc<Mutex<Option<DeviceFault>>>,
    /// The timers of passes.
    #[cfg(feature = "test-hooks")]
    pub(super) timers: std::sync::OnceLock<Timers>,
}

/// Why the graphics adapter could not do its work.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The system has no adapter.
    NoAdapter,
    /// There is an adapter, but it lacks something, or its driver refuses it.
    Unusable {
        /// The adapter's name.
        adapter: String,
        /// What is missing, or what the driver said.
        reason: String,
    },
    /// The adapter could not do the work.
    Failed {
        /// The adapter's name.
        adapter: String,
        /// What failed.
        reason: String,
    },
    /// The device failed while it worked and cannot be used any more; a new one may work.
    Lost {
        /// The adapter's name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
}

plain_display!(GpuError);

impl Worded for GpuError {
    fn message(&self) -> Message {
        let on_processor = (Field::Engine, "cpu");
        match self {
            GpuError::NoAdapter => message![
                "no graphics adapter was found";
                "install a driver (on Linux mesa-vulkan-drivers draws in software)",
                MessagePart::Where(Field::Engine, pieces![
                    " or draw on the processor with ", on_processor, ", without ", Field::Silhouette
                ])
            ],
            GpuError::Unusable { adapter, reason } => message![
                format!("the graphics adapter '{adapter}' cannot be used: {reason}");
                "update its driver",
                MessagePart::Where(Field::Engine, pieces![" or use ", on_processor])
            ],
            GpuError::Failed { adapter, reason } | GpuError::Lost { adapter, reason } => message![
                format!("the graphics adapter '{adapter}' failed: {reason}");
                "try larger cells",
                aside(Field::Cell),
                MessagePart::Where(Field::Engine, pieces![" or ", on_processor])
            ],
        }
    }
}

impl GpuError {
    /// What went wrong, without a hint, for callers that have their own hint.
    pub fn why(&self) -> String {
        match self {
            GpuError::NoAdapter => "no graphics adapter was found".to_owned(),
            GpuError::Unusable { adapter, reason } => {
                format!("the graphics adapter '{adapter}' cannot be used ({})", plain(reason))
            }
            GpuError::Failed { adapter, reason } | GpuError::Lost { adapter, reason } => {
                format!("the graphics adapter '{adapter}' failed ({})", plain(reason))
            }
        }
    }
}

/// A driver's words on one line.
fn plain(reason: &str) -> String {
    reason.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A fault that a device reported asynchronously.
#[derive(Clone)]
struct DeviceFault {
    reason: String,
    /// Whether the device itself is lost.
    lost: bool,
}

impl DeviceFault {
    fn untold() -> DeviceFault {
        DeviceFault { reason: "an error could not be told".to_owned(), lost: false }
    }
}

/// The required features: a float depth with a stencil.
const NEEDED: Features = Features::DEPTH32FLOAT_STENCIL8;
/// Optional features: some techniques need float blending, which some adapters lack (all of GL); timers need
/// timestamps.
const WANTED: Features = Features::FLOAT32_BLENDABLE.union(Features::TIMESTAMP_QUERY);

impl Gpu {
    /// The backends that are used. OpenGL lacks too much of what is needed.
    pub const BACKENDS: Backends = Backends::PRIMARY;

    /// Opens the fastest adapter of the system. The usual environment variables of wgpu choose another one.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`]; otherwise as [`Gpu::on`].
    pub fn open() -> Result<Gpu, GpuError> {
        Self::open_as(false)
    }

    /// Opens a software adapter, if the system has one.
    ///
    /// # Errors
    /// As [`Gpu::open`].
    pub fn open_software() -> Result<Gpu, GpuError> {
        Self::open_as(true)
    }

    fn open_as(software: bool) -> Result<Gpu, GpuError> {
        let mut wanted = InstanceDescriptor::new_without_display_handle_from_env();
        wanted.backends &= Self::BACKENDS;
        let options = RequestAdapterOptions {
            power_preference: PowerPreference::HighPerformance,
            force_fallback_adapter: software,
            ..RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(Instance::new(wanted).request_adapter(&options));
        Self::on(&adapter.map_err(|_| GpuError::NoAdapter)?)
    }

    /// Opens another device on an adapter.
    ///
    /// # Errors
    /// [`GpuError::Unusable`] if the adapter lacks a required feature, or has lost its device.
    pub fn on(adapter: &Adapter) -> Result<Gpu, GpuError> {
        check(adapter)?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Self::description(adapter)))
            .map_err(|error| unusable(adapter, error.to_string()))?;
        Ok(Self::opened(adapter, device, queue))
    }

    /// The descriptor of a device on which all techniques can draw, for callers that open it themselves.
    pub(crate) fn description(adapter: &Adapter) -> DeviceDescriptor<'static> {
        DeviceDescriptor {
            label: Some("gnomon"),
            required_features: adapter.features() & (NEEDED | WANTED),
            required_limits: adapter.limits(),
            ..DeviceDescriptor::default()
        }
    }

    /// Uses a device that is already open, and records the faults that it reports from now on.
    #[doc(hidden)]
    pub fn opened(adapter: &Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Gpu {
        let fault = Arc::new(Mutex::new(None::<DeviceFault>));
        let heard = Arc::clone(&fault);
        let hear = move |reason: String, lost: bool| {
            if let Ok(mut fault) = heard.lock() {
                match &mut *fault {
                    // consequences of a loss may be reported before it
                    Some(first) if lost && !first.lost => *first = DeviceFault { reason, lost },
                    Some(_) => {}
                    none => *none = Some(DeviceFault { reason, lost }),
                }
            }
        };
        let hear_lost = hear.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| hear(error.to_string(), false)));
        device.set_device_lost_callback(move |_, message| {
            let why = if message.is_empty() { String::new() } else { format!(" ({message})") };
            hear_lost(format!("its device was lost{why}"), true);
        });
        let info = adapter.get_info();
        let (name, software) = (info.name, info.device_type == wgpu::DeviceType::Cpu);
        Gpu {
            device,
            queue,
            limits: adapter.limits(),
            name,
            software,
            fault,
            #[cfg(feature = "test-hooks")]
            timers: std::sync::OnceLock::new(),
        }
    }

    /// The adapter's name, from its driver.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether the adapter is a software adapter.
    pub fn software(&self) -> bool {
        self.software
    }

    /// Checks that the adapter can blend 32-bit floats, which `what` needs.
    ///
    /// # Errors
    /// [`GpuError::Failed`]
    pub(crate) fn blends_float32(&self, what: &str) -> Result<(), GpuError> {
        match self.device.features().contains(Features::FLOAT32_BLENDABLE) {
            true => Ok(()),
            false => Err(self.failed(format!("{what} by blending 32-bit floats, which it cannot"))),
        }
    }

    /// Returns an error if something went wrong since the device was opened. wgpu reports faults (mostly of memory)
    /// separately from the calls that cause them, so callers must check before they return a result.
    ///
    /// # Errors
    /// [`GpuError::Lost`]
    #[doc(hidden)]
    pub fn check(&self) -> Result<(), GpuError> {
        #[cfg(feature = "test-hooks")]
        if super::losing::is_to_be_lost() {
            self.device.destroy();
        }
        let fault = || self.fault.lock().map_or_else(|_| Some(DeviceFault::untold()), |fault| fault.clone());
        if fault().is_none() {
            return Ok(());
        }
        // a loss is reported once all work has ended, and the poll may report it
        let _ = self.device.poll(PollType::wait_indefinitely());
        fault().map_or(Ok(()), |fault| Err(self.lost(fault.reason)))
    }

    /// The fault that was reported since the last call, for callers that continue after a fault.
    #[doc(hidden)]
    pub fn heard(&self) -> Option<GpuError> {
        let fault = self.fault.lock().ok()?.take()?;
        Some(self.lost(fault.reason))
    }

    /// Whether the device itself is lost, and not just some work on it.
    pub fn is_lost(&self) -> bool {
        self.fault.lock().map_or(true, |fault| fault.as_ref().is_some_and(|fault| fault.lost))
    }

    /// The error with the adapter's name, for a fault on the device.
    #[doc(hidden)]
    pub fn lost(&self, reason: impl ToString) -> GpuError {
        GpuError::Lost { adapter: self.name.clone(), reason: reason.to_string() }
    }

    /// The error with the adapter's name, for work that the adapter cannot do.
    #[doc(hidden)]
    pub fn failed(&self, reason: impl ToString) -> GpuError {
        GpuError::Failed { adapter: self.name.clone(), reason: reason.to_string() }
    }
}

/// Checks that an adapter has the required features.
fn check(adapter: &Adapter) -> Result<(), GpuError> {
    match adapter.features().contains(NEEDED) {
        true => Ok(()),
        false => Err(unusable(adapter, "it has no 32-bit depth with stencil".into())),
    }
}

fn unusable(adapter: &Adapter, reason: String) -> GpuError {
    GpuError::Unusable { adapter: adapter.get_info().name, reason }
}
