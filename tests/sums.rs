//! Sums of masks are exact integers, on both machines; shadow, sun and night add up to the window.

use crate::shared::drawing::gpu;
use crate::site::{SITE, load};
use gnomon::choice::{Engine, Receivers};
use gnomon::gpu::Gpu;
use gnomon::profile::Profile;
use gnomon::profile::accumulate::Sum;
use gnomon::shadow::DrawnMask;
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, Event, Wants};
use gnomon::view::{Bits, Grid, Mask};
use proptest::prelude::*;
use std::ops::ControlFlow;
use wgpu::{Texture, TextureFormat, TextureUsages};

/// Every mask with its weight in seconds.
type Weighted = Vec<(Mask, u32)>;

fn weighted() -> impl Strategy<Value = Weighted> {
    // rows that end within a group of threads and within a copy's alignment
    (1_u32..70, 1_u32..40).prop_flat_map(|(width, height)| {
        let cells = (width * height) as usize;
        let share = prop_oneof![Just(0_u8), Just(255), any::<u8>()];
        let mask = prop::collection::vec(share, cells).prop_map(move |share| Mask { width, height, share });
        prop::collection::vec((mask, prop_oneof![0_u32..5, 0_u32..100_000]), 1..8)
    })
}

fn texture(gpu: &Gpu, mask: &Mask) -> Texture {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
    let texture = gpu.texture("test.mask", (mask.width, mask.height), TextureFormat::R8Unorm, usage);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(mask.width), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), &mask.share, layout, texture.size());
    texture
}

/// The sum on the GPU or in memory, of masks on the GPU or in memory.
fn sum(on_gpu: bool, masks_on_gpu: bool, masks: &Weighted) -> Vec<u64> {
    let (width, height) = (masks[0].0.width, masks[0].0.height);
    let mut sum = Sum::new(on_gpu.then(gpu), width, height);
    for (mask, secs) in masks {
        if masks_on_gpu {
            sum.add(&DrawnMask::Texture(&gpu(), &texture(&gpu(), mask)), *secs).unwrap();
        } else {
            sum.add(&DrawnMask::Memory(mask), *secs).unwrap();
        }
    }
    sum.finish().unwrap().iter().collect()
}

/// Cell by cell.
fn plain(masks: &Weighted) -> Vec<u64> {
    let of = |cell: usize| masks.iter().map(|(mask, secs)| u64::from(255 - mask.share[cell]) * u64::from(*secs)).sum();
    (0..masks[0].0.share.len()).map(of).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn both_machines_sum_to_the_bit(masks in weighted()) {
        let expected = plain(&masks);
        for (on_gpu, masks_on_gpu) in [(false, false), (false, true), (true, false), (true, true)] {
            prop_assert_eq!(&sum(on_gpu, masks_on_gpu, &masks), &expected, "sum on GPU {}, masks {}", on_gpu, masks_on_gpu);
        }
        // one level of one cell for one second more is another sum
        let mut other = masks;
        let last = other[0].0.share.len() - 1;
        other.push((Mask { share: (0..=last).map(|at| 255 - u8::from(at == last)).collect(), ..other[0].0.clone() }, 1));
        prop_assert_ne!(&sum(true, true, &other), &expected);
        prop_assert_eq!(&sum(true, true, &other), &plain(&other));
    }
}

#[test]
fn the_longest_sum_does_not_overflow() {
    let dark = Mask { width: 3, height: 2, share: vec![0, 1, 254, 255, 128, 0] };
    let most = u32::MAX / 255;
    let masks = vec![(dark.clone(), most - 3600), (dark, 3600)];
    assert_eq!(plain(&masks)[0], u64::from(u32::MAX));
    for on_gpu in [false, true] {
        assert_eq!(sum(on_gpu, on_gpu, &masks), plain(&masks));
    }
}

