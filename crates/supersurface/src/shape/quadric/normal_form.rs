//! Reduction to normal form: turn to the eigenvectors of `M`, move to the centre or the vertex (FORMULAS §1.1).
//!
//! In the frame of the eigenvectors `Σ λ_i y_i² + n·y + P = 0`. Where `λ_i` is not zero the square is completed,
//! which leaves the constant `P' = P - Σ n_i²/(4 λ_i)`; a slope `ℓ` that is left in the null space makes the
//! quadric parabolic and takes up the constant. What counts as zero is relative: [`NormalForm::TOLERANCE`].

use std::cmp::Ordering;

use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitQuaternion};

use super::kind::RightSide;
use super::{Quadric, QuadricType};
use crate::shape::{Posed, Superellipsoid};
use crate::{Point, Pose, Vector};

/// A quadric in its own frame: `Σ squares_i x_i²` is 1, 0 or z, as its type says.
///
/// ```
/// use supersurface::shape::{Quadric, QuadricType};
/// // 2 x y = 1 is a hyperbolic cylinder, turned by 45° around z
/// let q = Quadric::new([0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0])?;
/// let form = q.normal_form();
/// assert_eq!((form.kind, form.rank), (QuadricType::HyperbolicCylinder, 2));
/// assert!((form.squares[0] - 1.0).abs() < 1e-15 && (form.squares[1] + 1.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForm {
    /// Which of the 17 types.
    pub kind: QuadricType,
    /// Rank of `M`: how many eigenvalues are not zero.
    pub rank: usize,
    /// Eigenvalues of `M` in rising order, in the equation's own units; exactly 0 beyond the rank.
    pub eigenvalues: [f64; 3],
    /// Factors of `x²`, `y²`, `z²` in the frame of `pose`: positive ones first, then negative, then zero, each
    /// rising in magnitude. In 1/m² where the right side is 1, in 1/m where it is z, and such that the largest
    /// magnitude is 1 where it is 0.
    pub squares: [f64; 3],
    /// Where the normal form's frame stands: its origin is the centre of the quadric or the vertex of a
    /// paraboloid; for cylinders and planes, whose centres are many, the one nearest to the frame's origin.
    pub pose: Pose,
}

impl NormalForm {
    /// What counts as zero: an eigenvalue against the largest, the constant against the terms that it is the
    /// difference of, the slope of a paraboloid against the whole linear part.
    pub const TOLERANCE: f64 = 1e-9;

    /// The centre in metres, where there is exactly one (rank 3).
    pub fn centre(&self) -> Option<Point> {
        (self.rank == 3).then(|| Point::from(self.pose.translation.vector))
    }

    /// `1/√|squares_i|` in metres along the axes of the pose: semi-axes, of a hyperboloid also the imaginary
    /// ones. `None` along which there is none (cylinders), and for types whose right side is not 1.
    pub fn semi_axes(&self) -> [Option<f64>; 3] {
        let one = match self.kind {
            QuadricType::Ellipsoid
            | QuadricType::ImaginaryEllipsoid
            | QuadricType::HyperboloidOneSheet
            | QuadricType::HyperboloidTwoSheets
            | QuadricType::EllipticCylinder
            | QuadricType::ImaginaryEllipticCylinder
            | QuadricType::HyperbolicCylinder
            | QuadricType::ParallelPlanes
            | QuadricType::ImaginaryParallelPlanes => true,
            QuadricType::Point
            | QuadricType::EllipticCone
            | QuadricType::EllipticParaboloid
            | QuadricType::HyperbolicParaboloid
            | QuadricType::Line
            | QuadricType::IntersectingPlanes
            | QuadricType::ParabolicCylinder
            | QuadricType::CoincidentPlanes => false,
        };
        self.squares.map(|s| (one && s != 0.0).then(|| 1.0 / s.abs().sqrt()))
    }

    /// The ellipsoid that it is, with semi-axes falling from x to z, if it is one.
    pub fn as_ellipsoid(&self) -> Option<Posed<Superellipsoid>> {
        let [Some(a1), Some(a2), Some(a3)] = self.semi_axes() else { return None };
        if self.kind != QuadricType::Ellipsoid {
            return None;
        }
        Posed::new(Superellipsoid::new([a1, a2, a3], [1.0, 1.0]).ok()?, self.pose).ok()
    }
}

/// One eigenvector with what the equation says along it.
#[derive(Clone, Copy)]
struct Axis {
    direction: Vector,
    square: f64,
    slope: f64,
}

impl Axis {
    /// Positive squares first, then negative, then zero.
    const fn group(&self) -> u8 {
        if self.square > 0.0 {
            0
        } else if self.square < 0.0 {
            1
        } else {
            2
        }
    }
}

