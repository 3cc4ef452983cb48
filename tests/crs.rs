//! Maps and the Earth: positions and meridian convergence against PROJ, published constants and closed forms from
//! textbooks.

use glam::DVec3;
use gnomon::crs::{Crs, CrsKind, GeodeticPoint, LocalFrame, MapToLocal};

/// Systems, a longitude and latitude in WGS 84, where PROJ 9.5.1 has it on the map by the same parameters of the datum, and
/// PROJ's own meridian convergence there (`get_factors`), degrees from the meridian of the map's datum.
const BY_PROJ: &[(&str, [f64; 2], [f64; 2], f64)] = &[
    ("EPSG:25832", [8.4366, 49.1004], [458874.4871, 5438769.7050], -0.425856),
    ("EPSG:32756", [151.2093, -33.8688], [334368.6336, 6250948.3454], 0.998172),
    ("EPSG:32733", [18.42, -33.92], [816196.7118, 6241444.3144], -1.910063),
    ("EPSG:3006", [18.0686, 59.3293], [674571.8664, 6580743.0083], 2.640004),
    ("EPSG:3006", [12.2, 57.7], [333140.7888, 6398758.3548], -2.367274),
    // New York and North Carolina: Lambert, in feet; Florida: transverse Mercator, in feet
    ("EPSG:2263", [-73.9857, 40.7484], [988212.2372, 211939.2786], 0.009353),
    ("EPSG:2264", [-80.84, 35.22], [1450498.1080, 540088.3352], -1.061993),
    ("EPSG:2236", [-80.19, 25.76], [922755.1620, 519281.6565], 0.352047),
    ("EPSG:5514", [14.42, 50.087], [-742911.8107, -1043059.5810], -7.833393),
    ("EPSG:28992", [4.9, 52.37], [121819.3606, 487013.7614], -0.385357),
    ("EPSG:7415", [4.36, 52.01], [84477.2776, 447346.8459], -0.810496),
    ("EPSG:2056", [8.54, 47.37], [2683186.2856, 1247156.7441], 0.804994),
    ("EPSG:27700", [-3.19, 55.95], [325784.7480, 673635.7681], -0.984839),
    ("EPSG:31467", [8.4366, 49.1004], [3458933.3430, 5440505.6903], -0.425144),
    ("EPSG:3857", [13.4, 52.5], [1491681.1766, 6891041.7239], 0.0),
    ("EPSG:2193", [174.76, -36.85], [1756911.9449, 5920321.8182], -1.055726),
    ("EPSG:31370", [4.35, 50.85], [148679.4474, 171066.8103], -0.014470),
    // not conformal: there PROJ tells the lean of the meridian on the map; this is the azimuth of its inverse over 100 m
    ("EPSG:3035", [8.4366, 49.1004], [4206812.9159, 2888687.5849], -1.193660),
    ("EPSG:2154", [2.2945, 48.8583], [648237.2022, 6862260.5625], -0.511916),
    ("EPSG:31256", [16.37, 48.21], [2814.2814, 341289.3889], 0.028237),
    ("EPSG:28355", [144.96, -37.81], [320422.8203, 5813305.2226], 1.250946),
];

