//! The site's frame: azimuthal equidistant around the place.

use super::{Crs, CrsKind, GeodeticPoint};
use glam::{DVec2, DVec3};
use proj4rs::Proj;
use proj4rs::transform::transform;

/// The distance beyond which a model cannot be described in the flat frame, metres.
pub const TOO_FAR_M: f64 = 2.0e6;

/// The distance to either side of a point over which directions are measured, metres.
const STEP_M: f64 = 50.0;

/// Metres east and north of a place on the WGS 84 ellipsoid, with true distances and directions from it, and heights
/// above its elevation. It is also the frame of the GeoTIFF of hours.
#[derive(Clone)]
pub struct LocalFrame {
    proj: Proj,
    longlat: Proj,
    place: GeodeticPoint,
}

impl std::fmt::Debug for LocalFrame {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "LocalFrame({:?})", self.proj.latitude_of_origin())
    }
}

impl LocalFrame {
    /// The frame around a point; `None` if that is not a point of the Earth.
    pub fn around(place: GeodeticPoint) -> Option<LocalFrame> {
        let GeodeticPoint { latitude_deg, longitude_deg, height_m } = place;
        if !(latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 360.0 && height_m.is_finite()) {
            return None;
        }
        let text = format!("+proj=aeqd +lat_0={latitude_deg} +lon_0={longitude_deg} +datum=WGS84 +units=m +no_defs");
        let longlat = Proj::from_proj_string("+proj=longlat +datum=WGS84 +no_defs").ok()?;
        Some(LocalFrame { proj: Proj::from_proj_string(&text).ok()?, longlat, place })
    }

    /// The height of its origin above the sea, metres.
    pub fn elevation_m(&self) -> f64 {
        self.place.height_m
    }

    /// The point of the Earth at its origin.
    pub fn place(&self) -> GeodeticPoint {
        self.place
    }

    /// Converts a point of the Earth to this frame; `None` if it is too far away.
    pub fn point(&self, at: GeodeticPoint) -> Option<DVec3> {
        self.anywhere(at).filter(|local| local.truncate().length() <= TOO_FAR_M)
    }

    /// The distance of a point of the Earth from the place, metres; `None` if the projection does not reach it.
    pub fn distance_m(&self, at: GeodeticPoint) -> Option<f64> {
        Some(self.anywhere(at)?.truncate().length())
    }

    fn anywhere(&self, at: GeodeticPoint) -> Option<DVec3> {
        let mut point = (at.longitude_deg.to_radians(), at.latitude_deg.to_radians(), 0.0);
        transform(&self.longlat, &self.proj, &mut point).ok()?;
        let local = DVec3::new(point.0, point.1, at.height_m - self.place.height_m);
        local.is_finite().then_some(local)
    }

    /// Converts a point of this frame to the Earth; `None` if it is too far away for the frame.
    pub fn on_earth(&self, at: DVec3) -> Option<GeodeticPoint> {
        if !(at.is_finite() && at.truncate().length() <= TOO_FAR_M) {
            return None;
        }
        let mut point = (at.x, at.y, 0.0);
        transform(&self.proj, &self.longlat, &mut point).ok()?;
        let found = GeodeticPoint {
            latitude_deg: point.1.to_degrees(),
            longitude_deg: point.0.to_degrees(),
            height_m: self.place.height_m + at.z,
        };
        (found.latitude_deg.is_finite() && found.longitude_deg.is_finite()).then_some(found)
    }

    /// The direction of true north at a point, radians clockwise from this frame's north.
    pub fn true_north_rad(&self, at: GeodeticPoint) -> Option<f64> {
        let step = STEP_M / super::RADIUS_M.to_radians();
        let beside = |by: f64| self.point(GeodeticPoint { latitude_deg: at.latitude_deg + by, ..at });
        // at a pole there is no north; next to it one side is enough
        let [south, north] = [-step, step].map(|by| beside(by).filter(|_| (at.latitude_deg + by).abs() < 90.0));
        let here = self.point(at);
        direction((north.or(here)? - south.or(here)?).truncate())
    }

    /// The direction of a map's north at one of its points, radians clockwise from this frame's north.
    pub fn map_north_rad(&self, crs: &Crs, at: DVec3) -> Option<f64> {
        let step = match crs.kind() {
            CrsKind::EarthCentred => return None,
            CrsKind::Geographic => STEP_M / super::RADIUS_M.to_radians(),
            CrsKind::Projected => STEP_M / crs.unit_m(),
        };
        let [south, north] = [-step, step].map(|by| self.point(crs.to_wgs84(at + DVec3::Y * by)?));
        direction((north? - south?).truncate())
    }
}

/// The clockwise angle from north; `None` for a zero vector.
fn direction(way: DVec2) -> Option<f64> {
    (way.length_squared() > 0.0).then(|| way.x.atan2(way.y))
}
