//! What is reported about the position of models: its source, its unit, and which part of it is used.

use super::*;
use gnomon::site::ModelReference;

const MODEL: &str = "[[model]]\npath = \"house.glb\"\n";

/// The models of a site as `gnomon check` reads them.
fn models(site: &str, model: &Model) -> Result<Models, SiteError> {
    let folder = folder(site, &["house.glb"]);
    let written = WrittenSite::read(folder.path(), &Overrides::default()).expect("a site");
    Models::read(&written, |_, _| Ok(model.clone()))
}

fn reference(site: &str, model: &Model) -> ModelReference {
    models(site, model).expect(site).references()[0].clone()
}

#[track_caller]
fn assert_says(text: &str, words: &[&str]) {
    words.iter().for_each(|word| assert!(text.contains(word), "'{word}' is missing in: {text}"));
}

/// A `[place]` that says no point takes that of the file, in `gnomon check` and in studies alike; half a point is no place.
#[test]
fn a_place_without_a_point_is_where_the_file_says() {
    let house = anchored(vec![map_anchor(0.0)]);
    let site = format!("[place]\nname = \"Here\"\nelevation = 90.0\n{MODEL}");
    let found = load(&site, &[("house.glb", house.clone())]).expect("the file's place");
    assert_eq!((found.place.name.as_str(), found.place.elevation_m), ("Here", 90.0));
    assert!((found.place.latitude_deg - LONG_LAT[1]).abs() < 1e-7, "{:?}", found.place);
    // 110 m is 20 m above what is written
    assert_near(&corners(&found.mesh, 0)[..1], &[DVec3::Z * 20.0], 1e-3);
    let checked = models(&site, &house).expect("the file's place");
    assert_eq!(checked.references()[0].stands_by, "IfcMapConversion");

    for (half, missing) in
        [("latitude = 49.1", "no longitude in [place]"), ("longitude = 8.4", "no latitude in [place]")]
    {
        let site = format!("[place]\n{half}\n{MODEL}");
        assert_says(&load(&site, &[("house.glb", house.clone())]).expect_err(half).to_string(), &[missing]);
        assert_says(&models(&site, &house).expect_err(half).to_string(), &[missing]);
    }
    let nobody = load(&site, &[("house.glb", drawing())]).expect_err("no place").to_string();
    assert_says(&nobody, &["no latitude and longitude in [place]", "latitude = 48.8583"]);
    assert_eq!(reference(&site, &drawing()).stands, None);
}

#[test]
fn what_is_taken_stands_before_what_the_file_says() {
    let house = anchored(vec![map_anchor(0.0)]);
    let moved = reference(&format!("{PLACE}{MODEL}position = [1000.0, 0.0, -50.0]\n"), &house);
    let [stands, said] = [moved.stands, moved.said].map(|point| point.expect("a place"));
    assert_eq!((moved.stands_by.as_str(), said.at.height_m, stands.at.height_m), ("position", 110.0, 50.0));
    // a kilometre along the parallel
    let east_m = (stands.at.longitude_deg - said.at.longitude_deg).to_radians() * 6_378_137.0 * 0.6557;
    assert!((east_m - 1000.0).abs() < 5.0, "{east_m}");
    let on_map = reference(&format!("{PLACE}{MODEL}crs = \"EPSG:31467\"\nposition = [0.0, 0.0, -3.0]\n"), &drawn());
    assert_eq!(on_map.stands_by, "position");
    let heights = on_map.stands.zip(on_map.said).map(|(stands, said)| stands.at.height_m - said.at.height_m);
    assert!(heights.is_some_and(|by| (by + 3.0).abs() < 1e-6), "{heights:?}");
    // an anchor in another country is passed over
    let paris = "[place]\nlatitude = 48.8583\nlongitude = 2.2945\nelevation = 35.0\n";
    let far = reference(&format!("{paris}{MODEL}"), &anchored(vec![site_anchor(LONG_LAT, None)]));
    assert_eq!((far.stands_by.as_str(), far.said_by.as_deref()), ("the site's place", Some("IfcSite")));
    assert!((far.stands.expect("a place").at.latitude_deg - 48.8583).abs() < 1e-9, "{far:?}");
    // without a word of the file it stands at the place, as high as that
    let plain = reference(&format!("{paris}{MODEL}"), &drawing());
    assert_eq!(plain.stands.map(|point| (point.at.height_m, point.has_height)), Some((35.0, true)));
}

