//! Studies of several days: which instants, what is stored of them, and that a stopped one continues as if it had not
//! been stopped.

use crate::shared::program::{PLACE, command, done, fails, files, gnomon, left, numberless, site, stderr, stopped};
use chrono::{Datelike, NaiveDate, TimeDelta, Timelike};
use gnomon::sun::{EachDay, Place, SunError, SunTrack, Window};
use serde_json::Value;
use std::fs;
#[cfg(unix)]
use std::process::{Command, Stdio};

fn paris() -> Place {
    Place::new("Paris", 48.8583, 2.2945, 35.0, Some("Europe/Paris")).unwrap()
}

fn dates(first: &str, days: usize) -> Vec<NaiveDate> {
    first.parse::<NaiveDate>().unwrap().iter_days().take(days).collect()
}

fn each(from: &str, to: &str) -> EachDay {
    let reading = |text: &str| (!text.is_empty()).then(|| text.parse().unwrap());
    EachDay { from: reading(from), to: reading(to) }
}

fn days(place: &Place, first: &str, count: usize, from: &str, to: &str, step_secs: u32) -> Result<SunTrack, SunError> {
    SunTrack::days(place, &dates(first, count), each(from, to), step_secs, true)
}

#[test]
fn every_day_has_its_own_window() {
    // clocks change within the days; the step misses the end; to is on the next day
    for (from, to) in [("9:10", "17:00"), ("sunrise+20min", "sunset-1h"), ("22:00", "4:00")] {
        let all = days(&paris(), "2026-03-27", 4, from, to, 2700).unwrap();
        let mut instants = Vec::new();
        for date in dates("2026-03-27", 4) {
            let EachDay { from, to } = each(from, to);
            let window = Window { date: Some(date), from: from.unwrap(), to: to.unwrap(), step_secs: 2700 };
            instants.extend(SunTrack::window(&paris(), &window, true).unwrap().instants);
        }
        let brief = |track: &[gnomon::sun::Instant]| -> Vec<_> {
            track.iter().map(|it| (it.time, it.weight_secs, it.to_sun, it.night)).collect()
        };
        assert_eq!(brief(&all.instants), brief(&instants), "{from} to {to}");
        let listed: Vec<NaiveDate> = all.days.iter().map(|day| day.date).collect();
        assert_eq!(listed, dates("2026-03-27", 4));
    }
}

#[test]
fn whole_days_meet_in_one_instant() {
    let year = days(&paris(), "2026-01-01", 365, "", "", 3600).unwrap();
    assert_eq!((year.instants.len(), year.window_secs(), year.days.len()), (8761, 8760 * 3600, 365));
    let midnights: Vec<_> = year.instants.iter().filter(|it| it.time.hour() == 0).collect();
    assert_eq!(midnights.len(), 366);
    assert!(midnights[1..365].iter().all(|it| it.weight_secs == 3600));
    assert!(year.instants.windows(2).all(|pair| pair[0].time < pair[1].time));
    // the days on which clocks change are an hour shorter and longer
    let of = |month: u32, day: u32| {
        year.instants.iter().filter(|it| (it.time.month(), it.time.day()) == (month, day)).count()
    };
    assert_eq!([of(3, 29), of(6, 1), of(10, 25)], [23, 24, 25]);
    let noon = year.instants.iter().find(|it| it.time.month() == 6 && it.time.hour() == 14).unwrap();
    assert!(noon.altitude_deg() > 60.0);
}

#[test]
fn days_that_are_none_are_told() {
    let told = |result: Result<SunTrack, SunError>| result.unwrap_err().to_string();
    let tromso = Place::new("Tromsø", 69.65, 18.96, 0.0, Some("Europe/Oslo")).unwrap();
    assert!(told(days(&tromso, "2026-06-10", 20, "sunrise", "sunrise+2h", 3600)).contains("no day has a time"));
    assert!(told(days(&paris(), "2026-05-10", 3, "9:00", "9:00", 3600)).contains("empty"));
    assert!(told(days(&paris(), "2026-05-10", 3, "9:00", "17:00", 0)).contains("step of 0"));
    assert!(told(days(&paris(), "2026-05-10", 3, "sunrise+12h", "sunset-12h", 60)).contains("no day has a time"));
    let many = days(&paris(), "2026-01-01", 3650, "", "", 60);
    let least = match many {
        Err(SunError::TooManyInstants { least_secs, .. }) => u32::try_from(least_secs).unwrap(),
        other => panic!("{other:?}"),
    };
    assert!(days(&paris(), "2026-01-01", 3650, "", "", least).is_ok());
    // the sun sets later each day in spring, and earlier in autumn
    assert!(days(&paris(), "2026-03-10", 3, "sunset", "sunset+24h", 600).is_ok());
    assert!(told(days(&paris(), "2026-09-10", 3, "sunset", "sunset+24h", 600)).contains("2026-09-11 begins before"));
}

