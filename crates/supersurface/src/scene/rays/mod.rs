//! What the rays of a camera meet in a scene: exact surfaces, not meshes.
//!
//! Rays come in bundles of neighbours. A solid whose window at depth 1 is beside that of a bundle is left out for all of
//! them; the others are followed in blocks through the box: to convex solids by tangent planes
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

pub(super) use block::RAYS;
pub(super) use bundle::{Along, MOST};

use bundle::{Bundle, Column};
use target::Target;

use crate::numeric::lanes::{Job, Lane, dispatch};
use crate::scene::Scene;
use crate::{Point, Pose};

/// The surfaces of a scene, ready for the rays of one camera.
pub(super) struct Rays<'a> {
    scene: &'a Scene,
    /// Nearer ones first.
    targets: Vec<Target>,
    pose: Pose,
}

/// What the rays of a bundle meet first.
pub(super) struct Seen {
    /// Along the optical axis, in metres; infinite where nothing is met.
    pub(super) depth: Column,
    /// Number of the body from 1; 0 for what is no body.
    pub(super) label: [u32; MOST],
    /// Outward unit normal in the optical frame; zero where nothing is met.
    pub(super) normal: [[f32; MOST]; 3],
}

impl Seen {
    pub(super) const fn nothing() -> Self {
        Self { depth: [f64::INFINITY; MOST], label: [0; MOST], normal: [[0.0; MOST]; 3] }
    }
}

impl<'a> Rays<'a> {
    /// For a camera whose optical frame stands at `pose` in the world.
    pub(super) fn new(scene: &'a Scene, pose: &Pose) -> Self {
        let labelled = scene.bodies.iter().zip(1..);
        let parts = labelled.flat_map(|(body, label)| {
            body.solids().into_iter().map(move |solid| Target::part(&solid, label, pose))
        });
        let boards = scene.boards.iter().filter_map(|board| Target::board(board, pose));
        let mut targets: Vec<Target> = boards.chain(parts).collect();
        targets.sort_by(|a, b| a.nearest.total_cmp(&b.nearest));
        Self { scene, targets, pose: *pose }
    }

    /// What the rays meet first.
    pub(super) fn see(&self, along: &Along, seen: &mut Seen) {
        let bundle = Bundle::new(along, &self.pose);
        let up = self.scene.support.normal();
        let origin = Point::from(self.pose.translation.vector);
        dispatch(Table {
            up: up.into_inner().into(),
            height: self.scene.support.height(&origin),
            origin: [origin.x, origin.y],
            half_size: self.scene.half_size,
            normal: self.pose.rotation.inverse_transform_vector(&up).cast::<f32>().into(),
            directions: &bundle.directions,
            seen,
        });
        for target in self.targets.iter().filter(|t| t.is_near(&bundle)) {
            target.meet(&bundle, seen);
        }
    }

    /// Which of the rays would meet each body, were nothing before it.
    pub(super) fn alone(&self, along: &Along) -> Vec<[bool; MOST]> {
        let bundle = Bundle::new(along, &self.pose);
        let mut seen = Seen::nothing();
        let mut met_by = vec![[false; MOST]; self.scene.bodies.len()];
        for target in self.targets.iter().filter(|t| t.is_near(&bundle)) {
            let body = met_by.get_mut((target.label as usize).wrapping_sub(1));
            let Some(body) = body else { continue };
            seen.depth = [f64::INFINITY; MOST];
            target.meet(&bundle, &mut seen);
            body.iter_mut().zip(&seen.depth).for_each(|(met, t)| *met |= t.is_finite());
        }
        met_by
    }
}

