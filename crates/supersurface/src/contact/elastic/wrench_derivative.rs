//! How the wrench of a foundation changes with the poses of both bodies: what an optimiser of trajectories asks for.
//!
//! For springs alone, without damping and friction. A vertex at `x` feels `f = k A I` with the indentation `I` of equation
//! (46), and `I` changes with the vertex by `J` ([`SmoothlyIndented`]). With `r = x - o`, twists `(v, ω)` of each body about
//! `o` give
//!
//! ```text
//! mesh    df =  k A J (v + ω × r)              dm = r × df + (v + ω × r) × f
//! solid   df = -k A J (v + ω × r) + ω × f      dm = r × df
//! ```
//!
//! Vertices that come in or go out do so with no force, so the wrench is continuous, and its derivative jumps by `k A n nᵀ`
//! as each of them passes the surface.

use nalgebra::{Matrix3, Matrix6};

use super::foundation::{Block, Foundation};
use super::foundation_error::FoundationError;
use super::indentation::BLOCK;
use super::indentation_slope::{IndentationSlopes, SmoothlyIndented};
use super::wrench::Wrench;
use crate::numeric::lanes::{Job, dispatch, dot, fused};
use crate::shape::Posed;
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
    /// Vertices that lie exactly on a seam where the surface has no curvature or an infinite one: there the second
    /// derivatives are taken as 0. Where this is 0 the derivatives are exact.
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
    pub fn press_derivative<S: SmoothlyIndented>(
        &self,
        pose: &Pose,
        solid: &Posed<S>,
        stiffness: f64,
        about: &Point,
    ) -> Result<WrenchDerivative, FoundationError> {
        FoundationError::positive("stiffness", stiffness)?;
        FoundationError::finite("a coordinate of the point", about.iter())?;
        let origin = solid.to_local(about).coords.into();
        let (mut slopes, mut sums) = (IndentationSlopes::default(), Sums::default());
        self.gather(pose, solid, |block| {
            solid.shape().slopes(&block.points, &mut slopes);
            dispatch(Add { block, slopes: &slopes, origin, sums: &mut sums });
        })?;
        sums.derivative(pose, solid.pose(), stiffness, about)
    }
}

/// Sums over vertices for `k = 1`, in the solid's axes, with arms `r` from the point.
#[derive(Default)]
struct Sums {
    force: Vector,
    /// `Σ A (J, [r]× J; J [r]×ᵀ, [r]× J [r]×ᵀ)`, by columns.
    spring: Matrix6<f64>,
    /// `Σ r fᵀ`.
    arms: Matrix3<f64>,
    without_curvature: f64,
}

/// Adds a block of vertices.
struct Add<'a> {
    block: &'a Block,
    slopes: &'a IndentationSlopes,
    origin: [f64; 3],
    sums: &'a mut Sums,
}

impl Job for Add<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { block, slopes, origin, sums } = self;
        let mut arms = block.points;
        for (arm, o) in arms.iter_mut().zip(origin) {
            arm.iter_mut().for_each(|v| *v -= o);
        }
        let mut weighted = arms;
        for column in &mut weighted {
            column.iter_mut().zip(&block.areas).for_each(|(v, area)| *v *= area);
        }
        for (r, (arm, own)) in weighted.iter().zip(&slopes.vectors).enumerate() {
            sums.force[r] += dot::<FUSED, f64>(&block.areas, own);
            for (c, vector) in slopes.vectors.iter().enumerate() {
                sums.arms[(r, c)] += dot::<FUSED, f64>(arm, vector);
            }
        }
        // the columns of (J; [r]× J)
        let mut tall = [[[0.0; BLOCK]; 6]; 3];
        for (c, column) in tall.iter_mut().enumerate() {
            for r in 0..3 {
                let (next, last) = ((r + 1) % 3, (r + 2) % 3);
                column[r] = slopes.by_point[r][c];
                for i in 0..BLOCK {
                    let turned = arms[last][i] * slopes.by_point[next][c][i];
                    column[r + 3][i] =
                        fused::<FUSED>(arms[next][i], slopes.by_point[last][c][i], -turned);
                }
            }
        }
        // and what [r]×ᵀ makes of its rows
        for c in 0..3 {
            let (next, last) = ((c + 1) % 3, (c + 2) % 3);
            for (r, own) in tall[c].iter().enumerate() {
                sums.spring[(r, c)] += dot::<FUSED, f64>(&block.areas, own);
                sums.spring[(r, c + 3)] += dot::<FUSED, f64>(&weighted[next], &tall[last][r])
                    - dot::<FUSED, f64>(&weighted[last], &tall[next][r]);
            }
        }
        for (seam, area) in slopes.without_curvature.iter().zip(&block.areas) {
            sums.without_curvature += if *area > 0.0 { *seam } else { 0.0 };
        }
    }
}

impl Sums {
    fn derivative(
        &self,
        mesh: &Pose,
        solid: &Pose,
        stiffness: f64,
        about: &Point,
    ) -> Result<WrenchDerivative, FoundationError> {
        let force = self.force.cross_matrix();
        // Σ [f]× [r]× = Σ r fᵀ - Σ (f·r), and its transpose is Σ [r]× [f]×
        let arms = self.arms - Matrix3::identity() * self.arms.trace();
        let zero = Matrix3::zeros();
        let on_mesh = self.spring + blocks([[zero, zero], [-force, arms]]);
        let on_solid = -self.spring - blocks([[zero, force], [zero, arms.transpose()]]);
        let turn = solid.rotation.to_rotation_matrix().into_inner();
        let turns = blocks([[turn, zero], [zero, turn]]);
        let by_pose = |by_twist: Matrix6<f64>, body: &Pose| {
            turns * by_twist * turns.transpose() * twist_by_pose(body, about) * stiffness
        };
        // Σ r × f from the skew part of Σ r fᵀ
        let skew = self.arms - self.arms.transpose();
        let moment = Vector::new(skew[(1, 2)], skew[(2, 0)], skew[(0, 1)]);
        let found = WrenchDerivative {
            on_mesh: Wrench {
                force: turn * self.force * stiffness,
                moment: turn * moment * stiffness,
                about: *about,
            },
            by_mesh: by_pose(on_mesh, mesh),
            by_solid: by_pose(on_solid, solid),
            without_curvature: self.without_curvature as usize,
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
