//! Shapes of parry answer as the library's surfaces do.

use std::f64::consts::TAU;

use supersurface::measure::{ClosestFinder, first_hit};
use supersurface::numeric::powers::power;
use supersurface::numeric::random::Stream;
use supersurface::numeric::superellipse::dual_norm;
use supersurface::shape::{
    Implicit, MassProperties, Parametric, Posed, Ray, Superellipsoid, Supertoroid, SupportMap,
};
use supersurface::surface::{Solid, Surface};
use supersurface::{Direction, Point, Pose, Vector};
use supersurface_physics::convert::{from_point, from_vector, to_point, to_vector};
use supersurface_physics::parry::query::Ray as ParryRay;
use supersurface_physics::parry::shape::SharedShape;
use supersurface_physics::{ConvexSolid, NoShape, Pieces, compound, shape};

fn superellipsoid(axes: [f64; 3], exponents: [f64; 2]) -> Superellipsoid {
    Superellipsoid::new(axes, exponents).unwrap()
}

fn members() -> Vec<Surface> {
    let stick = superellipsoid([0.01, 0.012, 0.06], [0.3, 1.0]);
    let ring = |ratio, e| Supertoroid::new([0.01, 0.012, 0.015], ratio, e).unwrap();
    vec![
        Surface::Superellipsoid(superellipsoid([0.03, 0.04, 0.05], [0.1, 1.7])),
        Surface::Superellipsoid(superellipsoid([1.0, 0.4, 0.5], [1.9, 0.2])),
        Surface::Supertoroid(ring(3.0, [1.0, 1.0])),
        Surface::Supertoroid(ring(1.5, [0.2, 0.2])),
        Surface::tapered(stick, [0.3, -0.2]).unwrap(),
        Surface::tapered(superellipsoid([0.02, 0.02, 0.05], [1.8, 1.0]), [0.6, 0.6]).unwrap(),
        Surface::bent(stick, 12.0, 0.3).unwrap(),
        Surface::twisted(superellipsoid([0.01, 0.02, 0.05], [0.2, 0.2]), 0.25).unwrap(),
        Surface::tapered_bent(stick, [-0.3, -0.3], 10.0, 0.0).unwrap(),
    ]
}

#[test]
fn mass_is_that_of_the_surface() {
    for surface in members() {
        let found = shape(&surface).unwrap().mass_properties(700.0);
        let truth = Solid::from(surface).mass_properties(700.0);
        assert!((found.mass() / truth.mass - 1.0).abs() < 1e-12);
        assert!((to_point(found.local_com) - truth.centre).norm() < 1e-12);
        let inertia = found.reconstruct_inertia_matrix();
        for (k, v) in truth.inertia.iter().enumerate() {
            assert!((inertia.to_cols_array()[k] - v).abs() < 1e-9 * truth.inertia.trace());
        }
    }
}

#[test]
fn rays_and_points_are_exact() {
    let solid = superellipsoid([0.3, 0.4, 0.5], [0.2, 1.7]);
    let shape = shape(&Surface::Superellipsoid(solid)).unwrap();
    let finder = ClosestFinder::superellipsoid(&solid);
    let mut random = Stream::new(2, 0);
    for _ in 0..200 {
        let origin = Point::from(Vector::from_fn(|_, _| random.between(-1.0, 1.0)));
        let way = Vector::from_fn(|_, _| random.normal());
        let ray = ParryRay::new(from_point(&origin), from_vector(&way));
        let found = shape.cast_local_ray(&ray, 10.0, false);
        let exact = Ray { origin, direction: Direction::new_normalize(way) };
        let truth = first_hit(&solid, &exact, 10.0 * way.norm());
        assert_eq!(found, truth.map(|hit| hit.distance / way.norm()));
        let point = shape.project_local_point(from_point(&origin), false);
        assert_eq!(to_point(point.point), finder.find(&origin).unwrap().point);
        assert_eq!(point.is_inside, solid.contains(&origin));
    }
}

/// The convex pieces of a shape.
fn pieces(shape: &SharedShape) -> Vec<SharedShape> {
    match shape.as_shape::<Pieces>() {
        Some(cut) => cut.pieces().iter().map(|(_, piece)| piece.clone()).collect(),
        None => vec![shape.clone()],
    }
}

#[test]
fn pieces_reach_as_far_as_the_solid() {
    for surface in members() {
        let pieces = pieces(&shape(&surface).unwrap());
        let mut random = Stream::new(3, 0);
        let [low, high] = surface.bounds();
        let size = 0.5 * (high - low).norm();
        for _ in 0..100 {
            let n = Vector::from_fn(|_, _| random.normal()).normalize();
            let reach = |piece: &SharedShape| {
                let map = piece.as_support_map().unwrap();
                to_vector(map.local_support_point(from_vector(&n))).dot(&n)
            };
            let found = pieces.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
            let truth = surface.support(&n);
            assert!((found - truth).abs() < 0.01 * size, "{surface:?} {found} {truth}");
        }
    }
}

