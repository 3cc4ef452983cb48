//! The device that draws pictures. It is not the window's, so that drawing never blocks the window. If it fails, it is
//! replaced by another one; if devices fail repeatedly, pictures are drawn without any.

use crate::gpu::{Gpu, GpuError};
#[cfg(feature = "test-hooks")]
use std::sync::atomic::AtomicU32;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The current device, and the adapter of the next one.
pub(in crate::desktop) struct Easel {
    /// The window's adapter.
    adapter: wgpu::Adapter,
    gpu: Mutex<Option<Arc<Gpu>>>,
    software: AtomicBool,
    given_up: AtomicBool,
    note: Mutex<Option<String>>,
    /// The number of devices to lose as soon as they are opened.
    #[cfg(feature = "test-hooks")]
    to_lose: AtomicU32,
}

impl Easel {
    /// An easel without an open device.
    pub(in crate::desktop) fn new(adapter: wgpu::Adapter) -> Easel {
        let software = AtomicBool::new(adapter.get_info().device_type == wgpu::DeviceType::Cpu);
        let (gpu, note) = (Mutex::new(None), Mutex::new(None));
        Easel {
            adapter,
            gpu,
            software,
            given_up: AtomicBool::new(false),
            note,
            #[cfg(feature = "test-hooks")]
            to_lose: AtomicU32::new(0),
        }
    }

    /// Whether the processor draws pictures: by a software adapter, or without an adapter.
    pub(in crate::desktop) fn is_software(&self) -> bool {
        self.software.load(Ordering::Acquire)
    }

    /// Whether pictures are drawn without an adapter.
    pub(in crate::desktop) fn is_given_up(&self) -> bool {
        self.given_up.load(Ordering::Acquire)
    }

    /// What happened to a device since the last call.
    pub(in crate::desktop) fn note(&self) -> Option<String> {
        locked(&self.note).take()
    }

    /// The current device, or a new one: on the window's adapter, or on another if that has none. `None` if all failed.
    pub(in crate::desktop) fn gpu(&self) -> Option<Arc<Gpu>> {
        if self.is_given_up() {
            return None;
        }
        let mut at_hand = locked(&self.gpu);
        if let Some(gpu) = &*at_hand {
            return Some(Arc::clone(gpu));
        }
        let error = match Gpu::on(&self.adapter) {
            Ok(gpu) => return Some(self.take(&mut at_hand, gpu)),
            Err(error) => error,
        };
        // an adapter whose driver was reset must be found again
        match Gpu::open().or_else(|_| Gpu::open_software()) {
            Ok(gpu) => {
                self.tell(format!("{}; pictures are drawn by '{}'", error.why(), gpu.name()));
                Some(self.take(&mut at_hand, gpu))
            }
            Err(_) => self.give_up(&error),
        }
    }

    /// Replaces a device after a number of failures of the same picture: by a new one on the same adapter, then by one
    /// on a software adapter, then by none.
    pub(in crate::desktop) fn replace(&self, error: &GpuError, failures: usize) -> Option<Arc<Gpu>> {
        *locked(&self.gpu) = None;
        match failures {
            1 => {
                self.tell(format!("{}; the picture was drawn again on a new device", error.why()));
                self.gpu()
            }
            2 => {
                let Ok(gpu) = Gpu::open_software() else { return self.give_up(error) };
                self.tell(format!(
                    "{} again; pictures are drawn on the processor now, by '{}'",
                    error.why(),
                    gpu.name()
                ));
                Some(self.take(&mut locked(&self.gpu), gpu))
            }
            _ => self.give_up(error),
        }
    }

    fn give_up(&self, error: &GpuError) -> Option<Arc<Gpu>> {
        self.given_up.store(true, Ordering::Release);
        self.software.store(true, Ordering::Release);
        self.tell(format!("{}; pictures are drawn on the processor now, with sun and shadow alone", error.why()));
        None
    }

    fn tell(&self, note: String) {
        *locked(&self.note) = Some(note);
    }

    fn take(&self, at_hand: &mut Option<Arc<Gpu>>, gpu: Gpu) -> Arc<Gpu> {
        self.software.store(gpu.software(), Ordering::Release);
        #[cfg(feature = "test-hooks")]
        if self.to_lose.fetch_update(Ordering::AcqRel, Ordering::Acquire, |left| left.checked_sub(1)).is_ok() {
            gpu.device.destroy();
        }
        Arc::clone(at_hand.insert(Arc::new(gpu)))
    }

    /// Loses the device, as if its driver was reset, and then that many further ones as soon as they are opened.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn lose(&self, further: u32) {
        self.to_lose.store(further, Ordering::Release);
        if let Some(gpu) = &*locked(&self.gpu) {
            gpu.device.destroy();
        }
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
