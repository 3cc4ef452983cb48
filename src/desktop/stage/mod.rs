//! The stage draws the picture on its own thread and its own device. It takes the newest wish, drops older ones, and
//! hands over a texture of the window's device, which the window shows unchanged.
//!
//! With one device for both, the window could not be resized while a picture is drawn: wgpu does not configure a
//! surface while another thread submits work, and waits for all work that was submitted before.

pub(in crate::desktop) mod easel;
pub(in crate::desktop) mod plain;
pub(in crate::desktop) mod wish;

use crate::desktop::stage::easel::Easel;
use crate::desktop::stage::plain::PlainDrawer;
use crate::desktop::stage::wish::Wish;
use crate::desktop::state::words::PanelWords;
use crate::export::figure::{Colours, component_colours};
use crate::gpu::{Gpu, readback};
use crate::message::Worded;
use crate::picture::{COLOURS, Picture};
use crate::profile::Provenance;
use crate::shadow::ShadowError;
use crate::site::Site;
use crate::study::StudyError;
use crate::study::live::{Live, LiveMethod};
use crate::view::{Camera, Elevation, Grid, View};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Instant;

/// A picture, and what it shows.
pub(in crate::desktop) struct StagePicture {
    /// The picture, on the window's device.
    pub(in crate::desktop) texture: wgpu::Texture,
    /// The wish that it fulfils.
    pub(in crate::desktop) wish: Wish,
    /// What drew it.
    pub(in crate::desktop) provenance: Provenance,
    /// Whether it shows only sun and shadow, without overlays.
    pub(in crate::desktop) plain: bool,
    /// The time until all of the work was submitted to the adapter, seconds, as far as it depends on the picture's
    /// size. The time that the adapter then needs depends on the window's frames as well.
    pub(in crate::desktop) secs: f64,
    /// The meaning of the colours of a diagram.
    pub(in crate::desktop) legend: Option<Colours>,
}

/// The window's handle on the drawing thread.
pub(in crate::desktop) struct Stage {
    shared: Arc<StageWorker>,
}

struct StageWorker {
    easel: Easel,
    render: RenderState,
    context: egui::Context,
    next: Mutex<Option<Wish>>,
    woken: Condvar,
    done: Mutex<Option<Result<StagePicture, String>>>,
    busy: AtomicBool,
    over: AtomicBool,
}

impl Stage {
    /// Starts the thread.
    pub(in crate::desktop) fn new(render: RenderState, context: egui::Context) -> Stage {
        let shared = Arc::new(StageWorker {
            easel: Easel::new(render.adapter.clone()),
            render,
            context,
            next: Mutex::new(None),
            woken: Condvar::new(),
            done: Mutex::new(None),
            busy: AtomicBool::new(false),
            over: AtomicBool::new(false),
        });
        let worker = Arc::clone(&shared);
        std::thread::spawn(move || worker.work());
        Stage { shared }
    }

    /// Requests a picture. An earlier wish that was not begun yet is dropped.
    pub(in crate::desktop) fn wish(&self, wish: Wish) {
        if let Ok(mut next) = self.shared.next.lock() {
            *next = Some(wish);
            self.shared.busy.store(true, Ordering::Release);
            self.shared.woken.notify_one();
        }
    }

    /// The newest picture since the last call, or why there is none.
    pub(in crate::desktop) fn done(&self) -> Option<Result<StagePicture, String>> {
        self.shared.done.lock().ok()?.take()
    }

    /// What happened to the device on which pictures are drawn, since the last call.
    pub(in crate::desktop) fn note(&self) -> Option<String> {
        self.shared.easel.note()
    }

    /// Whether it is drawing, or about to.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn is_busy(&self) -> bool {
        self.shared.is_busy()
    }

    /// Whether the processor draws.
    pub(in crate::desktop) fn is_software(&self) -> bool {
        self.shared.easel.is_software()
    }

    /// Loses its device, and further ones.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn lose_devices(&self, further: u32) {
        self.shared.easel.lose(further);
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        // locked, so that a worker cannot miss this between its check and its sleep
        let next = self.shared.next.lock();
        self.shared.over.store(true, Ordering::Release);
        drop(next);
        self.shared.woken.notify_one();
    }
}

/// What is kept from one picture to the next, separately for quick looks and for best pictures, so that neither changes
/// the other's size.
#[derive(Default)]
struct StageCache {
    /// The site's number, and its live drawing.
    live: Option<(u64, Live)>,
    hours: Option<u64>,
    /// The last wish.
    wish: Option<Wish>,
    /// The picture on the stage's device, and on the window's.
    target: Option<[wgpu::Texture; 2]>,
    /// The drawer without a device.
    plain: Option<PlainDrawer>,
}

impl StageWorker {
    fn work(&self) {
        let mut kept = [StageCache::default(), StageCache::default()];
        while let Some(wish) = self.wait() {
            let result = self.draw_somewhere(&mut kept, &wish);
            let Ok(mut done) = self.done.lock() else { return };
            *done = Some(result);
            drop(done);
            if let Ok(next) = self.next.lock()
                && next.is_none()
            {
                self.busy.store(false, Ordering::Release);
            }
            self.context.request_repaint();
            self.get_ready(&mut kept);
        }
    }

