//! Draws a picture without a graphics adapter: sun and shadow by rays, in the colours of drawings.

use crate::choice::{Engine, Method, Receivers, Settings};
use crate::deliver::instant::seen_casts;
use crate::deliver::{DrawnView, figure_context};
use crate::desktop::stage::wish::Wish;
use crate::export::figure::{self, PictureExtras};
use crate::profile::Provenance;
use crate::shadow::ray_cast::RayCast;
use crate::shadow::{Scene, ShadowError, Technique};
use crate::study::live::far_view;
use crate::view::Mask;

/// What is kept from one picture to the next.
pub(in crate::desktop) struct PlainDrawer {
    /// The site's number, and the number of the sun's points.
    of: (u64, Option<u32>),
    scene: Scene,
    rays: RayCast,
}

/// Draws a wish, without overlays: the pixels, row 0 first, and the provenance.
///
/// # Errors
/// Errors of ray casting.
pub(in crate::desktop) fn draw(
    kept: &mut Option<PlainDrawer>,
    wish: &Wish,
) -> Result<(Vec<[u8; 4]>, Provenance), ShadowError> {
    let sun_samples = wish.way.settings.sun_samples;
    let site = &*wish.site;
    let new = || {
        let casters = site.mesh.of_components(&site.casts);
        let receivers = site.mesh.of_components(&site.receives);
        let scene = Scene { casters, receivers, ground: site.ground.level };
        let rays = RayCast::new(scene.clone(), far_view(&scene), sun_samples);
        PlainDrawer { of: (wish.number, sun_samples), scene, rays }
    };
    let at_hand = kept.take().filter(|plain| plain.of == (wish.number, sun_samples));
    let plain = kept.insert(at_hand.unwrap_or_else(new));
    if plain.rays.view() != wish.view {
        plain.rays.look_at(wish.view);
    }
    let (width, height) = wish.view.size();
    let mask = match wish.to_sun.z > 0.0 {
        true => plain.rays.draw(wish.to_sun)?.read()?,
        false => Mask { width, height, share: vec![0; width as usize * height as usize] },
    };
    let provenance = Provenance {
        technique: Method::RayCast,
        finder: None,
        engine: Engine::Cpu,
        adapter: None,
        settings: Settings { sun_samples, ..Settings::NONE },
        resolution_secs: 0,
    };
    let (mesh, surface) = (&plain.scene.receivers, &plain.rays.surface()?);
    let scene = figure_context(site, DrawnView { receivers: Receivers::Top, surface, mesh, drawn: &provenance });
    let casts = seen_casts(site);
    let shown = PictureExtras { casts: wish.style.tinted.then_some(casts.as_slice()), ..PictureExtras::default() };
    let pixels = figure::bare(&scene, &wish.view, &mask, wish.to_sun, &shown);
    Ok((pixels.into_iter().map(|[red, green, blue]| [red, green, blue, 255]).collect(), provenance))
}
