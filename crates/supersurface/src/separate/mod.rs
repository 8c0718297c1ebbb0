//! Floor 8: things that touch, told apart; pieces of one thing, put together.
//!
//! What stands on a support comes as clumps. One that one body explains but for noise is a thing. Each other is cut at its
//! concave edges; where one body does not explain all parts after all, a part is cut that two bodies explain and one does
//! not. Pieces are joined again where there is a reason to and one surface explains them about as well as their own do
//! ([`Reason`]). That alone is no reason: two boxes of the same footprint, one on the other, are explained by one box.
//!
//! The reasons to join pieces are seen in the image: clouds of several views, which are none, keep their pieces but for
//! clumps that are one body.

mod bits;
mod bodies;
mod clump;
mod joints;
mod split;
mod view;

use std::collections::BTreeMap;

pub(crate) use bodies::Around;

use crate::cloud::{PointCloud, Sets, VoxelGrid};
use crate::fit::{Fit, FitError, FitOptions};
use crate::segment::{DropReason, Dropped, Frame, Raster, Segmentation, Support};
use clump::clumped;
use view::View;

/// The least noise that is reckoned with, in metres: bodies are no superellipsoids to the last digit.
const LEAST_NOISE: f64 = 0.0004;

/// Share over its support up to which a thing may be part of what stands beside it, and the seam between, in metres.
const OVER: f64 = 0.05;
const SEAM: f64 = 0.03;

/// Why pieces between concave edges are one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Reason {
    /// One body explains the whole clump: there is but a dent.
    Whole,
    /// Something nearer hides what is between them, and one body explains both.
    Behind,
    /// One is the inside of the other, seen through its mouth: one body explains both, and shows its inside at one of them.
    Hollow,
    /// The surface goes on from one to the other: noise parted them, and one body explains both.
    Unbroken,
    /// The smaller lies in a dent of the larger, and one body explains both.
    Dent,
    /// Nothing carries it but its neighbour: a handle, a spout.
    Hanging,
    /// Too small to be an object.
    Sliver,
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Whole => "one body with dents",
            Self::Behind => "behind something nearer",
            Self::Hollow => "its inside",
            Self::Dent => "beside a dent",
            Self::Unbroken => "no edge between",
            Self::Hanging => "carried by it alone",
            Self::Sliver => "a sliver of it",
        })
    }
}

/// An object of a scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Thing {
    /// Its points, in ascending order.
    pub points: Vec<u32>,
    /// Its surface, or why its points give none.
    pub fit: Result<Fit, FitError>,
    /// Why its pieces were put together; none for an object of one piece.
    pub joined: Vec<Reason>,
}

impl Thing {
    /// An object whose points were given.
    pub(crate) const fn given(points: Vec<u32>, fit: Result<Fit, FitError>) -> Self {
        Self { points, fit, joined: Vec::new() }
    }
}

/// A piece between concave edges.
#[derive(Clone, Debug)]
struct Piece {
    points: Vec<u32>,
    /// The clump that it was cut from.
    clump: usize,
    fit: Result<Fit, FitError>,
    /// True where it was fitted as objects are.
    fitted: bool,
    /// Median distance of its points from their own surface, in metres; 0 where they give none.
    own: f64,
    /// The mean of these distances, none counted for more than 10 mm.
    rough: f64,
    /// Heights of its lowest, middle and highest points over the support, in metres.
    heights: [f64; 3],
    joined: Vec<Reason>,
}

impl Piece {
    fn new(scene: &Around<'_>, clump: usize, points: Vec<u32>, options: &FitOptions) -> Self {
        let fit = scene.fit(&points, options);
        let off = fit.as_ref().ok().map(|f| scene.off(&points, f));
        let (rough, own) = off.map_or((0.0, 0.0), |off| (off.mean(), off.median()));
        let heights = scene.heights(&points);
        Self { points, clump, fit, fitted: false, own, rough, heights, joined: Vec::new() }
    }
}

