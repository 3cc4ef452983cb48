//! Runs the system's event loop for several windows, one after another.
//!
//! egui's renderer panics when it paints on a lost device, or when the device's memory is full. A panic that leaves
//! winit's loop makes the loop unusable, and a process can have only one. So the panic is caught here, around each
//! event: the window ends, and the loop can show the next one.

use eframe::{EframeWinitApplication, NativeOptions, UserEvent};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use winit::application::ApplicationHandler;
use winit::error::EventLoopError;
use winit::event::{DeviceEvent, DeviceId, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::platform::run_on_demand::EventLoopExtRunOnDemand;
use winit::window::WindowId;

/// The message of a panic.
pub(in crate::desktop) type Panic = Box<dyn Any + Send>;

/// The event loop of this process, with these options.
///
/// # Errors
/// Usually: there is no display.
pub(in crate::desktop) fn new(options: &mut NativeOptions) -> Result<EventLoop<UserEvent>, EventLoopError> {
    let mut builder = EventLoop::with_user_event();
    if let Some(hook) = options.event_loop_builder.take() {
        hook(&mut builder);
    }
    builder.build()
}

/// Shows a window until it is closed. Returns the panic that ended it, if one did.
///
/// # Errors
/// Errors of the system.
pub(in crate::desktop) fn show(
    event_loop: &mut EventLoop<UserEvent>,
    window: EframeWinitApplication<'_>,
) -> Result<Option<Panic>, EventLoopError> {
    let mut guarded = PanicGuard { window, panic: None };
    event_loop.run_app_on_demand(&mut guarded)?;
    let PanicGuard { window, panic } = guarded;
    // its resources may be on a lost device
    let dropped = catch_unwind(AssertUnwindSafe(|| drop(window)));
    Ok(panic.or(dropped.err()))
}

/// A window whose panics end only that window.
struct PanicGuard<'a> {
    window: EframeWinitApplication<'a>,
    panic: Option<Panic>,
}

impl PanicGuard<'_> {
    /// Passes an event on, unless the window has ended.
    fn hand_on(&mut self, event_loop: &ActiveEventLoop, event: impl FnOnce(&mut EframeWinitApplication<'_>)) {
        if self.panic.is_none() {
            let window = &mut self.window;
            self.panic = catch_unwind(AssertUnwindSafe(|| event(window))).err();
        }
        if self.panic.is_some() {
            event_loop.exit();
        }
    }
}

impl ApplicationHandler<UserEvent> for PanicGuard<'_> {
    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        self.hand_on(event_loop, |window| window.new_events(event_loop, cause));
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        self.hand_on(event_loop, |window| window.resumed(event_loop));
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: UserEvent) {
        self.hand_on(event_loop, |window| window.user_event(event_loop, event));
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        self.hand_on(event_loop, |window| window.window_event(event_loop, id, event));
    }

    fn device_event(&mut self, event_loop: &ActiveEventLoop, id: DeviceId, event: DeviceEvent) {
        self.hand_on(event_loop, |window| window.device_event(event_loop, id, event));
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.hand_on(event_loop, |window| window.about_to_wait(event_loop));
    }

    fn suspended(&mut self, event_loop: &ActiveEventLoop) {
        self.hand_on(event_loop, |window| window.suspended(event_loop));
    }

    fn memory_warning(&mut self, event_loop: &ActiveEventLoop) {
        self.hand_on(event_loop, |window| window.memory_warning(event_loop));
    }

    /// Also called after a panic: the system's window is closed, and eframe stores its state.
    fn exiting(&mut self, event_loop: &ActiveEventLoop) {
        let ended = catch_unwind(AssertUnwindSafe(|| self.window.exiting(event_loop)));
        // the first panic is reported
        self.panic = self.panic.take().or(ended.err());
    }
}
