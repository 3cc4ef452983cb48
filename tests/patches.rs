//! Faces gathered into flat patches: all faces are kept, holes respected, the outer side judged, and texels placed
//! correctly.

use crate::shared::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::mesh::patches::{DEFAULT_CELL_M, FLAT_M, MOST_TEXELS, Patch, Patches};
use gnomon::mesh::{Mesh, Part};
use gnomon::site::{Overrides, Site};
use gnomon::sunlight::PatchHours;
use std::path::Path;

fn patches(parts: Vec<Part>, cell: f64) -> (Mesh, Patches) {
    let mesh = Mesh::build(parts).expect("a mesh");
    let receives = vec![true; mesh.components.len()];
    let patches = Patches::of(&mesh, &receives, cell, MOST_TEXELS);
    whole(&mesh, &receives, &patches);
    (mesh, patches)
}

/// Every face with an area is in exactly one patch of its component, in its plane; texels do not lie over each other.
fn whole(mesh: &Mesh, receives: &[bool], patches: &Patches) {
    let mut count = vec![0; mesh.faces.len()];
    let mut taken = vec![false; (patches.page_size * patches.page_size * patches.pages) as usize];
    for patch in &patches.list {
        let faces = &patches.faces[patch.faces.start as usize..patch.faces.end as usize];
        for &face in faces {
            count[face as usize] += 1;
            assert!(mesh.components[patch.component as usize].faces.contains(&face));
            for corner in mesh.corners(face as usize) {
                let off = patch.plane.dot(corner.as_dvec3().extend(1.0)).abs();
                assert!(off <= FLAT_M + 1e-9, "a corner lies {off} m off its patch");
                let [x, y] = patches.in_page(patch, corner.as_dvec3());
                let within = |at: f64, first: u32, count: u32| {
                    at >= f64::from(first) - 1e-3 && at <= f64::from(first + count) + 1e-3
                };
                assert!(within(x, patch.x, patch.width) && within(y, patch.y, patch.height), "({x}, {y})");
            }
        }
        assert!(!patch.texels.is_empty(), "a patch has no texel");
        for row in patch.y..patch.y + patch.height {
            for column in patch.x..patch.x + patch.width {
                let at = (patch.page * patches.page_size + row) * patches.page_size + column;
                assert!(!std::mem::replace(&mut taken[at as usize], true), "two patches share a texel");
            }
        }
        for texel in &patches.texels[patch.texels.start as usize..patch.texels.end as usize] {
            let point = patches.point(patch, *texel);
            assert!(patch.plane.dot(point.extend(1.0)).abs() < 1e-9 * (1.0 + point.length()));
            assert!(faces.iter().any(|&face| holds(mesh, face, patch, point)), "{point} lies in no face");
        }
    }
    for (face, count) in count.into_iter().enumerate() {
        let component = mesh.components.iter().position(|it| it.faces.contains(&(face as u32))).expect("a component");
        let has_area = mesh.planes()[face] != glam::DVec4::ZERO;
        assert_eq!(count, u32::from(receives[component] && has_area), "face {face}");
    }
}

fn holds(mesh: &Mesh, face: u32, patch: &Patch, point: DVec3) -> bool {
    let [a, b, c] = mesh.corners(face as usize).map(|corner| corner.as_dvec3());
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| patch.normal().dot((to - from).cross(point - from)));
    let slack = 1e-9 * (1.0 + sides.iter().fold(0.0f64, |most, side| most.max(side.abs())));
    sides.iter().all(|&side| side >= -slack) || sides.iter().all(|&side| side <= slack)
}

fn turned(mut part: Part) -> Part {
    part.triangles.iter_mut().for_each(|triangle| triangle.reverse());
    part
}

/// The patch that looks along a direction and lies farthest that way.
fn towards(patches: &Patches, along: DVec3) -> &Patch {
    let looks = |patch: &&Patch| patch.normal().dot(along) > 0.99;
    let found = patches.list.iter().filter(looks).max_by(|a, b| (-a.plane.w).total_cmp(&-b.plane.w));
    found.unwrap_or_else(|| panic!("no patch looks along {along}"))
}

