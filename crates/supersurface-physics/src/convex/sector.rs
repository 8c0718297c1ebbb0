//! The convex hull of a supertoroid, or of a sector of it between two angles around z.
//!
//! At the angle `ω` the toroid's slice lies in the plane of the spoke `p(ω) = (a1 cos^ε2 ω, a2 sin^ε2 ω)`: along it from
//! `a4 - 1` to `a4 + 1` of its length, `a3` up and down. With `s = p·n` its support function is
//! `a4 s + ‖(s, a3 n_z)‖_q1`, which grows with `s` as `a4 >= 1`: the hull's support point lies on the slice whose spoke
//! reaches farthest along `n`, and on a convex arc of spokes that is where the superellipse of the spokes is touched, or
//! the nearer end. The outside of the hull is the toroid's own; inside, at the hole, its faces are chords.

use std::f64::consts::TAU;

use supersurface::numeric::powers::{quadrant_cos_sin, signed_power};
use supersurface::numeric::superellipse::touched;
use supersurface::shape::{Supertoroid, SupportMap};
use supersurface::{Point, Vector};

/// A hull in the toroid's frame.
#[derive(Clone, Debug)]
pub(crate) struct Sector {
    toroid: Supertoroid,
    /// Where it begins and ends, counter-clockwise; `None` for the whole ring.
    ends: Option<[End; 2]>,
}

/// An end of a sector: its spoke, and the normal of the superellipse of spokes there.
#[derive(Clone, Debug)]
struct End {
    spoke: [f64; 2],
    normal: [f64; 2],
}

impl Sector {
    /// The hull of a whole ring.
    pub(crate) const fn ring(toroid: &Supertoroid) -> Self {
        Self { toroid: *toroid, ends: None }
    }

    /// All sectors of a toroid: `count` of them, a multiple of 8, so that the corners of square rings are seams. The
    /// exponents are at most 2.
    pub(crate) fn all(toroid: &Supertoroid, count: usize) -> Vec<Self> {
        let end = |k: usize| End::at(toroid, k as f64 / count as f64 * TAU);
        let ends = |k| Some([end(k), end((k + 1) % count)]);
        (0..count).map(|k| Self { toroid: *toroid, ends: ends(k) }).collect()
    }

    /// How far the chords of the hole's side lie inside of the hole, at most, in metres.
    pub(crate) fn deviation(&self) -> f64 {
        let Some([from, to]) = &self.ends else { return 0.0 };
        let [from, to] = [from.spoke, to.spoke];
        let chord = Vector::new(to[0] - from[0], to[1] - from[1], 0.0);
        let Some(out) = Vector::new(chord.y, -chord.x, 0.0).try_normalize(0.0) else { return 0.0 };
        let touched = self.reach(&[out.x, out.y]);
        let sagitta = out.x * (touched[0] - from[0]) + out.y * (touched[1] - from[1]);
        (self.toroid.ring_ratio() - 1.0) * sagitta.max(0.0)
    }

    /// The spoke of the arc that reaches farthest along a direction.
    fn reach(&self, n: &[f64; 2]) -> [f64; 2] {
        let touched = || {
            let [a, b, _] = self.toroid.semi_axes();
            let [_, e2] = self.toroid.exponents();
            let (_, [x, y]) = touched((a * n[0]).abs(), (b * n[1]).abs(), e2);
            [(a * x).copysign(n[0]), (b * y).copysign(n[1])]
        };
        let Some([from, to]) = &self.ends else { return touched() };
        // of most directions no power needs to be known
        if turns_left(&from.normal, n) && turns_left(n, &to.normal) {
            let touched = touched();
            if turns_left(&from.spoke, &touched) && turns_left(&touched, &to.spoke) {
                return touched;
            }
        }
        let along = |end: &End| end.spoke[0] * n[0] + end.spoke[1] * n[1];
        if along(from) >= along(to) { from.spoke } else { to.spoke }
    }
}

impl SupportMap for Sector {
    fn support_point(&self, n: &Vector) -> Point {
        let [_, _, c] = self.toroid.semi_axes();
        let [e1, _] = self.toroid.exponents();
        let p = self.reach(&super::planar(n));
        // the section for a spoke of unit length
        let along = p[0] * n.x + p[1] * n.y;
        let (_, [x, z]) = touched(along.abs(), (c * n.z).abs(), e1);
        let share = self.toroid.ring_ratio() + x.copysign(along);
        Point::new(p[0] * share, p[1] * share, (c * z).copysign(n.z))
    }
}

impl End {
    /// At a parametric angle.
    fn at(toroid: &Supertoroid, angle: f64) -> Self {
        let [a, b, _] = toroid.semi_axes();
        let [_, e2] = toroid.exponents();
        let (cos, sin) = quadrant_cos_sin(angle);
        let spoke = [a * signed_power(cos, e2), b * signed_power(sin, e2)];
        Self { spoke, normal: [signed_power(cos, 2.0 - e2) / a, signed_power(sin, 2.0 - e2) / b] }
    }
}

fn turns_left(from: &[f64; 2], to: &[f64; 2]) -> bool {
    from[0] * to[1] - from[1] * to[0] >= 0.0
}
