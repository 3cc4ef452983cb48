//! A graphics device that is lost in the middle of a study: the work is repeated, and the result is the same.

use gnomon::choice::{Engine, Method, Receivers};
use gnomon::deliver::profile::{ProfileRequest, profile};
use gnomon::deliver::{Folder, Sink};
use gnomon::gpu::{Gpu, GpuError, lose_after, readback};
use gnomon::site::{Overrides, Site};
use gnomon::study::again::persist;
use gnomon::study::{self, Event, FrameView, InstantWants, Stopwatch, StudyError, TiledStudy, Wants};
use gnomon::view::View;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

/// The works at four instants, in coarse cells, on a graphics adapter.
fn works() -> Site {
    let asked = Overrides { size: Some(200), ..Overrides::default() };
    let mut site = Site::load(Path::new("sites/industry"), &asked).expect("a sample");
    site.track.instants.truncate(4);
    (site.method, site.engine) = (Method::Stencil, Engine::Gpu);
    site
}

/// What a study reports: its notes, how often it started over, and the instants that were drawn.
#[derive(Debug, Default)]
struct Told {
    notes: Vec<String>,
    anew: usize,
    drawn: Vec<usize>,
}

impl Told {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Note(note) => self.notes.push(note.to_string()),
            Event::StartsOver => self.anew += 1,
            Event::Drawn { index, .. } => self.drawn.push(*index),
            _ => {}
        }
        ControlFlow::Continue(())
    }

    /// That it was told of one device that was lost.
    fn is_of_one_loss(&self) {
        assert_eq!(self.anew, 1, "{self:?}");
        let lost = self.notes.iter().filter(|note| note.contains("its device was lost"));
        let lost: Vec<_> = lost.collect();
        assert!(lost.len() == 1 && lost[0].ends_with(": the work is done again on a new device"), "{lost:?}");
    }

    /// That it was told of two, after which an adapter that is a program took over.
    fn is_of_software(&self) {
        assert_eq!(self.anew, 2, "{self:?}");
        let last = self.notes.iter().rfind(|note| note.contains("its device was lost"));
        let last = last.expect("a note");
        assert!(last.contains(": the work is done again on the processor, by '") && last.ends_with('\''), "{last}");
    }

    /// Listens, and removes the next device as soon as the work begins again, as often as requested.
    fn losing<'a>(&'a mut self, mut more: usize, checks: u32) -> impl FnMut(Event<'_>) -> ControlFlow<()> + 'a {
        lose_after(checks);
        move |event| {
            if matches!(event, Event::StartsOver) && more > 0 {
                more -= 1;
                lose_after(checks);
            }
            self.hear(&event)
        }
    }
}

#[test]
fn study_comes_to_the_same() {
    let site = works();
    let wants = Wants { bits: true, surface: true, ..Wants::default() };
    let right = study::run(&site, &wants, &mut |_| ControlFlow::Continue(())).expect("a study");
    let mut told = Told::default();
    let again = study::run(&site, &wants, &mut |event| {
        if matches!(event, Event::Drawn { index: 1, .. }) && told.anew == 0 {
            lose_after(1);
        }
        told.hear(&event)
    });
    let again = again.expect("a study");
    told.is_of_one_loss();
    assert!(told.drawn.starts_with(&[0, 1]) && told.drawn.ends_with(&[0, 1, 2, 3]), "{:?}", told.drawn);
    let cells = |outcome: &study::Outcome| outcome.profile.shaded.iter().collect::<Vec<u64>>();
    assert!(cells(&right).iter().any(|secs| *secs > 0));
    assert!(cells(&again) == cells(&right));
    assert_eq!(again.drawn, right.drawn);
}

#[test]
fn instant_comes_to_the_same() {
    let site = works();
    let (view, wants) = (View::Camera(site.camera), InstantWants { volumes: true, ..InstantWants::default() });
    let right = study::instant(&site, view, &wants, &mut |_| ControlFlow::Continue(())).expect("an instant");
    let mut told = Told::default();
    lose_after(3);
    let again = study::instant(&site, view, &wants, &mut |event| told.hear(&event)).expect("an instant");
    told.is_of_one_loss();
    assert!(again.mask.share == right.mask.share);
    assert!(again.overlay.expect("volumes").layers == right.overlay.expect("volumes").layers);
}

#[test]
fn frames_are_given_out_once_each() {
    let site = works();
    let view = View::Plan(site.grid);
    let mut masks = [Vec::new(), Vec::new()];
    for (loses, masks) in [false, true].into_iter().zip(&mut masks) {
        let mut told = Told::default();
        let given = &mut *masks;
        study::frames::<StudyError>(&site, FrameView::Still(view), &mut |event| told.hear(&event), &mut |frame| {
            given.push(frame.mask.share.clone());
            if loses && given.len() == 2 {
                lose_after(0);
            }
            Ok(())
        })
        .expect("frames");
        if loses {
            told.is_of_one_loss();
        }
    }
    assert_eq!(masks[1].len(), 4);
    assert!(masks[0] == masks[1]);
}

