//! The picture is drawn by a thread of its own: it takes the newest wish, drops what was wished before, and hands over a
//! texture that the window shows as it is.

use super::hours::Laid;
use crate::export::figure::{Colours, Diagram};
use crate::gpu::Gpu;
use crate::profile::Drawn;
use crate::shadow::picture::{Picture, Style};
use crate::site::Site;
use crate::study::live::{Live, Way};
use crate::view::{Camera, Elevation, Grid, View};
use eframe::egui;
use glam::DVec3;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Instant;

/// What the window wishes to see.
#[derive(Clone)]
pub(super) struct Wish {
    /// The site without what is hidden, and which one of those that were loaded.
    pub(super) site: Arc<Site>,
    /// Grows with every site loaded.
    pub(super) number: u64,
    /// With the picture's size in pixels.
    pub(super) view: View,
    /// How shadows are found.
    pub(super) way: Way,
    /// The unit vector to the sun.
    pub(super) to_sun: DVec3,
    /// How the picture is drawn.
    pub(super) style: Style,
    /// Hours to lie over the scene.
    pub(super) hours: Option<Arc<Laid>>,
    /// The volumes and the silhouette over it.
    pub(super) overlay: [bool; 2],
    /// What counting took, instead.
    pub(super) diagram: Option<Diagram>,
    /// Something moves: this is a quick look, and a better one will be wished for.
    pub(super) quick: bool,
}

impl Wish {
    /// Whether two wishes are for the same picture.
    pub(super) fn is_same(&self, other: &Wish) -> bool {
        let hours = |wish: &Wish| wish.hours.as_ref().map(|laid| laid.number);
        self.number == other.number
            && self.view == other.view
            && self.way == other.way
            && self.to_sun == other.to_sun
            && self.style == other.style
            && hours(self) == hours(other)
            && self.overlay == other.overlay
            && self.diagram == other.diagram
    }
}

/// A picture, and what it shows.
pub(super) struct Shown {
    /// The picture.
    pub(super) texture: wgpu::Texture,
    /// What was wished.
    pub(super) wish: Wish,
    /// What drew it.
    pub(super) drawn: Drawn,
    /// How long that took until the adapter had all of it, seconds: what a size of the picture has a say in. How long the
    /// adapter takes then is a matter of the window's frames as well.
    pub(super) secs: f64,
    /// What the colours of a diagram mean.
    pub(super) legend: Option<Colours>,
}

/// The thread that draws, as the window knows it.
pub(super) struct Stage {
    shared: Arc<Shared>,
}

struct Shared {
    gpu: Arc<Gpu>,
    context: egui::Context,
    next: Mutex<Option<Wish>>,
    woken: Condvar,
    done: Mutex<Option<Result<Shown, String>>>,
    busy: AtomicBool,
    over: AtomicBool,
}

impl Stage {
    /// Starts the thread.
    pub(super) fn new(gpu: Arc<Gpu>, context: egui::Context) -> Stage {
        let shared = Arc::new(Shared {
            gpu,
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

    /// Wishes for a picture; one that was not begun yet is forgotten.
    pub(super) fn wish(&self, wish: Wish) {
        if let Ok(mut next) = self.shared.next.lock() {
            *next = Some(wish);
            self.shared.busy.store(true, Ordering::Release);
            self.shared.woken.notify_one();
        }
    }

    /// The newest picture since the last time it was asked for, or why there is none.
    pub(super) fn done(&self) -> Option<Result<Shown, String>> {
        self.shared.done.lock().ok()?.take()
    }

    /// Whether it draws, or is about to.
    pub(super) fn is_busy(&self) -> bool {
        self.shared.is_busy()
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        self.shared.over.store(true, Ordering::Release);
        self.shared.woken.notify_one();
    }
}

/// What is kept from one picture to the next; for quick looks and for the best ones apart, so that neither turns the other
/// to its size.
#[derive(Default)]
struct Kept {
    /// The site's number, and the site itself with what draws it.
    live: Option<(u64, Live)>,
    hours: Option<u64>,
    /// What was drawn last.
    wish: Option<Wish>,
    target: Option<wgpu::Texture>,
}

impl Shared {
    fn work(&self) {
        let mut kept = [Kept::default(), Kept::default()];
        while let Some(wish) = self.wait() {
            let its = &mut kept[usize::from(wish.quick)];
            let result = self.draw(its, wish);
            if result.is_err() {
                *its = Kept::default();
            }
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

    /// Makes what quick looks need while nothing is asked, so that the first movement does not wait for it.
    fn get_ready(&self, kept: &mut [Kept; 2]) {
        let [best, quick] = kept;
        let (Some(wish), false) = (&best.wish, self.is_busy()) else { return };
        if quick.live.as_ref().is_some_and(|(number, _)| *number == wish.number) {
            return;
        }
        let view = match wish.view {
            View::Plan(grid) => View::Plan(Grid { width: 16, height: 16, ..grid }),
            View::Camera(camera) => View::Camera(Camera { width: 16, height: 16, ..camera }),
            View::Elevation(side) => View::Elevation(Elevation { width: 16, height: 16, ..side }),
        };
        let way = if self.gpu.software() { Way::quickest() } else { wish.way };
        let small = Wish { view, way, overlay: [false; 2], diagram: None, quick: true, ..wish.clone() };
        // what is wrong here will be told when it is asked for
        if self.draw(quick, small).is_err() {
            *quick = Kept::default();
        }
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

    fn draw(&self, kept: &mut Kept, wish: Wish) -> Result<Shown, String> {
        let told = |error: crate::study::StudyError| error.to_string();
        let tint = |live: &mut Live| live.picture().tint(super::components::face_colours(&wish.site));
        // one of another scene goes first, with its memory
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
                let mut live = Live::new(&wish.site, Arc::clone(&self.gpu), wish.view).map_err(told)?;
                tint(&mut live);
                live
            }
        };
        let started = Instant::now();
        live.look_at(wish.view);
        let laid = wish.hours.as_ref().map(|laid| laid.number);
        if laid != kept.hours {
            match &wish.hours {
                Some(laid) => laid.lay(live.picture(), &wish.site).map_err(|error| error.to_string())?,
                None => live.picture().lay_hours(None),
            }
            kept.hours = laid;
        }
        let mut legend = None;
        let [volumes, silhouette] = wish.overlay;
        live.lay_overlay(wish.to_sun, volumes, silhouette).map_err(told)?;
        if let Some(diagram) = wish.diagram
            && let Some(counted) = live.counted(&wish.way, wish.to_sun).map_err(told)?
            && let Some(colours) = Colours::of(&counted, diagram)
        {
            live.picture().paint(wish.view.size(), &colours.of_cells);
            legend = Some(colours);
        }
        let size = wish.view.size();
        let fits = |texture: &wgpu::Texture| (texture.width(), texture.height()) == size;
        let target = kept.target.take().filter(fits).unwrap_or_else(|| Picture::target(&self.gpu, &wish.view));
        let drawn = live.draw(&wish.way, wish.to_sun, &wish.style, &target).map_err(told)?;
        let secs = started.elapsed().as_secs_f64();
        // no wish piles up on another: this one is finished before the next is taken
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
        self.gpu.check().map_err(|error| error.to_string())?;
        kept.target = Some(target.clone());
        (kept.live, kept.wish) = (Some((wish.number, live)), Some(wish.clone()));
        Ok(Shown { texture: target, wish, drawn, secs, legend })
    }
}
