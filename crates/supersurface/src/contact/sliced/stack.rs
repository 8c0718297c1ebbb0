//! The slices of a superellipsoid across its z axis, deformed or not.
//!
//! At the angle `τ` of the profile stretched to a round one, `(r, t) = (cos τ, sin τ)/‖(cos τ, sin τ)‖` with the norm of `2/ε1`,
//! the slice has the half widths `a1 r (1 + Kx t)` and `a2 r (1 + Ky t)` and stands at `z = a3 t`. A twist turns it about the
//! axis, a bend carries it rigidly along the bent axis.

use super::body::NotSliced;
use super::outline::{around, spoke};
use super::slice::Disc;
use crate::deform::{Bend, Deformation, Taper, Twist};
use crate::numeric::superellipse::dual_norm;
use crate::shape::{InvalidShape, Superellipsoid};
use crate::surface::Solid;
use crate::{Point, Vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// A superellipsoid, what was done to it, and in this order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stack {
    core: Superellipsoid,
    taper: Option<Taper>,
    twist: Option<Twist>,
    bend: Option<Bend>,
}

impl Stack {
    pub(super) const SPAN: [f64; 2] = [-FRAC_PI_2, FRAC_PI_2];

    pub(super) fn new(solid: &Solid) -> Result<Self, NotSliced> {
        let (inner, bend) = match solid {
            Solid::Bent(s) => (s.shape(), Some(*s.deformation())),
            other => (other, None),
        };
        let (inner, twist) = match inner {
            Solid::Twisted(s) => (s.shape(), Some(*s.deformation())),
            other => (other, None),
        };
        let (inner, taper) = match inner {
            Solid::Tapered(s) => (s.shape(), Some(*s.deformation())),
            other => (other, None),
        };
        let Solid::Superellipsoid(core) = inner else { return Err(NotSliced::Kind(solid.name())) };
        let section = core.exponents()[1];
        InvalidShape::check(section <= 2.0, "exponent ε2", section, "at most 2 for convex slices")?;
        Ok(Self { core: *core, taper, twist, bend })
    }

    /// Taper along x and y from the middle to the upper end.
    fn slopes(&self) -> [f64; 2] {
        let [_, _, c] = self.core.semi_axes();
        self.taper.map_or([0.0; 2], |t| t.slopes().map(|k| k * c / t.half_height()))
    }

    /// How much a slice turns with its height, in radians a metre: about z, and along the bend.
    fn rates(&self) -> [f64; 2] {
        let twist = self.twist.map_or(0.0, |t| t.turns() * PI / t.half_height());
        [twist, self.bend.map_or(0.0, |b| b.curvature())]
    }

    pub(super) fn disc(&self, angle: f64) -> Disc {
        self.disc_of(spoke(self.core.exponents()[0], angle))
    }

    /// The slice of a point of the profile and its derivative.
    fn disc_of(&self, [[r, t], [to_r, to_t]]: [[f64; 2]; 2]) -> Disc {
        let [a, b, c] = self.core.semi_axes();
        let [_, e2] = self.core.exponents();
        let (z, to_z) = (c * t, c * to_t);
        let [kx, ky] = self.slopes();
        let width =
            |a: f64, k: f64| [a * r * (1.0 + k * t), a * (to_r * (1.0 + k * t) + r * k * to_t)];
        let [[w1, to_w1], [w2, to_w2]] = [width(a, kx), width(b, ky)];
        let mut disc = Disc {
            middle: Vector::new(0.0, 0.0, z),
            axes: [Vector::x(), Vector::y()],
            widths: [w1, w2],
            exponent: e2,
            velocity: Vector::new(0.0, 0.0, to_z),
            turning: Vector::zeros(),
            growth: [to_w1, to_w2],
        };
        let on_axis = Point::new(0.0, 0.0, z);
        let [twisted, bent] = self.rates();
        if let Some(twist) = &self.twist {
            let turn = twist.jacobian(&on_axis);
            disc.axes = disc.axes.map(|x| turn * x);
            disc.turning = Vector::new(0.0, 0.0, twisted * to_z);
        }
        if let Some(bend) = &self.bend {
            // a turn on the axis
            let turn = bend.jacobian(&on_axis);
            let (sin, cos) = bend.angle().sin_cos();
            disc.middle = bend.forward(&on_axis).coords;
            disc.velocity = turn * disc.velocity;
            disc.axes = disc.axes.map(|x| turn * x);
            disc.turning = turn * disc.turning + Vector::new(-sin, cos, 0.0) * (bent * to_z);
        }
        disc
    }

    /// A bound: as the slices between change in width, in height, and by turning.
    pub(super) fn way(&self, middle: f64, half: f64) -> f64 {
        let [a, b, c] = self.core.semi_axes();
        let at =
            |angle: f64| spoke(self.core.exponents()[0], angle.clamp(-FRAC_PI_2, FRAC_PI_2))[0];
        let ends = [at(middle - half), at(middle + half)];
        let [r, t] = at(middle);
        let widest = if middle.abs() < half { 1.0 } else { ends[0][0].max(ends[1][0]).max(r) };
        let thinner = ends.iter().map(|[other, _]| (other - r).abs()).fold(widest - r, f64::max);
        let higher = ends.iter().map(|[_, other]| (other - t).abs()).fold(0.0, f64::max);
        let [kx, ky] = self.slopes().map(f64::abs);
        let wider = |a: f64, k: f64| a * (thinner * (1.0 + k) + widest * k * higher);
        let reach = (a * (1.0 + kx)).hypot(b * (1.0 + ky)) * widest;
        let [twisted, bent] = self.rates().map(|rate| rate.abs() * c * higher * reach);
        let (across, along) = (wider(a, kx).hypot(wider(b, ky)), c * higher);
        let straight = if bent > 0.0 { across + along } else { across.hypot(along) };
        straight + twisted + bent
    }

    /// No point of the slices within an interval lies farther along a unit direction: they are those of a triangle
    /// around the profile's arc. A fixed point `(u, v)` of them is a smooth function of `(r, t)`, which is within half the second
    /// differential of the interpolation of its values at the corners.
    pub(super) fn extent(&self, ends: [f64; 2], way: &Vector) -> f64 {
        let corners = around(self.core.exponents()[0], ends);
        let reach = |corner: [f64; 2]| {
            let disc = self.disc_of([corner, [0.0; 2]]);
            let [u, v] = [0, 1].map(|k| (disc.widths[k] * disc.axes[k].dot(way)).abs());
            disc.middle.dot(way) + dual_norm(u, v, disc.exponent)
        };
        let farthest = corners.map(reach).into_iter().fold(f64::NEG_INFINITY, f64::max);
        let range = |k: usize| {
            let values = corners.map(|corner| corner[k]);
            let [low, high] =
                [f64::min, f64::max].map(|f| values.into_iter().reduce(f).unwrap_or(0.0));
            (high - low, high)
        };
        let ((dr, widest), (dt, _)) = (range(0), range(1));
        let [a, b, c] = self.core.semi_axes();
        let [kx, ky] = self.slopes().map(f64::abs);
        let (reach, tapered) = ((a * (1.0 + kx)).hypot(b * (1.0 + ky)), (a * kx).hypot(b * ky));
        let [twisted, bent] = self.rates().map(f64::abs);
        let turn = (twisted + bent) * c * dt;
        let across = reach * dr + tapered * widest * dt;
        let second = 2.0 * tapered * dr * dt
            + turn * (turn * reach * widest + 2.0 * across)
            + bent * (c * dt) * (c * dt);
        farthest + 0.5 * second
    }
}
