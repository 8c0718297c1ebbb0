//! Scenes of things of a household, in all layouts: at rest, none lost, and no overlap by exact queries.

use supersurface::contact::{Convex, WarmStart, pair};
use supersurface::measure::ClosestFinder;
use supersurface::scene::{Layout, Scene, arrange, draw};
use supersurface::shape::{Implicit, Parametric, Posed, SupportMap};
use supersurface::surface::{Solid, Surface};
use supersurface::{Point, Vector};
use supersurface_io::read_things;
use supersurface_physics::{SettleOptions, settle_scene};

use crate::scenes;

/// Points along each of both parameters.
const POINTS: usize = 48;

fn points(part: &Posed<Surface>) -> Vec<Point> {
    let solid = Solid::from(*part.shape());
    let [eta, omega] = solid.domain();
    let at = |[from, to]: [f64; 2], k: usize| from + (to - from) * k as f64 / POINTS as f64;
    let grid = (0..=POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j)));
    let point = |(i, j)| solid.point(at(eta, i), at(omega, j));
    grid.map(|at| part.pose() * point(at)).collect()
}

/// The deepest overlap of parts of different bodies, in metres: exact between superellipsoids, else that of points of one
/// surface in the other solid.
fn deepest(scene: &Scene) -> f64 {
    let bodies = scene.bodies.iter().enumerate();
    let parts: Vec<_> =
        bodies.flat_map(|(k, b)| b.solids().into_iter().map(move |s| (k, s))).collect();
    let mut deepest = 0.0f64;
    let convex = |part: &Posed<Surface>| match part.shape() {
        Surface::Superellipsoid(s) => Posed::new(Convex::new(*s).ok()?, *part.pose()).ok(),
        _ => None,
    };
    for (i, (body, a)) in parts.iter().enumerate() {
        for (_, b) in parts[..i].iter().filter(|(other, _)| other != body) {
            if let (Some(a), Some(b)) = (convex(a), convex(b)) {
                deepest = deepest.max(-pair(&a, &b, &mut WarmStart::default()).distance);
            }
        }
        let finder = match a.shape() {
            Surface::Superellipsoid(s) => ClosestFinder::superellipsoid(s),
            Surface::Supertoroid(s) => ClosestFinder::supertoroid(s),
            _ => continue,
        };
        for (_, b) in parts.iter().filter(|(other, _)| other != body) {
            let inside = points(b).into_iter().map(|p| a.to_local(&p));
            for p in inside.filter(|p| a.shape().contains(p)) {
                deepest = deepest.max(finder.find(&p).map_or(0.0, |found| -found.distance));
            }
        }
        let below = a.pose().rotation.inverse() * -Vector::z();
        let lowest = a.pose().translation.z - a.shape().support(&below);
        deepest = deepest.max(-lowest);
    }
    deepest
}

/// `SUPERSURFACE_SCENES` says how many of each layout.
#[test]
fn scenes_of_a_household_lie_still_and_apart() {
    let things = read_things("household").unwrap();
    for seed in 0..scenes::count("SUPERSURFACE_SCENES", 2) {
        for layout in [Layout::Single, Layout::Pile, Layout::Packed, Layout::Shelf] {
            let bodies = if layout == Layout::Single { 1 } else { 10 };
            let mut scene = arrange(draw(&things, bodies, seed).unwrap(), layout, seed).unwrap();
            let settled = settle_scene(&mut scene, &SettleOptions::default()).unwrap();
            assert!(settled.all_at_rest(), "seed {seed}, {layout:?} moves");
            assert!(settled.overlap < 1e-4, "seed {seed}, {layout:?}: {settled:?}");
            let deepest = deepest(&scene);
            assert!(deepest < 1e-3, "seed {seed}, {layout:?}: {deepest} m");
        }
    }
}
