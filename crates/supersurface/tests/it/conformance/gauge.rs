//! Gauge, gradient and second derivatives against differences; what a pose and a scale do to them.

use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Posed, SecondOrder};
use supersurface::{Point, Vector};

use super::members::{Make, pose};
use super::samples::{around, difference, region, scaled, shapes};

/// Steps and slopes in units of the region, so that all components count alike.
pub(super) fn gradient<S: Implicit + Clone>(make: Make<S>) {
    let (mut sharp, mut all) = (0, 0);
    for (case, shape) in shapes(make, 150) {
        let random = &mut Stream::new(11, case);
        let [low, high] = region(&shape);
        let edges = high - low;
        for _ in 0..20 {
            let p = around(&shape, random);
            let gauge = shape.gauge(&p);
            if !gauge.is_finite() {
                continue;
            }
            let gradient = shape.gradient(&p).component_mul(&edges);
            let found = Vector::from_fn(|k, _| {
                let along = |h: f64| {
                    let moved = p + Vector::ith(k, h * edges[k]);
                    Vector::new(shape.gauge(&moved), 0.0, 0.0)
                };
                let d = difference(along, 1e-4);
                if !d.slope.x.is_finite() {
                    return 0.0;
                }
                let (error, size) = ((gradient[k] - d.slope.x).abs(), gradient.norm());
                let allowed = 3.0 * d.error + 1e-6 * size + 1e-10 * gauge;
                assert!(error <= allowed, "{case} {p} {k}: {gradient} {} {}", d.slope.x, d.error);
                f64::from(d.error < 1e-3 * size)
            });
            sharp += usize::from(found == Vector::repeat(1.0));
            all += 1;
        }
        moves(make, case, &shape, random);
    }
    assert!(sharp * 10 > all * 8 && all > 1000, "{sharp} of {all} differences say something");
}

/// A turned shape has the same gauge and a turned gradient, a larger one the same gauge at larger points.
fn moves<S: Implicit + Clone>(make: Make<S>, case: u64, shape: &S, random: &mut Stream) {
    let pose = pose(random, 1.0);
    let posed = Posed::new(shape.clone(), pose).unwrap();
    let large = scaled(make, case, 16.0);
    for _ in 0..5 {
        let p = around(shape, random);
        let (gauge, gradient) = (shape.gauge(&p), shape.gradient(&p));
        if !gauge.is_finite() || !gradient.iter().all(|v| v.is_finite()) {
            continue;
        }
        let there = large.gauge(&(p * 16.0));
        assert!((there - gauge).abs() <= 1e-9 * gauge.max(1.0), "{case} {p}: {gauge} {there}");
        let slope = large.gradient(&(p * 16.0)) * 16.0;
        assert!((slope - gradient).norm() <= 1e-6 * gradient.norm(), "{case}: {gradient} {slope}");
        let q = pose * p;
        // the turn rounds the point by a few bits
        let lost = 1e-14 * gradient.norm() * (1.0 + q.coords.norm());
        let turned = posed.gauge(&q);
        assert!((turned - gauge).abs() <= 1e-8 * gauge.max(1.0) + lost, "{case}: {gauge} {turned}");
        let back = pose.rotation.inverse_transform_vector(&posed.gradient(&q));
        let direct = shape.gradient(&posed.to_local(&q));
        assert!((back - direct).norm() <= 1e-12 * direct.norm());
    }
    for p in [Point::origin(), Point::new(0.1, 0.0, 0.0)] {
        assert_eq!(posed.contains(&p), posed.gauge(&p) <= 1.0);
    }
}

/// Second derivatives: symmetric, those of the gradient, and there at nearly every point.
pub(super) fn hessian<S: SecondOrder + Clone>(make: Make<S>) {
    let (mut sharp, mut all) = (0, 0);
    for (case, shape) in shapes(make, 150) {
        let random = &mut Stream::new(12, case);
        let [low, high] = region(&shape);
        let edges = high - low;
        let pose = pose(random, 1.0);
        let posed = Posed::new(shape.clone(), pose).unwrap();
        let large = scaled(make, case, 16.0);
        for _ in 0..20 {
            let p = around(&shape, random);
            if !shape.gauge(&p).is_finite() {
                continue;
            }
            all += 1;
            let Some(hessian) = shape.hessian(&p) else { continue };
            assert!((hessian - hessian.transpose()).amax() <= 1e-10 * hessian.amax(), "{hessian}");
            let gradient = shape.gradient(&p).component_mul(&edges).norm();
            let h = hessian.component_mul(&(edges * edges.transpose()));
            let mut fine = true;
            for k in 0..3 {
                let along = |t: f64| {
                    shape.gradient(&(p + Vector::ith(k, t * edges[k]))).component_mul(&edges)
                };
                let d = difference(along, 1e-4);
                if !d.error.is_finite() {
                    fine = false;
                    continue;
                }
                let error = (h.column(k) - d.slope).norm();
                let size = h.norm().max(gradient);
                assert!(
                    error <= 3.0 * d.error + 1e-6 * size,
                    "{case} {p} {k}: {h} {} {}",
                    d.slope,
                    d.error
                );
                fine &= d.error < 1e-3 * size;
            }
            sharp += usize::from(fine);
            if let Some(other) = large.hessian(&(p * 16.0)) {
                let error = (other * 16.0 * 16.0 - hessian).norm();
                assert!(error <= 1e-4 * hessian.norm(), "{case} {p}: {hessian} {other}");
            }
            let turn = pose.rotation.to_rotation_matrix().into_inner();
            let direct = posed.to_local(&(pose * p));
            if let (Some(a), Some(b)) = (posed.hessian(&(pose * p)), shape.hessian(&direct)) {
                assert!((turn.transpose() * a * turn - b).norm() <= 1e-12 * b.norm());
            }
        }
    }
    assert!(sharp * 10 > all * 7 && all > 1000, "{sharp} of {all} differences say something");
}