#[test]
fn patches_come_to_the_same() {
    let site = Site { method: Method::SoftTexture, receivers: Receivers::Patches, ..works() };
    let cell = 2.0;
    let right = study::patches(&site, cell, &mut |_| ControlFlow::Continue(())).expect("surfaces");
    let mut told = Told::default();
    let again = study::patches(&site, cell, &mut |event| {
        if matches!(event, Event::Drawn { index: 1, .. }) && told.anew == 0 {
            lose_after(0);
        }
        told.hear(&event)
    });
    let again = again.expect("surfaces");
    told.is_of_one_loss();
    assert!(again.hours.lit == right.hours.lit && again.hours.lit.iter().any(|secs| *secs > 0));
}

/// A driver that fails repeatedly: the processor takes over, unless the request needs an adapter.
#[test]
fn processor_does_what_no_device_does() {
    let lost = || GpuError::Lost { adapter: "some card".to_owned(), reason: "memory\nis full".to_owned() };
    let works = works();
    let free = Site { method: Method::Auto, engine: Engine::Auto, ..works.clone() };
    let attempt = |site: &Site, can: bool| {
        let (mut told, mut engines) = (Told::default(), Vec::new());
        let done = persist(site, can, &mut |event| told.hear(&event), &mut |site, _, _| {
            engines.push(site.engine);
            if site.engine == Engine::Cpu { Ok(()) } else { Err(lost().into()) }
        });
        (done, told, engines)
    };
    let (done, told, engines) = attempt(&free, true);
    assert!(done.is_ok());
    assert_eq!(engines, [Engine::Auto, Engine::Auto, Engine::Cpu]);
    let why = "the graphics adapter 'some card' failed (memory is full): the work is done again";
    assert_eq!(told.notes, [format!("{why} on a new device"), format!("{why} on the processor")]);
    for (site, can) in [(&free, false), (&works, true)] {
        let (done, told, engines) = attempt(site, can);
        let error = done.expect_err("every device fails").to_string();
        let begins = "the graphics adapter 'some card' failed (memory is full), after another device had failed";
        assert!(error.starts_with(begins) && error.contains("update its driver"), "{error}");
        // on what asks for an adapter the processor itself takes nothing over
        assert_eq!((told.anew, engines), (2, vec![site.engine; 3]));
        let by = format!("{why} on the processor, by '");
        assert!(told.notes.iter().any(|note| note.starts_with(&by)), "{:?}", told.notes);
    }
    // what an adapter cannot do, it cannot on a new device either
    let mut attempts = 0;
    let done = persist(&free, true, &mut |_| ControlFlow::Continue(()), &mut |_, _, _| -> Result<(), StudyError> {
        attempts += 1;
        Err(GpuError::Failed { adapter: "some card".to_owned(), reason: "too large".to_owned() }.into())
    });
    assert!(done.is_err() && attempts == 1);
}

/// If real adapters fail, a software adapter does what only an adapter can do, with the same technique.
#[test]
fn software_adapter_does_what_the_processor_cannot() {
    let site = works();
    let free = Site { method: Method::Auto, engine: Engine::Auto, ..works() };
    let view = View::Camera(site.camera);
    let volumes = InstantWants { volumes: true, silhouette: true, ..InstantWants::default() };
    let right = study::instant(&free, view, &volumes, &mut |_| ControlFlow::Continue(())).expect("an instant");
    let mut told = Told::default();
    let again = study::instant(&free, view, &volumes, &mut told.losing(1, 3)).expect("an instant");
    told.is_of_software();
    assert_eq!(again.drawn.technique, Method::Stencil);
    assert!(again.overlay.expect("volumes").layers == right.overlay.expect("volumes").layers);

    let statistics = Wants { statistics: true, ..Wants::default() };
    for site in [&free, &site] {
        let right = study::run(site, &statistics, &mut |_| ControlFlow::Continue(())).expect("a study");
        let mut told = Told::default();
        let again = study::run(site, &statistics, &mut told.losing(1, 2)).expect("a study");
        told.is_of_software();
        assert!(again.statistics.is_some() && again.statistics == right.statistics);
        assert_eq!(again.drawn.technique, right.drawn.technique);
    }
}

#[test]
fn verification_comes_to_the_same() {
    let asked = Overrides { size: Some(64), ..Overrides::default() };
    let mut site = Site::load(Path::new("sites/industry"), &asked).expect("a sample");
    site.track.instants.retain(|instant| !instant.night);
    site.track.instants.truncate(2);
    let found = |told: &mut Told, losses: usize| {
        let done = match losses {
            0 => study::verify::verify(&site, &mut |event| told.hear(&event)),
            _ => study::verify::verify(&site, &mut told.losing(losses - 1, 5)),
        };
        done.map(|found| found.rows.into_iter().map(|row| (row.drawn, row.difference, row.missed)).collect::<Vec<_>>())
    };
    let right = found(&mut Told::default(), 0).expect("a verification");
    assert!(right.len() >= 6);
    let (mut once, mut twice, mut thrice) = (Told::default(), Told::default(), Told::default());
    assert_eq!(found(&mut once, 1).expect("a verification"), right);
    once.is_of_one_loss();
    assert_eq!(found(&mut twice, 2).expect("a verification"), right);
    twice.is_of_software();
    let error = found(&mut thrice, 3).expect_err("every device is lost").to_string();
    assert!(error.contains("(its device was lost), after another device had failed"), "{error}");
    assert!(error.contains("only a graphics adapter can draw what was requested") && !error.contains('\n'), "{error}");
}

