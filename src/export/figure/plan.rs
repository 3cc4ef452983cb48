//! The colours and lines of a plan: ground and roofs seen from above.

use super::FigureContext;
use super::picture::{CellBorder, Cells, Fit, LazyRaster, PagePicture, Pen, Pixels, compose};
use super::scale::{Bands, Rgb, mix};
use crate::look::LOOK;
use crate::mesh::Mesh;
use crate::profile::comparison::Alteration;
use crate::profile::{Profile, ShadedCells};
use crate::view::{Mask, Surface, SurfaceRows};
use glam::DVec3;
use std::ops::Range;

/// Roofs that are not judged.
pub(super) const ROOF_UNJUDGED: Rgb = LOOK.plan_roof_unjudged;

/// Hours of shadow.
pub(super) fn profile<S: SurfaceRows, C: ShadedCells>(
    scene: &FigureContext<S>,
    profile: &Profile<C>,
    bands: &Bands,
    fit: Fit,
) -> impl Pixels {
    let ground_only = scene.is_ground_alone();
    let of_roofs = if ground_only { LOOK.relief } else { LOOK.relief_of_hours };
    let values = |cells| {
        let part = profile.shaded.part(cells);
        move |at| part.of(at)
    };
    let flat = move |shaded, is_ground: bool| match ground_only && !is_ground {
        true => ROOF_UNJUDGED,
        false => bands.colour(shaded),
    };
    draw(scene, profile.grid.cell, fit, [LOOK.relief_of_hours, of_roofs], values, flat, |_, _| ())
}

/// Sun and shadow at one instant.
pub(super) fn instant(scene: &FigureContext, cell_m: f64, mask: &Mask, fit: Fit) -> impl Pixels {
    let ground_only = scene.is_ground_alone();
    draw(
        scene,
        cell_m,
        fit,
        [LOOK.relief; 2],
        move |cells: Range<usize>| move |at| mask.share[cells.start + at],
        move |share, is_ground| {
            let share = f64::from(share) / 255.0;
            match is_ground {
                true => mix(LOOK.plan_ground_shade, LOOK.plan_ground_sun, share),
                false if ground_only => ROOF_UNJUDGED,
                false => mix(LOOK.plan_roof_shade, LOOK.plan_roof_sun, share),
            }
        },
        |_, _| (),
    )
}

/// Paints the cells without relief and lines, which would be mistaken for cells.
pub(super) fn painted(of_cells: &[Rgb], fit: Fit) -> PagePicture {
    compose(fit, CellBorder::Sharp, of_cells, |_, _| None)
}

/// The hours of shadow after the change minus those before. What is gone keeps its lines.
pub(super) fn difference<'a>(
    scenes: &'a [FigureContext; 2],
    of_cells: &'a [Rgb],
    altered: &'a [Alteration],
    cell_m: f64,
    fit: Fit,
) -> impl Pixels + 'a {
    let [before, after] = scenes;
    let width = fit.cells.0 as usize;
    let lines_of_gone = move |rows: Range<usize>, cells: &mut Cells| {
        let gone = &altered[rows.start * width..rows.end * width];
        let surface = &before.surface.rows(rows.clone());
        cells.border(rows.len(), |a, b| {
            let is_gone = [a, b].map(|cell| gone[cell] == Alteration::Cleared) != [false; 2];
            let parts = is_gone && surface.face[a] != surface.face[b];
            if parts { pen(before, surface, cell_m, a, b) } else { None }
        });
    };
    draw(
        after,
        cell_m,
        fit,
        [LOOK.relief_of_hours; 2],
        move |cells: Range<usize>| move |at| of_cells[cells.start + at],
        |colour, _| colour,
        lines_of_gone,
    )
}

/// Draws a plan. `flat` gives the colour of a level cell from its value and from whether it is ground; `values` returns
/// the values of a range of cells, indexed from its first cell. Slopes get relief, whose strengths for terrain and for
/// roofs are given; borders get lines, and `more` adds further lines to a range of rows.
fn draw<S: SurfaceRows, V: Copy + PartialEq, G: Fn(usize) -> V>(
    scene: &FigureContext<S>,
    cell_m: f64,
    fit: Fit,
    [of_terrain, of_roofs]: [f64; 2],
    values: impl Fn(Range<usize>) -> G + Sync,
    flat: impl Fn(V, bool) -> Rgb + Sync,
    more: impl Fn(Range<usize>, &mut Cells) + Sync,
) -> impl Pixels {
    let light = relief_light(scene);
    let width = fit.cells.0 as usize;
    LazyRaster::new(fit, CellBorder::Sharp, move |rows: Range<usize>, cells: &mut Cells| {
        let surface = &scene.surface.rows(rows.clone());
        let mesh = scene.mesh;
        let value = values(rows.start * width..rows.end * width);
        // neighbouring cells often see the same face
        let mut last = None;
        let colour = |(at, &seen): (usize, &u32)| {
            let value = value(at);
            if let Some((its, face, colour)) = last
                && (its, face) == (value, seen)
            {
                return colour;
            }
            let is_ground = scene.is_ground(seen);
            let factor = match seen {
                Surface::GROUND => 1.0,
                face => relief(upward(mesh, face as usize), light, if is_ground { of_terrain } else { of_roofs }),
            };
            let colour = shade(flat(value, is_ground), factor);
            last = Some((value, seen, colour));
            colour
        };
        cells.paint(surface.face.iter().enumerate().map(colour));
        // nearly all neighbours see the same face
        cells.border_of(&surface.face, |a, b| pen(scene, surface, cell_m, a, b));
        more(rows, cells);
    })
}