impl Quadric {
    /// The type, pose and size of the quadric. They do not change when the equation is multiplied by any
    /// number but 0 (the axes may come with other signs).
    pub fn normal_form(&self) -> NormalForm {
        let largest = self.largest(6);
        let (m, n, constant) = self.parts(largest);
        let eigen = SymmetricEigen::new(m);
        let unit = eigen.eigenvalues.amax();
        let (n, constant) = (n / unit, constant / unit);
        let mut axes = [0, 1, 2].map(|i| {
            let direction = Vector::from(eigen.eigenvectors.column(i));
            let square = eigen.eigenvalues[i] / unit;
            let square = if square.abs() > NormalForm::TOLERANCE { square } else { 0.0 };
            Axis { direction, square, slope: n.dot(&direction) }
        });
        let rank = axes.iter().filter(|a| a.square != 0.0).count();
        let mut eigenvalues = axes.map(|a| a.square * unit * largest);
        eigenvalues.sort_by(f64::total_cmp);

        // complete the squares
        let (mut origin, mut down) = (Vector::zeros(), Vector::zeros());
        let (mut rest, mut completed) = (constant, 0.0);
        for a in &axes {
            if a.square == 0.0 {
                down += a.direction * a.slope;
            } else {
                origin -= a.direction * (0.5 * a.slope / a.square);
                rest -= 0.25 * a.slope * a.slope / a.square;
                completed += 0.25 * a.slope * a.slope / a.square.abs();
            }
        }
        let terms = constant.abs().max(completed);

        // a slope along which the vertex is not infinitely far
        let slope = down.norm();
        let parabolic = slope > NormalForm::TOLERANCE * n.norm()
            && (rest / slope).is_finite()
            && (1.0 / slope).is_finite();
        let central =
            rest.abs() > NormalForm::TOLERANCE * terms && (1.0 / rest).is_finite() && !parabolic;
        let right = match (parabolic, central) {
            (true, _) => RightSide::Z,
            (_, true) => RightSide::One,
            (_, false) => RightSide::Zero,
        };
        let count =
            |axes: &[Axis; 3], group: u8| axes.iter().filter(|a| a.group() == group).count();
        // most squares positive; of two that differ in sign, the positive one is the smaller
        let balance = axes.iter().map(|a| a.square).sum::<f64>();
        let sign = match count(&axes, 0).cmp(&count(&axes, 1)) {
            Ordering::Greater => 1.0,
            Ordering::Less => -1.0,
            Ordering::Equal if balance > 0.0 => -1.0,
            Ordering::Equal => 1.0,
        };
        let factor = match right {
            RightSide::Z => sign / slope,
            RightSide::One => -1.0 / rest,
            RightSide::Zero => sign,
        };
        for a in &mut axes {
            a.square *= factor;
        }
        axes.sort_by(|a, b| {
            a.group().cmp(&b.group()).then(a.square.abs().total_cmp(&b.square.abs()))
        });

        let [x, mut y, mut z] = axes.map(|a| a.direction);
        if parabolic {
            origin -= down * (rest / slope / slope);
            z = down * (-sign / slope);
            if rank == 1 {
                y = z.cross(&x);
            }
        }
        let frame = Matrix3::from_columns(&[y.cross(&z), y, z]);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(frame));
        NormalForm {
            kind: QuadricType::of(count(&axes, 0), count(&axes, 1), right),
            rank,
            eigenvalues,
            squares: axes.map(|a| a.square),
            pose: Pose::from_parts(origin.into(), turn),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::Implicit;

    /// The coefficients of `Σ squares x² = right(1, z)` in the frame of `pose`, times `scale`.
    fn coefficients(squares: [f64; 3], right: [f64; 2], pose: &Pose, scale: f64) -> [f64; 10] {
        let r = pose.rotation.to_rotation_matrix().into_inner();
        let m = r * Matrix3::from_diagonal(&Vector::from(squares)) * r.transpose();
        let c = pose.translation.vector;
        let up = r.column(2) * right[1];
        let n = -2.0 * (m * c) - up;
        let p = c.dot(&(m * c)) + up.dot(&c) - right[0];
        let [d, e, f] = [m[(0, 1)], m[(1, 2)], m[(0, 2)]].map(|v| 2.0 * v);
        [m[(0, 0)], m[(1, 1)], m[(2, 2)], d, e, f, n.x, n.y, n.z, p].map(|v| v * scale)
    }

    #[test]
    fn all_types_come_back_from_any_pose_and_scale() {
        use QuadricType::*;
        let cases = [
            (Ellipsoid, [1.0, 2.0, 5.0], [1.0, 0.0]),
            (ImaginaryEllipsoid, [-1.0, -2.0, -5.0], [1.0, 0.0]),
            (Point, [0.25, 0.5, 1.0], [0.0, 0.0]),
            (HyperboloidOneSheet, [1.0, 2.0, -3.0], [1.0, 0.0]),
            (HyperboloidTwoSheets, [1.0, -2.0, -3.0], [1.0, 0.0]),
            (EllipticCone, [0.25, 1.0, -0.5], [0.0, 0.0]),
            (EllipticParaboloid, [1.0, 3.0, 0.0], [0.0, 1.0]),
            (HyperbolicParaboloid, [1.0, -3.0, 0.0], [0.0, 1.0]),
            (EllipticCylinder, [1.0, 3.0, 0.0], [1.0, 0.0]),
            (ImaginaryEllipticCylinder, [-1.0, -3.0, 0.0], [1.0, 0.0]),
            (Line, [0.3, 1.0, 0.0], [0.0, 0.0]),
            (HyperbolicCylinder, [1.0, -3.0, 0.0], [1.0, 0.0]),
            (IntersectingPlanes, [0.5, -1.0, 0.0], [0.0, 0.0]),
            (ParabolicCylinder, [2.0, 0.0, 0.0], [0.0, 1.0]),
            (ParallelPlanes, [2.0, 0.0, 0.0], [1.0, 0.0]),
            (ImaginaryParallelPlanes, [-2.0, 0.0, 0.0], [1.0, 0.0]),
            (CoincidentPlanes, [1.0, 0.0, 0.0], [0.0, 0.0]),
        ];
        for (i, (kind, squares, right)) in cases.into_iter().enumerate() {
            for k in 0..40 {
                let mut random = Stream::new(3, 100 * i as u64 + k);
                let axis = Vector::from_fn(|_, _| random.normal());
                let at = Vector::from_fn(|_, _| 2.0 * random.normal());
                let pose = Pose::new(at, axis);
                let scale = [1.0, -1.0, 3e-200, -1e150][k as usize % 4];
                let q = Quadric::new(coefficients(squares, right, &pose, scale)).unwrap();
                let form = q.normal_form();
                assert_eq!(form.kind, kind, "{form:?}");
                for (found, s) in form.squares.iter().zip(squares) {
                    assert!((found - s).abs() < 1e-9, "{kind:?}: {form:?}");
                }
                assert_eq!(form.rank, squares.iter().filter(|s| **s != 0.0).count());
                // the form's equation is the quadric's, up to one factor
                let frame = form.pose.rotation.to_rotation_matrix().into_inner();
                assert!((frame * frame.transpose() - Matrix3::identity()).amax() < 1e-14);
                let back = coefficients(form.squares, right, &form.pose, 1.0);
                let given = q.coefficients();
                let factor = given.iter().zip(back).map(|(a, b)| a / scale * b).sum::<f64>()
                    / back.iter().map(|b| b * b).sum::<f64>();
                let size = back.iter().fold(0.0f64, |m, b| m.max(b.abs()));
                for (a, b) in given.iter().zip(back) {
                    assert!(
                        (a / scale - factor * b).abs() < 1e-8 * size * factor.abs(),
                        "{kind:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn an_ellipsoid_is_a_posed_superellipsoid() {
        let pose = Pose::new(Vector::new(0.3, -1.0, 2.0), Vector::new(0.4, 0.2, -1.0));
        let squares = [1.0 / 0.09, 1.0 / 0.04, 1.0 / 0.01];
        let q = Quadric::new(coefficients(squares, [1.0, 0.0], &pose, -7.0)).unwrap();
        let e = q.as_ellipsoid().unwrap();
        for (found, a) in e.shape().semi_axes().into_iter().zip([0.3, 0.2, 0.1]) {
            assert!((found - a).abs() < 1e-12);
        }
        for local in crate::shape::checks::points([0.0; 3], [0.4; 3], 30) {
            let p = pose * local;
            let g = e.gauge(&p);
            assert!((q.value(&p) + 7.0 * (g * g - 1.0)).abs() < 1e-10 * (1.0 + g * g));
            let slope = q.gradient(&p) + e.gradient(&p) * (14.0 * g);
            assert!(slope.norm() < 1e-9 * q.gradient(&p).norm());
        }
        assert!(
            (q.normal_form().centre().unwrap() - pose.translation.vector).coords.norm() < 1e-12
        );
    }

    #[test]
    fn what_is_no_quadric_is_refused_and_extremes_have_a_finite_form() {
        assert!(Quadric::new([0.0; 10]).is_err());
        let mut c = [0.0; 10];
        c[6] = 1.0;
        assert!(Quadric::new(c).is_err());
        let values = [0.0, 5e-324, 1e-300, 1.0, -1e200, f64::MAX];
        for i in 0..20_000 {
            let mut random = Stream::new(4, i);
            let c: [f64; 10] = std::array::from_fn(|_| values[random.index(values.len())]);
            let Ok(q) = Quadric::new(c) else { continue };
            let form = q.normal_form();
            assert!(form.squares.iter().all(|v| v.is_finite()), "{c:?}: {form:?}");
            assert!(form.pose.translation.vector.iter().all(|v| v.is_finite()), "{c:?}: {form:?}");
            assert!(form.pose.rotation.coords.iter().all(|v| v.is_finite()), "{c:?}: {form:?}");
            assert!(!q.value(&Point::new(1e200, -3.0, 0.0)).is_nan());
            let _ = q.as_ellipsoid();
        }
    }
}