#[test]
fn a_box_has_six_patches_that_look_outwards_however_it_is_wound() {
    let plain = cuboid("box", dvec3(0.0, 0.0, 0.0), dvec3(8.0, 6.0, 4.0));
    let mut mixed = plain.clone();
    mixed.triangles.iter_mut().step_by(3).for_each(|triangle| triangle.reverse());
    for part in [plain.clone(), turned(plain), mixed] {
        let (_, patches) = patches(vec![part], 0.5);
        assert_eq!(patches.list.len(), 6);
        for patch in &patches.list {
            assert!(!patch.two_sided);
            assert!(patch.plane.dot(dvec3(0.0, 0.0, 0.0).extend(1.0)) < 0.0, "{:?} looks inwards", patch.plane);
            assert_eq!(patch.texels.len() as u32, patch.width * patch.height);
        }
        let south = towards(&patches, DVec3::NEG_Y);
        assert_eq!((south.width, south.height), (16, 8));
        assert!((south.right - DVec3::X).length() < 1e-12 && (south.down - DVec3::NEG_Z).length() < 1e-12);
        assert_eq!(south.azimuth_deg().map(f64::round), Some(180.0));
        assert_eq!(south.tilt_deg(), 90.0);
        let west = towards(&patches, DVec3::NEG_X);
        assert_eq!(west.azimuth_deg().map(f64::round), Some(270.0));
        assert!((west.right - DVec3::NEG_Y).length() < 1e-12, "seen from the west, south is to the right");
        let roof = towards(&patches, DVec3::Z);
        assert!((roof.right - DVec3::X).length() < 1e-6 && (roof.down - DVec3::NEG_Y).length() < 1e-6);
        assert_eq!((roof.tilt_deg(), roof.azimuth_deg()), (0.0, None));
    }
}

#[test]
fn what_a_solid_holds_is_a_room_or_stands_in_its_court_and_beside_it_is_a_solid() {
    let shell = cuboid("house", dvec3(0.0, 0.0, 0.0), dvec3(8.0, 6.0, 4.0));
    let room = turned(cuboid("house", dvec3(1.0, 1.0, 1.0), dvec3(7.0, 5.0, 3.0)));
    let mut part = shell.clone();
    let base = part.positions.len() as u32;
    part.positions.extend(room.positions);
    part.triangles.extend(room.triangles.iter().map(|triangle| triangle.map(|corner| corner + base)));
    for part in [part.clone(), turned(part)] {
        let (_, patches) = patches(vec![part], 0.5);
        let of_both: f64 = patches.list.iter().filter(|it| it.two_sided).map(|it| it.area_m2).sum();
        assert!((of_both - 2.0 * (24.0 + 12.0 + 8.0)).abs() < 1e-9, "{of_both} m² are of both sides");
    }
    // beside the house it is a house turned inside out
    let mut beside = shell;
    let other = turned(cuboid("house", dvec3(20.0, 0.0, 0.0), dvec3(24.0, 3.0, 3.0)));
    beside.positions.extend(other.positions);
    beside.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|corner| corner + 8)));
    let (mesh, patches) = patches(vec![beside], 0.5);
    for patch in &patches.list {
        let at = patches.point(patch, patches.texels[patch.texels.start as usize]) + mesh.origin;
        let middle = if at.x > 15.0 { dvec3(22.0, 1.5, 1.5) } else { dvec3(4.0, 3.0, 2.0) };
        assert!(patch.plane.dot((middle - mesh.origin).extend(1.0)) < 0.0);
    }
}

/// Some sides of a box: those whose outer normals are kept.
fn sides_of_box(keep: impl Fn(DVec3) -> bool) -> Part {
    let mut part = cuboid("sheet", dvec3(0.0, 0.0, 0.0), dvec3(8.0, 6.0, 4.0));
    let positions = part.positions.clone();
    part.triangles.retain(|triangle| {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        keep((b - a).cross(c - a).normalize())
    });
    part
}

#[test]
fn sheets_are_judged_where_they_look_up_or_on_both_sides() {
    let without_floor = sides_of_box(|normal| normal.z > -0.5);
    for part in [without_floor.clone(), turned(without_floor)] {
        let (_, patches) = patches(vec![part], 0.5);
        assert!(patches.list.iter().all(|patch| !patch.two_sided && patch.plane.w < 0.0), "a house looks outwards");
    }
    // a basin, or a house whose roof is a component of its own
    let walls_and_floor = sides_of_box(|normal| normal.z < 0.5);
    for part in [walls_and_floor.clone(), turned(walls_and_floor)] {
        let (_, patches) = patches(vec![part], 0.5);
        assert!(patches.list.iter().all(|patch| patch.two_sided), "nothing tells its outer side");
    }
    let (_, walls) = patches(vec![sides_of_box(|normal| normal.z.abs() < 0.5)], 0.5);
    assert!(walls.list.iter().all(|patch| patch.two_sided));
    assert_eq!(walls.list.len(), 4);
}

