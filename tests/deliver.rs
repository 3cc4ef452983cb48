//! Results as a program that uses the library gets them: in memory the same as in a folder, and resumed after a stop.

use crate::shared::program::site;
use gnomon::choice::{Engine, Receivers};
use gnomon::deliver::comparison::{comparison, find_comparison};
use gnomon::deliver::disk::workplace::Workplace;
use gnomon::deliver::instant::{InstantRequest, Show, instant};
use gnomon::deliver::lines::Lines;
use gnomon::deliver::patches::{PatchesRequest, find_patches, patches};
use gnomon::deliver::probe::{ProbeRequest, probe};
use gnomon::deliver::profile::{ProfileAnswer, ProfileRequest, find_hours, profile};
use gnomon::deliver::volumes::volumes;
use gnomon::deliver::{Folder, NamedFile, Sink, WrittenFiles};
use gnomon::site::{Overrides, Pair, Site, load_probes};
use gnomon::study::{Event, Stopwatch};
use gnomon::view::View;
use std::collections::BTreeMap;
use std::ops::ControlFlow::{self, Break, Continue};
use std::path::{Path, PathBuf};

fn loaded(folder: &Path, step: &str) -> Site {
    let step_secs = gnomon::sun::parse_duration_secs(step).ok();
    let asked = Overrides { engine: Some(Engine::Cpu), size: Some(150), step_secs, ..Overrides::default() };
    Site::load(folder, &asked).unwrap()
}

fn inside(path: &Path) -> Folder<'_> {
    Folder { path, who: "a test", inputs: &[] }
}

/// The files of a folder by name, without timings, which differ each time.
fn comparable(files: impl Iterator<Item = NamedFile>) -> BTreeMap<PathBuf, Vec<u8>> {
    let timeless = |bytes: Vec<u8>| {
        let mut report: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        report.as_object_mut().unwrap().remove("timings_secs").unwrap();
        serde_json::to_vec(&report).unwrap()
    };
    let file = |(path, bytes): NamedFile| {
        let is_report = path.extension().is_some_and(|is| is == "json");
        (PathBuf::from(path.file_name().unwrap()), if is_report { timeless(bytes) } else { bytes })
    };
    files.map(file).collect()
}

fn read(folder: &Path) -> impl Iterator<Item = NamedFile> {
    let paths = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
    paths.filter(|path| path.is_file()).map(|path| (path.clone(), std::fs::read(path).unwrap()))
}

/// Everything that is written to a folder can also be returned in memory, the same to the byte, both for a whole plan
/// and for tiles.
#[test]
fn memory_holds_what_a_folder_gets() {
    let folder = site();
    let site = loaded(folder.path(), "1h");
    let (out, masks) = (folder.path().join("out"), folder.path().join("masks"));
    let of = |asked: &ProfileRequest<'_>, sink: Sink<'_>| -> (ProfileAnswer, usize) {
        let mut tiles = 0;
        let answer = profile(&site, asked, sink, &mut |event| {
            if let Event::Started { tiles: count, .. } = event {
                tiles = count;
            }
            Continue(())
        });
        (answer.unwrap(), tiles)
    };
    let all = ProfileRequest {
        drawing: true,
        raster: true,
        report: true,
        bits: true,
        ..ProfileRequest::of(Stopwatch::start())
    };
    let whole = ProfileRequest { lines: &[Lines::Hours, Lines::Outlines], masks: Some(&masks), ..all.clone() };
    let in_tiles = ProfileRequest { memory: Some(500 << 10), ..all };
    for (asked, is_in_tiles) in [(whole, false), (in_tiles, true)] {
        let (by_folder, tiles) = of(&asked, Sink::Folder(inside(&out)));
        assert_eq!(tiles > 1, is_in_tiles, "{tiles} tiles");
        let (by_memory, _) = of(&asked, Sink::Memory);
        let mut written = comparable(read(&out));
        if let Some(masks) = asked.masks {
            written.extend(comparable(read(masks)));
        }
        let held = comparable(by_memory.written.files.into_iter());
        assert_eq!(held.keys().collect::<Vec<_>>(), written.keys().collect::<Vec<_>>());
        assert!(held == written, "a file is another one");
        assert!(held.contains_key(Path::new("shadow.bits")) && held.len() >= 4, "{:?}", held.keys());
        assert_eq!((by_memory.range, by_memory.masks), (by_folder.range, by_folder.masks));
        std::fs::remove_dir_all(&out).unwrap();
    }
}

