//! Files of known programs that are not read, and how to export a readable file from each program.

use super::companion;
use crate::message::{Message, message};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// A format that is known but not read.
struct RefusedFormat {
    /// What its files are usually called, with the article.
    what: &'static str,
    /// The endings of its files' names.
    endings: &'static [&'static str],
    /// The first bytes of its files. Several formats may share them; then the ending decides.
    marks: &'static [&'static [u8]],
    /// Words near the beginning, for texts whose first bytes are common.
    words: &'static [&'static [u8]],
    /// How to export something that is read.
    way_out: &'static str,
}

/// The first bytes of Microsoft's compound files.
const COMPOUND: &[u8] = b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1";

const REFUSED: &[RefusedFormat] = &[
    RefusedFormat {
        what: "a SketchUp file",
        endings: &["skp", "skb"],
        marks: &[b"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0"],
        words: &[],
        way_out: "in SketchUp, File > Export > 3D Model, as COLLADA (.dae), which keeps its components separate",
    },
    RefusedFormat {
        what: "a Rhino file",
        endings: &["3dm"],
        marks: &[b"3D Geometry File Format"],
        words: &[],
        way_out: "in Rhino, File > Export Selected, as .obj or .glb",
    },
    RefusedFormat {
        what: "a Revit file",
        endings: &["rvt", "rfa", "rte", "rft"],
        marks: &[COMPOUND],
        words: &[],
        way_out: "in Revit, File > Export > IFC; a family is first loaded into a project",
    },
    RefusedFormat {
        what: "a 3ds Max file",
        endings: &["max"],
        marks: &[COMPOUND],
        words: &[],
        way_out: "in 3ds Max, File > Export > Export, as OBJ",
    },
    RefusedFormat {
        what: "an Archicad file",
        endings: &["pln", "pla", "mod", "tpl", "gsm"],
        marks: &[],
        words: &[],
        way_out: "in Archicad, File > Save As, as IFC File",
    },
    RefusedFormat {
        what: "a Vectorworks file",
        endings: &["vwx"],
        marks: &[],
        words: &[],
        way_out: "in Vectorworks, File > Export > Export IFC Project",
    },
    RefusedFormat {
        what: "a DWG drawing",
        endings: &["dwg"],
        marks: &[b"AC10"],
        words: &[],
        way_out: "in AutoCAD, File > Save As, as DXF; solids first become meshes with the command MESHSMOOTH",
    },
    RefusedFormat {
        what: "a 3DS file",
        endings: &["3ds"],
        marks: &[],
        words: &[],
        way_out: "in the program that wrote it, File > Export, as OBJ or COLLADA",
    },
    RefusedFormat {
        what: "an FBX file",
        endings: &["fbx"],
        marks: &[b"Kaydara FBX Binary", b"; FBX "],
        words: &[],
        way_out: "in Blender, File > Import > FBX, then File > Export > glTF 2.0",
    },
    RefusedFormat {
        what: "a Blender file",
        endings: &["blend"],
        marks: &[b"BLENDER"],
        words: &[],
        way_out: "in Blender, File > Export > glTF 2.0",
    },
    RefusedFormat {
        what: "a USD file",
        endings: &["usd", "usda", "usdc", "usdz"],
        marks: &[b"PXR-USDC", b"#usda"],
        words: &[],
        way_out: "in Blender, File > Import > Universal Scene Description, then File > Export > glTF 2.0",
    },
    RefusedFormat {
        what: "ifcXML",
        endings: &["ifcxml"],
        marks: &[],
        words: &[
            b"<ifcXML",
            b":ifcXML",
            b"iso_10303_28",
            b"buildingsmart-tech.org/ifcXML",
            b"buildingsmart-tech.org/ifc/IFC4",
        ],
        way_out: "in the program that wrote it, export the model as IFC (.ifc) instead of ifcXML",
    },
    RefusedFormat {
        what: "IFC 5 (ifcx)",
        endings: &["ifcx"],
        marks: &[],
        words: &[b"\"ifcxVersion\""],
        way_out: "in the program that wrote it, export the model as IFC 4 or 4.3 (.ifc)",
    },
    RefusedFormat {
        what: "a KML file",
        endings: &["kml"],
        marks: &[],
        words: &[b"<kml"],
        way_out: "in QGIS, Layer > Save As, as GeoJSON or FlatGeobuf; a model that it places is a COLLADA file (.dae): open that",
    },
    RefusedFormat {
        what: "a KMZ archive",
        endings: &["kmz"],
        marks: &[],
        words: &[],
        way_out: "unpack it and open the COLLADA file (.dae) in it; for outlines open it in QGIS, then Layer > Save As, as GeoJSON",
    },
    RefusedFormat {
        what: "OpenStreetMap's own format",
        endings: &["osm", "pbf"],
        marks: &[],
        words: &[b"<osm "],
        way_out: "on overpass-turbo.eu, Export > GeoJSON, or with GDAL: ogr2ogr out.fgb FILE multipolygons",
    },
    RefusedFormat {
        what: "a GeoPackage",
        endings: &["gpkg"],
        marks: &[b"SQLite format 3\0"],
        words: &[],
        way_out: "in QGIS, Layer > Save As, as FlatGeobuf or GeoJSON",
    },
    RefusedFormat {
        what: "a STEP or IGES file",
        endings: &["step", "stp", "p21", "iges", "igs"],
        marks: &[],
        words: &[],
        way_out: "in FreeCAD, open it, select all, then File > Export, as glTF",
    },
    RefusedFormat {
        what: "a FreeCAD file",
        endings: &["fcstd"],
        marks: &[],
        words: &[],
        way_out: "in FreeCAD, select all, then File > Export, as glTF or IFC",
    },
    RefusedFormat {
        what: "a list of points",
        endings: &["xyz", "pts", "ptx"],
        marks: &[],
        words: &[],
        way_out: "in CloudCompare, File > Save, as LAS",
    },
    RefusedFormat {
        what: "an E57 point cloud",
        endings: &["e57"],
        marks: &[b"ASTM-E57"],
        words: &[],
        way_out: "in CloudCompare, File > Save, as LAS",
    },
    RefusedFormat {
        what: "gbXML",
        endings: &["gbxml"],
        marks: &[],
        words: &[b"<gbXML"],
        way_out: "in the program that wrote it, export the model as IFC (.ifc) instead of gbXML",
    },
    RefusedFormat {
        what: "a PDF file",
        endings: &["pdf"],
        marks: &[b"%PDF-"],
        words: &[],
        way_out: "in the program that drew it, export the model as IFC or glTF",
    },
    RefusedFormat {
        what: "a zip archive without a model at its beginning",
        endings: &["zip"],
        marks: &[],
        words: &[],
        way_out: "unpack it and open the model in it",
    },
];

