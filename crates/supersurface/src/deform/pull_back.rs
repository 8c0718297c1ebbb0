//! Radial distances of deformed superellipsoids with their derivatives by shape, pose and deformation (FORMULAS §7.3).
//!
//! The pull-back distance is the radial distance `r` of `u = T⁻¹(q)` to the undeformed solid. From `T(u; k) = q` follow
//! `∂r/∂q = J^{-T} ∂r/∂u` and `∂r/∂k = -∂r/∂q · ∂T/∂k`. It is 0 on the surface and no distance elsewhere. The exact radial
//! distance `n (1 - s)` of a tapered solid, `n = |q|`, has its foot at `s q`, where `r` stays 0: with the derivatives of
//! `r` there, `d(n (1 - s)) = (1 - s) dn + n dr/(q·∂r/∂q)`.

use super::{Bend, Deformation, Deformed, Taper, Twist};
use crate::shape::superellipsoid::PARAMETERS;
use crate::shape::{Posed, Superellipsoid};
use crate::{Point, Pose, Vector};

/// A deformation with `K` parameters that a fit may change.
pub trait Adjustable<const K: usize>: Deformation {
    /// Derivatives of [`forward`](Deformation::forward) at an undeformed point by the parameters, and by the height at
    /// which they count (zero where there is none).
    fn by_parameters(&self, p: &Point) -> ([Vector; K], Vector);
}

/// By `Kx`, `Ky`, in metres.
impl Adjustable<2> for Taper {
    fn by_parameters(&self, p: &Point) -> ([Vector; 2], Vector) {
        let ([kx, ky], h) = (self.slopes(), self.half_height());
        let (x, y) = (Vector::x() * (p.x * p.z / h), Vector::y() * (p.y * p.z / h));
        ([x, y], -(x * kx + y * ky) / h)
    }
}

/// By the number of turns, in metres.
impl Adjustable<1> for Twist {
    fn by_parameters(&self, p: &Point) -> ([Vector; 1], Vector) {
        let h = self.half_height();
        let moved = self.forward(p);
        let by_angle = Vector::new(-moved.y, moved.x, 0.0) * std::f64::consts::PI;
        ([by_angle * (1.0 + p.z / h)], -by_angle * (self.turns() * p.z / (h * h)))
    }
}

/// By the curvature `k` in m², by the angle `α` in metres.
impl Adjustable<2> for Bend {
    /// `∂R/∂k = -r z sin γ + z² (γ sin γ + cos γ - 1)/γ²`, `∂Z/∂k = -r z cos γ + z² (γ cos γ - sin γ)/γ²`.
    fn by_parameters(&self, p: &Point) -> ([Vector; 2], Vector) {
        let (sin_a, cos_a) = self.angle().sin_cos();
        let (inwards, across) = (Vector::new(cos_a, sin_a, 0.0), Vector::new(-sin_a, cos_a, 0.0));
        let (r, w) = (inwards.dot(&p.coords), across.dot(&p.coords));
        let gamma = self.curvature() * p.z;
        let (sin, cos) = gamma.sin_cos();
        let square = gamma * gamma;
        // both cancel next to 0
        let (f, g) = match gamma.abs() < 0.1 {
            true => (
                0.5 - square / 8.0 * (1.0 - square / 18.0 * (1.0 - square / 40.0)),
                -gamma / 3.0
                    * (1.0 - square / 10.0 * (1.0 - square / 28.0 * (1.0 - square / 54.0))),
            ),
            false => ((gamma * sin + cos - 1.0) / square, (gamma * cos - sin) / square),
        };
        let by_k =
            inwards * (p.z * (p.z * f - r * sin)) + Vector::z() * (p.z * (p.z * g - r * cos));
        let shift = self.forward(p).coords.dot(&inwards) - r;
        let by_angle = across * shift + inwards * ((cos - 1.0) * w) - Vector::z() * (sin * w);
        ([by_k, by_angle], Vector::zeros())
    }
}

/// A distance with its derivatives: by semi-axes and exponents of the shape, by the point, by the deformation.
struct Derivatives<const K: usize> {
    distance: f64,
    by_shape: [f64; 5],
    by_point: Vector,
    by_deformation: [f64; K],
}

impl<const K: usize> Derivatives<K> {
    /// The same for a body at a pose, in the order of [`PARAMETERS`].
    fn posed(self, pose: &Pose, q: &Point) -> (f64, [f64; PARAMETERS], [f64; K]) {
        let mut row = [0.0; PARAMETERS];
        let by_position = -(pose.rotation * self.by_point);
        let by_rotation = self.by_point.cross(&q.coords);
        let all = self.by_shape.iter().chain(by_position.iter()).chain(by_rotation.iter());
        for (entry, value) in row.iter_mut().zip(all) {
            *entry = *value;
        }
        (self.distance, row, self.by_deformation)
    }
}

impl<D> Deformed<Superellipsoid, D> {
    /// Of the radial distance of `T⁻¹(q)`.
    fn pulled_back<const K: usize>(&self, q: &Point) -> Option<Derivatives<K>>
    where
        D: Adjustable<K>,
    {
        let u = self.pull_back(q)?;
        let (distance, row) = Posed::new(*self.shape(), Pose::identity()).ok()?.radial_jacobian(&u);
        let [a1, a2, a3, e1, e2, x, y, z, ..] = row;
        let by_point =
            self.deformation().jacobian(&u).try_inverse()?.tr_mul(&-Vector::new(x, y, z));
        let (by_parameters, by_height) = self.deformation().by_parameters(&u);
        Some(Derivatives {
            distance,
            by_shape: [a1, a2, a3 - by_point.dot(&by_height), e1, e2],
            by_point,
            by_deformation: by_parameters.map(|v| -by_point.dot(&v)),
        })
    }
}

impl<D> Posed<Deformed<Superellipsoid, D>> {
    /// Pull-back radial distance of a world point in metres, its derivatives by the [`PARAMETERS`] of the
    /// superellipsoid, and by those of the deformation (see [`Adjustable`]). The height of the deformation is taken to
    /// change with a3. `None` where there is no pull-back.
    pub fn pull_back_jacobian<const K: usize>(
        &self,
        p: &Point,
    ) -> Option<(f64, [f64; PARAMETERS], [f64; K])>
    where
        D: Adjustable<K>,
    {
        let q = self.to_local(p);
        Some(self.shape().pulled_back(&q)?.posed(self.pose(), &q))
    }
}

impl Posed<Deformed<Superellipsoid, Taper>> {
    /// Exact radial distance of a world point in metres, its derivatives by the [`PARAMETERS`] of the superellipsoid, and
    /// by the slopes of the taper; its height is taken to change with a3. `None` at the centre and for points that are
    /// not finite.
    pub fn radial_jacobian(&self, p: &Point) -> Option<(f64, [f64; PARAMETERS], [f64; 2])> {
        let q = self.to_local(p);
        let s = self.shape().radial_scale(&q)?;
        let at_foot: Derivatives<2> = self.shape().pulled_back(&Point::from(q.coords * s))?;
        let length = q.coords.norm();
        let share = length / at_foot.by_point.dot(&q.coords);
        let found = Derivatives {
            distance: self.shape().radial_distance(&q),
            by_shape: at_foot.by_shape.map(|v| v * share),
            by_point: q.coords * ((1.0 - s) / length) + at_foot.by_point * (s * share),
            by_deformation: at_foot.by_deformation.map(|v| v * share),
        };
        share.is_finite().then(|| found.posed(self.pose(), &q))
    }
}