/// Hours for display continue where they were stopped; if another study is using the shelf, they are still found.
#[test]
fn hours_go_on_from_their_shelf() {
    let folder = site();
    let site = loaded(folder.path(), "10min");
    let shelf = folder.path().join("studies");
    let asked = ProfileRequest::of(Stopwatch::start());
    let mut drawn = 0;
    let mut find = |most: usize, shelf: Option<Folder<'_>>| {
        drawn = 0;
        let hours = find_hours(&site, &asked, shelf, &mut |event| -> ControlFlow<()> {
            drawn += usize::from(matches!(event, Event::Drawn { .. }));
            if drawn < most { Continue(()) } else { Break(()) }
        });
        (hours.map(|hours| hours.shaded().unwrap().clone()), drawn)
    };
    let (whole, count) = find(usize::MAX, None);
    assert!(count > 10, "{count} instants");
    let (stopped, _) = find(7, Some(inside(&shelf)));
    assert!(stopped.is_err_and(|error| error.is_interrupted()));
    assert_eq!(read(&shelf).count(), 1, "what is done is kept, and nothing is locked");
    let locked = Workplace::take([shelf.as_path()], &[], "somebody").unwrap();
    let (beside, drawn) = find(usize::MAX, Some(inside(&shelf)));
    assert_eq!(drawn, count, "all is found again while somebody works there");
    drop(locked);
    let (gone_on, drawn) = find(usize::MAX, Some(inside(&shelf)));
    assert_eq!(drawn, count - 7);
    let whole = whole.unwrap();
    assert!(*whole == *gone_on.unwrap() && *whole == *beside.unwrap());
    assert_eq!(read(&shelf).count(), 0, "nothing stays of a study that is done");
}

/// So do hours with the shadow of each instant, from which outlines are drawn.
#[test]
fn outlines_go_on_from_their_shelf() {
    let folder = site();
    let site = loaded(folder.path(), "15min");
    let shelf = folder.path().join("studies");
    let asked = ProfileRequest { bits: true, ..ProfileRequest::of(Stopwatch::start()) };
    let mut drawn = 0;
    let mut notes = Vec::new();
    let mut find = |most: usize, shelf: Option<Folder<'_>>| {
        drawn = 0;
        let hours = find_hours(&site, &asked, shelf, &mut |event| -> ControlFlow<()> {
            if let Event::Note(note) = &event {
                notes.push(note.to_string());
            }
            drawn += usize::from(matches!(event, Event::Drawn { .. }));
            if drawn < most { Continue(()) } else { Break(()) }
        });
        let both = |hours: gnomon::deliver::profile::Hours| {
            let outlines: Vec<_> = hours.outlines.iter().map(|one| (one.index, one.shadow.clone())).collect();
            (hours.shaded().unwrap().clone(), outlines)
        };
        (hours.map(both), drawn)
    };
    let (whole, count) = find(usize::MAX, None);
    let (shaded, outlines) = whole.unwrap();
    assert_eq!((count, outlines.len()), (9, 9));
    assert!(outlines.iter().any(|(_, shadow)| shadow.words.iter().any(|word| *word != 0)));
    let (stopped, _) = find(4, Some(inside(&shelf)));
    assert!(stopped.is_err_and(|error| error.is_interrupted()));
    assert_eq!(read(&shelf).count(), 2, "the sums and the bits are kept");
    let (gone_on, drawn) = find(usize::MAX, Some(inside(&shelf)));
    assert_eq!(drawn, count - 4);
    let gone_on = gone_on.unwrap();
    assert!(*gone_on.0 == *shaded && gone_on.1 == outlines);
    assert_eq!(read(&shelf).count(), 0, "nothing stays of a study that is done");
    assert!(!notes.iter().any(|note| note.contains("shadow.bits")), "{notes:?}");
}

