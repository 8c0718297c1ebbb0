//! A ring and a convex body: apart, one through the other's hole, and in each other.

#![allow(clippy::print_stdout)]

use std::env;
use std::f64::consts::PI;
use std::time::Instant;

use supersurface::contact::{Contact, Convex, Sliced, solids, sphere};
use supersurface::measure::ClosestFinder;
use supersurface::mesh::{Spacing, supertoroid_grid};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Posed, Superellipsoid, Supertoroid};
use supersurface::surface::Solid;
use supersurface::{Point, Pose, Vector};

use crate::contact::{body, direction, moved};

/// The contact of a ring with a body, from the ring to the body.
fn ring(torus: &Posed<Supertoroid>, body: &Posed<Convex>) -> Contact {
    let torus = Posed::new(Solid::from(*torus.shape()), *torus.pose()).unwrap();
    let body = Posed::new(Solid::from(*body.shape().shape()), *body.pose()).unwrap();
    solids(&Sliced::new(&torus).unwrap(), &Sliced::new(&body).unwrap()).unwrap()
}

#[test]
fn a_ball_is_as_far_from_a_ring_as_its_centre_less_the_radius() {
    let mut random = Stream::new(76, 0);
    for _ in 0..300 {
        let exponents = [random.between(0.1, 1.9), random.between(0.1, 1.9)];
        let ring = random.between(1.2, 5.0);
        let axes = [0; 3].map(|_| random.between(0.5, 2.0));
        let shape = Supertoroid::new(axes, ring, exponents).unwrap();
        let finder = ClosestFinder::supertoroid(&shape);
        let place = Pose::translation(0.3, -0.2, 0.7);
        let body = Posed::new(shape, place).unwrap();
        let centre = place * Point::from(Vector::from_fn(|_, _| random.between(-6.0, 6.0)));
        let radius = random.between(0.0, 2.0);
        let found = sphere(&body, &finder, &centre, radius).unwrap();
        let point = sphere(&body, &finder, &centre, 0.0).unwrap();
        assert!((found.distance - (point.distance - radius)).abs() < 1e-12, "{found:?}");
        // the point is on the surface, and no sampled one is nearer
        let [on_ring, on_ball] = found.witnesses;
        assert!((shape.gauge(&body.to_local(&on_ring)) - 1.0).abs() < 1e-7, "{shape:?} {found:?}");
        assert!(((on_ball - centre).norm() - radius).abs() < 1e-12, "{found:?}");
        for _ in 0..500 {
            let (eta, omega) = (random.between(-PI, PI), random.between(-PI, PI));
            let sample = (body.point(eta, omega) - centre).norm();
            assert!(sample >= point.distance.abs() - 1e-9, "{shape:?} {centre} {sample} {point:?}");
        }
    }
}

/// `SUPERSURFACE_RING_PAIRS=1000 cargo test --release -p supersurface --test it rings_are`
#[test]
fn rings_are_as_far_from_bodies_as_dense_samples_say() {
    let count = env::var("SUPERSURFACE_RING_PAIRS").map_or(60, |n| n.parse().unwrap());
    let mut random = Stream::new(78, 0);
    let (mut apart, mut overlapping) = (0, 0);
    for _ in 0..count {
        let exponents = [random.between(0.1, 1.9), random.between(0.1, 1.9)];
        let axes = [0; 3].map(|_| random.between(0.3, 1.0));
        let shape = Supertoroid::new(axes, random.between(1.2, 4.0), exponents).unwrap();
        let torus = Posed::new(shape, *body(&mut random).pose()).unwrap();
        let shift = Vector::from_fn(|_, _| random.between(-2.5, 2.5));
        let other = moved(&body(&mut random), shift);
        let found = ring(&torus, &other);
        let finder = ClosestFinder::superellipsoid(other.shape().shape());
        let near = |sample: &Point| finder.find(&other.to_local(sample)).unwrap().distance;
        let spacing = 0.05;
        let points = supertoroid_grid(&shape, Spacing::EqualArc, spacing).unwrap();
        let sampled =
            points.iter().map(|p| near(&(torus.pose() * p))).fold(f64::INFINITY, f64::min);
        match found.distance {
            d if d > 0.0 => {
                let contact = found;
                apart += 1;
                assert!(d <= sampled + 1e-9, "{d} {sampled} {torus:?} {other:?}");
                assert!(contact.bounds[0] <= d && d <= contact.bounds[1], "{contact:?}");
                let [p, q] = contact.witnesses;
                assert!(((q - p).norm() - d).abs() < 1e-7, "{contact:?}");
                let on_ring = shape.gauge(&torus.to_local(&p));
                let on_body = other.shape().shape().gauge(&other.to_local(&q));
                assert!((on_ring - 1.0).abs() < 1e-6, "{on_ring} {torus:?} {other:?}");
                assert!((on_body - 1.0).abs() < 1e-6, "{on_body} {torus:?} {other:?}");
            }
            _ => {
                overlapping += 1;
                // a body within the tube holds no point of its surface
                let inside = torus.gauge(&(other.pose() * Point::origin())) < 1.0;
                // outside of the circle on which the points are that far apart they are farther
                let widest =
                    4.0 * spacing * (shape.ring_ratio() + 1.0) / (shape.ring_ratio() - 1.0);
                assert!(sampled < widest.max(0.2) || inside, "{sampled} {torus:?} {other:?}");
            }
        }
    }
    assert!(apart > count / 5 && overlapping > count / 10, "{apart} {overlapping}");
}

