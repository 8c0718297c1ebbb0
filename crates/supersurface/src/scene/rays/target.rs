//! What rays from one point may meet: a part of a body or a board, in its own frame.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::Seen;
use super::bent::Bent;
use super::block::{Block, Hits, RAYS, Solid};
use super::bundle::{Bundle, Window};
use super::convex::{Approach, Convex};
use super::march::March;
use super::ring::Ring;
use super::tapered::Tapered;
use super::twisted::Twisted;
use crate::measure::first_hit;
use crate::numeric::lanes::{Job, Lane, dispatch};
use crate::scene::Board;
use crate::shape::{Implicit, Posed, Ray};
use crate::surface::Surface;
use crate::{Direction, Point, Pose, Vector};
use nalgebra::UnitQuaternion;

/// How hits are found.
enum Kind {
    Cuboid(Cuboid),
    Convex(Convex),
    Ring(Ring),
    Bent(Bent),
    Twisted(Twisted),
    Tapered(Tapered),
    Other(OneByOne),
}

/// A solid that fills its box well in its own frame.
pub(super) struct Target {
    /// Number of the body from 1; 0 for what is no body.
    pub(super) label: u32,
    kind: Kind,
    /// Lowest and highest corner.
    bounds: [[f64; 3]; 2],
    /// From its frame to the world, and to the optical frame, by rows.
    turn: [[f64; 3]; 3],
    to_optical: [[f64; 3]; 3],
    /// Where the rays start, in its frame.
    eye: [f64; 3],
    /// No point of it is nearer to there.
    pub(super) nearest: f64,
    /// Where it is seen.
    window: Window,
}

impl Target {
    /// A part of the body of a label, for a camera.
    pub(super) fn part(solid: &Posed<Surface>, label: u32, camera: &Pose) -> Self {
        let surface = *solid.shape();
        let known = if let Some(convex) = Convex::new(&surface) {
            Some(Kind::Convex(convex))
        } else {
            match &surface {
                Surface::Supertoroid(s) => Ring::new(s).map(Kind::Ring),
                Surface::Bent(s) => Bent::new(s).map(Kind::Bent),
                Surface::Twisted(s) => Twisted::new(s).map(Kind::Twisted),
                Surface::Tapered(s) => Tapered::new(s).map(Kind::Tapered),
                _ => None,
            }
        };
        let outside = solid.gauge(&Point::from(camera.translation.vector)) > 1.0;
        let kind = known.filter(|_| outside).unwrap_or(Kind::Other(OneByOne(surface)));
        Self::new(kind, &surface.bounds(), solid.pose(), label, camera)
    }

    /// A board, which is met from outside.
    pub(super) fn board(board: &Board, camera: &Pose) -> Option<Self> {
        let half = Point::from(board.half_extents);
        let local = board.pose.inverse_transform_point(&Point::from(camera.translation.vector));
        let outside = local.iter().zip(half.iter()).any(|(x, h)| x.abs() > *h);
        let kind = Kind::Cuboid(Cuboid { half: board.half_extents });
        outside.then(|| Self::new(kind, &[-half, half], &board.pose, 0, camera))
    }

    fn new(kind: Kind, [low, high]: &[Point; 2], pose: &Pose, label: u32, camera: &Pose) -> Self {
        let rows = |turn: UnitQuaternion<f64>| {
            let turn = turn.to_rotation_matrix();
            std::array::from_fn(|k| turn.matrix().row(k).into_owned().into())
        };
        let eye = Point::from(camera.translation.vector);
        let to_optical = camera.inverse() * pose;
        let middle = (to_optical * nalgebra::center(low, high)).coords;
        let corners: [_; 8] = std::array::from_fn(|corner| {
            let ends = std::array::from_fn(|k| if corner >> k & 1 == 0 { low[k] } else { high[k] });
            (to_optical * Point::from(ends)).into()
        });
        Self {
            label,
            kind,
            bounds: [(*low).into(), (*high).into()],
            turn: rows(pose.rotation),
            to_optical: rows(to_optical.rotation),
            eye: pose.inverse_transform_point(&eye).into(),
            nearest: middle.norm() - 0.5 * (high - low).norm(),
            window: Window::around(&corners),
        }
    }

    /// False where no ray of the bundle passes near it.
    pub(super) fn is_near(&self, bundle: &Bundle) -> bool {
        bundle.may_meet(&self.window)
    }

    /// Rays that meet it before what they have seen see it from now on.
    pub(super) fn meet(&self, bundle: &Bundle, seen: &mut Seen) {
        match &self.kind {
            Kind::Cuboid(solid) => self.meet_as(*solid, bundle, seen),
            Kind::Convex(solid) => self.meet_as(Approach::new(solid), bundle, seen),
            Kind::Ring(solid) => self.meet_as(March(*solid), bundle, seen),
            Kind::Bent(solid) => self.meet_as(March(*solid), bundle, seen),
            Kind::Twisted(solid) => self.meet_as(March(*solid), bundle, seen),
            Kind::Tapered(solid) => self.meet_as(March(*solid), bundle, seen),
            Kind::Other(solid) => self.meet_as(*solid, bundle, seen),
        }
    }

    fn meet_as(&self, solid: impl Solid, bundle: &Bundle, seen: &mut Seen) {
        dispatch(Meet { solid, target: self, bundle, seen });
    }
}

struct Meet<'a, S> {
    solid: S,
    target: &'a Target,
    bundle: &'a Bundle,
    seen: &'a mut Seen,
}