/// In the coordinates of an unnamed map.
fn drawn() -> Model {
    Model { coordinates: Coordinates::Local, unit_m: None, up: Up::Z, ..on_map("", GAUSS, 110.0) }
}

/// An error in the file's values names the file, and one in the key `crs` names the key.
#[test]
fn faults_are_said_of_who_says_it() {
    let of = |keys: &str, model: Model| one(keys, model).expect_err(keys).to_string();
    let own = of("", on_map("EPSG:99999", GAUSS, 0.0));
    assert_says(
        &own,
        &["house.glb: names a reference system that cannot be taken", "99999", "write `crs` under [[model]]"],
    );
    assert!(!own.contains("site.toml"), "{own}");
    let key = of("crs = \"EPSG:99999\"", on_map("EPSG:31467", GAUSS, 0.0));
    assert_says(&key, &["site.toml, [[model]] crs:", "99999"]);
    // what is where
    let far = on_map("EPSG:4326", [[174.8, -41.3]; 3], 0.0);
    let told = of("", far.clone());
    let words =
        ["house.glb: has 'sheet'", "41.3 S 174.8 E", "km from the place at 49.10039 N 8.43659 E", "within 2000 km"];
    assert_says(&told, &words);
    assert!(!told.contains("site.toml"), "{told}");
    assert_says(&of("crs = \"EPSG:4326\"", far), &["[[model]] crs: has 'sheet'", "41.3 S 174.8 E"]);
    let beyond = of("", on_map("EPSG:4326", [[1e9, 2.0]; 3], 0.0));
    assert_says(&beyond, &["house.glb: has 'sheet' at 1000000000, 2, where", "does not reach"]);
}

/// If a unit is assumed, or if there are two units, a note says so and names the key.
#[test]
fn units_that_are_taken_are_told() {
    let place = "[place]\nlatitude = 40.7484\nlongitude = -73.9857\nelevation = 0.0\n";
    let at = DVec3::new(988212.2372, 211939.2786, 0.0);
    let feet = sheet([at, at + DVec3::X * 300.0, at + DVec3::new(0.0, 300.0, 100.0)]);
    let notes = |keys: &str, model: Model| {
        let site = load(&format!("{place}{MODEL}{keys}"), &[("house.glb", model)]).expect(keys);
        said(&site.notes).concat()
    };
    let unsaid = Model { unit_m: None, ..feet.clone() };
    let crs = "crs = \"EPSG:2263\"\n";
    assert_says(
        &notes(crs, unsaid.clone()),
        &["does not give its unit", "that of its map, 0.3048006096 m", "`scale` under [[model]]"],
    );
    assert!(!notes(&format!("{crs}scale = 0.3048\n"), unsaid.clone()).contains("does not give its unit"));
    let checked = reference(&format!("{place}{MODEL}{crs}"), &unsaid);
    assert!((checked.unit_m - 1200.0 / 3937.0).abs() < 1e-12 && !checked.unit_is_said, "{checked:?}");
    let named = |unit_m| Model { unit_m, coordinates: Coordinates::Map("EPSG:2263".to_owned()), ..feet.clone() };
    let two = ["has heights in units of 1 m", "in those of its map, 0.3048006096 m", "`scale` under [[model]]"];
    assert_says(&notes("", named(Some(1.0))), &two);
    assert!(!notes("", named(Some(0.3048))).contains("has heights in units"));
    // a surface in feet on a map in metres, and all of it in feet
    let metric = on_map("EPSG:25832", [UTM, [UTM[0] + 20.0, UTM[1]], [UTM[0], UTM[1] + 20.0]], 360.0);
    let in_feet = Model { unit_m: Some(0.3048), ..metric };
    let told = one("", in_feet.clone()).expect("feet");
    assert_says(&said(&told.notes).concat(), &["has heights in units of 0.3048 m", "in those of its map, 1 m"]);
    assert!((corners(&told.mesh, 0)[0].z - (360.0 * 0.3048 - 100.0)).abs() < 1e-3, "{}", corners(&told.mesh, 0)[0]);
    let corners_in_feet = in_feet.parts[0].positions.iter().map(|at| *at / 0.3048).collect::<Vec<_>>();
    let all = sheet([corners_in_feet[0], corners_in_feet[1], corners_in_feet[2]]);
    let all = Model { coordinates: in_feet.coordinates, unit_m: Some(0.3048), ..all };
    let found = one("scale = 0.3048", all).expect("feet");
    assert!(corners(&found.mesh, 0)[0].truncate().length() < 0.1, "{}", corners(&found.mesh, 0)[0]);
    assert!(!said(&found.notes).concat().contains("has heights in units"), "{:?}", found.notes);
}

