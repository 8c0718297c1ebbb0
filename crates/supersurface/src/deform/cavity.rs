//! A dish in the upper side (FORMULAS §4, definition fixed there; Barr only names it).
//!
//! `Z = z - c w(ρ̂) (a3 + z)/2` with `w = (1 - ρ̂²)²` inside the planar superellipse `ρ̂ = 1` and 0 outside, `X = x`,
//! `Y = y`. The dish is `c a3` deep in the middle, the bottom stays. One to one for `c < 2`: the determinant is
//! `1 - c w/2`. Once continuously differentiable.

use nalgebra::Matrix3;

use super::Deformation;
use crate::numeric::superellipse::weighted;
use crate::shape::{Implicit, InvalidShape, Superellipsoid};
use crate::{Point, Vector};

/// The upper side sinks in the middle.
///
/// ```
/// use supersurface::{Point, deform::{Cavity, Deformation}, shape::Superellipsoid};
/// let tin = Superellipsoid::new([0.05, 0.05, 0.02], [0.2, 1.0])?;
/// let bowl = Cavity::new(1.5, &tin)?;
/// assert!((bowl.forward(&Point::new(0.0, 0.0, 0.02)).z - (0.02 - 1.5 * 0.02)).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cavity {
    depth: f64,
    semi_axes: [f64; 3],
    exponent: f64,
}

/// `w` and its derivatives by x and y.
struct Dish {
    weight: f64,
    slope: [f64; 2],
}

impl Cavity {
    /// Depth `c` in [0, 2) in units of a3; the dish has the section across z and the height of `shape`.
    pub fn new(depth: f64, shape: &Superellipsoid) -> Result<Self, InvalidShape> {
        InvalidShape::check((0.0..2.0).contains(&depth), "depth of a cavity", depth, "in [0, 2)")?;
        Ok(Self { depth, semi_axes: shape.semi_axes(), exponent: shape.exponents()[1] })
    }

    /// Depth `c` in units of a3.
    pub const fn depth(&self) -> f64 {
        self.depth
    }

    fn dish(&self, p: &Point) -> Dish {
        let [a1, a2, _] = self.semi_axes;
        let radius = weighted((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponent);
        let rho = radius.norm;
        if rho.is_nan() || rho >= 1.0 {
            return Dish { weight: 0.0, slope: [0.0; 2] };
        }
        let rest = 1.0 - rho * rho;
        // ∂w/∂x = -4 (1 - ρ̂²) ρ̂ ∂ρ̂/∂x with ∂ρ̂/∂x = ρ̂ w2/x
        let slope = |share: f64, c: f64| {
            if c == 0.0 { 0.0 } else { -4.0 * rest * rho * (rho * share / c) }
        };
        Dish { weight: rest * rest, slope: [slope(radius.first, p.x), slope(radius.second, p.y)] }
    }
}

impl Deformation for Cavity {
    fn forward(&self, p: &Point) -> Point {
        let sunk = 0.5 * self.depth * self.dish(p).weight;
        Point::new(p.x, p.y, p.z - sunk * (self.semi_axes[2] + p.z))
    }

    fn inverse(&self, p: &Point) -> Option<Point> {
        let sunk = 0.5 * self.depth * self.dish(p).weight;
        Some(Point::new(p.x, p.y, (p.z + sunk * self.semi_axes[2]) / (1.0 - sunk)))
    }

    fn jacobian(&self, p: &Point) -> Matrix3<f64> {
        let Dish { weight, slope } = self.dish(p);
        let lever = -0.5 * self.depth * (self.semi_axes[2] + p.z);
        let last = 1.0 - 0.5 * self.depth * weight;
        Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, lever * slope[0], lever * slope[1], last)
    }

    fn check_over(&self, _solid: &dyn Implicit) -> Result<(), InvalidShape> {
        Ok(())
    }

    /// `Z` is linear in z and in w, so that its extremes lie at the ends of both.
    fn bounds_over(&self, solid: &dyn Implicit) -> [Point; 2] {
        let [mut low, mut high] = solid.bounds();
        let a3 = self.semi_axes[2];
        let sunk = |z: f64| z - 0.5 * self.depth * (a3 + z);
        (low.z, high.z) = (low.z.min(sunk(low.z)), high.z.max(sunk(high.z)));
        [low, high]
    }

    /// Nothing moves across z.
    fn extent_over(&self, solid: &dyn Implicit, n: &Vector) -> f64 {
        if n.z == 0.0 { solid.extent(n) } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformed;
    use crate::deform::tests::is_a_map;
    use crate::shape::Parametric;

    #[test]
    fn a_bowl_has_its_bottom_and_its_dish() {
        let shape = Superellipsoid::new([0.5, 0.4, 0.3], [0.3, 1.2]).unwrap();
        for depth in [0.0, 0.8, 1.9] {
            let cavity = Cavity::new(depth, &shape).unwrap();
            is_a_map(&cavity, shape.semi_axes());
            let bowl = Deformed::new(shape, cavity).unwrap();
            let top = bowl.point(std::f64::consts::FRAC_PI_2, 0.0);
            assert!((top.z - 0.3 * (1.0 - depth)).abs() < 1e-15);
            let [low, high] = bowl.bounds();
            for i in 0..400 {
                let p = bowl.point(-1.5 + 0.0075 * f64::from(i), f64::from(i));
                assert!((bowl.gauge(&p) - 1.0).abs() < 1e-9);
                assert!((p - low).min() >= 0.0 && (high - p).min() >= 0.0);
            }
        }
        assert!(Cavity::new(2.0, &shape).is_err() && Cavity::new(-0.1, &shape).is_err());
    }
}
