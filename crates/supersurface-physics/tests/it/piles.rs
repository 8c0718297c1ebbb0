//! Ten bodies in a bin: at rest, none lost, and no overlap by the library's own query.

use supersurface::contact::{Convex, certify, contacts, half_space};
use supersurface::shape::{Plane, Posed};
use supersurface::surface::Surface;
use supersurface::{Point, Vector};
use supersurface_physics::{Falling, SettleOptions, settle};

use crate::scenes;

#[test]
fn piles_of_ten_lie_still_and_apart() {
    let floor = Plane::through(&Point::origin(), Vector::z_axis());
    let walls = scenes::bin().cuboids.into_iter().map(|(pose, half)| {
        let wall = supersurface::shape::Superellipsoid::new(half, [1e-6; 2]).unwrap();
        Posed::new(Convex::new(wall).unwrap(), pose).unwrap()
    });
    let walls: Vec<_> = walls.collect();
    for seed in 0..scenes::count("SUPERSURFACE_PILES", 4) {
        let (solids, starts) = scenes::pile(seed);
        let bodies: Vec<Falling> = solids
            .iter()
            .zip(&starts)
            .map(|(s, at)| scenes::falling(Surface::Superellipsoid(*s), *at))
            .collect();
        let settled = settle(&bodies, &scenes::bin(), &SettleOptions::default()).unwrap();
        assert!(settled.all_at_rest(), "seed {seed} moves");
        let placed: Vec<_> = solids
            .iter()
            .zip(&settled.bodies)
            .map(|(s, body)| Posed::new(Convex::new(*s).unwrap(), body.pose).unwrap())
            .collect();
        let mut deepest = 0.0f64;
        for contact in contacts(&placed, 0.0) {
            deepest = deepest.max(-contact.contact.distance);
        }
        for body in &placed {
            deepest = deepest.max(-half_space(body, &floor).distance);
            for wall in &walls {
                deepest = deepest.max(-certify(body, wall, 1e-3).distance);
            }
            let [x, y, z] = body.pose().translation.vector.into();
            assert!(x.abs() < 0.11 && y.abs() < 0.11 && z > 0.0, "seed {seed} lost one");
        }
        assert!(deepest < 1e-4, "seed {seed}: {deepest} m");
    }
}
