//! Settling of what is not convex, on shelves, and of what is wrong.

use supersurface::combine::Part;
use supersurface::contact::{Sliced, half_space, solids};
use supersurface::shape::{Plane, Posed, Superellipsoid, Supertoroid};
use supersurface::surface::{Solid, Surface};
use supersurface::{Point, Pose, Vector};
use supersurface_physics::{
    Falling, Ground, NoShape, SettleError, SettleOptions, integration_parameters, settle,
};

use crate::scenes;

fn superellipsoid(axes: [f64; 3], exponents: [f64; 2]) -> Superellipsoid {
    Superellipsoid::new(axes, exponents).unwrap()
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let run = || {
        let (solids, starts) = scenes::pile(7);
        let bodies: Vec<Falling> = solids
            .iter()
            .zip(&starts)
            .take(5)
            .map(|(s, at)| scenes::falling(Surface::Superellipsoid(*s), *at))
            .collect();
        settle(&bodies, &scenes::bin(), &SettleOptions::default()).unwrap()
    };
    let first = run();
    let again = std::thread::spawn(run).join().unwrap();
    assert_eq!(format!("{first:?}"), format!("{again:?}"));
}

#[test]
fn a_ring_falls_over_a_peg() {
    let toroid = Supertoroid::new([0.01; 3], 3.0, [1.0; 2]).unwrap();
    let peg = superellipsoid([0.012, 0.012, 0.05], [0.1, 1.0]);
    let bodies = [
        scenes::falling(Surface::Superellipsoid(peg), Pose::translation(0.0, 0.0, 0.05)),
        scenes::falling(Surface::Supertoroid(toroid), Pose::translation(0.003, 0.0, 0.13)),
    ];
    let settled = settle(&bodies, &Ground::default(), &SettleOptions::default()).unwrap();
    assert!(settled.all_at_rest());
    let [peg_at, ring_at] = [settled.bodies[0].pose, settled.bodies[1].pose];
    assert!((ring_at.translation.z - 0.01).abs() < 3e-4, "{ring_at}");
    let ring = Posed::new(Solid::from(toroid), ring_at).unwrap();
    let peg = Posed::new(Solid::from(peg), peg_at).unwrap();
    let [ring, peg] = [ring, peg].map(|solid| Sliced::new(&solid).unwrap());
    // apart, or so near that the exact query calls it an overlap of nothing
    assert!(solids(&ring, &peg).unwrap().distance > -1e-4);
    assert!(settled.overlap < 1e-4);
}

#[test]
fn cut_solids_and_bodies_of_parts_rest_on_the_floor() {
    let stick = superellipsoid([0.01, 0.012, 0.06], [0.3, 1.0]);
    let surfaces = [
        Surface::bent(stick, 12.0, 0.3).unwrap(),
        Surface::twisted(superellipsoid([0.01, 0.02, 0.05], [0.2, 0.2]), 0.25).unwrap(),
        Surface::tapered(superellipsoid([0.03, 0.03, 0.05], [0.2, 1.0]), [0.3, 0.3]).unwrap(),
    ];
    let floor = Plane::through(&Point::origin(), Vector::z_axis());
    for surface in surfaces {
        let bodies = [scenes::falling(surface, Pose::translation(0.0, 0.0, 0.1))];
        let settled = settle(&bodies, &Ground::default(), &SettleOptions::default()).unwrap();
        assert!(settled.all_at_rest(), "{surface:?}");
        let posed = Posed::new(surface, settled.bodies[0].pose).unwrap();
        let gap = half_space(&posed, &floor).distance;
        assert!(gap.abs() < 5e-4, "{surface:?}: {gap}");
    }
    // a hammer
    let part = |s, pose| scenes::part(Surface::Superellipsoid(s), pose);
    let head = superellipsoid([0.02, 0.02, 0.05], [0.1, 0.1]);
    let hammer = Falling {
        parts: vec![
            part(stick, Pose::identity()),
            part(head, Pose::new(Vector::new(0.0, 0.0, 0.06), Vector::x() * 1.57)),
        ],
        ..scenes::falling(Surface::Superellipsoid(stick), Pose::translation(0.0, 0.0, 0.1))
    };
    let settled = settle(&[hammer], &Ground::default(), &SettleOptions::default()).unwrap();
    assert!(settled.all_at_rest() && settled.overlap < 1e-4);
}

#[test]
fn a_shelf_holds_what_lies_on_it_and_the_rest_is_lost() {
    let tin = Surface::Superellipsoid(superellipsoid([0.03, 0.03, 0.05], [0.1, 1.0]));
    let bodies = [
        scenes::falling(tin, Pose::translation(0.0, 0.0, 0.56)),
        scenes::falling(tin, Pose::translation(0.5, 0.0, 0.6)),
    ];
    let board = (Pose::translation(0.0, 0.0, 0.49), [0.2, 0.1, 0.01]);
    let ground = Ground { floor: None, cuboids: vec![board], ..Ground::default() };
    let settled = settle(&bodies, &ground, &SettleOptions::default()).unwrap();
    assert!(settled.bodies[0].at_rest && !settled.bodies[0].lost);
    assert!((settled.bodies[0].pose.translation.z - 0.55).abs() < 5e-4);
    assert!(settled.bodies[1].lost && !settled.bodies[1].at_rest && !settled.all_at_rest());
}

#[test]
fn bodies_that_start_in_each_other_are_taken_apart() {
    let ball = Surface::Superellipsoid(superellipsoid([0.03; 3], [1.0; 2]));
    let bodies = [0.0, 0.01, 0.02].map(|x| scenes::falling(ball, Pose::translation(x, 0.0, 0.02)));
    let options = SettleOptions { time_limit: 0.0, ..SettleOptions::default() };
    let settled = settle(&bodies, &Ground::default(), &options).unwrap();
    assert!(settled.simulated_overlap > 0.03 && settled.overlap <= options.tolerance);
}

#[test]
fn wrong_numbers_are_errors() {
    let ball = Surface::Superellipsoid(superellipsoid([0.03; 3], [1.0; 2]));
    let good = scenes::falling(ball, Pose::identity());
    let (ground, options) = (Ground::default(), SettleOptions::default());
    let part = Part::new("air", *good.parts[0].body(), 0.0).unwrap();
    let light = Falling { parts: vec![part], ..good.clone() };
    let error = settle(&[good.clone(), light], &ground, &options).unwrap_err();
    assert!(error.to_string().starts_with("density is 0"), "{error}");
    let nothing = Falling { parts: Vec::new(), ..good.clone() };
    let error = settle(&[nothing], &ground, &options).unwrap_err();
    assert_eq!(error, SettleError::Body { body: 0, why: NoShape::Empty });
    let still = SettleOptions { gravity: Vector::zeros(), ..options.clone() };
    assert!(settle(&[good], &ground, &still).is_err());
    assert!(settle(&[], &ground, &options).unwrap().all_at_rest());
    assert!(integration_parameters(0.5, 100.0).dt == 0.01);
}
