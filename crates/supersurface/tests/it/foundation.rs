//! Meshes against supersurfaces: laws in closed form, mechanics, derivatives.

use supersurface::contact::laws::radial_sphere_on_plane;
use supersurface::contact::{
    Application, ByClosestPoint, Foundation, FoundationError, FoundationOptions, Indented,
    SmoothlyIndented, Twist, Wrench, layer_stiffness,
};
use supersurface::mesh::{Mesh, tessellate};
use supersurface::nalgebra::{Matrix6, Vector6};
use supersurface::numeric::powers::power;
use supersurface::numeric::random::Stream;
use supersurface::numeric::superellipse::norm;
use supersurface::shape::{Implicit, Parametric, Posed, Superellipsoid, Supertoroid};
use supersurface::{Point, Pose, Vector};

/// A square plate about the origin across z, of `count` vertices a side.
fn plate(half: f64, count: u32) -> Mesh {
    let at = |i: u32| half * (2.0 * f64::from(i) / f64::from(count - 1) - 1.0);
    let vertices = (0..count * count).map(|k| Point::new(at(k % count), at(k / count), 0.0));
    let cell = |k: u32| {
        let a = k / (count - 1) * count + k % (count - 1);
        let (b, c, d) = (a + 1, a + count + 1, a + count);
        // diagonals turn, so that all inner vertices have one area
        if k.is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let triangles = (0..(count - 1) * (count - 1)).flat_map(cell).collect();
    Mesh::new(vertices.collect(), triangles).unwrap()
}

fn random_pose(random: &mut Stream, shift: f64) -> Pose {
    let mut vector = |size: f64| Vector::from_fn(|_, _| random.between(-size, size));
    Pose::new(vector(shift), vector(2.0))
}

fn springs(stiffness: f64) -> FoundationOptions {
    FoundationOptions { stiffness, ..FoundationOptions::default() }
}

#[test]
fn a_sphere_on_a_plane_is_the_law_of_radial_indentations() {
    let ball = Superellipsoid::new([0.05; 3], [1.0, 1.0]).unwrap();
    for depth in [1e-4, 5e-4, 2.5e-3, 0.01] {
        let reach = f64::sqrt(2.0 * 0.05 * depth - depth * depth);
        let mesh = plate(1.03 * reach, 35);
        let pose = Pose::translation(0.0, 0.0, 0.05 - depth);
        let solid = Posed::new(ball, pose).unwrap();
        let found = Foundation::new(&mesh)
            .unwrap()
            .press(&Pose::identity(), &solid, &Twist::default(), &springs(2e6))
            .unwrap();
        assert!(found.vertices <= 1000, "{found:?}");
        let law = radial_sphere_on_plane(0.05, depth, 2e6);
        let error = found.on_solid.force.z / law - 1.0;
        assert!(error.abs() < 0.01, "depth {depth}: {error} with {} points", found.vertices);
        assert!(found.on_solid.force.xy().norm() < 1e-10 * law);
        assert!((found.deepest / depth - 1.0).abs() < 0.01);
    }
}

#[test]
fn a_ring_on_a_plane_is_the_law_of_its_section() {
    // around the ring r of a tube, per length the springs of its section: those within and without make up for each
    // other's circumference
    let (ring, tube) = (0.06, 0.02);
    let solid = Supertoroid::new([tube; 3], ring / tube, [1.0, 1.0]).unwrap();
    for depth in [2e-4, 1e-3, 5e-3] {
        let height = tube - depth;
        let reach = f64::sqrt(tube * tube - height * height);
        let springs_of_section = tube * (reach / height).asinh() - reach;
        let law = 4.0 * std::f64::consts::PI * ring * 2e6 * height * springs_of_section;
        let foundation = Foundation::new(&plate(0.085, 301)).unwrap();
        let solid = Posed::new(solid, Pose::translation(0.0, 0.0, height)).unwrap();
        let found =
            foundation.press(&Pose::identity(), &solid, &Twist::default(), &springs(2e6)).unwrap();
        let error = found.on_solid.force.z / law - 1.0;
        assert!(error.abs() < 0.01, "depth {depth}: {error} with {} points", found.vertices);
    }
}

/// Each kind of solid with a mesh that reaches into it.
fn pressed(case: u64, random: &mut Stream) -> (Kind, Foundation, Pose) {
    let axes = [0; 3].map(|_| random.between(0.03, 0.1));
    let e = [0; 2].map(|_| random.between(0.3, 1.7));
    let pose = random_pose(random, 0.3);
    let kind = match case % 2 {
        0 => Kind::Tin(Posed::new(Superellipsoid::new(axes, e).unwrap(), pose).unwrap()),
        _ => {
            let ring = Supertoroid::new(axes, random.between(1.2, 2.5), e).unwrap();
            Kind::Ring(Posed::new(ring, pose).unwrap())
        }
    };
    let other = Superellipsoid::new([0.05, 0.08, 0.06], [0.7, 1.2]).unwrap();
    let mesh = tessellate(&other, Some(3e-4)).unwrap().mesh;
    let [low, high] = kind.bounds();
    let middle = supersurface::nalgebra::center(&low, &high).coords;
    let off = Vector::from_fn(|k, _| random.between(-0.4, 0.4) * (high - low)[k]);
    let turn = random_pose(random, 0.0).rotation;
    (kind, Foundation::new(&mesh).unwrap(), Pose::from_parts((middle + off).into(), turn))
}

#[derive(Clone, Copy)]
enum Kind {
    Tin(Posed<Superellipsoid>),
    Ring(Posed<Supertoroid>),
}

impl Kind {
    fn bounds(&self) -> [Point; 2] {
        match self {
            Self::Tin(s) => s.bounds(),
            Self::Ring(s) => s.bounds(),
        }
    }
}

fn lively(random: &mut Stream) -> (Twist, FoundationOptions) {
    let mut vector = || Vector::from_fn(|_, _| random.normal());
    let motion = Twist { linear: vector(), angular: vector(), about: vector().into() };
    let application =
        if random.uniform() < 0.5 { Application::Vertex } else { Application::Surface };
    let options = FoundationOptions {
        stiffness: 1e6,
        damping: random.between(0.0, 1.0),
        friction: random.between(0.0, 1.0),
        slip_speed: random.between(0.01, 1.0),
        application,
    };
    (motion, options)
}

fn largest(wrench: &Wrench) -> f64 {
    wrench.force.amax().max(wrench.moment.amax())
}

fn same(a: &Wrench, b: &Wrench, relative: f64) {
    let size = largest(a).max(largest(b));
    let off = (a.force - b.force).amax().max((a.moment - b.moment).amax());
    assert!(off <= relative * size, "{a:?}\n{b:?}");
}

fn mechanics<S: Indented + Clone>(
    solid: &Posed<S>,
    foundation: &Foundation,
    pose: &Pose,
    random: &mut Stream,
) -> usize {
    let (motion, options) = lively(random);
    let found = foundation.press(pose, solid, &motion, &options).unwrap();
    let forces = foundation.forces(pose, solid, &motion, &options).unwrap();
    assert_eq!(found.vertices, forces.len());
    let about = found.on_mesh.about;
    let start = Wrench { about, ..Wrench::default() };
    let sum = |sign: f64| {
        forces.iter().fold(start, |sum, f| sum + Wrench::of_force(f.force * sign, &f.at, &about))
    };
    same(&found.on_mesh, &sum(1.0), 1e-11);
    // action and reaction, also about other points
    let far = Point::from(Vector::from_fn(|_, _| random.normal()));
    let nothing = found.on_mesh.moved_to(&far) + found.on_solid;
    assert!(largest(&nothing) <= 1e-12 * largest(&found.on_mesh.moved_to(&far)));
    same(&found.on_mesh, &-sum(-1.0), 1e-11);
    for f in &forces {
        let along = f.force.dot(&f.indentation.normal);
        let across = (f.force - *f.indentation.normal * along).norm();
        assert!(along >= 0.0 && across <= options.friction * along * (1.0 + 1e-12));
    }
    // what turns and moves with the world
    let frame = random_pose(random, 1.0);
    let turned = |v: &Vector| frame.rotation * v;
    let moved = Twist {
        linear: turned(&motion.linear),
        angular: turned(&motion.angular),
        about: frame * motion.about,
    };
    let there = foundation.press(&(frame * pose), &solid.moved(&frame), &moved, &options).unwrap();
    same(&there.on_mesh.seen_from(&frame), &found.on_mesh, 1e-11);
    found.vertices
}

#[test]
fn wrenches_are_sums_of_forces_in_any_frame() {
    let mut random = Stream::new(21, 0);
    let mut touching = 0;
    for case in 0..200 {
        let (kind, foundation, pose) = pressed(case, &mut random);
        let vertices = match kind {
            Kind::Tin(s) => mechanics(&s, &foundation, &pose, &mut random),
            Kind::Ring(s) => mechanics(&s, &foundation, &pose, &mut random),
        };
        touching += usize::from(vertices > 5);
    }
    assert!(touching > 150, "{touching}");
}

/// Differences of fourth order by the coordinates of a pose as they are documented.
fn differences(pose: &Pose, step: f64, f: impl Fn(&Pose) -> Vector6<f64>) -> Matrix6<f64> {
    Matrix6::from_columns(&[0, 1, 2, 3, 4, 5].map(|k| {
        let at = |amount: f64| {
            let mut twist = Vector6::zeros();
            twist[k] = amount * step;
            let by = Pose::new(Vector::zeros(), twist.fixed_rows::<3>(3).into_owned());
            let mut moved = pose * by;
            moved.translation.vector += twist.fixed_rows::<3>(0);
            f(&moved)
        };
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step)
    }))
}

