//! The sums of a study as a slice, with the transform of its plan; and the same study split in two parts, as for two
//! machines.

use gnomon::choice::Engine;
use gnomon::profile::{Shaded, hours};
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, Event, TiledStudy, Wants};
use std::ops::ControlFlow;
use std::path::Path;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let asked = Overrides { size: Some(128), engine: Some(Engine::Cpu), ..Overrides::default() };
    let site = Site::load(Path::new("sites/tower"), &asked)?;
    let profile = study::run(&site, &Wants::default(), &mut |_| ControlFlow::Continue(()))?.profile;

    // Seconds of shadow times 255, row by row from the north, each from the west.
    let sums = profile.shaded.in_one_word().ok_or("more than a year of daylight takes two words a cell")?;
    let [west, east_of_column, _, north, _, north_of_row] = profile.grid.transform();
    let darkest = (0..sums.len()).max_by_key(|&cell| sums[cell]).ok_or("a plan has a cell")?;
    let (column, row) = (darkest % profile.grid.width as usize, darkest / profile.grid.width as usize);
    println!(
        "{:.2} hours of shadow {:.1} m east and {:.1} m north of the place",
        hours(sums[darkest].into()),
        west + (column as f64 + 0.5) * east_of_column,
        north + (row as f64 + 0.5) * north_of_row,
    );

    // Instants are numbers, found once and passed on. Sums are integers: whoever adds them up comes to the same.
    let go_on = &mut |_: Event<'_>| ControlFlow::Continue(());
    let study = TiledStudy::new(&site, &Wants::default(), go_on)?;
    let (earlier, later) = site.track.instants.split_at(site.track.instants.len() / 2);
    let (tile, mut sums) = (study.tiles()[0], vec![0; profile.grid.cells()]);
    for part in [study.sum(tile, earlier, go_on)?, study.sum(tile, later, go_on)?] {
        sums.iter_mut().zip(part.iter()).for_each(|(sum, shaded)| *sum += shaded);
    }
    assert_eq!(Shaded::from(sums), profile.shaded);
    Ok(())
}
