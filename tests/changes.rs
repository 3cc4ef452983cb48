//! Times of change between instants: the hours must equal those of a study with steps as short as the resolution, and
//! those of closed forms.

mod closed_forms;
mod said;

use gnomon::choice::{Engine, Method, Receivers};
use gnomon::site::typed::resolution_secs;
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, Event, PatchOutcome, StudyError, TiledStudy, Wants, in_tiles, patches};
use gnomon::view::Bits;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

const SITES: [&str; 3] = ["headquarters", "industry", "tower"];
const MINUTES: usize = 60;

/// Parses a resolution that is a duration, in seconds.
fn secs(text: &str) -> Option<u32> {
    Some(resolution_secs(text).expect("a duration"))
}

fn sample(name: &str, asked: Overrides) -> Site {
    Site::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name), &asked).expect("a sample site")
}

/// Sums, and the shadow at each instant.
fn study(site: &Site) -> (Vec<u64>, Vec<Bits>) {
    let mut shadows = Vec::new();
    let outcome = study::run(site, &Wants { bits: true, ..Wants::default() }, &mut |event| {
        if let Event::Drawn { bits: Some(bits), .. } = event {
            shadows.push(bits.clone());
        }
        ControlFlow::Continue(())
    });
    (outcome.expect("hours").profile.shaded.iter().collect(), shadows)
}

/// In how many hours of a study with steps of a minute a cell changes once, and more than once.
fn changes(minutes: &[Bits], cell: usize) -> [usize; 2] {
    let mut hours = [0; 2];
    for first in (0..minutes.len() - 1).step_by(MINUTES) {
        let hour = &minutes[first..=first + MINUTES];
        match hour.windows(2).filter(|pair| pair[0].contains(cell) != pair[1].contains(cell)).count() {
            0 => {}
            1 => hours[0] += 1,
            _ => hours[1] += 1,
        }
    }
    hours
}

/// For each cell, the result between hourly instants equals that of a study by the minute if the technique draws whole
/// masks. If it tests cells singly, they are equal if no hour has more than one change; otherwise the error is at most
/// those hours.
fn are_those_of_minutes(name: &str, asked: &Overrides) {
    let draws_whole = asked.engine == Some(Engine::Gpu) || asked.receivers == Some(Receivers::Ground);
    let of = |step: &str, resolution: &str| {
        sample(name, Overrides { step_secs: secs(step), resolution_secs: secs(resolution), ..asked.clone() })
    };
    let (stepped, minutes) = study(&of("1min", "step"));
    let hourly = of("1h", "1min");
    assert_eq!(minutes.len(), (hourly.track.instants.len() - 1) * MINUTES + 1, "{name}: not one instant is at night");
    let (found, hours) = study(&hourly);
    assert!(
        hours.iter().enumerate().all(|(at, bits)| *bits == minutes[at * MINUTES]),
        "{name}: bits are the instants'"
    );
    let (alone, _) = study(&of("1h", "step"));
    let (mut once, mut often, mut off, mut off_alone) = (0, 0, 0, 0);
    let mut secs_off = [0; 2];
    for cell in 0..stepped.len() {
        let [single, several] = changes(&minutes, cell);
        let differs = |sums: &[u64]| sums[cell].abs_diff(stepped[cell]);
        assert!(differs(&found) <= several as u64 * 3600 * 255, "{name}: cell {cell} is off by more than it can be");
        once += usize::from(single > 0);
        often += usize::from(several > 0);
        off += usize::from(differs(&found) > 0);
        off_alone += usize::from(differs(&alone) > 255 * 60);
        secs_off = [secs_off[0] + differs(&found), secs_off[1] + differs(&alone)];
    }
    assert!(
        once * 20 > stepped.len() && off_alone * 2 > once,
        "{name}: {once} cells change, {off_alone} are off without it"
    );
    assert!(!draws_whole || off == 0, "{name}: {off} cells are off");
    assert!(off <= often, "{name}: {off} cells are off, of {often} that change often");
    let [found, alone] = secs_off;
    assert!(found * 3 < alone * 2, "{name}: cells are off by {found}/255 s in all, by {alone} without it");
}

