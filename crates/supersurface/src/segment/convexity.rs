//! Where would one cut a heap? Between patches that meet at a concave edge: two things touch there.
//!
//! Patches with centres `c1`, `c2` and normals `n1`, `n2` meet at a convex or flat edge when
//! `(c1 - c2)·(n1 - n2) >= 0`, or when the normals differ by less than a tolerance (Stein et al., CVPR 2014).
//! An edge counts only if the patches do not merely pass each other's ends: the angle between `c1 - c2` and
//! `n1 × n2` must exceed `60°/(1 + exp(-0.25 (β - 25°)))` for normals that differ by β.
//!
//! What is cut need not be two things: a handle and a bowl's floor are concave too. So this proposes, and
//! whoever can say what a thing looks like decides.

use crate::cloud::{PointCloud, Sets};
use crate::segment::patches::{Patch, Patches, patches};

/// Normals that differ by less than this many degrees belong to one surface.
const TOLERANCE: f64 = 15.0;
/// Spread of a patch's normals from which it may lie across an edge, and how many times its neighbour's it is then.
const ASTRIDE: f64 = 0.04;
const ASTRIDE_TIMES: f64 = 2.0;
/// Height of a step between surfaces that look the same way, in distances of patches.
const STEP: f64 = 0.1;
/// A piece of fewer patches is a crumb of its neighbour.
const LEAST_PATCHES: usize = 3;

/// The pieces of an object between its concave edges, the indices of each in ascending order; one piece where
/// nothing parts it, where its points are too far apart or the sensor's place is not known.
pub fn convex_pieces(cloud: &PointCloud, object: &[u32]) -> Vec<Vec<u32>> {
    if cloud.viewpoint.is_none() {
        return vec![object.to_vec()];
    }
    let patches = patches(cloud, object);
    let mut pieces = vec![Vec::new(); patches.patches.len()];
    for (k, root) in roots(&patches).into_iter().enumerate() {
        pieces[root].extend_from_slice(&patches.points[k]);
    }
    pieces.retain(|p| !p.is_empty());
    pieces.iter_mut().for_each(|p| p.sort_unstable());
    pieces.sort_unstable_by_key(|p| p[0]);
    if pieces.is_empty() { vec![object.to_vec()] } else { pieces }
}

/// The piece of each patch, as the number of one of its patches.
fn roots(patches: &Patches) -> Vec<usize> {
    let all = &patches.patches;
    let mut sets = Sets::new(all.len());
    for ([a, b], _) in &patches.borders {
        if is_convex(&all[*a as usize], &all[*b as usize], patches.size) {
            sets.join(*a as usize, *b as usize);
        }
    }
    // crumbs go to the neighbour with the longest border, the smallest crumbs first
    loop {
        let roots: Vec<usize> = (0..all.len()).map(|k| sets.root(k)).collect();
        let mut sizes = vec![0usize; all.len()];
        roots.iter().for_each(|r| sizes[*r] += 1);
        let mut contact = std::collections::BTreeMap::<[usize; 2], u32>::new();
        for ([a, b], count) in &patches.borders {
            let (a, b) = (roots[*a as usize], roots[*b as usize]);
            for pair in [[a, b], [b, a]].into_iter().filter(|_| a != b) {
                *contact.entry(pair).or_default() += count;
            }
        }
        let crumbs = contact.iter().filter(|([a, _], _)| sizes[*a] < LEAST_PATCHES);
        let best = crumbs.max_by_key(|([a, b], count)| {
            (std::cmp::Reverse(sizes[*a]), **count, std::cmp::Reverse([*a, *b]))
        });
        let Some(([a, b], _)) = best else { return roots };
        sets.join(*a, *b);
    }
}

/// Whether two patches of such a size go on in each other or meet at a convex edge.
fn is_convex(a: &Patch, b: &Patch, size: f64) -> bool {
    let spread = [a, b].map(|p| 1.0 - p.evenness);
    let (least, most) = (spread[0].min(spread[1]), spread[0].max(spread[1]));
    // one that lies across an edge belongs to both sides of it
    if most > ASTRIDE && most > ASTRIDE_TIMES * least {
        return false;
    }
    let apart = a.centre - b.centre;
    let bend = a.normal.angle(&b.normal).to_degrees();
    let crossing = a.normal.cross(&b.normal);
    if let (Some(along), Some(apart)) = (crossing.try_normalize(1e-6), apart.try_normalize(1e-12)) {
        let angle = along.dot(&apart).abs().min(1.0).acos().to_degrees();
        if angle < 60.0 / (1.0 + (-0.25 * (bend - 25.0)).exp()) {
            return false;
        }
    }
    if bend >= TOLERANCE {
        return apart.dot(&(a.normal - b.normal)) >= 0.0;
    }
    // one surface lies behind the other where both look the same way
    let step = a.normal.dot(&apart).abs().min(b.normal.dot(&apart).abs());
    step < size * (crossing.norm() + STEP)
}
