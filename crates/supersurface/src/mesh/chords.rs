//! Where to cut a curve so that its chords stay close to it.
//!
//! Parameters are poor measures of length: with small exponents nearly all of a face lies within 1e-10 rad of a
//! seam. Cuts are therefore made where the point is about as far from one end as from the other, which a bisection of
//! the parameter finds.

use std::f64::consts::FRAC_PI_4;

use crate::Point;

/// Cuts of one curve beyond which it is given up.
const MOST_CUTS: usize = 8_000;

/// A parameter whose point is about as far from the point at `from` as from that at `to`.
pub(super) fn middle(curve: &impl Fn(f64) -> Point, from: f64, to: f64) -> f64 {
    part(curve, from, to, 1.0)
}

/// A parameter whose point is about `ratio` (up to 1) times as far from the point at `from` as from that at `to`.
fn part(curve: &impl Fn(f64) -> Point, from: f64, to: f64, ratio: f64) -> f64 {
    let (a, b) = (curve(from), curve(to));
    // 3 % of the part
    let enough = 0.06 * ratio * ratio / (1.0 + ratio) * (b - a).norm_squared();
    let (mut low, mut high) = (from, to);
    loop {
        let m = 0.5 * (low + high);
        let p = curve(m);
        let off = (p - a).norm_squared() - ratio * ratio * (p - b).norm_squared();
        if off.abs() <= enough || m <= low || m >= high {
            return m;
        }
        if off > 0.0 {
            high = m;
        } else {
            low = m;
        }
    }
}

/// Both ends, and parameters that part an interval in about equal parts between them.
fn parts(curve: &impl Fn(f64) -> Point, from: f64, to: f64, count: u32) -> Vec<f64> {
    let mut ends = vec![from];
    for left in (1..count).rev() {
        let last = ends.last().copied().unwrap_or(from);
        ends.push(part(curve, last, to, 1.0 / f64::from(left)));
    }
    ends.push(to);
    ends
}

/// Three parameters that part an interval in about equal quarters.
pub(super) fn quarters(curve: &impl Fn(f64) -> Point, from: f64, to: f64) -> [f64; 3] {
    let m = middle(curve, from, to);
    [middle(curve, from, m), m, middle(curve, m, to)]
}

/// The distances of the curve from its chord at three points between the ends.
fn sagittas(curve: &impl Fn(f64) -> Point, from: f64, to: f64) -> [f64; 3] {
    let (a, b) = (curve(from), curve(to));
    quarters(curve, from, to).map(|t| distance_to_segment(&curve(t), &a, &b))
}

/// The largest distance of the curve from its chord, at three points between the ends.
pub(super) fn sagitta(curve: &impl Fn(f64) -> Point, from: f64, to: f64) -> f64 {
    largest(&sagittas(curve, from, to))
}

