//! Files of known programs that cannot be read, and the rules that all formats follow.

use super::building::*;
use gnomon::formats::FORMATS;
use gnomon::site::{Overrides, WrittenSite};

#[test]
fn files_of_other_programs_say_how_to_export() {
    for (name, head, words) in [
        ("house.skp", &b"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0U\0p\0"[..], &["SketchUp", "File > Export > 3D Model"][..]),
        ("house.3dm", b"3D Geometry File Format        7", &["Rhino", "File > Export Selected"]),
        ("house.rvt", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", &["Revit", "File > Export > IFC"]),
        ("house.rfa", b"", &["Revit", "File > Export > IFC"]),
        ("house.max", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", &["3ds Max", "as OBJ"]),
        ("house.pln", b"", &["Archicad", "File > Save As"]),
        ("house.dwg", b"AC1032", &["DWG", "as DXF"]),
        ("house.3ds", b"", &["3DS", "OBJ"]),
        ("house.fbx", b"Kaydara FBX Binary  \0", &["FBX", "File > Import > FBX"]),
        ("house.blend", b"BLENDER-v300", &["Blender", "File > Export > glTF 2.0"]),
        ("house.usdz", b"PK\x03\x04", &["USD", "File > Export > glTF 2.0"]),
        // the content goes before the name
        ("house.obj", b"AC1032", &["DWG"]),
        ("house", b"#usda 1.0", &["USD"]),
        ("house.ifcxml", b"", &["ifcXML", "export the model as IFC (.ifc)"]),
        (
            "house.xml",
            b"<?xml version=\"1.0\"?><ifcXML xmlns=\"http://www.buildingsmart-tech.org/ifcXML/IFC4\">",
            &["ifcXML"],
        ),
        ("house.xml", b"<ex:iso_10303_28 xmlns:ex=\"urn:iso\">", &["ifcXML"]),
        ("house.ifcx", b"", &["IFC 5", "as IFC 4 or 4.3"]),
        ("house.json", b"{\"header\":{\"ifcxVersion\":\"ifcx_alpha\"},\"data\":[]}", &["IFC 5 (ifcx)"]),
        ("house.kml", b"<?xml version=\"1.0\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\">", &["KML", "QGIS"]),
        ("house.kmz", b"PK\x03\x04", &["KMZ", ".dae"]),
        ("town.xml", b"<osm version=\"0.6\">", &["OpenStreetMap", "overpass-turbo.eu"]),
        ("town.osm.pbf", b"\0\0\0\x0e", &["OpenStreetMap", "ogr2ogr"]),
        ("town.db", b"SQLite format 3\0", &["GeoPackage", "FlatGeobuf"]),
        ("part.stp", b"ISO-10303-21;", &["STEP", "FreeCAD"]),
        ("part.FCStd", b"PK\x03\x04", &["FreeCAD file", "File > Export"]),
        ("ground.xyz", b"1 2 3\n", &["points", "as LAS"]),
        ("scan.e57", b"ASTM-E57", &["E57", "CloudCompare"]),
        ("house.xml", b"<gbXML version=\"6.01\">", &["gbXML", "IFC"]),
        ("plan.pdf", b"%PDF-1.7", &["PDF", "IFC"]),
        ("obj.zip", b"PK\x03\x04", &["zip archive", "unpack it"]),
    ] {
        assert_refused(name, head, words);
        assert_refused(name, head, &["which Gnomon does not read"]);
    }
    assert_refused("house.txt", b"a house", &["of no format that Gnomon knows", "glTF", "OBJ", "DXF"]);
}

/// Endings lead to one format each, but for those of texts of many formats, which their content tells apart.
#[test]
fn no_ending_is_two_formats_own() {
    let endings = FORMATS.iter().flat_map(|format| format.endings()).copied();
    let mut endings: Vec<&str> = endings.filter(|ending| !["json", "xml"].contains(ending)).collect();
    let count = endings.len();
    endings.sort_unstable();
    endings.dedup();
    assert_eq!(endings.len(), count);
}

#[test]
fn files_that_go_with_a_model_name_it() {
    let shp = [&9994_u32.to_be_bytes()[..], &[0; 24], &1000_u32.to_le_bytes(), &[0; 72]].concat();
    for (name, bytes, words) in [
        ("roads.shx", &shp[..], &["the index of a shapefile", "put roads.shp beside it"][..]),
        ("roads.dbf", b"\x03~\x01\x01", &["the attributes of a shapefile", "put roads.shp beside it"]),
        ("roads.prj", b"PROJCS[]", &["the reference system of a shapefile or a grid", "roads.shp"]),
        ("house.mtl", b"newmtl a", &["the materials of an OBJ file", "house.obj"]),
    ] {
        assert_refused(name, bytes, words);
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["roads.shx", "roads.SHP", "dem.prj", "dem.asc"] {
        std::fs::write(folder.path().join(name), &shp).unwrap();
    }
    let hint =
        |name: &str| gnomon::formats::read(&folder.path().join(name), &Default::default()).unwrap_err().to_string();
    assert!(hint("roads.shx").contains("open roads.SHP, which lies beside it"), "{}", hint("roads.shx"));
    std::fs::write(folder.path().join("dem.prj"), "EPSG:25832").unwrap();
    assert!(hint("dem.prj").contains("open dem.asc"), "{}", hint("dem.prj"));
}

/// A file that is neither a model nor a site is reported as such; for one that is meant as a site, the error in it is
/// reported.
#[test]
fn what_is_neither_site_nor_model_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        WrittenSite::read(&path, &Overrides::default()).unwrap_err().to_string()
    };
    for (name, bytes) in [("list.txt", &b"three walls\n"[..]), ("house", b"\x01\x02\0\xFF"), ("a.doc", b"caf\xE9")] {
        let error = told(name, bytes);
        assert!(error.contains("is neither a site file nor a model") && error.contains("docs/formats.md"), "{error}");
    }
    for name in ["site.toml", "site.txt"] {
        let error = told(name, b"[place]\nlatitude 48\n");
        assert!(!error.contains("neither") && error.contains("latitude 48"), "{error}");
    }
    let error = told("large.toml", &vec![b'#'; 16_000_001]);
    assert!(error.contains("16000001 bytes") && error.contains("16 MB"), "{error}");
    assert!(told("kml.kml", b"<kml>").contains("KML"));
}
