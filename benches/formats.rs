//! How long it takes to read model files, each at one size and at ten times that size: `cargo bench --bench formats`.
//! Prints a table in Markdown; `-- FILE…` adds files of your own.
//!
//! The bench writes the files itself: a hilly sheet of triangles as OBJ and STL, buildings as CityJSON and as
//! footprints, heights as an ASCII grid, walls and furniture as IFC. The house of `sites/hillside` is added. Compare
//! the columns, since absolute times vary with the machine's load.

mod ifc_text;
mod timing;

use gnomon::formats::{self, ReadOptions};
use ifc_text::FurnitureAs;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use timing::{median, timed};

/// How often each file is read.
const TIMES: usize = 5;

/// A format's name, its extension, a function that writes a file with a given number of objects, and that number.
type Writer = (&'static str, &'static str, fn(usize) -> Vec<u8>, usize);

const WRITERS: [Writer; 7] = [
    ("OBJ, triangles", "obj", obj, 18_200),
    ("STL, triangles", "stl", stl, 18_200),
    ("CityJSON, buildings", "city.json", city_json, 500),
    ("GeoJSON, footprints", "geojson", geojson, 500),
    ("ASCII grid, heights", "asc", ascii_grid, 100_000),
    ("IFC, products with face sets", "ifc", |products| ifc_text::ifc(products, FurnitureAs::FaceSet), 200),
    ("IFC, products with breps", "ifc", |products| ifc_text::ifc(products, FurnitureAs::Brep), 200),
];

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let folder = std::env::temp_dir().join(format!("gnomon-bench-formats-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    println!(
        "| format | things | MB | triangles | ms | ten times as many, ms | ratio |\n|---|---|---|---|---|---|---|"
    );
    for (name, ending, write, things) in WRITERS {
        let [one, ten] = [things, 10 * things].map(|things| {
            let path = folder.join(format!("{things}.{ending}"));
            std::fs::write(&path, write(things)).expect("a file");
            measured(&path)
        });
        println!(
            "| {name} | {things} | {:.1} | {} | {:.1} | {:.1} | {:.1} |",
            one.megabytes,
            one.triangles,
            one.ms,
            ten.ms,
            ten.ms / one.ms
        );
    }
    let house = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/hillside/house.ifc");
    let own = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).map(PathBuf::from);
    for path in std::iter::once(house).chain(own) {
        let file = measured(&path);
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        println!("| {name} | 1 | {:.1} | {} | {:.1} | | |", file.megabytes, file.triangles, file.ms);
    }
    println!(
        "\nMedians of {TIMES}; {} threads; read in this process, without the cache.",
        rayon::current_num_threads()
    );
    std::fs::remove_dir_all(&folder).expect("the bench's own folder");
}

struct Measured {
    megabytes: f64,
    triangles: usize,
    ms: f64,
}

fn measured(path: &Path) -> Measured {
    let mut times = Vec::new();
    let mut triangles = 0;
    for _ in 0..TIMES {
        let model = timed(&mut times, || formats::read(path, &ReadOptions::default()).expect("a model"));
        triangles = model.parts.iter().map(|part| part.triangles.len()).sum();
    }
    let bytes = std::fs::metadata(path).expect("a file").len();
    Measured { megabytes: bytes as f64 / 1e6, triangles, ms: median(times) }
}

/// A height of the hilly sheet.
fn height(x: usize, y: usize) -> f64 {
    200.0 + 20.0 * (x as f64 / 37.0).sin() * (y as f64 / 51.0).cos()
}

/// The number of squares along a side of a sheet with about this many triangles.
fn side(triangles: usize) -> usize {
    (triangles as f64 / 2.0).sqrt().ceil() as usize
}

fn obj(triangles: usize) -> Vec<u8> {
    let side = side(triangles);
    let mut text = "o sheet\n".to_owned();
    for y in 0..=side {
        for x in 0..=side {
            writeln!(text, "v {x}.25 {:.4} {y}.75", height(x, y)).expect("a text");
        }
    }
    for y in 0..side {
        for x in 0..side {
            let corner = |dx: usize, dy: usize| (y + dy) * (side + 1) + x + dx + 1;
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").expect("a text");
        }
    }
    text.into_bytes()
}

