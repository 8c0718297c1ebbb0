//! The convex hull of a sector of a supertoroid, between two angles around z.
//!
//! At the angle `ω` the toroid's slice lies in the plane of the spoke `p(ω) = (a1 cos^ε2 ω, a2 sin^ε2 ω)`: along it from
//! `a4 - 1` to `a4 + 1` of its length, `a3` up and down. With `s = p·n` its support function is
//! `a4 s + ‖(s, a3 n_z)‖_q1`, which grows with `s` as `a4 >= 1`: the hull's support point lies on the slice whose spoke
//! reaches farthest along `n`, and on a convex arc of spokes that is where the superellipse of the spokes is touched, or
//! the nearer end. The outside of the hull is the toroid's own; inside, at the hole, its faces are chords.

use std::f64::consts::TAU;

use supersurface::numeric::powers::{quadrant_cos_sin, signed_power};
use supersurface::shape::{Superellipsoid, Supertoroid, SupportMap};
use supersurface::{Point, Vector};

/// A sector's hull in the toroid's frame.
#[derive(Clone, Debug)]
pub(crate) struct Sector {
    toroid: Supertoroid,
    /// The spokes at both ends, counter-clockwise.
    ends: [[f64; 2]; 2],
    /// The section in the plane of x and z for a spoke of unit length.
    section: Superellipsoid,
    /// The superellipse of the spokes, as a body whose height does not matter.
    spokes: Superellipsoid,
}

impl Sector {
    /// All sectors of a toroid: `count` of them, a multiple of 8, so that the corners of square rings are seams. The
    /// exponents are at most 2.
    pub(crate) fn all(toroid: &Supertoroid, count: usize) -> Option<Vec<Self>> {
        let [a, b, c] = toroid.semi_axes();
        let [e1, e2] = toroid.exponents();
        let spokes = Superellipsoid::new([a, b, a.min(b)], [1.0, e2]).ok()?;
        let section = Superellipsoid::new([1.0, 1.0, c], [e1, 1.0]).ok()?;
        let spoke = |k: usize| spoke(toroid, k as f64 / count as f64 * TAU);
        let sectors = (0..count).map(|k| {
            let ends = [spoke(k), spoke((k + 1) % count)];
            Self { toroid: *toroid, ends, section, spokes }
        });
        Some(sectors.collect())
    }

    /// How far the chords of the hole's side lie inside of the hole, at most, in metres.
    pub(crate) fn deviation(&self) -> f64 {
        let [from, to] = self.ends;
        let chord = Vector::new(to[0] - from[0], to[1] - from[1], 0.0);
        let Some(out) = Vector::new(chord.y, -chord.x, 0.0).try_normalize(0.0) else { return 0.0 };
        let touched = self.reach(&[out.x, out.y]);
        let sagitta = out.x * (touched[0] - from[0]) + out.y * (touched[1] - from[1]);
        (self.toroid.ring_ratio() - 1.0) * sagitta.max(0.0)
    }

    /// The spoke of the arc that reaches farthest along a direction.
    fn reach(&self, n: &[f64; 2]) -> [f64; 2] {
        let touched = self.spokes.support_point(&Vector::new(n[0], n[1], 0.0));
        let [from, to] = self.ends;
        let touched = [touched.x, touched.y];
        if turns_left(&from, &touched) && turns_left(&touched, &to) {
            return touched;
        }
        let along = |p: &[f64; 2]| p[0] * n[0] + p[1] * n[1];
        if along(&from) >= along(&to) { from } else { to }
    }
}

impl SupportMap for Sector {
    fn support_point(&self, n: &Vector) -> Point {
        let p = self.reach(&super::planar(n));
        let along = p[0] * n.x + p[1] * n.y;
        let tube = self.section.support_point(&Vector::new(along, 0.0, n.z));
        let share = self.toroid.ring_ratio() + tube.x;
        Point::new(p[0] * share, p[1] * share, tube.z)
    }
}

/// The superellipse of the spokes at a parametric angle.
fn spoke(toroid: &Supertoroid, angle: f64) -> [f64; 2] {
    let [a, b, _] = toroid.semi_axes();
    let [_, e2] = toroid.exponents();
    let (cos, sin) = quadrant_cos_sin(angle);
    [a * signed_power(cos, e2), b * signed_power(sin, e2)]
}

fn turns_left(from: &[f64; 2], to: &[f64; 2]) -> bool {
    from[0] * to[1] - from[1] * to[0] >= 0.0
}