fn derivatives<S: SmoothlyIndented + Clone>(
    solid: &Posed<S>,
    foundation: &Foundation,
    pose: &Pose,
) -> Option<f64> {
    let about = Point::new(0.05, -0.2, 0.1);
    let found = foundation.press_derivative(pose, solid, 1e6, &about).unwrap();
    let still = Twist::default();
    let row = |pose: &Pose, solid: &Posed<S>| {
        let found = foundation.press(pose, solid, &still, &springs(1e6)).unwrap();
        let wrench = found.on_mesh.moved_to(&about);
        let mut all = Vector6::zeros();
        all.fixed_rows_mut::<3>(0).copy_from(&wrench.force);
        all.fixed_rows_mut::<3>(3).copy_from(&wrench.moment);
        all
    };
    let wrench = foundation.press(pose, solid, &still, &springs(1e6)).unwrap();
    if wrench.vertices == 0 {
        return None;
    }
    same(&found.on_mesh, &wrench.on_mesh.moved_to(&about), 1e-11);
    // where a step takes a vertex over a seam or through the surface, a shorter one does not
    let off = |step: f64| {
        let by_mesh = differences(pose, step, |pose| row(pose, solid));
        let by_solid = differences(solid.pose(), step, |at| {
            row(pose, &Posed::new(solid.shape().clone(), *at).unwrap())
        });
        let off = |a: &Matrix6<f64>, b: &Matrix6<f64>| (a - b).amax() / a.amax();
        off(&found.by_mesh, &by_mesh).max(off(&found.by_solid, &by_solid))
    };
    Some([1e-7, 1e-8, 1e-9].map(off).into_iter().fold(f64::INFINITY, f64::min))
}