#[test]
fn a_day_without_a_time_between_from_and_to_has_no_instant() {
    // in winter the day is shorter than nine hours
    let year = days(&paris(), "2026-01-01", 365, "sunrise+4h30", "sunset-4h30", 1800).unwrap();
    let with = |month: u32| year.instants.iter().any(|it| it.time.month() == month);
    assert!(!with(12) && with(6) && year.days.len() == 365);
}

const RANGE: &str = "--from-date 2026-03-28 --to-date 2026-04-02 --from 8:00 --to 18:00";

#[test]
fn a_profile_of_several_days_lists_them() {
    let folder = site();
    let said =
        done(folder.path(), &format!("profile . --engine cpu --size 64 --receivers ground {RANGE} --step 1h --json"));
    let json: Value = serde_json::from_str(&said).unwrap();
    let days: Vec<_> = json["days"].as_array().unwrap().iter().map(|day| day["date"].as_str().unwrap()).collect();
    assert_eq!(days, ["2026-03-28", "2026-03-29", "2026-03-30", "2026-03-31", "2026-04-01", "2026-04-02"]);
    let instants = json["instants"].as_array().unwrap();
    let secs: u64 = instants.iter().map(|it| it["weight_secs"].as_u64().unwrap()).sum();
    assert_eq!((instants.len(), secs), (6 * 11, 6 * 10 * 3600));
    assert!(instants[11]["time"].as_str().unwrap().starts_with("2026-03-29T08:00:00+02:00"));

    // the site file says the same
    let text = "\n[study]\ndates = [\"2026-03-28\", 2026-04-02]\nfrom = \"8:00\"\nto = \"18:00\"\nstep = \"1h\"\n";
    let model = "[[model]]\npath = \"tower.glb\"\n";
    fs::write(folder.path().join("range.toml"), format!("{PLACE}{model}{text}")).unwrap();
    done(folder.path(), "profile range.toml --engine cpu --size 64 --receivers ground --out b");
    assert_eq!(files(&folder.path().join("out")), files(&folder.path().join("b")));
    // and a day of the command line goes before it
    let one = done(folder.path(), "sun range.toml --date 2026-04-01 --json");
    let one: Value = serde_json::from_str(&one).unwrap();
    assert_eq!(one["days"].as_array().unwrap().len(), 1);
}

#[test]
fn mistaken_days_are_told() {
    let folder = site();
    let path = folder.path();
    fails(path, "profile . --from-date 2026-03-28", 2, &["--from-date", "needs --to-date"]);
    fails(path, "profile . --to-date 2026-03-28", 2, &["--to-date", "needs --from-date"]);
    fails(path, "profile . --from-date 2026-03-28 --to-date 2026-03-27", 2, &["--to-date", "exchange"]);
    fails(path, "profile . --from-date 2026-03-28 --to-date 2046-03-27", 2, &["--to-date", "3660"]);
    fails(path, "profile . --from-date 2026-03-28 --to-date 2026-03-29 --date 2026-03-28", 2, &["--date", "leave one"]);
    fails(
        path,
        "profile . --from-date 2026-03-28 --to-date 2026-03-29 --from 2026-03-28T9:00",
        2,
        &["--from", "each day"],
    );
    fails(path, "profile . --from-date 2026-13-28 --to-date 2026-03-29", 2, &["--from-date", "2026-13-28"]);
    fails(path, "sun . --at 12:00 --from-date 2026-03-28 --to-date 2026-03-29", 2, &["--from-date", "--at"]);
    for (study, words) in [
        ("date = 2026-01-01\ndates = [2026-01-01, 2026-01-02]", ["dates", "leave one"]),
        ("dates = [2026-01-02, 2026-01-01]", ["dates", "exchange"]),
        ("dates = [2026-01-02]", ["dates", "dates = ["]),
        ("dates = \"2026-01-02\"", ["dates", "dates = ["]),
    ] {
        let text = format!("{PLACE}[[model]]\npath = \"tower.glb\"\n[study]\n{study}\nstep = \"1h\"\n");
        fs::write(path.join("bad.toml"), text).unwrap();
        fails(path, "profile bad.toml", 1, &words);
    }
}