impl RefusedFormat {
    fn begins(&self, head: &[u8]) -> bool {
        let is_text = head.trim_ascii_start().first().is_some_and(|first| b"<{\xEF".contains(first));
        let holds = |word: &&[u8]| head.windows(word.len()).any(|here| here == *word);
        self.marks.iter().any(|mark| head.starts_with(mark)) || is_text && self.words.iter().any(holds)
    }

    fn message(&self) -> Message {
        message![format!("is {}, which Gnomon does not read", self.what); self.way_out]
    }
}

/// The error for a file with these first bytes, if they identify a format that is not read.
pub(super) fn by_content(head: &[u8], path: &Path) -> Option<Message> {
    let mut alike = REFUSED.iter().filter(|format| format.begins(head));
    let first = alike.clone().next()?;
    Some(alike.find(|format| format.ends(path)).unwrap_or(first).message())
}

/// The error for a file with the ending of a format that is not read.
pub(super) fn by_ending(path: &Path) -> Option<Message> {
    REFUSED.iter().find(|format| format.ends(path)).map(RefusedFormat::message)
}

impl RefusedFormat {
    fn ends(&self, path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        self.endings.contains(&ending.as_str())
    }
}

/// The message for a file of a known format that is not read; `None` for other files.
pub(crate) fn refusal(path: &Path) -> Option<Message> {
    if !path.is_file() {
        return None;
    }
    let mut head = Vec::new();
    File::open(path).ok()?.take(super::format::HEAD_BYTES).read_to_end(&mut head).ok()?;
    by_content(&head, path).or_else(|| by_ending(path)).or_else(|| companion::refusal(path))
}