#[test]
fn derivatives_are_those_of_differences() {
    let mut random = Stream::new(22, 0);
    let mut touching = 0;
    for case in 0..60 {
        let (kind, foundation, pose) = pressed(case, &mut random);
        let error = match kind {
            Kind::Tin(s) => derivatives(&s, &foundation, &pose),
            Kind::Ring(s) => derivatives(&s, &foundation, &pose),
        };
        touching += usize::from(error.is_some());
        assert!(error.is_none_or(|e| e < 1e-6), "case {case}: {error:?}");
    }
    assert!(touching > 50, "{touching}");
}

#[test]
fn moving_both_bodies_turns_the_wrench() {
    let mut random = Stream::new(23, 0);
    for case in (0..40).step_by(2) {
        let (Kind::Tin(solid), foundation, pose) = pressed(case, &mut random) else { continue };
        let found = foundation.press_derivative(&pose, &solid, 1e6, &Point::origin()).unwrap();
        // a turn of the world about an axis through the origin
        let axis = Vector::from_fn(|_, _| random.normal());
        let change = |body: &Pose| {
            let shift = axis.cross(&body.translation.vector);
            let turn = body.rotation.inverse_transform_vector(&axis);
            Vector6::from_iterator(shift.iter().chain(turn.iter()).copied())
        };
        let total = found.by_mesh * change(&pose) + found.by_solid * change(solid.pose());
        let truth = [found.on_mesh.force, found.on_mesh.moment].map(|v| axis.cross(&v));
        let off = (total.fixed_rows::<3>(0) - truth[0]).norm()
            + (total.fixed_rows::<3>(3) - truth[1]).norm();
        assert!(off <= 1e-10 * found.by_mesh.amax().max(1e-9), "{off}");
    }
}

