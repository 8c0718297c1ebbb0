//! How deep a point lies in a solid, without iteration (equation 46, corrected in FORMULAS §9).
//!
//! The line from the solid's centre through the point `p` (from a toroid's mean superellipse) leaves the solid at the
//! foot `p_s`, with the outward normal `n` there. The indentation is the part of the way along the normal,
//! `I = ((p_s - p)·n) n`. Along that line the gauge `g` grows evenly to 1 while its gradient stays the same, so
//!
//! ```text
//! I = (1 - g)/|∇g|² ∇g        depth |I| = (1 - g)/|∇g|        n = ∇g/|∇g|
//! ```
//!
//! with gauge and gradient at `p` itself. This is exact where the gauge is homogeneous along the line: superellipsoids and
//! other members with a radial gauge, and supertoroids by the gauge of their section.
//!
//! What is not guaranteed: that `I` leads to the closest point. It does on a sphere, on flat faces and in the limit of
//! shallow depth; elsewhere the radial foot lies beside it, and in a convex solid the depth is too large. Of points at equal
//! angles under the surface of superellipsoids with the semi-axes 1, 1, r and both exponents ε, at depths in shares of the
//! smallest semi-axis, by so much (median / largest) over [`ByClosestPoint`](super::ByClosestPoint):
//!
//! | r | ε | depth 1 % | 5 % | 10 % |
//! |--:|--:|--:|--:|--:|
//! | 1 | 1 | 0.0 / 0.0 % | 0.0 / 0.0 % | 0.0 / 0.0 % |
//! | 1 | 0.3 | 0.1 / 0.3 % | 0.8 / 1.8 % | 1.6 / 3.8 % |
//! | 3 | 1 | 0.2 / 0.4 % | 0.9 / 2.2 % | 2.0 / 4.6 % |
//! | 3 | 0.3 | 0.3 / 1.1 % | 1.7 / 5.9 % | 3.6 / 12.7 % |
//! | 10 | 1 | 0.3 / 1.9 % | 1.8 / 10.3 % | 3.5 / 22.6 % |
//! | 10 | 0.3 | 0.8 / 2.4 % | 4.5 / 13.1 % | 9.7 / 28.9 % |

use super::gauge_columns::Layers;
use super::indentation_columns::fill;
use crate::shape::{
    Implicit, Posed, RadialExtended, Supercylinder, Superellipsoid, Supershape, Supertoroid,
};
use crate::{Direction, Point};

/// A point in a solid, seen from the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Indentation {
    /// The point `p_s` of the surface.
    pub foot: Point,
    /// Outward unit normal there.
    pub normal: Direction,
    /// Length of the indentation in metres, positive.
    pub depth: f64,
}

impl Indentation {
    /// From its parts.
    pub const fn new(foot: Point, normal: Direction, depth: f64) -> Self {
        Self { foot, normal, depth }
    }
}

/// How many points go through [`Indented::indentations`] at once.
pub const BLOCK: usize = 64;

/// Depths and normals of a block of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Indentations {
    /// Depths in metres; 0 for points that are not inside.
    pub depths: [f64; BLOCK],
    /// Components of the outward unit normals; 0 for points that are not inside.
    pub normals: [[f64; BLOCK]; 3],
}

impl Default for Indentations {
    fn default() -> Self {
        Self { depths: [0.0; BLOCK], normals: [[0.0; BLOCK]; 3] }
    }
}

/// A solid that can tell how deep a point lies in it.
///
/// The methods given here are right for every gauge that is homogeneous along rays from the origin, `g(sp) = s g(p)`.
///
/// ```
/// use supersurface::{Point, contact::Indented, shape::Superellipsoid};
/// let brick = Superellipsoid::new([0.1, 0.05, 0.03], [0.1, 0.1])?;
/// let found = brick.indentation(&Point::new(0.02, 0.01, 0.028)).unwrap();
/// assert!((found.depth - 0.002).abs() < 1e-6 && found.normal.z > 0.999);
/// assert!(brick.indentation(&Point::new(0.0, 0.0, 0.031)).is_none());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub trait Indented: Implicit {
    /// The foot `p_s`: where the line from the solid's middle through `p` leaves it. `None` where there is no such
    /// line (in the middle itself) and for points that are not finite.
    fn foot(&self, p: &Point) -> Option<Point> {
        let foot = p / self.gauge(p);
        foot.iter().all(|v| v.is_finite()).then_some(foot)
    }

    /// The indentation of a point; `None` when it is not inside, and where the gauge has no gradient.
    fn indentation(&self, p: &Point) -> Option<Indentation> {
        let room = 1.0 - self.gauge(p);
        let gradient = self.gradient(p);
        let slope = gradient.norm();
        let depth = room / slope;
        let inside = room > 0.0 && slope > 0.0 && depth > 0.0 && depth.is_finite();
        let normal = Direction::new_unchecked(gradient / slope);
        inside.then_some(Indentation { foot: self.foot(p)?, normal, depth })
    }

    /// The same for many points, as columns of coordinates: what a hot loop calls, up to rounding.
    fn indentations(&self, points: &[[f64; BLOCK]; 3], out: &mut Indentations) {
        one_by_one(self, points, out);
    }
}

/// One point of a block.
pub(super) fn point_of(points: &[[f64; BLOCK]; 3], i: usize) -> Point {
    Point::from(points.each_ref().map(|column| column[i]))
}

