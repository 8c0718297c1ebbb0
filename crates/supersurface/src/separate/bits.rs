//! Pieces that are nothing by themselves: insides cut at random, and what only a neighbour carries.

use std::collections::BTreeMap;

use super::bodies::Around;
use super::view::{Border, View};
use super::{Piece, Reason};
use crate::cloud::Sets;
use crate::fit::Fit;
use crate::shape::{Plane, SupportMap};

/// Height over the support from which a piece may hang, in metres.
const ALOFT: f64 = 0.02;
/// Points of a piece that is no crumb, and its mean distance from its own surface in standard deviations of the support's
/// points.
const LARGE: usize = 800;
const SMOOTH: f64 = 0.8;
/// Height of the lowest point of a surface that stands on the support, in metres.
const FOOT: f64 = 0.008;
/// Share of its neighbour's points up to which a piece is a bit of it: where it hangs, and where it does not.
const HANGING: f64 = 0.3;
const CRUMB: f64 = 0.08;
/// Share of a hollow thing's points that a piece of its rim has at most.
const RIM: f64 = 0.3;
/// Pairs of pixels from which pieces touch.
const TOUCH: u32 = 5;
/// An inside lies so near to the body of its outside, in metres, and faces the eye at so few of its points.
const NEAR: f64 = 0.0026;
const INSIDE: f64 = 0.2;

/// Joins these to the sets that they belong to, the smallest first.
pub(super) fn hang_on(
    scene: &Around<'_>,
    view: &View<'_>,
    pieces: &[Piece],
    borders: &BTreeMap<[usize; 2], Border>,
    sets: &mut Sets,
    reasons: &mut Vec<(usize, Reason)>,
) {
    insides(scene, pieces, sets, reasons);
    let Some(support) = scene.support else { return };
    let up = support.normal();
    let mut smallest: Vec<usize> = (0..pieces.len()).collect();
    smallest.sort_by_key(|k| (pieces[*k].points.len(), *k));
    for k in smallest {
        // the set that it touches most
        let mut touching = BTreeMap::<usize, u32>::new();
        for ([a, b], border) in borders.iter().filter(|([a, b], _)| *a == k || *b == k) {
            let root = sets.root(a + b - k);
            if root != sets.root(k) {
                *touching.entry(root).or_default() += border.touching;
            }
        }
        let Some((root, pairs)) =
            touching.into_iter().max_by_key(|(root, n)| (*n, pieces.len() - root))
        else {
            continue;
        };
        let size = |root: usize, sets: &mut Sets| {
            (0..pieces.len())
                .filter(|j| sets.root(*j) == root)
                .map(|j| pieces[j].points.len())
                .sum::<usize>() as f64
        };
        let own_root = sets.root(k);
        let share = size(own_root, sets) / size(root, sets);
        let hangs = || {
            pieces[k].heights[0] > ALOFT
                && view.hangs(&pieces[k].points, &up)
                && !stands(&pieces[k], &support)
        };
        let crumb = share < CRUMB && !is_thing(scene, &pieces[k], &support);
        if pairs >= TOUCH && (crumb || share < HANGING && hangs()) {
            sets.join(root, k);
            reasons.push((k, if crumb { Reason::Sliver } else { Reason::Hanging }));
        }
    }
}

/// Whether a piece that stands on the support is large and smooth enough to be a thing, however large its neighbour is.
fn is_thing(scene: &Around<'_>, piece: &Piece, support: &Plane) -> bool {
    let smooth = piece.rough < SMOOTH * scene.noise;
    piece.points.len() >= LARGE && smooth && stands(piece, support)
}

/// Whether a piece reaches the support by its own surface, as a ball does whose lowest points are not seen.
fn stands(piece: &Piece, support: &Plane) -> bool {
    let lowest = |fit: &Fit| support.height(&fit.surface.support_point(&-support.normal()));
    piece.fit.as_ref().is_ok_and(|fit| lowest(fit) < FOOT)
}

/// Joins what the body of a hollow set explains as its inside.
fn insides(
    scene: &Around<'_>,
    pieces: &[Piece],
    sets: &mut Sets,
    reasons: &mut Vec<(usize, Reason)>,
) {
    let hollow: Vec<usize> =
        reasons.iter().filter(|r| r.1 == Reason::Hollow).map(|r| r.0).collect();
    for k in hollow {
        let root = sets.root(k);
        let members = (0..pieces.len()).filter(|j| sets.root(*j) == root);
        let mut points: Vec<u32> = members.flat_map(|j| &pieces[j].points).copied().collect();
        points.sort_unstable();
        let Ok(body) = scene.fit_hollow(&points) else { continue };
        for j in 0..pieces.len() {
            let piece = &pieces[j];
            if sets.root(j) != sets.root(k)
                && piece.clump == pieces[k].clump
                && scene.typical(&piece.points, &body) < NEAR
                && (scene.facing(&piece.points, &body) <= INSIDE
                    || piece.points.len() as f64 <= RIM * points.len() as f64)
            {
                sets.join(j, k);
                reasons.push((j, Reason::Hollow));
            }
        }
    }
}
