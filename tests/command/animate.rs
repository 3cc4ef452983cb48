//! `gnomon animate`: the frames equal the drawings of `gnomon shadow`, and become a GIF.

use crate::shared::program::{command, done, fails, names, site, stderr};
use std::path::Path;
use std::process::Stdio;

/// Night, a low sun and noon; the plan is the same in all of them.
const ASKED: &str = "--engine cpu --region -40,-20,40,60 --cell 2";
const HOURS: &str = "--from 06:30 --to 13:30 --step 1h45";

struct Gif {
    size: (u16, u16),
    repeat: gif::Repeat,
    delays: Vec<u16>,
    /// Red, green, blue of every pixel.
    frames: Vec<Vec<[u8; 3]>>,
    local_palettes: usize,
}

fn read_gif(path: &Path) -> Gif {
    let mut decoder = gif::DecodeOptions::new();
    decoder.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = decoder.read_info(std::fs::File::open(path).unwrap()).unwrap();
    let palette: Vec<[u8; 3]> = decoder.global_palette().unwrap().as_chunks().0.to_vec();
    let mut read = Gif {
        size: (decoder.width(), decoder.height()),
        repeat: gif::Repeat::Finite(0),
        delays: Vec::new(),
        frames: Vec::new(),
        local_palettes: 0,
    };
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        read.delays.push(frame.delay);
        read.local_palettes += usize::from(frame.palette.is_some());
        read.frames.push(frame.buffer.iter().map(|number| palette[usize::from(*number)]).collect());
    }
    read.repeat = decoder.repeat();
    read
}

fn png(path: &Path) -> image::RgbImage {
    image::open(path).unwrap().into_rgb8()
}

#[test]
fn each_frame_is_the_picture_of_its_instant() {
    let folder = site();
    let said = done(folder.path(), &format!("animate . {ASKED} {HOURS} --width 3508"));
    let out = folder.path().join("out");
    let frames: Vec<_> = (0..5).map(|index| format!("frame-{index:04}.png")).collect();
    assert_eq!(names(out.clone()), [vec!["day.gif".to_owned()], frames].concat());
    for word in ["day.gif", "frame-0000.png to ", "frame-0004.png", "5 frames, 1 of them at night", "on the cpu"] {
        assert!(said.contains(word), "{said}");
    }
    for (index, at) in [(0, "06:30"), (1, "08:15"), (4, "13:30")] {
        done(folder.path(), &format!("shadow . {ASKED} --at 2026-09-18T{at}"));
        let alone = png(&folder.path().join("shadow.png"));
        assert!(png(&out.join(format!("frame-{index:04}.png"))) == alone, "{at}");
    }
}

#[test]
fn fewer_pixels_are_the_means_of_the_sheet() {
    let folder = site();
    // else each study has its own
    let camera = "[camera]\neye = [60.0, -80.0, 50.0]\ntarget = [0.0, 0.0, 8.0]\n";
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    std::fs::write(folder.path().join("site.toml"), format!("{text}{camera}")).unwrap();
    let asked = "--engine cpu --view camera";
    done(folder.path(), &format!("animate . {asked} --to 11:00 --width 877"));
    done(folder.path(), &format!("shadow . {asked} --at 2026-09-18T11:00"));
    let (small, sheet) = (png(&folder.path().join("out/frame-0002.png")), png(&folder.path().join("shadow.png")));
    assert_eq!((small.dimensions(), sheet.dimensions()), ((877, 620), (3508, 2480)));
    // a quarter as wide; the filter reaches a little into the pixels around
    let mut apart = 0.0;
    for (x, y, pixel) in small.enumerate_pixels() {
        for part in 0..3 {
            let under = (0..16).map(|at| f64::from(sheet.get_pixel(4 * x + at % 4, 4 * y + at / 4)[part]));
            apart += (under.sum::<f64>() / 16.0 - f64::from(pixel[part])).abs();
        }
    }
    let mean = apart / f64::from(3 * 877 * 620);
    assert!(mean < 1.0, "{mean}");
}

#[test]
fn gif_is_the_frames_for_ever_in_one_palette() {
    let folder = site();
    done(folder.path(), &format!("animate . {ASKED} {HOURS} --width 640 --fps 3 --out a/b"));
    let out = folder.path().join("a/b");
    let read = read_gif(&out.join("day.gif"));
    assert_eq!((read.size, read.delays.as_slice()), ((640, 453), &[33; 5][..]));
    assert!(matches!(read.repeat, gif::Repeat::Infinite));
    assert_eq!(read.local_palettes, 0);
    for (index, frame) in read.frames.iter().enumerate() {
        let drawn = png(&out.join(format!("frame-{index:04}.png")));
        let apart = |(one, other): (&[u8; 3], &image::Rgb<u8>)| {
            let parts = one.iter().zip(other.0).map(|(one, other)| one.abs_diff(other));
            parts.max().unwrap()
        };
        assert_eq!(frame.len(), drawn.pixels().len());
        let apart: Vec<u8> = frame.iter().zip(drawn.pixels()).map(apart).collect();
        let same = apart.iter().filter(|apart| **apart == 0).count() as f64 / apart.len() as f64;
        let worst = apart.iter().max().unwrap();
        // what is flat is most of it, and stays what it is
        assert!(same > 0.9 && *worst < 24, "frame {index}: {same} the same, at most {worst} apart");
    }
    assert!(read.frames[0] != read.frames[4], "day and night are alike");
}

