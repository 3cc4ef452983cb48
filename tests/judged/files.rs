//! GeoJSON files of areas and plots, and which files a site reads.

use super::{fails_in, folder, judged, notes, open, write};
use glam::{DVec2, dvec2};
use gnomon::crs::{GeodeticPoint, LocalFrame};
use gnomon::site::inputs;

/// Corners around Vienna's place, as longitudes and latitudes.
fn on_earth(corners: &[DVec2]) -> String {
    let place = GeodeticPoint { latitude_deg: 48.2, longitude_deg: 16.38, height_m: 165.0 };
    let frame = LocalFrame::around(place).unwrap();
    let position = |corner: &DVec2| {
        let at = frame.on_earth(corner.extend(0.0)).unwrap();
        format!("[{}, {}]", at.longitude_deg, at.latitude_deg)
    };
    let mut positions: Vec<String> = corners.iter().map(position).collect();
    positions.push(positions[0].clone());
    format!("[{}]", positions.join(", "))
}

fn square(low: DVec2, side: f64) -> [DVec2; 4] {
    [low, low + dvec2(side, 0.0), low + dvec2(side, side), low + dvec2(0.0, side)]
}

fn feature(name: Option<&str>, kind: &str, coordinates: &str) -> String {
    let name = name.map_or("{}".to_owned(), |name| format!("{{\"name\": \"{name}\"}}"));
    format!(
        "{{\"type\": \"Feature\", \"properties\": {name}, \"geometry\": {{\"type\": \"{kind}\", \"coordinates\": {coordinates}}}}}"
    )
}

fn collection(features: &[String]) -> String {
    format!("{{\"type\": \"FeatureCollection\", \"features\": [{}]}}", features.join(", "))
}

/// A park with a pond in it, and a playground in two parts.
fn parks() -> String {
    let ring = |x: f64, y: f64, side: f64| on_earth(&square(dvec2(x, y), side));
    collection(&[
        feature(Some("Park"), "Polygon", &format!("[{}, {}]", ring(100.0, 100.0, 40.0), ring(110.0, 110.0, 10.0))),
        feature(
            Some("Playground"),
            "MultiPolygon",
            &format!("[[{}], [{}]]", ring(0.0, 60.0, 5.0), ring(10.0, 60.0, 5.0)),
        ),
        feature(Some("Path"), "LineString", "[[16.38, 48.2], [16.39, 48.2]]"),
    ])
}

fn signed_area(ring: &[DVec2]) -> f64 {
    (0..ring.len()).map(|at| ring[at].perp_dot(ring[(at + 1) % ring.len()])).sum::<f64>() / 2.0
}

#[test]
fn a_file_gives_its_polygons() {
    let folder = folder("[[area]]\nfile = \"parks.geojson\"");
    write(&folder, "parks.geojson", &parks());
    let site = open(folder.path());
    let names: Vec<_> = site.areas.iter().map(|area| area.name.as_str()).collect();
    assert_eq!(names, ["Park", "Playground"]);
    let areas = |of: usize| site.areas[of].rings.iter().map(|ring| signed_area(ring).round()).collect::<Vec<_>>();
    assert_eq!((areas(0), areas(1)), (vec![1600.0, -100.0], vec![25.0, 25.0]));
    let corner = site.areas[0].rings[0][0];
    assert!(corner.distance(dvec2(100.0, 100.0)) < 1e-3, "{corner}");
    assert!(notes(&site).contains("parks.geojson has 1 LineString left out"), "{}", notes(&site));
    // a polygon's own dwelling goes before the key, which holds for the others
    let of_flat = parks().replace("\"name\": \"Park\"", "\"name\": \"Park\", \"dwelling\": \"flat 1\"");
    write(&folder, "flats.geojson", &of_flat);
    write(&folder, "site.toml", &format!("{}[[area]]\nfile = \"flats.geojson\"\ndwelling = \"flat 2\"", super::HEAD));
    let dwellings: Vec<_> = open(folder.path()).areas.into_iter().map(|area| area.dwelling.unwrap()).collect();
    assert_eq!(dwellings, ["flat 1", "flat 2"]);
    // one of them, at a height of its own
    write(
        &folder,
        "site.toml",
        &format!("{}[[area]]\nname = \"Park\"\nfile = \"parks.geojson\"\nlevel = 2", super::HEAD),
    );
    assert_eq!(open(folder.path()).areas.len(), 1);
    write(&folder, "site.toml", &format!("{}[[area]]\nname = \"Parc\"\nfile = \"parks.geojson\"", super::HEAD));
    fails_in(folder.path(), &["[[area]] name", "\"Parc\"", "\"Park\""]);
}

