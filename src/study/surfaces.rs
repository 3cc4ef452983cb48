//! provisional
use super::{Event, OnEvent, Stopwatch, StudyError, tell};
use crate::mesh::Mesh;
use crate::mesh::patches::{MOST_TEXELS, Patches};
use crate::profile::surfaces::SurfaceHours;
use crate::profile::{Drawn, Timings};
use crate::shadow::ray_cast::{RayCast, RayCaster, Shear};
use crate::shadow::Scene;
use crate::shadow::Technique;
use crate::site::Site;
use crate::view::{Surface, View};

pub struct Outcome { pub mesh: Mesh, pub patches: Patches, pub hours: SurfaceHours, pub drawn: Drawn, pub surface: Option<Surface>, pub timings: Timings }

pub fn run(site: &Site, wants_surface: bool, on_event: &mut OnEvent<'_>) -> Result<Outcome, StudyError> {
    let watch = Stopwatch::start();
    let mesh = site.mesh.of_components(&site.receives);
    let patches = Patches::of(&mesh, &vec![true; mesh.components.len()], site.patch_cell, MOST_TEXELS);
    let casters = site.mesh.of_components(&site.casts);
    let caster = RayCaster::new(&casters, 10_000.0);
    let mut lit = vec![0; patches.texels.len()];
    let (day_secs, night_secs) = super::day_and_night(&site.track)?;
    tell(on_event, Event::Started { instants: site.track.instants.len() })?;
    for instant in &site.track.instants {
        if instant.night { continue; }
        let shear = Shear::along(instant.to_sun);
        for patch in &patches.list {
            let side = patch.normal().dot(instant.to_sun);
            if side.abs() < 1e-9 || (side < 0.0 && !patch.two_sided) { continue; }
            let up = patch.normal() * side.signum() * 0.001;
            for at in patch.texels.start as usize..patch.texels.end as usize {
                let point = patches.point(patch, patches.texels[at]) + up;
                if !caster.blocked(point, &shear) { lit[at] += instant.weight_secs; }
            }
        }
    }
    let hours = SurfaceHours { lit, samples: 1, day_secs, night_secs };
    let surface = wants_surface.then(|| {
        let scene = Scene { casters: site.mesh.of_components(&[]), receivers: mesh.clone(), ground: site.ground };
        RayCast::new(scene, View::Camera(site.camera), None).surface()
    }).transpose()?;
    Ok(Outcome { mesh, patches, hours, drawn: Drawn { technique: "ray-cast", silhouette: None, engine: "cpu", adapter: None }, surface, timings: watch.stages })
}