impl Seen {
    /// Cosine of the angle between each ray and the normal where it ends; 1 where nothing is met.
    pub(super) fn incidence(&self, along: &Along) -> [f32; MOST] {
        let mut cosines = [1.0; MOST];
        let [nx, ny, nz] = &self.normal;
        for i in 0..MOST {
            let (x, y) = (along.x[i], along.y[i]);
            let [nx, ny, nz] = [nx[i], ny[i], nz[i]].map(f64::from);
            let cosine = (nx * x + ny * y + nz).abs() / (x * x + y * y + 1.0).sqrt();
            cosines[i] = if self.depth[i].is_finite() { cosine as f32 } else { 1.0 };
        }
        cosines
    }
}

/// Where rays cross the table's top.
struct Table<'a> {
    up: [f64; 3],
    height: f64,
    origin: [f64; 2],
    half_size: [f64; 2],
    /// In the optical frame.
    normal: [f32; 3],
    directions: &'a [Column; 3],
    seen: &'a mut Seen,
}

impl Job for Table<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [xs, ys, zs] = self.directions;
        let [up_x, up_y, up_z] = self.up;
        for i in 0..MOST {
            let along = xs[i].times_plus::<FUSED>(up_x, ys[i] * up_y);
            let along = zs[i].times_plus::<FUSED>(up_z, along);
            let t = -self.height / along;
            let x = t.times_plus::<FUSED>(xs[i], self.origin[0]).abs();
            let y = t.times_plus::<FUSED>(ys[i], self.origin[1]).abs();
            let on = t > 0.0 && x <= self.half_size[0] && y <= self.half_size[1];
            self.seen.depth[i] = if on { t } else { f64::INFINITY };
            self.seen.label[i] = 0;
            for k in 0..3 {
                self.seen.normal[k][i] = if on { self.normal[k] } else { 0.0 };
            }
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
    use crate::{Direction, Vector};

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
            let [x, y] = [(); 2].map(|()| [(); MOST].map(|()| stream.between(-0.3, 0.3)));
            let along = Along { x, y };
            let bundle = Bundle::new(&along, &pose);
            let mut seen = Seen::nothing();
            let rays = Rays::new(&scene, &pose);
            for target in rays.targets.iter().filter(|t| t.is_near(&bundle)) {
                target.meet(&bundle, &mut seen);
            }
            for (i, depth) in seen.depth.into_iter().enumerate() {
                let along = Vector::new(x[i], y[i], 1.0);
                let quick = depth * along.norm();
                let ray = Ray { origin: eye, direction: pose * Direction::new_normalize(along) };
                let slow = first_hit(&surface, &ray, 100.0 * size);
                counts[usize::from(!quick.is_finite())] += 1;
                if quick.is_finite() {
                    let gauge = surface.gauge(&ray.at(quick));
                    assert!((gauge - 1.0).abs() < 1e-9, "{surface:?} {ray:?} {gauge}");
                    let normal = surface.gradient(&ray.at(quick)).normalize();
                    let told = Vector::from(seen.normal.map(|row| f64::from(row[i])));
                    let turned = normal.dot(&(pose.rotation * told));
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
        assert!(met > 4_000 && missed > 4_000);
    }

    #[test]
    fn tapered_ones_too() {
        let [met, missed] = compare(300, |stream| {
            let slope = stream.between(-0.95, 0.95);
            let other = if stream.uniform() < 0.5 { slope } else { stream.between(-0.95, 0.95) };
            Surface::tapered(core(stream), [slope, other]).ok()
        });
        assert!(met > 4_000 && missed > 4_000);
    }

    #[test]
    fn twisted_ones_too() {
        let [met, missed] = compare(150, |stream| {
            let turns = stream.between(-0.6, 0.6);
            Surface::twisted(core(stream), turns).ok()
        });
        assert!(met > 2_000 && missed > 2_000);
    }

    #[test]
    fn bent_ones_too() {
        let [met, missed] = compare(300, |stream| {
            let core = core(stream);
            let angle = stream.between(-3.1, 3.1);
            Surface::bent(core, angle / core.semi_axes()[2], stream.between(-3.0, 3.0)).ok()
        });
        assert!(met > 2_000 && missed > 2_000);
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
        assert!(met > 4_000 && missed > 4_000);
    }
}
