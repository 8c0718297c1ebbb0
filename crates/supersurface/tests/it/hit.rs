//! First hits of rays against brute force and closed forms.

use supersurface::measure::first_hit;
use supersurface::nalgebra::{Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Posed, Ray, Superellipsoid, Supertoroid};
use supersurface::surface::Surface;
use supersurface::{Direction, Point, Pose, Vector};

fn vector(stream: &mut Stream) -> Vector {
    Vector::new(stream.normal(), stream.normal(), stream.normal())
}

/// A random surface of about 0.1 m; every third is a toroid, and exponents reach 0.1 and 1.9.
fn surface(stream: &mut Stream, case: u64) -> Surface {
    let mut axis = || stream.between(0.02, 0.1);
    let axes = [axis(), axis(), axis()];
    let mut exponent = || if stream.uniform() < 0.2 { 0.1 } else { stream.between(0.1, 1.9) };
    let exponents = [exponent(), exponent()];
    if case.is_multiple_of(3) {
        let ratio = stream.between(1.2, 4.0);
        Surface::Supertoroid(Supertoroid::new(axes, ratio, exponents).unwrap())
    } else {
        Surface::Superellipsoid(Superellipsoid::new(axes, exponents).unwrap())
    }
}

/// A ray from around the shape at a point in its bounds; every fifth along an axis.
fn ray(stream: &mut Stream, shape: &Surface, case: u64) -> Ray {
    let half = Vector::from(shape.half_extents());
    let mut inside = || {
        let mut c = || stream.between(-1.0, 1.0);
        Point::from(half.component_mul(&Vector::new(c(), c(), c())))
    };
    let (target, start) = (inside(), inside());
    let towards = if case.is_multiple_of(5) { Vector::y() } else { vector(stream) };
    let direction = Direction::new_normalize(towards);
    let origin = if case.is_multiple_of(7) { start } else { target - direction.into_inner() * 1.0 };
    Ray { origin, direction }
}

#[test]
fn hits_agree_with_fine_marching() {
    let (mut hits, mut misses) = (0, 0);
    for case in 0..1500 {
        let mut stream = Stream::new(11, case);
        let shape = surface(&mut stream, case);
        let ray = ray(&mut stream, &shape, case);
        let inside = shape.contains(&ray.origin);
        let n = 20_000;
        let at = |i: usize| i as f64 * 2.0 / n as f64;
        let crossing = (1..=n).find(|i| shape.contains(&ray.at(at(*i))) != inside);
        let hit = first_hit(&shape, &ray, 2.0);
        match (hit, crossing) {
            (Some(hit), Some(i)) => {
                assert!(hit.distance <= at(i) + 1e-12, "case {case}: {} > {}", hit.distance, at(i));
                // marching may step over a corner, never the other way round
                let early = hit.distance < at(i - 1) - 1e-12;
                assert!(!early || shape.gauge(&hit.point) < 1.0 + 1e-9, "case {case}");
                assert!((shape.gauge(&hit.point) - 1.0).abs() < 1e-11, "case {case}");
                let out = hit.point + hit.normal.into_inner() * 1e-7;
                assert!(shape.gauge(&out) > 1.0, "case {case}");
                hits += 1;
            }
            (None, None) => misses += 1,
            (Some(hit), None) => {
                let deep = hit.point + ray.direction.into_inner() * 1e-4;
                assert!(!shape.contains(&deep), "case {case}: a hit where marching finds none");
            }
            (None, Some(i)) => panic!("case {case}: missed at {} of {shape:?} {ray:?}", at(i)),
        }
    }
    assert!(hits > 600 && misses > 100, "{hits} hits, {misses} misses");
}

#[test]
fn spheres_are_met_where_the_quadratic_says() {
    let ball = Superellipsoid::new([0.7; 3], [1.0; 2]).unwrap();
    for case in 0..2000 {
        let mut stream = Stream::new(5, case);
        let direction = Direction::new_normalize(vector(&mut stream));
        let ray = Ray { origin: Point::from(vector(&mut stream) * 2.0), direction };
        let b = ray.origin.coords.dot(&direction);
        let c = ray.origin.coords.norm_squared() - 0.49;
        let root = b * b - c;
        let first = if c <= 0.0 { -b + root.sqrt() } else { -b - root.max(0.0).sqrt() };
        let expected = (root >= 0.0 && first >= 0.0).then_some(first);
        let found = first_hit(&ball, &ray, f64::INFINITY).map(|h| h.distance);
        if root.abs() > 1e-9 {
            assert_eq!(found.is_some(), expected.is_some(), "case {case}");
        }
        if let (Some(found), Some(expected)) = (found, expected) {
            // grazing rays meet at the square root of the rounding
            assert!((found - expected).abs() < 1e-12 / root.sqrt().min(1.0), "case {case}");
        }
    }
}

#[test]
fn a_posed_shape_is_met_like_the_shape_in_its_frame() {
    for case in 0..500 {
        let mut stream = Stream::new(23, case);
        let shape = surface(&mut stream, case);
        let local = ray(&mut stream, &shape, case);
        let turn = UnitQuaternion::from_scaled_axis(vector(&mut stream));
        let pose = Pose::from_parts(Translation3::from(vector(&mut stream)), turn);
        let world = Ray { origin: pose * local.origin, direction: pose * local.direction };
        let posed = Posed::new(shape, pose).unwrap();
        let (a, b) = (first_hit(&shape, &local, 5.0), first_hit(&posed, &world, 5.0));
        if let (Some(a), Some(b)) = (a, b) {
            assert!((a.distance - b.distance).abs() < 1e-7, "case {case}: {a:?} {b:?}");
        }
    }
}

#[test]
fn boxes_are_met_on_their_faces() {
    let cube = Superellipsoid::new([0.03, 0.04, 0.05], [0.1, 0.1]).unwrap();
    for (x, y) in [(0.0, 0.0), (0.01, -0.02), (-0.02, 0.03)] {
        let ray = Ray { origin: Point::new(x, y, 0.6), direction: -Vector::z_axis() };
        let hit = first_hit(&cube, &ray, 1.0).unwrap();
        assert!((hit.point.z - 0.05).abs() < 1e-4 && hit.normal.z > 0.99, "{hit:?}");
    }
    let beside = Ray { origin: Point::new(0.0301, 0.0, 0.6), direction: -Vector::z_axis() };
    assert!(first_hit(&cube, &beside, 1.0).is_none());
}
