//! Supertoroids that are tapered, twisted, bent, in this order (FORMULAS §4).
//!
//! The gauge is that of the point pulled back. Of a bend by the vector `b = k (cos α, sin α)` the inverse is, with
//! `B = 1 - b·(X, Y)`, `A² = b² Z²` and `h = √(A² + B²)`: `(x, y) = (X, Y) - b Z²/(h + B)`,
//! `z = Z atan2(A, B)/A`, smooth also where b is 0.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Rotation3;

use super::GenericShape;
use super::jet::Jet;
use super::member::{AXES, Body, Member, Range, range};
use super::search::Ground;
use crate::Vector;
use crate::fit::start::quantile;
use crate::shape::{InvalidShape, Supertoroid};
use crate::surface::Solid;

/// Which deformations are free.
#[derive(Clone, Copy, Debug)]
pub(super) struct Toroid {
    pub(super) taper: bool,
    pub(super) twist: bool,
    pub(super) bend: bool,
}

const RING: usize = 3;
const EXPONENT: usize = 4;
const TAPER: usize = 6;
const TWIST: usize = 8;
const BEND: usize = 9;
const COUNT: usize = 11;
/// Factors of a taper are not less than this: there is no body where they are.
const LEAST_FACTOR: f64 = 0.02;
/// Shares of the points that lie within the hole of a start: a few that noise or outliers put there, or more of them.
const HOLES: [f64; 2] = [0.04, 0.15];

impl Member for Toroid {
    const POSED: bool = true;
    const START_SCALE: f64 = 0.06;

    fn range(&self, number: usize) -> Range {
        let free = |free: bool, most: f64| {
            if free { range(-most, most, 0.3) } else { range(0.0, 0.0, 0.0) }
        };
        match number {
            RING => range(1.05, 15.0, 0.7),
            EXPONENT | 5 => range(0.1, 1.9, 0.4),
            TAPER | 7 => free(self.taper, 0.95),
            TWIST => free(self.twist, 1.0),
            BEND.. => free(self.bend, 1.5),
            _ => range(AXES[0], AXES[1], 0.7),
        }
    }

    fn log_gauge(&self, n: &[Jet], point: &[Jet; 3]) -> Jet {
        let Some([a, b, c, ring, e1, e2, kx, ky, turns, bx, by]) = n.first_chunk::<COUNT>() else {
            return Jet::constant(0.0);
        };
        let [mut x, mut y, mut z] = *point;
        if self.bend {
            let rest = Jet::constant(1.0) - *bx * x - *by * y;
            let square = (*bx * *bx + *by * *by) * z * z;
            let h = (square + rest * rest).sqrt();
            let shift = z * z * (h + rest + 1e-9).inverse();
            (x, y) = (x - *bx * shift, y - *by * shift);
            z = z * arc(&square, &rest);
        }
        let height = z * (-*c).exp();
        if self.twist {
            let [cos, sin] = (*turns * (height + 1.0) * PI).cos_sin();
            (x, y) = (cos * x + sin * y, cos * y - sin * x);
        }
        if self.taper {
            let factor = |k: &Jet| {
                let f = *k * height + 1.0;
                if f.value < LEAST_FACTOR { Jet::constant(LEAST_FACTOR) } else { f }
            };
            (x, y) = (x * factor(kx).inverse(), y * factor(ky).inverse());
        }
        let planar = Jet::layer(&(x.log() - *a), &(y.log() - *b), e2).exp();
        Jet::layer(&(planar - *ring).log(), &(z.log() - *c), e1)
    }

    fn shape(&self, n: &[f64], scale: f64) -> Result<GenericShape, InvalidShape> {
        let at = |k: usize| n.get(k).copied().unwrap_or(0.0);
        let axes = [0, 1, 2].map(|k| at(k).exp() * scale);
        let mut solid =
            Solid::from(Supertoroid::new(axes, at(RING), [at(EXPONENT), at(EXPONENT + 1)])?);
        if self.taper {
            solid = solid.tapered([at(TAPER), at(TAPER + 1)])?;
        }
        if self.twist {
            solid = solid.twisted(at(TWIST))?;
        }
        if self.bend {
            let (x, y) = (at(BEND), at(BEND + 1));
            solid = solid.bent(x.hypot(y) / scale, y.atan2(x))?;
        }
        Ok(GenericShape::Solid(solid))
    }
}

/// `atan2(A, B)/A` as a function of `A²`, which may be 0, and of B.
fn arc(square: &Jet, rest: &Jet) -> Jet {
    if square.value > 1e-4 {
        let root = square.sqrt();
        return Jet::atan2(&root, rest) * root.inverse();
    }
    let inverse = rest.inverse();
    let t = *square * inverse * inverse;
    inverse * (t * (t * 0.2 + (-1.0 / 3.0)) + 1.0)
}

impl Toroid {
    /// The toroid that explains the undeformed cloud best, and rings in the boxes of other frames, each with the
    /// deformations at rest and a little off it.
    pub(super) fn starts(&self, ground: &Ground) -> Vec<Body<Self>> {
        let mut out = Vec::new();
        let mut push = |numbers: [f64; 6], position: Vector, rotation: Rotation3<f64>| {
            for [turns, bx, by] in self.deformations() {
                let mut all = numbers.to_vec();
                all.extend([0.0, 0.0, turns, bx, by]);
                // a turn of the lower end is a turn of the whole
                let rotation = rotation * Rotation3::new(Vector::z() * (-turns * PI));
                out.push(Body { member: *self, numbers: all, position, rotation });
            }
        };
        if let Some((ring, frame)) = &ground.toroid {
            let [a, b, c] = frame.half.map(f64::ln);
            let [e1, e2] = frame.exponents;
            push([a, b, c, *ring, e1, e2], frame.position, frame.rotation);
            let turned = frame.rotation * Rotation3::new(Vector::z() * (0.5 * FRAC_PI_2));
            let mean = 0.5 * (a + b);
            push([mean, mean, c, *ring, e1, 1.0], frame.position, turned);
        }
        for frame in ground.frames.iter().flat_map(|f| f.roles()) {
            let [a, b, c] = frame.half;
            let radius = |p: &Vector| {
                let q = frame.rotation.inverse_transform_vector(&(p - frame.position));
                (q.z.abs() < c).then(|| (q.x / a).hypot(q.y / b))
            };
            let mut radii: Vec<f64> =
                ground.points.iter().filter_map(radius).filter(|r| *r < 1.1).collect();
            for share in HOLES {
                let hole = quantile(&mut radii, share).clamp(0.1, 0.8);
                let ring = (1.0 + hole) / (1.0 - hole);
                let [a, b] = [a, b].map(|v| (v / (1.0 + ring)).ln());
                push([a, b, c.ln(), ring, 0.7, 0.7], frame.position, frame.rotation);
            }
        }
        out
    }

    /// Turns and bends to begin with.
    fn deformations(&self) -> Vec<[f64; 3]> {
        let turns: &[f64] = if self.twist { &[0.0, 0.12, -0.12] } else { &[0.0] };
        let bends: &[[f64; 2]] = if self.bend {
            &[[0.0, 0.0], [0.3, 0.0], [-0.3, 0.0], [0.0, 0.3], [0.0, -0.3]]
        } else {
            &[[0.0, 0.0]]
        };
        turns.iter().flat_map(|t| bends.iter().map(|[x, y]| [*t, *x, *y])).collect()
    }
}
