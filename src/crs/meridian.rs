//! The central meridian of a transverse Mercator map, which is invalid far from it.

/// The greatest distance from the central meridian that is used in practice, degrees at the equator: Norway's map in
/// one UTM zone reaches 6.
const FAR_DEG: f64 = 10.0;

/// The latitude at which UTM ends, degrees.
const UTM_ENDS_DEG: f64 = 84.0;

/// The central meridian of a transverse Mercator map.
#[derive(Clone, Copy)]
pub(super) struct MiddleMeridian {
    longitude_deg: f64,
    is_utm: bool,
}

impl MiddleMeridian {
    /// Reads it from a definition in PROJ's text; `None` for other projections, and for meridians not counted from
    /// Greenwich.
    pub(super) fn of(text: &str) -> Option<MiddleMeridian> {
        let value = |key: &str| {
            text.split_whitespace().find_map(|token| token.trim_start_matches('+').strip_prefix(key)?.strip_prefix('='))
        };
        if value("pm").is_some_and(|meridian| meridian != "greenwich") {
            return None;
        }
        match value("proj")? {
            "utm" => {
                let zone: f64 = value("zone")?.parse().ok()?;
                Some(MiddleMeridian { longitude_deg: zone * 6.0 - 183.0, is_utm: true })
            }
            "tmerc" | "etmerc" => {
                let longitude_deg = value("lon_0").map_or(Some(0.0), |degrees| degrees.parse().ok())?;
                Some(MiddleMeridian { longitude_deg, is_utm: false })
            }
            _ => None,
        }
    }

    /// Whether a point, in degrees, is far outside of its map.
    pub(super) fn is_far_from(self, latitude_deg: f64, longitude_deg: f64) -> bool {
        let beside = (longitude_deg - self.longitude_deg + 180.0).rem_euclid(360.0) - 180.0;
        let is_beside = (beside * latitude_deg.to_radians().cos()).abs() > FAR_DEG || beside.abs() > 90.0;
        is_beside || (self.is_utm && latitude_deg.abs() > UTM_ENDS_DEG)
    }
}