/// Far from the place true north has another direction: the note and `check` give the same number and its parts.
#[test]
fn north_is_one_number_wherever_the_model_stands() {
    let west = "[place]\nlatitude = 49.1\nlongitude = 8.2\nelevation = 110.0\n";
    let site = format!("{west}{MODEL}");
    for (anchor, is_of_map) in [(map_anchor(30.0), true), (site_anchor(LONG_LAT, Some(30.0)), false)] {
        let house = anchored(vec![anchor]);
        let checked = reference(&site, &house);
        let found = load(&site, &[("house.glb", house.clone())]).expect("17 km to the east");
        let edge = (corners(&found.mesh, 0)[2] - corners(&found.mesh, 0)[1]).normalize();
        let turned = (-edge.x).atan2(edge.y).to_degrees();
        assert!((turned - checked.north_deg).abs() < 1e-3, "{turned}, and {}", checked.north_deg);
        // 0.2366° of longitude by the sine of the latitude: in the east true north leans to the west
        let meridian = checked.meridian_deg.expect("another meridian");
        assert!((meridian + 0.2366 * 49.1_f64.to_radians().sin()).abs() < 1e-3, "{meridian}");
        let parts = 30.0 - checked.convergence_deg.unwrap_or_default() - meridian;
        assert!(
            (checked.north_deg - parts).abs() < 1e-3 && checked.convergence_deg.is_some() == is_of_map,
            "{checked:?}"
        );
        let told = said(&found.notes).concat();
        let words =
            [format!("its north is {:.2}°", checked.north_deg), format!("{meridian:.2}° between true north there")];
        words.iter().for_each(|word| assert!(told.contains(word), "'{word}' is missing in: {told}"));
        // one that is moved to the place keeps its true north, and has the place's meridian
        let moved = reference(&format!("{site}position = [0.0, 0.0, 0.0]\n"), &house);
        let north = 30.0 - moved.convergence_deg.unwrap_or_default();
        assert!((moved.north_deg - north).abs() < 1e-6 && moved.meridian_deg.is_none(), "{moved:?}");
    }
}

/// The elevation of a file is written with its source, and the same models are reused.
#[test]
fn an_elevation_of_a_file_is_written_with_its_source() {
    let site = format!("[place]\nlatitude = 49.1\nlongitude = 8.4366\n{MODEL}");
    let folder = folder(&site, &["house.glb"]);
    let written = WrittenSite::read(folder.path(), &Overrides::default()).expect("a site");
    let models = Models::read(&written, |_, _| Ok(anchored(vec![map_anchor(0.0)]))).expect("models");
    let mut now = written.clone();
    let place = now.site.place.as_mut().expect("a place");
    place.complete_with(models.proposed_place().expect("an elevation"));
    assert_eq!((place.latitude, place.elevation), (Some(49.1), Some(110.0)));
    assert!(models.are_those_of(&now) && models.are_those_of(&written));
    let text = now.site.to_toml_in(&written.text).expect("TOML");
    assert!(text.contains("elevation = 110.0 # from house.glb, IfcMapConversion\n"), "{text}");
    now.site.place.as_mut().expect("a place").elevation = Some(90.0);
    assert!(!models.are_those_of(&now), "they stand 20 m higher");
    let text = now.site.to_toml_in(&written.text).expect("TOML");
    assert!(text.contains("elevation = 90.0\n"), "{text}");
}