#[test]
fn bits_are_the_masks() {
    let folder = site();
    for engine in ["cpu --receivers ground", "cpu", "gpu"] {
        let asked = format!("profile . --engine {engine} --size 61 {RANGE} --from 4:00 --step 2h --bits --masks masks");
        let told = stderr(&gnomon(folder.path(), &asked.replace("--from 8:00 ", "")));
        assert!(told.contains("shadow.bits will take "), "{told}");
        let bytes = fs::read(folder.path().join("out/shadow.bits")).unwrap();
        assert_eq!(&bytes[..8], b"GNOMBITS");
        let begin = u64::from_le_bytes(bytes[8..16].try_into().unwrap()) as usize;
        let header: Value = serde_json::from_slice(&bytes[16..begin]).unwrap();
        let [width, height, row] = ["width", "height", "bytes_a_row"].map(|key| header[key].as_u64().unwrap() as usize);
        let profile: Value =
            serde_json::from_slice(&fs::read(folder.path().join("out/profile.json")).unwrap()).unwrap();
        let of_profile = profile["instants"].as_array().unwrap();
        let by_day: Vec<_> = of_profile.iter().filter(|it| it["night"] == false).collect();
        assert_eq!(header["instants"].as_array().unwrap().iter().collect::<Vec<_>>(), by_day);
        assert!(by_day.len() < of_profile.len() && row == width.div_ceil(8));
        assert_eq!(bytes.len(), begin + by_day.len() * row * height);
        let mut rasters = bytes[begin..].chunks(row * height);
        let mut shadow = 0;
        for (index, instant) in of_profile.iter().enumerate() {
            if instant["night"] == true {
                continue;
            }
            let raster = rasters.next().unwrap();
            let mask = image::open(folder.path().join(format!("masks/mask-{index:04}.png"))).unwrap().to_luma8();
            for (x, y, share) in mask.enumerate_pixels() {
                let bit = raster[y as usize * row + x as usize / 8] >> (x % 8) & 1;
                assert_eq!(bit == 1, share.0[0] <= 127, "{engine}, {index}: {x}, {y}");
                shadow += usize::from(bit);
            }
        }
        assert!(shadow > 100, "{engine}");
    }
}

/// A study that is stopped while its drawing is made says whether it can continue.
#[cfg(unix)]
#[test]
fn a_study_stopped_at_its_drawing_says_where_it_goes_on() {
    let folder = site();
    let path = folder.path();
    let asked = "profile . --engine cpu --receivers ground --size 6000 --from 8:00 --to 18:00 --step 1h";
    // all is kept before the drawing is made; who waits for it waits already, as a process takes its time to begin
    let bits = path.join("bits");
    let mut child = command(path, &format!("{asked} --bits --out bits"));
    let child = child.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let kill =
        format!("until ls {}/profile.*.unfinished; do sleep 0.02; done && kill -INT {}", bits.display(), child.id());
    let mut killer =
        Command::new("sh").args(["-c", &kill]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let output = child.wait_with_output().unwrap();
    let told = stderr(&output);
    // a study that ended by itself leaves nothing to wait for
    killer.kill().unwrap();
    killer.wait().unwrap();
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains("100%") && told.contains("the same study continues from there"), "{told}");
    assert!(numberless(&bits).iter().any(|name| name == "profile.N.unfinished"));
    let told = stopped(path, &format!("{asked} --out short"), "100%");
    assert!(told.contains("is not kept; the same study starts over"), "{told}");
    assert_eq!(numberless(&path.join("short")), [""; 0]);
}