/// A study that stores its progress continues from there on a new device: nothing is done twice.
#[test]
fn study_goes_on_from_what_was_kept() {
    let site = works();
    let wants = Wants { keep_every: Some(Duration::ZERO), bits: true, ..Wants::default() };
    let right = study::run(&site, &wants, &mut |_| ControlFlow::Continue(())).expect("a study");
    let nothing = &mut |_: Event<'_>| ControlFlow::Continue(());
    for keeps in [true, false] {
        let (mut told, mut kept, mut sums, mut gone_on) = (Told::default(), None, None, Vec::new());
        let tiled = TiledStudy::new(&site, &wants, nothing).expect("a study");
        study::in_tiles(tiled, None, &mut |event| {
            match &event {
                Event::Kept(unfinished) => {
                    kept = Some((*unfinished).clone());
                    if unfinished.done == 2 && told.anew == 0 {
                        lose_after(0);
                    }
                }
                Event::Resumes { study, begun } => {
                    assert!(kept.as_ref().is_some_and(|kept| study.is_of(kept)));
                    *begun.borrow_mut() = kept.clone().filter(|_| keeps);
                }
                Event::GoesOn { done } => gone_on.push(*done),
                Event::Summed(shaded) => sums = Some(std::sync::Arc::clone(shaded)),
                _ => {}
            }
            told.hear(&event)
        })
        .expect("a study");
        told.is_of_one_loss();
        // the loss is noticed in the gap before the third
        assert_eq!(gone_on, if keeps { vec![2] } else { Vec::new() });
        assert_eq!(told.drawn, if keeps { vec![0, 1, 2, 3] } else { vec![0, 1, 0, 1, 2, 3] });
        assert!(*sums.expect("sums") == right.profile.shaded);
    }
}

/// A study resumes from the files of a stopped one, also if a device is lost after that.
#[test]
fn stopped_study_goes_on_from_its_folder_on_a_new_device() {
    let site = works();
    let folder = tempfile::tempdir().expect("a folder");
    let [right, out] = ["right", "out"].map(|name| folder.path().join(name));
    let asked = ProfileRequest { raster: true, bits: true, ..ProfileRequest::of(Stopwatch::start()) };
    let sink = |path| Sink::Folder(Folder { path, who: "a test", inputs: &[] });
    profile(&site, &asked, sink(&right), &mut |_| ControlFlow::Continue(())).expect("a study");

    let stopped = profile(&site, &asked, sink(&out), &mut |event| match event {
        Event::Drawn { index: 1, .. } => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    });
    assert!(stopped.is_err_and(|error| error.is_interrupted()));
    let (mut told, mut gone_on) = (Told::default(), Vec::new());
    profile(&site, &asked, sink(&out), &mut |event| {
        match event {
            Event::GoesOn { done } => gone_on.push(done),
            Event::Drawn { index: 2, .. } if told.anew == 0 => lose_after(0),
            _ => {}
        }
        told.hear(&event)
    })
    .expect("a study");
    told.is_of_one_loss();
    assert_eq!(gone_on, [2, 2]);
    for name in ["shadow-hours.tif", "shadow.bits"] {
        let [right, found] = [&right, &out].map(|folder| std::fs::read(folder.join(name)).expect("a file"));
        assert!(right == found, "{name} is another");
    }
}

/// A picture of the stage's device is shown by the window's.
#[test]
fn picture_goes_from_one_device_to_another() {
    let devices = [Gpu::open().expect("an adapter"), Gpu::open().expect("an adapter")];
    // rows that end beside the alignment of copies, and more than are copied in one go
    for (width, height) in [(1, 1), (77, 5), (1920, 1080), (4096, 4100)] {
        let usage = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
        let [from, to] =
            [0, 1].map(|at| devices[at].texture("test", (width, height), wgpu::TextureFormat::Rgba8Unorm, usage));
        let texels: Vec<[u8; 4]> =
            (0..width * height).map(|at| (at.wrapping_mul(2_654_435_761)).to_le_bytes()).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        let bytes = texels.iter().flatten().copied().collect::<Vec<u8>>();
        devices[0].queue.write_texture(from.as_image_copy(), &bytes, layout, from.size());
        let begun = std::time::Instant::now();
        readback::hand_over(&devices[0], &from, &devices[1].queue, &to).expect("a copy");
        println!("{width} x {height}: {:.1} ms", begun.elapsed().as_secs_f64() * 1e3);
        let there: Vec<[u8; 4]> = readback::texels(&devices[1], &to, wgpu::TextureAspect::All).expect("texels");
        assert!(there == texels, "{width} x {height}");
    }
}
