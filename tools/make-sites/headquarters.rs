//! A curved office tower on a plaza, its façade drawn fin by fin, in a quarter of simpler neighbours.
//!
//! In plan the tower is a bent bar with round ends, hollow towards the plaza in the south; its upper storeys step back
//! from the east, each leaving a terrace.

use super::glb::{Model, Node};
use super::quarter;
use super::shapes::{block, circle, lathe, on_circle, prism, rect, strut};
use super::solids::{Solid, hoop};
use glam::{DVec2, DVec3, dvec2};

/// The storey under the roof; storey 0 is the lobby.
const TOP_STOREY: u32 = 21;
/// The first storey that steps back.
const FIRST_STEP: u32 = 15;
/// Modules of the bend that each step gives up.
const STEP_MODULES: u32 = 4;
const STOREY_HEIGHT: f64 = 3.75;
const LOBBY_HEIGHT: f64 = 6.0;
const SLAB: f64 = 0.35;

/// The bend: modules of 1.5° from 36° to 144° around a point south of the plot's middle.
const MODULES: u32 = 72;
const BEND_CENTRE: DVec2 = dvec2(0.0, -20.0);
const BEND_RADIUS: f64 = 68.0;
const HALF_DEPTH: f64 = 10.0;
/// Sides of each round end.
const END_SIDES: u32 = 16;

pub(super) fn model() -> Model {
    let mut model = Model::new();
    let facade = model.material("facade", [0.8, 0.76, 0.68, 1.0]);
    let concrete = model.material("concrete", [0.58, 0.57, 0.55, 1.0]);
    let glass = model.material("glass", [0.25, 0.4, 0.48, 0.6]);
    let roof = model.material("roof", [0.4, 0.44, 0.36, 1.0]);
    let tiles = model.material("tiles", [0.42, 0.2, 0.14, 1.0]);
    let neighbours = model.material("neighbours", [0.75, 0.68, 0.55, 1.0]);

    let tower = model.mesh(
        "headquarters",
        vec![(facade, facade_parts()), (concrete, structure()), (glass, glazing()), (roof, terraces())],
    );
    let plaza = model.mesh("plaza", vec![(concrete, plaza()), (glass, pavilion())]);
    let quarter = quarter::nodes(&mut model, neighbours, tiles, roof);
    model.nodes = vec![Node::group(
        "site",
        vec![
            Node::showing("headquarters", tower),
            Node::showing("plaza", plaza).at(0.0, -28.0, 0.0),
            Node::group("quarter", quarter),
        ],
    )];
    model
}

/// A point of a storey's edge with the direction in which it looks out.
#[derive(Clone, Copy)]
struct EdgePoint {
    at: DVec2,
    out: DVec2,
}

/// The top of a storey's floor.
fn floor_of(storey: u32) -> f64 {
    match storey {
        0 => 0.0,
        _ => LOBBY_HEIGHT + STOREY_HEIGHT * f64::from(storey - 1),
    }
}

/// Where in the bend a storey begins in the east.
fn first_module(storey: u32) -> u32 {
    (storey + 1).saturating_sub(FIRST_STEP) * STEP_MODULES
}

/// The direction of a module from the bend's centre.
fn direction(module: f64) -> DVec2 {
    on_circle((36.0 + 1.5 * module) / 360.0)
}

/// A storey's edge, counter-clockwise: the outer side, the western end, the inner side, the eastern end.
fn edge(storey: u32) -> Vec<EdgePoint> {
    let modules = first_module(storey)..=MODULES;
    let on_side = |module: u32, side: f64| {
        let radial = direction(f64::from(module));
        EdgePoint { at: BEND_CENTRE + (BEND_RADIUS + side * HALF_DEPTH) * radial, out: side * radial }
    };
    let round_end = |module: u32, start: f64| {
        (1..END_SIDES).map(move |side| {
            let turn = on_circle(start + 0.5 * f64::from(side) / f64::from(END_SIDES));
            let out = turn.rotate(direction(f64::from(module)));
            EdgePoint { at: BEND_CENTRE + BEND_RADIUS * direction(f64::from(module)) + HALF_DEPTH * out, out }
        })
    };
    let mut points: Vec<EdgePoint> = modules.clone().map(|module| on_side(module, 1.0)).collect();
    points.extend(round_end(MODULES, 0.0));
    points.extend(modules.rev().map(|module| on_side(module, -1.0)));
    points.extend(round_end(first_module(storey), 0.5));
    points
}