#[cfg(unix)]
#[test]
fn a_stopped_study_goes_on_and_comes_to_the_same() {
    let folder = site();
    let path = folder.path();
    for (name, engine, step) in [
        ("cpu", "--technique ray-cast", "3min"),
        ("gpu", "--technique stencil --stats", "10min"),
        ("ground", "--receivers ground --engine cpu", "10s"),
    ] {
        let size = if name == "ground" { 150 } else { 64 };
        let asked =
            |out: &str| format!("profile . {engine} --size {size} {RANGE} --step {step} --bits --out {name}-{out}");
        done(path, &asked("whole"));
        stopped(path, &asked("stopped"), "10%");
        let out = path.join(format!("{name}-stopped"));
        assert_eq!(numberless(&out), ["profile.N.unfinished", "shadow.bits.N.unfinished"]);
        // a second stop, and what lies beyond what was kept is drawn again
        stopped(path, &asked("stopped"), "50%");
        let name_of_bits = left(&out).file_name().unwrap().to_str().unwrap().replace("profile", "shadow.bits");
        let bits = out.join(name_of_bits);
        let mut longer = fs::read(&bits).unwrap();
        longer.extend([0xA5; 777]);
        fs::write(&bits, longer).unwrap();
        let told = stderr(&gnomon(path, &asked("stopped")));
        assert!(told.contains("continues where it was stopped, after"), "{told}");
        let [whole, stopped] = ["whole", "stopped"].map(|out| files(&path.join(format!("{name}-{out}"))));
        assert_eq!(whole.keys().collect::<Vec<_>>(), stopped.keys().collect::<Vec<_>>());
        for (file, bytes) in &whole {
            assert!(bytes == &stopped[file], "{name}: {file} is another");
        }
    }
}

#[cfg(unix)]
#[test]
fn what_another_study_left_is_not_used() {
    let folder = site();
    let path = folder.path();
    let asked = format!("profile . --technique ray-cast --size 64 {RANGE} --step 3min --write tif");
    stopped(path, &asked, "10%");
    let file = left(&path.join("out"));
    let kept = fs::read(&file).unwrap();
    for other in ["--no-refraction", "--cell 1", "--to 18:01"] {
        let short = asked
            .replace("--step 3min", "--step 1h")
            .replace("--size 64", if other == "--cell 1" { "" } else { "--size 40" });
        let short = if other == "--to 18:01" { short.replace("--to 18:00", other) } else { format!("{short} {other}") };
        let told = stderr(&gnomon(path, &short));
        assert!(
            told.contains("keeps another study that was stopped") && !told.contains("continues where"),
            "{other}: {told}"
        );
        done(path, &format!("{short} --out alone"));
        let [tif, alone] = ["out", "alone"].map(|out| fs::read(path.join(out).join("shadow-hours.tif")).unwrap());
        assert!(tif == alone, "{other}");
        // nor is it lost
        assert!(fs::read(&file).unwrap() == kept, "{other}");
    }
    // half a file is none
    fs::write(&file, &kept[..kept.len() - 1]).unwrap();
    let told = stderr(&gnomon(path, &asked));
    assert!(told.contains("starts over") && !told.contains("continues"), "{told}");
    // and the number of the study is looked at, not the file's name alone
    let short = asked.replace("3min", "2min");
    stopped(path, &short, "10%");
    fs::rename(left(&path.join("out")), &file).unwrap();
    let told = stderr(&gnomon(path, &asked));
    assert!(told.contains("starts over") && !told.contains("continues"), "{told}");
    fs::write(&file, &kept).unwrap();
    assert!(stderr(&gnomon(path, &asked)).contains("continues"));
    assert_eq!(numberless(&path.join("out")), ["shadow-hours.tif"]);
}

/// Nothing keeps outlines: a study that was stopped without them draws all instants again.
#[cfg(unix)]
#[test]
fn outlines_of_a_stopped_study_are_all_there() {
    let folder = site();
    let path = folder.path();
    let asked = "profile . --technique ray-cast --size 900 --from 8:00 --to 18:00 --step 30min --write tif";
    stopped(path, asked, "14%");
    let kept = left(&path.join("out"));
    let told = stderr(&gnomon(path, &format!("{asked} --draw outlines")));
    assert!(!told.contains("continues where"), "{told}");
    done(path, &format!("{asked} --draw outlines --out alone"));
    let [svg, alone] = ["out", "alone"].map(|out| fs::read(path.join(out).join("outlines.svg")).unwrap());
    assert!(svg == alone && kept.is_file());
    assert!(stderr(&gnomon(path, asked)).contains("continues where"));
}

