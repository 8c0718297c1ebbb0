//! Solids combined by Boolean operations: trees of R-functions over any implicit solids.
//!
//! A leaf has the value `f = 1 - g` (> 0 inside), each operation combines two values
//! ([`super::rfunction`]), and the gauge of the whole is `1 - f`. Only its surface `g = 1` is exact: away from
//! it a combined gauge is no distance. Gradients follow by the chain rule.
//!
//! The tree is a [`Program`], so that neither depth nor width costs anything but time.

use std::fmt;
use std::sync::Arc;

use super::bounds;
use super::program::{Join, Kind, Program, Step, leaf_value};
use super::rfunction::{Alpha, Blend};
use crate::shape::Implicit;
use crate::{Point, Vector};

/// A Boolean combination of solids, itself a solid; a copy shares them.
///
/// ```
/// use supersurface::{Point, combine::{Alpha, CombinedSolid}};
/// use supersurface::shape::{Implicit, Superellipsoid};
/// // a ball with a square hole along z
/// let ball = Superellipsoid::new([0.05; 3], [1.0, 1.0])?;
/// let bar = Superellipsoid::new([0.02, 0.02, 0.1], [0.1, 0.1])?;
/// let bead = CombinedSolid::new(ball).difference(CombinedSolid::new(bar), Alpha::SMOOTH);
/// assert!(!bead.contains(&Point::origin()));
/// assert!(bead.contains(&Point::new(0.03, 0.0, 0.0)));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone)]
pub struct CombinedSolid {
    program: Program,
}

impl CombinedSolid {
    /// One solid alone.
    pub fn new(shape: impl Implicit + Send + Sync + 'static) -> Self {
        Self { program: Program::leaf(Arc::new(shape)) }
    }

    /// What is in either.
    #[must_use]
    pub fn union(self, other: Self, alpha: Alpha) -> Self {
        self.join(other, Kind::Union, alpha, None)
    }

    /// What is in both.
    #[must_use]
    pub fn intersection(self, other: Self, alpha: Alpha) -> Self {
        self.join(other, Kind::Intersection, alpha, None)
    }

    /// What is in this one and not in the other.
    #[must_use]
    pub fn difference(self, other: Self, alpha: Alpha) -> Self {
        self.join(other, Kind::Difference, alpha, None)
    }

    /// The union with a fillet (or a groove) where the two surfaces meet; α = 0.
    #[must_use]
    pub fn blend_union(self, other: Self, blend: Blend) -> Self {
        self.join(other, Kind::Union, Alpha::SMOOTH, Some(blend))
    }

    /// The intersection with its edge filled up (or rounded off); α = 0.
    #[must_use]
    pub fn blend_intersection(self, other: Self, blend: Blend) -> Self {
        self.join(other, Kind::Intersection, Alpha::SMOOTH, Some(blend))
    }

    /// Everything outside.
    #[must_use]
    pub fn complement(self) -> Self {
        Self { program: self.program.complemented() }
    }

    /// Number of solids that it is made of.
    pub fn leaves(&self) -> usize {
        self.program.steps().iter().filter(|s| matches!(s, Step::Leaf(_))).count()
    }

    fn join(self, other: Self, kind: Kind, alpha: Alpha, blend: Option<Blend>) -> Self {
        let join = Join::new(kind, alpha, blend);
        Self { program: self.program.joined(other.program, join) }
    }

    /// The value f: positive inside, 0 on the surface, negative outside, `1 - g` at the leaves.
    pub fn value(&self, p: &Point) -> f64 {
        self.program.run(0.0, |shape| leaf_value(shape, p), |f| -f, |o, f1, f2| o.apply(f1, f2).0)
    }
}

impl fmt::Debug for CombinedSolid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CombinedSolid").field("leaves", &self.leaves()).finish_non_exhaustive()
    }
}

impl Implicit for CombinedSolid {
    /// `1 - f`.
    fn gauge(&self, p: &Point) -> f64 {
        1.0 - self.value(p)
    }

