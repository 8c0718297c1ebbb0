//! The Euclidean distance against brute force.

use supersurface::measure::ClosestFinder;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Superellipsoid, Supertoroid};
use supersurface::{Point, Vector};

/// Semi-axes up to 100:1 and exponents as the practice has them.
fn ellipsoid(random: &mut Stream) -> Superellipsoid {
    let axes = [0; 3].map(|_| (random.between(0.0, 100f64.ln())).exp() * 0.01);
    let exponents = [0; 2].map(|_| random.between(0.1, 1.95));
    Superellipsoid::new(axes, exponents).unwrap()
}

/// A point, every other one inside.
fn around(shape: &impl Implicit, inside: bool, random: &mut Stream) -> Point {
    let [low, high] = shape.bounds();
    loop {
        let size = if inside { 1.0 } else { 1.6 };
        let p = Point::from(Vector::from_fn(|k, _| {
            size * (low[k] + (high[k] - low[k]) * random.uniform())
        }));
        let p = if inside { p } else { p + (high - low) * (0.3 * random.between(-1.0, 1.0)) };
        if (shape.gauge(&p) < 1.0) == inside {
            return p;
        }
    }
}

/// The least distance to points of the surface on a fine grid: never under the true distance.
fn brute(shape: &impl Parametric, p: &Point, steps: usize) -> f64 {
    let [[e0, e1], [w0, w1]] = shape.domain();
    let mut least = f64::INFINITY;
    for i in 0..=steps {
        for j in 0..=steps {
            let share = |k: usize| k as f64 / steps as f64;
            let q = shape.point(e0 + (e1 - e0) * share(i), w0 + (w1 - w0) * share(j));
            least = least.min((q - p).norm_squared());
        }
    }
    least.sqrt()
}

#[test]
fn no_point_of_a_superellipsoid_is_nearer() {
    let mut random = Stream::new(21, 0);
    for case in 0..60 {
        let shape = ellipsoid(&mut random);
        let finder = ClosestFinder::superellipsoid(&shape);
        for k in 0..4 {
            let p = around(&shape, k % 2 == 0, &mut random);
            let found = finder.find(&p).unwrap();
            assert!((shape.gauge(&found.point) - 1.0).abs() < 1e-9, "case {case}");
            let least = brute(&shape, &p, 160);
            assert!(
                found.distance.abs() <= least * (1.0 + 1e-9),
                "case {case}: {shape:?} {p} {found:?} {least}"
            );
        }
    }
}

#[test]
fn no_point_of_a_supertoroid_is_nearer() {
    let mut random = Stream::new(22, 0);
    for case in 0..60 {
        let tube = ellipsoid(&mut random);
        let ring = random.between(1.0, 6.0);
        let shape = Supertoroid::new(tube.semi_axes(), ring, tube.exponents()).unwrap();
        let finder = ClosestFinder::supertoroid(&shape);
        for k in 0..4 {
            let p = around(&shape, k % 2 == 0, &mut random);
            let found = finder.find(&p).unwrap();
            let least = brute(&shape, &p, 160);
            assert!(
                found.distance.abs() <= least * (1.0 + 1e-9),
                "case {case}: {shape:?} {p} {found:?} {least}"
            );
        }
    }
}

#[test]
fn special_places_have_their_distance() {
    let body = Superellipsoid::new([1.0, 2.0, 3.0], [0.5, 1.4]).unwrap();
    let finder = ClosestFinder::superellipsoid(&body);
    for hard in [f64::NAN, f64::INFINITY, 1e200] {
        assert_eq!(finder.find(&Point::new(hard, 0.0, 0.0)), None);
    }
    for tiny in [0.0, 1e-320, 1e-200, 1e-12] {
        for p in [Point::new(tiny, 5.0, tiny), Point::new(tiny, -5.0, 0.0)] {
            let found = finder.find(&p).unwrap();
            assert!((found.distance - 3.0).abs() < 1e-9, "{p} {found:?}");
        }
        let found = finder.find(&Point::new(tiny, tiny, tiny)).unwrap();
        assert!(found.distance < -0.9 && found.distance > -1.0 - 1e-12, "{found:?}");
    }
    let far = finder.find(&Point::new(1e100, 1e100, 1e100)).unwrap();
    assert!(far.distance.is_finite() && far.distance > 1e100);
}
