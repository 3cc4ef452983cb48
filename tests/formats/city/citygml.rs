//! CityGML 2 and 3.

use super::block::{AT, Body, assert_is_block, corners, faces, fault_of, left_out, model_of, names};
use glam::DVec3;
use gnomon::formats::{Coordinates, Model, PartKind};

/// A file around some objects, in a reference system.
pub(super) fn city(system: &str, objects: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/2.0\" \
         xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\" xmlns:gml=\"http://www.opengis.net/gml\" \
         xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n<gml:boundedBy><gml:Envelope srsName=\"{system}\" \
         srsDimension=\"3\"><gml:lowerCorner>0 0 0</gml:lowerCorner></gml:Envelope></gml:boundedBy>\n\
         <core:cityObjectMember>{objects}</core:cityObjectMember>\n</core:CityModel>\n"
    )
}

fn ring(points: &[DVec3]) -> String {
    let numbers = points.iter().chain(points.first()).map(|point| format!("{} {} {}", point.x, point.y, point.z));
    let numbers: Vec<String> = numbers.collect();
    format!("<gml:LinearRing><gml:posList>{}</gml:posList></gml:LinearRing>", numbers.join(" "))
}

fn polygon(id: &str, points: &[DVec3]) -> String {
    format!("<gml:Polygon gml:id=\"{id}\"><gml:exterior>{}</gml:exterior></gml:Polygon>", ring(points))
}

/// The building's polygons, each with its kind and id, placed by `place`.
fn polygons(place: impl Fn(DVec3) -> DVec3) -> Vec<(&'static str, String, String)> {
    let corners = corners();
    let each = faces().into_iter().enumerate().map(|(at, (kind, ring))| {
        let points: Vec<DVec3> = ring.iter().map(|&corner| place(corners[corner])).collect();
        (kind, format!("p{at}"), polygon(&format!("p{at}"), &points))
    });
    each.collect()
}

fn members(polygons: impl Iterator<Item = String>) -> String {
    polygons.map(|polygon| format!("<gml:surfaceMember>{polygon}</gml:surfaceMember>")).collect()
}

/// The building as the commonest exporters write it: surfaces with polygons, and a solid that refers to them.
pub(super) fn building(place: impl Fn(DVec3) -> DVec3) -> String {
    let polygons = polygons(place);
    let references = polygons.iter().map(|(_, id, _)| format!("<gml:surfaceMember xlink:href=\"#{id}\"/>"));
    let references: String = references.collect();
    let surfaces = polygons.iter().map(|(kind, id, polygon)| {
        format!(
            "<bldg:boundedBy><bldg:{kind} gml:id=\"s{id}\"><bldg:lod2MultiSurface><gml:MultiSurface>\
             <gml:surfaceMember>{polygon}</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:{kind}>\
             </bldg:boundedBy>"
        )
    });
    let surfaces: String = surfaces.collect();
    format!(
        "<bldg:Building gml:id=\"b\"><gml:name>Haus &amp; Hof</gml:name><bldg:lod2Solid><gml:Solid><gml:exterior>\
         <gml:CompositeSurface>{references}</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>{surfaces}\
         </bldg:Building>"
    )
}

fn at(corner: DVec3) -> DVec3 {
    corner + AT
}

fn read(text: &str) -> Model {
    model_of("a.gml", text)
}

#[test]
fn a_solid_of_references_is_a_part_for_each_kind_of_surface() {
    let model = read(&city("EPSG:25832", &building(at)));
    assert_is_block(&model);
    assert_eq!(names(&model), ["Building b/GroundSurface", "Building b/RoofSurface", "Building b/WallSurface"]);
    assert_eq!(model.parts[2].aliases, ["b", "Building", "Haus & Hof", "WallSurface"]);
    assert_eq!(model.coordinates, Coordinates::Map("EPSG:25832".into()));
    assert_eq!((model.left_out, model.notes), (vec![], vec![]));
}

