//! Support point in closed form (FORMULAS §9).

use super::Superellipsoid;
use crate::numeric::superellipse::touched;
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
