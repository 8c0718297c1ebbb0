//! Pairs of members of all kinds, cut into slices: rings, tapered, twisted and bent bodies, and those that are whole.

#![allow(clippy::print_stdout)]

use std::env;
use std::f64::consts::PI;
use std::time::Instant;

use supersurface::contact::{Contact, Sliced, solids};
use supersurface::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Posed, Superellipsoid, Supertoroid};
use supersurface::surface::Solid;
use supersurface::{Point, Pose, Vector};

/// Of all kinds, with a size around 1.
fn solid(random: &mut Stream, kind: usize) -> Solid {
    let axes: [f64; 3] = [0; 3].map(|_| random.between(0.3, 1.0));
    let exponents = [0; 2].map(|_| random.between(0.1, 1.9));
    let core = || Solid::from(Superellipsoid::new(axes, exponents).unwrap());
    let slopes = [0; 2].map(|_| random.between(-0.8, 0.8));
    // up to a radian to each side, if that keeps the inner side
    let bent = |solid: Solid, random: &mut Stream| {
        let [low, high] = solid.bounds();
        let across = low.x.abs().max(high.x).hypot(low.y.abs().max(high.y));
        let curvature = random.between(0.2, 0.9) * (1.0 / axes[2]).min(1.0 / across);
        solid.bent(curvature, random.between(-PI, PI)).unwrap()
    };
    match kind {
        0 => core(),
        1 => {
            let ratio = random.between(1.2, 4.0);
            Solid::from(Supertoroid::new(axes.map(|a| 0.5 * a), ratio, exponents).unwrap())
        }
        2 => core().tapered(slopes).unwrap(),
        3 => core().twisted(random.between(-0.4, 0.4)).unwrap(),
        4 => bent(core(), random),
        5 => bent(core().tapered(slopes).unwrap(), random),
        _ => bent(
            core().tapered(slopes).unwrap().twisted(random.between(-0.3, 0.3)).unwrap(),
            random,
        ),
    }
}

const KINDS: usize = 7;
const NAMES: [&str; KINDS] =
    ["whole", "ring", "tapered", "twisted", "bent", "tapered bent", "all three"];

fn posed(random: &mut Stream, kind: usize, spread: f64) -> Sliced {
    let turn = Quaternion::new(random.normal(), random.normal(), random.normal(), random.normal());
    let place = Vector::from_fn(|_, _| random.between(-spread, spread));
    let pose = Pose::from_parts(Translation3::from(place), UnitQuaternion::new_normalize(turn));
    Sliced::new(&Posed::new(solid(random, kind), pose).unwrap()).unwrap()
}

fn moved(body: &Sliced, by: Vector) -> Sliced {
    let motion = Pose::translation(by.x, by.y, by.z);
    Sliced::new(&body.solid().moved(&motion)).unwrap()
}

/// Points of the surface in the world, at even angles of profile and section made round.
fn samples(body: &Sliced, count: usize) -> Vec<Point> {
    let solid = body.solid();
    let angle = |k: usize| -PI + 2.0 * PI * (k as f64 + 0.5) / count as f64;
    // the parameter of the point of a superellipse towards an angle
    let round = |angle: f64, exponent: f64| {
        let (s, c) = angle.sin_cos();
        let [s1, c1] = [s, c].map(|v| (v.abs().ln() / exponent).exp());
        let quarter = s1.atan2(c1);
        (if c < 0.0 { PI - quarter } else { quarter }).copysign(s)
    };
    let exponents = exponents_of(solid.shape());
    let ring = matches!(solid.shape(), Solid::Supertoroid(_));
    let pairs = (0..count * count).map(|k| (angle(k / count), angle(k % count)));
    pairs
        .map(|(eta, omega)| {
            let eta = if ring { eta } else { 0.5 * eta };
            solid.point(round(eta, exponents[0]), round(omega, exponents[1]))
        })
        .collect()
}

fn exponents_of(solid: &Solid) -> [f64; 2] {
    match solid {
        Solid::Superellipsoid(s) => s.exponents(),
        Solid::Supertoroid(s) => s.exponents(),
        Solid::Tapered(s) => exponents_of(s.shape()),
        Solid::Twisted(s) => exponents_of(s.shape()),
        Solid::Bent(s) => exponents_of(s.shape()),
        _ => [1.0; 2],
    }
}

/// The least distance of points of two surfaces, and the least gauge of a point in the other body.
fn by_samples(a: &Sliced, b: &Sliced, count: usize) -> (f64, f64) {
    let [of_a, of_b] = [samples(a, count), samples(b, count)];
    let gauge = |points: &[Point], solid: &Posed<Solid>| {
        points.iter().map(|p| solid.gauge(p)).fold(f64::INFINITY, f64::min)
    };
    let least = gauge(&of_a, b.solid()).min(gauge(&of_b, a.solid()));
    let tree = rstar::RTree::bulk_load(of_a.iter().map(|p| [p.x, p.y, p.z]).collect());
    let near = |p: &Point| {
        let q = tree.nearest_neighbor([p.x, p.y, p.z]).unwrap();
        (p - Point::from(*q)).norm()
    };
    (of_b.iter().map(near).fold(f64::INFINITY, f64::min), least)
}