/// The objects that the clumps of a segmentation consist of, in the order of their first points; the segmentation's objects
/// become these. What the border of the image cuts off is left out, unless it touches a thing that is seen whole.
pub fn separate(
    cloud: &PointCloud,
    segmentation: &mut Segmentation,
    options: &FitOptions,
) -> Vec<Thing> {
    let mut things: Vec<(Thing, usize)> = Vec::new();
    for k in 0..segmentation.supports.len().max(1) {
        let standing = segmentation.objects.iter().enumerate();
        let standing =
            standing.filter(|(i, _)| segmentation.stands_on.get(*i).is_none_or(|s| *s == k));
        let clumps: Vec<&[u32]> = standing.map(|(_, points)| &points[..]).collect();
        let support = segmentation.supports.get(k);
        let found = separate_on(cloud, segmentation.image(), support, &clumps, options);
        things.extend(found.into_iter().map(|thing| (thing, k)));
    }
    things.sort_by_key(|(thing, _)| thing.points.first().copied());
    let left = left_over(&segmentation.objects, &things, cloud.points.len());
    let beside = beside(&segmentation.dropped);
    let cut = cut_off(cloud, &segmentation.objects, &things);
    let mut kept = Vec::with_capacity(things.len());
    for ((thing, k), is_cut) in things.into_iter().zip(cut) {
        let support = segmentation.supports.get(k);
        let reason = match support {
            _ if is_cut => DropReason::CutOff,
            Some(support) if goes_on(cloud, &thing, support, &beside) => DropReason::OffSupport,
            _ => {
                kept.push((thing, k));
                continue;
            }
        };
        segmentation.dropped.push(match support {
            Some(support) => Dropped::new(&cloud.points, thing.points, reason, &support.plane),
            None => Dropped { points: thing.points, reason, bounds: None },
        });
    }
    let things = kept;
    if !left.is_empty() {
        segmentation.dropped.push(Dropped {
            points: left,
            reason: DropReason::Speck,
            bounds: None,
        });
    }
    segmentation.objects = things.iter().map(|(thing, _)| thing.points.clone()).collect();
    segmentation.stands_on = things.iter().map(|(_, k)| *k).collect();
    things.into_iter().map(|(thing, _)| thing).collect()
}

/// Which things the border of the image cuts off: none that touches one that is seen whole.
fn cut_off(cloud: &PointCloud, clumps: &[Vec<u32>], things: &[(Thing, usize)]) -> Vec<bool> {
    let Some(frame) = Frame::of(cloud) else { return vec![false; things.len()] };
    let mut cut: Vec<bool> = things.iter().map(|(thing, _)| frame.cuts(&thing.points)).collect();
    let clump = |k: usize| {
        let first = things[k].0.points.first();
        clumps.iter().position(|c| first.is_some_and(|i| c.binary_search(i).is_ok()))
    };
    if cut.contains(&true) {
        let whole: Vec<_> = (0..cut.len()).filter(|k| !cut[*k]).map(clump).collect();
        cut.iter_mut().enumerate().for_each(|(k, cut)| *cut &= !whole.contains(&clump(k)));
    }
    cut
}

/// The points of what stands beside the supports.
fn beside(dropped: &[Dropped]) -> Vec<u32> {
    let off = dropped.iter().filter(|d| d.reason == DropReason::OffSupport);
    off.flat_map(|d| &d.points).copied().collect()
}

/// Whether a thing goes on in what stands beside its support, and is itself hardly over it.
fn goes_on(cloud: &PointCloud, thing: &Thing, support: &Support, beside: &[u32]) -> bool {
    let points = || thing.points.iter().filter_map(|i| cloud.points.get(*i as usize)).step_by(8);
    if beside.is_empty() || support.share_over(points()) > OVER {
        return false;
    }
    let grid = VoxelGrid::new(&cloud.points, beside.iter().copied(), SEAM);
    grid.is_some_and(|grid| {
        let mut near = 0;
        points().for_each(|p| grid.within(p, SEAM, |_, _| near += 1));
        near > 0
    })
}