#[test]
fn longer_sums_take_two_words() {
    let masks = |secs: &[u32]| -> Weighted {
        let share = |at: usize| vec![0, 1, 254, 255, 128, at as u8];
        secs.iter().enumerate().map(|(at, &secs)| (Mask { width: 3, height: 2, share: share(at) }, secs)).collect()
    };
    let most = u32::MAX / 255;
    // over by a second; ten years in one instant; many that fit no multiple
    for secs in [vec![most, 1], vec![316_224_000], vec![1, 7_654_321, 0, 16_000_000, 12_345_678, 3 * most + 2, 5]] {
        let masks = masks(&secs);
        let expected = plain(&masks);
        assert!(expected[0] > u64::from(u32::MAX));
        for (on_gpu, masks_on_gpu) in [(false, false), (true, true), (true, false)] {
            assert_eq!(sum(on_gpu, masks_on_gpu, &masks), expected, "{secs:?}");
        }
    }
}

#[test]
fn a_sum_goes_on_from_another() {
    let half = |share: u8| Mask { width: 70, height: 2, share: vec![share; 140] };
    for on_gpu in [false, true] {
        let new = || Sum::new(on_gpu.then(gpu), 70, 2);
        let mut whole = new();
        let mut first = new();
        for sum in [&mut whole, &mut first] {
            sum.add(&DrawnMask::Memory(&half(100)), 16_000_000).unwrap();
        }
        let mut second = new();
        second.begin_with(&first.so_far().unwrap(), 16_000_000);
        for sum in [&mut whole, &mut second] {
            sum.add(&DrawnMask::Memory(&half(7)), 15_000_000).unwrap();
        }
        let sums = [whole.finish().unwrap(), second.finish().unwrap()];
        assert_eq!(sums[0], sums[1]);
        assert_ne!(sums[0], first.finish().unwrap());
    }
}

#[test]
fn bits_sum_as_their_masks_do() {
    // many of one weight, as in a year, and others between them
    let drawn = (0..70_u32).map(|instant| {
        // the first cell is always dark, so that nothing is counted more often
        let share = |at: u32| 255 * u8::from(at > 0 && (at + instant) * (instant + 2) % 7 < 3);
        let mask = Mask { width: 131, height: 3, share: (0..393).map(share).collect() };
        (mask, if instant % 37 < 34 { 1234 } else { instant })
    });
    let drawn: Vec<_> = drawn.collect();
    let [mut of_masks, mut of_bits] = [(); 2].map(|()| Sum::new(None, 131, 3));
    for (at, (mask, weight)) in drawn.iter().enumerate() {
        let bits = Bits::of(mask);
        assert_eq!(bits.mask(), *mask);
        of_masks.add(&DrawnMask::Memory(mask), *weight).unwrap();
        of_bits.add(&DrawnMask::Bits(&bits), *weight).unwrap();
        if at == 20 {
            assert_eq!(of_masks.so_far().unwrap(), of_bits.so_far().unwrap());
        }
    }
    let sums = [of_masks, of_bits].map(|sum| sum.finish().unwrap());
    assert_eq!(sums[0], sums[1]);
    assert_eq!(sums[1].iter().collect::<Vec<_>>(), plain(&drawn));
}

/// Paris in September, from the afternoon into the night, at the tower's site.
fn asked(engine: Engine, receivers: Receivers) -> Overrides {
    Overrides {
        engine: Some(engine),
        receivers: Some(receivers),
        from: "15:10".parse().ok(),
        to: "22:07".parse().ok(),
        step_secs: Some(25 * 60),
        // masks are of the instants
        resolution_secs: Some(0),
        size: Some(150),
        ..Overrides::default()
    }
}