/// The plain version of [`Indented::indentations`].
pub(super) fn one_by_one(
    solid: &(impl Indented + ?Sized),
    points: &[[f64; BLOCK]; 3],
    out: &mut Indentations,
) {
    for i in 0..BLOCK {
        let found = solid.indentation(&point_of(points, i));
        out.depths[i] = found.map_or(0.0, |f| f.depth);
        for (k, column) in out.normals.iter_mut().enumerate() {
            column[i] = found.map_or(0.0, |f| f.normal[k]);
        }
    }
}

impl Indented for Superellipsoid {
    fn indentations(&self, points: &[[f64; BLOCK]; 3], out: &mut Indentations) {
        match Layers::of_superellipsoid(self) {
            Some(layers) => fill(layers, points, out),
            None => one_by_one(self, points, out),
        }
    }
}

impl Indented for Supertoroid {
    /// In the meridian plane of the point, from the mean superellipse (equation 36).
    fn foot(&self, p: &Point) -> Option<Point> {
        Some(self.meridian_foot(p)?.foot)
    }

    fn indentations(&self, points: &[[f64; BLOCK]; 3], out: &mut Indentations) {
        match Layers::of_supertoroid(self) {
            Some(layers) => fill(layers, points, out),
            None => one_by_one(self, points, out),
        }
    }
}

impl Indented for Supercylinder {}
impl Indented for Supershape {}
impl Indented for RadialExtended {}

/// In the world.
impl<S: Indented> Indented for Posed<S> {
    fn foot(&self, p: &Point) -> Option<Point> {
        Some(self.pose() * self.shape().foot(&self.to_local(p))?)
    }

    fn indentation(&self, p: &Point) -> Option<Indentation> {
        let found = self.shape().indentation(&self.to_local(p))?;
        let normal = self.pose().rotation * found.normal;
        Some(Indentation { foot: self.pose() * found.foot, normal, depth: found.depth })
    }
}

impl<S: Indented + ?Sized> Indented for &S {
    fn foot(&self, p: &Point) -> Option<Point> {
        (**self).foot(p)
    }

    fn indentation(&self, p: &Point) -> Option<Indentation> {
        (**self).indentation(p)
    }

    fn indentations(&self, points: &[[f64; BLOCK]; 3], out: &mut Indentations) {
        (**self).indentations(points, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::{ExtendedSuperellipsoid, Superformula};
    use crate::{Pose, Vector};

    /// `I = ((p_s - p)·n) n` with the normal at the foot.
    fn is_equation_46(solid: &impl Indented, random: &mut Stream, name: &str) {
        let [low, high] = solid.bounds();
        let size = (high - low).amax();
        let mut inside = 0;
        while inside < 200 {
            let p = Point::from(Vector::from_fn(|k, _| random.between(low[k], high[k])));
            let g = solid.gauge(&p);
            let Some(found) = solid.indentation(&p) else {
                assert!(g >= 1.0, "{name} {p}");
                continue;
            };
            inside += 1;
            assert!((solid.gauge(&found.foot) - 1.0).abs() < 1e-10, "{name} {p}");
            let normal = solid.gradient(&found.foot).normalize();
            assert!((normal - *found.normal).norm() < 1e-6, "{name} {p}");
            let along = (found.foot - p).dot(&found.normal);
            assert!((along - found.depth).abs() < 1e-11 * size, "{name} {p} {along} {found:?}");
        }
    }

    #[test]
    fn the_first_order_of_the_gauge_is_equation_46() {
        let mut random = Stream::new(3, 0);
        for _ in 0..50 {
            let axes = [0; 3].map(|_| random.between(0.05, 1.0));
            let e = [0; 2].map(|_| random.between(0.2, 1.8));
            let pose = Pose::new(Vector::new(0.3, -0.2, 0.5), Vector::new(0.4, 1.0, -2.0));
            let tin = Superellipsoid::new(axes, e).unwrap();
            is_equation_46(&tin, &mut random, "superellipsoid");
            is_equation_46(&Posed::new(tin, pose).unwrap(), &mut random, "posed");
            let ring = Supertoroid::new(axes, random.between(1.0, 4.0), e).unwrap();
            is_equation_46(&ring, &mut random, "supertoroid");
            is_equation_46(&Posed::new(&ring, pose).unwrap(), &mut random, "posed ring");
            let can = Supercylinder::new(axes, e[1]).unwrap();
            is_equation_46(&can, &mut random, "supercylinder");
        }
        let star = Superformula::new(6.0, [2.0, 1.7, 1.7], [0.5, 0.4]).unwrap();
        let round = Superformula::new(4.0, [2.0; 3], [1.0, 0.5]).unwrap();
        let starfish = Supershape::new(star, round).unwrap();
        is_equation_46(&starfish, &mut random, "supershape");
        let (profile, section) = ([0.5, 0.9, 1.0], [1.0, 0.6, 1.0, 1.0]);
        let vase = ExtendedSuperellipsoid::new([0.05, 0.05, 0.1], &profile, &section).unwrap();
        is_equation_46(&vase.radial(), &mut random, "radial extended");
    }

    #[test]
    fn nothing_is_said_without_a_line_or_a_gradient() {
        let ball = Superellipsoid::new([1.0; 3], [1.0; 2]).unwrap();
        let ring = Supertoroid::new([0.5; 3], 2.0, [1.0; 2]).unwrap();
        assert!(ball.indentation(&Point::origin()).is_none());
        assert!(ring.indentation(&Point::new(1.0, 0.0, 0.0)).is_none());
        for v in [f64::NAN, f64::INFINITY, 1e300] {
            let p = Point::new(v, 0.0, 0.0);
            assert!(ball.indentation(&p).is_none() && ring.indentation(&p).is_none());
        }
    }
}
