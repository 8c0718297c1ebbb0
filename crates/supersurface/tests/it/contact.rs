//! Pairs of convex bodies: random ones with known distances, odd ones, derivatives, and a second method.

#![allow(clippy::print_stdout)]

use std::env;

use supersurface::contact::{
    Contact, Convex, WarmStart, certify, common_point, contacts, differentiate, intersect, pair,
};
use supersurface::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Posed, Superellipsoid, SupportMap};
use supersurface::{Direction, Point, Pose, Vector};

pub(crate) fn direction(random: &mut Stream) -> Direction {
    Direction::new_normalize(Vector::from_fn(|_, _| random.normal()))
}

/// A body with exponents 0.1 to 1.9 and axis ratios up to 20, of a size around 1, somewhere.
pub(crate) fn body(random: &mut Stream) -> Posed<Convex> {
    let ratio = random.between(0.0, 20f64.ln()).exp();
    let middle = random.between(0.0, 1.0);
    let mut axes = [1.0, ratio.powf_in(middle), ratio];
    axes.rotate_left(random.index(3));
    let scale = random.between(0.5, 2.0) / ratio;
    let shape = Superellipsoid::new(
        axes.map(|a| a * scale),
        [random.between(0.1, 1.9), random.between(0.1, 1.9)],
    );
    let turn = Quaternion::new(random.normal(), random.normal(), random.normal(), random.normal());
    let place = Vector::from_fn(|_, _| random.between(-1.0, 1.0));
    let pose = Pose::from_parts(Translation3::from(place), UnitQuaternion::new_normalize(turn));
    Posed::new(Convex::new(shape.unwrap()).unwrap(), pose).unwrap()
}

/// `ratio^t` without the forbidden power.
trait Share {
    fn powf_in(self, t: f64) -> f64;
}

impl Share for f64 {
    fn powf_in(self, t: f64) -> f64 {
        (t * self.ln()).exp()
    }
}

fn support(body: &Posed<Convex>, n: &Vector) -> Vector {
    let local = body.pose().rotation.inverse() * n;
    (body.pose() * body.shape().shape().support_point(&local)).coords
}

fn size(bodies: &[Posed<Convex>; 2]) -> f64 {
    let largest = |b: &Posed<Convex>| b.shape().shape().semi_axes().into_iter().fold(0.0, f64::max);
    0.5 * (largest(&bodies[0]) + largest(&bodies[1]))
}

pub(crate) fn moved(body: &Posed<Convex>, by: Vector) -> Posed<Convex> {
    body.moved(&Pose::translation(by.x, by.y, by.z))
}

/// The larger gauge of a point.
fn gauge(bodies: &[Posed<Convex>; 2], p: &Point) -> f64 {
    bodies.iter().map(|b| b.shape().shape().gauge(&b.to_local(p))).fold(0.0, f64::max)
}

/// Two bodies whose faces along a random normal are `gap` sizes apart: for a positive gap, their distance.
fn placed(random: &mut Stream, gap: f64) -> ([Posed<Convex>; 2], f64) {
    let bodies = [body(random), body(random)];
    let n = direction(random).into_inner();
    let gap = gap * size(&bodies);
    let shift = support(&bodies[0], &n) - support(&bodies[1], &-n) + n * gap;
    ([bodies[0], moved(&bodies[1], shift)], gap)
}

/// Signed distance along one direction: never more than the true one.
fn separation(bodies: &[Posed<Convex>; 2], n: &Vector) -> f64 {
    n.dot(&(support(&bodies[1], &-n) - support(&bodies[0], n)))
}

/// The closest point of `B - A` to the origin by Gilbert's algorithm with the segment of its last two support points
/// replaced by triangles: a plain GJK on the support points of `shape`, which share no code with the kernels.
fn gilbert(bodies: &[Posed<Convex>; 2]) -> [f64; 2] {
    let vertex = |n: &Vector| support(&bodies[1], &-n) - support(&bodies[0], n);
    let mut simplex = vec![vertex(&Vector::x())];
    let mut nearest = simplex[0];
    let mut low = f64::NEG_INFINITY;
    for _ in 0..2_000 {
        let distance = nearest.norm();
        if distance < 1e-12 {
            return [low, 0.0];
        }
        let n = nearest / distance;
        let new = vertex(&n);
        low = f64::max(low, n.dot(&new));
        if distance - low < 1e-10 {
            break;
        }
        simplex.push(new);
        (nearest, simplex) = closest_of(&simplex);
        if simplex.len() == 4 {
            return [low, 0.0];
        }
    }
    [low, nearest.norm()]
}