#[test]
fn holes_are_respected_and_thin_patches_have_a_value() {
    // a plate of 6 × 6 m around a hole of 2 × 2 m, as eight squares
    let mut plate = Part { name: "plate".into(), ..Part::default() };
    for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))).filter(|at| *at != (1, 1)) {
        let base = plate.positions.len() as u32;
        let at = dvec3(f64::from(column) * 2.0, f64::from(row) * 2.0, 1.0);
        plate.positions.extend([at, at + DVec3::X * 2.0, at + dvec3(2.0, 2.0, 0.0), at + DVec3::Y * 2.0]);
        plate.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }
    let (mesh, found) = patches(vec![plate], 0.5);
    assert_eq!(found.list.len(), 1);
    let patch = &found.list[0];
    assert_eq!((patch.width, patch.height, patch.texels.len()), (12, 12, 144 - 16));
    assert!((patch.area_m2 - 32.0).abs() < 1e-9);
    for texel in &found.texels {
        let at = found.point(patch, *texel) + mesh.origin;
        assert!((at.x - 3.0).abs() > 1.0 || (at.y - 3.0).abs() > 1.0, "{at} lies in the hole");
    }
    // a blade that passes between the centres
    let blade = Part {
        name: "blade".into(),
        positions: vec![dvec3(0.0, 0.0, 0.0), dvec3(4.0, 0.0, 3.6), dvec3(4.0, 0.0, 3.5)],
        triangles: vec![[0, 1, 2]],
        ..Part::default()
    };
    let (_, found) = patches(vec![blade], 2.0);
    assert_eq!((found.list.len(), found.texels.len()), (1, 1));
    assert!(found.list[0].alone.is_some());
}

#[test]
fn the_cell_grows_where_the_atlas_would_be_too_large() {
    let part = cuboid("box", dvec3(0.0, 0.0, 0.0), dvec3(80.0, 60.0, 40.0));
    let mesh = Mesh::build(vec![part]).expect("a mesh");
    let small = Patches::of(&mesh, &[true], 0.25, 20_000);
    assert!(small.cell > 0.25 && small.asked_cell == 0.25);
    whole(&mesh, &[true], &small);
    let texels: u32 = small.list.iter().map(|patch| (patch.width + 2) * (patch.height + 2)).sum();
    assert!(texels <= 20_000 && texels > 15_000, "{texels}");
    let long = Patches::of(&mesh, &[true], 0.01, usize::MAX);
    assert!(long.cell > 0.0195 && long.cell < 0.021, "a side of 80 m fits a page at {}", long.cell);
    assert!(Patches::of(&mesh, &[false], 0.25, MOST_TEXELS).list.is_empty());
}

#[test]
fn sites_lose_nothing() {
    for name in ["tower", "industry", "headquarters"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
        let cell = if name == "headquarters" { 2.0 } else { DEFAULT_CELL_M };
        let patches = Patches::of(&site.mesh, &site.receives, cell, MOST_TEXELS);
        println!(
            "{name}: {} patches, {} two-sided, {} texels, {} alone, {} pages of {}, cell {}",
            patches.list.len(),
            patches.list.iter().filter(|patch| patch.two_sided).count(),
            patches.texels.len(),
            patches.list.iter().filter(|patch| patch.alone.is_some()).count(),
            patches.pages,
            patches.page_size,
            patches.cell,
        );
        assert_eq!(patches.cell, cell);
        whole(&site.mesh, &site.receives, &patches);
    }
}

