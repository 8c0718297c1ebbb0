//! Meridian radial distance (equations 32 to 37, corrected in FORMULAS §7.1) and its derivatives (§7.3).
//!
//! In the meridian plane of `p` a line runs from the mean superellipse through `p` to the surface. Without angles, with
//! `P = √(x² + y²)`: `a_ω = P/ρ̂`, `h = a_ω (ρ̂ - a4)`, `ℓ = √(h² + z²)`, `d = ℓ (1 - 1/G)`.

use super::Supertoroid;
use crate::numeric::superellipse::{norm, weighted};
use crate::shape::{Implicit, Posed};
use crate::{Point, Vector};

/// Number of parameters of a posed supertoroid, in the order `a1, a2, a3, a4, ε1, ε2, tx, ty, tz, rx, ry, rz`.
pub const PARAMETERS: usize = 12;

/// Where the line from the mean superellipse through a point meets the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeridianFoot {
    /// Angle of the meridian plane about z, `ω_π = atan2(y, x)`, in radians.
    pub polar_angle: f64,
    /// Parameter ω of that plane, in radians.
    pub omega: f64,
    /// Semi-axis `a_ω` of the section across z, in metres.
    pub semi_axis: f64,
    /// The point `R_π` of the mean superellipse.
    pub mean_point: Point,
    /// The surface point `p_s`.
    pub foot: Point,
    /// `β2 = a4/ρ̂`, which scales `(x, y)` to the mean superellipse.
    pub mean_scale: f64,
    /// `β1 = 1/G`, which scales `p - R_π` to the surface.
    pub tube_scale: f64,
}

impl Supertoroid {
    /// Signed distance in metres along the line from the mean superellipse through `p`, in the
    /// meridian plane of `p`: `d = ℓ (1 - 1/G)`, positive outside the tube.
    ///
    /// On the centre line it is minus the lesser of the section's semi-axes; on the z axis `a_ω` is the least over all
    /// directions.
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
        let width = if radius > 0.0 { planar / radius } else { self.least_width() };
        let length = (width * (radius - self.ring_ratio)).hypot(p.z);
        let gauge = self.gauge(p);
        if gauge == 0.0 { -width.min(a3) } else { length * (1.0 - 1.0 / gauge) }
    }

    /// The least distance from the z axis to the superellipse with semi-axes a1, a2: `min(a1, a2)` for ε2 <= 1, and
    /// `(a1^-s + a2^-s)^(-1/s)` with `s = 2/(ε2 - 1)` above (FORMULAS §8.1).
    fn least_width(&self) -> f64 {
        let [a1, a2, _] = self.semi_axes;
        let least = a1.min(a2);
        let [_, e2] = self.exponents;
        if e2 <= 1.0 { least } else { least / norm(least / a1, least / a2, 2.0 / (e2 - 1.0)) }
    }

    /// The line of [`meridian_distance`](Self::meridian_distance) and its ends; `None` on the z axis, on the mean
    /// superellipse and for points that are not finite.
    pub fn meridian_foot(&self, p: &Point) -> Option<MeridianFoot> {
        let [a1, a2, _] = self.semi_axes;
        let [_, e2] = self.exponents;
        let planar = weighted((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / e2);
        let mean_scale = self.ring_ratio / planar.norm;
        let tube_scale = 1.0 / self.gauge(p);
        let off = (planar.norm - self.ring_ratio) / planar.norm;
        let away = Vector::new(p.x * off, p.y * off, p.z);
        let mean_point = Point::new(p.x * mean_scale, p.y * mean_scale, 0.0);
        let found = MeridianFoot {
            polar_angle: p.y.atan2(p.x),
            omega: planar.second.sqrt().copysign(p.y).atan2(planar.first.sqrt().copysign(p.x)),
            semi_axis: p.x.hypot(p.y) / planar.norm,
            mean_point,
            foot: mean_point + away * tube_scale,
            mean_scale,
            tube_scale,
        };
        found.foot.iter().all(|v| v.is_finite()).then_some(found)
    }
}

impl Posed<Supertoroid> {
    /// Meridian distance of a world point in metres and its derivatives by the [`PARAMETERS`] (by axes and position
    /// dimensionless, by the ring ratio, exponents and the body's rotation vector in metres). On the z axis and on the
    /// mean superellipse the derivatives are zero.
    pub fn meridian_jacobian(&self, p: &Point) -> (f64, [f64; PARAMETERS]) {
        let shape = self.shape();
        let q = self.to_local(p);
        let ([a1, a2, a3], [e1, e2], ring) = (shape.semi_axes, shape.exponents, shape.ring_ratio);
        let planar = weighted((q.x / a1).abs(), (q.y / a2).abs(), 2.0 / e2);
        let offset = planar.norm - ring;
        let whole = weighted(offset.abs(), (q.z / a3).abs(), 2.0 / e1);
        let radius = q.x.hypot(q.y);
        let width = radius / planar.norm;
        let across = width * offset;
        let length = across.hypot(q.z);
        let distance = shape.meridian_distance(&q);
        let mut row = [0.0; PARAMETERS];
        if planar.norm == 0.0 || length == 0.0 || !distance.is_finite() {
            return (distance, row);
        }
        let share = |w: f64, c: f64| if c == 0.0 { 0.0 } else { w / c };
        // d = ℓ (1 - 1/G): by ℓ and by ln G
        let (by_length, by_gauge) = (1.0 - 1.0 / whole.norm, length / whole.norm);
        let by_across = by_length * across / length;
        // h = P (1 - a4/ρ̂): by P, by ln ρ̂; τ = ρ̂ - a4
        let by_radius = by_across * offset / planar.norm;
        let by_tube = by_gauge * share(whole.first, offset);
        let by_log = by_across * width * ring + by_tube * planar.norm;
        let by_q = Vector::new(
            by_radius * q.x / radius + by_log * share(planar.first, q.x),
            by_radius * q.y / radius + by_log * share(planar.second, q.y),
            by_length * q.z / length + by_gauge * share(whole.second, q.z),
        );
        row[0] = -by_log * planar.first / a1;
        row[1] = -by_log * planar.second / a2;
        row[2] = -by_gauge * whole.second / a3;
        row[3] = -by_across * width - by_tube;
        row[4] = 0.5 * by_gauge * whole.entropy();
        row[5] = 0.5 * by_log * planar.entropy();
        let by_position = -(self.pose().rotation * by_q);
        let by_rotation = by_q.cross(&q.coords);
        for i in 0..3 {
            row[6 + i] = by_position[i];
            row[9 + i] = by_rotation[i];
        }
        (distance, row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_the_axis_the_narrowest_direction_counts() {
        for e2 in [0.3, 1.0, 1.2, 1.7, 2.4] {
            let ring = Supertoroid::new([0.3, 0.5, 0.1], 2.0, [1.0, e2]).unwrap();
            let on = ring.meridian_distance(&Point::origin());
            let near = (0..2000)
                .map(|k| {
                    let angle = f64::from(k) * std::f64::consts::FRAC_PI_2 / 2000.0;
                    ring.meridian_distance(&Point::new(1e-9 * angle.cos(), 1e-9 * angle.sin(), 0.0))
                })
                .fold(f64::INFINITY, f64::min);
            assert!((on - near).abs() < 1e-6, "ε2 = {e2}: {on} {near}");
        }
    }
}
