//! First hits of rays and nearest points against brute force.

use std::fmt::Debug;

use supersurface::measure::{NearestFinder, first_hit};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Ray};
use supersurface::{Direction, Point, Vector};

use super::members::Make;
use super::samples::{angles, around, region, shapes, surface_points};

/// A hit lies on the surface, not behind where fine marching finds one; a miss is a miss unless what was passed is
/// thinner than what the search promises.
pub(super) fn ray<S: Implicit>(make: Make<S>) {
    const STEPS: usize = 600;
    let (mut hits, mut misses) = (0, 0);
    for (case, shape) in shapes(make, 60) {
        let random = &mut Stream::new(61, case);
        let [low, high] = region(&shape);
        let length = 2.0 * (high - low).norm();
        for _ in 0..10 {
            let (a, b) = (around(&shape, random), around(&shape, random));
            let Some(direction) = Direction::try_new(b - a, 0.0) else { continue };
            let ray = Ray { origin: a, direction };
            let inside = shape.contains(&a);
            let at = |i: usize| i as f64 * length / STEPS as f64;
            let changed = |i: &usize| shape.contains(&ray.at(at(*i))) != inside;
            let crossing = (1..=STEPS).find(changed);
            match (first_hit(&shape, &ray, length), crossing) {
                (Some(hit), first) => {
                    let gauge = shape.gauge(&hit.point);
                    assert!((gauge - 1.0).abs() < 1e-9, "{case}: {hit:?} {gauge}");
                    assert!((ray.at(hit.distance) - hit.point).norm() == 0.0);
                    let last = first.map_or(length, at);
                    assert!(hit.distance <= last * (1.0 + 1e-12), "{case}: {hit:?} {last}");
                    hits += 1;
                }
                (None, Some(i)) => {
                    // how long it stays on the other side
                    let stay = (i..=STEPS).find(|k| !changed(k)).unwrap_or(STEPS) - i;
                    let thin = (stay as f64) * length / STEPS as f64;
                    assert!(thin < (high - low).norm() / 20.0, "{case}: missed at {}", at(i));
                    assert!(!shape.is_convex(), "{case}: missed at {} of a convex one", at(i));
                }
                (None, None) => misses += 1,
            }
        }
    }
    assert!(hits > 150 && hits + misses > 400, "{hits} hits and {misses} misses");
}

/// The found point lies on the surface at the distance that is said. Whether no one of many surface points is nearer,
/// and the distance.
fn beats<S: Implicit + Debug>(
    case: u64,
    finder: &NearestFinder<'_, S>,
    shape: &S,
    p: &Point,
    samples: &[Point],
) -> (bool, f64) {
    let found = finder.find(p).unwrap();
    let gauge = shape.gauge(&found.point);
    assert!((gauge - 1.0).abs() < 1e-8, "{case} {p}: {found:?} {gauge}");
    let distance = (found.point - p).norm();
    assert!((distance - found.distance.abs()).abs() <= 1e-12 * distance);
    assert_eq!(found.distance < 0.0, shape.gauge(p) < 1.0 && distance > 0.0);
    let least = samples.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
    (distance <= least * (1.0 + 1e-7), distance)
}

fn points(shape: &impl Implicit, random: &mut Stream) -> [Point; 4] {
    let [low, high] = region(shape);
    let middle = supersurface::nalgebra::center(&low, &high);
    let on_axis = middle + Vector::ith(random.index(3), random.between(-1.0, 1.0));
    [around(shape, random), around(shape, random), middle, on_axis]
}

/// Of a thousand nearest points so many may not be the nearest. The search promises none: on spikes and cones of
/// exponents over 2 it follows what its starts show.
const MISSED: usize = 15;
/// The same of surfaces without end, where the grid covers a part only.
const MISSED_OF_ENDLESS: usize = 30;

/// By a grid over the angles.
pub(super) fn nearest<S: Implicit + Parametric + Debug>(make: Make<S>) {
    by_angles(make, 3);
}

/// By a grid over the part of a surface without end.
pub(super) fn nearest_of_endless<S: Implicit + Parametric + Debug>(make: Make<S>) {
    by_angles(make, MISSED_OF_ENDLESS);
}

fn by_angles<S: Implicit + Parametric + Debug>(make: Make<S>, missed: usize) {
    let (mut best, mut all) = (0, 0);
    for (case, shape) in shapes(make, 60) {
        let random = &mut Stream::new(62, case);
        let mut samples = surface_points(&shape, random, 200);
        samples.extend((0..800).map(|_| {
            let [eta, omega] = angles(&shape, random);
            shape.point(eta, omega)
        }));
        let finder = NearestFinder::of_surface(&shape);
        for p in points(&shape, random) {
            let (nearest, whole) = beats(case, &finder, &shape, &p, &samples);
            best += usize::from(nearest);
            all += 1;
            let (cut, [eta, omega]) = finder.find_on_patch(&p).unwrap();
            assert!((shape.point(eta, omega) - cut.point).norm() == 0.0);
            assert!(whole <= cut.distance.abs() * (1.0 + 1e-7), "{case} {p}: {whole} {cut:?}");
        }
    }
    assert!((all - best) * 1000 <= missed * all && all > 150, "{best} of {all} are the nearest");
}

/// By rays alone.
pub(super) fn nearest_solid<S: Implicit + Debug>(make: Make<S>) {
    let (mut best, mut all) = (0, 0);
    for (case, shape) in shapes(make, 60) {
        let random = &mut Stream::new(63, case);
        let samples = surface_points(&shape, random, 1000);
        let finder = NearestFinder::of_solid(&shape);
        for p in points(&shape, random) {
            best += usize::from(beats(case, &finder, &shape, &p, &samples).0);
            all += 1;
        }
    }
    assert!((all - best) * 1000 <= MISSED * all && all > 150, "{best} of {all} are the nearest");
}