/// The point of a simplex that is nearest to the origin, and the vertices that it lies between.
fn closest_of(simplex: &[Vector]) -> (Vector, Vec<Vector>) {
    let mut best = (f64::INFINITY, simplex[0], vec![simplex[0]]);
    for chosen in 1u32..1 << simplex.len() {
        let part: Vec<Vector> =
            (0..simplex.len()).filter(|i| chosen >> i & 1 == 1).map(|i| simplex[i]).collect();
        let Some(point) = inside(&part) else { continue };
        if point.norm() < best.0 {
            best = (point.norm(), point, part);
        }
    }
    (best.1, best.2)
}

/// The foot of the origin on the span of some points, if it lies between them.
fn inside(part: &[Vector]) -> Option<Vector> {
    let edges: Vec<Vector> = part[1..].iter().map(|v| v - part[0]).collect();
    let k = edges.len();
    if k == 0 {
        return Some(part[0]);
    }
    let gram = supersurface::nalgebra::DMatrix::from_fn(k, k, |i, j| edges[i].dot(&edges[j]));
    let right = supersurface::nalgebra::DVector::from_fn(k, |i, _| -edges[i].dot(&part[0]));
    let weights = gram.lu().solve(&right)?;
    let within = weights.iter().all(|w| *w >= 0.0) && weights.sum() <= 1.0;
    within.then(|| edges.iter().zip(weights.iter()).fold(part[0], |p, (e, w)| p + e * *w))
}

fn check_consistent(bodies: &[Posed<Convex>; 2], found: &Contact, size: f64) {
    let n = found.normal.into_inner();
    let case = || format!("{bodies:?} {found:?}");
    assert!(found.distance.is_finite() && (n.norm() - 1.0).abs() < 1e-12, "{}", case());
    assert!(found.bounds[0] <= found.distance && found.distance <= found.bounds[1], "{}", case());
    // a search that stalled says so by its bounds
    if found.distance > 0.0 && found.bounds[1] - found.bounds[0] > 1e-9 * size {
        return;
    }
    let [p, q] = found.witnesses;
    assert!((q - p - n * found.distance).norm() < 1e-8 * size, "{}", case());
    for (body, point) in bodies.iter().zip([p, q]) {
        let gauge = body.shape().shape().gauge(&body.to_local(&point));
        assert!((gauge - 1.0).abs() < 1e-5, "gauge {gauge} {}", case());
    }
}

#[test]
fn random_pairs_have_their_distance() {
    let count = if cfg!(debug_assertions) { 20_000 } else { 100_000 };
    let mut random = Stream::new(71, 0);
    let (mut wrong, mut worse, mut wide, mut apart) = (0, 0, 0, 0);
    for case in 0..count {
        let gap = match case % 4 {
            0 => random.between(0.1, 2.0),
            1 => random.between((1e-4f64).ln(), (1e-2f64).ln()).exp(),
            2 => -random.between((1e-4f64).ln(), (1e-2f64).ln()).exp(),
            _ => -random.between(0.02, 0.3),
        };
        let (bodies, gap) = placed(&mut random, gap);
        let size = size(&bodies);
        let found = pair(&bodies[0], &bodies[1], &mut WarmStart::default());
        check_consistent(&bodies, &found, size);
        let width = (found.bounds[1] - found.bounds[0]) / size;
        if gap > 0.0 {
            apart += 1;
            wrong += u32::from((found.distance - gap).abs() > 1e-9 * size);
            wide += u32::from(width > 1e-9);
            let slack = 1e-13 * size;
            assert!(found.bounds[0] <= gap + slack && gap <= found.bounds[1] + slack, "{found:?}");
        } else {
            // pushed together along one direction; another may be better, but none worse
            worse += u32::from(found.distance < gap - 1e-9 * size);
            assert!(width < 1.1e-3 || found.distance >= 0.0, "{width} {bodies:?}");
            for _ in 0..20 {
                let other = separation(&bodies, &direction(&mut random));
                assert!(other <= found.bounds[1] + 1e-13 * size, "{bodies:?} {found:?}");
            }
        }
    }
    assert!(f64::from(wrong) <= 1e-3 * f64::from(apart), "{wrong} of {apart} wrong");
    assert!(f64::from(worse) <= 1e-3 * f64::from(count - apart), "{worse} deeper than need be");
    assert!(f64::from(wide) <= 0.05 * f64::from(apart), "{wide} of {apart} wide");
    println!("{wrong} of {apart} wrong, {wide} with wide bounds; {worse} overlaps too deep");
}

