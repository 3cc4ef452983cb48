//! Formats of model files: what is read from each, the messages, and one building written in all of them.

mod apart;
pub(crate) mod building;
mod city;
mod compressed;
mod convert;
mod dae;
mod dxf;
mod foreign;
#[cfg(feature = "ifc")]
mod ifc;
mod kept;
mod kinds;
mod large_faces;
mod las;
#[cfg(unix)]
mod links;
mod mutations;
mod obj;
mod one_house;
mod ply;
mod several;
mod stl;
mod terrain;
mod zip;

#[cfg(not(feature = "ifc"))]
#[test]
fn without_its_reader_an_ifc_file_is_one_clear_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("house.ifc");
    std::fs::write(&path, "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\n").expect("written");
    let error = gnomon::formats::read(&path, &Default::default()).expect_err("no reader").to_string();
    assert!(error.contains("is IFC, but this gnomon was built without a reader for it"), "{error}");
}
