//! Boxes around a posed shape: the one that turns with it, and the least one along the axes.
//!
//! In its own frame a shape knows its box; the pose carries it along. Along the axes of the world the least box of
//! a body follows from its support function, `[-h(-e_i), h(e_i)]` (FORMULAS §9: half extents `h(Rᵀ e_i)`).

use crate::shape::{Implicit, InvalidShape, Posed, SupportMap};
use crate::{Point, Pose, Vector};

/// A box that may stand at any angle.
///
/// ```
/// use supersurface::measure::OrientedBox;
/// use supersurface::{Point, Pose, Vector, shape::{Posed, Superellipsoid}};
/// let tin = Superellipsoid::new([0.03, 0.03, 0.05], [0.1, 1.0])?;
/// let lying = Posed::new(tin, Pose::new(Vector::x(), Vector::y() * 0.7))?;
/// let found = OrientedBox::around(&lying).unwrap();
/// assert_eq!(found.half_extents(), [0.03, 0.03, 0.05]);
/// assert!(found.contains(&(lying.pose() * Point::new(0.03, 0.0, 0.05))));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    pose: Pose,
    half_extents: [f64; 3],
}

impl OrientedBox {
    /// The box of the shape's own frame, at the shape's pose: as tight as the shape's [`Implicit::bounds`]. `None`
    /// where the solid is not bounded.
    pub fn around<S: Implicit>(shape: &Posed<S>) -> Option<Self> {
        let [low, high] = shape.shape().bounds();
        // halves first: the sum or the difference of 1e308 would overflow
        let (low, high) = (low.coords * 0.5, high.coords * 0.5);
        let centre = Pose::from(nalgebra::Translation3::from(low + high));
        let (pose, half) = (shape.pose() * centre, high - low);
        let finite = pose.translation.vector.iter().chain(half.iter()).all(|v| v.is_finite());
        finite.then(|| Self { pose, half_extents: half.into() })
    }

    /// The box of half edges `half_extents` (in metres, along the axes of the pose). Fails where a number is not finite or
    /// an edge negative.
    pub fn new(pose: Pose, half_extents: [f64; 3]) -> Result<Self, InvalidShape> {
        let at = pose.translation.vector.iter().chain(&pose.rotation.coords);
        let place = at.copied().find(|v| !v.is_finite());
        InvalidShape::check(place.is_none(), "pose of the box", f64::NAN, "finite")?;
        for h in half_extents {
            let range = "0 or positive, finite";
            InvalidShape::check(h >= 0.0 && h.is_finite(), "half edge of the box", h, range)?;
        }
        Ok(Self { pose, half_extents })
    }

    /// The box carried along by a pose.
    pub fn moved(&self, by: &Pose) -> Self {
        Self { pose: by * self.pose, ..*self }
    }

    /// True when two boxes have a point in common: no face of either and no pair of edges parts them
    /// (separating axes; Gottschalk, Lin and Manocha 1996).
    pub fn meets(&self, other: &Self) -> bool {
        let turn = (self.pose.rotation.inverse() * other.pose.rotation).to_rotation_matrix();
        let between = other.pose.translation.vector - self.pose.translation.vector;
        let away = self.pose.rotation.inverse_transform_vector(&between);
        let (a, b) = (Vector::from(self.half_extents), Vector::from(other.half_extents));
        let apart = |axis: Vector| {
            let reach = a.dot(&axis.abs()) + b.dot(&turn.inverse_transform_vector(&axis).abs());
            // parallel edges span no axis
            axis.norm_squared() > 1e-12 && away.dot(&axis).abs() > reach
        };
        let own = [Vector::x(), Vector::y(), Vector::z()];
        let others = own.map(|e| turn * e);
        let crossed = own.iter().flat_map(|e| others.iter().map(|f| e.cross(f)));
        !own.into_iter().chain(others).chain(crossed).any(apart)
    }

    /// Centre and axes of the box.
    pub const fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Half the edges along the axes of the pose, in metres.
    pub const fn half_extents(&self) -> [f64; 3] {
        self.half_extents
    }

    /// The eight corners, in metres.
    pub fn corners(&self) -> [Point; 8] {
        std::array::from_fn(|corner| {
            let side = |k: usize| if corner >> k & 1 == 0 { -1.0 } else { 1.0 };
            let [x, y, z] = self.half_extents;
            self.pose * Point::new(side(0) * x, side(1) * y, side(2) * z)
        })
    }

    /// True inside or on the box.
    pub fn contains(&self, p: &Point) -> bool {
        let local = self.pose.inverse_transform_point(p);
        local.iter().zip(self.half_extents).all(|(c, half)| c.abs() <= half)
    }

    /// Volume in m³.
    pub fn volume(&self) -> f64 {
        8.0 * self.half_extents.iter().product::<f64>()
    }
}