fn check(contact: &Contact, a: &Sliced, b: &Sliced) {
    let case = || format!("{:?} {:?} {contact:?}", a.solid(), b.solid());
    let d = contact.distance;
    assert!(contact.bounds[0] <= d && d <= contact.bounds[1], "{}", case());
    let [p, q] = contact.witnesses;
    assert!((q - p - contact.normal.into_inner() * d).norm() < 1e-7, "{}", case());
    for (body, p) in [(a, p), (b, q)] {
        let off = body.solid().first_order_distance(&p);
        let gauge = body.solid().gauge(&p);
        assert!((gauge - 1.0).abs() < 1e-4 || off.abs() < 1e-5, "{gauge} {off} {}", case());
    }
}

/// `SUPERSURFACE_SLICED_PAIRS=1000 cargo test --release -p supersurface --test it members_are_as -- --nocapture`
#[test]
fn members_are_as_far_apart_as_dense_samples_say() {
    let count = env::var("SUPERSURFACE_SLICED_PAIRS").map_or(49, |n| n.parse().unwrap());
    let mut random = Stream::new(81, 0);
    let mut worst = 0f64;
    let mut times = vec![Vec::new(); 2];
    let mut widths = Vec::new();
    for k in 0..count {
        let kinds = [k % KINDS, k / KINDS % KINDS];
        let [a, b] = [(0, 0.0), (1, 2.5)].map(|(i, spread)| posed(&mut random, kinds[i], spread));
        let clock = Instant::now();
        let found = solids(&a, &b).unwrap();
        let took = clock.elapsed().as_secs_f64() * 1e3;
        times[usize::from(found.distance <= 0.0)].push(took);
        check(&found, &a, &b);
        let (sampled, gauge) = by_samples(&a, &b, 120);
        let case = || {
            format!(
                "{:?}: {:?} {:?} {found:?} {sampled}",
                kinds.map(|k| NAMES[k]),
                a.solid(),
                b.solid()
            )
        };
        if found.distance > 0.0 {
            assert!(gauge > 1.0 - 1e-9, "{gauge} {}", case());
            assert!(found.distance <= sampled + 1e-9, "{}", case());
            worst = worst.max(sampled - found.distance);
            widths.push(found.bounds[1] - found.bounds[0]);
        } else {
            assert!(gauge < 1.0 + 0.05 || sampled < 0.1, "{gauge} {}", case());
        }
    }
    times.iter_mut().for_each(|t| t.sort_by(f64::total_cmp));
    widths.sort_by(f64::total_cmp);
    let at = |t: &[f64], share: f64| {
        t.get(((t.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(0.0)
    };
    println!(
        "{count} pairs: samples at most {worst:.3} farther; bounds at most {:.1e} wide",
        at(&widths, 1.0)
    );
    for (name, t) in ["apart", "overlapping"].iter().zip(&times) {
        println!(
            "{} {name}: ms median {:.2} 90 % {:.2} most {:.2}",
            t.len(),
            at(t, 0.5),
            at(t, 0.9),
            at(t, 1.0)
        );
    }
    assert!(worst < 0.15, "{worst}");
}

/// `SUPERSURFACE_SLICED_PAIRS=300 cargo test --release -p supersurface --test it depths_of_members -- --nocapture`
#[test]
fn depths_of_members_part_them_and_nothing_shorter_does() {
    let count = env::var("SUPERSURFACE_SLICED_PAIRS").map_or(2, |n| n.parse().unwrap());
    let mut random = Stream::new(83, 0);
    let (mut times, mut widths, mut shorter, mut asked) = (Vec::new(), Vec::new(), 0, 0);
    let mut k = 0;
    while times.len() < count {
        k += 1;
        let kinds = [1 + random.index(KINDS - 1), random.index(KINDS)];
        let [a, b] = [(0, 0.0), (1, 1.2)].map(|(i, spread)| posed(&mut random, kinds[i], spread));
        let clock = Instant::now();
        let found = solids(&a, &b).unwrap();
        if found.distance >= 0.0 {
            continue;
        }
        times.push(clock.elapsed().as_secs_f64() * 1e3);
        let case = || {
            format!("{k} {:?}: {:?} {:?} {found:?}", kinds.map(|k| NAMES[k]), a.solid(), b.solid())
        };
        check(&found, &a, &b);
        let (depth, n) = (-found.distance, found.normal.into_inner());
        widths.push((found.bounds[1] - found.bounds[0]) / depth);
        let [of_a, of_b] = [samples(&a, 120), samples(&b, 120)];
        // the least gauge of a sample in the other body after a translation of the second
        let least = |by: Vector, every: usize| {
            let back = of_a.iter().step_by(every).map(|p| b.solid().gauge(&(p - by)));
            let there = of_b.iter().step_by(every).map(|p| a.solid().gauge(&(p + by)));
            back.chain(there).fold(f64::INFINITY, f64::min)
        };
        let gauge = least(n * (depth * (1.0 + 1e-6)), 1);
        assert!(gauge > 1.0 - 1e-8, "{gauge} {}", case());
        for _ in 0..100 {
            let way = Vector::from_fn(|_, _| random.normal()).normalize() * (0.98 * depth);
            if least(way, 7) < 1.0 || least(way, 1) < 1.0 {
                continue;
            }
            asked += 1;
            if solids(&a, &moved(&b, way)).unwrap().distance >= 0.0 {
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
         median {:.1}, 90 % {:.1}, most {:.1}; bounds in depths: median {:.3}, 90 % {:.3}, widest {:.3}",
        at(&times, 0.5),
        at(&times, 0.9),
        at(&times, 1.0),
        at(&widths, 0.5),
        at(&widths, 0.9),
        at(&widths, 1.0)
    );
    assert_eq!(shorter, 0, "shorter translations part");
}
