//! The superellipsoid as lines from its centre, without the angles whose powers have infinite slopes.
//!
//! With `(x/a1, y/a2) = ρ b(s)` and `(ρ, z/a3) = r c(t)` on eighths of the unit superellipses of `2/ε2` and `2/ε1`, the
//! volume element is `a1 a2 a3 r² c1 ds dt dr / (n(s)² m(t)²)` with the norms n and m.

use super::Superellipsoid;
use super::mass::section_moment;
use crate::Point;
use crate::numeric::superellipse::weighted;
use crate::shape::Filled;
use crate::shape::filled::{Bits, eighth};

impl Filled for Superellipsoid {
    fn pieces(&self) -> usize {
        32
    }

    fn along(
        &self,
        piece: usize,
        [s, t]: [f64; 2],
        shares: &[f64],
        each: &mut dyn FnMut(Point, f64),
    ) {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        let ([x, y], turn) = eighth(&mut Bits::of(piece % 8), s, 2.0 / e2);
        // of the half plane only what lies outwards
        let mut half = Bits::of(piece / 8 % 2 + piece / 16 % 2 * 4);
        let ([out, up], tilt) = eighth(&mut half, t, 2.0 / e1);
        let volume = a1 * a2 * a3 * out * turn * tilt;
        let end = Point::new(a1 * out * x, a2 * out * y, a3 * up);
        for r in shares {
            each(end * *r, volume * r * r);
        }
    }

    /// Two pairs of points on the axes of a section have its area and second moments; all odd moments are 0. With
    /// `(ρ, z/a3)` on eighths of the profile, `dz = a3/m ds/(1 + s^p)` and `a3/m s^(p-1) ds/(1 + s^p)`.
    fn sections(&self, rule: &[[f64; 2]], each: &mut dyn FnMut(Point, f64)) -> bool {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        let [area, xx, yy] = [[0, 0], [2, 0], [0, 2]].map(|powers| section_moment(e2, powers));
        let [x, y] = [a1 * (2.0 * xx / area).sqrt(), a2 * (2.0 * yy / area).sqrt()];
        let whole = a1 * a2 * a3 * area;
        for [s, weight] in rule {
            let profile = weighted(1.0, *s, 2.0 / e1);
            let [one, share] = [1.0, *s].map(|v| v / profile.norm);
            let wide = (one, share, profile.first / profile.norm);
            let high = (share, one, profile.second / (s * profile.norm));
            for (out, up, rate) in [wide, high] {
                let volume = whole * out * out * rate * weight;
                for z in [a3 * up, -a3 * up] {
                    for (x, y) in [(x, 0.0), (-x, 0.0), (0.0, y), (0.0, -y)] {
                        each(Point::new(out * x, out * y, z), volume);
                    }
                }
            }
        }
        true
    }
}