fn face(surface: &Surface, cell: usize) -> Option<usize> {
    let face = surface.face[cell];
    (face < Surface::GROUND).then_some(face as usize)
}

/// The normal of a face on its upper side; straight up if the face has no area.
fn upward(mesh: &Mesh, face: usize) -> DVec3 {
    // computed here, since a plan crosses the border of each face only a few times, and the planes of all faces would
    // take longer
    let [a, b, c] = mesh.faces[face].map(|vertex| mesh.vertices[vertex as usize].as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or_zero();
    if normal.z < 0.0 {
        -normal
    } else if normal == DVec3::ZERO {
        DVec3::Z
    } else {
        normal
    }
}

/// The direction of the light for relief, half-way between up and the highest sun of the study, so that relief and
/// shadows agree.
/// Maps usually light relief from the north-west, but here that would darken the roofs that get most sun.
fn relief_light<S>(scene: &FigureContext<S>) -> DVec3 {
    let instants = scene.track.instants.iter();
    let highest = instants.max_by(|a, b| a.altitude_rad.total_cmp(&b.altitude_rad));
    let (sin, cos) = highest.map_or(0.0, |instant| instant.azimuth_rad).sin_cos();
    DVec3::new(sin, cos, 1.0) * std::f64::consts::FRAC_1_SQRT_2
}

/// The factor of relief: 1 if level, less on slopes away from the light, a little more towards it.
fn relief(normal: DVec3, light: DVec3, strength: f64) -> f64 {
    // Level roofs keep the legend's colours to the bit.
    if normal.z > LOOK.relief_level {
        return 1.0;
    }
    (1.0 + strength * (normal.dot(light) / light.z - 1.0)).clamp(LOOK.relief_darkest, LOOK.relief_lightest)
}

fn shade(colour: Rgb, factor: f64) -> Rgb {
    // most of a plan is level ground and roofs
    if factor == 1.0 {
        return colour;
    }
    colour.map(|part| (f64::from(part) * factor).round().min(255.0) as u8)
}

/// The line between two neighbours that see different things. The ground has lines only where it steps: a cliff, or the
/// terrain's edge.
pub(super) fn pen<S>(scene: &FigureContext<S>, surface: &Surface, cell_m: f64, a: usize, b: usize) -> Option<Pen> {
    let mesh = scene.mesh;
    let east = b == a + 1;
    let half = if east { DVec3::X } else { DVec3::NEG_Y } * (0.5 * cell_m);
    let [from, to] = [a, b].map(|cell| face(surface, cell).map(|face| upward(mesh, face)));
    // how much each face rises over half a cell
    let [rise_from, rise_to] = [from, to].map(|normal| rise(normal, half));
    // at a ridge between two centres, the heights are off by the rise over half a cell
    let step_m = (0.5 * cell_m).clamp(LOOK.plan_step_least_m, LOOK.plan_step_most_m) + rise_from.abs() + rise_to.abs();
    // the heights at the border
    let [height_from, height_to] = [a, b].map(|cell| f64::from(surface.height_m[cell]));
    let jump = (height_from + rise_from - (height_to - rise_to)).abs();
    let are_ground = [a, b].map(|cell| scene.is_ground(surface.face[cell]));
    match (are_ground, from, to) {
        (_, None, None) => None,
        ([true, true], ..) => (jump > step_m).then_some(Pen::STEP),
        ([false, false], Some(from), Some(to)) if jump <= step_m => {
            (from.dot(to) < LOOK.plan_crease_cos).then_some(Pen::CREASE)
        }
        ([false, false], ..) => Some(Pen::STEP),
        _ => Some(if jump > step_m { Pen::OUTLINE } else { Pen::CREASE }),
    }
}

/// How much a face rises over half a cell; 0 for the ground and for walls.
fn rise(normal: Option<DVec3>, half: DVec3) -> f64 {
    let Some(normal) = normal.filter(|normal| normal.z >= LOOK.plan_wall_up) else {
        return 0.0;
    };
    -(normal.x * half.x + normal.y * half.y) / normal.z
}
