//! Malicious files. The reader is a third-party library: any failure in it becomes one error, in this process, too.

use super::house::house;
use super::{HEAD, read_as};
use crate::formats::mutations::read_watched;
use std::time::{Duration, Instant};

/// A sequence of numbers that looks like chance, and is always the same.
struct Chance(u64);

impl Chance {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % most
    }
}

/// The file with some of its bytes changed, a piece repeated, or what is before its end cut off.
fn mutated(text: &[u8], chance: &mut Chance) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for _ in 0..1 + chance.below(4) {
        let at = chance.below(bytes.len());
        match chance.below(8) {
            // with an end, as one without is refused before it is read
            0 => {
                bytes.truncate(at.max(HEAD.len()));
                bytes.extend(b"\nENDSEC;\nEND-ISO-10303-21;\n");
            }
            1 => {
                let piece = bytes[at..(at + chance.below(200)).min(bytes.len())].to_vec();
                bytes.splice(at..at, piece);
            }
            2 => bytes[at] = chance.below(256) as u8,
            3 => bytes[at] = b"#$*'().,;=-/"[chance.below(12)],
            // numbers of records and of lengths: what is most read
            _ => {
                let digits: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
                let at = digits[chance.below(digits.len())];
                bytes[at] = b'0' + chance.below(10) as u8;
            }
        }
    }
    bytes
}

#[test]
fn a_thousand_mutations_neither_panic_nor_hang() {
    let text = house("");
    let mut chance = Chance(18);
    let mut read = 0;
    for round in 0..1000 {
        let bytes = mutated(text.as_bytes(), &mut chance);
        let started = Instant::now();
        if let Ok(model) = read_as("house.ifc", &bytes) {
            read += 1;
            for part in &model.parts {
                let corners = part.positions.len() as u32;
                assert!(part.triangles.iter().flatten().all(|&corner| corner < corners), "round {round}");
                assert!(part.positions.iter().all(|at| at.is_finite()), "round {round}");
            }
            assert!(model.see_through.iter().flat_map(|it| &it.parts).all(|&part| part < model.parts.len()));
        }
        assert!(started.elapsed() < Duration::from_secs(10), "round {round} took {:?}", started.elapsed());
        // its reader makes shapes on threads of its own, so that a process is watched
        if round % 20 == 0 {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("house.ifc");
            std::fs::write(&path, &bytes).expect("written");
            read_watched(&path);
        }
    }
    assert!(read > 300, "only {read} could be read, so the mutations try little");
}

#[test]
fn circles_of_records_end() {
    let circles = [
        // a place that stands on itself
        house("")
            .replace("'Column 1',$,$,#20", "'Column 1',$,$,#970")
            .replace("#408=", "#970=IFCLOCALPLACEMENT(#970,#6);\n#408="),
        // a storey that is its own part
        house("#970=IFCRELAGGREGATES('0000000000000000000050',$,$,$,#23,(#22));"),
        // a shape that repeats itself
        house("").replace(
            "#406=IFCEXTRUDEDAREASOLID(#401,#6,#7,3000.);",
            "#406=IFCMAPPEDITEM(#971,#972);\n#971=IFCREPRESENTATIONMAP(#6,#405);\n\
             #972=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#5,1.,$);",
        ),
        // a cut of itself by itself
        house("")
            .replace("#406=IFCEXTRUDEDAREASOLID(#401,#6,#7,3000.);", "#406=IFCBOOLEANRESULT(.DIFFERENCE.,#406,#406);"),
        // a material of itself
        house("").replace("#408=IFCMATERIAL('Steel',$,$);", "#408=IFCMATERIALLIST((#408,#408,#408,#408));"),
    ];
    for (at, text) in circles.iter().enumerate() {
        let started = Instant::now();
        let model = read_as("house.ifc", text.as_bytes()).unwrap_or_else(|error| panic!("circle {at}: {error}"));
        assert!(!model.parts.is_empty() && started.elapsed() < Duration::from_secs(10), "circle {at}");
    }
}

#[test]
fn numbers_beyond_all_bounds_are_no_shape() {
    for number in ["1.E400", "1.E300", "-1.E39", "0."] {
        let text = house("").replace("#7,30000.);", &format!("#7,{number});"));
        if let Ok(model) = read_as("house.ifc", text.as_bytes()) {
            assert!(model.parts.iter().flat_map(|part| &part.positions).all(|at| at.is_finite()), "{number}");
        }
    }
    let text = house("").replace("#3=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);", "#3=IFCCONVERSIONBASEDUNIT($,.LENGTHUNIT.,'OWN',#9);\n#9=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.),#8);\n#8=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);");
    let error = read_as("house.ifc", text.as_bytes()).expect_err("no unit");
    assert!(error.contains("has a unit of length that is not a number"), "{error}");
}

#[test]
fn long_names_are_cut_and_told() {
    let text = house("").replace("'Window 1'", &format!("'{}'", "ü".repeat(4000)));
    let model = read_as("house.ifc", text.as_bytes()).expect("read");
    let aliases = || model.parts.iter().flat_map(|part| &part.aliases);
    assert!(aliases().all(|name| name.len() <= 1000) && aliases().any(|name| name.len() == 1000));
    assert!(super::notes(&model).contains("has names of more than 1000 bytes (2), which are shortened"));
}