/// So do hours of sun on patches; and in the command's folder.
#[test]
fn patches_go_on_from_where_they_were_stopped() {
    let folder = site();
    let site = Site { receivers: Receivers::Patches, patch_cell: 4.0, ..loaded(folder.path(), "10min") };
    let (shelf, out) = (folder.path().join("studies"), folder.path().join("out"));
    let mut drawn = 0;
    let mut find = |most: usize, shelf: Option<Folder<'_>>| {
        drawn = 0;
        let outcome = find_patches(&site, shelf, &mut |event| -> ControlFlow<()> {
            drawn += usize::from(matches!(event, Event::Drawn { .. }));
            if drawn < most { Continue(()) } else { Break(()) }
        });
        (outcome.map(|outcome| outcome.hours), drawn)
    };
    let (whole, count) = find(usize::MAX, None);
    let whole = whole.unwrap();
    assert!(count > 10 && whole.lit.iter().any(|lit| *lit > 0), "{count} instants");
    assert!(find(7, Some(inside(&shelf))).0.is_err_and(|error| error.is_interrupted()));
    assert_eq!(read(&shelf).count(), 1, "what is done is kept, and nothing is locked");
    // a byte of it is another
    let (kept, right) = read(&shelf).next().unwrap();
    let mut wrong = right.clone();
    wrong[right.len() / 2] ^= 4;
    std::fs::write(&kept, wrong).unwrap();
    let (anew, drawn) = find(usize::MAX, Some(inside(&shelf)));
    assert_eq!((anew.unwrap(), drawn), (whole.clone(), count), "what is damaged is not gone on with");
    std::fs::write(&kept, right).unwrap();
    let (gone_on, drawn) = find(usize::MAX, Some(inside(&shelf)));
    assert_eq!((gone_on.unwrap(), drawn), (whole, count - 7));
    assert_eq!(read(&shelf).count(), 0, "nothing stays of a study that is done");

    let all = PatchesRequest::all(Stopwatch::start());
    let files = patches(&site, &all, Sink::Memory, &mut |_| Continue(())).unwrap().written.files;
    let mut drawn = 0;
    let stopped = patches(&site, &all, Sink::Folder(inside(&out)), &mut |event| {
        drawn += usize::from(matches!(event, Event::Drawn { .. }));
        if drawn < 5 { Continue(()) } else { Break(()) }
    });
    assert!(stopped.is_err_and(|error| error.is_interrupted()));
    let mut went_on = 0;
    patches(&site, &all, Sink::Folder(inside(&out)), &mut |event| {
        if let Event::GoesOn { done } = event {
            went_on = done;
        }
        Continue(())
    })
    .unwrap();
    assert_eq!(went_on, 5);
    assert!(comparable(read(&out)) == comparable(files.into_iter()), "a file is another one");
}

/// A comparison continues in the state in which it was stopped.
#[test]
fn comparison_goes_on_from_where_it_was_stopped() {
    let folder = site();
    let path = folder.path();
    let step_secs = Some(600);
    let asked = Overrides { engine: Some(Engine::Cpu), size: Some(100), step_secs, ..Overrides::default() };
    let mut pair = Pair::load(path, path, &asked).unwrap();
    pair.before.casts.fill(false);
    let shelf = path.join("studies");
    let mut drawn = 0;
    let mut find = |most: usize, shelf: Option<Folder<'_>>| {
        drawn = 0;
        let outcome = find_comparison(&pair, None, shelf, &mut |event| -> ControlFlow<()> {
            drawn += usize::from(matches!(event, Event::Drawn { .. }));
            if drawn < most { Continue(()) } else { Break(()) }
        });
        let both = outcome.map(|outcome| [outcome.comparison.before().clone(), outcome.comparison.after().clone()]);
        (both, drawn)
    };
    let (whole, count) = find(usize::MAX, None);
    let whole = whole.unwrap();
    assert!(count > 20 && whole[0].shaded != whole[1].shaded, "{count} instants of both");
    for stops_after in [4, count / 2 + 3] {
        assert!(find(stops_after, Some(inside(&shelf))).0.is_err_and(|error| error.is_interrupted()));
        assert_eq!(read(&shelf).count(), 1, "the state that was worked on is kept");
        let (gone_on, drawn) = find(usize::MAX, Some(inside(&shelf)));
        let kept = if stops_after > count / 2 { stops_after - count / 2 } else { stops_after };
        assert_eq!(drawn, count - kept);
        assert!(gone_on.unwrap() == whole);
        assert_eq!(read(&shelf).count(), 0, "nothing stays of a comparison that is done");
    }
}

/// The shelf is for stopped work: if nothing can be kept on it, hours are still found, and a message says so.
#[test]
fn shelf_that_cannot_be_used_stops_no_study() {
    let folder = site();
    let site = loaded(folder.path(), "20min");
    let shelf = folder.path().join("studies");
    let asked = ProfileRequest::of(Stopwatch::start());
    let whole = find_hours(&site, &asked, None, &mut |_| Continue(())).unwrap();
    let stopped = find_hours(&site, &asked, Some(inside(&shelf)), &mut |event| match event {
        Event::Drawn { .. } => Break(()),
        _ => Continue(()),
    });
    assert!(stopped.is_err_and(|error| error.is_interrupted()));
    // where its file would lie there is a folder
    let [file] = read(&shelf).map(|(path, _)| path).collect::<Vec<_>>().try_into().unwrap();
    std::fs::remove_file(&file).unwrap();
    std::fs::create_dir(&file).unwrap();
    let mut notes = Vec::new();
    let found = find_hours(&site, &asked, Some(inside(&shelf)), &mut |event| {
        if let Event::Note(note) = event {
            notes.push(note.to_string());
        }
        Continue(())
    });
    assert!(found.unwrap().shaded() == whole.shaded());
    assert!(notes.iter().any(|note| note.ends_with("what is done is not kept")), "{notes:?}");
}