#[test]
fn tables_weigh_by_texels_and_area() {
    let (_, patches) = patches(vec![cuboid("box", dvec3(0.0, 0.0, 0.0), dvec3(8.0, 6.0, 4.0))], 2.0);
    let mut hours = PatchHours { lit: vec![0; patches.texels.len()], samples: 2, day_secs: 36_000, night_secs: 0 };
    let roof = towards(&patches, DVec3::Z).clone();
    // 12 texels: half of them an hour, a quarter three
    for (at, texel) in (roof.texels.start as usize..roof.texels.end as usize).enumerate() {
        hours.lit[texel] = [3600, 3600, 10_800, 0][at % 4] * 2;
    }
    let of_roof = hours.of_patch(&roof);
    assert_eq!((of_roof.hours_mean, of_roof.hours_min, of_roof.hours_max), (1.25, 0.0, 3.0));
    assert_eq!(of_roof.shares, [0.75, 0.25, 0.25, 0.0]);
    let whole = hours.of_component(&patches, 0).expect("patches");
    assert!((whole.area_m2 - 208.0).abs() < 1e-9 && (whole.hours_mean - 1.25 * 48.0 / 208.0).abs() < 1e-9);
    assert!(hours.of_component(&patches, 1).is_none());
}

/// The area and the mean hours of each component where all texels have an hour, once what is shared is left out.
fn areas(parts: Vec<Part>, casts: &[bool], cell: f64) -> (Vec<f64>, Patches) {
    let (mesh, mut patches) = patches(parts, cell);
    let receives = vec![true; mesh.components.len()];
    patches.leave_out_shared(&mesh, casts, &receives);
    let hours = PatchHours { lit: vec![3600; patches.texels.len()], samples: 1, day_secs: 3600, night_secs: 0 };
    let of_component = |component: usize| {
        let exposure = hours.of_component(&patches, component as u32).expect("patches");
        assert_eq!(exposure.hours_mean, if exposure.area_m2 > 0.0 { 1.0 } else { 0.0 });
        exposure.area_m2
    };
    ((0..mesh.components.len()).map(of_component).collect(), patches)
}

fn near(area: f64, right: f64) -> bool {
    (area - right).abs() < 1e-6 * right.max(1.0)
}

/// `shared/cases/10-doubled-faces-area`: 2000 and 400 before, 1000 and 200 are right.
#[test]
fn a_surface_that_is_there_twice_counts_once() {
    let tower = || cuboid("tower", dvec3(0.0, 0.0, 0.0), dvec3(10.0, 10.0, 20.0));
    let again = |turn: fn([u32; 3]) -> [u32; 3]| {
        let mut part = tower();
        let twice: Vec<[u32; 3]> = part.triangles.iter().map(|&triangle| turn(triangle)).collect();
        part.triangles.extend(twice);
        part
    };
    for doubled in [again(|triangle| triangle), again(|[a, b, c]| [a, c, b])] {
        let (areas, patches) = areas(vec![doubled], &[true], 0.25);
        assert!(near(areas[0], 1000.0), "{areas:?}");
        assert!(near(patches.left_out.doubled_m2, 1000.0) && patches.left_out.touching_m2 == 0.0);
        let walls = patches.list.iter().filter(|patch| patch.normal().z.abs() < 0.5 && patch.area_m2 > 0.0);
        let mut of_walls = [0.0; 2];
        walls.for_each(|patch| of_walls[usize::from(patch.normal().x.abs() > 0.5)] += patch.area_m2);
        assert!(of_walls.iter().all(|area| near(*area, 400.0)), "two walls of 200 m² each way: {of_walls:?}");
    }
    // in two components it counts in the first
    let (areas, _) = areas(vec![tower(), tower()], &[true; 2], 0.25);
    assert!(near(areas[0], 1000.0) && areas[1] == 0.0, "{areas:?}");
}

#[test]
fn of_two_that_lie_over_each_other_in_part_that_part_counts_once() {
    let quad = |name: &str, from: f64, to: f64, diagonal: bool| {
        let mut part = Part { name: name.into(), ..Part::default() };
        part.positions = vec![dvec3(from, 0.0, 0.0), dvec3(to, 0.0, 0.0), dvec3(to, 0.0, 10.0), dvec3(from, 0.0, 10.0)];
        part.triangles = if diagonal { vec![[0, 1, 2], [0, 2, 3]] } else { vec![[0, 1, 3], [1, 2, 3]] };
        part
    };
    let (areas_of, _) = areas(vec![quad("wall", 0.0, 10.0, true), quad("paint", 5.0, 15.0, true)], &[true; 2], 0.25);
    assert!(near(areas_of[0], 100.0) && near(areas_of[1], 50.0), "{areas_of:?}");
    // walls of a row that meet at an edge are whole
    let (areas_of, patches) =
        areas(vec![quad("one", 0.0, 10.1, true), quad("two", 10.1, 17.3, true)], &[true; 2], 0.25);
    assert!(near(areas_of[0], 101.0) && near(areas_of[1], 72.0), "{areas_of:?}");
    assert_eq!(patches.left_out, gnomon::mesh::patches::UncountedArea::default());
    assert!(patches.list.iter().all(|patch| patch.uncounted.is_empty()));
    // the same wall again in the same component, cut along its other diagonal
    let mut both = quad("wall", 0.0, 10.0, true);
    both.triangles.extend(quad("wall", 0.0, 10.0, false).triangles);
    let (areas_of, _) = areas(vec![both], &[true], 0.25);
    assert!(near(areas_of[0], 100.0), "{areas_of:?}");
}

