//! Beams on the sample sites: every cell equals that of the plain caster, with each instruction set that the machine
//! has.

use glam::DVec3;
use gnomon::shadow::JUDGED_ABOVE_M;
use gnomon::shadow::rays::{PlainCaster, RayCaster, Shear, SimdLevel};
use gnomon::site::{Overrides, Site};

/// Cells along a side of the squares that are traced at once.
const SIDE: u32 = 8;

#[test]
fn beams_on_the_sites_agree_with_plain_rays() {
    for name in ["tower", "industry", "headquarters"] {
        let asked = Overrides { size: Some(256), ..Overrides::default() };
        let site = Site::load(std::path::Path::new(&format!("sites/{name}")), &asked).unwrap();
        let mesh = site.mesh.of_components(&site.casts);
        let plain = PlainCaster::new(&mesh, 2000.0);
        let levels = SimdLevel::all();
        let casters: Vec<RayCaster> = levels.iter().map(|&level| RayCaster::new(&mesh, 2000.0).on(level)).collect();
        let top = mesh.top() + 1.0;
        let mut found = [0; 2];
        let suns = site.track.instants.iter().filter(|instant| !instant.night).step_by(3);
        for to_sun in suns.map(|instant| instant.to_sun) {
            let shear = Shear::along(to_sun);
            for (first_row, first_column) in squares(site.grid.width, site.grid.height) {
                let above = |at: u32| {
                    let centre = site.grid.centre(first_column + at % SIDE, first_row + at / SIDE);
                    centre.extend(top) - mesh.origin
                };
                let above: Vec<DVec3> = (0..SIDE * SIDE).map(above).collect();
                let seen: Vec<_> = above.iter().map(|&above| plain.first_hit(above, DVec3::NEG_Z)).collect();
                // on what is seen, or on the ground, and a storey below it
                let judged = |(above, seen): (&DVec3, &Option<(u32, f64)>)| {
                    let depth = seen.map_or(top - site.ground.level, |(_, depth)| depth);
                    [0.0, 3.0].map(|lower| *above - DVec3::Z * (depth - JUDGED_ABOVE_M + lower))
                };
                let origins: Vec<DVec3> = above.iter().zip(&seen).flat_map(judged).collect();
                let expected: Vec<bool> = origins.iter().map(|&origin| plain.blocked(origin, to_sun)).collect();
                for (caster, level) in casters.iter().zip(&levels) {
                    let mut hits = [None; 64];
                    caster.first_hits(&above, &Shear::along(DVec3::NEG_Z), &mut hits);
                    assert_eq!(hits[..], seen, "{name}, {level:?}: seen from above");
                    for (origins, expected) in origins.chunks(64).zip(expected.chunks(64)) {
                        let blocked = caster.blocked_beam(origins, &shear);
                        let said: Vec<bool> = (0..origins.len()).map(|at| blocked >> at & 1 == 1).collect();
                        assert_eq!(said, expected, "{name}, {level:?}, sun at {to_sun}");
                    }
                }
                let hit = expected.iter().filter(|blocked| **blocked).count();
                found = [found[0] + hit, found[1] + expected.len() - hit];
            }
        }
        assert!(found[0] > 1_000 && found[1] > 10_000, "{name}: {found:?}");
    }
}

/// Where squares begin that are spread over a plan and cover a third of it.
fn squares(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    let of_row = move |row: u32| (0..width / SIDE).map(move |column| (row, column));
    let all = (0..height / SIDE).flat_map(of_row);
    all.filter(|(row, column)| (row + column) % 3 == 0).map(|(row, column)| (row * SIDE, column * SIDE))
}