#[test]
fn convex_tapered_solids_reach_exactly_as_far() {
    let mut random = Stream::new(9, 0);
    let mut convex = 0;
    for _ in 0..60 {
        let axes = [0; 3].map(|_| random.between(0.02, 0.1));
        let exponents = [0; 2].map(|_| random.between(0.1, 1.9));
        let slopes = [0; 2].map(|_| random.between(-0.3, 0.3));
        let solid = superellipsoid(axes, exponents);
        let shape = shape(&Surface::tapered(solid, slopes).unwrap()).unwrap();
        let Some(map) = shape.as_support_map() else { continue };
        convex += 1;
        let truth = |n: &Vector| {
            // of sections at many heights
            let heights = (0..=20_000).map(|k| (TAU * k as f64 / 40_000.0 - TAU / 4.0).sin());
            let reach = |t: f64| {
                let r = power((1.0 - power(t, 2.0 / exponents[0])).max(0.0), 0.5 * exponents[0]);
                let [w1, w2] = [0, 1].map(|k| axes[k] * (1.0 + slopes[k] * t) * r);
                axes[2] * t * n.z + dual_norm((w1 * n.x).abs(), (w2 * n.y).abs(), exponents[1])
            };
            heights.map(reach).fold(f64::NEG_INFINITY, f64::max)
        };
        for _ in 0..20 {
            let n = Vector::from_fn(|_, _| random.normal()).normalize();
            let found = to_vector(map.local_support_point(from_vector(&n))).dot(&n);
            let off = found - truth(&n);
            assert!(off > -1e-12 && off < 1e-6, "{exponents:?} {slopes:?} {n}: {off}");
        }
        for n in [Vector::z(), -Vector::z(), Vector::x()] {
            let found = map.local_support_point(from_vector(&n));
            assert!((to_vector(found).dot(&n) - truth(&n)).abs() < 1e-6);
        }
    }
    assert!(convex > 20);
}

#[test]
fn pieces_are_within_a_hundredth_of_the_surface() {
    for surface in members() {
        let solid = Solid::from(surface);
        let pieces = pieces(&shape(&surface).unwrap());
        let [low, high] = surface.bounds();
        let allowed = 0.01 * (high - low).norm();
        let mut random = Stream::new(4, 0);
        let [eta, omega] = solid.domain();
        for _ in 0..100 {
            let at = [eta, omega].map(|[from, to]| random.between(from, to));
            let Some(normal) = solid.normal(at[0], at[1]) else { continue };
            let p = solid.point(at[0], at[1]);
            let inside = |q: Point| pieces.iter().any(|s| s.contains_local_point(from_point(&q)));
            // near sharp edges both may be on the other side of the solid
            let [within, without] = [-allowed, allowed].map(|way| p + normal.into_inner() * way);
            let (full, free) = (surface.contains(&within), !surface.contains(&without));
            assert!(inside(within) || !full, "{surface:?} is hollow at {p}");
            assert!(!inside(without) || !free, "{surface:?} is fat at {p}");
        }
    }
}

#[test]
fn a_toroid_keeps_its_hole_and_its_outside() {
    let ring = Supertoroid::new([0.01; 3], 3.0, [1.0; 2]).unwrap();
    let shape = shape(&Surface::Supertoroid(ring)).unwrap();
    let pieces = pieces(&shape);
    assert!(pieces.len() >= 16);
    let inside = |r: f64, angle: f64| {
        let p = from_point(&Point::new(r * angle.cos(), r * angle.sin(), 0.0));
        pieces.iter().any(|s| s.contains_local_point(p))
    };
    for k in 0..360 {
        let angle = TAU * k as f64 / 360.0;
        assert!(inside(0.04 - 1e-6, angle) && !inside(0.04 + 1e-6, angle));
        assert!(inside(0.02 + 1e-6, angle) && !inside(0.02 - 3e-4, angle));
    }
}

#[test]
fn what_has_no_shape_says_why() {
    let star = Surface::Superellipsoid(superellipsoid([0.1; 3], [1.0, 2.5]));
    assert_eq!(shape(&star).unwrap_err(), NoShape::Exponents { exponents: [1.0, 2.5] });
    let dust = Surface::Superellipsoid(superellipsoid([1e-150; 3], [1.0; 2]));
    assert!(matches!(shape(&dust), Err(NoShape::Degenerate { .. })));
    assert_eq!(compound(&[]).unwrap_err(), NoShape::Empty);
}

#[test]
fn parts_become_one_compound() {
    let cup = Surface::Superellipsoid(superellipsoid([0.03, 0.03, 0.05], [0.1, 1.0]));
    let handle = Surface::Supertoroid(Supertoroid::new([0.005; 3], 4.0, [1.0; 2]).unwrap());
    let parts = [
        Posed::new(cup, Pose::identity()).unwrap(),
        Posed::new(handle, Pose::new(Vector::new(0.03, 0.0, 0.0), Vector::x() * 1.5)).unwrap(),
    ];
    let whole = compound(&parts).unwrap();
    assert!(whole.as_compound().unwrap().shapes().len() > 16);
    assert!(shape(&cup).unwrap().as_shape::<ConvexSolid>().unwrap().superellipsoid().is_some());
}
