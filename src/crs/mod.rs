//! Converts coordinates of a map or of the Earth to longitude and latitude, and to metres around a place.
//!
//! The definitions of the EPSG dataset come from `crs-definitions`, the arithmetic from `proj4rs`. Datums are shifted
//! by the three or seven parameters of the definition, where surveyors would use grids. Heights above the sea are not
//! changed: a datum shift moves a point horizontally only, since nobody measures heights from an old ellipsoid.

mod convert;
mod datums;
mod definition;
mod heights;
mod local;
mod meridian;
mod names;
mod wkt;

pub use convert::MapToLocal;
pub use heights::vertical_unit_m;
pub use local::{LocalFrame, TOO_FAR_M};

use crate::message::{Message, message};
use definition::{Definition, shortened};
use glam::DVec3;
use meridian::MiddleMeridian;
use proj4rs::Proj;
use proj4rs::transform::transform;
use std::sync::LazyLock;

/// The longest text that is read as a reference system.
const MOST_BYTES: usize = 64 * 1024;

/// A point belongs to a map if converting it there and back moves it by at most this, metres.
const COMES_BACK_M: f64 = 1.0;

/// Coordinates this close to a map's origin are a drawing's own and not the map's, if the map has a false easting or
/// northing of at least this, metres.
const NEAR_ZERO_M: f64 = 5_000.0;
const FALSE_ORIGIN_M: f64 = 100_000.0;

/// The distance to either side of a point over which the direction of the map's north is measured, metres.
const STEP_M: f64 = 50.0;

/// Longitudes and latitudes in WGS 84, in radians, as `proj4rs` expects them.
static WGS84: LazyLock<Option<Proj>> =
    LazyLock::new(|| Proj::from_proj_string("+proj=longlat +datum=WGS84 +no_defs").ok());

/// The WGS 84 ellipsoid: its semi-major axis in metres, and the square of its eccentricity.
const RADIUS_M: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARED: f64 = 0.006_694_379_990_141_316;

/// A point of the Earth in WGS 84.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeodeticPoint {
    /// Degrees, north positive.
    pub latitude_deg: f64,
    /// Degrees, east positive.
    pub longitude_deg: f64,
    /// Metres above the sea.
    pub height_m: f64,
}

/// A coordinate reference system.
#[derive(Clone)]
pub struct Crs {
    proj: Proj,
    name: String,
    kind: CrsKind,
    /// The unit of heights in metres, if the system has its own.
    height_unit_m: Option<f64>,
    /// The datum shift to WGS 84; empty if there is none.
    shift: String,
    doubt: Option<&'static str>,
    meridian: Option<MiddleMeridian>,
}

/// The kinds of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrsKind {
    /// Eastings and northings on a map.
    Projected,
    /// Longitudes and latitudes, in degrees.
    Geographic,
    /// x, y, z from the middle of the Earth.
    EarthCentred,
}

impl std::fmt::Debug for Crs {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Crs({})", self.name)
    }
}

impl Crs {
    /// Reads a reference system as a file or a person writes it: `EPSG:25832`, its forms as URN or URL, a compound
    /// system, a name, WKT, or PROJ's text.
    ///
    /// # Errors
    /// What is wrong, and a hint; the subject is the text.
    pub fn read(text: &str) -> Result<Crs, Message> {
        let text = text.trim();
        if text.is_empty() || text.len() > MOST_BYTES {
            return Err(message!["a reference system must be named"; "write for example \"EPSG:25832\""]);
        }
        let found = if text.contains('[') { wkt::definition(text)? } else { names::definition(text)? };
        Self::of(found, text)
    }

    fn of(found: Definition, text: &str) -> Result<Crs, Message> {
        let Definition { name, proj: definition, height_unit_m, doubt } = found;
        let unusable = |why: String| {
            message![
                format!("{} cannot be used: {why}", shortened(text));
                "export the model in another system, such as UTM on WGS 84 or ETRS89"
            ]
        };
        let usable = datums::usable(&definition).map_err(|why| unusable(why.to_owned()))?;
        let proj = Proj::from_proj_string(&usable.text).map_err(|error| unusable(error.to_string()))?;
        let kind = match () {
            () if proj.is_latlong() => CrsKind::Geographic,
            () if proj.is_geocent() => CrsKind::EarthCentred,
            () => CrsKind::Projected,
        };
        // without an inverse, no point of the map can be converted to the Earth
        if !(proj.has_inverse() && proj.to_meter().is_finite() && proj.to_meter() > 0.0) {
            return Err(unusable("its projection has no inverse here".to_owned()));
        }
        let height_unit_m = height_unit_m.or_else(|| usable.text.contains("+vunits=").then(|| proj.vto_meter()));
        let meridian = MiddleMeridian::of(&usable.text);
        Ok(Crs { proj, name, kind, height_unit_m, shift: usable.shift, doubt: doubt.or(usable.doubt), meridian })
    }

