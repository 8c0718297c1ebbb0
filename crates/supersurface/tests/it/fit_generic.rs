//! Made clouds of members that the special fitter does not cover, recovered by the generic one.
//!
//! The whole table (some minutes; figures of single clouds with `--nocapture`):
//! `cargo test --release -p supersurface --test it -- --ignored --nocapture generic_table`

use supersurface::fit::FitError;
use supersurface::fit::generic::{
    GenericFit, GenericModel, GenericOptions, GenericShape, fit_generic,
};
use supersurface::mesh::{MarchOptions, Mesh, Resolution, march};
use supersurface::nalgebra::{Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{
    ExtendedSuperellipsoid, Hyperquadric, Implicit, Posed, Superformula, Supershape, Supertoroid,
};
use supersurface::surface::Solid;
use supersurface::{Point, Pose, Vector};

const POINTS: usize = 1500;
/// Standard deviation of the noise along each axis, in sizes.
const NOISE: f64 = 0.005;
/// A shape within this mean distance, in sizes, is recovered.
const RECOVERED: f64 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Class {
    Hyperquadric,
    Supershape,
    Extended,
    Tapered,
    Twisted,
    Bent,
    /// Tapered, twisted and bent.
    Deformed,
}

const CLASSES: [Class; 7] = [
    Class::Hyperquadric,
    Class::Supershape,
    Class::Extended,
    Class::Tapered,
    Class::Twisted,
    Class::Bent,
    Class::Deformed,
];

impl Class {
    /// A random member with the model that it belongs to; `None` for a body that is too thin or not one at all.
    fn draw(self, random: &mut Stream) -> Option<(GenericShape, GenericModel)> {
        let (shape, model) = match self {
            Self::Hyperquadric => {
                let terms = 4 + random.index(3);
                (
                    GenericShape::Hyperquadric(hyperquadric(terms, random)?),
                    GenericModel::Hyperquadric { terms },
                )
            }
            Self::Supershape => (solid(supershape(random)?), GenericModel::Supershape),
            Self::Extended => {
                let (profile, section) = (3 + random.index(2), 3 + random.index(3));
                let axes = std::array::from_fn(|_| random.between(0.4, 1.0));
                let mut values = |count: usize| -> Vec<f64> {
                    (0..count).map(|_| random.between(0.2, 1.7)).collect()
                };
                let shape = ExtendedSuperellipsoid::new(axes, &values(profile), &values(section));
                let shape = Solid::RadialExtended(Box::new(shape.ok()?.radial()));
                (solid(shape), GenericModel::Extended { profile, section })
            }
            Self::Tapered | Self::Twisted | Self::Bent | Self::Deformed => {
                let either = |class| self == class || self == Self::Deformed;
                let model = GenericModel::Toroid {
                    taper: either(Self::Tapered),
                    twist: either(Self::Twisted),
                    bend: either(Self::Bent),
                };
                (solid(toroid(model, random)?), model)
            }
        };
        let sides = sides(&shape);
        (sides.max() < 6.0 * sides.min()).then_some((shape, model))
    }
}

/// A ring with those deformations that a model has.
fn toroid(model: GenericModel, random: &mut Stream) -> Option<Solid> {
    let GenericModel::Toroid { taper, twist, bend } = model else { return None };
    let axes = std::array::from_fn(|_| random.between(0.2, 0.6));
    let exponents = [random.between(0.2, 1.6), random.between(0.2, 1.6)];
    let ring = random.between(1.5, 4.0);
    let mut shape = Solid::from(Supertoroid::new(axes, ring, exponents).ok()?);
    let mut signed = |low: f64, high: f64| {
        let v = random.between(low, high);
        if random.uniform() < 0.5 { -v } else { v }
    };
    if taper {
        shape = shape.tapered([signed(0.1, 0.7), signed(0.1, 0.7)]).ok()?;
    }
    if twist {
        shape = shape.twisted(signed(0.03, 0.15)).ok()?;
    }
    if bend {
        let reach = axes[0].max(axes[1]) * (1.0 + ring);
        shape = shape.bent(signed(0.2, 0.7) / reach, signed(0.0, 1.6)).ok()?;
    }
    Some(shape)
}

fn solid(shape: Solid) -> GenericShape {
    GenericShape::Solid(shape)
}

fn sides(shape: &impl Implicit) -> Vector {
    let [low, high] = shape.bounds();
    high - low
}

/// Planes in random directions, no two nearly the same.
fn hyperquadric(terms: usize, random: &mut Stream) -> Option<Hyperquadric> {
    let mut planes: Vec<[f64; 4]> = Vec::new();
    for _ in 0..200 {
        let n = Vector::from_fn(|_, _| random.normal()).normalize();
        let alike = |p: &[f64; 4]| Vector::new(p[0], p[1], p[2]).normalize().dot(&n).abs() > 0.8;
        if planes.len() < terms && !planes.iter().any(alike) {
            let n = n / random.between(0.6, 1.2);
            planes.push([n.x, n.y, n.z, random.between(-0.3, 0.3)]);
        }
    }
    let exponents: Vec<f64> = planes.iter().map(|_| random.between(0.5, 3.0).exp()).collect();
    Hyperquadric::new(&planes, &exponents).ok().filter(Hyperquadric::is_bounded)
}

fn supershape(random: &mut Stream) -> Option<Solid> {
    let mut curve = |m: usize, size: f64, odd: bool| {
        let first = random.between(0.0, 2.0).exp();
        let second = first * random.between(-0.7, 0.7).exp();
        let third = if odd { second } else { first * random.between(-0.7, 0.7).exp() };
        let a = random.between(0.8, 1.25);
        let b = if odd { a } else { random.between(0.8, 1.25) };
        // scales that multiply the radius by `size`
        let grown = |scale: f64, n: f64| scale * (size.ln() * first / n).exp();
        let curve = Superformula::new(
            m as f64,
            [first, second, third],
            [grown(a, second), grown(b, third)],
        );
        let radii = |c: &Superformula| (0..400).map(|i| c.radius(f64::from(i) * 0.0157)).collect();
        curve.ok().filter(|c| {
            let radii: Vec<f64> = radii(c);
            let (low, high) =
                radii.iter().fold((f64::MAX, 0.0f64), |(l, h), r| (l.min(*r), h.max(*r)));
            high < 2.5 * low
        })
    };
    let around = 2 + (curve(4, 1.0, false).map_or(0, |c| (c.radius(0.1) * 1e6) as usize)) % 7;
    let longitude = curve(around, 1.0, around % 2 == 1)?;
    let along = [2, 4, 4, 6][(longitude.radius(0.3) * 1e6) as usize % 4];
    let latitude = curve(along, 0.5, false)?;
    Some(Solid::Supershape(Box::new(Supershape::new(longitude, latitude).ok()?)))
}

/// How finely surfaces are compared.
#[derive(Clone, Copy)]
struct Accuracy {
    /// Cells of a mesh along the longest side.
    cells: usize,
    /// Points whose distances are taken.
    samples: u32,
}

const QUICK: Accuracy = Accuracy { cells: 32, samples: 120 };
const FULL: Accuracy = Accuracy { cells: 56, samples: 500 };

struct Case {
    model: GenericModel,
    truth: Posed<GenericShape>,
    mesh: Mesh,
    size: f64,
    /// The cloud is so many times as large as the truth.
    unit: f64,
    points: Vec<Point>,
    accuracy: Accuracy,
}

/// Cloud number `index` of a class: a body of 5 cm to 5 m anywhere, with noise on its surface points, of which a
/// share is replaced by points anywhere in a box 1.4 times as large as the body's.
fn case(class: Class, index: u64, outliers: f64, accuracy: Accuracy) -> Case {
    let mut random = Stream::new(100 + class as u64, index);
    let (shape, model) =
        (0..1000).find_map(|_| class.draw(&mut random)).expect("a body can be drawn");
    // not every member can be scaled: the points are
    let own = sides(&shape).max();
    let turn = Vector::from_fn(|_, _| random.normal());
    let place = Vector::from_fn(|_, _| random.between(-2.0, 2.0) * own);
    let unit = random.between(-3.0, 1.6).exp() / own;
    let pose = Pose::from_parts(Translation3::from(place), UnitQuaternion::new(turn));
    let truth = Posed::new(shape, pose).unwrap();
    let mesh = meshed(&truth, accuracy);
    let sampler = mesh.sampler();
    let [low, high] = truth.shape().bounds();
    let stray = |random: &mut Stream| {
        let share = Vector::from_fn(|_, _| random.between(-0.2, 1.2));
        truth.pose() * (low + (high - low).component_mul(&share))
    };
    let points = (0..POINTS)
        .map(|_| {
            if random.uniform() < outliers {
                return stray(&mut random) * unit;
            }
            let numbers = std::array::from_fn(|_| random.uniform());
            let (p, _) = sampler.sample_at(numbers).unwrap();
            (p + Vector::from_fn(|_, _| random.normal()) * (NOISE * own)) * unit
        })
        .collect();
    Case { model, truth, mesh, size: own, unit, points, accuracy }
}

fn meshed(shape: &Posed<GenericShape>, accuracy: Accuracy) -> Mesh {
    let options =
        MarchOptions { resolution: Resolution::Count(accuracy.cells), ..Default::default() };
    march(shape.shape(), &options).map(|m| m.moved(shape.pose())).unwrap()
}

/// Mean of the distances from points of each surface to the other, in sizes.
fn surface_distance(case: &Case, found: &GenericFit) -> f64 {
    let (vertices, triangles) = meshed(&found.surface, case.accuracy).into_parts();
    let vertices = vertices.into_iter().map(|v| v / case.unit).collect();
    let other = Mesh::new(vertices, triangles).unwrap();
    let one_way = |from: &Mesh, to: &Mesh| {
        let (sampler, mut random) = (from.sampler(), Stream::new(9, 0));
        let triangles: Vec<[Point; 3]> = to.corners().collect();
        let count = case.accuracy.samples;
        let sum: f64 = (0..count)
            .filter_map(|_| sampler.sample_at(std::array::from_fn(|_| random.uniform())))
            .map(|(p, _)| {
                let nearest = triangles.iter().map(|t| square_distance(&p, t));
                nearest.fold(f64::MAX, f64::min).sqrt()
            })
            .sum();
        sum / f64::from(count)
    };
    0.5 * (one_way(&case.mesh, &other) + one_way(&other, &case.mesh)) / case.size
}

/// From a point to a triangle.
fn square_distance(p: &Point, [a, b, c]: &[Point; 3]) -> f64 {
    let edge = |a: &Point, b: &Point| {
        let (along, to) = (b - a, p - a);
        let t = (to.dot(&along) / along.norm_squared().max(1e-300)).clamp(0.0, 1.0);
        (to - along * t).norm_squared()
    };
    let n = (b - a).cross(&(c - a));
    let beside = |a: &Point, b: &Point| (b - a).cross(&(p - a)).dot(&n) >= 0.0;
    if beside(a, b) && beside(b, c) && beside(c, a) && n.norm_squared() > 0.0 {
        let height = (p - a).dot(&n);
        return height * height / n.norm_squared();
    }
    edge(a, b).min(edge(b, c)).min(edge(c, a))
}

#[test]
fn one_of_each_class_is_recovered() {
    for class in [Class::Hyperquadric, Class::Supershape, Class::Extended, Class::Tapered] {
        let case = case(class, 0, 0.0, QUICK);
        let found = fit_generic(&case.points, case.model, &GenericOptions::default()).unwrap();
        let error = surface_distance(&case, &found);
        assert!(error < 0.005, "{class:?}: {error}");
        let noise = found.noise / (case.size * case.unit);
        assert!((noise / NOISE - 1.0).abs() < 0.1, "{class:?}: {noise}");
        assert!(found.inliers.iter().filter(|i| **i).count() > POINTS * 99 / 100);
        let median = 0.6745 * found.noise;
        assert!((found.residual / median - 1.0).abs() < 0.2);
    }
}

#[test]
fn outliers_are_told() {
    let case = case(Class::Extended, 1, 0.2, QUICK);
    let found = fit_generic(&case.points, case.model, &GenericOptions::default()).unwrap();
    assert!(surface_distance(&case, &found) < 0.005);
    let left = found.inliers.iter().filter(|i| !**i).count() as f64 / POINTS as f64;
    assert!((0.12..0.24).contains(&left), "{left}");
}

#[test]
fn results_do_not_depend_on_the_unit_nor_on_the_run() {
    let case = case(Class::Tapered, 3, 0.0, QUICK);
    let few = &case.points[..300];
    let options = GenericOptions::default();
    let fit = |points: &[Point]| fit_generic(points, case.model, &options).unwrap();
    let found = fit(few);
    assert_eq!(found.surface, fit(few).surface);
    for unit in [1e-3, 1024.0] {
        let scaled: Vec<Point> = few.iter().map(|p| p * unit).collect();
        let same = fit(&scaled);
        assert!((same.noise / (found.noise * unit) - 1.0).abs() < 1e-3);
        let offset = found.surface.pose().inverse() * few[0];
        let gap = found.surface.gauge(&few[0]) - same.surface.gauge(&scaled[0]);
        assert!(gap.abs() < 1e-3, "{offset} {gap}");
    }
    // a point that is no number is no inlier and changes nothing
    let mut more = few.to_vec();
    more.insert(7, Point::new(f64::NAN, 0.0, f64::INFINITY));
    let with = fit(&more);
    assert!(!with.inliers[7] && with.surface == found.surface);
}

#[test]
fn points_without_a_shape_are_answered() {
    let models = [
        GenericModel::Hyperquadric { terms: 4 },
        GenericModel::Supershape,
        GenericModel::Extended { profile: 3, section: 4 },
        GenericModel::Toroid { taper: true, twist: false, bend: true },
    ];
    let mut random = Stream::new(1, 0);
    let mut cloud = |sides: [f64; 3]| -> Vec<Point> {
        let mut p = || Point::from(sides.map(|s| s * random.normal()));
        (0..60).map(|_| p()).collect()
    };
    let wrong = [
        Vec::new(),
        cloud([0.0; 3]),
        cloud([1.0, 0.0, 0.0]),
        cloud([f64::NAN; 3]),
        cloud([1e308; 3]),
        cloud([1e-310; 3]),
    ];
    let [flat, blob] = [cloud([1.0, 1.0, 0.0]), cloud([1.0; 3])];
    let (far, near) = (cloud([1e200; 3]), cloud([1e-200; 3]));
    let options = GenericOptions { kept: 1, ..Default::default() };
    let answered = |points: &[Point], model| {
        let found = fit_generic(points, model, &options);
        assert!(found.is_err() || found.is_ok_and(|f| f.residual.is_finite()), "{model:?}");
    };
    for model in models {
        for points in &wrong {
            assert!(fit_generic(points, model, &options).is_err(), "{model:?}");
        }
        answered(&flat, model);
    }
    let vase = GenericModel::Extended { profile: 3, section: 4 };
    for points in [&blob, &far, &near] {
        answered(points, vase);
    }
    for model in [
        GenericModel::Hyperquadric { terms: 2 },
        GenericModel::Hyperquadric { terms: 99 },
        GenericModel::Extended { profile: 0, section: 4 },
    ] {
        let found = fit_generic(&blob, model, &options);
        assert!(matches!(found, Err(FitError::Invalid(_))), "{model:?}");
    }
}

#[test]
#[ignore = "a measurement of some minutes"]
#[allow(clippy::print_stdout)]
fn generic_table() {
    use std::time::Instant;
    let only = std::env::var("CLASS").unwrap_or_default();
    let count: u64 = std::env::var("COUNT").ok().and_then(|c| c.parse().ok()).unwrap_or(20);
    for (class, outliers) in CLASSES.into_iter().flat_map(|c| [(c, 0.0), (c, 0.2)]) {
        let name = format!("{class:?} with {:.0} % outliers", 100.0 * outliers);
        if !name.to_lowercase().contains(&only.to_lowercase()) {
            continue;
        }
        let mut errors = Vec::new();
        let mut seconds = Vec::new();
        for index in 0..count {
            let case = case(class, index, outliers, FULL);
            let start = Instant::now();
            let found = fit_generic(&case.points, case.model, &GenericOptions::default());
            seconds.push(start.elapsed().as_secs_f64());
            let error = found.as_ref().map_or(f64::INFINITY, |f| surface_distance(&case, f));
            match &found {
                Ok(f) => println!(
                    "  {name} {index:2}: error {:.3} %, residual {:.3} %, noise {:.3} %, inliers {:.3}, {} rounds, {:?}, {:?}",
                    100.0 * error,
                    100.0 * f.residual / (case.size * case.unit),
                    100.0 * f.noise / (case.size * case.unit),
                    f.inliers.iter().filter(|i| **i).count() as f64 / POINTS as f64,
                    f.iterations,
                    f.stopped,
                    case.model,
                ),
                Err(e) => println!("  {name} {index:2}: {e}"),
            }
            if error > 0.01 {
                println!("    truth {:?}", case.truth.shape());
                println!("    found {:?}", found.as_ref().map(|f| f.surface.shape()));
            }
            errors.push(error);
        }
        errors.sort_by(f64::total_cmp);
        seconds.sort_by(f64::total_cmp);
        let good = errors.iter().filter(|e| **e < RECOVERED).count();
        println!(
            "{name}: {good} of {count} within 2 %; median error {:.3} %; median time {:.2} s, longest {:.2} s",
            100.0 * errors[errors.len() / 2],
            seconds[seconds.len() / 2],
            seconds[seconds.len() - 1],
        );
    }
}
