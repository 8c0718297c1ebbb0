//! A ring's slices: flat convex discs, one at each angle around its z axis, whose union it is.
//!
//! The angle `τ` is that of the ring stretched to a round one: the slice lies in the half plane through
//! `P(τ) = (a1 cos τ, a2 sin τ)/‖(cos τ, sin τ)‖` with the norm of `2/ε2`, and reaches from `(a4 - 1) P` to `(a4 + 1) P`.
//! A point `s P` of it moves with the angle by `s P'`, so that the distance of a body from the slice changes by
//! `-n·P' s` for the witness point `s P` and the normal `n`: the minima over the angle are roots of that.

use crate::contact::pair::pair_by_cells;
use crate::contact::{Contact, Convex, WarmStart};
use crate::numeric::superellipse::weighted;
use crate::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use crate::{Pose, Vector};
use nalgebra::{Translation3, UnitQuaternion};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// Thickness of a slice relative to its smaller half width: no slice has none in the pair's query.
const THIN: f64 = 1e-10;
/// Cells of directions that may be looked at for the depth of a body in one slice, of which many are asked.
const CELLS: usize = 300;
/// Steps of the search for a root, which halves the interval at least every second time.
const ROOT_STEPS: usize = 60;
/// A minimum is found where the interval's ends can differ by this at most, relative to the ring's size.
const SETTLED: f64 = 1e-14;

/// The slice at an angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slice {
    pub(super) angle: f64,
    disc: Posed<Convex>,
    /// `|P|` in metres.
    length: f64,
    /// `P'` in the world, in metres a radian.
    velocity: Vector,
}

/// The contact of a body with a slice, and its derivative by the slice's angle in metres a radian.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) angle: f64,
    pub(super) contact: Contact,
    pub(super) slope: f64,
}

/// `P(τ)` and `P'(τ)`.
fn spoke(shape: &Supertoroid, angle: f64) -> [[f64; 2]; 2] {
    let [a, b, _] = shape.semi_axes();
    let (sin, cos) = angle.sin_cos();
    let planar = weighted(cos.abs(), sin.abs(), 2.0 / shape.exponents()[1]);
    let share = |weight: f64, c: f64| if c == 0.0 { 0.0 } else { weight / c };
    let rate = sin * cos * (share(planar.second, sin * sin) - share(planar.first, cos * cos));
    let by = |value: f64| value / planar.norm;
    [[a * by(cos), b * by(sin)], [-a * by(sin + cos * rate), b * by(cos - sin * rate)]]
}

impl Slice {
    /// The slices at the middles of so many equal intervals.
    pub(super) fn around(
        torus: &Posed<Supertoroid>,
        count: usize,
    ) -> Result<Vec<Self>, InvalidShape> {
        let width = TAU / count as f64;
        // off the seams, where the slice is that of a corner for small ε2
        (0..count).map(|k| Self::new(torus, (k as f64 + 0.5) * width)).collect()
    }

    pub(super) fn new(torus: &Posed<Supertoroid>, angle: f64) -> Result<Self, InvalidShape> {
        let shape = torus.shape();
        let [[x, y], [to_x, to_y]] = spoke(shape, angle);
        let (length, height) = (x.hypot(y), shape.semi_axes()[2]);
        let thin = THIN * length.min(height);
        let disc = Superellipsoid::new([length, thin, height], [shape.exponents()[0], 1.0])?;
        let middle = Vector::new(x, y, 0.0) * shape.ring_ratio();
        let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), y.atan2(x));
        let place = Pose::from_parts(Translation3::from(middle), turn);
        let disc = Posed::new(Convex::new(disc)?, torus.pose() * place)?;
        let velocity = torus.pose().rotation * Vector::new(to_x, to_y, 0.0);
        Ok(Self { angle, disc, length, velocity })
    }

    /// True where the balls around the slice and a body are apart.
    pub(super) fn clear_of(&self, body: &Posed<Convex>) -> bool {
        let apart = body.pose().translation.vector - self.disc.pose().translation.vector;
        // a body lies within the box of its semi-axes
        let reach = |b: &Posed<Convex>| Vector::from(b.shape().shape().semi_axes()).norm();
        apart.norm() > reach(&self.disc) + reach(body)
    }

    /// The contact with a body. The slice is A.
    pub(super) fn touch(
        &self,
        torus: &Posed<Supertoroid>,
        body: &Posed<Convex>,
        start: &mut WarmStart,
    ) -> Touch {
        let contact = pair_by_cells(&self.disc, body, start, CELLS);
        let local = torus.to_local(&contact.witnesses[0]);
        let along = local.x.hypot(local.y) / self.length;
        let slope = -along * contact.normal.dot(&self.velocity);
        Touch { angle: self.angle, contact, slope }
    }
}

/// The longest way from the slice at an angle to one within another of it, in metres: that of the tube's outer edge.
pub(super) fn way(shape: &Supertoroid, middle: f64, half: f64) -> f64 {
    let [x, y] = spoke(shape, middle)[0];
    let to = |angle: f64| {
        let [p, q] = spoke(shape, angle)[0];
        (p - x).hypot(q - y)
    };
    // corners that may lie between, and farther out than both ends
    let places = [0.0, FRAC_PI_4, 2.0 * FRAC_PI_4, 3.0 * FRAC_PI_4];
    let between = places.iter().map(|place| {
        let nearest = place + ((middle - place) / PI).round() * PI;
        if (nearest - middle).abs() < half { to(nearest) } else { 0.0 }
    });
    (1.0 + shape.ring_ratio()) * between.fold(to(middle - half).max(to(middle + half)), f64::max)
}

/// The minimum of the distance over the angle between two slices, of which the first's falls and the second's rises, by
/// the regula falsi with halved ends (Illinois) and halves. Where the slope jumps, the least that was met.
pub(super) fn minimum(
    torus: &Posed<Supertoroid>,
    body: &Posed<Convex>,
    ends: [&Touch; 2],
    start: &mut WarmStart,
) -> Result<Touch, InvalidShape> {
    let [mut low, mut high] = ends.map(|end| (end.angle, end.slope));
    let nearer = ends[0].contact.distance <= ends[1].contact.distance;
    let mut best = if nearer { *ends[0] } else { *ends[1] };
    let size = torus.shape().semi_axes().into_iter().fold(0.0, f64::max);
    for step in 0..ROOT_STEPS {
        let width = high.0 - low.0;
        let straight = low.0 + width * (low.1 / (low.1 - high.1));
        let angle = match straight.is_finite() && step % 3 != 2 {
            true => straight.clamp(low.0 + 1e-3 * width, high.0 - 1e-3 * width),
            false => low.0 + 0.5 * width,
        };
        let found = Slice::new(torus, angle)?.touch(torus, body, start);
        if found.contact.distance < best.contact.distance {
            best = found;
        }
        if found.slope.abs() * width <= SETTLED * size || width <= 1e-15 * PI {
            break;
        }
        if found.slope < 0.0 {
            low = (angle, found.slope);
            high.1 *= 0.5;
        } else {
            high = (angle, found.slope);
            low.1 *= 0.5;
        }
    }
    Ok(best)
}