fn largest(values: &[f64; 3]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Rising parameters between which no chord of any of the curves is farther than `tolerance` from its arc, as far as
/// parameters can be told apart. Multiples of π/4 from the middle of the range, where seams are, are among them.
pub(super) fn cuts<C: Fn(f64) -> Point>(
    curves: &[C],
    [from, to]: [f64; 2],
    tolerance: f64,
) -> Vec<f64> {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pieces = (half / FRAC_PI_4).round().clamp(2.0, 16.0) as i32;
    let at = |i: i32| centre + half * (f64::from(i) / f64::from(pieces));
    let mut found = vec![from];
    let mut open: Vec<_> = (-pieces..pieces).rev().map(|i| (at(i), at(i + 1))).collect();
    while let Some((from, to)) = open.pop() {
        let worst = curves
            .iter()
            .map(|curve| (sagittas(curve, from, to), curve))
            .max_by(|a, b| largest(&a.0).total_cmp(&largest(&b.0)))
            .filter(|(off, _)| largest(off) > tolerance && found.len() + open.len() < MOST_CUTS);
        let ends = worst.as_ref().map_or_else(Vec::new, |(off, curve)| {
            parts(curve, from, to, pieces_of(off, tolerance))
        });
        if worst.is_some() && ends.is_sorted_by(|a, b| a < b) {
            open.extend(ends.windows(2).rev().map(|w| (w[0], w[1])));
        } else {
            found.push(to);
        }
    }
    found
}

/// Into how many parts an arc has to be cut. Sagittas shrink with the square of the chord where the curvature is even,
/// and then those at the quarters are three quarters of the middle one; elsewhere halves show more.
fn pieces_of([before, middle, after]: &[f64; 3], tolerance: f64) -> u32 {
    let even = |off: &f64| (0.65..0.85).contains(&(off / middle));
    match even(before) && even(after) {
        true => (1.04 * (middle / tolerance).sqrt()).ceil().clamp(2.0, 32.0) as u32,
        false => 2,
    }
}

fn distance_to_segment(p: &Point, a: &Point, b: &Point) -> f64 {
    let (ab, ap) = (b - a, p - a);
    let length = ab.norm_squared();
    let t = if length > 0.0 { (ap.dot(&ab) / length).clamp(0.0, 1.0) } else { 0.0 };
    (ap - ab * t).norm()
}

/// Distance of a point from a triangle, by the region of the triangle's plane over which it lies.
pub(super) fn distance_to_triangle(p: &Point, [a, b, c]: &[Point; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(&ac);
    let twice = normal.norm_squared();
    let (v, w) = (ap.cross(&ac).dot(&normal), ab.cross(&ap).dot(&normal));
    if twice > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= twice {
        return (ap.dot(&normal) / twice.sqrt()).abs();
    }
    distance_to_segment(p, a, b).min(distance_to_segment(p, b, c)).min(distance_to_segment(p, c, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Parametric, Superellipsoid};
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn chords_of_a_circle_are_as_long_as_they_may_be() {
        let circle = |t: f64| Point::new(t.cos(), t.sin(), 0.0);
        let found = cuts(&[circle], [-PI, PI], 1e-4);
        // sagitta θ²/8; halves and thirds leave more than half of the longest chord
        let longest = (8e-4f64).sqrt();
        assert!(found.windows(2).all(|w| w[1] - w[0] <= longest * 1.01));
        assert!(found.len() as f64 <= 1.0 + 2.0 * 2.0 * PI / longest, "{}", found.len());
        assert!(found.contains(&0.0) && found.contains(&FRAC_PI_2) && found.contains(&-PI));
    }

    #[test]
    fn faces_of_a_box_need_few_cuts_and_its_edges_many() {
        let solid = Superellipsoid::new([1.0; 3], [0.1, 0.1]).unwrap();
        let profile = |eta: f64| solid.point(eta, 0.0);
        let found = cuts(&[profile], [-FRAC_PI_2, FRAC_PI_2], 1e-4);
        let on_face = found.iter().filter(|t| profile(**t).z.abs() < 0.7).count();
        assert!(found.len() < 90 && on_face < 8, "{} {on_face}", found.len());
        assert!((profile(middle(&profile, 0.0, FRAC_PI_4)).z - 0.5).abs() < 0.1);
    }

    #[test]
    fn distances_to_a_triangle() {
        let t = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
        for (p, d) in [
            ([0.2, 0.2, -0.5], 0.5),
            ([-3.0, -4.0, 0.0], 5.0),
            ([0.5, -2.0, 0.0], 2.0),
            ([1.0, 1.0, 0.0], 0.5f64.sqrt()),
            ([4.0, 0.0, 4.0], 5.0),
        ] {
            assert!((distance_to_triangle(&Point::from(p), &t) - d).abs() < 1e-15, "{p:?}");
        }
        let none = [Point::origin(); 3];
        assert_eq!(distance_to_triangle(&Point::new(0.0, 2.0, 0.0), &none), 2.0);
    }
}
