//! How the wrench of a foundation changes with the poses of both bodies: what an optimiser of trajectories asks for.
//!
//! For springs alone, without damping and friction. A vertex at `x` with the indentation `I = (1 - g)/|∇g|² ∇g` feels
//! `f = k A I`, and the indentation changes with the vertex, in the solid's frame, by
//!
//! ```text
//! J = ∂I/∂x = ((1 - g)(H - 2 ∇g (H∇g)ᵀ/|∇g|²) - ∇g ∇gᵀ)/|∇g|²
//! ```
//!
//! with the second derivatives `H` of the gauge. With `r = x - o`, twists `(v, ω)` of each body about `o` give
//!
//! ```text
//! mesh    df =  k A J (v + ω × r)              dm = r × df + (v + ω × r) × f
//! solid   df = -k A J (v + ω × r) + ω × f      dm = r × df
//! ```
//!
//! `J` is not symmetric: the normals of equation (46) are those of the foot, and the work of its forces along a closed way
//! need not vanish. Vertices that come in or go out do so with no force, so the wrench is continuous, and its derivative
//! jumps by `k A n nᵀ` as each of them passes the surface.

use nalgebra::{Matrix3, Matrix6};

use super::foundation::Foundation;
use super::foundation_error::FoundationError;
use super::indentation::Indented;
use super::wrench::Wrench;
use crate::shape::{Posed, SecondOrder};
use crate::{Point, Pose, Vector};

/// A wrench with its derivatives by the poses of both bodies.
///
/// Rows are force and moment in world axes, the moment about a point that stays where it is. Columns are the position of
/// the body's origin in world axes, `t → t + δt`, then its rotation vector in its own axes, `R → R exp([δ]×)`: the
/// parameters of [`Posed::radial_jacobian`](crate::shape::Posed::radial_jacobian). For steps in body axes,
/// `T → T exp(ξ)`, multiply the first three columns by `R` from the right.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WrenchDerivative {
    /// What the mesh feels; the solid feels the opposite, with the opposite derivatives.
    pub on_mesh: Wrench,
    /// By the pose of the mesh: N/m, N/rad, N·m/m, N·m/rad.
    pub by_mesh: Matrix6<f64>,
    /// By the pose of the solid.
    pub by_solid: Matrix6<f64>,
    /// Vertices that lie on a seam where the surface has no curvature or an infinite one: there the second derivatives are
    /// taken as 0. Elsewhere, and wherever this is 0, the derivatives are exact.
    pub without_curvature: usize,
}

impl Foundation {
    /// The elastic wrench between the mesh at `pose` and a solid about a fixed point, for a stiffness in Pa/m, with its
    /// derivatives by both poses.
    ///
    /// ```
    /// use supersurface::contact::Foundation;
    /// use supersurface::mesh::tessellate;
    /// use supersurface::shape::{Posed, Superellipsoid};
    /// use supersurface::{Point, Pose};
    /// let ball = Superellipsoid::new([0.02; 3], [1.0; 2])?;
    /// let pad = Foundation::new(&tessellate(&ball, Some(1e-5))?.mesh)?;
    /// let solid = Posed::new(ball, Pose::identity())?;
    /// let at = |x: f64| pad.press_derivative(&Pose::translation(x, 0.0, 0.0), &solid, 1e8, &Point::origin());
    /// let found = at(0.039)?;
    /// let step = 1e-7;
    /// let slope = (at(0.039 + step)?.on_mesh.force.x - at(0.039 - step)?.on_mesh.force.x) / (2.0 * step);
    /// assert!(found.by_mesh[(0, 0)] < 0.0 && (found.by_mesh[(0, 0)] / slope - 1.0).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn press_derivative<S: Indented + SecondOrder>(
        &self,
        pose: &Pose,
        solid: &Posed<S>,
        stiffness: f64,
        about: &Point,
    ) -> Result<WrenchDerivative, FoundationError> {
        FoundationError::positive("stiffness", stiffness)?;
        FoundationError::finite("a coordinate of the point", about.iter())?;
        let origin = solid.to_local(about).coords;
        let mut sums = Sums::default();
        self.gather(pose, solid, |block| {
            for i in 0..block.count {
                let q = Vector::from_fn(|k, _| block.points[k][i]);
                sums.add(solid.shape(), &q, &(q - origin), block.areas[i]);
            }
        })?;
        sums.derivative(pose, solid.pose(), stiffness, about)
    }
}

