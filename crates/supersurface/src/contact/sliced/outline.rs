//! A superellipse of half widths 1 by the angle of its points, and triangles around its arcs.

use crate::numeric::superellipse::weighted;

/// Tangents that turn by less than this meet nowhere that matters.
const STRAIGHT: f64 = 1e-12;

/// The point towards an angle, and its derivative by that: `(cos τ, sin τ)/‖(cos τ, sin τ)‖` with the norm of `2/ε`.
pub(super) fn spoke(exponent: f64, angle: f64) -> [[f64; 2]; 2] {
    let (sin, cos) = angle.sin_cos();
    let planar = weighted(cos.abs(), sin.abs(), 2.0 / exponent);
    let share = |weight: f64, c: f64| if c == 0.0 { 0.0 } else { weight / c };
    let rate = sin * cos * (share(planar.second, sin * sin) - share(planar.first, cos * cos));
    let by = |value: f64| value / planar.norm;
    [[by(cos), by(sin)], [-by(sin + cos * rate), by(cos - sin * rate)]]
}

/// Corners of a triangle around the arc between two angles of one quadrant: its ends, and where their tangents meet.
pub(super) fn around(exponent: f64, ends: [f64; 2]) -> [[f64; 2]; 3] {
    let [[p, along_p], [q, along_q]] = ends.map(|angle| spoke(exponent, angle));
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let chord = [q[0] - p[0], q[1] - p[1]];
    let turn = cross(along_p, along_q);
    let lengths = along_p[0].hypot(along_p[1]) * along_q[0].hypot(along_q[1]);
    if turn.abs() <= STRAIGHT * lengths {
        return [p, p, q];
    }
    // between 0 and what brings it to the end's tangent
    let share = (cross(chord, along_q) / turn).max(0.0);
    [p, [p[0] + share * along_p[0], p[1] + share * along_p[1]], q]
}