#[test]
fn axes_are_in_the_order_that_the_name_of_the_system_asks_for() {
    let north_first = |corner: DVec3| {
        let place = at(corner);
        DVec3::new(place.y, place.x, place.z)
    };
    // of Gauss-Krüger's zones the northing is first, of UTM's the easting
    for (system, is_swapped) in [
        ("urn:ogc:def:crs:EPSG::31467", true),
        ("http://www.opengis.net/def/crs/EPSG/0/31467", true),
        ("EPSG:31467", false),
        ("urn:ogc:def:crs:EPSG::25832", false),
        ("urn:ogc:def:crs:EPSG::2056", false),
        ("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH", false),
    ] {
        let file = if is_swapped { building(north_first) } else { building(at) };
        assert_is_block(&read(&city(system, &file)));
    }
    let zoned = |corner: DVec3| at(corner) + DVec3::new(32e6, 0.0, 0.0);
    let model = read(&city("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH", &building(zoned)));
    assert_is_block(&model);
    assert!(model.notes[0].to_string().contains("zone, 32"), "{:?}", model.notes);
    let degrees = |corner: DVec3| DVec3::new(35.0 + corner.y * 1e-5, 139.0 + corner.x * 1e-5, corner.z);
    let model = read(&city("http://www.opengis.net/def/crs/EPSG/0/6697", &building(degrees)));
    assert!(model.parts[0].positions.iter().all(|corner| corner.x > 138.0 && corner.y < 36.0));
    assert_eq!(model.notes, vec![]);
    let turned = |corner: DVec3| DVec3::new(139.0 + corner.x * 1e-5, 35.0 + corner.y * 1e-5, corner.z);
    let model = read(&city("http://www.opengis.net/def/crs/EPSG/0/6697", &building(turned)));
    assert!(model.parts[0].positions.iter().all(|corner| corner.x > 138.0), "no latitude is 139°");
    assert!(model.notes[0].to_string().contains("longitudes"), "{:?}", model.notes);
}

#[test]
fn version_3_and_other_shapes_of_geometry_give_the_building() {
    let inside = |polygons: Vec<(&str, String, String)>| members(polygons.into_iter().map(|(_, _, polygon)| polygon));
    let shell = format!("<gml:Shell>{}</gml:Shell>", inside(polygons(at)));
    let patches: String = polygons(at)
        .into_iter()
        .map(|(_, _, polygon)| {
            polygon.replace("gml:Polygon ", "gml:PolygonPatch ").replace("/gml:Polygon>", "/gml:PolygonPatch>")
        })
        .collect();
    let reversed = |corner: DVec3| at(DVec3::new(corner.y, corner.x, corner.z));
    let turned = polygons(reversed).into_iter().map(|(_, _, polygon)| {
        format!("<gml:OrientableSurface orientation=\"-\"><gml:baseSurface>{polygon}</gml:baseSurface></gml:OrientableSurface>")
    });
    let turned = members(turned);
    for geometry in [
        format!("<core:lod2Solid><gml:Solid><gml:exterior>{shell}</gml:exterior></gml:Solid></core:lod2Solid>"),
        format!(
            "<core:lod3MultiSurface><gml:MultiSurface>{}</gml:MultiSurface></core:lod3MultiSurface>",
            inside(polygons(at))
        ),
        format!(
            "<bldg:lod1Solid><gml:Solid><gml:exterior><gml:Surface><gml:patches>{patches}</gml:patches></gml:Surface></gml:exterior></gml:Solid></bldg:lod1Solid>"
        ),
    ] {
        let model = read(&city("EPSG:25832", &format!("<con:Building gml:id=\"b\">{geometry}</con:Building>")));
        assert_is_block(&model);
    }
    // turned faces of a mirrored building: its volume is the building's
    let geometry =
        format!("<core:lod3MultiSurface><gml:MultiSurface>{turned}</gml:MultiSurface></core:lod3MultiSurface>");
    let model = read(&city("EPSG:25832", &format!("<bldg:Building gml:id=\"b\">{geometry}</bldg:Building>")));
    let plain = read(&city("EPSG:25832", &building(at)));
    assert!((Body::of(&model, AT).volume() - Body::of(&plain, AT).volume()).abs() < 1e-6);
}

