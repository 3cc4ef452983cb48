//! The window's picture looks like a drawing: both are compared as whole pictures, pixel by pixel.

use crate::shared::drawing::gpu;
use gnomon::choice::{Engine, Method, Receivers, Settings};
use gnomon::export::figure::scale::Bands;
use gnomon::export::figure::{self, FigureContext, PictureExtras};
use gnomon::export::patches::{Atlas, PatchContext};
use gnomon::gpu::readback;
use gnomon::look::LOOK;
use gnomon::mesh::Mesh;
use gnomon::mesh::patches::{MOST_TEXELS, Patches};
use gnomon::picture::{HoursRaster, PatchColours, Picture, Style};
use gnomon::profile::{Profile, Provenance};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{DrawnMask, Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::sunlight::PatchHours;
use gnomon::view::{Camera, Grid, Mask, Side, Surface, View};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use wgpu::TextureAspect;

/// Pixels farther than this from every border have no line, in the drawing either.
const REACH: usize = 4;
/// Levels by which a pixel without a line may be off: the shader reckons in `f32`.
const LEVELS: u8 = 1;
/// The daylight of made-up hours.
const DAY_HOURS: u32 = 8;
/// Levels by which a pixel at a border may be off: a drawing's finest line leaves a tenth of its ink beside the pixel.
const LINE_LEVELS: u8 = 14;

/// One view, as the window shows it and as a drawing has it.
struct Pair {
    width: usize,
    picture: Vec<[u8; 4]>,
    drawing: Vec<[u8; 3]>,
    /// Of each pixel the plane that it sees, as a number: between faces of one plane there is no line.
    seen: Vec<u32>,
}

fn sample(name: &str, at: &str) -> Site {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    Site::load(&path, &Overrides { at: at.parse().ok(), ..Overrides::default() }).expect("a sample site")
}

/// What both show.
#[derive(Clone, Copy)]
enum Content<'a> {
    Sun,
    /// Sun and shadow, components in their own colours.
    Components,
    /// Hours of shadow on a plan's cells.
    Hours(&'a Profile),
    /// Hours of sun on patches.
    Patches(&'a PatchContext<'a>),
}

/// Both see the same faces and have the same mask, of rays, so that they differ by their look alone.
fn pair(site: &Site, view: View, content: Content) -> Pair {
    let [casters, receivers] = [&site.casts, &site.receives].map(|chosen| site.mesh.of_components(chosen));
    let scene = Scene { casters, receivers, ground: site.ground.level };
    let instant = &site.track.instants[0];
    let mut rays = RayCast::new(scene.clone(), view, None);
    let (width, height) = view.size();
    let mask = match instant.night {
        true => Mask { width, height, share: vec![0; width as usize * height as usize] },
        false => rays.draw(instant.to_sun).and_then(|mask| mask.read()).expect("a mask"),
    };
    let surface = rays.surface().expect("what is seen");
    let planes = scene.receivers.planes();
    let mut numbers = HashMap::new();
    let seen = surface.face.iter().map(|&face| match planes.get(face as usize) {
        None => face,
        Some(plane) => {
            let next = numbers.len() as u32;
            *numbers.entry(plane.to_array().map(f64::to_bits)).or_insert(next)
        }
    });
    let seen = seen.collect();

    let mut picture = Picture::new(gpu(), &scene, view).expect("a picture");
    picture.look_at(&scene, view, Some(&rays.faces())).expect("another look");
    let casts: Vec<bool> =
        site.casts.iter().zip(&site.receives).filter(|(_, seen)| **seen).map(|(casts, _)| *casts).collect();
    let colours = figure::component_colours(&scene.receivers, &casts);
    let parts = scene.receivers.components.iter().zip(colours);
    picture.tint(parts.flat_map(|(part, colour)| std::iter::repeat_n(colour, part.faces.len())));
    let focus_m = site.camera.target.distance(site.camera.eye);
    let tinted = matches!(content, Content::Components);
    let hours = lay(&mut picture, site, &surface, content);
    let style = Style { focus_m, lines: 1.0, wide_lines: true, tinted, hours };
    let target = Picture::target(&gpu(), &view);
    picture.draw(&DrawnMask::Memory(&mask), instant.to_sun, &style, &target).expect("a picture");
    let picture = readback::texels(&gpu(), &target, TextureAspect::All).expect("pixels");
    let drawing = drawing(site, &view, &mask, (&scene.receivers, &surface), &casts, content);
    Pair { width: width as usize, picture, drawing, seen }
}

/// Lays hours over the picture, as the window does. Whether there are any.
fn lay(picture: &mut Picture, site: &Site, surface: &Surface, content: Content) -> bool {
    match content {
        Content::Sun | Content::Components => return false,
        Content::Hours(profile) => {
            let Grid { west, north, cell, width, height } = profile.grid;
            let bands = Bands::new(site.track.step_secs, profile.day_secs);
            let colours: Vec<_> = profile.shaded.iter().map(|shaded| bands.colour(shaded)).collect();
            let (corner, size, height_m) = ([west, north], (width, height), &surface.height_m);
            picture.lay_hours(Some(HoursRaster { corner, cell, size, colours: &colours, height_m }));
        }
        Content::Patches(found) => {
            let atlas = Atlas::of(found);
            let pages = atlas.colours(&found.bands(), found.hours.samples);
            let colours = PatchColours { patches: found.patches, patch_of: &atlas.patch_of, pages: &pages };
            picture.lay_patches(&colours).expect("patches");
        }
    }
    true
}

fn drawing(
    site: &Site,
    view: &View,
    mask: &Mask,
    (mesh, surface): (&Mesh, &Surface),
    casts: &[bool],
    content: Content,
) -> Vec<[u8; 3]> {
    let drawn = Provenance {
        technique: Method::RayCast,
        finder: None,
        engine: Engine::Cpu,
        adapter: None,
        settings: Settings::NONE,
        resolution_secs: 0,
    };
    let (place, track, ground, receivers) = (&site.place, &site.track, site.ground, Receivers::Top);
    let sheet = FigureContext { place, track, mesh, surface, receivers, ground, drawn: &drawn };
    let to_sun = track.instants[0].to_sun;
    let shown = PictureExtras::default();
    match content {
        Content::Sun => figure::bare(&sheet, view, mask, to_sun, &shown),
        Content::Components => figure::bare(&sheet, view, mask, to_sun, &PictureExtras { casts: Some(casts), ..shown }),
        Content::Hours(profile) => figure::bare_hours(&sheet, profile),
        Content::Patches(found) => figure::bare_patches(&sheet, view, found).expect("a camera or a side"),
    }
}

/// Hours of shadow, by turns in squares of eight cells.
fn hours_of(grid: Grid) -> Profile {
    let cells = 0..grid.width * grid.height;
    let square = |cell: u32| (cell % grid.width / 8 + 3 * (cell / grid.width / 8)) % (DAY_HOURS + 1);
    let shaded: Vec<u32> = cells.map(|cell| square(cell) * 3600 * 255).collect();
    Profile { grid, shaded: shaded.into(), day_secs: DAY_HOURS * 3600, night_secs: 0 }
}

/// Large texels, and hours of sun on them that differ from patch to patch and within patches.
fn hours_on_patches(site: &Site) -> (Patches, PatchHours) {
    let patches = Patches::of(&site.mesh, &site.receives, 8.0, MOST_TEXELS);
    let mut lit = vec![0; patches.texels.len()];
    for (number, patch) in patches.list.iter().enumerate() {
        let of_patch = patch.texels.start as usize..patch.texels.end as usize;
        for (lit, texel) in lit[of_patch.clone()].iter_mut().zip(&patches.texels[of_patch]) {
            let half = u32::from(texel.column > patch.width as u16 / 2);
            *lit = (number as u32 + half) % (DAY_HOURS + 1) * 3600;
        }
    }
    (patches, PatchHours { lit, samples: 1, day_secs: DAY_HOURS * 3600, night_secs: 0 })
}

/// How far two pixels are apart, levels.
fn off(picture: [u8; 4], drawing: [u8; 3]) -> u8 {
    (0..3).map(|at| picture[at].abs_diff(drawing[at])).max().unwrap_or(0)
}

/// Of pixels without a line, and of those at a border that lies alone: how many there are, and how many are off by more
/// than they may.
#[derive(Debug)]
struct Compared {
    /// All pixels.
    all: usize,
    plain: usize,
    plain_off: usize,
    border: usize,
    border_off: usize,
}

impl Compared {
    /// The share of all pixels that were compared.
    fn share(&self) -> f64 {
        (self.plain + self.border) as f64 / self.all as f64
    }

    /// At most one in ten thousand pixels without a line is off, and one in a hundred at a border.
    fn holds(&self) -> bool {
        self.plain_off * 10_000 <= self.plain && self.border_off * 100 <= self.border
    }
}

impl Pair {
    /// Which planes are seen within a distance in pixels.
    fn planes_near(&self, pixel: usize, reach: usize) -> BTreeSet<u32> {
        let (column, row) = (pixel % self.width, pixel / self.width);
        let rows = self.seen.len() / self.width;
        let span = |at: usize, most: usize| at.saturating_sub(reach)..(at + reach + 1).min(most);
        span(row, rows).flat_map(|y| &self.seen[y * self.width..][span(column, self.width)]).copied().collect()
    }

    /// Whether another plane is seen in the next pixel, along the row or the column.
    fn is_at_border(&self, pixel: usize) -> bool {
        let seen = &self.seen;
        let other = |at: Option<usize>| at.and_then(|at| seen.get(at)).is_some_and(|there| *there != seen[pixel]);
        let column = pixel % self.width;
        other((column > 0).then(|| pixel - 1))
            || other((column + 1 < self.width).then(|| pixel + 1))
            || other(pixel.checked_sub(self.width))
            || other(Some(pixel + self.width))
    }

    fn compare(&self) -> Compared {
        let mut compared = Compared { all: self.picture.len(), plain: 0, plain_off: 0, border: 0, border_off: 0 };
        for (pixel, (picture, drawing)) in self.picture.iter().zip(&self.drawing).enumerate() {
            let off = off(*picture, *drawing);
            match self.planes_near(pixel, REACH).len() {
                1 => {
                    compared.plain += 1;
                    compared.plain_off += usize::from(off > LEVELS);
                }
                2 if self.is_at_border(pixel) => {
                    compared.border += 1;
                    compared.border_off += usize::from(off > LINE_LEVELS);
                }
                // no border's own line alone
                _ => {}
            }
        }
        compared
    }
}

/// A sample's views, in few pixels.
fn views(site: &Site) -> [(&'static str, View); 3] {
    let camera = Camera { width: 480, height: 300, ..site.camera };
    let step = f64::from(site.grid.width.max(site.grid.height)) / 400.0;
    let size = |cells: u32| (f64::from(cells) / step) as u32;
    let Grid { width, height, cell, .. } = site.grid;
    let grid = Grid { width: size(width), height: size(height), cell: cell * step, ..site.grid };
    [("camera", View::Camera(camera)), ("plan", View::Plan(grid)), ("side", View::Elevation(camera.side(Side::South)))]
}

#[test]
fn the_windows_picture_has_the_drawings_look() {
    for (name, at) in [
        ("industry", "2026-09-18T16:00"),
        ("industry", "2026-12-21T09:00"),
        ("industry", "2026-09-18T23:00"),
        ("tower", "2026-06-21T13:00"),
    ] {
        let site = sample(name, at);
        for (word, view) in views(&site) {
            let compared = pair(&site, view, Content::Sun).compare();
            assert!(compared.plain > 10_000 && compared.border > 500, "{name} {at} {word}: {compared:?}");
            assert!(compared.share() > 0.5, "{name} {at} {word}: {:.2}, {compared:?}", compared.share());
            assert!(compared.holds(), "{name} {at} {word}: {compared:?}");
        }
    }
}

/// On the plan terrain has the ground's colours and lines in the window, too.
#[test]
fn terrain_has_the_drawings_look() {
    let plain = sample("industry", "2026-09-18T16:00");
    let view = views(&plain)[1].1;
    let mut site = plain.clone();
    site.mesh.components.iter_mut().step_by(2).for_each(|component| component.is_terrain = true);
    let mut terrain = pair(&site, view, Content::Sun);
    assert!(terrain.compare().holds(), "{:?}", terrain.compare());
    terrain.picture = pair(&plain, view, Content::Sun).picture;
    assert!(!terrain.compare().holds(), "terrain drawn as roofs: {:?}", terrain.compare());
}

#[test]
fn components_have_the_drawings_look() {
    let site = sample("industry", "2026-09-18T16:00");
    let view = views(&site)[0].1;
    let compared = pair(&site, view, Content::Components).compare();
    assert!(compared.holds(), "{compared:?}");
}

/// With hours by day and by night, in which hours are shown, too.
#[test]
fn hours_have_the_drawings_look() {
    for (name, at) in
        [("industry", "2026-09-18T16:00"), ("industry", "2026-09-18T23:00"), ("tower", "2026-06-21T13:00")]
    {
        let site = sample(name, at);
        let (patches, hours) = hours_on_patches(&site);
        let Site { place, track, mesh, receives, .. } = &site;
        let found = PatchContext { place, track, mesh, receives, patches: &patches, hours: &hours };
        for (word, view) in views(&site) {
            let profile;
            let content = match view {
                View::Plan(grid) => {
                    profile = hours_of(grid);
                    Content::Hours(&profile)
                }
                View::Camera(_) | View::Elevation(_) => Content::Patches(&found),
            };
            let compared = pair(&site, view, content).compare();
            assert!(compared.plain > 10_000 && compared.border > 500, "{name} {at} {word}: {compared:?}");
            assert!(compared.holds(), "{name} {at} {word}: {compared:?}");
        }
    }
}

/// What had drifted is seen: the ground around façades was darker in the window.
#[test]
fn another_ground_around_facades_is_seen() {
    let site = sample("tower", "2026-06-21T13:00");
    let (patches, hours) = hours_on_patches(&site);
    let Site { place, track, mesh, receives, .. } = &site;
    let found = PatchContext { place, track, mesh, receives, patches: &patches, hours: &hours };
    let mut pair = pair(&site, views(&site)[0].1, Content::Patches(&found));
    assert!(pair.compare().holds());
    for (pixel, _) in pair.picture.iter_mut().zip(&pair.seen).filter(|(_, seen)| **seen == Surface::GROUND) {
        *pixel = [226, 222, 210, 255];
    }
    assert!(!pair.compare().holds(), "another ground: {:?}", pair.compare());
}

/// What had drifted is seen: the ground's line in a side was stronger in the window.
#[test]
fn a_line_that_is_too_strong_and_a_colour_that_is_off_are_seen() {
    let site = sample("tower", "2026-06-21T13:00");
    let view = views(&site)[2].1;
    let mut pair = pair(&site, view, Content::Sun);
    assert!(pair.compare().holds());
    let is_open = |face: u32| face >= Surface::GROUND;
    let width = pair.width;
    let right = pair.picture.clone();
    let parts = |a: u32, b: u32| a != b && is_open(a) && is_open(b);
    for (pixel, right) in right.iter().enumerate() {
        let face = &pair.seen;
        let above = pixel >= width && parts(face[pixel], face[pixel - width]);
        let below = pixel + width < face.len() && parts(face[pixel], face[pixel + width]);
        if above || below {
            let stronger = (1.0 - 0.9) / (1.0 - f64::from(LOOK.step));
            let ink = |at: usize| f64::from(LOOK.line[at]);
            let part = |at: usize| (ink(at) + (f64::from(right[at]) - ink(at)) * stronger).round() as u8;
            pair.picture[pixel] = [part(0), part(1), part(2), 255];
        }
    }
    assert!(!pair.compare().holds(), "a line of another strength: {:?}", pair.compare());
    pair.picture = right;
    pair.picture.iter_mut().for_each(|pixel| pixel[2] = pixel[2].saturating_sub(LEVELS + 1));
    assert!(!pair.compare().holds(), "a colour that is off: {:?}", pair.compare());
}
