//! Meridian radial distance (equations 32 to 37, corrected in FORMULAS §7.1).

use super::Supertoroid;
use crate::Point;
use crate::numeric::superellipse::norm;
use crate::shape::Implicit;

impl Supertoroid {
    /// Signed distance in metres along the line from the mean superellipse through `p`, in the
    /// meridian plane of `p`: `d = ℓ (1 - 1/G)`, positive outside the tube.
    ///
    /// Without angles: `P = √(x² + y²)`, `a_ω = P/ρ̂`, `h = a_ω (ρ̂ - a4)`, `ℓ = √(h² + z²)`. On the
    /// centre line it is minus the lesser of the section's semi-axes; on the z axis `a_ω` is taken
    /// as `min(a1, a2)`, the least over all directions for ε2 <= 1.
    ///
    /// ```
    /// use supersurface::{Point, shape::Supertoroid};
    /// let ring = Supertoroid::new([0.01; 3], 4.0, [1.0, 1.0])?;
    /// assert!((ring.meridian_distance(&Point::new(0.07, 0.0, 0.0)) - 0.02).abs() < 1e-15);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn meridian_distance(&self, p: &Point) -> f64 {
        let [a1, a2, a3] = self.semi_axes;
        let planar = p.x.hypot(p.y);
        let radius = norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponents[1]);
        let width = if radius > 0.0 { planar / radius } else { a1.min(a2) };
        let length = (width * (radius - self.ring_ratio)).hypot(p.z);
        let gauge = self.gauge(p);
        if gauge == 0.0 { -width.min(a3) } else { length * (1.0 - 1.0 / gauge) }
    }
}