    /// Prepares for quick looks while there is no other work, so that the first movement does not wait.
    fn get_ready(&self, kept: &mut [StageCache; 2]) {
        let [best, quick] = &*kept;
        let (Some(wish), false) = (&best.wish, self.is_busy() || self.easel.is_given_up()) else { return };
        if quick.live.as_ref().is_some_and(|(number, _)| *number == wish.number) {
            return;
        }
        let view = match wish.view {
            View::Plan(grid) => View::Plan(Grid { width: 16, height: 16, ..grid }),
            View::Camera(camera) => View::Camera(Camera { width: 16, height: 16, ..camera }),
            View::Elevation(side) => View::Elevation(Elevation { width: 16, height: 16, ..side }),
        };
        let way = if self.easel.is_software() { LiveMethod::quickest() } else { wish.way };
        let small = Wish { view, way, overlay: [false; 2], diagram: None, quick: true, ..wish.clone() };
        // errors here will be reported when the picture is requested
        let _ = self.draw_somewhere(kept, &small);
    }

    /// Draws on the current device; if that fails, on another; and if all fail, on none.
    fn draw_somewhere(&self, kept: &mut [StageCache; 2], wish: &Wish) -> Result<StagePicture, String> {
        let mut failures = 0;
        let mut gpu = self.easel.gpu();
        while let Some(device) = gpu.take() {
            let its = &mut kept[usize::from(wish.quick)];
            let error = match self.draw(&device, its, wish.clone()) {
                Ok(shown) => return Ok(shown),
                Err(error) => error,
            };
            *its = StageCache::default();
            let Some(lost) = error.lost_device() else { return Err(error.in_words(&PanelWords)) };
            // none of it can be used again
            *kept = Default::default();
            drop(device);
            failures += 1;
            gpu = self.easel.replace(lost, failures);
        }
        self.draw_plain(&mut kept[usize::from(wish.quick)].plain, wish).map_err(|error| error.in_words(&PanelWords))
    }

    fn draw_plain(&self, kept: &mut Option<PlainDrawer>, wish: &Wish) -> Result<StagePicture, ShadowError> {
        let started = Instant::now();
        let (pixels, provenance) = plain::draw(kept, wish)?;
        let size = wish.view.size();
        let texture = self.shown_texture(size);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * size.0), rows_per_image: None };
        let bytes = bytemuck::cast_slice(&pixels);
        self.render.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        let secs = started.elapsed().as_secs_f64();
        Ok(StagePicture { texture, wish: wish.clone(), provenance, plain: true, secs, legend: None })
    }

    fn is_busy(&self) -> bool {
        self.busy.load(Ordering::Acquire)
    }

    fn wait(&self) -> Option<Wish> {
        let mut next = self.next.lock().ok()?;
        loop {
            if self.over.load(Ordering::Acquire) {
                return None;
            }
            match next.take() {
                Some(wish) => return Some(wish),
                None => next = self.woken.wait(next).ok()?,
            }
        }
    }

    fn draw(&self, gpu: &Arc<Gpu>, kept: &mut StageCache, wish: Wish) -> Result<StagePicture, StudyError> {
        let tint = |live: &mut Live| live.picture().tint(face_colours(&wish.site));
        // frees the memory of another scene first
        let at_hand = kept.live.take().and_then(|(number, mut live)| {
            if number != wish.number {
                live.change_to(&wish.site).then(|| tint(&mut live))?;
            }
            Some(live)
        });
        let mut live = match at_hand {
            Some(live) => live,
            None => {
                (kept.hours, kept.target) = (None, None);
                let mut live = Live::new(&wish.site, Arc::clone(gpu), wish.view)?;
                tint(&mut live);
                live
            }
        };
        let started = Instant::now();
        live.look_at(wish.view);
        let hours = wish.hours.as_ref().map(|hours| hours.number);
        if hours != kept.hours {
            match &wish.hours {
                Some(hours) => hours.lay(live.picture(), &wish.site)?,
                None => live.picture().lay_hours(None),
            }
            kept.hours = hours;
        }
        let mut legend = None;
        let [volumes, silhouette] = wish.overlay;
        live.lay_overlay(wish.to_sun, volumes, silhouette)?;
        if let Some(diagram) = wish.diagram
            && let Some(counted) = live.counted(&wish.way, wish.to_sun)?
            && let Some(colours) = Colours::of(&counted, diagram)
        {
            live.picture().paint(wish.view.size(), &colours.of_cells);
            legend = Some(colours);
        }
        let size = wish.view.size();
        let fits = |[of, _]: &[wgpu::Texture; 2]| (of.width(), of.height()) == size;
        let target = kept.target.take().filter(fits);
        let target = target.unwrap_or_else(|| [Picture::target(gpu, &wish.view), self.shown_texture(size)]);
        let provenance = live.draw(&wish.way, wish.to_sun, &wish.style, &target[0])?;
        let secs = started.elapsed().as_secs_f64();
        // waits for the copy, so that pictures do not queue up
        readback::hand_over(gpu, &target[0], &self.render.queue, &target[1])?;
        let texture = target[1].clone();
        kept.target = Some(target);
        (kept.live, kept.wish) = (Some((wish.number, live)), Some(wish.clone()));
        Ok(StagePicture { texture, wish, provenance, plain: false, secs, legend })
    }

    /// A texture on the window's device.
    fn shown_texture(&self, (width, height): (u32, u32)) -> wgpu::Texture {
        let usage =
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC;
        self.render.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("stage.shown"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: COLOURS,
            usage,
            view_formats: &[],
        })
    }
}

/// The colours of all visible faces, in the form that the picture uses.
fn face_colours(site: &Site) -> impl Iterator<Item = [u8; 3]> {
    let colours = component_colours(&site.mesh, &site.casts);
    let seen = site.mesh.components.iter().zip(colours).zip(&site.receives).filter(|(_, seen)| **seen);
    let faces: Vec<_> = seen.map(|((component, colour), _)| (component.faces.len(), colour)).collect();
    faces.into_iter().flat_map(|(count, colour)| std::iter::repeat_n(colour, count))
}