impl<S: Solid> Job for Meet<'_, S> {
    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        // copies: what a loop reads through a reference where a ray is closer becomes gathers
        let Target { turn, eye, bounds, to_optical, label, .. } = *self.target;
        let rays = &self.bundle.directions;
        let Seen { depth: nearest, label: labels, normal: [nx, ny, nz] } = self.seen;
        // whole blocks, so that no index has to be checked
        let [xs, ys, zs] = rays.each_ref().map(|column| column.as_chunks::<RAYS>().0);
        let all = nearest.as_chunks_mut::<RAYS>().0.iter_mut();
        let all = all.zip(xs.iter().zip(ys).zip(zs));
        let normals = nx.as_chunks_mut::<RAYS>().0.iter_mut();
        let normals = normals.zip(ny.as_chunks_mut::<RAYS>().0).zip(nz.as_chunks_mut::<RAYS>().0);
        let blocks = all.zip(normals.zip(labels.as_chunks_mut::<RAYS>().0));
        for ((nearest, ((xs, ys), zs)), (((nx, ny), nz), labels)) in blocks {
            // into the solid's frame, and what of the rays is in its box
            let mut block = Block::from(eye);
            (block.near, block.far) = ([0.0; RAYS], *nearest);
            for k in 0..3 {
                let [a, b] = [bounds[0][k] - eye[k], bounds[1][k] - eye[k]];
                for i in 0..RAYS {
                    let sum = xs[i].times_plus::<FUSED>(turn[0][k], ys[i] * turn[1][k]);
                    let d = zs[i].times_plus::<FUSED>(turn[2][k], sum);
                    block.directions[k][i] = d;
                    // along a face: infinities, or NaN that no comparison takes
                    let inverse = 1.0 / d;
                    let (enters, leaves) = if d < 0.0 { (b, a) } else { (a, b) };
                    let (enters, leaves) = (enters * inverse, leaves * inverse);
                    block.near[i] = if enters > block.near[i] { enters } else { block.near[i] };
                    block.far[i] = if leaves < block.far[i] { leaves } else { block.far[i] };
                }
            }
            let mut any = 0;
            for i in 0..RAYS {
                any |= u64::from(block.near[i] <= block.far[i]);
            }
            if any == 0 {
                continue;
            }
            let Hits { depth, normal: [xs, ys, zs] } = self.solid.hits::<FUSED>(&block);
            let mut any = 0;
            for i in 0..RAYS {
                any |= u64::from(depth[i] < nearest[i]);
            }
            if any == 0 {
                continue;
            }
            for i in 0..RAYS {
                let closer = depth[i] < nearest[i];
                // scaled first, as squares may overflow
                let largest = xs[i].abs().most(ys[i].abs()).most(zs[i].abs());
                let scale = 1.0 / largest.most(f64::TINY);
                let (x, y, z) = (xs[i] * scale, ys[i] * scale, zs[i] * scale);
                let inverse = 1.0 / (x * x + y * y + z * z).sqrt().most(f64::TINY);
                let (x, y, z) = (x * inverse, y * inverse, z * inverse);
                let turned = |row: &[f64; 3]| {
                    let sum = x.times_plus::<FUSED>(row[0], y * row[1]);
                    z.times_plus::<FUSED>(row[2], sum) as f32
                };
                let [x, y, z] =
                    [turned(&to_optical[0]), turned(&to_optical[1]), turned(&to_optical[2])];
                nx[i] = if closer { x } else { nx[i] };
                ny[i] = if closer { y } else { ny[i] };
                nz[i] = if closer { z } else { nz[i] };
                labels[i] = if closer { label } else { labels[i] };
                nearest[i] = if closer { depth[i] } else { nearest[i] };
            }
        }
    }
}

/// A board.
#[derive(Clone, Copy, Debug)]
struct Cuboid {
    half: [f64; 3],
}

impl Solid for Cuboid {
    #[inline(always)]
    fn hits<const FUSED: bool>(&mut self, block: &Block) -> Hits {
        let mut hits = Hits::NONE;
        let p = block.at::<FUSED>(&block.near);
        for i in 0..RAYS {
            let shares = [0, 1, 2].map(|k| p[k][i].abs() / self.half[k]);
            let largest = shares[0].most(shares[1]).most(shares[2]);
            for k in 0..3 {
                let face = if shares[k] < largest { 0.0 } else { 1.0 };
                hits.normal[k][i] = face.copysign(p[k][i]);
            }
            let met = block.near[i] <= block.far[i];
            hits.depth[i] = if met { block.near[i] } else { f64::INFINITY };
        }
        hits
    }
}

/// Any surface, ray by ray, also where rays start inside.
#[derive(Clone, Copy, Debug)]
struct OneByOne(Surface);

impl Solid for OneByOne {
    #[inline(always)]
    fn hits<const FUSED: bool>(&mut self, block: &Block) -> Hits {
        let mut hits = Hits::NONE;
        for i in 0..RAYS {
            let along = Vector::from(block.directions.map(|d| d[i]));
            let (direction, length) = Direction::new_and_get(along);
            let ray = Ray { origin: Point::from(block.origin), direction };
            // the end of the box may be rounded down
            let far = block.far[i] * (1.0 + 1e-12);
            let met = (block.near[i] <= far).then(|| first_hit(&self.0, &ray, far * length));
            if let Some(hit) = met.flatten() {
                hits.depth[i] = hit.distance / length;
                for k in 0..3 {
                    hits.normal[k][i] = hit.normal[k];
                }
            }
        }
        hits
    }
}
