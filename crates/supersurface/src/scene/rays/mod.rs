//! What the rays of a camera meet in a scene: exact surfaces, not meshes.
//!
//! Rays come in bundles of neighbours. A solid that the cone around a bundle does not touch is left out for all of them; of
//! the others the box of the solid leaves some, which are followed in blocks: to convex solids by tangent planes
//! ([`convex`]), to others by certified steps ([`march`]).

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

mod bent;
mod block;
mod bundle;
mod convex;
mod march;
mod ring;
mod tapered;
mod target;
mod twisted;

pub(super) use bundle::MOST;

use bundle::{Bundle, Column};
use target::{Met, Target};

use crate::numeric::lanes::{Job, Lane, dispatch};
use crate::scene::Scene;
use crate::{Point, Pose, Vector};

/// The surfaces of a scene, ready for the rays of one camera.
pub(super) struct Rays<'a> {
    scene: &'a Scene,
    /// Nearer ones first.
    targets: Vec<Target>,
    pose: Pose,
}

/// What the ray of a pixel meets.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    /// Along the optical axis, in metres.
    pub(super) depth: f64,
    /// Cosine of the angle between ray and normal.
    pub(super) incidence: f64,
    /// Number of the body from 1; 0 for what is no body.
    pub(super) label: u32,
    /// Outward unit normal in the world; zero where nothing is met.
    pub(super) normal: nalgebra::Vector3<f32>,
}

/// Where a ray meets nothing.
pub(super) const NOTHING: Seen = Seen {
    depth: f64::INFINITY,
    incidence: 1.0,
    label: 0,
    normal: nalgebra::Vector3::new(0.0, 0.0, 0.0),
};

impl<'a> Rays<'a> {
    /// For a camera whose optical frame stands at `pose` in the world.
    pub(super) fn new(scene: &'a Scene, pose: &Pose) -> Self {
        let eye = Point::from(pose.translation.vector);
        let labelled = scene.bodies.iter().zip(1..);
        let parts = labelled.flat_map(|(body, label)| {
            body.solids().into_iter().map(move |solid| Target::part(&solid, label, &eye))
        });
        let boards = scene.boards.iter().filter_map(|board| Target::board(board, &eye));
        let mut targets: Vec<Target> = boards.chain(parts).collect();
        targets.sort_by(|a, b| a.nearest().total_cmp(&b.nearest()));
        Self { scene, targets, pose: *pose }
    }

    /// What each of up to [`MOST`] rays meets first; `along` are the points at depth 1 that they pass, in the optical frame.
    pub(super) fn see(&self, along: &[Vector]) -> [Seen; MOST] {
        let bundle = Bundle::new(along, &self.pose);
        let mut nearest = self.table(&bundle);
        let mut seen = [NOTHING; MOST];
        let up = self.scene.support.normal().into_inner();
        let normal = up.cast();
        let d = &bundle.directions;
        for i in 0..bundle.count {
            if nearest[i].is_finite() {
                let incidence = (up.x * d[0][i] + up.y * d[1][i] + up.z * d[2][i]).abs();
                seen[i] = Seen { incidence, normal, ..NOTHING };
            }
        }
        for target in self.targets.iter().filter(|t| t.is_near(&bundle)) {
            target.meet(&bundle, &mut nearest, |ray, met| {
                let Met { normal, incidence } = *met;
                seen[ray] = Seen { incidence, label: target.label, normal, ..NOTHING };
            });
        }
        for i in 0..bundle.count {
            seen[i].depth = nearest[i] / bundle.lengths[i];
        }
        seen
    }

    /// How far the table's top is along each ray; infinite where there is none.
    fn table(&self, bundle: &Bundle) -> Column {
        let origin = Point::from(self.pose.translation.vector);
        let mut distance = [f64::INFINITY; MOST];
        dispatch(Table {
            up: self.scene.support.normal().into_inner().into(),
            height: self.scene.support.height(&origin),
            origin: [origin.x, origin.y],
            half_size: self.scene.half_size,
            directions: &bundle.directions,
            distance: &mut distance,
        });
        distance
    }

    /// How many of up to [`MOST`] rays would meet each body, were nothing before it.
    pub(super) fn alone(&self, along: &[Vector]) -> Vec<u32> {
        let bundle = Bundle::new(along, &self.pose);
        let mut met_by = vec![[false; MOST]; self.scene.bodies.len()];
        for target in self.targets.iter().filter(|t| t.is_near(&bundle)) {
            let Some(body) = met_by.get_mut((target.label as usize).wrapping_sub(1)) else {
                continue;
            };
            target.meet(&bundle, &mut [f64::INFINITY; MOST], |ray, _| body[ray] = true);
        }
        met_by.iter().map(|rays| rays.iter().filter(|met| **met).count() as u32).collect()
    }
}

/// Where rays cross the table's top.
struct Table<'a> {
    up: [f64; 3],
    height: f64,
    origin: [f64; 2],
    half_size: [f64; 2],
    directions: &'a [Column; 3],
    distance: &'a mut Column,
}

