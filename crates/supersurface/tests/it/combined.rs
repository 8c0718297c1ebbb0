//! Boolean trees against what their parts say by themselves: inside or outside, rays, mass; and a million odd inputs.

use supersurface::combine::{Alpha, Blend, CombinedSolid};
use supersurface::measure::first_hit;
use supersurface::mesh::mass_of_solid;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Posed, Ray, Supercylinder, Superellipsoid, Supertoroid};
use supersurface::{Direction, Point, Pose, Vector};

type Solids = (Superellipsoid, Posed<Superellipsoid>, Posed<Supertoroid>);

/// A ball, a bar across it, and a ring around it.
fn parts() -> Solids {
    let ball = Superellipsoid::new([0.5; 3], [1.0; 2]).unwrap();
    let bar = Superellipsoid::new([0.2, 0.25, 0.9], [0.2, 0.6]).unwrap();
    let ring = Supertoroid::new([0.15, 0.15, 0.2], 3.0, [0.7, 1.0]).unwrap();
    let turned = Pose::new(Vector::new(0.1, 0.0, 0.05), Vector::new(0.4, 0.9, 0.0));
    let lifted = Pose::new(Vector::new(0.0, 0.05, 0.1), Vector::new(0.2, 0.0, 0.0));
    (ball, Posed::new(bar, turned).unwrap(), Posed::new(ring, lifted).unwrap())
}

/// A tree, and whether a point is in it by what its parts say.
type Tree = (CombinedSolid, fn(&Solids, &Point) -> bool);

fn trees(alpha: Alpha) -> [Tree; 3] {
    let (ball, bar, ring) = parts();
    let leaves = || (CombinedSolid::new(ball), CombinedSolid::new(bar), CombinedSolid::new(ring));
    let (a, b, c) = leaves();
    let cut = a.difference(b, alpha).union(c, alpha);
    let (a, b, c) = leaves();
    let common = a.union(c, alpha).intersection(b, alpha);
    let (a, b, c) = leaves();
    let rest = b.union(c, alpha).difference(a, alpha);
    [
        (cut, |(a, b, c), p| (a.contains(p) && !b.contains(p)) || c.contains(p)),
        (common, |(a, b, c), p| (a.contains(p) || c.contains(p)) && b.contains(p)),
        (rest, |(a, b, c), p| (b.contains(p) || c.contains(p)) && !a.contains(p)),
    ]
}

fn all_trees() -> Vec<Tree> {
    [-0.5, 0.0, 1.0].into_iter().flat_map(|a| trees(Alpha::new(a).unwrap())).collect()
}

#[test]
fn inside_is_what_the_parts_say() {
    let solids = parts();
    for (tree, holds) in all_trees() {
        let mut random = Stream::new(71, 0);
        let [low, high] = tree.bounds();
        for _ in 0..20_000 {
            let p = Point::from(Vector::from_fn(|_, _| random.between(-1.2, 1.2)));
            let inside = holds(&solids, &p);
            assert_eq!(tree.contains(&p), inside, "{p}");
            assert!(!inside || (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]), "{p}");
        }
    }
}

#[test]
fn rays_meet_what_small_steps_meet() {
    let solids = parts();
    let mut hits = 0;
    for (tree, holds) in trees(Alpha::SMOOTH) {
        let mut random = Stream::new(72, 0);
        for _ in 0..1000 {
            let origin = Point::from(Vector::from_fn(|_, _| random.normal()).normalize() * 2.0);
            let aim = Vector::from_fn(|_, _| random.between(-0.5, 0.5));
            let direction = Direction::new_normalize(aim - origin.coords);
            let found = first_hit(&tree, &Ray { origin, direction }, 4.0);
            // the first step inside, and where between it and the one before
            const STEP: f64 = 1e-3;
            let at = |t: f64| origin + direction.into_inner() * t;
            let inside = |t: f64| holds(&solids, &at(t));
            let stepped = (1..4000).map(|k| f64::from(k) * STEP).find(|t| inside(*t));
            match (found, stepped) {
                (None, None) => {}
                (Some(hit), Some(t)) => {
                    let (mut out, mut within) = (t - STEP, t);
                    for _ in 0..50 {
                        let middle = 0.5 * (out + within);
                        *(if inside(middle) { &mut within } else { &mut out }) = middle;
                    }
                    // a corner thinner than a step may be met earlier
                    let early = hit.distance < t - STEP && inside(hit.distance + 1e-9);
                    assert!(early || (hit.distance - within).abs() < 1e-7, "{hit:?} {within}");
                    hits += 1;
                }
                (Some(hit), None) => assert!(inside(hit.distance + 1e-9), "{hit:?}"),
                (None, Some(t)) => panic!("missed at {t} from {origin} along {direction:?}"),
            }
        }
    }
    assert!(hits > 1500, "{hits}");
}

