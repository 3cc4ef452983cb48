//! The GeoTIFF and the mask, read back.

use super::synthetic::{self, Town};
use gnomon::export::{ExportError, file, raster};
use gnomon::profile::Profile;
use gnomon::view::Mask;
use std::fs;
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

fn sample() -> (Town, Profile) {
    let town = Town::new(1.0, 32_400, 61_200, 1800);
    let grid = synthetic::grid(70, 50, 0.25);
    // Hours that count up from the north-west corner, so that a turned raster shows.
    let shaded: Vec<u32> = (0..grid.cells() as u32).map(|cell| cell * 2_000).collect();
    let profile = Profile { grid, shaded: shaded.into(), day_secs: 28_800, night_secs: 0 };
    (town, profile)
}

#[test]
fn geotiff_keeps_values_and_place() {
    let (town, profile) = sample();
    let bytes = raster::geotiff(&profile, &town.place).unwrap();
    if let Some(folder) = std::env::var_os("GNOMON_PICTURES") {
        file::write(&std::path::Path::new(&folder).join("hours.tif"), &bytes).unwrap();
    }
    let mut tiff = Decoder::new(Cursor::new(bytes)).unwrap();
    assert_eq!(tiff.dimensions().unwrap(), (70, 50));
    assert_eq!(tiff.get_tag_f64_vec(Tag::ModelPixelScaleTag).unwrap(), [0.25, 0.25, 0.0]);
    assert_eq!(tiff.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap(), [0.0, 0.0, 0.0, -8.75, 6.25, 0.0]);
    assert_eq!(tiff.get_tag_ascii_string(Tag::GdalNodata).unwrap(), "nan");
    assert_eq!(tiff.get_tag_f64_vec(Tag::GeoDoubleParamsTag).unwrap(), [16.38, 48.2, 0.0, 0.0]);
    let keys = tiff.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap();
    assert_eq!(keys[..4], [1, 1, 0, (keys.len() / 4 - 1) as u16]);
    let keys: Vec<&[u16]> = keys[4..].chunks(4).collect();
    assert!(keys.is_sorted_by_key(|key| key[0]), "GeoTIFF wants its keys sorted");
    assert!(keys.contains(&&[1025, 0, 1, 1][..]), "pixel is area");
    assert!(keys.contains(&&[3075, 0, 1, 12][..]), "azimuthal equidistant");
    let DecodingResult::F32(hours) = tiff.read_image().unwrap() else {
        panic!("not float32");
    };
    for (cell, hours) in hours.iter().enumerate() {
        assert_eq!(*hours, profile.hours(cell), "cell {cell}");
    }
}

#[test]
fn mask_is_the_bare_shares() {
    let share: Vec<u8> = (0..=255).chain(0..44).collect();
    let mask = Mask { width: 20, height: 15, share };
    let image = image::load_from_memory(&raster::mask_png(&mask).unwrap()).unwrap();
    assert_eq!(image.color(), image::ColorType::L8);
    assert_eq!((image.width(), image.height()), (20, 15));
    assert_eq!(image.as_bytes(), mask.share);
}

#[test]
fn a_raster_that_does_not_fill_its_grid_is_an_error() {
    let (town, mut profile) = sample();
    profile.shaded = vec![0_u32; 3499].into();
    let error = raster::geotiff(&profile, &town.place).unwrap_err();
    assert!(matches!(error, ExportError::Size { have: 3499, .. }), "{error}");
    let mask = Mask { width: 2, height: 2, share: vec![0; 3] };
    assert!(raster::mask_png(&mask).is_err());
}

#[test]
fn files_come_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let names = |folder: &std::path::Path| -> Vec<_> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
    };
    // Missing folders are made, an old file is replaced, nothing stays beside it.
    let path = folder.path().join("a/b/out.bin");
    file::write(&path, b"old").unwrap();
    file::write(&path, b"new").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
    assert_eq!(names(path.parent().unwrap()), ["out.bin"]);

    // A folder where the file should be: an error that names it and the way out, and no litter.
    let taken = folder.path().join("taken");
    fs::create_dir_all(taken.join("inside")).unwrap();
    let error = file::write(&taken, b"bytes").unwrap_err().to_string();
    assert!(error.contains(&taken.display().to_string()) && error.contains("give the name of a file"), "{error}");
    let mut left = names(folder.path());
    left.sort();
    assert_eq!(left, ["a", "taken"]);

    // A file where the folder should be.
    let error = file::write(&path.join("below.bin"), b"bytes").unwrap_err();
    assert!(error.to_string().contains("below.bin"), "{error}");
    let error = file::write(std::path::Path::new(".."), b"bytes").unwrap_err();
    assert!(matches!(error, ExportError::NoFileName { .. }), "{error}");
}

/// A link leads to the file that is written; a device is never replaced by one.
#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("file.png"), folder.path().join("link.png"));
    fs::write(&file, b"old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    file::write(&link, b"new").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"new");
    assert!(link.symlink_metadata().unwrap().is_symlink());

    let error = file::write(std::path::Path::new("/dev/null"), b"new").unwrap_err().to_string();
    assert!(error.contains("/dev/null"), "{error}");
    assert!(!std::path::Path::new("/dev/null").metadata().unwrap().is_file());
}
