//! Implicit form: gauge of the cross-section and its gradient (equation 12, FORMULAS §3).

use super::Supertoroid;
use crate::numeric::superellipse::{norm, weighted};
use crate::shape::{Implicit, SupportMap, finite_or_zero};
use crate::{Point, Vector};

impl Implicit for Supertoroid {
    /// `G = (|ρ̂ - a4|^p1 + |z/a3|^p1)^(1/p1)`, the gauge of the tube's section.
    #[inline]
    fn gauge(&self, p: &Point) -> f64 {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let radius = norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / e2);
        norm((radius - self.ring_ratio).abs(), (p.z / a3).abs(), 2.0 / e1)
    }

    /// Zero on the z axis and on the centre line of the tube, where there is no gradient.
    fn gradient(&self, p: &Point) -> Vector {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let planar = weighted((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / e2);
        let offset = planar.norm - self.ring_ratio;
        let whole = weighted(offset.abs(), (p.z / a3).abs(), 2.0 / e1);
        let share = |weight: f64, c: f64| if c == 0.0 { 0.0 } else { weight / c };
        let across = whole.norm * share(whole.first, offset) * planar.norm;
        finite_or_zero(Vector::new(
            across * share(planar.first, p.x),
            across * share(planar.second, p.y),
            whole.norm * share(whole.second, p.z),
        ))
    }

    fn bounds(&self) -> [Point; 2] {
        let [a1, a2, a3] = self.semi_axes;
        let outer = 1.0 + self.ring_ratio;
        let half = Vector::new(a1 * outer, a2 * outer, a3);
        [Point::from(-half), Point::from(half)]
    }

    fn extent(&self, n: &Vector) -> f64 {
        self.support(n)
    }
}
