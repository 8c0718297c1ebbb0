//! A million inputs a shape: random ones, zeros, subnormal and huge numbers, NaN and infinities in any mixture, for
//! shapes of any size. Nothing panics, finite inputs give no NaN, and no point that is not finite is called inside.

use supersurface::measure::{NearestFinder, first_hit};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Ray, SecondOrder, SupportMap};
use supersurface::{Direction, Point, Vector};

use super::members::Make;

const SCALES: [f64; 8] = [1.0, 1e-3, 1e3, 1e-150, 1e150, 1e-305, 1e300, 1e-320];
const VALUES: [f64; 16] = [
    0.0,
    -0.0,
    5e-324,
    -1e-320,
    1e-308,
    1e-200,
    -1e-30,
    1e-8,
    0.5,
    -1.0,
    1e8,
    1e30,
    -1e200,
    1e308,
    f64::MIN,
    2.0,
];
const WILD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Shapes of all sizes that exist, one for each 10000 inputs.
fn all_sizes<S>(make: Make<S>, shapes: u64) -> impl Iterator<Item = S> {
    let sizes = (0..20 * shapes).filter_map(move |case| {
        let scale = SCALES[(case % SCALES.len() as u64) as usize];
        make(&mut Stream::new(102, case / 2), scale).ok()
    });
    sizes.take(shapes as usize)
}

/// A number of a kind; `wild` allows those that are not finite.
fn number(random: &mut Stream, wild: bool) -> f64 {
    match random.index(4) {
        0 => VALUES[random.index(VALUES.len())],
        // any bits, of which one in 2048 is not finite
        1 => Some(f64::from_bits(random.bits())).filter(|v| wild || v.is_finite()).unwrap_or(1.0),
        2 if wild && random.uniform() < 0.1 => WILD[random.index(3)],
        _ => random.normal(),
    }
}

fn point(random: &mut Stream, wild: bool) -> Point {
    Point::from(Vector::from_fn(|_, _| number(random, wild)))
}

fn finite<'a>(values: impl IntoIterator<Item = &'a f64>) -> bool {
    values.into_iter().all(|v| v.is_finite())
}

/// Gauge, gradient, first-order distance, rays and nearest points.
pub(super) fn point_extremes<S: Implicit>(make: Make<S>) {
    with_points(make, 0.0);
}

/// The same of gauges that may fall under 0 inside.
pub(super) fn point_extremes_of_combined<S: Implicit>(make: Make<S>) {
    with_points(make, -100.0);
}

fn with_points<S: Implicit>(make: Make<S>, least: f64) {
    let mut made = 0;
    for (index, shape) in all_sizes(make, 100).enumerate() {
        made += 1;
        let random = &mut Stream::new(71, index as u64);
        let [low, high] = shape.bounds();
        assert!((0..3).all(|k| low[k] <= high[k]), "{low} {high}");
        let finder = NearestFinder::of_solid(&shape);
        for i in 0..10_000 {
            let p = point(random, true);
            let gauge = shape.gauge(&p);
            if !finite(p.iter()) {
                assert!(!shape.contains(&p), "{p} is inside: {gauge}");
                // a solid without bounds may go on to where the point is
                let endless = low.x.is_infinite();
                assert!(endless || gauge.is_nan() || gauge > 1.0, "{p}: {gauge}");
                continue;
            }
            assert!(gauge >= least, "{p}: {gauge}");
            if i % 2 == 0 {
                let gradient = shape.gradient(&p);
                assert!(finite(gradient.iter()), "{p}: {gradient}");
            }
            if i % 8 == 0 {
                assert!(!shape.first_order_distance(&p).is_nan(), "{p}");
                let n = point(random, false).coords;
                assert!(!shape.extent(&n).is_nan(), "{n}");
            }
            if i % 100 == 0 {
                let Some(direction) = Direction::try_new(point(random, false).coords, 0.0) else {
                    continue;
                };
                if !finite(direction.iter()) {
                    continue;
                }
                let max = number(random, true).abs();
                if let Some(hit) = first_hit(&shape, &Ray { origin: p, direction }, max) {
                    let numbers = hit.point.iter().chain(hit.normal.iter()).chain([&hit.distance]);
                    assert!(finite(numbers) && hit.distance <= max, "{p}: {hit:?}");
                }
            }
            let found = (i % 5000 == 0).then(|| finder.find(&p)).flatten();
            assert!(
                found.is_none_or(|f| finite(f.point.iter().chain([&f.distance]))),
                "{p}: {found:?}"
            );
        }
        for wild in WILD {
            let ray = Ray { origin: Point::new(wild, 0.0, 0.0), direction: Vector::x_axis() };
            assert!(first_hit(&shape, &ray, 1.0).is_none());
            assert!(finder.find(&Point::new(0.0, wild, 0.0)).is_none());
        }
    }
    assert!(made == 100, "{made} shapes");
}

/// Second derivatives that are said to exist are finite.
pub(super) fn hessian_extremes<S: SecondOrder>(make: Make<S>) {
    for (index, shape) in all_sizes(make, 40).enumerate() {
        let random = &mut Stream::new(72, index as u64);
        for _ in 0..5000 {
            let p = point(random, true);
            let hessian = shape.hessian(&p);
            if finite(p.iter()) {
                assert!(hessian.is_none_or(|h| finite(h.iter())), "{p}: {hessian:?}");
            }
        }
    }
}

/// Points are numbers for finite angles; tangents and normals that exist are finite, for any angle.
pub(super) fn surface_extremes<S: Parametric + std::fmt::Debug>(make: Make<S>) {
    for (index, shape) in all_sizes(make, 40).enumerate() {
        let random = &mut Stream::new(73, index as u64);
        let domain = shape.domain();
        assert!(finite(domain.as_flattened()));
        for i in 0..5000 {
            let [mut eta, mut omega] = [0; 2].map(|_| number(random, true));
            if i % 2 == 0 {
                [eta, omega] = domain.map(|[from, to]| random.between(from, to));
            }
            let p = shape.point(eta, omega);
            if eta.is_finite() && omega.is_finite() {
                assert!(p.iter().all(|v| !v.is_nan()), "{shape:?} {eta} {omega}: {p}");
            }
            let tangents = shape.tangents(eta, omega);
            assert!(
                tangents.is_none_or(|t| finite(t.iter().flat_map(|t| t.iter()))),
                "{eta} {omega}"
            );
            let unit = |n: &Direction| (n.norm() - 1.0).abs() < 1e-12;
            let normal = shape.normal(eta, omega);
            assert!(normal.as_ref().is_none_or(unit), "{eta} {omega}: {normal:?}");
        }
    }
}

/// Any vector has a finite support point.
pub(super) fn support_extremes<S: SupportMap>(make: Make<S>) {
    for (index, shape) in all_sizes(make, 40).enumerate() {
        let random = &mut Stream::new(74, index as u64);
        for _ in 0..5000 {
            let n = point(random, true).coords;
            let s = shape.support_point(&n);
            assert!(!finite(n.iter()) || finite(s.iter()), "{n}: {s}");
        }
    }
}