/// A ring and a body somewhere about its tube or hole.
fn ring_and_body(random: &mut Stream) -> (Posed<Supertoroid>, Posed<Convex>) {
    let exponents = [random.between(0.1, 1.9), random.between(0.1, 1.9)];
    let axes = [0; 3].map(|_| random.between(0.3, 1.0));
    let shape = Supertoroid::new(axes, random.between(1.2, 4.0), exponents).unwrap();
    let torus = Posed::new(shape, *body(random).pose()).unwrap();
    let shift = Vector::from_fn(|_, _| random.between(-2.0, 2.0));
    (torus, moved(&body(random), shift))
}

/// Points of a ring's and of a body's surface, in their own frames.
struct Samples {
    of_ring: Vec<Point>,
    of_body: Vec<Point>,
}

impl Samples {
    fn new(torus: &Posed<Supertoroid>, body: &Posed<Convex>, count: u32) -> Self {
        let angle = |k: u32| -PI + 2.0 * PI * (f64::from(k) + 0.5) / f64::from(count);
        let pairs = || (0..count * count).map(|k| (angle(k / count), angle(k % count)));
        let (torus, body) = (torus.shape(), body.shape().shape());
        // directions of the tube and of the body, so that flat faces are covered as well as edges
        let of_ring = pairs().map(|(eta, omega)| {
            let [a, b, c] = torus.semi_axes();
            let [e1, e2] = torus.exponents();
            let tube = Superellipsoid::new([1.0, 1.0, 1.0], [e1, 1.0]).unwrap();
            let around = Superellipsoid::new([1.0, 1.0, 1.0], [1.0, e2]).unwrap();
            let [s, z] = [eta.cos(), eta.sin()];
            let g = tube.gauge(&Point::new(s, 0.0, z));
            let h = around.gauge(&Point::new(omega.cos(), omega.sin(), 0.0));
            let out = (torus.ring_ratio() + s / g) / h;
            Point::new(a * out * omega.cos(), b * out * omega.sin(), c * z / g)
        });
        let of_body = pairs().map(|(eta, omega)| {
            let [a, b, c] = body.semi_axes();
            let eta = 0.5 * eta;
            let way =
                Point::new(a * eta.cos() * omega.cos(), b * eta.cos() * omega.sin(), c * eta.sin());
            way / body.gauge(&way)
        });
        Self { of_ring: of_ring.collect(), of_body: of_body.collect() }
    }

    /// The least gauge of a sample in the other body: below 1 where the two overlap by as much as samples see.
    fn least_gauge(&self, torus: &Posed<Supertoroid>, body: &Posed<Convex>) -> f64 {
        let of_ring = self
            .of_ring
            .iter()
            .map(|p| body.shape().shape().gauge(&body.to_local(&(torus.pose() * p))));
        let of_body = self.of_body.iter().map(|p| torus.gauge(&(body.pose() * p)));
        of_ring.chain(of_body).fold(f64::INFINITY, f64::min)
    }
}

