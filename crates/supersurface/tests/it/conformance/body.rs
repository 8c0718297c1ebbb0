//! Bounds, support points and mass against samples.

use std::fmt::Debug;

use supersurface::measure::{OrientedBox, tight_bounds};
use supersurface::nalgebra::Matrix3;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, MassProperties, Parametric, Posed, SupportMap};
use supersurface::{Point, Vector};

use super::members::{Make, pose};
use super::samples::{scaled, shapes, surface_points};

/// No surface point lies outside of the bounds or beyond an extent, also of the posed shape and of its oriented box.
pub(super) fn bounds<S: Implicit + Clone + Debug>(make: Make<S>) {
    for (case, shape) in shapes(make, 80) {
        let random = &mut Stream::new(51, case);
        let [low, high] = shape.bounds();
        let pose = pose(random, 1.0);
        let posed = Posed::new(shape.clone(), pose).unwrap();
        let [posed_low, posed_high] = posed.bounds();
        let around = OrientedBox::around(&posed);
        let size = 1e-9 * (1.0 + posed.pose().translation.vector.norm());
        for p in surface_points(&shape, random, 100) {
            let q = pose * p;
            for k in 0..3 {
                assert!(p[k] >= low[k] - size && p[k] <= high[k] + size, "{case}: {p}");
                assert!(q[k] >= posed_low[k] - size && q[k] <= posed_high[k] + size, "{case}: {q}");
            }
            let n = Vector::from_fn(|_, _| random.normal());
            assert!(n.dot(&p.coords) <= shape.extent(&n) + size * n.norm(), "{case}: {n} {p}");
            assert!(n.dot(&q.coords) <= posed.extent(&n) + size * n.norm(), "{case}: {n} {q}");
            let shrunk = around.map(|b| {
                let local = b.pose().inverse_transform_point(&q);
                (0..3).all(|k| local[k].abs() <= b.half_extents()[k] + size)
            });
            assert!(shrunk.unwrap_or(true), "{case}: {q} outside of {around:?}");
        }
        let large = scaled(make, case, 16.0).bounds();
        for (a, b) in
            large.iter().flat_map(|p| p.iter()).zip([low, high].iter().flat_map(|p| p.iter()))
        {
            assert!(*a == b * 16.0 || (a - b * 16.0).abs() < 1e-2 * a.abs(), "{case}: {a} {b}");
        }
    }
}

/// The surface touches its bounds on every side: the farthest point along each axis, from samples and then by ever
/// shorter steps.
pub(super) fn touched<S: Implicit + Parametric>(make: Make<S>) {
    for (case, shape) in shapes(make, 80) {
        let [low, high] = shape.bounds();
        let [eta, omega] = shape.domain();
        for k in 0..3 {
            for (side, bound) in [(-1.0, low[k]), (1.0, high[k])] {
                let value = |e: f64, o: f64| {
                    side * shape.point(e.clamp(eta[0], eta[1]), o.clamp(omega[0], omega[1]))[k]
                };
                let mut best = (f64::NEG_INFINITY, [0.0; 2]);
                for i in 0..=24 {
                    for j in 0..=24 {
                        let at = |[a, b]: [f64; 2], n: i32| a + (b - a) * f64::from(n) / 24.0;
                        let place = [at(eta, i), at(omega, j)];
                        let found = value(place[0], place[1]);
                        best = if found > best.0 { (found, place) } else { best };
                    }
                }
                let mut step = (eta[1] - eta[0]) / 24.0;
                while step > 1e-13 {
                    let before = best.0;
                    let [e, o] = best.1;
                    for (a, b) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                        let place = [e + a * step, o + b * step];
                        let found = value(place[0], place[1]);
                        best = if found > best.0 { (found, place) } else { best };
                    }
                    step *= if best.0 > before { 1.2 } else { 0.5 };
                }
                let gap = side * bound - best.0;
                let width = high[k] - low[k];
                assert!(gap.abs() < 1e-6 * width, "{case}, axis {k}: {best:?} {bound}");
            }
        }
    }
}

/// A support point lies on the surface, no sample lies beyond it, the support function is convex and 1-homogeneous
/// and stays within the bounds.
pub(super) fn support<S: Implicit + SupportMap + Clone + Debug>(make: Make<S>) {
    for (case, shape) in shapes(make, 80) {
        let random = &mut Stream::new(52, case);
        let [low, high] = shape.bounds();
        let edges = high - low;
        let samples = surface_points(&shape, random, 150);
        let pose = pose(random, 1.0);
        let posed = Posed::new(shape.clone(), pose).unwrap();
        let large = scaled(make, case, 16.0);
        let size = edges.norm();
        let mut last = Vector::x();
        for turn in 0..40 {
            // in units of the edges, so that thin bodies are met from all sides
            let n = match turn {
                0..6 => Vector::ith(turn % 3, if turn < 3 { 1.0 } else { -1.0 }),
                6..14 => Vector::from_fn(|_, _| random.index(3) as f64 - 1.0).component_div(&edges),
                _ => Vector::from_fn(|_, _| random.normal()).component_div(&edges),
            };
            let s = shape.support_point(&n);
            if n != Vector::zeros() {
                assert!(
                    (shape.gauge(&s) - 1.0).abs() < 1e-8,
                    "{case} {n}: {s} {}",
                    shape.gauge(&s)
                );
            }
            let h = shape.support(&n);
            let rounding = 1e-12 * n.norm() * size;
            for q in &samples {
                assert!(n.dot(&q.coords) <= h + rounding * 100.0, "{case} {n}: {q} beyond {s}");
            }
            assert!((h - n.dot(&s.coords)).abs() <= rounding);
            assert!(shape.extent(&n) >= h - rounding);
            assert!((shape.support(&(n * 3.0)) - 3.0 * h).abs() <= 1e2 * rounding, "homogeneous");
            let sum = shape.support(&(n + last));
            let parts = h + shape.support(&last);
            assert!(sum <= parts + 1e-12 * size * (n.norm() + last.norm()), "convex");
            last = n;
            assert!((large.support(&n) - 16.0 * h).abs() <= 1e-6 * size * n.norm() * 16.0);
            let turned = posed.support(&(pose.rotation * n));
            let moved = h + (pose.rotation * n).dot(&pose.translation.vector);
            assert!((turned - moved).abs() <= 1e-9 * n.norm() * (1.0 + size));
        }
        let [tight_low, tight_high] = tight_bounds(&shape).unwrap();
        assert!(
            (tight_low - low).min() >= -1e-9 * size && (high - tight_high).min() >= -1e-9 * size
        );
    }
}