/// Sums over vertices for `k = 1`, in the solid's axes, arms from the point.
#[derive(Default)]
struct Sums {
    force: Vector,
    moment: Vector,
    /// `Σ A J`, `Σ A J [r]×`, `Σ A [r]× J`, `Σ A [r]× J [r]×`.
    spring: [Matrix3<f64>; 4],
    /// `Σ [f]× [r]×`.
    arms: Matrix3<f64>,
    without_curvature: usize,
}

impl Sums {
    fn add<S: Indented + SecondOrder>(&mut self, solid: &S, q: &Vector, r: &Vector, area: f64) {
        let q = Point::from(*q);
        let (room, gradient) = (1.0 - solid.gauge(&q), solid.gradient(&q));
        let square = gradient.norm_squared();
        if !(room > 0.0 && square > 0.0) {
            return;
        }
        let hessian = solid.hessian(&q).unwrap_or_else(|| {
            self.without_curvature += 1;
            Matrix3::zeros()
        });
        let bend = hessian - gradient * (hessian * gradient).transpose() * (2.0 / square);
        let by_point = (bend * room - gradient * gradient.transpose()) * (area / square);
        let force = gradient * (area * room / square);
        let arm = r.cross_matrix();
        self.force += force;
        self.moment += r.cross(&force);
        let turned = by_point * arm;
        for (sum, part) in
            self.spring.iter_mut().zip([by_point, turned, arm * by_point, arm * turned])
        {
            *sum += part;
        }
        self.arms += force.cross_matrix() * arm;
    }

    fn derivative(
        &self,
        mesh: &Pose,
        solid: &Pose,
        stiffness: f64,
        about: &Point,
    ) -> Result<WrenchDerivative, FoundationError> {
        let [by_v, by_w, moment_by_v, moment_by_w] = self.spring;
        let f = self.force.cross_matrix();
        let on_mesh = blocks([[by_v, -by_w], [moment_by_v - f, self.arms - moment_by_w]]);
        // Σ [r]× [f]× is the transpose of Σ [f]× [r]×
        let on_solid =
            blocks([[-by_v, by_w - f], [-moment_by_v, moment_by_w - self.arms.transpose()]]);
        let turn = solid.rotation.to_rotation_matrix().into_inner();
        let zero = Matrix3::zeros();
        let turns = blocks([[turn, zero], [zero, turn]]);
        let scaled = |m: nalgebra::Matrix6<f64>, body: &Pose| {
            turns * m * turns.transpose() * twist_by_pose(body, about) * stiffness
        };
        let found = WrenchDerivative {
            on_mesh: Wrench {
                force: turn * self.force * stiffness,
                moment: turn * self.moment * stiffness,
                about: *about,
            },
            by_mesh: scaled(on_mesh, mesh),
            by_solid: scaled(on_solid, solid),
            without_curvature: self.without_curvature,
        };
        let finite = found.by_mesh.iter().chain(&found.by_solid).all(|v| v.is_finite());
        if finite && found.on_mesh.is_finite() { Ok(found) } else { Err(FoundationError::Overflow) }
    }
}

/// The twist about a point, in world axes, that a change `(δt, δ)` of a pose is.
fn twist_by_pose(pose: &Pose, about: &Point) -> Matrix6<f64> {
    let turn = pose.rotation.to_rotation_matrix().into_inner();
    let arm = about.coords - pose.translation.vector;
    blocks([[Matrix3::identity(), -arm.cross_matrix() * turn], [Matrix3::zeros(), turn]])
}

fn blocks([[a, b], [c, d]]: [[Matrix3<f64>; 2]; 2]) -> Matrix6<f64> {
    let mut all = Matrix6::zeros();
    for (i, j, part) in [(0, 0, a), (0, 3, b), (3, 0, c), (3, 3, d)] {
        all.fixed_view_mut::<3, 3>(i, j).copy_from(&part);
    }
    all
}