#[test]
fn several_days_are_the_sum_of_each() {
    let folder = site();
    let hours = |asked: &str| {
        done(
            folder.path(),
            &format!("profile . --engine cpu --receivers ground --region -40,-40,40,40 --cell 1 --write tif {asked}"),
        );
        let mut tif =
            tiff::decoder::Decoder::new(fs::File::open(folder.path().join("out/shadow-hours.tif")).unwrap()).unwrap();
        match tif.read_image().unwrap() {
            tiff::decoder::DecodingResult::F32(hours) => hours,
            other => panic!("{other:?}"),
        }
    };
    let window = "--from 10:00 --to 11:00 --step 20min --resolution 1min";
    let all = hours(&format!("--from-date 2026-03-28 --to-date 2026-03-30 {window}"));
    let first: NaiveDate = "2026-03-28".parse().unwrap();
    let each: Vec<_> = (0..3).map(|day| hours(&format!("--date {} {window}", first + TimeDelta::days(day)))).collect();
    assert!(all.iter().any(|hours| *hours > 1.5));
    for (cell, all) in all.iter().enumerate() {
        let sum: f32 = each.iter().map(|hours| hours[cell]).sum();
        assert!((all - sum).abs() < 1e-5, "cell {cell}: {all} and {sum}");
    }
}

/// Files written during a study belong to that study, whichever others were stopped in its folder.
#[cfg(unix)]
#[test]
fn what_another_stopped_study_wrote_is_not_taken_over() {
    let folder = site();
    let path = folder.path();
    let study = |date: &str, more: &str| {
        format!(
            "profile . --technique ray-cast --size 64 --date {date} --from 9:00 --to 15:00 --step 1min \
             --write tif,json {more}"
        )
    };
    done(path, &study("2026-09-18", "--bits --masks right --out right"));
    // bits and masks of another day; then the day itself, which writes none and is stopped later
    stopped(path, &study("2026-06-18", "--bits --masks masks --out out"), "60%");
    stopped(path, &study("2026-09-18", "--out out"), "40%");
    let told = stderr(&gnomon(path, &study("2026-09-18", "--bits --masks masks --out out")));
    assert!(!told.contains("continues where"), "{told}");
    // elsewhere is another study, too: what lies there already is not its own
    stopped(path, &study("2026-09-18", "--masks other --out there"), "40%");
    done(path, &study("2026-06-18", "--masks others --out another"));
    let told = stderr(&gnomon(path, &study("2026-09-18", "--masks others --out there")));
    assert!(told.contains("keeps another study") && !told.contains("continues where"), "{told}");
    let [right, out] = ["right", "out"].map(|out| files(&path.join(out)));
    for (name, bytes) in right.iter().filter(|(name, _)| !name.starts_with("mask-")) {
        assert!(*bytes == out[name], "{name}");
    }
    let kept = ["profile.N.unfinished", "profile.N.unfinished", "shadow.bits.N.unfinished"];
    assert!(kept.iter().all(|name| numberless(&path.join("out")).contains(&(*name).to_owned())));
    for folder in ["masks", "others"] {
        for index in [0, 100, 250, 360] {
            let mask = |folder: &str| fs::read(path.join(folder).join(format!("mask-{index:04}.png"))).unwrap();
            let right = fs::read(path.join("right").join(format!("mask-{index:04}.png"))).unwrap();
            assert!(mask(folder) == right, "{folder}, {index}");
        }
    }
    // what was stopped stays beside one that is done, and goes on
    stopped(path, &study("2026-09-18", "--bits --out left"), "40%");
    done(path, &study("2026-09-18", "--out left"));
    let kept = ["profile.N.unfinished", "profile.json", "shadow-hours.tif", "shadow.bits.N.unfinished"];
    assert_eq!(numberless(&path.join("left")), kept);
    let told = stderr(&gnomon(path, &study("2026-09-18", "--bits --out left")));
    assert!(told.contains("continues where"), "{told}");
    assert!(files(&path.join("left"))["shadow.bits"] == right["shadow.bits"]);
    assert_eq!(numberless(&path.join("left")), ["profile.json", "shadow-hours.tif", "shadow.bits"]);
}