/// Of stopped studies the newest are kept.
#[test]
fn shelf_holds_so_many_studies() {
    let folder = site();
    let shelf = folder.path().join("studies");
    for step in ["10min", "11min", "12min", "13min", "14min", "15min"] {
        let site = loaded(folder.path(), step);
        let mut drawn = 0;
        let _ = find_hours(&site, &ProfileRequest::of(Stopwatch::start()), Some(inside(&shelf)), &mut |event| {
            drawn += usize::from(matches!(event, Event::Drawn { .. }));
            if drawn < 3 { Continue(()) } else { Break(()) }
        });
    }
    assert_eq!(read(&shelf).count(), 4);
}

/// Makes a deliverable.
type Write<'a> = &'a dyn Fn(Sink<'_>) -> WrittenFiles;

/// The same holds for all other deliverables except the animation, whose GIF is made of files.
#[test]
fn every_deliverable_goes_into_memory() {
    let folder = site();
    let path = folder.path();
    let site = loaded(path, "1h");
    let watch = Stopwatch::start();
    let camera = Site { receivers: Receivers::Patches, ..site.clone() };
    let pair = Pair::load(path, path, &Overrides { engine: Some(Engine::Cpu), size: Some(60), ..Overrides::default() });
    let pair = pair.unwrap();
    let point = Overrides { point: Some(glam::dvec3(12.0, -3.0, 4.5)), ..Overrides::default() };
    let probing = load_probes(path, &point).unwrap();
    let [one, other, third, of_volumes, sky] =
        ["one.png", "other.png", "third.csv", "volumes.glb", "sky.svg"].map(|name| path.join(name));
    let of_instant = InstantRequest {
        view: View::Plan(site.grid),
        drawing: Some(one.clone()),
        mask: Some(other.clone()),
        show: Show::default(),
        statistics: false,
        watch: watch.clone(),
    };
    let of_probe = ProbeRequest {
        drawing: Some(one),
        table: Some(other),
        totals: Some(third),
        sky: Some(sky),
        ..ProbeRequest::default()
    };
    let all = PatchesRequest::all(watch.clone());
    let on_event = |_: Event<'_>| Continue(());
    let of_one = |sink: Sink<'_>| instant(&site, &of_instant, sink, &mut on_event.clone()).unwrap().written;
    let of_points = |sink: Sink<'_>| probe(&probing, &of_probe, sink, &mut on_event.clone()).unwrap().written;
    let of_solids = |sink: Sink<'_>| volumes(&site, &of_volumes, sink, &mut on_event.clone()).unwrap().written;
    let of_walls = |sink: Sink<'_>| patches(&camera, &all, sink, &mut on_event.clone()).unwrap().written;
    let of_both = |sink: Sink<'_>| comparison(&pair, watch.clone(), sink, &mut on_event.clone()).unwrap().written;
    let out = path.join("out");
    let (files, folder) = (Sink::Paths { inputs: &[] }, Sink::Folder(inside(&out)));
    let deliverables: [(Write<'_>, Sink<'_>, usize); 5] = [
        (&of_one, files, 2),
        (&of_points, files, 4),
        (&of_solids, files, 1),
        (&of_walls, folder, 4),
        (&of_both, folder, 3),
    ];
    for (write, sink, count) in deliverables {
        let paths = write(sink).paths;
        let written = comparable(paths.into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())));
        let held = comparable(write(Sink::Memory).files.into_iter());
        assert_eq!(held.keys().collect::<Vec<_>>(), written.keys().collect::<Vec<_>>());
        assert!(held == written && held.len() == count, "{:?}", held.keys());
    }
}

/// A given instant is the one that is reported, even if clocks show that time twice.
#[test]
fn known_time_is_the_one_that_is_written() {
    let folder = site();
    for at in ["2026-06-21T13:00", "2026-10-25T02:30+01:00", "2026-10-25T02:30+02:00"] {
        let written = Overrides { at: at.parse().ok(), ..Overrides::default() };
        let written = Site::load(folder.path(), &written).unwrap();
        let instant = Some(written.track.instants[0].time);
        let known = Site::load(folder.path(), &Overrides { instant, ..Overrides::default() }).unwrap();
        assert_eq!(known.track, written.track, "{at}");
        assert_eq!(known.grid, written.grid, "{at}");
    }
}