/// The edge moved outwards.
fn offset(edge: &[EdgePoint], outwards: f64) -> Vec<DVec2> {
    edge.iter().map(|point| point.at + outwards * point.out).collect()
}

/// A ring between two offsets of an edge.
fn band(edge: &[EdgePoint], inside: f64, outside: f64, bottom: f64, top: f64) -> Solid {
    let ring = |outwards: f64, z: f64| offset(edge, outwards).iter().map(|point| point.extend(z)).collect();
    hoop(&[ring(outside, bottom), ring(outside, top), ring(inside, top), ring(inside, bottom)])
}

/// A blade that stands across the façade.
fn blade(point: EdgePoint, inside: f64, outside: f64, width: f64, bottom: f64, top: f64) -> Solid {
    let along = point.out.perp() * (width / 2.0);
    let corner = |outwards: f64| point.at + outwards * point.out;
    let plan = [corner(inside) - along, corner(outside) - along, corner(outside) + along, corner(inside) + along];
    prism(&plan, bottom, top)
}

/// For each storey: a fin on every module, a mullion between two, and a rail at the height of a sill.
fn facade_parts() -> Vec<Solid> {
    let mut solids = Vec::new();
    for storey in 1..=TOP_STOREY {
        let edge = edge(storey);
        let (floor, ceiling) = (floor_of(storey), floor_of(storey + 1) - SLAB);
        for (index, &point) in edge.iter().enumerate() {
            // Deeper where the sun is high, and in a slow wave that climbs around the tower.
            let phase = (index as u32 + 3 * storey) % 24;
            let wave = f64::from(phase.min(24 - phase)) / 12.0;
            let depth = if point.out.y < 0.0 { 0.45 + 0.4 * wave } else { 0.3 + 0.25 * wave };
            solids.push(blade(point, -0.3, depth, 0.14, floor - 0.25, ceiling - 0.05));

            let next = edge[(index + 1) % edge.len()];
            let out = point.out + next.out;
            let between = EdgePoint { at: (point.at + next.at) / 2.0, out: out / out.length() };
            solids.push(blade(between, -0.5, -0.2, 0.08, floor - 0.05, ceiling + 0.05));
        }
        solids.push(band(&edge, -0.3, -0.15, floor + 0.9, floor + 1.05));
    }
    solids
}

/// Slabs, columns behind the façade, and two cores.
fn structure() -> Vec<Solid> {
    let mut solids = Vec::new();
    for storey in 1..=TOP_STOREY + 1 {
        // A slab covers the storey below it, and so is the floor of the terrace where the next steps back.
        let edge = edge(storey - 1);
        solids.push(prism(&offset(&edge, 0.0), floor_of(storey) - SLAB, floor_of(storey)));
    }
    for storey in 0..=TOP_STOREY {
        for module in (first_module(storey)..=MODULES).step_by(6) {
            for radius in [BEND_RADIUS - 7.5, BEND_RADIUS + 7.5] {
                let foot = (BEND_CENTRE + radius * direction(f64::from(module))).extend(floor_of(storey));
                let height = floor_of(storey + 1) - floor_of(storey) - SLAB + 0.1;
                let (thickness, sides) = if storey == 0 { (0.6, 16) } else { (0.45, 10) };
                solids.push(lathe(foot, &[(thickness, 0.0), (thickness, height)], sides));
            }
        }
    }
    // Each core ends a storey above the slab through which it breaks.
    for (module, top) in [(54.0, floor_of(TOP_STOREY + 1) + 3.6), (22.0, floor_of(19) + 3.2)] {
        let corner = |along: f64, radius: f64| BEND_CENTRE + radius * direction(module + along);
        let plan = [corner(-4.0, 64.5), corner(-4.0, 71.5), corner(4.0, 71.5), corner(4.0, 64.5)];
        solids.push(prism(&plan, 0.0, top));
    }
    solids
}