#[test]
fn polygons_that_are_written_twice_stand_there_once() {
    let both = building(at);
    let solid = members(polygons(at).into_iter().map(|(_, _, polygon)| polygon.replace("gml:id=\"p", "gml:id=\"q")));
    let (before, rest) = both.split_once("<gml:CompositeSurface>").expect("a solid");
    let (_, after) = rest.split_once("</gml:CompositeSurface>").expect("a solid");
    let doubled = format!("{before}<gml:CompositeSurface>{solid}</gml:CompositeSurface>{after}");
    assert_is_block(&read(&city("EPSG:25832", &doubled)));
}

#[test]
fn one_level_of_detail_stands_there_and_parts_replace_their_building() {
    let flat = polygon("f", &[at(DVec3::ZERO), at(DVec3::X), at(DVec3::Y)]);
    let outline = format!(
        "<bldg:lod0FootPrint><gml:MultiSurface><gml:surfaceMember>{flat}</gml:surfaceMember></gml:MultiSurface></bldg:lod0FootPrint>"
    );
    let whole = building(at).replace("<bldg:lod2Solid>", &format!("{outline}<bldg:lod2Solid>"));
    let model = read(&city("EPSG:25832", &whole));
    assert_is_block(&model);
    assert_eq!(left_out(&model, "geometries"), 1);
    let part =
        building(at).replace("bldg:Building ", "bldg:BuildingPart ").replace("/bldg:Building>", "/bldg:BuildingPart>");
    let nested = format!(
        "<bldg:Building gml:id=\"whole\">{outline}<bldg:consistsOfBuildingPart>{part}</bldg:consistsOfBuildingPart></bldg:Building>"
    );
    let model = read(&city("EPSG:25832", &nested));
    assert_is_block(&model);
    assert_eq!(left_out(&model, "Building"), 1);
    assert!(model.parts[0].aliases.contains(&"whole".to_owned()), "{:?}", model.parts[0].aliases);
}

