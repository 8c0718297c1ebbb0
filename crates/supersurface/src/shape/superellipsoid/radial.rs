//! The radial distance (equations 25 to 29, corrected in FORMULAS §7) and its derivatives (§7.3).
//!
//! The ray from the centre through `q` meets the surface at `β q` with `β = 1/g`, so the signed distance along it is
//! `r = |q| (1 - 1/g)`, positive outside. With `W = (w1 w2, w1 (1 - w2), 1 - w1)` and the entropy S of a weight
//!
//! ```text
//! ∂r/∂q = q/|q| (1 - 1/g) + |q|/g W_i/q_i        ∂r/∂a_i = -|q|/g W_i/a_i
//! ∂r/∂ε1 = |q|/g S(w1)/2                          ∂r/∂ε2 = |q|/g w1 S(w2)/2
//! ```
//!
//! and for a body at a pose `q = Rᵀ (p - t)`: `∂r/∂t = -R ∂r/∂q`, and `∂r/∂δ = ∂r/∂q × q` for the rotation
//! `R exp([δ]×)`.

use super::Superellipsoid;
use crate::numeric::superellipse::weighted;
use crate::shape::{Implicit, Posed};
use crate::{Point, Vector};

/// Number of parameters of a posed superellipsoid, in the order `a1, a2, a3, ε1, ε2, tx, ty, tz, rx, ry, rz`.
pub const PARAMETERS: usize = 11;

impl Superellipsoid {
    /// Signed radial distance `|p| (1 - 1/g)` in metres, positive outside. At the centre it is minus the least
    /// semi-axis.
    ///
    /// ```
    /// use supersurface::{Point, shape::Superellipsoid};
    /// let ball = Superellipsoid::new([2.0; 3], [1.0, 1.0])?;
    /// assert!((ball.radial_distance(&Point::new(0.0, 3.0, 4.0)) - 3.0).abs() < 1e-14);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    #[inline]
    pub fn radial_distance(&self, p: &Point) -> f64 {
        let g = self.gauge(p);
        if g == 0.0 {
            let [a, b, c] = self.semi_axes;
            return -a.min(b).min(c);
        }
        p.coords.norm() * (1.0 - 1.0 / g)
    }

    /// Where the ray from the centre through `p` leaves the body; `None` for the centre and for points that are
    /// not finite.
    pub fn radial_foot(&self, p: &Point) -> Option<Point> {
        let beta = 1.0 / self.gauge(p);
        let foot = p * beta;
        foot.iter().all(|v| v.is_finite()).then_some(foot)
    }
}

impl Posed<Superellipsoid> {
    /// Radial distance of a world point in metres and its derivatives by the [`PARAMETERS`] (by axes and
    /// position dimensionless, by exponents and by the body's rotation vector in metres). At the centre the
    /// derivatives are zero.
    ///
    /// This is the plain version; [`Self::radial_jacobians`] does the same for many points.
    pub fn radial_jacobian(&self, p: &Point) -> (f64, [f64; PARAMETERS]) {
        let shape = self.shape();
        let q = self.to_local(p).coords;
        let ([a1, a2, a3], [e1, e2]) = (shape.semi_axes, shape.exponents);
        let planar = weighted((q.x / a1).abs(), (q.y / a2).abs(), 2.0 / e2);
        let whole = weighted(planar.norm, (q.z / a3).abs(), 2.0 / e1);
        let g = whole.norm;
        let mut row = [0.0; PARAMETERS];
        let length = q.norm();
        if g == 0.0 || length == 0.0 {
            return (shape.radial_distance(&Point::origin()), row);
        }
        let weights = [whole.first * planar.first, whole.first * planar.second, whole.second];
        let scale = length / g;
        let along = (1.0 - 1.0 / g) / length;
        // the limit of W/q on a symmetry plane is 0 for ε < 2
        let share = |w: f64, c: f64| if c == 0.0 { 0.0 } else { w / c };
        let by_q = Vector::from_fn(|i, _| q[i] * along + scale * share(weights[i], q[i]));
        for (i, a) in [a1, a2, a3].into_iter().enumerate() {
            row[i] = -scale * weights[i] / a;
        }
        row[3] = 0.5 * scale * whole.entropy();
        row[4] = 0.5 * scale * whole.first * planar.entropy();
        let by_position = -(self.pose().rotation * by_q);
        let by_rotation = by_q.cross(&q);
        for i in 0..3 {
            row[5 + i] = by_position[i];
            row[8 + i] = by_rotation[i];
        }
        (length * (1.0 - 1.0 / g), row)
    }
}
