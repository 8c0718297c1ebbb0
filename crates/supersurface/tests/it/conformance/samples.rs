//! What the checks share: random shapes, points around them, points on them, differences with their error.

use supersurface::measure::first_hit;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Ray};
use supersurface::{Direction, Point, Vector};

use super::members::Make;

/// Shapes of about unit size.
pub(super) fn shapes<S>(make: Make<S>, count: u64) -> impl Iterator<Item = (u64, S)> {
    // an empty or folded one now and then is no shape
    (0..count).filter_map(move |case| Some((case, make(&mut Stream::new(101, case), 1.0).ok()?)))
}

/// The shape of a case, `scale` times as large.
pub(super) fn scaled<S>(make: Make<S>, case: u64, scale: f64) -> S {
    make(&mut Stream::new(101, case), scale).unwrap()
}

/// The bounds; one and a half to each side of what has none.
pub(super) fn region(shape: &impl Implicit) -> [Point; 2] {
    let [low, high] = shape.bounds();
    let near = |v: f64| if v.is_finite() { v } else { 1.5f64.copysign(v) };
    [low.map(near), high.map(near)]
}

/// A point in 1.4 times the region.
pub(super) fn around(shape: &impl Implicit, random: &mut Stream) -> Point {
    let [low, high] = region(shape);
    let share = Vector::from_fn(|_, _| random.between(-0.2, 1.2));
    low + (high - low).component_mul(&share)
}

/// Points on the surface: first hits of rays through the region.
pub(super) fn surface_points(
    shape: &(impl Implicit + std::fmt::Debug),
    random: &mut Stream,
    count: usize,
) -> Vec<Point> {
    let [low, high] = region(shape);
    let (middle, half) = (supersurface::nalgebra::center(&low, &high), (high - low) * 0.5);
    let mut found = Vec::new();
    for _ in 0..60 * count {
        if found.len() >= count {
            break;
        }
        // half of the coordinates are drawn to the middle, where spikes and thin walls are
        let mut inside = || {
            let share = Vector::from_fn(|_, _| {
                let (s, drawn) = (random.between(-1.3, 1.3), random.uniform() < 0.5);
                if drawn { 0.3 * s * s * s * s * s } else { s }
            });
            middle + half.component_mul(&share)
        };
        let (a, b) = (inside(), inside());
        let Some(direction) = Direction::try_new(b - a, 0.0) else { continue };
        let hit = first_hit(shape, &Ray { origin: a, direction }, (b - a).norm());
        found.extend(hit.map(|hit| hit.point));
    }
    assert!(found.len() >= count / 4, "{} of {count} points on {shape:?}", found.len());
    found
}

/// Angles: any, on seams and poles, and a little off them.
pub(super) fn angles(shape: &impl Parametric, random: &mut Stream) -> [f64; 2] {
    shape.domain().map(|[from, to]| match random.index(6) {
        0 => from + (to - from) * random.index(9) as f64 / 8.0,
        1 => {
            let seam = from + (to - from) * random.index(9) as f64 / 8.0;
            let off = random.between(-14.0, -1.0) * 10f64.ln();
            (seam + if random.uniform() < 0.5 { off.exp() } else { -off.exp() }).clamp(from, to)
        }
        _ => random.between(from, to),
    })
}

/// Angles that are not near seams.
pub(super) fn free_angles(shape: &impl Parametric, random: &mut Stream) -> [f64; 2] {
    shape.domain().map(|[from, to]| {
        let eighth = (to - from) / 8.0;
        from + eighth * (random.index(8) as f64 + random.between(0.1, 0.9))
    })
}

/// A central difference and how far it is from one of another step.
pub(super) struct Difference {
    pub(super) slope: Vector,
    pub(super) error: f64,
}

/// The derivative of `f` at 0 by steps of `h`, extrapolated.
pub(super) fn difference(f: impl Fn(f64) -> Vector, h: f64) -> Difference {
    let [coarse, fine] = [h, 0.5 * h].map(|h| (f(h) - f(-h)) / (2.0 * h));
    Difference { slope: fine + (fine - coarse) / 3.0, error: (fine - coarse).norm() }
}
