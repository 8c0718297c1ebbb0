//! Support point in closed form (FORMULAS §9).

use super::Superellipsoid;
use crate::numeric::powers::quick_power;
use crate::numeric::superellipse::dual_exponent;
use crate::shape::SupportMap;
use crate::{Point, Vector};

impl SupportMap for Superellipsoid {
    /// With `u_i = |a_i n_i|`, `g = ‖(u1, u2)‖_q2`, `h = ‖(g, u3)‖_q1`, `t = ε/(2 - ε)`:
    /// `x = a1 sgn(n_x) (u1/g)^t2 (g/h)^t1`, likewise y; `z = a3 sgn(n_z) (u3/h)^t1`.
    /// From ε = 2 the support point of the convex hull.
    fn support_point(&self, n: &Vector) -> Point {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let u = [(a1 * n.x).abs(), (a2 * n.y).abs(), (a3 * n.z).abs()];
        let (g, [x, y]) = touched(u[0], u[1], e2);
        let (h, [planar, z]) = touched(g, u[2], e1);
        if h == 0.0 || !h.is_finite() {
            let largest = n.amax();
            return match h == f64::INFINITY && largest > 1.0 && largest.is_finite() {
                true => self.support_point(&(n / largest)),
                false => Point::origin(),
            };
        }
        Point::new(
            (a1 * x * planar).copysign(n.x),
            (a2 * y * planar).copysign(n.y),
            (a3 * z).copysign(n.z),
        )
    }
}

/// The dual norm of a non-negative pair, and `(part/norm)^(q-1)` of both parts: where the unit curve of the exponent is
/// touched. With `r = small/large` and `q = 2/(2-ε)` the larger part has `(1 + r^q)^(-ε/2)`, which times `1 + r^q` is the
/// norm, too. For ε >= 2 the larger takes all, of equal ones the first.
fn touched(first: f64, second: f64, epsilon: f64) -> (f64, [f64; 2]) {
    let in_order = |large: f64, small: f64| match first >= second {
        true => [large, small],
        false => [small, large],
    };
    let [large, small] = in_order(first, second);
    let ratio = small / large;
    if epsilon >= 2.0 || small == 0.0 || ratio == 0.0 || large == f64::INFINITY {
        return (large, in_order(1.0, 0.0));
    }
    if epsilon == 1.0 {
        let m = (1.0 + ratio * ratio).sqrt();
        return (large * m, in_order(1.0 / m, ratio / m));
    }
    let q = dual_exponent(epsilon);
    let other = quick_power(ratio, q - 1.0);
    let t = ratio * other;
    let share = quick_power(1.0 + t, -0.5 * epsilon);
    (large * (1.0 + t) * share, in_order(share, other * share))
}
