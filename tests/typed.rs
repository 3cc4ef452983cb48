//! Typed input: each spelling is understood as intended, and ambiguous ones are refused.

use crate::shared::program::done;
use gnomon::site::typed::{Axis, Degrees, TypedError, clock, date, degrees, number, place, resolution, step, within};
use gnomon::sun::SunError;
use std::path::Path;

#[test]
fn decimal_comma_is_a_decimal_point() {
    for (text, wanted) in [
        ("0,001", 0.001),
        ("0.001", 0.001),
        (",5", 0.5),
        ("5,", 5.0),
        (" 12 ", 12.0),
        ("-3,5", -3.5),
        ("−3.5", -3.5),
        ("+7", 7.0),
        // one mark parts the decimals, whatever follows
        ("1,234", 1.234),
        ("1.234", 1.234),
        ("1,234.5", 1234.5),
        ("1.234,5", 1234.5),
        ("1 234,5", 1234.5),
        ("1\u{202f}234.5", 1234.5),
        ("1'234.5", 1234.5),
        ("1’234,5", 1234.5),
        ("1,234,567", 1_234_567.0),
        ("1.234.567,25", 1_234_567.25),
        ("12 345 678", 12_345_678.0),
        ("1e-3", 0.001),
        ("2,5E2", 250.0),
    ] {
        assert_eq!(number(text), Ok(wanted), "{text}");
    }
}

#[test]
fn what_is_no_number_is_refused() {
    for text in [
        "",
        " ",
        ",",
        "-",
        "abc",
        "1 2",
        "1,23,4",
        "1.2.3",
        "1,234.567,8",
        "1 23,5",
        "12,34.5",
        "0x1",
        "nan",
        "inf",
        "1e400",
    ] {
        assert_eq!(number(text), Err(TypedError::Number(text.trim().to_owned())), "{text}");
    }
    let told = within("0", 1e-6..=1e6, "metres per unit").unwrap_err().to_string();
    assert_eq!(told, "0 is not between 0.000001 and 1000000 metres per unit");
    assert_eq!(within("0,001", 1e-6..=1e6, "metres per unit"), Ok(0.001));
}

/// 48°12'30" is 48 + 12/60 + 30/3600 degrees.
const VIENNA: [f64; 2] = [48.0 + 12.0 / 60.0 + 30.0 / 3600.0, 16.0 + 22.0 / 60.0 + 26.0 / 3600.0];

fn is_near(a: [f64; 2], b: [f64; 2]) -> bool {
    (0..2).all(|at| (a[at] - b[at]).abs() < 1e-9)
}

#[test]
fn places_are_read_as_people_write_them() {
    for text in [
        "48.2082, 16.3738",
        "48.2082,16.3738",
        "48.2082 16.3738",
        "48.2082\t16.3738",
        " 48.2082 ; 16.3738 ",
        "48,2082; 16,3738",
        "48,2082 16,3738",
        "48,2082, 16,3738",
        "48,2082,16,3738",
        "48.2082° N, 16.3738° E",
        "48.2082°N 16.3738°E",
        "48,2082° N 16,3738° E",
        "48.2082 n 16.3738 e",
        "N 48.2082° E 16.3738°",
        "N48.2082, E16.3738",
        "16.3738° E, 48.2082° N",
        "48.2082°, 16.3738°",
        "48,2082° 16,3738°",
        "48.2082º N; 16.3738",
    ] {
        assert!(place(text).is_ok_and(|read| is_near(read, [48.2082, 16.3738])), "{text}: {:?}", place(text));
    }
    for text in [
        "48°12'30\" N 16°22'26\" E",
        "48°12′30″N 16°22′26″E",
        "48° 12' 30'' N, 16° 22' 26'' E",
        "48°12’30” N, 16°22’26” E",
        "48°12'30\", 16°22'26\"",
        "48 12 30 N 16 22 26 E",
        "N 48°12'30\" E 16°22'26\"",
        "48°12,5' N; 16°22,433333333' E",
    ] {
        let near = |read: [f64; 2]| (0..2).all(|at| (read[at] - VIENNA[at]).abs() < 1e-8);
        assert!(place(text).is_ok_and(near), "{text}: {:?}", place(text));
    }
    for text in ["-33.86, 151.2", "−33,86; 151,2", "33.86° S, 151.2° E", "33.86 S 151.2 E", "-33.86° 151.2°"] {
        assert!(place(text).is_ok_and(|read| is_near(read, [-33.86, 151.2])), "{text}: {:?}", place(text));
    }
    assert_eq!(place("33°30' S, 70°30' W"), Ok([-33.5, -70.5]));
    assert_eq!(place("-48, -16.5"), Ok([-48.0, -16.5]));
}