/// The objects that the clumps on one support consist of.
fn separate_on(
    cloud: &PointCloud,
    image: Option<&Raster>,
    support: Option<&Support>,
    clumps: &[&[u32]],
    options: &FitOptions,
) -> Vec<Thing> {
    let scene = Around {
        cloud: image.map_or(cloud, |i| &i.cloud),
        support: support.map(|s| s.plane),
        noise: support.map_or(0.0, |s| s.noise).max(LEAST_NOISE),
    };
    let clumps = each(clumps.len(), |k| {
        let points = clumps[k];
        match image {
            Some(image) => clumped(&scene, k, &image.pixels(points), options),
            None => clumped(&scene, k, points, options),
        }
    });
    let pieces: Vec<Piece> = clumps.into_iter().flatten().collect();
    let groups = match View::new(scene.cloud, pieces.iter().map(|p| &p.points[..])) {
        Some(view) => grouped(&scene, &view, &pieces),
        None => (0..pieces.len()).map(|k| (vec![k], Vec::new())).collect(),
    };
    let around = Around { cloud, ..scene };
    each(groups.len(), |k| {
        let (members, reasons) = &groups[k];
        let own = members.iter().map(|m| &pieces[*m]);
        let mut points: Vec<u32> = own.clone().flat_map(|p| &p.points).copied().collect();
        points.sort_unstable();
        if let Some(image) = image {
            points = image.back(&points);
        }
        let mut joined: Vec<Reason> = own.flat_map(|p| &p.joined).chain(reasons).copied().collect();
        joined.sort_unstable();
        joined.dedup();
        let fit = match (&members[..], image) {
            ([k], None) if pieces[*k].fitted => pieces[*k].fit.clone(),
            _ => around.fit(&points, options),
        };
        Thing { fit, points, joined }
    })
}

/// The points of clumps that are no thing's.
fn left_over(clumps: &[Vec<u32>], things: &[(Thing, usize)], count: usize) -> Vec<u32> {
    let mut taken = vec![false; count];
    things.iter().flat_map(|(thing, _)| &thing.points).for_each(|i| taken[*i as usize] = true);
    let mut left: Vec<u32> =
        clumps.iter().flatten().filter(|i| !taken[**i as usize]).copied().collect();
    left.sort_unstable();
    left
}

/// The pieces that are one object, and why.
fn grouped(
    scene: &Around<'_>,
    view: &View<'_>,
    pieces: &[Piece],
) -> Vec<(Vec<usize>, Vec<Reason>)> {
    let borders = view.borders();
    let mut sets = Sets::new(pieces.len());
    let mut reasons: Vec<(usize, Reason)> = Vec::new();
    for joint in joints::joints(scene, view, pieces, &borders) {
        let [a, b] = joint.pieces.map(|k| sets.root(k));
        let in_both = |k: usize, sets: &mut Sets| [a, b].contains(&sets.root(k));
        let all: Vec<&Piece> =
            (0..pieces.len()).filter(|k| in_both(*k, &mut sets)).map(|k| &pieces[k]).collect();
        let hollow = joint.reason == Reason::Hollow
            || reasons.iter().any(|(k, r)| *r == Reason::Hollow && in_both(*k, &mut sets));
        if a != b && joints::is_one(scene, &all, hollow) {
            sets.join(a, b);
            reasons.push((a, joint.reason));
        }
    }
    bits::hang_on(scene, view, pieces, &borders, &mut sets, &mut reasons);
    let mut groups: BTreeMap<usize, (Vec<usize>, Vec<Reason>)> = BTreeMap::new();
    for k in 0..pieces.len() {
        groups.entry(sets.root(k)).or_default().0.push(k);
    }
    for (k, reason) in reasons {
        groups.entry(sets.root(k)).or_default().1.push(reason);
    }
    groups.into_values().collect()
}

/// The results of `work` for 0..n in order, on all cores where the feature `parallel` is on.
pub(crate) fn each<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..n).into_par_iter().map(work).collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        (0..n).map(work).collect()
    }
}