/// The least axis-aligned box (lowest, highest corner) of a body, from its support points. It touches the body on
/// all six sides, also where the body is not convex. Fails where a support point overflows.
///
/// ```
/// use supersurface::measure::tight_bounds;
/// use supersurface::{Pose, Vector, shape::{Posed, Superellipsoid}};
/// let ball = Superellipsoid::new([1.0; 3], [1.0, 1.0])?;
/// // turned balls are no wider
/// let [low, high] = tight_bounds(&Posed::new(ball, Pose::rotation(Vector::new(0.4, 0.5, 0.6)))?)?;
/// assert!((high.x - 1.0).abs() < 1e-15 && (low.z + 1.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn tight_bounds(body: &(impl SupportMap + ?Sized)) -> Result<[Point; 2], InvalidShape> {
    let mut bounds = [Point::origin(); 2];
    for axis in 0..3 {
        for (bound, side) in bounds.iter_mut().zip([-1.0, 1.0]) {
            let reached = body.support_point(&Vector::ith(axis, side))[axis];
            let what = "coordinate of a support point";
            InvalidShape::check(reached.is_finite(), what, reached, "finite")?;
            bound[axis] = reached;
        }
    }
    Ok(bounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::{Parametric, Superellipsoid, Superparaboloid, Supertoroid};

    fn pose(random: &mut Stream) -> Pose {
        let mut vector = || Vector::from_fn(|_, _| random.normal());
        Pose::new(vector(), vector())
    }

    #[test]
    fn boxes_meet_where_nothing_parts_them() {
        let cube = OrientedBox::new(Pose::identity(), [0.5; 3]).unwrap();
        let at = |x: f64, y: f64| cube.moved(&Pose::translation(x, y, 0.0));
        assert!(cube.meets(&cube) && cube.meets(&at(0.99, 0.99)) && !cube.meets(&at(1.01, 0.0)));
        // turned by 45 degrees its edge reaches out to 0.707
        let turned = |x: f64, y: f64| {
            cube.moved(&Pose::new(
                Vector::new(x, y, 0.0),
                Vector::z() * std::f64::consts::FRAC_PI_4,
            ))
        };
        assert!(cube.meets(&turned(1.2, 0.0)) && !cube.meets(&turned(1.21, 0.0)));
        assert!(cube.meets(&turned(0.85, 0.85)) && !cube.meets(&turned(0.86, 0.86)));
        // two rods that cross: only the product of their edges parts them
        let rod = OrientedBox::new(Pose::identity(), [2.0, 0.1, 0.1]).unwrap();
        let across = |z: f64| {
            let about_z = Vector::z() * std::f64::consts::FRAC_PI_4;
            rod.moved(&(Pose::translation(0.0, 0.0, z) * Pose::new(Vector::zeros(), about_z)))
        };
        assert!(rod.meets(&across(0.19)) && !rod.meets(&across(0.21)));
        assert!(OrientedBox::new(Pose::identity(), [1.0, -1.0, 1.0]).is_err());
        assert!(OrientedBox::new(Pose::identity(), [1.0, f64::NAN, 1.0]).is_err());
    }

    /// No sample lies outside of either box, and some lie on every side of both.
    fn fits<S: Implicit + Parametric + SupportMap>(shape: S, pose: Pose) {
        let posed = Posed::new(shape, pose).unwrap();
        let oriented = OrientedBox::around(&posed).unwrap();
        let [low, high] = tight_bounds(&posed).unwrap();
        let size = (high - low).norm();
        let [[from, to], [start, end]] = posed.shape().domain();
        let mut touched = [f64::INFINITY; 6];
        for i in 0..=120 {
            for j in 0..=120 {
                let at = |a: f64, b: f64, k: i32| a + (b - a) * f64::from(k) / 120.0;
                let p = pose * posed.shape().point(at(from, to, i), at(start, end, j));
                for k in 0..3 {
                    assert!(p[k] >= low[k] - 1e-14 * size && p[k] <= high[k] + 1e-14 * size);
                }
                let local = oriented.pose().inverse_transform_point(&p);
                for (k, half) in oriented.half_extents().into_iter().enumerate() {
                    assert!(local[k].abs() <= half + 1e-14 * size);
                    touched[k] = touched[k].min(half - local[k]);
                    touched[k + 3] = touched[k + 3].min(half + local[k]);
                }
            }
        }
        assert!(touched.iter().all(|gap| *gap < 1e-14 * size), "{touched:?}");
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let s = posed.support_point(&Vector::ith(axis, side));
                assert!((posed.gauge(&s) - 1.0).abs() < 1e-9, "a side that nothing touches");
            }
        }
        // the box along the axes of the box that turns with the body is never smaller
        let [loose_low, loose_high] = posed.bounds();
        assert!(
            (low - loose_low).min() > -1e-14 * size && (loose_high - high).min() > -1e-14 * size
        );
    }

    #[test]
    fn both_boxes_touch_and_nothing_is_outside() {
        for case in 0..20 {
            let mut random = Stream::new(3, case);
            let axes = [0; 3].map(|_| (random.between(0.0, 100f64.ln())).exp() * 0.01);
            let exponents = [0; 2].map(|_| random.between(0.1, 1.9));
            fits(Superellipsoid::new(axes, exponents).unwrap(), pose(&mut random));
            let ring = random.between(1.0, 5.0);
            fits(Supertoroid::new(axes, ring, exponents).unwrap(), pose(&mut random));
        }
    }

    #[test]
    fn the_box_contains_its_corners_and_no_more() {
        let shape = Superellipsoid::new([1.0, 2.0, 3.0], [1.0; 2]).unwrap();
        let posed = Posed::new(shape, pose(&mut Stream::new(8, 0))).unwrap();
        let found = OrientedBox::around(&posed).unwrap();
        assert_eq!(found.volume(), 48.0);
        for corner in found.corners() {
            let centre = Point::from(found.pose().translation.vector);
            assert!(found.contains(&(centre + (corner - centre) * (1.0 - 1e-12))));
            assert!(!found.contains(&(centre + (corner - centre) * (1.0 + 1e-12))));
        }
    }

    #[test]
    fn what_has_no_bounds_has_no_box() {
        let bowl = Superparaboloid::new([1.0; 3], [1.0; 2]).unwrap();
        assert_eq!(OrientedBox::around(&Posed::new(bowl, Pose::identity()).unwrap()), None);
        let huge = Superellipsoid::new([1e308; 3], [1.0; 2]).unwrap();
        let posed = Posed::new(huge, Pose::identity()).unwrap();
        assert_eq!(OrientedBox::around(&posed).unwrap().half_extents(), [1e308; 3]);
        assert!(tight_bounds(&posed).is_ok());
    }
}
