//! The position of a file's origin on Earth, and the direction of north.

use super::house::house;
use super::{notes, read};
use gnomon::formats::{Anchor, AnchorPoint, Model};

const SITE: &str = "(49,6,1,566000),(8,26,11,540400),110000.";

fn said_by<'a>(model: &'a Model, what: &str) -> &'a Anchor {
    let known: Vec<&str> = model.anchors.iter().map(|anchor| anchor.said_by).collect();
    model.anchors.iter().find(|anchor| anchor.said_by == what).unwrap_or_else(|| panic!("no {what} in {known:?}"))
}

#[track_caller]
fn is_at(anchor: &Anchor, latitude: f64, longitude: f64, elevation: Option<f64>) {
    let AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m } = anchor.at else {
        panic!("{anchor:?} is not a place of the Earth")
    };
    // a millimetre
    assert!((latitude_deg - latitude).abs() < 1e-8 && (longitude_deg - longitude).abs() < 1e-8, "{anchor:?}");
    let apart = elevation_m.zip(elevation).map(|(one, other)| (one - other).abs());
    assert!(apart.is_none_or(|apart| apart < 1e-6) && elevation_m.is_some() == elevation.is_some(), "{anchor:?}");
}

#[track_caller]
fn north(anchor: &Anchor, degrees: Option<f64>) {
    let said = anchor.north_rad.map(f64::to_degrees);
    assert!(said.zip(degrees).is_none_or(|(one, other)| (one - other).abs() < 1e-9), "{said:?}");
    assert_eq!(said.is_some(), degrees.is_some());
}

#[test]
fn a_sites_place_is_read_in_all_its_parts() {
    // place and north of a known sample, AC20-FZK-Haus: 49.100435°, 8.436539°, TrueNorth (cos 40°, sin 40°)
    let anchor = read(&house("")).anchors;
    assert_eq!(anchor.len(), 1);
    assert_eq!(anchor[0].said_by, "IfcSite");
    is_at(&anchor[0], 49.100435, 8.436539, Some(110.0));
    // that direction lies 50° clockwise from +y
    north(&anchor[0], Some(50.0));
    let south = house("").replace(SITE, "(-33,-51,-25),(-71,-3,-24,-263305),$");
    is_at(said_by(&read(&south), "IfcSite"), -33.856944444444445, -71.05673980694444, None);
    // a sign at zero degrees counts
    let near = house("").replace(SITE, "(0,-30,0),(0,35,41,222400),1.");
    is_at(said_by(&read(&near), "IfcSite"), -0.5, 0.594784, Some(0.001));
}

#[test]
fn north_alone_is_said_and_may_be_missing() {
    let nowhere = house("").replace(SITE, "$,$,$");
    let anchor = read(&nowhere).anchors;
    assert_eq!((anchor.len(), anchor[0].said_by, &anchor[0].at), (1, "TrueNorth", &AnchorPoint::Nowhere));
    north(&anchor[0], Some(50.0));
    let west = nowhere.replace("(0.766044443118978,0.642787609686539)", "(-1.,0.)");
    north(&read(&west).anchors[0], Some(-90.0));
    let without = house("").replace("1.E-5,#6,#11", "1.E-5,#6,$");
    north(said_by(&read(&without), "IfcSite"), None);
    assert_eq!(read(&nowhere.replace("1.E-5,#6,#11", "1.E-5,#6,$")).anchors, []);
    // a second context that says otherwise
    let twice = house("#12=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Plan',2,1.E-5,#6,#13);\n#13=IFCDIRECTION((0.,1.));");
    let model = read(&twice);
    north(said_by(&model, "IfcSite"), Some(50.0));
    assert!(notes(&model).contains("says TrueNorth twice, 50.000° and 0.000°"), "{}", notes(&model));
}