/// `SUPERSURFACE_RING_PAIRS=1000 cargo test --release -p supersurface --test it depths_of -- --nocapture`
#[test]
fn depths_of_bodies_in_rings_part_them_and_nothing_shorter_does() {
    let count = env::var("SUPERSURFACE_RING_PAIRS").map_or(8, |n| n.parse().unwrap());
    let mut random = Stream::new(79, 0);
    let mut times = Vec::new();
    let (mut widths, mut shorter, mut asked) = (Vec::new(), 0, 0);
    while times.len() < count {
        let (torus, other) = ring_and_body(&mut random);
        let clock = Instant::now();
        let found = ring(&torus, &other);
        if found.distance >= 0.0 {
            continue;
        }
        times.push(clock.elapsed().as_secs_f64() * 1e3);
        let depth = -found.distance;
        let n = found.normal.into_inner();
        let case = || format!("{torus:?} {other:?} {found:?}");
        assert!(found.bounds[0] <= -depth && -depth <= found.bounds[1], "{}", case());
        widths.push((found.bounds[1] - found.bounds[0]) / depth);
        let [p, q] = found.witnesses;
        assert!((q - p + n * depth).norm() < 1e-9, "{}", case());
        let samples = Samples::new(&torus, &other, 160);
        let apart = moved(&other, n * (depth * (1.0 + 1e-6)));
        let gauge = samples.least_gauge(&torus, &apart);
        assert!(gauge > 1.0 - 1e-9, "{gauge} {}", case());
        // the witnesses are on the surfaces
        let on_ring = torus.gauge(&p);
        let on_body = other.shape().shape().gauge(&other.to_local(&q));
        assert!((on_ring - 1.0).abs() < 1e-4, "{on_ring} {}", case());
        assert!((on_body - 1.0).abs() < 1e-4, "{on_body} {}", case());
        let few = Samples::new(&torus, &other, 40);
        for k in 0..=200 {
            let way = if k == 0 { found.normal } else { direction(&mut random) };
            let still = moved(&other, way.into_inner() * (0.98 * depth));
            if few.least_gauge(&torus, &still) < 1.0 || samples.least_gauge(&torus, &still) < 1.0 {
                continue;
            }
            asked += 1;
            if ring(&torus, &still).distance >= 0.0 {
                println!("{way:?} {}", case());
                shorter += 1;
                break;
            }
        }
    }
    times.sort_by(f64::total_cmp);
    widths.sort_by(f64::total_cmp);
    let at = |v: &[f64], share: f64| v[((v.len() - 1) as f64 * share) as usize];
    println!(
        "{count} overlaps, {shorter} with a shorter way, {asked} directions that samples left open; milliseconds: \
         median {:.1}, 99 % {:.1}, most {:.1}; bounds in depths: median {:.3}, 90 % {:.3}, widest {:.3}",
        at(&times, 0.5),
        at(&times, 0.99),
        at(&times, 1.0),
        at(&widths, 0.5),
        at(&widths, 0.9),
        at(&widths, 1.0)
    );
    assert_eq!(shorter, 0, "shorter translations part");
}

/// A ball as a body of its own; for another `exponent` than 1 almost one, which is not told by its closest point.
fn ball(centre: Point, radius: f64, exponent: f64) -> Posed<Convex> {
    let shape = Superellipsoid::new([radius; 3], [exponent; 2]).unwrap();
    let place = Pose::translation(centre.x, centre.y, centre.z);
    Posed::new(Convex::new(shape).unwrap(), place).unwrap()
}

#[test]
fn a_ball_in_a_ring_is_as_deep_as_its_closest_point_says() {
    let mut random = Stream::new(80, 0);
    let (mut checked, mut other, mut worst) = (0, 0, 0f64);
    while checked < 20 {
        let exponents = [random.between(0.1, 1.9), random.between(0.1, 1.9)];
        let axes = [0; 3].map(|_| random.between(0.5, 2.0));
        let shape = Supertoroid::new(axes, random.between(1.2, 5.0), exponents).unwrap();
        let torus = Posed::new(shape, Pose::translation(0.3, -0.2, 0.7)).unwrap();
        let finder = ClosestFinder::supertoroid(&shape);
        let centre = Point::from(Vector::from_fn(|_, _| random.between(-4.0, 4.0)));
        let radius = random.between(0.05, 2.0);
        let exact = sphere(&torus, &finder, &centre, radius).unwrap();
        let after = centre - exact.normal.into_inner() * exact.distance;
        // moved into touch it may be in another part of the ring: then it has to go farther
        let there = sphere(&torus, &finder, &after, radius).unwrap().distance;
        let told = ring(&torus, &ball(centre, radius, 1.0));
        let found = ring(&torus, &ball(centre, radius, 1.0 + 1e-10));
        let size = axes.into_iter().fold(0.0, f64::max) * (1.0 + shape.ring_ratio());
        assert!(
            found.distance <= exact.distance + 1e-9 * size,
            "{shape:?} {centre} {radius} {found:?} {exact:?}"
        );
        if exact.distance < 0.0 && there > -1e-9 * size {
            checked += 1;
            assert!((told.distance - exact.distance).abs() < 1e-12 * size, "{told:?} {exact:?}");
            let error = (found.distance - exact.distance).abs() / size;
            worst = worst.max(error);
            // another minimum that is nearly as good
            other += u32::from(error > 1e-9);
            let [low, high] = found.bounds;
            assert!(low <= exact.distance && exact.distance <= high, "{found:?} {exact:?}");
        }
    }
    println!(
        "by directions {other} of {checked} balls have another minimum, worst {worst:.1e} of the size"
    );
    assert!(other <= 2 && worst < 1e-3, "{other} {worst}");
}

