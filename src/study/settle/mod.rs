//! What only rays can tell of a judged site: which side of a pane or wall is outside, how deep a window lies in its
//! wall, and whether an area lies under something.

mod areas;
mod obstacles;
mod windows;

use crate::message::{Message, message};
use crate::site::{JudgedSite, SiteError};
use obstacles::Obstacles;
use rayon::prelude::*;

/// Settles what the site file leaves open, and adds notes that say how.
///
/// # Errors
/// Windows that look into their own wall.
pub fn settle(mut site: JudgedSite) -> Result<JudgedSite, SiteError> {
    let mut is_obstacle = vec![true; site.now.mesh.components.len()];
    for component in site.windows.iter().filter_map(|window| window.component) {
        is_obstacle[component as usize] = false;
    }
    let has_doubt = site.facades.iter().any(|facade| !facade.doubtful.is_empty());
    if has_doubt || !site.windows.is_empty() {
        let corners = site.windows.iter().flat_map(|window| window.corners);
        let points = site.facades.iter().flat_map(|facade| facade.points.iter().map(|[point, _]| *point));
        let obstacles = Obstacles::new(&site.now.mesh, &is_obstacle, corners.chain(points));
        windows::settle(&mut site, &obstacles)?;
        let notes = facades(&mut site, &obstacles);
        site.notes.extend(notes);
    }
    let notes = areas::notes(&site);
    site.notes.extend(notes);
    Ok(site)
}

/// Turns the points of façades where the wall is more open behind.
fn facades(site: &mut JudgedSite, obstacles: &Obstacles) -> Vec<Message> {
    let mut notes = Vec::new();
    for facade in &mut site.facades {
        let doubtful = std::mem::take(&mut facade.doubtful);
        let count = doubtful.len();
        let turned = |at: &usize| {
            let [point, normal] = *facade.points.get(*at)?;
            (obstacles.openness(point, -normal) > obstacles.openness(point, normal)).then_some(*at)
        };
        let turned: Vec<usize> = doubtful.par_iter().filter_map(turned).collect();
        for at in turned {
            facade.points[at][1] = -facade.points[at][1];
        }
        let what = format!("\"{}\" has {count} points on walls whose outer side is not known", facade.name);
        notes.extend((count > 0).then(|| message![what; "each is judged on the side that is more open"]));
    }
    notes
}