/// Bounds are the support points of the axes.
pub(super) fn tight<S: Implicit + SupportMap>(make: Make<S>) {
    for (case, shape) in shapes(make, 300) {
        let [low, high] = shape.bounds();
        let found = tight_bounds(&shape).unwrap();
        for (a, b) in found.iter().zip([low, high]) {
            assert!(
                (a - b).amax() <= 1e-12 * (high - low).norm(),
                "{case}: {found:?} {low} {high}"
            );
        }
    }
}

/// Volume, centre and inertia against one random point in each of many cells, within five standard deviations of that
/// sum; scaled and posed as they should be.
pub(super) fn mass<S: Implicit + MassProperties + Clone>(make: Make<S>) {
    const CELLS: usize = 40;
    for (case, shape) in shapes(make, 12) {
        let random = &mut Stream::new(53, case);
        let [low, high] = shape.bounds();
        let edge = (high - low) / CELLS as f64;
        let cell = edge.x * edge.y * edge.z;
        let (mut volume, mut first, mut second) = (0.0, Vector::zeros(), Matrix3::zeros());
        let mut last = [vec![false; CELLS * CELLS], vec![false; CELLS * CELLS]];
        let mut changes = 0;
        for i in 0..CELLS {
            for j in 0..CELLS * CELLS {
                let at = Vector::new(i as f64, (j / CELLS) as f64, (j % CELLS) as f64);
                let inside = at + Vector::from_fn(|_, _| random.uniform());
                let p = low + inside.component_mul(&edge);
                let contained = shape.contains(&p);
                // cells of which neighbours differ are those that the surface may cross
                let row = j % CELLS > 0 && last[1][j - 1] != contained;
                let column = j >= CELLS && last[1][j - CELLS] != contained;
                let layer = last[0][j] != contained;
                changes += usize::from(row) + usize::from(column) + usize::from(layer);
                last[1][j] = contained;
                if contained {
                    volume += cell;
                    first += p.coords * cell;
                    second += p.coords * p.coords.transpose() * cell;
                }
            }
            let [before, now] = &mut last;
            before.copy_from_slice(now);
            now.fill(false);
        }
        let error = 5.0 * (0.5 * cell) * (2.0 * changes as f64 + 100.0).sqrt();
        let found = shape.mass_properties(2.0);
        let half = (high - low) * 0.5 + nalgebra_center(&low, &high).coords.abs();
        assert!((found.mass / 2.0 - volume).abs() < error, "{case}: {found:?} {volume} {error}");
        let moment = found.centre.coords * (found.mass / 2.0);
        let inertia = found.inertia_about_origin() / 2.0;
        let truth = Matrix3::identity() * second.trace() - second;
        for i in 0..3 {
            let allowed = error * half[i];
            assert!((moment[i] - first[i]).abs() < allowed, "{case}: {found:?} {first}");
            for j in 0..3 {
                let allowed = error * if i == j { half.norm_squared() } else { half[i] * half[j] };
                let off = (inertia[(i, j)] - truth[(i, j)]).abs();
                assert!(off < 2.0 * allowed, "{case}: {inertia} {truth} {allowed}");
            }
        }
        assert_eq!(shape.mass_properties(0.0).mass, 0.0);
        let large = scaled(make, case, 2.0).mass_properties(2.0);
        assert!((large.mass / found.mass / 8.0 - 1.0).abs() < 1e-6, "{large:?} {found:?}");
        assert!((large.inertia / 32.0 - found.inertia).amax() < 1e-6 * found.inertia.amax());
        let pose = pose(random, 1.0);
        let moved = Posed::new(shape.clone(), pose).unwrap().mass_properties(2.0);
        assert!((moved.centre - pose * found.centre).norm() < 1e-12);
        let (a, b) = (moved.inertia.trace(), found.inertia.trace());
        assert!((a - b).abs() < 1e-9 * b && (moved.mass - found.mass).abs() <= 1e-12 * found.mass);
    }
}

fn nalgebra_center(a: &Point, b: &Point) -> Point {
    supersurface::nalgebra::center(a, b)
}
