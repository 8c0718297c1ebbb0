//! Points spread over a whole surface, for its sides that nobody saw.
//!
//! Both families are products of two superellipses, each of which a ray from its centre meets at its
//! direction over its norm. So the point `(a1 (r + v1) u1, a2 (r + v1) u2, a3 v2)` with `u`, `v` on the unit
//! superellipses of `ε2`, `ε1` and the ring ratio `r` (0 for a superellipsoid) is exact, and even steps of the
//! two rays' angles give steps of about the same length.

use crate::Point;
use crate::numeric::superellipse::norm;
use crate::surface::Surface;

/// Most points along one angle.
const MOST: f64 = 120.0;

/// Points about `step` metres apart, in the surface's own frame.
pub(super) fn shell(surface: &Surface, step: f64) -> Vec<Point> {
    let [a1, a2, a3] = surface.semi_axes();
    let [e1, e2] = surface.exponents();
    let ring = surface.ring_ratio();
    let r = ring.unwrap_or(0.0);
    let wide = a1.max(a2);
    // half a meridian for a superellipsoid, a whole tube section for a toroid
    let (from, sweep) = match ring {
        Some(_) => (0.0, std::f64::consts::TAU),
        None => (-std::f64::consts::FRAC_PI_2, std::f64::consts::PI),
    };
    let along = steps(sweep * wide.max(a3), step);
    let mut out = Vec::new();
    for i in 0..=along {
        let v = on_unit(from + sweep * i as f64 / along as f64, e1);
        let around = steps(std::f64::consts::TAU * wide * (r + v[0]).max(0.0), step);
        for j in 0..around {
            let u = on_unit(std::f64::consts::TAU * j as f64 / around as f64, e2);
            let radius = r + v[0];
            out.push(Point::new(a1 * radius * u[0], a2 * radius * u[1], a3 * v[1]));
        }
    }
    out
}

fn steps(length: f64, step: f64) -> usize {
    (length / step).ceil().clamp(1.0, MOST) as usize
}

/// Where the ray of an angle meets the superellipse with semi-axes 1 and exponent `epsilon`.
fn on_unit(angle: f64, epsilon: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    let length = norm(c.abs(), s.abs(), 2.0 / epsilon);
    [c / length, s / length]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Implicit, Superellipsoid, Supertoroid};

    #[test]
    fn points_lie_on_the_surface_and_reach_its_box() {
        let solid =
            Superellipsoid::new([0.03, 0.05, 0.02], [0.3, 1.4]).map(Surface::Superellipsoid);
        let ring = Supertoroid::new([0.01, 0.012, 0.02], 3.0, [0.5, 1.0]).map(Surface::Supertoroid);
        for surface in [solid.unwrap(), ring.unwrap()] {
            let points = shell(&surface, 0.004);
            assert!(points.len() > 200, "{}", points.len());
            for p in &points {
                assert!((surface.gauge(p) - 1.0).abs() < 1e-9, "{p}");
            }
            for (k, half) in surface.half_extents().into_iter().enumerate() {
                let most = points.iter().map(|p| p[k]).fold(0.0, f64::max);
                assert!(most > 0.95 * half && most < half + 1e-12, "{most} of {half}");
            }
        }
    }
}