#[test]
fn what_is_no_place_is_refused() {
    for text in [
        "",
        "Vienna",
        "48.2082",
        "48.2082 N",
        "48,2082,16",
        "48 12 N",
        "48 12N",
        "48.2 N, 16.4 N",
        "48.5°30' N, 16° E",
        "48°60' N, 16° E",
        "-48 N, 16 E",
        "48.2 16.3 5",
        "48.2082° N, 16.3738° O",
        "1, 2, 3",
    ] {
        assert_eq!(place(text), Err(TypedError::Place(text.to_owned())), "{text}");
    }
    for (text, what, value) in
        [("98, 16", "latitude", 98.0), ("48,2082", "longitude", 2082.0), ("48°, 181°", "longitude", 181.0)]
    {
        let (most, unit) = (if what == "latitude" { 90.0 } else { 180.0 }, "degrees");
        let error = SunError::OutOfRange { what, value, low: -most, high: most, unit };
        assert_eq!(place(text), Err(TypedError::Sun(error)), "{text}");
    }
}

/// A field for one angle takes that, and a place that is pasted into it.
#[test]
fn field_of_one_angle_takes_both() {
    use Axis::{Latitude, Longitude};
    for (text, axis, wanted) in [
        ("48,2082", Latitude, 48.2082),
        ("48.2082° N", Latitude, 48.2082),
        ("48°12'30\" N", Latitude, VIENNA[0]),
        ("48°12′30″N", Latitude, VIENNA[0]),
        ("48 12 30 N", Latitude, VIENNA[0]),
        ("48°12'30\"", Latitude, VIENNA[0]),
        ("33,86 S", Latitude, -33.86),
        ("-0,5", Latitude, -0.5),
        ("70°30' W", Longitude, -70.5),
        ("151,2", Longitude, 151.2),
    ] {
        let read = degrees(text, axis);
        assert!(matches!(read, Ok(Degrees::One(value)) if (value - wanted).abs() < 1e-9), "{text}: {read:?}");
    }
    for axis in [Latitude, Longitude] {
        for text in ["48.2082, 16.3738", "48,2082; 16,3738", "48.2082 16.3738", "48.2082° N, 16.3738° E"] {
            let read = degrees(text, axis);
            let is_so = |both| is_near(both, [48.2082, 16.3738]);
            assert!(matches!(read, Ok(Degrees::Both(both)) if is_so(both)), "{text}: {read:?}");
        }
    }
    assert_eq!(degrees("48,16.5", Latitude), Ok(Degrees::Both([48.0, 16.5])));
    for (text, axis, told) in [
        ("98", Latitude, "latitude 98 is not between -90 and 90 degrees"),
        ("98, 16", Latitude, "latitude 98 is not between -90 and 90 degrees"),
        ("-181", Longitude, "longitude -181 is not between -180 and 180 degrees"),
        ("north", Latitude, "\"north\" is not a latitude; write degrees, for example 48.2082, 48,2082 or 48°12'30\" N"),
        ("16 E", Latitude, "\"16 E\" is not a latitude; write degrees, for example 48.2082, 48,2082 or 48°12'30\" N"),
        ("", Longitude, "\"\" is not a longitude; write degrees, for example 16.3738, 16,3738 or 16°22'26\" E"),
    ] {
        assert_eq!(degrees(text, axis).unwrap_err().to_string(), told);
    }
}

