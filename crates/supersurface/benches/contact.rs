//! Microseconds of the queries of convex bodies, on one core: pairs apart and overlapping, cold and warm, certified, with
//! derivatives; rings and deformed bodies; and 1,000 bodies, by the tree of their boxes and by all pairs.
//!
//! `cargo bench -p supersurface --bench contact`; against peers: `compare/contact`.

#![allow(clippy::print_stdout)]

use std::hint::black_box;

use cpu_time::ProcessTime;
use supersurface::contact::{
    Convex, Sliced, WarmStart, certify, contacts, differentiate, intersect, pair, solids,
};
use supersurface::nalgebra::{Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Posed, Superellipsoid, Supertoroid};
use supersurface::surface::Solid;
use supersurface::{Pose, Vector};

/// What is done to a superellipsoid.
type Deform = fn(Solid) -> Solid;

const PAIRS: usize = 1_000;
const SLICED: usize = 10;
const BODIES: usize = 1_000;

fn pose(random: &mut Stream, place: Vector) -> Pose {
    let turn = Vector::from_fn(|_, _| random.normal());
    Pose::from_parts(Translation3::from(place), UnitQuaternion::from_scaled_axis(turn))
}

fn body(random: &mut Stream, place: Vector) -> Posed<Convex> {
    let axes = [0; 3].map(|_| random.between(0.3, 1.0));
    let exponents = [0; 2].map(|_| random.between(0.1, 1.9));
    let shape = Convex::new(Superellipsoid::new(axes, exponents).unwrap()).unwrap();
    Posed::new(shape, pose(random, place)).unwrap()
}

/// Mean microseconds of something done once for each of many, best of three.
fn timed<T>(count: usize, mut each: impl FnMut(usize) -> T) -> f64 {
    let once = |each: &mut dyn FnMut(usize) -> T| {
        let start = ProcessTime::now();
        (0..count).for_each(|k| drop(black_box(each(k))));
        start.elapsed().as_secs_f64() * 1e6 / count as f64
    };
    (0..3).map(|_| once(&mut each)).fold(f64::INFINITY, f64::min)
}

fn main() {
    let mut random = Stream::new(6, 0);
    for (name, apart) in [("apart", 3.0), ("overlapping", 0.6)] {
        let pairs: Vec<[Posed<Convex>; 2]> = (0..PAIRS)
            .map(|_| [0.0, apart].map(|x| body(&mut random, Vector::new(x, 0.0, 0.0))))
            .collect();
        let cold = timed(PAIRS, |k| pair(&pairs[k][0], &pairs[k][1], &mut WarmStart::default()));
        let mut starts = vec![WarmStart::default(); PAIRS];
        let warm = timed(PAIRS, |k| pair(&pairs[k][0], &pairs[k][1], &mut starts[k]));
        let yes = timed(PAIRS, |k| intersect(&pairs[k][0], &pairs[k][1]));
        let slopes =
            timed(PAIRS, |k| differentiate(&pairs[k][0], &pairs[k][1], &mut WarmStart::default()));
        let sure = timed(PAIRS / 10, |k| certify(&pairs[k][0], &pairs[k][1], 1e-6));
        println!(
            "{name:12} pair {cold:7.2} µs, same again {warm:7.2}, intersect {yes:7.2}, differentiate {slopes:7.2}, \
             certify to 1e-6 {sure:9.1}"
        );
    }
    let solid = |shape: Solid, place: Vector, random: &mut Stream| {
        Sliced::new(&Posed::new(shape, pose(random, place)).unwrap()).unwrap()
    };
    let core = |random: &mut Stream| Solid::from(*body(random, Vector::zeros()).shape().shape());
    let kinds: [(&str, Deform); 3] = [
        ("whole", |s| s),
        ("ring", |_| Solid::from(Supertoroid::new([0.3; 3], 2.5, [1.0; 2]).unwrap())),
        ("tapered and bent", |s| s.tapered([-0.3, -0.3]).unwrap().bent(0.4, 0.0).unwrap()),
    ];
    for (first, make_first) in &kinds[1..] {
        for (second, make_second) in &kinds {
            for (name, apart) in [("apart", 3.0), ("overlapping", 0.6)] {
                let pairs: Vec<[Sliced; 2]> = (0..SLICED)
                    .map(|_| {
                        let [a, b] = [core(&mut random), core(&mut random)];
                        let a = solid(make_first(a), Vector::zeros(), &mut random);
                        [a, solid(make_second(b), Vector::new(apart, 0.0, 0.0), &mut random)]
                    })
                    .collect();
                let took = timed(SLICED, |k| solids(&pairs[k][0], &pairs[k][1]));
                println!("{first} and {second}, {name}: {:.2} ms", 1e-3 * took);
            }
        }
    }
    let wide = 14.0;
    let many: Vec<Posed<Convex>> = (0..BODIES)
        .map(|_| {
            let place = Vector::from_fn(|_, _| random.between(-0.5 * wide, 0.5 * wide));
            body(&mut random, place)
        })
        .collect();
    let (mut found, mut all) = (0, 0);
    let by_tree = timed(1, |_| found = contacts(&many, 0.0).len());
    let by_pairs = timed(1, |_| {
        all = 0;
        for (k, a) in many.iter().enumerate() {
            all += many[k + 1..].iter().filter(|b| intersect(a, b)).count();
        }
    });
    println!(
        "{BODIES} bodies: {found} contacts in {:.1} ms of CPU; {all} by all pairs, {:.0} times as long",
        by_tree * 1e-3,
        by_pairs / by_tree
    );
}
