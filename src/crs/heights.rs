//! The units of vertical systems, which the projection library does not know.

const US_SURVEY_FOOT_M: f64 = 1200.0 / 3937.0;

/// All vertical systems of the EPSG dataset that are not in metres, with the metres of their unit.
const IN_FEET: &[(u32, f64)] = &[
    (5614, 0.3048),
    (5702, US_SURVEY_FOOT_M),
    (5754, 0.304_800_749_1),
    (6130, 0.3048),
    (6131, 0.3048),
    (6132, 0.3048),
    (6358, US_SURVEY_FOOT_M),
    (6359, US_SURVEY_FOOT_M),
    (6360, US_SURVEY_FOOT_M),
    (8050, 0.3048),
    (8051, 0.3048),
    (8052, US_SURVEY_FOOT_M),
    (8053, US_SURVEY_FOOT_M),
    (8228, 0.3048),
    (8897, 0.3048),
];

/// Returns the unit of a vertical system in metres, by its code. The codes of vertical datums in the first GeoTIFF have
/// no unit.
pub fn vertical_unit_m(code: u32) -> Option<f64> {
    match (IN_FEET.iter().find(|(known, _)| *known == code), code) {
        (Some((_, unit_m)), _) => Some(*unit_m),
        (None, 5001..=5033 | 5101..=5106) => None,
        (None, 1024..=32766) => Some(1.0),
        _ => None,
    }
}
