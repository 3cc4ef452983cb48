//! The sample sites: every way against rays, cell by cell, at three instants.

use super::Scene;
use gnomon::choice::{Engine, Method};
use gnomon::mesh::patches::{DEFAULT_CELL_M, MOST_TEXELS, Patches};
use gnomon::shadow::soft_texture::{Choice, Sample};
use gnomon::site::{Overrides, Site};
use gnomon::study::{PatchOutcome, patches};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// A site's scene with texels of this size in metres, and three of its instants.
fn site(name: &str, cell: f64) -> (Scene, Vec<Sample>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
    let patches = Arc::new(Patches::of(&site.mesh, &site.receives, cell, MOST_TEXELS));
    let casters = site.mesh.of_components(&site.casts);
    let instants: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).collect();
    let chosen = [0, instants.len() / 2, instants.len() - 1].map(|at| instants[at].to_sun.extend(0.0));
    (Scene { casters, patches }, super::weighed(chosen))
}

#[test]
fn the_tower_agrees_with_rays() {
    let (scene, samples) = site("tower", 1.0);
    scene.check(&samples, &[Choice::Texture, Choice::Auto]);
    println!("tower: {} texels differ on the adapter", scene.check_adapter(&samples, Choice::Texture));
}

#[test]
fn the_works_agree_with_rays() {
    let (scene, samples) = site("industry", 1.0);
    scene.check(&samples, &[Choice::Texture, Choice::Auto]);
    println!("industry: {} texels differ on the adapter", scene.check_adapter(&samples, Choice::Texture));
}

#[test]
fn the_headquarters_agree_with_rays() {
    let (scene, samples) = site("headquarters", 2.0);
    scene.check(&samples, &[Choice::Auto]);
    // every patch of 73,000 filled takes a minute; those that are worth it
    let (large, _) = scene.of_patches(|patch| patch.texels.len() >= 40);
    assert!(large.patches.texels.len() > 90_000);
    large.check(&samples, &[Choice::Texture]);
    println!("headquarters: {} texels differ on the adapter", large.check_adapter(&samples, Choice::Texture));
}

fn hours(name: &str, asked: &Overrides) -> PatchOutcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let site = Site::load(&folder, asked).expect("a sample site");
    patches(&site, DEFAULT_CELL_M, &mut |_| ControlFlow::Continue(())).expect("hours")
}

#[test]
fn hours_at_the_default_cell_are_those_of_rays() {
    for name in ["tower", "industry"] {
        let [divided, rays] = [Method::Auto, Method::RayCast].map(|method| {
            hours(name, &Overrides { technique: Some(method), engine: Some(Engine::Cpu), ..Overrides::default() })
        });
        let asked = divided.judged.rays + divided.judged.rectangle_texels;
        assert!(divided.judged.rectangle_texels * 3 > asked, "{name}: {:?}", divided.judged);
        assert_eq!((divided.judged.textures, rays.judged.rectangle_texels), (0, 0));
        assert_eq!(divided.hours.lit.len(), rays.hours.lit.len());
        let differ = divided.hours.lit.iter().zip(&rays.hours.lit).filter(|(one, other)| one != other).count();
        assert_eq!(differ, 0, "{name}: of {} texels", rays.hours.lit.len());
    }
}

#[test]
fn the_headquarters_fit_the_adapter_at_the_default_cell() {
    let at = "2026-09-18T12:00".parse().ok();
    let outcome = hours("headquarters", &Overrides { at, engine: Some(Engine::Gpu), ..Overrides::default() });
    assert_eq!(outcome.patches.cell, DEFAULT_CELL_M);
    println!("{} MiB on the adapter", outcome.gpu_bytes >> 20);
    assert!((1 << 24..1 << 30).contains(&outcome.gpu_bytes), "{} bytes", outcome.gpu_bytes);
}