/// Per cell the time in the sun in 1/255 s, from the masks alone; and the profile of the same run.
fn sunlit(site: &Site) -> (Vec<u64>, Profile) {
    let mut sun = vec![0_u64; site.grid.cells()];
    let mut heard = 0;
    let outcome = study::run(site, &Wants { masks: true, ..Wants::default() }, &mut |event| {
        if let Event::Drawn { index, mask, time, .. } = event {
            let (instant, mask) = (&site.track.instants[index], mask.expect("masks are wanted"));
            assert_eq!((index, time), (heard, instant.time));
            heard += 1;
            if instant.night {
                assert!(mask.share.iter().all(|&share| share == 0), "at night nothing sees the sun");
            }
            for (sun, &share) in sun.iter_mut().zip(&mask.share) {
                *sun += u64::from(share) * u64::from(instant.weight_secs);
            }
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_eq!(heard, site.track.instants.len());
    (sun, outcome.profile)
}

/// Whether in every cell shadow, sun and night fill the window, to 1/255 s.
fn fills(site: &Site, sun: &[u64], profile: &Profile) -> bool {
    let window = site.track.window_secs() * 255;
    let night = u64::from(profile.night_secs) * 255;
    sun.len() == profile.shaded.len()
        && sun.iter().zip(profile.shaded.iter()).all(|(sun, shaded)| sun + shaded + night == window)
}

#[test]
fn shadow_sun_and_night_fill_the_window() {
    let mut profiles = Vec::new();
    for engine in [Engine::Cpu, Engine::Gpu] {
        for receivers in [Receivers::Ground, Receivers::Top] {
            let site = load(SITE, &asked(engine, receivers)).unwrap();
            assert_eq!(site.track.window_secs(), (6 * 60 + 57) * 60);
            let (mut sun, mut profile) = sunlit(&site);
            assert!(profile.night_secs > 3600 && profile.day_secs > 3600, "the window holds night and day");
            assert_eq!(u64::from(profile.day_secs) + u64::from(profile.night_secs), site.track.window_secs());
            assert!(profile.shaded.iter().any(|shaded| shaded > 0), "{engine} {receivers}: no shadow");
            assert!(sun.iter().any(|&sun| sun == u64::from(profile.day_secs) * 255), "{engine} {receivers}: no sun");
            assert!(fills(&site, &sun, &profile), "{engine} {receivers}");
            profiles.push(profile.clone());
            // by one 255th of a second it would not
            sun[7] += 1;
            assert!(!fills(&site, &sun, &profile));
            sun[7] -= 1;
            profile.night_secs += 1;
            assert!(!fills(&site, &sun, &profile));
        }
    }
    // the two machines differ at shadows' edges alone
    for (cpu, gpu) in profiles[..2].iter().zip(&profiles[2..]) {
        assert_eq!((cpu.grid, cpu.day_secs, cpu.night_secs), (gpu.grid, gpu.day_secs, gpu.night_secs));
        let differ = cpu.shaded.iter().zip(gpu.shaded.iter()).filter(|(cpu, gpu)| cpu != gpu).count();
        assert!(differ * 50 < cpu.shaded.len(), "{differ} of {} cells", cpu.shaded.len());
    }
    assert_ne!(profiles[0].shaded, profiles[1].shaded, "the ground alone is another profile");
}

#[test]
fn a_profile_of_one_instant_is_empty() {
    for engine in [Engine::Cpu, Engine::Gpu] {
        for at in ["2026-09-18T15:00", "2026-09-18T23:30"] {
            let asked = Overrides { engine: Some(engine), at: at.parse().ok(), size: Some(60), ..Overrides::default() };
            let site = load(SITE, &asked).unwrap();
            let (sun, profile) = sunlit(&site);
            assert_eq!((profile.day_secs, profile.night_secs), (0, 0));
            assert!(profile.shaded.iter().all(|shaded| shaded == 0), "one instant lasts no time");
            assert!(fills(&site, &sun, &profile));
        }
    }
}

#[test]
fn hours_are_told_in_single_precision() {
    let shaded = vec![0_u32, 255 * 3600, 255 * 5400, 255, 1, u32::MAX];
    let grid = Grid { west: 0.0, north: 0.0, cell: 1.0, width: 3, height: 2 };
    let profile = Profile { grid, shaded: shaded.into(), day_secs: u32::MAX / 255, night_secs: 0 };
    let hours: Vec<f32> = (0..6).map(|cell| profile.hours(cell)).collect();
    let expected = [0.0, 1.0, 1.5, 1.0 / 3600.0, (1.0 / (255.0 * 3600.0)) as f32, (16_843_009.0 / 3600.0) as f32];
    assert_eq!(hours, expected);
    assert_ne!(profile.hours(3), profile.hours(4));
    let day = f64::from(profile.day_secs) / 3600.0;
    assert!(hours.iter().all(|&hours| f64::from(hours) <= day.next_up() + 1e-3));
}