/// `SUPERSURFACE_FUZZ_PAIRS=1000000 cargo test --release -p supersurface --test it two_methods -- --nocapture`
#[test]
fn two_methods_agree() {
    let count = env::var("SUPERSURFACE_FUZZ_PAIRS").map_or(2_000, |n| n.parse().unwrap());
    let mut random = Stream::new(72, 0);
    let mut worst = 0f64;
    for _ in 0..count {
        let gap = random.between(-0.2, 1.0);
        let (bodies, _) = placed(&mut random, gap);
        let size = size(&bodies);
        let found = pair(&bodies[0], &bodies[1], &mut WarmStart::default());
        let [low, high] = gilbert(&bodies);
        let slack = 1e-9 * size;
        assert!(found.distance >= low - slack, "{bodies:?} {found:?} {low}");
        assert!(found.distance.max(0.0) <= high + slack, "{bodies:?} {found:?} {high}");
        worst = worst.max((found.distance - low.max(found.bounds[0])) / size);
        if found.distance.abs() > 1e-9 * size {
            assert_eq!(intersect(&bodies[0], &bodies[1]), found.distance < 0.0, "{bodies:?}");
        }
    }
    println!("{count} pairs; at most {worst:.1e} above the other's bound");
}

#[test]
fn depths_are_those_of_the_exact_mode() {
    let mut random = Stream::new(73, 0);
    let mut other = 0;
    for case in 0..400 {
        let (bodies, _) = placed(&mut random, -0.01 - 0.002 * f64::from(case % 200));
        let size = size(&bodies);
        let found = pair(&bodies[0], &bodies[1], &mut WarmStart::default());
        let sure = certify(&bodies[0], &bodies[1], 1e-6 * size);
        assert!(sure.bounds[1] - sure.bounds[0] <= 1e-6 * size, "{bodies:?} {sure:?}");
        other += u32::from((found.distance - sure.distance).abs() > 1e-9 * size);
    }
    assert!(other <= 1, "{other} of 400 depths are other minima");
}

#[test]
fn a_warm_start_changes_nothing_but_time() {
    let mut others = 0;
    // one start for all: what other bodies left in it is of no use, and does no harm
    let mut start = WarmStart::default();
    for seed in 0..200 {
        let random = &mut Stream::new(31, seed);
        let gap = random.between(-0.8, 0.3);
        let (mut bodies, _) = placed(random, gap);
        let size = size(&bodies);
        let step = 10f64.powf_in(random.between(-4.0, -1.0));
        for _ in 0..10 {
            let turn = UnitQuaternion::from_scaled_axis(direction(random).into_inner() * step);
            let place = bodies[1].pose().translation.vector
                + direction(random).into_inner() * (step * size);
            let pose = Pose::from_parts(place.into(), turn * bodies[1].pose().rotation);
            bodies[1] = Posed::new(*bodies[1].shape(), pose).unwrap();
            let warm = pair(&bodies[0], &bodies[1], &mut start);
            let cold = pair(&bodies[0], &bodies[1], &mut WarmStart::default());
            check_consistent(&bodies, &warm, size);
            assert!(warm.bounds[0] <= cold.distance && cold.distance <= warm.bounds[1]);
            // of minima that are nearly as good either may be found
            others += usize::from((warm.distance - cold.distance).abs() > 1e-9 * size);
        }
    }
    assert!(others <= 4, "{others} of 2,000");
}

