//! A house on a slope in Salzburg, with the files that an architect gets: the house as IFC, its neighbours as
//! footprints, the terrain as a raster. Each file has coordinates of its own; the site tests that they meet.

mod footprints;
mod house;
mod step;
mod terrain;

/// Degrees of the place.
const LATITUDE: f64 = 47.8;
const LONGITUDE: f64 = 13.04;
/// The same point in EPSG:25833 (UTM zone 33, ETRS89), metres, by Krüger's series.
const EASTING: f64 = 353_231.365_5;
const NORTHING: f64 = 5_295_931.48;
/// How easting and northing grow with the degrees there: with latitude, and with longitude. Within 200 m of the place this is
/// right to some millimetres.
const PER_LATITUDE: [f64; 2] = [2_817.479_5, 111_135.679_6];
const PER_LONGITUDE: [f64; 2] = [74_879.135_2, -1_898.314_1];

/// The files of the site.
pub(crate) fn files() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("hillside/house.ifc", house::ifc().into_bytes()),
        ("hillside/neighbours.geojson", footprints::geojson().into_bytes()),
        ("hillside/terrain.asc", terrain::ascii_grid().into_bytes()),
    ]
}

/// Metres above the sea at a point, metres east and north of the place on the map: a slope that rises to the north, and a
/// ridge in the south-west, behind which the winter's sun sets.
fn height(east: f64, north: f64) -> f64 {
    let slope = 430.0 + 0.11 * north + 0.02 * east;
    let across = (north + 150.0 + 0.35 * (east + 60.0)) / 45.0;
    let along = (east + 130.0) / 110.0;
    let ridge = 34.0 * (-across * across - along * along).exp();
    let terrace = 0.6 * (east / 37.0).sin() * (north / 29.0).cos();
    slope + ridge + terrace
}

/// Longitude and latitude of a point, metres east and north of the place on the map.
fn degrees(east: f64, north: f64) -> [f64; 2] {
    let [[a, c], [b, d]] = [PER_LONGITUDE, PER_LATITUDE];
    let determinant = a * d - b * c;
    [LONGITUDE + (d * east - b * north) / determinant, LATITUDE + (a * north - c * east) / determinant]
}
