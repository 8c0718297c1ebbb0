//! Implicit form: gauge and gradient (equation 9, FORMULAS §0.1).

use super::Superellipsoid;
use crate::numeric::superellipse::{norm, weighted};
use crate::shape::{Implicit, SupportMap, finite_or_zero};
use crate::{Point, Vector};

impl Implicit for Superellipsoid {
    /// `g = (ρ̂^p1 + |z/a3|^p1)^(1/p1)` with `ρ̂ = (|x/a1|^p2 + |y/a2|^p2)^(1/p2)`, `p = 2/ε`.
    #[inline]
    fn gauge(&self, p: &Point) -> f64 {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let radius = norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / e2);
        norm(radius, (p.z / a3).abs(), 2.0 / e1)
    }

    /// `∂g/∂x = g w1 w2 / x`, `∂g/∂y = g w1 (1 - w2) / y`, `∂g/∂z = g (1 - w1) / z`; a component is
    /// 0 where its coordinate is (the limit for ε < 2).
    fn gradient(&self, p: &Point) -> Vector {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let (u, v, w) = ((p.x / a1).abs(), (p.y / a2).abs(), (p.z / a3).abs());
        let planar = weighted(u, v, 2.0 / e2);
        let whole = weighted(planar.norm, w, 2.0 / e1);
        let share = |weight: f64, c: f64| if c == 0.0 { 0.0 } else { whole.norm * weight / c };
        finite_or_zero(Vector::new(
            share(whole.first * planar.first, p.x),
            share(whole.first * planar.second, p.y),
            share(whole.second, p.z),
        ))
    }

    fn bounds(&self) -> [Point; 2] {
        let a = Vector::from(self.semi_axes);
        [Point::from(-a), Point::from(a)]
    }

    fn extent(&self, n: &Vector) -> f64 {
        self.support(n)
    }

    /// Both norms are convex for exponents up to 2, and the outer one grows with the inner one.
    fn is_convex(&self) -> bool {
        self.exponents.iter().all(|e| *e <= 2.0)
    }
}