#[test]
fn walls_between_parts_that_touch_are_left_out() {
    let house = |name: &str, low: DVec3, high: DVec3| cuboid(name, low, high);
    let first = || house("first", dvec3(0.0, 0.0, 0.0), dvec3(10.0, 10.0, 20.0));
    let second = |aside: f64| house("second", dvec3(10.0, aside, 0.0), dvec3(20.0, 10.0 + aside, 20.0));
    let (areas_of, patches) = areas(vec![first(), second(0.0)], &[true; 2], 0.25);
    assert!(near(areas_of[0], 800.0) && near(areas_of[1], 800.0), "{areas_of:?}");
    assert!(near(patches.left_out.touching_m2, 400.0) && patches.left_out.doubled_m2 == 0.0);
    // half of the wall
    let (areas_of, _) = areas(vec![first(), second(5.0)], &[true; 2], 0.25);
    assert!(near(areas_of[0], 900.0) && near(areas_of[1], 900.0), "{areas_of:?}");
    // in one component, as well
    let mut whole = first();
    let base = whole.positions.len() as u32;
    whole.positions.extend(second(0.0).positions);
    whole.triangles.extend(second(0.0).triangles.iter().map(|triangle| triangle.map(|corner| corner + base)));
    let (areas_of, _) = areas(vec![whole], &[true], 0.25);
    assert!(near(areas_of[0], 1600.0), "{areas_of:?}");
    // light falls through what does not cast, and onto what stands a hand's breadth off
    let (areas_of, _) = areas(vec![first(), second(0.0)], &[true, false], 0.25);
    assert!(near(areas_of[0], 1000.0) && near(areas_of[1], 800.0), "{areas_of:?}");
    let off = house("second", dvec3(10.1, 0.0, 0.0), dvec3(20.0, 10.0, 20.0));
    let (areas_of, _) = areas(vec![first(), off], &[true; 2], 0.25);
    assert!(near(areas_of[0], 1000.0), "{areas_of:?}");
}

#[test]
fn a_neighbour_that_only_casts_covers_the_wall_it_touches() {
    let parts = vec![
        cuboid("house", dvec3(0.0, 0.0, 0.0), dvec3(10.0, 10.0, 20.0)),
        cuboid("neighbour", dvec3(10.0, 0.0, 0.0), dvec3(20.0, 10.0, 20.0)),
    ];
    let mesh = Mesh::build(parts).expect("a mesh");
    let mut patches = Patches::of(&mesh, &[true, false], 0.25, MOST_TEXELS);
    patches.leave_out_shared(&mesh, &[true; 2], &[true, false]);
    assert!(near(patches.list.iter().map(|patch| patch.area_m2).sum(), 800.0));
}

#[test]
fn a_sheet_with_front_and_back_counts_once_and_sheet_metal_has_two_sides() {
    let positions = vec![dvec3(0.0, 0.0, 0.0), dvec3(10.0, 0.0, 0.0), dvec3(10.0, 0.0, 10.0), dvec3(0.0, 0.0, 10.0)];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]];
    let fence = Part { name: "fence".into(), positions, triangles, ..Part::default() };
    let (areas_of, patches) = areas(vec![fence], &[true], 0.25);
    assert!(near(areas_of[0], 100.0), "{areas_of:?}");
    assert!(near(patches.left_out.doubled_m2, 100.0) && patches.left_out.touching_m2 == 0.0);
    let metal = cuboid("metal", dvec3(0.0, 0.0, 0.0), dvec3(10.0, 0.0005, 10.0));
    let (areas_of, patches) = areas(vec![metal], &[true], 0.25);
    assert!(near(areas_of[0], 200.02), "{areas_of:?}");
    assert_eq!(patches.left_out, gnomon::mesh::patches::UncountedArea::default());
}
