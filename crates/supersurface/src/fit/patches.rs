//! The neighbourhoods of points: how flat, how dense, which way they face. Surfaces are flat and dense; outliers are
//! not.

use super::neighbours::Neighbours;
use super::start::quantile;
use crate::Vector;
use crate::cloud::Neighbourhood;
use crate::numeric::symmetric::least_axes;

/// Neighbours that make a neighbourhood.
const NEIGHBOURS: usize = 12;
/// Most points among which neighbours are sought.
const AMONG: usize = 1600;

/// The neighbourhood of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub(super) point: Vector,
    /// Unit normal of the plane through the neighbours.
    pub(super) normal: Vector,
    /// 1 on a plane, 0 in a ball.
    pub(super) flatness: f64,
    /// Distance of the farthest neighbour.
    radius: f64,
}

/// Neighbourhoods of up to `looked_at` points spread over the cloud; none for too few points.
pub(super) fn patches(points: &[Vector], looked_at: usize) -> Vec<Patch> {
    if points.len() < 3 * NEIGHBOURS {
        return Vec::new();
    }
    let stride = points.len().div_ceil(AMONG);
    let among: Vec<Vector> = points.iter().step_by(stride).copied().collect();
    let mut neighbours = Neighbours::among(&among);
    let stride = points.len().div_ceil(looked_at);
    let places = points.iter().step_by(stride);
    let (mut radii, mut scatters) = (Vec::with_capacity(looked_at), Vec::with_capacity(looked_at));
    for p in places.clone() {
        let near = neighbours.nearest(p, NEIGHBOURS + 1);
        radii.push(near.last().map_or(0.0, |n| n.square().sqrt()));
        let mut about = Neighbourhood::default();
        near.iter().for_each(|n| about.add(&(among[n.place()] - p)));
        scatters.push(about.covariance());
    }
    let mut found = Vec::with_capacity(looked_at);
    let each = places.zip(radii).zip(&scatters).zip(least_axes(&scatters));
    for (((point, radius), scatter), ([least, ..], normal)) in each {
        let share = least / scatter.trace().max(1e-300);
        found.push(Patch { point: *point, normal, flatness: 1.0 - 3.0 * share, radius });
    }
    found
}

/// The flattest share.
pub(super) fn flattest(patches: &[Patch], share: f64) -> Vec<Patch> {
    best(patches, share, |p| p.flatness)
}

/// The share that is most flat and dense.
pub(super) fn firmest(patches: &[Patch], share: f64) -> Vec<Patch> {
    let mut radii: Vec<f64> = patches.iter().map(|p| p.radius).collect();
    let typical = quantile(&mut radii, 0.5).max(1e-300);
    best(patches, share, |p| p.flatness - 0.5 * p.radius / typical)
}

fn best(patches: &[Patch], share: f64, merit: impl Fn(&Patch) -> f64) -> Vec<Patch> {
    let count = (share * patches.len() as f64).ceil() as usize;
    let mut ranked: Vec<(f64, usize)> = patches.iter().map(merit).zip(0..).collect();
    let Some(last) = count.min(ranked.len()).checked_sub(1) else { return Vec::new() };
    ranked.select_nth_unstable_by(last, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    ranked[..=last].iter().map(|(_, i)| patches[*i]).collect()
}