/// A pane's thickness of glass around each storey; around the lobby it stands back.
fn glazing() -> Vec<Solid> {
    let storey_glass = |storey: u32| {
        // Every second module is enough for a surface behind the fins.
        let edge: Vec<EdgePoint> = edge(storey).into_iter().step_by(2).collect();
        let inside = if storey == 0 { -4.0 } else { -0.4 };
        let bottom = if storey == 0 { 0.0 } else { floor_of(storey) - 0.05 };
        band(&edge, inside - 0.06, inside, bottom, floor_of(storey + 1) - SLAB + 0.05)
    };
    (0..=TOP_STOREY).map(storey_glass).collect()
}

/// The covering of the roof and of each terrace, parapets, and the plant on the roof.
fn terraces() -> Vec<Solid> {
    let mut solids = Vec::new();
    for storey in FIRST_STEP..=TOP_STOREY + 1 {
        let below: Vec<EdgePoint> = edge(storey - 1).into_iter().step_by(2).collect();
        let floor = floor_of(storey);
        if storey > TOP_STOREY {
            solids.push(prism(&offset(&below, -0.6), floor - 0.1, floor + 0.15));
            solids.push(band(&below, -0.5, -0.1, floor - 0.1, floor + 1.0));
        } else {
            // What the step uncovers, and a little of what it does not.
            let first = first_module(storey - 1);
            let arc = |radius: f64| {
                let modules = (0..=3).map(|step| f64::from(first + 2 * step) - 3.0);
                modules.map(move |module| BEND_CENTRE + radius * direction(module))
            };
            let inner = arc(BEND_RADIUS - 6.5).rev();
            let plan: Vec<DVec2> = arc(BEND_RADIUS + 6.5).chain(inner).collect();
            solids.push(prism(&plan, floor - 0.1, floor + 0.2));
        }
    }
    let roof = floor_of(TOP_STOREY + 1);
    for module in [36.0, 42.0, 62.0, 67.0] {
        let corner = |along: f64, radius: f64| BEND_CENTRE + radius * direction(module + along);
        let plan = [corner(-1.7, 65.0), corner(-1.7, 71.0), corner(1.7, 71.0), corner(1.7, 65.0)];
        solids.push(prism(&plan, roof, roof + 2.6));
        for radius in [66.5, 69.5] {
            solids.push(lathe(corner(0.0, radius).extend(roof + 2.5), &[(1.0, 0.0), (1.0, 0.8)], 12));
        }
    }
    solids
}

/// Steps up to the tower, planters, and a long bench around the pavilion.
fn plaza() -> Vec<Solid> {
    let mut solids =
        vec![block([-70.0, -30.0, 0.0], [70.0, 26.0, 0.15]), block([-66.0, -22.0, 0.1], [66.0, 92.0, 0.3])];
    for x in [-48.0, -34.0, 34.0, 48.0] {
        for y in [-14.0, 2.0] {
            solids.push(prism(&rect([x - 4.0, y - 2.5], [x + 4.0, y + 2.5]), 0.2, 0.9));
        }
    }
    let plan = |radius: f64, z: f64| circle(DVec3::Z * z, radius, 48);
    solids.push(hoop(&[plan(17.5, 0.2), plan(17.5, 0.75), plan(16.9, 0.75), plan(16.9, 0.2)]));
    // The pavilion's roof is a shell on slender posts, thin at its rim.
    solids.push(lathe(DVec3::Z * 5.0, &[(13.6, 0.0), (14.0, 0.3), (10.0, 1.4), (5.0, 2.1), (0.0, 2.3)], 48));
    for post in circle(DVec3::Z * 0.2, 12.8, 16) {
        solids.push(strut(post, post + 5.0 * DVec3::Z, 0.25, 0.25));
    }
    solids
}

/// The pavilion's glass drum.
fn pavilion() -> Vec<Solid> {
    let plan = |radius: f64, z: f64| circle(DVec3::Z * z, radius, 48);
    vec![hoop(&[plan(11.5, 0.25), plan(11.5, 5.1), plan(11.42, 5.1), plan(11.42, 0.25)])]
}