#[test]
fn an_impact_loses_the_share_that_the_damping_says() {
    let brick = Superellipsoid::new([0.1, 0.1, 0.05], [0.1, 0.1]).unwrap();
    let plate = Foundation::new(&plate(0.02, 5)).unwrap();
    let (mass, damping, speed) = (0.5, 0.2, 0.1);
    let options = FoundationOptions { damping, ..springs(1e8) };
    let (mut height, mut velocity) = (0.0, -speed);
    let step = 2e-7;
    let force = |height: f64, velocity: f64| {
        let solid = Posed::new(brick, Pose::translation(0.0, 0.0, 0.05 + height)).unwrap();
        let motion = Twist { linear: Vector::z() * -velocity, ..Twist::default() };
        let found = plate.press(&Pose::identity(), &solid, &motion, &options).unwrap();
        found.on_solid.force.z
    };
    while height <= 0.0 {
        // midpoint rule
        let middle = velocity + 0.5 * step * force(height, velocity) / mass;
        let push = force(height + 0.5 * step * velocity, middle);
        assert!(push >= 0.0);
        height += step * middle;
        velocity += step * push / mass;
    }
    let share = 1.0 - velocity / speed;
    assert!((share - damping * speed).abs() < 5e-4, "{share}");
}

#[test]
fn friction_is_smooth_and_reaches_coulombs_limit() {
    let ball = Superellipsoid::new([0.05; 3], [1.0, 1.0]).unwrap();
    let solid = Posed::new(ball, Pose::translation(0.0, 0.0, 0.049)).unwrap();
    let plate = Foundation::new(&plate(0.02, 41)).unwrap();
    let friction = |speed: f64| {
        let options = FoundationOptions { friction: 0.6, ..springs(1e7) };
        let motion = Twist { linear: Vector::x() * speed, ..Twist::default() };
        let found = plate.press(&Pose::identity(), &solid, &motion, &options).unwrap();
        found.on_mesh.force.x / found.on_mesh.force.z.abs()
    };
    assert!(friction(0.0).abs() < 1e-12);
    assert!((friction(10.0) + 0.6).abs() < 0.01 && (friction(-10.0) - 0.6).abs() < 0.01);
    let half = -friction(1e-3) / 0.6;
    assert!((half - 0.5f64.sqrt()).abs() < 0.01, "{half}");
    let mut last = friction(-5e-3);
    for k in -99..100 {
        let next = friction(f64::from(k) * 5e-5);
        assert!(next <= last && last - next < 0.04, "{last} {next}");
        last = next;
    }
}

#[test]
fn solids_that_slip_away_feel_nothing() {
    let ball = Superellipsoid::new([0.05; 3], [1.0, 1.0]).unwrap();
    let plate = Foundation::new(&plate(1.0, 100)).unwrap();
    let solid = Posed::new(ball, Pose::translation(0.0, 0.0, 0.0501)).unwrap();
    let rest = Twist::default();
    let found =
        plate.press(&Pose::identity(), &solid, &rest, &FoundationOptions::default()).unwrap();
    assert_eq!((found.vertices, found.area, found.deepest), (0, 0.0, 0.0));
    assert_eq!(found.on_mesh.force, Vector::zeros());
    assert!(found.on_mesh.moment == Vector::zeros());
}