#[test]
fn holes_rooms_terrain_and_shapes_of_libraries() {
    let square = |side: f64, z: f64| {
        [DVec3::new(0.0, 0.0, z), DVec3::new(side, 0.0, z), DVec3::new(side, side, z), DVec3::new(0.0, side, z)]
    };
    let inner: Vec<DVec3> =
        square(2.0, 0.0).into_iter().map(|corner| corner + DVec3::new(1.0, 1.0, 0.0)).rev().collect();
    let holed = format!(
        "<gml:Polygon><gml:exterior>{}</gml:exterior><gml:interior>{}</gml:interior></gml:Polygon>",
        ring(&square(10.0, 0.0)),
        ring(&inner)
    );
    let triangle =
        format!("<gml:Triangle><gml:exterior>{}</gml:exterior></gml:Triangle>", ring(&square(3.0, 1.0)[..3]));
    let objects = format!(
        "<luse:LandUse gml:id=\"l\"><luse:lod1MultiSurface><gml:MultiSurface><gml:surfaceMember>{holed}</gml:surfaceMember>\
         </gml:MultiSurface></luse:lod1MultiSurface></luse:LandUse></core:cityObjectMember><core:cityObjectMember>\
         <dem:ReliefFeature gml:id=\"r\"><dem:lod>1</dem:lod><dem:reliefComponent><dem:TINRelief gml:id=\"t\"><dem:tin>\
         <gml:TriangulatedSurface><gml:trianglePatches>{triangle}</gml:trianglePatches></gml:TriangulatedSurface></dem:tin>\
         </dem:TINRelief></dem:reliefComponent></dem:ReliefFeature></core:cityObjectMember><core:cityObjectMember>\
         <veg:SolitaryVegetationObject><veg:lod2ImplicitRepresentation><core:ImplicitGeometry><gml:Point/>\
         </core:ImplicitGeometry></veg:lod2ImplicitRepresentation></veg:SolitaryVegetationObject></core:cityObjectMember>\
         <core:cityObjectMember><tran:Road gml:id=\"none\"/></core:cityObjectMember><core:cityObjectMember>\
         <bldg:Building gml:id=\"b\"><bldg:interiorRoom><bldg:Room><bldg:lod4MultiSurface><gml:MultiSurface>\
         <gml:surfaceMember>{}</gml:surfaceMember><gml:surfaceMember xlink:href=\"#nowhere\"/></gml:MultiSurface>\
         </bldg:lod4MultiSurface></bldg:Room></bldg:interiorRoom></bldg:Building>",
        polygon("x", &square(1.0, 0.0))
    );
    let model = read(&city("EPSG:25832", &objects));
    assert_eq!(names(&model), ["LandUse l", "TINRelief t"]);
    assert_eq!((model.kind(0), model.kind(1)), (PartKind::GroundCover, PartKind::Terrain));
    let area = |part: usize| {
        let part = &model.parts[part];
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| part.positions[corner as usize]);
            (b - a).cross(c - a).z / 2.0
        };
        part.triangles.iter().map(of).sum::<f64>()
    };
    assert!((area(0) - 96.0).abs() < 1e-9, "{}", area(0));
    let counts = ["ImplicitGeometry", "Road", "Room"].map(|what| left_out(&model, what));
    assert_eq!(counts, [1, 1, 1], "{:?}", model.left_out);
}

#[test]
fn references_that_lead_nowhere_out_or_round_are_told() {
    let solid = "<bldg:lod2Solid><gml:Solid gml:id=\"round\"><gml:exterior><gml:CompositeSurface gml:id=\"c\">\
         <gml:surfaceMember xlink:href=\"#round\"/><gml:surfaceMember xlink:href=\"#c\"/><gml:surfaceMember xlink:href=\"#lost\"/>\
         <gml:surfaceMember xlink:href=\"other.gml#p\"/></gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>";
    let both = building(at).replace("</bldg:Building>", &format!("{solid}</bldg:Building>"));
    let model = read(&city("EPSG:25832", &both));
    assert_is_block(&model);
    let whys: Vec<&str> = model.left_out.iter().map(|one| one.why.as_str()).collect();
    assert!(
        whys.contains(&"the reference is not in the file") && whys.contains(&"the reference is to another file"),
        "{whys:?}"
    );
}

#[test]
fn older_encodings_are_read_and_damage_is_said() {
    let text = city("EPSG:25832", &building(at)).replace("UTF-8", "ISO-8859-1").replace("Haus", "Gebäude");
    let latin: Vec<u8> = text.chars().map(|letter| u8::try_from(u32::from(letter)).expect("Latin 1")).collect();
    let model = model_of("a.gml", latin);
    assert_is_block(&model);
    assert_eq!(model.parts[0].aliases[2], "Gebäude & Hof");
    let whole = city("EPSG:25832", &building(at));
    let cut = fault_of("a.gml", &whole[..whole.len() - 60]);
    assert!(cut.contains("is cut off") || cut.contains("is no XML"), "{cut}");
    let crossed = fault_of("a.gml", whole.replace("</bldg:Building>", "</bldg:Tower>"));
    assert!(crossed.contains("is no XML at its byte"), "{crossed}");
    let bomb =
        whole.replace("<core:CityModel", "<!DOCTYPE a [<!ENTITY x \"ha\"><!ENTITY y \"&x;&x;\">]>\n<core:CityModel");
    assert_is_block(&model_of("a.gml", bomb.replace("&amp;", "&y;")));
}
