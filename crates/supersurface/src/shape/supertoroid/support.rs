//! Support point of the convex hull (FORMULAS §3: `h_T(n) = a4 ‖(a1 n_x, a2 n_y)‖_q2 + h_SE(n)`).

use super::Supertoroid;
use crate::shape::{Superellipsoid, SupportMap};
use crate::{Point, Vector};

impl SupportMap for Supertoroid {
    /// The support point of the tube's superellipsoid pushed out by the ring: their planar
    /// directions agree, so the sum of both support points is one of the toroid's.
    fn support_point(&self, n: &Vector) -> Point {
        let tube = Superellipsoid::from_checked(self.semi_axes, self.exponents);
        let mut ring = tube.support_point(&Vector::new(n.x, n.y, 0.0));
        if ring == Point::origin() {
            // along z every direction of the ring serves
            ring.x = self.semi_axes[0];
        }
        let p = tube.support_point(n);
        let a4 = self.ring_ratio;
        Point::new(p.x + a4 * ring.x, p.y + a4 * ring.y, p.z)
    }
}
