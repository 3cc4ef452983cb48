//! The neighbours as GeoJSON: footprints with heights, or with storeys, in longitude and latitude.

use super::degrees;
use std::fmt::Write as _;

/// A house: its middle, metres east and north of the place on the map, its length and width, and how it is turned, degrees.
struct Neighbour {
    middle: [f64; 2],
    size: [f64; 2],
    turned_deg: f64,
    /// As the footprint says how high it is.
    height: &'static str,
}

const NEIGHBOURS: [Neighbour; 12] = [
    house([-42.0, 8.0], [14.0, 10.0], 20.0, r#""height": "8.4 m""#),
    house([-45.0, -22.0], [12.0, 9.0], 15.0, r#""building:levels": "2""#),
    house([-38.0, 40.0], [13.0, 10.0], 30.0, r#""height": 9"#),
    house([-4.0, 44.0], [16.0, 10.0], 12.0, r#""height": 7.5"#),
    house([30.0, 46.0], [12.0, 12.0], 5.0, r#""building:levels": 3"#),
    house([44.0, 12.0], [15.0, 9.0], 18.0, r#""height": 8"#),
    house([46.0, -20.0], [22.0, 12.0], 22.0, r#""height": "13.5""#),
    house([4.0, -38.0], [18.0, 11.0], 14.0, r#""height": 11"#),
    house([-24.0, -48.0], [12.0, 10.0], 20.0, r#""building:levels": "2""#),
    house([34.0, -56.0], [14.0, 10.0], 10.0, r#""height": "28'""#),
    house([72.0, 30.0], [14.0, 10.0], 0.0, r#""height": 8.2"#),
    house([-76.0, 20.0], [16.0, 11.0], 25.0, r#""height": 9.6"#),
];

const fn house(middle: [f64; 2], size: [f64; 2], turned_deg: f64, height: &'static str) -> Neighbour {
    Neighbour { middle, size, turned_deg, height }
}

pub(super) fn geojson() -> String {
    let mut text = "{\"type\": \"FeatureCollection\", \"features\": [\n".to_owned();
    for (number, neighbour) in (1..).zip(&NEIGHBOURS) {
        let corners = neighbour.corners().map(|[longitude, latitude]| format!("[{longitude:.8}, {latitude:.8}]"));
        let [a, b, c, d] = &corners;
        let _ = writeln!(
            text,
            "  {{\"type\": \"Feature\", \"properties\": {{\"building\": \"house\", \"name\": \"Neighbour {number}\", {}}},\n   \
             \"geometry\": {{\"type\": \"Polygon\", \"coordinates\": [[{a}, {b}, {c}, {d}, {a}]]}}}}{}",
            neighbour.height,
            if number == NEIGHBOURS.len() { "" } else { "," },
        );
    }
    text + "]}\n"
}

impl Neighbour {
    fn corners(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = self.turned_deg.to_radians().sin_cos();
        let [length, width] = self.size.map(|side| side / 2.0);
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| {
            let (x, y) = (x * length, y * width);
            degrees(self.middle[0] + x * cos - y * sin, self.middle[1] + x * sin + y * cos)
        })
    }
}
