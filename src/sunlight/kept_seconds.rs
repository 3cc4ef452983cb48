//! Which seconds of sun are kept where only some of them must be: those whose rays pass highest.

/// A second, and the least z of its ray over a plot; infinite if the ray does not pass over it.
pub type RayHeight = (i64, f64);

/// The seconds that are kept free, and the z of the lowest of their rays.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptSeconds {
    /// Spells in their order: the first second, and the one after the last.
    pub spells: Vec<[i64; 2]>,
    /// Infinite if none of them passes over the plot.
    pub lowest: f64,
}

/// From seconds in their order, chooses enough of them such that their lowest ray is as high as possible. `at_once`
/// asks for one stretch without a gap. Returns `None` if there are not enough.
pub fn roomiest(rays: &[RayHeight], secs: usize, at_once: bool) -> Option<KeptSeconds> {
    if secs == 0 {
        return Some(KeptSeconds { spells: Vec::new(), lowest: f64::INFINITY });
    }
    if rays.len() < secs {
        return None;
    }
    if at_once {
        return longest_at_once(rays, secs);
    }
    let mut by_height: Vec<RayHeight> = rays.to_vec();
    // the first of equal ones
    let higher = |one: &RayHeight, other: &RayHeight| other.1.total_cmp(&one.1).then(one.0.cmp(&other.0));
    let (_, (_, lowest), _) = by_height.select_nth_unstable_by(secs - 1, higher);
    let lowest = *lowest;
    let mut kept: Vec<i64> = by_height[..secs].iter().map(|(second, _)| *second).collect();
    kept.sort_unstable();
    Some(KeptSeconds { spells: spells(&kept), lowest })
}

/// The same for one stretch without a gap. The lowest ray of each stretch is found with a queue of the rays that may
/// become it.
fn longest_at_once(rays: &[RayHeight], secs: usize) -> Option<KeptSeconds> {
    let mut best: Option<(f64, usize)> = None;
    let mut queue = std::collections::VecDeque::new();
    let mut begin = 0;
    for (at, (second, height)) in rays.iter().enumerate() {
        if at > 0 && rays[at - 1].0 + 1 != *second {
            queue.clear();
            begin = at;
        }
        while queue.back().is_some_and(|last: &usize| rays[*last].1 >= *height) {
            queue.pop_back();
        }
        queue.push_back(at);
        if at + 1 < begin + secs {
            continue;
        }
        let first = at + 1 - secs;
        while queue.front().is_some_and(|front| *front < first) {
            queue.pop_front();
        }
        let lowest = queue.front().map_or(f64::INFINITY, |front| rays[*front].1);
        if best.is_none_or(|(height, _)| lowest > height) {
            best = Some((lowest, first));
        }
    }
    let (lowest, first) = best?;
    Some(KeptSeconds { spells: vec![[rays[first].0, rays[first].0 + secs as i64]], lowest })
}

/// Merges seconds in their order into spells.
pub fn spells(seconds: &[i64]) -> Vec<[i64; 2]> {
    let mut spells: Vec<[i64; 2]> = Vec::new();
    for second in seconds {
        match spells.last_mut() {
            Some(last) if last[1] == *second => last[1] += 1,
            _ => spells.push([*second, *second + 1]),
        }
    }
    spells
}
