//! What the tests of every member ask: do the forms of a shape agree with each other?

use nalgebra::Matrix3;

use super::{Implicit, MassProperties, Parametric, SecondOrder, SupportMap};
use crate::numeric::random::Stream;
use crate::{Point, Vector};

/// Points of a box of half edges `a` around `centre`, off the coordinate planes.
pub(super) fn points(centre: [f64; 3], a: [f64; 3], count: u64) -> impl Iterator<Item = Point> {
    (0..count).map(move |i| {
        let mut random = Stream::new(5, i);
        Point::from(Vector::from_fn(|k, _| {
            let side = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
            centre[k] + side * a[k] * random.between(0.15, 1.0)
        }))
    })
}

/// The gradient is the central difference of the gauge, the second derivatives those of the gradient, and a
/// second derivative that is said to exist is finite.
pub(super) fn derivatives(shape: &impl SecondOrder, points: impl Iterator<Item = Point>) {
    for p in points.filter(|p| shape.gauge(p).is_finite()) {
        let gradient = shape.gradient(&p);
        let step = 1e-5 * p.coords.norm();
        let moved = |i: usize, s: f64| p + Vector::ith(i, s * step);
        let slopes = Vector::from_fn(|i, _| {
            (shape.gauge(&moved(i, 1.0)) - shape.gauge(&moved(i, -1.0))) / (2.0 * step)
        });
        assert!((gradient - slopes).norm() < 2e-6 * gradient.norm(), "{p}: {gradient} {slopes}");
        let Some(hessian) = shape.hessian(&p) else { continue };
        assert!((hessian - hessian.transpose()).amax() <= 1e-12 * hessian.amax());
        for i in 0..3 {
            let difference =
                (shape.gradient(&moved(i, 1.0)) - shape.gradient(&moved(i, -1.0))) / (2.0 * step);
            let error = (hessian.column(i) - difference).norm();
            let size = hessian.norm().max(gradient.norm() / p.coords.norm());
            assert!(error < 1e-5 * size, "{p}, {i}: {hessian} {difference}");
        }
    }
}

/// Parametric points lie on the surface, tangents are differences of points, and the normal stands on both
/// along the gauge's gradient.
pub(super) fn forms(shape: &(impl Implicit + Parametric)) {
    let [[from, to], [start, end]] = shape.domain();
    for i in 0..200 {
        let mut random = Stream::new(6, i);
        let (eta, omega) = (random.between(from, to), random.between(start, end));
        let p = shape.point(eta, omega);
        assert!((shape.gauge(&p) - 1.0).abs() < 1e-10, "{eta} {omega}: {}", shape.gauge(&p));
        let [along, around] = shape.tangents(eta, omega).unwrap();
        let h = 1e-6 * (to - eta).min(eta - from).min(end - omega).min(omega - start);
        let h = h.max(1e-9);
        let difference = [
            (shape.point(eta + h, omega) - shape.point(eta - h, omega)) / (2.0 * h),
            (shape.point(eta, omega + h) - shape.point(eta, omega - h)) / (2.0 * h),
        ];
        for (t, d) in [along, around].iter().zip(difference) {
            let size = t.norm() + 1e-9 * p.coords.norm() / h;
            assert!((t - d).norm() < 1e-3 * size, "{eta} {omega}: {t} {d}");
        }
        let (n, g) = (shape.normal(eta, omega).unwrap(), shape.gradient(&p));
        assert!(n.dot(&along).abs() < 1e-9 * along.norm(), "{eta} {omega}");
        assert!(n.dot(&around).abs() < 1e-9 * around.norm(), "{eta} {omega}");
        assert!((n.into_inner() - g.normalize()).norm() < 1e-8, "{eta} {omega}: {n:?} {g}");
    }
}

/// No NaN from points that break naive powers: zeros, subnormal numbers, huge numbers.
pub(super) fn extremes(shape: &impl SecondOrder) {
    let values = [0.0, 5e-324, 1e-300, 1e-9, 0.3, 1.0, 1e9, 1e300, f64::MAX, -0.5, -1e-320];
    for x in values {
        for y in values {
            for z in values {
                let p = Point::new(x, y, z);
                assert!(!shape.gauge(&p).is_nan(), "{p}");
                assert!(!shape.first_order_distance(&p).is_nan(), "{p}");
                assert!(shape.gradient(&p).iter().all(|v| v.is_finite()), "{p}");
                let finite = |h: Matrix3<f64>| h.iter().all(|v| v.is_finite());
                assert!(shape.hessian(&p).is_none_or(finite), "{p}");
            }
        }
    }
}

/// A support point lies on the surface, no point of the surface lies farther, and bounds are support points of
/// the axes.
pub(super) fn support(shape: &(impl Implicit + SupportMap)) {
    for i in 0..100 {
        let mut random = Stream::new(7, i);
        let n = Vector::from_fn(|_, _| random.normal());
        let s = shape.support_point(&n);
        assert!((shape.gauge(&s) - 1.0).abs() < 1e-9, "{n}: {s}");
        let h = shape.support(&n);
        for _ in 0..400 {
            // some directions near that of the support point, where the maximum is
            let far = if random.uniform() < 0.5 { 1.0 } else { 0.01 };
            let d = s.coords.normalize() + far * Vector::from_fn(|_, _| random.normal());
            let q = d / shape.gauge(&Point::from(d));
            assert!(n.dot(&q) <= h + 1e-12 * n.norm() * q.norm(), "{n}: {q} beyond {s}");
        }
    }
    let [low, high] = shape.bounds();
    for i in 0..3 {
        let axis = Vector::ith(i, 1.0);
        assert!((shape.support(&axis) - high[i]).abs() < 1e-12 * high[i]);
        assert!((shape.support(&-axis) + low[i]).abs() < 1e-12 * high[i]);
    }
    assert!(shape.gauge(&shape.support_point(&Vector::zeros())) < 1.0 + 1e-9);
    let wild = [0.0, 5e-324, 1e300, f64::INFINITY, -1.0];
    for (x, y, z) in wild.iter().flat_map(|x| wild.map(|y| (*x, y, 0.7 * y * *x))) {
        let n = Vector::new(x, y, if z.is_nan() { 0.0 } else { z });
        assert!(shape.support_point(&n).iter().all(|v| v.is_finite()), "{n}");
    }
}

/// Mass properties of density 2 against sums over the cells of a fine grid.
pub(super) fn mass(shape: &(impl Implicit + MassProperties), relative: f64) {
    const CELLS: usize = 120;
    let [low, high] = shape.bounds();
    let edge = (high - low) / CELLS as f64;
    let cell = edge.x * edge.y * edge.z * 2.0;
    let (mut mass, mut first, mut second) = (0.0, Vector::zeros(), Matrix3::zeros());
    for i in 0..CELLS.pow(3) {
        let at = [i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS].map(|k| k as f64 + 0.5);
        let p = low + Vector::from(at).component_mul(&edge);
        if shape.contains(&p) {
            mass += cell;
            first += p.coords * cell;
            second += p.coords * p.coords.transpose() * cell;
        }
    }
    let centre = first / mass;
    second -= centre * centre.transpose() * mass;
    let inertia = Matrix3::identity() * second.trace() - second;
    let found = shape.mass_properties(2.0);
    let size = (high - low).norm();
    assert!((found.mass / mass - 1.0).abs() < relative, "{} {mass}", found.mass);
    assert!((found.centre.coords - centre).norm() < relative * size);
    assert!(
        (found.inertia - inertia).amax() < 2.0 * relative * inertia.amax(),
        "{found:?} {inertia}"
    );
}