#[test]
fn other_maps_are_taken_to_the_place() {
    let folder = folder("[[area]]\nname = \"Yard\"\nfile = \"yard.geojson\"\ncrs = \"EPSG:32633\"");
    let square = |low: DVec2| {
        let corners: Vec<_> = square(low, 10.0).iter().map(|at| format!("[{}, {}]", at.x, at.y)).collect();
        collection(&[feature(None, "Polygon", &format!("[[{}]]", corners.join(", ")))])
    };
    write(&folder, "yard.geojson", &square(dvec2(602_500.0, 5_339_400.0)));
    let site = open(folder.path());
    let [area] = site.areas.as_slice() else { panic!("{:?}", site.areas) };
    assert!((signed_area(&area.rings[0]) - 100.0).abs() < 0.2 && area.rings[0][0].length() < 5000.0, "{area:?}");
    // of no map: metres around the place, which is said
    write(&folder, "site.toml", &format!("{}[[area]]\nname = \"Yard\"\nfile = \"yard.geojson\"", super::HEAD));
    fails_in(folder.path(), &["[[area]] file", "\"Yard\"", "50 km"]);
    write(&folder, "yard.geojson", &square(dvec2(200.0, 100.0)));
    let site = open(folder.path());
    assert_eq!(site.areas[0].rings[0][0], dvec2(200.0, 100.0));
    assert!(notes(&site).contains("taken as metres"), "{}", notes(&site));
    write(&folder, "site.toml", &format!("{}[[area]]\nfile = \"yard.geojson\"\ncrs = \"EPSG:0\"", super::HEAD));
    fails_in(folder.path(), &["[[area]] crs"]);
}

#[test]
fn files_that_are_none_are_told() {
    let told = |text: &str, words: &[&str]| {
        let folder = folder("[[area]]\nfile = \"parks.geojson\"");
        write(&folder, "parks.geojson", text);
        fails_in(folder.path(), words);
    };
    told("", &["parks.geojson"]);
    told("{\"type\": \"FeatureCollection\", \"features\": []}", &["parks.geojson", "no polygon"]);
    let ring = |x: f64, y: f64, side: f64| on_earth(&square(dvec2(x, y), side));
    told(&collection(&[feature(None, "Polygon", &format!("[{}]", ring(0.0, 0.0, 9.0)))]), &["feature 1", "`name`"]);
    let meeting = format!("[{}, {}]", ring(0.0, 0.0, 9.0), ring(5.0, 5.0, 9.0));
    told(&collection(&[feature(Some("A"), "Polygon", &meeting)]), &["\"A\"", "cross or touch", "border 1", "border 2"]);
    let touching = format!("[[{}], [{}]]", ring(0.0, 0.0, 9.0), ring(9.0, 0.0, 9.0));
    told(&collection(&[feature(Some("A"), "MultiPolygon", &touching)]), &["\"A\"", "cross or touch"]);
    let twice = feature(Some("A"), "Polygon", &format!("[{}]", ring(0.0, 0.0, 9.0)));
    told(&collection(&[twice.clone(), twice]), &["\"A\"", "another area"]);
    let empty = feature(Some("A"), "Polygon", "[[[16.38, 48.2], [16.38, 48.2], [16.38, 48.2], [16.38, 48.2]]]");
    told(&collection(&[empty]), &["\"A\"", "1 corner "]);
    let none = folder("[[area]]\nfile = \"nothing.geojson\"");
    fails_in(none.path(), &["[[area]] file", "nothing.geojson", "no file"]);
}