fn crs(text: &str) -> Crs {
    Crs::read(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn around([longitude_deg, latitude_deg]: [f64; 2]) -> LocalFrame {
    LocalFrame::around(GeodeticPoint { latitude_deg, longitude_deg, height_m: 0.0 }).expect("a place")
}

/// Every point within 5 mm, and every convergence: to a hundredth of a thousandth of a degree where the datum is WGS 84's,
/// and to the few thousandths by which an older datum's meridian is another one.
#[test]
fn positions_and_convergence_are_those_of_proj() {
    for (name, at, [easting, northing], convergence) in BY_PROJ {
        let crs = crs(name);
        let point = crs.to_wgs84(DVec3::new(*easting, *northing, 0.0)).expect("on the map");
        let off = around(*at).point(point).expect("near").length();
        assert!(off < 0.005, "{name}: {off} m");
        let found = crs.convergence_rad(*easting, *northing).expect("on the map").to_degrees();
        let within = if crs.shift().is_empty() { 1e-5 } else { 4e-3 };
        assert!((found - convergence).abs() < within, "{name}: {found}° is not {convergence}°");
    }
    // an offset of a hundredth of a degree would be seen
    let stockholm = crs("EPSG:3006").convergence_rad(674571.8664, 6580743.0083).expect("on the map").to_degrees();
    assert!((stockholm - 2.650).abs() > 4e-3);
}

/// Lambert's conic: γ = n (λ − λ₀), with the zone's published n (NOAA Manual NOS NGS 5, North Carolina: sin φ₀ =
/// 0.577170777). Transverse Mercator: tan γ = tan(λ − λ₀) sin φ on the sphere, to which the ellipsoid adds less than
/// γ³-terms: in five degrees of longitude less than 0.005°.
#[test]
fn convergence_follows_the_textbooks() {
    let carolina = crs("EPSG:2264").convergence_rad(1450498.1080, 540088.3352).expect("on the map").to_degrees();
    let by_lambert = 0.577170777 * (-80.84 + 79.0);
    assert!((carolina - by_lambert).abs() < 1e-5, "{carolina}° is not {by_lambert}°");
    for (name, [longitude, latitude], [easting, northing], meridian) in [
        ("EPSG:25832", [8.4366, 49.1004], [458874.4871, 5438769.7050], 9.0_f64),
        ("EPSG:32756", [151.2093, -33.8688], [334368.6336, 6250948.3454], 153.0),
        ("EPSG:3006", [18.0686, 59.3293], [674571.8664, 6580743.0083], 15.0),
        ("EPSG:2236", [-80.19, 25.76], [922755.1620, 519281.6565], -81.0),
    ] {
        let (longitude, latitude): (f64, f64) = (longitude, latitude);
        let by_sphere = ((longitude - meridian).to_radians().tan() * latitude.to_radians().sin()).atan().to_degrees();
        let found = crs(name).convergence_rad(easting, northing).expect("on the map").to_degrees();
        assert!((found - by_sphere).abs() < 0.005, "{name}: {found}° is not {by_sphere}°");
    }
}

/// Points of EPSG Guidance Note 7-2 (IOGP 373-7-2), on their own datum: British National Grid, Lambert 1SP and 2SP (Jamaica
/// and Texas), RD. What the note gives is latitude and longitude on the map's own ellipsoid, so the datum is left out.
#[test]
fn the_examples_of_guidance_note_7_2_come_out() {
    let dms = |degrees: f64, minutes: f64, seconds: f64| degrees + minutes / 60.0 + seconds / 3600.0;
    for (text, [easting, northing], [latitude, longitude]) in [
        (
            "+proj=tmerc +lat_0=49 +lon_0=-2 +k=0.9996012717 +x_0=400000 +y_0=-100000 +ellps=airy +no_defs",
            [577274.99, 69740.50],
            [50.5, 0.5],
        ),
        (
            "+proj=lcc +lat_1=18 +lat_0=18 +lon_0=-77 +k_0=1 +x_0=250000 +y_0=150000 +ellps=clrk66 +no_defs",
            [255966.58, 142493.51],
            [dms(17.0, 55.0, 55.80), -dms(76.0, 56.0, 37.26)],
        ),
        (
            "+proj=lcc +lat_1=28.383333333333333 +lat_2=30.283333333333333 +lat_0=27.833333333333333 +lon_0=-99 \
             +x_0=609601.2192024384 +y_0=0 +ellps=clrk66 +units=us-ft +no_defs",
            [2963503.91, 254759.80],
            [28.5, -96.0],
        ),
    ] {
        let found = crs(text).to_wgs84(DVec3::new(easting, northing, 0.0)).expect("on the map");
        let off = around([longitude, latitude]).point(found).expect("near").length();
        assert!(off < 0.02, "{text}: {off} m");
    }
}

#[test]
fn systems_go_by_many_names() {
    for (text, name) in [
        ("EPSG:25832", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("epsg:25832", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("25832", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("urn:ogc:def:crs:EPSG::25832", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("urn:ogc:def:crs:EPSG:6.12:25832", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("http://www.opengis.net/gml/srs/epsg.xml#25832", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("http://www.opengis.net/def/crs/EPSG/0/7415", "EPSG:7415 (Amersfoort / RD New + NAP height)"),
        ("ETRS89 / UTM zone 32N", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("ETRS_1989_UTM_Zone_32N", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH", "EPSG:25832 (ETRS89 / UTM zone 32N)"),
        ("DE_DHDN_3GK3", "EPSG:31467 (DHDN / 3-degree Gauss-Kruger zone 3)"),
        ("OGC:CRS84", "OGC:CRS84"),
        ("urn:ogc:def:crs:OGC:1.3:CRS84", "OGC:CRS84"),
        ("WGS 84", "EPSG:4326 (WGS 84)"),
        ("RD New", "EPSG:28992 (Amersfoort / RD New)"),
        (
            "PROJCS[\"a map\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.25]]],AUTHORITY[\"EPSG\",\"25832\"]]",
            "EPSG:25832 (ETRS89 / UTM zone 32N)",
        ),
        (
            "COMPOUNDCRS[\"both\",PROJCRS[\"m\",ID[\"EPSG\",2263]],VERTCRS[\"v\",CS[vertical,1],AXIS[\"up\",up,\
             LENGTHUNIT[\"US survey foot\",0.304800609601219]]]]",
            "EPSG:2263 (NAD83 / New York Long Island (ftUS))",
        ),
    ] {
        assert_eq!(crs(text).name(), name, "{text}");
    }
    assert_eq!(crs("EPSG:4978").kind(), CrsKind::EarthCentred);
    assert_eq!(crs("EPSG:4326").kind(), CrsKind::Geographic);
    let feet = crs("EPSG:2263+6360");
    assert_eq!((feet.kind(), feet.unit_m()), (CrsKind::Projected, 1200.0 / 3937.0));
    assert_eq!((feet.height_unit_m(), crs("EPSG:7415").height_unit_m()), (Some(1200.0 / 3937.0), Some(1.0)));
    assert_eq!(crs("EPSG:25832").height_unit_m(), None);
    assert_eq!(crs("EPSG:2263+5703").height_unit_m(), Some(1.0));
    let compound = "COMPD_CS[\"c\",PROJCS[\"m\",AUTHORITY[\"EPSG\",\"2263\"]],VERT_CS[\"v\",UNIT[\"f\",0.3048]]]";
    assert_eq!(crs(compound).height_unit_m(), Some(0.3048));
}

/// `.prj` files of some programs have no number: their parameters say the same.
#[test]
fn maps_without_a_number_are_read_by_their_parameters() {
    let esri = "PROJCS[\"New_York_of_ours\",GEOGCS[\"GCS_North_American_1983\",DATUM[\"D_North_American_1983\",\
        SPHEROID[\"GRS_1980\",6378137.0,298.257222101]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],\
        PROJECTION[\"Lambert_Conformal_Conic\"],PARAMETER[\"False_Easting\",984250.0],PARAMETER[\"False_Northing\",0.0],\
        PARAMETER[\"Central_Meridian\",-74.0],PARAMETER[\"Standard_Parallel_1\",40.66666666666666],\
        PARAMETER[\"Standard_Parallel_2\",41.03333333333333],PARAMETER[\"Latitude_Of_Origin\",40.16666666666666],\
        UNIT[\"Foot_US\",0.3048006096012192]]";
    let second = "PROJCRS[\"ours\",BASEGEOGCRS[\"ETRS89\",DATUM[\"European Terrestrial Reference System 1989\",\
        ELLIPSOID[\"GRS 1980\",6378137,298.257222101,LENGTHUNIT[\"metre\",1]]]],CONVERSION[\"zone\",\
        METHOD[\"Transverse Mercator\"],PARAMETER[\"Latitude of natural origin\",0],\
        PARAMETER[\"Longitude of natural origin\",9],PARAMETER[\"Scale factor at natural origin\",0.9996],\
        PARAMETER[\"False easting\",500000,LENGTHUNIT[\"metre\",1]],PARAMETER[\"False northing\",0]],CS[Cartesian,2],\
        LENGTHUNIT[\"metre\",1]]";
    for (text, like) in [(esri, "EPSG:2263"), (second, "EPSG:25832")] {
        let (_, at, [easting, northing], _) = BY_PROJ.iter().find(|(name, ..)| *name == like).expect("it is there");
        let point = crs(text).to_wgs84(DVec3::new(*easting, *northing, 0.0)).expect("on the map");
        let off = around(*at).point(point).expect("near").length();
        assert!(off < 0.005, "{like}: {off} m");
    }
}

#[test]
fn what_is_no_system_is_told_with_the_way_out() {
    for text in
        ["", "nonsense", "EPSG:9518", "EPSG:6360", "UTM zone 32N", "PROJCS[\"x\"", "PROJCS[\"x\"]", "[[[[", "EPSG:"]
    {
        let told = Crs::read(text).expect_err(text).to_string();
        assert!(told.contains("EPSG:25832"), "{text}: {told}");
    }
    let grid = Crs::read("+proj=utm +zone=32 +nadgrids=/etc/passwd").expect_err("a file").to_string();
    assert!(grid.contains("grid") && grid.contains("ETRS89"), "{grid}");
    let deep = "A[".repeat(100_000);
    assert!(Crs::read(&deep).is_err() && Crs::read(&deep[..60_000]).is_err());
    assert!(crs("EPSG:2000").doubt().is_some_and(|doubt| doubt.contains("hundred metres")));
    assert!(crs("EPSG:26710").doubt().is_some_and(|doubt| doubt.contains("NAD27")));
    assert_eq!(crs("EPSG:31467").doubt(), None);
    for at in [DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e300)] {
        assert_eq!(crs("EPSG:25832").to_wgs84(at), None);
    }
    assert_eq!(crs("EPSG:4326").to_wgs84(DVec3::new(8.0, 91.0, 0.0)), None);
}

/// Web Mercator's metres are no metres: 100 m of it in 60° north are 50 m.
#[test]
fn web_mercator_is_never_measured_in() {
    let frame = around([20.0, 60.0]);
    let crs = crs("EPSG:3857");
    let to = MapToLocal { crs: &crs, frame: &frame };
    let x = 20.0_f64.to_radians() * 6378137.0;
    let y = (std::f64::consts::FRAC_PI_4 + 30.0_f64.to_radians()).tan().ln() * 6378137.0;
    let [here, there] = [0.0, 100.0].map(|by| to.point(DVec3::new(x + by, y, 0.0)).expect("near"));
    assert!(here.length() < 1e-3, "{here}");
    // the ellipsoid's parallel is longer than the sphere's by 1/√(1 − e² sin² φ)
    let parallel = 50.0 / (1.0 - 0.00669438 * 0.75_f64).sqrt();
    assert!((there.distance(here) - parallel).abs() < 1e-3, "{}", there.distance(here));
}

/// Distances and directions from the place are those on the ellipsoid: PROJ's `aeqd` gives these metres.
#[test]
fn the_local_frame_is_azimuthal_equidistant() {
    let at = GeodeticPoint { latitude_deg: 49.1004, longitude_deg: 8.4366, height_m: 160.0 };
    let frame = LocalFrame::around(GeodeticPoint { latitude_deg: 49.1, longitude_deg: 8.43, height_m: 110.0 })
        .expect("a place");
    let found = frame.point(at).expect("near");
    let by_proj = DVec3::new(481.9624046, 44.5056534, 50.0);
    assert!(found.distance(by_proj) < 1e-6, "{found}");
    assert_eq!(frame.point(GeodeticPoint { latitude_deg: -49.1, longitude_deg: -171.0, height_m: 0.0 }), None);
    assert!(LocalFrame::around(GeodeticPoint { latitude_deg: 91.0, ..at }).is_none());
    // east of the place the meridian leans to the west of the frame's north in the northern hemisphere
    let east = frame.true_north_rad(GeodeticPoint { longitude_deg: 8.93, ..at }).expect("near").to_degrees();
    assert!((east + 0.5 * 49.1_f64.to_radians().sin()).abs() < 1e-2, "{east}");
}

/// Of very many points a lattice is exact, and the others are within a millimetre: of all kinds of maps, in high latitudes,
/// and where nothing is, none is made up.
#[test]
fn many_points_are_as_exact_as_few() {
    for (name, middle, side) in [
        ("EPSG:25832", [458874.0, 5438769.0], 8000.0),
        ("EPSG:31467", [3458933.0, 5440505.0], 8000.0),
        ("EPSG:4326", [10.0, 69.0], 0.12),
        ("EPSG:3857", [1491681.0, 11000000.0], 8000.0),
        ("EPSG:5514", [-742911.0, -1043059.0], 8000.0),
        ("EPSG:2263", [988212.0, 211939.0], 26000.0),
    ] {
        let crs = crs(name);
        let origin = crs.to_wgs84(DVec3::new(middle[0], middle[1], 0.0)).expect("on the map");
        let frame = LocalFrame::around(origin).expect("a place");
        let to = MapToLocal { crs: &crs, frame: &frame };
        const ROW: usize = 360;
        let point = |index: usize| {
            let [across, up] = [index % ROW, index / ROW].map(|step| side * (step as f64 / (ROW - 1) as f64 - 0.5));
            DVec3::new(middle[0] + across, middle[1] + up, (index % 97) as f64)
        };
        let points: Vec<DVec3> = (0..ROW * ROW).map(point).collect();
        let mut converted = points.clone();
        assert_eq!(to.convert(&mut converted), Ok(()), "{name}");
        let off = |(from, found): (&DVec3, &DVec3)| to.point(*from).expect("near").distance(*found);
        let worst = points.iter().zip(&converted).step_by(13).map(off).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{name}: {worst} m");
    }
    let crs = crs("EPSG:25832");
    let frame = around([9.0, 49.0]);
    let mut lost = vec![DVec3::new(500000.0, 5400000.0, 0.0); 120_000];
    lost[7] = DVec3::NAN;
    assert_eq!(MapToLocal { crs: &crs, frame: &frame }.convert(&mut lost), Err(7));
}

/// A thousand texts with letters changed, left out and doubled: each is a system or a message, and no point is a panic.
#[test]
fn mutated_texts_are_read_or_refused() {
    const TEXTS: [&str; 6] = [
        "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837",
        "+proj=tmerc +lat_0=0 +lon_0=9 +k=0.9996 +x_0=500000 +y_0=0 +ellps=GRS80 +towgs84=0,0,0 +units=m +no_defs",
        "+proj=lcc +lat_1=41.03 +lat_2=40.67 +lat_0=40.17 +lon_0=-74 +x_0=300000 +datum=NAD83 +units=us-ft",
        "+proj=krovak +lat_0=49.5 +lon_0=24.83 +k=0.9999 +ellps=bessel +towgs84=589,76,480,0,0,0,0 +pm=ferro +axis=swu",
        "+proj=sterea +lat_0=52.16 +lon_0=5.39 +k=0.9999 +x_0=155000 +a=6377397 +rf=299.15 +vunits=ft +to_meter=1",
        "PROJCS[\"m\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.25],TOWGS84[1,2,3]],PRIMEM[\"p\",2]],\
         PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",5],UNIT[\"f\",0.3]]",
    ];
    const LETTERS: &[u8] = b"0189.-+=e,:[]\"()EPSG/ n\xc3";
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let mut usable = 0;
    for round in 0..1000 {
        let mut text = TEXTS[round % TEXTS.len()].as_bytes().to_vec();
        for _ in 0..=random(3) {
            let at = random(text.len());
            match random(3) {
                0 => text[at] = LETTERS[random(LETTERS.len())],
                1 => drop(text.remove(at)),
                _ => text.insert(at, LETTERS[random(LETTERS.len())]),
            }
        }
        let Ok(crs) = Crs::read(&String::from_utf8_lossy(&text)) else { continue };
        usable += 1;
        for [x, y] in [[0.0, 0.0], [458874.0, 5438769.0], [-1e7, 1e7], [8.0, 49.0]] {
            let _ = (crs.to_wgs84(DVec3::new(x, y, 1.0)), crs.convergence_rad(x, y));
        }
    }
    assert!(usable > 100, "{usable} of 1000 were read");
}
