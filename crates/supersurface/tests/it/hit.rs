//! First hits of rays against brute force and closed forms.

use supersurface::combine::{Alpha, Blend, CombinedSolid};
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

/// A bead, a plate with five holes, a bracket with a fillet, a sieve of balls, and two bodies apart.
fn trees() -> Vec<CombinedSolid> {
    let block = |axes: [f64; 3], at: [f64; 3]| {
        let block = Superellipsoid::new(axes, [0.1, 0.1]).unwrap();
        CombinedSolid::new(Posed::new(block, Pose::translation(at[0], at[1], at[2])).unwrap())
    };
    let round = |axes: [f64; 3], e: [f64; 2], at: [f64; 3]| {
        let round = Superellipsoid::new(axes, e).unwrap();
        CombinedSolid::new(Posed::new(round, Pose::translation(at[0], at[1], at[2])).unwrap())
    };
    let drill = |x: f64, y: f64| round([0.012, 0.012, 0.2], [0.1, 1.0], [x, y, 0.0]);
    let bead = round([0.05; 3], [1.0; 2], [0.0; 3]);
    let bead = bead.difference(block([0.02, 0.02, 0.1], [0.0; 3]), Alpha::SMOOTH);
    let holes = [[0.0, 0.0], [0.05, 0.05], [-0.05, 0.05], [0.05, -0.05], [-0.05, -0.05]];
    let plate = block([0.1, 0.08, 0.02], [0.0; 3]);
    let plate = holes.iter().fold(plate, |p, [x, y]| p.difference(drill(*x, *y), Alpha::EXACT));
    let fillet = Blend::new(0.2, [0.4, 0.5]).unwrap();
    let bracket = block([0.1, 0.05, 0.015], [0.0; 3])
        .blend_union(block([0.015, 0.05, 0.08], [0.0; 3]), fillet);
    let ring = Supertoroid::new([0.02; 3], 3.0, [0.5, 1.0]).unwrap();
    let sieve = round([0.06; 3], [1.0; 2], [0.0; 3])
        .intersection(round([0.04; 3], [1.0; 2], [0.0; 3]).complement(), Alpha::SMOOTH)
        .union(CombinedSolid::new(ring), Alpha::new(0.5).unwrap());
    let apart = round([0.03; 3], [1.0; 2], [0.2, 0.0, 0.0])
        .union(block([0.03; 3], [-0.2, 0.0, 0.0]), Alpha::SMOOTH);
    vec![bead, plate, bracket, sieve, apart]
}

#[test]
fn trees_are_met_where_fine_marching_meets_them() {
    for (tree, solid) in trees().iter().enumerate() {
        let [low, high] = solid.bounds();
        let (middle, half) = (supersurface::nalgebra::center(&low, &high), (high - low) * 0.5);
        let (mut hits, mut misses, mut thin) = (0, 0, 0);
        for case in 0..1000 {
            let stream = &mut Stream::new(29 + tree as u64, case);
            let mut inside =
                || middle + half.component_mul(&Vector::from_fn(|_, _| stream.between(-1.0, 1.0)));
            let (target, start) = (inside(), inside());
            let towards = if case % 5 == 0 { Vector::y() } else { vector(stream) };
            let direction = Direction::new_normalize(towards);
            let origin = if case % 7 == 0 { start } else { target - direction.into_inner() };
            let ray = Ray { origin, direction };
            let n = 8000;
            let at = |i: usize| i as f64 * 2.0 / n as f64;
            let begun = solid.contains(&ray.origin);
            let changed = |i: usize| solid.contains(&ray.at(at(i))) != begun;
            let crossing = (1..=n).find(|i| changed(*i));
            match (first_hit(solid, &ray, 2.0), crossing) {
                (Some(hit), Some(i)) => {
                    let gauge = solid.gauge(&hit.point);
                    assert!((gauge - 1.0).abs() < 1e-9, "{tree} {case}: {gauge}");
                    let stay = (i..=n).find(|k| !changed(*k)).unwrap_or(n) - i;
                    let late = hit.distance > at(i) + 1e-12;
                    // a piece or a gap thinner than a fortieth of the way through the box may be passed
                    let allowed = at(stay) <= 2.0 * half.norm() / 40.0;
                    assert!(!late || allowed, "{tree} {case}: {} > {}", hit.distance, at(i));
                    thin += usize::from(late);
                    hits += 1;
                }
                (None, None) => misses += 1,
                // between two steps
                (Some(hit), None) => {
                    assert!((solid.gauge(&hit.point) - 1.0).abs() < 1e-9, "{tree} {case}");
                }
                (None, Some(i)) => {
                    let stay = (i..=n).find(|k| !changed(*k)).unwrap_or(n) - i;
                    assert!(at(stay) <= 2.0 * half.norm() / 40.0, "{tree} {case}: missed {i}");
                    thin += 1;
                }
            }
        }
        assert!(hits > 250 && hits + misses > 950, "{tree}: {hits} hits, {misses} misses");
        assert!(thin <= 10, "{tree}: {thin} thin pieces passed");
    }
}
