//! Two things where no edge is concave: a piece that one body explains badly and two bodies explain well.
//!
//! Boxes that touch at a corner, a ball on a rim: where the contact is small its patches look like one surface. What tells
//! is that no body explains the whole. So the patches of a piece are shared out between two bodies, each patch to the one that
//! it lies on, fitted again and shared out again, as k-means does with points (Bradley and Mangasarian, k-plane clustering, 2000).

use nalgebra::{DMatrix, DVector};

use super::bodies::{AS_RING, Around, ROUGHLY};
use crate::cloud::Sets;
use crate::fit::Fit;
use crate::segment::{Patches, patches};

/// Mean distance from its surface from which a piece is tried, in standard deviations of the support's points, and which share
/// of it two surfaces may leave.
const ROUGH: f64 = 1.25;
const LEFT: f64 = 0.45;
/// The same of two sides that both reach down to the support, as necks and handles do not: to so many metres.
const LEFT_STANDING: f64 = 0.62;
const DOWN: f64 = 0.02;
/// The share from which nothing is hoped for when the patches were shared out once.
const HOPELESS: f64 = 0.8;
/// Mean distance from its surface up to which a thing is explained well, in standard deviations of the support's points.
const WELL: f64 = 1.1;
/// Mean distance from a ring up to which a piece is one, in the same.
const SMOOTH: f64 = 0.9;
/// Share of a side's points at which its surface faces the sensor, at least.
const OUTSIDE: f64 = 0.8;
/// The same of the body about both sides.
const PARTLY: f64 = 0.6;
/// Share of a piece's points that each side has at least.
const SIDE: f64 = 0.05;
/// Points of the smaller side, at least.
const LEAST: usize = 150;
/// Patches of a piece that is tried, at most, some 0.15 m² of it: the cut takes the cube of their number.
const MOST: usize = 300;
/// Times that the patches are shared out.
const ROUNDS: usize = 2;
/// Bend of a concave edge in degrees at which patches hold together by half or so.
const BEND: f64 = 10.0;

/// The points of two things in a piece, where it is two.
pub(super) fn split(scene: &Around<'_>, points: &[u32], whole: &Fit) -> Option<[Vec<u32>; 2]> {
    if scene.is_corner(points, whole) {
        let convex = scene.fit(points, &ROUGHLY).ok()?;
        return split(scene, points, &convex);
    }
    let rough = scene.rough(points, whole);
    let small = points.len() < 2 * LEAST;
    if small || rough < ROUGH * scene.noise || scene.facing(points, whole) < PARTLY {
        return None;
    }
    let is_ring = |fit: &Fit| {
        !scene.is_corner(points, fit) && scene.rough(points, fit) < SMOOTH * scene.noise
    };
    if scene.fit(points, &AS_RING).is_ok_and(|ring| is_ring(&ring)) {
        return None;
    }
    let patches = patches(scene.cloud, points);
    let (left, sides) = shared_out(scene, &patches, weakest_link(&patches)?, rough)?;
    let sides = [true, false].map(|side| side_points(&patches, &sides, side));
    let least = LEAST.max((SIDE * points.len() as f64) as usize);
    let down = |points: &Vec<u32>| scene.heights(points)[0] < DOWN;
    let better = is_better(scene, rough, left)
        || left < LEFT_STANDING * rough && left < WELL * scene.noise && sides.iter().all(down);
    // an inside is explained by no body from without: cut at random it stays as bad
    let outside = |points: &Vec<u32>| {
        let fit = scene.fit(points, &ROUGHLY);
        fit.is_ok_and(|fit| scene.facing(points, &fit) > OUTSIDE)
    };
    (better && sides.iter().all(|side| side.len() >= least && outside(side))).then_some(sides)
}

/// Whether several surfaces, which leave a mean distance, explain what is rough to one.
pub(super) fn is_better(scene: &Around<'_>, rough: f64, left: f64) -> bool {
    left < LEFT * rough && left < WELL * scene.noise
}

fn side_points(patches: &Patches, sides: &[bool], side: bool) -> Vec<u32> {
    let of_side = sides.iter().zip(&patches.points).filter(|(s, _)| **s == side);
    let mut points: Vec<u32> = of_side.flat_map(|(_, points)| points).copied().collect();
    points.sort_unstable();
    points
}