#[test]
fn a_rod_in_the_hole_goes_from_apart_to_overlapping_without_a_jump() {
    let shape = Supertoroid::new([0.01; 3], 3.0, [1.0; 2]).unwrap();
    let torus = Posed::new(shape, Pose::identity()).unwrap();
    let rod = Superellipsoid::new([0.005, 0.005, 0.2], [0.1, 1.0]).unwrap();
    let rod = Convex::new(rod).unwrap();
    for x in [0.01, 0.0149, 0.014_999_99, 0.015, 0.015_000_01, 0.0151, 0.02] {
        let posed = Posed::new(rod, Pose::translation(x, 0.0, 0.0)).unwrap();
        let found = ring(&torus, &posed);
        let gap = 0.015 - x;
        assert!((found.distance - gap).abs() < 1e-11, "{x} {found:?}");
        assert!((found.normal.x - -1.0).abs() < 1e-6, "{x} {found:?}");
    }
}

#[test]
fn a_rod_that_two_walls_of_the_hole_hold_moves_into_the_corner_between() {
    // a square rod in a round hole: two edges touch at once, and no normal is common to both
    let shape = Supertoroid::new([0.01, 0.01, 0.01], 3.0, [1.0; 2]).unwrap();
    let torus = Posed::new(shape, Pose::identity()).unwrap();
    let rod = Superellipsoid::new([0.013, 0.013, 0.2], [0.01, 0.01]).unwrap();
    let posed = Posed::new(Convex::new(rod).unwrap(), Pose::translation(0.004, 0.0, 0.0)).unwrap();
    let found = ring(&torus, &posed);
    // the edges at (x + 0.013, ±0.013) reach the hole's wall, 0.02 from the middle
    let shift = 0.004 + 0.013 - (0.02f64.powi(2) - 0.013f64.powi(2)).sqrt();
    assert!((found.distance + shift).abs() < 1e-4, "{shift} {found:?}");
    assert!((found.normal.x + 1.0).abs() < 1e-3, "{found:?}");
}

#[test]
fn rings_and_bodies_may_be_extreme() {
    for scale in [1e-9, 1e9] {
        for exponents in [[0.02, 0.02], [0.02, 2.0], [2.0, 0.02], [2.0, 2.0], [1.0, 1.0]] {
            // of an octahedron's edges a query can take tens of seconds
            let slow = exponents.contains(&2.0) && env::var("SUPERSURFACE_RING_PAIRS").is_err();
            for ratio in if slow { vec![20.0] } else { vec![1.01, 20.0] } {
                let shape = Supertoroid::new([scale; 3], ratio, exponents).unwrap();
                let torus = Posed::new(shape, Pose::identity()).unwrap();
                let cases =
                    if ratio < 2.0 { vec![(0.3, ratio), (4.0, 0.0)] } else { vec![(0.3, 0.0)] };
                for (large, shift) in cases {
                    let axes = [large * scale, 0.5 * large * scale, large * scale];
                    let other = Superellipsoid::new(axes, exponents).unwrap();
                    let place = Pose::translation(shift * scale, 0.0, 0.0);
                    let other = Posed::new(Convex::new(other).unwrap(), place).unwrap();
                    let found = ring(&torus, &other);
                    let case = || format!("{torus:?} {other:?} {found:?}");
                    let [p, q] = found.witnesses;
                    let numbers = [found.distance, found.bounds[0], found.bounds[1]];
                    let all = numbers.iter().chain(p.coords.iter()).chain(q.coords.iter());
                    assert!(all.chain(found.normal.iter()).all(|v| v.is_finite()), "{}", case());
                    assert!(found.bounds[0] <= found.distance, "{}", case());
                    assert!(found.distance <= found.bounds[1], "{}", case());
                }
            }
        }
    }
}