#[test]
fn the_place_is_that_of_the_sites_own_zero() {
    // the site lies 300 m along the file's x, 400 m along its y and 5 m up; north is 90° clockwise from +y, along +x
    let moved = house("")
        .replace("#20=IFCLOCALPLACEMENT($,#6);", "#20=IFCLOCALPLACEMENT($,#30);\n#30=IFCAXIS2PLACEMENT3D(#31,$,$);")
        .replace("#100=IFCWALL", "#31=IFCCARTESIANPOINT((300000.,400000.,5000.));\n#100=IFCWALL")
        .replace("(0.766044443118978,0.642787609686539)", "(1.,0.)")
        .replace(SITE, "(49,0,0),(8,0,0),110000.");
    let model = read(&moved);
    // so the file's zero is 300 m south of the site and 400 m east; the lengths of a degree by the usual series
    let latitude = 49.0_f64.to_radians();
    let degree_north = 111_132.954 - 559.822 * (2.0 * latitude).cos() + 1.175 * (4.0 * latitude).cos();
    let degree_east = 111_412.84 * latitude.cos() - 93.5 * (3.0 * latitude).cos() + 0.118 * (5.0 * latitude).cos();
    let AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m } = said_by(&model, "IfcSite").at else {
        panic!("no place")
    };
    assert!((latitude_deg - (49.0 - 300.0 / degree_north)).abs() < 1e-7, "{latitude_deg}");
    assert!((longitude_deg - (8.0 + 400.0 / degree_east)).abs() < 1e-7, "{longitude_deg}");
    assert_eq!(elevation_m, Some(105.0));
    // one whose coordinates are a map's says nothing of zero, and that is told
    let far = read(&moved.replace("(300000.,400000.,5000.)", "(690000000.,5300000000.,0.)"));
    assert_eq!(far.anchors.iter().map(|anchor| anchor.said_by).collect::<Vec<_>>(), ["TrueNorth"]);
    assert!(notes(&far).contains("5345 km from its own zero"), "{}", notes(&far));
}

/// What a map conversion comes to, with records for its end.
fn on_map(conversion: &str, crs: &str) -> Model {
    let more = format!("#950=IFCPROJECTEDCRS({crs});\n#951={conversion};\n#952=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);");
    read(&house(&more))
}

/// The scale is metres on the map a unit of the file.
#[track_caller]
fn is_on_map(anchor: &Anchor, name: &str, at: [f64; 3], said: f64) {
    let AnchorPoint::Map { crs, easting, northing, height, scale } = &anchor.at else { panic!("{anchor:?}") };
    assert_eq!(crs, name);
    let apart = [easting - at[0], northing - at[1], height.unwrap_or(f64::NAN) - at[2], scale / said - 1.0];
    assert!(apart.iter().all(|apart| apart.abs() < 1e-9), "{anchor:?}");
}

const UTM: &str = "'EPSG:25832',$,$,$,$,$,#952";

#[test]
fn a_map_conversion_says_place_north_and_scale() {
    let turned = "IFCMAPCONVERSION(#10,#950,458870.5,5438230.25,115.,0.866025403784439,-0.5,0.001)";
    let model = on_map(turned, UTM);
    let said: Vec<&str> = model.anchors.iter().map(|anchor| anchor.said_by).collect();
    assert_eq!(said, ["IfcMapConversion", "IfcSite"]);
    is_on_map(&model.anchors[0], "EPSG:25832", [458870.5, 5438230.25, 115.0], 0.001);
    // +x points 30° south of the map's east, so its north is 30° anticlockwise from +y
    north(&model.anchors[0], Some(-30.0));
    assert!(!notes(&model).contains("Scale"));
    assert_eq!(model.assumed_map_unit_m, None);
    // one that corrects for the map's own scale, too
    let scaled = on_map(&turned.replace("0.001)", "0.0009996)"), UTM);
    is_on_map(&scaled.anchors[0], "EPSG:25832", [458870.5, 5438230.25, 115.0], 0.0009996);
    // all in the project's unit, without a name
    let own = on_map("IFCMAPCONVERSION(#10,#950,15000.,0.,0.,0.,1.,$)", "'',$,$,$,$,$,$");
    is_on_map(&own.anchors[0], "", [15.0, 0.0, 0.0], 0.001);
    assert_eq!(own.assumed_map_unit_m, Some(0.001));
    north(&own.anchors[0], Some(90.0));
}