#[test]
fn hours_are_those_of_a_study_by_the_minute() {
    for name in SITES {
        for receivers in [Receivers::Ground, Receivers::Top] {
            let engine = Some(Engine::Cpu);
            let asked = Overrides { size: Some(100), receivers: Some(receivers), engine, ..Overrides::default() };
            are_those_of_minutes(name, &asked);
        }
    }
}

#[test]
fn every_exact_technique_finds_them() {
    let exact = [
        (Method::RayCast, Engine::Cpu, Receivers::Top),
        (Method::Stencil, Engine::Gpu, Receivers::Top),
        (Method::Projected, Engine::Gpu, Receivers::Ground),
        (Method::Hybrid, Engine::Gpu, Receivers::Top),
    ];
    for (method, engine, receivers) in exact {
        let (technique, engine) = (Some(method), Some(engine));
        let asked = Overrides { size: Some(48), receivers: Some(receivers), technique, engine, ..Overrides::default() };
        are_those_of_minutes("tower", &asked);
    }
}

#[test]
fn work_that_ends_between_two_instants_goes_on_from_the_first_of_them() {
    for receivers in [Receivers::Ground, Receivers::Top] {
        let (receivers, engine) = (Some(receivers), Some(Engine::Cpu));
        let asked = Overrides { size: Some(64), receivers, engine, step_secs: secs("1h"), ..Overrides::default() };
        let site = sample("tower", asked);
        let wants = Wants { keep_every: Some(Duration::from_secs(3600)), ..Wants::default() };
        let prepared = || TiledStudy::new(&site, &wants, &mut |_| ControlFlow::Continue(())).expect("a study");
        let (mut drawn, mut kept) = (0, None);
        let ended = in_tiles(prepared(), None, &mut |event| {
            match event {
                Event::Drawn { .. } => drawn += 1,
                Event::Kept(unfinished) => kept = Some(unfinished.clone()),
                Event::Between if drawn == 2 => return ControlFlow::Break(()),
                _ => {}
            }
            ControlFlow::Continue(())
        });
        assert!(matches!(ended, Err(StudyError::Interrupted)));
        assert_eq!(drawn, 2, "it ends before the third instant");
        let kept = kept.expect("what was done");
        assert_eq!(kept.done, 2);
        let mut summed = None;
        in_tiles(prepared(), Some(kept), &mut |event| {
            if let Event::Summed(shaded) = event {
                summed = Some(shaded);
            }
            ControlFlow::Continue(())
        })
        .expect("hours");
        let summed: Vec<u64> = summed.expect("sums").iter().collect();
        assert!(summed == study(&site).0, "it goes on to the same hours");
    }
}

/// How many texels are off by more than the given seconds.
fn off(one: &PatchOutcome, other: &PatchOutcome, secs: u32) -> usize {
    one.hours.lit.iter().zip(&other.hours.lit).filter(|(one, other)| one.abs_diff(**other) > secs).count()
}

#[test]
fn an_adapter_draws_facades_at_every_moment() {
    let of = |engine: Engine, step: &str, resolution: &str| {
        let site = sample(
            "tower",
            Overrides { step_secs: secs(step), resolution_secs: secs(resolution), ..Overrides::default() },
        );
        let site = Site { receivers: Receivers::Patches, method: Method::SoftTexture, engine, ..site };
        patches(&site, 8.0, &mut |_| ControlFlow::Continue(())).expect("hours")
    };
    let stepped = of(Engine::Gpu, "10min", "step");
    let found = of(Engine::Gpu, "1h", "10min");
    assert_eq!((found.drawn.engine, found.drawn.resolution_secs), (Engine::Gpu, 600));
    assert_eq!(found.hours.lit, stepped.hours.lit, "it misses nothing");
    let on_processor = of(Engine::Cpu, "10min", "step");
    assert!(off(&found, &on_processor, 0) * 20 < found.hours.lit.len());
}
