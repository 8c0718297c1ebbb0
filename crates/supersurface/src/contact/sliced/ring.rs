//! A supertoroid's slices: one at each angle around its z axis.
//!
//! The angle `τ` is that of the ring stretched to a round one: the slice lies in the half plane through
//! `P(τ) = (a1 cos τ, a2 sin τ)/‖(cos τ, sin τ)‖` with the norm of `2/ε2`, and reaches from `(a4 - 1) P` to `(a4 + 1) P`.

use super::outline::{around, spoke};
use super::slice::Disc;
use crate::Vector;
use crate::numeric::superellipse::dual_norm;
use crate::shape::{InvalidShape, Supertoroid};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// A supertoroid whose section is convex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring(Supertoroid);

impl Ring {
    pub(super) const SPAN: [f64; 2] = [0.0, TAU];

    pub(super) fn new(shape: &Supertoroid) -> Result<Self, InvalidShape> {
        let section = shape.exponents()[0];
        InvalidShape::check(section <= 2.0, "exponent ε1", section, "at most 2 for convex slices")?;
        Ok(Self(*shape))
    }

    /// `P` and `P'`.
    fn spoke(&self, angle: f64) -> [[f64; 2]; 2] {
        let [a, b, _] = self.0.semi_axes();
        spoke(self.0.exponents()[1], angle).map(|[x, y]| [a * x, b * y])
    }

    pub(super) fn disc(&self, angle: f64) -> Disc {
        let [[x, y], [to_x, to_y]] = self.spoke(angle);
        let length = x.hypot(y);
        let out = Vector::new(x / length, y / length, 0.0);
        let to = Vector::new(to_x, to_y, 0.0);
        Disc {
            middle: out * (length * self.0.ring_ratio()),
            axes: [out, Vector::z()],
            widths: [length, self.0.semi_axes()[2]],
            exponent: self.0.exponents()[0],
            velocity: to * self.0.ring_ratio(),
            turning: out.cross(&to) / length,
            growth: [out.dot(&to), 0.0],
        }
    }

    /// That of the tube's outer edge.
    pub(super) fn way(&self, middle: f64, half: f64) -> f64 {
        let [x, y] = self.spoke(middle)[0];
        let to = |angle: f64| {
            let [p, q] = self.spoke(angle)[0];
            (p - x).hypot(q - y)
        };
        // corners that may lie between, and farther out than both ends
        let places = [0.0, FRAC_PI_4, 2.0 * FRAC_PI_4, 3.0 * FRAC_PI_4];
        let between = places.iter().map(|place| {
            let nearest = place + ((middle - place) / PI).round() * PI;
            if (nearest - middle).abs() < half { to(nearest) } else { 0.0 }
        });
        (1.0 + self.0.ring_ratio())
            * between.fold(to(middle - half).max(to(middle + half)), f64::max)
    }

    /// No point of the slices within an interval lies farther along a direction: `(a4 + u) P·n + v a3 n_z` is convex in `P`.
    pub(super) fn extent(&self, ends: [f64; 2], way: &Vector) -> f64 {
        let [a, b, c] = self.0.semi_axes();
        let [e1, e2] = self.0.exponents();
        let reach = |[x, y]: [f64; 2]| {
            let along = a * x * way.x + b * y * way.y;
            self.0.ring_ratio() * along + dual_norm(along.abs(), (c * way.z).abs(), e1)
        };
        around(e2, ends).map(reach).into_iter().fold(f64::NEG_INFINITY, f64::max)
    }
}
