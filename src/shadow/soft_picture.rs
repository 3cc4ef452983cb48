//! A camera's picture with soft shadow textures: the sun as a disc, on every visible flat patch and on the ground.
//!
//! The patches that the picture sees get their textures ([`crate::shadow::soft_texture`]) with points of the sun's disc
//! as samples, in texels about as large as a pixel at the scene's middle depth. A pixel takes the mean of the four
//! texels around the point that it sees, each weighted by its nearness. Where these differ by more than half of the
//! sun, the edge is harder than texels can show (the foot of a wall), and rays decide. The ground is one more patch, as
//! large as the ground on which shadows fall in the picture.
//!
//! Where textures do not apply, rays are cast to the same points of the disc, and [`Technique::note`] says how much of
//! the picture that is: patches too thin for a texel (curved bodies), surfaces not seen from their outer side, and a
//! ground on which shadows are too long.

use super::ray_cast::{RayCast, RayEnd};
use super::soft_texture::{Choice, Fill, Painter, Sample, SoftTexture};
use super::{DrawnMask, Scene, ShadowError, Technique};
use crate::mesh::patches::{MOST_PAGE, MOST_TEXELS, Patch, Patches, Texel};
use crate::sun::disc;
use crate::view::{Camera, Mask, Surface, View};
use glam::{BVec3, DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::sync::Arc;

/// The technique, made for one scene and one camera.
pub struct SoftPicture {
    scene: Scene,
    /// Finds what the pixels see, and judges those without textures.
    cast: RayCast,
    samples: u32,
    /// The patches of all receivers, with all texels.
    patches: Patches,
    looks: Vec<PixelTarget>,
    mask: Mask,
    /// The number of pixels in the last mask that rays judged because they have no texture.
    by_rays: usize,
}

/// What a pixel sees, which determines how it is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PixelTarget {
    Sky,
    /// A pixel whose surface has no texture.
    Bare,
    /// A point of the ground, metres east and north of the scene's origin.
    Ground(DVec2),
    /// A point of a patch, in texels from its corner.
    Patch(u32, DVec2),
}

/// A texel: its patch, row and column.
type TexelIndex = (u32, u16, u16);