#[test]
fn what_cannot_be_worked_with_says_why() {
    assert_eq!(Foundation::new(&Mesh::default()).unwrap_err(), FoundationError::NoArea);
    let line = Mesh::new(vec![Point::origin(), Point::new(1.0, 0.0, 0.0)], vec![[0, 1, 1]]);
    assert_eq!(Foundation::new(&line.unwrap()).unwrap_err(), FoundationError::NoArea);
    let vast = [[0.0, 0.0, 0.0], [1e300, 0.0, 0.0], [0.0, 1e300, 0.0]].map(Point::from).to_vec();
    let vast = Foundation::new(&Mesh::new(vast, vec![[0, 1, 2]]).unwrap());
    assert!(matches!(vast, Err(FoundationError::OutOfRange { .. })));
    let plate = Foundation::new(&plate(0.1, 20)).unwrap();
    let ball = Superellipsoid::new([0.05; 3], [1.0, 1.0]).unwrap();
    let solid = Posed::new(ball, Pose::translation(0.0, 0.0, 0.049)).unwrap();
    let (still, rest, good) = (Pose::identity(), Twist::default(), FoundationOptions::default());
    assert!(plate.press(&still, &solid, &rest, &good).is_ok());
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        for options in [
            FoundationOptions { stiffness: bad, ..good },
            FoundationOptions { damping: bad, ..good },
            FoundationOptions { friction: bad, ..good },
            FoundationOptions { slip_speed: bad, ..good },
        ] {
            assert!(plate.press(&still, &solid, &rest, &options).is_err());
            assert!(plate.forces(&still, &solid, &rest, &options).is_err());
        }
        assert!(plate.press_derivative(&still, &solid, bad, &Point::origin()).is_err());
        assert!(
            layer_stiffness(bad, 0.3, 0.01).is_err() && layer_stiffness(1e6, 0.3, bad).is_err()
        );
    }
    assert!(layer_stiffness(1e6, 0.5, 0.01).is_err());
    for bad in [f64::NAN, f64::INFINITY] {
        let lost = Pose::translation(bad, 0.0, 0.0);
        assert!(plate.press(&lost, &solid, &rest, &good).is_err());
        assert!(plate.forces(&lost, &solid, &rest, &good).is_err());
        let point = Point::new(bad, 0.0, 0.0);
        assert!(plate.press_derivative(&lost, &solid, 1.0, &Point::origin()).is_err());
        assert!(plate.press_derivative(&still, &solid, 1.0, &point).is_err());
        let wild = Twist { angular: Vector::x() * bad, ..rest };
        assert!(plate.press(&still, &solid, &wild, &good).is_err());
    }
    let hard = FoundationOptions { stiffness: 1e308, damping: 1e308, ..good };
    let fast = Twist { linear: Vector::z() * 1e308, ..rest };
    assert_eq!(plate.press(&still, &solid, &fast, &hard), Err(FoundationError::Overflow));
    let far = Pose::translation(1e308, -1e308, 1e308);
    assert_eq!(plate.press(&far, &solid, &rest, &good).unwrap().vertices, 0);
}

/// The numbers of the row of a documentation's table that starts with two numbers.
fn row(text: &str, ratio: f64, epsilon: f64) -> Vec<f64> {
    let start = format!("//! | {ratio} | {epsilon} |");
    let line = text.lines().find_map(|l| l.strip_prefix(&start));
    let cells = line.unwrap_or_else(|| panic!("no row {start}")).split(['|', '/']);
    cells.filter_map(|c| c.trim().trim_end_matches(" %").parse().ok()).collect()
}

