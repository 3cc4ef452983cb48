//! The sun between exact positions, against exact positions.

use super::{date, place};
use chrono::{Days, TimeDelta};
use gnomon::sun::{Air, DayWindow, Place, Sky, SmoothSky, delta_t_secs};

const PLACES: [(f64, f64); 7] =
    [(48.2, 16.37), (0.0, 0.0), (-33.9, 151.2), (69.6, 18.9), (89.9, 0.0), (-78.0, 166.0), (23.4, -80.0)];
/// The greatest distance, radians: half the 40 µs that a Julian date jumps by, and some.
const NEAR_RAD: f64 = 3e-9;

/// A day's sky, exact and smooth.
fn skies<'a>(place: &'a Place, window: &DayWindow, air: Option<Air>) -> (Sky<'a>, SmoothSky<'a>) {
    let sky = Sky { place, delta_t_secs: delta_t_secs(window.from.to_utc()).unwrap(), air };
    (sky, SmoothSky::new(sky, [window.from.to_utc(), window.to.to_utc()]).unwrap())
}

#[test]
fn the_sun_between_exact_positions_is_the_exact_sun() {
    let (mut asked, mut same, mut night) = (0, 0, 0);
    for (latitude, longitude) in PLACES {
        let place = place(latitude, longitude, 170.0, "UTC");
        for number in 0..24 {
            let window = DayWindow::on(&place, date("2026-01-01") + Days::new(number * 15), None, None).unwrap();
            for air in [None, Some(Air::standard(170.0))] {
                let (sky, smooth) = skies(&place, &window, air);
                let mut time = window.from;
                while time < window.to {
                    let (exact, found) = (sky.at(time).unwrap(), smooth.at(time).unwrap());
                    // far below the horizon refraction begins at once, and nobody asks
                    if exact.altitude_rad > -0.01 {
                        let off = exact.to_sun.distance(found.to_sun);
                        assert!(off < NEAR_RAD, "{latitude}, {time}: {off}");
                        assert_eq!((exact.night, exact.time), (found.night, found.time));
                        assert!((exact.altitude_rad - found.altitude_rad).abs() < NEAR_RAD);
                        asked += 1;
                        same += usize::from(off == 0.0);
                        night += usize::from(exact.night);
                    }
                    time += TimeDelta::milliseconds(1_237_331);
                }
            }
        }
    }
    assert!(asked > 5000 && night > 10 && same < asked / 100, "{asked} asked, {same} the same, {night} at night");
}

#[test]
fn beyond_its_part_of_time_the_smooth_sky_is_exact() {
    let place = place(48.2, 16.37, 170.0, "UTC");
    let window = DayWindow::on(&place, date("2026-06-21"), None, None).unwrap();
    let (sky, smooth) = skies(&place, &window, Some(Air::standard(170.0)));
    for hours in [-30, -3, 27, 50] {
        let time = window.from + TimeDelta::hours(hours);
        assert_eq!(sky.at(time).unwrap(), smooth.at(time).unwrap());
    }
}