/// The sides after each patch went to the surface that it lies on, a few times, or as they were, where that leaves less; and
/// the mean distance that is left; `rough` is what one body leaves.
fn shared_out(
    scene: &Around<'_>,
    patches: &Patches,
    mut sides: Vec<bool>,
    rough: f64,
) -> Option<(f64, Vec<bool>)> {
    let given = sides.clone();
    let (mut as_given, mut left) = (f64::INFINITY, f64::INFINITY);
    for round in 0..ROUNDS {
        let (a, b) = (body(scene, patches, &sides, true), body(scene, patches, &sides, false));
        let (a, b) = (a?, b?);
        let (mut own, mut least, mut count) = (0.0, 0.0, 0.0);
        for (side, points) in sides.iter_mut().zip(&patches.points).filter(|(_, p)| !p.is_empty()) {
            let [on_a, on_b] = [&a, &b].map(|fit| scene.rough(points, fit));
            let weight = points.len() as f64;
            own += weight * if *side { on_a } else { on_b };
            least += weight * on_a.min(on_b);
            count += weight;
            *side = on_a < on_b;
        }
        connect(patches, &mut sides);
        left = least / f64::max(count, 1.0);
        if round == 0 {
            as_given = own / f64::max(count, 1.0);
            // nothing moved, or too much is left to hope for
            if sides == given || left > HOPELESS * rough {
                break;
            }
        }
    }
    Some(if as_given < left { (as_given, given) } else { (left, sides) })
}

/// The surface of a side, a ring where that explains it and a convex body does not.
fn body(scene: &Around<'_>, patches: &Patches, sides: &[bool], side: bool) -> Option<Fit> {
    let points = side_points(patches, sides, side);
    let seen = scene.seen(&points);
    let fit = seen.fit(&ROUGHLY).ok()?;
    if scene.rough(&points, &fit) < ROUGH * scene.noise {
        return Some(fit);
    }
    let ring = seen.fit(&AS_RING).ok();
    let ring = ring.filter(|ring| scene.rough(&points, ring) < scene.rough(&points, &fit));
    Some(ring.unwrap_or(fit))
}

/// Leaves each side its largest connected part.
fn connect(patches: &Patches, sides: &mut [bool]) {
    for side in [true, false] {
        let mut sets = Sets::new(sides.len());
        for ([a, b], _) in &patches.borders {
            let (a, b) = (*a as usize, *b as usize);
            if sides[a] == side && sides[b] == side {
                sets.join(a, b);
            }
        }
        let mut sizes = vec![0; sides.len()];
        for k in (0..sides.len()).filter(|k| sides[*k] == side) {
            sizes[sets.root(k)] += patches.points[k].len();
        }
        let Some(main) = (0..sizes.len()).max_by_key(|k| sizes[*k]) else { return };
        for (k, own) in sides.iter_mut().enumerate() {
            if *own == side && sets.root(k) != main {
                *own = !side;
            }
        }
    }
}

/// The sides of the cut through the fewest and most concave borders, for what it parts (the normalised cut of Shi and Malik,
/// 2000, along the Fiedler vector).
fn weakest_link(patches: &Patches) -> Option<Vec<bool>> {
    let n = patches.patches.len();
    if !(4..=MOST).contains(&n) {
        return None;
    }
    let mut holds = DMatrix::<f64>::zeros(n, n);
    for ([a, b], count) in &patches.borders {
        let (a, b) = (*a as usize, *b as usize);
        let (p, q) = (&patches.patches[a], &patches.patches[b]);
        let concave = (p.centre - q.centre).dot(&(p.normal - q.normal)) < 0.0;
        let bend = if concave { p.normal.angle(&q.normal).to_degrees() } else { 0.0 };
        let hold = f64::from(*count) * (-(bend / BEND).powi(2)).exp() + 1e-6;
        holds[(a, b)] = hold;
        holds[(b, a)] = hold;
    }
    let degree: Vec<f64> = (0..n).map(|k| holds.row(k).sum()).collect();
    if degree.iter().any(|d| *d <= 0.0) {
        return None;
    }
    let scale: Vec<f64> = degree.iter().map(|d| d.sqrt().recip()).collect();
    let laplace = DMatrix::from_fn(n, n, |a, b| {
        f64::from(u8::from(a == b)) - holds[(a, b)] * scale[a] * scale[b]
    });
    let eigen = laplace.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let vector: DVector<f64> = eigen.eigenvectors.column(order[1]).into_owned();
    let at = |k: usize| vector[k] * scale[k];
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| at(*a).total_cmp(&at(*b)));
    // the best of all thresholds
    let all: f64 = degree.iter().sum();
    let mut inside = vec![false; n];
    let (mut cut, mut volume) = (0.0, 0.0);
    let mut best: Option<(f64, usize)> = None;
    for (k, patch) in order.iter().enumerate().take(n - 1) {
        for other in 0..n {
            let hold = holds[(*patch, other)];
            cut += if inside[other] { -hold } else { hold };
        }
        inside[*patch] = true;
        volume += degree[*patch];
        let cost = cut / volume + cut / (all - volume);
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, k));
        }
    }
    let (_, last) = best?;
    let mut sides = vec![false; n];
    order[..=last].iter().for_each(|k| sides[*k] = true);
    Some(sides)
}
