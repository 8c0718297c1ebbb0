//! What rays from one point may meet: a part of a body or a board, in its own frame.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::bent::Bent;
use super::block::{Block, Hits, Row};
use super::bundle::{Bundle, Column, MOST};
use super::convex::{Convex, Planes};
use super::march::march;
use super::ring::Ring;
use super::tapered::Tapered;
use super::twisted::Twisted;
use crate::measure::first_hit;
use crate::numeric::lanes::{Job, Lane, WIDTH, dispatch};
use crate::scene::Board;
use crate::shape::{Implicit, Posed, Ray};
use crate::surface::Surface;
use crate::{Direction, Point, Pose, Vector};

/// How hits are found.
enum Kind {
    Cuboid,
    Convex(Convex),
    Ring(Ring),
    Bent(Bent),
    Twisted(Twisted),
    Tapered(Tapered),
    /// Ray by ray, also where rays start inside.
    Other(Surface),
}

/// A solid that fills its box well in its own frame.
pub(super) struct Target {
    /// Number of the body from 1; 0 for what is no body.
    pub(super) label: u32,
    kind: Kind,
    /// Lowest and highest corner.
    bounds: [[f64; 3]; 2],
    /// From its frame to the world, by rows.
    turn: [[f64; 3]; 3],
    /// Where the rays start, in its frame.
    eye: [f64; 3],
    /// To the middle of the ball around it, in the world.
    to: Vector,
    radius: f64,
}

/// How a ray meets a surface.
pub(super) struct Met {
    /// Outward unit normal in the world.
    pub(super) normal: nalgebra::Vector3<f32>,
    /// Cosine of the angle between ray and normal.
    pub(super) incidence: f64,
}

impl Target {
    /// A part of the body of a label.
    pub(super) fn part(solid: &Posed<Surface>, label: u32, eye: &Point) -> Self {
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
        let kind = known.filter(|_| solid.gauge(eye) > 1.0).unwrap_or(Kind::Other(surface));
        Self::new(kind, &surface.bounds(), solid.pose(), label, eye)
    }

    /// A board, which is met from outside.
    pub(super) fn board(board: &Board, eye: &Point) -> Option<Self> {
        let half = Point::from(board.half_extents);
        let local = board.pose.inverse_transform_point(eye);
        let outside = local.iter().zip(half.iter()).any(|(x, h)| x.abs() > *h);
        outside.then(|| Self::new(Kind::Cuboid, &[-half, half], &board.pose, 0, eye))
    }

    fn new(kind: Kind, [low, high]: &[Point; 2], pose: &Pose, label: u32, eye: &Point) -> Self {
        let turn = pose.rotation.to_rotation_matrix();
        Self {
            label,
            kind,
            bounds: [(*low).into(), (*high).into()],
            turn: std::array::from_fn(|k| turn.matrix().row(k).into_owned().into()),
            eye: pose.inverse_transform_point(eye).into(),
            to: pose * nalgebra::center(low, high) - eye,
            radius: 0.5 * (high - low).norm(),
        }
    }

    /// False where the bundle passes the ball around it.
    pub(super) fn is_near(&self, bundle: &Bundle) -> bool {
        bundle.may_meet(&self.to, self.radius)
    }

    /// No point of it is nearer to where the rays start.
    pub(super) fn nearest(&self) -> f64 {
        self.to.norm() - self.radius
    }

    /// Tells `take` of every ray that meets it nearer than `nearest`, which becomes its distance.
    pub(super) fn meet(
        &self,
        bundle: &Bundle,
        nearest: &mut Column,
        mut take: impl FnMut(usize, &Met),
    ) {
        let mut inside = Stretch { directions: [[0.0; MOST]; 3], near: [0.0; MOST], far: *nearest };
        dispatch(Clip { target: self, directions: &bundle.directions, stretch: &mut inside });
        let mut passing = [0; MOST];
        let mut count = 0;
        for i in 0..bundle.count {
            passing[count] = i;
            count += usize::from(inside.near[i] <= inside.far[i]);
        }
        let mut planes = Planes::default();
        for rays in passing[..count].chunks(WIDTH) {
            let block = inside.block(rays, self.eye);
            let hits = match &self.kind {
                Kind::Cuboid => self.faces(&block),
                Kind::Convex(solid) => solid.hits(&block, &mut planes),
                Kind::Ring(solid) => march(solid, &block),
                Kind::Bent(solid) => march(solid, &block),
                Kind::Twisted(solid) => march(solid, &block),
                Kind::Tapered(solid) => march(solid, &block),
                Kind::Other(surface) => one_by_one(surface, &block),
            };
            let mut incidence = [0.0; WIDTH];
            let mut normal = hits.normal;
            dispatch(Turn {
                turn: &self.turn,
                block: &block,
                normal: &mut normal,
                incidence: &mut incidence,
            });
            for (i, ray) in rays.iter().enumerate() {
                if hits.distance[i] < nearest[*ray] {
                    nearest[*ray] = hits.distance[i];
                    let normal = normal.map(|row| row[i] as f32).into();
                    take(*ray, &Met { normal, incidence: incidence[i] });
                }
            }
        }
    }