/// A bead, a plate with five holes, a bracket with a fillet, a sieve of balls, and two bodies apart.
fn parts_of_machines() -> Vec<CombinedSolid> {
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
fn rays_also_from_inside_meet_what_small_steps_meet() {
    for (tree, solid) in parts_of_machines().iter().enumerate() {
        let [low, high] = solid.bounds();
        let (middle, half) = (supersurface::nalgebra::center(&low, &high), (high - low) * 0.5);
        let (mut hits, mut misses, mut thin) = (0, 0, 0);
        for case in 0..1000 {
            let stream = &mut Stream::new(29 + tree as u64, case);
            let mut inside =
                || middle + half.component_mul(&Vector::from_fn(|_, _| stream.between(-1.0, 1.0)));
            let (target, start) = (inside(), inside());
            let any = Vector::from_fn(|_, _| stream.normal());
            let towards = if case % 5 == 0 { Vector::y() } else { any };
            let direction = Direction::new_normalize(towards);
            let origin = if case % 7 == 0 { start } else { target - direction.into_inner() * 0.4 };
            let ray = Ray { origin, direction };
            let n = 1600;
            let at = |i: usize| i as f64 * 0.8 / n as f64;
            let begun = solid.contains(&ray.origin);
            let changed = |i: usize| solid.contains(&ray.at(at(i))) != begun;
            let crossing = (1..=n).find(|i| changed(*i));
            match (first_hit(solid, &ray, 0.8), crossing) {
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

#[test]
fn a_ball_with_a_hole_weighs_what_it_should() {
    let ball = Superellipsoid::new([0.05; 3], [1.0; 2]).unwrap();
    let drill = Supercylinder::new([0.02, 0.02, 0.2], 1.0).unwrap();
    let moved = Pose::translation(0.3, -0.2, 0.1);
    let bead = CombinedSolid::new(ball).difference(CombinedSolid::new(drill), Alpha::SMOOTH);
    let bead = Posed::new(bead, moved).unwrap();
    let found = mass_of_solid(&bead, 1000.0, 96).unwrap();
    let height = (0.05f64.powi(2) - 0.02f64.powi(2)).sqrt();
    let mass = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * height.powi(3);
    assert!((found.mass.mass / mass - 1.0).abs() < found.error.min(3e-3), "{found:?}");
    assert!((found.mass.centre.coords - moved.translation.vector).norm() < 1e-5);
    // about the axis: shells of radius r and height 2 √(R² - r²), so 2/5 of (R² + 3/2 r²) on average
    let axial = mass * 0.4 * (0.05f64.powi(2) + 1.5 * 0.02f64.powi(2));
    assert!((found.mass.inertia[(2, 2)] / axial - 1.0).abs() < found.error, "{found:?} {axial}");
}

#[test]
fn no_input_breaks_a_tree() {
    let fillet = Blend::new(0.4, [0.5, 0.3]).unwrap();
    let (ball, bar, ring) = parts();
    let blended = CombinedSolid::new(ball).blend_union(CombinedSolid::new(bar), fillet);
    let odd = blended.difference(CombinedSolid::new(ring), Alpha::SMOOTH);
    let values = [0.0, -0.0, 5e-324, 1e-308, 1e-150, 1e-8, 1.0, 1e8, 1e150, 1e308, f64::MAX];
    let wild = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for (index, tree) in trees(Alpha::SMOOTH).into_iter().map(|t| t.0).chain([odd]).enumerate() {
        let mut random = Stream::new(73, index as u64);
        for _ in 0..250_000 {
            let p = Point::from(Vector::from_fn(|_, _| match random.index(8) {
                0..=2 => values[random.index(values.len())] * [1.0, -1.0][random.index(2)],
                3 => wild[random.index(3)],
                4 => f64::from_bits(random.bits()),
                _ => random.normal(),
            }));
            let (gauge, slope) = (tree.gauge(&p), tree.gradient(&p));
            let finite = p.iter().all(|v| v.is_finite());
            assert!(!finite || !gauge.is_nan(), "{p}");
            assert!(finite || !tree.contains(&p), "{p}");
            assert!(slope.iter().all(|v| v.is_finite()) || !finite, "{p} {slope}");
        }
    }
}
