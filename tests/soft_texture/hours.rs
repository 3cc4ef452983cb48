//! Hours on patches: the study, on each machine and with each technique.

use crate::shared::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::choice::{Engine, Finder, Method};
use gnomon::cli::Options;
use gnomon::mesh::Mesh;
use gnomon::message::Worded;
use gnomon::site::{Overrides, Site};
use gnomon::study::{Event, PatchOutcome, StudyError, patches};
use std::ops::ControlFlow;
use std::path::Path;

/// The tower's site with other things on it, all of which cast and receive.
fn site(parts: Vec<gnomon::mesh::Part>) -> Site {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/tower");
    // what is expected is of the instants
    let asked = Overrides { resolution_secs: Some(0), ..Overrides::default() };
    let mut site = Site::load(&folder, &asked).expect("a sample site");
    site.mesh = Mesh::build(parts).expect("a mesh");
    site.casts = vec![true; site.mesh.components.len()];
    site.receives = site.casts.clone();
    site
}

pub(super) fn house() -> Site {
    site(vec![
        cuboid("house", dvec3(-5.0, -4.0, -2.0), dvec3(5.0, 4.0, 6.0)),
        cuboid("tree", dvec3(2.0, -9.0, 0.0), dvec3(3.0, -8.0, 7.0)),
    ])
}

fn asked(site: &Site, cell: f64) -> (PatchOutcome, Vec<String>) {
    let mut notes = Vec::new();
    let outcome = patches(site, cell, &mut |event| {
        if let Event::Note(note) = event {
            notes.push(note.to_string());
        }
        ControlFlow::Continue(())
    });
    (outcome.expect("hours"), notes)
}

#[test]
fn every_machine_and_technique_finds_the_same_hours() {
    let mut site = house();
    let (auto, notes) = asked(&site, 0.5);
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!((auto.drawn.technique, auto.drawn.finder), (Method::SoftTexture, None));
    site.method = Method::RayCast;
    let (rays, _) = asked(&site, 0.5);
    assert_eq!((rays.drawn.technique, rays.judged.textures), (Method::RayCast, 0));
    assert_eq!(auto.hours, rays.hours);
    (site.method, site.engine) = (Method::SoftTexture, Engine::Cpu);
    let (filled, _) = asked(&site, 0.5);
    assert_eq!((filled.hours.clone(), filled.drawn.engine, filled.gpu_bytes), (auto.hours, Engine::Cpu, 0));
    site.engine = Engine::Gpu;
    let (drawn, _) = asked(&site, 0.5);
    assert_eq!(drawn.drawn.engine, Engine::Gpu);
    assert!(drawn.drawn.adapter.is_some() && drawn.gpu_bytes > 0);
    let differing = super::differing(&filled.hours.lit, &drawn.hours.lit).len();
    assert!(differing * 100 < filled.hours.lit.len(), "{differing} texels");
}

#[test]
fn a_free_wall_has_the_sun_while_it_stands_before_it_and_the_underground_never() {
    let site = site(vec![cuboid("house", dvec3(-5.0, -4.0, -2.0), dvec3(5.0, 4.0, 6.0))]);
    let (found, _) = asked(&site, 0.5);
    let mut underground = 0;
    for patch in &found.patches.list {
        let by_day = site.track.instants.iter().filter(|it| !it.night && it.to_sun.dot(patch.normal()) > 0.0);
        let seconds: u32 = by_day.map(|instant| instant.weight_secs).sum();
        for at in patch.texels.start as usize..patch.texels.end as usize {
            let point = found.patches.point(patch, found.patches.texels[at]) + found.patches.origin;
            let expected = if point.z < 0.0 { 0 } else { seconds };
            underground += u32::from(point.z < 0.0 && seconds > 0);
            assert_eq!(found.hours.lit[at], expected, "at {point}");
        }
    }
    assert!(underground > 0);
    assert_eq!(found.hours.day_secs, 4 * 3600);
    let roof = found.patches.list.iter().find(|patch| patch.normal().z > 0.5).expect("a roof");
    let of_roof = found.hours.of_patch(roof);
    assert_eq!((of_roof.hours_mean, of_roof.hours_min, of_roof.shares), (4.0, 4.0, [1.0; 4]));
}

#[test]
fn the_disc_softens_hours_and_keeps_whole_ones() {
    let mut site = house();
    let (hard, _) = asked(&site, 0.5);
    site.settings.sun_samples = Some(16);
    let (soft, _) = asked(&site, 0.5);
    assert_eq!(soft.hours.samples, 16);
    let hours = |of: &PatchOutcome| (0..of.hours.lit.len()).map(|at| of.hours.hours(at)).collect::<Vec<_>>();
    let (hard, soft) = (hours(&hard), hours(&soft));
    assert!(soft.iter().any(|hours| (hours * 2.0).fract() != 0.0), "some texel lies in a penumbra");
    let off = hard.iter().zip(&soft).filter(|(hard, soft)| (*hard - *soft).abs() > 0.5).count();
    assert!(off * 20 < hard.len(), "{off} of {} hours differ by more than one instant", hard.len());
    let (darkest, sunniest) =
        (|all: &[f64]| all.iter().copied().fold(9.0, f64::min), |all: &[f64]| all.iter().copied().fold(0.0, f64::max));
    assert_eq!((darkest(&hard), sunniest(&hard)), (darkest(&soft), sunniest(&soft)));
}

#[test]
fn what_does_not_fit_is_told_and_listeners_may_stop() {
    let refused = |change: fn(&mut Site), word: &str| {
        let mut site = house();
        change(&mut site);
        let error = patches(&site, 0.5, &mut |_| ControlFlow::Continue(())).expect_err("a conflict");
        assert!(error.in_words(&Options).contains(word), "{error}");
        error
    };
    assert!(refused(|site| site.method = Method::Stencil, "soft-texture or ray-cast").is_wrong_use());
    assert!(refused(|site| site.settings.map_size = Some(512), "map-size: ").is_wrong_use());
    assert!(refused(|site| site.finder = Finder::Brute, "silhouette: ").is_wrong_use());
    assert!(refused(|site| (site.method, site.engine) = (Method::RayCast, Engine::Gpu), "engine: ").is_wrong_use());
    assert!(!refused(|site| site.receives = vec![false; 2], "receives").is_wrong_use());
    let mut drawn = 0;
    let stopped = patches(&house(), 0.5, &mut |event| {
        drawn += u32::from(matches!(event, Event::Drawn { .. }));
        if drawn == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted)));
}

#[test]
fn sheets_and_larger_texels_are_told() {
    let mut wall = cuboid("wall", DVec3::ZERO, dvec3(9.0, 0.1, 3.0));
    wall.triangles.truncate(5);
    wall.triangles.drain(..4);
    let (_, notes) = asked(&site(vec![wall]), 0.5);
    assert!(notes.len() == 1 && notes[0].contains("1 of 1 patches"), "{notes:?}");
    let (found, notes) = asked(&site(vec![cuboid("lawn", DVec3::ZERO, dvec3(3000.0, 2000.0, 1.0))]), 0.25);
    assert!(found.patches.cell > 0.5 && notes.len() == 1 && notes[0].contains("0.25 m"), "{notes:?}");
}