impl SoftPicture {
    /// Finds what the pixels see, and the patches.
    pub fn new(scene: Scene, camera: Camera, samples: u32) -> SoftPicture {
        let cast = RayCast::new(scene.clone(), View::Camera(camera), Some(samples));
        let (width, height) = (camera.width, camera.height);
        let mut distances: Vec<f64> =
            cast.seen().iter().filter(|seen| seen.face != Surface::SKY).map(|seen| seen.distance).collect();
        let middle = distances.len() / 2;
        let distance =
            if distances.is_empty() { 1.0 } else { *distances.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let cell = distance * camera.half_size().y * 2.0 / f64::from(height);
        let receives = vec![true; scene.receivers.components.len()];
        let patches = Patches::of(&scene.receivers, &receives, cell, MOST_TEXELS);
        let looks = looks(&scene, &cast, &patches, width);
        let mask = Mask { width, height, share: vec![255; looks.len()] };
        SoftPicture { scene, cast, samples, patches, looks, mask, by_rays: 0 }
    }

    /// The extent of the ground on which shadows fall in the picture, from its west and south to its east and north,
    /// metres around the scene's origin.
    fn shaded_ground(&self, to_sun: DVec3) -> Option<[DVec2; 2]> {
        let origin = self.patches.origin;
        let (low, high) = self.scene.casters.bounds()?;
        let corner = |at: u32| DVec3::select(BVec3::new(at & 1 > 0, at & 2 > 0, at & 4 > 0), low, high) - origin;
        let fallen = (0..8).map(corner).map(|corner| {
            let height = (corner.z + origin.z - self.scene.ground).max(0.0);
            corner.truncate() - to_sun.truncate() * (height / to_sun.z.max(1e-9))
        });
        let [low, high] = bounds(fallen);
        // the disc's shadows are slightly longer
        let more = (high - low) * 0.1 + 1.0;
        let within = |at: &DVec2| at.cmpge(low - more).all() && at.cmple(high + more).all();
        let [low, high] = bounds(self.looks.iter().filter_map(|look| match look {
            PixelTarget::Ground(at) => Some(*at).filter(within),
            _ => None,
        }));
        (low.x <= high.x).then_some([low, high])
    }

    /// The ground as a patch; `None` if it would be too large.
    fn ground(&self, [low, high]: [DVec2; 2]) -> Option<Patch> {
        let cell = self.patches.cell;
        // half a texel more on all sides, so that every pixel is surrounded by texels
        let count = (high - low) / cell + 2.0;
        let ground = self.scene.ground - self.patches.origin.z;
        (count.max_element() < f64::from(4 * MOST_PAGE)).then(|| Patch {
            component: u32::MAX,
            faces: 0..0,
            plane: DVec4::new(0.0, 0.0, 1.0, -ground),
            two_sided: false,
            area_m2: 0.0,
            uncounted: Vec::new(),
            corner: DVec3::new(low.x - cell, high.y + cell, ground),
            right: DVec3::X,
            down: DVec3::NEG_Y,
            width: count.x.ceil() as u32 + 1,
            height: count.y.ceil() as u32 + 1,
            page: 0,
            x: 0,
            y: 0,
            texels: 0..0,
            alone: None,
        })
    }

    /// The judged texels around a position in a patch, with their weights.
    fn around(&self, patch: u32, at: DVec2, ground: Option<&Patch>) -> impl Iterator<Item = (TexelIndex, f64)> {
        let size = match self.patches.list.get(patch as usize) {
            Some(patch) => [patch.width, patch.height],
            None => ground.map_or([0; 2], |ground| [ground.width, ground.height]),
        };
        let first = (at - 0.5).floor();
        let part = at - 0.5 - first;
        let of = |right: f64, down: f64| {
            let (column, row) = (first.x + right, first.y + down);
            let weight = (1.0 - (part.x - right).abs()) * (1.0 - (part.y - down).abs());
            let within = column >= 0.0 && row >= 0.0 && column < f64::from(size[0]) && row < f64::from(size[1]);
            let place = (patch, row as u16, column as u16);
            (within && weight > 0.0 && self.is_judged(place)).then_some((place, weight))
        };
        [of(0.0, 0.0), of(1.0, 0.0), of(0.0, 1.0), of(1.0, 1.0)].into_iter().flatten()
    }

    /// Whether a texel lies in its patch.
    fn is_judged(&self, (patch, row, column): TexelIndex) -> bool {
        let Some(patch) = self.patches.list.get(patch as usize) else { return true };
        let texels = &self.patches.texels[patch.texels.start as usize..patch.texels.end as usize];
        texels.binary_search_by_key(&(row, column), |texel| (texel.row, texel.column)).is_ok()
    }

    /// The number of the disc's points that each texel sees; texels are sorted by patch.
    fn counts(&self, places: &[TexelIndex], ground: Option<&Patch>, to_sun: DVec3) -> Result<Vec<u32>, ShadowError> {
        let mut seen = Patches { list: Vec::new(), texels: Vec::new(), faces: Vec::new(), ..self.patches.clone() };
        for of_patch in places.chunk_by(|one, other| one.0 == other.0) {
            let Some(patch) = self.patches.list.get(of_patch[0].0 as usize).or(ground) else { continue };
            let first = seen.texels.len() as u32;
            seen.texels.extend(of_patch.iter().map(|&(_, row, column)| Texel { column, row }));
            seen.list.push(Patch { texels: first..seen.texels.len() as u32, ..patch.clone() });
        }
        let painter = Painter::OnProcessor(Fill::Silhouettes);
        let mut texture = SoftTexture::new(self.scene.casters.clone(), Arc::new(seen), painter, Choice::Auto)?;
        let samples: Vec<_> =
            disc(to_sun, self.samples).map(|point| Sample { light: point.extend(0.0), weight: 1 }).collect();
        texture.add(&samples)?;
        texture.finish()
    }
}

impl Technique for SoftPicture {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let shaded = self.shaded_ground(to_sun);
        let ground = shaded.and_then(|shaded| self.ground(shaded));
        let of_ground = self.patches.list.len() as u32;
        // the position of a pixel in its texture; `None` if rays are cast
        let look = |look: &PixelTarget| match *look {
            PixelTarget::Sky | PixelTarget::Bare => None,
            PixelTarget::Patch(patch, at) => Some((patch, at)),
            PixelTarget::Ground(at) => {
                let from_corner = (at - ground.as_ref()?.corner.truncate()) / self.patches.cell;
                Some((of_ground, DVec2::new(from_corner.x, -from_corner.y)))
            }
        };
        let around =
            |seen: &PixelTarget| look(seen).into_iter().flat_map(|(patch, at)| self.around(patch, at, ground.as_ref()));
        let mut places: Vec<TexelIndex> = self.looks.par_iter().flat_map_iter(around).map(|(place, _)| place).collect();
        places.par_sort_unstable();
        places.dedup();
        let counts = self.counts(&places, ground.as_ref(), to_sun)?;

