//! Old houses wall to wall around a courtyard, each with eaves, a roof, dormers and chimneys of its own.

use super::shapes::{extrude, prism, rect, rectangle, strut};
use super::solids::{Solid, loft};
use glam::{DVec2, DVec3, dvec2, dvec3};

/// From street to courtyard.
const HOUSE_DEPTH: f64 = 12.0;
/// How much of each street a corner house takes.
const CORNER_FRONT: f64 = 16.0;

/// Walls and roofs apart, as they are different materials.
#[derive(Default)]
pub(super) struct Buildings {
    pub(super) walls: Vec<Solid>,
    pub(super) roofs: Vec<Solid>,
}

/// Numbers that look like chance and are the same on every run (Lehmer's generator).
struct Dice(u64);

impl Dice {
    /// One of `0..sides`.
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 = self.0 * 48271 % 0x7fff_ffff;
        self.0 / 16 % sides
    }
}

/// A line across a house, from the street to the courtyard.
#[derive(Clone, Copy)]
struct Section {
    street: DVec2,
    court: DVec2,
}

impl Section {
    /// A point of it: 0 at the street, 1 at the courtyard.
    fn at(&self, share: f64, z: f64) -> DVec3 {
        self.street.lerp(self.court, share).extend(z)
    }

    fn moved(self, by: DVec2) -> Self {
        Self { street: self.street + by, court: self.court + by }
    }
}

/// Houses all around a courtyard, each with its own eaves and roof; the corner houses turn their ridges.
pub(super) fn perimeter_block(width: f64, depth: f64, seed: u64) -> Buildings {
    let mut dice = Dice(seed);
    let mut block = Buildings::default();
    let corners = rect([-width / 2.0, -depth / 2.0], [width / 2.0, depth / 2.0]);
    for side in 0..4 {
        let [before, here, after] = [side + 3, side, side + 1].map(|corner| corners[corner % 4]);
        let length = (after - here).length();
        let along = (after - here) / length;
        let inwards = along.perp();
        let section =
            |way: f64| Section { street: here + way * along, court: here + way * along + HOUSE_DEPTH * inwards };

        let back = (before - here) / (before - here).length();
        let arriving =
            Section { street: here + CORNER_FRONT * back, court: here + CORNER_FRONT * back + HOUSE_DEPTH * along };
        let turning = Section { street: here, court: here + HOUSE_DEPTH * (along + inwards) };
        house(&mut block, &mut dice, &[arriving, turning, section(CORNER_FRONT)], 2.0);

        let count = ((length - 2.0 * CORNER_FRONT) / 14.0).round();
        let front = (length - 2.0 * CORNER_FRONT) / count;
        for index in 0..count as u32 {
            let start = CORNER_FRONT + front * f64::from(index);
            // A hand into the neighbours' walls, so that no two houses share an edge.
            let overlap = 0.125 * along;
            house(&mut block, &mut dice, &[section(start).moved(-overlap), section(start + front).moved(overlap)], 0.0);
        }
    }
    // A workshop in the courtyard, lit from a roof that leans on nobody.
    let half = dvec2(width / 2.0 - HOUSE_DEPTH - 12.0, 4.0);
    block.walls.push(prism(&rect([-half.x, -half.y], [half.x, half.y]), 0.0, 4.2));
    let profile = [(-4.4, 4.0), (4.4, 4.0), (4.4, 4.3), (0.0, 6.6), (-4.4, 4.3)].map(|(y, z)| dvec2(y, z));
    block.roofs.push(extrude(&profile, dvec3(-half.x - 0.4, 0.0, 0.0), dvec3(half.x + 0.4, 0.0, 0.0), DVec3::Y));
    block
}

/// One house through two or three sections: walls, roof, chimneys on its first section, dormers and a bay to the street.
fn house(block: &mut Buildings, dice: &mut Dice, sections: &[Section], extra_height: f64) {
    let storeys = 4 + dice.roll(3);
    let eaves = 4.0 + 3.4 * storeys as f64 - 1.5 + extra_height;
    let street = sections.iter().map(|section| section.street);
    let court = sections.iter().rev().map(|section| section.court);
    block.walls.push(prism(&street.chain(court).collect::<Vec<_>>(), 0.0, eaves));

    // Share of the way from street to courtyard, and height above the eaves.
    let gable: &[(f64, f64)] = &[(-0.05, -0.2), (1.05, -0.2), (1.05, 0.0), (0.5, 5.2), (-0.05, 0.0)];
    let mansard: &[(f64, f64)] =
        &[(-0.05, -0.2), (1.05, -0.2), (1.05, 0.0), (0.88, 3.4), (0.5, 5.6), (0.12, 3.4), (-0.05, 0.0)];
    let is_mansard = dice.roll(3) == 0;
    let profile = if is_mansard { mansard } else { gable };
    let ring = |section: &Section| profile.iter().map(|&(share, up)| section.at(share, eaves + up)).collect();
    block.roofs.push(loft(&sections.iter().map(ring).collect::<Vec<_>>()));

    let (first, last) = (sections[0], sections[sections.len() - 1]);
    for share in [0.34, 0.64] {
        let foot = first.at(share, eaves + 1.0) + along_street(sections, 0) * 0.9;
        block.walls.push(loft(&[0.0, 5.6].map(|z| rectangle(foot + z * DVec3::Z, dvec2(0.45, 0.45)))));
    }
    // Dormers look to the street and, from the courtyard's slope, to the courtyard.
    let pieces = sections.len() - 1;
    for piece in 0..pieces {
        let (from, to) = (sections[piece], sections[piece + 1]);
        let count = 3;
        for index in 1..=count {
            let share = f64::from(index) / f64::from(count + 1);
            let across =
                Section { street: from.street.lerp(to.street, share), court: from.court.lerp(to.court, share) };
            let up = if is_mansard { 1.6 } else { 1.5 };
            block.roofs.push(strut(across.at(0.04, eaves + up), across.at(0.3, eaves + up), 1.4, 1.8));
            if index != 2 && pieces == 1 {
                block.roofs.push(strut(across.at(0.96, eaves + up), across.at(0.7, eaves + up), 1.4, 1.8));
            }
        }
    }
    // A bay window over the door, from the first floor to below the eaves.
    if dice.roll(2) == 0 {
        let middle = first.street.lerp(last.street, 0.5);
        if pieces == 1 {
            let along = along_street(sections, 0).truncate() * 1.6;
            let out = (first.street - first.court) / HOUSE_DEPTH;
            let plan =
                [middle - along - out, middle + along - out, middle + along + out * 0.9, middle - along + out * 0.9];
            block.walls.push(prism(&plan, 4.2, eaves - 2.5));
        }
    }
}

/// The direction of the street along a piece of a house.
fn along_street(sections: &[Section], piece: usize) -> DVec3 {
    let way = sections[piece + 1].street - sections[piece].street;
    (way / way.length()).extend(0.0)
}