impl Job for Table<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [xs, ys, zs] = self.directions;
        let [up_x, up_y, up_z] = self.up;
        for i in 0..MOST {
            let along = xs[i].times_plus::<FUSED>(up_x, ys[i] * up_y);
            let t = -self.height / zs[i].times_plus::<FUSED>(up_z, along);
            let x = t.times_plus::<FUSED>(xs[i], self.origin[0]).abs();
            let y = t.times_plus::<FUSED>(ys[i], self.origin[1]).abs();
            let on = t > 0.0 && x <= self.half_size[0] && y <= self.half_size[1];
            self.distance[i] = if on { t } else { f64::INFINITY };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::first_hit;
    use crate::numeric::random::Stream;
    use crate::scene::{Body, facing};
    use crate::shape::{Implicit, Ray, Superellipsoid, Supertoroid};
    use crate::surface::Surface;
    use crate::{Direction, Point};

    /// Bundles of rays at solids drawn by `draw` meet what single rays meet; returns how many met and missed.
    fn compare(cases: u64, draw: impl Fn(&mut Stream) -> Option<Surface>) -> [usize; 2] {
        let (mut counts, mut other) = ([0; 2], 0);
        for k in 0..cases {
            let mut stream = Stream::new(3, k);
            let Some(surface) = draw(&mut stream) else { continue };
            let [low, high] = surface.bounds();
            let size = (high - low).norm();
            let mut around =
                |r: f64| Vector::from([(); 3].map(|()| r * size * stream.between(-1.0, 1.0)));
            let eye = Point::from(around(1.5));
            if surface.gauge(&eye) < 1.2 {
                continue;
            }
            let mut scene = Scene::empty([0.0; 2]);
            scene.bodies.push(Body::single("it", surface, Pose::identity()).unwrap());
            let pose = facing(&eye, &Point::from(around(0.25)));
            let along: Vec<Vector> = (0..MOST)
                .map(|_| Vector::new(stream.between(-0.3, 0.3), stream.between(-0.3, 0.3), 1.0))
                .collect();
            let seen = Rays::new(&scene, &pose).see(&along);
            for (seen, along) in seen.iter().zip(&along) {
                let ray = Ray { origin: eye, direction: pose * Direction::new_normalize(*along) };
                let slow = first_hit(&surface, &ray, 100.0 * size);
                let quick = seen.depth * along.norm();
                counts[usize::from(!quick.is_finite())] += 1;
                if quick.is_finite() {
                    let gauge = surface.gauge(&ray.at(quick));
                    assert!((gauge - 1.0).abs() < 1e-9, "{surface:?} {ray:?} {gauge}");
                    let normal = surface.gradient(&ray.at(quick)).normalize();
                    let turned = normal.dot(&seen.normal.cast());
                    assert!(
                        turned > 1.0 - 1e-3 || surface.exponents().iter().any(|e| *e < 0.3),
                        "{surface:?} {ray:?} {turned}"
                    );
                }
                match slow {
                    Some(hit) if (quick - hit.distance).abs() < 1e-7 * size => (),
                    // what samples miss
                    Some(hit) if quick < hit.distance => other += 1,
                    None if quick.is_finite() => other += 1,
                    None => (),
                    Some(hit) => {
                        // a ray that grazes by less than rounding
                        let depth = surface.gauge(&ray.at(hit.distance + 1e-5 * size)) - 1.0;
                        assert!(depth > -1e-9, "{surface:?} {ray:?} {} {quick}", hit.distance);
                    }
                }
            }
        }
        let all: usize = counts.iter().sum();
        println!("{counts:?} {other}");
        assert!(other * 1000 < all, "{other} of {all}");
        counts
    }

    fn core(stream: &mut Stream) -> Superellipsoid {
        let mut draw = |low, high| stream.between(low, high);
        let axes = [draw(0.1, 1.0), draw(0.1, 1.0), draw(0.1, 1.0)];
        let mut exponent = || if draw(0.0, 1.0) < 0.3 { 1.0 } else { draw(0.05, 2.0) };
        Superellipsoid::new(axes, [exponent(), exponent()]).unwrap()
    }

    #[test]
    fn superellipsoids_are_met_where_single_rays_meet_them() {
        let [met, missed] = compare(300, |stream| Some(Surface::Superellipsoid(core(stream))));
        assert!(met > 10_000 && missed > 10_000);
    }

    #[test]
    fn tapered_ones_too() {
        let [met, missed] = compare(300, |stream| {
            let slope = stream.between(-0.95, 0.95);
            let other = if stream.uniform() < 0.5 { slope } else { stream.between(-0.95, 0.95) };
            Surface::tapered(core(stream), [slope, other]).ok()
        });
        assert!(met > 10_000 && missed > 10_000);
    }

    #[test]
    fn twisted_ones_too() {
        let [met, missed] = compare(150, |stream| {
            let turns = stream.between(-0.6, 0.6);
            Surface::twisted(core(stream), turns).ok()
        });
        assert!(met > 5_000 && missed > 5_000);
    }

    #[test]
    fn bent_ones_too() {
        let [met, missed] = compare(300, |stream| {
            let core = core(stream);
            let angle = stream.between(-3.1, 3.1);
            Surface::bent(core, angle / core.semi_axes()[2], stream.between(-3.0, 3.0)).ok()
        });
        assert!(met > 5_000 && missed > 5_000);
    }

    #[test]
    fn rings_too() {
        let [met, missed] = compare(300, |stream| {
            let core = core(stream);
            let ratio = stream.between(1.0, 6.0);
            Supertoroid::new(core.semi_axes(), ratio, core.exponents())
                .ok()
                .map(Surface::Supertoroid)
        });
        assert!(met > 10_000 && missed > 10_000);
    }
}