#[test]
fn a_scale_that_forgets_the_units_is_told_and_does_not_shrink() {
    for scale in ["$", "1.", "0.9996"] {
        let model = on_map(&format!("IFCMAPCONVERSION(#10,#950,458870.5,5438230.25,115.,$,$,{scale})"), UTM);
        let expected = 0.001 * scale.parse().unwrap_or(1.0);
        is_on_map(&model.anchors[0], "EPSG:25832", [458870.5, 5438230.25, 115.0], expected);
        north(&model.anchors[0], Some(0.0));
        assert!(notes(&model).contains("the Scale is taken not to convert units"), "{}", notes(&model));
    }
}

/// IFC has the project's unit where MapUnit is not said; numbers that are metres of a map all the same are taken so.
#[test]
fn metres_without_a_map_unit_are_told() {
    let unsaid = "'EPSG:25832',$,$,$,$,$,$";
    let model = on_map("IFCMAPCONVERSION(#10,#950,458870.5,5438230.25,115.,1.,0.,0.001)", unsaid);
    is_on_map(&model.anchors[0], "EPSG:25832", [458870.5, 5438230.25, 115.0], 0.001);
    assert!(notes(&model).contains("without the map's unit"), "{}", notes(&model));
    let model = on_map("IFCMAPCONVERSION(#10,#950,458870500.,5438230250.,115000.,1.,0.,1.)", unsaid);
    is_on_map(&model.anchors[0], "EPSG:25832", [458870.5, 5438230.25, 115.0], 0.001);
    assert!(!notes(&model).contains("without the map's unit"), "{}", notes(&model));
}

#[test]
fn an_axis_without_a_direction_is_told() {
    let model = on_map("IFCMAPCONVERSION(#10,#950,458870.5,5438230.25,115.,0.,0.,0.001)", UTM);
    assert!(notes(&model).contains("an XAxis of (0, 0)"), "{}", notes(&model));
}

#[test]
fn its_relatives_are_read() {
    let rigid = "IFCRIGIDOPERATION(#10,#950,IFCLENGTHMEASURE(458870.5),IFCLENGTHMEASURE(5438230.25),7.)";
    let model = on_map(rigid, UTM);
    is_on_map(said_by(&model, "IfcRigidOperation"), "EPSG:25832", [458870.5, 5438230.25, 7.0], 0.001);
    north(&model.anchors[0], Some(0.0));
    let set = "
#960=IFCPROPERTYSET('0000000000000000000040',$,'ePSet_MapConversion',$,(#961,#962,#963,#964));
#961=IFCPROPERTYSINGLEVALUE('TargetCRS',$,IFCLABEL('EPSG:2056'),$);
#962=IFCPROPERTYSINGLEVALUE('Eastings',$,IFCLENGTHMEASURE(2600000.),$);
#963=IFCPROPERTYSINGLEVALUE('Northings',$,IFCLENGTHMEASURE(1200000.),$);
#964=IFCPROPERTYSINGLEVALUE('Scale',$,IFCREALMEASURE(1.),$);";
    let model = read(&house(set).replace("'IFC4'", "'IFC2X3'").replace(".MILLI.,.METRE.", "$,.METRE."));
    is_on_map(said_by(&model, "ePSet_MapConversion"), "EPSG:2056", [2_600_000.0, 1_200_000.0, 0.0], 1.0);
    let alone = read(&house("#950=IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,$);"));
    assert_eq!(alone.anchors.len(), 1);
    assert!(notes(&alone).contains("does not say where on that map"), "{}", notes(&alone));
}