    /// The faces of the box.
    fn faces(&self, block: &Block) -> Hits {
        let mut hits = Hits { distance: block.near, ..Hits::NONE };
        for i in 0..WIDTH {
            let at = |k: usize| block.origin[k] + block.near[i] * block.directions[k][i];
            let share = |k: &usize| at(*k).abs() / self.bounds[1][*k];
            let axis = (0..3).max_by(|a, b| share(a).total_cmp(&share(b))).unwrap_or(0);
            hits.normal[axis][i] = 1f64.copysign(at(axis));
        }
        hits
    }
}

/// Hits of single rays, from inside too.
fn one_by_one(surface: &Surface, block: &Block) -> Hits {
    let mut hits = Hits::NONE;
    for i in 0..WIDTH {
        let direction = Direction::new_unchecked(Vector::from(block.directions.map(|d| d[i])));
        let ray = Ray { origin: Point::from(block.origin), direction };
        // the end of the box may be rounded down
        if let Some(hit) = first_hit(surface, &ray, block.far[i] * (1.0 + 1e-12)) {
            hits.distance[i] = hit.distance;
            for k in 0..3 {
                hits.normal[k][i] = hit.normal[k];
            }
        }
    }
    hits
}

/// The rays of a bundle in a solid's frame, and where they are in its box.
struct Stretch {
    directions: [Column; 3],
    near: Column,
    far: Column,
}

impl Stretch {
    /// Some rays; the last of a block that is not full is repeated.
    fn block(&self, rays: &[usize], origin: [f64; 3]) -> Block {
        let rays: [usize; WIDTH] = std::array::from_fn(|i| rays[i.min(rays.len() - 1)]);
        let of = |column: &Column| rays.map(|ray| column[ray]);
        let directions = [0, 1, 2].map(|k| of(&self.directions[k]));
        Block { origin, directions, near: of(&self.near), far: of(&self.far) }
    }
}

/// Turns rays into a solid's frame and cuts off what is outside its box.
struct Clip<'a> {
    target: &'a Target,
    directions: &'a [Column; 3],
    stretch: &'a mut Stretch,
}

impl Job for Clip<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Target { turn, eye, bounds, .. } = self.target;
        let [xs, ys, zs] = self.directions;
        let Stretch { directions, near, far } = self.stretch;
        for k in 0..3 {
            let [low, high] = [bounds[0][k] - eye[k], bounds[1][k] - eye[k]];
            for i in 0..MOST {
                let sum = xs[i].times_plus::<FUSED>(turn[0][k], ys[i] * turn[1][k]);
                let d = zs[i].times_plus::<FUSED>(turn[2][k], sum);
                directions[k][i] = d;
                // along a face: infinities, or NaN that no comparison takes
                let inverse = 1.0 / d;
                let (enters, leaves) = if d < 0.0 {
                    (high * inverse, low * inverse)
                } else {
                    (low * inverse, high * inverse)
                };
                near[i] = if enters > near[i] { enters } else { near[i] };
                far[i] = if leaves < far[i] { leaves } else { far[i] };
            }
        }
    }
}

/// Turns normals into the world and makes them unit ones.
struct Turn<'a> {
    turn: &'a [[f64; 3]; 3],
    block: &'a Block,
    normal: &'a mut [Row; 3],
    incidence: &'a mut Row,
}

impl Job for Turn<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [xs, ys, zs] = *self.normal;
        let d = &self.block.directions;
        for i in 0..WIDTH {
            let (x, y, z) = (xs[i], ys[i], zs[i]);
            // scaled first, as squares may overflow
            let largest = x.abs().most(y.abs()).most(z.abs()).most(f64::TINY);
            let (x, y, z) = (x / largest, y / largest, z / largest);
            let inverse = 1.0 / (x * x + y * y + z * z).sqrt().most(f64::TINY);
            let (x, y, z) = (x * inverse, y * inverse, z * inverse);
            self.incidence[i] = (x * d[0][i] + y * d[1][i] + z * d[2][i]).abs();
            for k in 0..3 {
                let row = &self.turn[k];
                let sum = x.times_plus::<FUSED>(row[0], y * row[1]);
                self.normal[k][i] = z.times_plus::<FUSED>(row[2], sum);
            }
        }
    }
}
