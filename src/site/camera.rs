//! The camera of the request, or a default one: three-quarter, from the sunlit side, with models and shadows in view,
//! or straight at a side with the models in view.

use super::error::SiteError;
use super::extent::Bounds;
use super::keys;
use super::overrides::{Overrides, refuse};
use super::written::WrittenSite;
use crate::choice::ChoiceError;
use crate::message::message;
use crate::sun::SunTrack;
use crate::view::{Camera, Side};
use glam::{DVec2, DVec3};

const WIDTH: u32 = 1600;
const HEIGHT: u32 = 1000;
const WIDTH_BY_HEIGHT: f64 = WIDTH as f64 / HEIGHT as f64;
const FOV_DEG: f64 = 40.0;
/// The default eye's altitude above the horizon as seen from the target, degrees.
const ELEVATION_DEG: f64 = 32.0;
/// The angle in plan between the default eye and the sun, degrees, turned east so that walls differ in brightness.
const ASIDE_DEG: f64 = 35.0;
/// The factor by which the picture is larger than its contents.
const MARGIN: f64 = 1.06;

/// The side that is shown instead of the perspective, as set by a face or in the site file.
pub(super) fn side(written: &WrittenSite, asked: &Overrides) -> Result<Option<Side>, SiteError> {
    match (asked.side, &written.site.camera.side) {
        (None, Some(word)) => {
            let read = word.parse().map(Some);
            read.map_err(|error: ChoiceError| refuse(written.key("camera", "side"), error.to_string()))
        }
        (side, _) => Ok(side),
    }
}

/// The camera; or, for a side, the one that sees the same extent. `shadows` are the south-west and north-east corners
/// of what should be in view on the ground.
pub(super) fn camera(
    written: &WrittenSite,
    side: Option<Side>,
    bounds: Bounds,
    shadows: [DVec2; 2],
    ground: f64,
    track: &SunTrack,
) -> Result<Camera, SiteError> {
    let table = &written.site.camera;
    let fault = |key: &str, what: String| {
        let example = keys::example("camera", key);
        refuse(written.key("camera", key), message![what; format!("write for example {example}")])
    };
    let vector = |key: &str, value: Option<[f64; 3]>| match value.map(DVec3::from_array) {
        Some(vector) if !vector.is_finite() => Err(fault(key, format!("{vector} is not a point"))),
        vector => Ok(vector),
    };
    let fov_deg = table.fov.unwrap_or(FOV_DEG);
    // A NaN is not between them either.
    if !(1.0..=170.0).contains(&fov_deg) {
        return Err(fault("fov", format!("{fov_deg} is not between 1 and 170 degrees")));
    }
    let fov_rad = fov_deg.to_radians();
    let up = vector("up", table.up)?.unwrap_or(DVec3::Z);
    let Some(up) = up.try_normalize() else {
        return Err(fault("up", "it has no length".to_owned()));
    };

    let [target, eye] = [vector("target", table.target)?, vector("eye", table.eye)?];
    // If only an option asks for a side, the eye and the target in the file belong to the perspective.
    let [target, eye] = if side.is_none() || table.side.is_some() { [target, eye] } else { [None, None] };
    let latitude = written.site.place.as_ref().and_then(|place| place.latitude);
    let back = direction_to_eye(latitude, track);
    let target = target.unwrap_or_else(|| match side {
        Some(side) => side.around(above(bounds, ground), WIDTH_BY_HEIGHT).0,
        None => middle(bounds, shadows),
    });
    let eye = eye.unwrap_or_else(|| {
        let far = match side {
            // from this eye the perspective sees the same extent at its target
            Some(side) => {
                side.height_about(target, above(bounds, ground), WIDTH_BY_HEIGHT) / 2.0 / (fov_rad / 2.0).tan()
            }
            None => distance(back, target, fov_rad, bounds, shadows, ground),
        };
        target + back * far
    });
    let Some(forward) = (target - eye).try_normalize() else {
        return Err(fault("eye", "it is the same point as the target".to_owned()));
    };
    if forward.cross(up).length() < 1e-6 {
        return Err(fault("up", "it is the direction of view, so no direction is up in the picture".to_owned()));
    }
    Ok(Camera { eye, target, up, fov_rad, width: WIDTH, height: HEIGHT })
}

/// The default perspective.
pub(super) fn found(latitude: f64, bounds: Bounds, shadows: [DVec2; 2], ground: f64, track: &SunTrack) -> Camera {
    let (target, fov_rad) = (middle(bounds, shadows), FOV_DEG.to_radians());
    let back = direction_to_eye(Some(latitude), track);
    let eye = target + back * distance(back, target, fov_rad, bounds, shadows, ground);
    Camera { eye, target, up: DVec3::Z, fov_rad, width: WIDTH, height: HEIGHT }
}

/// The middle between the models and the ground in view, so that neither is at the picture's edge.
fn middle(bounds: Bounds, shadows: [DVec2; 2]) -> DVec3 {
    let (centre, middle) = (bounds.centre(), (shadows[0] + shadows[1]) / 2.0);
    ((centre.truncate() + middle) / 2.0).extend(centre.z)
}

/// From the target to the default eye, unit length.
fn direction_to_eye(latitude: Option<f64>, track: &SunTrack) -> DVec3 {
    let day = track.instants.iter().filter(|instant| !instant.night);
    let sun: DVec2 = day.map(|instant| instant.to_sun.truncate()).sum();
    // Without a sun, or with suns all around, look from where the sun is at noon.
    let southern = latitude.is_some_and(|latitude| latitude < 0.0);
    let noon_side = if southern { DVec2::Y } else { DVec2::NEG_Y };
    let sunlit = sun.try_normalize().unwrap_or(noon_side);
    // Towards the east: counter-clockwise seen from above where the sun stands in the south.
    let turn = if sunlit.y > 0.0 { -ASIDE_DEG } else { ASIDE_DEG };
    let aside = DVec2::from_angle(turn.to_radians()).rotate(sunlit);
    let (sin, cos) = ELEVATION_DEG.to_radians().sin_cos();
    (aside * cos).extend(sin)
}

/// The part of the models that a side shows: from the ground upwards.
fn above(bounds: Bounds, ground: f64) -> (DVec3, DVec3) {
    (bounds.low.with_z(ground), bounds.high.with_z(bounds.high.z.max(ground)))
}

/// How far back the eye must be to see all corners.
fn distance(back: DVec3, target: DVec3, fov_rad: f64, bounds: Bounds, shadows: [DVec2; 2], ground: f64) -> f64 {
    let right = DVec3::Z.cross(back).normalize_or(DVec3::X);
    let up = back.cross(right);
    let half_height = (fov_rad / 2.0).tan();
    let half_width = half_height * WIDTH_BY_HEIGHT;
    let at = |x: [f64; 2], y: [f64; 2], z: f64| {
        x.into_iter().flat_map(move |x| y.into_iter().map(move |y| DVec3::new(x, y, z)))
    };
    let (low, high) = (bounds.low, bounds.high);
    at([low.x, high.x], [low.y, high.y], low.z)
        .chain(at([low.x, high.x], [low.y, high.y], high.z))
        .chain(at([shadows[0].x, shadows[1].x], [shadows[0].y, shadows[1].y], ground))
        .map(|corner| {
            let corner = corner - target;
            let aside = (corner.dot(right).abs() / half_width).max(corner.dot(up).abs() / half_height);
            corner.dot(back) + aside * MARGIN
        })
        // a model of no size still needs a distance
        .fold(1.0, f64::max)
}
