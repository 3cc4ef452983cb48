//! Rays from rectangles of texels: the same texels as by rays one by one, at a cost that does not depend on components.

use super::{Scene, differing, weighed};
use crate::shared::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::mesh::Part;
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, PatchJudgements, Sample, SoftTexture};
use std::sync::Arc;

/// A quarter of houses of different heights.
fn houses() -> Vec<Part> {
    let house = |at: u32| {
        let low = dvec3(f64::from(at % 20) * 12.0, f64::from(at / 20) * 12.0, 0.0);
        cuboid(&format!("house {at}"), low, low + dvec3(6.0, 7.0, 4.0 + f64::from(at * 7 % 11)))
    };
    (0..400).map(house).collect()
}

fn suns() -> Vec<Sample> {
    let suns = [dvec3(0.5, -0.6, 0.4), dvec3(0.05, -0.9, 0.3), dvec3(-0.8, -0.3, 0.1)];
    weighed(suns.map(|sun: DVec3| sun.normalize().extend(0.0)))
}

/// The sums of texels, and how they were found.
fn judged(parts: Vec<Part>, choice: Choice) -> (Vec<u32>, PatchJudgements) {
    let scene = Scene::of(parts, 0.5);
    let painter = Painter::OnProcessor(Fill::Silhouettes);
    let mut texture = SoftTexture::new(scene.casters.clone(), Arc::clone(&scene.patches), painter, choice).unwrap();
    texture.add(&suns()).unwrap();
    let judged = texture.judged();
    (texture.finish().unwrap(), judged)
}

#[test]
fn rectangles_find_what_rays_find() {
    let (rays, by_rays) = judged(houses(), Choice::Rays);
    let (divided, by_rectangles) = judged(houses(), Choice::Auto);
    assert_eq!(differing(&rays, &divided), Vec::<usize>::new());
    assert_eq!(by_rectangles.rays + by_rectangles.rectangle_texels, by_rays.rays);
    assert!(by_rectangles.rays * 10 < by_rays.rays * 9, "{by_rectangles:?}");
    // some texels see every sun that their patch faces, and some see none
    assert!([0, 0b111].iter().all(|sum| rays.contains(sum)));
}

#[test]
fn components_cost_no_more_than_one_with_as_many_faces() {
    let houses = houses();
    let mut together = Part { name: "houses".into(), ..Part::default() };
    for house in &houses {
        let base = together.positions.len() as u32;
        together.positions.extend(&house.positions);
        together.triangles.extend(house.triangles.iter().map(|triangle| triangle.map(|corner| corner + base)));
    }
    let (many, of_many) = judged(houses, Choice::Auto);
    let (one, of_one) = judged(vec![together], Choice::Auto);
    // their patches are in another order
    let tally = |sums: &[u32]| (0..8).map(|sum| sums.iter().filter(|it| **it == sum).count()).collect::<Vec<_>>();
    assert_eq!(tally(&many), tally(&one));
    // which block is tried first depends on who judged what before
    assert!(of_many.rays * 20 <= of_one.rays * 21, "{of_many:?}, of one component {of_one:?}");
    assert_eq!(of_many.rays + of_many.rectangle_texels, of_one.rays + of_one.rectangle_texels);
}