        let suns = self.cast.suns(to_sun);
        let is_shaded = |at: DVec2| shaded.is_some_and(|[low, high]| at.cmpge(low).all() && at.cmple(high).all());
        let share = |at: usize| -> (u8, bool) {
            let (mut sum, mut weights, mut least, mut most) = (0.0, 0.0, u32::MAX, 0);
            for (place, weight) in around(&self.looks[at]) {
                if let Ok(found) = places.binary_search(&place) {
                    let count = counts[found];
                    sum += f64::from(count) * weight;
                    weights += weight;
                    (least, most) = (least.min(count), most.max(count));
                }
            }
            match self.looks[at] {
                PixelTarget::Sky => (255, false),
                PixelTarget::Ground(at) if !is_shaded(at) => (255, false),
                _ if weights > 0.0 && most - least > self.samples / 2 => (self.cast.share(at, &suns), false),
                _ if weights > 0.0 => ((255.0 * sum / (weights * f64::from(self.samples))).round() as u8, false),
                _ => (self.cast.share(at, &suns), true),
            }
        };
        let shares: Vec<(u8, bool)> = (0..self.looks.len()).into_par_iter().map(share).collect();
        self.by_rays = shares.iter().filter(|(_, by_rays)| *by_rays).count();
        self.mask.share = shares.into_iter().map(|(share, _)| share).collect();
        Ok(DrawnMask::Memory(&self.mask))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.cast.surface()
    }

    fn note(&self) -> Option<String> {
        let seen = self.looks.iter().filter(|look| **look != PixelTarget::Sky).count();
        let percent = 100.0 * self.by_rays as f64 / seen.max(1) as f64;
        let part = if percent < 0.1 { "less than 0.1%".to_owned() } else { format!("{percent:.1}%") };
        (self.by_rays > 0).then(|| {
            format!(
                "soft-texture does not apply to {part} of what the picture shows: surfaces too thin or too curved for a \
                 texture, or not seen from their outer side; rays are cast there"
            )
        })
    }
}

/// What each pixel sees.
fn looks(scene: &Scene, cast: &RayCast, patches: &Patches, width: u32) -> Vec<PixelTarget> {
    let mut patch_of = vec![u32::MAX; scene.receivers.faces.len()];
    for (number, patch) in (0..).zip(&patches.list) {
        for &face in &patches.faces[patch.faces.start as usize..patch.faces.end as usize] {
            patch_of[face as usize] = number;
        }
    }
    let look = |at: usize| {
        let RayEnd { face, distance, .. } = cast.seen()[at];
        let (from, along) = cast.ray(at as u32 % width, at as u32 / width);
        let point = from + along * distance;
        match face {
            Surface::SKY => PixelTarget::Sky,
            Surface::GROUND => PixelTarget::Ground(point.truncate()),
            _ => {
                let number = patch_of[face as usize];
                let Some(patch) = patches.list.get(number as usize) else { return PixelTarget::Bare };
                let is_outer = !patch.two_sided && patch.normal().dot(along) < 0.0;
                if !is_outer || patch.alone.is_some() {
                    return PixelTarget::Bare;
                }
                let from_corner = (point - patch.corner) / patches.cell;
                PixelTarget::Patch(number, DVec2::new(from_corner.dot(patch.right), from_corner.dot(patch.down)))
            }
        }
    };
    (0..cast.seen().len()).into_par_iter().map(look).collect()
}

fn bounds(points: impl Iterator<Item = DVec2>) -> [DVec2; 2] {
    points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}