#[test]
fn what_cannot_be_is_told_before_the_work() {
    let folder = site();
    let at = folder.path();
    fails(at, "animate . --step 3s", 2, &["2401 instants", "2000", "--step"]);
    fails(at, "animate . --width 100", 2, &["--width", "320"]);
    fails(at, "animate . --fps 0", 2, &["--fps", "1..=50"]);
    fails(at, "animate . --view camera --cell 2", 2, &["--cell", "--view camera"]);
    fails(at, "animate . --receivers surfaces", 2, &["--receivers", "a study's profile"]);
    fails(at, "animate . --out site.toml", 1, &["site.toml", "--out"]);
    assert!(names(at.join("out")).is_empty());
}

#[cfg(unix)]
#[test]
fn stopped_leaves_the_old_gif_and_no_half_one() {
    use std::io::{BufRead, BufReader};
    let folder = site();
    std::fs::create_dir(folder.path().join("out")).unwrap();
    std::fs::write(folder.path().join("out/day.gif"), "old").unwrap();
    let asked = "animate . --engine cpu --size 64 --width 320 --step 1min";
    let mut child = command(folder.path(), asked).stderr(Stdio::piped()).spawn().unwrap();
    let mut told = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(told.next().unwrap().unwrap().contains("of 121 instants"));
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let last = told.map(Result::unwrap).last().unwrap();
    assert_eq!((child.wait().unwrap().code(), last.as_str()), (Some(130), "error: interrupted"));
    assert_eq!(std::fs::read(folder.path().join("out/day.gif")).unwrap(), b"old");
    let names = names(folder.path().join("out"));
    assert!(names.iter().all(|name| name == "day.gif" || name.starts_with("frame-")), "{names:?}");
}

/// They are removed, and nothing else.
#[test]
fn frames_of_a_longer_animation_do_not_stay_among_those_of_a_shorter_one() {
    let folder = site();
    let (at, out) = (folder.path(), folder.path().join("out"));
    let asked = "animate . --engine cpu --size 64 --width 320 --step";
    let longer = format!("{asked} 30min");
    for name in ["frame-3.png", "frame-00003.png", "frame-0003.jpg"] {
        std::fs::create_dir_all(&out).unwrap();
        std::fs::write(out.join(name), "another's").unwrap();
    }
    done(at, &longer);
    let [third, fourth] = [3, 4].map(|index| std::fs::read(out.join(format!("frame-{index:04}.png"))).unwrap());
    let all = names(out.clone());
    let told = super::gnomon(at, &format!("{asked} 1h"));
    assert!(told.status.success(), "{}", stderr(&told));
    assert!(
        stderr(&told).contains("frame-0003.png to frame-0004.png belong to the older, longer animation"),
        "{}",
        stderr(&told)
    );
    let left: Vec<String> =
        all.iter().filter(|name| !["frame-0003.png", "frame-0004.png"].contains(&name.as_str())).cloned().collect();
    assert_eq!(names(out.clone()), left);

    // one that is drawn on is somebody's work
    done(at, &longer);
    let mut edited = png(&out.join("frame-0004.png"));
    edited.put_pixel(100, 100, image::Rgb([255, 0, 0]));
    edited.save(out.join("frame-0004.png")).unwrap();
    let gif = std::fs::read(out.join("day.gif")).unwrap();
    let refused = |name: &str| {
        fails(at, &format!("{asked} 1h --quiet"), 1, &[name, "the 3 of this animation", "remove it", "another folder"])
    };
    refused("frame-0004.png");
    // so is one of another size, one without a GIF, and one that the GIF has not
    std::fs::write(out.join("frame-0004.png"), &third).unwrap();
    refused("frame-0004.png");
    std::fs::write(out.join("frame-0004.png"), &fourth).unwrap();
    std::fs::write(out.join("frame-0007.png"), &fourth).unwrap();
    refused("frame-0007.png");
    std::fs::remove_file(out.join("frame-0007.png")).unwrap();
    std::fs::remove_file(out.join("day.gif")).unwrap();
    refused("frame-0003.png");
    std::fs::write(out.join("day.gif"), gif).unwrap();
    assert_eq!(names(out.clone()), all);
    done(at, &format!("{asked} 1h"));
    assert_eq!(names(out), left);
}