/// By how many percent the force of a solid with the semi-axes `axes` on a plane across z exceeds that of the exact
/// closest points, and that of springs that stand on the plane, for a depth relative to the third axis.
fn excess(axes: [f64; 3], epsilon: f64, depth: f64) -> [f64; 2] {
    let solid = Superellipsoid::new(axes, [epsilon; 2]).unwrap();
    let height = (1.0 - depth) * axes[2];
    // the cut through the solid is a superellipse of this size
    let reach = power(1.0 - power(1.0 - depth, 2.0 / epsilon), 0.5 * epsilon);
    let (unit, triangles) = plate(1.02, 61).into_parts();
    let sized = |p: &Point| Point::new(p.x * reach * axes[0], p.y * reach * axes[1], 0.0);
    let mesh = Mesh::new(unit.iter().map(sized).collect(), triangles).unwrap();
    let foundation = Foundation::new(&mesh).unwrap();
    let pose = Pose::translation(0.0, 0.0, height);
    let press = |solid: &dyn Indented| {
        let (still, rest) = (Pose::identity(), Twist::default());
        let solid = Posed::new(solid, pose).unwrap();
        foundation.press(&still, &solid, &rest, &springs(1.0)).unwrap().on_solid.force.z
    };
    let radial = press(&solid);
    let exact = press(&ByClosestPoint::superellipsoid(&solid));
    let rise = |(index, area): (u32, f64)| {
        let planar =
            reach * norm(unit[index as usize].x.abs(), unit[index as usize].y.abs(), 2.0 / epsilon);
        let top = power(1.0 - power(planar.min(1.0), 2.0 / epsilon), 0.5 * epsilon);
        area * (axes[2] * top - height).max(0.0)
    };
    let volume: f64 = foundation.areas().map(rise).sum();
    [exact, volume].map(|law| 100.0 * (radial / law - 1.0))
}

const RATIOS: [f64; 3] = [1.0, 3.0, 10.0];
const EPSILONS: [f64; 2] = [1.0, 0.3];
const DEPTHS: [f64; 3] = [0.01, 0.05, 0.1];

#[test]
fn the_table_of_forces_is_true() {
    let text = include_str!("../../src/contact/elastic/foundation.rs");
    let mut wrong = String::new();
    for ratio in RATIOS {
        for epsilon in EPSILONS {
            let tip = DEPTHS.map(|d| excess([1.0, 1.0, ratio], epsilon, d));
            let found = tip.concat();
            let lying = DEPTHS.map(|d| excess([ratio, 1.0, 1.0], epsilon, d)[0]);
            assert!(lying.iter().all(|e| e.abs() < 1.1), "{ratio} {epsilon}: {lying:?}");
            let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 0.06 + 0.01 * b.abs();
            let told = row(text, ratio, epsilon);
            if told.len() != found.len() || !found.iter().zip(&told).all(near) {
                wrong += &format!("{ratio} {epsilon}: {found:.1?}\n");
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

/// Median and largest excess in percent of the depths of points under the surface.
fn depths(ratio: f64, epsilon: f64, depth: f64) -> [f64; 2] {
    let solid = Superellipsoid::new([1.0, 1.0, ratio], [epsilon; 2]).unwrap();
    let exact = ByClosestPoint::superellipsoid(&solid);
    let count = 40;
    let mut errors = Vec::new();
    for k in 0..count * count {
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(count) * std::f64::consts::FRAC_PI_2;
        let (eta, omega) = (at(k / count), at(k % count));
        let p = solid.point(eta, omega) - *solid.normal(eta, omega).unwrap() * depth;
        let (Some(radial), Some(exact)) = (solid.indentation(&p), exact.indentation(&p)) else {
            continue;
        };
        errors.push(100.0 * (radial.depth / exact.depth - 1.0));
    }
    errors.sort_unstable_by(|a, b| a.abs().total_cmp(&b.abs()));
    [errors[errors.len() / 2], errors[errors.len() - 1]]
}

#[test]
fn the_table_of_depths_is_true() {
    let text = include_str!("../../src/contact/elastic/indentation.rs");
    let mut wrong = String::new();
    for ratio in RATIOS {
        for epsilon in EPSILONS {
            let found = DEPTHS.map(|d| depths(ratio, epsilon, d)).concat();
            let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 0.06 + 0.01 * b.abs();
            let told = row(text, ratio, epsilon);
            if told.len() != found.len() || !found.iter().zip(&told).all(near) {
                wrong += &format!("{ratio} {epsilon}: {found:.2?}\n");
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