    /// Its name in messages: `EPSG:25832 (ETRS89 / UTM zone 32N)`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The kind of its coordinates.
    pub fn kind(&self) -> CrsKind {
        self.kind
    }

    /// The length of a unit of its eastings and northings in metres; 1 if they are degrees.
    pub fn unit_m(&self) -> f64 {
        if self.kind == CrsKind::Geographic { 1.0 } else { self.proj.to_meter() }
    }

    /// The length of a unit of its heights in metres, if it has its own.
    pub fn height_unit_m(&self) -> Option<f64> {
        self.height_unit_m
    }

    /// The parameters by which its datum is shifted to WGS 84; empty if the two agree to a metre.
    pub fn shift(&self) -> &str {
        &self.shift
    }

    /// A clause on why positions in it may be wrong by more than a few metres.
    pub fn doubt(&self) -> Option<&'static str> {
        self.doubt
    }

    /// Converts a point of the map to the Earth; `None` outside of the map.
    ///
    /// x and y are in the system's units, or degrees; z is in metres and is not changed. In a geocentric system all
    /// three are in its unit, and the resulting height is above the ellipsoid.
    pub fn to_wgs84(&self, at: DVec3) -> Option<GeodeticPoint> {
        if !at.is_finite() {
            return None;
        }
        let mut point = match self.kind {
            CrsKind::Geographic if at.x.abs() > 720.0 || at.y.abs() > 90.0 + 1e-9 => return None,
            CrsKind::Geographic => (at.x.to_radians(), at.y.to_radians(), 0.0),
            CrsKind::EarthCentred => (at.x, at.y, at.z),
            CrsKind::Projected => (at.x, at.y, 0.0),
        };
        transform(&self.proj, WGS84.as_ref()?, &mut point).ok()?;
        let height_m = if self.kind == CrsKind::EarthCentred { point.2 } else { at.z };
        let turned = (point.0.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
        let found = GeodeticPoint { latitude_deg: point.1.to_degrees(), longitude_deg: turned, height_m };
        let is_point = found.latitude_deg.abs() <= 90.0 && turned.is_finite() && height_m.is_finite();
        is_point.then_some(found)
    }

    /// Whether a point is far outside of the map, so that its coordinates probably belong to another map, unit or axis
    /// order. Definitions have no area of use; this is what arithmetic can tell.
    pub fn is_far_outside(&self, at: DVec3) -> bool {
        if self.kind != CrsKind::Projected {
            return false;
        }
        let Some(on_earth) = self.to_wgs84(at) else { return true };
        let is_beside =
            self.meridian.is_some_and(|meridian| meridian.is_far_from(on_earth.latitude_deg, on_earth.longitude_deg));
        let to_m = self.proj.to_meter();
        let is_kept_away =
            self.proj.false_easting().abs() >= FALSE_ORIGIN_M || self.proj.false_northing().abs() >= FALSE_ORIGIN_M;
        let is_at_zero = is_kept_away && at.truncate().length() * to_m < NEAR_ZERO_M;
        is_beside || is_at_zero || !self.comes_back(on_earth, at)
    }

    /// Whether converting a point of the Earth gives the point of the map again.
    fn comes_back(&self, on_earth: GeodeticPoint, at: DVec3) -> bool {
        let mut point = (on_earth.longitude_deg.to_radians(), on_earth.latitude_deg.to_radians(), 0.0);
        let found = WGS84.as_ref().and_then(|wgs84| transform(wgs84, &self.proj, &mut point).ok());
        let apart_m = (point.0 - at.x).hypot(point.1 - at.y) * self.proj.to_meter();
        found.is_some() && apart_m <= COMES_BACK_M
    }

    /// The meridian convergence at a point of the map: radians clockwise from true north to the map's north. `None`
    /// outside of the map, and for geocentric coordinates, which have no north.
    pub fn convergence_rad(&self, easting: f64, northing: f64) -> Option<f64> {
        let step = match self.kind {
            CrsKind::EarthCentred => return None,
            CrsKind::Geographic => STEP_M / RADIUS_M.to_radians(),
            CrsKind::Projected => STEP_M / self.unit_m(),
        };
        let [south, north] = [-step, step].map(|by| self.to_wgs84(DVec3::new(easting, northing + by, 0.0)));
        let (south, north) = (south?, north?);
        let latitude = ((south.latitude_deg + north.latitude_deg) / 2.0).to_radians();
        let turned = (north.longitude_deg - south.longitude_deg + 180.0).rem_euclid(360.0) - 180.0;
        // the ellipsoid's radii of curvature along the parallel and the meridian
        let w = 1.0 - ECCENTRICITY_SQUARED * latitude.sin().powi(2);
        let (along_parallel, along_meridian) = (latitude.cos(), (1.0 - ECCENTRICITY_SQUARED) / w);
        let east = turned * along_parallel;
        let up = (north.latitude_deg - south.latitude_deg) * along_meridian;
        (east != 0.0 || up != 0.0).then(|| east.atan2(up))
    }
}