    /// By the chain rule. Where two surfaces cross it is the mean of theirs, up to signs; there a smooth union has
    /// no gradient.
    fn gradient(&self, p: &Point) -> Vector {
        let (_, slope) = self.program.run(
            (0.0, Vector::zeros()),
            |shape| (leaf_value(shape, p), -shape.gradient(p)),
            |(f, slope)| (-f, -slope),
            |o, (f1, s1), (f2, s2)| {
                let (value, [a, b]) = o.apply(f1, f2);
                (value, s1 * a + s2 * b)
            },
        );
        -slope
    }

    /// Infinite for a complement; for blends a little wide.
    fn bounds(&self) -> [Point; 2] {
        bounds::bounds(&self.program)
    }

    /// True for intersections of convex solids without blends: `f1 ∧ f2` is concave and grows with both.
    fn is_convex(&self) -> bool {
        self.program.steps().iter().all(|step| match step {
            Step::Leaf(shape) => shape.is_convex(),
            Step::Complement => false,
            Step::Join(join) => join.kind == Kind::Intersection && join.blend.is_none(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::{Posed, Superellipsoid, Supertoroid};
    use crate::{Pose, Vector};

    fn parts() -> (Posed<Superellipsoid>, Posed<Superellipsoid>, Posed<Supertoroid>) {
        let block = Superellipsoid::new([0.5, 0.4, 0.3], [0.3, 0.4]).unwrap();
        let ball = Superellipsoid::new([0.4; 3], [1.0; 2]).unwrap();
        let ring = Supertoroid::new([0.1; 3], 4.0, [1.0; 2]).unwrap();
        let moved = |x, y, z| Pose::new(Vector::new(x, y, z), Vector::new(0.3, y, -0.4));
        (
            Posed::new(block, moved(0.0, 0.1, 0.0)).unwrap(),
            Posed::new(ball, moved(0.3, 0.0, 0.2)).unwrap(),
            Posed::new(ring, moved(-0.2, 0.0, 0.3)).unwrap(),
        )
    }

    /// (block ∪ ball) \ ring, and outside of a second ball.
    fn tree(alpha: Alpha) -> CombinedSolid {
        let (block, ball, ring) = parts();
        let other = ball.moved(&Pose::translation(-0.9, 0.0, 0.0));
        CombinedSolid::new(block)
            .union(CombinedSolid::new(ball), alpha)
            .difference(CombinedSolid::new(ring), alpha)
            .intersection(CombinedSolid::new(other).complement(), alpha)
    }

    #[test]
    fn membership_is_the_boolean_one() {
        let (block, ball, ring) = parts();
        let other = ball.moved(&Pose::translation(-0.9, 0.0, 0.0));
        for alpha in [Alpha::SMOOTH, Alpha::EXACT] {
            let solid = tree(alpha);
            let [low, high] = solid.bounds();
            let mut random = Stream::new(21, 0);
            let mut inside = 0;
            for _ in 0..100_000 {
                let p = Point::from(Vector::from_fn(|_, _| random.between(-1.0, 1.0)));
                let plain = (block.contains(&p) || ball.contains(&p))
                    && !ring.contains(&p)
                    && !other.contains(&p);
                assert_eq!(solid.contains(&p), plain, "{p}");
                if plain {
                    inside += 1;
                    assert!((0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]));
                }
            }
            assert!(inside > 3000 && high.coords.iter().all(|v| v.is_finite()), "{inside}");
        }
    }

    #[test]
    fn the_gradient_agrees_with_differences() {
        let (block, ball, _) = parts();
        let fillet = Blend::new(0.2, [0.4, 0.5]).unwrap();
        let blended = CombinedSolid::new(block).blend_union(CombinedSolid::new(ball), fillet);
        let mut random = Stream::new(22, 0);
        for solid in [tree(Alpha::SMOOTH), tree(Alpha::new(0.7).unwrap()), blended] {
            let h = 1e-7;
            for _ in 0..300 {
                let p = Point::from(Vector::from_fn(|_, _| random.between(-0.9, 0.9)));
                let gradient = solid.gradient(&p);
                for k in 0..3 {
                    let step = Vector::from_fn(|i, _| if i == k { h } else { 0.0 });
                    let d = (solid.gauge(&(p + step)) - solid.gauge(&(p - step))) / (2.0 * h);
                    assert!((gradient[k] - d).abs() < 1e-4 * (1.0 + gradient.norm()), "{p}");
                }
            }
        }
    }

    #[test]
    fn a_blend_stays_in_its_box_and_fills_the_groove() {
        let ball = Superellipsoid::new([0.3; 3], [1.0; 2]).unwrap();
        let at = |x| Posed::new(ball, Pose::translation(x, 0.0, 0.0)).unwrap();
        for amount in [0.1, 0.7, 5.0] {
            let blend = Blend::new(amount, [2.0, 2.0]).unwrap();
            let solid =
                CombinedSolid::new(at(-0.25)).blend_union(CombinedSolid::new(at(0.25)), blend);
            let groove = Point::new(0.0, 0.18, 0.0);
            assert!(solid.contains(&groove) && !at(0.25).contains(&groove));
            let [low, high] = solid.bounds();
            let mut random = Stream::new(23, 0);
            for _ in 0..20_000 {
                let p =
                    Point::from(Vector::from_fn(|_, _| 6.0 * amount.max(0.3) * random.normal()));
                let boxed = (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]);
                assert!(boxed || !solid.contains(&p), "{p} {high}");
            }
        }
    }

    #[test]
    fn deep_and_wide_trees_are_evaluated_alike() {
        let ball = Superellipsoid::new([0.1; 3], [1.0; 2]).unwrap();
        let at = |i: usize| {
            let pose = Pose::translation(i as f64 * 0.05, 0.0, 0.0);
            CombinedSolid::new(Posed::new(ball, pose).unwrap())
        };
        let n = 3000;
        let left = (1..n).fold(at(0), |tree, i| tree.union(at(i), Alpha::EXACT));
        let right = (1..n).fold(at(0), |tree, i| at(i).union(tree, Alpha::EXACT));
        assert_eq!((left.leaves(), left.program.need(), right.program.need()), (n, 2, 2));
        let mut level: Vec<CombinedSolid> = (0..n).map(at).collect();
        while level.len() > 1 {
            let mut next = Vec::new();
            let mut pairs = level.into_iter();
            while let Some(first) = pairs.next() {
                next.push(match pairs.next() {
                    Some(second) => first.union(second, Alpha::EXACT),
                    None => first,
                });
            }
            level = next;
        }
        let balanced = level.pop().unwrap();
        assert!(balanced.program.need() <= 13);
        for p in [[7.03, 0.02, 0.01], [-1.0, 0.0, 0.0], [200.0, 0.0, 0.0]] {
            let p = Point::from(p);
            let g = balanced.gauge(&p);
            assert!(
                (left.gauge(&p) - g).abs() < 1e-9 * g && (right.gauge(&p) - g).abs() < 1e-9 * g
            );
        }
        let reach = (n - 1) as f64 * 0.05 + 0.1;
        assert!((balanced.bounds()[1].x - reach).abs() < 1e-9);
        assert!((right.bounds()[1].x - reach).abs() < 1e-9);
    }

    #[test]
    fn convexity_and_empty_boxes() {
        let (block, ball, ring) = parts();
        let both = CombinedSolid::new(block).intersection(CombinedSolid::new(ball), Alpha::SMOOTH);
        assert!(both.is_convex());
        assert!(!CombinedSolid::new(ring).is_convex() && !tree(Alpha::SMOOTH).is_convex());
        let far = block.moved(&Pose::translation(9.0, 0.0, 0.0));
        let none = CombinedSolid::new(far).intersection(CombinedSolid::new(ball), Alpha::SMOOTH);
        let [low, high] = none.bounds();
        assert!(low.x == high.x);
        assert!(CombinedSolid::new(ball).complement().bounds()[0].x.is_infinite());
        for v in [0.0, 5e-324, 1e308, -1e308] {
            let p = Point::new(v, v, -v);
            assert!(!both.gauge(&p).is_nan());
        }
    }
}
