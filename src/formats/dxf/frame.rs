//! The axes of an entity in a plane of its own. DXF gives only the plane's normal; its "arbitrary axis algorithm"
//! determines the axes.

use glam::{DMat3, DVec3};

/// The rotation from an object's coordinates, whose z is the extrusion direction, to the world's.
pub(super) fn world_from_object(extrusion: DVec3) -> DMat3 {
    const NEAR_VERTICAL: f64 = 1.0 / 64.0;
    let Some(z) = extrusion.try_normalize() else { return DMat3::IDENTITY };
    let is_near = z.x.abs() < NEAR_VERTICAL && z.y.abs() < NEAR_VERTICAL;
    let x = if is_near { DVec3::Y.cross(z) } else { DVec3::Z.cross(z) };
    let Some(x) = x.try_normalize() else { return DMat3::IDENTITY };
    DMat3::from_cols(x, z.cross(x), z)
}

/// The length of a unit in metres for a value of `$INSUNITS`; `None` for "unitless" and unknown values.
pub(super) fn metres(unit: i64) -> Option<f64> {
    const FOOT: f64 = 0.3048;
    const SURVEY_FOOT: f64 = 1200.0 / 3937.0;
    Some(match unit {
        1 => FOOT / 12.0,
        2 => FOOT,
        3 => FOOT * 5280.0,
        4 => 0.001,
        5 => 0.01,
        6 => 1.0,
        7 => 1000.0,
        8 => FOOT / 12.0 * 1e-6,
        9 => FOOT / 12.0 * 1e-3,
        10 => FOOT * 3.0,
        13 => 1e-6,
        14 => 0.1,
        15 => 10.0,
        16 => 100.0,
        21 => SURVEY_FOOT,
        22 => SURVEY_FOOT / 12.0,
        23 => SURVEY_FOOT * 3.0,
        24 => SURVEY_FOOT * 5280.0,
        _ => return None,
    })
}
