//! The time that judging takes: `cargo bench --bench judge`. Prints tables in Markdown.
//!
//! BRE on the twenty areas of `headquarters`, before and after; TNO light, every day of eight months, on a thousand
//! windows; and how both grow. `docs/benchmarks/judge.md` has the results of a run and the machine.

use glam::DVec3;
use gnomon::judgement::Judgement;
use gnomon::rules::{Rule, built_in_text};
use gnomon::site::{JudgedSite, JudgedWindow, Overrides, load_judged};
use gnomon::study::judge::judge;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

const AREAS: &str = "uk-bre-209-sun-on-ground";
const WINDOWS: &str = "nl-tno-light";

/// Of upright faces each of these square metres has a place for a window.
const M2_A_PLACE: f64 = 12.0;

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/headquarters/judged.toml");
    let (site, secs) = timed(|| load_judged(&path, &Overrides::default()).expect("a sample site"));
    println!("{} threads; the site is read in {secs:.2} s\n", rayon::current_num_threads());
    areas(&site);
    windows(&site);
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

fn rule_text(id: &str) -> &'static str {
    built_in_text(id).expect("a built-in rule")
}

fn judged(site: &JudgedSite, id: &str, text: &str) -> (Judgement, f64) {
    let rule = Rule::parse(id, text).expect("a rule");
    let resolved = rule.resolve(&[]).expect("options");
    timed(|| judge(site, &rule.source, &resolved, &mut |_| ControlFlow::Continue(())).expect("a judgement"))
}

fn areas(site: &JudgedSite) {
    println!("| areas | points | s | µs a point | greatest error |");
    println!("|---|---|---|---|---|");
    for count in [2, 20] {
        let mut site = site.clone();
        // every tenth, so that few areas are of all kinds, too
        let every = site.areas.len().div_ceil(count);
        site.areas = site.areas.into_iter().step_by(every).collect();
        let (found, secs) = judged(&site, AREAS, rule_text(AREAS));
        let sizes: Vec<_> = found.receivers.iter().filter_map(|receiver| receiver.area).collect();
        let points: usize = sizes.iter().map(|size| size.points).sum();
        let error = sizes.iter().map(|size| size.error_m2 / size.m2).fold(0.0, f64::max);
        let each = secs * 1e6 / points as f64;
        println!("| {} | {points} | {secs:.2} | {each:.0} | {:.3} % |", sizes.len(), 100.0 * error);
    }
    println!();
}

fn windows(site: &JudgedSite) {
    println!("| windows | days | s | µs a window and day |");
    println!("|---|---|---|---|");
    // the same rule with a tenth of its days
    let text = rule_text(WINDOWS);
    let few_days = text.replace(r#"["02-19", "10-21"]"#, r#"["02-19", "03-14"]"#);
    assert_ne!(text, few_days, "the rule has other days");
    for (count, text) in [(100, text), (1000, few_days.as_str()), (1000, text)] {
        let site = JudgedSite { areas: Vec::new(), windows: on_facades(site, count), before: None, ..site.clone() };
        let (found, secs) = judged(&site, WINDOWS, text);
        let (windows, days) = (found.receivers.len(), found.days.len());
        println!("| {windows} | {days} | {secs:.2} | {:.0} |", secs * 1e6 / (windows * days) as f64);
    }
    println!();
}

/// Windows of a square metre, spread over the upright faces of all components.
fn on_facades(site: &JudgedSite, count: usize) -> Vec<JudgedWindow> {
    let mesh = &site.now.mesh;
    let mut places: Vec<(DVec3, DVec3)> = Vec::new();
    let mut m2 = 0.0;
    for face in 0..mesh.faces.len() {
        let [a, b, c] = mesh.corners(face).map(|corner| corner.as_dvec3() + mesh.origin);
        let normal = (b - a).cross(c - a);
        let middle = (a + b + c) / 3.0;
        let outward = normal.normalize_or_zero();
        if normal.length() < 2.0 || outward.z.abs() > 1e-3 || middle.z < 1.0 {
            continue;
        }
        m2 += normal.length() / 2.0;
        if m2 > M2_A_PLACE {
            m2 = 0.0;
            places.push((middle, outward));
        }
    }
    assert!(places.len() >= count, "{} places", places.len());
    (0..count).map(|number| window(number, places[number * places.len() / count])).collect()
}

fn window(number: usize, (middle, outward): (DVec3, DVec3)) -> JudgedWindow {
    let (right, up) = (DVec3::Z.cross(outward).normalize() * 0.5, DVec3::Z * 0.5);
    JudgedWindow {
        name: format!("window {number}"),
        component: None,
        corners: [middle - right - up, middle + right - up, middle + right + up, middle - right + up],
        outward,
        other_side: None,
        reveal_m: 0.0,
        reveal_is_said: true,
        inner_m: None,
        floor: None,
        room: None,
        dwelling: None,
        usage: None,
        room_m2: None,
    }
}