/// The command's option is the same parser.
#[test]
fn place_of_the_command_is_read_alike() {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/tower");
    for text in ["48.2082,16.3738", "48,2082;16,3738", "48.2082°N,16.3738°E"] {
        let sun = format!("sun tower.glb --at 2026-09-18T12:00 --json --place {text}");
        let told: serde_json::Value = serde_json::from_str(&done(&model, &sun)).unwrap();
        let place = ["latitude", "longitude"].map(|key| told["place"][key].as_f64());
        assert_eq!(place, [Some(48.2082), Some(16.3738)], "{text}");
    }
}

#[test]
fn dates_are_read_as_people_write_them() {
    for text in [
        "2026-12-21",
        "2026/12/21",
        "2026.12.21",
        "21.12.2026",
        "21. 12. 2026",
        "21/12/2026",
        "12/21/2026",
        "21-12-2026",
        "21 Dec 2026",
        "21 December 2026",
        "Dec 21, 2026",
        "21-dec-2026",
    ] {
        assert_eq!(date(text).map(|date| date.to_string()).as_deref(), Ok("2026-12-21"), "{text}");
    }
    // with points the day is the first, and equal numbers are one date either way
    for (text, wanted) in [("05.06.2026", "2026-06-05"), ("5/5/2026", "2026-05-05"), ("2026-1-5", "2026-01-05")] {
        assert_eq!(date(text).map(|date| date.to_string()).as_deref(), Ok(wanted), "{text}");
    }
    let told = date("05/06/2026").unwrap_err().to_string();
    assert_eq!(told, "\"05/06/2026\" can be 5 June 2026 or 6 May 2026; write 2026-06-05 or 2026-05-06");
    for text in ["", "soon", "21.12.26", "21.12.", "31.02.2026", "13/13/2026", "12.21.2026", "2026", "1.2.3.2026"] {
        assert_eq!(date(text), Err(TypedError::Date(text.to_owned())), "{text}");
    }
}

#[test]
fn times_are_read_as_people_write_them() {
    for (text, wanted) in [
        ("16", "16:00"),
        ("9", "9:00"),
        ("16.30", "16:30"),
        ("16:30", "16:30"),
        ("16:30:15", "16:30:15"),
        ("16.30.15", "16:30:15"),
        ("16h30", "16:30"),
        ("16 h", "16:00"),
        ("4 pm", "16:00"),
        ("4:30 PM", "16:30"),
        ("4.30 p.m.", "16:30"),
        ("12 am", "0:00"),
        ("12pm", "12:00"),
        ("Sunrise + 1h30", "sunrise + 1h30"),
        ("sunset-1h30", "sunset-1h30"),
        ("2:30+01:00", "2:30+01:00"),
        ("2026-09-18T15:00", "2026-09-18T15:00"),
    ] {
        assert_eq!(clock(text).as_deref(), Ok(wanted), "{text}");
    }
    // half past four, or five past?
    for text in ["", "noon", "25", "16:60", "16.5", "16,5", "13 pm", "0 am", "16:", "1630", "-1"] {
        assert_eq!(clock(text), Err(TypedError::Clock(text.to_owned())), "{text}");
    }
    for text in ["24", "24:00", "24.00"] {
        assert_eq!(clock(text), Err(TypedError::DayEnd), "{text}");
    }
}

#[test]
fn steps_are_read_as_people_write_them() {
    for (text, wanted) in [
        ("30min", "30min"),
        (" 1h30 ", "1h30"),
        ("30 min", "30 min"),
        ("1H", "60min"),
        ("0,5 h", "30min"),
        ("1.5 min", "90s"),
    ] {
        assert_eq!(step(text).as_deref(), Ok(wanted), "{text}");
    }
    for text in ["", "30", "soon", "0,3 s", "-1h", "9999h", "1:30"] {
        assert_eq!(step(text), Err(TypedError::Step(text.to_owned())), "{text}");
    }
    assert_eq!(step("0 min"), Err(TypedError::Sun(SunError::ZeroStep)));
    assert_eq!(["1 min", " Step "].map(|text| resolution(text).unwrap()), ["1 min", "step"]);
    assert_eq!(resolution("0s"), Err(TypedError::Resolution("0s".to_owned())));
}
