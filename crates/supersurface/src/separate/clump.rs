//! A clump as pieces between its concave edges, or as one body where that explains them all.

use super::bodies::{Around, QUICK};
use super::{Piece, Reason};
use crate::fit::{Fit, FitOptions};
use crate::segment::convex_pieces;
use crate::surface::Surface;

/// Points of the least piece, and the share of its clump's.
const LEAST: usize = 150;
const SLIVER: f64 = 0.02;
/// Distance from the surface that a sliver joins, in metres.
const BESIDE: f64 = 0.006;
/// How much worse than a piece's own surface that of the whole clump may explain it, and up to which distance in metres
/// that does not matter.
const WORSE: f64 = 1.3;
const SLIGHT: f64 = 0.0012;
/// The same for a body whose hole is seen: its inside is concave and cut at random. A handle, which it leaves out, has at
/// most this share of its points.
const HOLLOW_WORSE: f64 = 1.8;
const HOLLOW_SLIGHT: f64 = 0.0023;
const HANDLE: f64 = 0.2;

/// The pieces of clump number `clump`; one where there is nothing to cut.
pub(super) fn clumped(scene: &Around<'_>, clump: usize, points: &[u32]) -> Vec<Piece> {
    let piece = |points: Vec<u32>, own: f64, joined: Vec<Reason>| {
        let heights = scene.heights(&points);
        Piece { points, clump, own, heights, joined }
    };
    let least = LEAST.max((SLIVER * points.len() as f64) as usize);
    let pieces = convex_pieces(scene.cloud, points);
    let (large, slivers): (Vec<_>, Vec<_>) = pieces.into_iter().partition(|p| p.len() >= least);
    let own = |points: &[u32]| {
        let fit = scene.fit(points, &QUICK).ok();
        (fit.as_ref().map_or(f64::INFINITY, |f| scene.typical(points, f)), fit)
    };
    if large.len() < 2 {
        let joined = if slivers.is_empty() { Vec::new() } else { vec![Reason::Sliver] };
        return vec![piece(points.to_vec(), own(points).0, joined)];
    }
    let mut parts: Vec<(Vec<u32>, f64, Option<Fit>, bool)> = large
        .into_iter()
        .map(|points| {
            let (own, fit) = own(&points);
            (points, own, fit, false)
        })
        .collect();
    if let Ok(whole) = scene.fit(points, &FitOptions::UNDEFORMED.quick()) {
        let unexplained = |worse: f64, slight: f64| {
            let poorly = parts
                .iter()
                .filter(|(p, own, ..)| scene.typical(p, &whole) > (worse * own).max(slight));
            poorly.map(|(p, ..)| p.len()).sum::<usize>()
        };
        let hollow = matches!(whole.surface.shape(), Surface::Supertoroid(_));
        let handle = (HANDLE * points.len() as f64) as usize;
        if unexplained(WORSE, SLIGHT) == 0
            || hollow && unexplained(HOLLOW_WORSE, HOLLOW_SLIGHT) < handle
        {
            return vec![piece(points.to_vec(), scene.typical(points, &whole), vec![Reason::Whole])];
        }
    }
    for sliver in slivers {
        let distance = |fit: &Option<Fit>| {
            fit.as_ref().map_or(f64::INFINITY, |f| scene.typical(&sliver, f))
        };
        let nearest = parts.iter_mut().map(|p| (distance(&p.2), p));
        if let Some((distance, (points, _, _, joined))) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))
            && distance < BESIDE
        {
            points.extend(sliver);
            points.sort_unstable();
            *joined = true;
        }
    }
    let reasons = |joined: bool| if joined { vec![Reason::Sliver] } else { Vec::new() };
    parts.into_iter().map(|(points, own, _, joined)| piece(points, own, reasons(joined))).collect()
}