#[test]
fn bodies_that_overlap_have_a_common_point() {
    for seed in 0..1000 {
        let random = &mut Stream::new(32, seed);
        let gap = random.between(-0.5, 0.2);
        let gap = if seed % 3 == 0 { gap.signum() * 1e-6 } else { gap };
        let (bodies, _) = placed(random, gap);
        let found = pair(&bodies[0], &bodies[1], &mut WarmStart::default());
        let point = common_point(&bodies[0], &bodies[1], &found);
        assert_eq!(point.is_some(), found.distance < 0.0, "{bodies:?} {found:?}");
        assert!(point.is_none_or(|p| gauge(&bodies, &p) <= 1.0));
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    let mut random = Stream::new(75, 0);
    let mut checked = 0;
    for case in 0..300 {
        let (bodies, _) = placed(&mut random, if case % 2 == 0 { 0.3 } else { -0.03 });
        if bodies.iter().any(|b| b.shape().shape().exponents().iter().any(|e| *e < 0.2)) {
            continue;
        }
        let size = size(&bodies);
        let (_, derivatives) = differentiate(&bodies[0], &bodies[1], &mut WarmStart::default());
        let Some(derivatives) = derivatives else { continue };
        let distance = |bodies: [Posed<Convex>; 2]| {
            pair(&bodies[0], &bodies[1], &mut WarmStart::default()).distance
        };
        for which in 0..2 {
            let with = |body: Posed<Convex>| {
                let mut all = bodies;
                all[which] = body;
                distance(all)
            };
            let (body, found) = (&bodies[which], &derivatives[which]);
            let (axes, exponents) =
                (body.shape().shape().semi_axes(), body.shape().shape().exponents());
            let shaped = |axes: [f64; 3], exponents: [f64; 2]| {
                let shape = Superellipsoid::new(axes, exponents).unwrap();
                Posed::new(Convex::new(shape).unwrap(), *body.pose()).unwrap()
            };
            for k in 0..8 {
                // of fourth order in the step
                let at = |t: f64| match k {
                    0..3 => with(moved(body, Vector::ith(k, t))),
                    3..6 => {
                        let turn = UnitQuaternion::from_scaled_axis(Vector::ith(k - 3, t));
                        let pose = body.pose();
                        let turned = Pose::from_parts(pose.translation, turn * pose.rotation);
                        with(Posed::new(*body.shape(), turned).unwrap())
                    }
                    _ => {
                        let mut exponents = exponents;
                        exponents[k - 6] += t;
                        with(shaped(axes, exponents))
                    }
                };
                let slope =
                    |h: f64| (8.0 * (at(h) - at(-h)) - at(2.0 * h) + at(-2.0 * h)) / (12.0 * h);
                let truth = [1e-4, 1e-5, 1e-6].map(slope);
                let value = match k {
                    0..3 => found.translation[k],
                    3..6 => found.rotation[k - 3],
                    _ => found.exponents[k - 6],
                };
                let error = truth.map(|t| (t - value).abs()).into_iter().fold(f64::MAX, f64::min);
                assert!(error < 1e-6 * size.max(1.0), "{k} {error:e} {value} {truth:?} {bodies:?}");
            }
            for k in 0..3 {
                let at = |t: f64| {
                    let mut axes = axes;
                    axes[k] *= 1.0 + t;
                    with(shaped(axes, exponents))
                };
                let truth = (at(1e-6) - at(-1e-6)) / (2e-6 * axes[k]);
                assert!((truth - found.semi_axes[k]).abs() < 1e-6, "{truth} {found:?} {bodies:?}");
            }
            checked += 1;
        }
    }
    assert!(checked >= 300, "{checked} bodies checked");
}

#[test]
fn there_is_no_derivative_where_directions_are_equally_good() {
    let ball = Superellipsoid::new([1.0; 3], [1.0; 2]).unwrap();
    let centred = Posed::new(Convex::new(ball).unwrap(), Pose::identity()).unwrap();
    let (contact, derivatives) = differentiate(&centred, &centred, &mut WarmStart::default());
    assert!((contact.distance + 2.0).abs() < 1e-12 && derivatives.is_none());
    let cube = Superellipsoid::new([1.0; 3], [0.1; 2]).unwrap();
    let cube = Posed::new(Convex::new(cube).unwrap(), Pose::identity()).unwrap();
    let (contact, derivatives) = differentiate(&cube, &cube, &mut WarmStart::default());
    assert!((contact.distance + 2.0).abs() < 1e-9 && derivatives.is_none());
}

#[test]
fn sizes_and_places_may_be_extreme() {
    for (axes, far) in [(1e-9, 1e-9), (1e9, 1e9), (1e-9, 1e9), (1.0, 1e300), (1e-300, 1e300)] {
        for exponents in [[1e-6, 1e-6], [0.02, 0.02], [1.0, 1.0], [2.0, 2.0], [0.1, 2.0]] {
            let shape = Superellipsoid::new([axes, 2.0 * axes, 0.1 * axes], exponents).unwrap();
            let shape = Convex::new(shape).unwrap();
            let turn = UnitQuaternion::from_scaled_axis(Vector::new(0.3, 0.2, 0.5));
            let one = Posed::new(shape, Pose::from_parts(Translation3::identity(), turn)).unwrap();
            for x in [0.0, 1e-3 * axes, axes, far] {
                let other = Posed::new(shape, Pose::translation(x, -0.5 * x, 0.0)).unwrap();
                let found = pair(&one, &other, &mut WarmStart::default());
                let numbers = [found.distance, found.bounds[0], found.bounds[1]];
                assert!(numbers.iter().all(|v| v.is_finite()), "{exponents:?} {x} {found:?}");
                assert!(found.bounds[0] <= found.distance && found.distance <= found.bounds[1]);
            }
        }
    }
}

#[test]
fn contacts_of_many_bodies_are_those_of_all_pairs() {
    let mut random = Stream::new(77, 0);
    let bodies: Vec<Posed<Convex>> = (0..60)
        .map(|_| {
            let shift = Vector::from_fn(|_, _| random.between(-4.0, 4.0));
            moved(&body(&mut random), shift)
        })
        .collect();
    for within in [0.0, 0.3] {
        let mut expected = Vec::new();
        for i in 0..bodies.len() {
            for j in i + 1..bodies.len() {
                let found = pair(&bodies[i], &bodies[j], &mut WarmStart::default());
                if found.distance <= within {
                    expected.push(([i, j], found));
                }
            }
        }
        let found: Vec<_> =
            contacts(&bodies, within).iter().map(|n| (n.bodies, n.contact)).collect();
        assert!(found.len() > 10 && found == expected, "{} {}", found.len(), expected.len());
    }
    assert!(contacts(&[], 1.0).is_empty());
}
