//! The supertoroid as lines from the middle of its tube: `ρ = R + r c1(t)`, `z/a3 = r c2(t)` and
//! `(x/a1, y/a2) = ρ b(s)` on eighths of the unit superellipses; the volume element is
//! `a1 a2 a3 ρ r ds dt dr / (n(s)² m(t)²)`.

use super::Supertoroid;
use crate::Point;
use crate::shape::Filled;
use crate::shape::filled::{Bits, eighth};

impl Filled for Supertoroid {
    fn pieces(&self) -> usize {
        64
    }

    fn along(
        &self,
        piece: usize,
        [s, t]: [f64; 2],
        shares: &[f64],
        each: &mut dyn FnMut(Point, f64),
    ) {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        let mut bits = Bits::of(piece);
        let ([x, y], turn) = eighth(&mut bits, s, 2.0 / e2);
        let ([out, up], tilt) = eighth(&mut bits, t, 2.0 / e1);
        let volume = a1 * a2 * a3 * turn * tilt;
        for r in shares {
            let rho = self.ring_ratio() + r * out;
            each(Point::new(a1 * rho * x, a2 * rho * y, a3 * r * up), volume * rho * r);
        }
    }
}