#[test]
fn a_plot_may_be_a_file() {
    let folder = folder("[plot]\nfile = \"plot.geojson\"\nroads = [{ side = 2, width = 8 }]");
    let ring = on_earth(&square(dvec2(0.0, 0.0), 20.0));
    write(&folder, "plot.geojson", &collection(&[feature(None, "Polygon", &format!("[{ring}]"))]));
    let plot = open(folder.path()).plot.expect("a plot");
    assert!((signed_area(&plot.border) - 400.0).abs() < 0.01 && plot.sides[1].road_m == 8.0, "{plot:?}");
    write(&folder, "plot.geojson", &parks());
    fails_in(folder.path(), &["[plot] file", "4 borders"]);
}

#[test]
fn what_is_judged_is_among_the_files_of_a_site() {
    let tables = "[[area]]\nfile = \"parks.geojson\"\n[[window]]\ncomponent = \"glass\"\nrooms = \"rooms.csv\"\n[plot]\nfile = \"plot.geojson\"\n[before]\nsite = \"old/before.toml\"";
    let folder = folder(tables);
    std::fs::create_dir(folder.path().join("old")).unwrap();
    write(&folder, "old/before.toml", &super::HEAD.replace("town.obj", "old.obj"));
    let files = inputs(folder.path()).unwrap();
    for name in
        ["site.toml", "town.obj", "parks.geojson", "rooms.csv", "plot.geojson", "old/before.toml", "old/old.obj"]
    {
        assert!(files.contains(&folder.path().join(name)), "{name} is not in {files:?}");
    }
}

#[test]
fn a_saved_site_keeps_these_tables() {
    use gnomon::site::file::SiteFile;
    let tables = "
# the gardens
[[area]]
name = \"Garden\" # of no. 12
polygon = [ [0, 0], [1, 0], # a corner
            [0, 1] ]

[[window]]
component = \"glass\"
[[facade]]
component = [\"barn\"]
[plot]
border = [[0, 0], [1, 0], [0, 1]]
roads = [{ side = 1, width = 6 }] # the lane
[before]
absent = [\"tower\"]
";
    let text = format!("{}{tables}", super::HEAD);
    let read = SiteFile::parse("site.toml", &text).unwrap();
    assert_eq!(read.to_toml_in(&text).unwrap(), text);
    let mut later = read.clone();
    later.study.date = Some(gnomon::site::file::Text("2027-01-01".to_owned()));
    assert_eq!(later.to_toml_in(&text).unwrap(), text.replace("date = 2026-03-21", "date = \"2027-01-01\""));
    // a table that goes takes its own comments, and leaves those of the others
    let mut two = text.replace(
        "[[window]]",
        "# the court\n[[area]]\nname = \"Court\"\npolygon = [[5, 5], [6, 5], [6, 6]] # small\n\n[[window]]",
    );
    let mut fewer = SiteFile::parse("site.toml", &two).unwrap();
    fewer.area.remove(0);
    let written = fewer.to_toml_in(&two).unwrap();
    assert_eq!(SiteFile::parse("site.toml", &written).unwrap(), fewer, "{written}");
    two.truncate(two.find("[[window]]").unwrap());
    assert!(written.contains(&two[two.find("# the court").unwrap()..]), "{written}");
    assert!(!written.contains("no. 12") && !written.contains("the gardens"), "{written}");
    // written as a new file it means the same
    assert_eq!(SiteFile::parse("site.toml", &read.to_toml().unwrap()).unwrap(), read);
    assert_eq!(judged(tables).areas.len(), 1);
}