fn stl(triangles: usize) -> Vec<u8> {
    let side = side(triangles);
    let mut bytes = vec![0; 80];
    bytes.extend(((2 * side * side) as u32).to_le_bytes());
    for y in 0..side {
        for x in 0..side {
            for corners in [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]] {
                bytes.extend([0; 12]);
                for (dx, dy) in corners {
                    let point = [(x + dx) as f32, (y + dy) as f32, height(x + dx, y + dy) as f32];
                    bytes.extend(point.iter().flat_map(|number| number.to_le_bytes()));
                }
                bytes.extend([0; 2]);
            }
        }
    }
    bytes
}

/// Buildings stand on a square of these, 20 m apart.
fn place(building: usize) -> (usize, usize) {
    (building % 100 * 20, building / 100 * 20)
}

fn city_json(buildings: usize) -> Vec<u8> {
    let (mut objects, mut vertices) = (String::new(), String::new());
    for building in 0..buildings {
        let (x, y) = place(building);
        let top = 5 + building % 20;
        for z in [0, top] {
            for (dx, dy) in [(0, 0), (10, 0), (10, 8), (0, 8)] {
                write!(vertices, "[{},{},{z}],", x + dx, y + dy).expect("a text");
            }
        }
        let v = |corner: usize| 8 * building + corner;
        let ring = |corners: [usize; 4]| {
            format!("[[{},{},{},{}]]", v(corners[0]), v(corners[1]), v(corners[2]), v(corners[3]))
        };
        let sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]].map(ring);
        write!(
            objects,
            "\"b{building}\":{{\"type\":\"Building\",\"geometry\":[{{\"type\":\"Solid\",\"lod\":\"2\",\"boundaries\":[[{}]],\
             \"semantics\":{{\"surfaces\":[{{\"type\":\"GroundSurface\"}},{{\"type\":\"RoofSurface\"}},{{\"type\":\"WallSurface\"}}],\
             \"values\":[[0,1,2,2,2,2]]}}}}]}},",
            sides.join(",")
        )
        .expect("a text");
    }
    let text = format!(
        "{{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":{{\"scale\":[1,1,1],\"translate\":[0,0,0]}},\
         \"CityObjects\":{{{}}},\"vertices\":[{}]}}",
        objects.trim_end_matches(','),
        vertices.trim_end_matches(',')
    );
    text.into_bytes()
}

fn geojson(footprints: usize) -> Vec<u8> {
    let mut features = String::new();
    for footprint in 0..footprints {
        let (x, y) = place(footprint);
        let [x, y] = [13.0 + x as f64 * 1e-5, 47.0 + y as f64 * 1e-5];
        let corner = |dx: f64, dy: f64| format!("[{:.7},{:.7}]", x + dx, y + dy);
        let [a, b, c, d] = [corner(0.0, 0.0), corner(1e-4, 0.0), corner(1e-4, 8e-5), corner(0.0, 8e-5)];
        write!(
            features,
            "{{\"type\":\"Feature\",\"properties\":{{\"building\":\"yes\",\"height\":{}}},\"geometry\":{{\"type\":\"Polygon\",\
             \"coordinates\":[[{a},{b},{c},{d},{a}]]}}}},",
            5 + footprint % 20
        )
        .expect("a text");
    }
    format!("{{\"type\":\"FeatureCollection\",\"features\":[{}]}}", features.trim_end_matches(',')).into_bytes()
}

fn ascii_grid(heights: usize) -> Vec<u8> {
    let side = (heights as f64).sqrt().ceil() as usize;
    let mut text = format!("ncols {side}\nnrows {side}\nxllcorner 0\nyllcorner 0\ncellsize 1\n");
    for y in 0..side {
        for x in 0..side {
            write!(text, "{:.2} ", height(x, y)).expect("a text");
        }
        text.push('\n');
    }
    text.into_bytes()
}
